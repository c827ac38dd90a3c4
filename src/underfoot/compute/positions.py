"""A tread, not one position of it: the answer averaged over where its lugs happen to lie."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from underfoot.case import Case
from underfoot.core import SourcedValue, display
from underfoot.core.arrays import Array
from underfoot.friction import FrictionCoefficients, SampledCof
from underfoot.shoe import Tread
from underfoot.sole_contact.cost import Cost
from underfoot.sole_contact.solver import SoleContact

from .contact_friction import friction_sums
from .cost import cost
from .numbers import scalars
from .prepare import Prepared
from .sensors import scanned
from .sole import file_surface, tread_on_sole
from .steadiness import later_numbers

ANGLE_BAND = math.radians(1)
"""The shoe angle lies evenly within this of the case's, rad; assumed: how well an upper is held."""
ANGLE_DEVIATION = ANGLE_BAND / math.sqrt(3)
"""Standard deviation of that band, rad."""
GOLDEN = (math.sqrt(5) - 1) / 2
LANDING = 0.1e-3
"""What lies at most this above the lowest quarter of a sole lands first, m."""
FINEST = 0.25e-3
"""Cells that numbers under lugs are carried on to, m: the finest they were compared with."""
CARRIED = ("fluid_load", "cof_adhesion", "cof_hysteresis", "cof_viscous")
RATES = {1: 1.0, 2: 0.75}
"""Rate of the rule of positions by the number of periods of the tread, where the film jumps with
the place (docs/physics/coupled_contact.md)."""
_HELD = "spread of the friction law, its inputs and the"


@dataclass(frozen=True, slots=True)
class Place:
    """Where a tread lies: its pattern shifted by (x, y), m, the shoe turned by ``turn``, rad."""

    shift: tuple[float, float] = (0.0, 0.0)
    turn: float = 0.0


