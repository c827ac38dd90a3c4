"""Which shoe for a place: slips of every shoe over its floors, fluids and people, in joint draws.

A step in a fluid slips with the probability that ``run`` gives of the same case
(``underfoot.slip.slip_chances``), A the available friction of shoe, floor and fluid. Its median is
that of the solved case; its draws are the law's, with the load on the film off by the model's error
and by what is not known of the gap:

    A = g mu_c (1 - phi) exp(t) + A_v phi / phi_0

g what lugs and pressure make of the law's contact friction mu_c, phi the film's share of the load,
t the error of the tread model. What is answered of a shoe is the mean of P over floors (by area),
fluids (by share of the steps) and tasks: of the steps in a fluid, the share that slips. Steps on a
dry floor count as safe: the law's dry friction has an interval too wide to say more. One number
stands for the draws everywhere: their mean, of what is left the ratio of two means.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from underfoot.core import Progress, SourcedValue, silent
from underfoot.core.arrays import Array
from underfoot.core.presentation import (
    Presentable,
    Table,
    drawn_probability_text,
    interval_text,
    percent,
    probability_text,
    value_text,
)
from underfoot.core.remark import Message, Remark
from underfoot.core.threads import threads_limited
from underfoot.friction.pair_contact import (
    UnexpectedReading,
)
from underfoot.friction.shoe_class import slip_tests
from underfoot.slip import mean_of_draws

from .calibration import learn_floor
from .cells import (
    MODEL,
    Cell,
    PlaceSolver,
    law_of_pair,
    slips_in_cells,
    sum_of_shares,
    tested_cof,
)
from .joint import CofReading, PlaceDraws, interval
from .machines import FLUIDS, Machine, machines
from .place import Place, PlaceFloor, PlaceShoe, fluid_name, same_shoe

DECIDED = 0.75
"""Chance of being best from which a shoe is called the best."""
UNLIKELY = 0.05
TWICE = 2.0
"""Slips of the worn shoe over those of the new one from which it is to be replaced."""
ROUGH_FLOOR_RQ = 9e-6
"""Rq (m) of the floor that a change of floors is computed with."""
ROUGHER_FLOOR = {"roughness": {"rq": {"value": "9 um", "uncertainty": "3 um"}}}
"""Clay quarry tile of the catalogue."""
WASHED = "detergent"
"""What an oily floor is wet with after it was washed."""
BINS = 10
"""Readings, equally likely, of which it is counted how many change the choice."""
MOST_RATIO = 100.0
"""Ratio of slips beyond which no number is printed."""
WORN_EVENLY = "Shoes are worn evenly over their months; half of them are new on the mean day"
TOSS_UP = 0.05
"""Distance of a chance from one half below which a change is none that helps."""
IDLE = 5e-3
"""Share of the slips that a change moves at least: a smaller one does nothing."""
CHECKED = ("pendulum-96", "tile_glycerine")


@dataclass(frozen=True, slots=True)
class ShoeAnswer:
    """The answer for one shoe: the share of steps in a fluid that slip, the chance that it is best.

    ``reported`` are the slips that people will report, where those of today are given and reports
    go with slips.
    """

    shoe: PlaceShoe
    slips: SourcedValue
    best: float
    replaced: str
    reported: str


@dataclass(frozen=True, slots=True)
class Lever:
    """A change: slips left of those of today (95 % around the ratio), and the chance of fewer."""

    name: str
    left: tuple[float, float, float]
    fewer: float

    @property
    def does_something(self) -> bool:
        """Whether it moves the slips."""
        return any(abs(end - 1) >= IDLE for end in self.left)


@dataclass(frozen=True, slots=True)
class PossibleMeasurement:
    """A measurement that could be made: chance that the choice changes, share of slips it saves."""

    name: str
    changes: float
    saves: float


@dataclass(frozen=True, slots=True)
class ShoeChoice(Presentable):
    """Which shoe suits a place, how sure that is, and what else would help."""

    kind: ClassVar[str] = "choice"

    place: Place
    shoes: tuple[ShoeAnswer, ...]
    levers: tuple[Lever, ...]
    measurements: tuple[PossibleMeasurement, ...]
    sources: tuple[tuple[str, float], ...]
    cofs: tuple[tuple[str, str, str, float, float, float, float], ...]
    present: str
    effective: float
    floors_before_after: tuple[tuple[str, str, str], ...] = ()
    outside: tuple[tuple[str, UnexpectedReading], ...] = ()

    def heading(self) -> str:
        """Return the title."""
        return Message("Which shoe: {place}", place=self.place.name)

    @property
    def first(self) -> ShoeAnswer:
        """The shoe with the highest chance of being best."""
        return max(self.shoes, key=self._chance)

    def _chance(self, answer: ShoeAnswer) -> float:
        """Return the chance that a shoe is best: one with all that are the same shoe."""
        return math.fsum(shoe.best for shoe in self.shoes if same_shoe(shoe.shoe, answer.shoe))

    @property
    def _unlike(self) -> tuple[ShoeAnswer, ...]:
        """The shoes, of those that are the same the first."""
        return tuple(
            shoe
            for number, shoe in enumerate(self.shoes)
            if not any(same_shoe(shoe.shoe, other.shoe) for other in self.shoes[:number])
        )

    def headline(self) -> tuple[Message, ...]:
        """Return the answer, or that there is none."""
        first, best, count = self.first, self._chance(self.first), len(self._unlike)
        slips = value_text("slip_probability", first.slips)
        rate = Message("{slips} of steps in a fluid slip", slips=slips)
        chance = probability_text(best)
        answer = {"shoe": first.shoe.name, "chance": chance, "rate": rate}
        if len(self.shoes) == 1:
            lines = [Message("{shoe}: {rate}.", shoe=first.shoe.name, rate=rate)]
        elif count == 1:
            lines = [
                Message("Which shoe is best can't be told: all are the same ({rate}).", rate=rate)
            ]
        elif best >= DECIDED:
            lines = [Message("{shoe} is best with a chance of {chance}: {rate}.", **answer)]
        else:
            alike = (one for one in self._unlike if probability_text(self._chance(one)) == chance)
            level = [one.shoe.name for one in alike]
            told = Message("{shoe} is ahead with a chance of {chance} ({rate})", **answer)
            if len(level) > 1:
                *others, last = level
                told = Message(
                    "{others} and {last} are level with a chance of {chance} each (with {shoe}: "
                    "{rate})",
                    **answer, others=others, last=last,
                )  # fmt: skip
            lines = [
                Message(
                    "Which of the {count} shoes is best can't be told: {told}.",
                    count=count, told=told,
                )
            ]  # fmt: skip
        if unlikely := [shoe.shoe.name for shoe in self.shoes if self._chance(shoe) < UNLIKELY]:
            lines.append(
                Message(
                    "Hardly the best (chance below {limit:.0f} %): {shoes}.",
                    limit=100 * UNLIKELY, shoes=unlikely,
                )
            )  # fmt: skip
        most = self.levers[0] if self.levers else None
        if most is not None and most.left[1] < 1 and most.fewer > 0.5 + TOSS_UP:
            lines.append(
                Message(
                    "Most is gained by {change}: it leaves {share} of the slips of today, fewer "
                    "with a probability of {chance}.",
                    change=most.name, share=_share(most.left),
                    chance=drawn_probability_text(most.fewer),
                )
            )  # fmt: skip
        else:
            lines.append(Message("No change that was tried surely leaves fewer slips."))
        if self.measurements and self.measurements[0].changes >= 0.05:
            one = self.measurements[0]
            lines.append(
                Message(
                    "Measure first: {name}; it changes the choice with a chance of {chance}.",
                    name=one.name, chance=_of_bins(one.changes),
                )
            )  # fmt: skip
        return tuple(lines)

    def cautions(self) -> tuple[Message, ...]:
        """Return what the numbers are not."""
        lines = [
            Message(
                "A slip is a heel faster than 0.2 m/s of people who walk as if no fluid were "
                "there: many more than people report. Compare shoes by their ratio. Steps on dry "
                "floors count as safe; a worker takes {steps:,.0f} steps a day in a fluid.",
                steps=self.place.wet_steps,
            ),
            *(Remark.of(floor, told.text) for floor, told in self.outside),
        ]
        twins = [
            Message("{first} and {second}", first=shoe.shoe.name, second=two.shoe.name)
            for number, shoe in enumerate(self.shoes)
            for two in self.shoes[number + 1 :]
            if same_shoe(shoe.shoe, two.shoe)
        ]
        if twins:
            lines.append(
                Message("The same shoe twice, which shares its chance: {twins:; }.", twins=twins)
            )
        for floor in self.place.floors:
            if not floor.known:
                lines.append(
                    Message(
                        "{floor} has neither roughness nor reading: it was drawn over all usual "
                        "floors.",
                        floor=floor.name,
                    )
                )
        return tuple(lines)

    def table(self) -> Table:
        """Return the shoes, the likeliest best first."""
        rows = [
            (
                each.shoe.name,
                probability_text(each.best) if len(self.shoes) > 1 else "",
                probability_text(float(each.slips)),
                interval_text("slip_probability", each.slips),
                "" if each.shoe.price is None else f"{each.shoe.price:g}",
                _monthly(each.shoe),
                each.replaced,
                each.reported,
            )
            for each in sorted(self.shoes, key=lambda each: -each.best)
        ]
        heads = ("Shoe", "Best", "Steps in a fluid that slip", "95 %", "Price")
        heads = (*heads, "Price a month", "Replace", "Reported")
        told = [i for i in range(len(heads)) if any(row[i] for row in rows)]
        return Table(
            "Shoes", tuple(heads[i] for i in told), [[row[i] for i in told] for row in rows]
        )

    def tables(self) -> tuple[Table, ...]:
        """Return shoes, changes, measurements, where slips happen, friction."""
        levers = [
            (lever.name, _share(lever.left), drawn_probability_text(lever.fewer))
            for lever in self.levers
        ]
        measures = [
            (measurement.name, _of_bins(measurement.changes), probability_text(measurement.saves))
            for measurement in self.measurements
        ]
        where = [(name, percent(share)) for name, share in self.sources]
        cofs = [
            (
                *names,
                f"{median:.2f}",
                Message("{low:.2f} to {high:.2f}", low=low, high=high),
                percent(film),
            )
            for *names, low, median, high, film in self.cofs
        ]
        tables = [
            self.table(),
            Table(Message("What a change leaves of the slips with {shoe}", shoe=self.present),
                  ("Change", "Slips left (95 %)", "Fewer"), levers),
            Table("What one measurement would change of the shoe with the fewest slips on average",
                  ("Measurement", "Chance of another choice", "Slips saved by it"), measures),
            Table(Message("Where the slips with {shoe} happen", shoe=self.present),
                  ("Floor and fluid", "Share"), where),
            Table("Available friction",
                  ("Shoe", "Floor", "Fluid", "Median", "95 %", "Load on film"), cofs),
        ]  # fmt: skip
        if self.floors_before_after:
            heads = ("Floor", "Rq before, um", "after its readings, um")
            tables.append(Table("Floors", heads, self.floors_before_after))
        return tuple(table for table in tables if table.rows)

    def remarks(self) -> Mapping[str, Sequence[str]]:
        """Return what was assumed."""
        used = {reading.machine for floor in self.place.floors for reading in floor.readings}
        read = used or any(shoe.readings or shoe.known_class for shoe in self.place.shoes)
        notes = [
            Message(
                "{title}: {standard}; settings and sources: underfoot explain {name}",
                title=each.title, standard=each.standard, name=each.entry.name,
            )
            for each in sorted(used, key=lambda each: each.name)
        ]  # fmt: skip
        return {
            "Assumed": (
                *self.place.assumed,
                *(
                    [Message("Readings leave {count:.0f} of the draws", count=self.effective)]
                    if read
                    else []
                ),
                *([WORN_EVENLY] if any(s.wear_depth > 0 for s in self.place.shoes) else []),
            ),
            "Machines": notes,
        }

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "kind": self.kind,
            "name": self.place.name,
            "shoes": [
                {
                    "name": shoe.shoe.name,
                    "chance_best": shoe.best,
                    "slip_probability": shoe.slips.value,
                    "interval_95": shoe.slips.interval,
                    "replace": shoe.replaced,
                }
                for shoe in self.shoes
            ],
            "changes": [
                {"name": lever.name, "left": list(lever.left), "fewer": lever.fewer}
                for lever in self.levers
            ],
            "measurements": [
                {
                    "name": measurement.name,
                    "changes": measurement.changes,
                    "saves": measurement.saves,
                }
                for measurement in self.measurements
            ],
        }


def _count(value: float) -> str:
    return f"{value:.2g}" if value < 10 else f"{float(f'{value:.2g}'):,.0f}"


def _of_bins(chance: float) -> str:
    if chance > 0.5 / BINS:
        return percent(chance)
    return Message("below {least}", least=percent(1 / BINS))


def _ratio(value: float) -> str:
    """Return a ratio of slips; beyond a factor of 100 it is of the slip model's tails."""
    if value < 1 / MOST_RATIO:
        return Message("below {least}", least=f"{1 / MOST_RATIO:g}")
    if value > MOST_RATIO:
        return Message("above {most}", most=f"{MOST_RATIO:g}")
    return f"{float(f'{value:.2g}'):g}"


