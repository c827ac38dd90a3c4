"""Sums of decaying exponentials: separable least squares with nothing to start from."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from underfoot.core import DataError


@dataclass(frozen=True, slots=True)
class ExponentialSum:
    """y = level + sum of amplitude_k exp(-rate_k x), slowest first."""

    level: float
    amplitudes: np.ndarray
    rates: np.ndarray
    residual_sum: float

    def __call__(self, x: np.ndarray) -> np.ndarray:
        """Return the sum at ``x``."""
        decays = np.exp(-np.multiply.outer(np.asarray(x, dtype=float), self.rates))
        return self.level + decays @ self.amplitudes


def exponential_sum(
    x: Sequence[float] | np.ndarray, y: Sequence[float] | np.ndarray, terms: int
) -> ExponentialSum:
    """Return the least-squares sum of ``terms`` exponentials and a level.

    A logarithmic grid over the rates, each with its linear least squares, then a polish in the
    logarithms of the rates (variable projection).

    DataError: fewer points than parameters, missing values, x that does not vary; 1 to 3 terms.
    """
    from scipy.optimize import least_squares

    a, b = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if a.shape != b.shape or not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise DataError("x and y must match and be finite", where="exponential_sum")
    if not 1 <= terms <= 3 or len(a) <= 2 * terms + 1 or np.ptp(a) == 0:
        raise DataError(
            f"{terms} terms on {len(a)} points", where="exponential_sum", allowed="1 to 3 terms"
        )
    origin = float(a.min())
    t = a - origin
    spacing = float(np.min(np.diff(np.unique(t))))
    grid = np.geomspace(0.1 / np.ptp(t), 5.0 / spacing, {1: 80, 2: 40, 3: 24}[terms])

    def solved(log_rates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        matrix = np.column_stack((np.ones_like(t), np.exp(-np.outer(t, np.exp(log_rates)))))
        solution = np.linalg.lstsq(matrix, b, rcond=None)[0]
        return solution, matrix @ solution - b

    start = min(
        (np.log(np.array(rates)) for rates in combinations(grid, terms)),
        key=lambda rates: float(np.sum(solved(rates)[1] ** 2)),
    )
    found = least_squares(lambda r: solved(r)[1], start, xtol=1e-14, ftol=1e-14, gtol=1e-14)
    order = np.argsort(found.x)
    rates = np.exp(found.x[order])
    solution, residual = solved(found.x[order])
    amplitudes = solution[1:] * np.exp(rates * origin)
    return ExponentialSum(float(solution[0]), amplitudes, rates, float(np.sum(residual**2)))