@dataclass(frozen=True, slots=True)
class TreadPositions:
    """Numbers of a run at some positions of the tread.

    Attributes:
        places: Of the pattern and the shoe.
        values: Name of a result's scalar: its value at each place, SI.
        left_out: Number of positions that did not converge.
        at_own_place: The scalars at the case's own place, on the grid of the run.
        between: Name of a scalar: what the difference of two grids leaves unknown of its mean.
        by_angle: Name of a scalar: what ``ANGLE_DEVIATION``, toe up, adds to its value at the
            case's own place; empty where that is not known or in the values.
    """

    origin: ClassVar[str] = "tread_position"
    held: ClassVar[str] = "position of the tread"
    several: ClassVar[str] = "positions of the tread"

    places: tuple[Place, ...]
    values: Mapping[str, Array]
    left_out: int
    at_own_place: Mapping[str, float]
    between: Mapping[str, float] = field(default_factory=dict, kw_only=True)
    by_angle: Mapping[str, float] = field(default_factory=dict, kw_only=True)

    def answer(self, name: str) -> float:
        """Return the scalar of the result: its mean over the places."""
        return float(self.values[name].mean())

    def drawn(self, name: str, count: int) -> Array:
        """Return the scalar (count,) at each place in turn, evenly over the band of the angle."""
        at = np.arange(count)
        turns = math.sqrt(3) * (2 * np.mod(GOLDEN * at, 1) - 1)
        values = self.values[name][at % len(self.places)]
        return np.maximum(values + self.by_angle.get(name, 0.0) * turns, 0)

    def friction(
        self, friction: FrictionCoefficients, sampled: SampledCof | None
    ) -> tuple[FrictionCoefficients, SampledCof | None]:
        """Return COF and its draws over the positions, which the draws take in turn."""
        values = {name: values for name, values in self.values.items() if name.startswith("cof")}
        new = {name: replace(getattr(friction, name), value=self.answer(name)) for name in values}
        if sampled is not None:
            draws = {}
            for name in values:
                part = name.removeprefix("cof_")
                own = self.at_own_place[name]
                factors = self.drawn(name, sampled.cof.size) / own if own else 1.0
                draws[part] = getattr(sampled, part) * factors
            draws["cof"] = draws["adhesion"] + draws["hysteresis"] + draws["viscous"]
            more = {self.origin: float(np.var(values["cof"]))}
            if self.by_angle:
                more["shoe_angle"] = self.by_angle["cof"] ** 2
            law_variance = float(np.var(sampled.cof))
            whole = law_variance + sum(more.values())
            share = {name: each * law_variance / whole for name, each in sampled.share.items()}
            share |= {name: each / whole for name, each in more.items()}
            sampled = replace(sampled, share=share, **draws)
            for name, value in new.items():
                if value.uncertainty is not None:  # what the law leaves open stays open
                    new[name] = sampled.sourced(name.removeprefix("cof_"), value)
            new["cof"] = replace(new["cof"], note=f"{_HELD} {self.held}")
        load = self.answer("fluid_load")
        force = self.answer("cof") * friction.normal_force
        return replace(friction, **new, fluid_load=load, friction_force=force), sampled

    def averaged(self, numbers: Mapping[str, SourcedValue]) -> dict[str, SourcedValue]:
        """Return the numbers with means over the positions, and the spread of COF over them."""
        means = dict(numbers)
        if len(self.places) == 1:
            return means
        for name in self.values:
            if not name.startswith("cof"):
                means[name] = replace(numbers[name], value=self.answer(name))
        over = f"over {len(self.places)} {self.several}"
        means["fluid_load"] = replace(
            means["fluid_load"], note=f"{self._range('fluid_load', 'N')} {over}"
        )
        means[f"cof_{self.origin}"] = SourcedValue(
            float(np.std(self.values["cof"])),
            source=f"contact and film at another {self.held}",
            reason="itself a standard deviation",
            note=f"{self._range('cof')} {over}",
        )
        if self.by_angle:
            means["cof_shoe_angle"] = SourcedValue(
                abs(self.by_angle["cof"]),
                source="contact and film with the shoe turned",
                reason="itself a standard deviation",
            )
        return means

    def labels(self) -> dict[str, str]:
        """Return what was averaged in words."""
        failed = f"{self.left_out} did not converge and are left out" if self.left_out else ""
        told = {}
        if failed:
            told["positions_left_out"] = (
                f"{self.left_out} of {self.left_out + len(self.places)} positions of the tread did "
                "not converge. Most such positions float: COF may be lower and the load on the "
                "film higher than the means over the others."
            )
        if len(self.places) == 1:
            return {"tread_position": f"as the case describes it; {failed} of the average", **told}
        cof, load = self.at_own_place["cof"], self.at_own_place["fluid_load"]
        if not self.by_angle:
            told["angle_as_exact"] = (
                "The shoe could not be solved turned: its angle counts as exact, and the interval "
                "is too narrow."
            )
        else:
            up = display(math.degrees(ANGLE_DEVIATION), "1")
            more, film = (self.by_angle[name] for name in ("cof", "fluid_load"))
            told["shoe_angle"] = (
                f"{up} deg toe up, one standard deviation of it, moves COF by "
                f"{display(more, '1')} and the load on the film by {display(film, 'N')}"
            )
        return {
            "tread_position": f"COF {self._range('cof')}, load on the film "
            f"{self._range('fluid_load', 'N')} over {len(self.places)} positions of the tread. "
            f"Numbers are means over them; maps and histories show the position that the case "
            f"describes (COF {display(cof, '1')}, {display(load, 'N')} on the film)"
            + (f"; {failed}" if failed else ""),
            **told,
        }

    def assumptions(self) -> tuple[str, ...]:
        """Return the band of the shoe angle, where it was used."""
        angle = bool(self.by_angle) or any(place.turn for place in self.places)
        return ("motion.shoe_angle: ±1 deg",) * angle

    def fields(self) -> dict[str, Any]:
        """Return the variables of a data set: where the positions are, COF and load there."""

        def at(values: Any, unit: str, name: str, **more: float) -> tuple[str, Any, dict[str, Any]]:
            return ("tread_position", values, {"units": unit, "long_name": name, **more})

        cof, film = ({"as_described": self.at_own_place[n]} for n in ("cof", "fluid_load"))
        shift = np.array([place.shift for place in self.places])
        return {
            "position_shift_x": at(shift[:, 0], "m", "shift of the tread's pattern, forward"),
            "position_shift_y": at(shift[:, 1], "m", "shift of the tread's pattern, across"),
            "position_cof": at(self.values["cof"], "1", "coefficient of friction", **cof),
            "position_fluid_load": at(self.values["fluid_load"], "N", "load on the film", **film),
        }

    def _range(self, name: str, unit: str = "1") -> str:
        values = self.values[name]
        return f"{display(values.min(), unit)} to {display(values.max(), unit)}"


