"""A limit on the threads of the linear-algebra libraries, and the namespace of an array."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np


@contextmanager
def threads_limited(threads: int) -> Iterator[None]:
    """Keep BLAS and OpenMP of this process at ``threads`` inside the block or decorated function.

    Without it small matrix products take every core there is, whatever the caller asked for, and
    their digits depend on how many those are.
    """
    with _controller().limit(limits=threads):
        yield


def threads_in_use() -> int:
    """Return the number of threads of BLAS and OpenMP of this process."""
    return max((library["num_threads"] for library in _controller().info()), default=1)


@cache
def _controller() -> Any:
    from threadpoolctl import ThreadpoolController

    import_module("scipy.linalg")  # has a BLAS of its own: one that is loaded later has no limit
    return ThreadpoolController()


def namespace(array: Any) -> Any:
    """Return the array-API namespace of an array: NumPy's own for NumPy arrays."""
    if isinstance(array, np.ndarray):
        return np
    from array_api_compat import array_namespace

    return array_namespace(array)


def on_host(array: Any) -> np.ndarray:
    """Return an array of any library and device as one of NumPy: one wait for the device."""
    if isinstance(array, np.ndarray):
        return array
    from array_api_compat import is_array_api_strict_namespace, to_device

    xp = namespace(array)
    if is_array_api_strict_namespace(xp):
        return np.asarray(array.to_device(xp.Device("CPU_DEVICE")))
    return np.asarray(to_device(array, "cpu"))


def converter(like: Any) -> Any:
    """Return the function that brings a NumPy array to the namespace and device of ``like``."""
    if isinstance(like, np.ndarray):
        return np.asarray
    xp = namespace(like)
    return lambda array: xp.asarray(array, device=like.device)
