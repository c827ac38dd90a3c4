"""Eq. (1): from shear stresses under the sole to the coefficient of friction and its parts."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError, SourcedValue
from underfoot.core.arrays import Array
from underfoot.core.remark import Message

from .law import FrictionParts
from .sampled_cof import SampledCof

NO_SPREAD = "an input of the friction law came without a standard deviation"
HELD = "spread of the friction law and its inputs, contact and film held"


@dataclass(frozen=True, slots=True)
class FrictionCoefficients:
    """Coefficient of friction of the sole and its parts; ``cof`` is their sum.

    Forces in N. ``fluid_load`` is the part of ``normal_force`` that the fluid carries.
    """

    cof: SourcedValue
    cof_adhesion: SourcedValue
    cof_hysteresis: SourcedValue
    cof_viscous: SourcedValue
    friction_force: float
    normal_force: float
    fluid_load: float


def cof(
    parts: FrictionParts,
    contact_pressure: ArrayLike,
    fluid_pressure: ArrayLike,
    *,
    spacing: float,
    wet: ArrayLike | None = None,
    area: Array | float = 1.0,
    film_area: Array | float = 1.0,
    sampled: SampledCof | None = None,
    source: str = "",
) -> FrictionCoefficients:
    """Return the coefficient of friction of the whole sole and its parts (Eq. 1).

    COF = sum(tau_adhesion + tau_hysteresis + tau_viscous) dA / sum(p_c + p_f) dA. The report
    writes Eq. (1) as (COF_asp F_asp + F_fluid) / F_tot; here COF_asp may differ from place to
    place.

    Parameters:
        parts: Shear stresses from a law, Pa.
        contact_pressure, fluid_pressure: Pa, of the same shape; 0 outside contact and film.
        spacing: Side of a cell, m.
        wet: Where a film is: the viscous part counts only there. None counts it everywhere.
        area, film_area: What each cell stands for in cells, (nx, ny): of contact and shear, and of
            the fluid's pressure. Cells that the edge of a lug cuts are not 1.
        sampled: Draws of the same law (``sampled_cof``): they give standard deviations and
            intervals; None leaves these out, with the reason.
        source: Name and origin of the law, for the result.

    The part of the floor's shear that comes from the pressure gradient, (h/2) dp/dx, is left out;
    by partial integration it is sum(p_f dh/dx / 2) dA, the fluid load times half the slope of the
    film under it.

    Raises:
        InputError: Shapes that differ, values that are not finite, no normal force.
    """
    if not spacing > 0:
        raise InputError(f"{spacing:g} m is not positive", where="spacing", allowed="above 0")
    contact = np.asarray(contact_pressure, dtype=float)
    fluid = np.asarray(fluid_pressure, dtype=float)
    mask = np.ones(contact.shape, dtype=bool) if wet is None else np.asarray(wet, dtype=bool)
    shears = {"adhesion": parts.adhesion, "hysteresis": parts.hysteresis, "viscous": parts.viscous}
    for name, array in {**shears, "fluid_pressure": fluid, "wet": mask}.items():
        if np.shape(array) != contact.shape:
            raise InputError(
                Message("shape {shape}", shape=str(np.shape(array))),
                where=name,
                allowed=f"{contact.shape}",
            )
    shears["viscous"] = np.where(mask, parts.viscous, 0.0)
    for name, array in {**shears, "contact_pressure": contact, "fluid_pressure": fluid}.items():
        if not np.isfinite(array).all():
            raise InputError("a value is not finite", where=name)
    cell = spacing**2
    fluid_load = float((fluid * film_area).sum()) * cell
    normal = float((contact * area).sum()) * cell + fluid_load
    if not normal > 0:
        raise InputError(
            Message("the normal force is {normal:.3g} N", normal=normal),
            where="contact_pressure",
            allowed="above 0",
        )
    coefficients = {
        name: float((array * area).sum()) * cell / normal for name, array in shears.items()
    }
    total = sum(coefficients.values())

    def value(name: str, number: float) -> SourcedValue:
        plain = SourcedValue(number, "1", source=source, reason=NO_SPREAD)
        if sampled is None:
            return plain
        return replace(sampled.sourced_value(name, plain), note=HELD if name == "cof" else "")

    return FrictionCoefficients(
        cof=value("cof", total),
        cof_adhesion=value("adhesion", coefficients["adhesion"]),
        cof_hysteresis=value("hysteresis", coefficients["hysteresis"]),
        cof_viscous=value("viscous", coefficients["viscous"]),
        friction_force=total * normal,
        normal_force=normal,
        fluid_load=fluid_load,
    )
