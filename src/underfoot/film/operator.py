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
    h_c = k ((1 - t) a / K_a + t b / K_b)                            gap that carries the shear flow

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


Stencil = Array
"""(5, nx, ny): coefficients of a cell's row in its own column and those to the east, west (x) and
north, south (y)."""


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
        return self._stencil(0.0, (-kx, kx), (-ky, ky))

    @cached_property
    def by_fraction(self) -> Stencil:
        """Derivative of the balance by liquid fraction, m^3/s; a cell depends on its upstream."""
        forward, backward = np.maximum(self.carry.value, 0.0), np.minimum(self.carry.value, 0.0)
        return self._stencil(self.storage * self.gap, (backward, forward))

    def by_gap(self, pressure: Array, fraction: Array) -> Stencil:
        """Return the derivative of the balance by gap, m^2/s, at given pressure and fraction."""
        drop_x, drop_y = pressure[:-1] - pressure[1:], pressure[:, :-1] - pressure[:, 1:]
        filled = self._upstream(fraction)
        x_a = self.carry.by_a * filled + self.kx.by_a * drop_x
        x_b = self.carry.by_b * filled + self.kx.by_b * drop_x
        y_a, y_b = self.ky.by_a * drop_y, self.ky.by_b * drop_y
        return self._stencil(self.storage * fraction, (x_a, x_b), (y_a, y_b))

    def flows(self, pressure: Array, fraction: Array) -> tuple[Array, Array]:
        """Return the flow (m^3/s) through the x and the y faces."""
        flow_x = self.wall_transport(fraction)
        flow_x -= self.kx.value * (pressure[1:] - pressure[:-1])
        return flow_x, self.ky.value * (pressure[:, :-1] - pressure[:, 1:])

    def wall_transport(self, fraction: Array) -> Array:
        """Return what the walls carry through the x faces, m^3/s."""
        return self.carry.value * self._upstream(fraction)

    def imbalance(self, pressure: Array, fraction: Array, content: Array | float = 0.0) -> Array:
        """Return what leaves each cell plus what it stores, m^3/s: 0 where volume is conserved.

        ``content`` is the liquid per area before the time step, m.
        """
        outflow = divergence(*self.flows(pressure, fraction))
        return outflow + self.storage * (self.gap * fraction - content)

    def _stencil(
        self,
        centre: Array | float,
        along: tuple[Array, Array],
        across: tuple[Array, Array] | None = None,
    ) -> Stencil:
        """Return the coefficients of ``centre`` plus flows through the faces.

        The two values of a face are the derivatives of its flow by cell a and by cell b.
        """
        stencil: Stencil = np.zeros((5, *self.gap.shape))
        own, east, west, north, south = stencil
        own += centre
        x_a, x_b = along
        own[1:] -= x_a
        own[:-1] += x_b
        east[:-1] = x_a
        np.negative(x_b, out=west[1:])
        if across is not None:
            y_a, y_b = across
            own[:, 1:] -= y_a
            own[:, :-1] += y_b
            north[:, :-1] = y_a
            np.negative(y_b, out=south[:, 1:])
        return stencil

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
    """Cavitated cells, which pass on along x what they receive: a tridiagonal system.

    ``by_fraction`` (5, size) holds the rows of the numbered cells, ``mask`` (size,) marks those
    that are cavitated; ``cells`` are their numbers.
    """

    def __init__(self, pattern: Pattern, by_fraction: Array, mask: Mask) -> None:
        cells = self.cells = pattern.along[mask[pattern.along]]
        linked = pattern.columns[1, cells[:-1]] == cells[1:]
        self._factorise(
            linked * by_fraction[2, cells[1:]],
            by_fraction[0, cells],
            linked * by_fraction[1, cells[:-1]],
        )

    def _factorise(self, below: Array, diagonal: Array, above: Array) -> None:
        # factorised once, for it is solved in each product; three rows of their own at the end, for
        # LAPACK's wrapper takes no fewer
        size = diagonal.size
        rows = np.zeros((3, size + 3))
        rows[0, : below.size], rows[2, : above.size] = below, above
        rows[1, :size], rows[1, size:] = diagonal, 1.0
        *self._factors, failed = dgttrf(rows[0, :-1], rows[1], rows[2, :-1])
        if failed:
            raise np.linalg.LinAlgError("a cavity that neither holds nor passes on liquid")

    def filled_by(self, inflow: Array) -> Array:
        """Return the liquid fraction (size,) that an inflow (m^3/s) makes; 0 in other cells."""
        right = np.zeros(self.cells.size + 3)
        right[:-3] = inflow[self.cells]
        solution, _ = dgttrs(*self._factors, right, overwrite_b=True)
        filled = np.zeros_like(inflow)
        filled[self.cells] = solution[:-3]
        return filled


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
    k, dk = (dy / dx * part for part in along)
    kx = series_conductance(k[1:], k[:-1], dk[1:], dk[:-1], edges[0])
    m, dm = (dx / dy * part for part in across)
    ky = series_conductance(m[:, 1:], m[:, :-1], dm[:, 1:], dm[:, :-1], edges[1])
    a, b = gap[1:], gap[:-1]
    of_a, of_b = (1 - edges[0]) / k[1:], edges[0] / k[:-1]
    shear = shear_gap(a, b, of_a, of_b, kx)
    if upwinding is not None:
        shear = upwind_blend(a, b, shear, upwinding, from_a=speed < 0)
    carry = FaceValue(*(dy * speed * part for part in shear))
    if roughness_flow is not None:
        more = kx.value * (of_a * roughness_flow[1:] + of_b * roughness_flow[:-1])
        carry = carry._replace(value=carry.value + dy * more)
    return FilmOperator(gap, kx, ky, carry, storage)


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
    rest = 1 - place
    total = place * ka + rest * kb
    to_a, to_b = ka / total, kb / total
    return FaceValue(ka * to_b, rest * to_b * to_b * dka, place * to_a * to_a * dkb)


