"""Static condensation of a symmetric sparse matrix to a few of its unknowns."""

from __future__ import annotations

import ctypes

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from underfoot.core import ConvergenceError
from underfoot.core.mkl import mkl_library

Array = NDArray[np.float64]
SYMMETRIC_POSITIVE = 2
ANALYSE_AND_FACTORISE, RELEASE = 12, -1
FIRST_BLOCK = 64  # unit loads solved at once without MKL


def upper_triangle(matrix: sp.csr_matrix, last: NDArray[np.int64]) -> sp.csr_matrix:
    """Return the upper triangle of a symmetric matrix with the unknowns ``last`` put last."""
    size = matrix.indptr.size - 1
    others = np.ones(size, dtype=bool)
    others[last] = False
    place = np.empty(size, dtype=np.int32)
    place[others] = np.arange(size - last.size)
    place[last] = np.arange(size - last.size, size)
    row = np.repeat(place, np.diff(matrix.indptr))
    column = place[matrix.indices]
    taken = row <= column
    upper = sp.csr_matrix((matrix.data[taken], (row[taken], column[taken])), shape=(size, size))
    upper.sort_indices()
    return upper


def condensed(upper: sp.csr_matrix, count: int) -> Array:
    """Return the Schur complement S = K_kk - K_kr K_rr^-1 K_rk of the last ``count`` unknowns.

    ``upper`` is the upper triangle of a symmetric positive definite matrix; (count, count). Its
    inverse is the block of the inverse of the matrix, so S is all that loads on them see.

    Raises
    ------
    ConvergenceError
        The matrix is singular or not positive definite to working precision.
    """
    answer = _by_pardiso(upper, count) if mkl_library() is not None else _by_solves(upper, count)
    if not np.isfinite(answer).all():
        raise _singular()
    return 0.5 * (answer + answer.T)


def _by_pardiso(upper: sp.csr_matrix, count: int) -> Array:
    """Return the Schur complement that PARDISO leaves on the last unknowns."""
    library = mkl_library()
    assert library is not None
    size = upper.indptr.size - 1
    values = np.ascontiguousarray(upper.data, dtype=float)
    rows, columns = (np.asarray(part, dtype=np.int32) for part in (upper.indptr, upper.indices))
    handle, options = np.zeros(64, dtype=np.int64), np.zeros(64, dtype=np.int32)
    options[0] = 1  # no defaults
    options[1] = 2  # nested dissection
    options[34] = 1  # indices from zero
    options[35] = 1  # Schur complement into the solution vector
    chosen = np.zeros(size, dtype=np.int32)
    chosen[size - count :] = 1
    answer = np.zeros((count, count))
    unused = np.zeros(size)
    error = ctypes.c_int32(0)

    def integer(value: int):
        return ctypes.byref(ctypes.c_int32(value))

    def pointer(array: NDArray[np.generic]) -> ctypes.c_void_p:
        return array.ctypes.data_as(ctypes.c_void_p)

    for phase in (ANALYSE_AND_FACTORISE, RELEASE):
        library.pardiso(
            pointer(handle),
            integer(1),
            integer(1),
            integer(SYMMETRIC_POSITIVE),
            integer(phase),
            integer(size),
            pointer(values),
            pointer(rows),
            pointer(columns),
            pointer(chosen),
            integer(1),
            pointer(options),
            integer(0),
            pointer(unused),
            pointer(answer),
            ctypes.byref(error),
        )
        if phase == ANALYSE_AND_FACTORISE and error.value:
            raise _singular()
    return np.triu(answer) + np.triu(answer, 1).T if not np.tril(answer, -1).any() else answer


def _by_solves(upper: sp.csr_matrix, count: int) -> Array:
    """Return the same by one solve a kept unknown, with SciPy alone (slower, more memory)."""
    from scipy.sparse.linalg import splu

    size = upper.indptr.size - 1
    try:
        factors = splu(
            sp.csc_matrix(upper + sp.triu(upper, 1).T),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:
        raise _singular() from error
    inverse = np.empty((count, count))
    for first in range(0, count, FIRST_BLOCK):
        block = min(FIRST_BLOCK, count - first)
        right = np.zeros((size, block))
        right[size - count + first + np.arange(block), np.arange(block)] = 1.0
        inverse[:, first : first + block] = factors.solve(right)[size - count :]
    return np.asarray(np.linalg.inv(inverse), dtype=float)


def _singular() -> ConvergenceError:
    return ConvergenceError(
        "the elastic problem of the sole can't be factorised",
        where="outsole.finite_element",
        remedy="Check the mesh sizes and that the sole is bonded to the foot.",
    )
