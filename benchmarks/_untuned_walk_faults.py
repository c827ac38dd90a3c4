"""Kinds of faults of a walk on which no check was tuned; their author had seen some of the checks.

Each changes raw forces (n, 3), z up, of a plate at ``rate`` (Hz).
"""

import math
from collections.abc import Callable

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d
from scipy.signal import detrend, lfilter

from benchmarks._more_walk_faults import _loads

Random = np.random.Generator
Fault = Callable[[np.ndarray, float, Random], np.ndarray]


def _shear(change: Callable[[np.ndarray, float, Random, np.ndarray], np.ndarray]) -> Fault:
    """A change of the shear (n, 2); the normal force (n,) is told."""

    def fault(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
        return np.column_stack((change(f[:, :2].copy(), rate, rng, f[:, 2]), f[:, 2:]))

    return fault


def _stances(change: Callable[[np.ndarray, Random], np.ndarray]) -> Fault:
    """A change of the forces of each stance."""

    def fault(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
        out = f.copy()
        for start, stop in _loads(f):
            out[start:stop] = change(f[start:stop].copy(), rng)
        return out

    return fault


def _scaled(first: float, last: float, shear: bool = True) -> Callable:
    """A gain that goes from one end of a stance to the other."""

    def change(f: np.ndarray, rng: Random) -> np.ndarray:
        gain = np.linspace(first, last, len(f)) ** rng.uniform(0.7, 1.4)
        f[:, : 2 if shear else 3] *= gain[:, None]
        return f

    return change


def _cut(first: float, last: float, columns: slice, value: float) -> Callable:
    """Forces of a part of the stance, times a number."""

    def change(f: np.ndarray, rng: Random) -> np.ndarray:
        begin, end = (round(share * rng.uniform(0.8, 1.2) * len(f)) for share in (first, last))
        f[begin:end, columns] *= value * rng.uniform(0.5, 1.5)
        return f

    return change


def _exponential(f: np.ndarray, rate: float, rng: Random, _: np.ndarray) -> np.ndarray:
    share = 1.0 / (1.0 + rng.uniform(0.02, 0.06) * rate)
    return np.asarray(lfilter([share], [1.0, share - 1.0], f, axis=0))


def _harmonics(f: np.ndarray, rng: Random) -> np.ndarray:
    base = np.linspace(f[0], f[-1], len(f))
    waves = np.fft.rfft(f - base, axis=0)
    waves[int(rng.integers(3, 6)) :] = 0
    return np.fft.irfft(waves, len(f), axis=0) + base


def _bins(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    width = max(3, round(rng.uniform(0.03, 0.06) * rate))
    starts = np.arange(0, len(f), width)
    counts = np.diff(np.append(starts, len(f)))
    return np.repeat(np.add.reduceat(f, starts) / counts[:, None], counts, axis=0)


def _slewed(f: np.ndarray, rate: float, rng: Random, _: np.ndarray) -> np.ndarray:
    smooth = gaussian_filter1d(f, 0.01 * rate, axis=0)
    most, out = rng.uniform(0.15, 0.4) * np.abs(np.diff(smooth, axis=0)).max(), f.copy()
    for i in range(1, len(f)):
        out[i] = out[i - 1] + np.clip(f[i] - out[i - 1], -most, most)
    return out


def _jittered(f: np.ndarray, rate: float, rng: Random, _: np.ndarray) -> np.ndarray:
    late = 15.0 * rng.uniform(0.01, 0.03) * rate * gaussian_filter1d(rng.normal(size=len(f)), 5)
    frames = np.arange(len(f))
    at = np.clip(frames + late, 0, len(f) - 1)
    return np.column_stack([np.interp(at, frames, column) for column in f.T])


def _decaying(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    fall = np.exp(-np.arange(len(f)) / rate / rng.uniform(0.3, 1.5))
    return f + np.outer(fall, rng.uniform(15, 60, 3) * rng.choice([-1, 1], 3))


def _polynomial(f: np.ndarray, rate: float, rng: Random, _: np.ndarray) -> np.ndarray:
    time = np.linspace(-1.0, 1.0, len(f))
    fit = np.polynomial.polynomial.polyfit(time, f, int(rng.integers(6, 12)))
    return f - np.polynomial.polynomial.polyval(time, fit).T


def _crossed(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    leak = rng.uniform(0.04, 0.1) * rng.choice([-1, 1], (3, 3)) * (1.0 - np.eye(3))
    return f @ (np.eye(3) + leak)


def _digit(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    step = 10.0 ** np.floor(np.log10(np.maximum(np.abs(f), 1e-6)))
    return np.round(f / step) * step


def _wrapped(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    most = rng.uniform(0.6, 0.85) * f[:, 2].max()
    return np.column_stack((f[:, :2], np.where(f[:, 2] > most, f[:, 2] - most, f[:, 2])))


def _sagging(f: np.ndarray, rng: Random) -> np.ndarray:
    f[:, 2] *= 1.0 - rng.uniform(0.2, 0.4) * f[:, 2] / f[:, 2].max()
    return f


def _cane(f: np.ndarray, rng: Random) -> np.ndarray:
    f[:, 2] *= 1.0 - rng.uniform(0.2, 0.4) * np.sin(np.linspace(0.0, np.pi, len(f)))
    return f


def _charged(f: np.ndarray, rng: Random) -> np.ndarray:
    f[:, :2] += rng.uniform(15, 45) * rng.choice([-1, 1], 2)
    return f


def _pushed(f: np.ndarray, rng: Random) -> np.ndarray:
    f[:, int(np.argmin(np.abs(f[:, :2]).max(axis=0)))] += rng.uniform(0.08, 0.2) * f[:, 2]
    return f


def _turning(f: np.ndarray, rng: Random) -> np.ndarray:
    turn = np.exp(1j * np.linspace(0.0, math.radians(rng.uniform(50, 80)), len(f)))
    shear = (f[:, 0] + 1j * f[:, 1]) * turn
    return np.column_stack((shear.real, shear.imag, f[:, 2]))


def _stick_slip(f: np.ndarray, rng: Random) -> np.ndarray:
    saw = np.linspace(0.0, rng.uniform(6, 14), len(f)) % 1.0
    f[:, :2] *= (1.0 - rng.uniform(0.3, 0.6) * saw)[:, None]
    return f


def _zeroed_with_a_foot(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    loads = _loads(f)
    return f - f[loads[0][0] + round(0.03 * rate)] if loads else f


def _logarithmic(f: np.ndarray, rate: float, rng: Random, _: np.ndarray) -> np.ndarray:
    knee = rng.uniform(10, 40)
    return np.sign(f) * knee * np.log1p(np.abs(f) / knee)


def _held_peaks(f: np.ndarray, rate: float, rng: Random, _: np.ndarray) -> np.ndarray:
    count = round(rng.uniform(0.04, 0.1) * rate)
    high, low = (sign * maximum_filter1d(sign * f, count, axis=0) for sign in (1, -1))
    return np.where(np.abs(high) > np.abs(low), high, low)


def _rate_leaks(f: np.ndarray, rate: float, rng: Random, normal: np.ndarray) -> np.ndarray:
    push = np.gradient(gaussian_filter1d(normal, 0.005 * rate), 1.0 / rate)
    f[:, int(rng.integers(2))] += rng.uniform(0.003, 0.01) * rng.choice([-1, 1]) * push
    return f


def _wandering(f: np.ndarray, rate: float, rng: Random, _: np.ndarray) -> np.ndarray:
    gain = gaussian_filter1d(rng.normal(size=len(f)), 0.15 * rate)
    return f * np.exp(rng.uniform(0.25, 0.5) * gain / gain.std())[:, None]


def _slow_noise(f: np.ndarray, rate: float, rng: Random, _: np.ndarray) -> np.ndarray:
    noise = np.cumsum(rng.normal(0, 1, f.shape), axis=0)
    noise -= gaussian_filter1d(noise, 0.4 * rate, axis=0)
    return f + noise / noise.std() * rng.uniform(8, 20)


def _fluttering(f: np.ndarray, rate: float, rng: Random, _: np.ndarray) -> np.ndarray:
    signs = rng.choice([1, -1], len(f) // 20 + 1, p=[0.85, 0.15])
    return f * np.repeat(signs, 20)[: len(f), None]


def _lost_samples(f: np.ndarray, rate: float, rng: Random, _: np.ndarray) -> np.ndarray:
    f[:: int(rng.integers(8, 20))] = 0.0
    return f


def _failing_contact(f: np.ndarray, rate: float, rng: Random, normal: np.ndarray) -> np.ndarray:
    f[normal > rng.uniform(0.3, 0.6) * normal.max()] *= rng.uniform(0.3, 0.7)
    return f


def _echo(low: float, high: float, size: float) -> Fault:
    return lambda f, q, r: (
        f + size * r.uniform(0.7, 1.3) * np.roll(f, round(r.uniform(low, high) * q), axis=0)
    )


def _smoothed(low: float, high: float) -> Fault:
    return lambda f, q, r: gaussian_filter1d(f, r.uniform(low, high) * q, axis=0)


_ALL, _BOTH = slice(0, 3), slice(0, 2)
UNTUNED_FAULTS: dict[str, Fault] = {
    "gaussian smoothing of the shear": _shear(
        lambda f, q, r, _: gaussian_filter1d(f, r.uniform(0.02, 0.05) * q, axis=0)
    ),
    "gaussian smoothing of all": _smoothed(0.025, 0.06),
    "exponential smoothing of the shear": _shear(_exponential),
    "few harmonics kept": _stances(_harmonics),
    "means of bins": _bins,
    "slew rate of an amplifier": _shear(_slewed),
    "clock of the shear jitters": _shear(_jittered),
    "battery dies: gain falls": _shear(
        lambda f, _, r, __: f * np.linspace(1.0, r.uniform(0.4, 0.7), len(f))[:, None]
    ),
    "zero decays after switching on": _decaying,
    "charge at contact": _stances(_charged),
    "mean of the file taken off": lambda f, _, __: f - f.mean(axis=0),
    "trend of the file taken off": lambda f, _, __: detrend(f, axis=0),
    "polynomial taken off the shear": _shear(_polynomial),
    "calibration matrix of another plate": _crossed,
    "gain falls along the plate": _stances(_scaled(1.0, 0.45)),
    "gain grows along the plate": _stances(_scaled(0.45, 1.0)),
    "bridged at its edge": _stances(_scaled(0.35, 1.0, shear=False)),
    "normal force sags": _stances(_sagging),
    "normal force wraps": _wrapped,
    "logarithmic amplifier": _shear(_logarithmic),
    "one digit kept": _digit,
    "negative shear lost": _shear(lambda f, _, r, __: np.where(f < 0, f * r.uniform(0, 0.4), f)),
    "peaks held": _shear(_held_peaks),
    "cane": _stances(_cane),
    "heel beside the plate": _stances(_cut(0.0, 0.13, _ALL, 0.0)),
    "toe beside the plate": _stances(_cut(0.7, 1.3, _ALL, 0.0)),
    "stops": _stances(_cut(0.5, 1.3, _BOTH, 0.1)),
    "starts": _stances(_cut(0.0, 0.5, _BOTH, 0.1)),
    "turns": _stances(_turning),
    "pushed sideways": _stances(_pushed),
    "zero with a foot on": _zeroed_with_a_foot,
    "echo of the step": _echo(0.1, 0.25, 0.3),
    "echo taken off": _echo(0.03, 0.08, -0.22),
    "shear with its own rate": _shear(
        lambda f, q, r, _: (
            f + r.uniform(0.008, 0.025) * q * gaussian_filter1d(f, 0.004 * q, axis=0, order=1)
        )
    ),
    "shear with the rate of the normal": _shear(_rate_leaks),
    "resultant in one channel": _shear(
        lambda f, _, __, ___: np.column_stack((np.hypot(*f.T), 0.0 * f[:, 0]))
    ),
    "sign flutters": _shear(_fluttering),
    "every nth sample lost": _shear(_lost_samples),
    "white noise": _shear(lambda f, _, r, __: f + r.normal(0, r.uniform(40, 90), f.shape)),
    "slow noise": _shear(_slow_noise),
    "normal force in a shear channel": _shear(
        lambda f, _, __, normal: np.column_stack((0.3 * normal, f[:, 1]))
    ),
    "one channel twice": _shear(lambda f, _, r, __: f[:, [int(r.integers(2))] * 2]),
    "stick-slip of a mount": _stances(_stick_slip),
    "gain wanders": _shear(_wandering),
    "contact that fails under load": _shear(_failing_contact),
    "hole in the normal force": _stances(_cut(0.06, 0.11, slice(2, 3), 0.5)),
    "hole in the shear": _stances(_cut(0.05, 0.18, _BOTH, 0.1)),
    "shear late by 50 to 200 ms": _shear(
        lambda f, q, r, _: np.roll(f, round(r.uniform(0.05, 0.2) * q), axis=0)
    ),
    "six bits": lambda f, _, r: (
        np.floor(f / (step := max(np.abs(f).max(), 1.0) / 127 * r.uniform(2, 4))) * step
    ),
}
