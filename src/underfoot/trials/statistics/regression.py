"""Straight line and correlation (the report's Figure 33)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from underfoot.core import DataError


@dataclass(frozen=True, slots=True)
class Line:
    """y = intercept + slope x with standard errors, Pearson's r, p and the residual sd."""

    slope: float
    intercept: float
    slope_error: float
    intercept_error: float
    r: float
    p: float
    residual_sd: float
    n: int

    @property
    def r_squared(self) -> float:
        """Share of the variation described."""
        return self.r**2


def regression_line(x: Sequence[float] | np.ndarray, y: Sequence[float] | np.ndarray) -> Line:
    """Return the least-squares line of y on x.

    Errors
    ------
    DataError
        Fewer than three pairs, missing values, constant x or y.
    """
    from scipy import stats

    a, b = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if len(a) != len(b) or len(a) < 3 or not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise DataError("a regression line needs three complete pairs", where="regression")
    if np.ptp(a) == 0 or np.ptp(b) == 0:
        raise DataError("x or y is constant", where="regression")
    fit: Any = stats.linregress(a, b)
    residual = b - (fit.intercept + fit.slope * a)
    return Line(
        float(fit.slope),
        float(fit.intercept),
        float(fit.stderr),
        float(fit.intercept_stderr),
        float(fit.rvalue),
        float(fit.pvalue),
        float(np.sqrt(np.sum(residual**2) / (len(a) - 2))),
        len(a),
    )
