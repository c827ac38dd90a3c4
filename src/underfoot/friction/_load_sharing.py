"""Load shared by film and roughness: Johnson, Greenwood and Poon (1972)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

FILM_EXPONENT = 0.65
"""Film at the fluid's share f of load and stiffness: h = h_full f^-0.65. Eq. 18 has
h ~ E'^-0.44 w^-0.21, and both E' and w count as multiplied by f."""
_STEPS = 60


def fluid_share(full_film: ArrayLike, dry_gap: ArrayLike) -> NDArray[np.float64]:
    """Return the share f of the load that the fluid carries beside exponential roughness.

    1 - f = exp(-(h - h_dry)), h = h_full f^-0.65; lengths in units of the decay length u0 of the
    roughness' pressure. ``full_film``: the film if the fluid carried all; ``dry_gap`` >= 0: the
    gap without a fluid. Broadcast; 0 at ``full_film`` 0, towards 1 as it grows.

    Solved by bisection in log f (the left side falls and the right side grows with f).
    """
    film, dry = np.broadcast_arrays(
        np.asarray(full_film, dtype=float), np.asarray(dry_gap, dtype=float)
    )
    low = np.full(film.shape, np.log(1e-300))
    high = np.zeros(film.shape)
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        gap = film * np.exp(-FILM_EXPONENT * middle)
        # roughness carries less than the load's rest: the film is too thick, f too small
        too_thick = np.exp(-np.clip(gap - dry, -700.0, 700.0)) < -np.expm1(middle)
        low = np.where(too_thick, middle, low)
        high = np.where(too_thick, high, middle)
    return np.where(film > 0, np.exp(0.5 * (low + high)), 0.0)
