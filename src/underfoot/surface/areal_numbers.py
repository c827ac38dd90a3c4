"""Areal roughness numbers by ISO 25178-2."""

from dataclasses import dataclass, field

import numpy as np

from underfoot.core import RangeError
from underfoot.core.units import metres

from ._kernels.numbers import slope
from .filter import long_waves, short_waves
from .height_map import HeightMap
from .prepare import levelled
from .profile_numbers import height_numbers
from .resolution import shortest_derivable_wavelength, shortest_reliable_wavelength


@dataclass(frozen=True, slots=True)
class ArealRoughness:
    """Areal numbers with everything that they depend on; lengths in m.

    ``sdq`` (rms slope) is None without a short cut-off or a known resolution; ``not_estimated``
    gives the reason.
    """

    sa: float
    sq: float
    sz: float
    sp: float
    sv: float
    ssk: float | None
    sku: float | None
    sdq: float | None
    long_cutoff: float | None
    short_cutoff: float | None
    evaluation_size: tuple[float, float]
    ends: str
    processing: tuple[str, ...]
    standard: str = "ISO 25178-2"
    not_estimated: dict[str, str] = field(default_factory=dict)


def areal_roughness(
    surface: HeightMap,
    long_cutoff: float | None = None,
    short_cutoff: float | None = None,
    *,
    ends: str = "drop",
) -> ArealRoughness:
    """Return Sa, Sq, Sz, Sp, Sv, Ssk, Sku and Sdq of a map.

    The plane is removed first (not from a periodic map, which has none); then, where cut-offs
    (m) are given, the Gaussian filters: wavelengths below ``short_cutoff`` (S-filter) and above
    ``long_cutoff`` (L-filter) go.

    Sdq = sqrt(mean(z_x^2 + z_y^2)), see ``rms_slope``.

    Raises:
        RangeError: Short cut-off below what the measurement resolves.
        DataError, InputError: See ``long_waves``.
    """
    # The slope of a periodic map is taken in Fourier space, which needs no spare points.
    limit = (shortest_reliable_wavelength if surface.periodic else shortest_derivable_wavelength)(
        surface
    )
    if short_cutoff is not None and short_cutoff < limit.wavelength * (1.0 - 1e-9):
        raise RangeError(
            f"short cut-off {metres(short_cutoff)} is below what was measured",
            where="short_cutoff",
            allowed=f"{metres(limit.wavelength)} or more ({limit.reason})",
        )
    rough = surface if surface.periodic else levelled(surface, 1)
    if short_cutoff is not None:
        rough = long_waves(rough, short_cutoff, ends)
    if long_cutoff is not None:
        rough = short_waves(rough, long_cutoff, ends)
    numbers = height_numbers(rough.heights)
    shortest = short_cutoff if short_cutoff is not None else surface.resolution
    reasons: dict[str, str] = {}
    sdq = None
    if shortest is None:
        reasons["sdq"] = "no short cut-off given: it would be set by the spacing and the noise"
    elif shortest < limit.wavelength * (1.0 - 1e-9):
        reasons["sdq"] = f"the shortest waves are not resolved: {limit.reason}"
    elif min(rough.shape) < 9:
        reasons["sdq"] = "fewer than nine points along a side"
    else:
        sdq = rms_slope(rough)
    if numbers.rsk is None:
        reasons |= {"ssk": "a flat surface has none", "sku": "a flat surface has none"}
    return ArealRoughness(
        sa=numbers.ra,
        sq=numbers.rq,
        sz=numbers.rt,
        sp=numbers.rp,
        sv=numbers.rv,
        ssk=numbers.rsk,
        sku=numbers.rku,
        sdq=sdq,
        long_cutoff=long_cutoff,
        short_cutoff=short_cutoff,
        evaluation_size=rough.size,
        ends=ends,
        processing=rough.processing,
        not_estimated=reasons,
    )


def rms_slope(surface: HeightMap) -> float:
    """Return sqrt(mean(z_x^2 + z_y^2)) of a map as it is.

    Of a periodic map exactly, in Fourier space; of others by seven-point differences, for which
    the three outer rows serve as neighbours only.
    """
    z = surface.heights
    if surface.periodic:
        qx = 2.0 * np.pi * np.fft.fftfreq(z.shape[0], surface.spacing)[:, None]
        qy = 2.0 * np.pi * np.fft.fftfreq(z.shape[1], surface.spacing)[None, :]
        power = np.abs(np.fft.fft2(z)) ** 2
        return float(np.sqrt(np.sum(power * (qx**2 + qy**2)))) / z.size
    along = slope(z, surface.spacing)[:, 3:-3]
    across = slope(z.T, surface.spacing).T[3:-3]
    return float(np.sqrt(np.mean(along**2 + across**2)))
