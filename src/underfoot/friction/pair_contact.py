"""Contact friction of a sole, a floor and a fluid from what is known of the pair.

Where sole and floor touch under a fluid, friction has a part that a boundary film leaves, a
hysteresis part, and a dry-like part that fades as the fluid is dragged in faster than it can leave
the spots of contact:

    mu_c = [film + hysteresis + dry exp(-eta V / kappa)] (E / E_60)^-c
    kappa = kappa_0 (R / 8.3 um)^n,  R^2 = Rq_sole^2 + Rq_floor^2
    hysteresis = min(0.0125 (loss tangent / 0.2) Rq_floor / um, 0.15)

The form is the film at single asperities (rougher pairs shed it at higher eta V); its constants
are calibrated on published measurements (``underfoot.calibrate.pair_law``) and are measurements of
no single pair. A laboratory, its dry-like part and a pair each have an error of their own, learned
between the sources; they are the largest part of the interval.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtri

from underfoot.core import DataError, InputError, Range, SourcedValue
from underfoot.core.arrays import Array
from underfoot.core.checks import positive

from .law import FILM_RANGE, UncertainInputs
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
MOST = 1.0
"""COF of the contact under a fluid is taken as at most this one, that of a dry sole (assumed)."""
SOURCE = "law of the pair, calibrated on published measurements (underfoot studies run corpus)"
RANGES = {
    "sliding speed": Range(0.01, 1.0, "m/s", "speeds of the measurements behind the law"),
    "viscosity": Range(0.5e-3, 0.3, "Pa*s", "fluids of the measurements behind the law"),
}
LABORATORY, DRY_PART = "laboratory", "dry part of the laboratory"


@dataclass(frozen=True, slots=True)
class PairConstants:
    """Constants of the law, each of one shape; SI.

    ``film`` by family of fluid: what a boundary film leaves; ``dry``: the dry-like part at rest;
    ``kappa_0`` in Pa m; ``roughness_exponent`` n and ``hardness_exponent`` c.
    """

    film_aqueous: Array
    film_oil: Array
    dry: Array
    kappa_0: Array
    roughness_exponent: Array
    hardness_exponent: Array


def contact_terms(
    constants: PairConstants, numbers: Mapping[str, ArrayLike], *, oil: bool
) -> tuple[Array, Array, Array, Array]:
    """Return film, hysteresis and dry-like part (at rest) of the contact friction, and kappa.

    Parameters:
        constants: Numbers or draws that broadcast with ``numbers``.
        numbers: ``sole_rq`` and ``floor_rq`` (m), ``shore_a`` of the compound; where known its
            ``loss_tangent``, or its ``hysteresis`` (COF) in place of the closed form.
        oil: Whether the fluid is an oil; else water, detergent or an aqueous mixture.

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
    film = constants.film_oil if oil else constants.film_aqueous
    return film * softness, hysteresis * softness, constants.dry * softness, kappa


