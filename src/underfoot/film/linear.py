"""Direct solution of a sparse system: MKL's PARDISO where it is installed, else SuperLU."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from underfoot.core import ConvergenceError, MissingExtraError, unknown_name
from underfoot.core.mkl import mkl_library

from ._kernels.mkl import Pardiso, PardisoError

if TYPE_CHECKING:
    import scipy.sparse as sp

Array = NDArray[np.float64]
BACKENDS = ("pardiso", "superlu")


class Factorization(Protocol):
    """A factorised matrix that can take the values of another of the same sparsity."""

    def factorise(self, matrix: sp.csr_matrix) -> None:
        """Factorise a matrix of the same sparsity."""
        ...

    def solve(self, right: Array) -> Array:
        """Return the solution for one right-hand side."""
        ...


@cache
def available_backends() -> tuple[str, ...]:
    """Return the names of the usable sparse back ends, the fastest first."""
    return BACKENDS if mkl_library() is not None else ("superlu",)


def factorization(matrix: sp.csr_matrix, backend: str | None = None) -> Factorization:
    """Return the factorised ``matrix``.

    Parameters
    ----------
    matrix
        Square CSR matrix with sorted indices.
    backend
        "pardiso", "superlu" or None for the fastest that is installed.

    Raises
    ------
    ConvergenceError
        The matrix is singular to working precision or holds NaN.
    """
    name = backend or available_backends()[0]
    if name not in BACKENDS:
        raise unknown_name("sparse back end", name, BACKENDS, where="backend")
    if name not in available_backends():
        raise MissingExtraError("mkl", "mkl", "the PARDISO factorization")
    return _Checked(matrix, Pardiso if name == "pardiso" else _SuperLU)


class _Checked:
    """Turns the back ends' failures into the package's error."""

    def __init__(self, matrix: sp.csr_matrix, kind: type[Pardiso] | type[_SuperLU]) -> None:
        self._kind = kind
        self._inner: Pardiso | _SuperLU | None = None
        self.factorise(matrix)

    def factorise(self, matrix: sp.csr_matrix) -> None:
        if not np.isfinite(matrix.data).all():
            raise _singular()
        try:
            if self._inner is None:
                self._inner = self._kind(matrix)
            else:
                self._inner.factorise(matrix)
        except (PardisoError, RuntimeError) as error:
            raise _singular() from error

    def solve(self, right: Array) -> Array:
        assert self._inner is not None
        return self._inner.solve(right)


class _SuperLU:
    def __init__(self, matrix: sp.csr_matrix) -> None:
        self.factorise(matrix)

    def factorise(self, matrix: sp.csr_matrix) -> None:
        from scipy.sparse.linalg import splu

        self._factors = splu(
            matrix.tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.01,
            options={"SymmetricMode": True},
        )

    def solve(self, right: Array) -> Array:
        return self._factors.solve(right)


def _singular() -> ConvergenceError:
    return ConvergenceError(
        "the linear system of the film is singular",
        where="film",
        remedy="Check that the gap and the pressure law are finite and that some cell is loaded.",
    )
