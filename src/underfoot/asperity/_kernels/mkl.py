"""Intel's Fourier transforms through their C interface (DFTI), where the library is installed.

About 2.5 times faster than SciPy's on one thread. The library comes with the sparse direct solver;
nothing else of it is used here.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

from underfoot.core.mkl import mkl_library

Array = Any

# names and values of mkl_dfti.h
_SINGLE, _DOUBLE, _REAL = 35, 36, 33
_BACKWARD_SCALE, _CONJUGATE_EVEN_STORAGE, _PLACEMENT = 5, 10, 11
_INPUT_STRIDES, _OUTPUT_STRIDES, _THREAD_LIMIT = 12, 13, 27
_COMPLEX_COMPLEX, _NOT_INPLACE = 39, 44


class MklTransform:
    """Real FFT of C-ordered NumPy arrays of one shape and precision, into its own buffers."""

    def __init__(self, shape: tuple[int, int], dtype: Any, threads: int = 1) -> None:
        self.shape = shape
        self.dtype = np.dtype(dtype)
        single = self.dtype == np.float32
        half = shape[1] // 2 + 1
        self._library: Any = mkl_library()
        self._spectrum = np.empty((shape[0], half), np.complex64 if single else np.complex128)
        self._field = np.empty(shape, self.dtype)
        self._spectrum_at, self._field_at = _at(self._spectrum), _at(self._field)
        self._forward = self._library.DftiComputeForward
        self._backward = self._library.DftiComputeBackward
        real, complex_ = (0, shape[1], 1), (0, half, 1)
        self._handles: list[ctypes.c_void_p] = []
        for strides in ((real, complex_), (complex_, real)):
            self._handles.append(
                self._plan(_SINGLE if single else _DOUBLE, strides[0], strides[1], threads)
            )

    def forward(self, field: Array) -> Array:
        """Return the half spectrum of a real field."""
        field = np.ascontiguousarray(field, dtype=self.dtype)
        self._check(self._forward(self._handles[0], _at(field), self._spectrum_at))
        return self._spectrum

    def backward(self, spectrum: Array) -> Array:
        """Return the real field of a half spectrum."""
        spectrum = np.ascontiguousarray(spectrum, dtype=self._spectrum.dtype)
        own = spectrum is self._spectrum
        where = self._spectrum_at if own else _at(spectrum)
        self._check(self._backward(self._handles[1], where, self._field_at))
        return self._field

    def __del__(self) -> None:
        for handle in getattr(self, "_handles", ()):
            self._library.DftiFreeDescriptor(ctypes.byref(handle))

    def _plan(
        self, precision: int, into: tuple[int, ...], out: tuple[int, ...], threads: int
    ) -> ctypes.c_void_p:
        handle = ctypes.c_void_p()
        three = ctypes.c_long * 3
        scale = ctypes.c_double(1.0 / (self.shape[0] * self.shape[1]))
        lengths = (ctypes.c_long * 2)(*self.shape)
        self._call(
            "DftiCreateDescriptor",
            ctypes.byref(handle),
            ctypes.c_int(precision),
            ctypes.c_int(_REAL),
            ctypes.c_long(2),
            lengths,
        )
        settings = (
            (_CONJUGATE_EVEN_STORAGE, ctypes.c_int(_COMPLEX_COMPLEX)),
            (_PLACEMENT, ctypes.c_int(_NOT_INPLACE)),
            (_INPUT_STRIDES, three(*into)),
            (_OUTPUT_STRIDES, three(*out)),
            (_THREAD_LIMIT, ctypes.c_long(threads)),
            (_BACKWARD_SCALE, scale),
        )
        for name, value in settings:
            self._call("DftiSetValue", handle, ctypes.c_int(name), value)
        self._call("DftiCommitDescriptor", handle)
        return handle

    def _call(self, name: str, *arguments: Any) -> None:
        self._check(getattr(self._library, name)(*arguments))

    def _check(self, status: int) -> None:
        if status:
            raise RuntimeError(self._library.DftiErrorMessage(ctypes.c_long(status)).decode())


def _at(array: Array) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.__array_interface__["data"][0])
