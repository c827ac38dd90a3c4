"""Profile moments of an isotropic rough surface, the input of asperity theories."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError


@dataclass(frozen=True, slots=True)
class SpectralMoments:
    """Variances of height, slope and curvature along a line on an isotropic surface.

    ``m0`` = <h^2> (m^2), ``m2`` = <(dh/dx)^2>, ``m4`` = <(d2h/dx2)^2> (1/m^2). The rms gradient
    of the surface is sqrt(2 m2). ``m2`` and ``m4`` depend on the shortest wave that is kept.
    """

    m0: float
    m2: float
    m4: float

    def __post_init__(self) -> None:
        for name in self.__slots__:
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(
                    f"{name} is {value}", where="spectral moments", allowed="a positive number"
                )

    @property
    def nayak(self) -> float:
        """Return Nayak's spectral breadth m0 m4 / m2^2; at least 1.5 for isotropic Gaussians."""
        return self.m0 * self.m4 / self.m2**2

    @property
    def rms_height(self) -> float:
        """Return the rms height (m)."""
        return math.sqrt(self.m0)

    @property
    def rms_gradient(self) -> float:
        """Return the rms gradient h' of the surface (both directions together)."""
        return math.sqrt(2.0 * self.m2)

    @classmethod
    def from_spectrum(cls, wavenumber: ArrayLike, spectrum: ArrayLike) -> SpectralMoments:
        """Return the moments of an isotropic 2-D spectrum C(q), <h^2> = 2 pi int q C dq.

        m0 = 2 pi int q C dq, m2 = pi int q^3 C dq, m4 = (3 pi / 4) int q^5 C dq; trapezoids on
        the logarithm of ``wavenumber`` (rad/m, rising); ``spectrum`` in m^4.
        """
        q, c = checked_spectrum(wavenumber, spectrum)
        integral = [float(np.trapezoid(q ** (n + 2) * c, np.log(q))) for n in (0, 2, 4)]
        return cls(2.0 * math.pi * integral[0], math.pi * integral[1], 0.75 * math.pi * integral[2])

    @classmethod
    def from_map(cls, height: ArrayLike, spacing: float) -> SpectralMoments:
        """Return the moments of a periodic height map (m) as direction averages.

        Exact for the band-limited surface through the grid points: every Fourier wave counts
        with q^2/2 (slope) and 3 q^4/8 (curvature), as on an isotropic surface.
        """
        h = np.asarray(height, dtype=float)
        waves = 2.0 * np.pi * np.fft.fftfreq(h.shape[0], spacing)
        across = 2.0 * np.pi * np.fft.fftfreq(h.shape[1], spacing)
        q2 = waves[:, None] ** 2 + across[None, :] ** 2
        power = np.abs(np.fft.fft2(h - h.mean()) / h.size) ** 2
        return cls(
            float(power.sum()),
            float((power * q2).sum() / 2.0),
            float(0.375 * (power * q2**2).sum()),
        )


def checked_spectrum(wavenumber: ArrayLike, spectrum: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Return wave numbers and spectrum as arrays; raise InputError when they can't be used."""
    q = np.asarray(wavenumber, dtype=float)
    c = np.asarray(spectrum, dtype=float)
    where = "spectrum"
    if q.ndim != 1 or q.shape != c.shape or q.size < 8:
        raise InputError(
            f"wavenumber {q.shape} and spectrum {c.shape} do not fit",
            where=where,
            allowed="two arrays of one length, at least 8 values",
        )
    if not (np.all(np.isfinite(q)) and np.all(np.isfinite(c))):
        raise InputError("some values are not finite", where=where)
    if q[0] <= 0.0 or np.any(np.diff(q) <= 0.0):
        raise InputError("the wave numbers do not rise from above zero", where=where)
    if c.min() < 0.0 or c.max() == 0.0:
        raise InputError(
            f"the smallest density is {c.min():.3g} m^4",
            where=where,
            allowed="zero or more, not all zero",
        )
    return q, c
