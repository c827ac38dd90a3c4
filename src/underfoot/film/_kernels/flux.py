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
STEEP = (
    0.05  # relative step of the gap from which the series-exact shear gap replaces the upwind one
)


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


def upwind_blend(
    a: Array,
    b: Array,
    shear: tuple[Array, Array, Array],
    peclet: Array,
    *,
    from_a: bool,
) -> tuple[Array, Array, Array]:
    """Return the shear gap drawn towards the upstream cell where the film is flat and compliant.

    Central values wiggle where the gap answers to the pressure faster than the pressure flow can
    smooth it (cell Peclet number above 1) and the film is flat; a rigid film (``peclet`` 0) keeps
    the series-exact gap and its second order.
    """
    gap, by_a, by_b = shear
    strength = peclet**2 / (1 + peclet**2)
    total = a + b
    step = (a - b) / (STEEP * total)
    flat = 1 / (1 + step**2)
    weight = strength * flat
    slope = -2 * strength * step * flat**2 * 2 / (STEEP * total**2)
    upstream = a if from_a else b
    excess = upstream - gap
    mixed = gap + weight * excess
    by_a = (1 - weight) * by_a + excess * slope * b
    by_b = (1 - weight) * by_b - excess * slope * a
    if from_a:
        by_a = by_a + weight
    else:
        by_b = by_b + weight
    return mixed, by_a, by_b


def film_flow(
    gap: Array,
    pressure: Array,
    conductance: Array,
    conductance_slope: Array,
    *,
    spacing: float,
    wall_speed: float,
    peclet: Array | None = None,
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
    peclet
        (nx - 1, ny) cell Peclet number of the x faces; None for a rigid film.
    """
    shape = gap.shape
    k, dk = conductance, conductance_slope
    kx, kx_a, kx_b = series_conductance(k[1:], k[:-1], dk[1:], dk[:-1])
    ky, ky_a, ky_b = series_conductance(k[:, 1:], k[:, :-1], dk[:, 1:], dk[:, :-1])
    drop_x = pressure[1:] - pressure[:-1]
    drop_y = pressure[:, 1:] - pressure[:, :-1]

    a, b = gap[1:], gap[:-1]
    shear = shear_gap(a, b, k[1:], k[:-1], dk[1:], dk[:-1])
    if peclet is not None:
        shear = upwind_blend(a, b, shear, peclet, from_a=wall_speed < 0)
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
