"""Machines that read floors, as devices of the law of the pair: pendulum, ramp, tribometer.

A specimen of known rubber is pressed on the floor and slides. Its contact friction mu_c is that of
any sole (``underfoot.friction.pair_contact``) at the machine's pressure and speed. The edge of a
slider and the lug of a boot are bearings as well (``Bearing``): where a film carries the share phi
of the load, the machine reads

    mu = f [(1 - phi) mu_c + eta V / (h p)]

f is what its published readings teach (``Learned``); without any it is off as a laboratory is. The
scale turns mu into the machine's own number. A walker on the ramp needs the friction r of a half
step beside that of the slope:

    pendulum     PTV = 330 mu / (3 + mu)
    ramp         angle = atan(mu) - atan(r)
    tribometers  mu
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any, ClassVar

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from underfoot.case.surfaces import FLOOR_RQ, RZ_SPREAD
from underfoot.core import InputError, RangeError, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.catalogue import Entry, catalogue
from underfoot.core.presentation import Presentable, Table, percent
from underfoot.core.remark import Message
from underfoot.film import side_leakage, wedge_load_factor
from underfoot.friction.pair_contact import Pair, UnexpectedReading
from underfoot.material import youngs_modulus_gent
from underfoot.questions.method import Basis
from underfoot.rough_contact.pressure_gap_law import DECAY_OVER_RQ, INTERCEPT_OVER_MODULUS

from .joint import CofReading, PlaceDraws, interval

ANY_FLOOR_RQ = (0.2e-6, 15e-6)
"""Rq (m), polished to safety floors, over which a floor is drawn that was read and not measured
(assumed): the reading tells which it is."""
TAPER = (0.1, 2.0)
"""(h1 - h0) / h0 of the wedge under a worn edge (assumed; the film is thickest at 1.19)."""
SMALLEST = 1e-3
"""COF below which no machine reads."""


@dataclass(frozen=True, slots=True)
class Fluid:
    """Fluid of a machine: family, and viscosity in Pa s (None: dry)."""

    name: str
    family: Any
    viscosity: tuple[float, float] | None


FLUIDS = {
    fluid.name: fluid
    for fluid in (
        Fluid("dry", "dry", None),
        Fluid("water", "aqueous", (1.0e-3, 1.0e-3)),
        Fluid("detergent", "detergent", (0.95e-3, 1.05e-3)),
        Fluid("oil", "oil", (0.05, 0.08)),
        Fluid("ramp oil", "oil", (0.15, 0.25)),
    )
}


@dataclass(frozen=True, slots=True)
class MachineScale:
    """How a machine prints friction: name of its number, its unit, and both ways.

    ``least``: below it a number is none of the unit but a COF, or an angle in radians.
    """

    name: str
    unit: str
    least: float = 0.0

    def reading(self, cof: Any) -> Any:
        """Return the machine's number of a COF.

        PTV 330 mu / (3 + mu): by safetydirectamerica.com's table 0.31 is 31, 0.54 is 50, 1.00 is
        82.
        """
        if self.name == "ptv":
            return 330.0 * np.asarray(cof) / (3.0 + np.asarray(cof))
        return np.degrees(np.arctan(cof)) if self.name == "angle" else np.asarray(cof)

    def cof(self, reading: Any) -> Any:
        """Return the COF of a machine's number; PTV below 330, angles below 90 degrees."""
        if self.name == "ptv":
            return 3.0 * np.asarray(reading) / (330.0 - np.asarray(reading))
        return np.tan(np.radians(reading)) if self.name == "angle" else np.asarray(reading)

    def slope(self, reading: float) -> float:
        """Return d COF / d reading."""
        step = 1e-4 * max(abs(reading), 1e-3)
        return float(self.cof(reading + step) - self.cof(reading - step)) / (2 * step)


SCALES = {
    "ptv": MachineScale("ptv", "PTV", least=2.0),
    "angle": MachineScale("angle", "deg", least=1.6),
    "cof": MachineScale("cof", "COF"),
}


