"""A height map seen from a floor that is tilted about the y axis."""

import numpy as np

from underfoot.core.arrays import Array, Mask
from underfoot.core.optional import njit


@njit(cache=True, error_model="numpy")
def tilted_rows(
    source: tuple[Array, Array],
    height: Array,
    inside: Mask,
    target: tuple[Array, Array],
    cosine: float,
    sine: float,
) -> tuple[Array, Array]:
    """Return, per cell of the floor, the lowest z' over it and the x of the sole it comes from.

    Each row of the target is the polyline through the cells ``inside`` (nearest row) with heights
    linear between rows, each run of cells carried on by half a cell at its ends. nan where no part
    of the sole lies over the cell.

    Parameters:
        source, target: (x, y) of the cell centres of the map and of the floor, evenly spaced, m.
        height: (nx, ny) m, finite everywhere.
        inside: (nx, ny), the plan form.
        cosine, sine: Of the tilt; x' = x cosine - z sine, z' = x sine + z cosine.
    """
    x, y = source
    floor_x, floor_y = target
    spacing, step = x[1] - x[0], floor_x[1] - floor_x[0]
    count = x.size
    lowest = np.full((floor_x.size, floor_y.size), np.inf)
    origin = np.full(lowest.shape, np.nan)
    line = np.empty(count)
    for k in range(floor_y.size):
        place = (floor_y[k] - y[0]) / spacing
        nearest = int(np.floor(place + 0.5))
        if nearest < 0 or nearest >= y.size:
            continue
        below = min(max(int(np.floor(place)), 0), y.size - 2) if y.size > 1 else 0
        above = min(below + 1, y.size - 1)
        share = min(max(place - below, 0.0), 1.0)
        for i in range(count):
            line[i] = (1.0 - share) * height[i, below] + share * height[i, above]
        for i in range(count):
            if not inside[i, nearest]:
                continue
            before = i > 0 and inside[i - 1, nearest]
            after = i + 1 < count and inside[i + 1, nearest]
            slope_after = (line[i + 1] - line[i]) / spacing if after else 0.0
            slope_before = (line[i] - line[i - 1]) / spacing if before else slope_after
            if not after:
                slope_after = slope_before
            for side in range(2):
                slope = slope_before if side == 0 else slope_after
                x0 = x[i] - 0.5 * spacing if side == 0 else x[i]
                z0 = line[i] - 0.5 * spacing * slope if side == 0 else line[i]
                x1, z1 = x0 + 0.5 * spacing, z0 + 0.5 * spacing * slope
                first, last = x0 * cosine - z0 * sine, x1 * cosine - z1 * sine
                run = last - first
                if run == 0.0:
                    continue
                low, high = min(first, last), max(first, last)
                begin = max(int(np.ceil((low - floor_x[0]) / step - 1e-9)), 0)
                end = min(int(np.floor((high - floor_x[0]) / step + 1e-9)), floor_x.size - 1)
                for j in range(begin, end + 1):
                    part = min(max((floor_x[j] - first) / run, 0.0), 1.0)
                    at, up = x0 + part * (x1 - x0), z0 + part * (z1 - z0)
                    value = at * sine + up * cosine
                    if value < lowest[j, k]:
                        lowest[j, k] = value
                        origin[j, k] = at
    for j in range(floor_x.size):
        for k in range(floor_y.size):
            if np.isinf(lowest[j, k]):
                lowest[j, k] = np.nan
    return lowest, origin
