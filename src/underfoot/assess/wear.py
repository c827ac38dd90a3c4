"""Friction and film of a case as its sole wears, and when the fluid's load passes a limit."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from underfoot.core import InputError, Progress, display, silent, unknown_name

from .outcomes import Outcome, outcomes
from .sensitivity import OPEN_INPUTS, OpenInput, open_inputs, variants
from .wear_limit import Passing, passing

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.outsole.shape import SoleShape
    from underfoot.outsole.worn import WearMeasures

MODES = ("archard", "plane", "patch")
BAND_INPUTS = ("interface.roughness_beyond_cutoff", "shoe.material.shore_a")
"""What the band of the limit is made of: the least known inputs that decide the film."""
LARGEST_PATCH = 0.8
"""Largest patch of a series as a share of the heel's length and width."""
BEYOND_TREAD = 1.6
"""Thickness lost at the end of an Archard series in depths of the tread."""
PARTS = 6
"""Parts of a step in which the wear is measured, to say how worn the sole is at the limit."""
HEEL_PART = 0.25
"""Share of a whole sole's length that is its heel."""
LONGEST_HEEL, WIDTH_OF_HEEL = 0.12, 0.65
"""m, and the heel's width as a share of a whole sole's (assumed: common lasts)."""


@dataclass(frozen=True, slots=True)
class WearPoint:
    """One state of wear: how worn it is, its outcome, and those at the ends of open inputs.

    ``variants`` holds (path, low, high) for each open input that was varied; empty without a band.
    """

    measures: WearMeasures
    outcome: Outcome
    variants: tuple[tuple[str, Outcome, Outcome], ...] = ()