@dataclass(frozen=True, slots=True)
class ShoeAngles(TreadPositions):
    """Numbers of a run of a sole without lugs at its own shoe angle and beside it."""

    origin = "shoe_angle"
    held = "shoe angle"
    several = "shoe angles"

    def labels(self) -> dict[str, str]:
        """Return what the interval holds in words."""
        if len(self.places) == 1:
            return {}
        least, most = (math.degrees(bound([p.turn for p in self.places])) for bound in (min, max))
        cof, load = self.at_own_place["cof"], self.at_own_place["fluid_load"]
        return {
            "shoe_angle": f"COF {self._range('cof')}, load on the film "
            f"{self._range('fluid_load', 'N')} from {least:.1f} to +{most:.1f} deg beside the "
            "case's angle. Numbers are means over them; maps and histories show the case's angle "
            f"(COF {display(cof, '1')}, {display(load, 'N')} on the film)"
        }

    def fields(self) -> dict[str, Any]:
        """Return the variables of a data set: the angles, COF and load there."""
        fields = super(ShoeAngles, self).fields()
        turn = [place.turn for place in self.places]
        about = {"units": "rad", "long_name": "change of the shoe angle"}
        kept = {name: each for name, each in fields.items() if "shift" not in name}
        return {"position_turn": ("tread_position", turn, about), **kept}


def shoe_angles() -> tuple[Place, ...]:
    """Return the case's own shoe angle and one on each side, of the variance of ``ANGLE_BAND``."""
    turn = ANGLE_BAND / math.sqrt(2)
    return Place(), Place(turn=turn), Place(turn=-turn)


TURNED = (Place(turn=ANGLE_DEVIATION), Place(turn=-ANGLE_DEVIATION))
"""The shoe turned toe up and toe down, the tread as it lies."""


def places(periods: Array, count: int, begin: Array | None = None) -> tuple[Place, ...]:
    """Return ``count`` places of a pattern with the periods (n, 2), m.

    The first at ``begin``, shares (n,) of the periods; at rest without. Even along the first period
    and along a second, where they follow the order of golden shares: no low wave across both meets
    all of them in one phase, as it meets those of a lattice of 4 or 6. All at the shoe angle of the
    case: the film under bars is a saw-tooth along their period whose teeth the angle moves, and
    positions that have other angles leave a larger error of its mean.
    """
    order = np.argsort(np.argsort(np.mod(GOLDEN * np.arange(count), 1)))
    shares = np.column_stack([np.arange(count), order])[:, : len(periods)] / count
    if begin is not None:
        shares = np.mod(shares + begin, 1)
    return tuple(Place((float(x), float(y))) for x, y in shares @ periods)


