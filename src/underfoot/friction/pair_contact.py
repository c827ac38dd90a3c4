"""Contact friction of a sole, a floor and a fluid from what is known of the pair.

Dry, adhesion follows the real contact area of both roughnesses (Persson 2001), and the floor's
roughness adds hysteresis:

    mu_dry = rest a(p) + hysteresis,  rest = s (film + dry) (E / E_60)^-c
    a(p) = (p_0 / p) erf(p / p_R) / erf(p_0 / p_8.3)
    hysteresis = 0.0125 (loss tangent / 0.2) (slope of the floor / 0.105)

Under a fluid the same contact carries less: where the fluid has been pressed out of a spot it is
dry, else a boundary film is left, which is never stronger than the dry contact:

    mu_c = rest min(a, 1) D + min(s film (E / E_60)^-c, rest a) (1 - D) + hysteresis
    D = exp(-eta V / kappa),  kappa = kappa_0 (R / 8.3 um)^n,  R^2 = Rq_floor^2 + (o Rq_sole)^2

so that no floor grips more wet than dry. Rough pairs lose area, smooth ones keep their film: wet
friction has a maximum over roughness. The larger area of a pair smoother than 8.3 um is not
reached under a fluid, which such a pair seals in (min(a, 1)). o is the share of the sole's own
roughness that a floor does not press flat, 1 - erf(p / p_R) of the sole alone: what is flat drains
nothing. s is the share of adhesion that a surfactant leaves (detergents; else 1). p_R goes with the
slope of both surfaces, which grows with Rq up to that of the steepest floors: longer and higher
waves do not lower the real area.

No dry reading stands behind the level: adhesion at 8.3 um is taken as what water leaves of it at
rest. The constants are calibrated on published measurements (``underfoot.studies.pair_law``) and
are measurements of no single pair. A laboratory, its dry-like part and a pair each have an error of
their own, learned between the sources; they are the largest part of the interval.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import erf, ndtri

from underfoot.core import DataError, InputError, SourcedValue, ValidityRange
from underfoot.core.arrays import Array
from underfoot.core.checks import positive
from underfoot.core.deprecation import renamed_member
from underfoot.core.remark import Message, Remark

from .law import FILM_RANGE, PIN_PRESSURE, UncertainInputs
from .propagation import named_shares

ROUGHNESS = 8.3e-6
"""Rq (m) of the pair at which ``kappa_0`` holds: the report's polyurethane pin on vinyl."""
HYSTERESIS = 0.0125 / 1e-6
"""Hysteresis COF per metre of floor Rq at a loss tangent of 0.2: Persson theory, Hurst exponent
0.8, waves 2.5 um to 0.8 mm, roll-off 0.2 mm; the solved contact is 6 to 31 % higher."""
LOSS_TANGENTS = (0.1, 0.4)
"""Loss tangent of a compound of which it is not known (assumed; drawn evenly in its logarithm)."""
LOSS_TANGENT = 0.2
GENT_SLOPE = 0.045
"""d ln E / d Shore A near 65 (Gent 1958)."""
REFERENCE_HARDNESS = 60.0
SLOPE = 0.105 / 1e-6
"""rms slope h' over Rq (1/m) of the waves of ``HYSTERESIS``."""
STEEPEST = 1.26
"""rms slope that no floor passes, however high its waves (assumed): a hysteresis of 0.15."""
CONTACT_PRESSURE = 300e3
"""Pa, of lugs under a shoe: where no pressure is known."""
LEAST_PRESSURE = 1.0
"""Pa; below it the real area per load is that in the limit of light loads."""


def real_slope(rq: ArrayLike) -> Array:
    """Return the rms slope (1) of the waves that a stylus sees of a surface of Rq (m)."""
    slope = SLOPE * np.asarray(rq)
    return slope / np.sqrt(1 + (slope / STEEPEST) ** 2)


FULL_CONTACT = 3.4e6
"""p_R over the rms slope (Pa): E* / sqrt(2), with E* of Shore A 60 (2.97 MPa at 8.3 um). Stiffer
compounds have less area and more strength; c holds the rest."""
REFERENCE_FULL_CONTACT = FULL_CONTACT * float(real_slope(ROUGHNESS))


