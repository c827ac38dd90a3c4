"""The law of the pair narrowed by what machines read of the floor of a case."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Annotated, Any, ClassVar

import numpy as np

from underfoot.case import Case
from underfoot.case.context import Context
from underfoot.case.friction import PairOption
from underfoot.case.quantity import Quantity, optional
from underfoot.case.section import CaseView
from underfoot.case.tables import meant_file
from underfoot.compute.resolve import resolve_context
from underfoot.core import InputError, unknown_name
from underfoot.core.presentation import Presentable, Table
from underfoot.core.remark import Message, join_lines
from underfoot.friction import (
    FrictionLaw,
    PairContactLaw,
    PairDraws,
    packaged_pair_draws,
    read_pair_draws,
)
from underfoot.friction.pair_contact import Pair, UnexpectedReading

from .joint import KEPT_AS, PlaceDraws, floor_name, interval
from .machines import (
    ANY_FLOOR_RQ,
    Fluid,
    Machine,
    MachinePrediction,
    machine,
    machine_of,
    prediction,
)

PendulumValue = Annotated[float, Quantity("1", 0.0, 150.0)]
RampAngle = Annotated[float, Quantity("rad", 0.0, math.radians(45.0))]
Slipmeter = Annotated[float, Quantity("1", 0.0, 1.2)]
KEPT = 1000
FLOOR = "floor"


@dataclass(frozen=True, slots=True)
class FloorReading:
    """What a machine read on a floor, in its unit."""

    machine: Machine
    fluid: Fluid
    value: float
    kind: str = "value"
    sd: float | None = None

    @property
    def value_text(self) -> Message:
        """The reading with its unit and what bounds it."""
        values = {"value": self.value, "unit": self.machine.scale.unit}
        if self.kind == "lower":
            return Message("at least {value:g} {unit}", **values)
        if self.kind == "upper":
            return Message("at most {value:g} {unit}", **values)
        return Message("{value:g} {unit}", **values)

    @property
    def text(self) -> Message:
        """The reading with its machine."""
        return Message("{machine}: {value}", machine=self.machine.title, value=self.value_text)


def learn_floor(
    joint: PlaceDraws, floor: str, floor_rq: tuple[float, float], reading: FloorReading
) -> tuple[UnexpectedReading, ...]:
    """Teach draws what a machine read on a floor; return it where it was not foretold."""
    foretold = interval(reading.machine.draw_readings(joint, floor, floor_rq, reading.fluid))
    log = reading.machine.log_likelihood(
        joint, floor, floor_rq, reading.fluid, reading.value, kind=reading.kind, sd=reading.sd
    )
    joint.learn(log, reading.text)
    low, middle, high = foretold
    too_high, too_low = reading.value > high, reading.value < low
    if not {"value": too_high or too_low, "lower": too_high, "upper": too_low}[reading.kind]:
        return ()
    title, unit = reading.machine.title, reading.machine.scale.unit
    return (UnexpectedReading(title, unit, reading.value, low, middle, high),)


@dataclass(frozen=True, slots=True)
class FloorCalibration(Presentable):
    """Draws of the law, and the roughness of the floor (m) before and after the readings."""

    kind: ClassVar[str] = "floor_calibration"

    readings: tuple[FloorReading, ...]
    draws: PairDraws
    before: tuple[float, float, float]
    after: tuple[float, float, float]
    effective: float
    beside: tuple[FloorReading, ...] = ()
    """Readings that the case itself holds: they count there, not in these draws."""
    again: tuple[Machine, ...] = ()
    """Machines of which the draws to begin with hold a reading of this floor already."""

    def cautions(self) -> tuple[Message, ...]:
        """Return the readings that were not foretold, left out, or may count twice."""
        return (
            *(reading.text for reading in self.draws.outside),
            *(
                Message(
                    "{reading} stays in the case, and is not in the file: friction.model = "
                    '"pair_read" counts it there.',
                    reading=reading.text,
                )
                for reading in self.beside
            ),
            *(
                Message(
                    "friction.draws_file holds a reading of {machine} on this floor already: this "
                    "one counts as a further reading. If it is the same, do not use the file.",
                    machine=machine.title,
                )
                for machine in self.again
            ),
        )

    def heading(self) -> str:
        """Return the title."""
        return Message(
            "Floor by {readings:; }", readings=[reading.text for reading in self.readings]
        )

    def headline(self) -> tuple[Message, ...]:
        """Return what the readings say of the floor."""
        before, after = (
            Message("{rq:.2g} um (95 %: {low:.2g} to {high:.2g})", low=low, rq=rq, high=high)
            for low, rq, high in (1e6 * np.array([self.before, self.after])).tolist()
        )
        if self.before[0] == self.before[2]:
            return (
                Message("The roughness of the floor is given: the reading narrows the law alone."),
            )
        return (
            Message("Rq of the floor was {before} and is {after}.", before=before, after=after),
        )

    def table(self) -> Table:
        """Return the draws that are left."""
        rows = [("equal draws that are left", f"{self.effective:.0f}")]
        return Table("Draws", ("quantity", "value"), rows)


def floor_calibration(
    pair: Pair, draws: PairDraws, readings: tuple[FloorReading, ...], seed: int
) -> FloorCalibration:
    """Return the draws of the law of a pair that readings of its floor leave.

    Errors that readings of a shoe determined before are kept, by the rows that agree.

    Raises:
        InputError: Readings that hardly any draw agrees with.
    """
    joint, roughness = (
        floor_draws(pair, draws, seed),
        Message("roughness of floor {floor}", floor=FLOOR),
    )
    share = floor_name(pair)
    before = interval(joint.drawn_between(roughness, pair.floor_rq))
    outside = [
        told for reading in readings for told in learn_floor(joint, FLOOR, pair.floor_rq, reading)
    ]
    rows = np.arange(KEPT)  # in random order already
    known = {**joint.errors(), share: joint.share(roughness)}
    if pair.compound_and_floor not in known:  # no reading of this pair determined it
        error = joint.pair_error(pair, pair.compound_and_floor, FLOOR)
        known[pair.compound_and_floor] = joint.constants.sd_pair * error
    machines = {reading.machine.name for reading in readings}
    known |= joint.values_of(
        f"floor {FLOOR} beyond",
        *(f"{what} of {name}" for name in machines for what in ("factor", "reader", "walker")),
        *(f"{name} on {FLOOR}" for name in machines),
    )
    pair_draws = replace(
        joint.constants.rows(rows),
        errors={name: values[rows] for name, values in known.items()},
        source=f"{draws.source}; floor read: {join_lines(each.text for each in readings)}",
        basis="of a floor that was read",
        notes=draws.notes,
        outside=(*draws.outside, *outside),
    )
    after = interval(joint.drawn_between(roughness, pair.floor_rq))
    return FloorCalibration(readings, pair_draws, before, after, joint.fewest)


def floor_draws(pair: Pair, draws: PairDraws, seed: int) -> PlaceDraws:
    """Return joint draws that know of the floor of a pair what its draws do."""
    joint, share = PlaceDraws(seed=seed, start=draws), floor_name(pair)
    for name, known in joint.errors().items():
        if name == share:
            joint.begin(f"roughness of floor {FLOOR}", known)
        elif name.startswith(KEPT_AS):
            joint.begin(name.removeprefix(KEPT_AS), known)
    return joint


def machine_reading(case: Case, *, method: str, keep: Sequence[str] = ()) -> MachinePrediction:
    """Return what a machine prints of the floor of a case; its shoe is not asked.

    Parameters:
        method: Name of the machine's set-up.
        keep: "contaminant" takes the fluid of the case in place of the standard's.

    Raises:
        InputError: Another part to keep, or another law of friction.
    """
    device, law = machine_of(case.catalogue.entry("setup", method)), pair_law(case)
    for part in keep:
        if part != "contaminant":
            raise unknown_name("part of the case to keep", part, ["contaminant"], where="--keep")
    fluid = device.fluid_of_standard()
    if keep:
        viscosity = None if law.viscosity is None else (law.viscosity, law.viscosity)
        fluid = Fluid(
            case.entries.get("contaminant", "fluid of the case"), law.pair.family, viscosity
        )
    joint = floor_draws(law.pair, law.draws, case.numerics.seed)
    told = prediction(device, joint, FLOOR, law.pair.floor_rq, fluid, law.pair.measured[1])
    return replace(told, outside=law.draws.outside)


def pair_law(case: Case) -> PairContactLaw:
    """Return the law of a case.

    Raises:
        InputError: It is none of a pair.
    """
    law = case.friction.build(resolve_context(case))
    if not isinstance(law, PairContactLaw):
        raise InputError(f'the law is "{law.name}"', where="friction", allowed='model = "pair"')
    return law


def calibrated_floor(
    case: Case, named: str, reading: float, *, kind: str = "value", fluid: str = "", seed: int = 0
) -> FloorCalibration:
    """Return the draws of the law calibrated to a machine's reading of the floor of a case.

    What ``pair_read`` holds in the case stays there: it does not count in these draws too.

    Raises:
        InputError: Another law of friction; a reading that the machine cannot print, one of a
            machine whose reading the case holds, or one that hardly any draw agrees with.
    """
    device = machine(named, "--machine")
    liquid = device.fluid_of_standard(fluid, "--fluid")
    value = device.check_reading(reading, "--reading")
    law, read = pair_law(case), FloorReading(device, liquid, value, kind)
    beside: tuple[FloorReading, ...] = ()
    if isinstance(case.friction, PairReadOption):
        beside, law = case.friction.floor_readings(), case.friction.unread(resolve_context(case))
    if any(floor_reading.machine == device for floor_reading in beside):
        raise InputError(
            Message("the case holds what {title} read of this floor", title=device.title),
            where="--machine",
            allowed="a machine whose reading is not in the case",
            remedy="Write the mean of its readings into the case, which counts it by itself",
        )
    told = floor_calibration(law.pair, law.draws, (read,), case.numerics.seed + seed)
    again = (device,) if was_read(law.draws, device) else ()
    return replace(told, beside=beside, again=again)


def was_read(draws: PairDraws, device: Machine) -> bool:
    """Return whether draws hold what a machine read of their floor."""
    return any(name.startswith(f"{KEPT_AS}{device.name} on {FLOOR}") for name in draws.errors)


FIELDS = {
    "ptv_96": "pendulum-96",
    "ptv_55": "pendulum-55",
    "ramp_angle": "ramp-oil",
    "barefoot_angle": "ramp-barefoot",
    "dcof": "bot-3000e",
    "slip_index": "english-xl",
}
CLASSES = {"ramp_class": "ramp-oil", "barefoot_class": "ramp-barefoot"}


def class_bounds(device: Machine, name: str, where: str) -> tuple[FloorReading, ...]:
    """Return the bounds of a machine's reading that a class of its standard stands for."""
    labels = [label for _, label in device.classes]
    if name not in labels:
        raise unknown_name("class", name, labels, where=where)
    at, fluid = labels.index(name), device.fluid_of_standard()
    ends = [("lower", device.classes[at][0])]
    if at + 1 < len(labels):
        ends.append(("upper", device.classes[at + 1][0]))
    return tuple(FloorReading(device, fluid, end, kind) for kind, end in ends if end > 0)


