"""Tapered wedge of finite width: load, side leakage, peak pressure, film that carries a load."""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from underfoot.core.arrays import Array
from underfoot.core.checks import positive

_MODES = 40


@dataclass(frozen=True, slots=True)
class TaperedWedge:
    """What a rigid wedge carries."""

    load: float  # N
    leakage: float  # eta_s, load over that of the infinitely wide wedge
    peak_pressure: float  # Pa
    pressure_centre: float  # m from the trailing edge


def tapered_wedge(
    *,
    viscosity: float,
    speed: float,
    length: float,
    width: float,
    leading_gap: float,
    trailing_gap: float,
) -> TaperedWedge:
    """Return load, side leakage and peak pressure of a tapered wedge with open sides.

    F = 6 eta u l^2 b / h0^2 K(m) eta_s(l / b, m),  K = [ln(1 + m) - 2 m / (2 + m)] / m^2,
    m = (h1 - h0) / h0

    The pressure is that of the infinitely wide wedge less its expansion in the eigenfunctions of
    (h^3 f')' = -mu^2 h^3 f, each of which decays from the sides as cosh(mu y): no grid. Ten digits
    in the load; pressure 0 all round, no cavitation (none in a wedge that narrows), no flexing.

    Parameters:
        viscosity, speed: Pa s; sliding speed, m/s.
        length, width: l along the motion, b across it, m.
        leading_gap, trailing_gap: h1 > h0 > 0, m.

    Source: Reynolds 1886; separation after Michell 1905.

    >>> wedge = {"length": 0.01, "width": 0.01, "leading_gap": 2e-4, "trailing_gap": 1e-4}
    >>> round(tapered_wedge(viscosity=0.1, speed=1.0, **wedge).load, 4)
    0.6928
    """
    h1 = positive(leading_gap, "leading_gap")
    h0 = positive(trailing_gap, "trailing_gap")
    m = positive(h1 / h0 - 1, "leading_gap")
    along, across = positive(length, "length"), positive(width, "width")
    unit = 6 * positive(viscosity, "viscosity") * positive(speed, "speed")
    unit *= along / h0**2
    modes = _modes(m)
    half, held = modes.side_modes(along / across)
    middle = 1 - 1 / np.cosh(np.minimum(half, 700.0))
    place = np.linspace(0.0, 1.0, 2001)
    profile = (modes.weights * middle) @ modes.at(place)
    top = int(np.argmax(profile))
    around = place[max(top - 2, 0) : top + 3]
    curve = np.polynomial.Polynomial.fit(around, (modes.weights * middle) @ modes.at(around), 4)
    fine = np.linspace(around[0], around[-1], 401)
    load = float((modes.shares * held).sum())
    moment = float((modes.weights * modes.moments * held).sum())
    return TaperedWedge(
        load=unit * along * across * load,
        leakage=load / float(modes.shares.sum()),
        peak_pressure=unit * float(curve(fine).max()),
        pressure_centre=along * moment / load,
    )


def side_leakage(length_over_width: float, taper: float) -> float:
    """Return eta_s, load of a tapered wedge over the infinitely wide one's, 0 to 1.

    ``length_over_width`` l / b with l along the motion; ``taper`` m = (h1 - h0) / h0. 0.44 for a
    square pad. Method and source as ``tapered_wedge``.

    >>> round(side_leakage(1.0, 1.0), 3)
    0.436
    """
    ratio = positive(length_over_width, "length_over_width")
    modes = _modes(positive(taper, "taper"))
    return float((modes.shares * modes.side_modes(ratio)[1]).sum() / modes.shares.sum())


def wedge_film(
    *, viscosity: float, speed: float, length: float, width: float, load: float, taper: float
) -> float:
    """Return the trailing gap h0 (m) at which a wedge of given taper carries ``load`` (N).

    h0 = l (6 eta u b K eta_s / F)^(1/2); ``taper`` m = (h1 - h0) / h0, largest film at m = 1.19.
    Source as ``tapered_wedge``.

    Parameters:
        viscosity: Pa s.
        speed: Of sliding, m/s.
        length: Along sliding, m.
        width: Across sliding, m.
        load: N.
        taper: m, above 0.
    """
    m = positive(taper, "taper")
    along, across = positive(length, "length"), positive(width, "width")
    carried = 6 * positive(viscosity, "viscosity") * positive(speed, "speed") * across
    carried *= wedge_load_factor(m) * side_leakage(along / across, m)
    return along * math.sqrt(carried / positive(load, "load"))


def wedge_load_factor(taper: float) -> float:
    """Return K(m) = [ln(1 + m) - 2 m / (2 + m)] / m^2, at most 0.02671 (m = 1.189).

    >>> round(wedge_load_factor(1.0), 4)
    0.0265
    """
    m = positive(taper, "taper")
    if m < 1e-2:  # series: the bracket loses its digits
        return m / 12 * (1 - 1.5 * m + 1.65 * m**2 - 1.625 * m**3)
    return (math.log1p(m) - 2 * m / (2 + m)) / m**2


@dataclass(frozen=True, slots=True)
class _Modes:
    """Eigenfunctions along the wedge of unit length, x from the trailing edge."""

    rates: Array  # mu
    weights: Array  # coefficients of the infinitely wide wedge's pressure
    shares: Array  # integral of each mode times its weight
    moments: Array  # integral of x times each mode
    coefficients: Array  # (modes, modes) by sine

    def side_modes(self, slenderness: float) -> tuple[Array, Array]:
        """Return half the sides' distance by modes, and the share of each that the sides leave."""
        half = 0.5 * self.rates / slenderness
        return half, 1 - np.tanh(half) / half

    def at(self, place: Array) -> Array:
        """Return the modes (modes, n) at ``place``."""
        return self.coefficients @ _bubbles(2 * place - 1)[0]


@lru_cache(maxsize=64)
def _modes(taper: float) -> _Modes:
    from scipy.linalg import eigh

    nodes, weight = np.polynomial.legendre.leggauss(2 * _MODES + 10)
    place, weight = 0.5 * (nodes + 1), 0.5 * weight
    h = 1 + taper * place
    value, slope = _bubbles(nodes)
    stiffness = (slope * (weight * h**3)) @ slope.T
    mass = (value * (weight * h**3)) @ value.T
    squares, vectors = eigh(stiffness, mass)
    # weak form of (h^3 p')' = -dh/dx in units of 6 eta u l / h0^2: rises towards +x
    forced = value @ (weight * taper)
    coefficients = vectors.T
    weights = (coefficients @ forced) / squares
    return _Modes(
        rates=np.sqrt(squares),
        weights=weights,
        shares=weights * (coefficients @ (value @ weight)),
        moments=coefficients @ (value @ (weight * place)),
        coefficients=coefficients,
    )


def _bubbles(s: Array) -> tuple[Array, Array]:
    """Return polynomials (modes, n) that vanish at s = -1 and 1, and their slopes by x."""
    legendre = np.polynomial.legendre.legvander(s, _MODES + 1).T
    order = np.arange(1, _MODES + 1)[:, None]
    norm = 1 / np.sqrt(2 * (2 * order + 1))
    value = norm * (legendre[2:] - legendre[:-2])
    slope = 2 * norm * (2 * order + 1) * legendre[1:-1]  # dx = ds / 2
    return value, slope
