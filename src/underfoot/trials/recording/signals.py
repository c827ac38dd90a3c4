"""Signals of plates and markers: low-pass filters named in full, unloaded baseline, saturation."""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from underfoot.core import DataError, InputError, unknown_name
from underfoot.core.remark import Message

SHEAR_WARNING = 2.0  # N; above it the required friction moves by more than about 0.01
UNLOADED_LIMIT = 100.0  # N; a larger "offset" is a load that never left the plate
_MINIMUM_SAMPLES = 50
_MARGIN = 0.025  # s, kept away from a loaded stretch on both sides
CONTACT_FORCE = 20.0  # N of vertical force; above it a plate is stood on
_LOWEST, _HIGHEST = 8.0, 60.0  # N above the unloaded level at which a plate counts as loaded


def along(values: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Return the components (n,) of ``values`` (n, 3) along an axis (3,), in double precision.

    Values in single precision, as those of long records, are not held in double too.
    """
    if values.dtype == float:
        return values @ axis
    parts = np.zeros(len(values))
    for column, share in zip(values.T, axis, strict=True):
        parts += column * share
    return parts


def unloaded_samples(vertical: np.ndarray, rate: float) -> np.ndarray:
    """Return a mask of the samples in which nothing stood on the plate, shape (n,).

    The lowest well-filled level of the vertical force is the unloaded one. A stretch of 10 ms
    whose mean lies more than 5 robust standard deviations (8 to 60 N) above it is loaded, and so
    is everything within 25 ms of it. Empty when the plate was never unloaded.

    ``vertical``: upward force on the foot (N), shape (n,); NaN samples count as loaded. ``rate``:
    samples per second.
    """
    none = np.zeros(len(vertical), dtype=bool)
    finite = np.isfinite(vertical)
    if finite.sum() < _MINIMUM_SAMPLES:
        return none
    # A long record is held as few times as can be.
    known = vertical if finite.all() else vertical[finite]
    low, high = np.percentile(known, [0.5, 99.5])
    if high - low < 30.0:
        level, width = float(np.median(known)), 30.0
    else:
        top = min(2.0 * UNLOADED_LIMIT, low + 0.15 * (high - low))
        candidates = known[(known > -2.0 * UNLOADED_LIMIT) & (known < top)]
        if len(candidates) < _MINIMUM_SAMPLES:
            return none
        counts, edges = np.histogram(candidates, bins=max(3, int(np.ptp(candidates) / 5.0)))
        fullest = int(np.argmax(counts))
        inside = (candidates >= edges[fullest] - 5.0) & (candidates <= edges[fullest + 1] + 5.0)
        level = float(np.median(candidates[inside]))
        spread = 1.4826 * float(np.median(np.abs(candidates - level)))
        width = float(np.clip(5.0 * spread, _LOWEST, _HIGHEST))
    if abs(level) > UNLOADED_LIMIT:
        return none
    # Noise passes any limit now and then; a load does so in the mean of 10 ms.
    count = max(1, round(0.01 * rate))
    filled = vertical if known is vertical else np.where(finite, vertical, np.inf)
    smooth = np.convolve(filled, np.full(count, 1.0 / count), "same")
    smooth -= level
    rests = np.abs(smooth, out=smooth) <= width
    return _away_from_load(rests, max(1, round(_MARGIN * rate)))


def frames_between(times: np.ndarray, begin: float, end: float, *, beside: int = 0) -> slice:
    """Return which of rising ``times`` (n,) lie between two (s), both included.

    ``beside``: as many more on both sides.
    """
    first = int(times.searchsorted(begin)) - beside
    return slice(max(first, 0), int(times.searchsorted(end, "right")) + beside)


def enough(mask: np.ndarray) -> bool:
    """True when the mean of the masked samples may serve as a baseline."""
    return int(mask.sum()) >= _MINIMUM_SAMPLES


def is_saturated(signal: np.ndarray, rate: float) -> bool:
    """True when a raw signal (n,) is cut flat at its extreme value.

    Cut flat: it stays at the extreme for 20 ms and 16 samples or more, and comes within 5 ms from
    further away than 1 % of the extreme's height over rest (a rounded peak arrives slowly) and
    than three steps of the converter (a load that stands still dwells on one step).
    """
    signal = signal[np.isfinite(signal)]
    if signal.size < 16:
        return False
    length, approach = max(16, round(0.02 * rate)), max(3, round(0.005 * rate))
    for extreme in (float(signal.max()), float(signal.min())):
        at_extreme = signal == extreme
        if extreme == 0.0 or np.count_nonzero(at_extreme) < length:
            continue
        flat = [(start, stop) for start, stop in runs(at_extreme) if stop - start >= length]
        if not flat:
            continue
        rest = float(np.median(signal))
        spread = float(np.percentile(np.abs(signal - rest), 90))
        steps = np.abs(np.diff(signal))
        quantum = float(steps[steps > 0].min(initial=np.inf))
        height = abs(extreme - rest)
        if height <= 0.2 * spread:
            continue
        limit = max(0.01 * height, 3.0 * quantum)
        if any(abs(signal[max(start - approach, 0)] - extreme) > limit for start, _ in flat):
            return True
    return False


def longest_run(mask: np.ndarray) -> int:
    """Return the length of the longest stretch of True in a mask (n,)."""
    return max((stop - start for start, stop in runs(mask)), default=0)


def runs(mask: np.ndarray) -> list[tuple[int, int]]:
    """Return (start, stop) of every stretch of True in a mask (n,); ``stop`` is excluded."""
    padded = np.concatenate(([False], mask, [False])).astype(np.int8)
    steps = np.diff(padded)
    starts, stops = np.flatnonzero(steps == 1), np.flatnonzero(steps == -1)
    return [(int(a), int(b)) for a, b in zip(starts, stops, strict=True)]


def contacts(
    vertical: np.ndarray, rate: float, threshold: float = CONTACT_FORCE
) -> list[tuple[int, int]]:
    """Return (start, stop) of the stretches in which a plate is stood on, shape of samples.

    A stretch begins where the vertical force (n,), N, passes ``threshold`` and counts when it
    lasts 30 ms and reaches five times the threshold; interruptions below 20 ms are bridged.
    """
    loaded = vertical > threshold  # not where the number is missing
    for start, stop in runs(~loaded):
        if start > 0 and stop < len(loaded) and stop - start < 0.02 * rate:
            loaded[start:stop] = True
    return [
        (start, stop)
        for start, stop in runs(loaded)
        if stop - start >= 0.03 * rate and np.nanmax(vertical[start:stop]) > 5.0 * threshold
    ]


def _away_from_load(mask: np.ndarray, margin: int) -> np.ndarray:
    kept = np.zeros_like(mask)
    for start, stop in runs(mask):
        first = start + (margin if start > 0 else 0)
        last = stop - (margin if stop < len(mask) else 0)
        kept[first : max(first, last)] = True
    return kept


FILTERS = {
    "butterworth-4-zero-phase": Message(
        "Butterworth, 2nd order forward and backward (4th, zero phase)"
    ),
    "butterworth-4-zero-phase-corrected": Message(
        "Butterworth, 2nd order forward and backward, cutoff raised for the two passes (/0.802)"
    ),
    "butterworth-8-zero-phase": Message(
        "Butterworth, 4th order forward and backward (8th, zero phase)"
    ),
    "butterworth-4-one-pass": Message("Butterworth, 4th order, one pass (shifts in time)"),
    "none": Message("no filter"),
}


class _Design(NamedTuple):
    """Order of one pass, whether it is one alone, whether the cutoff is raised for two."""

    order: int = 4
    one_pass: bool = False
    raised: bool = False


_DESIGNS = {
    "butterworth-4-zero-phase": _Design(order=2),
    "butterworth-4-zero-phase-corrected": _Design(order=2, raised=True),
    "butterworth-8-zero-phase": _Design(),
    "butterworth-4-one-pass": _Design(one_pass=True),
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
            raise InputError(
                Message("cutoff {cutoff} Hz", cutoff=self.cutoff),
                where="filter",
                allowed="above 0 Hz",
            )

    @property
    def description(self) -> Message:
        """What the filter is, with its cutoff."""
        if self.kind == "none":
            return FILTERS[self.kind]
        return Message("{kind}, {cutoff:g} Hz", kind=FILTERS[self.kind], cutoff=self.cutoff)

    def __str__(self) -> str:
        return self.description


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
            Message(
                "cutoff {cutoff:g} Hz is too high for {rate:g} samples per second",
                cutoff=low_pass.cutoff,
                rate=rate,
            ),
            where="filter",
            allowed=Message("up to {rate:.3g} Hz", rate=0.45 * rate),
        )
    from scipy import signal

    order, one_pass, raised = _DESIGNS[low_pass.kind]
    cutoff = low_pass.cutoff
    if raised:
        cutoff = min(cutoff / _TWO_PASSES, 0.49 * rate)
    sections = _sections(order, cutoff, rate)
    if one_pass:
        rest = signal.sosfilt_zi(sections)
        rest = rest.reshape(rest.shape + (1,) * (values.ndim - 1)) * values[0]
        return signal.sosfilt(sections, values, axis=0, zi=rest)[0]
    if len(values) < 30:
        raise DataError(
            Message("{count} samples are too few to filter", count=len(values)),
            allowed="30 or more",
        )
    padding = min(len(values) - 1, max(15, round(rate / low_pass.cutoff)))
    if order > 2:
        return signal.sosfiltfilt(sections, values, axis=0, padlen=padding)
    # One section: the numbers of scipy's filtfilt in half its time, the rest state kept.
    begin, end = values[padding:0:-1], values[-2 : -padding - 2 : -1]
    out = np.concatenate((2 * values[0] - begin, values, 2 * values[-1] - end))
    rest = _rest(order, cutoff, rate).reshape((2,) + (1,) * (values.ndim - 1))
    for _ in range(2):
        out = signal.lfilter(sections[0, :3], sections[0, 3:], out, axis=0, zi=rest * out[0])[0]
        out = out[::-1]
    return out[padding:-padding]


def low_passed_part(
    values: np.ndarray, rate: float, low_pass: LowPass, start: int, stop: int
) -> np.ndarray:
    """Return samples ``start`` to ``stop`` of ``values`` (n, k), filtered in their surroundings.

    The filter sees ten over its cutoff (s) before and after, as far as no number is missing: what
    lies beyond adds less than 1e-9 of itself. Errors as ``low_passed``.
    """
    margin = int(min(10.0 / low_pass.cutoff * rate, len(values)))
    begin, end = max(0, start - margin), min(len(values), stop + margin)
    lost = begin + np.flatnonzero(~np.isfinite(values[begin:end] @ np.ones(values.shape[1])))
    begin = max(begin, *(lost[lost < start] + 1), 0)
    end = min(end, *lost[lost >= stop], len(values))
    return low_passed(values[begin:end], rate, low_pass)[start - begin : stop - begin]


@lru_cache(maxsize=64)
def _sections(order: int, cutoff: float, rate: float) -> np.ndarray:
    """Second-order sections of a Butterworth filter: their design takes longer than their use."""
    from scipy import signal

    return np.asarray(signal.butter(order, cutoff, fs=rate, output="sos"))


@lru_cache(maxsize=64)
def _rest(order: int, cutoff: float, rate: float) -> np.ndarray:
    """State (2,) of the section of a second-order filter after a long unit input."""
    from scipy import signal

    sections = _sections(order, cutoff, rate)
    return np.asarray(signal.lfilter_zi(sections[0, :3], sections[0, 3:]))


def velocity(positions: np.ndarray, rate: float, low_pass: LowPass) -> np.ndarray:
    """Return the velocity (n, k) of positions (n, k): filtered, then central differences."""
    return np.gradient(low_passed(positions, rate, low_pass), 1.0 / rate, axis=0)


def bridge_gaps(positions: np.ndarray, longest: int) -> tuple[np.ndarray, np.ndarray]:
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
