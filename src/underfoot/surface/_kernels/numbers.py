"""Slopes, curvatures and crossings of evenly spaced heights; pure functions of arrays."""

import numpy as np


def slope(heights: np.ndarray, spacing: float) -> np.ndarray:
    """Return the slope by the seven-point formula of ISO 4287 along axis 0, (n - 6, ...)."""
    z, n = heights, heights.shape[0]
    total = 45.0 * (z[4 : n - 2] - z[2 : n - 4])
    total -= 9.0 * (z[5 : n - 1] - z[1 : n - 5])
    total += z[6:] - z[: n - 6]
    return total / (60.0 * spacing)


def curvature(heights: np.ndarray, spacing: float) -> np.ndarray:
    """Return the second derivative by the sixth-order formula along axis 0, (n - 6, ...)."""
    z, n = heights, heights.shape[0]
    total = 270.0 * (z[4 : n - 2] + z[2 : n - 4]) - 490.0 * z[3 : n - 3]
    total -= 27.0 * (z[5 : n - 1] + z[1 : n - 5])
    total += 2.0 * (z[6:] + z[: n - 6])
    return total / (180.0 * spacing**2)


def element_spacing(heights: np.ndarray, spacing: float, threshold: float) -> float | None:
    """Return the mean length of profile elements; None when there is not one whole element.

    An element runs from one upward crossing of zero to the next; a crossing counts once the
    profile has been below -threshold and then exceeds +threshold.
    """
    state = np.where(heights > threshold, 1, np.where(heights < -threshold, -1, 0))
    marked = np.flatnonzero(state)
    if marked.size < 2:
        return None
    turns = np.flatnonzero((state[marked[:-1]] == -1) & (state[marked[1:]] == 1))
    if turns.size < 2:
        return None
    crossings = [
        _last_upward_zero(heights, int(marked[i]), int(marked[i + 1]))
        for i in (turns[0], turns[-1])
    ]
    return float((crossings[1] - crossings[0]) * spacing / (turns.size - 1))


def _last_upward_zero(heights: np.ndarray, low: int, high: int) -> float:
    part = heights[low : high + 1]
    i = int(np.flatnonzero((part[:-1] <= 0.0) & (part[1:] > 0.0))[-1])
    return low + i + float(part[i] / (part[i] - part[i + 1]))
