"""Slip risk against friction: logistic curves with confidence bands."""

from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError

from .statistics import ClusteredFit, LogisticFit


@dataclass(frozen=True, slots=True)
class LogisticLine:
    """p(x) = 1 / (1 + exp(-(intercept + slope x))) given by two published numbers."""

    intercept: float
    slope: float
    source: str = ""

    def probability(self, x: float | np.ndarray) -> np.ndarray:
        """Return the slip probability at ``x``."""
        return 0.5 * (1.0 + np.tanh(0.5 * (self.intercept + self.slope * np.asarray(x, float))))

    def at_probability(self, probability: float) -> float:
        """Return the x at which the risk equals ``probability``."""
        _between(probability)
        return float((np.log(probability / (1.0 - probability)) - self.intercept) / self.slope)


@dataclass(frozen=True, slots=True)
class RiskCurve:
    """A fitted risk curve on a grid, with its band.

    ``x``, ``risk``, ``low``, ``high``: shape (m,). ``half``: x at a risk of one half, and its
    standard error (delta method).
    """

    name: str
    x: np.ndarray
    risk: np.ndarray
    low: np.ndarray
    high: np.ndarray
    half: float
    half_error: float
    method: str
    confidence: float


def risk_curve(
    fit: LogisticFit | ClusteredFit, x: np.ndarray | None = None, *, confidence: float = 0.95
) -> RiskCurve:
    """Return the risk curve of a logistic fit with one predictor, with a pointwise band.

    The band is symmetric on the logit: eta +- z sqrt(var(b0) + 2 x cov + x^2 var(b1)). It covers
    the curve, not single persons. With errors by person (``clustered_logistic``) it is as wide as
    the number of persons asks for.

    ``x``: where to evaluate, shape (m,); by default where the risk runs from 0.5 % to 99.5 %.

    InputError: a fit with several predictors, or a slope of zero.
    """
    from scipy.stats import norm

    if len(fit.coefficients) != 2:
        raise InputError(
            f"{len(fit.coefficients) - 1} predictors", where="risk_curve", allowed="one"
        )
    _between(confidence)
    b0, b1 = fit.estimates
    if b1 == 0:
        raise InputError("the slope is zero", where="risk_curve")
    line = LogisticLine(float(b0), float(b1))
    if x is None:
        ends = sorted((line.at_probability(0.005), line.at_probability(0.995)))
        x = np.linspace(ends[0], ends[1], 201)
    x = np.asarray(x, dtype=float)
    rows = np.column_stack((np.ones_like(x), x))
    error = np.sqrt(np.einsum("ij,jk,ik->i", rows, fit.covariance, rows))
    eta = b0 + b1 * x
    z = float(norm.ppf(0.5 + confidence / 2))
    half = float(-b0 / b1)
    gradient = np.array([-1.0 / b1, b0 / b1**2])
    half_error = float(np.sqrt(gradient @ fit.covariance @ gradient))
    risk, low, high = (
        0.5 * (1.0 + np.tanh(0.5 * value)) for value in (eta, eta - z * error, eta + z * error)
    )
    name = fit.coefficients[1].name
    return RiskCurve(name, x, risk, low, high, half, half_error, fit.method, confidence)


def _between(value: float) -> None:
    if not 0.0 < value < 1.0:
        raise InputError(f"{value} is not a probability", where="risk", allowed="between 0 and 1")