@dataclass(frozen=True, slots=True)
class WearSeries:
    """A case over its wear.

    ``limit`` is the fluid load (N) that is looked for; ``passings`` says for the load under the
    sole ("fluid_load") and as the floor sensors read it ("fluid_load_sensor") when it is passed.
    """

    name: str
    mode: str
    limit: float
    points: tuple[WearPoint, ...]
    passings: dict[str, Passing]
    assumptions: tuple[str, ...]

    def values(self, name: str) -> np.ndarray:
        """Return a number of all points in SI, nan where it was not determined."""
        return np.array([point.outcome.number(name) for point in self.points])

    def measured(self, name: str) -> np.ndarray:
        """Return a measure of wear of all points in SI."""
        return np.array([getattr(point.measures, name) for point in self.points])

    def ends(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Return the lowest and highest value of a number over the open inputs, per point."""
        low, high = [], []
        for point in self.points:
            seen = [point.outcome.number(name)]
            seen += [end.number(name) for _, *pair in point.variants for end in pair]
            known = [value for value in seen if not math.isnan(value)]
            low.append(min(known, default=math.nan))
            high.append(max(known, default=math.nan))
        return np.array(low), np.array(high)


def wear_series(
    case: Case,
    *,
    mode: str = "archard",
    steps: int = 6,
    deepest: float | None = None,
    limit: float | None = None,
    band: bool = True,
    draws: int = 4000,
    seed: int = 0,
    quick: bool = True,
    processes: int | None = 1,
    progress: Progress = silent,
) -> WearSeries:
    """Return the numbers of a case from new to worn, and where the fluid's load passes a limit.

    Parameters
    ----------
    case
        A shoe with tread; its own wear is replaced.
    mode
        "archard": contact pressure times sliding at three angles about ``shoe.wear.angle`` (the
        shoe angle of the case where none is given); "plane": ground at that angle; "patch": a worn
        patch at the heel that grows, worn down to the channel floor.
    steps
        Number of worn states.
    deepest
        Thickness lost at the end, m (archard, plane); area of the patch at the end, m^2 (patch).
        By default the depth of the tread (plane), 1.6 times that (archard: a single place is worn
        through first), and a patch of 0.8 of the heel's length and width.
    limit
        Fluid load, N; by default 5 N, the report's limit of detection (G.4).
    band
        Vary the least known inputs at every state: four more runs a state.
    draws, seed
        Of the sampling of the band.
    quick, processes, progress
        As for ``outcomes``; every finished state is kept on disk, so that a stopped series goes on.

    Errors
    ------
    InputError
        A sole without tread; a patch larger than the shoe; wear deeper than the sole.
    """
    if mode not in MODES:
        raise unknown_name("mode", mode, MODES, where="mode")
    if steps < 2:
        raise InputError(f"{steps} steps make no series", where="steps", allowed="2 or more")
    if mode == "archard" and case.shoe.outsole.file is not None:
        raise InputError(
            "wear by pressure and sliding needs a parametric sole",
            where="mode",
            allowed="plane or patch with an outsole file",
        )
    if not _extent(case)[0] > 0:
        raise InputError(
            "the sole has no tread that could wear away",
            where="shoe.tread.pattern",
            remedy="Choose a case with tread; an untreaded sole is worn out already",
        )
    force = case.motion.normal_force
    limit = 5.0 if limit is None else limit
    if not 0 < limit < force:
        raise InputError(
            f"a limit of {limit:g} N is not below the load",
            where="limit",
            allowed=f"above 0 N and below {force:g} N (motion.normal_force)",
        )
    cases = worn_cases(case, mode, steps, deepest)
    inputs = band_inputs(case) if band else []
    plan: list[Case] = []
    for worn in cases:
        plan.append(worn)
        plan += [end for _, _, _, *ends in variants(worn, inputs) for end in ends]
    if mode == "archard":
        _wear_down(plan, progress)
    states = [_measures(worn) for worn in cases]
    found = outcomes(
        plan, quick=quick, processes=processes, progress=progress, stage="Wearing and sliding"
    )
    each = 1 + 2 * len(inputs)
    points = []
    for number, state in enumerate(states):
        own, *ends = found[number * each : (number + 1) * each]
        pairs = zip(inputs, ends[::2], ends[1::2], strict=True)
        points.append(WearPoint(state, own, tuple((one.path, a, b) for one, a, b in pairs)))
    between = measures_between(case, cases, mode, deepest)
    return WearSeries(
        name=case.name,
        mode=mode,
        limit=limit,
        points=tuple(points),
        passings={
            name: passing(points, name, limit, draws=draws, seed=seed, between=between)
            for name in ("fluid_load", "fluid_load_sensor")
        },
        assumptions=_assumptions(cases[-1], mode, inputs),
    )


def worn_cases(case: Case, mode: str, steps: int, deepest: float | None) -> list[Case]:
    """Return the case new and worn in ``steps`` equal steps."""
    depth, heel_length, heel_width = _extent(case)
    angle = case.shoe.wear.angle
    if "shoe.wear.angle" not in case.origins or case.origins["shoe.wear.angle"].kind == "default":
        angle = max(case.motion.shoe_angle, 0.0)
    new = case.replace("shoe.wear.depth", "0 mm")
    cases = [new]
    share = np.arange(1, steps + 1) / steps
    if mode == "patch":
        length, width = heel_length * LARGEST_PATCH, heel_width * LARGEST_PATCH
        if deepest is not None:
            grow = math.sqrt(deepest / (math.pi / 4 * length * width))
            length, width = length * grow, width * grow
        for part in map(float, np.sqrt(share)):
            cases.append(
                new.replace(
                    {
                        "shoe.wear.mode": "patch",
                        "shoe.wear.depth": f"{depth!r} m",
                        "shoe.wear.patch_length": f"{length * part!r} m",
                        "shoe.wear.patch_width": f"{width * part!r} m",
                    }
                )
            )
        return cases
    thickness = case.shoe.sole.outsole_thickness
    end = depth if deepest is None else deepest
    if deepest is None and mode == "archard":
        end = min(BEYOND_TREAD * depth, (depth + thickness) / 2)
    if not 0 < end < thickness:
        raise InputError(
            f"wear of {display(end, 'm')} is deeper than the sole",
            where="deepest",
            allowed=f"above 0 mm and below {display(thickness, 'm')} (shoe.sole.outsole_thickness)",
        )
    for part in map(float, share):
        cases.append(
            new.replace(
                {
                    "shoe.wear.mode": mode,
                    "shoe.wear.depth": f"{end * part!r} m",
                    "shoe.wear.angle": f"{float(angle)!r} rad",
                }
            )
        )
    return cases


def measures_between(
    case: Case, cases: list[Case], mode: str, deepest: float | None
) -> list[WearMeasures]:
    """Return how worn the sole is from new to the end, in ``PARTS`` even parts of each step.

    Between two states of Archard wear the removed thickness is taken as linear.
    """
    steps = len(cases) - 1
    if mode != "archard":
        return [_measures(worn) for worn in worn_cases(case, mode, steps * PARTS, deepest)]
    from underfoot.case.build_sole import archard_state, new_sole
    from underfoot.outsole.worn import WornMap, wear_measures

    new = new_sole(cases[0])
    maps = [archard_state(worn).worn for worn in cases[1:]]
    removed = [np.zeros_like(maps[0].removed), *(worn.removed for worn in maps)]
    found = []
    for place in np.linspace(0, steps, steps * PARTS + 1):
        before = min(int(place), steps - 1)
        share = place - before
        blend = (1 - share) * removed[before] + share * removed[before + 1]
        worn = WornMap(maps[0].x, maps[0].y, blend)
        found.append(wear_measures(cast("SoleShape", replace(cast("Any", new), wear=worn))))
    return found


def band_inputs(case: Case) -> list[OpenInput]:
    """Return the open inputs of the case that the band of the limit is made of."""
    return open_inputs(case, [one for one in OPEN_INPUTS if one.path in BAND_INPUTS])


def _wear_down(cases: list[Case], progress: Progress) -> None:
    """Compute the worn shapes one after the other, so that none is worn twice."""
    from underfoot.case.build_sole import archard_state

    waiting = [worn for worn in cases if worn.shoe.wear.depth > 0]
    waiting.sort(key=lambda worn: worn.shoe.wear.depth)
    for number, worn in enumerate(waiting):
        progress("Wearing the sole", number / len(waiting))
        archard_state(worn)


def _extent(case: Case) -> tuple[float, float, float]:
    """Return depth of the tread, length and width of the heel, m."""
    heel, tread = case.shoe.heel, case.shoe.tread
    if case.shoe.outsole.file is not None:
        from underfoot.case.build_outsole import file_outsole

        surface = file_outsole(case).surface
        # longer than a heel can be: a whole sole or its rear half
        part = HEEL_PART if surface.length > LONGEST_HEEL else 1.0
        width = surface.width if part == 1.0 else WIDTH_OF_HEEL * surface.width
        return float(surface.tread_depth.max()), surface.length * part, width
    depth = 0.0 if tread.pattern == "none" else tread.depth or 0.0
    return depth, heel.length * (HEEL_PART if heel.plan == "sole" else 1.0), heel.width


def _measures(case: Case) -> WearMeasures:
    from underfoot.outsole.worn import surface_wear_measures, wear_measures

    if case.shoe.outsole.file is not None:
        from underfoot.case.build_outsole import file_outsole, file_surface

        return surface_wear_measures(file_outsole(case).surface, file_surface(case))
    from underfoot.case.build_sole import sole_shape

    return wear_measures(sole_shape(case))


def _assumptions(case: Case, mode: str, inputs: list[OpenInput]) -> tuple[str, ...]:
    wear = case.shoe.wear
    found = []
    if mode == "archard":
        low, high = (math.degrees(wear.angle + side * wear.angle_range / 2) for side in (-1, 1))
        found.append(
            f"worn dry at {low:.0f}, {math.degrees(wear.angle):.0f} and {high:.0f} deg with equal "
            "sliding, contact pressure times sliding (Archard); the wear rate sets the way alone"
        )
    elif mode == "plane":
        found.append(f"ground flat at {math.degrees(wear.angle):.0f} deg")
    else:
        found.append(
            f"patch worn to the channel floor, wear tapering off at "
            f"{math.degrees(wear.patch_taper):.0f} deg around it"
        )
    found.append("the worn surface is as rough as the new one")
    for one in inputs:
        found.append(f"band: {one.path}, {one.reason}")
    return tuple(found)
