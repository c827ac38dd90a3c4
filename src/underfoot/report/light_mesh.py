"""A sole as few triangles with its fields on their corners: loads kept, walls apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .drawn_sole import DrawnSole
from .quantities import AREAS
from .sole_mesh import BODY
from .surface_mesh import LATTICE, SurfaceMesh

Floats = NDArray[np.float64]
CELLS, DESIGNED_CELLS = 1_200_000, 8_000_000
"""Cells at most from which the surface of a file is made, and of a design: that of a whole sole
has ``FINEST`` with them, and takes 1.3 GB."""
SMALL, MOST, LOADED = 1e-3, 24_000, 1e-3
"""m of a triangle's longest side where a pressure is; corners at most, above which it is doubled;
share of a pressure's peak from which it counts."""
FINEST = 0.05e-3 / 0.75
"""m: side of the cells of a small sole. Its rim passes within 0.75 cells of where they end."""


@dataclass(frozen=True, slots=True)
class LightMesh:
    """Triangles in m, x forward, y to the left, z up; corners of walls are their own.

    ``below`` corners are seen from below: ``area`` (m²) is what each stands for, the third of its
    triangles in plan, 0 on walls. A field that is linear on triangles integrates to field @ area.
    """

    points: Floats
    triangles: NDArray[np.int64]
    area: Floats
    below: int
    fields: dict[str, Floats]


def light_mesh(
    surface: SurfaceMesh, sole: DrawnSole, values: dict[str, Floats], *, pressed: bool = False
) -> LightMesh:
    """Return the triangles of a surface with fields (SI) of the cells of a sole at their corners.

    A corner has the mean of the cells around it, weighted as a triangle is interpolated; pressures
    are then scaled so that they carry the load of the cells in all. 0 where there is none.
    """
    points, land, triangles = _refine_mesh(surface, sole, values)
    triangles = _facing_down(points, triangles)
    if pressed and sole.pressed is not None:
        moved = _at(sole, sole.pressed - sole.height, points)
        points = np.column_stack([points[:, :2], np.maximum(points[:, 2] + moved, 0.0)])
    corners = points[triangles]
    thirds = np.repeat(_in_plan(corners) / 3, 3)
    area: Floats = np.bincount(triangles.ravel(), thirds, len(points)).astype(float)
    cells, owners, weights = _shares(sole, land, points, triangles)
    fields = {}
    for name, cell_values in values.items():
        taken = cell_values.ravel()[cells]
        known = np.isfinite(taken)
        if name in AREAS:
            taken, known = np.nan_to_num(taken), np.ones(len(taken), bool)
        total = np.bincount(owners[known], (weights * taken)[known], len(points))
        count = np.bincount(owners[known], weights[known], len(points))
        mean = np.where(count > 0, total / np.where(count > 0, count, 1.0), 0.0)
        if name in AREAS and (load := mean @ area) > 0:
            mean *= float(np.nansum(cell_values)) * sole.spacing**2 / load
        fields[name] = mean
    further, sides = _upright(surface, points, sole)
    none = np.zeros(len(further))
    return LightMesh(
        np.concatenate([points, further]),
        np.concatenate([triangles, sides + len(points)]),
        np.concatenate([area, none]),
        len(points),
        {name: np.concatenate([each, none]) for name, each in fields.items()},
    )


def spacing_for(sole: DrawnSole, *, designed: bool = True) -> float:
    """Return the side (m) of the cells from which the surface of a sole is made."""
    plan = np.ptp(sole.x) * np.ptp(sole.y)
    return max(FINEST, float(np.sqrt(plan / (DESIGNED_CELLS if designed else CELLS))))


def _refine_mesh(
    surface: SurfaceMesh, sole: DrawnSole, values: dict[str, Floats]
) -> tuple[Floats, NDArray[np.bool_], NDArray[np.int64]]:
    """Return points, their land, and triangles, cut in four where a pressure is, until small."""
    from scipy.ndimage import maximum_filter

    loaded = np.zeros(sole.height.shape)
    for each in (np.nan_to_num(values[name]) for name in AREAS if name in values):
        loaded = np.maximum(loaded, each > LOADED * each.max())
    wide = maximum_filter(loaded, 1 + round(2 * LATTICE / sole.spacing))
    side = SMALL
    while True:
        points, land = surface.points, surface.land
        triangles = surface.triangles.astype(np.int64)
        while len(points) <= MOST:
            corners = points[triangles, :2]
            long = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1) > side
            i, j = (
                np.clip(np.rint((at - axis[0]) / sole.spacing), 0, axis.size - 1).astype(int)
                for at, axis in zip(corners.mean(axis=1).T, (sole.x, sole.y), strict=True)
            )
            long &= wide[i, j] > 0
            if not long.any():
                return points, land, triangles
            cut = triangles[long]
            sides = np.sort(np.stack([cut, np.roll(cut, -1, axis=1)], axis=-1), axis=-1)
            edges, owner = np.unique(sides.reshape(-1, 2), axis=0, return_inverse=True)
            middle = len(points) + owner.reshape(-1, 3)
            points = np.concatenate([points, points[edges].mean(axis=1)])
            land = np.concatenate([land, land[edges[:, 0]]])
            a, b, c = cut.T
            ab, bc, ca = middle.T
            parts = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
            triangles = np.concatenate([triangles[~long], *(np.stack(p, axis=1) for p in parts)])
        side *= 2


