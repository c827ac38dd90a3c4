"""Patir and Cheng (1978): pressure flow factors of rough walls with a direction."""

import math
from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, RangeError, ValidityRange, breaches
from underfoot.core.arrays import Array
from underfoot.core.checks import positive, positive_array

SOURCE = "Patir and Cheng (1978) J. Lubr. Technol. 100:12-17, Table 1"

TABLE = {
    1 / 9: (1.48, 0.42),
    1 / 6: (1.38, 0.42),
    1 / 3: (1.18, 0.42),
    1.0: (0.90, 0.56),
    3.0: (0.225, 1.5),
    6.0: (0.520, 1.5),
    9.0: (0.870, 1.5),
}
"""C and r by gamma: 1 - C exp(-r H) up to gamma = 1, 1 + C H^-r above. From memory; a published
fit of C and r (log-linear, in a public bearing code) agrees within 5 %."""

RANGES = {
    "gap over roughness H": ValidityRange(0.5, math.inf, "1", f"{SOURCE}; isotropic"),
    "anisotropy gamma": ValidityRange(1 / 9, 9.0, "1", SOURCE),
}


def patir_cheng_pressure_factors(
    gap: ArrayLike, rq: float, *, anisotropy: float = 1.0
) -> tuple[Array, Array]:
    """Return the pressure flow factors (phi_x, phi_y) along the motion and across it.

    phi_x = 1 - C exp(-r H) for gamma <= 1, 1 + C H^-r for gamma > 1;
    phi_y(H, gamma) = phi_x(H, 1 / gamma);  H = h / Rq

    Between the table's gammas the factor is linear in ln gamma.

    Parameters:
        gap: h, distance of the undeformed mean planes, m, any shape, above 0. Below H = 0.5 the
            value at 0.5 is held (``patir_cheng_breaches`` names it).
        rq: Roughness of both walls together, (Rq1^2 + Rq2^2)^(1/2), m.
        anisotropy: gamma, correlation length along the motion over that across, 1/9 to 9: above 1
            for grooves along the motion, which let more flow through.

    Raises:
        InputError, RangeError: Values that are not physical; gamma beyond the table.

    Gaussian heights, no deformation, contact as overlap: at H below 1 a soft rubber conforms and
    leaves other channels than this. Source: Patir and Cheng (1978) J. Lubr. Technol. 100:12-17.

    >>> [round(float(each), 3) for each in patir_cheng_pressure_factors(6e-6, 2e-6)]
    [0.832, 0.832]
    """
    ratio = np.maximum(
        positive_array(gap, "gap") / positive(rq, "rq"), RANGES["gap over roughness H"].low
    )
    gamma = checked_anisotropy(anisotropy)
    along, across = (
        between_gammas(lambda known: _fitted_factor(ratio, known), TABLE, value)
        for value in (gamma, 1 / gamma)
    )
    return along, across


def patir_cheng_mean_gap(gap: ArrayLike, rq: float) -> Array:
    """Return the mean gap h_T (m), overlap counted as none, of Gaussian walls ``gap`` apart.

    h_T = (h / 2) (1 + erf(h / (2^(1/2) Rq))) + Rq / (2 pi)^(1/2) exp(-h^2 / (2 Rq^2))

    What the walls carry and what the film stores is h_T, what resists pressure flow is
    phi_x h^3 / (12 eta): give ``Film`` the gap h_T and the factor phi (h / h_T)^3.
    Source: Patir and Cheng 1978 for Gaussian heights.

    >>> round(float(patir_cheng_mean_gap(5e-6, 2e-6)) * 1e6, 3)
    5.004
    """
    from scipy.special import erf

    h, sigma = positive_array(gap, "gap"), positive(rq, "rq")
    bell = np.exp(-((h / sigma) ** 2) / 2) * sigma / math.sqrt(2 * math.pi)
    return np.asarray(0.5 * h * (1 + erf(h / (math.sqrt(2) * sigma))) + bell)


def patir_cheng_breaches(gap: ArrayLike, rq: float) -> list[Breach]:
    """Return whether any gap (m) over roughness (m) leaves the range of the flow factors."""
    ratio = positive_array(gap, "gap") / positive(rq, "rq")
    return breaches("patir_cheng_1978", RANGES, {"gap over roughness H": ratio})


def checked_anisotropy(anisotropy: float) -> float:
    """Return gamma; refuse one beyond the tables of 1978 and 1979."""
    gamma = positive(anisotropy, "anisotropy")
    allowed = RANGES["anisotropy gamma"]
    if not allowed.low * (1 - 1e-9) <= gamma <= allowed.high * (1 + 1e-9):
        raise RangeError(
            f"gamma {gamma:.4g} is beyond the table",
            where="anisotropy",
            allowed="1/9 to 9",
            remedy="Use the flow factors of a contact table.",
        )
    return gamma


def _fitted_factor(ratio: Array, gamma: float) -> Array:
    c, r = TABLE[gamma]
    return 1 - c * np.exp(-r * ratio) if gamma <= 1 else 1 + c * ratio**-r


def between_gammas(at: Callable[[float], Array], table: Iterable[float], gamma: float) -> Array:
    """Return ``at(gamma)`` linear in ln gamma between the gammas of a table, held beyond it."""
    known = sorted(table)
    after = min(max(int(np.searchsorted(known, gamma)), 1), len(known) - 1)
    low, high = known[after - 1], known[after]
    share = min(max(math.log(gamma / low) / math.log(high / low), 0.0), 1.0)
    return np.asarray((1 - share) * at(low) + share * at(high))
