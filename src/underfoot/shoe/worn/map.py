"""Wear as a map of removed thickness."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from underfoot.core import InputError
from underfoot.core.arrays import Array

if TYPE_CHECKING:
    from ..shape import SoleShape


@dataclass(frozen=True, slots=True)
class WornMap:
    """Removed thickness of the land on a grid in the frame of the sole, bilinear between nodes.

    Parameters:
        x, y: Evenly spaced nodes, m.
        removed: (nx, ny), normal to the sole, m; beyond the grid its nearest value holds.
    """

    x: Array
    y: Array
    removed: Array

    def __post_init__(self) -> None:
        if self.removed.shape != (self.x.size, self.y.size):
            raise InputError(
                f"removed has shape {self.removed.shape}",
                where="wear.removed",
                allowed=f"{(self.x.size, self.y.size)}",
            )
        if not (np.isfinite(self.removed).all() and (self.removed >= 0).all()):
            raise InputError(
                "a removed thickness is negative or not finite",
                where="wear.removed",
                allowed="0 m or more everywhere",
            )

    @property
    def depth(self) -> float:
        """Largest thickness removed, m."""
        return float(self.removed.max())

    def thickness(self, x: Array, y: Array) -> Array:
        """Return the removed thickness (m) at (x, y)."""
        from scipy.ndimage import map_coordinates

        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        at = [
            (value - nodes[0]) / (nodes[1] - nodes[0])
            for value, nodes in ((x, self.x), (y, self.y))
        ]
        flat = [np.ravel(each) for each in at]
        depth = map_coordinates(self.removed, flat, order=1, mode="nearest")
        return depth.reshape(x.shape)

    def worn_height(self, x: Array, y: Array, unworn: Array, shape: SoleShape) -> Array:
        """Return the height (m) of the worn land at (x, y)."""
        return unworn + self.thickness(x, y)
