"""Draft of the walls between lugs and channels: how far from upright they stand."""

import math

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array

from .._kernels.regions import rim
from .view import View

_STEEPEST = math.radians(40)  # from upright: more is a slope, no wall
_WINDOW = 3e-3  # m: wall, land and floor of a channel lie in it
_SHALLOWEST = 1.2e-3  # m: of a channel whose walls count
_RIM = 2e-3  # m from it: side walls of the sole
_SAMPLE = 400_000
_FEWEST = 8


def wall_draft(triangles: NDArray[np.float32], seen: View, height: Array) -> float | None:
    """Return the median angle of the channels' walls from upright by area, rad; None without walls.

    Walls are faces less than 40 degrees from upright, 2 mm and more within the plan form, whose
    middle lies at 25 to 75 % of the height between land and floor of the channel around (within
    3 mm).

    Parameters:
        triangles: Of the sole, in the file's unit.
        seen: The view that ``height`` comes from.
        height: (nx, ny) m on the cells of ``seen``, nan outside.
    """
    from scipy.ndimage import maximum_filter, minimum_filter

    chosen = triangles[:: math.ceil(triangles.shape[0] / _SAMPLE) or 1].astype(np.float64)
    corners = chosen @ seen.axes.T
    sides = corners[:, 1:] - corners[:, :1]
    normal = np.cross(sides[:, 0], sides[:, 1])
    area = np.linalg.norm(normal, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        angle = np.arcsin(np.abs(normal[:, 2]) / area)
    middle = corners.mean(axis=1)
    wall = (angle < _STEEPEST) & np.isfinite(middle).all(axis=1)
    inside = np.isfinite(height)
    core = inside & ~rim(inside, round(_RIM / seen.spacing))
    size = 2 * round(_WINDOW / seen.spacing / 2) + 1
    low = minimum_filter(np.where(inside, height, np.inf), size)
    high = maximum_filter(np.where(inside, height, -np.inf), size)
    angle, area, middle = angle[wall], area[wall], middle[wall]
    place = [
        np.clip(np.rint((middle[:, n] - seen.first[n]) / seen.spacing), 0, height.shape[n] - 1)
        for n in (0, 1)
    ]
    cell = place[0].astype(np.intp), place[1].astype(np.intp)
    depth = np.where(core, high - low, 0.0)[cell]
    share = (middle[:, 2] - seen.level - low[cell]) / np.maximum(depth, _SHALLOWEST)
    on_walls = (depth >= _SHALLOWEST) & (share > 0.25) & (share < 0.75)
    if np.count_nonzero(on_walls) < _FEWEST:
        return None
    order = np.argsort(angle[on_walls])
    total = np.cumsum(area[on_walls][order])
    return float(angle[on_walls][order][np.searchsorted(total, total[-1] / 2)])
