"""Friction from the dry adhesion of the pair and the share that a fluid leaves (Eq. 26)."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from underfoot.core import SourcedValue, ValidityRange
from underfoot.core.arrays import Array
from underfoot.core.remark import Message
from underfoot.fluid import AdhesionBlocking

from .law import FILM_RANGE, PIN_PRESSURE, REPORT, UncertainInputs, coefficient

NORMAL_FORCE = 20.9
"""N, the load of the tests behind Eq. 26 (G.3.1)."""
RANGES = {
    "contact pressure": ValidityRange(
        0.0, PIN_PRESSURE, "Pa", f"{REPORT}, G.3.1: one load; lower assumed"
    ),
    "sliding speed": ValidityRange(0.0, 0.01, "m/s", f"{REPORT}, G.3.1: one speed"),
}


@dataclass(frozen=True, slots=True, repr=False)
class AdhesionBlockingLaw(UncertainInputs):
    """Adhesion by Eq. 26 from the dry adhesion of the pair, its measured hysteresis, eta V / h.

    mu_adhesion = alpha / N + beta mu_dry, N the load that alpha was measured at, and at most
    mu_dry: a fluid adds no adhesion. The report shows dry adhesion and hysteresis of its pairs
    only in figures: both must be given.

    Parameters:
        blocking: alpha and beta of the fluid.
        dry_adhesion, cof_hysteresis: Coefficients of the pair: dry adhesion = dry minus oiled
            friction (Eq. 24), hysteresis = oiled friction (Eq. 23), 1.
        viscosity: Pa s; None leaves out the viscous part.
    """

    blocking: AdhesionBlocking
    dry_adhesion: SourcedValue
    cof_hysteresis: SourcedValue
    viscosity: float | None = None
    name: str = field(default="adhesion_blocking", init=False)
    assumptions: tuple[Message, ...] = field(
        default=(
            Message(
                "Contact friction is proportional to the contact pressure and the same at all "
                "speeds."
            ),
            Message("A fluid blocks the same share of adhesion on every pair (R2 = 0.49)."),
        ),
        init=False,
    )

    @property
    def source(self) -> str:
        """Where alpha and beta come from."""
        return self.blocking.source

    @property
    def cof_parts(self) -> tuple[float, float]:
        """Coefficients of the contact (adhesion, hysteresis)."""
        dry = coefficient(self.dry_adhesion, "dry_adhesion")
        left = float(self.blocking.lubricated_adhesion_cof(dry))
        return min(left, dry), coefficient(self.cof_hysteresis, "cof_hysteresis")

    @property
    def error_of_model(self) -> float | None:
        """Spread of Eq. 26 about its own tests (mean error 1.05 N) over their load, 1."""
        dry = coefficient(self.dry_adhesion, "dry_adhesion")
        force = self.blocking.estimate(dry * NORMAL_FORCE).uncertainty
        return None if force is None else force / NORMAL_FORCE

    def contact_shear(self, pressure: Array, velocity: Array) -> tuple[Array, ...]:
        return tuple(part * pressure for part in self.cof_parts)

    @property
    def ranges(self) -> Mapping[str, ValidityRange]:
        return {**RANGES, **FILM_RANGE}
