"""Shape-preserving cubic interpolation on sorted nodes (PCHIP) in one and two dimensions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array


def pchip_slopes(x: Array, y: Array) -> Array:
    """Return node slopes along axis 0 of ``y`` (n >= 2 nodes) that keep monotone data monotone.

    Weighted harmonic means inside, one-sided three-point slopes at the ends:
    Fritsch and Butland (1984) SIAM J. Sci. Stat. Comput. 5:300.
    """
    h = np.diff(x).reshape((-1,) + (1,) * (y.ndim - 1))
    secant = np.diff(y, axis=0) / h
    if y.shape[0] == 2:
        return np.concatenate([secant, secant])
    left, right = secant[:-1], secant[1:]
    w1, w2 = 2.0 * h[1:] + h[:-1], h[1:] + 2.0 * h[:-1]
    same = left * right > 0.0
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        inside = np.where(same, (w1 + w2) / (w1 / left + w2 / right), 0.0)
    first = _end_slope(h[0], h[1], secant[0], secant[1])
    last = _end_slope(h[-1], h[-2], secant[-1], secant[-2])
    return np.concatenate([first[None], inside, last[None]])


def _end_slope(h0: Array, h1: Array, s0: Array, s1: Array) -> Array:
    slope = ((2.0 * h0 + h1) * s0 - h0 * s1) / (h0 + h1)
    slope = np.where(slope * s0 <= 0.0, 0.0, slope)
    return np.where((s0 * s1 < 0.0) & (np.abs(slope) > 3.0 * np.abs(s0)), 3.0 * s0, slope)


def located(x: Array, at: Array) -> tuple[NDArray[np.intp], Array, Array]:
    """Return (cell index, cell width, position 0 to 1 in the cell); ``at`` clipped to the nodes."""
    inside = np.clip(at, x[0], x[-1])
    cell = np.clip(np.searchsorted(x, inside, side="right") - 1, 0, x.size - 2)
    width = x[cell + 1] - x[cell]
    return cell, width, (inside - x[cell]) / width


def basis(t: Array, width: Array) -> tuple[Array, Array, Array, Array]:
    """Return the Hermite weights of (left value, right value, left slope, right slope)."""
    left = (1.0 + 2.0 * t) * (1.0 - t) ** 2
    return left, 1.0 - left, width * t * (1.0 - t) ** 2, -width * t**2 * (1.0 - t)


def basis_slope(t: Array, width: Array) -> tuple[Array, Array, Array, Array]:
    """Return the derivatives of ``basis`` with respect to the coordinate."""
    value = 6.0 * t * (t - 1.0) / width
    return value, -value, (1.0 - t) * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)


def interpolated(x: Array, y: Array, slopes: Array, at: Array) -> tuple[Array, Array]:
    """Return value and derivative of the cubic through (x, y) with node ``slopes``."""
    cell, width, t = located(x, at)
    nodes = (y[cell], y[cell + 1], slopes[cell], slopes[cell + 1])
    value = sum(w * node for w, node in zip(basis(t, width), nodes, strict=True))
    slope = sum(w * node for w, node in zip(basis_slope(t, width), nodes, strict=True))
    return np.asarray(value), np.asarray(slope)


def interpolated_grid(
    x: Array, y: Array, values: Array, at_x: Array, at_y: Array
) -> tuple[Array, Array]:
    """Return value and x-derivative of the tensor cubic through ``values`` (x.size, y.size).

    Monotone along both axes where the nodes are; a single row or column is taken as constant.
    """
    if y.size == 1:
        return interpolated(x, values[:, 0], pchip_slopes(x, values[:, 0]), at_x)
    in_x = pchip_slopes(x, values)
    i, width_x, s = located(x, at_x)
    j, width_y, t = located(y, at_y)
    across = basis(t, width_y)
    ends = []
    for nodes in (values, in_x):
        tilt = pchip_slopes(y, nodes.T).T
        for row in (i, i + 1):
            corners = (nodes[row, j], nodes[row, j + 1], tilt[row, j], tilt[row, j + 1])
            ends.append(sum(w * corner for w, corner in zip(across, corners, strict=True)))
    value = sum(w * end for w, end in zip(basis(s, width_x), ends, strict=True))
    slope = sum(w * end for w, end in zip(basis_slope(s, width_x), ends, strict=True))
    return np.asarray(value), np.asarray(slope)
