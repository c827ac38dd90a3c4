"""A compliance on cells that are fine along the sliding.

Far away the pressures of fine cells act as their sum over a square cell. Near by they act as on a
half-space of the same rubber, which is what every compliance is for short waves. So

    u = T C R p + N p,   N = L - T L_c R   between cells that are near,

with C the compliance between square cells, R the mean over a square cell, T the curve through the
deflections of the square cells next to a place along x, and L, L_c the deflections of the
half-space (Love 1929) between cells and between square cells.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask
from underfoot.shoe.row_cells import RowCells

from .compliance import Compliance, compliance_within

Indices = NDArray[np.intp]

REACH = 3, 1
"""Square cells along x and y, from the middle one, within which cells are near."""


def rectangle_deflection(x: Array, y: Array, half_x: Array, half_y: float, modulus: float) -> Array:
    """Return the deflection (m/Pa) of a half-space beside a rectangle under a unit pressure.

    Love (1929) at the place (x, y) from the middle of a rectangle of 2 half_x by 2 half_y, all m;
    ``modulus`` is E / (1 - nu^2), Pa.
    """
    total = np.zeros(np.broadcast(x, y, half_x).shape)
    for sx in (-1, 1):
        for sy in (-1, 1):
            a = np.abs(x + sx * half_x) + 1e-15
            b = np.abs(y + sy * half_y) + 1e-15
            sign = sx * sy * np.sign(x + sx * half_x) * np.sign(y + sy * half_y)
            total += sign * (a * np.arcsinh(b / a) + b * np.arcsinh(a / b))
    return total / (np.pi * modulus)


@dataclass(frozen=True, slots=True)
class RowCompliance:
    """Map from the pressures of cells (n,), Pa, to their deflections (n,), m."""

    squares: Compliance  # between the square cells of a box of the map
    shape: tuple[int, int]
    mean: sp.csr_matrix  # R, (squares, n)
    spread: sp.csr_matrix  # T, (n, squares)
    near: sp.csr_matrix  # N, (n, n)
    self_compliance: Array

    def apply(self, pressure: NDArray[Any]) -> NDArray[Any]:
        """Return the deflections."""
        far = self.squares.apply((self.mean @ pressure).reshape(self.shape))
        return self.spread @ far.ravel() + self.near @ pressure

    def symbol(self, wavenumber: Array) -> Array:
        """Return the approximate deflection over pressure (m/Pa) of a wave."""
        return self.squares.symbol(wavenumber)

    def within(self, numbers: NDArray[np.intp], dtype: Any = float) -> RowCompliance:
        """Return the compliance between some of the cells, the rest unloaded.

        Its cost is that of the square cells around them; ``dtype`` is its precision.
        """
        spread: Any = self.spread
        places = spread[numbers]
        i, j = np.divmod(np.unique(places.indices), self.shape[1])
        rows, columns = (slice(int(k.min()), int(k.max()) + 1) for k in (i, j))
        box = rows, columns
        kept = np.arange(self.shape[0] * self.shape[1]).reshape(self.shape)[box].ravel()
        own = self.self_compliance[numbers]
        return RowCompliance(
            compliance_within(self.squares, box, dtype),
            (rows.stop - rows.start, columns.stop - columns.start),
            self.mean[kept][:, numbers].astype(dtype),
            places[:, kept].astype(dtype),
            self.near[numbers][:, numbers].astype(dtype),
            own,
        )


def row_compliance(compliance: Compliance, cells: RowCells, land: Mask) -> RowCompliance:
    """Return the compliance between the cells of a sole, from that between its square cells.

    ``land`` (nx, ny) are the squares that count as land: a land cell in another square belongs to
    the land beside it, where the compliance between squares puts it too.
    """
    shape = cells.shape
    count = shape[0] * shape[1]
    numbers = np.arange(cells.size)
    home = _home(cells, land)
    mean = sp.csr_matrix((cells.width, (home, numbers)), (count, cells.size))
    squares, weights = _stencils(cells, land, home)
    spread = sp.csr_matrix(
        (weights.ravel(), (np.tile(numbers, len(weights)), squares.ravel())), (cells.size, count)
    )
    spread.eliminate_zeros()  # a square cell has its own deflection
    near = sp.csr_matrix((cells.size, cells.size))
    if (cells.width < 1).any():
        near = _near(cells, home, squares, weights, *short_waves(compliance, cells.spacing))
    own = compliance.self_compliance.ravel()[home] * cells.width
    own *= (weights * (squares == home)).sum(axis=0)
    own += near.diagonal()
    return RowCompliance(compliance, shape, mean, spread, near, np.maximum(own, own.max() * 1e-3))


def short_waves(compliance: Compliance, spacing: float) -> tuple[Array, float]:
    """Return weight (nx, ny) and modulus (Pa) of the half-space that short waves meet.

    As the compliance says by ``short_waves``, else 2 / (k C(k)) of its symbol C at the shortest
    wave of cells of ``spacing`` (m).
    """
    known = getattr(compliance, "short_waves", None)
    if known is not None:
        return known
    shortest = np.pi / spacing
    give = float(compliance.symbol(np.array([shortest]))[0])
    return np.ones(compliance.self_compliance.shape), 2 / (shortest * give)


def _home(cells: RowCells, land: Mask) -> Indices:
    """Return the square that each cell belongs to, a flat index."""
    (nx, ny), home = cells.shape, cells.parent.copy()
    i, j = np.divmod(home, ny)
    astray = np.flatnonzero(cells.land & ~land[i, j])
    west = np.where(cells.offset[astray] < 0, -1, 1)
    for step in (west, -west):
        beside = np.clip(i[astray] + step, 0, nx - 1)
        found = land[beside, j[astray]] & ~land.ravel()[home[astray]]
        home[astray[found]] = beside[found] * ny + j[astray[found]]
    return home


def _stencils(cells: RowCells, land: Mask, home: Indices) -> tuple[Indices, Array]:
    """Return the squares (4, n) along x whose deflections give that of a cell, and their weights.

    A cubic through the four squares around it, within the land that it belongs to; beyond the last
    of them a parabola; less where the land is short.
    """
    (nx, ny), (i, j) = cells.shape, np.divmod(home, cells.shape[1])
    places = np.arange(nx)[:, None]
    first = np.maximum.accumulate(np.where(land, -1, places), axis=0) + 1
    last = np.minimum.accumulate(np.where(land, nx, places)[::-1], axis=0)[::-1] - 1
    on = land[i, j]
    low, high = np.where(on, first[i, j], i), np.where(on, last[i, j], i)
    place = cells.parent // ny + cells.offset
    begin = np.floor(place).astype(np.intp) - 1
    inside = (place >= low) & (place <= high)
    many = np.minimum(np.where(inside, 4, 3), high - low + 1)
    begin = np.clip(begin, low, high - many + 1)
    squares, weights = [], []
    for k in range(4):
        weight = np.where(k < many, 1.0, 0.0)
        for m in range(4):
            if m != k:
                weight *= np.where((m < many) & (k < many), (place - begin - m) / (k - m), 1.0)
        squares.append(np.where(k < many, begin + k, i) * ny + j)
        weights.append(weight)
    return np.stack(squares), np.stack(weights)


def _near(
    cells: RowCells, home: Indices, squares: Indices, weights: Array, pressed: Array, modulus: float
) -> sp.csr_matrix:
    """Return N of the cells; ``pressed`` is the weight (nx, ny) of the half-space of ``modulus``.

    ``squares`` and ``weights`` are those of T.
    """
    nx, ny = cells.shape
    spacing = cells.spacing
    order = np.argsort(cells.parent, kind="stable")
    starts = np.searchsorted(cells.parent[order], np.arange(nx * ny + 1))
    many = np.diff(starts)
    i, j = np.divmod(cells.parent, ny)
    fine = many[cells.parent] > 1
    weight = pressed.ravel()[home] * cells.land
    rows, columns = [], []
    for di in range(-REACH[0], REACH[0] + 1):
        for dj in range(-REACH[1], REACH[1] + 1):
            to_i, to_j = i + di, j + dj
            held = (to_i >= 0) & (to_i < nx) & (to_j >= 0) & (to_j < ny) & (weight > 0)
            here = np.flatnonzero(held)
            there = (to_i * ny + to_j)[here]
            # a pair counts where either is a part of its square cell
            kept = fine[here] | (many[there] > 1)
            here, there = here[kept], there[kept]
            times = many[there]
            rows.append(np.repeat(here, times))
            inside = np.arange(times.sum()) - np.repeat(np.cumsum(times) - times, times)
            columns.append(order[np.repeat(starts[there], times) + inside])
    row, column = np.concatenate(rows), np.concatenate(columns)
    kept = weight[column] > 0
    row, column = row[kept], column[kept]
    x = i + cells.offset
    along, across = (x[row] - x[column]) * spacing, (j[row] - j[column]) * spacing
    half = 0.5 * spacing
    exact = rectangle_deflection(along, across, half * cells.width[column], half, modulus)
    # what the curve through the squares' deflections says of the same
    reach = REACH[0] + 6, REACH[1] + 1
    square = rectangle_deflection(
        spacing * np.arange(reach[0], dtype=np.float64)[:, None],
        spacing * np.arange(reach[1], dtype=np.float64)[None, :],
        np.full((1, 1), half),
        half,
        modulus,
    )
    smooth = np.zeros(row.size)
    beside = np.abs(j[row] - j[column])
    for at, part in zip(squares // ny, weights, strict=True):
        smooth += part[row] * square[np.abs(at[row] - home[column] // ny), beside]
    value = (exact - smooth * cells.width[column]) * weight[row] * weight[column]
    return sp.csr_matrix((value, (row, column)), (cells.size, cells.size))
