"""Contact friction of a sole, a floor and a fluid from what is known of the pair.

Where sole and floor touch under a fluid, friction has a part that a boundary film leaves, a
hysteresis part, and a dry-like part that fades as the fluid is dragged in faster than it can leave
the spots of contact:

    mu_c = [s film + hysteresis + s dry exp(-eta V / kappa)] (E / E_60)^-c
    kappa = kappa_0 (R / 8.3 um)^n,  R^2 = Rq_sole^2 + Rq_floor^2
    hysteresis = min(0.0125 (loss tangent / 0.2) Rq_floor / um, 0.15)

s is the share of adhesion that a surfactant leaves (detergents; else 1). On a dry floor nothing
fades, and adhesion follows the real contact area of the roughness (Persson 2001),

    mu_dry = [(film + dry) (p_0 / p) erf(p / p_R) / erf(p_0 / p_8.3) + hysteresis] (E / E_60)^-c

with p_R in proportion to R: rough pairs grip less dry and more wet. No dry reading stands behind
it: adhesion at 8.3 um is taken as what water leaves of it at rest.

The form under a fluid is the film at single asperities (rougher pairs shed it at higher eta V); its
constants are calibrated on published measurements (``underfoot_studies.pair_law``) and are
measurements of no single pair. A laboratory, its dry-like part and a pair each have an error of
their own, learned between the sources; they are the largest part of the interval.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import erf, ndtri

from underfoot.core import DataError, InputError, Range, SourcedValue
from underfoot.core.arrays import Array
from underfoot.core.checks import positive

from .law import FILM_RANGE, PIN_PRESSURE, UncertainInputs
from .propagation import named_shares

ROUGHNESS = 8.3e-6
"""Rq (m) of the pair at which ``kappa_0`` holds: the report's polyurethane pin on vinyl."""
HYSTERESIS = 0.0125 / 1e-6
"""Hysteresis COF per metre of floor Rq at a loss tangent of 0.2: Persson theory, Hurst exponent
0.8, waves 2.5 um to 0.8 mm, roll-off 0.2 mm; the solved contact is 6 to 31 % higher."""
LOSS_TANGENT = 0.2
MOST_HYSTERESIS = 0.15
GENT_SLOPE = 0.045
"""d ln E / d Shore A near 65 (Gent 1958)."""
REFERENCE_HARDNESS = 60.0
SLOPE = 0.105 / 1e-6
"""rms slope h' over Rq (1/m) of the waves of ``HYSTERESIS``."""
FULL_CONTACT = 2.97e6 / ROUGHNESS
"""p_R over R (Pa/m): E* h' / sqrt(2), with E* of Shore A 60 and the slope of ``SLOPE``. Stiffer
compounds have less area and more strength; c holds the rest."""
SOURCE = "law of the pair, calibrated on published measurements (underfoot studies run corpus)"
RANGES = {
    "sliding speed": Range(0.01, 1.0, "m/s", "speeds of the measurements behind the law"),
    "viscosity": Range(0.5e-3, 0.3, "Pa*s", "fluids of the measurements behind the law"),
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


def contact_terms(
    constants: PairConstants, numbers: Mapping[str, ArrayLike], *, family: Family
) -> tuple[Array, Array, Array, Array]:
    """Return film, hysteresis and dry-like part (at rest) of the contact friction, and kappa.

    Parameters:
        constants: Numbers or draws that broadcast with ``numbers``.
        numbers: ``sole_rq`` and ``floor_rq`` (m), ``shore_a`` of the compound; where known its
            ``loss_tangent``, or its ``hysteresis`` (COF) in place of the closed form.
        family: Of the fluid; "aqueous" are water and its mixtures without a surfactant.

    Returns:
        tuple: Three parts of COF (1) and kappa (Pa m).
    """
    floor = np.asarray(numbers["floor_rq"])
    roughness = np.hypot(numbers["sole_rq"], floor)
    kappa = constants.kappa_0 * (roughness / ROUGHNESS) ** constants.roughness_exponent
    softness = np.exp(
        -constants.hardness_exponent
        * GENT_SLOPE
        * (np.asarray(numbers["shore_a"]) - REFERENCE_HARDNESS)
    )
    loss = np.asarray(numbers.get("loss_tangent", LOSS_TANGENT)) / LOSS_TANGENT
    hysteresis = np.minimum(numbers.get("hysteresis", HYSTERESIS * loss * floor), MOST_HYSTERESIS)
    film = constants.film_oil if family == "oil" else constants.film_aqueous
    adhesion = softness * constants.surfactant if family == "detergent" else softness
    return film * adhesion, hysteresis * softness, constants.dry * adhesion, kappa


@dataclass(frozen=True, slots=True)
class PairDraws:
    """Joint draws of the constants and of the errors of ln COF, each (draws,).

    ``sd_laboratory``, ``sd_dry_part``, ``sd_pair``, ``sd_reading`` are the standard deviations of
    the errors of a laboratory, of its dry-like part, of a pair and of a reading. ``errors`` holds
    those that readings of one laboratory determined, by name; the others are drawn.
    """

    constants: PairConstants
    sd_laboratory: Array
    sd_dry_part: Array
    sd_pair: Array
    sd_reading: Array
    errors: Mapping[str, Array] = field(default_factory=dict)
    source: str = SOURCE

    @property
    def count(self) -> int:
        """Number of draws."""
        return self.sd_pair.size

    def rows(self, index: ArrayLike) -> PairDraws:
        """Return the draws of some rows."""
        at = np.asarray(index)
        columns = {name: values[at] for name, values in self.columns().items()}
        return _from_columns(columns, self.source)

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
            f"{path.name} holds no draws of the law of a pair ({error})",
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

    ``sole_rq`` and ``floor_rq`` (m) are (low, high): equal where measured, else the range over
    which it is drawn, evenly in its logarithm. ``hysteresis`` is the COF that the package's own
    theory gives for the compound's spectrum; None takes the closed form at a loss tangent of 0.2.
    ``hysteresis_origin`` names where it comes from. ``full_contact`` is p_R (Pa) where a contact
    table gives it. ``contact_deviation`` is the standard deviation of ln of both where a contact
    table gives them: finer waves make more of either. ``polymer`` names what soles of one compound
    share, whatever their hardness and roughness. ``shore_a_deviation`` is the standard deviation of
    the hardness. ``measured`` says of which of the two the range is that of a measurement.
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
    contact_deviation: float = 0.0
    measured: tuple[bool, bool] = (False, False)

    @property
    def compound_and_floor(self) -> str:
        """Name of compound and floor: cases that share it share the error of the pair."""
        sole, floor = (f"{1e6 * low:.3g} to {1e6 * high:.3g} um" for low, high in self._rq)
        compound = self.polymer or f"Shore A {self.shore_a:.3g}, Rq {sole}"
        return f"pair: {compound} on Rq {floor}, {self.family}"

    @property
    def _rq(self) -> tuple[tuple[float, float], tuple[float, float]]:
        return self.sole_rq, self.floor_rq

    def drawn(self, draws: PairDraws, seed: int) -> dict[str, Array]:
        """Return draws (draws,) of the inputs of ``PairContactLaw``, by name."""
        apart = ndtri(named_shares(seed, f"hardness {self.polymer}", draws.count))
        numbers: dict[str, ArrayLike] = {
            "shore_a": self.shore_a + self.shore_a_deviation * apart,
        }
        for name, (low, high) in zip(("sole_rq", "floor_rq"), self._rq, strict=True):
            share = named_shares(seed, f"{name} {low:.3g} {high:.3g}", draws.count)
            numbers[name] = low * (high / low) ** share
        finer = np.exp(
            self.contact_deviation * ndtri(named_shares(seed, "shortest wave", draws.count))
            if self.contact_deviation
            else 0.0
        )
        if self.hysteresis is not None:
            numbers["hysteresis"] = self.hysteresis * finer
        film, hysteresis, dry, kappa = contact_terms(draws.constants, numbers, family=self.family)
        drawn = {
            "film": film,
            "hysteresis": np.broadcast_to(hysteresis, film.shape),
            "dry": dry * np.exp(draws.error(DRY_PART, draws.sd_dry_part, seed)),
            "kappa": kappa,
            "laboratory": np.exp(draws.error(LABORATORY, draws.sd_laboratory, seed)),
            "pair": np.exp(draws.error(self.compound_and_floor, draws.sd_pair, seed)),
        }
        if self.family == "dry":
            rq = np.hypot(numbers["sole_rq"], numbers["floor_rq"])
            full = self.full_contact * finer if self.full_contact else FULL_CONTACT * rq
            drawn["full_contact"] = np.broadcast_to(full, film.shape)
        return drawn


@dataclass(frozen=True, slots=True, repr=False)
class PairContactLaw(UncertainInputs):
    """tau = l (film + hysteresis + dry exp(-eta V / kappa)) p_c + eta V / h.

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
    spread_basis: str = field(default="of a pair that was not measured", init=False)

    def __post_init__(self) -> None:
        if self.viscosity is not None:
            positive(self.viscosity, "viscosity", "Pa s")
        if (self.viscosity is None) != (self.pair.family == "dry"):
            raise InputError(
                f"a viscosity of {self.viscosity} and a fluid of family {self.pair.family}",
                where="pair",
                allowed='a viscosity and a fluid, or None and "dry"',
            )
        for low, high in (self.pair.sole_rq, self.pair.floor_rq):
            if not 0 < low <= high:
                raise InputError(f"{low:g} to {high:g} m", where="pair", allowed="Rq above 0")
        if not self.medians:
            drawn = self.pair.drawn(self.draws, 0)
            medians = {name: float(np.median(values)) for name, values in drawn.items()}
            if not self.draws.errors:  # the median of many draws of a symmetric error is 1
                medians |= {"laboratory": 1.0, "pair": 1.0}
            object.__setattr__(self, "medians", medians)
        if self.draws.errors:
            object.__setattr__(self, "spread_basis", "calibrated to readings")

    @property
    def highest(self) -> float:
        """COF that no contact is above."""
        return HIGHEST_DRY if self.viscosity is None else HIGHEST_WET

    @property
    def source(self) -> str:
        """Of the calibration."""
        return self.draws.source

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What no measurement stands behind."""
        words = []
        if not self.draws.errors:
            words.append(
                "friction.pair: contact friction of this pair was not measured; a reading of your "
                "own narrows it (underfoot calibrate pair)."
            )
        if self.pair.family == "dry":
            words.append(
                "friction.pair: no dry reading stands behind the law; dry adhesion is what water "
                "leaves at rest, with the real contact area of the roughness (Persson 2001)"
            )
        both = zip(("shoe", "floor"), self.pair._rq, self.pair.measured, strict=True)
        for part, (low, high), measured in both:
            if high > low and not measured:
                words.append(
                    f"{part}.roughness: not given; the friction is drawn over Rq = "
                    f"{1e6 * low:.2g} to {1e6 * high:.2g} um"
                )
        if self.pair.hysteresis is None:
            words.append("shoe.material: loss tangent 0.2 for the hysteresis, no spectrum is given")
        else:
            given = f"hysteresis COF {self.pair.hysteresis:.3f} from {self.pair.hysteresis_origin}"
            words.append(f"friction.pair: {given}")
        return tuple(words)

    @property
    def inputs(self) -> dict[str, SourcedValue]:
        """Medians with the standard deviations of the draws, which are joint."""
        drawn = self.pair.drawn(self.draws, 0)
        return {
            name: SourcedValue(value, UNITS.get(name, "1"), self.source, float(drawn[name].std()))
            for name, value in self.medians.items()
        }

    def joint_draws(self, samples: int, seed: int) -> dict[str, Array]:
        """Return (samples,) joint draws of the inputs; cases with one seed share what they can."""
        rows = np.arange(samples) % self.draws.count
        return self.pair.drawn(self.draws.rows(rows), seed)

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
        factor = m["laboratory"] * m["pair"]
        hysteresis = factor * m["hysteresis"] * pressure
        if self.viscosity is None:
            area = erf(pressure / m["full_contact"])
            area *= PIN_PRESSURE / erf(PIN_PRESSURE / (FULL_CONTACT * ROUGHNESS))
            adhesion = factor * (m["film"] + m["dry"]) * area
        else:
            left = np.exp(-self.viscosity * velocity / m["kappa"])
            adhesion = factor * (m["film"] + m["dry"] * left) * pressure
        most = np.minimum(1.0, self.highest * pressure / np.maximum(adhesion + hysteresis, 1e-30))
        return adhesion * most, hysteresis * most

    @property
    def ranges(self) -> Mapping[str, Range]:
        return {"sliding speed": RANGES["sliding speed"], **FILM_RANGE, **RANGES}
