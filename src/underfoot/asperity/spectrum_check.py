"""What the theories accept as an isotropic power spectrum."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError


def checked_spectrum(wavenumber: ArrayLike, spectrum: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Return wave numbers and spectrum as arrays; raise InputError when they can't be used."""
    q = np.asarray(wavenumber, dtype=float)
    c = np.asarray(spectrum, dtype=float)
    where = "spectrum"
    if q.ndim != 1 or q.shape != c.shape or q.size < 8:
        raise InputError(
            f"wavenumber {q.shape} and spectrum {c.shape} do not fit",
            where=where,
            allowed="two arrays of one length, at least 8 values",
        )
    if not (np.all(np.isfinite(q)) and np.all(np.isfinite(c))):
        raise InputError("some values are not finite", where=where)
    if q[0] <= 0.0 or np.any(np.diff(q) <= 0.0):
        raise InputError("the wave numbers do not rise from above zero", where=where)
    if c.min() < 0.0 or c.max() == 0.0:
        raise InputError(
            f"the smallest density is {c.min():.3g} m^4",
            where=where,
            allowed="zero or more, not all zero",
        )
    return q, c
