"""Land and channels of a sole known by its heights, and measures of its tread."""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core.arrays import Array, Mask

from ._kernels.regions import (
    carried_on,
    distance_to,
    distance_within,
    local_width,
    nearest_true,
    pieces,
    rim,
    without_specks,
)
from .geometry import SoleSurface

WIDEST_CHANNEL = 16e-3
"""A hollow wider than this is shape of the sole, not tread, m."""
SHALLOWEST_CHANNEL = 0.3e-3
"""A hollow shallower than this is texture, not tread, m."""
NOISE_FACTOR = 5.0
"""A channel is at least this many standard deviations of the scan's noise deep."""
SMALLEST_PIECE = 1e-6
"""A channel or lug of less area is a speck, m^2."""
LUG_REACH = 10e-3
"""Land farther than this from every channel is untreaded, m."""


@dataclass(frozen=True, slots=True)
class TreadMap:
    """Land, lug height and the land carried on across the channels; all (nx, ny)."""

    land: Mask
    tread_depth: Array
    base: Array
    level: float
    noise: float


def tread_map(
    height: Array,
    spacing: float,
    *,
    widest: float = WIDEST_CHANNEL,
    channels: Mask | None = None,
) -> TreadMap:
    """Return which parts of a sole are land and how high its lugs stand.

    The base is the grey opening of the height (z up, so channels are peaks) by a square of side
    ``widest``: it takes away every channel narrower than that and leaves slopes, rounded rims and
    toe spring as they are. A cell is channel where it stands more than max(0.3 mm, 5 sigma) over
    the base, sigma the noise of the heights. Lug height: the depth of the nearest channel, 0 on
    land more than 10 mm away from all channels.

    Parameters:
        height: (nx, ny) m in the untilted frame, z up into the shoe, nan outside the plan form.
        spacing: Side of a cell, m.
        widest: Of a channel, m.
        channels: Cells that are known to be channel beside those found.
    """
    from scipy.ndimage import maximum_filter, minimum_filter

    inside = np.isfinite(height)
    side = 2 * math.ceil(widest / spacing / 2) + 1
    # windows may hang over the rim, so that a rim that rises stays what it is
    padded = np.pad(np.where(inside, height, np.inf), side, constant_values=np.inf)
    low = minimum_filter(padded, side)
    opened = maximum_filter(np.where(np.isfinite(low), low, -np.inf), side)[side:-side, side:-side]
    noise = height_noise(height)
    level = max(SHALLOWEST_CHANNEL, NOISE_FACTOR * noise)
    channel = inside & (np.where(inside, height, 0.0) - np.where(inside, opened, 0.0) > level)
    if channels is not None:
        channel |= inside & channels
    cells = max(1, math.ceil(SMALLEST_PIECE / spacing**2))
    channel = without_specks(channel, cells)
    channel |= inside & ~channel & ~without_specks(inside & ~channel, cells)
    land = inside & ~channel
    if not land.any():
        land, channel = inside.copy(), np.zeros_like(inside)
    base = carried_on(height, land)
    if not channel.any():
        return TreadMap(land, np.zeros_like(height), base, level, noise)
    depth = np.where(channel, np.maximum(height - base, 0.0), 0.0)
    full = maximum_filter(depth, 2 * max(1, round(1.5e-3 / spacing)) + 1)
    far = distance_to(channel) * spacing > LUG_REACH
    lugs = np.where(land & ~far, full[nearest_true(channel)], 0.0)
    return TreadMap(land, lugs, base, level, noise)


def height_noise(height: Array) -> float:
    """Return the noise of a height map, m: 1.4826 median |second difference| / sqrt(6), along x.

    On a smooth sole the second difference of neighbours holds nothing else: sharp walls are few
    enough not to move the median.
    """
    second = height[2:] - 2 * height[1:-1] + height[:-2]
    second = second[np.isfinite(second)]
    return 0.0 if second.size == 0 else float(1.4826 * np.median(np.abs(second)) / math.sqrt(6))


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
