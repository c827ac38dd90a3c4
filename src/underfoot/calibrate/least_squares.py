"""Parameters of a model from data by least squares, with intervals and what is not identified."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import ConvergenceError, DataError, InputError, SourcedValue
from underfoot.core.remark import Message


@dataclass(frozen=True, slots=True)
class Parameter:
    """One unknown: where the search starts and what it may be.

    ``logarithmic`` searches its logarithm, for positive scales known only in magnitude.
    """

    start: float
    low: float
    high: float
    unit: str = "1"
    logarithmic: bool = False

    def __post_init__(self) -> None:
        if not (self.low < self.start < self.high):
            raise InputError(
                f"{self.start:g}",
                where="start",
                allowed=Message("within {low:g} to {high:g}", low=self.low, high=self.high),
            )
        if self.logarithmic and not self.low > 0:
            raise InputError(f"{self.low:g}", where="low", allowed="above 0 when logarithmic")


@dataclass(frozen=True, slots=True)
class Calibration:
    """Fitted parameters and how well the model then holds.

    ``residuals``: model minus data, of the data's shape, not weighted. ``deviation``: their root
    mean square with the parameters counted (n - k), the model's error on its own data.
    ``mean_absolute_error``: their mean magnitude. ``at_bound``: parameters that stopped at a limit.
    """

    parameters: Mapping[str, SourcedValue]
    residuals: NDArray[np.float64]
    deviation: float
    at_bound: tuple[str, ...] = ()
    covariance: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0)))

    @property
    def values(self) -> dict[str, float]:
        """The numbers alone."""
        return {name: float(given) for name, given in self.parameters.items()}

    @property
    def mean_absolute_error(self) -> float:
        """Mean magnitude of the residuals, in the data's unit."""
        return float(np.mean(np.abs(self.residuals)))


def calibrate_model(
    model: Callable[[Mapping[str, float]], ArrayLike],
    data: ArrayLike,
    parameters: Mapping[str, Parameter],
    *,
    deviation: ArrayLike | None = None,
    source: str = "",
) -> Calibration:
    """Return the parameters with which ``model`` comes nearest to ``data`` (least squares).

    Standard deviations are those of the linearised problem: with ``deviation`` given (the data's
    standard deviations) from it, else from the residuals. A parameter at its limit has none. A
    parameter that the data do not determine is "not estimated", never a number alone.

    Parameters:
        model: Of a mapping name -> number; returns an array of the shape of ``data``.
        data: Any shape, finite, at least as many as parameters.
        deviation: Standard deviations of the data, > 0, broadcast; they weight the residuals.
        source: For the values that come out.

    Errors:
        DataError: Too few data or data that are not finite.
        ConvergenceError: The search did not end.
    """
    from scipy.optimize import least_squares

    observed = np.asarray(data, dtype=float)
    if observed.size < len(parameters) or not np.isfinite(observed).all():
        raise DataError(
            Message(
                "{size} values for {count} parameters", size=observed.size, count=len(parameters)
            ),
            where="calibrated",
            allowed="finite values, at least as many as parameters",
        )
    weight = 1.0 if deviation is None else 1.0 / np.asarray(deviation, dtype=float)
    names = list(parameters)
    scales = [_Scale(parameters[name]) for name in names]

    def values(point: NDArray[np.float64]) -> dict[str, float]:
        return {n: s.value(x) for n, s, x in zip(names, scales, point, strict=True)}

    def misfit(point: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.ravel((np.asarray(model(values(point)), dtype=float) - observed) * weight)

    found = least_squares(
        misfit,
        [s.start for s in scales],
        bounds=([s.low for s in scales], [s.high for s in scales]),
        x_scale=[s.step for s in scales],
        xtol=1e-12,
        ftol=1e-12,
        gtol=1e-12,
        max_nfev=2000,
    )
    if found.status == 0:
        raise ConvergenceError(
            Message("no end after {nfev} evaluations", nfev=found.nfev),
            where="calibrated",
            history=[found.cost],
        )
    best = values(found.x)
    residuals = np.asarray(model(best), dtype=float) - observed
    freedom = observed.size - len(names)
    noise = 1.0 if deviation is not None else 2 * found.cost / max(freedom, 1)
    bound = tuple(
        name
        for name, scale, x in zip(names, scales, found.x, strict=True)
        if min(x - scale.low, scale.high - x) < 1e-6 * (scale.high - scale.low)
    )
    covariance = _covariance(found.jac, [n in bound for n in names])
    covariance = np.where(np.isfinite(covariance), covariance * max(noise, 1e-300), np.inf)
    results = {}
    for index, (name, scale) in enumerate(zip(names, scales, strict=True)):
        spread = float(covariance[index, index]) ** 0.5 * scale.slope(found.x[index])
        known = math.isfinite(spread) and freedom > 0 and name not in bound
        reason = "" if known else "at the limit of its range" if name in bound else "not identified"
        results[name] = SourcedValue(
            best[name],
            parameters[name].unit,
            source=source or "least squares",
            uncertainty=spread if known else None,
            reason=reason,
        )
    rms = math.sqrt(float(np.sum(residuals**2)) / max(freedom, 1))
    return Calibration(results, residuals, rms, bound, covariance)


class _Scale:
    """One parameter on the axis on which it is searched."""

    def __init__(self, given: Parameter) -> None:
        self.logarithmic = given.logarithmic
        self.start, self.low, self.high = (
            math.log(x) if given.logarithmic else x for x in (given.start, given.low, given.high)
        )
        self.step = (
            1.0 if given.logarithmic else max(abs(given.start), 1e-3 * (given.high - given.low))
        )

    def value(self, point: float) -> float:
        return float(math.exp(point) if self.logarithmic else point)

    def slope(self, point: float) -> float:
        return self.value(point) if self.logarithmic else 1.0


def _covariance(jacobian: NDArray[np.float64], fixed: list[bool]) -> NDArray[np.float64]:
    """Return (J^T J)^-1 of the free parameters; infinite where the data do not determine one."""
    count = jacobian.shape[1]
    free = [i for i in range(count) if not fixed[i]]
    full = np.full((count, count), np.inf)
    if not free:
        return full
    columns = jacobian[:, free]
    size = np.linalg.norm(columns, axis=0)
    if np.any(size == 0):
        return full
    normal = (columns / size).T @ (columns / size)
    if np.linalg.cond(normal) > 1e12:
        return full
    full[np.ix_(free, free)] = np.linalg.inv(normal) / np.outer(size, size)
    return full
