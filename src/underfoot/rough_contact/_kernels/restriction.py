"""Vectors on part of a grid: gathered where the part is small, masked fields where it is large."""

from __future__ import annotations

from typing import Any

import numpy as np

from underfoot.core.arrays import AnyArray

_GATHER_BELOW = 0.7
"""Share of the grid below which gathering costs less than masked fields (measured, NumPy)."""


class Restriction:
    """Single-precision vectors on the nodes where ``inside`` is true.

    Gathered: a vector holds those nodes. Masked: it is the whole field, zero elsewhere. Arrays that
    are not NumPy's are always masked: assignment by index is no part of the array API.
    """

    def __init__(self, inside: AnyArray, xp: Any, work: AnyArray) -> None:
        self.xp = xp
        self._flat = xp.reshape(inside, (-1,))
        self.nodes = int(xp.count_nonzero(self._flat))
        self.gathered = xp is np and self.nodes < _GATHER_BELOW * self._flat.shape[0]
        self._shape = inside.shape
        if self.gathered:
            self._index = xp.nonzero(self._flat)[0]
            self._work = work
            work[...] = 0.0
            self.size = self.nodes
        else:
            self._mask = xp.astype(self._flat, xp.float32)
            self.size = self._flat.shape[0]

    def take(self, field: AnyArray) -> AnyArray:
        """Return a new vector with the values of ``field`` on the nodes."""
        flat = self.xp.reshape(field, (-1,))
        if self.gathered:
            return self.xp.take(flat, self._index, axis=0)
        return flat * self._mask

    def spread(self, vector: AnyArray) -> AnyArray:
        """Return the field of a vector: a shared buffer or a view, not to be written to."""
        if not self.gathered:
            return self.xp.reshape(vector, self._shape)
        flat = self.xp.reshape(self._work, (-1,))
        flat[self._index] = vector
        return self._work

    def constant(self) -> AnyArray:
        """Return the vector of ones."""
        if self.gathered:
            return self.xp.ones(self.size, dtype=self.xp.float32)
        return self._mask

    def shift(self, vector: AnyArray, value: float) -> None:
        """Add ``value`` to the vector on its nodes, in place."""
        if self.gathered:
            vector += value
        else:
            vector += self._mask * self.xp.asarray(value, dtype=self.xp.float32)
