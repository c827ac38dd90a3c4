"""Finite-volume fluxes of the film between cells of constant gap, with their derivatives.

Arrays are (nx, ny) on square cells; x faces are (nx - 1, ny), y faces (nx, ny - 1). The face
between two cells is two half-cells in series, which is exact for a step in the gap: with
conductances K_a, K_b (m^3 / (Pa s)),

    k = 2 K_a K_b / (K_a + K_b)            pressure flow per unit pressure difference
    h_c = (a K_b + b K_a) / (K_a + K_b)    gap that carries the shear flow

Taking the gap linear between cell centres instead doubles the film under a lug beside a channel.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SMOOTH, STEP = 1.0, 2.0
"""|ln| of the ratio of neighbouring gaps: up to SMOOTH the film varies, from STEP it is a step."""


class Stencil(NamedTuple):
    """Five-point coefficients, each (nx, ny): row of a cell, columns itself and its neighbours."""

    centre: Array
    east: Array
    west: Array
    north: Array
    south: Array


class Flow(NamedTuple):
    """Net outflow of each cell and its derivatives by film pressure and by gap."""

    outflow: Array  # (nx, ny) m^3/s
    by_pressure: Stencil  # m^3/(Pa s)
    by_gap: Stencil  # m^2/s
    magnitude: float  # sum of |shear outflow|, m^3/s, to judge an imbalance by


class Upwinding(NamedTuple):
    """How far the shear gap of each x face, (nx - 1, ny), leans upstream."""

    strength: Array  # 0 central to 1 upwind
    correction: Array  # m, added to the upstream gap


def series_conductance(ka: Array, kb: Array, dka: Array, dkb: Array) -> tuple[Array, Array, Array]:
    """Return the conductance of two half-cells in series and its derivatives by the two gaps."""
    total = ka + kb
    return 2 * ka * kb / total, 2 * (kb / total) ** 2 * dka, 2 * (ka / total) ** 2 * dkb


def shear_gap(
    a: Array, b: Array, ka: Array, kb: Array, dka: Array, dkb: Array
) -> tuple[Array, Array, Array]:
    """Return the gap that carries the shear flow through a face and its derivatives by a and b."""
    total = ka + kb
    gap = (a * kb + b * ka) / total
    return gap, (kb + (b - gap) * dka) / total, (ka + (a - gap) * dkb) / total


def smoothness(a: Array, b: Array) -> tuple[Array, Array]:
    """Return 1 between gaps alike, 0 across a step, and the derivative by ln(a / b)."""
    ratio = np.log(a / b)
    place = np.clip((np.abs(ratio) - SMOOTH) / (STEP - SMOOTH), 0.0, 1.0)
    value = 1 - place * place * (3 - 2 * place)
    return value, -6 * place * (1 - place) / (STEP - SMOOTH) * np.sign(ratio)


def upwind_blend(
    a: Array,
    b: Array,
    shear: tuple[Array, Array, Array],
    lean: Upwinding,
    *,
    from_a: bool,
) -> tuple[Array, Array, Array]:
    """Return the shear gap drawn towards the upstream cell where the film is compliant.

    Central values wiggle where the gap answers to the pressure faster than the pressure flow can
    smooth it (cell Peclet number above 1). A rigid film keeps the series-exact gap, and so does a
    step in the sole, with no remainder: a channel 2 mm deep beside a film of 5 um would otherwise
    feed the lug with a flow it doesn't have.
    """
    gap, by_a, by_b = shear
    smooth, slope = smoothness(a, b)
    weight = lean.strength * smooth
    upstream = (a if from_a else b) + lean.correction
    excess = upstream - gap
    mixed = gap + weight * excess
    turn = lean.strength * slope * excess
    by_a = (1 - weight) * by_a + turn / a
    by_b = (1 - weight) * by_b - turn / b
    if from_a:
        by_a = by_a + weight
    else:
        by_b = by_b + weight
    return mixed, by_a, by_b


def upwinding(gap: Array, carried: Array, conductance: Array, *, from_a: bool) -> Upwinding:
    """Return how far the x faces lean upstream, from a known gap (that of the last time step).

    Parameters
    ----------
    gap, conductance
        (nx, ny) m and m^3/(Pa s).
    carried
        |U| / 2 times spacing times deflection per pressure, (nx, ny), m^3/(Pa s): what the shear
        flow carries of a pressure change. Over the conductance it is the cell Peclet number.
    from_a
        True when the flow comes from +x.

    Notes
    -----
    The correction is half the limited slope (van Leer) of the upstream cell: second order without
    widening the Newton matrix.
    """
    ratio = carried / conductance
    peclet = np.maximum(ratio[1:], ratio[:-1])
    step = gap[1:] - gap[:-1]
    before = np.zeros_like(step)
    if from_a:
        before[:-1] = step[1:]
    else:
        before[1:] = step[:-1]
    product = before * step
    limited = np.where(product > 0, product / np.where(product > 0, before + step, 1.0), 0.0)
    return Upwinding(peclet**2 / (1 + peclet**2), -limited if from_a else limited)


def film_flow(
    gap: Array,
    pressure: Array,
    conductance: Array,
    conductance_slope: Array,
    *,
    spacing: float,
    wall_speed: float,
    lean: Upwinding | None = None,
) -> Flow:
    """Return the net outflow of each cell, -div-free part included, with its derivatives.

    Parameters
    ----------
    gap, pressure
        (nx, ny) m and Pa. Outside the film the pressure is 0.
    conductance, conductance_slope
        phi h^3 / (12 eta) and its derivative by h, (nx, ny).
    spacing
        Cell size, m.
    wall_speed
        Speed of the floor along +x seen from the sole, m/s (minus the sliding speed).
    lean
        Upwinding of the x faces; None for a rigid film.
    """
    shape = gap.shape
    k, dk = conductance, conductance_slope
    kx, kx_a, kx_b = series_conductance(k[1:], k[:-1], dk[1:], dk[:-1])
    ky, ky_a, ky_b = series_conductance(k[:, 1:], k[:, :-1], dk[:, 1:], dk[:, :-1])
    drop_x = pressure[1:] - pressure[:-1]
    drop_y = pressure[:, 1:] - pressure[:, :-1]

    a, b = gap[1:], gap[:-1]
    shear = shear_gap(a, b, k[1:], k[:-1], dk[1:], dk[:-1])
    if lean is not None:
        shear = upwind_blend(a, b, shear, lean, from_a=wall_speed < 0)
    half_speed = 0.5 * wall_speed * spacing
    shear_x = half_speed * shear[0]
    flux_x = shear_x - kx * drop_x
    flux_y = -ky * drop_y
    x_a = half_speed * shear[1] - kx_a * drop_x
    x_b = half_speed * shear[2] - kx_b * drop_x
    y_a = -ky_a * drop_y
    y_b = -ky_b * drop_y

    outflow = _divergence(flux_x, flux_y, shape)
    centre, east, west, north, south = (np.zeros(shape) for _ in range(5))
    centre[1:] += kx
    centre[:-1] += kx
    centre[:, 1:] += ky
    centre[:, :-1] += ky
    east[:-1] = -kx
    west[1:] = -kx
    north[:, :-1] = -ky
    south[:, 1:] = -ky
    by_pressure = Stencil(centre, east, west, north, south)

    centre, east, west, north, south = (np.zeros(shape) for _ in range(5))
    centre[1:] -= x_a
    centre[:-1] += x_b
    centre[:, 1:] -= y_a
    centre[:, :-1] += y_b
    east[:-1] = x_a
    west[1:] = -x_b
    north[:, :-1] = y_a
    south[:, 1:] = -y_b
    by_gap = Stencil(centre, east, west, north, south)
    shear_only = _divergence(shear_x, np.zeros_like(flux_y), shape)
    return Flow(outflow, by_pressure, by_gap, float(np.abs(shear_only).sum()))


def _divergence(flux_x: Array, flux_y: Array, shape: tuple[int, ...]) -> Array:
    outflow = np.zeros(shape)
    outflow[:-1] += flux_x
    outflow[1:] -= flux_x
    outflow[:, :-1] += flux_y
    outflow[:, 1:] -= flux_y
    return outflow
