"""Machines that read floors, as devices of the law of the pair: pendulum, ramp, tribometer.

A specimen of known rubber is pressed on the floor and slides. Its contact friction mu_c is that of
any sole (``underfoot.friction.pair_contact``) at the machine's pressure and speed, off by the error
of the machine as by that of a laboratory. The edge of a slider is a bearing as well (``Edge``):
where a film carries the share phi of its load, the machine reads

    mu = (1 - phi) mu_c + eta V / (h p)

The scale turns mu into the machine's own number. A walker on the ramp needs the friction r of a
half step beside that of the slope:

    pendulum     PTV = 330 mu / (3 + mu)
    ramp         angle = atan(mu) - atan(r)
    tribometers  mu
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any, ClassVar

import numpy as np

from underfoot.case.surfaces import FLOOR_RQ
from underfoot.core import InputError, RangeError, to_si, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.presentation import Presentable, Table, percent
from underfoot.film import wedge_load_factor
from underfoot.friction.pair_contact import Pair
from underfoot.material import youngs_modulus_gent
from underfoot.rough_contact.pressure_gap_law import DECAY_OVER_RQ, INTERCEPT_OVER_MODULUS

from .joint import JointDraws, Reading, interval

RZ_OVER_RQ = 6.0
"""Rz over Rq of a profile, about (steel of EN ISO 13287 in the catalogue); 4 to 8 are drawn."""
RZ_SPREAD = (4.0, 8.0)
ANY_FLOOR_RQ = (0.2e-6, 15e-6)
"""Rq (m), polished to safety floors, over which a floor is drawn that was read and not measured
(assumed): the reading tells which it is."""
ANCHOR_SD = 0.15
"""Standard deviation of ln of an anchor: an indicative band, no reading (assumed)."""
TAPER = (0.1, 2.0)
"""(h1 - h0) / h0 of the wedge under a worn edge (assumed; the film is thickest at 1.19)."""
SMALLEST = 1e-3
"""COF below which no machine reads."""
MIDDLE_RQ = 2e-6
"""Rq (m) of a floor at which the error over roughness of a machine is 0: between its anchors."""


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
class Scale:
    """How a machine prints friction: name of its number, its unit, and both ways."""

    name: str
    unit: str

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
    "ptv": Scale("ptv", "PTV"),
    "angle": Scale("angle", "deg"),
    "cof": Scale("cof", "COF"),
}


@dataclass(frozen=True, slots=True)
class Edge:
    """Worn edge of a slider: load (N), its width across the motion and its length along it (m)."""

    load: float
    width: float
    length: tuple[float, float]

    def film(
        self, pressure: Array, drag: Array, rq: Array, modulus: float, taper: Array
    ) -> tuple[Array, Array]:
        """Return the share of the load on the film, 0 to 1, and the gap (m), each (count,).

        The film of a wide wedge and the rough contact carry the load at one mean gap:

            p = 6 eta V l K(m) / h^2 + 0.375 E / (1 - nu^2) exp(-h / (0.5 Rq))

        Parameters:
            pressure: p, of the edge, Pa.
            drag: eta V, viscosity times speed, N/m.
            rq: Of both surfaces together, m.
            modulus: E of the slider, Pa; nu = 0.5.
            taper: m = (h1 - h0) / h0 of the wedge.

        Source: Reynolds 1886 (``underfoot.film.wedge_load_factor``); Persson 2007
        (``underfoot.rough_contact.ExponentialLaw``). The leakage at the sides, below 5 % where the
        edge is 25 times as wide as long, is left out.
        """
        along = self.load / (self.width * pressure)
        factors = np.array([wedge_load_factor(float(m)) for m in taper])
        wedge = 6 * drag * along * factors
        stiff = INTERCEPT_OVER_MODULUS * modulus / 0.75
        gap, step = np.full_like(pressure, 1e-6), math.log(1e3)
        for _ in range(50):  # both parts fall with the gap: halve the steps of its logarithm
            carried = wedge / gap**2 + stiff * np.exp(-gap / (DECAY_OVER_RQ * rq))
            gap = gap * np.exp(np.where(carried > pressure, step, -step))
            step /= 2
        return np.minimum(wedge / gap**2 / pressure, 1.0), gap


@dataclass(frozen=True, slots=True)
class Machine:
    """A machine: specimen, motion, fluids of its standard, scale and classes; SI.

    ``anchors`` are (Rz, reading, source) that its offset is learned from, wet with water.
    ``walker`` is the range of the friction that a walker needs beside that of the slope.
    ``deviation`` is the standard deviation of ln COF where the law has no reading, as of skin or
    at 2.8 m/s; ``roughness_deviation`` that of the exponent of Rq there.
    ``reproducibility`` says how far laboratories differ, with its source.
    """

    name: str
    title: str
    standard: str
    scale: Scale
    shore_a: float
    sole_rq: tuple[float, float]
    pressure: tuple[float, float]
    speed: tuple[float, float]
    fluids: tuple[str, ...]
    classes: tuple[tuple[float, str], ...]
    above: bool
    most: float
    source: str
    memory: tuple[str, ...]
    note: str
    reproducibility: str
    walker: tuple[float, float] = (0.0, 0.0)
    deviation: float = 0.0
    roughness_deviation: float = 0.0
    edge: Edge | None = None
    anchors: tuple[tuple[float, float, str], ...] = ()
    anchored_by: str = ""

    @property
    def offset(self) -> str:
        """Name of the machine's error: machines with anchors in common share it."""
        return f"machine {self.anchored_by or self.name}"

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
                f"a {self.title.lower()} does not read {fluid.name}",
                where=where,
                allowed=", ".join(self.fluids),
                remedy=f"Outside {self.standard} the model of the machine is not held to anything",
            )
        return fluid

    def checked(self, reading: float, where: str) -> float:
        """Return a reading that the machine's scale holds.

        Raises:
            RangeError: A number that the machine cannot print.
        """
        if isinstance(reading, bool) or not isinstance(reading, int | float):
            raise InputError(f"{reading!r}", where=where, allowed="a number")
        if not 0 < reading <= self.most:
            raise RangeError(
                f"{reading:g} is no reading of the {self.title.lower()}",
                where=where,
                allowed=f"above 0, at most {self.most:g} {self.scale.unit}",
                remedy="Check machine and unit: a pendulum prints PTV (36), a ramp degrees (12), a "
                "tribometer COF (0.42)",
            )
        return float(reading)

    def cof(
        self, joint: JointDraws, floor: str, floor_rq: tuple[float, float], fluid: Fluid
    ) -> Array:
        """Return draws (count,) of the COF that the machine reads on a floor of Rq (m)."""
        pair = Pair(self.shore_a, self.sole_rq, floor_rq, fluid.family)
        pressure = self._pressure(joint)
        drag = None
        if fluid.viscosity is not None:
            drag = joint.between(f"speed of {self.name}", self.speed) * joint.between(
                f"viscosity of {fluid.name}", fluid.viscosity
            )
        sole = f"specimen of {self.name}"
        cof = joint.contact_cof(
            pair, laboratory=self.offset, floor=floor, sole=sole, pressure=pressure, drag=drag
        )
        cof = cof * np.exp(self.deviation * joint.normal(f"{self.offset}, untested"))
        rq = joint.between(f"roughness of floor {floor}", floor_rq)
        if drag is not None:
            tilt = self.roughness_deviation * joint.normal(f"{self.offset}, over roughness")
            cof = cof * (rq / MIDDLE_RQ) ** tilt
        if self.edge is not None and drag is not None:
            rough = np.hypot(joint.between(f"roughness of sole {sole}", self.sole_rq), rq)
            modulus = float(youngs_modulus_gent(self.shore_a))
            taper = joint.between(f"wedge of {self.name}", TAPER)
            film, gap = self.edge.film(pressure, drag, rough, modulus, taper)
            cof = (1 - film) * cof + film * drag / (gap * pressure)
        if self.walker[1]:
            low, high = self.walker
            needed = low + (high - low) * joint.share(f"walker of {self.name}")
            cof = np.tan(np.arctan(cof) - np.arctan(needed))
        return np.maximum(cof, SMALLEST)

    def _pressure(self, joint: JointDraws) -> Array:
        if self.edge is None:
            return joint.between(f"pressure of {self.name}", self.pressure)
        length = joint.between(f"edge of {self.name}", self.edge.length)
        return self.edge.load / (self.edge.width * length)

    def learn_anchors(self, joint: JointDraws) -> None:
        """Teach draws the offset of the machine, as far as its anchors tell it."""
        owner = machines()[self.anchored_by] if self.anchored_by else self
        for rz, reading, _ in owner.anchors:
            cof = owner.cof(joint, f"anchor Rz {rz:g}", rq_of_rz(rz), FLUIDS["water"])
            at = float(owner.scale.cof(reading))
            log = joint.log_likelihood(cof, Reading(at, "value", ANCHOR_SD * at))
            joint.learn(log, owner.name)

    def log_likelihood(
        self,
        joint: JointDraws,
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
        read = Reading(float(self.scale.cof(reading)), kind, cof_sd)
        return joint.log_likelihood(self.cof(joint, floor, floor_rq, fluid), read)


def rq_of_rz(rz: float) -> tuple[float, float]:
    """Return the range of Rq (m) of a floor of which Rz (m) is known alone."""
    return rz / RZ_SPREAD[1], rz / RZ_SPREAD[0]


@cache
def machines() -> Mapping[str, Machine]:
    """Return the machines by name."""
    text = resources.files("underfoot_places").joinpath("machines.toml").read_text("utf-8")

    def span(entry: Mapping[str, Any], key: str, unit: str) -> tuple[float, float]:
        low, high = (to_si(end, unit, where=key) for end in entry[key])
        return low, high

    def edge(entry: Mapping[str, Any]) -> Edge | None:
        if "edge" not in entry:
            return None
        table = entry["edge"]
        load = to_si(table["load"], "N", where="edge.load")
        width = to_si(table["width"], "m", where="edge.width")
        return Edge(load, width, span(table, "length", "m"))

    def pressure(entry: Mapping[str, Any]) -> tuple[float, float]:
        bears = edge(entry)
        if bears is None:
            return span(entry, "pressure", "Pa")
        low, high = (bears.load / (bears.width * end) for end in reversed(bears.length))
        return low, high

    return {
        name: Machine(
            name,
            entry["title"],
            entry["standard"],
            SCALES[entry["scale"]],
            float(entry["shore_a"]),
            span(entry, "sole_rq", "m"),
            pressure(entry),
            span(entry, "speed", "m/s"),
            tuple(entry["fluids"]),
            tuple((float(limit), label) for limit, label in entry["classes"]),
            entry.get("above", False),
            float(entry["most"]),
            entry["source"],
            tuple(entry["memory"]),
            entry.get("note", ""),
            entry["reproducibility"],
            tuple(entry.get("walker", (0.0, 0.0))),
            entry.get("deviation", 0.0),
            entry.get("roughness_deviation", 0.0),
            edge(entry),
            tuple(
                (to_si(one["rz"], "m", where=name), one["reading"], one["source"])
                for one in entry.get("anchor", ())
            ),
            entry.get("anchors_of", ""),
        )
        for name, entry in tomllib.loads(text).items()
    }


def machine(name: str, where: str = "machine") -> Machine:
    """Return a machine by its name.

    Raises:
        InputError: No such machine; the nearest and all are named.
    """
    if name not in machines():
        raise unknown_name("machine", name, machines(), where=where)
    return machines()[name]


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

    def heading(self) -> str:
        """Return the title."""
        return f"{self.machine.title}, {self.fluid.name}"

    def headline(self) -> tuple[str, ...]:
        """Return the number with its interval, and the likeliest class."""
        unit, (label, chance) = self.machine.scale.unit, max(self.classes, key=lambda c: c[1])
        digits = 2 if unit == "COF" else 0
        low, median, high = (f"{x:.{digits}f}" for x in (self.low, self.median, self.high))
        told = f"{label} with a probability of {percent(chance)}"
        if chance < 0.75:
            told = f"no class can be told: the likeliest is {told}"
        return (f"{median} {unit} (95 %: {low} to {high}); {told}.",)

    def cautions(self) -> tuple[str, ...]:
        """Return what the number rests on that nobody measured."""
        lines = []
        if self.fluid.name not in self.machine.fluids:
            allowed = ", ".join(self.machine.fluids)
            lines.append(
                f"Outside the standard: {self.machine.standard} reads {allowed}, not "
                f"{self.fluid.name}."
            )
        if not self.known:
            low, high = (1e6 * x for x in self.floor_rq)
            lines.append(
                f"The floor has no roughness: it was drawn over Rq {low:.2g} to {high:.2g} um."
            )
        if not (self.machine.anchors or self.machine.anchored_by):
            lines.append("No reading of this machine stands behind the prediction.")
        return tuple(lines)

    def table(self) -> Table:
        """Return the classes with their probabilities."""
        rows = [(label, percent(chance)) for label, chance in self.classes]
        return Table("Class", ("class", "probability"), rows)

    def tables(self) -> tuple[Table, ...]:
        """Return classes and set-up."""
        m = self.machine
        anchors = [
            (f"anchor, Rz {1e6 * rz:.0f} um", f"{reading:g}", source)
            for rz, reading, source in m.anchors
        ]
        rows = [
            ("standard", m.standard, m.source),
            ("Shore A of the specimen", f"{m.shore_a:g}", ""),
            ("Rq of the specimen, um", _span(m.sole_rq, 1e6), ""),
            ("pressure, kPa", _span(m.pressure, 1e-3), ""),
            ("speed, m/s", _span(m.speed, 1.0), m.note),
            *([("worn edge, mm", _span(m.edge.length, 1e3), "")] if m.edge else []),
            *(
                [("friction of a half step", _span(m.walker, 1.0), "assumed")]
                if m.walker[1]
                else []
            ),
            ("between laboratories", m.reproducibility, ""),
            *anchors,
            ("from memory, not verified", "; ".join(m.memory), ""),
        ]
        return self.table(), Table("Set-up", ("setting", "used", "source or remark"), rows)


def _span(ends: tuple[float, float], factor: float) -> str:
    return " to ".join(f"{factor * end:.3g}" for end in dict.fromkeys(ends))


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
    joint = JointDraws(seed=seed)
    device.learn_anchors(joint)
    reading = device.scale.reading(device.cof(joint, "floor", rq, liquid))
    names = np.array([device.class_of(float(x)) for x in reading])
    classes = tuple((label, float(np.mean(names == label))) for _, label in device.classes)
    return MachinePrediction(device, liquid, rq, floor_rq is not None, *interval(reading), classes)
