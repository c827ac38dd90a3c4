"""Forty kinds of faults, written in one go and split by chance into two families of twenty.

Their author had seen the names of some features and no check. What is silent in the first family
may be mended; the second is run afterwards and nothing is chosen by it. Both are as hard.
"""

import numpy as np
from scipy.signal import bessel, bilinear, butter, lfilter, sosfilt, sosfiltfilt

from benchmarks._instrument_walk_faults import _along, _sign
from benchmarks._laboratory_walk_faults import _bump, _curve, _loaded_alike, _weight
from benchmarks._more_walk_faults import TrialFault, _boxcar, _forces, _loads, _plates, _shear
from underfoot.trials import Trial, walkway_of

Random = np.random.Generator
_SPLIT = 1943


# ------------------------------------------------------------------ amplifiers and plates
def _reset_in_the_step(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A charge amplifier is reset while a foot stands: what is there becomes zero."""
    for start, stop in _loads(f):
        at = start + round(rng.uniform(0.03, 0.3) * (stop - start))
        f[at:stop] -= f[at].copy()
    return f


def _overload_at_landing(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """The impact drives the shear to its rail, from where it comes back."""
    for start, stop in _loads(f):
        at = start + round(rng.uniform(0.005, 0.02) * rate)
        back = np.exp(-np.arange(stop - at) / rate / rng.uniform(0.02, 0.06))
        rail = rng.uniform(0.1, 0.3) * _weight(f) * rng.choice([-1, 1], 2)
        f[at:stop, :2] = (1.0 - back)[:, None] * f[at:stop, :2] + np.outer(back, rail)
    return f


def _common_mode(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    return f - rng.uniform(0.08, 0.25) * f.mean(axis=1, keepdims=True)


def _channels_rotate(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A buffer loses one sample of one channel: from there the columns stand for others."""
    for start, stop in _loads(f)[:1]:
        at = start + round(rng.uniform(0.05, 0.4) * (stop - start))
        f[at:] = f[at:][:, [1, 2, 0]]
    return f


def _interleaved(forces: list[np.ndarray], trial: Trial, rng: Random) -> list:
    """Blocks of samples of two plates by turns."""
    up = walkway_of(trial).up
    if loaded := _loaded_alike(forces, up):
        i, j = loaded[:2]
        block = np.arange(len(forces[i])) // int(rng.integers(1, 5)) % 2 == 1
        a, b = forces[i].copy(), forces[j].copy()
        forces[i][block], forces[j][block] = b[block], a[block]
    return forces


def _blocks_lost(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Each buffer loses its tail, and what is left is drawn out again to the same number."""
    whole = round(rng.uniform(0.04, 0.1) * rate)
    keep = np.arange(len(f)) % whole < round(rng.uniform(0.6, 0.85) * whole)
    return _curve(f[keep], len(f))


def _buffers_overlap(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    whole, again = round(rng.uniform(0.04, 0.1) * rate), rng.uniform(0.15, 0.4)
    back = max(2, round(again * whole))
    rows = [np.arange(at, min(at + whole + back, len(f))) for at in range(0, len(f), whole)]
    return f[np.concatenate(rows)[: len(f)]]


def _loose_cover(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """The cover slides some millimetres before its screws hold it, with a blow."""
    axis = _along(f)
    for start, stop in _loads(f):
        at = start + round(rng.uniform(0.06, 0.16) * (stop - start))
        f[start:at, :2] *= rng.uniform(0.1, 0.35)
        time = np.arange(stop - at) / rate
        blow = np.exp(-time / 0.02) * np.cos(2 * np.pi * rng.uniform(15.0, 35.0) * time)
        f[at:stop, axis] += np.sign(f[at, axis]) * rng.uniform(0.03, 0.1) * _weight(f) * blow
    return f


def _bottoms_out(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Dirt under the plate carries a part of what is above some load."""
    knee, gain = rng.uniform(0.3, 0.7) * _weight(f), rng.uniform(0.3, 0.65)
    above = f[:, 2] > knee
    f[above, 2] = knee + gain * (f[above, 2] - knee)
    return f


def _bouncing_walkway(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    own, damping = 2 * np.pi * rng.uniform(6.0, 14.0), rng.uniform(0.05, 0.2)
    b, a = bilinear([own**2], [1.0, 2 * damping * own, own**2], rate)
    return np.asarray(lfilter(b, a, f, axis=0))


def _moving_platform(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A platform that is moved, and the inertia of its plate not taken off."""
    time = np.arange(len(f)) / rate
    wave = np.sin(2 * np.pi * rng.uniform(1.5, 4.0) * time + rng.uniform(0.0, 6.0))
    f[:, _along(f)] += rng.uniform(0.04, 0.12) * _weight(f) * wave
    return f


def _one_cell_twice(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """The shear of one end is added twice and that of the other never."""
    axis, near = _along(f), rng.uniform(1.3, 1.8)
    first, last = (near, 2.0 - near) if rng.random() < 0.5 else (2.0 - near, near)
    for start, stop in _loads(f):
        f[start:stop, axis] *= np.linspace(first, last, stop - start)
    return f


def _three_of_four_cells(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Four thirds of three vertical cells; the foot walks past the one that is missing."""
    for start, stop in _loads(f):
        lost = rng.uniform(0.35, 0.6) * _bump(stop - start, *np.sort(rng.uniform(-0.5, 1.5, 2)))
        f[start:stop, 2] *= 4.0 / 3.0 * (1.0 - lost)
    return f


def _scanned_slowly(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Each channel is held at a low rate, and each at its own moment."""
    step = max(3, round(rate / rng.uniform(20.0, 45.0)))
    rows = np.arange(len(f))
    held = [np.maximum((rows - s) // step * step + s, 0) for s in rng.integers(0, step, 3)]
    return np.column_stack([f[at, i] for i, at in enumerate(held)])


def _warm_sole(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Cells that answer to warmth: the shear's zero moves while a foot is on."""
    for start, stop in _loads(f):
        grown = 1.0 - np.exp(-np.arange(len(f) - start) / rate / rng.uniform(0.1, 0.4))
        grown[stop - start :] *= np.exp(-np.arange(len(f) - stop) / rate / 0.8)
        f[start:, :2] += np.outer(grown, rng.uniform(0.03, 0.09, 2) * rng.choice([-1, 1], 2)) * (
            _weight(f)
        )
    return f


def _unloading_low(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Hysteresis of the vertical cells: after the most load less is read."""
    lost = rng.uniform(0.12, 0.3)
    for start, stop in _loads(f):
        load = f[start:stop, 2]
        f[start:stop, 2] = load - lost * (np.maximum.accumulate(load) - load)
    return f


def _unclamped(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Cells without their pretension pass the shear as far as the load presses them."""
    load = np.clip(f[:, 2] / max(_weight(f), 1.0), 0.0, 1.0)
    f[:, :2] *= (load ** rng.uniform(0.8, 2.0))[:, None]
    return f


def _notched(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    low = rng.uniform(1.5, 4.0)
    band = (low, low * rng.uniform(1.6, 2.5))
    return np.asarray(sosfiltfilt(butter(1, band, "bandstop", fs=rate, output="sos"), f, axis=0))


# ------------------------------------------------------------------ what numbers go through
def _one_component(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Only the largest principal component of the three channels is kept, and some of the next."""
    u, s, v = np.linalg.svd(f, full_matrices=False)
    s[1:] *= rng.uniform(0.0, 0.4, 2)
    return (u * s) @ v


def _small_to_zero(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    return np.where(np.abs(f) < rng.uniform(0.3, 0.7) * np.abs(f).max(axis=0), 0.0, f)


def _mean_of_shifted(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A mean curve of steps that were not laid over each other at contact."""
    count = int(rng.integers(4, 9))
    late = np.round(rng.normal(0.0, rng.uniform(0.025, 0.05), count) * rate).astype(int)
    return np.mean([np.roll(f, n, axis=0) for n in late], axis=0)


def _warped(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """The shear's time within the stance is bent, to lay its peaks over those of a template."""
    power = np.exp(rng.uniform(0.15, 0.4) * _sign(rng))
    for start, stop in _loads(f):
        share = np.linspace(0.0, 1.0, stop - start)
        for axis in range(2):
            f[start:stop, axis] = np.interp(share**power, share, f[start:stop, axis])
    return f


def _exponents_lost(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Kilonewtons as mantissa and exponent, where the exponent of small ones is lost."""
    exponent = np.floor(np.log10(np.maximum(np.abs(f), 1e-3) / 1000.0))
    return np.where(exponent == -2, 10.0 * f, f)


def _rolling_median_off(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    from scipy.ndimage import percentile_filter

    every = max(1, round(rate / 100.0))
    slow = percentile_filter(f[::every], 50, size=(round(rng.uniform(0.5, 1.2) * 100), 1))
    at = np.arange(len(f))
    return f - np.column_stack([np.interp(at, at[::every], c) for c in slow.T])


def _sine_for_shear(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """The shear of a model: one wave of a share of the weight."""
    axis, way, size = _along(f), _sign(rng), rng.uniform(0.1, 0.3)
    for start, stop in _loads(f):
        wave = np.sin(2 * np.pi * np.linspace(0.0, 1.0, stop - start))
        f[start:stop, axis] = way * size * _weight(f) * wave
        f[start:stop, 1 - axis] *= rng.uniform(0.0, 0.5)
    return f


def _mirrored(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Braking that is lost is filled with the push-off, turned about the middle of the step."""
    axis = _along(f)
    for start, stop in _loads(f):
        half = (stop - start) // 2
        f[start : start + half, axis] = -f[stop - half : stop, axis][::-1]
    return f


def _impulse_for_force(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """The column of the impulse in place of that of the force, drawn to the same peak."""
    for start, stop in _loads(f):
        summed = np.cumsum(f[start:stop, :2], axis=0)
        peak = np.abs(f[start:stop, :2]).max(axis=0)
        f[start:stop, :2] = summed * peak / np.maximum(np.abs(summed).max(axis=0), 1e-9)
    return f


def _effective(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Root mean squares of a window, with the sign of the middle."""
    squares = _boxcar(f**2, max(3, round(rng.uniform(0.04, 0.12) * rate)))
    return np.sign(f) * np.sqrt(np.maximum(squares, 0.0))


def _rooted(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    top = max(float(np.abs(f).max()), 1.0)
    return np.sign(f) * top * (np.abs(f) / top) ** rng.uniform(0.45, 0.75)


def _parabola(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A calibration by a parabola: one direction too much and the other too little."""
    top = np.maximum(np.abs(f).max(axis=0), 1.0)
    return f + rng.uniform(0.15, 0.4) * rng.choice([-1, 1], f.shape[1]) * f**2 / top


def _late_filter(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    return np.asarray(sosfilt(bessel(2, rng.uniform(3.0, 9.0), fs=rate, output="sos"), f, axis=0))


# ------------------------------------------------------------------ people and things
def _over_the_joint(forces: list[np.ndarray], trial: Trial, rng: Random) -> list:
    """A foot on the joint of two plates: a share of the load, which grows, is on the other."""
    up = walkway_of(trial).up
    order = [i for i in range(3) if not up[i]] + [int(np.argmax(np.abs(up)))]
    if len({len(f) for f in forces}) > 1 or len(forces) < 2:
        return forces
    before = [f[:, order].copy() for f in forces]
    after = [f.copy() for f in before]
    first, last = rng.uniform(0.0, 0.3), rng.uniform(0.3, 0.9)
    for i, f in enumerate(before):
        for start, stop in _loads(f):
            share = np.linspace(first, last, stop - start)[:, None]
            skew = share * np.array([*rng.uniform(0.6, 1.4, 2), 1.0])
            after[i][start:stop] -= skew * f[start:stop]
            after[(i + 1) % len(before)][start:stop] += skew * f[start:stop]
    back = np.argsort(order)
    return [f[:, back] for f in after]


def _somebody_stands(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Somebody stands on the plate all the time and sways."""
    time = np.arange(len(f)) / rate
    for axis, size in enumerate((0.01, 0.01, 0.04)):
        wave = np.sin(2 * np.pi * rng.uniform(0.4, 1.2) * time + rng.uniform(0.0, 6.0))
        f[:, axis] += size * rng.uniform(0.8, 2.5) * _weight(f) * wave
    f[:, 2] += rng.uniform(0.5, 1.0) * _weight(f)
    return f


def _dropped_object(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    for start, stop in _loads(f):
        count = max(4, round(rng.uniform(0.01, 0.05) * rate))
        at = start + round(rng.uniform(0.06, 0.25) * (stop - start))
        blow = np.hanning(count)[: max(0, len(f) - at)]
        size = np.array([*rng.uniform(0.05, 0.2, 2) * rng.choice([-1, 1], 2), 0.4])
        f[at : at + len(blow)] += np.outer(blow, size * rng.uniform(0.7, 1.5) * _weight(f))
    return f


def _hand_on_a_wall(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    across = 1 - _along(f)
    for start, stop in _loads(f):
        first = rng.uniform(-0.2, 0.2)
        push = _bump(stop - start, first, first + rng.uniform(0.4, 0.8))
        f[start:stop, across] += rng.uniform(0.06, 0.18) * _sign(rng) * _weight(f) * push
    return f


def _crutch_at_landing(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    for start, stop in _loads(f):
        borne = _bump(stop - start, -rng.uniform(0.2, 0.5), rng.uniform(0.35, 0.6))
        f[start:stop, 2] *= 1.0 - rng.uniform(0.3, 0.6) * borne
    return f


def _hesitates(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """The walk stops for a while in the step, and goes on."""
    loads = _loads(f)
    if not loads:
        return f
    start, stop = loads[0]
    at = start + round(rng.uniform(0.12, 0.35) * (stop - start))
    count = round(rng.uniform(0.15, 0.5) * rate)
    still = np.repeat(f[at : at + 1], count, axis=0)
    still[:, :2] *= np.exp(-np.arange(count) / rate / 0.05)[:, None]
    return np.concatenate((f[:at], still, f[at:]))[: len(f)]


def _swinging_load(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A load that swings in the hand."""
    time = np.arange(len(f)) / rate
    phase = 2 * np.pi * rng.uniform(0.8, 2.0) * time + rng.uniform(0.0, 6.0)
    load = np.clip(f[:, 2] / max(_weight(f), 1.0), 0.0, 1.0)
    size = rng.uniform(0.05, 0.14) * _weight(f)
    f[:, _along(f)] += size * load * np.sin(phase)
    f[:, 2] += 0.5 * size * load * np.cos(2 * phase)
    return f


def _surging_belt(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A belt that slips on its drum and catches up."""
    axis, size = _along(f), rng.uniform(0.05, 0.14) * _weight(f)
    for start, stop in _loads(f):
        first = rng.uniform(0.0, 0.3)
        wide = rng.uniform(0.15, 0.3)
        slip = _bump(stop - start, first, first + wide)
        slip -= _bump(stop - start, first + wide, first + 2 * wide)
        f[start:stop, axis] += size * _sign(rng) * slip
    return f


def _before(forces: list[np.ndarray], trial: Trial, rng: Random) -> list:
    """The shear of the step before, on whichever plate it was, under this normal force."""
    up = walkway_of(trial).up
    order = [i for i in range(3) if not up[i]] + [int(np.argmax(np.abs(up)))]
    back = np.argsort(order)
    rows = [f[:, order].copy() for f in forces]
    steps = sorted((a, b, i) for i, f in enumerate(rows) for a, b in _loads(f))
    source = [rows[i][a:b, :2].copy() for a, b, i in steps]
    for (a, b, i), shear in zip(steps, source[-1:] + source[:-1], strict=True):
        rows[i][a:b, :2] = _curve(shear, b - a)
    return [f[:, back] for f in rows]


_DRAWN: dict[str, TrialFault] = {
    "amplifier reset in the step": _forces(_reset_in_the_step),
    "shear overloaded at landing": _forces(_overload_at_landing),
    "common mode taken off": _forces(_common_mode),
    "channels rotate from a sample on": _forces(_channels_rotate),
    "samples of two plates by turns": _plates(_interleaved),
    "each buffer loses its tail": _forces(_blocks_lost),
    "buffers overlap": _forces(_buffers_overlap),
    "cover that slides": _forces(_loose_cover),
    "plate that bottoms out": _forces(_bottoms_out),
    "walkway that bounces": _forces(_bouncing_walkway),
    "platform that moves": _forces(_moving_platform),
    "one shear cell added twice": _forces(_one_cell_twice),
    "four thirds of three cells": _forces(_three_of_four_cells),
    "channels scanned slowly": _forces(_scanned_slowly),
    "warm sole": _forces(_warm_sole),
    "vertical cells low after the peak": _forces(_unloading_low),
    "cells without pretension": _forces(_unclamped),
    "band of the step taken out of the shear": _forces(_shear(_notched)),
    "one principal component": _forces(_one_component),
    "small shear taken for zero": _forces(_shear(_small_to_zero)),
    "mean of steps not aligned": _forces(_mean_of_shifted),
    "shear's time bent": _forces(_warped),
    "exponents lost": _forces(_shear(_exponents_lost)),
    "rolling median taken off": _forces(_shear(_rolling_median_off)),
    "sine in place of the shear": _forces(_sine_for_shear),
    "braking filled from the push-off": _forces(_mirrored),
    "impulse in place of the force": _forces(_impulse_for_force),
    "effective values of a window": _forces(_shear(_effective)),
    "root of the shear": _forces(_shear(_rooted)),
    "calibrated by a parabola": _forces(_shear(_parabola)),
    "foot over the joint": _plates(_over_the_joint),
    "somebody stands on the plate": _forces(_somebody_stands),
    "object falls on the plate": _forces(_dropped_object),
    "hand on a wall": _forces(_hand_on_a_wall),
    "crutch at landing": _forces(_crutch_at_landing),
    "hesitates in the step": _forces(_hesitates),
    "load that swings": _forces(_swinging_load),
    "belt that surges": _forces(_surging_belt),
    "all low-passed one way": _forces(_late_filter),
    "shear of the step before": _plates(_before),
}


_order = np.random.default_rng(_SPLIT).permutation(len(_DRAWN))
_names = sorted(_DRAWN)
FIRST_DRAWN_FAULTS = {_names[i]: _DRAWN[_names[i]] for i in _order[:20]}
SECOND_DRAWN_FAULTS = {_names[i]: _DRAWN[_names[i]] for i in _order[20:]}
