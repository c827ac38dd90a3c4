"""Two slips of one person are not two persons: logistic estimating equations with clusters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from underfoot.core import ConvergenceError, DataError

from ._kernels.likelihood import probability
from .logistic import _checked, logistic_regression


@dataclass(frozen=True, slots=True)
class ClusteredCoefficient:
    """Estimate with the sandwich error, its small-sample form, and p from t (clusters - p df)."""

    name: str
    estimate: float
    robust_error: float
    corrected_error: float
    p: float


@dataclass(frozen=True, slots=True)
class ClusteredFit:
    """Population-averaged logistic model with exchangeable working correlation."""

    coefficients: tuple[ClusteredCoefficient, ...]
    correlation: float
    clusters: int
    n: int

    def __getitem__(self, name: str) -> ClusteredCoefficient:
        return next(c for c in self.coefficients if c.name == name)


def clustered_logistic(
    outcome: Sequence[int] | np.ndarray,
    predictors: Mapping[str, Sequence[float] | np.ndarray],
    cluster: Sequence[object],
    *,
    steps: int = 100,
) -> ClusteredFit:
    """Return generalised estimating equations with exchangeable correlation within clusters.

    Errors are the sandwich of Liang and Zeger and its bias-corrected form of Mancl and DeRouen;
    p uses the corrected error and t with (clusters - parameters) degrees of freedom.

    Parameters
    ----------
    outcome, predictors
        As for ``logistic_regression``.
    cluster
        Whom each row belongs to, shape (n,).

    Errors
    ------
    DataError
        Separated data, fewer clusters than needed, lengths differ.
    ConvergenceError
        The estimating equations did not settle.

    Source: K.-Y. Liang, S. L. Zeger, Biometrika 73 (1986) 13; L. A. Mancl, T. A. DeRouen,
    Biometrics 57 (2001) 126.
    """
    from scipy.stats import t as student

    y, matrix, names = _checked(outcome, predictors)
    labels = [str(c) for c in cluster]
    if len(labels) != len(y):
        raise DataError("one cluster label per row is needed", where="cluster")
    order = list(dict.fromkeys(labels))
    groups = [np.flatnonzero([x == label for x in labels]) for label in order]
    p = matrix.shape[1]
    if len(groups) <= p + 1:
        raise DataError(
            f"{len(groups)} clusters for {p} parameters", where="cluster", allowed="more clusters"
        )
    # Refuses separated data with its own message.
    beta = logistic_regression(y.astype(int), dict(predictors)).estimates
    scale = np.concatenate(([1.0], matrix[:, 1:].std(axis=0)))
    centre = np.concatenate(([0.0], matrix[:, 1:].mean(axis=0)))
    work = (matrix - centre) / scale
    gamma = beta * scale
    gamma[0] = beta[0] + float(np.sum(centre[1:] * beta[1:]))
    alpha = 0.0
    for _ in range(steps):
        alpha = _correlation(work, y, gamma, groups)
        bread, score = np.zeros((p, p)), np.zeros(p)
        for rows in groups:
            derivative, inverse, residual = _pieces(work, y, gamma, alpha, rows)
            bread += derivative.T @ inverse @ derivative
            score += derivative.T @ inverse @ residual
        move = np.linalg.solve(bread, score)
        gamma = gamma + move
        if np.max(np.abs(move)) < 1e-10:
            break
    else:
        raise ConvergenceError("the estimating equations did not settle", where="clusters")
    alpha = _correlation(work, y, gamma, groups)
    bread = np.zeros((p, p))
    for rows in groups:
        derivative, inverse, _ = _pieces(work, y, gamma, alpha, rows)
        bread += derivative.T @ inverse @ derivative
    outer = np.linalg.inv(bread)
    plain, corrected = np.zeros((p, p)), np.zeros((p, p))
    for rows in groups:
        derivative, inverse, residual = _pieces(work, y, gamma, alpha, rows)
        leverage = derivative @ outer @ derivative.T @ inverse
        u = derivative.T @ inverse @ residual
        v = derivative.T @ inverse @ np.linalg.solve(np.eye(len(rows)) - leverage, residual)
        plain += np.outer(u, u)
        corrected += np.outer(v, v)
    back = np.diag(1.0 / scale)
    back[0, 1:] = -centre[1:] / scale[1:]
    estimates = back @ gamma
    robust = np.sqrt(np.diag(back @ outer @ plain @ outer @ back.T))
    small = np.sqrt(np.diag(back @ outer @ corrected @ outer @ back.T))
    df = len(groups) - p
    found = tuple(
        ClusteredCoefficient(
            name,
            float(estimates[j]),
            float(robust[j]),
            float(small[j]),
            2.0 * float(student.sf(abs(estimates[j]) / small[j], df)),
        )
        for j, name in enumerate(names)
    )
    return ClusteredFit(found, alpha, len(groups), len(y))


def _pieces(
    matrix: np.ndarray, y: np.ndarray, beta: np.ndarray, alpha: float, rows: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return d mean / d beta, the inverse working covariance and the residual of one cluster."""
    mean = probability(matrix[rows] @ beta)
    weight = mean * (1.0 - mean)
    sd = np.sqrt(weight)
    correlation = np.full((len(rows), len(rows)), alpha)
    np.fill_diagonal(correlation, 1.0)
    covariance = sd[:, None] * correlation * sd[None, :]
    return weight[:, None] * matrix[rows], np.linalg.inv(covariance), y[rows] - mean


def _correlation(
    matrix: np.ndarray, y: np.ndarray, beta: np.ndarray, groups: list[np.ndarray]
) -> float:
    """Return the moment estimate of the exchangeable correlation, with estimated dispersion."""
    mean = probability(matrix @ beta)
    pearson = (y - mean) / np.sqrt(mean * (1.0 - mean))
    pairs, total = 0.0, 0.0
    for rows in groups:
        r = pearson[rows]
        total += (r.sum() ** 2 - np.sum(r**2)) / 2.0
        pairs += len(rows) * (len(rows) - 1) / 2.0
    if pairs <= len(beta):
        return 0.0
    largest = max(len(rows) for rows in groups)
    low = -1.0 / (largest - 1) * 0.99 if largest > 1 else 0.0
    dispersion = float(np.sum(pearson**2)) / (len(y) - len(beta))
    return float(np.clip(total / dispersion / (pairs - len(beta)), low, 0.99))