def relative_area(pressure: ArrayLike, full_contact: ArrayLike) -> Array:
    """Return a(p): real contact area a load, over that of Rq 8.3 um at the pressure of the pins.

    Parameters:
        pressure: Pa, above 0.
        full_contact: p_R of the pair, Pa.
    """
    share = erf(np.asarray(pressure) / full_contact) / pressure
    return share * PIN_PRESSURE / erf(PIN_PRESSURE / REFERENCE_FULL_CONTACT)


SOURCE = "law of the pair, calibrated on published measurements (underfoot studies run corpus)"
RANGES = {
    "sliding speed": ValidityRange(0.01, 1.0, "m/s", "speeds of the measurements behind the law"),
    "viscosity": ValidityRange(0.5e-3, 0.3, "Pa*s", "fluids of the measurements behind the law"),
}
Family = Literal["aqueous", "detergent", "oil", "dry"]
HIGHEST_WET, HIGHEST_DRY = 1.39, 3.0
"""Highest COF of a contact: static friction of strips of soft natural rubber under 90 % glycerol on
steel, the highest read under a fluid (Yamaguchi, Katsurashima, Shibata and Hokkirigawa, design of
tread blocks; sliding they read 1.18); of clean soft rubber dry (assumed)."""
UNITS = {"kappa": "Pa*m", "full_contact": "Pa"}
SPREADS = ("sd_laboratory", "sd_dry_part", "sd_pair", "sd_reading")
LABORATORY, DRY_PART = "laboratory", "dry part of the laboratory"


@dataclass(frozen=True, slots=True)
class PairConstants:
    """Constants of the law, each of one shape; SI.

    ``film`` by family of fluid: what a boundary film leaves; ``dry``: the dry-like part at rest;
    ``kappa_0`` in Pa m; ``surfactant``: share of adhesion left under a detergent;
    ``roughness_exponent`` n and ``hardness_exponent`` c.
    """

    film_aqueous: Array
    film_oil: Array
    dry: Array
    kappa_0: Array
    surfactant: Array
    roughness_exponent: Array
    hardness_exponent: Array


@dataclass(frozen=True, slots=True)
class ContactTerms:
    """What contact friction is made of, each of one shape.

    ``film`` and ``rest``: adhesion COF that a boundary film leaves and that of the contact at rest
    at the real area of Rq 8.3 um; ``hysteresis`` COF; ``kappa`` (Pa m); ``full_contact`` p_R (Pa).
    """

    film: Array
    rest: Array
    hysteresis: Array
    kappa: Array
    full_contact: Array

    def adhesion(self, pressure: ArrayLike, drag: ArrayLike | None) -> Array:
        """Return the adhesion COF at a pressure (Pa, above 0) and viscosity x speed (None: dry)."""
        area = relative_area(pressure, self.full_contact)
        dry = self.rest * area
        if drag is None:
            return dry
        shed = np.exp(-np.asarray(drag) / self.kappa)
        return np.minimum(dry, self.rest) * shed + np.minimum(dry, self.film) * (1 - shed)


TERMS = tuple(ContactTerms.__dataclass_fields__)


