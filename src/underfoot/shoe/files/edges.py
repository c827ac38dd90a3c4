"""Where the lugs and the sides of a file end in plan, from its own faces."""

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array

from .._kernels.regions import nearest_true
from ..geometry import SoleSurface

_PART = 400_000  # faces looked at together


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
        i, j = (
            np.clip(np.rint((corners[..., n] - at[0]) / surface.spacing), 0, at.size - 1)
            for n, at in enumerate((surface.x, surface.y))
        )
        above = corners[..., 2] - land[i.astype(np.intp), j.astype(np.intp)] - height
        passing = (above.min(axis=1) < 0) & (above.max(axis=1) >= 0)
        here, low = corners[passing], above[passing]
        ahead, high = np.roll(here, -1, axis=1), np.roll(low, -1, axis=1)
        crossed = (low < 0) != (high < 0)  # two sides of a triangle
        share = low / np.where(crossed, low - high, 1.0)
        points = here + share[..., None] * (ahead - here)
        lines.append(points[crossed][:, :2].reshape(-1, 2, 2))
    return np.concatenate(lines)
