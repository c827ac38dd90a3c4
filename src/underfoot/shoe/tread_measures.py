"""Land and channels of a sole known by its heights, and measures of its tread."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from underfoot.core.arrays import Array, Mask

from ._kernels.covering_discs import channel_width, covering_value, local_width
from ._kernels.regions import (
    Labels,
    Nearest,
    across_channels,
    carried_on,
    distance_to,
    distance_within,
    draining,
    nearest_true,
    pieces,
    rim,
    without_specks,
)
from ._kernels.rolling import rolled_base
from .geometry import BESIDE_A_WALL, SoleSurface

ROLLING_RADIUS = 0.5
"""Of the paraboloid that tells land: hollows of a larger radius are the sole's shape, m."""
STEEPEST_RIM = (0.5, 0.3)
"""Slopes along and across up to which a rim that rises is land: toe spring, bevels."""
SHALLOWEST_CHANNEL = 0.3e-3
"""A hollow shallower than this is texture, not tread, m."""
NOISE_FACTOR = 6.0
"""A channel is this many standard deviations of the noise deep: the base lies 3 below the land."""
WIDEST_CHANNEL = 50e-3
"""A hollow wider than this is an arch: no land, but no channel with depth and width, m."""
_ROUNDED = (0.25, 3.0)  # slope of a rounded edge: no floor of a channel, no wall
_SLOPE_REACH = 0.5e-3  # m
_GRAZED = (2e-3, 0.12)  # m from the rim, slope of the floor there
_EDGE = (1e-3, 0.1e-3)  # m on both sides of a lug's edge, and what the heights bend there at least
_EDGED = 0.2  # of the border of land with channels
_REACHED = 30e-6  # m
_MOST_NOISE = 0.1e-3  # m: to begin with
QUIET = 15e-6
"""Noise of a scan's heights that stays on its land, m: less than the roughness of soles hides."""
SMOOTHED = 5e-3
"""Longest side of the squares of land that noise is averaged over, m."""
WIDEST_SIPE = 1.2e-3
"""A channel narrower than this is a slit, m."""
SHORTEST_SIPE = 3e-3
"""Of a slit that counts, m."""
MOST_OPEN = 1 / 3
"""Share of a slit's walls that may be the outline of the sole: half of them is a channel's rest."""
SMALLEST_PIECE = 1e-6
"""A channel or lug of less area is a speck, m^2."""
_SMOOTHED = 1e-3
"""m between the cells that the usual height of lugs is taken of."""
_LOWER = (0.5, 1e-3)
"""A lower lug stands up from half of the channels' depth beside it, and is wider than this, m."""
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
    height: Array, spacing: float, *, channels: Mask | None = None, lag: int = 1
) -> TreadMap:
    """Return which parts of a sole are land and how high its lugs stand.

    The base is what a paraboloid of radius 0.5 m rolled under the sole reaches (``rolled_base``):
    slopes, rounded rims and toe spring stay as they are, a gap of any width is left out unless it
    is shallower than its width^2 / (8 x 0.5 m). A cell is land where it stands no more than
    max(0.3 mm, 6 sigma) over the base, sigma the noise of the heights; all else is channel. Lug
    height: the depth of the nearest channel, 0 on land more than 10 mm away from all channels.

    Parameters:
        height: (nx, ny) m in the untilted frame, z up into the shoe, nan outside the plan form.
        spacing: Side of a cell, m.
        channels: Cells that are known to be channel beside those found.
        lag: Cells between heights that don't share noise: the scan's distance of points.
    """
    from scipy.ndimage import maximum_filter

    inside = np.isfinite(height)
    onto = nearest_true(inside)
    rolled = rolled_base(height, spacing, ROLLING_RADIUS, STEEPEST_RIM)
    above = height - rolled
    raised = np.where(inside, np.minimum(above, _rounded_rim(height, spacing, onto)), -np.inf)
    # walls count as noise until the land is known
    begin = raised > _level(min(height_noise(height), _MOST_NOISE))
    noise = height_noise(np.where(begin, np.nan, height), lag)
    begin = raised > _level(noise)
    noise = height_noise(np.where(begin, np.nan, height), lag)
    level = _level(noise)
    channel = inside & (raised > level)
    if channels is not None:
        channel |= inside & channels
    cells = max(1, math.ceil(SMALLEST_PIECE / spacing**2))
    channel = without_specks(channel, cells)
    channel |= inside & ~channel & ~without_specks(inside & ~channel, cells)
    land = inside & ~channel
    # what only a tilted floor grazes, along the rim, is no land; a facet that lies like the land
    # beside it, beyond the rounding of the rim, is
    numbers, _ = pieces(land)
    steps = max(1, round(_GRAZED[0] / spacing))
    deeper = numbers[land & ~rim(inside, steps)]
    slopes = _slopes(rolled[onto], spacing)
    steep = np.hypot(*slopes) > _GRAZED[1]
    if (flat := land & ~rim(inside, 2 * steps)).any():
        beside = nearest_true(flat)
        plane, way = slopes[:, *beside], spacing * (np.indices(height.shape) - beside)
        off = np.abs(rolled - rolled[beside] - (plane * way).sum(axis=0))
        steep &= (off > SHALLOWEST_CHANNEL) | (np.hypot(*(slopes - plane)) > _GRAZED[1])
    steepness = np.bincount(numbers.ravel(), steep.ravel()) / np.maximum(
        np.bincount(numbers.ravel()), 1
    )
    land &= np.isin(numbers, deeper) | (steepness[numbers] < 0.5)
    land &= ~_bare_ends(height, land, spacing, onto)
    channel = inside & ~land
    if not land.any():
        land, channel = inside.copy(), np.zeros_like(inside)
    # the edges of lugs and the rim may be rounded: what lies between other land is known best
    with np.errstate(invalid="ignore"):
        flat = land & (raised <= _least_height(noise))
    sound = across_channels(height, flat & ~rim(inside, steps))
    base = carried_on(height, land)
    base = np.where(land | ~np.isfinite(sound), base, sound)
    if not channel.any():
        return TreadMap(land, np.zeros_like(height), base, level, noise)
    depth = np.where(inside, np.where(channel, np.maximum(height - base, 0.0), 0.0), np.nan)
    far = distance_to(channel) * spacing > LUG_REACH
    # of a channel that the rim cuts the nearest cells may show nothing but its wall
    window = 1 + 2 * max(1, round(BESIDE_A_WALL / spacing))
    floor = maximum_filter(floor_depth(depth, channel, spacing), window)
    lugs = np.where(land & ~far, floor[nearest_true(channel)], 0.0)
    # what falls away at the rim is no floor of a channel where another is within reach, nor does
    # one with land on one side alone count where there is a better
    for floors in (channel & ~steep, channel & ~steep & np.isfinite(sound)):
        if floors.any():
            near = land & (distance_to(floors) * spacing <= LUG_REACH)
            lugs = np.where(near, floor[nearest_true(floors)], lugs)
    treaded = land & (lugs > 0)
    lugs = _without_ends(lugs, treaded, inside, spacing)
    return TreadMap(land, lugs, base, level, noise)


