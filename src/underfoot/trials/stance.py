"""One contact with one force plate, and where contacts begin and end."""

from dataclasses import dataclass

import numpy as np

from .axes import Direction
from .baseline import runs
from .measurement import Flag

CONTACT_FORCE = 20.0  # N
_UNKNOWN = Direction()


@dataclass(frozen=True, slots=True, eq=False)
class Stance:
    """One contact with one plate; ``reason`` says why it is no step, and is empty when it is.

    ``number`` counts the contacts of a trial from 1, ``start`` and ``stop`` are sample numbers of
    the plate (stop excluded), ``contact`` and ``toe_off`` the times (s), ``peak`` the largest
    vertical force (N). ``by_hand`` names what was edited.
    """

    plate: str
    start: int
    stop: int
    contact: float
    toe_off: float
    peak: float
    reason: str = ""
    side: str = "unknown"
    heel: str = ""
    direction: Direction = _UNKNOWN
    flags: tuple[Flag, ...] = ()
    number: int = 0
    by_hand: tuple[str, ...] = ()

    @property
    def accepted(self) -> bool:
        """True when the contact is one whole step."""
        return not self.reason

    @property
    def walking(self) -> np.ndarray | None:
        """Walking direction (3,), or None."""
        return self.direction.vector

    @property
    def duration(self) -> float:
        """Length of the contact (s)."""
        return self.toe_off - self.contact

    @property
    def label(self) -> str:
        """Name of the step in tables."""
        return f"step {self.number} on {self.plate}"


def contacts(
    vertical: np.ndarray, rate: float, threshold: float = CONTACT_FORCE
) -> list[tuple[int, int]]:
    """Return (start, stop) of the stretches in which a plate is stood on, shape of samples.

    A stretch begins where the vertical force (n,), N, passes ``threshold`` and counts when it
    lasts 30 ms and reaches five times the threshold; interruptions below 20 ms are bridged.
    """
    loaded = np.nan_to_num(vertical, nan=0.0) > threshold
    for start, stop in runs(~loaded):
        if start > 0 and stop < len(loaded) and stop - start < 0.02 * rate:
            loaded[start:stop] = True
    return [
        (start, stop)
        for start, stop in runs(loaded)
        if stop - start >= 0.03 * rate and np.nanmax(vertical[start:stop]) > 5.0 * threshold
    ]
