"""Exponential decays that are linear once their decay constant is fixed (variable projection)."""

from collections.abc import Callable

import numpy as np


def linear_part(
    x: np.ndarray, y: np.ndarray, tau: np.ndarray, start: float | None, end: float | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (end, start, residual sum) of y = end + (start - end) exp(-x / tau), each (m,).

    Both levels are kept at zero or above; a given ``start`` or ``end`` is not fitted.

    ``x`` and ``y``: shape (n,). ``tau``: decay constants to try, shape (m,).
    """
    e = np.exp(-x / np.maximum(tau[:, None], 1e-300))
    rise = 1.0 - e
    if start is not None or end is not None:

        def level(given: float | None, shape: np.ndarray, rest: np.ndarray) -> np.ndarray:
            if given is not None:
                return np.full(len(tau), given)
            return np.maximum((shape * rest).sum(axis=1) / _positive((shape**2).sum(axis=1)), 0.0)

        a, b = level(end, rise, y - (start or 0.0) * e), level(start, e, y - (end or 0.0) * rise)
    else:
        saa, sbb, sab = (rise**2).sum(axis=1), (e**2).sum(axis=1), (rise * e).sum(axis=1)
        ra, rb = rise @ y, e @ y
        det = saa * sbb - sab**2
        safe = det > 1e-12 * saa * sbb
        a = np.where(safe, (sbb * ra - sab * rb) / np.where(safe, det, 1.0), -1.0)
        b = np.where(safe, (saa * rb - sab * ra) / np.where(safe, det, 1.0), -1.0)
        # On a bound the other level is fitted alone; the better of the two bounds is taken.
        only_b = np.maximum(rb / _positive(sbb), 0.0)
        only_a = np.maximum(ra / _positive(saa), 0.0)
        gain_b = 2 * only_b * rb - only_b**2 * sbb
        gain_a = 2 * only_a * ra - only_a**2 * saa
        outside = (a < 0) | (b < 0)
        use_b = gain_b >= gain_a
        a = np.where(outside, np.where(use_b, 0.0, only_a), a)
        b = np.where(outside, np.where(use_b, only_b, 0.0), b)
    residual = y - a[:, None] * rise - b[:, None] * e
    return a, b, (residual**2).sum(axis=1)


def best_decay(
    x: np.ndarray,
    y: np.ndarray,
    low: float,
    high: float,
    *,
    start: float | None = None,
    end: float | None = None,
    points: int = 160,
) -> tuple[float, float, float, float]:
    """Return (end, start, tau, residual sum) of the best decay with tau in [low, high].

    A logarithmic grid finds the valley, golden sections narrow it down: nothing to start from.
    """

    def at(log_tau: np.ndarray) -> np.ndarray:
        return linear_part(x, y, np.exp(log_tau), start, end)[2]

    log_tau = _minimum(at, np.log(low), np.log(high), points)
    a, b, rss = linear_part(x, y, np.exp(np.array([log_tau])), start, end)
    return float(a[0]), float(b[0]), float(np.exp(log_tau)), float(rss[0])


def _minimum(
    function: Callable[[np.ndarray], np.ndarray], low: float, high: float, points: int
) -> float:
    """Return the place of the lowest value: grids of shrinking width around the best point."""
    grid = np.linspace(low, high, points)
    best = low
    for _ in range(14):
        values = function(grid)
        i = int(np.argmin(values))
        best = float(grid[i])
        left, right = grid[max(i - 1, 0)], grid[min(i + 1, len(grid) - 1)]
        if right - left < 1e-10:
            break
        grid = np.linspace(left, right, 21)
    return best


def _positive(values: np.ndarray) -> np.ndarray:
    return np.maximum(values, 1e-300)
