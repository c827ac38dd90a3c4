"""Checks of coefficients of friction."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import InputError, RangeError

LARGEST_ACOF = 5.0


def available(acof: ArrayLike) -> NDArray[np.float64]:
    """Return available friction as an array; refuse what no sole on a floor can have."""
    array = np.asarray(acof, dtype=float)
    if not np.isfinite(array).all():
        raise InputError("a value is not a finite number", where="acof")
    if ((array < 0) | (array > LARGEST_ACOF)).any():
        raise RangeError(
            f"{array.min():g} to {array.max():g}", where="acof", allowed=f"0 to {LARGEST_ACOF:g}"
        )
    return array


def required(rcof: ArrayLike, where: str = "rcof") -> NDArray[np.float64]:
    """Return required friction as an array; refuse what no walking needs."""
    array = np.asarray(rcof, dtype=float)
    if not np.isfinite(array).all():
        raise InputError("a value is not a finite number", where=where)
    if ((array < 0) | (array > 1)).any():
        raise RangeError(f"{array.min():g} to {array.max():g}", where=where, allowed="0 to 1")
    return array


def deviation(value: ArrayLike, where: str) -> NDArray[np.float64]:
    """Return a standard deviation; refuse a negative one."""
    array = np.asarray(value, dtype=float)
    if not np.isfinite(array).all():
        raise InputError("a value is not a finite number", where=where)
    if ((array < 0) | (array > 1)).any():
        raise RangeError(f"{array.min():g} to {array.max():g}", where=where, allowed="0 to 1")
    return array
