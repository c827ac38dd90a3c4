"""Mass balance of a film on a grid: the one Reynolds operator under sole, pin and block.

    R(p, theta, h) = div[ theta (U h + s) e_x - phi h^3 / (12 eta) grad p ] + d(theta h)/dt
    p >= 0,  theta <= 1,  p (1 - theta) = 0

p is the pressure above that of the cavities, theta the share of the gap that holds liquid, U the
mean speed of the walls on the grid, s the flow that roughness carries. Finite volumes with square
or oblong cells, arrays (nx, ny), x faces (nx - 1, ny), y faces (nx, ny - 1); the flow through an
x face is

    q = c theta_upstream - k (p_east - p_west)

so that volume is conserved in full film, in cavities and across their borders. For given h the
balance is linear in p and theta, and any mixture of their columns is an M-matrix: it can be
factorised without pivoting.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_banded

from underfoot.core.arrays import Array, Mask

from ._kernels.faces import FaceValue, Upwinding, series_conductance, shear_gap, upwind_blend


class Stencil(NamedTuple):
    """Five-point coefficients, each (nx, ny): row of a cell, columns itself and its neighbours."""

    centre: Array
    east: Array
    west: Array
    north: Array
    south: Array


class Conductance(NamedTuple):
    """phi h^3 / (12 eta), m^3/(Pa s), and its derivative by h, each (nx, ny)."""

    value: Array
    slope: Array


@dataclass(frozen=True, slots=True)
class FilmOperator:
    """Face coefficients of one gap; made by ``film_operator``.

    ``carry`` is what the walls carry through a full x face, m^3/s. A film let in by an edge finer
    than the grid is a smaller ``carry`` of that face: what leaves one cell still enters the next.
    """

    gap: Array  # m, finite and positive everywhere
    kx: FaceValue  # m^3/(Pa s)
    ky: FaceValue
    carry: FaceValue
    storage: float  # cell area over time step, m^2/s; 0 for a steady film

    @property
    def by_pressure(self) -> Stencil:
        """Derivative of the balance by pressure, m^3/(Pa s)."""
        kx, ky = self.kx.value, self.ky.value
        centre, east, west, north, south = (np.zeros(self.gap.shape) for _ in range(5))
        centre[1:] += kx
        centre[:-1] += kx
        centre[:, 1:] += ky
        centre[:, :-1] += ky
        east[:-1], west[1:] = -kx, -kx
        north[:, :-1], south[:, 1:] = -ky, -ky
        return Stencil(centre, east, west, north, south)

    @property
    def by_fraction(self) -> Stencil:
        """Derivative of the balance by liquid fraction, m^3/s; a cell depends on its upstream."""
        forward, backward = np.maximum(self.carry.value, 0.0), np.minimum(self.carry.value, 0.0)
        centre = self.storage * self.gap
        east, west, nil = (np.zeros(self.gap.shape) for _ in range(3))
        centre[:-1] += forward
        centre[1:] -= backward
        west[1:] = -forward
        east[:-1] = backward
        return Stencil(centre, east, west, nil, nil)

    def by_gap(self, pressure: Array, fraction: Array) -> Stencil:
        """Return the derivative of the balance by gap, m^2/s, at given pressure and fraction."""
        drop_x, drop_y = np.diff(pressure, axis=0), np.diff(pressure, axis=1)
        filled = self._upstream(fraction)
        x_a = self.carry.by_a * filled - self.kx.by_a * drop_x
        x_b = self.carry.by_b * filled - self.kx.by_b * drop_x
        y_a, y_b = -self.ky.by_a * drop_y, -self.ky.by_b * drop_y
        centre = self.storage * fraction
        east, west, north, south = (np.zeros(self.gap.shape) for _ in range(4))
        centre[1:] -= x_a
        centre[:-1] += x_b
        centre[:, 1:] -= y_a
        centre[:, :-1] += y_b
        east[:-1], west[1:] = x_a, -x_b
        north[:, :-1], south[:, 1:] = y_a, -y_b
        return Stencil(centre, east, west, north, south)

    def flows(self, pressure: Array, fraction: Array) -> tuple[Array, Array]:
        """Return the flow (m^3/s) through the x and the y faces."""
        flow_x = self.carry.value * self._upstream(fraction)
        flow_x -= self.kx.value * np.diff(pressure, axis=0)
        return flow_x, -self.ky.value * np.diff(pressure, axis=1)

    def imbalance(self, pressure: Array, fraction: Array, content: Array | float = 0.0) -> Array:
        """Return what leaves each cell plus what it stores, m^3/s: 0 where volume is conserved.

        ``content`` is the liquid per area before the time step, m.
        """
        outflow = divergence(*self.flows(pressure, fraction))
        if self.storage:
            outflow += self.storage * (self.gap * fraction - content)
        return outflow

    def cavity_fraction(
        self, pressure: Array, cavity: Cavity, content: Array | float = 0.0
    ) -> Array:
        """Return the liquid fraction that conserves volume in a cavity, 1 elsewhere.

        Values above 1 say that the cell has filled up.
        """
        fraction = np.ones_like(self.gap)
        fraction.flat[cavity.cells] = 0.0
        sent = -self.imbalance(pressure, fraction, content)
        fraction.flat[cavity.cells] = cavity.filled_by(sent.flat[cavity.cells])
        return fraction

    def _upstream(self, fraction: Array) -> Array:
        if (self.carry.value < 0).all():  # a sole that slides forward
            return fraction[1:]
        return np.where(self.carry.value > 0, fraction[:-1], fraction[1:])


class Cavity:
    """Cavitated cells, which pass on along x what they receive: a tridiagonal system."""

    def __init__(self, operator: FilmOperator, mask: Mask) -> None:
        along, across = np.nonzero(mask.T)[::-1]
        self.cells = np.ravel_multi_index((along, across), mask.shape)  # x runs fastest
        rows = operator.by_fraction
        linked = (np.diff(along) == 1) & (np.diff(across) == 0)
        self._bands = np.zeros((3, self.cells.size))
        self._bands[0, 1:] = np.where(linked, rows.east.flat[self.cells[:-1]], 0.0)
        self._bands[1] = rows.centre.flat[self.cells]
        self._bands[2, :-1] = np.where(linked, rows.west.flat[self.cells[1:]], 0.0)

    def filled_by(self, inflow: Array) -> Array:
        """Return the liquid fraction that an inflow (m^3/s) makes, both at ``cells``."""
        if not self.cells.size:
            return inflow
        return solve_banded((1, 1), self._bands, inflow, check_finite=False)


def film_operator(
    gap: Array,
    along: Conductance,
    across: Conductance,
    *,
    spacing: tuple[float, float],
    speed: float,
    storage: float = 0.0,
    roughness_flow: Array | None = None,
    upwinding: Upwinding | None = None,
) -> FilmOperator:
    """Return the mass balance of a film of given gap.

    Parameters:
        gap: (nx, ny) m, finite and above 0.
        along, across: Conductance along x and along y.
        spacing: Cell size along x and along y, m.
        speed: U, mean speed of the walls on the grid along +x, m/s (minus half the sliding speed
            where the grid moves with the sole).
        storage: Area of a cell over the time step, m^2/s; 0 for a steady film.
        roughness_flow: s, flow per width that roughness carries besides, (nx, ny), m^2/s.
        upwinding: Of the x faces; None for rigid walls.
    """
    dx, dy = spacing
    k, dk = along
    kx = series_conductance(k[1:], k[:-1], dk[1:], dk[:-1])
    ky = series_conductance(
        across.value[:, 1:], across.value[:, :-1], across.slope[:, 1:], across.slope[:, :-1]
    )
    a, b = gap[1:], gap[:-1]
    shear = shear_gap(a, b, k[1:], k[:-1], dk[1:], dk[:-1])
    if upwinding is not None:
        shear = upwind_blend(a, b, shear, upwinding, from_a=speed < 0)
    carry = FaceValue(*(dy * speed * part for part in shear))
    if roughness_flow is not None:
        nil = np.zeros_like(a)
        more = shear_gap(roughness_flow[1:], roughness_flow[:-1], k[1:], k[:-1], nil, nil)
        carry = carry._replace(value=carry.value + dy * more.value)
    return FilmOperator(
        gap,
        FaceValue(*(dy / dx * part for part in kx)),
        FaceValue(*(dx / dy * part for part in ky)),
        carry,
        storage,
    )


def divergence(flow_x: Array, flow_y: Array) -> Array:
    """Return what the flows through the faces take out of each cell, m^3/s."""
    outflow = np.zeros((flow_y.shape[0], flow_x.shape[1]))
    outflow[:-1] += flow_x
    outflow[1:] -= flow_x
    outflow[:, :-1] += flow_y
    outflow[:, 1:] -= flow_y
    return outflow
