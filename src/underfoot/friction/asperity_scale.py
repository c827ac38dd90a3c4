"""Asperities and the fine roughness on them: one rough surface split at one wavelength."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import erf

from underfoot.core import RangeError
from underfoot.core.arrays import Array, Mask
from underfoot.core.checks import positive
from underfoot.surface import IsotropicSpectrum


@dataclass(frozen=True, slots=True)
class AsperityScale:
    """What a spectrum gives when waves longer than ``wavelength`` count as asperities.

    Parameters:
        wavelength: Dividing wavelength, m.
        radius: Of the asperities, m: R = 3 sqrt(pi) / (8 sqrt(m4)) (McCool 1987), m4 of the longer
            waves.
        slope: Root-mean-square slope of the longer waves (of the surface, not of a profile), 1.
        fine_roughness: Root-mean-square height of the shorter waves, m.
    """

    wavelength: float
    radius: float
    slope: float
    fine_roughness: float

    def __post_init__(self) -> None:
        for name in ("wavelength", "radius", "slope", "fine_roughness"):
            positive(getattr(self, name), name)

    def rougher(self, factor: float) -> AsperityScale:
        """Return the same surface with all heights times ``factor``."""
        positive(factor, "factor")
        return replace(
            self,
            radius=self.radius / factor,
            slope=self.slope * factor,
            fine_roughness=self.fine_roughness * factor,
        )

    def contact_fraction(self, relative_pressure: ArrayLike) -> Array:
        """Return the share of the area on which asperities touch, fine roughness unresolved.

        A = erf(sqrt(2) p / (E* slope)) (Persson 2001, elastic); ``relative_pressure`` is p / E*,
        p the nominal contact pressure, E* = E / (1 - nu^2). About 25 to 30 % low at light load.
        """
        return erf(math.sqrt(2.0) * np.asarray(relative_pressure, dtype=float) / self.slope)

    def spot_pressure(self, relative_pressure: ArrayLike) -> Array:
        """Return the mean pressure on the touching asperities over E*: p / (A E*).

        At light load it tends to 0.627 times the slope, whatever the load.
        """
        p = np.maximum(np.asarray(relative_pressure, dtype=float), 1e-9 * self.slope)
        return p / self.contact_fraction(p)


def self_affine_scale(
    wavelength: float, *, rq: float, longest_wave: float, hurst: float = 0.8
) -> AsperityScale:
    """Return the asperities of a self-affine surface divided at ``wavelength`` (m).

    Mean square height of the waves beyond q is Rq^2 (q / q0)^(-2H), q0 = 2 pi / longest_wave: the
    spectrum goes on below the resolution of the stylus with the same Hurst exponent (assumed).

    Parameters:
        wavelength: m, below ``longest_wave``.
        rq: Root-mean-square height of all waves up to ``longest_wave``, m.
        longest_wave: m: the cut-off of the profile that ``rq`` was measured with.
        hurst: 0 to 1, below 1.

    Raises:
        RangeError: A dividing wavelength that is not below the longest wave, a Hurst exponent
            outside 0 to 1.

    >>> self_affine_scale(1e-5, rq=2e-6, longest_wave=1e-3).wavelength
    1e-05
    """
    if not 0 < hurst < 1:
        raise RangeError(f"{hurst:g}", where="hurst", allowed="above 0, below 1")
    if not 0 < wavelength < longest_wave:
        raise RangeError(
            f"{wavelength:g} m", where="wavelength", allowed=f"0 to {longest_wave:g} m"
        )
    q0, q1 = 2 * math.pi / longest_wave, 2 * math.pi / wavelength

    def moment(order: int) -> float:
        power = order - 2 * hurst
        return 2 * hurst * rq**2 * q0 ** (2 * hurst) * (q1**power - q0**power) / power

    return AsperityScale(
        wavelength, _radius(0.375 * moment(4)), math.sqrt(moment(2)), rq * (q1 / q0) ** -hurst
    )


def spectrum_scale(wavelength: float, spectrum: IsotropicSpectrum) -> AsperityScale:
    """Return the asperities of a measured isotropic spectrum divided at ``wavelength`` (m).

    Waves beyond the reliable band count as no roughness: divide well within it.

    Raises:
        RangeError: Fewer than two wave numbers of the reliable band on one side.
    """
    low, high = spectrum.reliable
    q = spectrum.wavenumber
    inside = (q >= low) & (q <= high)
    long_waves = inside & (q <= 2 * math.pi / wavelength)
    short_waves = inside & ~long_waves
    if min(long_waves.sum(), short_waves.sum()) < 2:
        raise RangeError(
            f"{wavelength:g} m leaves no spectrum on one side",
            where="wavelength",
            allowed=f"well within {2 * math.pi / high:.3g} to {2 * math.pi / low:.3g} m",
            remedy="Measure a wider band, or use the self-affine form with Rq and its cut-off",
        )
    share = spectrum.density * spectrum.area

    def moment(order: int, chosen: Mask) -> float:
        return float(np.sum((share * q**order)[chosen]))

    return AsperityScale(
        wavelength,
        _radius(0.375 * moment(4, long_waves)),
        math.sqrt(moment(2, long_waves)),
        math.sqrt(moment(0, short_waves)),
    )


def _radius(fourth_moment: float) -> float:
    return 3 * math.sqrt(math.pi) / (8 * math.sqrt(fourth_moment))
