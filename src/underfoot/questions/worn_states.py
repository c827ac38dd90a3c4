"""Cases of a sole from new to worn, in equal steps, and how worn each is."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.core import InputError, Progress, display
from underfoot.core.remark import Message

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.shoe.worn import WearMeasures

MODES = ("walk", "archard", "plane", "patch")
LARGEST_PATCH = 0.8
"""Largest patch of a series as a share of the heel's length and width."""
BEYOND_TREAD = {"walk": 2.4, "archard": 1.6}
"""Thickness lost at the end of a series, in depths of the tread: where a single place is worn
through, the rest is not."""
PARTS = 6
"""Parts of a step in which the wear is measured, to say how worn the sole is at the limit."""
HEEL_PART = 0.25
"""Share of a whole sole's length that is its heel."""
LONGEST_HEEL, WIDTH_OF_HEEL = 0.12, 0.65
"""m, and the heel's width as a share of a whole sole's (assumed: common lasts)."""


def worn_cases(case: Case, mode: str, steps: int, deepest: float | None) -> list[Case]:
    """Return the case new and worn in ``steps`` equal steps.

    Parameters:
        case: The new shoe.
        mode: Name of an option of ``shoe.wear``.
        steps: Number of equal steps.
        deepest: Wear of the last one, m; m^2 of a patch. None takes what the sole allows.
    """
    depth, heel_length, heel_width = tread_and_heel(case)
    angle = case.value("shoe.wear.angle")
    if angle is None or case.origins["shoe.wear.angle"].kind == "default":
        angle = max(case.motion.shoe_angle, 0.0)
    new = case.replace("shoe.wear.depth", "0 mm")
    share = np.arange(1, steps + 1) / steps
    if mode == "patch":
        length, width = heel_length * LARGEST_PATCH, heel_width * LARGEST_PATCH
        if deepest is not None:
            grow = math.sqrt(deepest / (math.pi / 4 * length * width))
            length, width = length * grow, width * grow
        states = [
            {"depth": depth, "patch_length": length * part, "patch_width": width * part}
            for part in map(float, np.sqrt(share))
        ]
    else:
        thickness = case.shoe.sole.outsole_thickness
        end = depth if deepest is None else deepest
        if deepest is None and mode in BEYOND_TREAD:
            end = min(BEYOND_TREAD[mode] * depth, (depth + thickness) / 2)
        if not 0 < end < thickness:
            most = display(thickness, "m")
            raise InputError(
                Message("wear of {end} is none, or deeper than the sole", end=display(end, "m")),
                where="deepest",
                allowed=Message(
                    "above 0 mm and below {most} (shoe.sole.outsole_thickness)", most=most
                ),
            )
        states = [{"depth": end * part} for part in map(float, share)]
        if mode != "walk":
            states = [{**state, "angle": float(angle)} for state in states]
    changes = [{f"shoe.wear.{key}": value for key, value in state.items()} for state in states]
    return [new, *(new.replace({"shoe.wear.mode": mode, **change}) for change in changes)]


def measures_between(
    case: Case, cases: list[Case], mode: str, deepest: float | None
) -> list[WearMeasures]:
    """Return how worn the sole is from new to the end, in ``PARTS`` even parts of each step.

    Between two states of Archard wear the removed thickness is taken as linear.
    """
    steps = len(cases) - 1
    if mode != "archard":
        return [measures_of(worn) for worn in worn_cases(case, mode, steps * PARTS, deepest)]
    from underfoot.compute.sole import archard_state, new_sole
    from underfoot.shoe.worn import WornMap, wear_measures

    new = new_sole(cases[0])
    maps = [archard_state(worn).worn for worn in cases[1:]]
    removed = [np.zeros_like(maps[0].removed), *(worn.removed for worn in maps)]
    measures = []
    for place in np.linspace(0, steps, steps * PARTS + 1):
        before = min(int(place), steps - 1)
        share = place - before
        blend = (1 - share) * removed[before] + share * removed[before + 1]
        worn = WornMap(maps[0].x, maps[0].y, blend)
        measures.append(wear_measures(new.with_wear(worn)))
    return measures


def wear_down(cases: list[Case], progress: Progress) -> None:
    """Compute the worn shapes one after the other, so that none is worn twice."""
    from underfoot.compute.sole import archard_state

    waiting = [worn for worn in cases if worn.shoe.wear.depth > 0]
    waiting.sort(key=lambda worn: worn.shoe.wear.depth)
    for number, worn in enumerate(waiting):
        progress("Wearing the sole", number / len(waiting))
        archard_state(worn)


def tread_and_heel(case: Case) -> tuple[float, float, float]:
    """Return depth of the tread, length and width of the heel, m."""
    heel: Any = case.shoe.heel
    if case.shoe.outsole is not None:
        from underfoot.compute.sole import file_outsole

        surface = file_outsole(case).surface
        # longer than a heel can be: a whole sole or its rear half
        part = HEEL_PART if surface.length > LONGEST_HEEL else 1.0
        width = surface.width if part == 1.0 else WIDTH_OF_HEEL * surface.width
        return float(surface.tread_depth.max()), surface.length * part, width
    depth = case.value("shoe.tread.depth") or 0.0
    return depth, heel.length * (HEEL_PART if heel.name == "sole" else 1.0), heel.width


def measures_of(case: Case) -> WearMeasures:
    """Return how worn the sole of a case is."""
    from underfoot.shoe.worn import surface_wear_measures, wear_measures

    if case.shoe.outsole is not None:
        from underfoot.compute.sole import file_outsole, file_surface

        return surface_wear_measures(file_outsole(case).surface, file_surface(case))
    from underfoot.compute.sole import sole_shape

    return wear_measures(sole_shape(case))
