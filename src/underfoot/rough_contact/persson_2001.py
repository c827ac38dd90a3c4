"""Persson (2001): real contact area by spreading of the pressure distribution with resolution."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import erf

from underfoot.core import InputError

from .sliding_input import Modulus, modulus_function
from .theory import checked_spectrum

SOURCE = "Persson (2001) J. Chem. Phys. 115:3840-3861"
_DIRECTIONS = 48


def persson_contact_fractions(
    pressure: float,
    wavenumber: ArrayLike,
    spectrum: ArrayLike,
    modulus: Modulus,
    speed: float = 0.0,
    poisson_ratio: float = 0.5,
) -> np.ndarray:
    """Return the real contact fraction P(q) seen when roughness up to each q is resolved.

    P = erf(1/(2 sqrt(G))), G(q) = (1/8) int_q0^q q^3 C(q) int_0^2pi |E*(q v cos phi)/p|^2 dphi dq,
    E* = E/(1-nu^2). Elastic: P = erf(sqrt(2) p/(E* h'(q))). The last value is the contact.

    Parameters
    ----------
    pressure
        Nominal pressure, Pa, > 0.
    wavenumber, spectrum
        q (rad/m, rising) and the isotropic 2-D spectrum C(q) (m^4), <h^2> = 2 pi int q C dq.
    modulus
        Young's modulus as in ``steady_sliding``: Pa, a material, or E*(rad/s).
    speed
        m/s; 0 takes the modulus at rest.

    Exact at full contact. At light load the area is p/(E* h') times 1.60, where half-space
    solutions of broad spectra give 2.0 to 2.3: about 25 to 30 % low there, less above.
    """
    q, c = checked_spectrum(wavenumber, spectrum)
    return contact_fractions(pressure, q, c, direction_means(modulus, q, speed, poisson_ratio)[0])


def contact_fractions(
    pressure: float, q: np.ndarray, c: np.ndarray, stiffness_squared: np.ndarray
) -> np.ndarray:
    """Return P(q) from int |E*|^2 dphi at every q (Pa^2, see ``direction_means``)."""
    if not (math.isfinite(pressure) and pressure > 0.0):
        raise InputError(f"the pressure is {pressure}", where="Persson", allowed="above zero")
    spread = cumulative(q**3 * c * stiffness_squared, q) / (8.0 * pressure**2)
    with np.errstate(divide="ignore"):
        return erf(0.5 / np.sqrt(spread))


def direction_means(
    modulus: Modulus, q: np.ndarray, speed: float, poisson_ratio: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return int |E*|^2 dphi (Pa^2) and int cos(phi) Im E* dphi (Pa) over all directions."""
    factor = 1.0 / (1.0 - poisson_ratio**2)
    nodes, weights = np.polynomial.legendre.leggauss(_DIRECTIONS)
    cosine = np.cos(0.25 * np.pi * (nodes + 1.0))
    frequency = np.abs(speed) * q[:, None] * cosine[None, :]
    e = modulus_function(modulus, frequency.ravel())(frequency) * factor
    quadrant = 0.25 * np.pi * weights
    total = 4.0 * (np.abs(e) ** 2 @ quadrant)
    loss = 4.0 * ((np.imag(e) * cosine) @ quadrant) * np.sign(speed)
    return total, loss


def cumulative(integrand: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return the running integral over q, trapezoids on log q, 0 at the first wave number."""
    steps = 0.5 * (integrand[1:] * q[1:] + integrand[:-1] * q[:-1]) * np.diff(np.log(q))
    return np.concatenate([[0.0], np.cumsum(steps)])
