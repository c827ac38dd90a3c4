"""A tread, not one position of it: the answer averaged over where its lugs happen to lie."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
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
from .sole import file_periods, file_surface

ANGLE_BAND = math.radians(1)
"""The shoe angle lies evenly within this of the case's, rad; assumed: how well an upper is held."""
_HELD = "spread of the friction law, its inputs and the"


@dataclass(frozen=True, slots=True)
class Place:
    """Where a tread lies: its pattern shifted by (x, y), m, the shoe turned by ``turn``, rad."""

    shift: tuple[float, float] = (0.0, 0.0)
    turn: float = 0.0


@dataclass(frozen=True, slots=True)
class TreadPositions:
    """Numbers of a run at some positions of the tread, the case's own first.

    Attributes:
        places: Of the pattern and the shoe.
        values: Name of a result's scalar: its value at each place, SI, on the grid of the run.
        left_out: Number of positions that did not converge.
    """

    origin: ClassVar[str] = "tread_position"
    held: ClassVar[str] = "position of the tread"
    several: ClassVar[str] = "positions of the tread"
    within: ClassVar[str] = "over the positions of the tread"

    places: tuple[Place, ...]
    values: Mapping[str, Array]
    left_out: int

    def answer(self, name: str) -> float:
        """Return the scalar of the result: its mean over the places."""
        return float(self.values[name].mean())

    def factors(self, name: str) -> Array:
        """Return the scalar at each place over that at the case's own; 1 where that is 0."""
        values = self.values[name]
        return values / values[0] if values[0] else np.ones_like(values)

    def friction(
        self, friction: FrictionCoefficients, sampled: SampledCof | None
    ) -> tuple[FrictionCoefficients, SampledCof | None]:
        """Return COF and its draws over the positions, which the draws take in turn."""
        values = {name: values for name, values in self.values.items() if name.startswith("cof")}
        new = {name: replace(getattr(friction, name), value=self.answer(name)) for name in values}
        if sampled is not None:
            law_variance, place_variance = float(np.var(sampled.cof)), float(np.var(values["cof"]))
            at = np.arange(sampled.cof.size) % len(self.places)
            draws = {
                name.removeprefix("cof_"): getattr(sampled, name.removeprefix("cof_"))
                * self.factors(name)[at]
                for name in values
            }
            draws["cof"] = draws["adhesion"] + draws["hysteresis"] + draws["viscous"]
            share = {
                name: each * law_variance / (law_variance + place_variance)
                for name, each in sampled.share.items()
            }
            share[self.origin] = place_variance / (law_variance + place_variance)
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
        cof, load = (float(self.values[name][0]) for name in ("cof", "fluid_load"))
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
        angle = any(place.turn for place in self.places)
        return (f"motion.shoe_angle: ±1 deg {self.within}",) * angle

    def fields(self) -> dict[str, Any]:
        """Return the variables of a data set: where the positions are, COF and load there."""

        def at(values: Any, unit: str, name: str) -> tuple[str, Any, dict[str, str]]:
            return ("tread_position", values, {"units": unit, "long_name": name})

        shift = np.array([place.shift for place in self.places])
        turn = [place.turn for place in self.places]
        return {
            "position_shift_x": at(shift[:, 0], "m", "shift of the tread's pattern, forward"),
            "position_shift_y": at(shift[:, 1], "m", "shift of the tread's pattern, across"),
            "position_turn": at(turn, "rad", "change of the shoe angle"),
            "position_cof": at(self.values["cof"], "1", "coefficient of friction"),
            "position_fluid_load": at(self.values["fluid_load"], "N", "load carried by the fluid"),
        }

    def _range(self, name: str, unit: str = "1") -> str:
        values = self.values[name]
        return f"{display(values.min(), unit)} to {display(values.max(), unit)}"


@dataclass(frozen=True, slots=True)
class ShoeAngles(TreadPositions):
    """Numbers of a run of a sole without lugs at its own shoe angle and beside it.

    Attributes:
        coarse: Scalars at the own angle on the grid that the angles are compared on.
    """

    coarse: Mapping[str, float]

    origin = "shoe_angle"
    held = "shoe angle"
    several = "shoe angles"
    within = "over the shoe angles"

    def labels(self) -> dict[str, str]:
        """Return what the interval holds in words."""
        if len(self.places) == 1:
            return {}
        least, most = (math.degrees(bound([p.turn for p in self.places])) for bound in (min, max))
        cof, load = (float(self.values[name][0]) for name in ("cof", "fluid_load"))
        return {
            "shoe_angle": f"COF {self._range('cof')}, load on the film "
            f"{self._range('fluid_load', 'N')} from {least:.1f} to +{most:.1f} deg beside the "
            "case's angle. Numbers are means over them; maps and histories show the case's angle "
            f"(COF {display(cof, '1')}, {display(load, 'N')} on the film)"
        }

    def fields(self) -> dict[str, Any]:
        """Return the variables of a data set: the angles, COF and load there."""
        fields = super(ShoeAngles, self).fields()
        return {name: each for name, each in fields.items() if "shift" not in name}


