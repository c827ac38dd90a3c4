"""The land of a sole carried on across its channels."""

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask


def nearest_true(mask: Mask) -> tuple[NDArray[np.intp], ...]:
    """Return, for each cell, the indices of the nearest cell where ``mask`` is true."""
    from scipy.ndimage import distance_transform_edt

    indices = distance_transform_edt(~mask, return_distances=False, return_indices=True)
    return tuple(np.asarray(indices, dtype=np.intp))


def carried_on(height: Array, land: Mask) -> Array:
    """Return heights known on ``land`` carried on across the other cells of the plan form.

    Between two pieces of land, linear along x and along y, weighted by the inverse of the gap;
    at the rim the nearest land counts.
    """
    inside = np.isfinite(height)
    if not land.any():
        return np.where(inside, height, np.nan)
    fallback = height[nearest_true(land)]
    total, weights = np.zeros_like(height), np.zeros_like(height)
    for axis in (0, 1):
        value, gap = _between_land(np.moveaxis(height, axis, 0), np.moveaxis(land, axis, 0))
        known = np.isfinite(value)
        weight = np.where(known, 1.0 / np.maximum(gap, 1.0), 0.0)
        total += np.moveaxis(np.where(known, value, 0.0) * weight, 0, axis)
        weights += np.moveaxis(weight, 0, axis)
    filled = np.where(weights > 0, total / np.maximum(weights, 1e-30), fallback)
    return np.where(inside, np.where(land, height, filled), np.nan)


def _between_land(height: Array, land: Mask) -> tuple[Array, Array]:
    """Return the linear value between the land before and after along axis 0, and their gap."""
    count = height.shape[0]
    index = np.arange(count)[:, None] * np.ones_like(height)
    before = np.maximum.accumulate(np.where(land, index, -1.0), axis=0)
    after = np.minimum.accumulate(np.where(land, index, count)[::-1], axis=0)[::-1]
    known = (before >= 0) & (after < count)
    low, high = np.clip(before, 0, count - 1).astype(int), np.clip(after, 0, count - 1).astype(int)
    columns = np.arange(height.shape[1])[None, :]
    gap = (high - low).astype(float)
    share = (index - low) / np.maximum(gap, 1.0)
    value = (1 - share) * height[low, columns] + share * height[high, columns]
    return np.where(known, value, np.nan), gap
