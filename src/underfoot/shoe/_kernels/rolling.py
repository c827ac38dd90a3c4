"""A wide paraboloid rolled under a height map: what of it a nearly flat floor can reach."""

import numpy as np

from underfoot.core.arrays import Array
from underfoot.core.compiled import njit

_STEP = 2e-3  # m between the paraboloid's places: it is off by _STEP^2 / (8 radius), 1 um


def rolled_base(height: Array, spacing: float, radius: float, slopes: tuple[float, float]) -> Array:
    """Return the highest place that a paraboloid rolled under the surface reaches, per cell.

    Grey opening by p(r) = -r^2 / (2 R): e(c) = min_x [z(x) + |x - c|^2 / (2 R)], base(x) =
    max_c [e(c) - |x - c|^2 / (2 R)]. A gap of width w is entered by w^2 / (8 R); a surface that is
    convex downward, or hollow with a radius above R, is its own base. Both steps are separable:
    along x lower envelopes of parabolas (Felzenszwalb and Huttenlocher 2012, Theory of Computing
    8), between them both steps along y at once, a convex hull.

    Parameters:
        height: (nx, ny) m, z up, nan outside: there the paraboloid is free.
        spacing: Of the cells, m.
        radius: R, m.
        slopes: Steepest slopes along x and y that it follows at the rim; places beyond the rim by
            slope times R.
    """
    x, y = (np.arange(count, dtype=np.float64) * spacing for count in height.shape)
    places = np.arange(x[0] - slopes[0] * radius, x[-1] + slopes[0] * radius + _STEP, _STEP)
    bend, lines = 0.5 / radius, np.ascontiguousarray
    eroded = _lower_envelopes(
        lines(np.where(np.isfinite(height), height, np.inf).T), x, places, bend
    )
    opened = _open_lines(lines(eroded.T), y, bend, slopes[1])
    base = -_lower_envelopes(lines(-opened.T), places, x, bend).T
    return np.where(np.isfinite(height), base, np.nan)


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


@njit(cache=True, error_model="numpy")
def _open_lines(lines: Array, at: Array, curvature: float, slope: float) -> Array:
    """Return what parabolas under each line of heights reach at ``at``; inf heights: free.

    With curvature at^2 added a parabola is straight, and what it reaches is the lower convex hull,
    whose slopes are those of places up to ``slope`` beyond the ends.
    """
    least, most = 2 * curvature * at[0] - slope, 2 * curvature * at[-1] + slope
    reached = np.full(lines.shape, np.inf)
    hull = np.empty(at.size, dtype=np.int64)
    for n in range(lines.shape[0]):
        raised = lines[n] + curvature * at**2
        last = -1
        for i in range(at.size):
            if not np.isfinite(raised[i]):
                continue
            while last > 0:
                a, b = hull[last - 1], hull[last]
                turn = (raised[i] - raised[b]) * (at[b] - at[a])
                if (raised[b] - raised[a]) * (at[i] - at[b]) < turn:
                    break
                last -= 1
            last += 1
            hull[last] = i
        if last < 0:
            continue
        edges = np.diff(raised[hull[: last + 1]]) / np.diff(at[hull[: last + 1]])
        part = np.sum(edges < least)
        last -= np.sum(edges > most)
        for m in range(at.size):
            while part < last and at[m] > at[hull[part + 1]]:
                part += 1
            k = hull[part]
            rise = least if at[m] < at[k] else most if part == last else edges[part]
            reached[n, m] = raised[k] + rise * (at[m] - at[k]) - curvature * at[m] ** 2
    return reached