@dataclass(frozen=True, slots=True)
class PairDraws:
    """Joint draws of the constants and of the errors of ln COF, each (draws,).

    ``sd_laboratory``, ``sd_dry_part``, ``sd_pair`` are the standard deviations of the errors of a
    laboratory, of its dry-like part and of a pair. ``errors`` holds those that readings of one
    laboratory determined, by name; the others are drawn.
    """

    constants: PairConstants
    sd_laboratory: Array
    sd_dry_part: Array
    sd_pair: Array
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
        spreads = ("sd_laboratory", "sd_dry_part", "sd_pair")
        return {
            **{name: getattr(self.constants, name) for name in names},
            **{name: getattr(self, name) for name in spreads},
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
    spreads = [rest.pop(name) for name in ("sd_laboratory", "sd_dry_part", "sd_pair")]
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
    """

    shore_a: float
    sole_rq: tuple[float, float]
    floor_rq: tuple[float, float]
    oil: bool
    hysteresis: float | None = None

    @property
    def compound_and_floor(self) -> str:
        """Name of compound and floor: cases that share it share the error of the pair."""
        sole, floor = (f"{1e6 * low:.3g} to {1e6 * high:.3g}" for low, high in self._rq)
        family = "oil" if self.oil else "aqueous"
        return f"pair: Shore A {self.shore_a:.3g}, Rq {sole} um on {floor} um, {family}"

    @property
    def _rq(self) -> tuple[tuple[float, float], tuple[float, float]]:
        return self.sole_rq, self.floor_rq

    def drawn(self, draws: PairDraws, seed: int) -> dict[str, Array]:
        """Return draws (draws,) of the inputs of ``PairContactLaw``, by name."""
        numbers: dict[str, ArrayLike] = {"shore_a": self.shore_a}
        for name, (low, high) in zip(("sole_rq", "floor_rq"), self._rq, strict=True):
            share = named_shares(seed, f"{name} {low:.3g} {high:.3g}", draws.count)
            numbers[name] = low * (high / low) ** share
        if self.hysteresis is not None:
            numbers["hysteresis"] = self.hysteresis
        film, hysteresis, dry, kappa = contact_terms(draws.constants, numbers, oil=self.oil)
        return {
            "film": film,
            "hysteresis": np.broadcast_to(hysteresis, film.shape),
            "dry": dry * np.exp(draws.error(DRY_PART, draws.sd_dry_part, seed)),
            "kappa": kappa,
            "laboratory": np.exp(draws.error(LABORATORY, draws.sd_laboratory, seed)),
            "pair": np.exp(draws.error(self.compound_and_floor, draws.sd_pair, seed)),
        }


@dataclass(frozen=True, slots=True, repr=False)
class PairContactLaw(UncertainInputs):
    """tau = min(l (film + hysteresis + dry exp(-eta V / kappa)), 1) p_c + eta V / h.

    l is the factor of laboratory and pair, 1 at the median.

    Parameters:
        pair: What is known of sole, floor and fluid.
        viscosity: Pa s.
        draws: Of the constants; the packaged ones by default.
    """

    pair: Pair
    viscosity: float
    draws: PairDraws = field(default_factory=packaged_pair_draws)
    medians: Mapping[str, float] = field(default_factory=dict)
    name: str = field(default="pair", init=False)
    spread_basis: str = field(default="of a pair that was not measured", init=False)

    def __post_init__(self) -> None:
        positive(self.viscosity, "viscosity", "Pa s")
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
        for part, (low, high) in (("shoe", self.pair.sole_rq), ("floor", self.pair.floor_rq)):
            if high > low:
                words.append(
                    f"{part}.roughness: not given; the friction is drawn over Rq = "
                    f"{1e6 * low:.2g} to {1e6 * high:.2g} um"
                )
        if self.pair.hysteresis is None:
            words.append("shoe.material: loss tangent 0.2 for the hysteresis, no spectrum is given")
        return tuple(words)

    @property
    def inputs(self) -> dict[str, SourcedValue]:
        """Medians with the standard deviations of the draws, which are joint."""
        drawn = self.pair.drawn(self.draws, 0)
        return {
            name: SourcedValue(
                value, "Pa*m" if name == "kappa" else "1", self.source, float(drawn[name].std())
            )
            for name, value in self.medians.items()
        }

    def joint_draws(self, samples: int, seed: int) -> dict[str, Array]:
        """Return (samples,) joint draws of the inputs; cases with one seed share what they can."""
        rows = np.arange(samples) % self.draws.count
        return self.pair.drawn(self.draws.rows(rows), seed)

    def at(self, values: Mapping[str, float]) -> PairContactLaw:
        """Return the law at other numbers."""
        present = {**self.medians, **{k: v for k, v in values.items() if k in self.medians}}
        return PairContactLaw(
            self.pair, values.get("viscosity", self.viscosity), self.draws, present
        )

    def contact_shear(self, pressure: Array, velocity: Array) -> tuple[Array, ...]:
        m = self.medians
        factor = m["laboratory"] * m["pair"]
        left = np.exp(-self.viscosity * velocity / m["kappa"])
        adhesion = factor * (m["film"] + m["dry"] * left)
        hysteresis = factor * m["hysteresis"]
        most = np.minimum(1.0, MOST / (adhesion + hysteresis))
        return adhesion * most * pressure, hysteresis * most * pressure

    @property
    def ranges(self) -> Mapping[str, Range]:
        return {"sliding speed": RANGES["sliding speed"], **FILM_RANGE, **RANGES}
