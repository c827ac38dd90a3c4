"""Real two-dimensional Fourier transforms: MKL's where it is installed, else SciPy's.

The variable ``UNDERFOOT_FFT`` of the environment ("mkl" or "scipy") chooses one for a whole run.
"""

from __future__ import annotations

import os
from typing import Any, Protocol

import numpy as np

from .arrays import AnyArray
from .errors import MissingExtraError, unknown_name
from .mkl import MklTransform, mkl_library

LIBRARIES = ("mkl", "scipy")
VARIABLE = "UNDERFOOT_FFT"


class Transform(Protocol):
    """Real FFT of one shape and precision; results may live in buffers that the next call reuses.

    ``forward`` gives the half spectrum over axis 1, ``backward`` the real field. Both may be
    overwritten by the caller and by the next call of the same method.
    """

    def forward(self, field: AnyArray) -> AnyArray:
        """Return the half spectrum of a real field."""
        ...

    def backward(self, spectrum: AnyArray) -> AnyArray:
        """Return the real field of a half spectrum."""
        ...


class ScipyTransform:
    """SciPy's transforms of NumPy arrays with a number of threads."""

    def __init__(self, shape: tuple[int, int], threads: int = 1) -> None:
        from scipy import fft

        self.shape = shape
        self.threads = threads
        self._fft: Any = fft

    def forward(self, field: AnyArray) -> AnyArray:
        """Return the half spectrum of a real field."""
        return self._fft.rfft2(field, workers=self.threads)

    def backward(self, spectrum: AnyArray) -> AnyArray:
        """Return the real field of a half spectrum."""
        return self._fft.irfft2(spectrum, s=self.shape, workers=self.threads, overwrite_x=True)


class NamespaceTransform:
    """The transforms of an array-API namespace, for arrays that are not NumPy's."""

    def __init__(self, shape: tuple[int, int], xp: Any) -> None:
        self.shape = shape
        self._fft = xp.fft

    def forward(self, field: AnyArray) -> AnyArray:
        """Return the half spectrum of a real field."""
        return self._fft.rfftn(field, axes=(0, 1))

    def backward(self, spectrum: AnyArray) -> AnyArray:
        """Return the real field of a half spectrum."""
        return self._fft.irfftn(spectrum, s=self.shape, axes=(0, 1))


def fourier_library(name: str = "auto") -> str:
    """Return the library in use: ``name``, for "auto" ``UNDERFOOT_FFT``, else the fastest.

    Raises
    ------
    InputError
        An unknown name.
    MissingExtraError
        MKL is named, but not installed.
    """
    where = VARIABLE if name == "auto" else "fft"
    if name == "auto":
        name = os.environ.get(VARIABLE) or ("mkl" if mkl_library() is not None else "scipy")
    if name not in LIBRARIES:
        raise unknown_name("Fourier library", name, ("auto", *LIBRARIES), where=where)
    if name == "mkl" and mkl_library() is None:
        raise MissingExtraError("mkl", "fast", "MKL's Fourier transform")
    return name


def transform(
    shape: tuple[int, int], dtype: Any, *, xp: Any = np, threads: int = 1, library: str = "auto"
) -> Transform:
    """Return the transform of one shape and precision by ``fourier_library(library)``.

    Arrays that are not NumPy's are transformed by their own namespace ``xp``.
    """
    if xp is not np:
        return NamespaceTransform(shape, xp)
    if fourier_library(library) == "mkl":
        return MklTransform(shape, dtype, threads)
    return ScipyTransform(shape, threads)
