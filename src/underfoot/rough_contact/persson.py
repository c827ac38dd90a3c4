"""Persson's theory as one model: area, mean gap and hysteresis friction over pressure."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Range, breaches

from . import persson_2001, scaraggi_persson_2015, yang_persson_2008
from .persson_2001 import contact_fractions, direction_means
from .sliding_input import Modulus, modulus_function
from .theory import TheoryContact, checked_spectrum

TESTED = {
    "real_contact_fraction": Range(
        0.15, 1.0, "1", "within 25 % of half-space solutions; area 25 to 30 % low below"
    ),
}


def persson(
    pressure: ArrayLike,
    wavenumber: ArrayLike,
    spectrum: ArrayLike,
    modulus: Modulus,
    speed: float = 0.0,
    poisson_ratio: float = 0.5,
) -> TheoryContact:
    """Return area, mean gap (elastic case) and hysteresis COF at nominal pressures (Pa, > 0).

    The arguments are those of ``persson_contact_fractions``. The mean gap is given for speed 0
    or a constant modulus; otherwise None with the reason.
    """
    q, c = checked_spectrum(wavenumber, spectrum)
    p = np.atleast_1d(np.asarray(pressure, dtype=float))
    stiffness_squared, _ = direction_means(modulus, q, speed, poisson_ratio)
    area = np.array([contact_fractions(float(value), q, c, stiffness_squared)[-1] for value in p])
    elastic = speed == 0.0 or isinstance(modulus, int | float)
    gap, reason, source = None, "", persson_2001.SOURCE
    if elastic:
        young = float(np.real(modulus_function(modulus, np.zeros(1))(np.zeros(1))[0]))
        gap = yang_persson_2008.yang_persson_mean_gap(p, q, c, young, poisson_ratio)
        source += "; " + yang_persson_2008.SOURCE
    else:
        reason = "mean gap: the theory derives it from stored energy, which sliding loses"
        source = scaraggi_persson_2015.SOURCE
    cof = scaraggi_persson_2015.persson_friction(p, q, c, modulus, speed, poisson_ratio)
    return TheoryContact(
        closure="persson",
        source=source,
        pressure=p,
        real_contact_fraction=area,
        mean_gap=gap,
        cof_hysteresis=cof,
        not_estimated=reason,
        breaches=tuple(breaches("persson", TESTED, {"real_contact_fraction": area})),
    )