def _share(left: tuple[float, float, float]) -> str:
    low, median, high = map(_ratio, left)
    if low == high:
        return median
    return Message("{median} ({low} to {high})", median=median, low=low, high=high)


def _monthly(shoe: PlaceShoe) -> str:
    return "" if not shoe.price or not shoe.months else f"{shoe.price / shoe.months:.2g}"


@threads_limited(1)
def choose_shoe(
    place: Place, *, seed: int = 0, quick: bool = True, progress: Progress = silent
) -> ShoeChoice:
    """Return which shoe suits a place.

    Parameters:
        place: As its file describes it.
        seed: Of the draws.
        quick: Solve on the coarse grid.

    Raises:
        InputError: A case that cannot be; readings that contradict each other.
    """
    joint = PlaceDraws(seed=seed)
    new_cases = {shoe.name: place.case(shoe, place.floors[0], "water") for shoe in place.shoes}
    floor_rq = {
        floor.name: law_of_pair(place.case(place.shoes[0], floor, "water")).pair.floor_rq
        for floor in place.floors
    }
    before = {name: interval(joint.drawn_between(f"roughness of floor {name}", rq))
              for name, rq in floor_rq.items()}  # fmt: skip
    outside = _learn(place, joint, floor_rq, new_cases)
    solver = PlaceSolver(place, joint, quick, _read_floors(place, joint, floor_rq))
    shares: dict[str, dict[tuple[str, str], Array]] = {}
    worn_rate: dict[str, Array] = {}
    cofs = []
    present = next((shoe for shoe in place.shoes if shoe.present), place.shoes[0])
    count = 1 + sum(1 + _wears(shoe) for shoe in place.shoes)
    done = 0

    def step(what: str) -> None:
        nonlocal done
        progress(what, done / count)
        done += 1

    states: dict[str, dict[bool, dict[tuple[str, str], Cell]]] = {}
    for shoe in place.shoes:
        states[shoe.name] = {}
        for worn in (False, True) if _wears(shoe) else (False,):
            step(Message("{shoe}, worn", shoe=shoe.name) if worn else shoe.name)
            states[shoe.name][worn] = solver.cells(shoe, place.floors, worn)
        new = states[shoe.name][False]
        shares[shoe.name] = slips_in_cells(place, joint, new)
        for (floor_named, fluid), cell in states[shoe.name][shoe.worn_region is not None].items():
            ends = interval(cell.acof)
            cofs.append((shoe.name, floor_named, fluid_name(fluid), *ends, cell.film_share))
        if True in states[shoe.name]:
            worn_slips = slips_in_cells(place, joint, states[shoe.name][True])
            worn_rate[shoe.name] = sum_of_shares(worn_slips)
            shares[shoe.name] = (
                worn_slips  # a ruler tells of the shoe of today
                if shoe.worn_region
                else {key: 0.5 * (x + worn_slips[key]) for key, x in shares[shoe.name].items()}
            )
    rates = {name: sum_of_shares(each) for name, each in shares.items()}
    matrix = np.array([rates[shoe.name] for shoe in place.shoes])
    lowest = matrix <= matrix.min(axis=0) * (1 + 1e-9)
    best = (lowest / lowest.sum(axis=0)).mean(axis=1)
    answers = tuple(
        ShoeAnswer(
            shoe,
            mean_of_draws(rates[shoe.name] / place.wet_share, source=MODEL.source),
            float(chance),
            _replacement_time(shoe, states[shoe.name], worn_rate.get(shoe.name), place, joint),
            _reported_slips(place, rates[shoe.name], rates[present.name]),
        )
        for shoe, chance in zip(place.shoes, best, strict=True)
    )
    step("another floor")
    today = rates[present.name]
    levers = []
    others = [answer for answer in answers if answer.shoe.name != present.name]
    if others:
        other = min(others, key=lambda each: float(rates[each.shoe.name].mean())).shoe.name
        name = Message("{other} instead of {present}", other=other, present=present.name)
        levers.append(_lever(name, rates[other], today))
    new = sum_of_shares(slips_in_cells(place, joint, states[present.name][False]))
    smooth = [
        floor
        for floor in place.floors
        if np.median(joint.drawn_between(f"roughness of floor {floor.name}", floor_rq[floor.name]))
        < ROUGH_FLOOR_RQ * (1 - IDLE)
    ]
    if smooth:
        fluids = dict.fromkeys(place.fluids(), 1.0)
        unused = "quarry tile"
        while unused in floor_rq:  # what is known of a floor of the place is none of the new one's
            unused += ", new"
        one = PlaceFloor(unused, ROUGHER_FLOOR, 1.0, 0.0, True, fluids, ())
        cells = solver.cells(present, [one], False)
        tiled = states[present.name][False] | {
            (floor.name, fluid): cells[one.name, fluid]
            for floor in smooth
            for fluid in floor.fluids
            if fluid != "dry"
        }
        name = Message("floors of clay quarry tile (Rq 9 um)")
        if len(smooth) < len(place.floors):
            floors = [floor.name for floor in smooth]
            name = Message("floors of clay quarry tile (Rq 9 um) ({floors})", floors=floors)
        levers.append(_lever(name, sum_of_shares(slips_in_cells(place, joint, tiled)), new))
    levers += _cleaning(place, solver, present, states[present.name][False], shares[present.name])
    levers = sorted(
        (lever for lever in levers if lever.does_something),
        key=lambda each: (each.left[1], each.name),
    )
    measurements = _measurements(place, joint, floor_rq, new_cases, matrix)
    mean = {
        key: float(value.mean() / max(today.mean(), 1e-300))
        for key, value in shares[present.name].items()
    }
    sources = tuple(
        (Message("{floor}, {fluid}", floor=floor, fluid=fluid_name(fluid)), value)
        for (floor, fluid), value in sorted(mean.items(), key=lambda item: -item[1])
    )
    return ShoeChoice(
        place, answers, tuple(levers), measurements, sources, tuple(cofs), present.name,
        joint.fewest, _floors(place, joint, floor_rq, before), outside,
    )  # fmt: skip


