"""Shift of a periodic map by any fraction of the spacing."""

from __future__ import annotations

import numpy as np

from underfoot.core.arrays import AnyArray


class ShiftedMap:
    """A periodic map read at x + distance, exact for every wave below Nyquist."""

    def __init__(self, heights: AnyArray, spacing: float) -> None:
        self._shape = heights.shape
        self._spectrum = np.fft.rfft2(heights)
        self._qx = 2.0 * np.pi * np.fft.fftfreq(heights.shape[0], spacing)[:, None]

    def at(self, distance: float) -> AnyArray:
        """Return the heights at x + ``distance``."""
        return np.fft.irfft2(self._spectrum * self._phase(distance), s=self._shape)

    def slope_at(self, distance: float) -> AnyArray:
        """Return the slope along axis 0 at x + ``distance``."""
        turned = self._phase(distance) * 1j * self._qx
        if self._shape[0] % 2 == 0:
            turned[self._shape[0] // 2] = 0.0
        return np.fft.irfft2(self._spectrum * turned, s=self._shape)

    def _phase(self, distance: float) -> AnyArray:
        phase = np.exp(1j * self._qx * distance)
        if self._shape[0] % 2 == 0:
            middle = self._shape[0] // 2
            phase[middle] = np.real(phase[middle])
        return phase
