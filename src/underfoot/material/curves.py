"""Measured curves: relaxation and dynamic sweeps, and what is wrong with them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError
from underfoot.core.remark import Message


@dataclass(frozen=True, slots=True, eq=False)
class RelaxationCurve:
    """Relaxation modulus at one temperature: ``time`` (s), ``modulus`` (Pa), temperature (K)."""

    time: np.ndarray
    modulus: np.ndarray
    temperature: float | None = None
    source: str = ""

    def __post_init__(self) -> None:
        _settle(self, "time", modulus="relaxation modulus")


@dataclass(frozen=True, slots=True, eq=False)
class DynamicSweep:
    """E' and E'' (Pa) against angular frequency (rad/s) at one temperature (K)."""

    angular_frequency: np.ndarray
    storage_modulus: np.ndarray
    loss_modulus: np.ndarray
    temperature: float | None = None
    source: str = ""

    def __post_init__(self) -> None:
        quantities = {"storage_modulus": "storage modulus", "loss_modulus": "loss modulus"}
        _settle(self, "angular_frequency", **quantities)


def _settle(curve: Any, axis: str, **quantities: str) -> None:
    """Store the checked columns of a curve; refuse a temperature that is not one in kelvin."""
    given = getattr(curve, axis)
    for name, quantity in quantities.items():
        # a multi-frequency ramp has three frequencies at a temperature: enough beside others
        fewest = 4 if axis == "time" else 3
        x, values = checked_curve(given, getattr(curve, name), quantity=quantity, fewest=fewest)
        object.__setattr__(curve, axis, x)
        object.__setattr__(curve, name, values)
    kelvin = curve.temperature
    if kelvin is not None and not (np.isfinite(kelvin) and kelvin > 0.0):
        raise DataError(
            Message("temperature {temperature:g} K", temperature=kelvin),
            where="temperature",
            allowed="kelvin, above 0 K",
        )


def checked_curve(
    abscissa: ArrayLike,
    values: ArrayLike,
    *,
    quantity: str = "relaxation modulus",
    fewest: int = 4,
) -> tuple[np.ndarray, np.ndarray]:
    """Return time or frequency ascending with the values; refuse what can't be a measurement.

    A time has to ascend as given; frequencies (sweeps run both ways) are sorted.
    """
    x, y = np.asarray(abscissa, dtype=float), np.asarray(values, dtype=float)
    axis = "time" if quantity == "relaxation modulus" else "angular frequency"
    if x.ndim != 1 or x.shape != y.shape:
        raise DataError(
            Message(
                "{axis} of shape {shape} and {quantity} of shape {other}",
                axis=axis,
                shape=str(x.shape),
                quantity=quantity,
                other=str(y.shape),
            ),
            where=quantity,
            allowed="two one-dimensional arrays of the same length",
        )
    if x.size < fewest:
        words = {3: "three", 4: "four"}[fewest]
        raise DataError(
            Message("{size} points", size=x.size),
            where=quantity,
            allowed=Message("{wording} points or more", wording=words),
        )
    for name, array in ((axis, x), (quantity, y)):
        missing = np.flatnonzero(~np.isfinite(array))
        if missing.size:
            raise DataError(
                Message(
                    "{size} of {array_size} values are missing, the first at row {missing}",
                    size=missing.size,
                    array_size=array.size,
                    missing=missing[0] + 1,
                ),
                where=name,
                remedy="Remove the rows, or repair them at their source",
            )
        wrong = np.flatnonzero(array <= 0.0)
        if wrong.size:
            raise DataError(
                Message("row {wrong} is {array:g}", wrong=wrong[0] + 1, array=array[wrong[0]]),
                where=name,
                allowed="values above 0",
                remedy="Leave out the start (t = 0) and readings below the instrument's noise",
            )
    if axis == "time":
        falling = np.flatnonzero(np.diff(x) <= 0.0)
        if falling.size:
            i = int(falling[0])
            raise DataError(
                Message(
                    "time goes from {before:g} s to {after:g} s at row {row}",
                    before=x[i],
                    after=x[i + 1],
                    row=i + 2,
                ),
                where="time",
                allowed="ascending times",
                remedy="Sort the rows, and keep only one of two readings at the same time",
            )
        return x.copy(), y.copy()
    order = np.argsort(x, kind="stable")
    return x[order], y[order]


def minimum_on(grid: np.ndarray, cost: Callable[[float], float], tolerance: float) -> float:
    """Return where ``cost`` is least: on the grid, then refined between the neighbours there."""
    from scipy.optimize import minimize_scalar

    best = int(np.argmin([cost(float(x)) for x in grid]))
    bounds = (grid[max(best - 1, 0)], grid[min(best + 1, grid.size - 1)])
    options = {"xatol": tolerance}
    optimum: Any = minimize_scalar(cost, bounds=bounds, method="bounded", options=options)
    return float(optimum.x)
