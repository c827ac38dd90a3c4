"""Student's, Welch's and the paired t test, each named in its result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

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
    first: Sequence[float] | np.ndarray,
    second: Sequence[float] | np.ndarray,
    *,
    kind: str = "welch",
    confidence: float = 0.95,
) -> TTest:
    """Return the two-sided t test of two samples.

    ``kind``: ``"welch"`` (default), ``"pooled"`` (JMP's default) or ``"paired"``.

    Errors
    ------
    DataError
        Fewer than two values, missing values, unequal lengths when paired, no scatter at all.
    """
    from scipy import stats

    if kind not in KINDS:
        raise unknown_name("t test", kind, KINDS, where="kind")
    a, b = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    if min(len(a), len(b)) < 2 or not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise DataError("a t test needs at least two finite values in each sample", where=kind)
    if kind == "paired":
        if len(a) != len(b):
            raise DataError(f"{len(a)} against {len(b)} values can't be paired", where=kind)
        differences = a - b
        variance, df = differences.var(ddof=1) / len(a), float(len(a) - 1)
    elif kind == "pooled":
        df = float(len(a) + len(b) - 2)
        within = ((len(a) - 1) * a.var(ddof=1) + (len(b) - 1) * b.var(ddof=1)) / df
        variance = within * (1 / len(a) + 1 / len(b))
    else:
        va, vb = a.var(ddof=1) / len(a), b.var(ddof=1) / len(b)
        variance = va + vb
        df = variance**2 / (va**2 / (len(a) - 1) + vb**2 / (len(b) - 1)) if variance > 0 else 1.0
    if variance <= 0:
        raise DataError("the samples do not scatter", where=kind)
    difference, error = float(a.mean() - b.mean()), float(np.sqrt(variance))
    t = difference / error
    reach = float(stats.t.ppf(0.5 + confidence / 2, df)) * error
    p = 2.0 * float(stats.t.sf(abs(t), df))
    return TTest(kind, t, float(df), p, difference, difference - reach, difference + reach)
