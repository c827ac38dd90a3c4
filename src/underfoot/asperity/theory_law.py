"""A pressure-gap law from Persson's theory: instant, elastic, no surface needed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError, Range

from . import yang_persson_2008
from .persson_2001 import cumulative
from .spectrum_check import checked_spectrum
from .tabulated_law import TabulatedLaw

_NODES = 48
_LIGHTEST, _HEAVIEST = 1e-4, 0.5
"""Shares of E* h' between which the nodes lie; above, the theory's gap is 20 % off and more."""


def persson_law(
    wavenumber: ArrayLike,
    spectrum: ArrayLike,
    modulus: float,
    poisson_ratio: float = 0.5,
    flow_factor: Callable[[np.ndarray], np.ndarray] | None = None,
) -> TabulatedLaw:
    """Return the law p(u) of Yang and Persson's mean gap u between 1e-4 and 0.5 of E* h'.

    Parameters
    ----------
    wavenumber, spectrum
        q (rad/m, rising) and C(q) (m^4), <h^2> = 2 pi int q C dq.
    modulus
        Young's modulus of the rubber at the rate of its asperities, Pa.
    flow_factor
        phi of the mean gap (m), 0 or more and not falling; None leaves it at 1, which lets too
        much fluid through at small gaps.

    Notes
    -----
    Within 2 % of half-space gaps up to a tenth of E* h', 7 % at 0.3 and 20 % at 0.5 (self-affine,
    Hurst exponent 0.8). Without hysteresis: at speed take the modulus at the asperities' rate.
    """
    q, c = checked_spectrum(wavenumber, spectrum)
    if not (np.isfinite(modulus) and modulus > 0.0):
        raise InputError(f"modulus {modulus} Pa", where="persson_law", allowed="above 0 Pa")
    gradient = float(np.sqrt(2.0 * np.pi * cumulative(q**3 * c, q)[-1]))
    full = modulus / (1.0 - poisson_ratio**2) * gradient
    pressure = np.geomspace(_HEAVIEST, _LIGHTEST, _NODES) * full
    gap = yang_persson_2008.yang_persson_mean_gap(pressure, q, c, modulus, poisson_ratio)
    flow = np.ones_like(gap) if flow_factor is None else np.asarray(flow_factor(gap), dtype=float)
    return TabulatedLaw(
        name="persson",
        source=yang_persson_2008.SOURCE,
        gap=gap,
        node_pressure=pressure,
        node_flow_factor=flow,
        ranges={
            "pressure": Range(
                _LIGHTEST * full, _HEAVIEST * full, "Pa", "1e-4 to 0.5 of E* times the rms slope"
            )
        },
    )
