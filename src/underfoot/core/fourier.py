"""Real two-dimensional Fourier transforms: MKL's where it is installed, else SciPy's.

The variable ``UNDERFOOT_FFT`` of the environment ("mkl" or "scipy") chooses one for a whole run.
"""

import os
from typing import Any, Protocol

import numpy as np

from .arrays import AnyArray
from .errors import MissingExtraError, unknown_name
from .mkl import MklTransform, mkl_library

LIBRARIES = ("mkl", "scipy")
VARIABLE = "UNDERFOOT_FFT"


class Transform(Protocol):
    """Real FFT over the last two axes, the half spectrum over the last.

    The result is a new array, or ``out`` (contiguous, of the result's kind) where the library can
    write there: fresh memory of a large grid costs a fifth of its transform.
    """

    def forward(self, field: AnyArray, out: AnyArray = None) -> AnyArray:
        """Return the half spectrum of a real field."""
        ...

    def backward(self, spectrum: AnyArray, out: AnyArray = None) -> AnyArray:
        """Return the real field of a half spectrum, whose content is lost."""
        ...


class ArrayTransform:
    """The transforms of one module for arrays, with its own ``options``."""

    def __init__(self, shape: tuple[int, ...], module: Any, **options: Any) -> None:
        self.shape = shape
        self._fft, self._options = module, options

    def forward(self, field: AnyArray, out: AnyArray = None) -> AnyArray:
        return self._fft.rfftn(field, axes=(-2, -1), **self._options)

    def backward(self, spectrum: AnyArray, out: AnyArray = None) -> AnyArray:
        return self._fft.irfftn(spectrum, s=self.shape[-2:], axes=(-2, -1), **self._options)


class ScipyTransform(ArrayTransform):
    """SciPy's transforms; back by one axis and then the other, half the time of both at once."""

    def backward(self, spectrum: AnyArray, out: AnyArray = None) -> AnyArray:
        fft, options = self._fft, self._options
        columns = fft.ifft(spectrum, axis=-2, overwrite_x=True, **options)
        return fft.irfft(columns, self.shape[-1], axis=-1, overwrite_x=True, **options)


def fourier_library(name: str = "auto") -> str:
    """Return the library in use: ``name``, for "auto" ``UNDERFOOT_FFT``, else the fastest.

    An unknown name raises ``InputError``, MKL that is not installed ``MissingExtraError``.
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
    shape: tuple[int, ...], dtype: Any, *, xp: Any = np, threads: int = 1, library: str = "auto"
) -> Transform:
    """Return the transform of one shape and precision by ``fourier_library(library)``.

    Arrays that are not NumPy's are transformed by their own namespace ``xp``.
    """
    if xp is not np:
        return ArrayTransform(shape, xp.fft)
    if fourier_library(library) == "mkl":
        return MklTransform(shape, dtype, threads)
    from scipy import fft

    return ScipyTransform(shape, fft, workers=threads)
