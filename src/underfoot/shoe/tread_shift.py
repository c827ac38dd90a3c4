"""A tread known by its heights, moved under its sole: bevel, rocker and plan form stay."""

import math
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask

from ._kernels.covering_discs import local_width
from ._kernels.regions import between_land, distance_to, nearest_true, rim
from ._kernels.tread_pattern import rotate_coordinates
from .geometry import SoleSurface
from .tread_measures import floor_depth, reached_by_floor

LEAST_LIKENESS = 0.5
"""Correlation of a tread with itself, moved by a period, from which it counts as one."""
LONGEST_PERIOD = 50e-3
"""m"""
_BETWEEN = 0.3  # a pattern is that much less like itself on the way from one period to the next
_STEP = 0.25  # cosine of the least angle between two periods, from 1
_SLOPE_REACH = 3e-3  # m of land beside a channel that tell its slope
_RIM_WEIGHT = 1e-3  # of land beside the rim of the plan form, whose edge is rounded, in that slope
_EDGE_REACH = 3e-3  # m: land farther from all that a floor reaches is no edge of a lug


def tread_periods(surface: SoleSurface) -> Array:
    """Return the shifts (x, y), one row each (1 or 2), m, that map the tread nearly onto itself.

    The shortest peaks of the autocorrelation of land, over the cells that both places have. Bars
    have one. A tread without (or with too few lugs to tell) gets the sum of its median widths of
    lugs and channels, along and across.
    """
    periods: list[Array] = []
    likeness = _likeness(surface)
    for lag in _peaks(likeness):
        if len(periods) == 2:
            break
        if not _differs_on_the_way(likeness, lag):
            continue
        if periods:
            first = periods[0]
            cosine = abs(lag @ first) / (np.linalg.norm(lag) * np.linalg.norm(first))
            apart = all(_differs_on_the_way(likeness, lag + n * first) for n in range(-5, 6))
            if cosine > 1 - _STEP or not apart:
                continue
        periods.append(lag)
    if not periods:
        channel = surface.inside & ~surface.land
        pitch = sum(
            float(np.median(local_width(mask, surface.spacing)[mask]))
            for mask in (channel, surface.land)
            if mask.any()
        )
        return np.diag([min(pitch, LONGEST_PERIOD)] * 2)
    return np.array(periods) * surface.spacing


def tread_place(surface: SoleSurface, periods: Array) -> Array:
    """Return where the tread has most land by its first waves, in shares (n,) of its periods."""
    inside = surface.inside
    x, y = np.meshgrid(surface.x, surface.y, indexing="ij")
    window = inside.astype(np.float64)  # keeps the rim out of the waves
    for place in (x, y):
        ends = place[inside].min(), place[inside].max()
        window *= np.sin(math.pi * np.clip((place - ends[0]) / (ends[1] - ends[0]), 0, 1)) ** 2
    land = window * (surface.land - np.average(surface.land, weights=window))
    shares = np.stack([x, y], axis=-1) @ np.linalg.pinv(periods)
    waves = np.exp(-2j * math.pi * shares)
    return -np.angle(np.einsum("ij,ijk->k", land, waves)) / (2 * math.pi)


