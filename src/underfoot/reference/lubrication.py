"""Closed forms of fluid films: bearings, squeeze film, soft elastohydrodynamic point contact.

All films are incompressible and isoviscous; ``speed`` is the sliding speed of one wall past the
other. SI throughout.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

BEST_TAPER = 1.18869
"""Gap ratio m = (h1 - h0) / h0 of the infinitely wide inclined bearing that carries the most."""


def inclined_bearing_load(
    *, viscosity: float, speed: float, length: float, leading_gap: float, trailing_gap: float
) -> float:
    """Return the load per width (N/m) of an infinitely wide inclined bearing.

    W = 6 eta u l^2 / h0^2 K(m), K = [ln(1 + m) - 2 m / (2 + m)] / m^2, m = h1 / h0 - 1.

    Parameters:
        viscosity, speed, length: Pa s, m/s, m (length along the sliding direction).
        leading_gap, trailing_gap: h1 > h0 > 0, m.

    Source: Reynolds 1886; Hamrock, Schmid and Jacobson, Fundamentals of Fluid Film Lubrication
    (2004), fixed-incline slider.

    >>> gaps = {"leading_gap": 2e-4, "trailing_gap": 1e-4}
    >>> round(inclined_bearing_load(viscosity=0.1, speed=1.0, length=0.01, **gaps), 1)
    158.9
    """
    m = leading_gap / trailing_gap - 1
    shape = (math.log1p(m) - 2 * m / (2 + m)) / m**2
    return 6 * viscosity * speed * length**2 / trailing_gap**2 * shape


def inclined_bearing_pressure(
    place: ArrayLike,
    *,
    viscosity: float,
    speed: float,
    length: float,
    leading_gap: float,
    trailing_gap: float,
) -> Array:
    """Return the pressure (Pa) at ``place`` (m from the leading edge) of the inclined bearing.

    p = 6 eta u l / (h1^2 - h0^2) (h1 - h)(h - h0) / h^2, infinitely wide. Source as the load.

    Parameters:
        place: From the leading edge, m.
        viscosity: Pa s.
        speed: Of sliding, m/s.
        length: Along sliding, m.
        leading_gap: h1, m.
        trailing_gap: h0, m.
    """
    h1, h0 = leading_gap, trailing_gap
    h = h1 - (h1 - h0) * np.asarray(place, dtype=float) / length
    factor = 6 * viscosity * speed * length / (h1**2 - h0**2)
    return factor * (h1 - h) * (h - h0) / h**2


def parabolic_bearing_load(
    *, viscosity: float, speed: float, length: float, leading_gap: float, trailing_gap: float
) -> float:
    """Return the load per width (N/m) of a pad with h = h0 + (h1 - h0) (x / l)^2.

    x runs from the trailing edge, where the parabola has its vertex. dp/dx = 6 eta u (h - h*) / h^3
    with p = 0 at both ends, integrated by Gauss quadrature.

    >>> gaps = {"leading_gap": 2e-4, "trailing_gap": 1e-4}
    >>> round(parabolic_bearing_load(viscosity=0.1, speed=1.0, length=0.01, **gaps), 1)
    172.2
    """
    h0, rise = trailing_gap, leading_gap - trailing_gap
    nodes, weights = np.polynomial.legendre.leggauss(200)
    place = 0.5 * (nodes + 1)
    h = h0 + rise * place**2
    weight = 0.5 * weights
    second, third = (weight / h**2).sum(), (weight / h**3).sum()
    star = second / third
    # load = integral of p = -integral of x dp/dx by parts, with p = 0 at both ends
    slope = 6 * viscosity * speed * (h - star) / h**3
    return abs(float((weight * place * slope).sum())) * length**2


def step_bearing_load(
    *,
    viscosity: float,
    speed: float,
    length: float,
    leading_share: float,
    leading_gap: float,
    trailing_gap: float,
) -> float:
    """Return the load per width (N/m) of an infinitely wide step (Rayleigh) bearing.

    W = p_step l / 2, p_step = 6 eta u (h1 - h0) / (h1^3 / l1 + h0^3 / l0), with l1 =
    ``leading_share`` l before the step and l0 after it.

    Source: Rayleigh 1918; Hamrock, Schmid and Jacobson 2004, parallel-step slider.

    >>> gaps = {"leading_share": 0.72, "leading_gap": 2e-4, "trailing_gap": 1e-4}
    >>> round(step_bearing_load(viscosity=0.1, speed=1.0, length=0.01, **gaps), 1)
    204.3
    """
    before = leading_share * length
    after = length - before
    resistance = leading_gap**3 / before + trailing_gap**3 / after
    peak = 6 * viscosity * speed * (leading_gap - trailing_gap) / resistance
    return 0.5 * peak * length


SIDE_LEAKAGE = {
    0.25: {1.0: 0.847, 1.189: 0.848, 2.0: 0.854},
    0.5: {1.0: 0.695, 1.189: 0.698, 2.0: 0.708},
    1.0: {1.0: 0.436, 1.189: 0.440, 2.0: 0.457},
    2.0: {1.0: 0.183, 1.189: 0.187, 2.0: 0.201},
    4.0: {1.0: 0.058, 1.189: 0.060, 2.0: 0.068},
}
"""Load of a tapered wedge of length l, width b over the infinitely wide one: [l / b][m].

