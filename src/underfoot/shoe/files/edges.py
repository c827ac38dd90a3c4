"""Where the lugs and the sides of a file end in plan, from its own faces."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask

from .._kernels.regions import nearest_true
from ..drawn_surface import drawn_surface
from ..geometry import SoleSurface

_PART = 400_000  # faces looked at together
_BESIDE = 0.75  # cells beside a line, where the sole is looked at
_HEIGHTS = (0.3, 0.5, 0.7, 1.0)  # of the height at which the sides of a body are cut
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

    (lines,) = section_lines(triangles, axes, begin, surface, [height])
    channel = surface.inside & ~drawn_surface(surface).land
    one, other, known = _beside(lines, surface, channel)
    lines = lines[known & (one | other)]
    ways: list[Array] = []
    for line in shapely.get_parts(_merge_lines(lines)):
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
    """Return the lines at which the plan form ends: around sections at ``_HEIGHTS`` of a height.

    One section alone is that of chords where the sides of a body are fewer faces than its bottom's
    rim. Else as ``section_lines``.
    """
    import shapely

    levels = [height * share for share in _HEIGHTS]
    sections = section_lines(triangles, axes, begin, surface, levels)
    rings: list[Any] = []
    for lines in sections:
        for ring in shapely.get_parts(_merge_lines(lines)):
            if ring.is_closed and len(ring.coords) > 3:
                rings.append(shapely.make_valid(shapely.polygons(ring.coords)))
    plan: Any = shapely.union_all(rings)
    around = shapely.get_coordinates(shapely.get_rings(shapely.get_parts(plan)), return_index=True)
    ends, ring = around
    ahead = np.flatnonzero(ring[1:] == ring[:-1])
    rim = np.stack([ends[ahead], ends[ahead + 1]], axis=1)
    # holes through the sole lie within
    inner = sections[-1]
    within = shapely.contains_xy(plan.buffer(-surface.spacing), *inner.mean(axis=1).T)
    lines = np.concatenate([rim, inner[within]])
    one, other, known = _beside(lines, surface, surface.inside)
    return lines[known & ~(one & other)]


def section_lines(
    triangles: NDArray[np.float32],
    axes: Array,
    begin: Array,
    surface: SoleSurface,
    heights: Sequence[float],
) -> list[Array]:
    """Return the lines (n, 2, 2; m) along which faces pass each of ``heights`` (m) above the land.

    Parameters:
        triangles: Of the sole, in the file's unit.
        axes: Rows along x, y, z of the surface, m per unit.
        begin: (3,) m, where the origin of the surface lies along them.
        surface: The bottom of the sole, whose ``land_base`` the land is.
        heights: m.
    """
    land = surface.land_base
    land = land[nearest_true(np.isfinite(land))]
    lines = [[np.empty((0, 2, 2))] for _ in heights]
    for first in range(0, len(triangles), _PART):
        corners = triangles[first : first + _PART].astype(np.float64) @ axes.T - begin
        corners = corners[np.isfinite(corners).all(axis=(1, 2))]
        above = corners[..., 2] - land[_cells(surface, corners)]
        lowest, highest = above.min(axis=1), above.max(axis=1)
        for height, found_lines in zip(heights, lines, strict=True):
            passing = (lowest < height) & (highest >= height)
            here, low = corners[passing], above[passing] - height
            ahead, high = np.roll(here, -1, axis=1), np.roll(low, -1, axis=1)
            crossed = (low < 0) != (high < 0)  # two sides of a triangle
            share = low / np.where(crossed, low - high, 1.0)
            points = here + share[..., None] * (ahead - here)
            found_lines.append(points[crossed][:, :2].reshape(-1, 2, 2))
    return [np.concatenate(line) for line in lines]


def _merge_lines(lines: Array) -> Any:
    """Return lines (n, 2, 2; m) joined where their ends meet."""
    import shapely

    strings: Any = shapely.linestrings(np.round(lines / _SAME) * _SAME)
    return shapely.line_merge(shapely.multilinestrings(strings))


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
