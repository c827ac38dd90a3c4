"""Horizontal shift between two measured curves; pure functions of arrays."""

from typing import Any

import numpy as np

DEGREE = 3
LEAST_SCATTER = 4e-4
"""0.1 % in log10: no reading is trusted further."""


def common_polynomial_cost(
    shift: float, x: np.ndarray, y: np.ndarray, x_other: np.ndarray, y_other: np.ndarray
) -> tuple[float, int]:
    """Return the sum of squares about one polynomial through both curves, and free values.

    The second curve is moved by ``shift``. ``y`` and ``y_other`` are (q, n): quantities that
    share the abscissa and the shift, each with its own polynomial. All points count whatever the
    overlap, so the cost does not favour small overlaps.
    """
    both = np.concatenate([x, x_other + shift])
    low, high = both.min(), both.max()
    unit = 2.0 * (both - low) / (high - low) - 1.0
    degree = min(DEGREE, both.size // 4)
    basis = np.polynomial.chebyshev.chebvander(unit, degree)
    target = np.concatenate([y, y_other], axis=1).T
    q, _ = np.linalg.qr(basis)
    rest = target - q @ (q.T @ target)
    return float(np.sum(rest * rest)), target.size - target.shape[1] * (degree + 1) - 1


def best_shift(
    x: np.ndarray, y: np.ndarray, x_other: np.ndarray, y_other: np.ndarray
) -> tuple[float, float, float]:
    """Return the shift of the second curve onto the first, its standard error, rms residual.

    Searched over every shift at which the two still touch, then refined. Each quantity counts by
    its own scatter: a noisy loss modulus does not decide against a precise storage modulus. The
    rms residual is that of the quantities as given, each weighted equally.
    """
    from scipy.optimize import minimize_scalar

    scatter = np.sqrt(0.5 * (own_scatter(x, y) ** 2 + own_scatter(x_other, y_other) ** 2))
    scatter = np.maximum(scatter, LEAST_SCATTER)
    y, y_other = y / scatter[:, None], y_other / scatter[:, None]

    low, high = x.min() - x_other.max(), x.max() - x_other.min()
    grid = np.linspace(low, high, 121)
    costs = [common_polynomial_cost(float(s), x, y, x_other, y_other)[0] for s in grid]
    i = int(np.argmin(costs))
    bounds = (grid[max(i - 1, 0)], grid[min(i + 1, grid.size - 1)])
    optimum: Any = minimize_scalar(
        lambda s: common_polynomial_cost(float(s), x, y, x_other, y_other)[0],
        bounds=bounds,
        method="bounded",
        options={"xatol": 1e-9},
    )
    shift = float(optimum.x)
    cost, free = common_polynomial_cost(shift, x, y, x_other, y_other)
    variance = cost / max(free, 1)
    step = 0.02 * (high - low)
    around = [common_polynomial_cost(shift + d, x, y, x_other, y_other)[0] for d in (-step, step)]
    curvature = (around[0] + around[1] - 2.0 * cost) / step**2
    # Flat curves fit at any shift: the error must say so, however smooth they are.
    error = np.sqrt(2.0 * max(variance, 1.0) / curvature) if curvature > 0.0 else np.inf
    return shift, float(error), float(np.sqrt(variance * np.mean(scatter**2)))


def own_scatter(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the rms of each quantity about its own cubic (or less), (q,)."""
    degree = min(3, max(x.size - 3, 1))
    unit = 2.0 * (x - x.min()) / np.ptp(x) - 1.0
    basis = np.polynomial.chebyshev.chebvander(unit, degree)
    q, _ = np.linalg.qr(basis)
    rest = y.T - q @ (q.T @ y.T)
    return np.sqrt(np.sum(rest * rest, axis=0) / max(x.size - degree - 1, 1))
