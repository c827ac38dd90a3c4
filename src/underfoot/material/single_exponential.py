"""One-term relaxation: Eq. 7 of the grant report, and its fit."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError, SourcedValue

from .curves import checked_curve
from .spectrum import RelaxationSpectrum
from .spectrum_fit import quality

SOURCE = "one-term relaxation (grant report, Eq. 7), least squares fit"


def single_exponential_spectrum(
    instantaneous_modulus: float, equilibrium_modulus: float, decay_rate: float, *, source: str = ""
) -> RelaxationSpectrum:
    """Return G(t) = G_inf + (G_0 - G_inf) exp(-beta t) as a spectrum of one term (Eq. 7).

    Moduli in Pa (E or G, the spectrum is of the same kind), ``decay_rate`` beta in 1/s.
    """
    if not (np.isfinite(decay_rate) and decay_rate > 0.0):
        raise InputError(
            f"decay rate {decay_rate:g} 1/s", where="decay_rate", allowed="above 0 1/s"
        )
    if not instantaneous_modulus >= equilibrium_modulus:
        raise InputError(
            f"instantaneous modulus {instantaneous_modulus:g} Pa below the equilibrium modulus "
            f"{equilibrium_modulus:g} Pa",
            where="instantaneous_modulus",
            remedy="A passive material relaxes: check whether the two were exchanged",
        )
    return RelaxationSpectrum(
        equilibrium_modulus,
        np.array([instantaneous_modulus - equilibrium_modulus]),
        np.array([1.0 / decay_rate]),
        source=source,
    )


@dataclass(frozen=True, slots=True, eq=False)
class SingleExponentialFit:
    """Eq. 7 fitted to a relaxation curve; ``quality`` says whether it may be used."""

    spectrum: RelaxationSpectrum
    instantaneous_modulus: SourcedValue
    equilibrium_modulus: SourcedValue
    decay_rate: SourcedValue
    residual: np.ndarray
    """Fitted over measured - 1, (n,)."""

    @property
    def rms_residual(self) -> float:
        """Root mean square of the relative residuals."""
        return float(np.sqrt(np.mean(self.residual**2)))

    @property
    def largest_residual(self) -> float:
        """Largest relative residual."""
        return float(np.max(np.abs(self.residual)))

    @property
    def quality(self) -> str:
        """Return "good" (rms residual up to 5 %), "rough" (up to 20 %) or "bad"."""
        return quality(self.rms_residual)

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
    from scipy.optimize import minimize_scalar

    t, y = checked_curve(time, modulus)
    grid = np.linspace(np.log(t[0] / 3.0), np.log(t[-1] * 10.0), 241)
    cost = np.array([_moduli(t, y, tau)[1] for tau in np.exp(grid)])
    best = int(np.argmin(cost))
    low, high = grid[max(best - 1, 0)], grid[min(best + 1, grid.size - 1)]
    optimum: Any = minimize_scalar(
        lambda x: _moduli(t, y, float(np.exp(x)))[1],
        bounds=(low, high),
        method="bounded",
        options={"xatol": 1e-10},
    )
    tau = float(np.exp(optimum.x))
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
