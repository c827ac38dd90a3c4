"""Eq. 7 of the report, relaxation in one term, fitted to a relaxation curve."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import SourcedValue
from underfoot.material import RelaxationSpectrum, single_exponential_spectrum
from underfoot.material.curves import checked_curve, minimum_on
from underfoot.material.spectrum_fit import Judged

SOURCE = "one-term relaxation (grant report, Eq. 7), least squares fit"


@dataclass(frozen=True, slots=True, eq=False)
class SingleExponentialFit(Judged):
    """Eq. 7 fitted to a relaxation curve; ``quality`` says whether it may be used."""

    spectrum: RelaxationSpectrum
    instantaneous_modulus: SourcedValue
    equilibrium_modulus: SourcedValue
    decay_rate: SourcedValue
    residual: np.ndarray
    """Fitted over measured - 1, (n,)."""

    def __str__(self) -> str:
        advice = "" if self.quality == "good" else "; one term can't follow it: use fit_relaxation"
        return (
            f"one term, {self.quality} (rms {100 * self.rms_residual:.2g} %, largest "
            f"{100 * self.largest_residual:.3g} %){advice}"
        )


def fit_single_exponential(time: ArrayLike, modulus: ArrayLike) -> SingleExponentialFit:
    """Return Eq. 7 fitted by least squares to a relaxation curve.

    The two moduli are linear once beta is fixed: beta is searched over the measured times and
    then refined, so no starting value is needed. Moduli are kept at 0 or above.

    ``time`` s, ascending, above 0; ``modulus`` Pa, above 0; (n,) with n >= 4.

    A decay slower than the test is long, or faster than its first point, is not identified:
    then the uncertainty is left out and the reason given.
    """
    t, y = checked_curve(time, modulus)
    grid = np.linspace(np.log(t[0] / 3.0), np.log(t[-1] * 10.0), 241)
    tau = float(np.exp(minimum_on(grid, lambda x: _moduli(t, y, float(np.exp(x)))[1], 1e-10)))
    (einf, drop), rss = _moduli(t, y, tau)
    errors, reason = _errors(t, y, einf, drop, tau, rss)
    model = einf + drop * np.exp(-t / tau)

    def value(number: float, unit: str, error: float | None) -> SourcedValue:
        return SourcedValue(number, unit, SOURCE, uncertainty=error, reason=reason)

    return SingleExponentialFit(
        single_exponential_spectrum(einf + drop, einf, 1.0 / tau, source=SOURCE),
        value(einf + drop, "Pa", errors[0]),
        value(einf, "Pa", errors[1]),
        value(1.0 / tau, "1/s", errors[2]),
        model / y - 1.0,
    )


def _moduli(t: np.ndarray, y: np.ndarray, tau: float) -> tuple[np.ndarray, float]:
    from scipy.optimize import nnls

    kernel = np.column_stack([np.ones_like(t), np.exp(-t / tau)])
    solution, norm = nnls(kernel, y)
    return solution, float(norm) ** 2


def _errors(
    t: np.ndarray, y: np.ndarray, einf: float, drop: float, tau: float, rss: float
) -> tuple[tuple[float | None, float | None, float | None], str]:
    unknown = (None, None, None)
    if tau > t[-1]:
        return unknown, f"not identified: the decay ({tau:.3g} s) is longer than the test"
    if tau < t[0]:
        return unknown, f"not identified: the decay ({tau:.3g} s) is over before the first reading"
    if einf <= 0.0 or drop <= 0.0:
        return unknown, "not identified: a modulus lies at its bound of zero"
    decay = np.exp(-t / tau)
    # Derivatives by E_0, E_inf and beta.
    jacobian = np.column_stack([decay, 1.0 - decay, -drop * t * decay])
    variance = rss / max(t.size - 3, 1)
    covariance = variance * np.linalg.pinv(jacobian.T @ jacobian)
    e0, e1, e2 = np.sqrt(np.diag(covariance))
    return (float(e0), float(e1), float(e2)), "linearised least squares, independent errors"
