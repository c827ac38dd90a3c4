"""Persson's viscoelastic friction, with the correction of Scaraggi and Persson (2015)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .persson_2001 import contact_fractions, cumulative, direction_means
from .sliding_input import Modulus
from .theory import checked_spectrum

SOURCE = (
    "Persson (2001) J. Chem. Phys. 115:3840-3861; S(q): Scaraggi and Persson (2015) "
    "J. Phys.: Condens. Matter 27:105102"
)
GAMMA = 0.5
"""Reduced deformation in partial contact (source: about 0.5, from simulations)."""


def persson_friction(
    pressure: ArrayLike,
    wavenumber: ArrayLike,
    spectrum: ArrayLike,
    modulus: Modulus,
    speed: float,
    poisson_ratio: float = 0.5,
    gamma: float = GAMMA,
) -> np.ndarray:
    """Return the hysteresis COF at nominal pressures (Pa, > 0).

    mu = (1/2) int q^3 C(q) S(q) P(q) int_0^2pi cos(phi) Im E*(q v cos phi)/p dphi dq,
    S = gamma + (1-gamma) P^2, P(q) from ``persson_contact_fractions``. gamma = 1 leaves S out.
    Exact in full contact (P = S = 1), where it is a sum over independent waves.

    ``modulus`` as in ``steady_sliding``. ``speed`` (m/s) may be negative: mu(-v) = -mu(v).
    In partial contact expect the right order and trends, not the percent: see the comparison on
    the physics page. It is known to be worse where sliding strongly reduces the area
    (Sukhomlinov and Mueser 2021, arXiv:2104.15056).
    """
    return persson_cumulative_friction(
        pressure, wavenumber, spectrum, modulus, speed, poisson_ratio, gamma
    )[:, -1]


def persson_cumulative_friction(
    pressure: ArrayLike,
    wavenumber: ArrayLike,
    spectrum: ArrayLike,
    modulus: Modulus,
    speed: float,
    poisson_ratio: float = 0.5,
    gamma: float = GAMMA,
) -> np.ndarray:
    """Return mu (pressures, wave numbers) from roughness up to each wave number.

    It shows which scales make the friction, and what the choice of the shortest wave changes.
    """
    q, c = checked_spectrum(wavenumber, spectrum)
    stiffness_squared, loss = direction_means(modulus, q, speed, poisson_ratio)
    rows = []
    for p in np.atleast_1d(np.asarray(pressure, dtype=float)):
        fraction = contact_fractions(float(p), q, c, stiffness_squared)
        correction = gamma + (1.0 - gamma) * fraction**2
        rows.append(0.5 * cumulative(q**3 * c * fraction * correction * loss, q) / p)
    return np.array(rows)