def shear_gap(a: Array, b: Array, of_a: Array, of_b: Array, series: FaceValue) -> FaceValue:
    """Return the gap that carries the shear flow: the mean of two parts, each by its resistance.

    ``of_a``, ``of_b`` are the resistances (1 - t) / K_a and t / K_b, ``series`` the conductance.
    """
    share, rest, step = of_a * series.value, of_b * series.value, a - b
    return FaceValue(
        share * a + rest * b, share - step * of_b * series.by_a, rest + step * of_a * series.by_b
    )


def upwind_blend(
    a: Array,
    b: Array,
    shear: FaceValue,
    lean: Upwinding,
    *,
    from_a: bool,
    steps: Mask | Literal[True] = True,
) -> FaceValue:
    """Return the shear gap drawn towards the upstream cell where the film is compliant.

    Central values wiggle where the gap answers to the pressure faster than the pressure flow can
    smooth it (cell Peclet number above 1). A rigid film keeps the series-exact gap, and so does a
    step in the sole, with no remainder: a channel 2 mm deep beside a film of 5 um would otherwise
    feed the lug with a flow it doesn't have. ``steps`` are the faces that may hold one: others know
    the gap between their cells.
    """
    gap, by_a, by_b = shear
    smooth, slope = _smoothness(a, b)
    smooth, slope = np.where(steps, smooth, 1.0), np.where(steps, slope, 0.0)
    weight = lean.strength * smooth
    excess = (a if from_a else b) + lean.correction - gap
    turn = lean.strength * slope * excess
    kept = 1 - weight
    by_a = kept * by_a + turn / a
    by_b = kept * by_b - turn / b
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
    ratio = np.log(b / a)
    near = np.clip((STEP - np.abs(ratio)) / (STEP - SMOOTH), 0.0, 1.0)
    slope = 6 / (STEP - SMOOTH) * near * (1 - near)
    return near * near * (3 - 2 * near), np.copysign(slope, ratio)


