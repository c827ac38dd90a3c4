"""Triangles to height maps, and height maps seen from a tilted floor."""

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask
from underfoot.core.compiled import njit

Triangles = NDArray[np.float32]


@njit(cache=True, error_model="numpy")
def extents(triangles: Triangles, rotation: Array) -> tuple[Array, Array]:
    """Return the least and greatest rotated coordinates (3,), nan vertices left out."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for n in range(triangles.shape[0]):
        for k in range(3):
            x, y, z = triangles[n, k, 0], triangles[n, k, 1], triangles[n, k, 2]
            for a in range(3):
                value = rotation[a, 0] * x + rotation[a, 1] * y + rotation[a, 2] * z
                if value < low[a]:
                    low[a] = value
                if value > high[a]:
                    high[a] = value
    return low, high


@njit(cache=True, error_model="numpy")
def height_buffer(
    triangles: Triangles,
    rotation: Array,
    first: tuple[float, float],
    spacing: float,
    shape: tuple[int, int],
) -> tuple[Array, Array, NDArray[np.int8]]:
    """Return the lowest and highest z over every cell centre and which way the lowest faces.

    Parameters:
        triangles: (n, 3, 3): triangle, corner, coordinate.
        rotation: (3, 3), rows are the axes of the map; may hold a scale.
        first: (x, y) of the first cell centre in the rotated frame.
        spacing, shape: Of the cells.

    Returns:
        lowest, highest: (nx, ny), nan where no triangle lies over the centre.
        facing: -1 where the lowest triangle's normal points down, 1 where up, 0 where none.
    """
    lowest = np.full(shape, np.inf)
    highest = np.full(shape, -np.inf)
    facing = np.zeros(shape, dtype=np.int8)
    rxx, rxy, rxz = rotation[0, 0] / spacing, rotation[0, 1] / spacing, rotation[0, 2] / spacing
    ryx, ryy, ryz = rotation[1, 0] / spacing, rotation[1, 1] / spacing, rotation[1, 2] / spacing
    rzx, rzy, rzz = rotation[2, 0], rotation[2, 1], rotation[2, 2]
    x_first, y_first = first[0] / spacing, first[1] / spacing
    for n in range(triangles.shape[0]):
        ax, ay, az = triangles[n, 0, 0], triangles[n, 0, 1], triangles[n, 0, 2]
        bx, by, bz = triangles[n, 1, 0], triangles[n, 1, 1], triangles[n, 1, 2]
        cx, cy, cz = triangles[n, 2, 0], triangles[n, 2, 1], triangles[n, 2, 2]
        x0 = rxx * ax + rxy * ay + rxz * az - x_first
        x1 = rxx * bx + rxy * by + rxz * bz - x_first
        x2 = rxx * cx + rxy * cy + rxz * cz - x_first
        i_begin = max(int(np.ceil(min(x0, x1, x2) - 1e-9)), 0)
        i_end = min(int(np.floor(max(x0, x1, x2) + 1e-9)), shape[0] - 1)
        if i_begin > i_end:
            continue
        y0 = ryx * ax + ryy * ay + ryz * az - y_first
        y1 = ryx * bx + ryy * by + ryz * bz - y_first
        y2 = ryx * cx + ryy * cy + ryz * cz - y_first
        j_begin = max(int(np.ceil(min(y0, y1, y2) - 1e-9)), 0)
        j_end = min(int(np.floor(max(y0, y1, y2) + 1e-9)), shape[1] - 1)
        if j_begin > j_end:
            continue
        twice = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        if not abs(twice) > 1e-18:
            continue  # seen edge on, or not finite
        z0 = rzx * ax + rzy * ay + rzz * az
        z1 = rzx * bx + rzy * by + rzz * bz
        z2 = rzx * cx + rzy * cy + rzz * cz
        sign = np.int8(1 if twice > 0 else -1)
        for i in range(i_begin, i_end + 1):
            for j in range(j_begin, j_end + 1):
                w0 = ((x1 - i) * (y2 - j) - (x2 - i) * (y1 - j)) / twice
                w1 = ((x2 - i) * (y0 - j) - (x0 - i) * (y2 - j)) / twice
                w2 = 1.0 - w0 - w1
                if w0 < -1e-9 or w1 < -1e-9 or w2 < -1e-9:
                    continue
                z = w0 * z0 + w1 * z1 + w2 * z2
                if z < lowest[i, j]:
                    lowest[i, j] = z
                    facing[i, j] = sign
                if z > highest[i, j]:
                    highest[i, j] = z
    for i in range(shape[0]):
        for j in range(shape[1]):
            if np.isinf(lowest[i, j]):
                lowest[i, j] = np.nan
                highest[i, j] = np.nan
    return lowest, highest, facing


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
