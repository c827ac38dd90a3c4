"""Mass balance of a film on cells in rows along x, whose faces know the gap between two centres.

    R(p, theta, h) = div[ theta U h e_x - phi h^3 / (12 eta) grad p ] + d(theta h)/dt
    p >= 0,  theta <= 1,  p (1 - theta) = 0

as in ``film.operator``; there on a grid, here on any cells in rows. Between the centres of two
cells of a row the gap is two straight pieces that meet in a node; at an edge they end at two
heights. With K = phi h^3 / (12 eta) at both ends of a piece of length l, a = K^(1/3), and H the
harmonic mean of the gaps at its ends,

    r = l (a + b) / (2 a^2 b^2),  k = w / sum r,  h_c = sum(r H) / sum r

are exact for phi = 1: int h^-3 dx and int h^-2 dx over a straight piece. The flow through the face,
w wide, is q = w U h_c theta_upstream - k (p_east - p_west). In one dimension the pressures at the
centres then have no error, wherever the corners lie. Faces across have two parts in series.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask

from .operator import (
    Cavity,
    Conductance,
    FaceValue,
    SparseLayout,
    Upwinding,
    series_conductance,
    upwind_blend,
)

Indices = NDArray[np.intp]


class RowFaces(Protocol):
    """Faces between neighbours in a row: the cells west and east and the way between them."""

    @property
    def west(self) -> Indices:
        """The cell west of each face."""
        ...

    @property
    def east(self) -> Indices:
        """The cell east of each face."""
        ...

    @property
    def distance(self) -> Array:
        """The way between their centres, in spacings."""
        ...


@dataclass(frozen=True)
class Faces:
    """Cells of which the first ``size`` are unknowns, and the faces that join them.

    ``west`` and ``east`` are the cells of x faces, ``south`` and ``north`` those of y faces;
    lengths in units of ``spacing`` (m), rises in m, all as in ``shoe.row_cells.RowCells``.
    """

    count: int
    size: int
    spacing: float
    west: Indices
    east: Indices
    distance: Array
    node: Array
    lean: Array
    rise: Array
    south: Indices
    north: Indices
    overlap: Array
    crossing: Array

    @cached_property
    def ahead(self) -> Indices:
        """The cell on the far side of each face, x faces first."""
        return np.concatenate([self.east, self.north])

    @cached_property
    def behind(self) -> Indices:
        """The cell on the near side of each face, x faces first."""
        return np.concatenate([self.west, self.south])

    @cached_property
    def layout(self) -> tuple[Indices, Indices]:
        """Rows and columns of a ``FaceMatrix``; column -1 where either is no unknown."""
        numbers = np.arange(self.size)
        rows = np.concatenate([numbers, self.behind, self.ahead])
        columns = np.concatenate([numbers, self.ahead, self.behind])
        return rows, np.where((rows < self.size) & (columns < self.size), columns, -1)

    @cached_property
    def sparse(self) -> SparseLayout:
        """Layout of one operator between the unknowns."""
        return SparseLayout(*self._rows_within(), (self.size, self.size))

    @cached_property
    def pair(self) -> SparseLayout:
        """Layout of two operators side by side."""
        rows, columns = self._rows_within()
        beside = np.where(columns < 0, -1, columns + self.size)
        rows, columns = np.concatenate([rows, rows]), np.concatenate([columns, beside])
        return SparseLayout(rows, columns, (self.size, 2 * self.size))

    def _rows_within(self) -> tuple[Indices, Indices]:
        rows, columns = self.layout
        return np.minimum(rows, self.size - 1), columns

    @cached_property
    def face_to_east(self) -> Indices:
        """The x face east of each cell, -1 for none."""
        faces = np.full(self.count, -1)
        faces[self.west] = np.arange(self.west.size)
        return faces

    def divergence(self, flow: Array) -> Array:
        """Return what flows through the faces, x faces first, take out of each cell, (count,)."""
        out = np.bincount(self.behind, flow, self.count)
        return np.asarray(out - np.bincount(self.ahead, flow, self.count), dtype=np.float64)


class Inlet(NamedTuple):
    """What edges of lugs, finer than the cells, let through the x faces, (faces,)."""

    film: Array  # m, gap of the shear flow that a closed edge lets in
    closed: Array  # how far the edge is closed: 0 where cells hold it or none is, 1
    passing: Array  # share of the pressure flow that passes


class FaceMatrix(NamedTuple):
    """Operator between cells that share a face: its diagonal (count,) and what faces add.

    ``to_ahead`` stands in the row of the cell behind a face, ``to_behind`` in that of the one ahead
    of it, (faces,).
    """

    faces: Faces
    diagonal: Array
    to_ahead: Array
    to_behind: Array

    @classmethod
    def of_flow(cls, faces: Faces, by_ahead: Array, by_behind: Array, centre: Array) -> FaceMatrix:
        """Return ``centre`` plus the divergence of flows with these derivatives by both cells."""
        diagonal = centre + np.bincount(faces.behind, by_behind, faces.count)
        diagonal -= np.bincount(faces.ahead, by_ahead, faces.count)
        return cls(faces, diagonal, by_ahead, -by_behind)

    def columns(self, factor: Array) -> FaceMatrix:
        """Return the matrix with its columns times a factor (count,)."""
        return self._scale(factor, factor[self.faces.ahead], factor[self.faces.behind])

    def rows(self, factor: Array) -> FaceMatrix:
        """Return the matrix with its rows times a factor (count,)."""
        return self._scale(factor, factor[self.faces.behind], factor[self.faces.ahead])

    def _scale(self, centre: Array, ahead: Array, behind: Array) -> FaceMatrix:
        diagonal = self.diagonal * centre
        return FaceMatrix(self.faces, diagonal, self.to_ahead * ahead, self.to_behind * behind)

    def plus(self, other: FaceMatrix) -> FaceMatrix:
        """Return the sum of two matrices."""
        return FaceMatrix(
            self.faces,
            self.diagonal + other.diagonal,
            self.to_ahead + other.to_ahead,
            self.to_behind + other.to_behind,
        )

    @property
    def coefficients(self) -> Array:
        """The entries in the order of ``Faces.layout``."""
        return np.concatenate([self.diagonal[: self.faces.size], self.to_ahead, self.to_behind])

    def matrix(self) -> sp.csr_matrix:
        """Return the sparse matrix between the unknowns."""
        return self.faces.sparse.matrix(self.coefficients)

    def sums(self) -> Array:
        """Return the sum of each row over its unknowns, (size,)."""
        return np.asarray(self.matrix().sum(axis=1)).ravel()


@dataclass(frozen=True)
class FaceOperator:
    """Coefficients of the balance at one gap, (count,) and faces, x faces first where of both."""

    faces: Faces
    gap: Array  # m, finite and positive everywhere
    kx: FaceValue  # m^3/(Pa s)
    ky: FaceValue
    carry: FaceValue  # what the walls carry through a full x face, m^3/s
    backward: bool  # the walls carry towards -x
    storage: Array | float

    @cached_property
    def by_pressure(self) -> FaceMatrix:
        """Derivative of the balance by pressure, m^3/(Pa s)."""
        k = np.concatenate([self.kx.value, self.ky.value])
        return FaceMatrix.of_flow(self.faces, -k, k, np.zeros(self.faces.count))

    @cached_property
    def by_fraction(self) -> FaceMatrix:
        """Derivative of the balance by liquid fraction, m^3/s; a cell depends on its upstream."""
        carry = np.concatenate([self.carry.value, np.zeros(self.faces.south.size)])
        none = np.zeros_like(carry)
        ahead, behind = (carry, none) if self.backward else (none, carry)
        return FaceMatrix.of_flow(self.faces, ahead, behind, self.storage * self.gap)

    def by_gap(self, pressure: Array, fraction: Array) -> FaceMatrix:
        """Return the derivative of the balance by gap, m^2/s, at given pressure and fraction."""
        faces = self.faces
        drop_x = pressure[faces.west] - pressure[faces.east]
        drop_y = pressure[faces.south] - pressure[faces.north]
        filled = self._upstream(fraction)
        ahead = np.concatenate(
            [self.carry.by_a * filled + self.kx.by_a * drop_x, self.ky.by_a * drop_y]
        )
        behind = np.concatenate(
            [self.carry.by_b * filled + self.kx.by_b * drop_x, self.ky.by_b * drop_y]
        )
        return FaceMatrix.of_flow(faces, ahead, behind, self.storage * fraction)

    def wall_transport(self, fraction: Array) -> Array:
        """Return what the walls carry through the x faces, m^3/s."""
        return self.carry.value * self._upstream(fraction)

    def imbalance(self, pressure: Array, fraction: Array, content: Array | float) -> Array:
        """Return what leaves each cell plus what it stores, m^3/s: 0 where volume is conserved.

        ``content`` is the liquid per area before the time step, m.
        """
        faces = self.faces
        flow = np.concatenate(
            [
                self.wall_transport(fraction)
                - self.kx.value * (pressure[faces.east] - pressure[faces.west]),
                self.ky.value * (pressure[faces.south] - pressure[faces.north]),
            ]
        )
        return faces.divergence(flow) + self.storage * (self.gap * fraction - content)

    def _upstream(self, fraction: Array) -> Array:
        return fraction[self.faces.east if self.backward else self.faces.west]


def face_operator(
    faces: Faces,
    gap: Array,
    conductance: Callable[[Array, Array | None], Conductance],
    *,
    before: Array | None,
    limits: tuple[float, float],
    speed: float,
    storage: Array | float = 0.0,
    upstream: Upwinding | None = None,
    inlet: Inlet | None = None,
) -> FaceOperator:
    """Return the mass balance of a film on faces.

    Parameters:
        faces: Cells and faces.
        gap: (count,) m, as it is: the film sees it within ``limits`` (m), but derivatives are those
            of the gap that it sees.
        conductance: phi h^3 / (12 eta) of a gap and of the gap before the step (m), with its
            derivative by the gap.
        before: Gap before the time step; None: conductances are those of ``gap`` alone.
        speed: U, mean speed of the walls along +x, m/s.
        storage: Area of the cells over the time step, m^2/s; 0 for a steady film.
        upstream: How far the shear gap leans upstream (``leaning``); None: not at all.
        inlet: What edges of lugs let in; None: as much as the gap holds.
    """
    west, east, lean = faces.west, faces.east, faces.lean

    def clip_values(values: Array) -> Array:
        return np.clip(values, *limits)

    def nodes(values: Array) -> Array:  # (2, m): the node as seen from the west, from the east
        return (1 - lean) * values[west] + lean * values[east] + faces.rise

    bounded, node = clip_values(gap), clip_values(nodes(gap))
    if before is None:
        centre, middle = conductance(bounded, None), conductance(node, None)
    else:
        centre = conductance(bounded, clip_values(before))
        middle = conductance(node, clip_values(nodes(before)))
    # west piece: from the west's centre to the node; east piece: from the node to the east's centre
    slope = centre.slope
    ends = (
        (bounded[west], centre.value[west], slope[west], faces.node),
        (bounded[east], centre.value[east], slope[east], 1 - faces.node),
    )
    resistance, carrying = np.zeros((2, west.size))
    pieces = []
    for k, (h, value, h_slope, share) in enumerate(ends):
        a, b = np.cbrt(value), np.cbrt(middle.value[k])
        length = share * faces.distance
        both = 1 / (a * a * b * b)
        r = 0.5 * length * (a + b) * both
        # d r / d K at both ends
        of_centre = -length * (0.5 * a + b) * both / (3 * a * a * a) * h_slope
        of_node = -length * (0.5 * b + a) * both / (3 * b * b * b) * middle.slope[k]
        total = h + node[k]
        mean = 2 * h * node[k] / total
        mean_by_centre = 2 * (node[k] / total) ** 2
        mean_by_node = 2 * (h / total) ** 2
        resistance = resistance + r
        carrying = carrying + r * mean
        pieces.append((r, of_centre, of_node, mean, mean_by_centre, mean_by_node))
    k_value = 1 / resistance
    shear = carrying * k_value
    by_west, by_east, shear_west, shear_east = np.zeros((4, west.size))
    for k, (r, of_centre, of_node, mean, mean_by_centre, mean_by_node) in enumerate(pieces):
        turned = of_node * (mean - shear) + r * mean_by_node
        own = of_centre * (mean - shear) + r * mean_by_centre
        by_west = by_west + (1 - lean[k]) * of_node + (of_centre if k == 0 else 0.0)
        by_east = by_east + lean[k] * of_node + (of_centre if k == 1 else 0.0)
        shear_west = shear_west + (1 - lean[k]) * turned + (own if k == 0 else 0.0)
        shear_east = shear_east + lean[k] * turned + (own if k == 1 else 0.0)
    squared = k_value * k_value
    kx = FaceValue(k_value, -by_east * squared, -by_west * squared)
    shear_gap = FaceValue(shear, shear_east * k_value, shear_west * k_value)
    if upstream is not None:
        a, b = bounded[east], bounded[west]
        parted = lean[0] != lean[1]
        shear_gap = upwind_blend(a, b, shear_gap, upstream, from_a=speed < 0, steps=parted)
    if inlet is not None:
        shear_gap = FaceValue(*((1 - inlet.closed) * part for part in shear_gap))
        shear_gap = shear_gap._replace(value=shear_gap.value + inlet.closed * inlet.film)
        kx = FaceValue(*(inlet.passing * part for part in kx))
    carry = FaceValue(*(faces.spacing * speed * part for part in shear_gap))
    m, dm = centre.value, slope
    north, south = faces.north, faces.south
    ky = series_conductance(m[north], m[south], dm[north], dm[south], faces.crossing)
    ky = FaceValue(*(faces.overlap * part for part in ky))
    return FaceOperator(faces, bounded, kx, ky, carry, speed < 0, storage)


def leaning(
    faces: RowFaces, gap: Array, width: Array, carried: Array, conductance: Array, *, backward: bool
) -> Upwinding:
    """Return how far the x faces lean upstream, from a known gap (that of the last time step).

    Parameters:
        faces: Between cells in rows.
        gap, conductance: Of the cells, m and m^3/(Pa s).
        width: Of the cells, in spacings.
        carried: What the shear flow carries of a pressure change, m^3/(Pa s): |U| times width in m
            times deflection per pressure. Over the conductance it is the cell Peclet number.
        backward: The flow comes from the east.

    The correction is the limited slope (van Leer) of the upstream cell, half a cell long: second
    order without widening the Newton matrix.
    """
    west, east = faces.west, faces.east
    ratio = carried / conductance
    peclet = np.maximum(ratio[west], ratio[east])
    slope = (gap[east] - gap[west]) / faces.distance
    further = np.full(gap.size, -1)
    further[west if backward else east] = np.arange(west.size)
    upstream = east if backward else west
    face = further[upstream]
    before = np.where(face >= 0, slope[face], 0.0)
    product = before * slope
    steep = np.where(product > 0, 2 * product / np.where(product > 0, before + slope, 1.0), 0.0)
    half = 0.5 * width[upstream] * steep
    return Upwinding(peclet**2 / (1 + peclet**2), -half if backward else half)


class RowCavity(Cavity):
    """Cavitated cells in rows.

    ``by_fraction`` holds the balance by liquid fraction, ``mask`` (size,) marks the cavitated
    unknowns; ``cells`` are their numbers.
    """

    def __init__(self, by_fraction: FaceMatrix, mask: Mask) -> None:
        faces = by_fraction.faces
        cells = self.cells = np.flatnonzero(mask)
        face = faces.face_to_east[cells[:-1]]
        linked = (face >= 0) & (faces.east[face] == cells[1:]) if cells.size else face >= 0
        self._factorise(
            linked * by_fraction.to_behind[face],
            by_fraction.diagonal[cells],
            linked * by_fraction.to_ahead[face],
        )
