"""Letters as lugs: closed outlines that repeat along and across the shoe."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from underfoot.core.arrays import Array

from ._kernels.tread_pattern import outline_distance

Ring = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Lettering:
    """Outlines of one line of text in the frame of the pattern, m.

    Parameters:
        shells, holes: Corners of the letters' outer and inner walls; no ring closes on itself.
        gap: Between the lines, and between the end of the text and its next beginning, m.
    """

    shells: tuple[Ring, ...]
    holes: tuple[Ring, ...]
    gap: float

    @cached_property
    def corner(self) -> Array:
        """Lowest (x, y) of the text, m."""
        return np.concatenate([np.array(ring) for ring in self.shells]).min(axis=0)

    @cached_property
    def pitch(self) -> Array:
        """Period along and across, m: the text's extent and the gap."""
        points = np.concatenate([np.array(ring) for ring in self.shells])
        return np.ptp(points, axis=0) + self.gap

    @property
    def area(self) -> float:
        """Area of the letters, m^2: shells without their holes (shoelace formula)."""
        return sum(map(_area, self.shells)) - sum(map(_area, self.holes))

    @property
    def stroke(self) -> float:
        """Mean width of the thinnest letter's stroke, m: 2 area / perimeter of all its walls."""
        widths = []
        for shell in self.shells:
            low, high = np.min(shell, axis=0), np.max(shell, axis=0)
            inner = [h for h in self.holes if (low < h[0]).all() and (h[0] < high).all()]
            area = _area(shell) - sum(map(_area, inner))
            sides = (zip(ring, (*ring[1:], ring[0]), strict=True) for ring in (shell, *inner))
            widths.append(2 * area / sum(math.dist(*ends) for ring in sides for ends in ring))
        return min(widths)

    @cached_property
    def segments(self) -> Array:
        """Walls of one period, (n, 4) as x0, y0, x1, y1, m."""
        rows = []
        for ring in (*self.shells, *self.holes):
            points = np.array(ring)
            rows.append(np.hstack([points, np.roll(points, -1, axis=0)]))
        return np.concatenate(rows)

    def channel_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) into the channels: positive there, negative on a letter."""
        return outline_distance(x, y, self.segments, self.corner - self.gap / 2, self.pitch)

    def outlines(self, low: Array, high: Array) -> Iterator[tuple[Array, list[Array]]]:
        """Yield outer wall and inner walls (n, 2) of each letter between two corners, m."""
        for shell in map(np.array, self.shells):
            first, last = shell.min(axis=0), shell.max(axis=0)
            holes = map(np.array, self.holes)
            holes = [h for h in holes if (first < h[0]).all() and (h[0] < last).all()]
            begin, end = np.floor((low - first) / self.pitch), np.ceil((high - first) / self.pitch)
            for shift in product(*map(np.arange, begin - 1, end + 2)):
                yield shell + self.pitch * shift, [hole + self.pitch * shift for hole in holes]


def _area(ring: Ring) -> float:
    x, y = np.array(ring).T
    return float(abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2)