def _likeness(surface: SoleSurface) -> Array:
    """Return the correlation of land with itself by lag in cells, lag 0 in the middle.

    -1 where fewer than a third of the cells have a partner, and beyond ``LONGEST_PERIOD``.
    """
    from scipy.signal import fftconvolve

    inside = surface.inside
    value = np.where(inside, surface.land - surface.land[inside].mean(), 0.0)
    known = inside.astype(np.float64)

    def correlate(first: Array, other: Array) -> Array:
        return np.asarray(fftconvolve(first, other[::-1, ::-1]))

    mine, partner = correlate(value**2, known), correlate(known, value**2)
    enough = correlate(known, known) > np.count_nonzero(inside) / 3
    energy = np.sqrt(np.maximum(mine * partner, 1e-30))
    correlation = np.where(enough, correlate(value, value) / energy, -1.0)
    reach = int(LONGEST_PERIOD / surface.spacing)
    i, j = (np.arange(n) - n // 2 for n in correlation.shape)
    return np.where(np.hypot(i[:, None], j) <= reach, correlation, -1.0)


def _peaks(likeness: Array) -> Array:
    """Return the lags (n, 2) in cells of the peaks of a correlation by length, forward ones.

    Between cells by a parabola along each axis, which rounding moves by next to nothing.
    """
    from scipy.ndimage import maximum_filter

    middle = np.array(likeness.shape) // 2
    highest = likeness == maximum_filter(likeness, 5)
    # at the rim too little lies over itself to be alike
    at = np.argwhere(highest & (likeness > LEAST_LIKENESS))
    at = at[(at[:, 0] > middle[0]) | ((at[:, 0] == middle[0]) & (at[:, 1] > middle[1]))]
    if not at.size:
        return np.zeros((0, 2))
    like = likeness[tuple(at.T)]
    at = at[like > like.max() - _BETWEEN / 2]
    lags = (at - middle).astype(np.float64)
    for axis, step in enumerate(np.eye(2, dtype=int)):
        before, here, after = (likeness[tuple((at + n * step).T)] for n in (-1, 0, 1))
        lags[:, axis] += 0.5 * (before - after) / np.minimum(before - 2 * here + after, -1e-12)
    return lags[np.argsort(np.round(np.hypot(*lags.T), 3), kind="stable")]


def _differs_on_the_way(likeness: Array, lag: Array) -> bool:
    """Return whether the tread is unlike itself somewhere between the shift 0 and ``lag``.

    At ``lag`` too counts as between.
    """
    from scipy.ndimage import map_coordinates

    middle = np.array(likeness.shape) // 2
    way = middle[:, None] + np.linspace(0, 1, 33) * lag[:, None]
    along = np.asarray(map_coordinates(likeness, way, order=1, mode="nearest"))
    return bool(along.min() < max(along[-1], LEAST_LIKENESS) - _BETWEEN)


def moved_tread(
    surface: SoleSurface,
    shift: tuple[float, float],
    periods: Array,
    *,
    yaw: float = 0.0,
    pivot: tuple[float, float] = (0.0, 0.0),
) -> SoleSurface:
    """Return the surface with its tread moved by ``shift`` (x, y; m), to whole cells.

    Then it is turned by ``yaw`` (rad, anticlockwise seen from above) about ``pivot`` (x, y; m).
    What stands over the base moves (channels with their walls, rounded edges of lugs), the base
    stays. It is the land that a floor reaches, carried on across the channels by the planes of the
    land on both sides, where these meet below the straight line: a bevel keeps its corner. What
    comes from beyond the plan form is taken one of the ``periods`` (n, 2; m) from there.
    """
    base, inside = carried_base(surface), surface.inside
    over = np.where(inside, np.maximum(surface.height - base, 0.0), 0.0)
    x, y = np.meshgrid(surface.x - pivot[0], surface.y - pivot[1], indexing="ij")
    back = np.array(rotate_coordinates(x, y, yaw)) - (x, y)
    ways = np.asarray(shift)[:, None, None] - back
    cells = _sources(inside, ways / surface.spacing, periods / surface.spacing)
    land = inside & surface.land[cells]
    return replace(
        surface,
        height=np.where(inside, base + over[cells], np.nan),
        land=land,
        tread_depth=np.where(land, surface.tread_depth[cells], 0.0),
        base=np.where(inside, base, np.nan),
    )


def _sources(inside: Mask, shift: Array, periods: Array) -> tuple[NDArray[np.intp], ...]:
    """Return, for each cell, the indices of the cell of the sole that comes to it.

    ``shift`` (2, nx, ny) and ``periods`` (n, 2) are in cells.
    """
    counts = np.array(list(product((0, -1, 1, -2, 2), repeat=len(periods))))
    ways = counts @ periods
    far = np.hypot(*(ways + shift.mean(axis=(1, 2))).T)
    ways = ways[np.argsort(np.round(far, 6), kind="stable")]
    nearest = np.stack(nearest_true(inside))
    sources, known = nearest.copy(), np.zeros_like(inside)
    place = np.indices(inside.shape)
    for way in ways:
        # a half counts as more, whatever its rounding: one processor must not move it elsewhere
        moved = way[:, None, None] + shift
        cells = np.sign(moved) * np.floor(np.abs(moved) + 0.5 + 1e-6)
        there = place - cells.astype(int)
        within = np.all([(t >= 0) & (t < n) for t, n in zip(there, inside.shape, strict=True)], 0)
        there = [np.clip(t, 0, n - 1) for t, n in zip(there, inside.shape, strict=True)]
        new = ~known & within & inside[tuple(there)]
        sources = np.where(new, there, sources)
        known |= new
    return tuple(sources)


def carried_base(surface: SoleSurface) -> Array:
    """Return the height (m) that the sole would have without its tread; nan outside.

    ``land_base`` without the rounded edges of lugs, and with the corners that channels hide. Where
    a channel opens at the rim, the base rises with its floor.
    """
    reached = surface.land & reached_by_floor(surface.height, surface.land, surface.spacing)
    if not reached.any():
        return surface.land_base
    reached |= surface.land & (distance_to(reached) * surface.spacing > _EDGE_REACH)
    steps = max(2, round(_SLOPE_REACH / surface.spacing))
    weight = np.where(rim(surface.inside, steps), _RIM_WEIGHT, 1.0) * reached
    between, beyond = (np.full_like(surface.height, np.nan) for _ in range(2))
    narrowest = np.full_like(surface.height, np.inf)
    for axis in (0, 1):
        height, known = np.moveaxis(surface.height, axis, 0), np.moveaxis(weight, axis, 0)
        planes = _plane_on(height, known, steps), _plane_on(height[::-1], known[::-1], steps)[::-1]
        chord, gap = between_land(height, known > 0)
        lower = np.minimum(np.maximum(*planes), chord)
        lower, gap, only = (np.moveaxis(each, 0, axis) for each in (lower, gap, np.fmax(*planes)))
        nearer = np.isfinite(lower) & (gap < narrowest)
        between, narrowest = np.where(nearer, lower, between), np.where(nearer, gap, narrowest)
        beyond = np.fmax(beyond, only)
    open_ended = ~np.isfinite(between)
    nearest = surface.height[nearest_true(reached)]
    carried = np.where(open_ended, np.fmax(beyond, nearest), between)
    channel = surface.inside & ~surface.land
    over = np.where(channel, surface.height - carried, 0.0)
    floor = floor_depth(over, channel, surface.spacing)
    rounding = np.where(open_ended, np.maximum(over - floor, 0.0), 0.0)
    return np.where(reached, surface.height, carried + rounding)


def _plane_on(height: Array, weight: Array, steps: int) -> Array:
    """Return the plane of the ``steps`` cells of land before each along axis 0; nan without.

    ``weight`` is 0 beside land. The slope is a mean over as many rows on both sides.
    """
    from scipy.ndimage import correlate1d, uniform_filter1d

    place = np.arange(height.shape[0], dtype=np.float64)[:, None]
    known = weight > 0
    value, own = np.where(known, height, 0.0), known.astype(np.float64)
    size = steps + 1

    def before(values: Array) -> Array:
        return np.asarray(
            correlate1d(values, np.ones(size), 0, mode="constant", origin=steps - size // 2)
        )

    count = np.maximum(before(own), 1.0)
    middle, mean = before(own * place) / count, before(value) / count
    counted = np.where(count >= 3, count * weight, 0.0)
    shared, spread = (
        uniform_filter1d(counted * moment, 2 * steps + 1, axis=1)
        for moment in (
            before(value * place) / count - middle * mean,
            before(own * place**2) / count - middle**2,
        )
    )
    slope = np.where(spread > 1e-9, shared / np.maximum(spread, 1e-9), 0.0)
    last = np.maximum.accumulate(np.where(known, place, -1.0), axis=0).astype(int)
    from_there = np.take_along_axis(height, np.maximum(last, 0), 0)
    beyond = np.take_along_axis(slope, np.maximum(last, 0), 0) * (place - last)
    return np.where(last >= 0, from_there + beyond, np.nan)