def case_places(case: Case, *, quick: bool) -> tuple[Place, ...]:
    """Return the places of a run of a treaded sole.

    The pattern begins at the front of what lands first, where the teeth of its film lie: so all
    treads meet them in nearly one phase, wherever they were drawn and however wide their lugs are.
    """
    periods, begin, x, height = tread_on_sole(case)
    clearance = height + math.tan(case.motion.shoe_angle) * x
    over = np.nan_to_num(clearance, nan=math.inf) - np.nanquantile(clearance, 0.25) - LANDING
    last = int(np.flatnonzero(over < 0)[-1])
    front = np.interp(0.0, over[last : last + 2], x[last : last + 2])
    at_front = np.array([front, 0.0]) @ np.linalg.pinv(periods)
    return places(periods, position_count(case, quick=quick), at_front - begin)


def tread_positions(
    case: Case,
    known: Mapping[Place, Mapping[str, float]],
    at_places: Callable[
        [Sequence[tuple[Place, float]]], Iterator[tuple[int, Mapping[str, float] | None]]
    ],
    *,
    load: float,
    spacing: float,
    quick: bool,
) -> TreadPositions:
    """Return the numbers of a run at more positions of its tread, or shoe angles without a tread.

    All places are solved on the quick grid, every other one, of shoe angles the own, on the grid of
    the run too. The ratio of the means on both takes all to the grid of the run, and under lugs on
    to that of ``FINEST``, where numbers move by the first order of the cells (``carried``).
    What the angle adds under a tread is half the difference of the shoe turned up and down, at the
    case's own position.

    ``load`` is the whole load, N; ``known`` are the numbers at the case's own place, and what is
    known of others, on the grid of the run, of ``spacing`` (m); ``at_places`` solves places,
    each on a grid (m), and gives the index of each with its numbers as they end, None where a
    contact did not converge.
    """
    lugs, own = treaded(case), known[Place()]
    all_places, on_run_grid, coarse = _places_on_grids(case, spacing, quick=quick)
    angles = TURNED * lugs
    asked = [(place, spacing) for place in (*on_run_grid, *angles) if place not in known]
    asked += [(place, coarse) for place in all_places if coarse != spacing]
    ended = dict(at_places(asked))
    at = {(place, spacing): numbers for place, numbers in known.items()}
    at |= {one: numbers for k, one in enumerate(asked) if (numbers := ended[k]) is not None}
    pairs = [p for p in on_run_grid if (p, spacing) in at and (p, coarse) in at]
    if not pairs:  # nothing compares the grids
        pairs = [place for place in on_run_grid if (place, spacing) in at] or [Place()]
        coarse = spacing
    answers = {p: at[p, coarse] for p in all_places if (p, coarse) in at} or {Place(): own}
    failed = {*all_places} - {*answers} | {p for p in on_run_grid if (p, spacing) not in at}
    onward = max(spacing - FINEST, 0.0) / (coarse - spacing) if lugs and coarse > spacing else 0.0
    rate = RATES[len(tread_on_sole(case)[0])] if lugs else 1.0
    values, between = {}, {}
    for name in own:
        each = np.array([numbers[name] for numbers in answers.values()])
        before, after = (np.array([at[p, h][name] for p in pairs]) for h in (coarse, spacing))
        limit = load if name == "fluid_load" else math.inf
        order = onward if name in CARRIED else 0.0
        values[name] = carried(each, before, after, order, limit)
        further = float((values[name] - carried(each, before, after, 0.0, limit)).mean())
        apart = after - before
        scatter = float(np.std(apart, ddof=1)) if len(pairs) > 1 else abs(float(apart[0]))
        between[name] = math.hypot(further / 2, (1 + order) * scatter / len(pairs) ** rate)
    for whole in (values, between):
        whole["cof"] = sum(whole[f"cof_{part}"] for part in ("adhesion", "hysteresis", "viscous"))
    if not lugs:
        return ShoeAngles(tuple(answers), values, len(failed), own, between=between)
    by_angle = {}
    if all((place, spacing) in at for place in angles):
        up, down = (at[place, spacing] for place in angles)
        by_angle = {name: (up[name] - down[name]) / 2 for name in own}
    return TreadPositions(
        tuple(answers), values, len(failed), own, between=between, by_angle=by_angle
    )