@dataclass(frozen=True, slots=True)
class Bearing:
    """Part of a specimen that a film may lift, edge or lug: length along the motion, width (m).

    ``load`` (N) is what it bears at any length; None where it bears the specimen's pressure.
    """

    length: tuple[float, float]
    width: float
    load: float | None

    def film(
        self,
        pressure: Array,
        length: Array,
        drag: Array,
        rq: Array,
        modulus: float,
        taper: Array,
    ) -> tuple[Array, Array]:
        """Return the share of the load on the film, 0 to 1, and the gap (m), each (count,).

        The film of a wedge with open sides and the rough contact carry the load at one mean gap:

            p = 6 eta V l K(m) eta_s(l / b, m) / h^2 + 0.375 E / (1 - nu^2) exp(-h / (0.5 Rq))

        Parameters:
            pressure: p, Pa.
            length: l, m.
            drag: eta V, viscosity times speed, N/m.
            rq: Of both surfaces together, m.
            modulus: E of the specimen, Pa; nu = 0.5.
            taper: m = (h1 - h0) / h0 of the wedge.

        Source: Reynolds 1886, Michell 1905 (``underfoot.film.side_leakage``); Persson 2007
        (``underfoot.rough_contact.ExponentialLaw``).
        """
        wedge = 6 * drag * length * _wedge_factors(taper, length / self.width)
        stiff = INTERCEPT_OVER_MODULUS * modulus / 0.75
        gap, step = np.full_like(pressure, 1e-6), math.log(1e3)
        for _ in range(50):  # both parts fall with the gap: halve the steps of its logarithm
            carried = wedge / gap**2 + stiff * np.exp(-gap / (DECAY_OVER_RQ * rq))
            gap = gap * np.exp(np.where(carried > pressure, step, -step))
            step /= 2
        return np.minimum(wedge / gap**2 / pressure, 1.0), gap


def _wedge_factors(taper: Array, length_over_width: Array) -> Array:
    """Return K eta_s of wedges, (count,), from a table of them; 1e-3 off at most."""
    return _wedge_table()(np.log([taper, length_over_width]).T)


@cache
def _wedge_table() -> Any:
    tapers, ratios = np.geomspace(*TAPER, 25), np.geomspace(5e-3, 3, 25)
    table = [
        [wedge_load_factor(float(m)) * side_leakage(float(ratio), float(m)) for ratio in ratios]
        for m in tapers
    ]
    return RegularGridInterpolator((np.log(tapers), np.log(ratios)), table, method="cubic")


@dataclass(frozen=True, slots=True)
class Learned:
    """What readings teach of a machine, of ln COF.

    ``factor`` over the law of the pair and ``factor_sd``, how unsure it is; ``source_sd`` between
    those who read, ``floor_sd`` between floors of one roughness.
    """

    factor: float
    factor_sd: float
    source_sd: float
    floor_sd: float

    def error(self, joint: PlaceDraws, machine: str, floor: str) -> Array:
        """Return draws (count,) of ln of COF over that of the law."""
        return (
            self.factor
            + self.factor_sd * joint.normal(f"factor of {machine}")
            + self.source_sd * joint.normal(f"reader of {machine}")
            + self.floor_sd * joint.beyond_roughness(floor, f"{machine} on {floor}")
        )


