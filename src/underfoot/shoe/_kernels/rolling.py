"""A wide paraboloid rolled under a height map: what of it a nearly flat floor can reach."""

import numpy as np

from underfoot.core.arrays import Array
from underfoot.core.compiled import njit

_STEP = 2e-3  # m between the paraboloid's places: it is off by _STEP^2 / (8 radius), 1 um


def rolled_base(height: Array, spacing: float, radius: float, slopes: tuple[float, float]) -> Array:
    """Return the highest place that a paraboloid rolled under the surface reaches, per cell.

    Grey opening by p(r) = -r^2 / (2 R): e(c) = min_x [z(x) + |x - c|^2 / (2 R)], base(x) =
    max_c [e(c) - |x - c|^2 / (2 R)]. A gap of width w is entered by w^2 / (8 R); a surface that is
    convex downward, or hollow with a radius above R, is its own base. Both steps are separable
    lower envelopes of parabolas (Felzenszwalb and Huttenlocher 2012, Theory of Computing 8).

    Parameters:
        height: (nx, ny) m, z up, nan outside: there the paraboloid is free.
        spacing: Of the cells, m.
        radius: R, m.
        slopes: Steepest slopes along x and y that it follows at the rim; places beyond the rim by
            slope times R.
    """
    axes = [np.arange(count, dtype=np.float64) * spacing for count in height.shape]
    places = [
        np.arange(axis[0] - slope * radius, axis[-1] + slope * radius + _STEP, _STEP)
        for axis, slope in zip(axes, slopes, strict=True)
    ]
    eroded = np.where(np.isfinite(height), height, np.inf)
    for axis in (0, 1):
        eroded = _along(eroded, axis, axes[axis], places[axis], radius)
    base = -eroded
    for axis in (1, 0):  # the last of above first: its lines lie together
        base = _along(base, axis, places[axis], axes[axis], radius)
    return np.where(np.isfinite(height), -base, np.nan)


def _along(values: Array, axis: int, places: Array, at: Array, radius: float) -> Array:
    lines = np.ascontiguousarray(np.moveaxis(values, axis, -1))
    return np.moveaxis(_lower_envelopes(lines, places, at, 0.5 / radius), -1, axis)


@njit(cache=True, error_model="numpy")
def _lower_envelopes(lines: Array, places: Array, at: Array, curvature: float) -> Array:
    """Return min over i of lines[n, i] + curvature (at - places[i])^2 for each line n; inf: none.

    ``places`` and ``at`` ascend.
    """
    count = places.size
    lowest = np.full((lines.shape[0], at.size), np.inf)
    stack = np.empty(count, dtype=np.int64)
    begin = np.empty(count)
    for n in range(lines.shape[0]):
        values = lines[n]
        top = -1
        for i in range(count):
            if not np.isfinite(values[i]):
                continue
            own = values[i] + curvature * places[i] ** 2
            cross = -np.inf
            while top >= 0:
                k = stack[top]
                other = values[k] + curvature * places[k] ** 2
                cross = (own - other) / (2 * curvature * (places[i] - places[k]))
                if cross > begin[top]:
                    break
                top -= 1
            top += 1
            stack[top] = i
            begin[top] = cross if top > 0 else -np.inf
        if top < 0:
            continue
        part = 0
        for m in range(at.size):
            while part < top and begin[part + 1] <= at[m]:
                part += 1
            k = stack[part]
            lowest[n, m] = values[k] + curvature * (at[m] - places[k]) ** 2
    return lowest
