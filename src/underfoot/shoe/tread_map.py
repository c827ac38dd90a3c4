"""Land, channels and lug heights of a sole that is known by its heights alone."""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core.arrays import Array, Mask

from ._kernels.land import carried_on, nearest_true
from ._kernels.pieces import distance_to, without_specks

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
