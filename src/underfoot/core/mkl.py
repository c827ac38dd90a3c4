"""Intel's Math Kernel Library, where it is installed: PARDISO and Fourier transforms by ctypes.

The wrappers are our own because the packages on offer fit neither use. pypardiso knows general
matrices alone, analyses each matrix anew and has no Schur complement; mkl_fft plans each call anew
(measured: 1.0 to 2.0 times the time of the transforms here) and ties the version of MKL.
"""

from __future__ import annotations

import ctypes
import math
from ctypes.util import find_library
from functools import cache
from importlib import metadata
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .remark import Message

if TYPE_CHECKING:
    import scipy.sparse as sp

Array = NDArray[np.float64]

# phases and matrix types of PARDISO
_ANALYSE, _FACTORISE, _ANALYSE_AND_FACTORISE, _SOLVE, _RELEASE = 11, 22, 12, 33, -1
MATRIX_TYPES = {"general": 11, "symmetric": -2, "positive definite": 2}
# names and values of mkl_dfti.h
_SINGLE, _DOUBLE, _REAL = 35, 36, 33
_BACKWARD_SCALE, _CONJUGATE_EVEN_STORAGE, _PLACEMENT = 5, 10, 11
_INPUT_STRIDES, _OUTPUT_STRIDES, _INPUT_DISTANCE, _OUTPUT_DISTANCE = 12, 13, 14, 15
_NUMBER_OF_TRANSFORMS, _THREAD_LIMIT = 7, 27
_COMPLEX_COMPLEX, _NOT_INPLACE = 39, 44

_NONE = np.zeros(1)


class MklError(RuntimeError):
    """MKL reported an error code."""


@cache
def mkl_library() -> ctypes.CDLL | None:
    """Return MKL's run-time library, or None where it is not installed."""
    try:
        files = metadata.files("mkl") or []
    except metadata.PackageNotFoundError:
        files = []
    candidates = [str(file.locate()) for file in files if "mkl_rt" in file.name]
    for path in candidates or filter(None, [find_library("mkl_rt")]):
        try:
            loaded = ctypes.CDLL(path)
            _ = loaded.pardiso, loaded.DftiCreateDescriptor, loaded.MKL_Set_Num_Threads_Local
        except (OSError, AttributeError):
            continue
        loaded.pardiso.restype = None
        loaded.DftiErrorMessage.restype = ctypes.c_char_p
        return loaded
    return None


class Pardiso:
    """Factorization of matrices that share one sparsity; its memory goes back on deletion.

    The reordering with weighted matching is left out (the systems here have a full, dominant
    enough diagonal), so the analysis depends on the sparsity alone and serves the next matrix too.
    """

    def __init__(self, matrix: sp.csr_matrix, kind: str) -> None:
        self._system = _System(matrix, kind)
        self._system.call(_ANALYSE)
        self._system.call(_FACTORISE)

    def factorise(self, matrix: sp.csr_matrix) -> None:
        """Factorise the values of a matrix of the same sparsity."""
        self._system.values[:] = matrix.data
        self._system.call(_FACTORISE)

    def solve(self, right: Array) -> Array:
        """Return the solution for right-hand sides (n,) or (n, m)."""
        right = np.asfortranarray(right, dtype=float)
        answer = np.empty_like(right, order="F")
        self._system.call(_SOLVE, right, answer)
        return answer


def pardiso_schur_complement(
    upper: sp.csr_matrix, retained: NDArray[np.integer], kind: str
) -> Array:
    """Return the Schur complement on the ``retained`` unknowns (ascending), see ``core.sparse``."""
    system = _System(upper, kind)
    system.retained[retained] = 1
    system.options[35] = 1  # the complement, dense, in the place of the solution
    answer = np.zeros((retained.size, retained.size))
    system.call(_ANALYSE_AND_FACTORISE, np.zeros(system.retained.size), answer)
    return np.triu(answer) + np.triu(answer, 1).T  # whether MKL filled one side or both


