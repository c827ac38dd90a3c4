"""What a theory of rough contact returns, the same for every theory."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from underfoot.core import Breach, Status


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
