"""Real two-dimensional Fourier transforms and diagonal operators in them."""

from __future__ import annotations

from typing import Any

Array = Any


class RealTransform:
    """Real FFT over a grid with a fixed number of threads."""

    def __init__(self, shape: tuple[int, int], threads: int = 1) -> None:
        from scipy import fft

        self.shape = shape
        self.threads = threads
        self._fft: Any = fft

    def forward(self, field: Array) -> Array:
        """Return the half spectrum of a real field."""
        return self._fft.rfft2(field, workers=self.threads)

    def backward(self, spectrum: Array) -> Array:
        """Return the real field of a half spectrum (which may be overwritten)."""
        return self._fft.irfft2(spectrum, s=self.shape, workers=self.threads, overwrite_x=True)

    def apply(self, symbol: Array, field: Array) -> Array:
        """Return the field multiplied by ``symbol`` in Fourier space."""
        spectrum = self.forward(field)
        spectrum *= symbol
        return self.backward(spectrum)
