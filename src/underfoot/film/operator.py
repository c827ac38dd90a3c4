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
factorised without pivoting. A face lies between ``a``, the cell on its far side along the axis, and
``b``. It is two parts in series, exact for a step in the gap: with conductances K_a, K_b and the
share t of the way between the centres that b's gap reaches (1/2, or where an edge cuts the cells),

    k = K_a K_b / (t K_a + (1 - t) K_b)                              pressure flow per difference
    h_c = ((1 - t) a K_b + t b K_a) / (t K_a + (1 - t) K_b)          gap that carries the shear flow

Taking the gap linear between cell centres instead doubles the film under a lug beside a channel.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.linalg import get_lapack_funcs

from underfoot.core.arrays import Array, Mask

dgttrf, dgttrs = get_lapack_funcs(("gttrf", "gttrs"), dtype=np.float64)
SMOOTH, STEP = 1.0, 2.0
"""|ln| of the ratio of neighbouring gaps: up to SMOOTH the film varies, from STEP it is a step."""


class FaceValue(NamedTuple):
    """A quantity of each face and its derivatives by the gaps a and b."""

    value: Array
    by_a: Array
    by_b: Array


class Upwinding(NamedTuple):
    """How far the shear gap of each x face, (nx - 1, ny), leans upstream."""

    strength: Array  # 0 central to 1 upwind
    correction: Array  # m, added to the upstream gap


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


@dataclass(frozen=True)
class FilmOperator:
    """Face coefficients of one gap; made by ``film_operator``.

    ``carry`` is what the walls carry through a full x face, m^3/s. A film let in by an edge finer
    than the grid is a smaller ``carry`` of that face: what leaves one cell still enters the next.
    """

    gap: Array  # m, finite and positive everywhere
    kx: FaceValue  # m^3/(Pa s)
    ky: FaceValue
    carry: FaceValue
    storage: Array | float  # area of the cells over time step, m^2/s; 0 for a steady film

    @property
    def by_pressure(self) -> Stencil:
        """Derivative of the balance by pressure, m^3/(Pa s)."""
        kx, ky = self.kx.value, self.ky.value
        return self._stencil(np.zeros(self.gap.shape), (kx, kx), (ky, ky))

    @cached_property
    def by_fraction(self) -> Stencil:
        """Derivative of the balance by liquid fraction, m^3/s; a cell depends on its upstream."""
        forward, backward = np.maximum(self.carry.value, 0.0), np.minimum(self.carry.value, 0.0)
        return self._stencil(self.storage * self.gap, (-backward, forward))

    def by_gap(self, pressure: Array, fraction: Array) -> Stencil:
        """Return the derivative of the balance by gap, m^2/s, at given pressure and fraction."""
        drop_x, drop_y = pressure[1:] - pressure[:-1], pressure[:, 1:] - pressure[:, :-1]
        filled = self._upstream(fraction)
        x_a = self.carry.by_a * filled - self.kx.by_a * drop_x
        x_b = self.carry.by_b * filled - self.kx.by_b * drop_x
        y_a, y_b = -self.ky.by_a * drop_y, -self.ky.by_b * drop_y
        return self._stencil(self.storage * fraction, (-x_a, x_b), (-y_a, y_b))

    def flows(self, pressure: Array, fraction: Array) -> tuple[Array, Array]:
        """Return the flow (m^3/s) through the x and the y faces."""
        flow_x = self.carried(fraction)
        flow_x -= self.kx.value * (pressure[1:] - pressure[:-1])
        return flow_x, self.ky.value * (pressure[:, :-1] - pressure[:, 1:])

    def carried(self, fraction: Array) -> Array:
        """Return what the walls carry through the x faces, m^3/s."""
        return self.carry.value * self._upstream(fraction)

    def imbalance(self, pressure: Array, fraction: Array, content: Array | float = 0.0) -> Array:
        """Return what leaves each cell plus what it stores, m^3/s: 0 where volume is conserved.

        ``content`` is the liquid per area before the time step, m.
        """
        outflow = divergence(*self.flows(pressure, fraction))
        return outflow + self.storage * (self.gap * fraction - content)

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

    def _stencil(
        self, centre: Array, along: tuple[Array, Array], across: tuple[Array, Array] | None = None
    ) -> Stencil:
        """Return the coefficients of ``centre`` plus flows through the faces.

        Of the two values of a face the first is minus the derivative of its flow by cell a, the
        second the derivative by cell b.
        """
        x_a, x_b = along
        east, west, north, south = (np.zeros(self.gap.shape) for _ in range(4))
        centre[1:] += x_a
        centre[:-1] += x_b
        east[:-1], west[1:] = -x_a, -x_b
        if across is not None:
            y_a, y_b = across
            centre[:, 1:] += y_a
            centre[:, :-1] += y_b
            north[:, :-1], south[:, 1:] = -y_a, -y_b
        return Stencil(centre, east, west, north, south)

    def _upstream(self, fraction: Array) -> Array:
        if self._backward is True:  # a sole that slides forward
            return fraction[1:]
        return np.where(self._backward, fraction[1:], fraction[:-1])

    @cached_property
    def _backward(self) -> Mask | Literal[True]:
        """Faces that the walls carry liquid through towards -x (or none); True for all."""
        backward = self.carry.value <= 0
        return True if backward.all() else backward


