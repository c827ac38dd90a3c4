"""Measures of a tread: land, channels, how they drain, lugs and the largest untreaded patch."""

from dataclasses import dataclass

import numpy as np

from underfoot.core.arrays import Array, Mask

from ._kernels.local_width import local_width
from ._kernels.pieces import distance_within, pieces, rim
from .sole_surface import SoleSurface
from .tread_map import SMALLEST_PIECE

SHARES = (10, 50, 90)
"""Percentiles by area at which distributions are given."""


@dataclass(frozen=True, slots=True)
class TreadMeasures:
    """Numbers of a tread; lengths in m, areas in m^2, shares 0 to 1, None where there is none.

    Parameters:
        length, width, plan_area: Of the plan form.
        land_ratio: Land area / plan area.
        channel_depth: 10, 50 and 90 % by channel area of the depth below the land around.
        channel_width: The same of the local width: the largest disc in the channel that covers a
            place.
        drained_share: Of the channel area: connected through channels to the rim of the plan form.
        lug_count: Pieces of land of 1 mm^2 and more, not connected by an edge of a cell.
        lug_area: 10, 50 and 90 % of the area of these pieces (each counts once).
        patch_area, patch_length, patch_width, patch_circle: Of the largest piece of land: its area,
            extent along and across the shoe, and the diameter of the largest circle in it.
        free_circle: Diameter of the largest circle without channel anywhere in the plan form.
    """

    length: float
    width: float
    plan_area: float
    land_ratio: float
    channel_depth: tuple[float, float, float] | None
    channel_width: tuple[float, float, float] | None
    drained_share: float | None
    lug_count: int
    lug_area: tuple[float, float, float]
    patch_area: float
    patch_length: float
    patch_width: float
    patch_circle: float
    free_circle: float


def tread_measures(surface: SoleSurface) -> TreadMeasures:
    """Return the measures of a sole's tread; docs/guide/outsole_files.md has each formula."""
    inside, land, spacing = surface.inside, surface.land, surface.spacing
    channel = inside & ~land
    depth = width = drained = None
    if channel.any():
        depth = _shares(channel_depth(surface)[channel])
        width = _shares(local_width(channel, spacing)[channel])
        drained = float(np.count_nonzero(draining(surface)) / np.count_nonzero(channel))
    areas = np.bincount(pieces(land)[0].ravel())[1:].astype(np.float64) * spacing**2
    lugs = areas[areas >= SMALLEST_PIECE * (1 - 1e-9)]
    lugs = areas if lugs.size == 0 else lugs
    patch = largest_patch(surface)
    along, across = np.nonzero(patch.any(axis=1))[0], np.nonzero(patch.any(axis=0))[0]
    radius = distance_within(land)

    def circle(within: Mask) -> float:
        return float(max(2 * radius[within].max() - 0.5, 1.0)) * spacing

    return TreadMeasures(
        length=surface.length,
        width=surface.width,
        plan_area=surface.plan_area,
        land_ratio=surface.land_ratio,
        channel_depth=depth,
        channel_width=width,
        drained_share=drained,
        lug_count=int(lugs.size),
        lug_area=_shares(lugs),
        patch_area=float(areas.max()),
        patch_length=float(np.ptp(along) + 1) * spacing,
        patch_width=float(np.ptp(across) + 1) * spacing,
        patch_circle=circle(patch),
        free_circle=circle(land),
    )


def largest_patch(surface: SoleSurface) -> Mask:
    """Return the largest connected piece of land."""
    numbers, _ = pieces(surface.land)
    return numbers == int(np.argmax(np.bincount(numbers.ravel())[1:])) + 1


def channel_depth(surface: SoleSurface) -> Array:
    """Return the depth (m) of the channels below the land around; 0 on land, nan outside."""
    channel = surface.inside & ~surface.land
    below = np.where(channel, np.maximum(surface.height - surface.land_base, 0.0), 0.0)
    return np.where(surface.inside, below, np.nan)


def draining(surface: SoleSurface) -> Mask:
    """Return which cells of the channels are connected to the rim through channels."""
    numbers, _ = pieces(surface.inside & ~surface.land)
    return np.isin(numbers, np.setdiff1d(numbers[rim(surface.inside)], [0]))


def _shares(values: Array) -> tuple[float, float, float]:
    low, middle, high = np.percentile(values, SHARES)
    return float(low), float(middle), float(high)