def _without_ends(lugs: Array, treaded: Mask, inside: Mask, spacing: float) -> Array:
    """Return lug heights (m) with those near the rim as most of them are within a lug's reach.

    Where a channel runs out over the rim the land that it is measured from is a guess.
    """
    if not (ends := treaded & rim(inside, round(LUG_REACH / spacing))).any():
        return lugs
    step = max(1, round(_SMOOTHED / spacing))
    coarse = lugs[nearest_true(treaded)][::step, ::step]
    reach = round(LUG_REACH / (step * spacing))
    window = (1 + 2 * reach, 1 + 2 * reach)
    around = sliding_window_view(np.pad(coarse, reach, mode="edge"), window)
    i, j = np.nonzero(ends)
    cells, of_cell = np.unique(
        np.ravel_multi_index((i // step, j // step), coarse.shape), return_inverse=True
    )
    # the median of all windows would take five times as long
    usual = np.median(around[np.unravel_index(cells, coarse.shape)], axis=(1, 2))
    without = lugs.copy()
    without[i, j] = usual[of_cell]
    return without


def _bare_ends(height: Array, land: Mask, spacing: float, onto: Nearest) -> Mask:
    """Return pieces of land that are the floor of channels, where a tilted floor reaches it.

    Such a piece lies above other land and goes over into channel without an edge: an end of the
    sole without lugs.
    """
    if not land.any():
        return land
    numbers, count = pieces(land)
    if count < 2:
        return np.zeros_like(land)
    inside = np.isfinite(height)
    filled = height[onto]
    steps = max(1, round(_EDGE[0] / spacing))
    wide = np.pad(filled, steps, mode="edge")
    n, m = height.shape
    bend = np.zeros_like(filled)
    for axis in (0, 1):
        before, after = (
            wide[steps + way * (axis == 0) :, steps + way * (axis == 1) :][:n, :m]
            for way in (-steps, steps)
        )
        bend = np.maximum(bend, np.abs(before + after - 2 * filled))
    border = land & (distance_to(inside & ~land) <= 1.0)
    lengths = np.bincount(numbers[border], minlength=count + 1)
    edged = np.bincount(numbers[border & (bend > _EDGE[1])], minlength=count + 1)
    lowest = np.full(count + 1, np.inf)
    np.minimum.at(lowest, numbers[land], height[land])
    bare = (lengths > 0) & (edged < _EDGED * lengths)
    bare &= lowest > lowest[1:].min() + SHALLOWEST_CHANNEL
    bare[0] = False
    return bare[numbers]


def reached_by_floor(height: Array, land: Mask, spacing: float) -> Mask:
    """Return the land that a nearly flat floor reaches: not the rounded edges of lugs.

    What stands no more than max(30 um, 6 sigma) over the base of ``tread_map``.
    """
    rolled = rolled_base(height, spacing, ROLLING_RADIUS, STEEPEST_RIM)
    onto = nearest_true(np.isfinite(height))
    above = np.minimum(height - rolled, _rounded_rim(height, spacing, onto))
    noise = height_noise(np.where(land, height, np.nan))
    with np.errstate(invalid="ignore"):
        return land & (above <= _least_height(noise))


def _least_height(noise: float) -> float:
    return max(_REACHED, NOISE_FACTOR * noise)


def _rounded_rim(height: Array, spacing: float, onto: Nearest) -> Array:
    """Return the height over what a paraboloid that follows steep rims reaches; inf elsewhere.

    Steep and no wall: a slope of 0.25 to 3. A rounded edge is shape of the sole, the level floor
    of a channel that opens at the rim is not. ``onto``: the nearest cell inside of each.
    """
    inside = np.isfinite(height)
    slope = np.hypot(*_slopes(height[onto], spacing))
    above = height - rolled_base(height, spacing, ROLLING_RADIUS, (_ROUNDED[1], _ROUNDED[1]))
    steep = inside & (slope > _ROUNDED[0]) & (slope < _ROUNDED[1])
    return np.where(steep, above, np.inf)


def _level(noise: float) -> float:
    return max(SHALLOWEST_CHANNEL, NOISE_FACTOR * noise)


def _slopes(height: Array, spacing: float) -> Array:
    """Return the slopes along and across (2, nx, ny) over 1 mm of heights known everywhere."""
    steps = max(1, round(_SLOPE_REACH / spacing))
    filled = np.pad(height, steps, mode="edge")
    along = filled[2 * steps :, steps:-steps] - filled[: -2 * steps, steps:-steps]
    across = filled[steps:-steps, 2 * steps :] - filled[steps:-steps, : -2 * steps]
    return np.array([along, across]) / (2 * steps * spacing)


def height_noise(height: Array, lag: int = 1) -> float:
    """Return the noise of a height map, m: 1.4826 median |third difference| / sqrt(20), along x.

    Of heights ``lag`` cells apart, which don't share noise: on a sole of even curvature the
    difference holds nothing else; sharp walls are few enough not to move the median.
    """
    a, b, c, d = (height[n * lag : max(0, height.shape[0] - (3 - n) * lag)] for n in range(4))
    third = d - 3 * c + 3 * b - a
    third = third[np.isfinite(third)]
    return 0.0 if third.size == 0 else float(1.4826 * np.median(np.abs(third)) / math.sqrt(20))


def without_noise(height: Array, land: Mask, noise: float, spacing: float, lag: int = 1) -> Array:
    """Return heights (m) whose land has the planes that fit a square of land around each cell.

    The square holds as many points of a scan as leave ``QUIET`` of their noise, at most
    ``SMOOTHED`` a side: on a lug noise is no shape, and the film would see it as one. Fitted to
    the land alone, so that walls and channels stay; a lug too small to tell a slope gets its mean.
    """
    from scipy.ndimage import uniform_filter

    if noise <= QUIET:
        return height
    side = min(lag * spacing * noise / QUIET, SMOOTHED)
    size = 2 * max(1, round(side / 2 / spacing)) + 1
    places = spacing * np.indices(height.shape).astype(np.float64)
    x, y = np.asarray(places[0]), np.asarray(places[1])
    z = np.where(land, height, 0.0)
    own = land.astype(np.float64)

    def mean(values: Array) -> Array:
        return np.asarray(uniform_filter(own * values, size, mode="constant"))

    count = np.maximum(mean(own), 1e-9)
    mx, my, mz = (mean(each) / count for each in (x, y, z))
    xx, yy, xy = (
        mean(a) / count - b for a, b in ((x * x, mx * mx), (y * y, my * my), (x * y, mx * my))
    )
    xz, yz = mean(x * z) / count - mx * mz, mean(y * z) / count - my * mz
    spread = xx * yy - xy**2
    told = spread > spacing**4
    spread = np.where(told, spread, np.inf)
    along, across = (xz * yy - yz * xy) / spread, (yz * xx - xz * xy) / spread
    return np.where(land, mz + along * (x - mx) + across * (y - my), height)


SHARES = (10, 50, 90)
"""Percentiles by area at which distributions are given."""


@dataclass(frozen=True, slots=True)
class TreadMeasures:
    """Numbers of a tread; lengths in m, areas in m^2, shares 0 to 1, None where there is none.

    Parameters:
        length, width, plan_area: Of the plan form.
        land_ratio: Land area / plan area.
        channel_depth: 10, 50 and 90 % by channel area of the depth of the channel's floor below
            the land around; arches (hollows wider than 50 mm) left out, as in the width.
        channel_width: The same of the local width: the largest disc in the channel that covers a
            place.
        drained_share: Of the channel area: connected through channels to the rim of the plan form.
        sipe_count, sipe_length: Slits narrower than 1.2 mm and longer than 3 mm (parts of them
            between wider channels count each); their length in all.
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
    sipe_count: int
    sipe_length: float
    lug_count: int
    lug_area: tuple[float, float, float]
    patch_area: float
    patch_length: float
    patch_width: float
    patch_circle: float
    free_circle: float


def tread_measures(surface: SoleSurface, walls: Array | None = None) -> TreadMeasures:
    """Return the measures of a sole's tread; docs/guide/outsole_files.md has each formula.

    Where lugs end is known within half a cell; of ``walls`` (n, 2, 2; m), lines at which they do,
    land share, widths and lengths of slits are those of the lines.
    """
    inside, land, spacing = surface.inside, surface.land, surface.spacing
    channel = inside & ~land
    depth = width = drained = None
    sipe_count, sipe_length, land_ratio = 0, 0.0, surface.land_ratio
    if channel.any():
        deep = channel_depth(surface)
        open_ground = channel & ~lower_lugs(deep, channel, spacing)
        widths = channel_width(open_ground, spacing)
        if walls is not None and len(walls):
            area, length = _beyond_walls(surface, walls)
            widths = _width_of_walls(widths, open_ground, area, length, spacing)
            land_ratio += float(area.sum()) / surface.plan_area
        counted = open_ground & (widths <= WIDEST_CHANNEL)
        counted = counted if counted.any() else open_ground
        floor = floor_depth(deep, channel, spacing)
        depth = _shares(floor[counted])
        sipe_count, sipe_length = _sipes(open_ground, surface.inside, widths, spacing)
        width = _shares(widths[counted])
        drained = float(
            np.count_nonzero(draining(surface.inside, channel)) / np.count_nonzero(channel)
        )
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
        land_ratio=land_ratio,
        channel_depth=depth,
        channel_width=width,
        drained_share=drained,
        sipe_count=sipe_count,
        sipe_length=sipe_length,
        lug_count=int(lugs.size),
        lug_area=_shares(lugs),
        patch_area=float(areas.max()),
        patch_length=float(np.ptp(along) + 1) * spacing,
        patch_width=float(np.ptp(across) + 1) * spacing,
        patch_circle=circle(patch),
        free_circle=circle(land),
    )


def _beyond_walls(surface: SoleSurface, walls: Array) -> tuple[Array, Array]:
    """Return the area (m^2) by which cells of channels lie beyond walls, and the walls' length (m).

    Of each cell (nx, ny) in which a piece of a wall lies; less than 0 where they end before it.
    """
    from scipy.ndimage import map_coordinates

    long = np.hypot(*(walls[:, 1] - walls[:, 0]).T)
    count = np.maximum(np.ceil(long / surface.spacing), 1).astype(int)
    number = np.repeat(np.arange(len(walls)), count)
    part = np.arange(len(number)) - np.repeat(np.cumsum(count) - count, count)
    share = ((part + 0.5) / count[number])[:, None]
    places = walls[number, 0] * (1 - share) + walls[number, 1] * share
    long = long[number] / count[number]
    channel = surface.inside & ~surface.land
    into = distance_within(channel) - distance_within(~channel)
    into = np.where(channel, into - 0.5, into + 0.5) * surface.spacing
    cells = [(place - at[0]) / surface.spacing for place, at in
             zip(places.T, (surface.x, surface.y), strict=True)]  # fmt: skip
    i, j = (np.rint(cell).astype(int) for cell in cells)
    near = (i >= 0) & (j >= 0) & (i < channel.shape[0]) & (j < channel.shape[1])
    off = map_coordinates(into, cells, order=1, mode="nearest")
    near[near] &= surface.inside[i[near], j[near]] & (np.abs(off[near]) < surface.spacing)
    area, length = np.zeros(channel.shape), np.zeros(channel.shape)
    np.add.at(area, (i[near], j[near]), (off * long)[near])
    np.add.at(length, (i[near], j[near]), long[near])
    return area, length


def _width_of_walls(
    widths: Array, channel: Mask, area: Array, length: Array, spacing: float
) -> Array:
    """Return the widths (m) of a channel's cells less what they lie beyond the walls around them.

    ``area`` and ``length`` as ``_beyond_walls``; the mean within a channel's width and a cell.
    """
    from scipy.ndimage import uniform_filter

    exact, reach, done = widths.copy(), 2, ~channel
    while not done.all():
        here = ~done & (widths <= reach * spacing)
        if here.any():
            window = 2 * reach + 3
            off, long = (uniform_filter(each, window, mode="constant") for each in (area, length))
            known = here & (long > 1e-3 * spacing / window**2)
            exact[known] -= 2 * off[known] / long[known]
        done |= here
        reach *= 2
    return np.where(channel, np.maximum(exact, spacing / 4), 0.0)


def _sipes(channel: Mask, inside: Mask, widths: Array, spacing: float) -> tuple[int, float]:
    """Return how many slits there are and their length in all, m."""
    numbers, count = _slit_pieces(channel & (widths < WIDEST_SIPE), inside, spacing)
    areas, mean_widths = _slit_widths(numbers, count, spacing)
    return count, float((areas / mean_widths).sum())


def _slit_pieces(narrow: Mask, inside: Mask, spacing: float) -> tuple[Labels, int]:
    """Return the number of the slit of each cell and how many count.

    Those that are long enough and have land on both sides: what the outline leaves of a channel is
    none.
    """
    from scipy.ndimage import find_objects

    numbers, count = pieces(narrow, diagonal=True)
    extent = [math.hypot(*(s.stop - s.start for s in box)) for box in find_objects(numbers)]
    long_enough = np.array([False, *(cells * spacing >= SHORTEST_SIPE for cells in extent)])
    walls, open_walls = np.zeros((2, count + 1))
    for axis in (0, 1):
        for step in (1, -1):
            beside = np.roll(np.pad(numbers, 1), step, axis)[1:-1, 1:-1] > 0
            sole = np.roll(np.pad(inside, 1), step, axis)[1:-1, 1:-1]
            walls += np.bincount(numbers[~beside], minlength=count + 1)
            open_walls += np.bincount(numbers[~sole], minlength=count + 1)
    long_enough &= open_walls < MOST_OPEN * walls
    rank = np.cumsum(long_enough) * long_enough
    return rank[numbers], int(rank.max())


def _slit_widths(numbers: Labels, count: int, spacing: float) -> tuple[Array, Array]:
    """Return area (m^2) and mean width (m) of each slit, however it bends.

    Width: 2 area / perimeter, the perimeter by the Crofton formula over four directions, which is
    within 5 % at any angle (along the axes 5 % short).
    """
    padded = np.pad(numbers, 1)
    crossings = np.zeros(count + 1)
    for step, weight in (((1, 0), 1.0), ((0, 1), 1.0), ((1, 1), 0.5**0.5), ((1, -1), 0.5**0.5)):
        leaving = padded[padded != np.roll(padded, step, (0, 1))]
        crossings += weight * np.bincount(leaving, minlength=count + 1)
    cells = np.bincount(numbers.ravel(), minlength=count + 1)[1:].astype(np.float64)
    areas = cells * spacing**2
    return areas, 2 * areas / (math.pi / 4 * spacing * crossings[1:])


@dataclass(frozen=True, slots=True)
class SurfaceSlits:
    """Slits of a height map; ``mask`` marks them, arrays (nx, ny) hold those of the nearest one.

    ``width`` and ``depth`` in m, ``tangent`` the unit vector along it (two arrays).
    """

    mask: Mask
    width: Array
    depth: Array
    tangent: tuple[Array, Array]


def surface_without_slits(
    surface: SoleSurface, widest: float
) -> tuple[SoleSurface, SurfaceSlits | None]:
    """Return the surface with its slits narrower than ``widest`` (m) filled, and these.

    Slits as ``TreadMeasures`` counts them, each with its mean width and median depth. Land
    beside them is as high as the wider channels around are deep; where none is near, as the slits.
    """
    from scipy.ndimage import gaussian_filter, median

    channel, spacing = surface.inside & ~surface.land, surface.spacing
    if not channel.any():
        return surface, None
    widths = local_width(channel, spacing)
    numbers, count = _slit_pieces(
        channel & (widths < min(widest, WIDEST_SIPE)), surface.inside, spacing
    )
    if count == 0:
        return surface, None
    mask = numbers > 0
    nearest = nearest_true(mask)
    each = np.arange(1, count + 1)
    floor = floor_depth(channel_depth(surface), channel, spacing)
    _, mean_widths = _slit_widths(numbers, count, spacing)
    of_each = mean_widths, np.asarray(median(floor, numbers, each))
    width, depth = (np.append(0.0, values)[numbers][nearest] for values in of_each)
    # the direction in which the mask changes least
    reach = max(float(width[mask].max()) / spacing, 1.0)
    slope = np.gradient(gaussian_filter(mask.astype(np.float64), 0.5 * reach))
    xx, xy, yy = (
        gaussian_filter(one * other, reach)
        for one, other in ((slope[0], slope[0]), (slope[0], slope[1]), (slope[1], slope[1]))
    )
    across = 0.5 * np.arctan2(2 * xy, xx - yy)[nearest]
    land, wide = surface.land | mask, channel & ~mask
    lugs = np.where(land, depth, 0.0)
    if wide.any():
        near = distance_to(wide) * spacing <= LUG_REACH
        lugs = np.where(land & near, floor[nearest_true(wide)], lugs)
        lugs = np.where(near | (distance_to(mask) * spacing <= LUG_REACH), lugs, 0.0)
    filled = replace(
        surface,
        height=np.where(mask, surface.land_base, surface.height),
        land=land,
        tread_depth=lugs,
        base=surface.land_base,
    )
    return filled, SurfaceSlits(mask, width, depth, (-np.sin(across), np.cos(across)))


def largest_patch(surface: SoleSurface) -> Mask:
    """Return the largest connected piece of land."""
    numbers, _ = pieces(surface.land)
    return numbers == int(np.argmax(np.bincount(numbers.ravel())[1:])) + 1


def channel_depth(surface: SoleSurface) -> Array:
    """Return the depth (m) of the channels below the land around; 0 on land, nan outside."""
    channel = surface.inside & ~surface.land
    below = np.where(channel, np.maximum(surface.height - surface.land_base, 0.0), 0.0)
    return np.where(surface.inside, below, np.nan)


def floor_depth(depth: Array, channel: Mask, spacing: float) -> Array:
    """Return, per cell of the channels, the depth (m) at the middle of the channel over the cell.

    That of the middle of the largest disc in the channel that covers the cell: drafted walls and
    fillets take the depth of the floor beside them. On a lower lug its own depth below the land.
    """
    lower = lower_lugs(depth, channel, spacing)
    floor = np.zeros_like(depth)
    for each in (channel & ~lower, lower):
        floor = np.where(each, covering_value(each, np.where(each, depth, 0.0)), floor)
    return floor


def lower_lugs(depth: Array, channel: Mask, spacing: float) -> Mask:
    """Return what stands in the channels between deeper ones: lugs that are lower than others.

    Higher than half of the deepest channel within ``LUG_REACH``, wider than 1 mm, and with more
    channel than land along its border.
    """
    from scipy.ndimage import binary_opening, maximum_filter

    deepest = maximum_filter(
        np.where(channel, depth, 0.0), 1 + 2 * max(1, round(LUG_REACH / spacing))
    )
    shallow = channel & (depth < _LOWER[0] * deepest)
    side = 1 + max(1, round(_LOWER[1] / spacing))
    opened = np.asarray(binary_opening(shallow, np.ones((side, side))), dtype=np.bool_)
    numbers, count = pieces(opened)
    beside = np.zeros((2, count + 1))
    for axis in (0, 1):
        for step in (1, -1):
            padded = np.pad(numbers, 1)
            next_to = np.roll(padded, step, axis)
            for n, ground in enumerate((channel, ~channel & np.isfinite(depth))):
                met = (padded == 0) & (next_to > 0) & np.pad(ground, 1)
                beside[n] += np.bincount(next_to[met], minlength=count + 1)
    return np.isin(numbers, np.flatnonzero(beside[0] > beside[1]))


def arch_area(tread: TreadMap, inside: Mask, spacing: float) -> float:
    """Return the area of the hollows wider than 50 mm, m^2."""
    channel = inside & ~tread.land
    if not channel.any():
        return 0.0
    wide = local_width(channel, spacing) > WIDEST_CHANNEL
    return float(np.count_nonzero(wide & channel)) * spacing**2


def _shares(values: Array) -> tuple[float, float, float]:
    low, middle, high = np.percentile(values, SHARES)
    return float(low), float(middle), float(high)