def shoe_angles() -> tuple[Place, ...]:
    """Return the case's own shoe angle and one on each side, of the variance of ``ANGLE_BAND``."""
    turn = ANGLE_BAND / math.sqrt(2)
    return Place(), Place(turn=turn), Place(turn=-turn)


def places(periods: Array, count: int) -> tuple[Place, ...]:
    """Return ``count`` places of a pattern with the periods (n, 2), m; the first at rest.

    A lattice rule: even along the first period, in steps of a golden share along a second, and a
    shoe angle that goes some times round its band as a sine of the same variance. A quantity that
    is smooth in the place then has a mean with next to no error of the rule.

    The film under bars is a saw-tooth along the only period: an angle that goes round with one of
    its strong harmonics, the first two, leaves an error that more places do not mend. Three times
    round, and below 5 places no other angle, halve the error (of eight places 3.1 to 1.9 % rms of
    the film, of four 8.3 to 4.1 %).
    """
    step = _golden_step(count)
    rounds = (3 if count >= 5 else 2) if len(periods) == 1 else (2 if count >= 5 else 1)
    lattice = []
    for k in range(count):
        shares = np.array([k / count, k * step % count / count])[: len(periods)]
        x, y = shares @ periods
        turn = math.sqrt(2 / 3) * math.sin(2 * math.pi * (rounds * k % count) / count)
        lattice.append(Place((float(x), float(y)), round(ANGLE_BAND * turn, 12)))
    return tuple(lattice)


def _golden_step(count: int) -> int:
    """Return the number without common divisor with ``count`` next to its golden share."""
    golden = count * (math.sqrt(5) - 1) / 2
    steps = [step for step in range(1, count + 1) if math.gcd(step, count) == 1]
    return min(steps, key=lambda step: abs(step - golden))


def tread_positions(
    case: Case,
    case_numbers: Mapping[str, float],
    at_places: Callable[[Sequence[Place], float], Iterator[tuple[int, Mapping[str, float] | None]]],
    *,
    spacing: float,
    quick: bool,
) -> TreadPositions:
    """Return the numbers of a run at more positions of its tread, or shoe angles without a tread.

    Positions are solved on the grid of the run, of ``spacing`` (m); shoe angles on the quick one,
    whose ratios are taken.

    ``case_numbers`` are those at the case's own place; ``at_places`` solves places on a grid and
    gives the index of each with its numbers as they end, None where a contact did not converge.
    """
    count, lugs = position_count(case, quick=quick), treaded(case)
    if lugs:
        tread = _tread(case)
        all_places = places(file_periods(case) if tread is None else tread.periods, count)
    else:
        all_places = shoe_angles()
        spacing = case.numerics.quick_grid_spacing
    known = {Place(): case_numbers} if lugs or quick else {}
    others = all_places[len(known) :]
    solved = dict(at_places(others, spacing))
    numbers = known | {place: n for k, place in enumerate(others) if (n := solved[k])}
    if Place() not in numbers:  # nothing to compare the angles with
        numbers = {Place(): case_numbers}
    values = {}
    for name, value in case_numbers.items():
        each = np.array([at[name] for at in numbers.values()])
        values[name] = each * (value / each[0]) if each[0] else each
    values["cof"] = sum(values[f"cof_{part}"] for part in ("adhesion", "hysteresis", "viscous"))
    left_out = count - len(numbers)
    if lugs:
        return TreadPositions(tuple(numbers), values, left_out)
    return ShoeAngles(tuple(numbers), values, left_out, coarse=numbers[Place()])


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
    count = position_count(case, quick=quick)
    if quick or count == 1 or treaded(case):
        return 1 / count
    numerics = case.numerics
    return 1 / (1 + count * (numerics.grid_spacing / numerics.quick_grid_spacing) ** 2)


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
    return {
        name: each.value
        for name, each in numbers.items()
        if each.value is not None and name not in ("normal_force", "slip_probability")
    }