def _wears(shoe: PlaceShoe) -> bool:
    return shoe.wear_depth > 0 or shoe.worn_region is not None


def _cleaning(
    place: Place,
    solver: PlaceSolver,
    shoe: PlaceShoe,
    new: Mapping[tuple[str, str], Cell],
    shares: Mapping[tuple[str, str], Array],
) -> list[Lever]:
    """Return what cleaning leaves: each fluid on half the steps; oil washed off, the floor wet."""
    joint, levers = solver.joint, []
    today = sum_of_shares(shares)
    for fluid in place.fluids():
        halved = {key: (0.5 if key[1] == fluid else 1.0) * x for key, x in shares.items()}
        name = Message("{fluid} wiped up sooner, on half the steps", fluid=fluid_name(fluid))
        levers.append(_lever(name, sum_of_shares(halved), today))
    oily = [fluid for fluid in place.fluids() if _is_oil(place, shoe, fluid)]
    if oily:
        washed = {key: cell for key, cell in new.items() if key[1] == WASHED}
        rest = [floor for floor in place.floors if (floor.name, WASHED) not in washed]
        if rest:
            floors = [replace(floor, fluids={WASHED: 1.0}) for floor in rest]
            washed |= solver.cells(shoe, floors, False)
        cells = {
            (floor, fluid): washed[floor, WASHED] if fluid in oily else cell
            for (floor, fluid), cell in new.items()
        }
        name = Message(
            "{fluids} washed off with {washed}, the floor left wet",
            fluids=[*map(fluid_name, oily)], washed=WASHED,
        )  # fmt: skip
        after, before = (sum_of_shares(slips_in_cells(place, joint, each)) for each in (cells, new))
        levers.append(_lever(name, after, before))
    return levers


