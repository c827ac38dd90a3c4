"""Adhesion as shear strength times real contact area: Bowden and Tabor (1950)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError, SourcedValue
from underfoot.core.arrays import Array
from underfoot.core.checks import not_negative, positive
from underfoot.core.remark import Message

from .law import UncertainInputs, drawn_value, with_values

ContactFraction = Callable[[Array, Array], ArrayLike]
"""Real over nominal area at (contact pressure Pa, speed m/s)."""


@dataclass(frozen=True, slots=True)
class ShearStrength:
    """Shear strength of the real contact, s(V) = s0 exp(-c log10(V / V0)^2), Pa.

    Parameters:
        strength: s0, Pa: the largest.
        source: Where it comes from.
        width: c, 1; 0 (default) is one strength at every speed. For tread rubber on dry roads
            Persson and co-workers find a bell of the logarithm of the speed, many decades wide
            (Lorenz et al., J. Chem. Phys. 142 (2015) 194701); no value for shoe compounds under a
            fluid is known.
        peak_speed: V0, m/s.
        deviation: Standard deviation of s0, Pa; None when not known.
    """

    strength: float
    source: str
    width: float = 0.0
    peak_speed: float = 0.01
    deviation: float | None = None

    def __post_init__(self) -> None:
        not_negative(self.strength, "strength", "Pa")
        not_negative(self.width, "width")
        positive(self.peak_speed, "peak_speed", "m/s")
        if not self.source.strip():
            raise InputError("no source", where="source", remedy="Say where the strength is from")

    def __call__(self, speed: ArrayLike) -> Array:
        """Return the shear strength at ``speed`` (m/s), Pa; at rest that of 1 um/s."""
        moving = np.maximum(np.abs(np.asarray(speed, dtype=float)), 1e-6)
        return self.strength * np.exp(-self.width * np.log10(moving / self.peak_speed) ** 2)


def shear_strength_from_cof(
    cof_adhesion: float, contact_pressure: float, real_contact_fraction: float, source: str
) -> ShearStrength:
    """Return the strength behind a measured adhesion: s = COF_adhesion p / (A_real / A).

    At the pressure (Pa) and real contact fraction (1) of the measurement; constant with speed.
    It holds for that pair and fluid, and only as well as the contact fraction is known.

    Parameters:
        cof_adhesion: Measured, without hysteresis.
        contact_pressure: Nominal, Pa.
        real_contact_fraction: A_real / A, above 0 to 1.
        source: Of the measurement.
    """
    if not 0 < real_contact_fraction <= 1:
        raise InputError(
            f"{real_contact_fraction:g}", where="real_contact_fraction", allowed="above 0 to 1"
        )
    if not (contact_pressure > 0 and cof_adhesion >= 0):
        raise InputError(
            f"COF {cof_adhesion:g} at {contact_pressure:g} Pa",
            where="shear_strength_from_cof",
            allowed="a pressure above 0 and a coefficient of 0 or more",
        )
    return ShearStrength(cof_adhesion * contact_pressure / real_contact_fraction, source)


@dataclass(frozen=True, slots=True, repr=False)
class BowdenTaborLaw(UncertainInputs):
    """tau = s(V) A_real/A(p, V) + mu_hysteresis(p, V) p + eta V / h.

    Parameters:
        shear_strength: Of the real contact with whatever film lies in it.
        real_contact_fraction: Callable of (pressure Pa, speed m/s):
            ``ContactTable.real_contact_fraction`` with ``outside="extend"``, or
            ``AsperityScale.contact_fraction`` of p / E*.
        cof_hysteresis: Callable of the same arguments (``ContactTable.cof_hysteresis``), or a
            number.
        viscosity: Pa s; None for a dry floor.
        contact_source: Where area and hysteresis come from, for reports.
    """

    shear_strength: ShearStrength
    real_contact_fraction: ContactFraction
    cof_hysteresis: float | ContactFraction = 0.0
    viscosity: float | None = None
    contact_source: str = ""
    name: str = field(default="bowden_tabor", init=False)

    def __post_init__(self) -> None:
        UncertainInputs.__post_init__(self)
        if not callable(self.cof_hysteresis):
            not_negative(self.cof_hysteresis, "cof_hysteresis")

    @property
    def source(self) -> str:
        """Sources of the law, the strength and the contact."""
        parts = (
            "Bowden and Tabor 1950, The Friction and Lubrication of Solids",
            self.shear_strength.source,
            self.contact_source,
        )
        return "; ".join(dict.fromkeys(part for part in parts if part))

    @property
    def assumptions(self) -> tuple[Message, ...]:
        """What no measurement stands behind."""
        return (Message("Adhesion is one shear strength times the real contact area."),)

    def contact_shear(self, pressure: Array, velocity: Array) -> tuple[Array, ...]:
        area = np.clip(np.asarray(self.real_contact_fraction(pressure, velocity)), 0.0, 1.0)
        loss = self.cof_hysteresis
        loss = np.asarray(loss(pressure, velocity)) if callable(loss) else loss
        return self.shear_strength(velocity) * area, loss * pressure, area

    @property
    def inputs(self) -> dict[str, SourcedValue]:
        """The shear strength."""
        s = self.shear_strength
        return {"shear_strength": SourcedValue(s.strength, "Pa", s.source, s.deviation)}

    def at(self, values: Mapping[str, float]) -> BowdenTaborLaw:
        """Return the law at another shear strength."""
        law = with_values(self, {k: v for k, v in values.items() if k != "shear_strength"})
        if "shear_strength" not in values:
            return law
        strength = drawn_value(values["shear_strength"], self.shear_strength.strength)
        return replace(law, shear_strength=replace(self.shear_strength, strength=strength))