def contact_terms(
    constants: PairConstants, numbers: Mapping[str, ArrayLike], *, family: Family
) -> ContactTerms:
    """Return the terms of the contact friction.

    Parameters:
        constants: Numbers or draws that broadcast with ``numbers``.
        numbers: ``sole_rq`` and ``floor_rq`` (m), ``shore_a`` of the compound; where known its
            ``loss_tangent``, ``sole_slope`` and ``floor_slope`` of scans, and in place of closed
            forms the ``hysteresis`` (COF) and ``full_contact`` p_R (Pa) of the pair.
        family: Of the fluid; "aqueous" are water and its mixtures without a surfactant.
    """
    slopes = [
        np.asarray(numbers.get(f"{part}_slope", real_slope(numbers[f"{part}_rq"])))
        for part in ("sole", "floor")
    ]
    flat = erf(CONTACT_PRESSURE / (FULL_CONTACT * slopes[0]))
    draining = np.hypot(np.asarray(numbers["sole_rq"]) * (1 - flat), numbers["floor_rq"])
    kappa = constants.kappa_0 * (draining / ROUGHNESS) ** constants.roughness_exponent
    strength = np.exp(
        -constants.hardness_exponent
        * GENT_SLOPE
        * (np.asarray(numbers["shore_a"]) - REFERENCE_HARDNESS)
    )
    if family == "detergent":
        strength = strength * constants.surfactant
    loss = np.asarray(numbers.get("loss_tangent", LOSS_TANGENT)) / LOSS_TANGENT
    hysteresis = numbers.get("hysteresis", HYSTERESIS / SLOPE * loss * slopes[1])
    film = constants.film_oil if family == "oil" else constants.film_aqueous
    return ContactTerms(
        film * strength,
        (constants.film_aqueous + constants.dry) * strength,
        np.asarray(hysteresis),
        kappa,
        np.asarray(numbers.get("full_contact", FULL_CONTACT * np.hypot(*slopes))),
    )


