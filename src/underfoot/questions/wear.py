"""Friction and film of a case as its sole wears, and when the fluid load exceeds a limit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from underfoot.case.wear import USUAL_WEAR_RATE
from underfoot.compute.sole import bottom_surface
from underfoot.core import InputError, Progress, display, silent, to_si, unknown_name
from underfoot.core.deprecation import renamed_member
from underfoot.core.fields import Fields, labelled_fields
from underfoot.core.presentation import Presentable, Table, percent
from underfoot.core.progress import part
from underfoot.core.remark import NOTHING, Amount, Message, Remark
from underfoot.core.unit_text import tread_unit

from .outcomes import CaseOutcome, outcomes
from .sensitivity import OPEN_INPUTS, OpenInput, open_inputs, variants
from .walked import SOURCES, Walked, WearWalker, WornPair
from .wear_limit import Crossing, LimitCrossing, WearPoint, limit_crossing
from .worn_states import MODES, measures_between, measures_of, tread_and_heel, wear_down, worn_cases

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.shoe import SoleSurface

BAND_INPUTS = ("interface.roughness_beyond_cutoff", "shoe.material.shore_a")
"""What the band of the limit is made of: the least known inputs that decide the film."""
MAPS = {"contact_pressure": "contact pressure", "fluid_pressure": "fluid pressure"}
"""Fields that a series keeps of every state."""
DRAWS = "cof_draws"


EVEN = 5e-4
"""Smallest change of COF that counts: COF is printed with three decimals."""
WORN_REGION = (
    "Beschorner et al., worn region size, 57 shoes (abstract; doi 10.5061/dryad.vmcvdncsk)"
)
SLIGHT_WEAR = "Hemler et al. 2019, five shoes ground at three angles (abstract, Appl. Ergon. 80:35)"
REPORT = "final progress report on shoe-floor friction, G.4.3"
LOADS = {"fluid_load_sensor": "as floor sensors read it", "fluid_load": "under the sole"}
MEASURES = (
    ("removed_depth", "m", "Lost"),
    ("tread_left", "m", "Tread left, least"),
    ("mean_tread_left", "m", "Tread left, mean"),
    ("worn_patch_area", "m^2", "Worn patch"),
    ("removed_volume", "m^3", "Volume lost"),
)
"""Name, SI unit and heading of each measure of wear."""
NUMBERS = (
    ("cof", "1", "COF"),
    ("fluid_load", "N", "Fluid load"),
    ("fluid_load_sensor", "N", "by sensor"),
    ("peak_fluid_pressure", "Pa", "Peak"),
    ("peak_fluid_pressure_sensor", "Pa", "by sensor"),
)
SCREEN = ("removed_depth tread_left worn_patch_area cof fluid_load fluid_load_sensor").split()
"""Measures and numbers in the table; the files have all."""


@dataclass(frozen=True, slots=True)
class Trend:
    """A published direction and ours: rank correlation over the states of the series.

    ``correlation`` is None where the series is too short or does not change.
    """

    finding: str
    source: str
    correlation: float | None
    agrees: bool | None

    @property
    def verdict(self) -> Message:
        """Whether ours agrees, and how sure that is."""
        verdict = {None: "not testable on this series", True: "agrees", False: "disagrees"}
        if self.correlation is None:
            return Message.plain(verdict[self.agrees])
        return Message(
            "{verdict} (rank correlation {rank:.2f})",
            verdict=verdict[self.agrees], rank=self.correlation,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class WearSeries(Presentable):
    """A case over its wear.

    ``limit`` is the fluid load (N) that counts as worn out; ``crossings`` has, for the load under
    the sole ("fluid_load") and as the floor sensors read it ("fluid_load_sensor"), the wear at
    which it is exceeded. ``untreaded`` is the last state without any tread; None where the sole
    comes from a file. ``soles`` are the bottoms of the states in their own frame, the last that of
    ``untreaded``, ``maps`` the pressures (Pa) on their cells by name, those of the case's own
    position of the tread. ``walker`` turns the volume lost into a distance.
    """

    kind: ClassVar[str] = "wear"

    name: str
    mode: str
    limit: float
    points: tuple[WearPoint, ...]
    crossings: dict[str, LimitCrossing]
    assumptions: tuple[Message, ...]
    quick: bool = True
    untreaded: CaseOutcome | None = None
    soles: tuple[SoleSurface, ...] = ()
    maps: tuple[dict[str, np.ndarray], ...] = ()
    walker: WearWalker | None = None

    def __repr__(self) -> str:
        return f"<WearSeries of {self.name!r}, {self.mode}: {len(self.points)} states>"

    @property
    def usable(self) -> bool:
        return any(point.outcome.usable for point in self.points)

    def heading(self) -> str:
        return Message(
            "{name}: friction and film with wear ({mode})", name=self.name, mode=self.mode
        )

    def headline(self) -> tuple[Message, ...]:
        sentences = [self._crossing(name) for name in LOADS]
        if (cof := self._cof()) is not None:
            sentences.append(cof)
        if walks := self.walks():
            measured = self.walker is not None and self.walker.pair is not None
            life = Message("life not estimated without a worn pair (--worn-pair)")
            volume = _size(float(self.wear_measures("removed_volume")[-1]), "m^3")
            sentences.append(
                Message(
                    "The last state has lost {volume}: {life}.",
                    volume=volume, life=walks[-1].text if measured else life,
                )
            )  # fmt: skip
        return tuple(sentences)

    def _cof(self) -> Message | None:
        """Return the COF at both ends of the series and without tread; None where none is known."""
        cof, bare = self.values("cof"), math.nan
        if self.untreaded is not None:
            bare = self.untreaded.number("cof")
        known = np.flatnonzero(np.isfinite(cof))
        if known.size < 2:
            if math.isnan(bare):
                return None
            return Message("COF {bare:.3f} if that sole had no tread at all.", bare=bare)
        start, end = known[[0, -1]]
        values = {"first": cof[start], "last": cof[end], "sure": self._sure()}
        if known.size == cof.size and bare < cof[start] < cof[end]:
            return Message(
                "COF {first:.3f} new and {bare:.3f} with the tread gone; shortly before that "
                "{last:.3f}{sure}, no reason to wear it down.",
                **values, bare=bare,
            )  # fmt: skip
        without = NOTHING
        if math.isfinite(bare):
            without = Message("; {bare:.3f} if that sole had no tread at all", bare=bare)
        if (start, end) != (0, cof.size - 1):
            return Message(
                "COF {first:.3f} at state {start} and {last:.3f} at state {end}{sure}{without}.",
                **values, start=start, end=end, without=without,
            )  # fmt: skip
        return Message(
            "COF {first:.3f} new and {last:.3f} at the last state{sure}{without}.",
            **values, without=without,
        )  # fmt: skip

    def curve(self, name: str) -> np.ndarray:
        """Return a number of every state that is drawn: those of ``values``, then without tread."""
        bare = [] if self.untreaded is None else [self.untreaded.number(name)]
        return np.append(self.values(name), bare)

    def _sure(self) -> Message:
        """Return the probability that COF changes as computed; nothing where it is not known."""
        outcomes = [point.outcome for point in self.points if point.outcome.usable]
        new, worn = (outcomes[k].maps.get(DRAWS) for k in (0, -1))
        if new is None or worn is None:
            return NOTHING
        if outcomes[-1].number("cof") < outcomes[0].number("cof"):
            chance = percent(float(np.mean(worn < new)))
            return Message(" (lower with a probability of {chance})", chance=chance)
        chance = percent(float(np.mean(worn > new)))
        return Message(" (higher with a probability of {chance})", chance=chance)

    def walks(self) -> list[Walked]:
        """Return how far one walks to each state; empty without a walker."""
        if self.walker is None:
            return []
        volumes, lost = (
            self.wear_measures(name).tolist() for name in ("removed_volume", "removed_depth")
        )
        return [self.walker.walk_until(volume, volumes, lost) for volume in volumes]

    walked = renamed_member("walked", "walks", gone="0.4")

    def cautions(self) -> tuple[Message, ...]:
        reasons: list[Message] = []
        cof = self.values("cof")
        ends = np.isfinite(cof[-1]) and self.untreaded is None  # else there may be none to compare
        if ends and cof[-1] > 1.05 * np.nanmin(cof) and cof[-1] == np.nanmax(cof):
            reasons.append(
                Message(
                    "The COF still rises at the last state: its fall lies beyond the range (--to)."
                )
            )
        failed = [k for k, point in enumerate(self.points) if not point.outcome.usable]
        if failed:
            reasons.append(Message("No result for state {failed} (0 is new).", failed=failed))
        if self.walker is not None and self.walker.pair is not None:
            reasons.append(
                Message("Distance walked: from the measured pair, for its wearer and floors.")
            )
        if self.quick:
            reasons.append(Message("Coarse grid (--full for the fine one)."))
        return tuple(reasons)

    def table(self) -> Table:
        measures = [each for each in MEASURES if each[0] in SCREEN]
        numbers = [each for each in NUMBERS if each[0] in SCREEN]
        states = [
            ([getattr(point.measures, name) for name, *_ in measures], point.outcome)
            for point in self.points
        ]
        if self.untreaded is not None:  # as worn as the last state, without any tread
            bare = {"removed_depth": self.points[-1].measures.removed_depth, "tread_left": 0.0}
            states.append(([bare.get(name, math.nan) for name, *_ in measures], self.untreaded))
        rows = []
        for worn, outcome in states:
            values = [*worn, *(outcome.number(name) for name, *_ in numbers)]
            units = [unit for _, unit, _ in (*measures, *numbers)]
            shown = [v / tread_unit(unit)[0] for v, unit in zip(values, units, strict=True)]
            rows.append(["not determined" if math.isnan(v) else _short(v) for v in shown])
        heads = tuple(
            label
            if unit == "1"
            else Message("{label} ({unit})", label=label, unit=_unit_name(unit))
            for _, unit, label in (*measures, *numbers)
        )
        walks = self.walks()
        if walks and self.walker and self.walker.pair:
            distances = [*(walk.text for walk in walks), *[""] * (len(rows) - len(walks))]
            heads = (*heads, "Walked")
            rows = [[*row, walked] for row, walked in zip(rows, distances, strict=True)]
        return Table("States of wear, new to worn", heads, rows)

    def tables(self) -> tuple[Table, ...]:
        rows = [(trend.finding, trend.verdict, trend.source) for trend in trends(self)]
        beside = Table("Published trends", ("Finding", "This series", "Source"), rows)
        return self.table(), beside

    def remarks(self) -> dict[str, Sequence[str]]:
        return {"Assumptions": self.assumptions}

    def to_dict(self) -> dict[str, Any]:
        def finite(value: float) -> float | None:
            return value if math.isfinite(value) else None

        return {
            "mode": self.mode,
            "limit_N": self.limit,
            "states": [
                {
                    **asdict(point.measures),
                    **{name: finite(point.outcome.number(name)) for name, *_ in NUMBERS},
                    "status": str(point.outcome.status),
                    **walk,
                }
                for point, walk in zip(self.points, self._walks(), strict=True)
            ],
            "crossings": {
                name: {
                    "crossing": str(each.crossing),
                    "share_of_draws": finite(each.share),
                    **{
                        measure: [finite(part[measure]) for part in (each.at, each.low, each.high)]
                        for measure in each.at
                    },
                }
                for name, each in self.crossings.items()
            },
            "untreaded_cof": None
            if self.untreaded is None
            else finite(self.untreaded.number("cof")),
            "trends": [asdict(trend) for trend in trends(self)],
            "assumptions": list(self.assumptions),
        }

    def data_tables(self) -> dict[str, Table]:
        heads = [f"{name}_{unit.replace('^', '')}" for name, unit, _ in MEASURES]
        for name, unit, *_ in NUMBERS:
            heads += [f"{name}_{unit}", f"{name}_low", f"{name}_high"]
        ends = {name: self.ends(name) for name, *_ in NUMBERS}
        rows = []
        walks = self._walks()
        for k, point in enumerate(self.points):
            row = [getattr(point.measures, name) for name, *_ in MEASURES]
            for name, *_ in NUMBERS:
                row += [point.outcome.number(name), *(float(end[k]) for end in ends[name])]
            rows.append((*row, str(point.outcome.status), *walks[k].values()))
        return {"wear": Table("", (*heads, "status", *walks[0]), rows)}

    def _walks(self) -> list[dict[str, float]]:
        """Return the distance (m) and months to each state by name; nothing without a walker."""
        names = ("walked_low_m", "walked_high_m", "months_low", "months_high")
        ends = [(*walk.distance, *walk.months) for walk in self.walks()]
        return [dict(zip(names, end, strict=True)) for end in ends] or [{} for _ in self.points]

    def values(self, name: str) -> np.ndarray:
        """Return a number of all points in SI, nan where it was not determined."""
        return np.array([point.outcome.number(name) for point in self.points])

    def wear_measures(self, name: str) -> np.ndarray:
        """Return a measure of wear of all points in SI."""
        return np.array([getattr(point.measures, name) for point in self.points])

    measured = renamed_member("measured", "wear_measures", gone="0.4")

    def ends(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Return the lowest and highest value of a number over the open inputs, per point."""
        ends = []
        for point in self.points:
            varied = (each for _, *pair in point.variants for each in pair)
            values = [outcome.number(name) for outcome in (point.outcome, *varied)]
            known = [value for value in values if not math.isnan(value)] or [math.nan]
            ends.append((min(known), max(known)))
        low, high = np.array(ends).T
        return low, high

    def fields(self) -> Fields:
        """Return soles and pressures of all states on (state, x, y) in their own frame, SI."""
        axes, first, count = ("state", "x", "y"), self.soles[0], len(self.points)
        shapes = {
            "height": ("m", "height of the sole over its plane"),
            "land": ("1", "can touch the floor"),
            "tread_depth": ("m", "height of the lugs"),
        }
        variables: dict[str, tuple[Any, ...]] = {
            name: (
                axes,
                np.stack([getattr(sole, name) for sole in self.soles[:count]]),
                {"units": unit, "long_name": title},
            )
            for name, (unit, title) in shapes.items()
        }
        for name in self.maps[0] if self.maps else ():
            values = np.stack([each[name] for each in self.maps[:count]]).astype(np.float32)
            variables[name] = (axes, values, {"units": "Pa", "long_name": MAPS[name]})
        lost = {"units": "m", "long_name": "thickness lost at the most worn place"}
        return labelled_fields(
            variables,
            {
                "state": ("state", self.wear_measures("removed_depth"), lost),
                "x": ("x", first.x, {"units": "m", "long_name": "from the rear end"}),
                "y": ("y", first.y, {"units": "m", "long_name": "across"}),
            },
        )

    def _crossing(self, name: str) -> Message:
        crossing, part = self.crossings[name], LOADS[name]
        share = NOTHING
        if self.points[0].variants and math.isfinite(crossing.share):
            share = Message(
                " ({share} of the draws exceed it within the range)", share=percent(crossing.share)
            )
        if crossing.crossing is Crossing.UNKNOWN:
            return Message("The fluid load {part} was not determined.", part=part)
        values = {"part": part, "limit": self.limit}
        if crossing.crossing is Crossing.FROM_NEW:
            return Message("The fluid load {part} exceeds {limit:g} N already when new.", **values)
        if crossing.crossing is Crossing.NEVER:
            return Message(
                "The fluid load {part} stays below {limit:g} N within the range{share}.",
                **values, share=share,
            )  # fmt: skip
        tread, patch = (
            [each[measure] for each in (crossing.at, crossing.low, crossing.high)]
            for measure in ("tread_left", "worn_patch_area")
        )
        area = NOTHING
        if any(each > 0 for each in patch):
            area = Message(" and a worn patch of {patch}", patch=_interval(patch, "m^2"))
        return Message(
            "The fluid load {part} exceeds {limit:g} N with {tread} of tread left at the most worn "
            "place{area}{share}.",
            **values, tread=_interval(tread, "m"), area=area, share=share,
        )  # fmt: skip


