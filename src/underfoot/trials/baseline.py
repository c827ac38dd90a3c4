"""Baseline of an unloaded force plate and saturated samples: found, subtracted, said."""

import numpy as np

SHEAR_WARNING = 2.0  # N; above it the required friction moves by more than about 0.01
UNLOADED_LIMIT = 100.0  # N; a larger "offset" is a load that never left the plate
_MINIMUM_SAMPLES = 50
_MARGIN = 0.025  # s, kept away from a loaded stretch on both sides
_LOWEST, _HIGHEST = 8.0, 60.0  # N above the unloaded level at which a plate counts as loaded


def unloaded(vertical: np.ndarray, rate: float) -> np.ndarray:
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
    low, high = np.percentile(vertical[finite], [0.5, 99.5])
    if high - low < 30.0:
        level, width = float(np.median(vertical[finite])), 30.0
    else:
        near = np.abs(np.where(finite, vertical, np.inf)) < 2.0 * UNLOADED_LIMIT
        candidates = vertical[near & (vertical < low + 0.15 * (high - low))]
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
    smooth = np.convolve(np.where(finite, vertical, np.inf), np.full(count, 1.0 / count), "same")
    return _away_from_load(np.abs(smooth - level) <= width, max(1, round(_MARGIN * rate)))


def enough(mask: np.ndarray) -> bool:
    """True when the mean of the masked samples may serve as a baseline."""
    return int(mask.sum()) >= _MINIMUM_SAMPLES


def saturated(signal: np.ndarray, rate: float) -> bool:
    """True when a raw signal (n,) is cut flat at its extreme value.

    Cut flat: it stays at the extreme for 20 ms and 16 samples or more, and comes within 5 ms from
    further away than 1 % of the extreme's height over rest (a rounded peak arrives slowly) and
    than three steps of the converter (a load that stands still dwells on one step).
    """
    signal = signal[np.isfinite(signal)]
    if signal.size < 16:
        return False
    rest = float(np.median(signal))
    spread = float(np.percentile(np.abs(signal - rest), 90))
    steps = np.abs(np.diff(signal))
    quantum = float(steps[steps > 0].min(initial=np.inf))
    length, approach = max(16, round(0.02 * rate)), max(3, round(0.005 * rate))
    for extreme in (float(signal.max()), float(signal.min())):
        height = abs(extreme - rest)
        if height <= 0.2 * spread or extreme == 0.0:
            continue
        for start, stop in runs(signal == extreme):
            before = abs(signal[max(start - approach, 0)] - extreme)
            if stop - start >= length and before > max(0.01 * height, 3.0 * quantum):
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


def _away_from_load(mask: np.ndarray, margin: int) -> np.ndarray:
    kept = np.zeros_like(mask)
    for start, stop in runs(mask):
        first = start + (margin if start > 0 else 0)
        last = stop - (margin if stop < len(mask) else 0)
        kept[first : max(first, last)] = True
    return kept
