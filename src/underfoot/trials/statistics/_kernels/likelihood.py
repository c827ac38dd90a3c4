"""Newton ascent of the logistic likelihood, plain or with Firth's penalty."""

from __future__ import annotations

import numpy as np


def log_likelihood(eta: np.ndarray, y: np.ndarray) -> float:
    """Return sum(y eta - log(1 + exp eta))."""
    return float(np.sum(y * eta - np.logaddexp(0.0, eta)))


def information(matrix: np.ndarray, eta: np.ndarray) -> np.ndarray:
    """Return X' diag(p (1 - p)) X, shape (p, p)."""
    p = probability(eta)
    return matrix.T @ ((p * (1.0 - p))[:, None] * matrix)


def probability(eta: np.ndarray) -> np.ndarray:
    """Return 1 / (1 + exp(-eta)) without overflow."""
    return 0.5 * (1.0 + np.tanh(0.5 * eta))


def objective(matrix: np.ndarray, eta: np.ndarray, y: np.ndarray, firth: bool) -> float:
    """Return the log-likelihood, plus half the log-determinant of the information for Firth."""
    value = log_likelihood(eta, y)
    if not firth:
        return value
    sign, logdet = np.linalg.slogdet(information(matrix, eta))
    return value + 0.5 * float(logdet) if sign > 0 else -np.inf


def maximised(
    matrix: np.ndarray,
    y: np.ndarray,
    start: np.ndarray,
    free: np.ndarray,
    firth: bool,
    *,
    steps: int = 200,
    tolerance: float = 1e-10,
) -> tuple[np.ndarray, float, bool]:
    """Return (coefficients, objective, converged); only ``free`` coefficients move.

    Newton steps on the (modified) score with the Fisher information as curvature, at most 5 in
    any scaled coefficient, halved until the objective rises.
    """
    beta = start.copy()
    eta = matrix @ beta
    value = objective(matrix, eta, y, firth)
    for _ in range(steps):
        p = probability(eta)
        weight = p * (1.0 - p)
        curvature = matrix.T @ (weight[:, None] * matrix)
        residual = y - p
        if firth:
            inverse = np.linalg.pinv(curvature)
            leverage = weight * np.einsum("ij,jk,ik->i", matrix, inverse, matrix)
            residual = residual + leverage * (0.5 - p)
        score = matrix[:, free].T @ residual
        step = np.linalg.lstsq(curvature[np.ix_(free, free)], score, rcond=None)[0]
        if np.max(np.abs(step), initial=0.0) > 5.0:
            step *= 5.0 / np.max(np.abs(step))
        scale = 1.0
        for _ in range(40):
            trial = beta.copy()
            trial[free] += scale * step
            trial_eta = matrix @ trial
            trial_value = objective(matrix, trial_eta, y, firth)
            if trial_value >= value - 1e-13 * abs(value):
                break
            scale *= 0.5
        else:
            return beta, value, bool(np.max(np.abs(score), initial=0.0) < 1e-6)
        moved = float(np.max(np.abs(scale * step), initial=0.0))
        beta, eta, value = trial, trial_eta, trial_value
        if moved < tolerance and np.max(np.abs(score), initial=0.0) < 1e-7:
            return beta, value, True
    return beta, value, False
