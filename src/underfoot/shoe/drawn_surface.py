"""A sole from a file as it is drawn: lugs up to their rims, floors of channels as they are."""

from dataclasses import replace

import numpy as np

from underfoot.core.arrays import Array, Mask

from ._kernels.regions import grow_mask, nearest_true, pieces
from .geometry import SoleSurface

_RIM = 0.5
"""Of its height, by which the rounded rim of a lug may stand over its land."""
_STEEP = 2.0
"""Slope within a channel beyond which a cell is of a wall."""
_WIDE = 1.5e-3
"""m over which the plan form is smoothed to know where its rim faces."""
_OUTWARD = 0.5
"""Least share of the slope along the rim that a rounded rim rises out of it: at corners both."""
_ON_WALLS = 3
"""Cells of a wall that have the floor beside them."""


def rounded_rims(surface: SoleSurface) -> Mask:
    """Return the cells of channels that are the rounded rim of a lug: they rise to the outside.

    A floor does not touch them, so that they are no land; they are drawn with their lug.
    """
    from scipy.ndimage import gaussian_filter

    height, land, inside = surface.height, surface.land, surface.inside
    if not land.any() or land.all():
        return np.zeros_like(land)
    beside = nearest_true(land)
    lugs = surface.tread_depth[beside]
    least = _RIM * np.where(lugs > 0, lugs, np.inf)
    raised = inside & ~land & (height - height[beside] < least)
    slopes = [_slope(np.where(raised | land, height, np.nan), axis) for axis in (0, 1)]
    # out of the plan form, notches of its edge smoothed out
    plan = gaussian_filter(inside.astype(float), _WIDE / surface.spacing, mode="constant")
    out = [-_slope(plan, axis) for axis in (0, 1)]
    outward = slopes[0] * out[0] + slopes[1] * out[1]
    raised &= outward > _OUTWARD * np.abs(slopes[0] * out[1] - slopes[1] * out[0])
    # none with the floor of a channel farther out
    long = np.maximum(np.hypot(*out), np.finfo(float).tiny)
    i, j = (
        np.clip(at + np.rint(way / long).astype(int), 0, size - 1)
        for at, way, size in zip(np.indices(land.shape), out, land.shape, strict=True)
    )
    while True:
        stays = raised & (raised | land | ~inside)[i, j]
        if (stays == raised).all():
            break
        raised = stays
    numbers, _ = pieces(raised | land)
    return raised & np.isin(numbers, numbers[land])


def drawn_surface(surface: SoleSurface) -> SoleSurface:
    """Return a surface whose lugs reach the rim and whose floors are linear between cells.

    As ``surface_map`` takes it: the floor of a channel is its base, a whole lug below it.
    """
    rims, height = rounded_rims(surface), surface.height
    land = surface.land | rims
    channel = surface.inside & ~land
    if not land.any() or not channel.any():
        return replace(surface, land=land, base=np.where(land, height, surface.land_base))
    lug = np.where(surface.land, surface.tread_depth, 0.0)[nearest_true(surface.land)]
    floor = channel & ~_walls(height, channel, surface.spacing)
    base = np.where(land, height, surface.land_base)
    if floor.any():
        near = nearest_true(floor)
        close = grow_mask(floor, _ON_WALLS)
        base = np.where(channel & close, (height - lug)[near], base)
        height = np.where(channel & close, (base + lug), height)
    return replace(surface, height=height, land=land, base=base)


def _slope(height: Array, axis: int) -> Array:
    """Return the mean step to the neighbours along an axis that are known, 0 where none is."""
    step = np.diff(height, axis=axis)
    ends = [(0, 0), (0, 0)]
    ends[axis] = (1, 1)
    both = np.pad(step, ends, constant_values=np.nan)
    before, after = (np.take(both, range(n, n + height.shape[axis]), axis=axis) for n in (0, 1))
    known = np.isfinite(before).astype(int) + np.isfinite(after)
    return (np.nan_to_num(before) + np.nan_to_num(after)) / np.maximum(known, 1)


def _walls(height: Array, channel: Mask, spacing: float) -> Mask:
    """Return the cells of channels beside which the height within them changes steeply."""
    known = np.where(channel, height, np.nan)
    steep = np.zeros_like(channel)
    for axis in (0, 1):
        step = np.abs(np.diff(known, axis=axis)) >= _STEEP * spacing
        first, last = [(0, 0), (0, 0)], [(0, 0), (0, 0)]
        first[axis], last[axis] = (1, 0), (0, 1)
        steep |= np.pad(step, first) | np.pad(step, last)
    return steep & channel