def _is_oil(place: Place, shoe: PlaceShoe, fluid: str) -> bool:
    return law_of_pair(place.case(shoe, place.floors[0], fluid)).pair.family == "oil"


def _learn(
    place: Place,
    joint: PlaceDraws,
    floor_rq: Mapping[str, tuple[float, float]],
    cases: Mapping[str, Any],
) -> tuple[tuple[str, UnexpectedReading], ...]:
    """Teach the draws every reading of floors and shoes, in the order of names.

    Return the readings of floors that were not foretold.
    """
    outside = [
        (floor.name, told)
        for floor in sorted(place.floors, key=lambda each: each.name)
        for reading in floor.readings
        for told in learn_floor(joint, floor.name, floor_rq[floor.name], reading)
    ]
    learned = []
    for shoe in sorted(place.shoes, key=lambda each: each.name):
        if any(same_shoe(shoe, other) for other in learned):
            continue
        learned.append(shoe)
        case = cases[shoe.name]
        law = law_of_pair(case)
        for reading in shoe.readings:
            cof = tested_cof(joint, case, law, shoe, slip_tests()[reading.test])
            where = Message("shoe {shoe}", shoe=shoe.name)
            joint.learn(joint.log_likelihood(cof, reading.reading), where)
        known = shoe.known_class
        if known is not None:
            passed = np.zeros(joint.count)
            for reading in known.readings:
                cof = tested_cof(joint, case, law, shoe, reading.test)
                passed += joint.log_likelihood(
                    cof, CofReading(reading.cof, reading.kind, reading.sd)
                )
            log = np.log(np.maximum(-np.expm1(passed), 1e-12)) if known.fails else passed
            where = Message(
                "shoe {shoe}, class {slip_class}", shoe=shoe.name, slip_class=known.name
            )
            joint.learn(log, where)
    return tuple(outside)


