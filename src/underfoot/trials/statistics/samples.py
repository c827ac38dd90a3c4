"""Samples: t tests, straight line, repeatability and reproducibility (ISO 5725-2)."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, unknown_name
from underfoot.core.optional import optional_module
from underfoot.core.remark import Message

ROUNDING = 1e-12
"""Differences below this share of the largest value are those of rounding: no instrument reads
twelve digits."""

_NUMBERED = re.compile(r"(\D*?)([+-]?\d+(?:\.\d+)?)(\D*)")

KINDS = {
    "welch": "Welch's t test (variances may differ)",
    "pooled": "Student's t test (pooled variance)",
    "paired": "paired t test",
}


def ordered_levels(labels: Iterable[str]) -> tuple[str, ...]:
    """Return labels once each: by value where they differ in one number, else as they first come.

    >>> ordered_levels(["75 Shore A", "45 Shore A", "100 Shore A"])
    ('45 Shore A', '75 Shore A', '100 Shore A')
    >>> ordered_levels(["wet", "dry"])
    ('wet', 'dry')
    """
    once = tuple(dict.fromkeys(labels))
    parts = [_NUMBERED.fullmatch(label) for label in once]
    if not all(parts) or len({(part[1], part[3]) for part in parts if part}) != 1:
        return once
    values = {part[0]: float(part[2]) for part in parts if part}
    return tuple(sorted(once, key=values.__getitem__))


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


def merge_equal_values(values: ArrayLike) -> np.ndarray:
    """Return the values, with those that differ by rounding alone made equal (0.3, 0.1 + 0.2)."""
    x = np.asarray(values, dtype=float)
    order = np.argsort(x, axis=None)
    flat = x.ravel()[order]
    if not len(flat):
        return x
    apart = np.diff(flat, prepend=flat[0]) > ROUNDING * np.abs(flat).max()
    made = np.empty_like(flat)
    made[order] = flat[np.maximum.accumulate(np.where(apart, np.arange(len(flat)), 0))]
    return made.reshape(x.shape)


def standard_deviation(values: ArrayLike) -> float | None:
    """Return the standard deviation of a sample (n,), or None where it can't be told.

    A single value has none; values that are all alike scatter by less than their resolution, which
    is not the same as 0.
    """
    x = merge_equal_values(values)
    return float(x.std(ddof=1)) if len(x) > 1 and np.ptp(x) > 0 else None


def corrected_p(p: Sequence[float], method: str = "holm") -> list[float]:
    """Return p corrected for their number: Holm's method, or another of statsmodels."""
    if not p:
        return []
    purpose = "Correcting p for the number of comparisons"
    corrected = optional_module("statsmodels.stats.multitest", "trials", purpose)
    corrected = corrected.multipletests(p, method=method)[1]
    return [float(each) for each in corrected]


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
        raise DataError(
            Message("{count} against {other} values can't be paired", count=len(a), other=len(b)),
            where=kind,
        )
    scatter = np.ptp(a - b) if kind == "paired" else max(np.ptp(a), np.ptp(b))
    if scatter <= ROUNDING * max(np.abs(a).max(), np.abs(b).max()):
        raise DataError("the samples do not scatter", where=kind)
    test: Any = (
        stats.ttest_rel(a, b)
        if kind == "paired"
        else stats.ttest_ind(a, b, equal_var=kind == "pooled")
    )
    ends = test.confidence_interval(confidence)
    numbers = (test.statistic, test.df, test.pvalue, a.mean() - b.mean(), *ends)
    return TTest(kind, *map(float, numbers))


def drift(values: ArrayLike, *, alpha: float = 0.01, least: float = 0.05) -> float | None:
    """Return the rise over a series of readings as a share of their mean, or None where none is.

    The slope of a straight line over the order, where t calls it significant at ``alpha`` and the
    rise is ``least`` of the mean and more: a floor that was not cleaned, a fluid that dries.

    ``values``: shape (n,), in the order in which they were read; None from fewer than four.
    """
    x = merge_equal_values(values)
    if len(x) < 4 or x.mean() == 0 or np.ptp(x) == 0:
        return None
    line = regression_line(np.arange(len(x)), x)
    rise = line.slope * (len(x) - 1) / abs(float(x.mean()))
    return rise if line.p < alpha and abs(rise) >= least else None


