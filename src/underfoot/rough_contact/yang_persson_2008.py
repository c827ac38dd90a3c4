"""Yang and Persson (2008): the average gap of a rough elastic contact at a pressure."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import erf, exp1

from underfoot.core import InputError

from .persson_2001 import cumulative
from .theory import checked_spectrum

SOURCE = "Yang and Persson (2008) J. Phys.: Condens. Matter 20:215214"
GAMMA = 0.45
"""Reduction of stored energy in partial contact, fitted to simulations in the source."""


def yang_persson_mean_gap(
    pressure: ArrayLike,
    wavenumber: ArrayLike,
    spectrum: ArrayLike,
    modulus: float,
    poisson_ratio: float = 0.5,
    gamma: float = GAMMA,
) -> np.ndarray:
    """Return the mean interfacial gap (m) at nominal pressures (Pa, > 0).

    u(p) = sqrt(pi) int q^2 C(q) w(q) int_p^inf [gamma + 3 (1-gamma) P^2] exp(-(w p'/E*)^2) dp'/p'
    dq, w(q) = (pi int_q0^q q^3 C dq)^(-1/2), P = erf(w p'/E*), E* = E/(1-nu^2).
    It follows from p = -dU/du with the stored energy U = (pi/2) E* int q^2 C [gamma P +
    (1-gamma) P^3] dq. At light load p ~ exp(-u/u0), see ``yang_persson_decay_length``.

    Elastic only: a sliding viscoelastic contact dissipates, so no stored energy gives its gap.
    ``wavenumber`` (rad/m, rising), ``spectrum`` C(q) in m^4 with <h^2> = 2 pi int q C dq.
    """
    q, c = checked_spectrum(wavenumber, spectrum)
    p = np.atleast_1d(np.asarray(pressure, dtype=float))
    if not np.all((p > 0.0) & np.isfinite(p)):
        raise InputError("pressure must be positive", where="Yang-Persson")
    root, inverse = _root_grid(q, c)
    with np.errstate(divide="ignore"):
        x = p[:, None] * (1.0 - poisson_ratio**2) / (modulus * math.sqrt(math.pi) * root)
    return 2.0 * np.asarray(np.trapezoid(_inner_integral(x, gamma) * inverse, root, axis=1))


def yang_persson_decay_length(
    wavenumber: ArrayLike, spectrum: ArrayLike, gamma: float = GAMMA
) -> float:
    """Return u0 (m) of p ~ exp(-u/u0) at light load: sqrt(pi) gamma int q^2 C w dq."""
    q, c = checked_spectrum(wavenumber, spectrum)
    root, inverse = _root_grid(q, c)
    return 2.0 * gamma * float(np.trapezoid(inverse, root))


def _root_grid(q: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return s = (int q^3 C dq)^(1/2) and 1/q on a grid that is fine near s = 0.

    In s the integrand q^2 C w dq = (2/sqrt(pi)) ds/q has no singularity at the first wave.
    """
    root = np.sqrt(cumulative(q**3 * c, q))
    fine = np.concatenate([[0.0], np.geomspace(1e-7 * root[-1], root[-1], 1200)])
    return fine, np.interp(fine, root, 1.0 / q)


def _inner_integral(x: np.ndarray, gamma: float) -> np.ndarray:
    """Return int_x^inf [gamma + 3 (1-gamma) erf^2(t)] exp(-t^2) dt/t."""
    grid = np.linspace(math.log(1e-7), math.log(8.0), 4000)
    t = np.exp(grid)
    integrand = 3.0 * erf(t) ** 2 * np.exp(-(t**2))
    steps = 0.5 * (integrand[1:] + integrand[:-1]) * np.diff(grid)
    tail = np.concatenate([np.cumsum(steps[::-1])[::-1], [0.0]])
    second = np.interp(np.log(np.clip(x, t[0], t[-1])), grid, tail)
    return 0.5 * gamma * exp1(np.minimum(x, 26.0) ** 2) + (1.0 - gamma) * second
