"""Curves tested as a whole (statistical parametric mapping): t at each instant, one threshold."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError

from .samples import ROUNDING

_STILL = 1e-3  # of the median scatter over the curve: what no measurement of these persons resolves


@dataclass(frozen=True, slots=True)
class Cluster:
    """Stretch of a curve, from ``start`` to ``stop`` (samples, both inside), beyond the threshold.

    ``p``: chance of a stretch as long beyond the threshold anywhere on the curve if there were no
    difference; ``p_peak``: of a peak as high.
    """

    start: int
    stop: int
    p: float
    p_peak: float


@dataclass(frozen=True, slots=True)
class CurveTest:
    """Paired t test of curves.

    ``t``: shape (m,), NaN at ``still``, the samples at which persons do not differ in their
    difference. ``threshold``: that random field theory gives for the whole curve. ``fwhm``:
    smoothness in samples. ``clusters``: stretches beyond it, both signs. ``p``: of the whole curve,
    by its highest peak.
    """

    t: np.ndarray
    threshold: float
    fwhm: float
    clusters: tuple[Cluster, ...]
    p: float
    persons: int
    still: tuple[int, ...] = ()


def paired_curve_test(first: ArrayLike, second: ArrayLike, *, alpha: float = 0.05) -> CurveTest:
    """Return the paired t test of whole curves, two-sided.

    t of the persons' differences at each instant. The threshold u solves P(max |t| > u) = alpha
    with P(max t > u) = 1 - exp(-(P0(u) + R P1(u))): P0 the tail of t, P1(u) = sqrt(4 ln 2) /
    (2 pi) (1 + u^2/df)^(-(df-1)/2), R = (m - 1) / fwhm, each side at alpha / 2; fwhm from the
    gradients of the residuals. A stretch of k resels beyond u has 1 - exp(-(P0(u) + R P1(u))
    exp(-(Gamma(3/2) k P1(u) / P0(u))^2)) a side. Samples at which the difference scatters less
    than a thousandth of the usual (a clamp, a boundary) are left out and named.

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
    if not np.isfinite(difference).all():
        raise DataError("curves miss values", where="curves")
    scatter = difference.std(axis=0)
    largest = np.maximum(np.abs(a), np.abs(b)).max(axis=0)
    moves = scatter > ROUNDING * largest
    if moves.any():
        moves &= scatter > _STILL * float(np.median(scatter[moves]))
    if moves.sum() < 3:
        raise DataError("curves do not scatter", where="curves")
    n, m = difference.shape
    t = np.full(m, np.nan)
    t[moves] = difference.mean(axis=0)[moves] / (scatter[moves] / np.sqrt(n - 1.0))
    fwhm = smoothness(difference - difference.mean(axis=0), moves)
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
            length = float(stop - start)
            for inside, outside in ((start, start - 1), (stop, stop + 1)):
                if 0 <= outside < m and np.isfinite(t[outside]):
                    length += float((sign * t[inside] - u) / (sign * (t[inside] - t[outside])))
            p = 2.0 * _tail(u, n - 1, resels, length / fwhm), 2.0 * _tail(peak, n - 1, resels)
            clusters.append(Cluster(int(start), int(stop), min(p[0], 1.0), min(p[1], 1.0)))
    clusters.sort(key=lambda cluster: cluster.start)
    whole = min(2.0 * _tail(float(np.nanmax(np.abs(t))), n - 1, resels), 1.0)
    still = tuple(np.flatnonzero(~moves).tolist())
    return CurveTest(t, u, fwhm, tuple(clusters), whole, n, still)


def smoothness(residuals: np.ndarray, moves: np.ndarray) -> float:
    """Return the full width at half maximum (samples) of residuals (persons, m).

    fwhm = sqrt(4 ln 2) / mean of sqrt(sum of squared gradients / sum of squares), over the samples
    that move, ``moves`` (m,); gradients are those between them.
    """
    at = np.flatnonzero(moves)
    gradient = np.gradient(residuals[:, at], at.astype(float), axis=1)
    rate = np.sqrt((gradient**2).sum(axis=0) / (residuals[:, at] ** 2).sum(axis=0))
    return float(np.sqrt(4.0 * np.log(2.0)) / rate.mean())


def _tail(u: float, df: int, resels: float, length: float = 0.0) -> float:
    """Chance that a smooth t field goes beyond u for a length of so many resels (one side)."""
    from scipy.stats import t as student

    above = float(student.sf(u, df))
    density = np.sqrt(4.0 * np.log(2.0)) / (2.0 * np.pi) * (1.0 + u * u / df) ** (-(df - 1) / 2.0)
    longer = np.exp(-((np.sqrt(np.pi) / 2.0 * length * density / above) ** 2))
    return float(-np.expm1(-(above + resels * density) * longer))
