"""Spectral moments and the asperities of Greenwood and Williamson that they imply."""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError

from .spectrum import IsotropicSpectrum, ProfileSpectrum


@dataclass(frozen=True, slots=True)
class SpectralMoments:
    """Profile moments m0 (m^2), m2 (1) and m4 (1/m^2): mean squares of height, slope, curvature.

    They depend on the band of wave numbers ``band`` (rad/m), m4 almost entirely on its upper end.
    """

    m0: float
    m2: float
    m4: float
    band: tuple[float, float]

    @property
    def bandwidth(self) -> float:
        """Nayak's alpha = m0 m4 / m2^2, at least 1.5 for an isotropic random surface."""
        return self.m0 * self.m4 / self.m2**2


@dataclass(frozen=True, slots=True)
class Asperities:
    """Summits of an isotropic Gaussian surface as spheres of one radius.

    ``density`` (1/m^2), ``radius`` (m), ``height_sd`` (m) of the summits, ``mean_height`` (m) of
    the summits above the mean plane.
    """

    density: float
    radius: float
    height_sd: float
    mean_height: float
    source: str = (
        "J. I. McCool, Relating profile instrument measurements to the functional performance of "
        "rough surfaces, J. Tribology 109 (1987) 264-270; Nayak (1971)"
    )


def spectral_moments(
    spectrum: ProfileSpectrum | IsotropicSpectrum, band: tuple[float, float] | None = None
) -> SpectralMoments:
    """Return the moments of the profiles of a surface over ``band`` (rad/m; default: reliable).

    From a profile spectrum m_n = 2 int q^n C dq; from an isotropic one
    m_n = int cos^n(phi) q^n C d^2q, so m0, m2 / 2 and 3 m4 / 8 of the radial integrals.

    Raises:
        InputError: No wave number in the band, or no roughness there.
    """
    low, high = band if band is not None else spectrum.reliable
    q = spectrum.wavenumber
    inside = (q >= low * (1 - 1e-12)) & (q <= high * (1 + 1e-12))
    if isinstance(spectrum, ProfileSpectrum):
        step = np.gradient(q) if q.size > 1 else q
        weight, share = 2.0 * spectrum.density * step, (1.0, 1.0, 1.0)
    else:
        weight, share = spectrum.density * spectrum.area, (1.0, 0.5, 0.375)
    weight, q = weight[inside], q[inside]
    if not (weight.size and weight.sum() > 0.0):
        raise InputError(
            f"no roughness between {low:g} and {high:g} rad/m",
            where="band",
            allowed=f"within {spectrum.wavenumber[0]:g} to {spectrum.wavenumber[-1]:g} rad/m",
        )
    m0, m2, m4 = (s * float(np.sum(weight * q**n)) for s, n in zip(share, (0, 2, 4), strict=True))
    return SpectralMoments(m0, m2, m4, (float(low), float(high)))


def asperities(moments: SpectralMoments) -> Asperities:
    """Return the summits that Greenwood and Williamson's model needs, after McCool (1987).

    density = m4 / (6 pi sqrt(3) m2), radius = 3 sqrt(pi) / (8 sqrt(m4)),
    height_sd^2 = (1 - 0.8968 / alpha) m0, mean_height = 4 sqrt(m0 / (pi alpha)).

    Raises:
        InputError: alpha below 1.5: not an isotropic random surface.
    """
    alpha = moments.bandwidth
    if alpha < 1.5 * (1.0 - 1e-6):
        raise InputError(
            f"bandwidth parameter {alpha:.3g}",
            where="moments",
            allowed="1.5 or more, as every isotropic random surface has",
            remedy="A wave or a ridged surface has no summits in this sense",
        )
    return Asperities(
        density=moments.m4 / (6.0 * math.pi * math.sqrt(3.0) * moments.m2),
        radius=3.0 * math.sqrt(math.pi) / (8.0 * math.sqrt(moments.m4)),
        height_sd=math.sqrt((1.0 - 0.8968 / alpha) * moments.m0),
        mean_height=4.0 * math.sqrt(moments.m0 / (math.pi * alpha)),
    )
