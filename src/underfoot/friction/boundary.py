"""Boundary friction of the pair and fluid, as measured, at every speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from underfoot.core import InputError, SourcedValue, ValidityRange
from underfoot.core.arrays import Array
from underfoot.core.deprecation import renamed_member
from underfoot.core.remark import Message

from .law import PIN_RANGES, UncertainInputs, coefficient
from .measured import BoundaryFriction, friction_left


@dataclass(frozen=True, slots=True, repr=False)
class BoundaryLaw(UncertainInputs):
    """tau = COF_BL p_c, split into hysteresis and adhesion, plus eta V / h.

    COF_BL is the friction of the pair with this fluid between the asperities and no film that
    carries load. It holds no fall with speed: what the film takes from the asperities on the scale
    of the shoe is left to the film, and the fall that a pin shows within boundary lubrication
    (Eq. 17) is another law, ``StribeckLaw``.

    Hysteresis is the friction that is left when adhesion is blocked, at most COF_BL; adhesion is
    the rest. Only their sum was measured with the fluid itself.

    Parameters:
        cof_boundary: COF_BL of the pair and fluid.
        cof_hysteresis: Friction left when adhesion is blocked, see ``friction_left``.
        viscosity: Pa s; None leaves out the viscous part.
        assumed: Further assumptions behind the numbers, in words.
    """

    cof_boundary: SourcedValue
    cof_hysteresis: SourcedValue
    viscosity: float | None = None
    assumed: tuple[Message, ...] = ()
    name: str = field(default="boundary", init=False)

    @classmethod
    def from_measured(
        cls,
        friction: BoundaryFriction | None,
        *,
        cof_hysteresis: SourcedValue | None = None,
        others: tuple[BoundaryFriction, ...] = (),
    ) -> BoundaryLaw:
        """Return the law of a measured fluid.

        Parameters:
            friction: Of the pair and fluid; None when nothing was measured.
            cof_hysteresis: Measured hysteresis of the pair; None takes ``friction_left`` of
                ``others``.
            others: Fluids measured on the same pair.

        Raises:
            InputError: No boundary friction (as for a dry floor: the report prints none) or no
                hysteresis.
        """
        if friction is None or friction.cof_boundary.value is None:
            fluid = "a dry floor" if friction is None else friction.fluid
            raise InputError(
                f"no boundary friction was measured for {fluid}",
                where="friction.cof_bl",
                remedy="Give the adhesion and hysteresis coefficients of the pair "
                "(friction.model = constant), or cof_boundary of the fluid",
            )
        notes = []
        if cof_hysteresis is None:
            cof_hysteresis = friction_left(others or (friction,))
            notes.append(
                "Hysteresis is the friction that stays at high speed under glycerol "
                "(COF_asymptote), also for other fluids."
            )
        if friction.cof_boundary.assumed:
            notes.append(friction.cof_boundary.note or f"COF_BL of {friction.fluid} is assumed.")
        if friction.pair:
            notes.append(f"Boundary friction was measured on {friction.pair}.")
        return cls(friction.cof_boundary, cof_hysteresis, friction.viscosity, tuple(notes))

    measured = classmethod(renamed_member("measured", "from_measured", gone="0.4"))

    @property
    def source(self) -> str:
        """Where COF_BL comes from."""
        return self.cof_boundary.source or "given"

    @property
    def assumptions(self) -> tuple[Message, ...]:
        """What no measurement stands behind."""
        return (
            Message(
                "Contact friction is proportional to the contact pressure and the same at all "
                "speeds."
            ),
            *self.assumed,
        )

    @property
    def cof_parts(self) -> tuple[float, float]:
        """Coefficients of the contact (adhesion, hysteresis); their sum is COF_BL."""
        boundary = coefficient(self.cof_boundary, "cof_boundary")
        hysteresis = min(coefficient(self.cof_hysteresis, "cof_hysteresis"), boundary)
        return boundary - hysteresis, hysteresis

    def contact_shear(self, pressure: Array, velocity: Array) -> tuple[Array, ...]:
        return tuple(part * pressure for part in self.cof_parts)

    @property
    def ranges(self) -> Mapping[str, ValidityRange]:
        return PIN_RANGES