def _read_floors(
    place: Place, joint: PlaceDraws, floor_rq: Mapping[str, tuple[float, float]]
) -> dict[str, PlaceFloor]:
    """Return the floors that were read, with the roughness that the readings leave."""
    found = {}
    for floor in place.floors:
        low, high = floor_rq[floor.name]
        if not floor.readings or low == high:
            continue
        low, middle, high = interval(
            joint.drawn_between(f"roughness of floor {floor.name}", (low, high))
        )
        deviation = middle * math.log(high / low) / (2 * 1.96)
        rq = {"value": f"{1e6 * middle:.4g} um", "uncertainty": f"{1e6 * deviation:.4g} um"}
        section = {**floor.section, "roughness": {**floor.section.get("roughness", {}), "rq": rq}}
        found[floor.name] = replace(floor, section=section)
    return found


def _slip_ratio(after: Array, before: Array) -> tuple[float, float, float]:
    """Return the ratio of the mean slips between the 2.5 and 97.5 % of the ratio of the draws.

    Draws in which nobody slips, before and after, have no ratio.
    """
    known = (after > 0) | (before > 0)
    if not known.any():
        return 1.0, 1.0, 1.0
    low, _, high = interval(after[known] / np.maximum(before[known], 1e-300))
    middle = float(after.mean() / max(before.mean(), 1e-300))
    return min(low, middle), middle, max(high, middle)


