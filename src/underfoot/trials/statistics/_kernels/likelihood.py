"""Newton ascent of the logistic likelihood, plain or with Firth's penalty."""

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
    tolerance: float = 1e-17,
) -> tuple[np.ndarray, float, bool]:
    """Return (coefficients, objective, converged); only ``free`` coefficients move.

    The penalty is that of an orthonormal basis of the columns: another constant than
    ``objective`` of the matrix itself.

    Newton steps on the (modified) score with the Fisher information as curvature, at most 5 in
    any scaled coefficient, halved until the objective rises; settled when a step promises less
    than ``tolerance``, or when rounding hides a promise below 1e-8.
    """
    beta = start.copy()
    eta = matrix @ beta
    # The penalty and the leverages depend on the space of the columns only: an orthonormal basis
    # keeps them exact when the columns are nearly alike.
    basis = np.linalg.qr(matrix)[0]
    value = objective(basis, eta, y, firth)
    for _ in range(steps):
        p = probability(eta)
        weight = p * (1.0 - p)
        curvature = matrix.T @ (weight[:, None] * matrix)
        residual = y - p
        if firth:
            inverse = np.linalg.pinv(basis.T @ (weight[:, None] * basis))
            leverage = weight * np.einsum("ij,jk,ik->i", basis, inverse, basis)
            residual = residual + leverage * (0.5 - p)
        score = matrix[:, free].T @ residual
        step = np.linalg.lstsq(curvature[np.ix_(free, free)], score, rcond=None)[0]
        # Twice the expected rise of the objective: the same in every unit of the predictors.
        gain = float(score @ step)
        if np.max(np.abs(step), initial=0.0) > 5.0:
            step *= 5.0 / np.max(np.abs(step))
        scale = 1.0
        for _ in range(40):
            trial = beta.copy()
            trial[free] += scale * step
            trial_eta = matrix @ trial
            trial_value = objective(basis, trial_eta, y, firth)
            if trial_value >= value - 1e-13 * abs(value):
                break
            scale *= 0.5
        else:
            return beta, value, gain < 1e-8
        beta, eta, value = trial, trial_eta, trial_value
        if gain < tolerance:
            return beta, value, True
    return beta, value, False
