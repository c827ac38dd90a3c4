"""Intel's Math Kernel Library, where it is installed: found once, called through ctypes."""

from __future__ import annotations

import ctypes
from ctypes.util import find_library
from functools import cache
from importlib import metadata


@cache
def mkl_library() -> ctypes.CDLL | None:
    """Return MKL's run-time library, or None where it is not installed.

    The sparse direct solver and the Fourier transforms of the program run several times faster
    with it; everything works without.
    """
    candidates: list[str] = []
    try:
        files = metadata.files("mkl") or []
        candidates += [str(file.locate()) for file in files if "mkl_rt" in file.name]
    except metadata.PackageNotFoundError:
        pass
    system = find_library("mkl_rt") if not candidates else None
    for path in (*candidates, *([system] if system else [])):
        try:
            loaded = ctypes.CDLL(path)
            _ = loaded.pardiso, loaded.DftiCreateDescriptor
        except (OSError, AttributeError):
            continue
        loaded.pardiso.restype = None
        loaded.DftiErrorMessage.restype = ctypes.c_char_p
        return loaded
    return None