def _facing_down(points: Floats, triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return triangles whose corners turn so that their normals point down."""
    a, b, c = points[triangles, :2].transpose(1, 0, 2)
    u, v = b - a, c - a
    up = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] > 0
    return np.where(up[:, None], triangles[:, ::-1], triangles)


def _in_plan(corners: Floats) -> Floats:
    """Return the areas (m²) of triangles (t, 3, 3) seen from above."""
    u, v = corners[:, 1, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 0, :2]
    return np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2


def _shares(
    sole: DrawnSole, land: NDArray[np.bool_], points: Floats, triangles: NDArray[np.int64]
) -> tuple[NDArray[np.intp], NDArray[np.intp], Floats]:
    """Return (cell, corner, weight) of every cell in the triangle of its kind that holds it.

    Cells between the straightened lines and those of the grid belong to the nearest corner; a
    corner that no cell knows has its nearest cell.
    """
    from scipy.spatial import KDTree

    ny, kinds = sole.y.size, sole.land & np.isfinite(sole.height)
    found: list[tuple[NDArray[np.intp], NDArray[np.intp], Floats]] = []
    taken = np.zeros(sole.height.shape, bool)
    for corners in triangles:
        (ax, ay), (bx, by), (cx, cy) = points[corners, :2]
        rows = slice(*np.searchsorted(sole.x, (min(ax, bx, cx), max(ax, bx, cx))))
        columns = slice(*np.searchsorted(sole.y, (min(ay, by, cy), max(ay, by, cy))))
        x, y = sole.x[rows, None] - ax, sole.y[None, columns] - ay
        double = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if not x.size or not y.size or double == 0:
            continue
        second = (x * (cy - ay) - y * (cx - ax)) / double
        third = (y * (bx - ax) - x * (by - ay)) / double
        inside = (second >= 0) & (third >= 0) & (second + third <= 1)
        inside &= kinds[rows, columns] == land[corners[0]]
        i, j = np.nonzero(inside)
        taken[rows, columns] |= inside
        cell = (i + rows.start) * ny + j + columns.start
        for corner, weight in zip(corners, (1 - second - third, second, third), strict=True):
            found.append((cell, np.full(cell.size, corner), weight[i, j]))
    cells, owners, weights = (np.concatenate(each) for each in zip(*found, strict=True))
    inside = np.isfinite(sole.height)
    without = np.bincount(owners, weights, len(points)) <= 0
    for kind in (False, True):
        i, j = np.nonzero(inside & (kinds == kind))
        d = np.flatnonzero(land == kind)
        if not i.size or not d.size:
            continue
        places = np.stack([sole.x[i], sole.y[j]], axis=1)
        rest = np.flatnonzero(~taken[i, j])
        near = d[KDTree(points[d, :2]).query(places[rest])[1]]
        alone = np.flatnonzero(without & (land == kind))
        beside = KDTree(places).query(points[alone, :2])[1]
        cells = np.concatenate([cells, i[rest] * ny + j[rest], i[beside] * ny + j[beside]])
        owners = np.concatenate([owners, near, alone])
        weights = np.concatenate([weights, np.ones(rest.size + alone.size)])
    return cells, owners, weights


def _at(sole: DrawnSole, values: Floats, points: Floats) -> Floats:
    """Return values of the cells at points, those of the nearest cell that has one."""
    from scipy.ndimage import distance_transform_edt, map_coordinates

    nearest = distance_transform_edt(np.isnan(values), return_distances=False, return_indices=True)
    places = [(points[:, k] - axis[0]) / sole.spacing for k, axis in enumerate((sole.x, sole.y))]
    return map_coordinates(values[*np.asarray(nearest)], places, order=1, mode="nearest")


def _upright(
    surface: SurfaceMesh, points: Floats, sole: DrawnSole
) -> tuple[Floats, NDArray[np.int64]]:
    """Return corners and triangles of the walls, and of the sides up to the body's top."""
    a, b, c = sole.plane
    rim = points[surface.sides]
    above = points[:, 2] - (a + b * points[:, 0] + c * points[:, 1])
    top = rim.copy()
    top[:, :, 2] = a + float(above.max()) + BODY + b * rim[:, :, 0] + c * rim[:, :, 1]
    walls = points[surface.walls]
    low = walls[:, :2, 2].sum(axis=1) <= walls[:, 2:, 2].sum(axis=1)
    lower = np.where(low[:, None, None], walls[:, :2], walls[:, 2:])
    upper = np.where(low[:, None, None], walls[:, 2:], walls[:, :2])
    quads = np.concatenate(
        [np.concatenate([lower, upper[:, ::-1]], 1), np.concatenate([rim, top[:, ::-1]], 1)]
    )
    if not len(quads):
        return np.empty((0, 3)), np.empty((0, 3), np.int64)
    number = 4 * np.arange(len(quads))[:, None]
    triangles = (number + np.array([0, 1, 2, 0, 2, 3])).reshape(-1, 3)
    return quads.reshape(-1, 3), triangles