class Cavity:
    """Cavitated cells, which pass on along x what they receive: a tridiagonal system."""

    def __init__(self, operator: FilmOperator, mask: Mask) -> None:
        along, across = np.nonzero(mask.T)[::-1]
        self.cells = np.ravel_multi_index((along, across), mask.shape)  # x runs fastest
        rows = operator.by_fraction
        linked = (np.diff(along) == 1) & (np.diff(across) == 0)
        # factorised once, for it is solved in each product; three rows of their own at the end, for
        # LAPACK's wrapper takes no fewer
        below, above = np.zeros((2, self.cells.size + 2))
        below[: linked.size] = np.where(linked, rows.west.flat[self.cells[1:]], 0.0)
        above[: linked.size] = np.where(linked, rows.east.flat[self.cells[:-1]], 0.0)
        own = np.append(rows.centre.flat[self.cells], np.ones(3))
        *self._factors, failed = dgttrf(below, own, above)
        if failed:
            raise np.linalg.LinAlgError("a cavity that neither holds nor passes on liquid")

    def filled_by(self, inflow: Array) -> Array:
        """Return the liquid fraction that an inflow (m^3/s) makes, both at ``cells``."""
        if not self.cells.size:
            return inflow
        solution, _ = dgttrs(*self._factors, np.append(inflow, np.zeros(3)))
        return solution[:-3]


def film_operator(
    gap: Array,
    along: Conductance,
    across: Conductance,
    *,
    spacing: tuple[float, float],
    speed: float,
    storage: Array | float = 0.0,
    roughness_flow: Array | None = None,
    upwinding: Upwinding | None = None,
    edges: tuple[Array | float, Array | float] = (0.5, 0.5),
) -> FilmOperator:
    """Return the mass balance of a film of given gap.

    Parameters:
        gap: (nx, ny) m, finite and above 0.
        along, across: Conductance along x and along y.
        spacing: Cell size along x and along y, m.
        speed: U, mean speed of the walls on the grid along +x, m/s (minus half the sliding speed
            where the grid moves with the sole).
        storage: Area of the cells over the time step, m^2/s; 0 for a steady film.
        roughness_flow: s, flow per width that roughness carries besides, (nx, ny), m^2/s.
        upwinding: Of the x faces; None for rigid walls.
        edges: t of the x faces, (nx - 1, ny), and of the y faces, (nx, ny - 1).
    """
    dx, dy = spacing
    k, dk = along
    kx = series_conductance(k[1:], k[:-1], dk[1:], dk[:-1], edges[0])
    m, dm = across
    ky = series_conductance(m[:, 1:], m[:, :-1], dm[:, 1:], dm[:, :-1], edges[1])
    a, b = gap[1:], gap[:-1]
    shear = shear_gap(a, b, (k[1:], k[:-1], dk[1:], dk[:-1]), edges[0])
    if upwinding is not None:
        shear = upwind_blend(a, b, shear, upwinding, from_a=speed < 0)
    carry = FaceValue(*(dy * speed * part for part in shear))
    if roughness_flow is not None:
        nil = np.zeros_like(a)
        flow = roughness_flow[1:], roughness_flow[:-1]
        more = shear_gap(*flow, (k[1:], k[:-1], nil, nil), edges[0])
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


def series_conductance(
    ka: Array, kb: Array, dka: Array, dkb: Array, place: Array | float = 0.5
) -> FaceValue:
    """Return the conductance of two parts in series; ``dka`` is dK_a/da, ``place`` is t."""
    total = place * ka + (1 - place) * kb
    return FaceValue(
        ka * kb / total, (1 - place) * (kb / total) ** 2 * dka, place * (ka / total) ** 2 * dkb
    )


def shear_gap(
    a: Array, b: Array, conductances: tuple[Array, Array, Array, Array], place: Array | float = 0.5
) -> FaceValue:
    """Return the gap that carries the shear flow.

    ``conductances`` are K_a, K_b, dK_a/da and dK_b/db, ``place`` is t.
    """
    ka, kb, dka, dkb = conductances
    rest = 1 - place
    total = place * ka + rest * kb
    gap = (rest * a * kb + place * b * ka) / total
    return FaceValue(
        gap,
        (rest * kb + place * (b - gap) * dka) / total,
        (place * ka + rest * (a - gap) * dkb) / total,
    )


