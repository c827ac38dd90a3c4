"""Reliability and agreement: intraclass correlation, Bland and Altman's limits."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, unknown_name
from underfoot.core.remark import Message

from .samples import ROUNDING

FORMS = ("ICC(1,1)", "ICC(A,1)", "ICC(C,1)", "ICC(1,k)", "ICC(A,k)", "ICC(C,k)")


@dataclass(frozen=True, slots=True)
class IntraclassCorrelation:
    """ICC of a ``form`` with its interval.

    ``error``: standard error of measurement of a single value, in the unit of the values.
    ``subjects`` and ``k``: how many, and values of each (their effective number when uneven).
    """

    form: str
    value: float
    low: float
    high: float
    error: float
    subjects: int
    k: float

    @property
    def detectable_change(self) -> float:
        """Smallest change between two single values beyond chance (95 %): 1.96 sqrt(2) error."""
        return 1.96 * float(np.sqrt(2.0)) * self.error


def intraclass_correlation(
    values: Sequence[ArrayLike], form: str = "ICC(A,1)", *, confidence: float = 0.95
) -> IntraclassCorrelation:
    """Return the intraclass correlation of repeated values of subjects.

    With mean squares between subjects R, raters C, residual E, within W, and n subjects:
    ICC(1,1) = (R - W) / (R + (k-1) W); ICC(A,1) = (R - E) / (R + (k-1) E + k (C - E) / n);
    ICC(C,1) = (R - E) / (R + (k-1) E); those of means by Spearman and Brown's formula. Intervals
    from F. One-way random is (1,1) with Shrout and Fleiss, two-way absolute agreement (A) their
    (2,1), consistency (C) their (3,1).

    ``values``: one row a subject, shape (n, k); columns are raters, sessions or machines. Rows of
    unequal length are allowed in one-way forms, where columns have no meaning.

    Raters who agree exactly (of which C asks less than A) have an ICC of 1. An end at or below
    -1 / (k - 1), which no mean of k values can have, is minus infinity for the mean.

    InputError: unknown form. DataError: fewer than two subjects or no repeated values; missing or
    uneven values in a two-way form; subjects that do not differ.

    Source: K. O. McGraw, S. P. Wong, Psychol. Methods 1 (1996) 30; P. E. Shrout, J. L. Fleiss,
    Psychol. Bull. 86 (1979) 420.
    """
    from scipy.stats import f as fisher

    if form not in FORMS:
        raise unknown_name("form", form, FORMS, where="ICC")
    rows = [np.asarray(row, dtype=float) for row in values]
    sizes = np.array([len(row) for row in rows], dtype=float)
    n, total = len(rows), int(sizes.sum())
    if n < 2 or total <= n or not all(np.isfinite(row).all() and len(row) for row in rows):
        raise DataError(
            Message("{count} values of {subjects} subjects", count=total, subjects=n),
            where=form,
            allowed="two subjects, repeated values",
        )
    one_way, level = form.startswith("ICC(1"), 0.5 + confidence / 2
    everything = np.concatenate(rows)
    within = sum(float(((row - row.mean()) ** 2).sum()) for row in rows)
    between = float(((everything - everything.mean()) ** 2).sum()) - within
    mean_rows = between / (n - 1)
    k = (total - float((sizes**2).sum()) / total) / (n - 1)
    rounding = total * (ROUNDING * float(np.abs(everything).max())) ** 2
    if between <= rounding:
        raise DataError("the subjects do not differ", where=form)
    mean_columns = 0.0

    def of_ratio(ratio: float) -> float:
        return (ratio - 1.0) / (ratio + k - 1.0)

    if one_way:
        error_ms, df = within / (total - n), total - n
        variance = error_ms
    else:
        if len(set(sizes)) > 1:
            raise DataError("subjects have different numbers of values", where=form)
        columns = np.array(rows).mean(axis=0)
        mean_columns = n * float(((columns - columns.mean()) ** 2).sum()) / (k - 1)
        df = int((n - 1) * (k - 1))
        error_ms = max(within - mean_columns * (k - 1), 0.0) / df
        variance = error_ms
    agree = within <= rounding
    if agree or (df * error_ms <= rounding and not form.startswith("ICC(A")):
        return IntraclassCorrelation(form, 1.0, 1.0, 1.0, 0.0, n, float(k))
    error_ms = max(error_ms, rounding / df)
    ratio = mean_rows / error_ms
    low = of_ratio(ratio / float(fisher.ppf(level, n - 1, df)))
    high = of_ratio(ratio * float(fisher.ppf(level, df, n - 1)))
    value = of_ratio(ratio)
    if form.startswith("ICC(A"):
        shift = k * mean_columns + (k * n - k - n) * error_ms
        value = n * (mean_rows - error_ms) / (shift + n * mean_rows)
        held = max(value, 0.0)  # below, the weights of the mean squares would be negative
        a = k * held / (n * (1.0 - held))
        b = 1.0 + a * (n - 1)
        parts = a * mean_columns, b * error_ms
        freedom = sum(parts) ** 2 / (parts[0] ** 2 / (k - 1) + parts[1] ** 2 / df)
        under, over = fisher.ppf(level, n - 1, freedom), fisher.ppf(level, freedom, n - 1)
        low = n * (mean_rows - under * error_ms) / (under * shift + n * mean_rows)
        high = n * (over * mean_rows - error_ms) / (shift + n * over * mean_rows)
        variance += max(mean_columns - error_ms, 0.0) / n
    value, low, high = (
        (k * one / (1.0 + (k - 1.0) * one) if (k - 1.0) * one > -1.0 else -np.inf)
        if form.endswith("k)")
        else one
        for one in (float(value), float(low), float(high))
    )
    return IntraclassCorrelation(form, value, low, high, float(np.sqrt(variance)), n, float(k))


@dataclass(frozen=True, slots=True)
class Agreement:
    """Bland and Altman's analysis of ``first`` - ``second``: bias, limits, each with interval.

    ``within``: standard deviation of a subject's own differences, None without repeats.
    ``slope`` and ``slope_p``: rise of the differences with the means (proportional bias).
    """

    bias: float
    bias_interval: tuple[float, float]
    sd: float
    lower: float
    lower_interval: tuple[float, float]
    upper: float
    upper_interval: tuple[float, float]
    within: float | None
    slope: float
    slope_p: float
    subjects: int
    pairs: int


def bland_altman(
    first: ArrayLike,
    second: ArrayLike,
    subject: Sequence[object] = (),
    *,
    confidence: float = 0.95,
) -> Agreement:
    """Return bias and 95 % limits of agreement of two methods, with repeated pairs of subjects.

    Limits: mean of the subjects' mean differences -+ 1.96 sd. Repeated pairs of a subject (the
    true value may vary between them) give sd^2 = s_b^2 + (1 - 1/m) s_w^2, with the variance s_b^2
    of the subjects' means, s_w^2 within subjects and the harmonic mean m of the numbers of pairs.
    Intervals by MOVER from those of the mean (t) and the variances (chi squared).

    ``first``, ``second``: shape (n,), pairs. ``subject``: whose each pair is; each its own without.

    DataError: lengths differ, missing values, fewer than three subjects, no scatter.

    Source: J. M. Bland, D. G. Altman, Lancet 327 (1986) 307 and J. Biopharm. Stat. 17 (2007) 571;
    intervals: G. Y. Zou, Stat. Methods Med. Res. 22 (2013) 630.
    """
    from scipy import stats

    a, b = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    names = list(map(str, subject)) if len(subject) else list(map(str, range(len(a))))
    if not len(a) == len(b) == len(names) or not np.isfinite([a, b]).all():
        raise DataError("pairs are incomplete", where="Bland-Altman")
    order = list(dict.fromkeys(names))
    who = np.array([order.index(name) for name in names])
    n, counts = len(order), np.bincount(who)
    if n < 3:
        raise DataError(
            Message("{subjects} subjects", subjects=n),
            where="Bland-Altman",
            allowed="three or more",
        )
    difference = a - b
    means = np.bincount(who, difference) / counts
    share = 1.0 - float(np.mean(1.0 / counts))
    free = len(a) - n
    inside = float(((difference - means[who]) ** 2).sum()) / free if free else 0.0
    parts = ((float(means.var(ddof=1)), n - 1), (share * inside, free))
    variance = sum(part for part, _ in parts)
    if variance <= (ROUNDING * max(np.abs(a).max(), np.abs(b).max())) ** 2:
        raise DataError("the differences do not scatter", where="Bland-Altman")
    tail = 0.5 - confidence / 2
    down = up = 0.0
    for part, df in parts:
        if df:
            down += (part * (1.0 - df / float(stats.chi2.isf(tail, df)))) ** 2
            up += (part * (df / float(stats.chi2.ppf(tail, df)) - 1.0)) ** 2
    bias, sd = float(means.mean()), float(np.sqrt(variance))
    reach = float(stats.t.isf(tail, n - 1)) * float(np.sqrt(parts[0][0] / n))
    low_sd = 1.96 * (sd - float(np.sqrt(max(variance - np.sqrt(down), 0.0))))
    high_sd = 1.96 * (float(np.sqrt(variance + np.sqrt(up))) - sd)
    near, far = float(np.hypot(reach, low_sd)), float(np.hypot(reach, high_sd))
    lower, upper = bias - 1.96 * sd, bias + 1.96 * sd
    middle = np.bincount(who, (a + b) / 2) / counts
    moves = np.ptp(middle) > ROUNDING * np.abs(middle).max()
    line: Any = stats.linregress(middle, means) if moves else None
    slope, p = (0.0, 1.0) if line is None else (float(line.slope), float(line.pvalue))
    spread = float(np.sqrt(inside)) if free else None
    return Agreement(
        bias, (bias - reach, bias + reach), sd, lower, (lower - far, lower + near),
        upper, (upper - near, upper + far), spread, slope, p, n, len(a),
    )  # fmt: skip
