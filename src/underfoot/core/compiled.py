"""Compiled kernels where numba is installed; apart, because its import takes a while."""

from collections.abc import Callable
from typing import Any

try:
    from numba import njit
except ImportError:

    def njit(*_: Any, **__: Any) -> Callable[[Any], Any]:
        """Leave a kernel as it is where numba is not installed: the same numbers, slower."""
        return lambda function: function


__all__ = ["njit"]