def mean_interval(
    values: ArrayLike, *, positive: bool = False, confidence: float = 0.95
) -> tuple[float, float] | None:
    """Return the interval of a mean, or None from fewer than two values.

    mean +- t SD / sqrt(n). ``positive``: of a quantity that can't be negative, on the logarithm of
    the mean: mean exp(+- t SD / (mean sqrt(n))) (delta method), which stays above zero and is the
    same for small scatter; None from two values, whose t of 12.7 spans decades.
    """
    from scipy.stats import t

    x = np.asarray(values, dtype=float)
    if len(x) < 2:
        return None
    mean = float(x.mean())
    reach = float(t.ppf(0.5 + confidence / 2, len(x) - 1) * x.std(ddof=1) / np.sqrt(len(x)))
    if not positive or mean <= 0:
        return mean - reach, mean + reach
    factor = float(np.exp(min(reach / mean, 700.0)))
    return None if len(x) < 3 and reach > 0 else (mean / factor, mean * factor)


def share_interval(
    events: ArrayLike, trials: ArrayLike, *, confidence: float = 0.95
) -> tuple[float, float] | None:
    """Return the interval of a share, with persons as units; None from fewer than two persons.

    On the logit with the variance between persons, sum (events - share trials)^2 k / (k - 1) / N^2
    (ratio estimate), and t of k - 1. With no event or nothing else: exact (Clopper and Pearson)
    for the number of persons.

    ``events``, ``trials``: of each person, shape (k,).
    """
    from scipy.stats import t

    e, n = np.asarray(events, dtype=float), np.asarray(trials, dtype=float)
    k = len(e)
    if k < 2:
        return None
    share, tail = float(e.sum() / n.sum()), 0.5 - confidence / 2
    if share in (0.0, 1.0):
        edge = tail ** (1.0 / k)
        return (0.0, 1.0 - edge) if share == 0.0 else (edge, 1.0)
    variance = float(((e - share * n) ** 2).sum()) * k / (k - 1) / float(n.sum()) ** 2
    # never below that of independent trials: persons who happen to agree show nothing
    variance = max(variance, share * (1.0 - share) / float(n.sum()))
    reach = float(t.isf(tail, k - 1)) * np.sqrt(variance) / (share * (1.0 - share))
    middle = np.log(share / (1.0 - share))
    low, high = 0.5 * (1.0 + np.tanh(0.5 * (middle + reach * np.array((-1.0, 1.0)))))
    return float(low), float(high)


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


@dataclass(frozen=True, slots=True)
class OutlierTest:
    """One test of ISO 5725-2: statistic with its critical values at 5 % and 1 %.

    ``verdict``: "correct", "straggler" (beyond 5 %) or "outlier" (beyond 1 %).
    """

    name: str
    laboratory: str
    statistic: float
    critical_5_percent: float
    critical_1_percent: float

    @property
    def verdict(self) -> str:
        """Return what ISO 5725-2, 7.3.2.1 calls the item."""
        if self.statistic > self.critical_1_percent:
            return "outlier"
        return "straggler" if self.statistic > self.critical_5_percent else "correct"


@dataclass(frozen=True, slots=True)
class Precision:
    """Precision of a method at one level.

    ``repeatability`` and ``reproducibility``: standard deviations s_r (same laboratory, operator,
    machine) and s_R (any of them); None where the readings are equal, so that it is below their
    resolution. ``between``: standard deviation s_L between laboratories.
    ``outliers``: Cochran's test of the largest variance, Grubbs' of the largest and the smallest
    mean.
    """

    mean: float
    repeatability: float | None
    between: float
    reproducibility: float | None
    laboratories: int
    n: int
    outliers: tuple[OutlierTest, ...]

    @property
    def repeatability_limit(self) -> float | None:
        """Difference that two readings of one laboratory exceed in 5 % of cases, 2.8 s_r."""
        return None if self.repeatability is None else 2.8 * self.repeatability

    @property
    def reproducibility_limit(self) -> float | None:
        """Difference that readings of two laboratories exceed in 5 % of cases, 2.8 s_R."""
        return None if self.reproducibility is None else 2.8 * self.reproducibility


