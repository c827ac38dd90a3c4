"""Variances of random effects by restricted maximum likelihood, and the tests that hang on them.

No Python library gives degrees of freedom for these tests, and variances that are held at zero or
above pool errors that differ. Here a variance may be negative, as a covariance may be: in complete
data every test is then exactly that of the classical analysis of variance.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from underfoot.core import DataError

_STEPS, _HALVINGS, _CLOSE = 100, 40, 1e-9
_EXACT = 1e-12  # variances over that of all values: below is rounding
_LEAST = 1e-8  # standard deviation over that of all values: below is rounding
_TOLD = 1e-6  # to which degrees of freedom are found
_ALIKE = 1e-9  # what is left of a grouping, or of what the data say of its variance: rounding


@dataclass(frozen=True, slots=True)
class VarianceComponents:
    """Fixed effects, variances and what their tests need.

    ``coefficients`` (p,) and ``covariance`` (p, p): of the fixed effects, the covariance with what
    the estimate of the variances adds; ``plain`` is without. ``variances``: of each grouping, then
    of a single value; NaN where a later one is the same in these data. ``slopes`` (k, p, p): of
    ``plain`` against each variance that is estimated. ``uncertainty`` (k, k): covariance of those.
    """

    coefficients: np.ndarray
    covariance: np.ndarray
    plain: np.ndarray
    variances: np.ndarray
    slopes: np.ndarray
    uncertainty: np.ndarray

    def wald_test(self, contrasts: np.ndarray) -> tuple[float, float]:
        """Return F of q contrasts, shape (q, p), and the degrees of freedom of its error."""
        q = len(contrasts)
        value = contrasts @ self.coefficients
        f = float(value @ np.linalg.solve(contrasts @ self.covariance @ contrasts.T, value)) / q
        df, factor = self._error(contrasts)
        return float(factor * f), float(df)

    def error_df(self, contrast: np.ndarray) -> float:
        """Return the degrees of freedom of the error of one contrast, shape (p,)."""
        return float(self._error(contrast[None])[0])

    def _error(self, contrasts: np.ndarray) -> tuple[float, float]:
        """Return degrees of freedom and what F is multiplied by, after Kenward and Roger."""
        q = len(contrasts)
        middle = np.linalg.inv(contrasts @ self.plain @ contrasts.T)
        moved = np.array([middle @ contrasts @ slope @ contrasts.T for slope in self.slopes])
        traces = np.trace(moved, axis1=1, axis2=2)
        first = float(traces @ self.uncertainty @ traces)
        second = float(np.einsum("kl,kij,lji->", self.uncertainty, moved, moved))
        b = (first + 6.0 * second) / (2.0 * q)
        g = ((q + 1.0) * first - (q + 4.0) * second) / ((q + 2.0) * second)
        c = np.array((g, q - g, q + 2.0 - g)) / (3.0 * q + 2.0 * (1.0 - g))
        mean, tail = 1.0 - second / q, 1.0 - c[1] * b
        # Both vanish at two degrees of freedom, and the last of the three at four: in complete
        # data the tests are exact there too, so nothing is divided by them.
        two = max(abs(mean), abs(tail)) < _TOLD
        both = 1.0 if two else mean / (tail or _TOLD)
        last = 1.0 - c[2] * b
        beyond = (1.0 + c[0] * b) * both**2 - last
        df = 4.0 + (q + 2.0) * last / beyond if beyond > 0.0 else 0.0
        if df >= 1.0 and (two or mean * (df - 2.0) > 0.0):
            return df, 1.0 if two else df * mean / (df - 2.0)
        # beyond the range of the expansion: the fewest that a single contrast can have
        return max(2.0 / second, 1.0), 1.0


def variance_components(
    mean: np.ndarray,
    count: np.ndarray,
    squares: float,
    design: np.ndarray,
    groupings: Sequence[np.ndarray],
) -> VarianceComponents:
    """Return the fit of y = X b + a random effect of each group of each grouping + error.

    Values of a cell share their row of X; their mean, their number and the squares within say all.

    ``mean``, ``count``: shape (n,), of the cells. ``squares``: sum of squared deviations from the
    means of cells. ``design``: shape (n, p), the intercept first, of full rank. ``groupings``: the
    group of each cell, numbers, shape (n,) each, the coarsest first.

    DataError: a variance that these data can't tell from the fixed effects, or no scatter.

    Source: H. D. Patterson, R. Thompson, Biometrika 58 (1971) 545 (likelihood); M. G. Kenward,
    J. H. Roger, Biometrics 53 (1997) 983 (tests).
    """
    free, middle = float(count.sum() - len(mean)), float(mean.mean())
    scale = float(np.sqrt((np.sum(count * (mean - middle) ** 2) + squares) / count.sum()))
    if not scale > 0:
        raise DataError("the values do not scatter", where="mixed model")
    parts = [(grouping[:, None] == grouping).astype(float) for grouping in groupings] + [
        np.diag(1.0 / count)
    ]
    kept = _distinct(parts, free > 0)
    data = (mean - middle) / scale, design, [parts[i] for i in kept], free, squares / scale**2
    theta = np.full(len(kept), 1.0 / len(kept))
    state = _State.of(theta, *data)
    if state is None or _singular(state.expected):
        text = "so few persons leave nothing to estimate a scatter from"
        raise DataError(text, where="mixed model")
    for _ in range(_STEPS):
        try:
            step = np.linalg.solve(state.expected, state.score)
        except np.linalg.LinAlgError:  # nothing tells the variances apart
            break
        for _ in range(_HALVINGS):
            better = _State.of(theta + step, *data)
            if better is not None and better.deviance <= state.deviance + _CLOSE:
                break
            step /= 2.0
        else:
            break
        theta, state = theta + step, better
        if theta.max() < _EXACT:
            break
        if np.abs(step * np.sqrt(np.diagonal(state.expected))).max() <= _CLOSE:
            variances = np.full(len(parts), np.nan)
            variances[kept] = scale**2 * theta
            if _singular(state.expected):  # at the edge of what variances may be
                break
            uncertainty = np.linalg.inv(state.expected)
            plain = state.covariance
            added = 2.0 * np.einsum("kl,klpq->pq", uncertainty, state.bends)
            coefficients = scale * state.coefficients
            coefficients[0] += middle
            return VarianceComponents(
                coefficients, scale**2 * (plain + added), scale**2 * plain, variances,
                state.slopes, scale**4 * uncertainty,
            )  # fmt: skip
    if theta.max() < _LEAST:
        raise DataError("no scatter is left to test with", where="mixed model")
    raise DataError("the variances between persons can't be estimated", where="mixed model")


def _singular(information: np.ndarray) -> bool:
    told = np.sqrt(np.diagonal(information))
    if told.min() < _ALIKE * told.max():
        return True
    return bool(np.linalg.eigvalsh(information / np.outer(told, told))[0] < _ALIKE)


def _distinct(parts: Sequence[np.ndarray], single: bool) -> list[int]:
    """Return the parts that are no sum of later ones; the last is apart where values repeat."""
    last, kept = len(parts) - 1, list[int]()
    for i in range(last - 1, -1, -1):
        others = np.array([parts[j].ravel() for j in (kept if single else [*kept, last])])
        left = part = parts[i].ravel()
        if len(others):
            left = part - others.T @ np.linalg.lstsq(others.T, part, rcond=None)[0]
        if left @ left > _ALIKE * (part @ part):
            kept.insert(0, i)
    return [*kept, last]


@dataclass(frozen=True, slots=True)
class _State:
    """The likelihood at some variances: deviance, slope and information against each of them.

    ``slopes`` and ``bends``: of ``covariance`` against each, and against each two.
    """

    deviance: float
    score: np.ndarray
    expected: np.ndarray
    coefficients: np.ndarray
    covariance: np.ndarray
    slopes: np.ndarray
    bends: np.ndarray

    @classmethod
    def of(
        cls,
        theta: np.ndarray,
        y: np.ndarray,
        x: np.ndarray,
        parts: Sequence[np.ndarray],
        free: float,
        squares: float,
    ) -> Self | None:
        """Return the state, or None where the variances are those of no data."""
        variance = sum(t * part for t, part in zip(theta, parts, strict=True))
        try:
            root = np.linalg.cholesky(variance)
        except np.linalg.LinAlgError:
            return None
        error = theta[-1]
        if np.diagonal(root).min() < _LEAST or (free and error < _LEAST**2):
            return None
        inverse = np.linalg.inv(variance)
        weighed = inverse @ x
        covariance = np.linalg.inv(x.T @ weighed)
        project = inverse - weighed @ covariance @ weighed.T
        rest = project @ y
        pulls = [project @ part for part in parts]
        pushed = np.array([part @ rest for part in parts])
        expected = 0.5 * np.array([[np.sum(a * b.T) for b in pulls] for a in pulls])
        score = 0.5 * (pushed @ rest - [np.trace(pull) for pull in pulls])
        deviance = 2.0 * np.log(np.diagonal(root)).sum() + y @ rest
        deviance -= np.linalg.slogdet(covariance)[1]
        if free:
            deviance += free * np.log(error) + squares / error
            score[-1] += 0.5 * (squares / error - free) / error
            expected[-1, -1] += 0.5 * free / error**2
        bent = weighed @ covariance
        sides = np.array([part @ bent for part in parts])
        slopes = np.einsum("np,knq->kpq", bent, sides)
        bends = np.einsum("knp,lnq->klpq", sides, np.einsum("nm,lmq->lnq", project, sides))
        coefficients = covariance @ (weighed.T @ y)
        return cls(float(deviance), score, expected, coefficients, covariance, slopes, bends)
