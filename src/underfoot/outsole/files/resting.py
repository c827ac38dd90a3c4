"""The plane on which a sole rests: three points of its lowest lugs, toe spring left as it is."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_BLOCK = 3e-3  # m: one low point a block, so that noise and single spikes don't carry the sole
_LOW = 5.0  # percentile of the heights in a block that counts as its low point


def resting_plane(height: Array, spacing: float) -> tuple[float, float, float]:
    """Return (a, b, c) of the plane z = a x + b y + c that the sole rests on under its own centre.

    The lower convex hull of the low points (5 % of the heights in blocks of 3 mm); of its faces the
    one over the centroid of the plan form: a sole pressed there stands on that face's corners. x
    and y count from the first cell, m.

    Parameters
    ----------
    height
        (nx, ny) m, z up, nan outside.
    spacing
        Of its cells, m.
    """
    from scipy.spatial import ConvexHull, QhullError

    points = _low_points(height, spacing)
    inside = np.isfinite(height)
    centre = np.array([float(index.mean()) for index in np.nonzero(inside)]) * spacing
    if points.shape[0] < 4:
        return 0.0, 0.0, float(np.nanmin(height))
    try:
        hull = ConvexHull(points)
    except QhullError:  # all points in one plane: that plane
        coefficients, *_ = np.linalg.lstsq(
            np.column_stack([points[:, :2], np.ones(points.shape[0])]), points[:, 2], rcond=None
        )
        return float(coefficients[0]), float(coefficients[1]), float(coefficients[2])
    lower = hull.equations[hull.equations[:, 2] < -1e-9]
    # every lower face lies below the points: over the centre the highest of them is the hull
    a, b, c = (-lower[:, n] / lower[:, 2] for n in (0, 1, 3))
    best = int(np.argmax(a * centre[0] + b * centre[1] + c))
    return float(a[best]), float(b[best]), float(c[best])


def _low_points(height: Array, spacing: float) -> Array:
    size = max(1, round(_BLOCK / spacing))
    count = [math.ceil(n / size) for n in height.shape]
    padded = np.full([n * size for n in count], np.nan)
    padded[: height.shape[0], : height.shape[1]] = height
    blocks = padded.reshape(count[0], size, count[1], size).transpose(0, 2, 1, 3)
    blocks = blocks.reshape(count[0], count[1], -1)
    filled = np.isfinite(blocks).sum(axis=2)
    i, j = np.nonzero(filled >= 0.5 * blocks.shape[2])
    if i.size == 0:
        return np.zeros((0, 3))
    ranked = np.sort(blocks[i, j], axis=1)  # nan comes last
    rank = np.rint(_LOW / 100 * (filled[i, j] - 1)).astype(int)
    low = ranked[np.arange(i.size), rank]
    places = (i + 0.5) * size * spacing, (j + 0.5) * size * spacing
    return np.asarray(np.column_stack([*places, low]), dtype=np.float64)


def levelled(axes: Array, plane: tuple[float, float, float]) -> tuple[Array, float]:
    """Return the axes turned so that the plane is level, and the angle of the turn, rad."""
    slope_x, slope_y, _ = plane
    up = np.array([-slope_x, -slope_y, 1.0])
    up /= np.linalg.norm(up)
    forward = np.array([1.0, 0.0, 0.0]) - up[0] * up
    forward /= np.linalg.norm(forward)
    turn = np.stack([forward, np.cross(up, forward), up])
    return turn @ axes, math.acos(min(1.0, float(up[2])))
