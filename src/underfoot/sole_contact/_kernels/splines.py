"""Smooth waves on a plane: products of splines of second order over squares."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from underfoot.core.arrays import Array

OVERLAP = 0.55
"""Of a spline of second order with itself, over the side of a square."""


@dataclass(frozen=True, slots=True)
class Splines:
    """Splines over ``squares`` (nx, ny) of ``sides`` (m) from ``start`` (x, y in m) on.

    Wave i (ny + 2) + j is the product of the i-th spline along x and the j-th along y.
    """

    start: tuple[float, float]
    sides: tuple[float, float]
    squares: tuple[int, int]

    @property
    def count(self) -> int:
        """How many waves there are."""
        return (self.squares[0] + 2) * (self.squares[1] + 2)

    @property
    def end(self) -> tuple[float, float]:
        """Where the squares end, x and y in m."""
        x, y = (a + n * b for a, b, n in zip(self.start, self.sides, self.squares, strict=True))
        return x, y

    @property
    def size(self) -> float:
        """Overlap of a wave with itself where nothing cuts it, m^2."""
        return OVERLAP**2 * self.sides[0] * self.sides[1]

    def at(self, x: Array, y: Array) -> sp.csr_matrix:
        """Return each wave at places (n,) in m, (n, count); beyond the squares as at their rim."""
        numbers, values = [], []
        for place, start, side, count in zip(
            (x, y), self.start, self.sides, self.squares, strict=True
        ):
            share = np.clip((place - start) / side, 0.0, count)
            square = np.minimum(share.astype(np.intp), count - 1)
            t = share - square
            numbers.append(square[:, None] + np.arange(3))
            values.append(
                np.stack([0.5 * (1 - t) ** 2, 0.75 - (t - 0.5) ** 2, 0.5 * t**2], axis=-1)
            )
        column = numbers[0][:, :, None] * (self.squares[1] + 2) + numbers[1][:, None, :]
        value = values[0][:, :, None] * values[1][:, None, :]
        ends = 9 * np.arange(x.size + 1)
        return sp.csr_matrix((value.ravel(), column.ravel(), ends), (x.size, self.count))

    def on(self, x: Array, y: Array, cells: NDArray[np.bool_]) -> sp.csr_matrix:
        """Return each wave at cells (nx, ny) of a map with centres ``x`` and ``y``, 0 elsewhere."""
        i, j = np.nonzero(cells)
        waves = self.at(x[i], y[j])
        ends = np.concatenate([[0], np.cumsum(9 * cells.ravel())])
        return sp.csr_matrix((waves.data, waves.indices, ends), (cells.size, self.count))
