"""Symmetric sparse matrices by MKL's PARDISO, through ctypes: solution and Schur complement."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import numpy as np

from underfoot.core.mkl import mkl_library

if TYPE_CHECKING:
    import scipy.sparse as sp

ANALYSE_AND_FACTORISE, ANALYSE_TO_SOLVE, RELEASE = 12, 13, -1
SYMMETRIC = -2


def schur_complement(upper: sp.csr_matrix, kept: np.ndarray) -> np.ndarray | None:
    """Return S = K_kk - K_ki K_ii^-1 K_ik, (n, n), or None where MKL is missing or fails.

    ``upper`` is the upper triangle of K with sorted indices and a full diagonal, ``kept`` (n,) the
    degrees of freedom that stay, ascending.
    """
    chosen = np.zeros(upper.indptr.size - 1, dtype=np.int32)
    chosen[kept] = 1
    found = np.zeros((kept.size, kept.size))
    done = _called(upper, ANALYSE_AND_FACTORISE, chosen, np.zeros(1), found, 1)
    return found if done else None


def symmetric_solution(upper: sp.csr_matrix, right: np.ndarray) -> np.ndarray | None:
    """Return K^-1 ``right``, (n, m), or None where MKL is missing or fails; ``upper`` as above."""
    right = np.asfortranarray(right, dtype=float)
    found = np.zeros_like(right, order="F")
    nothing = np.zeros(1, dtype=np.int32)
    done = _called(upper, ANALYSE_TO_SOLVE, nothing, right, found, right.shape[1])
    return found if done else None


def _called(
    upper: sp.csr_matrix,
    phase: int,
    chosen: np.ndarray,
    right: np.ndarray,
    found: np.ndarray,
    count: int,
) -> bool:
    library = mkl_library()
    if library is None:
        return False
    options = np.zeros(64, dtype=np.int32)
    options[0] = 1  # no defaults
    options[1] = 2  # nested dissection
    options[9] = 8  # perturb pivots below 1e-8
    options[34] = 1  # indices from zero
    options[35] = int(chosen.size > 1)  # the complement, dense, in the place of the solution
    rows, columns = upper.indptr.astype(np.int32), upper.indices.astype(np.int32)
    values = np.ascontiguousarray(upper.data, dtype=float)
    handle = np.zeros(64, dtype=np.int64)

    def integer(value: int):
        return ctypes.byref(ctypes.c_int32(value))

    def at(array: np.ndarray):
        return array.ctypes.data_as(ctypes.c_void_p)

    def call(which: int) -> int:
        error = ctypes.c_int32(0)
        library.pardiso(
            at(handle),
            integer(1),
            integer(1),
            integer(SYMMETRIC),
            integer(which),
            integer(rows.size - 1),
            at(values),
            at(rows),
            at(columns),
            at(chosen),
            integer(count),
            at(options),
            integer(0),
            at(right),
            at(found),
            ctypes.byref(error),
        )
        return error.value

    error = call(phase)
    call(RELEASE)
    return error == 0
