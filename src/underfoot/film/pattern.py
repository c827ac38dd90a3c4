"""Sparsity of five-point operators on a masked grid, found once and filled many times."""

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from underfoot.core.arrays import Array

from .operator import Stencil


class Pattern:
    """The numbered cells of a mask and the sparse layout of five-point operators between them."""

    def __init__(self, mask: NDArray[np.bool_]) -> None:
        self.mask = mask
        self.cells = np.flatnonzero(mask)
        self.size = self.cells.size
        number = np.full(mask.shape, -1, dtype=np.int64)
        number.ravel()[self.cells] = np.arange(self.size)
        shifted = [number]
        for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
            neighbour = np.full(mask.shape, -1, dtype=np.int64)
            inner = [slice(None), slice(None)]
            outer = [slice(None), slice(None)]
            inner[axis] = slice(None, -1) if step > 0 else slice(1, None)
            outer[axis] = slice(1, None) if step > 0 else slice(None, -1)
            neighbour[tuple(inner)] = number[tuple(outer)]
            shifted.append(neighbour)
        self.columns = np.stack([part.ravel()[self.cells] for part in shifted])  # (5, size)
        self._present = self.columns >= 0
        rows = np.broadcast_to(np.arange(self.size), self.columns.shape)[self._present]
        columns = self.columns[self._present]
        self._order = np.lexsort((columns, rows))
        self.rows = rows[self._order]
        self.indices = columns[self._order].astype(np.int32)
        self.indptr = np.searchsorted(self.rows, np.arange(self.size + 1)).astype(np.int32)

    def gather(self, field: NDArray[Any]) -> NDArray[Any]:
        """Return the values of a grid field at the numbered cells."""
        return field.ravel()[self.cells]

    def scatter(self, values: Array) -> Array:
        """Return the grid field that holds ``values`` at the numbered cells and 0 elsewhere."""
        field = np.zeros(self.mask.shape)
        field.ravel()[self.cells] = values
        return field

    def rows_of(self, stencil: Stencil) -> Array:
        """Return the (5, size) coefficients of the numbered cells."""
        return np.stack([part.ravel()[self.cells] for part in stencil])

    def neighbours_of(self, values: Array, outside: float = 0.0) -> Array:
        """Return (5, size): ``values`` (size,) at each cell and its four neighbours."""
        return np.where(self._present, values[self.columns], outside)

    def data(self, coefficients: Array) -> Array:
        """Return the CSR data of (5, size) coefficients; columns outside the mask are dropped."""
        return coefficients[self._present][self._order]

    def matrix(self, coefficients: Array) -> sp.csr_matrix:
        """Return the sparse matrix of (5, size) coefficients."""
        return sp.csr_matrix(
            (self.data(coefficients), self.indices, self.indptr), shape=(self.size, self.size)
        )
