"""Fields of several results on one grid, so that they can be subtracted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from underfoot.core.fields import Fields

from .quantities import DrawnQuantity, inside, raw, spacing

_COVERED = 0.5
"""Least share of a cell that must lie on the sole."""


@dataclass(frozen=True, slots=True)
class CommonGrid:
    """The grid on which results are compared; ``resampled`` when it is not that of all of them."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    spacing: float
    resampled: bool


def common_grid(datasets: Sequence[Fields]) -> CommonGrid:
    """Return the grid of all if they share one, else cells of the coarsest over all soles (m)."""
    first = datasets[0]
    if all(_same(first, other) for other in datasets[1:]):
        return CommonGrid(first["x"].values, first["y"].values, spacing(first), False)
    side = max(spacing(dataset) for dataset in datasets)
    x, y = (_span([d[axis].values for d in datasets], side) for axis in ("x", "y"))
    return CommonGrid(x, y, side, True)


def on_grid(dataset: Fields, quantity: DrawnQuantity, grid: CommonGrid) -> NDArray[np.float64]:
    """Return a quantity in its shown unit on a common grid, (nx, ny), nan where there is no sole.

    Each new cell holds the mean over the parts of old cells within it, so that the integral of a
    pressure, the load, is kept; nan where less than half of it lies on the sole, or nothing of it
    has a value.
    """
    values = np.where(inside(dataset), raw(dataset, quantity.name), np.nan) / quantity.factor
    if not grid.resampled:
        return values
    known = np.isfinite(values)
    along, across = _weights(dataset, grid)
    total = along @ np.where(known, values, 0.0) @ across.T
    weight = along @ known.astype(float) @ across.T
    enough = sole_on_grid(dataset, grid) & (weight >= 0.5 * _COVERED * grid.spacing**2)
    return np.divide(total, weight, out=np.full_like(total, np.nan), where=enough)


def sole_on_grid(dataset: Fields, grid: CommonGrid) -> NDArray[np.bool_]:
    """Return where at least half of a cell of a common grid lies on the sole, (nx, ny)."""
    covered = inside(dataset)
    if not grid.resampled:
        return covered
    along, across = _weights(dataset, grid)
    return along @ covered.astype(float) @ across.T >= _COVERED * grid.spacing**2


def difference(
    second: NDArray[np.float64], first: NDArray[np.float64], quantity: DrawnQuantity
) -> NDArray[np.float64]:
    """Return second - first, or second / first for a quantity drawn on a logarithmic scale."""
    if not quantity.logarithmic:
        return second - first
    usable = (first > 0.0) & (second > 0.0)
    return np.divide(second, first, out=np.full_like(first, np.nan), where=usable)


def _same(first: Fields, other: Fields) -> bool:
    return all(
        first[axis].values.size == other[axis].values.size
        and np.allclose(first[axis].values, other[axis].values, atol=1e-3 * spacing(first))
        for axis in ("x", "y")
    )


def _span(centres: Sequence[NDArray[np.float64]], side: float) -> NDArray[np.float64]:
    low, high = min(c.min() for c in centres), max(c.max() for c in centres)
    return low + side * np.arange(np.ceil((high - low) / side - 1e-6) + 1)


def _weights(dataset: Fields, grid: CommonGrid) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    side = spacing(dataset)
    return (
        _overlap(grid.x, grid.spacing, dataset["x"].values, side),
        _overlap(grid.y, grid.spacing, dataset["y"].values, side),
    )


def _overlap(
    new: NDArray[np.float64], wide: float, old: NDArray[np.float64], narrow: float
) -> NDArray[np.float64]:
    """Return the length shared by new and old cells, (new, old)."""
    low = np.maximum(new[:, None] - 0.5 * wide, old - 0.5 * narrow)
    high = np.minimum(new[:, None] + 0.5 * wide, old + 0.5 * narrow)
    return np.maximum(high - low, 0.0)
