"""Real two-dimensional Fourier transforms in single or double precision."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

Array = Any


class Transform(Protocol):
    """Real FFT of one shape and precision; results may live in buffers that the next call reuses.

    ``forward`` gives the half spectrum over axis 1, ``backward`` the real field. Both may be
    overwritten by the caller and by the next call of the same method.
    """

    def forward(self, field: Array) -> Array:
        """Return the half spectrum of a real field."""
        ...

    def backward(self, spectrum: Array) -> Array:
        """Return the real field of a half spectrum."""
        ...


class ScipyTransform:
    """SciPy's transforms of NumPy arrays with a number of threads."""

    def __init__(self, shape: tuple[int, int], threads: int = 1) -> None:
        from scipy import fft

        self.shape = shape
        self.threads = threads
        self._fft: Any = fft

    def forward(self, field: Array) -> Array:
        """Return the half spectrum of a real field."""
        return self._fft.rfft2(field, workers=self.threads)

    def backward(self, spectrum: Array) -> Array:
        """Return the real field of a half spectrum."""
        return self._fft.irfft2(spectrum, s=self.shape, workers=self.threads, overwrite_x=True)


class NamespaceTransform:
    """The transforms of an array-API namespace, for arrays that are not NumPy's."""

    def __init__(self, shape: tuple[int, int], xp: Any) -> None:
        self.shape = shape
        self._fft = xp.fft

    def forward(self, field: Array) -> Array:
        """Return the half spectrum of a real field."""
        return self._fft.rfftn(field, axes=(0, 1))

    def backward(self, spectrum: Array) -> Array:
        """Return the real field of a half spectrum."""
        return self._fft.irfftn(spectrum, s=self.shape, axes=(0, 1))


def transform(
    shape: tuple[int, int], dtype: Any, *, xp: Any = np, threads: int = 1, library: str = "auto"
) -> Transform:
    """Return the fastest transform at hand: Intel's library where installed, else SciPy's.

    ``library`` is "auto", "mkl" or "scipy"; it has no effect on arrays that are not NumPy's.
    """
    if xp is not np:
        return NamespaceTransform(shape, xp)
    if library != "scipy":
        from underfoot.core.mkl import mkl_library

        from .mkl import MklTransform

        if mkl_library() is not None:
            return MklTransform(shape, dtype, threads)
        if library == "mkl":
            raise OSError("libmkl_rt was not found")
    return ScipyTransform(shape, threads)
