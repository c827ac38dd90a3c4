"""Down to which wavelength a measurement can be believed."""

from dataclasses import dataclass

import numpy as np

from underfoot.core.units import metres

from .heights import Heights, Profile

POINTS_PER_WAVE = 5
"""ISO 3274:1996 pairs a short cut-off of 2.5 um with a spacing of at most 0.5 um."""


@dataclass(frozen=True, slots=True)
class Resolution:
    """Shortest wavelength, m, that can be believed, and why not a shorter one."""

    wavelength: float
    reason: str


def shortest_reliable_wavelength(surface: Heights) -> Resolution:
    """Return the shortest wavelength that can be believed: the largest of three limits.

    - five points to a wave (ISO 3274), or two where the resolution is known;
    - the instrument's own resolution, where the surface knows it;
    - the tip: the scale below which the sharpest peak met at that scale is sharper than half the
      curvature of the stylus, where its radius is known (criterion of Sanner et al., Appl. Surf.
      Sci. Adv. 7 (2022) 100190: shortest stencil from which on the largest negative second
      difference stays below 1 / (2 R)).
    """
    known = surface.resolution
    limits = [_sampling(surface, POINTS_PER_WAVE if known is None else 2)]
    if known is not None:
        limits.append(Resolution(known, "resolution of the instrument"))
    radius = surface.tip_radius if isinstance(surface, Profile) else None
    if radius is not None:
        reason = f"radius of the tip, {radius:.4g} m: sharper peaks are rounded"
        limits.append(Resolution(_tip_limit(surface.heights, surface.spacing, radius), reason))
    return max(limits, key=lambda limit: limit.wavelength)


def shortest_derivable_wavelength(surface: Heights) -> Resolution:
    """Return the limit for slopes and curvatures by differences: five points to a wave at least."""
    limits = (shortest_reliable_wavelength(surface), _sampling(surface, POINTS_PER_WAVE))
    return max(limits, key=lambda limit: limit.wavelength)


def _sampling(surface: Heights, points: int) -> Resolution:
    reason = f"{points} points to a wave at a spacing of {metres(surface.spacing)}"
    return Resolution(points * surface.spacing, reason)


def _tip_limit(heights: np.ndarray, spacing: float, radius: float) -> float:
    reaches = np.unique(np.geomspace(1, max(heights.size // 3, 1), 60).astype(int))
    limit = 0.0
    for k, following in zip(reaches, [*reaches[1:], reaches[-1]], strict=True):
        second = (heights[2 * k :] - 2.0 * heights[k:-k] + heights[: -2 * k]) / (k * spacing) ** 2
        if second.size and float(-second.min()) > 0.5 / radius:
            limit = 2.0 * float(following) * spacing
    return limit
