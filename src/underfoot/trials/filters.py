"""Low-pass filters by name, and speeds from positions.

"Fourth-order low-pass Butterworth, 36 Hz" can mean four filters; they move the required
friction by up to 0.02, so a filter is always named in full.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from underfoot.core import DataError, InputError, unknown_name

from .baseline import runs

FILTERS = {
    "butterworth-4-zero-phase": "Butterworth, 2nd order forward and backward (4th, zero phase)",
    "butterworth-4-zero-phase-corrected": (
        "Butterworth, 2nd order forward and backward, cutoff raised for the two passes (/0.802)"
    ),
    "butterworth-8-zero-phase": "Butterworth, 4th order forward and backward (8th, zero phase)",
    "butterworth-4-one-pass": "Butterworth, 4th order, one pass (shifts in time)",
    "none": "no filter",
}
_TWO_PASSES = 0.802  # (sqrt(2) - 1)^(1/4): the cutoff of two 2nd-order passes over that of one


@dataclass(frozen=True, slots=True)
class LowPass:
    """A named low-pass filter with its cutoff (Hz); the default is the usual one for forces."""

    kind: str = "butterworth-4-zero-phase"
    cutoff: float = 36.0

    def __post_init__(self) -> None:
        if self.kind not in FILTERS:
            raise unknown_name("filter", self.kind, FILTERS, where="filter")
        if not 0 < self.cutoff < np.inf:
            raise InputError(f"cutoff {self.cutoff} Hz", where="filter", allowed="above 0 Hz")

    def __str__(self) -> str:
        return FILTERS[self.kind] + ("" if self.kind == "none" else f", {self.cutoff:g} Hz")


FORCE_FILTER = LowPass()
MARKER_FILTER = LowPass(cutoff=10.0)


def low_passed(values: np.ndarray, rate: float, low_pass: LowPass) -> np.ndarray:
    """Return ``values`` (n,) or (n, k) filtered along the first axis.

    DataError: NaN in the values, or too few samples to filter. InputError: the cutoff is above 0.45
    of the sampling rate.
    """
    values = np.asarray(values, dtype=float)
    if low_pass.kind == "none":
        return values
    if not np.isfinite(values).all():
        raise DataError("samples without a number can't be filtered")
    if low_pass.cutoff > 0.45 * rate:
        raise InputError(
            f"cutoff {low_pass.cutoff:g} Hz is too high for {rate:g} samples per second",
            where="filter",
            allowed=f"up to {0.45 * rate:.3g} Hz",
        )
    from scipy import signal

    order = 2 if low_pass.kind.startswith("butterworth-4-zero") else 4
    cutoff = low_pass.cutoff
    if low_pass.kind.endswith("corrected"):
        cutoff = min(cutoff / _TWO_PASSES, 0.49 * rate)
    sections = _sections(order, cutoff, rate)
    if low_pass.kind.endswith("one-pass"):
        rest = signal.sosfilt_zi(sections)
        rest = rest.reshape(rest.shape + (1,) * (values.ndim - 1)) * values[0]
        return signal.sosfilt(sections, values, axis=0, zi=rest)[0]
    if len(values) < 30:
        raise DataError(f"{len(values)} samples are too few to filter", allowed="30 or more")
    padding = min(len(values) - 1, max(15, round(rate / low_pass.cutoff)))
    return signal.sosfiltfilt(sections, values, axis=0, padlen=padding)


@lru_cache(maxsize=64)
def _sections(order: int, cutoff: float, rate: float) -> np.ndarray:
    """Second-order sections of a Butterworth filter: their design takes longer than their use."""
    from scipy import signal

    return np.asarray(signal.butter(order, cutoff, fs=rate, output="sos"))


def velocity(positions: np.ndarray, rate: float, low_pass: LowPass) -> np.ndarray:
    """Return the velocity (n, k) of positions (n, k): filtered, then central differences."""
    return np.gradient(low_passed(positions, rate, low_pass), 1.0 / rate, axis=0)


def bridged(positions: np.ndarray, longest: int) -> tuple[np.ndarray, np.ndarray]:
    """Return positions (n, k) with gaps of at most ``longest`` frames filled by cubic pieces.

    The second array (n,) is True where a value was filled in. Longer gaps stay NaN, and so do
    gaps at either end: there is nothing to lean on.
    """
    positions = np.array(positions, dtype=float)
    lost = np.asarray(~np.isfinite(positions).all(axis=1))
    filled = np.zeros(len(positions), dtype=bool)
    if not lost.any() or (~lost).sum() < 4:
        return positions, filled
    from scipy.interpolate import PchipInterpolator

    frames = np.arange(len(positions))
    curve = PchipInterpolator(frames[~lost], positions[~lost], axis=0)
    for start, stop in runs(lost):
        if stop - start <= longest and start > 0 and stop < len(positions):
            positions[start:stop] = curve(frames[start:stop])
            filled[start:stop] = True
    return positions, filled