def _lever(name: str, after: Array, before: Array) -> Lever:
    fewer = np.mean(after < before) + 0.5 * np.mean(after == before)
    return Lever(name, _slip_ratio(after, before), float(fewer))


def _reported_slips(place: Place, after: Array, today: Array) -> str:
    if place.reported is None:
        return ""
    ends = (1 / MOST_RATIO, MOST_RATIO)
    low, median, high = np.clip(_slip_ratio(after, today), *ends)
    least, middle, most = (_count(place.reported * ratio) for ratio in (low, median, high))
    if low == high:
        return middle
    least = Message("below {least}", least=least) if low == ends[0] else least
    most = Message("above {most}", most=most) if high == ends[1] else most
    return Message("{median} ({low} to {high})", median=middle, low=least, high=most)


def _replacement_time(
    shoe: PlaceShoe,
    states: Mapping[bool, Mapping[tuple[str, str], Cell]],
    worn: Array | None,
    place: Place,
    joint: PlaceDraws,
) -> str:
    """Return when the shoe slips twice as often as new, ln of slips even in time between.

    Of a shoe whose worn region was measured, whether it does so today; "" where no wear is given.
    """
    if worn is None:
        return ""
    new = sum_of_shares(slips_in_cells(place, joint, states[False]))
    if shoe.worn_region is not None:
        left = _slip_ratio(worn, new)
        if left[1] > TWICE:
            return Message("now: {ratio} times the slips of new", ratio=_share(left))
        return Message("not yet: {ratio} times the slips of new", ratio=_share(left))
    if shoe.months is None:
        return ""
    share = float(np.median(new / place.wet_share))
    if share * TWICE > 1:  # it can't slip in more than all of its steps
        text = probability_text(share)
        return Message("new already, it slips in {share} of the steps in a fluid", share=text)
    growth = np.log(np.maximum(worn, 1e-300) / np.maximum(new, 1e-300))
    with np.errstate(divide="ignore"):
        months = np.where(growth > 0, shoe.months * math.log(TWICE) / growth, np.inf)
    low, median, _ = (float(x) for x in np.quantile(months, (0.025, 0.5, 0.975), method="nearest"))
    if median > shoe.months:
        return Message("not within its {months:g} months", months=shoe.months)
    return Message("after {median:.2g} months (95 %: from {low:.2g})", median=median, low=low)


