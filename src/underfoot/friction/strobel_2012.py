"""How much adhesion a fluid leaves: Strobel et al. (2012), Eq. 26."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from numpy.typing import ArrayLike

from underfoot.core import Breach, InputError, Range, SourcedValue

from ._shared import (
    PIN_PRESSURE,
    REPORT,
    checked,
    checked_viscosity,
    coefficient,
    law_breaches,
    viscous_shear,
)
from .law import FrictionDeviation, FrictionParts

SOURCE = (
    "Strobel, Menezes, Lovell, Beschorner, Tribology Letters 47 (2012) 341-347; "
    f"{REPORT}, G.3, Eq. 26 and Table 5"
)
MEAN_ERROR = 1.05
"""N: mean absolute error of Eq. 26 over all pairs and fluids (G.3.2)."""
RANGES = {
    "contact pressure": Range(0.0, PIN_PRESSURE, "Pa", f"{REPORT}, G.3.1: one load; lower assumed"),
    "sliding speed": Range(0.0, 0.01, "m/s", f"{REPORT}, G.3.1: one speed"),
}


def lubricated_adhesion(dry_adhesion: float, alpha: float, beta: float) -> float:
    """Return the adhesion force under a fluid, N: F = alpha + beta F_dry (Eq. 26).

    ``alpha`` and ``dry_adhesion`` in N at 20.9 N normal load; R2 = 0.49, mean error 1.05 N.
    """
    return alpha + beta * dry_adhesion


@dataclass(frozen=True, slots=True)
class AdhesionBlockingLaw:
    """Adhesion by Eq. 26 from the dry adhesion of the pair, its measured hysteresis, eta V / h.

    mu_adhesion = alpha / N + beta mu_dry at the load N of the tests; not more than mu_dry. The
    report shows dry adhesion and hysteresis of its pairs only in figures: both must be given.

    Parameters
    ----------
    alpha, beta
        Of the fluid: N and 1.
    dry_adhesion, cof_hysteresis
        Coefficients of the pair: dry adhesion = dry minus oiled friction (Eq. 24), hysteresis =
        oiled friction (Eq. 23), 1.
    load
        Normal load at which alpha was measured, N.
    viscosity
        Pa s; None leaves out the viscous part.
    """

    alpha: SourcedValue
    beta: SourcedValue
    dry_adhesion: SourcedValue
    cof_hysteresis: SourcedValue
    load: float = 20.9
    viscosity: float | None = None
    name: str = field(default="adhesion_blocking", init=False)
    source: str = field(default=SOURCE, init=False)
    assumptions: tuple[str, ...] = field(
        default=(
            "Contact friction is proportional to the contact pressure and the same at all speeds.",
            "A fluid blocks the same share of adhesion on every pair (R2 = 0.49).",
        ),
        init=False,
    )

    def __post_init__(self) -> None:
        for label in ("alpha", "beta", "dry_adhesion", "cof_hysteresis"):
            coefficient(getattr(self, label), label)
        if not (math.isfinite(self.load) and self.load > 0):
            raise InputError(f"{self.load:g} N is not positive", where="load", allowed="above 0")
        checked_viscosity(self.viscosity)

    @property
    def cof_parts(self) -> tuple[float, float]:
        """Coefficients of the contact (adhesion, hysteresis)."""
        dry = coefficient(self.dry_adhesion, "dry_adhesion")
        force = lubricated_adhesion(
            dry * self.load, coefficient(self.alpha, "alpha"), coefficient(self.beta, "beta")
        )
        return min(force / self.load, dry), coefficient(self.cof_hysteresis, "cof_hysteresis")

    def __call__(
        self, contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
    ) -> FrictionParts:
        """Return the shear stresses in Pa."""
        pressure, velocity, film = checked(contact_pressure, speed, film_thickness)
        adhesion, hysteresis = self.cof_parts
        return FrictionParts(
            adhesion * pressure,
            hysteresis * pressure,
            viscous_shear(self.viscosity, velocity, film),
        )

    def deviation(
        self, contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
    ) -> FrictionDeviation | None:
        """Return the standard deviations, Pa: the regression's mean error and the hysteresis'.

        A mean absolute error of 1.05 N is a standard deviation of 1.05 sqrt(pi / 2) N for normal
        errors.
        """
        hysteresis = self.cof_hysteresis.uncertainty
        if hysteresis is None:
            return None
        pressure, _, _ = checked(contact_pressure, speed, film_thickness)
        adhesion = MEAN_ERROR * math.sqrt(math.pi / 2) / self.load
        return FrictionDeviation(
            math.hypot(adhesion, hysteresis) * pressure, adhesion * pressure, hysteresis * pressure
        )

    def breaches(
        self, *, contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
    ) -> list[Breach]:
        """Return what leaves the tests: 0.01 m/s and 266.1 kPa."""
        return law_breaches(
            self.name, RANGES, self.viscosity, contact_pressure, speed, film_thickness
        )