class _System:
    """One matrix with the arguments that PARDISO wants at every call, prepared once."""

    def __init__(self, matrix: sp.csr_matrix, kind: str) -> None:
        library = mkl_library()
        if library is None:
            raise MklError("MKL is not installed")
        self._pardiso = library.pardiso
        self._set_threads = library.MKL_Set_Num_Threads_Local
        size = matrix.indptr.size - 1
        self.values = np.array(matrix.data, dtype=float)
        self.retained = np.zeros(size, dtype=np.int32)
        self.options = np.zeros(64, dtype=np.int32)
        self.options[0] = 1  # no defaults
        self.options[34] = 1  # indices from zero
        # Nested dissection is right on any number of threads with either factorization. Minimum
        # degree (options[1] = 0) with the two-level one (options[23] = 10, for general matrices
        # alone: solves take half the time) is not: on two threads its solutions are wrong.
        self.options[1] = 2
        self.options[23] = 10 if kind == "general" else 0
        self.options[9] = 10 if kind == "general" else 8  # perturb pivots below 10^-this
        self._handle = np.zeros(64, dtype=np.int64)
        self._rows = matrix.indptr.astype(np.int32)
        self._indices = matrix.indices.astype(np.int32)
        self._phase, self._columns, self._error = (ctypes.c_int32() for _ in range(3))
        one, none, type_, count = map(ctypes.c_int32, (1, 0, MATRIX_TYPES[kind], size))
        self._before = (
            _address(self._handle),
            *map(ctypes.byref, (one, one, type_, self._phase, count)),
            *map(_address, (self.values, self._rows, self._indices, self.retained)),
            ctypes.byref(self._columns),
            _address(self.options),
            ctypes.byref(none),
        )

    def call(self, phase: int, right: Array = _NONE, answer: Array = _NONE) -> None:
        """Run one phase; raise ``MklError`` where it fails."""
        self._phase.value = phase
        self._columns.value = right.shape[1] if right.ndim == 2 else 1
        error = self._error
        # one thread: the same digits on every machine, and no threads that wait for each other
        before = self._set_threads(1)
        self._pardiso(*self._before, _address(right), _address(answer), ctypes.byref(error))
        self._set_threads(before)
        if error.value and phase != _RELEASE:
            raise MklError(Message("PARDISO reported error {number}", number=error.value))

    def __del__(self) -> None:
        if getattr(self, "_before", None) is not None:
            self.call(_RELEASE)


class MklTransform:
    """Real FFT over the last two axes of C-ordered NumPy arrays of one shape and precision."""

    def __init__(self, shape: tuple[int, ...], dtype: Any, threads: int = 1) -> None:
        self.shape = shape
        self.dtype = np.dtype(dtype)
        single = self.dtype == np.float32
        self._half = (*shape[:-1], shape[-1] // 2 + 1)
        self._complex = np.dtype(np.complex64 if single else np.complex128)
        self._library: Any = mkl_library()
        real, complex_ = (0, shape[-1], 1), (0, self._half[-1], 1)
        self._handles = [
            self._plan(_SINGLE if single else _DOUBLE, into, out, threads)
            for into, out in ((real, complex_), (complex_, real))
        ]

    def forward(self, field: Any, out: Any = None) -> Any:
        field = np.ascontiguousarray(field, dtype=self.dtype)
        spectrum = np.empty(self._half, self._complex) if out is None else out
        compute = self._library.DftiComputeForward
        self._check(compute(self._handles[0], _pointer(field), _pointer(spectrum)))
        return spectrum

    def backward(self, spectrum: Any, out: Any = None) -> Any:
        spectrum = np.ascontiguousarray(spectrum, dtype=self._complex)
        field = np.empty(self.shape, self.dtype) if out is None else out
        compute = self._library.DftiComputeBackward
        self._check(compute(self._handles[1], _pointer(spectrum), _pointer(field)))
        return field

    def __del__(self) -> None:
        for handle in getattr(self, "_handles", ()):
            self._library.DftiFreeDescriptor(ctypes.byref(handle))

    def _plan(
        self, precision: int, into: tuple[int, ...], out: tuple[int, ...], threads: int
    ) -> ctypes.c_void_p:
        handle, three = ctypes.c_void_p(), ctypes.c_long * 3
        size = (ctypes.c_long * 2)(*self.shape[-2:])
        rows = self.shape[-2]
        kind = (ctypes.c_int(precision), ctypes.c_int(_REAL), ctypes.c_long(2))
        self._call("DftiCreateDescriptor", ctypes.byref(handle), *kind, size)
        settings = {
            _CONJUGATE_EVEN_STORAGE: ctypes.c_int(_COMPLEX_COMPLEX),
            _PLACEMENT: ctypes.c_int(_NOT_INPLACE),
            _INPUT_STRIDES: three(*into),
            _OUTPUT_STRIDES: three(*out),
            _INPUT_DISTANCE: ctypes.c_long(rows * into[1]),
            _OUTPUT_DISTANCE: ctypes.c_long(rows * out[1]),
            _NUMBER_OF_TRANSFORMS: ctypes.c_long(math.prod(self.shape[:-2])),
            _THREAD_LIMIT: ctypes.c_long(threads),
            _BACKWARD_SCALE: ctypes.c_double(1.0 / (rows * self.shape[-1])),
        }
        for name, value in settings.items():
            self._call("DftiSetValue", handle, ctypes.c_int(name), value)
        self._call("DftiCommitDescriptor", handle)
        return handle

    def _call(self, name: str, *arguments: Any) -> None:
        self._check(getattr(self._library, name)(*arguments))

    def _check(self, status: int) -> None:
        if status:
            raise MklError(self._library.DftiErrorMessage(ctypes.c_long(status)).decode())


def _pointer(array: Any) -> Any:
    """Return a pointer to a contiguous array, in a quarter of ``_address``'s time.

    An array that is not to be written to has no buffer to give: its address then.
    """
    try:
        return ctypes.byref(ctypes.c_char.from_buffer(array))
    except TypeError:
        return _address(array)


def _address(array: NDArray[Any]) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.__array_interface__["data"][0])
