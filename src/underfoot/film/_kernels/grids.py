"""Fields between a grid and the one with cells of twice the size."""

from __future__ import annotations

import numpy as np

from underfoot.core.arrays import Array


def halved(field: Array, axes: tuple[int, ...]) -> Array:
    """Return the means of neighbouring cells along ``axes``; an odd last cell counts twice."""
    for axis in axes:
        if field.shape[axis] % 2:
            field = np.concatenate([field, np.take(field, [-1], axis)], axis=axis)
        even, odd = (np.take(field, range(part, field.shape[axis], 2), axis) for part in (0, 1))
        field = 0.5 * (even + odd)
    return field


def finer(field: Array, shape: tuple[int, ...]) -> Array:
    """Return a coarse ``field`` on the grid of ``shape``, linear between cell centres."""
    for axis in (0, 1):
        if field.shape[axis] == shape[axis]:
            continue
        size = field.shape[axis]
        before = np.take(field, np.maximum(np.arange(size) - 1, 0), axis)
        after = np.take(field, np.minimum(np.arange(size) + 1, size - 1), axis)
        pair = np.stack([0.75 * field + 0.25 * before, 0.75 * field + 0.25 * after], axis + 1)
        field = pair.reshape(*field.shape[:axis], 2 * size, *field.shape[axis + 1 :])
    return field[: shape[0], : shape[1]]