class PairReadOption(PairOption):
    """The law of the pair, narrowed by readings that machines took of the floor.

    A reading narrows the law of every shoe on that floor. It enters through the machine's model: it
    is no COF of the shoe. A slip class of the shoe and draws of ``underfoot calibrate pair`` may be
    given too.
    """

    name: ClassVar[str] = "pair_read"
    source: ClassVar[str] = "calibrated on published measurements and on readings of the floor"

    ptv_96: PendulumValue | None = optional("pendulum, slider 96, water: PTV")
    ptv_55: PendulumValue | None = optional("pendulum, slider 55, water: PTV")
    ramp_angle: RampAngle | None = optional("ramp with boots and oil")
    ramp_class: str | None = optional("class of the same: R9 to R13")
    barefoot_angle: RampAngle | None = optional("ramp, barefoot")
    barefoot_class: str | None = optional("class of the same: A, B or C")
    dcof: Slipmeter | None = optional("BOT-3000E, wet dynamic COF")
    slip_index: Slipmeter | None = optional("English XL, water")

    def floor_readings(self, where: str = "friction") -> tuple[FloorReading, ...]:
        """Return the readings that are given, each checked by its machine."""
        readings: list[FloorReading] = []
        for field, named in FIELDS.items():
            given = getattr(self, field)
            if given is not None:
                device = machine(named)
                value = float(np.degrees(given)) if device.scale.unit == "deg" else float(given)
                value = device.check_reading(value, f"{where}.{field}")
                readings.append(FloorReading(device, device.fluid_of_standard(), value))
        for field, named in CLASSES.items():
            if (given := getattr(self, field)) is not None:
                readings += class_bounds(machine(named), given, f"{where}.{field}")
        return tuple(readings)

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        """Yield what the machines cannot have read, and that nothing was."""
        yield from super().problems(case, where)
        try:
            if not self.floor_readings(where):
                fields = ", ".join((*FIELDS, *CLASSES))
                yield InputError("no reading of the floor", where=where, allowed=fields)
        except InputError as error:
            yield error

    def unread(self, context: Context) -> PairContactLaw:
        """Return the law without the readings, on any floor where none was measured."""
        law: Any = super().build(context)
        pair = law.pair if law.pair.measured[1] else replace(law.pair, floor_rq=ANY_FLOOR_RQ)
        return PairContactLaw(pair, law.viscosity, law.draws)

    def build(self, context: Context) -> FrictionLaw:
        """Return the law, narrowed."""
        law = self.unread(context)
        told = _narrow_pair(law.pair, self.floor_readings(), self.draws_file, self.sha256)
        return PairContactLaw(law.pair, law.viscosity, told.draws)


@lru_cache(maxsize=32)
def _narrow_pair(
    pair: Pair, readings: tuple[FloorReading, ...], draws_file: str | None, sha256: str | None
) -> FloorCalibration:
    draws = packaged_pair_draws()
    if draws_file:
        with meant_file(draws_file, sha256, "friction.draws_file") as path:
            draws = read_pair_draws(path)
    if twice := [reading.machine.title for reading in readings if was_read(draws, reading.machine)]:
        raise InputError(
            Message("holds what {twice} read of this floor, and so does the case", twice=twice[0]),
            where="friction.draws_file",
            remedy="Leave the reading out of the case, or the file",
        )
    return floor_calibration(pair, draws, readings, 0)
