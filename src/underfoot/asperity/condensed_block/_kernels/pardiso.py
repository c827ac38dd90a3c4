"""Schur complement of a sparse positive definite matrix by MKL's PARDISO, through ctypes."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np

from underfoot.core.mkl import mkl_library

if TYPE_CHECKING:
    import scipy.sparse as sp

ANALYSE_AND_FACTORISE, RELEASE = 12, -1
POSITIVE_DEFINITE, INDEFINITE = 2, -2


def schur_complement(upper: sp.csr_matrix, kept: np.ndarray) -> np.ndarray | None:
    """Return S = K_kk - K_ki K_ii^-1 K_ik, (n, n), or None where MKL is missing or fails.

    ``upper`` is the upper triangle of K with sorted indices and a full diagonal, ``kept`` (n,) the
    degrees of freedom that stay, ascending.
    """
    library = mkl_library()
    if library is None:
        return None
    size = upper.indptr.size - 1
    chosen = np.zeros(size, dtype=np.int32)
    chosen[kept] = 1
    options = np.zeros(64, dtype=np.int32)
    options[0] = 1  # no defaults
    options[1] = 2  # nested dissection
    options[34] = 1  # indices from zero
    options[35] = 1  # the complement as a dense matrix in the place of the solution
    rows, columns = upper.indptr.astype(np.int32), upper.indices.astype(np.int32)
    values = np.ascontiguousarray(upper.data, dtype=float)
    handle = np.zeros(64, dtype=np.int64)
    found = np.zeros((kept.size, kept.size))

    def call(phase: int) -> int:
        def integer(value: int):
            return ctypes.byref(ctypes.c_int32(value))

        def at(array: np.ndarray):
            return array.ctypes.data_as(ctypes.c_void_p)

        error = ctypes.c_int32(0)
        library.pardiso(
            at(handle),
            integer(1),
            integer(1),
            integer(INDEFINITE),
            integer(phase),
            integer(size),
            at(values),
            at(rows),
            at(columns),
            at(chosen),
            integer(1),
            at(options),
            integer(0),
            at(values),
            at(found),
            ctypes.byref(error),
        )
        return error.value

    error = call(ANALYSE_AND_FACTORISE)
    call(RELEASE)
    return None if error else found
