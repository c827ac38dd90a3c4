"""What all laws have in common: checked arguments, the viscous part, tested ranges."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import Breach, InputError, Range, SourcedValue, breaches

from .law import FrictionParts

Array = NDArray[np.float64]
SMALLEST_FILM = 2e-7
"""m: the viscous part counts no film thinner than this; mean gaps of rough soles are micrometres
(Rq of the report's soles 4 to 9 um), so the bound acts on no converged result of theirs."""
REPORT = "final progress report on shoe-floor friction"
PIN_PRESSURE = 266.1e3
"""Pa: 20.9 N on a pin of 10 mm, the one load of the report's pin-on-disk studies (G.2.1, G.3.1)."""


def checked(
    contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
) -> tuple[Array, Array, Array]:
    """Return the arguments of a law as arrays of one shape; the speed as its magnitude."""
    given = {
        "contact_pressure": np.asarray(contact_pressure, dtype=float),
        "speed": np.asarray(speed, dtype=float),
        "film_thickness": np.asarray(film_thickness, dtype=float),
    }
    for name, array in given.items():
        if np.isnan(array).any():
            raise InputError("a value is not a number", where=name)
    if (given["contact_pressure"] < 0).any():
        raise InputError(
            f"contact pressure down to {given['contact_pressure'].min():.3g} Pa",
            where="contact_pressure",
            allowed="0 or more",
        )
    pressure, velocity, film = np.broadcast_arrays(*given.values())
    return pressure, np.abs(velocity), film


def viscous_shear(viscosity: float | None, speed: Array, film_thickness: Array) -> Array:
    """Return eta V / h in Pa, the film taken as at least ``SMALLEST_FILM``; 0 without a fluid."""
    if viscosity is None:
        return np.zeros_like(film_thickness)
    return viscosity * speed / np.maximum(film_thickness, SMALLEST_FILM)


def proportional_parts(
    adhesion: float,
    hysteresis: float,
    viscosity: float | None,
    contact_pressure: ArrayLike,
    speed: ArrayLike,
    film_thickness: ArrayLike,
) -> FrictionParts:
    """Return the shear stresses (Pa) of two constant coefficients of the contact and eta V / h."""
    pressure, velocity, film = checked(contact_pressure, speed, film_thickness)
    return FrictionParts(
        adhesion * pressure, hysteresis * pressure, viscous_shear(viscosity, velocity, film)
    )


def law_breaches(
    closure: str,
    ranges: Mapping[str, Range],
    viscosity: float | None,
    contact_pressure: ArrayLike,
    speed: ArrayLike,
    film_thickness: ArrayLike,
) -> list[Breach]:
    """Return the breaches of a law.

    A range of "contact pressure" is held against the mean contact pressure that the load sees
    (sum p^2 / sum p): single cells may go above it.
    """
    pressure, velocity, film = checked(contact_pressure, speed, film_thickness)
    total = float(pressure.sum())
    values: dict[str, ArrayLike] = {"sliding speed": velocity}
    if total > 0:
        values["contact pressure"] = float((pressure**2).sum()) / total
    found = breaches(closure, ranges, values)
    if viscosity is not None:
        bound = {"film thickness": Range(SMALLEST_FILM, 1.0, "m", "bound of the viscous part")}
        found += breaches(closure, bound, {"film thickness": film})
    return found


def coefficient(value: SourcedValue, where: str) -> float:
    """Return the number of a friction coefficient, refused when missing, negative or not finite."""
    if value.value is None:
        raise InputError(
            f"was not measured: {value.reason}",
            where=where,
            remedy="Give a measured value of your own, or choose another friction law",
        )
    if not (np.isfinite(value.value) and value.value >= 0):
        raise InputError(f"{value.value:g}", where=where, allowed="a finite number, 0 or more")
    return value.value


def checked_viscosity(viscosity: float | None) -> None:
    """Refuse a viscosity that is not positive; None is no fluid."""
    if viscosity is not None and not (np.isfinite(viscosity) and viscosity > 0):
        raise InputError(
            f"{viscosity:g} Pa s is not positive",
            where="viscosity",
            allowed="a finite number above 0, or None for a dry floor",
        )
