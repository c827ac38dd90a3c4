"""PARDISO of Intel MKL through ctypes: one symbolic analysis, many numeric factorizations."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from underfoot.core.mkl import mkl_library

if TYPE_CHECKING:
    import scipy.sparse as sp

ANALYSE, FACTORISE, SOLVE, RELEASE = 11, 22, 33, -1
REAL_UNSYMMETRIC = 11


class PardisoError(RuntimeError):
    """MKL's PARDISO reported an error code."""


class Pardiso:
    """Factorization of matrices that share one sparsity; its memory goes back on deletion.

    The reordering with weighted matching is left out (the block systems here have a full, dominant
    enough diagonal), so the analysis depends on the sparsity alone and can be reused.
    """

    def __init__(self, matrix: sp.csr_matrix) -> None:
        loaded = mkl_library()
        if loaded is None:
            raise PardisoError("MKL is not installed")
        self._call_library = loaded.pardiso
        self._handle = np.zeros(64, dtype=np.int64)
        self._options = np.zeros(64, dtype=np.int32)
        self._options[0] = 1  # no defaults
        self._options[1] = 2  # nested dissection (METIS)
        self._options[9] = 10  # perturb pivots below 1e-10
        self._options[17] = self._options[18] = 0  # no statistics
        self._options[23] = 0
        self._options[34] = 1  # indices from zero
        self._size = matrix.indptr.size - 1
        self._rows = matrix.indptr.astype(np.int32)
        self._columns = matrix.indices.astype(np.int32)
        self._values = matrix.data.astype(float)
        self._call(ANALYSE, np.zeros(0), np.zeros(0))
        self.factorise(matrix)

    def factorise(self, matrix: sp.csr_matrix) -> None:
        """Factorise the values of a matrix of the same sparsity."""
        self._values = np.ascontiguousarray(matrix.data, dtype=float)
        self._call(FACTORISE, np.zeros(0), np.zeros(0))

    def solve(self, right: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the solution for one right-hand side."""
        right = np.ascontiguousarray(right, dtype=float)
        answer = np.empty_like(right)
        self._call(SOLVE, right, answer)
        return answer

    def __del__(self) -> None:
        if getattr(self, "_size", 0):
            self._call(RELEASE, np.zeros(0), np.zeros(0))

    def _call(self, phase: int, right: NDArray[np.float64], answer: NDArray[np.float64]) -> None:
        def integer(value: int):
            return ctypes.byref(ctypes.c_int32(value))

        error = ctypes.c_int32(0)
        none = np.zeros(1, dtype=np.int32)
        self._call_library(
            self._handle.ctypes.data_as(ctypes.c_void_p),
            integer(1),
            integer(1),
            integer(REAL_UNSYMMETRIC),
            integer(phase),
            integer(self._size),
            self._values.ctypes.data_as(ctypes.c_void_p),
            self._rows.ctypes.data_as(ctypes.c_void_p),
            self._columns.ctypes.data_as(ctypes.c_void_p),
            none.ctypes.data_as(ctypes.c_void_p),
            integer(1),
            self._options.ctypes.data_as(ctypes.c_void_p),
            integer(0),
            right.ctypes.data_as(ctypes.c_void_p),
            answer.ctypes.data_as(ctypes.c_void_p),
            ctypes.byref(error),
        )
        if error.value and phase != RELEASE:
            raise PardisoError(f"PARDISO reported error {error.value}")