def wear_series(
    case: Case,
    *,
    mode: str = "walk",
    steps: int = 6,
    deepest: float | None = None,
    limit: float | None = None,
    band: bool = True,
    draws: int = 4000,
    seed: int = 0,
    pair: WornPair | None = None,
    quick: bool = True,
    processes: int | None = 1,
    progress: Progress = silent,
) -> WearSeries:
    """Return a case from new to worn, and the wear at which its fluid load exceeds a limit.

    Parameters:
        case: A shoe with tread; its own wear is replaced.
        mode: "walk": cut by the floor at the angles from heel contact to flat; "archard": contact
            pressure times sliding at three angles about ``shoe.wear.angle`` (the shoe angle of the
            case where none is given); "plane": ground at that angle; "patch": a worn patch at the
            heel that grows, worn down to the channel floor.
        steps: Number of worn states.
        deepest: Thickness lost at the end, m; of a patch its area at the end, m^2. By default the
            depth of the tread (plane), 2.4 or 1.6 times that (walk, archard: a single place is
            worn through first), and a patch of 0.8 of the heel's length and width.
        limit: Fluid load, N; by default 5 N, the report's limit of detection (G.4).
        band: Vary the least known inputs at every state: four more runs a state.
        draws, seed: Of the sampling of the band.
        pair: A measured pair that the distance walked is taken from; else the wear rate of the
            case (``shoe.wear`` of mode "archard"), or its default.
        quick, processes, progress: As for ``outcomes``; every finished state is kept on disk, so
            that a stopped series goes on.

    Raises:
        InputError: A sole without tread; a patch larger than the shoe; wear deeper than the sole.
    """
    if mode not in MODES:
        raise unknown_name("mode", mode, MODES, where="mode")
    if steps < 2:
        raise InputError(
            Message("{steps} steps make no series", steps=steps), where="steps", allowed="2 or more"
        )
    if mode == "archard" and case.shoe.outsole is not None:
        raise InputError(
            "wear by pressure and sliding needs a parametric sole",
            where="mode",
            allowed="walk, plane or patch with an outsole file",
        )
    if not tread_and_heel(case)[0] > 0:
        raise InputError(
            "the sole has no tread to wear",
            where="shoe.tread.pattern",
            remedy="Choose a case with tread; an untreaded sole counts as worn out",
        )
    force = case.motion.normal_force
    limit = 5.0 if limit is None else limit
    if not 0 < limit < force:
        raise InputError(
            Message("a limit of {limit:g} N is not below the load", limit=limit),
            where="limit",
            allowed=Message("above 0 N and below {force:g} N (motion.normal_force)", force=force),
        )
    cases = worn_cases(case, mode, steps, deepest)
    if pair is not None and pair.lost > (end := cases[-1].shoe.wear.depth) * (1 + 1e-9):
        raise InputError(
            Message(
                "the pair has lost {lost}, the series ends at {end}",
                lost=display(pair.lost, "m"),
                end=display(end, "m"),
            ),
            where="pair",
            remedy="Let the series go on (--to).",
        )
    inputs = open_inputs(case, [each for each in OPEN_INPUTS if each.path in BAND_INPUTS])
    inputs = inputs if band else []
    plan: list[Case] = []
    for worn in cases:
        plan += [worn, *(end for *_, low, high in variants(worn, inputs) for end in (low, high))]
    parametric = case.shoe.outsole is None
    bare = [cases[-1].replace("shoe.tread.pattern", "none")] if parametric else []
    shaped = 0.0
    if mode == "archard":
        shaped = 0.1
        wear_down(plan, part(progress, 0.0, shaped))
    results = outcomes(
        [*plan, *bare],
        quick=quick,
        maps=(*MAPS, DRAWS),
        processes=processes,
        progress=part(progress, shaped, 1.0),
        stage="Simulating the worn soles",
    )
    per_state = 1 + 2 * len(inputs)
    points = []
    for number, worn in enumerate(cases):
        middle, *ends = results[number * per_state : (number + 1) * per_state]
        pairs = zip(inputs, ends[::2], ends[1::2], strict=True)
        varied = tuple((each.path, low, high) for each, low, high in pairs)
        points.append(WearPoint(measures_of(worn), middle, varied))
    between = measures_between(case, cases, mode, deepest)
    soles = tuple(map(bottom_surface, [*cases, *bare]))
    shown = [*(point.outcome for point in points), *results[len(plan) :]]
    angle = case.motion.shoe_angle
    return WearSeries(
        name=case.name,
        mode=mode,
        limit=limit,
        points=tuple(points),
        crossings={
            name: limit_crossing(points, name, limit, draws=draws, seed=seed, between=between)
            for name in LOADS
        },
        assumptions=(*_assumptions(cases[-1], mode, inputs), *_replaced_wear_note(case)),
        quick=quick,
        untreaded=results[-1] if bare else None,
        walker=WearWalker(case.value("shoe.wear.wear_rate") or USUAL_WEAR_RATE, pair),
        soles=soles,
        maps=tuple(
            maps_on_sole(sole, outcome, angle) for sole, outcome in zip(soles, shown, strict=True)
        ),
    )


