"""Patir and Cheng (1979): flow that sliding rough walls carry along."""

import math

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core.arrays import Array
from underfoot.core.checks import not_negative, positive, positive_array

from .patir_cheng_1978 import between_gammas, checked_anisotropy

SOURCE = "Patir and Cheng (1979) J. Lubr. Technol. 101:220-229, Table 1"

TABLE = {
    1 / 9: (2.046, 1.12, 0.78, 0.03, 1.856),
    1 / 6: (1.962, 1.08, 0.77, 0.03, 1.754),
    1 / 3: (1.858, 1.01, 0.76, 0.03, 1.561),
    1.0: (1.899, 0.98, 0.92, 0.05, 1.126),
    3.0: (1.560, 0.85, 1.13, 0.08, 0.556),
    6.0: (1.290, 0.62, 1.09, 0.08, 0.388),
    9.0: (1.011, 0.54, 1.07, 0.08, 0.295),
}
"""A1, alpha1, alpha2, alpha3, A2 by gamma. From memory, with a check on all five: the two
branches of every row meet within 0.1 % at H = 5."""

CHANGE = 5.0  # H from which the second branch holds


def patir_cheng_shear_factor(gap: ArrayLike, rq: float, *, anisotropy: float = 1.0) -> Array:
    """Return the shear flow factor Phi_s of one rough wall against a smooth one.

    Phi_s = A1 H^alpha1 exp(-alpha2 H + alpha3 H^2) up to H = 5, A2 exp(-0.25 H) above; H = h / Rq

    Between the table's gammas linear in ln gamma. 0 for grooves without end along the motion, and
    for gaps far above the roughness.

    Parameters:
        gap: h, distance of the undeformed mean planes, m, any shape, above 0. Below H = 0.5 the
            value at 0.5 is held.
        rq, anisotropy: As ``patir_cheng_pressure_factors``; gamma of the rough wall.

    Source: Patir and Cheng (1979) J. Lubr. Technol. 101:220-229.

    >>> round(float(patir_cheng_shear_factor(6e-6, 2e-6)), 3)
    0.553
    """
    ratio = np.maximum(positive_array(gap, "gap") / positive(rq, "rq"), 0.5)
    gamma = checked_anisotropy(anisotropy)
    return between_gammas(lambda known: _fitted_factor(ratio, known), TABLE, gamma)


def patir_cheng_shear_flow(
    gap: ArrayLike,
    rq_upper: float,
    rq_lower: float,
    *,
    anisotropy_upper: float = 1.0,
    anisotropy_lower: float = 1.0,
) -> Array:
    """Return s = sigma phi_s (m), for the ``shear_flow`` of a ``Film``.

    sigma phi_s = sigma [(Rq1 / sigma)^2 Phi_s(H, gamma1) - (Rq2 / sigma)^2 Phi_s(H, gamma2)],
    sigma^2 = Rq1^2 + Rq2^2, 1 the upper wall. The walls carry V s / 2 more than V h / 2 along the
    motion of the upper: 0 for walls equally rough, positive when the upper is the rougher.

    ``gap`` and both roughnesses (one may be 0) in m. Source as ``patir_cheng_shear_factor``.

    Parameters:
        gap: Between the mean planes, m.
        rq_upper: Rq of the moving wall, m.
        rq_lower: Rq of the wall at rest, m.
        anisotropy_upper: Peklenik number of the upper wall: above 1 for ridges along sliding.
        anisotropy_lower: The same of the lower wall.
    """
    upper = not_negative(rq_upper, "rq_upper")
    lower = not_negative(rq_lower, "rq_lower")
    sigma = math.hypot(upper, lower)
    if sigma == 0:
        return np.zeros_like(positive_array(gap, "gap"))
    first = patir_cheng_shear_factor(gap, sigma, anisotropy=anisotropy_upper)
    second = patir_cheng_shear_factor(gap, sigma, anisotropy=anisotropy_lower)
    return (upper**2 * first - lower**2 * second) / sigma


def _fitted_factor(ratio: Array, gamma: float) -> Array:
    a1, power, decay, square, a2 = TABLE[gamma]
    near = np.minimum(ratio, CHANGE)
    first = a1 * near**power * np.exp(-decay * near + square * near**2)
    return np.where(ratio <= CHANGE, first, a2 * np.exp(-0.25 * ratio))
