"""Direct solution of sparse systems: MKL's PARDISO where it is installed, else SciPy's SuperLU.

Both give the same numbers within the accuracy of a factorization in double precision. The variable
``UNDERFOOT_SPARSE`` of the environment ("pardiso" or "superlu") chooses one for a whole run.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from .errors import ConvergenceError, MissingExtraError, unknown_name
from .mkl import MklError, Pardiso, mkl_library, pardiso_schur_complement
from .remark import Message

if TYPE_CHECKING:
    import scipy.sparse as sp

Array = NDArray[np.float64]
Kind = Literal["general", "symmetric", "positive definite"]
BACK_ENDS = ("pardiso", "superlu")
VARIABLE = "UNDERFOOT_SPARSE"
LARGEST_RESIDUAL = 1e-8
"""Backward error |A x - b| / (|A| |x| + |b|) above which a solution counts as wrong."""
BATCH = 128  # unit loads solved at once for a Schur complement without MKL


class Factorization(Protocol):
    """A factorised matrix that can take the values of another of the same sparsity."""

    def factorise(self, matrix: sp.csr_matrix) -> None:
        """Factorise a matrix of the same sparsity."""
        ...

    def solve(self, right: Array) -> Array:
        """Return the solution for right-hand sides (n,) or (n, m)."""
        ...


def back_ends() -> tuple[str, ...]:
    """Return the names of the usable sparse back ends, the fastest first."""
    return BACK_ENDS if mkl_library() is not None else ("superlu",)


def back_end(name: str | None = None) -> str:
    """Return the back end in use: ``name``, else ``UNDERFOOT_SPARSE``, else the fastest.

    An unknown name raises ``InputError``, PARDISO without MKL ``MissingExtraError``.
    """
    where = "back_end" if name else VARIABLE
    name = name or os.environ.get(VARIABLE) or back_ends()[0]
    if name not in BACK_ENDS:
        raise unknown_name("sparse back end", name, BACK_ENDS, where=where)
    if name not in back_ends():
        raise MissingExtraError("mkl", "fast", "the PARDISO factorization")
    return name


def factorization(
    matrix: sp.csr_matrix, name: str | None = None, *, kind: Kind = "general", where: str = "film"
) -> Factorization:
    """Return the factorised ``matrix``: square CSR with sorted indices, of symmetric sparsity.

    ``name`` is the back end, None for ``back_end()``; ``where`` names the system in an error. A
    matrix that is singular to working precision, not positive definite although its ``kind`` says
    so, or holds NaN raises ``ConvergenceError``.
    """
    return _Checked(matrix, back_end(name), kind, where)


def upper_triangle(matrix: sp.csr_matrix) -> sp.csr_matrix:
    """Return the upper triangle of a symmetric matrix, indices sorted."""
    import scipy.sparse as sp

    upper = sp.csr_matrix(sp.triu(matrix, format="csr"))
    upper.sort_indices()
    return upper


def schur_complement(
    upper: sp.csr_matrix,
    retained: NDArray[np.integer],
    name: str | None = None,
    *,
    kind: Kind = "symmetric",
    where: str = "sparse system",
) -> Array:
    """Return the Schur complement S = K_rr - K_re K_ee^-1 K_er of the retained unknowns r.

    The inverse of S is the block (r, r) of the inverse of K: S is all that loads on r see.
    ``upper`` is the upper triangle of a symmetric K with a full diagonal, indices sorted;
    ``retained`` are the numbers of the m retained unknowns, ascending; S is (m, m), symmetric. The
    rest is as for ``factorization``.
    """
    if not np.isfinite(upper.data).all():
        raise _singular(where)
    retained = np.asarray(retained)
    try:
        if back_end(name) == "pardiso":
            complement = pardiso_schur_complement(upper, retained, kind)
        else:
            complement = np.linalg.inv(_inverse_block(upper, retained, kind))
    except (MklError, RuntimeError, np.linalg.LinAlgError) as error:
        raise _singular(where) from error
    if not np.isfinite(complement).all():
        raise _singular(where)
    return 0.5 * (complement + complement.T)


def _inverse_block(upper: sp.csr_matrix, retained: NDArray[np.integer], kind: Kind) -> Array:
    """Return the entries (retained, retained) of the inverse, by one solve a retained unknown."""
    import scipy.sparse as sp

    factors = _SuperLU(sp.csr_matrix(upper + sp.triu(upper, 1).T), kind)
    count, size = retained.size, upper.indptr.size - 1
    inverse = np.empty((count, count))
    for first in range(0, count, BATCH):
        block = retained[first : first + BATCH]
        right = np.zeros((size, block.size), order="F")
        right[block, np.arange(block.size)] = 1.0
        inverse[:, first : first + block.size] = factors.solve(right)[retained]
    return inverse


class _Checked:
    """Turns the back ends' failures into the package's error; checks one solve a factorization."""

    def __init__(self, matrix: sp.csr_matrix, name: str, kind: Kind, where: str) -> None:
        self._name, self._where = name, where
        self._kind: Kind = kind
        self._inner: Pardiso | _SuperLU | None = None
        self.factorise(matrix)

    def factorise(self, matrix: sp.csr_matrix) -> None:
        if not np.isfinite(matrix.data).all():
            raise _singular(self._where)
        self._unchecked: sp.csr_matrix | None = matrix
        if self._name == "pardiso" and self._kind != "general":
            matrix = upper_triangle(matrix)
        try:
            if self._inner is not None:
                self._inner.factorise(matrix)
            elif self._name == "pardiso":
                self._inner = Pardiso(matrix, self._kind)
            else:
                self._inner = _SuperLU(matrix, self._kind)
        except RuntimeError as error:
            raise _singular(self._where) from error

    def solve(self, right: Array) -> Array:
        assert self._inner is not None
        answer, matrix = self._inner.solve(right), self._unchecked
        if matrix is not None:
            self._unchecked = None
            largest = abs(matrix).max() * np.abs(answer).max() + np.abs(right).max()
            error = np.abs(matrix @ answer - right).max()
            if not error <= LARGEST_RESIDUAL * largest:
                raise ConvergenceError(
                    Message(
                        "a solution by {name} is wrong: its backward error is {error:.1e}, "
                        "at most {largest_residual:.0e} is right",
                        name=self._name,
                        error=error / largest,
                        largest_residual=LARGEST_RESIDUAL,
                    ),
                    where=self._where,
                    remedy=Message(
                        "Check that each part is held or loaded, or choose the other solver: "
                        "{variable}={other}",
                        variable=VARIABLE,
                        other=BACK_ENDS[1 - BACK_ENDS.index(self._name)],
                    ),
                )
        return answer


class _SuperLU:
    def __init__(self, matrix: sp.csr_matrix, kind: Kind) -> None:
        self._threshold = 0.0 if kind == "positive definite" else 0.01
        self.factorise(matrix)

    def factorise(self, matrix: sp.csr_matrix) -> None:
        from scipy.sparse.linalg import splu

        self._factors = splu(
            matrix.tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=self._threshold,
            options={"SymmetricMode": True},
        )

    def solve(self, right: Array) -> Array:
        return self._factors.solve(right)


def _singular(where: str) -> ConvergenceError:
    return ConvergenceError(
        "the sparse linear system is singular, or not positive definite as it should be",
        where=where,
        remedy="Check that every input is finite and that each part is held or loaded.",
    )
