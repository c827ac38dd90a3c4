"""Checks shared by the closures of the film."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import InputError


def positive(value: ArrayLike, where: str, *, zero: bool = False) -> NDArray[np.float64]:
    """Return ``value`` as an array of finite numbers above 0 (with ``zero``: 0 too)."""
    array = np.asarray(value, dtype=float)
    good = np.isfinite(array) & ((array >= 0) if zero else (array > 0))
    if array.size == 0 or not good.all():
        shown = array[~good].flat[0] if array.size else "nothing"
        raise InputError(
            f"{shown} is not a finite number {'of 0 or more' if zero else 'above 0'}",
            where=where,
            allowed="0 or more, in SI" if zero else "above 0, in SI",
        )
    return array
