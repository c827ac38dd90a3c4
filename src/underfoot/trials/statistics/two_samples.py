"""Two samples: t tests, each named in its result, and the straight line of y on x."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, unknown_name

KINDS = {
    "welch": "Welch's t test (variances may differ)",
    "pooled": "Student's t test (pooled variance)",
    "paired": "paired t test",
}


@dataclass(frozen=True, slots=True)
class TTest:
    """Difference of means ``first`` - ``second`` with t, degrees of freedom, p and interval."""

    kind: str
    t: float
    df: float
    p: float
    difference: float
    low: float
    high: float

    @property
    def title(self) -> str:
        """Name of the test."""
        return KINDS[self.kind]


def t_test(
    first: ArrayLike, second: ArrayLike, *, kind: str = "welch", confidence: float = 0.95
) -> TTest:
    """Return the two-sided t test of two samples.

    ``kind``: ``"welch"`` (default), ``"pooled"`` (JMP's default) or ``"paired"``.

    DataError: fewer than two values, missing values, unequal lengths when paired, no scatter at
    all.
    """
    from scipy import stats

    if kind not in KINDS:
        raise unknown_name("t test", kind, KINDS, where="kind")
    a, b = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    if min(len(a), len(b)) < 2 or not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise DataError("a t test needs at least two finite values in each sample", where=kind)
    if kind == "paired" and len(a) != len(b):
        raise DataError(f"{len(a)} against {len(b)} values can't be paired", where=kind)
    scatter = np.ptp(a - b) if kind == "paired" else max(np.ptp(a), np.ptp(b))
    if scatter == 0:
        raise DataError("the samples do not scatter", where=kind)
    test: Any = (
        stats.ttest_rel(a, b)
        if kind == "paired"
        else stats.ttest_ind(a, b, equal_var=kind == "pooled")
    )
    ends = test.confidence_interval(confidence)
    numbers = (test.statistic, test.df, test.pvalue, a.mean() - b.mean(), *ends)
    return TTest(kind, *map(float, numbers))


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


def regression_line(x: ArrayLike, y: ArrayLike) -> Line:
    """Return the least-squares line of y on x (the report's Figure 33).

    DataError: fewer than three pairs, missing values, constant x or y.
    """
    from scipy import stats

    a, b = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if len(a) != len(b) or len(a) < 3 or not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise DataError("a regression line needs three complete pairs", where="regression")
    if np.ptp(a) == 0 or np.ptp(b) == 0:
        raise DataError("x or y is constant", where="regression")
    fit: Any = stats.linregress(a, b)
    spread = float(np.sqrt(np.sum((b - fit.intercept - fit.slope * a) ** 2) / (len(a) - 2)))
    slope, intercept, r, p, *errors = map(float, (*fit[:4], fit.stderr, fit.intercept_stderr))
    return Line(slope, intercept, errors[0], errors[1], r, p, spread, len(a))
