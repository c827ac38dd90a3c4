"""Faces of a sole from its cells: every cell at its height, upright walls where a lug ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .drawn_sole import DrawnSole

STEEPEST = 2.0
"""Slope between cells of one level beyond which a wall stands between them."""
BODY = 4e-3
"""m of body drawn above the highest cell, so that the sole has sides."""
_CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))
"""Corners of a cell in order around it, (step in x, step in y)."""


@dataclass(frozen=True, slots=True)
class UndersideMesh:
    """Quadrilaterals of the underside of a sole, in m, x forward, y to the left, z up.

    ``points`` (n, 3) and ``quads`` (m, 4); ``cell`` (m,) is the cell of the grid (row * ny +
    column) that a face shows, -1 for a wall or a side. Corners are not shared between faces.
    """

    points: NDArray[np.float64]
    quads: NDArray[np.int64]
    cell: NDArray[np.int64]

    @property
    def triangles(self) -> NDArray[np.int64]:
        """Two triangles for each quadrilateral, (2 m, 3), in the order of the faces."""
        return self.quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


def sole_mesh(sole: DrawnSole, *, pressed: bool = False) -> UndersideMesh:
    """Return the underside of a sole with walls and sides, outward normals.

    Corners of a cell are at the mean height of the cells around it that are on its level (both
    land or both channel, slope below ``STEEPEST``). ``pressed`` takes the height under load.
    """
    height = sole.pressed if pressed and sole.pressed is not None else sole.height
    known, side = np.isfinite(sole.height), sole.spacing
    corners = _corner_heights(sole, height)
    nx, ny = height.shape
    rows, columns = np.nonzero(known)
    x, y = sole.x[rows], sole.y[columns]
    a, b, c = sole.plane
    above = height - (a + b * sole.x[:, None] + c * sole.y)
    upper = a + float(np.nanmax(above)) + BODY
    patches, cells = [], []
    # seen from below a face turns the other way: its normal points down, out of the sole
    order = [0, 3, 2, 1]
    patch = np.empty((rows.size, 4, 3))
    for place, number in enumerate(order):
        step_x, step_y = _CORNERS[number]
        patch[:, place, 0] = x + (step_x - 0.5) * side
        patch[:, place, 1] = y + (step_y - 0.5) * side
        patch[:, place, 2] = corners[rows, columns, number]
    patches.append(patch)
    cells.append(rows * ny + columns)
    for first, second in ((1, 2), (2, 3), (3, 0), (0, 1)):  # the edges of a cell, front first
        step = np.array(_CORNERS[first]) + np.array(_CORNERS[second]) - 1
        near = (rows + step[0], columns + step[1])
        within = (near[0] >= 0) & (near[0] < nx) & (near[1] >= 0) & (near[1] < ny)
        beside = np.zeros(rows.size, dtype=bool)
        beside[within] = known[near[0][within], near[1][within]]
        other = np.empty((rows.size, 2))
        for place, number in enumerate((first, second)):
            step_x, step_y = _CORNERS[number]
            other[:, place] = upper + b * (x + (step_x - 0.5) * side)
            other[:, place] += c * (y + (step_y - 0.5) * side)
        # a corner is the same place in the neighbour, on its opposite edge
        for place, number in enumerate((first, second)):
            mirrored = _CORNERS.index(tuple(int(v) for v in np.array(_CORNERS[number]) - step))
            other[beside, place] = corners[near[0][beside], near[1][beside], mirrored]
        ends = corners[rows, columns][:, [first, second]]
        # of two cells the lower one has the wall
        wall = np.abs(other - ends).sum(axis=1) > 1e-7
        wall &= other.sum(axis=1) > ends.sum(axis=1)
        upright = np.empty((int(wall.sum()), 4, 3))
        for place, (number, level) in enumerate(
            ((first, ends[:, 0]), (second, ends[:, 1]), (second, other[:, 1]), (first, other[:, 0]))
        ):
            step_x, step_y = _CORNERS[number]
            upright[:, place, 0] = (x + (step_x - 0.5) * side)[wall]
            upright[:, place, 1] = (y + (step_y - 0.5) * side)[wall]
            upright[:, place, 2] = level[wall]
        patches.append(upright)
        cells.append(np.full(int(wall.sum()), -1))
    points = np.concatenate(patches).reshape(-1, 3)
    return UndersideMesh(points, np.arange(len(points)).reshape(-1, 4), np.concatenate(cells))


def _corner_heights(sole: DrawnSole, height: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the heights (nx, ny, 4) of the corners of all cells, in the order of ``_CORNERS``."""
    nx, ny = height.shape

    def around(values: NDArray[np.float64], di: int, dj: int) -> NDArray[np.float64]:
        return padded_of(values)[1 + di : 1 + di + nx, 1 + dj : 1 + dj + ny]

    def padded_of(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.pad(values, 1, constant_values=np.nan)

    land = sole.land.astype(float)
    corners = np.empty((nx, ny, 4))
    for number, (step_x, step_y) in enumerate(_CORNERS):
        total, count = np.zeros((nx, ny)), np.zeros((nx, ny))
        for di in (step_x - 1, step_x):
            for dj in (step_y - 1, step_y):
                unloaded = around(sole.height, di, dj)
                level = np.abs(unloaded - sole.height) < STEEPEST * sole.spacing
                level &= around(land, di, dj) == land
                total += np.where(level, around(height, di, dj), 0.0)
                count += level
        corners[..., number] = total / np.where(count > 0, count, np.nan)
    return corners
