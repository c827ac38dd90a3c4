"""A limit on the threads of the linear-algebra libraries, and the namespace of an array."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

import numpy as np


@contextmanager
def threads_limited(threads: int) -> Iterator[None]:
    """Keep BLAS and OpenMP of this process at ``threads`` inside the block.

    Without it small matrix products take every core there is, whatever the caller asked for.
    """
    with _controller().limit(limits=threads):
        yield


@cache
def _controller() -> Any:
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()


def namespace(array: Any) -> Any:
    """Return the array-API namespace of an array: NumPy's own for NumPy arrays."""
    if isinstance(array, np.ndarray):
        return np
    from array_api_compat import array_namespace

    return array_namespace(array)


def converter(like: Any) -> Any:
    """Return the function that brings a NumPy array to the namespace and device of ``like``."""
    if isinstance(like, np.ndarray):
        return np.asarray
    xp = namespace(like)
    return lambda array: xp.asarray(array, device=like.device)