Computed by an independent finite-volume solution, extrapolated from 80 and 160 cells; the classical
tables give 0.44 at l / b = 1. Three digits.
"""


def tapered_wedge_load(
    *,
    viscosity: float,
    speed: float,
    length: float,
    width: float,
    leading_gap: float,
    trailing_gap: float,
    leakage: float,
) -> float:
    """Return the load (N) of a tapered wedge with side leakage, F = W b eta_s.

    ``leakage`` is the factor eta_s, tabulated in ``SIDE_LEAKAGE`` against length / width.

    Parameters:
        viscosity: Pa s.
        speed: Of sliding, m/s.
        length: Along sliding, m.
        width: Across sliding, m.
        leading_gap: h1, m.
        trailing_gap: h0, m.
        leakage: eta_s, 0 to 1.
    """
    infinite = inclined_bearing_load(
        viscosity=viscosity,
        speed=speed,
        length=length,
        leading_gap=leading_gap,
        trailing_gap=trailing_gap,
    )
    return infinite * width * leakage


def squeeze_disc_load(
    *, viscosity: float, radius: float, gap: float, closing_speed: float
) -> float:
    """Return the load (N) of a flat disc approaching a plane, F = 3 pi eta R^4 v / (2 h^3).

    Source: Stefan 1874; Hamrock, Schmid and Jacobson 2004, squeeze film between parallel discs.

    >>> round(squeeze_disc_load(viscosity=0.1, radius=0.01, gap=1e-4, closing_speed=1e-3), 3)
    4.712
    """
    return 1.5 * math.pi * viscosity * radius**4 * closing_speed / gap**3


def squeeze_disc_pressure(
    radius_at: ArrayLike, *, viscosity: float, radius: float, gap: float, closing_speed: float
) -> Array:
    """Return the pressure (Pa) under the disc, p = 3 eta v (R^2 - r^2) / h^3.

    Source as the load.

    Parameters:
        radius_at: r, m, at most ``radius``.
        viscosity: Pa s.
        radius: R, m.
        gap: h, m.
        closing_speed: v, m/s, positive when the gap closes.
    """
    r = np.asarray(radius_at, dtype=float)
    return 3 * viscosity * closing_speed * (radius**2 - r**2) / gap**3


def squeeze_disc_gap(
    time: ArrayLike, *, viscosity: float, radius: float, start_gap: float, load: float
) -> Array:
    """Return the gap (m) of a rigid disc sinking under a constant load after ``time`` (s).

    1 / h^2 = 1 / h_start^2 + 4 F t / (3 pi eta R^4): the load formula integrated.

    >>> disc = {"viscosity": 0.1, "radius": 0.01, "start_gap": 1e-4, "load": 10.0}
    >>> round(float(squeeze_disc_gap(0.02, **disc)) * 1e6, 1)
    73.5
    """
    t = np.asarray(time, dtype=float)
    return (start_gap**-2 + 4 * load * t / (3 * math.pi * viscosity * radius**4)) ** -0.5


def soft_ehl_film(
    *,
    viscosity: float,
    entrainment_speed: Array | float,
    load: Array | float,
    radius: float,
    effective_modulus: float,
    ellipticity: float = 1.0,
) -> tuple[Any, Any]:
    """Return the central and the minimum film (m) of a soft (isoviscous-elastic) point contact.

    H_c = 7.32 (1 - 0.72 exp(-0.28 k)) U^0.64 W^-0.22
    H_min = 7.43 (1 - 0.85 exp(-0.31 k)) U^0.65 W^-0.21
    H = h / R,  U = eta u / (E' R),  W = F / (E' R^2)

    Parameters:
        viscosity, entrainment_speed: Pa s; mean speed of the two surfaces, half the sliding speed,
            m/s.
        load, radius: N; reduced radius along the motion, m.
        effective_modulus: E' = 2 E*, 2 / E' = (1 - nu1^2) / E1 + (1 - nu2^2) / E2, Pa.
        ellipticity: k, 1 for a circle.

    Fitted by Hamrock and Dowson (1978, J. Lubr. Technol. 100:236-245) to 17 computed films with
    U from 0.5e-8 to 5.1e-8 and W from 0.2e-3 to 2.2e-3 (range from memory).
    """
    reduced = effective_modulus * radius
    speed = viscosity * entrainment_speed / reduced
    force = load / (reduced * radius)
    central = 7.32 * (1 - 0.72 * math.exp(-0.28 * ellipticity)) * speed**0.64 * force**-0.22
    least = 7.43 * (1 - 0.85 * math.exp(-0.31 * ellipticity)) * speed**0.65 * force**-0.21
    return central * radius, least * radius