def maps_on_sole(
    sole: SoleSurface, outcome: CaseOutcome, shoe_angle: float
) -> dict[str, np.ndarray]:
    """Return the maps of an outcome on the cells of its sole in the sole's own frame, (nx, ny).

    Each cell has the value of the nearest one over the floor: nan outside the sole, beside the part
    that was solved, and where there is no result.
    """
    from underfoot.shoe import place_on_floor

    along, across = outcome.maps["x"], outcome.maps["y"]
    side = along[1] - along[0]
    i = np.rint((place_on_floor(sole, shoe_angle) - along[0]) / side).astype(int)
    j = np.broadcast_to(np.rint((sole.y - across[0]) / side).astype(int), i.shape)
    covered = sole.inside & (i >= 0) & (i < along.size) & (j >= 0) & (j < across.size)
    covered &= outcome.usable
    fields = {}
    for name in MAPS:
        fields[name] = np.full(i.shape, np.nan)
        fields[name][covered] = outcome.maps[name][i[covered], j[covered]]
    return fields


def wear_mode(mode: str | None, case: Case) -> str:
    """Return the kind of wear: the given one, or walking."""
    if mode is None:
        return MODES[0]
    if mode not in MODES:
        raise unknown_name("mode", mode, MODES, where="--mode")
    return mode