@dataclass(frozen=True, slots=True)
class UnexpectedReading:
    """What a machine read outside the 95 % (``low`` to ``high``) that were foretold; its unit."""

    machine: str
    unit: str
    value: float
    low: float
    middle: float
    high: float

    @property
    def text(self) -> Message:
        """What was read and what was foretold."""
        digits = 2 if self.unit == "COF" else 0
        read, middle, low, high = (
            f"{x:.{digits}f}" for x in (self.value, self.middle, self.low, self.high)
        )
        return Message(
            "{machine} read {read} {unit} where {middle} (95 %: {low} to {high}) was foretold of "
            "this floor. The reading counts; check it, and the floor's roughness.",
            machine=self.machine, read=read, unit=self.unit, middle=middle, low=low, high=high,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class PairDraws:
    """Joint draws of the constants and of the errors of ln COF, each (draws,).

    ``sd_laboratory``, ``sd_dry_part``, ``sd_pair``, ``sd_reading`` are the standard deviations of
    the errors of a laboratory, of its dry-like part, of a pair and of a reading. ``errors`` holds
    those that readings of one laboratory determined, by name; the others are drawn. ``basis`` says
    what the draws are those of, ``notes`` what a user should know of them, ``outside`` the readings
    that were not foretold.
    """

    constants: PairConstants
    sd_laboratory: Array
    sd_dry_part: Array
    sd_pair: Array
    sd_reading: Array
    errors: Mapping[str, Array] = field(default_factory=dict)
    source: str = SOURCE
    basis: str = ""
    notes: tuple[str, ...] = ()
    outside: tuple[UnexpectedReading, ...] = ()

    @property
    def count(self) -> int:
        """Number of draws."""
        return self.sd_pair.size

    def rows(self, index: ArrayLike) -> PairDraws:
        """Return the draws of some rows."""
        at = np.asarray(index)
        columns = {name: values[at] for name, values in self.columns().items()}
        told = {name: getattr(self, name) for name in ("basis", "notes", "outside")}
        return replace(_from_columns(columns, self.source), **told)

    def error(self, name: str, deviation: Array, seed: int) -> Array:
        """Return the error of ln COF with a name: as determined, or drawn.

        The same name and seed give the same normal numbers: what two cases have in common
        cancels between them.
        """
        if name in self.errors:
            return self.errors[name]
        return deviation * ndtri(named_shares(seed, name, self.count))

    def columns(self) -> dict[str, Array]:
        """Return every array by name, as a file of draws has them."""
        names = PairConstants.__dataclass_fields__
        return {
            **{name: getattr(self.constants, name) for name in names},
            **{name: getattr(self, name) for name in SPREADS},
            **self.errors,
        }

    def write(self, path: Path) -> None:
        """Write the draws as CSV; the first line says where they come from."""
        columns = self.columns()
        with path.open("w", newline="", encoding="utf-8") as stream:
            stream.write(f"# source: {self.source}\n")
            table = csv.writer(stream, lineterminator="\n")
            table.writerow(columns)
            table.writerows([f"{x:.6g}" for x in row] for row in np.transpose([*columns.values()]))


def even_rows(weight: Array, count: int, begin: float) -> Array:
    """Return ``count`` rows of draws, each as often as its share of the weight, to within one.

    Parameters:
        weight: Of each draw, (n,); their sum is 1.
        count: Number of rows.
        begin: Above 0 to 1: where in its part of the whole weight each row is taken.
    """
    places = (np.arange(count) + begin) / count
    return np.searchsorted(np.cumsum(weight), places).clip(max=weight.size - 1)


def _from_columns(columns: Mapping[str, Array], source: str) -> PairDraws:
    rest = dict(columns)
    constants = PairConstants(*(rest.pop(name) for name in PairConstants.__dataclass_fields__))
    spreads = [rest.pop(name) for name in SPREADS]
    return PairDraws(constants, *spreads, errors=rest, source=source)


def read_pair_draws(path: Path) -> PairDraws:
    """Return the draws in a file that ``PairDraws.write`` made.

    Raises:
        DataError: No such file, or one without the columns of the law or with a value that is no
            number.
    """
    try:
        head, *lines = path.read_text(encoding="utf-8").splitlines()
        rows = list(csv.reader(lines))
        values = np.array(rows[1:], dtype=float)
        if values.ndim != 2 or not np.isfinite(values).all() or len(values) < 100:
            raise ValueError("fewer than 100 rows, or a value that is not finite")
        columns = dict(zip(rows[0], values.T, strict=True))
        return _from_columns(columns, head.removeprefix("# source:").strip())
    except (OSError, ValueError, IndexError, KeyError, TypeError) as error:
        raise DataError(
            Message(
                "{name} holds no draws of the law of a pair ({error})", name=path.name, error=error
            ),
            where=str(path),
            allowed="a file that underfoot calibrate pair wrote",
        ) from error


@cache
def packaged_pair_draws() -> PairDraws:
    """Return the draws calibrated on the packaged corpus of measurements."""
    folder = resources.files("underfoot") / "data" / "friction"
    with resources.as_file(folder / "pair_draws.csv") as path:
        return read_pair_draws(path)


@dataclass(frozen=True, slots=True)
class Pair:
    """What is known of a sole, a floor and a fluid.

    ``sole_rq`` and ``floor_rq`` (m) of waves up to 0.8 mm and ``loss_tangent`` are (low, high):
    equal where measured, else the range over which it is drawn, evenly in its logarithm.
    ``sole_slope`` and ``floor_slope`` are rms slopes of scans. ``hysteresis`` is the COF that the
    package's own theory gives for the compound's spectrum, ``hysteresis_origin`` names where it
    comes from; None takes the closed form. ``full_contact`` is p_R (Pa) where a contact table gives
    it. ``contact_deviation`` is the standard deviation of ln of both where a contact table gives
    them: finer waves make more of either. ``polymer`` names what soles of one compound share of
    friction and loss, whatever their hardness and roughness. ``shore_a_deviation`` is the standard
    deviation of the hardness. ``measured`` tells roughness that was measured from one assumed.
    """

    shore_a: float
    sole_rq: tuple[float, float]
    floor_rq: tuple[float, float]
    family: Family
    hysteresis: float | None = None
    hysteresis_origin: str = "given"
    full_contact: float | None = None
    polymer: str | None = None
    shore_a_deviation: float = 0.0
    loss_tangent: tuple[float, float] = LOSS_TANGENTS
    sole_slope: float | None = None
    floor_slope: float | None = None
    contact_deviation: float = 0.0
    measured: tuple[bool, bool] = (False, False)

    @property
    def compound_and_floor(self) -> str:
        """Name of compound and floor: cases that share it share the error of the pair."""
        sole, floor = (f"{1e6 * low:.3g} to {1e6 * high:.3g} um" for low, high in self._rq)
        compound = self.polymer or f"Shore A {self.shore_a:.3g}, Rq {sole}"
        return f"pair: {compound} on Rq {floor}, {self.family}"

    @property
    def sole_roughness(self) -> str:
        """Name of the share, 0 to 1, of the range of the sole's roughness, where one is known."""
        return f"sole_rq {self.sole_rq[0]:.3g} {self.sole_rq[1]:.3g}"

    @property
    def _rq(self) -> tuple[tuple[float, float], tuple[float, float]]:
        return self.sole_rq, self.floor_rq

    def draw_inputs(self, draws: PairDraws, seed: int) -> dict[str, Array]:
        """Return draws (draws,) of the inputs of ``PairContactLaw``, by name."""
        apart = ndtri(named_shares(seed, f"hardness {self.polymer}", draws.count))
        numbers: dict[str, ArrayLike] = {"shore_a": self.shore_a + self.shore_a_deviation * apart}
        spans = {"sole_rq": self.sole_rq, "floor_rq": self.floor_rq}
        for name, (low, high) in (spans | {"loss_tangent": self.loss_tangent}).items():
            owner = f" of {self.polymer}" if name == "loss_tangent" and self.polymer else ""
            subject = f"{name} {low:.3g} {high:.3g}{owner}"
            share = draws.errors.get(subject)
            share = named_shares(seed, subject, draws.count) if share is None else share
            numbers[name] = low * (high / low) ** share
        for name in ("hysteresis", "full_contact", "sole_slope", "floor_slope"):
            if getattr(self, name) is not None:
                numbers[name] = getattr(self, name)
        if self.contact_deviation:
            apart = ndtri(named_shares(seed, "shortest wave", draws.count))
            for name in {"hysteresis", "full_contact"} & numbers.keys():
                numbers[name] = numbers[name] * np.exp(self.contact_deviation * apart)
        dry = draws.constants.dry * np.exp(draws.error(DRY_PART, draws.sd_dry_part, seed))
        terms = contact_terms(replace(draws.constants, dry=dry), numbers, family=self.family)
        return {
            **{name: np.broadcast_to(getattr(terms, name), dry.shape) for name in TERMS},
            "laboratory": np.exp(draws.error(LABORATORY, draws.sd_laboratory, seed)),
            "pair": np.exp(draws.error(self.compound_and_floor, draws.sd_pair, seed)),
        }

    drawn = renamed_member("drawn", "draw_inputs", gone="0.4")


@dataclass(frozen=True, slots=True, repr=False)
class PairContactLaw(UncertainInputs):
    """tau = l mu_c p_c + eta V / h, mu_c as above.

    l is the factor of laboratory and pair, 1 at the median. No COF of the contact is above what was
    ever read (``HIGHEST_WET``).

    Parameters:
        pair: What is known of sole, floor and fluid.
        viscosity: Pa s; None on a dry floor.
        draws: Of the constants; the packaged ones by default.
    """

    pair: Pair
    viscosity: float | None
    draws: PairDraws = field(default_factory=packaged_pair_draws)
    medians: Mapping[str, float] = field(default_factory=dict)
    name: str = field(default="pair", init=False)
    spread_basis: str = field(
        default="without a measurement of this sole on this floor", init=False
    )

    def __post_init__(self) -> None:
        if self.viscosity is not None:
            positive(self.viscosity, "viscosity", "Pa s")
        if (self.viscosity is None) != (self.pair.family == "dry"):
            raise InputError(
                Message(
                    "a viscosity of {viscosity} and a fluid of family {family}",
                    viscosity=self.viscosity,
                    family=self.pair.family,
                ),
                where="pair",
                allowed='a viscosity and a fluid, or None and "dry"',
            )
        for low, high in (self.pair.sole_rq, self.pair.floor_rq):
            if not 0 < low <= high:
                raise InputError(f"{low:g} to {high:g} m", where="pair", allowed="Rq above 0")
        if not self.medians:
            drawn = self.pair.draw_inputs(self.draws, 0)
            medians = {name: float(np.median(values)) for name, values in drawn.items()}
            # the median of many draws of a symmetric error is 1
            for name, error in (("laboratory", LABORATORY), ("pair", self.pair.compound_and_floor)):
                if error not in self.draws.errors:
                    medians[name] = 1.0
            object.__setattr__(self, "medians", medians)
        basis = self.draws.basis or ("calibrated to readings" if self.draws.errors else "")
        if basis:
            object.__setattr__(self, "spread_basis", basis)

    @property
    def full_contact(self) -> float:
        """Pressure p_R (Pa) of the pair's real area."""
        return self.medians["full_contact"]

    @property
    def highest(self) -> float:
        """COF that no contact is above."""
        return HIGHEST_DRY if self.viscosity is None else HIGHEST_WET

    @property
    def source(self) -> str:
        """Source of the calibration."""
        return self.draws.source

    @property
    def assumptions(self) -> tuple[Message, ...]:
        """What no measurement stands behind."""
        words: list[Message] = [*map(Message.plain, self.draws.notes)]
        if LABORATORY not in self.draws.errors:
            words.append(
                Remark(
                    "friction.pair",
                    "nobody measured this sole on this floor; a reading of your own narrows it "
                    "(underfoot calibrate pair).",
                )
            )
        if self.pair.family == "dry":
            words.append(
                Remark(
                    "friction.pair",
                    "no dry reading stands behind the law; dry adhesion is what water leaves at "
                    "rest, with the real contact area of the roughness (Persson 2001)",
                )
            )
        both = zip(("shoe", "floor"), self.pair._rq, self.pair.measured, strict=True)
        for part, (low, high), measured in both:
            if high > low and not measured:
                words.append(
                    Remark(
                        f"{part}.roughness",
                        "not given; the friction is drawn over Rq = {low:.2g} to {high:.2g} um",
                        low=1e6 * low, high=1e6 * high,
                    )
                )  # fmt: skip
        low, high = self.pair.loss_tangent
        if self.pair.hysteresis is None and high > low:
            words.append(
                Remark(
                    "shoe.material.loss_tangent",
                    "not given; the hysteresis is drawn over {low:g} to {high:g}",
                    low=low, high=high,
                )
            )  # fmt: skip
        elif self.pair.hysteresis is None:
            words.append(
                Remark(
                    "friction.pair", "hysteresis from a loss tangent of {tangent:g}", tangent=low
                )
            )
        else:
            words.append(
                Remark(
                    "friction.pair",
                    "hysteresis COF {cof:.3f} from {origin}",
                    cof=self.pair.hysteresis, origin=self.pair.hysteresis_origin,
                )
            )  # fmt: skip
        return tuple(words)

    @property
    def inputs(self) -> dict[str, SourcedValue]:
        """Medians with the standard deviations of the draws, which are joint."""
        drawn = self.pair.draw_inputs(self.draws, 0)
        return {
            name: SourcedValue(value, UNITS.get(name, "1"), self.source, float(drawn[name].std()))
            for name, value in self.medians.items()
        }

    def joint_draws(self, samples: int, seed: int) -> dict[str, Array]:
        """Return (samples,) joint draws of the inputs; cases with one seed share what they can."""
        rows = np.arange(samples) % self.draws.count
        return self.pair.draw_inputs(self.draws.rows(rows), seed)

    def known_errors(self, samples: int) -> Mapping[str, Array]:
        """Return (samples,) errors that readings determined, by name, in the rows of the draws."""
        return self.draws.rows(np.arange(samples) % self.draws.count).errors

    def at(self, values: Mapping[str, float]) -> PairContactLaw:
        """Return the law at other numbers."""
        present = {**self.medians, **{k: v for k, v in values.items() if k in self.medians}}
        return PairContactLaw(
            self.pair, values.get("viscosity", self.viscosity), self.draws, present
        )

    def contact_shear(self, pressure: Array, velocity: Array) -> tuple[Array, ...]:
        m = self.medians
        terms = ContactTerms(*(np.asarray(m[name]) for name in TERMS))
        factor = m["laboratory"] * m["pair"] * pressure
        drag = None if self.viscosity is None else self.viscosity * velocity
        adhesion = factor * terms.adhesion(np.maximum(pressure, LEAST_PRESSURE), drag)
        hysteresis = factor * terms.hysteresis
        most = np.minimum(1.0, self.highest * pressure / np.maximum(adhesion + hysteresis, 1e-30))
        return adhesion * most, hysteresis * most

    @property
    def ranges(self) -> Mapping[str, ValidityRange]:
        return {"sliding speed": RANGES["sliding speed"], **FILM_RANGE, **RANGES}
