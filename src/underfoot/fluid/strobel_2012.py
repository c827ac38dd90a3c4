"""Adhesion left under a fluid in boundary lubrication: Strobel et al. (2012), Eq. 26."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, InputError, SourcedValue, ValidityRange, breaches, unknown_name
from underfoot.core.arrays import scalar_or_array
from underfoot.core.remark import Message

NAME = "strobel_2012"
SOURCE = (
    "C. M. Strobel, P. L. Menezes, M. R. Lovell, K. E. Beschorner, Analysis of the contribution "
    "of adhesion and hysteresis to shoe-floor lubricated friction in the boundary lubrication "
    "regime, Tribology Letters 47 (2012) 341-347; grant report G.3, Eq. 26 and Table 5"
)
NORMAL_FORCE = 20.9
"""N, the only load of the tests (pin of 10 mm diameter: 266 kPa)."""
MEAN_ERROR = 1.05
"""N, mean absolute error of Eq. 26 over the tests (G.3.2)."""
RANGES = {
    "normal_force": ValidityRange(20.9, 20.9, "N", "G.3: one load"),
    "speed": ValidityRange(0.01, 0.01, "m/s", "G.3: one speed"),
    "viscosity": ValidityRange(0.52e-3, 74.6e-3, "Pa*s", "G.3: water to canola oil"),
}


@dataclass(frozen=True, slots=True)
class AdhesionBlocking:
    """How much adhesion friction a fluid leaves: F_lubricated = alpha + beta F_dry.

    ``alpha`` (N, at ``normal_force``, N) is what the fluid itself carries, ``beta`` (1) how much of
    the dry adhesion of the shoe-floor pair comes through.
    """

    alpha: float
    beta: float
    source: str = SOURCE
    normal_force: float = NORMAL_FORCE

    def __post_init__(self) -> None:
        if not (math.isfinite(self.normal_force) and self.normal_force > 0.0):
            what = f"normal_force is {self.normal_force:g} N"
            raise InputError(what, where="normal_force", allowed="above 0 N")
        for name, value in (("alpha", self.alpha), ("beta", self.beta)):
            if not (math.isfinite(value) and value >= 0.0):
                raise InputError(
                    Message("{name} is {value:g}", name=name, value=value),
                    where=name,
                    allowed="0 or more",
                )

    def lubricated_adhesion(self, dry_adhesion: ArrayLike) -> Any:
        """Return the adhesion friction force under the fluid, N (Eq. 26), at ``normal_force``.

        ``dry_adhesion`` in N, any shape, >= 0. Eq. 26 is a regression (R2 = 0.49): below
        ``crossover`` it exceeds the dry adhesion itself; the value is returned as it is.
        """
        dry = np.asarray(dry_adhesion, dtype=float)
        if not np.all(np.isfinite(dry) & (dry >= 0.0)):
            raise InputError(
                "a force is negative or missing", where="dry_adhesion", allowed="0 N or more"
            )
        result = self.alpha + self.beta * dry
        return scalar_or_array(result)

    def lubricated_adhesion_cof(self, dry_adhesion_cof: ArrayLike) -> Any:
        """Return the adhesion part of the COF under the fluid: alpha / normal_force + beta COF_dry.

        Exact at that load. At another load it assumes that adhesion grows in proportion to the
        load, which the tests can't tell: ``strobel_breaches`` marks it.
        """
        dry = np.asarray(dry_adhesion_cof, dtype=float)
        return self.lubricated_adhesion(dry * self.normal_force) / self.normal_force

    def estimate(self, dry_adhesion: float) -> SourcedValue:
        """Return Eq. 26 with the uncertainty of the regression, N.

        Standard deviation from the published mean absolute error of 1.05 N, taken as normal:
        1.05 sqrt(pi / 2) = 1.32 N.
        """
        note = ""
        if dry_adhesion < self.crossover:
            note = (
                f"more than the dry adhesion: below {self.crossover:.3g} N the regression says "
                "that the fluid adds adhesion; no such reading is known"
            )
        return SourcedValue(
            self.lubricated_adhesion(dry_adhesion),
            "N",
            source=self.source,
            uncertainty=MEAN_ERROR * math.sqrt(math.pi / 2.0),
            note=note,
        )

    @property
    def crossover(self) -> float:
        """Dry adhesion, N, below which Eq. 26 gives more than it: alpha / (1 - beta)."""
        return self.alpha / (1.0 - self.beta) if self.beta < 1.0 else math.inf


BLOCKING: Mapping[str, AdhesionBlocking] = MappingProxyType(
    {
        "water": AdhesionBlocking(4.3263, 0.0531),
        "detergent 1.5 %": AdhesionBlocking(2.6125, 0.0399),
        "glycerol 25 %": AdhesionBlocking(2.5707, 0.0822),
        "glycerol 50 %": AdhesionBlocking(2.8006, 0.1027),
        "glycerol 75 %": AdhesionBlocking(2.3826, 0.0927),
        "canola oil": AdhesionBlocking(1.7556, 0.0106),
    }
)
"""Table 5, by fluid."""


def adhesion_blocking(fluid: str) -> AdhesionBlocking:
    """Return alpha and beta of one of the six fluids of Table 5.

    Raises:
        InputError: Another fluid: Eq. 26 has no rule from viscosity to alpha and beta.

    >>> adhesion_blocking("water").alpha
    4.3263
    """
    try:
        return BLOCKING[fluid]
    except KeyError:
        raise unknown_name("fluid with measured adhesion", fluid, BLOCKING) from None


def strobel_breaches(
    *, normal_force: ArrayLike, speed: ArrayLike, viscosity: ArrayLike | None = None
) -> list[Breach]:
    """Return in which respect Eq. 26 is used beyond its tests (20.9 N, 0.01 m/s).

    Parameters:
        normal_force: N.
        speed: Of sliding, m/s.
        viscosity: Pa s; None leaves it out.
    """
    values: dict[str, ArrayLike] = {"normal_force": normal_force, "speed": speed}
    if viscosity is not None:
        values["viscosity"] = viscosity
    return breaches(NAME, RANGES, values)