class SparseLayout:
    """Where the entries of a sparse matrix lie, to fill it again and again.

    ``rows`` and ``columns`` are of any one shape, that of the coefficients which fill the matrix; a
    column below 0 stands for none.
    """

    def __init__(
        self, rows: NDArray[np.integer], columns: NDArray[np.integer], shape: tuple[int, int]
    ) -> None:
        present = np.flatnonzero(columns.ravel() >= 0)
        # one row after another
        places = rows.ravel()[present] * shape[1] + columns.ravel()[present]
        order = np.argsort(places)
        self._places = present[order]
        row, column = np.divmod(places[order], shape[1])
        starts = np.searchsorted(row, np.arange(shape[0] + 1))
        sparse = np.ones(order.size), column.astype(np.int32), starts.astype(np.int32)
        self._ones = sp.csr_matrix(sparse, shape=shape)

    def matrix(self, coefficients: Array) -> sp.csr_matrix:
        """Return the matrix of coefficients; those without a column are dropped."""
        matrix = copy(self._ones)  # SciPy's constructor takes longer than a product
        matrix.data = coefficients.take(self._places)
        return matrix


class Pattern:
    """The numbered cells of a mask and the sparse layout of five-point operators between them."""

    def __init__(self, mask: Mask) -> None:
        self.mask = mask
        self.cells = np.flatnonzero(mask)
        self.size = self.cells.size
        number = np.full(mask.shape, -1, dtype=np.int64)
        number.ravel()[self.cells] = np.arange(self.size)
        shifted = [number]
        first, last, every = slice(None, -1), slice(1, None), slice(None)
        for inner, outer in (
            ((first, every), (last, every)),
            ((last, every), (first, every)),
            ((every, first), (every, last)),
            ((every, last), (every, first)),
        ):
            neighbour = np.full(mask.shape, -1, dtype=np.int64)
            neighbour[inner] = number[outer]
            shifted.append(neighbour)
        self.columns = np.stack([part.ravel()[self.cells] for part in shifted])  # (5, size)
        self.beside = np.where(self.columns < 0, -1, self.columns + self.size)  # of a second block
        self.rows = np.broadcast_to(np.arange(self.size), self.columns.shape)
        self.along = number.T[mask.T]  # the cells line after line along x
        self._layout = SparseLayout(self.rows, self.columns, (self.size, self.size))

    @cached_property
    def pair(self) -> SparseLayout:
        """Layout of two operators side by side, filled by (10, size) coefficients."""
        columns = np.concatenate([self.columns, self.beside])
        return SparseLayout(np.tile(self.rows, (2, 1)), columns, (self.size, 2 * self.size))

    def gather(self, field: NDArray[Any]) -> NDArray[Any]:
        """Return the values of a grid field at the numbered cells."""
        return field.ravel()[self.cells]

    def scatter(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return the grid field that holds ``values`` at the numbered cells and 0 elsewhere."""
        field = np.zeros(self.mask.shape, values.dtype)
        field.ravel()[self.cells] = values
        return field

    def rows_of(self, stencil: Stencil) -> Array:
        """Return the (5, size) coefficients of the numbered cells."""
        return stencil.reshape(5, -1).take(self.cells, axis=1)

    def neighbours_of(self, values: NDArray[Any], outside: float = 0) -> NDArray[Any]:
        """Return (5, size): ``values`` (size,) at each cell and its four neighbours."""
        padded = np.append(values, values.dtype.type(outside))  # column -1 is the last
        return padded.take(self.columns)

    def matrix(self, coefficients: Array) -> sp.csr_matrix:
        """Return the sparse matrix of (5, size) coefficients; columns outside are dropped."""
        return self._layout.matrix(coefficients)