@dataclass(frozen=True, slots=True)
class Machine:
    """A machine: a set-up of the catalogue with ``method.question = "machine_reading"``; SI.

    Where nobody's readings teach it (``learned`` None), its error is that of a laboratory, and
    ``deviation`` the standard deviation of ln COF for what the law has no reading of, as skin.
    ``walker`` is the range of the friction that a walker needs beside that of the slope.
    """

    entry: Entry = field(compare=False, repr=False)
    name: str
    scale: MachineScale
    shore_a: float
    sole_rq: tuple[float, float]
    pressure: tuple[float, float]
    speed: tuple[float, float]
    fluids: tuple[str, ...]
    classes: tuple[tuple[float, str], ...]
    above: bool
    most: float
    walker: tuple[float, float]
    bearing: Bearing | None
    deviation: float
    learned: Learned | None

    @property
    def title(self) -> str:
        """Title of the set-up."""
        return self.entry.title

    @property
    def standard(self) -> str:
        """Name of its standard."""
        return self.entry.text("machine.standard")

    @property
    def reproducibility(self) -> str:
        """How far two who read one floor differ."""
        return self.entry.text("machine.reproducibility")

    def class_of(self, reading: float) -> str:
        """Return the class of a reading."""
        name = self.classes[0][1]
        for number, (limit, label) in enumerate(self.classes):
            if reading > limit or (reading == limit and (number <= 1 or not self.above)):
                name = label
        return name

    def fluid_of_standard(self, name: str = "", where: str = "fluid") -> Fluid:
        """Return a fluid of the machine's standard, by default the first.

        Raises:
            InputError: No such fluid, or one that the standard does not read.
        """
        fluid = machine_fluid(name or self.fluids[0], where)
        if fluid.name not in self.fluids:
            raise InputError(
                Message(
                    "a {title} does not read {name}", title=self.title.lower(), name=fluid.name
                ),
                where=where,
                allowed=", ".join(self.fluids),
                remedy=Message(
                    "Outside {standard} the model of the machine is not held to anything",
                    standard=self.standard,
                ),
            )
        return fluid

    def check_reading(self, reading: float, where: str) -> float:
        """Return a reading that the machine's scale holds.

        Raises:
            RangeError: A number that the machine cannot print.
        """
        if isinstance(reading, bool) or not isinstance(reading, int | float):
            raise InputError(f"{reading!r}", where=where, allowed="a number")
        if not self.scale.least < reading <= self.most:
            raise RangeError(
                Message(
                    "{reading:g} is no reading of the {title}",
                    reading=reading,
                    title=self.title.lower(),
                ),
                where=where,
                allowed=Message(
                    "above {least:g}, at most {most:g} {unit}",
                    least=self.scale.least,
                    most=self.most,
                    unit=self.scale.unit,
                ),
                remedy="Check machine and unit: a pendulum prints PTV (36), a ramp degrees (12), a "
                "tribometer COF (0.42)",
            )
        return float(reading)

    def cof(
        self, joint: PlaceDraws, floor: str, floor_rq: tuple[float, float], fluid: Fluid
    ) -> Array:
        """Return draws (count,) of the COF that the machine reads on a floor of Rq (m).

        A machine with readings is taken at the middle of the law's constants and of what is open
        of its own setting: its factor was learned there and holds their errors.
        """
        known = self.learned is not None

        def setting(what: str, ends: tuple[float, float]) -> Array:
            if known:
                return np.full(joint.count, math.sqrt(ends[0] * ends[1]))
            return joint.drawn_between(f"{what} of {self.name}", ends)

        pair = Pair(self.shore_a, self.sole_rq, floor_rq, fluid.family)
        bearing, drag = self.bearing, None
        length = None if bearing is None else setting("edge", bearing.length)
        if bearing is not None and bearing.load is not None:
            assert length is not None
            pressure = bearing.load / (bearing.width * length)
        else:
            pressure = setting("pressure", self.pressure)
        if fluid.viscosity is not None:
            drag = setting("speed", self.speed) * joint.drawn_between(
                f"viscosity of {fluid.name}", fluid.viscosity
            )
        sole = f"specimen of {self.name}"
        cof = joint.contact_cof(
            pair, laboratory=f"machine {self.name}", floor=floor, sole=sole, pressure=pressure,
            drag=drag, middle=known,
        )  # fmt: skip
        cof = cof * np.exp(self.deviation * joint.normal(f"{self.name}, untested"))
        if bearing is not None and length is not None and drag is not None:
            rq = joint.drawn_between(f"roughness of floor {floor}", floor_rq)
            rough = np.hypot(joint.drawn_between(f"roughness of sole {sole}", self.sole_rq), rq)
            modulus = float(youngs_modulus_gent(self.shore_a))
            film, gap = bearing.film(
                pressure, length, drag, rough, modulus, setting("wedge", TAPER)
            )
            cof = (1 - film) * cof + film * drag / (gap * pressure)
        if self.learned is not None:
            cof = cof * np.exp(self.learned.error(joint, self.name, floor))
        if self.walker[1]:
            low, high = self.walker
            needed = low + (high - low) * joint.share(f"walker of {self.name}")
            cof = np.tan(np.arctan(cof) - np.arctan(needed))
        return np.maximum(cof, SMALLEST)

    def draw_readings(
        self, joint: PlaceDraws, floor: str, floor_rq: tuple[float, float], fluid: Fluid
    ) -> Array:
        """Return draws (count,) of what the machine prints of a floor, in its unit."""
        cof = self.cof(joint, floor, floor_rq, fluid)
        return np.minimum(self.scale.reading(cof), self.most)

    def log_likelihood(
        self,
        joint: PlaceDraws,
        floor: str,
        floor_rq: tuple[float, float],
        fluid: Fluid,
        reading: float,
        *,
        kind: str = "value",
        sd: float | None = None,
    ) -> Array:
        """Return ln p of a reading of a floor, (count,); ``sd`` in the machine's unit."""
        cof_sd = None if sd is None else sd * self.scale.slope(reading)
        read = CofReading(float(self.scale.cof(reading)), kind, cof_sd)
        return joint.log_likelihood(self.cof(joint, floor, floor_rq, fluid), read)


