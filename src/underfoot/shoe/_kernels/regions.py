"""Masks of a sole: pieces, distances, widths, and the land carried on across its channels."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask

Labels = NDArray[np.intp]
Nearest = tuple[NDArray[np.intp], ...]


def pieces(mask: Mask, *, diagonal: bool = False) -> tuple[Labels, int]:
    """Return the number of the connected piece of each cell (0 outside) and how many there are."""
    from scipy import ndimage

    structure = np.ones((3, 3)) if diagonal else None
    labelled: Any = ndimage.label(mask, structure=structure)
    return np.asarray(labelled[0], dtype=np.intp), int(labelled[1])


def grow_mask(mask: Mask, steps: int) -> Mask:
    """Return the mask and its neighbours within ``steps`` cells along the axes."""
    from scipy import ndimage

    return np.asarray(ndimage.binary_dilation(mask, iterations=steps), dtype=np.bool_)


def shrunk(mask: Mask, steps: int) -> Mask:
    """Return the cells of the mask that are more than ``steps`` cells from its edge."""
    from scipy import ndimage

    return np.asarray(ndimage.binary_erosion(mask, iterations=steps), dtype=np.bool_)


def without_holes(mask: Mask) -> Mask:
    """Return the mask with all that it encloses."""
    from scipy import ndimage

    return np.asarray(ndimage.binary_fill_holes(mask), dtype=np.bool_)


def rim(mask: Mask, steps: int = 1) -> Mask:
    """Return the cells of the mask within ``steps`` cells of the outside or the array's edge."""
    return mask & grow_mask(~np.pad(mask, 1), steps)[1:-1, 1:-1]


def without_specks(mask: Mask, fewest: int) -> Mask:
    """Return the mask without connected pieces of fewer cells."""
    numbers, count = pieces(mask)
    if count == 0:
        return mask
    keep = np.bincount(numbers.ravel()) >= fewest
    keep[0] = False
    return keep[numbers]


def distance_within(mask: Mask) -> Array:
    """Return the distance (cells) to the nearest cell outside; beyond the array is outside."""
    from scipy import ndimage

    distance: Any = ndimage.distance_transform_edt(np.pad(mask, 1))
    return np.asarray(distance, dtype=np.float64)[1:-1, 1:-1]


def distance_to(mask: Mask) -> Array:
    """Return the distance (cells) to the nearest cell of the mask."""
    from scipy import ndimage

    distance: Any = ndimage.distance_transform_edt(~mask)
    return np.asarray(distance, dtype=np.float64)


def nearest_true(mask: Mask) -> Nearest:
    """Return, for each cell, the indices of the nearest cell where ``mask`` is true."""
    from scipy.ndimage import distance_transform_edt

    indices = distance_transform_edt(~mask, return_distances=False, return_indices=True)
    return tuple(np.asarray(indices, dtype=np.intp))


def carried_on(height: Array, land: Mask) -> Array:
    """Return heights known on ``land`` carried on across the other cells of the plan form.

    As ``across_channels`` does; where no land is on both sides, at the rim, the nearest counts.
    """
    inside = np.isfinite(height)
    if not land.any():
        return np.where(inside, height, np.nan)
    filled = across_channels(height, land)
    filled = np.where(np.isfinite(filled), filled, height[nearest_true(land)])
    return np.where(inside, filled, np.nan)


def across_channels(height: Array, land: Mask) -> Array:
    """Return heights on ``land`` and between two pieces of it; nan where it is on one side alone.

    Linear along x and along y, weighted by the inverse of the gap; where channels cross and neither
    meets land, the same along the diagonals.
    """
    filled = np.where(land, height, np.nan)
    for diagonal in (False, True):
        missing = np.nonzero(~np.isfinite(filled))
        total, weights = np.zeros((2, missing[0].size))
        for turned in (False, True):
            value, gap = _between(height, land, missing, diagonal, turned)
            told = np.isfinite(value)
            weight = np.where(told, 1.0 / np.maximum(gap, 1.0), 0.0)
            total += np.where(told, value, 0.0) * weight
            weights += weight
        told = weights > 0
        filled[tuple(each[told] for each in missing)] = total[told] / weights[told]
    return filled


def _between(
    height: Array, land: Mask, cells: tuple[NDArray[np.intp], ...], diagonal: bool, turned: bool
) -> tuple[Array, Array]:
    """Return ``between_land`` of some cells alone, along x, along y or along a diagonal."""
    if not diagonal:
        if turned:
            height, land, cells = height.T, land.T, cells[::-1]
        return _value_between(height, land, *cells)
    rows = height.shape[0]
    i, j = np.indices(height.shape)
    columns, shift = (j - i + rows, rows - cells[0]) if turned else (j + i, cells[0])
    heights = np.full((rows, rows + height.shape[1]), np.nan)
    lands = np.zeros(heights.shape, dtype=bool)
    heights[i, columns], lands[i, columns] = height, land
    return _value_between(heights, lands, cells[0], cells[1] + shift)


def between_land(height: Array, land: Mask) -> tuple[Array, Array]:
    """Return the linear value between the land before and after along axis 0, and their gap."""
    every = np.indices(height.shape).reshape(2, -1)
    value, gap = _value_between(height, land, *every)
    return value.reshape(height.shape), gap.reshape(height.shape)


def _value_between(
    height: Array, land: Mask, row: NDArray[np.intp], column: NDArray[np.intp]
) -> tuple[Array, Array]:
    count = height.shape[0]
    index = np.arange(count, dtype=np.int32)[:, None]
    before = np.maximum.accumulate(np.where(land, index, np.int32(-1)), axis=0)[row, column]
    after = np.where(land, index, np.int32(count))[::-1]
    after = np.minimum.accumulate(after, axis=0)[::-1][row, column]
    known = (before >= 0) & (after < count)
    low, high = np.maximum(before, 0), np.minimum(after, count - 1)
    gap = (high - low).astype(float)
    share = (row - low) / np.maximum(gap, 1.0)
    value = (1 - share) * height[low, column] + share * height[high, column]
    return np.where(known, value, np.nan), gap


def draining(inside: Mask, channel: Mask) -> Mask:
    """Return which cells of the channels are connected to the rim through channels."""
    numbers, _ = pieces(channel)
    return np.isin(numbers, np.setdiff1d(numbers[rim(inside)], [0]))
