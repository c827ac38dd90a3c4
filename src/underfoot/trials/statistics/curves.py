"""Curves tested as a whole (statistical parametric mapping): t at each instant, one threshold."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError


@dataclass(frozen=True, slots=True)
class Cluster:
    """Stretch of a curve, from ``start`` to ``stop`` (samples, both inside), beyond the threshold.

    ``p``: chance of a peak as high anywhere on the curve if there were no difference.
    """

    start: int
    stop: int
    p: float


@dataclass(frozen=True, slots=True)
class CurveTest:
    """Paired t test of curves.

    ``t``: shape (m,), NaN where all persons agree exactly. ``threshold``: that random field theory
    gives for the whole curve. ``fwhm``: smoothness in samples. ``clusters``: stretches beyond it,
    both signs. ``p``: of the whole curve.
    """

    t: np.ndarray
    threshold: float
    fwhm: float
    clusters: tuple[Cluster, ...]
    p: float
    persons: int


def paired_curve_test(first: ArrayLike, second: ArrayLike, *, alpha: float = 0.05) -> CurveTest:
    """Return the paired t test of whole curves, two-sided.

    t of the persons' differences at each instant. The threshold u solves P(max |t| > u) = alpha
    with P(max t > u) = 1 - exp(-(P0(u) + R P1(u))): P0 the tail of t, P1(u) = sqrt(4 ln 2) /
    (2 pi) (1 + u^2/df)^(-(df-1)/2), R = (m - 1) / fwhm, each side at alpha / 2; fwhm from the
    gradients of the residuals.

    ``first``, ``second``: shape (persons, m), the same persons in the same order.

    DataError: shapes differ, fewer than four persons or three samples, missing values, no scatter.

    Source: K. J. Friston et al., Statistical Parametric Mapping, Academic Press 2007, ch. 17 to 19;
    T. C. Pataky, J. Biomech. 43 (2010) 1976.
    """
    from scipy.optimize import brentq

    a, b = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    if a.ndim != 2 or a.shape != b.shape or a.shape[0] < 4 or a.shape[1] < 3:
        raise DataError("curves of four persons or more are needed", where="curves")
    difference = a - b
    if not np.isfinite(difference).all() or not (difference.std(axis=0) > 0).any():
        raise DataError("curves miss values or do not scatter", where="curves")
    n, m = difference.shape
    t = _t(difference)
    fwhm = smoothness(difference - difference.mean(axis=0))
    resels = (m - 1) / fwhm

    def excess(u: float) -> float:
        return _tail(u, n - 1, resels) - alpha / 2

    high = 10.0
    while excess(high) > 0:
        high *= 2.0
    u = float(np.asarray(brentq(excess, 0.1, high, xtol=1e-10)))
    clusters = []
    for sign in (1, -1):
        beyond = np.concatenate(([False], np.nan_to_num(sign * t) > u, [False])).astype(int)
        steps = np.diff(beyond)
        ends = zip(np.flatnonzero(steps > 0), np.flatnonzero(steps < 0) - 1, strict=True)
        for start, stop in ends:
            peak = float(np.nanmax(sign * t[start : stop + 1]))
            p = min(2.0 * _tail(peak, n - 1, resels), 1.0)
            clusters.append(Cluster(int(start), int(stop), p))
    clusters.sort(key=lambda cluster: cluster.start)
    whole = min(2.0 * _tail(float(np.nanmax(np.abs(t))), n - 1, resels), 1.0)
    return CurveTest(t, u, fwhm, tuple(clusters), whole, n)


def smoothness(residuals: np.ndarray) -> float:
    """Return the full width at half maximum (samples) of residuals (persons, m).

    fwhm = sqrt(4 ln 2) / mean of sqrt(sum of squared gradients / sum of squares).
    """
    squares = (residuals**2).sum(axis=0)
    gradient = np.gradient(residuals, axis=1)
    some = squares > 0
    rate = np.sqrt((gradient**2).sum(axis=0)[some] / (squares[some] + np.finfo(float).eps))
    return float(np.sqrt(4.0 * np.log(2.0)) / rate.mean())


def _t(difference: np.ndarray) -> np.ndarray:
    error = difference.std(axis=0, ddof=1) / np.sqrt(len(difference))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(error > 0, difference.mean(axis=0) / error, np.nan)


def _tail(u: float, df: int, resels: float) -> float:
    """Chance that a smooth t field goes beyond u (one side)."""
    from scipy.stats import t as student

    density = np.sqrt(4.0 * np.log(2.0)) / (2.0 * np.pi) * (1.0 + u * u / df) ** (-(df - 1) / 2.0)
    return float(-np.expm1(-(student.sf(u, df) + resels * density)))
