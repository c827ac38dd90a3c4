"""Smooth non-negative least squares for Maxwell terms; pure functions of arrays."""

import numpy as np


def relaxation_kernel(time: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return columns [1, exp(-t / tau_k)], (n, 1 + m)."""
    return np.column_stack([np.ones(time.size), np.exp(-time[:, None] / times)])


def storage_kernel(w: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return columns [1, (w tau)^2 / (1 + (w tau)^2)], (n, 1 + m)."""
    x2 = (w[:, None] * times) ** 2
    return np.column_stack([np.ones(w.size), x2 / (1.0 + x2)])


def loss_kernel(w: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return columns [0, w tau / (1 + (w tau)^2)], (n, 1 + m)."""
    x = w[:, None] * times
    return np.column_stack([np.zeros(w.size), x / (1.0 + x * x)])


def second_differences(n: int) -> np.ndarray:
    """Return the operator of second differences of n values; the ends are taken as free."""
    return np.diff(np.eye(n), 2, axis=0) if n > 2 else np.zeros((0, n))


def smooth_nonnegative(
    kernel: np.ndarray, target: np.ndarray, scale: np.ndarray, step: float, smoothing: float
) -> np.ndarray:
    """Return x >= 0 minimising mean (kernel x - target)^2 + smoothing^2 mean (s'')^2.

    s = x[1:] / (scale step) is the spectrum per decade relative to the local modulus ``scale``
    (m,), ``step`` the spacing of the relaxation times in decades, '' the derivative by the
    decade. Column 0 is the equilibrium modulus and not smoothed.
    """
    from scipy.optimize import nnls

    n, m = kernel.shape[0], scale.size
    columns = np.concatenate([[scale[-1]], scale])
    rough = second_differences(m) / step**3
    penalty = np.hstack([np.zeros((rough.shape[0], 1)), rough])
    matrix = np.vstack([kernel * columns / np.sqrt(n), penalty * (smoothing / np.sqrt(m))])
    goal = np.concatenate([target / np.sqrt(n), np.zeros(rough.shape[0])])
    solution, _ = nnls(matrix, goal, maxiter=50 * (m + 1))
    return solution * columns


def run_length(residual: np.ndarray) -> int:
    """Return over how many neighbours residuals are correlated (first-order autoregression)."""
    if residual.size < 8:
        return 1
    centred = residual - residual.mean()
    power = float(centred @ centred)
    if power == 0.0:
        return 1
    rho = min(max(float(centred[1:] @ centred[:-1]) / power, 0.0), 0.9)
    return max(1, min(round((1.0 + rho) / (1.0 - rho)), residual.size // 8 or 1))


def random_signs(n: int, run: int, generator: np.random.Generator) -> np.ndarray:
    """Return n signs, equal within runs of ``run`` with a random start."""
    count = n // run + 2
    signs = np.repeat(generator.choice([-1.0, 1.0], count), run)
    start = int(generator.integers(run)) if run > 1 else 0
    return signs[start : start + n]
