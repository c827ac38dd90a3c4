"""Measured curves: relaxation and dynamic sweeps, and what is wrong with them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError


@dataclass(frozen=True, slots=True, eq=False)
class RelaxationCurve:
    """Relaxation modulus at one temperature: ``time`` (s), ``modulus`` (Pa), temperature (K)."""

    time: np.ndarray
    modulus: np.ndarray
    temperature: float | None = None
    source: str = ""

    def __post_init__(self) -> None:
        time, modulus = checked_curve(self.time, self.modulus)
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "modulus", modulus)
        check_temperature(self.temperature)


@dataclass(frozen=True, slots=True, eq=False)
class DynamicSweep:
    """E' and E'' (Pa) against angular frequency (rad/s) at one temperature (K)."""

    angular_frequency: np.ndarray
    storage_modulus: np.ndarray
    loss_modulus: np.ndarray
    temperature: float | None = None
    source: str = ""

    def __post_init__(self) -> None:
        w, storage = checked_curve(
            self.angular_frequency, self.storage_modulus, quantity="storage modulus"
        )
        _, loss = checked_curve(self.angular_frequency, self.loss_modulus, quantity="loss modulus")
        object.__setattr__(self, "angular_frequency", w)
        object.__setattr__(self, "storage_modulus", storage)
        object.__setattr__(self, "loss_modulus", loss)
        check_temperature(self.temperature)


def checked_curve(
    abscissa: ArrayLike, values: ArrayLike, *, quantity: str = "relaxation modulus"
) -> tuple[np.ndarray, np.ndarray]:
    """Return time or frequency ascending with the values; refuse what can't be a measurement.

    A time has to ascend as given; frequencies (sweeps run both ways) are sorted.
    """
    x, y = np.asarray(abscissa, dtype=float), np.asarray(values, dtype=float)
    axis = "time" if quantity == "relaxation modulus" else "angular frequency"
    if x.ndim != 1 or x.shape != y.shape:
        raise DataError(
            f"{axis} of shape {x.shape} and {quantity} of shape {y.shape}",
            where=quantity,
            allowed="two one-dimensional arrays of the same length",
        )
    if x.size < 4:
        raise DataError(f"{x.size} points", where=quantity, allowed="four points or more")
    for name, array in ((axis, x), (quantity, y)):
        missing = np.flatnonzero(~np.isfinite(array))
        if missing.size:
            raise DataError(
                f"{missing.size} of {array.size} values are missing, the first at row "
                f"{missing[0] + 1}",
                where=name,
                remedy="Remove the rows, or repair them at their source",
            )
        wrong = np.flatnonzero(array <= 0.0)
        if wrong.size:
            raise DataError(
                f"row {wrong[0] + 1} is {array[wrong[0]]:g}",
                where=name,
                allowed="values above 0",
                remedy="Leave out the start (t = 0) and readings below the instrument's noise",
            )
    if axis == "time":
        falling = np.flatnonzero(np.diff(x) <= 0.0)
        if falling.size:
            i = int(falling[0])
            raise DataError(
                f"time goes from {x[i]:g} s to {x[i + 1]:g} s at row {i + 2}",
                where="time",
                allowed="ascending times",
                remedy="Sort the rows, and keep only one of two readings at the same time",
            )
        return x.copy(), y.copy()
    order = np.argsort(x, kind="stable")
    return x[order], y[order]


def check_temperature(temperature: float | None) -> None:
    """Refuse a temperature that is not one in kelvin."""
    if temperature is not None and not (np.isfinite(temperature) and temperature > 0.0):
        raise DataError(
            f"temperature {temperature:g} K", where="temperature", allowed="kelvin, above 0 K"
        )