def precision(readings: Mapping[str, ArrayLike]) -> Precision:
    """Return repeatability and reproducibility from repeated readings of several laboratories.

    s_r^2 is the pooled variance within laboratories, s_L^2 = (MS_between - s_r^2) / n0 (zero when
    negative), s_R^2 = s_r^2 + s_L^2 with n0 = (N - sum n_i^2 / N) / (p - 1). Nothing is left out:
    outliers are named, and whoever removes one says so. Operators or machines may stand in place
    of laboratories; s_R then means reproducibility over these.

    ``readings``: readings by laboratory, at least two laboratories, one of them with two readings.

    DataError: too few laboratories or readings, or missing values.

    Source: ISO 5725-2:1994, 7.3 and 7.4 (from memory, not verified against the text; the formulas
    reproduce the example of ASTM E691). Critical values are computed: Cochran's from F, Grubbs'
    from t.
    """
    groups = {name: merge_equal_values(values) for name, values in readings.items()}
    if any(not len(v) or not np.isfinite(v).all() for v in groups.values()):
        raise DataError("missing readings", where="precision")
    p, total = len(groups), sum(map(len, groups.values()))
    if p < 2 or total <= p:
        raise DataError(
            Message("{count} readings of {laboratories} laboratories", count=total, laboratories=p),
            where="precision",
            allowed="two laboratories or more, repeated readings",
        )
    sizes = np.array([len(v) for v in groups.values()], dtype=float)
    means = np.array([v.mean() for v in groups.values()])
    grand = float(np.sum(sizes * means) / total)
    within = sum(float(np.sum((v - v.mean()) ** 2)) for v in groups.values()) / (total - p)
    n0 = (total - float(np.sum(sizes**2)) / total) / (p - 1)
    spread = float(np.sum(sizes * (means - grand) ** 2)) / (p - 1)
    between = max(0.0, (spread - within) / n0)
    level = (ROUNDING * max(float(np.abs(v).max()) for v in groups.values())) ** 2
    s_r, both = (
        float(np.sqrt(variance)) if variance > level else None
        for variance in (within, within + between)
    )
    s_l = float(np.sqrt(between))
    return Precision(grand, s_r, s_l, both, p, total, tuple(_outliers(groups, means)))


def _outliers(groups: Mapping[str, np.ndarray], means: np.ndarray) -> list[OutlierTest]:
    from scipy import stats

    names = list(groups)
    tests = []
    variances = {n: float(v.var(ddof=1)) for n, v in groups.items() if len(v) > 1}
    if len(variances) > 1 and sum(variances.values()) > 0:
        worst = max(variances, key=lambda n: variances[n])
        # ISO 5725-2, 7.3.3.2: n is the number of readings that most laboratories have.
        sizes = [len(groups[n]) for n in variances]
        n, p = max(set(sizes), key=sizes.count), len(variances)

        def cochran(alpha: float) -> float:
            f = float(stats.f.isf(alpha / p, n - 1, (p - 1) * (n - 1)))
            return f / (f + p - 1)

        tests.append(
            OutlierTest(
                "Cochran, largest variance", worst, variances[worst] / sum(variances.values()),
                cochran(0.05), cochran(0.01),
            )
        )  # fmt: skip
    p = len(means)
    if p > 2 and means.std() > 0:

        def grubbs(alpha: float) -> float:
            t2 = float(stats.t.isf(alpha / (2 * p), p - 2)) ** 2
            return float((p - 1) / np.sqrt(p) * np.sqrt(t2 / (p - 2 + t2)))

        for label, at, sign in (("largest", means.argmax(), 1), ("smallest", means.argmin(), -1)):
            g = sign * float(means[at] - means.mean()) / float(means.std(ddof=1))
            tests.append(
                OutlierTest(f"Grubbs, {label} mean", names[at], g, grubbs(0.05), grubbs(0.01))
            )
    return tests