def upwind_blend(
    a: Array, b: Array, shear: FaceValue, lean: Upwinding, *, from_a: bool
) -> FaceValue:
    """Return the shear gap drawn towards the upstream cell where the film is compliant.

    Central values wiggle where the gap answers to the pressure faster than the pressure flow can
    smooth it (cell Peclet number above 1). A rigid film keeps the series-exact gap, and so does a
    step in the sole, with no remainder: a channel 2 mm deep beside a film of 5 um would otherwise
    feed the lug with a flow it doesn't have.
    """
    gap, by_a, by_b = shear
    smooth, slope = _smoothness(a, b)
    weight = lean.strength * smooth
    excess = (a if from_a else b) + lean.correction - gap
    turn = lean.strength * slope * excess
    by_a = (1 - weight) * by_a + turn / a
    by_b = (1 - weight) * by_b - turn / b
    if from_a:
        by_a = by_a + weight
    else:
        by_b = by_b + weight
    return FaceValue(gap + weight * excess, by_a, by_b)


def upwinding(gap: Array, carried: Array, conductance: Array, *, from_a: bool) -> Upwinding:
    """Return how far the x faces lean upstream, from a known gap (that of the last time step).

    Parameters:
        gap, conductance: (nx, ny) m and m^3/(Pa s).
        carried: |U| times spacing times deflection per pressure, (nx, ny), m^3/(Pa s): what the
            shear flow carries of a pressure change. Over the conductance it is the cell Peclet
            number.
        from_a: True when the flow comes from +x.

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


def _smoothness(a: Array, b: Array) -> tuple[Array, Array]:
    """Return 1 between gaps alike, 0 across a step, and the derivative by ln(a / b)."""
    ratio = np.log(a / b)
    place = np.clip((np.abs(ratio) - SMOOTH) / (STEP - SMOOTH), 0.0, 1.0)
    value = 1 - place * place * (3 - 2 * place)
    return value, -6 * place * (1 - place) / (STEP - SMOOTH) * np.sign(ratio)


class Pattern:
    """The numbered cells of a mask and the sparse layout of five-point operators between them."""

    def __init__(self, mask: Mask) -> None:
        self.mask = mask
        self.cells = np.flatnonzero(mask)
        self.size = self.cells.size
        number = np.full(mask.shape, -1, dtype=np.int64)
        number.ravel()[self.cells] = np.arange(self.size)
        shifted = [number]
        for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
            neighbour = np.full(mask.shape, -1, dtype=np.int64)
            inner = [slice(None), slice(None)]
            outer = [slice(None), slice(None)]
            inner[axis] = slice(None, -1) if step > 0 else slice(1, None)
            outer[axis] = slice(1, None) if step > 0 else slice(None, -1)
            neighbour[tuple(inner)] = number[tuple(outer)]
            shifted.append(neighbour)
        self.columns = np.stack([part.ravel()[self.cells] for part in shifted])  # (5, size)
        self._present = self.columns >= 0
        rows = np.broadcast_to(np.arange(self.size), self.columns.shape)[self._present]
        columns = self.columns[self._present]
        self._order = np.lexsort((columns, rows))
        self.rows = rows[self._order]
        self.indices = columns[self._order].astype(np.int32)
        self.indptr = np.searchsorted(self.rows, np.arange(self.size + 1)).astype(np.int32)
        sparse = np.ones(self.rows.size), self.indices, self.indptr
        self._ones = sp.csr_matrix(sparse, shape=(self.size, self.size))

    def gather(self, field: NDArray[Any]) -> NDArray[Any]:
        """Return the values of a grid field at the numbered cells."""
        return field.ravel()[self.cells]

    def scatter(self, values: Array) -> Array:
        """Return the grid field that holds ``values`` at the numbered cells and 0 elsewhere."""
        field = np.zeros(self.mask.shape)
        field.ravel()[self.cells] = values
        return field

    def rows_of(self, stencil: Stencil) -> Array:
        """Return the (5, size) coefficients of the numbered cells."""
        return np.stack([part.ravel()[self.cells] for part in stencil])

    def neighbours_of(self, values: Array, outside: float = 0.0) -> Array:
        """Return (5, size): ``values`` (size,) at each cell and its four neighbours."""
        return np.where(self._present, values[self.columns], outside)

    def data(self, coefficients: Array) -> Array:
        """Return the CSR data of (5, size) coefficients; columns outside the mask are dropped."""
        return coefficients[self._present][self._order]

    def matrix(self, coefficients: Array) -> sp.csr_matrix:
        """Return the sparse matrix of (5, size) coefficients."""
        matrix = copy(self._ones)  # SciPy's constructor takes longer than a product
        matrix.data = self.data(coefficients)
        return matrix