def rq_of_rz(rz: float) -> tuple[float, float]:
    """Return the range of Rq (m) of a floor of which Rz (m) is known alone."""
    return rz / RZ_SPREAD[1], rz / RZ_SPREAD[0]


@cache
def machines() -> Mapping[str, Machine]:
    """Return the machines by name: set-ups of the catalogue that answer ``machine_reading``."""
    every = catalogue()
    entries = [every.entry("setup", name) for name in every.names("setup")]
    read = [entry for entry in entries if "machine.scale" in entry.values]
    return {each.name: each for each in map(machine_of, read)}


def machine_of(entry: Entry) -> Machine:
    """Return the machine of a set-up of the catalogue."""

    def span(path: str, unit: str) -> tuple[float, float]:
        low, high = entry.numbers(path, unit)
        return low, high

    def number(path: str, unit: str = "1") -> float:
        return float(entry.sourced_value(path, unit))

    def learned_factor() -> Learned | None:
        if "learned.ln_factor" not in entry.values:
            return None
        paths = ("ln_factor", "ln_factor_sd", "ln_source_sd", "ln_floor_sd")
        return Learned(*(number(f"learned.{path}") for path in paths))

    bearing = None
    if "specimen.edge_length" in entry.values:
        load = number("specimen.edge_load", "N") if "specimen.edge_load" in entry.values else None
        bearing = Bearing(
            span("specimen.edge_length", "m"), number("specimen.edge_width", "m"), load
        )
    if bearing is not None and bearing.load is not None:
        low, high = (bearing.load / (bearing.width * end) for end in reversed(bearing.length))
        pressure = low, high
    else:
        pressure = span("specimen.pressure", "Pa")
    limits, labels = entry.numbers("classes.limits", "1"), entry.leaf("classes.labels").given
    return Machine(
        entry,
        entry.name.replace("_", "-"),
        SCALES[entry.text("machine.scale")],
        number("specimen.shore_a"),
        span("specimen.rq", "m"),
        pressure,
        span("sliding.speed", "m/s"),
        tuple(entry.leaf("fluids.names").given),
        tuple(zip(limits, labels, strict=True)),
        "classes.above" in entry.values,
        number("machine.most"),
        span("sliding.walker", "1") if "sliding.walker" in entry.values else (0.0, 0.0),
        bearing,
        number("specimen.ln_deviation") if "specimen.ln_deviation" in entry.values else 0.0,
        learned_factor(),
    )


def machine(name: str, where: str = "machine") -> Machine:
    """Return a machine by its name.

    Raises:
        InputError: No machine is named, or no such one; the nearest and all are named.
    """
    if not name:
        words = "a reading says nothing without the machine that read it"
        raise InputError(words, where=where, allowed=", ".join(machines()))
    plain = name.replace("_", "-")
    if plain not in machines():
        raise unknown_name("machine", name, machines(), where=where)
    return machines()[plain]


def machine_fluid(name: str, where: str = "fluid") -> Fluid:
    """Return a fluid of machines by its name."""
    if name not in FLUIDS:
        raise unknown_name("fluid", name, FLUIDS, where=where)
    return FLUIDS[name]


