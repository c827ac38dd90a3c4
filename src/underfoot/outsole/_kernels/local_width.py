"""Local width of a plane region: the largest disc inside it that covers each cell."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from .pieces import distance_within

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


def local_width(region: Mask, spacing: float) -> Array:
    """Return, per cell of ``region``, the diameter (m) of the largest disc in it over the cell.

    w(c) = max { 2 d(m) : |c - m| < d(m) } - spacing / 2, with d(m) the distance of a cell m to the
    nearest cell outside; in a straight channel w is its width within half a cell. 0 outside the
    region; what lies beyond the array counts as outside.

    Source: Hildebrand and Ruegsegger 1997 (local thickness), in the plane.
    """
    radius = _covering_radius(np.pad(distance_within(region), 1))[1:-1, 1:-1]
    return np.where(region, np.maximum(2 * radius - 0.5, 1.0) * spacing, 0.0)


@njit(cache=True)
def _covering_radius(distance: Array) -> Array:
    count_x, count_y = distance.shape
    radius = distance.copy()
    for i in range(count_x):
        for j in range(count_y):
            reach = distance[i, j]
            if reach <= 1.0:
                continue
            ridge = True  # a disc that lies in a neighbour's disc paints nothing new
            for a in range(-1, 2):
                for b in range(-1, 2):
                    step = np.sqrt(a * a + b * b)
                    if step > 0 and distance[i + a, j + b] >= reach + step - 1e-9:
                        ridge = False
            if not ridge:
                continue
            whole = int(np.ceil(reach))
            for a in range(max(i - whole, 0), min(i + whole + 1, count_x)):
                for b in range(max(j - whole, 0), min(j + whole + 1, count_y)):
                    if (a - i) ** 2 + (b - j) ** 2 < reach * reach and radius[a, b] < reach:
                        radius[a, b] = reach
    return radius