def carried(each: Array, coarse: Array, fine: Array, onward: float, limit: float) -> Array:
    """Return numbers (n,) of a coarse grid on a finer one, by some of both (m,).

    The odds v / (limit - v), v without a limit, are scaled as those of the mean over the m move
    from ``coarse`` to ``fine``, and ``onward`` times as far again. What grows with finer cells
    grows evenly, of what shrinks the inverse does.
    """
    before, after = (float(one.mean()) for one in (coarse, fine))
    if not (0 < before < limit and 0 < after < limit):
        return each if before == after else np.full_like(each, after)
    step = after / before * (1 - before / limit) / (1 - after / limit)
    factor = step + onward * (step - 1) if step > 1 else step / (1 + onward * (1 - step))
    share = np.minimum(each / limit, 1.0)
    return each * factor / (1 - share + factor * share)


def _places_on_grids(
    case: Case, spacing: float, *, quick: bool
) -> tuple[tuple[Place, ...], tuple[Place, ...], float]:
    """Return the places of a run, those that the grid of the run solves, and that of all, m."""
    coarse = case.numerics.quick_grid_spacing
    if treaded(case):
        all_places = case_places(case, quick=quick)
        if quick or coarse <= spacing:
            return all_places, all_places, spacing
        return all_places, all_places[::2], coarse
    return shoe_angles(), shoe_angles()[: 3 if quick else 1], spacing if quick else coarse


def position_count(case: Case, *, quick: bool) -> int:
    """Return at how many positions of its tread, or shoe angles, a run is solved.

    On the quick grid half as many positions.
    """
    count = case.numerics.tread_positions
    if count == 1:
        return 1
    if not treaded(case):
        return len(shoe_angles())
    return math.ceil(count / 2) if quick else count


def treaded(case: Case) -> bool:
    """Return whether the sole of a case has lugs."""
    if case.shoe.outsole is None:
        return _tread(case) is not None
    return float(file_surface(case).tread_depth.max()) > 0


def first_share(case: Case, *, quick: bool) -> float:
    """Return the share of a run's work that its march at the case's own place takes."""
    count, lugs, numerics = position_count(case, quick=quick), treaded(case), case.numerics
    if count == 1:
        return 1.0
    share = numerics.grid_spacing / numerics.quick_grid_spacing
    if quick or (lugs and share >= 1):
        marches = float(count + lugs)
    else:
        marches = 1 + math.ceil(count / 2) * lugs + count * share**2
    if lugs:  # a history of the motion is marched at both angles
        marches += len(TURNED) * (case.motion.build() is not None)
    return 1 / marches


def run_cost(case: Case, *, quick: bool) -> Cost:
    """Return what a run will take, all places together."""
    numerics = case.numerics
    one = cost(case, numerics.quick_grid_spacing if quick else numerics.grid_spacing)
    share = first_share(case, quick=quick)
    low, high = (seconds / share for seconds in one.seconds)
    return replace(one, seconds=(low, high))


def _tread(case: Case) -> Tread | None:
    tread = None if case.shoe.tread is None else case.shoe.tread.build()
    return tread if tread and tread.depth > 0 else None


def place_numbers(parts: Prepared, contact: SoleContact) -> dict[str, float]:
    """Return the numbers of a result that depend on where the tread lies."""
    case, sole = parts.case, parts.sole
    friction = friction_sums(parts.local_law, contact, case.motion.speed)
    sensor = scanned(case, sole, contact, viscosity=parts.viscosity)
    numbers, _ = scalars(case, contact, friction, sensor)
    numbers |= later_numbers(parts, contact)
    return {
        name: each.value
        for name, each in numbers.items()
        if each.value is not None and name not in ("normal_force", "slip_probability")
    }
