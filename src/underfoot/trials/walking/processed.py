"""Signs that forces were changed before they were stored: a moving average, a dead band."""

from functools import lru_cache

import numpy as np

from ..recording.signals import runs

_AROUND = 0.3  # s of the record beside the stance that belong to its spectrum
_WINDOWS = np.geomspace(0.015, 0.16, 140)  # s of moving averages that are sought
_HIGHEST = 260.0  # Hz, beyond which there is noise of the converter alone
_HARMONICS, _FEWEST = 8, 3
_STILL = 0.015  # s


def comb_depth(forces: np.ndarray, rate: float) -> tuple[float, float]:
    """Return how deep (dB) the spectra of forces (n, k) fall at multiples of one frequency.

    A moving average over T takes every multiple of 1 / T out, whatever it averages. The depth is
    that of the mean level (of logarithms, over the forces) there below the level half way between,
    for the T (s) where it is largest, which comes second.
    """
    count = 4 * len(forces)
    line = np.linspace(0.0, 1.0, len(forces))[:, None]
    level = forces - (forces[0] + (forces[-1] - forces[0]) * line)
    power = np.abs(np.fft.rfft(level, count, axis=0)) ** 2
    log = (10.0 * np.log10(power + 1e-12 * power.max(axis=0) + 1e-300)).mean(axis=1)
    windows, orders, at = _combs(rate)
    if not len(windows):
        return 0.0, 0.0
    levels = np.interp(at, rate / count * np.arange(len(log)), log)
    firsts = np.concatenate(([0], np.cumsum(2 * orders + 1)[:-1]))
    parts = np.add.reduceat(levels, np.column_stack((firsts, firsts + orders)).ravel())
    depths = parts[1::2] / (orders + 1) - parts[::2] / orders
    best = int(np.argmax(depths))
    return (float(depths[best]), float(windows[best])) if depths[best] > 0.0 else (0.0, 0.0)


@lru_cache(maxsize=8)  # every step of a recording asks
def _combs(rate: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Windows (s), how many multiples of each, and these and what lies between (Hz) in a row."""
    most = (min(_HIGHEST, 0.45 * rate) * _WINDOWS).astype(int)
    windows, orders = _WINDOWS[most >= _FEWEST], np.minimum(most[most >= _FEWEST], _HARMONICS)
    at = [
        np.concatenate((np.arange(1, order + 1), np.arange(order + 1) + 0.5)) / window
        for window, order in zip(windows, orders, strict=True)
    ]
    return windows, orders, np.concatenate(at) if at else np.empty(0)


def comb_depths(
    force: np.ndarray, rate: float, start: int, stop: int, up: np.ndarray
) -> tuple[float, float]:
    """Return ``comb_depth`` of a stance in its surroundings: of all forces (n, 3), or of the shear.

    The deeper of both.
    """
    beside = round(_AROUND * rate)
    part = force[max(0, start - beside) : stop + beside]
    if len(part) < 64 or not np.isfinite(part).all():
        return 0.0, 0.0
    shear = np.delete(part, int(np.argmax(np.abs(up))), axis=1)
    return max(comb_depth(part, rate), comb_depth(shear, rate))


def dead_time(force: np.ndarray, rate: float, start: int, stop: int) -> float:
    """Return for how long (s) a force (n,) rests at exactly its unloaded level while it is loaded.

    Between 10 and 90 % of the stance. Zero where it rests as long at other levels (a coarse
    converter) or where the level of the unloaded force is not one number.
    """
    inner = slice(start + (stop - start) // 10, stop - (stop - start) // 10)
    outside = force[max(0, start - round(_AROUND * rate)) : max(0, start - round(0.02 * rate))]
    if len(outside) < 20:
        return 0.0
    rest = float(np.median(outside))
    if (outside == rest).mean() < 0.9:
        return 0.0
    part = force[inner]
    same = np.append(np.diff(part) == 0.0, False)
    longest = {True: 0, False: 0}
    for begin, end in runs(same):
        at_rest = bool(part[begin] == rest)
        longest[at_rest] = max(longest[at_rest], end - begin + 1)
    time = longest[True] / rate
    return time if time >= _STILL and longest[True] > 2 * longest[False] else 0.0