def limit_load(text: str, normal_force: float) -> float:
    """Return a limit in N from a force ("5 N") or a share of the normal force ("20 %")."""
    if text.strip().endswith("%"):
        load = to_si(text, "1", where="--limit") * normal_force
    else:
        load = to_si(text, "N", where="--limit")
    if load < 0:
        raise InputError(
            f'"{text}" is not a load',
            where="--limit",
            allowed='a force or a share, as "5 N" or "20 %"',
        )
    return load


def deepest_wear(text: str | None, mode: str) -> float | None:
    """Return the last state of a series from text: area of the patch (m^2) or depth (m)."""
    if text is None:
        return None
    return to_si(text, "m^2" if mode == "patch" else "m", where="--to")


def _replaced_wear_note(case: Case) -> tuple[Message, ...]:
    """Return that the wear of the case itself counts for nothing; empty of a new shoe."""
    depth = case.shoe.wear.depth
    if depth == 0:
        return ()
    return (
        Message(
            "the series begins with the new sole: shoe.wear.depth = {depth} counts for nothing",
            depth=Amount(depth, "m"),
        ),
    )


def _assumptions(case: Case, mode: str, inputs: list[OpenInput]) -> tuple[Message, ...]:
    wear: Any = case.shoe.wear  # the option that ``mode`` names
    if mode == "archard":
        low, high = (math.degrees(wear.angle + side * wear.angle_range / 2) for side in (-1, 1))
        shape = Message(
            "worn dry at {low:.0f}, {angle:.0f} and {high:.0f} deg with equal sliding, depth "
            "proportional to pressure times sliding (Archard); the wear rate sets the sliding "
            "distance only",
            low=low, angle=math.degrees(wear.angle), high=high,
        )  # fmt: skip
    elif mode == "walk":
        shape = Message(
            "cut by the floor at every angle from heel contact to flat, in proportion to the load "
            "that ten recorded steps bear there; equal sliding at each"
        )
    elif mode == "plane":
        shape = Message("ground flat at {angle:.0f} deg", angle=math.degrees(wear.angle))
    else:
        shape = Message(
            "patch worn to the channel floor, wear tapering off at {angle:.0f} deg around it",
            angle=math.degrees(wear.patch_taper),
        )
    return (
        shape,
        Message("the worn surface is as rough as the new one"),
        SOURCES,
        Message(
            "wear rounds the edges of lugs by up to {radius} (shoe.wear.edge_radius; nobody "
            "measured it, 0.1 to 0.5 mm are plausible)",
            radius=Amount(wear.edge_radius, "m"),
        ),
        *(
            Remark("interval", "{path}, {reason}", path=each.path, reason=each.reason)
            for each in inputs
        ),
    )


