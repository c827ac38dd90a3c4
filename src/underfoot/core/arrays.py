"""Names of the array types that the package's signatures use."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Double precision."""
Mask = NDArray[np.bool_]
AnyArray = Any
"""An array of NumPy, or of another library with the array API."""


def scalar_or_array(values: Any) -> Any:
    """Return a float for a zero-dimensional array, else the array: as many as were asked for."""
    return float(values) if np.ndim(values) == 0 else values


def of_python(item: Any) -> Any:
    """Return a value with the scalars and arrays of NumPy in it as numbers and lists of Python."""
    if isinstance(item, np.generic | np.ndarray):
        return item.tolist()
    if isinstance(item, list | tuple):
        return type(item)(map(of_python, item))
    if isinstance(item, Mapping):
        return {key: of_python(below) for key, below in item.items()}
    return item
