"""What every theory of rough contact takes and returns."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, InputError, Status


@dataclass(frozen=True, slots=True)
class TheoryContact:
    """Averages over a nominally flat rough contact; arrays over ``pressure``.

    ``mean_gap`` (m), ``cof_hysteresis`` and ``spot_density`` (contacts per m^2) are None where
    the theory does not give them; ``not_estimated`` then says why. ``breaches`` lists what lies
    outside the range in which the theory was tested.
    """

    closure: str
    source: str
    pressure: np.ndarray
    real_contact_fraction: np.ndarray
    mean_gap: np.ndarray | None = None
    cof_hysteresis: np.ndarray | None = None
    spot_density: np.ndarray | None = None
    not_estimated: str = ""
    breaches: tuple[Breach, ...] = ()

    @property
    def status(self) -> Status:
        """Return whether the theory was used inside its tested range."""
        return Status.OUT_OF_RANGE if self.breaches else Status.CONVERGED


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
