"""Roughness numbers of profiles (ISO 21920-2, ISO 4287) and of maps (ISO 25178-2)."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, InputError, RangeError
from underfoot.core.remark import Message
from underfoot.core.unit_text import metres

from .filter import long_waves, short_waves
from .heights import (
    HeightMap,
    Profile,
    Resolution,
    check_heights,
    shortest_derivable_wavelength,
    shortest_reliable_wavelength,
)
from .prepare import level_surface

STANDARDS = ("ISO 21920-2:2021", "ISO 4287:1997")
NO_CUTOFF = "no short cut-off given: it would be set by the spacing and the noise"


@dataclass(frozen=True, slots=True)
class HeightNumbers:
    """Numbers of a set of heights about their own mean: lengths in m, the others without unit."""

    ra: float
    rq: float
    rsk: float | None
    rku: float | None
    rp: float
    rv: float
    rt: float


def height_numbers(heights: ArrayLike) -> HeightNumbers:
    """Return mean and rms deviation, skewness, kurtosis, peak, valley and total height.

    Of heights (m) of any shape as they are: no form removed, no filter. Skewness and kurtosis
    are None for a flat surface.
    """
    z = np.asarray(heights, dtype=float)
    check_heights(np.atleast_1d(z))
    z = z - z.mean()
    rq = float(np.sqrt(np.mean(z * z)))
    flat = rq == 0.0
    return HeightNumbers(
        ra=float(np.mean(np.abs(z))),
        rq=rq,
        rsk=None if flat else float(np.mean((z / rq) ** 3)),
        rku=None if flat else float(np.mean((z / rq) ** 4)),
        rp=float(z.max()),
        rv=float(-z.min()),
        rt=float(z.max() - z.min()),
    )


@dataclass(frozen=True, slots=True)
class ProfileRoughness:
    """Roughness numbers of a profile with everything that they depend on.

    Lengths in m. ``rdq`` (rms slope) and ``rms_curvature`` (1/m) need a short cut-off and are
    None without one; ``rsm`` (mean spacing of profile elements) is None where no element counts,
    ``rsk`` and ``rku`` where a section is flat; ``not_estimated`` gives the reasons.
    """

    ra: float
    rq: float
    rz: float
    rp: float
    rv: float
    rt: float
    rsk: float | None
    rku: float | None
    rsm: float | None
    rdq: float | None
    rms_curvature: float | None
    long_cutoff: float
    short_cutoff: float | None
    sections: int
    section_length: float
    evaluation_length: float
    standard: str
    ends: str
    processing: tuple[str, ...]
    not_estimated: dict[str, str] = field(default_factory=dict)

    def __str__(self) -> str:
        def number(value: float | None) -> str:
            return "not estimated" if value is None else f"{value:.4g}"

        def um(value: float | None) -> str:
            return number(value) if value is None else f"{value * 1e6:.4g} um"

        names = ("ra", "rq", "rz", "rp", "rv", "rt", "rsm")
        lengths = ", ".join(f"{n[0].upper()}{n[1:]} {um(getattr(self, n))}" for n in names)
        return (
            f"{lengths}, Rsk {number(self.rsk)}, Rku {number(self.rku)}, Rdq {number(self.rdq)}; "
            f"{self.standard}, cut-off {um(self.long_cutoff)} / {um(self.short_cutoff)}, "
            f"{self.sections} sections of {um(self.section_length)}, ends: {self.ends}"
        )


def profile_roughness(
    profile: Profile,
    long_cutoff: float,
    short_cutoff: float | None = None,
    *,
    sections: int = 5,
    ends: str = "drop",
    standard: str = "ISO 21920-2:2021",
) -> ProfileRoughness:
    """Return the roughness numbers of a profile after the Gaussian filter of ISO 16610-21.

    The evaluation length is ``sections`` times the long cut-off, from the middle of what the
    filter leaves. The straight line is removed first.

    Parameters:
        long_cutoff: Lambda_c, m: 0.8e-3 for most floors and soles.
        short_cutoff: Lambda_s, m, or None; needed for slope and curvature. Below the resolution of
            the measurement it is refused.
        sections: Sections (ISO 21920) or sampling lengths (ISO 4287), each one long cut-off; 5 by
            default.
        ends: See ``long_waves``.
        standard: "ISO 21920-2:2021": Ra, Rq, Rsk, Rku, Rdq over the evaluation length; Rz, Rp, Rv
            means over the sections. "ISO 4287:1997": all of them means over the sampling lengths.
            Rt and RSm are of the whole evaluation length in both.

    RSm counts profile elements whose hill and dale both exceed 10 % of Rz, between upward
    crossings of the mean line.

    Raises:
        InputError: Unknown standard, fewer than one section, short cut-off not below the long one.
        RangeError: Short cut-off below what the measurement resolves.
        DataError: Profile too short.
    """
    flat = profile if profile.periodic else level_surface(profile, 1)
    return level_roughness(
        flat, long_cutoff, short_cutoff, sections=sections, ends=ends, standard=standard
    )


def level_roughness(
    flat: Profile,
    long_cutoff: float,
    short_cutoff: float | None = None,
    *,
    sections: int = 5,
    ends: str = "drop",
    standard: str = STANDARDS[0],
) -> ProfileRoughness:
    """Return the ``profile_roughness`` of one whose line was removed, or of a periodic one."""
    profile = flat
    _check(profile, long_cutoff, short_cutoff, sections, standard)
    if short_cutoff is not None:
        flat = long_waves(flat, short_cutoff, ends)
    rough = short_waves(flat, long_cutoff, ends)
    per_section = round(long_cutoff / profile.spacing)
    wanted = sections * per_section
    if rough.heights.size < wanted:
        lost = profile.length - rough.heights.size * profile.spacing
        raise DataError(
            Message(
                "the profile is {length} long, the filter uses {used} of it",
                length=metres(profile.length),
                used=metres(lost),
            ),
            where="profile",
            allowed=Message(
                "{sections} sections of {metres} and what the filter uses",
                sections=sections,
                metres=metres(long_cutoff),
            ),
            remedy='Take fewer sections, a shorter cut-off, or ends="regression"',
        )
    start = (rough.heights.size - wanted) // 2
    z = rough.heights[start : start + wanted]
    pieces = z.reshape(sections, per_section)
    whole = z - z.mean()
    # Peaks and valleys count from the mean line of the evaluation length, not of each section.
    high = pieces.max(axis=1) - z.mean()
    low = z.mean() - pieces.min(axis=1)
    rp, rv = float(high.mean()), float(low.mean())
    reasons: dict[str, str] = {}
    rdq = bend = None
    by_section = standard.startswith("ISO 4287")
    if short_cutoff is None:
        reasons |= {"rdq": NO_CUTOFF, "rms_curvature": NO_CUTOFF}
    else:
        rdq, bend = (
            float(np.mean([_rms(f(p, profile.spacing)) for p in (pieces if by_section else [z])]))
            for f in (slope, curvature)
        )
    rsm = element_spacing(whole, profile.spacing, 0.1 * (rp + rv))
    if rsm is None:
        reasons["rsm"] = "fewer than one whole profile element above 10 % of Rz"
    parts = [height_numbers(p) for p in (pieces if by_section else [z])]
    ra, rq, rsk, rku = (_mean(parts, name) for name in ("ra", "rq", "rsk", "rku"))
    if rsk is None or rku is None:
        reasons |= {"rsk": "a flat section has none", "rku": "a flat section has none"}
    return ProfileRoughness(
        ra=ra or 0.0,
        rq=rq or 0.0,
        rz=rp + rv,
        rp=rp,
        rv=rv,
        rt=float(whole.max() - whole.min()),
        rsk=rsk,
        rku=rku,
        rsm=rsm,
        rdq=rdq,
        rms_curvature=bend,
        long_cutoff=float(long_cutoff),
        short_cutoff=short_cutoff,
        sections=sections,
        section_length=per_section * profile.spacing,
        evaluation_length=wanted * profile.spacing,
        standard=standard,
        ends=ends,
        processing=rough.processing,
        not_estimated=reasons,
    )


def _check(
    profile: Profile, long_cutoff: float, short_cutoff: float | None, sections: int, standard: str
) -> None:
    if standard not in STANDARDS:
        raise InputError(f'"{standard}"', where="standard", allowed=", ".join(STANDARDS))
    if sections < 1:
        raise InputError(
            Message("{sections} sections", sections=sections), where="sections", allowed="1 or more"
        )
    limit = shortest_derivable_wavelength(profile)
    if long_cutoff < 2.0 * limit.wavelength:
        raise RangeError(
            Message("long cut-off {metres}", metres=metres(long_cutoff)),
            where="long_cutoff",
            allowed=Message(
                "at least twice the resolution of {metres} ({reason})",
                metres=metres(limit.wavelength),
                reason=limit.reason,
            ),
        )
    if short_cutoff is None:
        return
    if not short_cutoff < long_cutoff:
        raise InputError(
            Message("short cut-off {metres}", metres=metres(short_cutoff)),
            where="short_cutoff",
            allowed=Message("below {limit}", limit=metres(long_cutoff)),
        )
    _check_short_cutoff(short_cutoff, limit)


def _check_short_cutoff(cutoff: float, limit: Resolution) -> None:
    if cutoff < limit.wavelength * (1.0 - 1e-9):
        raise RangeError(
            Message("short cut-off {metres} is below what was measured", metres=metres(cutoff)),
            where="short_cutoff",
            allowed=f"{metres(limit.wavelength)} or more ({limit.reason})",
        )


def _mean(parts: list[HeightNumbers], name: str) -> float | None:
    values = [getattr(part, name) for part in parts]
    return None if any(value is None for value in values) else float(np.mean(values))


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values * values)))


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

    Parameters:
        surface: The map.
        long_cutoff: L-filter, m; None leaves it out.
        short_cutoff: S-filter, m; None leaves it out.
        ends: What the filters do at the rims, as ``long_waves``.

    Raises:
        RangeError: Short cut-off below what the measurement resolves.
        DataError, InputError: See ``long_waves``.
    """
    # The slope of a periodic map is taken in Fourier space, which needs no spare points.
    limit = (shortest_reliable_wavelength if surface.periodic else shortest_derivable_wavelength)(
        surface
    )
    if short_cutoff is not None:
        _check_short_cutoff(short_cutoff, limit)
    rough = surface if surface.periodic else level_surface(surface, 1)
    if short_cutoff is not None:
        rough = long_waves(rough, short_cutoff, ends)
    if long_cutoff is not None:
        rough = short_waves(rough, long_cutoff, ends)
    numbers = height_numbers(rough.heights)
    shortest = short_cutoff if short_cutoff is not None else surface.resolution
    reasons: dict[str, str] = {}
    sdq = None
    if shortest is None:
        reasons["sdq"] = NO_CUTOFF
    elif shortest < limit.wavelength * (1.0 - 1e-9):
        reasons["sdq"] = f"the shortest waves are not resolved: {limit.reason}"
    elif min(rough.shape) < 9:
        reasons["sdq"] = "fewer than nine points along a side"
    else:
        sdq = rms_slope(rough)
    if numbers.rsk is None:
        reasons |= {"ssk": "a flat surface has none", "sku": "a flat surface has none"}
    return ArealRoughness(
        *(numbers.ra, numbers.rq, numbers.rt, numbers.rp, numbers.rv, numbers.rsk, numbers.rku),
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

    >>> from underfoot.surface import sinusoidal
    >>> round(rms_slope(sinusoidal(64, 1e-6, 1e-6, 32e-6)), 3)
    0.139
    """
    z = surface.heights
    if surface.periodic:
        qx = 2.0 * np.pi * np.fft.fftfreq(z.shape[0], surface.spacings[0])[:, None]
        qy = 2.0 * np.pi * np.fft.fftfreq(z.shape[1], surface.spacings[1])[None, :]
        power = np.abs(np.fft.fft2(z)) ** 2
        return float(np.sqrt(np.sum(power * (qx**2 + qy**2)))) / z.size
    along = slope(z, surface.spacings[0])[:, 3:-3]
    across = slope(z.T, surface.spacings[1]).T[3:-3]
    return float(np.sqrt(np.mean(along**2 + across**2)))


def slope(heights: np.ndarray, spacing: float) -> np.ndarray:
    """Return the slope by the seven-point formula of ISO 4287 along axis 0, (n - 6, ...)."""
    z, n = heights, heights.shape[0]
    total = 45.0 * (z[4 : n - 2] - z[2 : n - 4])
    total -= 9.0 * (z[5 : n - 1] - z[1 : n - 5])
    total += z[6:] - z[: n - 6]
    return total / (60.0 * spacing)


def curvature(heights: np.ndarray, spacing: float) -> np.ndarray:
    """Return the second derivative by the sixth-order formula along axis 0, (n - 6, ...)."""
    z, n = heights, heights.shape[0]
    total = 270.0 * (z[4 : n - 2] + z[2 : n - 4]) - 490.0 * z[3 : n - 3]
    total -= 27.0 * (z[5 : n - 1] + z[1 : n - 5])
    total += 2.0 * (z[6:] + z[: n - 6])
    return total / (180.0 * spacing**2)


def element_spacing(heights: np.ndarray, spacing: float, threshold: float) -> float | None:
    """Return the mean length of profile elements; None when there is not one whole element.

    An element runs from one upward crossing of zero to the next; a crossing counts once the
    profile has been below -threshold and then exceeds +threshold.
    """
    state = np.where(heights > threshold, 1, np.where(heights < -threshold, -1, 0))
    marked = np.flatnonzero(state)
    if marked.size < 2:
        return None
    turns = np.flatnonzero((state[marked[:-1]] == -1) & (state[marked[1:]] == 1))
    if turns.size < 2:
        return None
    crossings = [
        _last_upward_zero(heights, int(marked[i]), int(marked[i + 1]))
        for i in (turns[0], turns[-1])
    ]
    return float((crossings[1] - crossings[0]) * spacing / (turns.size - 1))


def _last_upward_zero(heights: np.ndarray, low: int, high: int) -> float:
    part = heights[low : high + 1]
    i = int(np.flatnonzero((part[:-1] <= 0.0) & (part[1:] > 0.0))[-1])
    return low + i + float(part[i] / (part[i] - part[i + 1]))