def _measurements(
    place: Place,
    joint: PlaceDraws,
    floor_rq: Mapping[str, tuple[float, float]],
    cases: Mapping[str, Any],
    slips: Array,
) -> tuple[PossibleMeasurement, ...]:
    """Return what each reading that was not made would change, the most first."""
    if len(slips) < 2:
        return ()
    now, found = int(np.argmin(slips.mean(axis=1))), []
    device: Machine = machines()[CHECKED[0]]
    readings = [
        (Message("PTV of {floor}", floor=f.name),
         device.cof(joint, f.name, floor_rq[f.name], FLUIDS[device.fluids[0]]))
        for f in place.floors if not f.readings
    ]  # fmt: skip
    test = slip_tests()[CHECKED[1]]
    readings += [
        (Message("EN value, tile with glycerine, of {shoe}", shoe=shoe.name),
         tested_cof(joint, cases[shoe.name], law_of_pair(cases[shoe.name]), shoe, test))
        for shoe in place.shoes if not shoe.readings
    ]  # fmt: skip
    for name, cof in readings:
        noise = joint.normal(f"reading: {name}") * np.hypot(0.1, joint.constants.sd_reading)
        read = np.log(np.maximum(cof, 1e-6)) + noise
        edges = np.quantile(read, np.linspace(0, 1, BINS + 1)[1:-1])
        bins = np.searchsorted(edges, read)
        changes = saved = 0.0
        for number in range(BINS):
            here = (bins == number) / joint.count
            inside = slips @ here
            other = int(np.argmin(inside))
            if inside[other] < inside[now] * (1 - 1e-9):
                changes += float(here.sum())
                saved += float((inside[now] - inside[other]) / slips[now].mean())
        found.append(PossibleMeasurement(name, changes, saved))
    return tuple(sorted(found, key=lambda one: (-one.saves, one.name)))


def _floors(
    place: Place,
    joint: PlaceDraws,
    floor_rq: Mapping[str, tuple[float, float]],
    before: Mapping[str, tuple[float, float, float]],
) -> tuple[tuple[str, str, str], ...]:
    """Return the roughness of each floor with readings, before and after them."""
    rows = []
    for floor in place.floors:
        if floor.readings:
            after = interval(
                joint.drawn_between(f"roughness of floor {floor.name}", floor_rq[floor.name])
            )
            texts = [
                "{1:.2g} ({0:.2g} to {2:.2g})".format(*(1e6 * x for x in each))
                for each in (before[floor.name], after)
            ]
            rows.append((floor.name, *texts))
    return tuple(rows)