@dataclass(frozen=True, slots=True)
class MachinePrediction(Presentable):
    """What a machine will print of a floor: median and 95 % interval in its own unit."""

    kind: ClassVar[str] = "machine"

    machine: Machine
    fluid: Fluid
    floor_rq: tuple[float, float]
    known: bool
    low: float
    median: float
    high: float
    classes: tuple[tuple[str, float], ...]
    outside: tuple[UnexpectedReading, ...] = ()

    def heading(self) -> str:
        """Return the title."""
        return Message("{machine}, {fluid}", machine=self.machine.title, fluid=self.fluid.name)

    def headline(self) -> tuple[Message, ...]:
        """Return the number with its interval, and the likeliest class."""
        unit, (label, chance) = self.machine.scale.unit, max(self.classes, key=lambda c: c[1])
        digits = 2 if unit == "COF" else 0
        low, median, high = (f"{x:.{digits}f}" for x in (self.low, self.median, self.high))
        told = Message(
            "{label} with a probability of {chance}", label=label, chance=percent(chance)
        )
        if chance < 0.75:
            told = Message("no class can be told: the likeliest is {told}", told=told)
        return (
            Message(
                "{median} {unit} (95 %: {low} to {high}); {told}.",
                median=median, unit=unit, low=low, high=high, told=told,
            ),
        )  # fmt: skip

    def cautions(self) -> tuple[Message, ...]:
        """Return what the number rests on that nobody measured."""
        lines = [reading.text for reading in self.outside]
        if self.fluid.name not in self.machine.fluids:
            lines.append(
                Message(
                    "Outside the standard: {standard} reads {allowed}, not {fluid}.",
                    standard=self.machine.standard, allowed=self.machine.fluids,
                    fluid=self.fluid.name,
                )
            )  # fmt: skip
        if not self.known:
            low, high = (1e6 * x for x in self.floor_rq)
            lines.append(
                Message(
                    "The floor has no roughness: it was drawn over Rq {low:.2g} to {high:.2g} um.",
                    low=low, high=high,
                )
            )  # fmt: skip
        if self.machine.learned is None:
            lines.append(Message("No reading of this machine stands behind the prediction."))
        unsure = [
            value
            for value in self.machine.entry.values.values()
            if value.assumed or not value.verified
        ]
        lines.append(
            Message(
                "{count} settings of the set-up are assumed or from memory; see the table.",
                count=len(unsure),
            )
        )
        return tuple(lines)

    def table(self) -> Table:
        """Return the classes with their probabilities."""
        reached = np.cumsum([chance for _, chance in reversed(self.classes)])[::-1]
        rows = [
            (label, f"{limit:g}", percent(chance), percent(min(least, 1.0)))
            for (limit, label), (_, chance), least in zip(
                self.machine.classes, self.classes, reached, strict=True
            )
        ]
        heads = (
            "class",
            Message("from, {unit}", unit=self.machine.scale.unit),
            "probability",
            "of at least",
        )
        return Table("Class", heads, rows)

    def tables(self) -> tuple[Table, ...]:
        """Return classes and set-up, each setting with how sure its source is."""
        rows = []
        for path, leaf in self.machine.entry.values.items():
            section, _, name = path.partition(".")
            if section in ("method", "classes") and name != "labels":
                continue
            several = isinstance(leaf.given, list | tuple)
            given = leaf.given if several else (leaf.given,)
            between = ", " if name in ("labels", "names") else " to "
            basis = Basis.VERIFIED if leaf.verified else Basis.FROM_MEMORY
            basis = Basis.ASSUMED if leaf.assumed else basis
            setting = Message(
                "{section}: {setting}", section=section, setting=name.replace("_", " ")
            )
            rows.append((setting, between.join(map(str, given)), basis, leaf.source))
        heads = ("setting", "used", "basis", "source")
        return self.table(), Table("Set-up", heads, rows)

    def remarks(self) -> dict[str, Sequence[str]]:
        """Return what the set-up leaves out."""
        return {"Notes": (self.machine.entry.note,) if self.machine.entry.note else ()}


def predicted_reading(
    named: str,
    floor_rq: tuple[float, float] | None = None,
    *,
    fluid: str = "",
    seed: int = 0,
) -> MachinePrediction:
    """Return what a machine will print of a floor.

    Parameters:
        named: Name of the machine.
        floor_rq: Rq, low and high, m; None draws the usual range of floors.
        fluid: By default the first of the machine's standard.
    """
    device = machine(named)
    liquid = machine_fluid(fluid or device.fluids[0])
    rq = FLOOR_RQ if floor_rq is None else floor_rq
    for end in rq:
        if not (math.isfinite(end) and 1e-9 <= end <= 1e-3):
            raise RangeError(
                f"{end:g} m", where="roughness of the floor (Rq)", allowed="1 nm to 1 mm"
            )
    return prediction(device, PlaceDraws(seed=seed), "floor", rq, liquid, floor_rq is not None)


def prediction(
    device: Machine,
    joint: PlaceDraws,
    floor: str,
    floor_rq: tuple[float, float],
    fluid: Fluid,
    known: bool,
) -> MachinePrediction:
    """Return what a machine will print of a floor, by joint draws that may have learned of it.

    Parameters:
        device: The machine.
        joint: Draws of what is known of soles, floors and fluids.
        floor: Name of the floor in the draws.
        floor_rq: Least and greatest Rq, m.
        fluid: What is on the floor.
        known: What the prediction says of the floor: whether readings of it are known.
    """
    reading = device.draw_readings(joint, floor, floor_rq, fluid)
    names = np.array([device.class_of(float(x)) for x in reading])
    classes = tuple((label, float(np.mean(names == label))) for _, label in device.classes)
    return MachinePrediction(device, fluid, floor_rq, known, *interval(reading), classes)
