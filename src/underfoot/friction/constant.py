"""Friction given by the user as two constant coefficients."""

from dataclasses import dataclass, field

from underfoot.core import InputError, SourcedValue
from underfoot.core.arrays import Array
from underfoot.core.checks import not_negative
from underfoot.core.remark import Message

from .law import UncertainInputs


@dataclass(frozen=True, slots=True, repr=False)
class ConstantLaw(UncertainInputs):
    """Adhesion and hysteresis in proportion to the contact pressure: tau = mu p_c; plus eta V / h.

    Parameters:
        cof_adhesion, cof_hysteresis: Coefficients of the contact, 1.
        source: Where they come from.
        viscosity: Pa s; None for a dry floor.
        adhesion_deviation, hysteresis_deviation: Standard deviations, 1, taken as independent; None
            when not known.
    """

    cof_adhesion: float
    cof_hysteresis: float
    source: str
    viscosity: float | None = None
    adhesion_deviation: float | None = None
    hysteresis_deviation: float | None = None
    name: str = field(default="constant", init=False)
    assumptions: tuple[Message, ...] = field(
        default=(Message("Contact friction does not depend on pressure, speed or film."),),
        init=False,
    )

    def __post_init__(self) -> None:
        for label in ("cof_adhesion", "cof_hysteresis"):
            not_negative(getattr(self, label), label)
        for label in ("adhesion_deviation", "hysteresis_deviation"):
            if getattr(self, label) is not None:
                not_negative(getattr(self, label), label)
        UncertainInputs.__post_init__(self)
        if not self.source.strip():
            raise InputError(
                "no source", where="source", remedy="Say where the coefficients come from"
            )

    def contact_shear(self, pressure: Array, velocity: Array) -> tuple[Array, ...]:
        return self.cof_adhesion * pressure, self.cof_hysteresis * pressure

    @property
    def inputs(self) -> dict[str, SourcedValue]:
        """The two coefficients."""
        pairs = (
            ("cof_adhesion", self.cof_adhesion, self.adhesion_deviation),
            ("cof_hysteresis", self.cof_hysteresis, self.hysteresis_deviation),
        )
        return {
            name: SourcedValue(value, "1", self.source, deviation)
            for name, value, deviation in pairs
            if value > 0 or deviation is not None
        }