def trends(series: WearSeries) -> list[Trend]:
    """Return published trends with worn shoes beside those of the series.

    Those of worn regions are ranked over the states that have one, and the last one without.
    """
    patch = series.wear_measures("worn_patch_area")
    worn_region = slice(max(int(np.count_nonzero(patch == 0)) - 1, 0), None)
    patch, peak, friction = (
        values[worn_region]
        for values in (patch, series.values("peak_fluid_pressure_sensor"), series.values("cof"))
    )
    new, worn = series.values("fluid_load_sensor")[[0, -1]]
    half = series.values("fluid_load_sensor")[: max(2, (len(series.points) + 1) // 2)]
    rows = [
        _rank("a larger worn region goes with a higher peak fluid pressure", patch, peak, 1),
        _rank("a higher peak fluid pressure goes with less available friction", peak, friction, -1),
    ]
    rows.append(Trend("friction first rises, then falls", SLIGHT_WEAR, None, _rises_first(series)))
    late = None
    if np.isfinite([new, worn]).all() and worn > new:
        # the rise over the first half of the wear against that over all of it
        late = bool(np.nanmax(half) - new < 0.5 * (worn - new))
    finding = "little changes until a threshold of wear, then fluid pressure rises steeply"
    rows.append(Trend(finding, REPORT, None, late))
    return rows


def _rises_first(series: WearSeries) -> bool | None:
    """Return whether the COF is highest in between and falls from there to the end.

    What differs by less than ``EVEN`` neither rises nor falls.
    """
    cof = series.curve("cof")
    if not np.isfinite(cof).all():
        return None
    highest = int(cof.argmax())
    up, down = cof[highest] - cof[0], cof[highest] - cof[-1]
    return bool(min(up, down) > EVEN and (np.diff(cof[highest:]) < EVEN).all())


def _rank(finding: str, x: np.ndarray, y: np.ndarray, sign: int) -> Trend:
    from scipy.stats import spearmanr

    known = np.isfinite(x) & np.isfinite(y)
    if known.sum() < 3 or np.ptp(x[known]) == 0 or np.ptp(y[known]) == 0:
        return Trend(finding, WORN_REGION, None, None)
    value = float(np.asarray(spearmanr(x[known], y[known]))[0])
    return Trend(finding, WORN_REGION, value, value * sign > 0)


def _short(value: float) -> str:
    """Return a number with three figures, without decimals where it is large."""
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"


def _unit_name(unit: str) -> str:
    """Return the name of the unit in which sizes of a tread are given."""
    return tread_unit(unit)[1].replace("^2", "²").replace("^3", "³")


def _size(value: float, unit: str) -> str:
    return f"{_short(value / tread_unit(unit)[0])} {_unit_name(unit)}"


def _interval(values: Sequence[float], unit: str) -> Message:
    value, *ends = values
    factor, _ = tread_unit(unit)
    low, high = ("beyond the range" if math.isinf(e) else _short(e / factor) for e in ends)
    return Message("{size} (90 %: {low} to {high})", size=_size(value, unit), low=low, high=high)
