"""How the shift factor depends on temperature: Williams-Landel-Ferry and Arrhenius."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, RangeError
from underfoot.core.arrays import scalar_or_array

GAS_CONSTANT = 8.314462618
"""J/(mol K), CODATA 2018."""


@dataclass(frozen=True, slots=True)
class WlfShift:
    """log10 a_T = -C1 (T - T_ref) / (C2 + T - T_ref) (Williams, Landel, Ferry 1955).

    ``c1`` (1), ``c2`` (K), ``reference_temperature`` (K); ``rms`` is the residual in decades of
    the fit that gave it (NaN when given directly); ``tested`` the temperatures it was fitted on.
    """

    c1: float
    c2: float
    reference_temperature: float
    rms: float = float("nan")
    tested: tuple[float, float] | None = None

    def log10_shift_factor(self, temperature: ArrayLike) -> Any:
        """Return log10 a_T for temperatures in K, any shape.

        Raises:
            RangeError: At or below T_ref - C2, where the law has its pole.
        """
        away = np.asarray(temperature, dtype=float) - self.reference_temperature
        if not np.all(self.c2 + away > 0.0):
            raise RangeError(
                f"temperature {np.min(temperature):g} K",
                where="temperature",
                allowed=f"above {self.reference_temperature - self.c2:g} K, the pole of this WLF",
            )
        return scalar_or_array(-self.c1 * away / (self.c2 + away))

    def shift_factor(self, temperature: ArrayLike) -> Any:
        """Return a_T: times at T are a_T times those at the reference temperature."""
        return scalar_or_array(10.0 ** np.asarray(self.log10_shift_factor(temperature)))

    def __str__(self) -> str:
        return f"WLF C1 {self.c1:.4g}, C2 {self.c2:.4g} K, residual {self.rms:.2g} decades"


@dataclass(frozen=True, slots=True)
class ArrheniusShift:
    """ln a_T = E_a / R (1/T - 1/T_ref); ``activation_energy`` in J/mol."""

    activation_energy: float
    reference_temperature: float
    rms: float = float("nan")
    tested: tuple[float, float] | None = None

    def log10_shift_factor(self, temperature: ArrayLike) -> Any:
        """Return log10 a_T for temperatures in K, any shape, above 0."""
        t = np.asarray(temperature, dtype=float)
        if not np.all(t > 0.0):
            raise RangeError(
                f"temperature {np.min(t):g} K", where="temperature", allowed="above 0 K"
            )
        factor = self.activation_energy / (GAS_CONSTANT * np.log(10.0))
        return scalar_or_array(factor * (1.0 / t - 1.0 / self.reference_temperature))

    def shift_factor(self, temperature: ArrayLike) -> Any:
        """Return a_T: times at T are a_T times those at the reference temperature."""
        return scalar_or_array(10.0 ** np.asarray(self.log10_shift_factor(temperature)))

    def __str__(self) -> str:
        return (
            f"Arrhenius {self.activation_energy / 1e3:.4g} kJ/mol, residual {self.rms:.2g} decades"
        )


def fit_wlf(
    temperatures: ArrayLike, log10_shift_factors: ArrayLike, reference_temperature: float
) -> WlfShift:
    """Return the WLF law through measured shift factors, by least squares in decades.

    ``temperatures`` K and ``log10_shift_factors`` (n,), n >= 3. C2 is searched over a grid (C1 is
    linear once C2 is fixed) and refined, so no starting value is needed.
    """
    from scipy.optimize import minimize_scalar

    t, shifts = _checked(temperatures, log10_shift_factors, 3)
    away = t - reference_temperature
    lowest = max(-float(away.min()), 0.0)

    def solved(log_margin: float) -> tuple[float, float, float]:
        c2 = lowest + float(np.exp(log_margin))
        shape = -away / (c2 + away)
        c1 = float(shape @ shifts / (shape @ shape))
        return float(np.sum((c1 * shape - shifts) ** 2)), c1, c2

    grid = np.linspace(np.log(1.0), np.log(3000.0), 200)
    best = int(np.argmin([solved(float(g))[0] for g in grid]))
    bounds = (grid[max(best - 1, 0)], grid[min(best + 1, grid.size - 1)])
    optimum: Any = minimize_scalar(
        lambda g: solved(float(g))[0], bounds=bounds, method="bounded", options={"xatol": 1e-10}
    )
    cost, c1, c2 = solved(float(optimum.x))
    tested = (float(t.min()), float(t.max()))
    return WlfShift(c1, c2, float(reference_temperature), float(np.sqrt(cost / t.size)), tested)


def fit_arrhenius(
    temperatures: ArrayLike, log10_shift_factors: ArrayLike, reference_temperature: float
) -> ArrheniusShift:
    """Return the Arrhenius law through measured shift factors, by least squares in decades.

    ``temperatures`` K and ``log10_shift_factors`` (n,), n >= 2.
    """
    t, shifts = _checked(temperatures, log10_shift_factors, 2)
    inverse = (1.0 / t - 1.0 / reference_temperature) / (GAS_CONSTANT * np.log(10.0))
    energy = float(inverse @ shifts / (inverse @ inverse))
    rms = float(np.sqrt(np.mean((energy * inverse - shifts) ** 2)))
    tested = (float(t.min()), float(t.max()))
    return ArrheniusShift(energy, float(reference_temperature), rms, tested)


def _checked(
    temperatures: ArrayLike, shifts: ArrayLike, least: int
) -> tuple[np.ndarray, np.ndarray]:
    t, s = np.asarray(temperatures, dtype=float), np.asarray(shifts, dtype=float)
    if t.ndim != 1 or t.shape != s.shape or np.unique(t).size < least:
        raise DataError(
            f"{t.size} temperatures and {s.size} shift factors",
            where="shift factors",
            allowed=f"the same number of each, {least} different temperatures or more",
        )
    if not (np.all(np.isfinite(t)) and np.all(np.isfinite(s)) and np.all(t > 0.0)):
        raise DataError(
            "a temperature or shift factor is missing", where="shift factors", allowed="kelvin"
        )
    return t, s
