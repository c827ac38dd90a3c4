"""Where the lugs and the sides of a file end in plan, from its own faces."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask

from .._kernels.regions import nearest_true
from ..drawn_surface import drawn_surface
from ..geometry import SoleSurface

_PART = 400_000  # faces looked at together
_BESIDE = 0.75  # cells beside a line, where the sole is looked at
_UPRIGHT = 0.02  # sine of an upright face's tilt
_NODED = 1e-7  # m: where lines cross
_SAME = 1e-8  # m: ends of lines nearer than this are one
_CARRIED_ON = 2e-3  # m by which a line that stops short of the rim runs on


def lug_lines(
    triangles: NDArray[np.float32], axes: Array, begin: Array, surface: SoleSurface, height: float
) -> Array:
    """Return the ``section_lines`` at which lugs end, up to the rim and not along it.

    On its rounding, which is drawn with the lug, the section of a lug ends short of the rim.
    """
    import shapely
    from shapely.ops import substring

    lines = section_lines(triangles, axes, begin, surface, height)
    channel = surface.inside & ~drawn_surface(surface).land
    one, other, known = _beside(lines, surface, channel)
    lines = lines[known & (one | other)]
    ends = np.round(lines / _SAME) * _SAME
    strings: Any = shapely.linestrings(ends)
    merged: Any = shapely.line_merge(shapely.multilinestrings(strings))
    ways: list[Array] = []
    for line in shapely.get_parts(merged):
        way = shapely.get_coordinates(line)
        if not line.is_closed and line.length > 4 * surface.spacing:
            # the last of it may be a piece of the turn along the rim
            short: Any = substring(line, surface.spacing, line.length - surface.spacing)
            way = shapely.get_coordinates(short)
            for one in (short, short.reverse()):
                end, back = (
                    shapely.get_coordinates(shapely.line_interpolate_point(one, at))[0]
                    for at in (0.0, surface.spacing)
                )
                far = end + _CARRIED_ON * (end - back) / np.linalg.norm(end - back)
                way = np.concatenate([far[None], way])[::-1]
        ways.append(np.stack([way[:-1], way[1:]], axis=1))
    return np.concatenate(ways) if ways else lines


def rim_lines(
    triangles: NDArray[np.float32], axes: Array, begin: Array, surface: SoleSurface, height: float
) -> Array:
    """Return the lines of a section and of upright faces at which the plan form ends.

    A section alone is that of chords where the body's sides are fewer faces than its bottom's rim.
    Else as ``section_lines``.
    """
    import shapely

    lines = [section_lines(triangles, axes, begin, surface, height)]
    for first in range(0, len(triangles), _PART):
        corners = triangles[first : first + _PART].astype(np.float64) @ axes.T
        along = np.roll(corners, -1, axis=1) - corners
        normal = np.cross(along[:, 0], along[:, 1])
        upright = np.abs(normal[:, 2]) < _UPRIGHT * np.linalg.norm(normal, axis=1)
        here = corners[upright] - begin
        lines.append(np.stack([here, np.roll(here, -1, axis=1)], axis=2)[..., :2].reshape(-1, 2, 2))
    every = np.concatenate(lines)
    one, other, known = _beside(every, surface, surface.inside)
    strings = shapely.linestrings(every[known & ~(one & other)])
    noded: Any = shapely.union_all(strings, grid_size=_NODED)
    plan: Any = shapely.union_all(shapely.get_parts(shapely.polygonize(shapely.get_parts(noded))))
    ends, ring = shapely.get_coordinates(
        shapely.get_rings(shapely.get_parts(plan)), return_index=True
    )
    ahead = np.flatnonzero(ring[1:] == ring[:-1])
    lines = np.stack([ends[ahead], ends[ahead + 1]], axis=1)
    one, other, known = _beside(lines, surface, surface.inside)
    return lines[known & ~(one & other)]


def section_lines(
    triangles: NDArray[np.float32], axes: Array, begin: Array, surface: SoleSurface, height: float
) -> Array:
    """Return the lines (n, 2, 2; m) along which faces pass a ``height`` (m) above the land.

    Parameters:
        triangles: Of the sole, in the file's unit.
        axes: Rows along x, y, z of the surface, m per unit.
        begin: (3,) m, where the origin of the surface lies along them.
        surface: The bottom of the sole, whose ``land_base`` the land is.
    """
    land, lines = surface.land_base, [np.empty((0, 2, 2))]
    land = land[nearest_true(np.isfinite(land))]
    for first in range(0, len(triangles), _PART):
        corners = triangles[first : first + _PART].astype(np.float64) @ axes.T - begin
        corners = corners[np.isfinite(corners).all(axis=(1, 2))]
        above = corners[..., 2] - land[_cells(surface, corners)] - height
        passing = (above.min(axis=1) < 0) & (above.max(axis=1) >= 0)
        here, low = corners[passing], above[passing]
        ahead, high = np.roll(here, -1, axis=1), np.roll(low, -1, axis=1)
        crossed = (low < 0) != (high < 0)  # two sides of a triangle
        share = low / np.where(crossed, low - high, 1.0)
        points = here + share[..., None] * (ahead - here)
        lines.append(points[crossed][:, :2].reshape(-1, 2, 2))
    return np.concatenate(lines)


def _beside(lines: Array, surface: SoleSurface, mask: Mask) -> tuple[Mask, Mask, Mask]:
    """Return whether a mask holds on either side of lines, and which have a length to tell them."""
    along = lines[:, 1] - lines[:, 0]
    long = np.linalg.norm(along, axis=1, keepdims=True)
    away = _BESIDE * surface.spacing * along[:, ::-1] * [1, -1] / np.maximum(long, _SAME)
    padded = np.pad(mask, 1)  # cells beyond the map are outside
    at = np.stack([surface.x[0], surface.y[0]])
    one, other = (
        padded[
            *np.clip(
                np.rint((lines.mean(axis=1) + way - at) / surface.spacing).astype(int) + 1,
                0,
                np.array(padded.shape) - 1,
            ).T
        ]
        for way in (away, -away)
    )
    return one, other, long[:, 0] > _SAME


def _cells(surface: SoleSurface, places: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the cells that hold places (..., 2 or more; m), the nearest where none does."""
    i, j = (
        np.clip(np.rint((places[..., n] - at[0]) / surface.spacing), 0, at.size - 1)
        for n, at in enumerate((surface.x, surface.y))
    )
    return i.astype(np.intp), j.astype(np.intp)
