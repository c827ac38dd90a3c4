"""Names of the array types that the package's signatures use."""

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
