"""Forty further kinds of faults of a walk, written after features and limits were settled."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from underfoot.trials import Plate, Trial, finished_plate, walkway_of

TrialFault = Callable[[Trial, np.random.Generator], Trial]
Change = Callable[[np.ndarray, float, np.random.Generator], np.ndarray]


def _forces(change: Change, plates: str = "all") -> TrialFault:
    """A change of raw forces (n, 3), z up, on all plates alike or on the first that is loaded."""

    def fault(trial: Trial, rng: np.random.Generator) -> Trial:
        up = walkway_of(trial).up
        order = [i for i in range(3) if not up[i]] + [int(np.argmax(np.abs(up)))]
        back, state, done = np.argsort(order), int(rng.integers(2**32)), False
        made = []
        for plate in trial.plates:
            force = plate.force
            loaded = bool((force @ up).max() > 100.0)
            if plates == "all" or (loaded and not done):
                draws = np.random.default_rng(state)
                force = change(force[:, order].copy(), plate.rate, draws)[:, back]
                done = done or loaded
            made.append(_with(trial, plate, force))
        return replace(trial, plates=tuple(made))

    return fault


def _with(trial: Trial, plate: Plate, force: np.ndarray, rate: float = 1.0) -> Plate:
    return finished_plate(
        plate.name, force, rate=plate.rate * rate, start=plate.start / rate,
        up=walkway_of(trial).up, centre_of_pressure=plate.centre_of_pressure,
        corners=plate.corners,
    )  # fmt: skip


def _plates(how: Callable[[list[np.ndarray], Trial, np.random.Generator], list]) -> TrialFault:
    """Something done to the list of raw forces of all plates."""

    def fault(trial: Trial, rng: np.random.Generator) -> Trial:
        forces = how([p.force.copy() for p in trial.plates], trial, rng)
        plates = zip(trial.plates, forces, strict=True)
        return replace(trial, plates=tuple(_with(trial, p, f) for p, f in plates))

    return fault


def _clocks(forces: tuple[float, float], markers: bool) -> TrialFault:
    """Rates of the plates wrong by a factor, and those of markers and events with them."""

    def fault(trial: Trial, rng: np.random.Generator) -> Trial:
        factor = float(rng.choice(forces)) * float(rng.uniform(0.9, 1.1))
        made = replace(trial, plates=tuple(_with(trial, p, p.force, factor) for p in trial.plates))
        if not markers:
            return made
        return replace(
            made,
            markers={
                n: replace(m, rate=m.rate * factor, start=m.start / factor)
                for n, m in trial.markers.items()
            },
            events=tuple(replace(e, time=e.time / factor) for e in trial.events),
        )

    return fault


def _shear(change: Change) -> Change:
    def both(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
        return np.column_stack((change(f[:, :2], rate, rng), f[:, 2]))

    return both


def _loads(f: np.ndarray) -> list[tuple[int, int]]:
    on = np.concatenate(([False], f[:, 2] > 20.0, [False])).astype(int)
    step = np.diff(on)
    pairs = zip(np.flatnonzero(step == 1), np.flatnonzero(step == -1), strict=True)
    return [(int(a), int(b)) for a, b in pairs if b - a > 50]


def _hysteresis(f: np.ndarray, width: float) -> np.ndarray:
    out, state = f.copy(), np.zeros(f.shape[1])
    for i, row in enumerate(f):
        state = np.clip(state, row - width, row + width)
        out[i] = state
    return out


def _boxcar(f: np.ndarray, count: int) -> np.ndarray:
    kernel = np.ones(count) / count
    return np.column_stack([np.convolve(c, kernel, "same") for c in f.T])


def _median(f: np.ndarray, count: int) -> np.ndarray:
    from scipy.ndimage import median_filter

    return median_filter(f, (count | 1, 1))


def _splined(f: np.ndarray, rate: float, slow: float) -> np.ndarray:
    from scipy.interpolate import CubicSpline

    time = np.arange(len(f)) / rate
    at = np.arange(0.0, time[-1], 1.0 / slow)
    knots = np.column_stack([np.interp(at, time, c) for c in f.T])
    return CubicSpline(at, knots)(np.clip(time, 0.0, at[-1]))


def _stairs(f: np.ndarray, rate: float, slow: float) -> np.ndarray:
    step = max(2, round(rate / slow))
    return f[np.arange(len(f)) // step * step]


def _high_passed(f: np.ndarray, rate: float, hertz: float) -> np.ndarray:
    from scipy.signal import butter, sosfiltfilt

    return sosfiltfilt(butter(1, hertz, "high", fs=rate, output="sos"), f, axis=0)


def _resonant(f: np.ndarray, rate: float, hertz: float, damping: float) -> np.ndarray:
    """A plate on a loose mount: an oscillator of one degree of freedom between foot and sensor."""
    from scipy.signal import bilinear, lfilter

    w = 2 * math.pi * hertz
    b, a = bilinear([w * w], [1.0, 2 * damping * w, w * w], rate)
    return lfilter(b, a, f, axis=0)


def _ringing(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
    size, hertz = rng.uniform(30, 90), rng.uniform(12, 30)
    for start, _ in _loads(f):
        time = np.arange(len(f) - start) / rate
        wave = size * np.exp(-time / rng.uniform(0.04, 0.12)) * np.sin(2 * np.pi * hertz * time)
        f[start:, :2] += wave[:, None] * rng.choice([-1, 1], 2)
    return f


def _creep(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
    grown = np.cumsum(np.where(f[:, 2] > 20, f[:, 2], 0.0)) / rate
    for start, stop in _loads(f):
        share = rng.uniform(0.15, 0.5) * rng.choice([-1, 1])
        f[start:stop, int(rng.integers(2))] += share * (grown[start:stop] - grown[start])
    return f


def _burst(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
    for start, _ in _loads(f):
        at, count = start + round(rng.uniform(0.02, 0.06) * rate), round(0.08 * rate)
        f[at : at + count, :2] += rng.normal(0, rng.uniform(40, 120), f[at : at + count, :2].shape)
    return f


def _rail(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
    for start, _ in _loads(f):
        for at in start + (rng.uniform(0.02, 0.2, 4) * rate).astype(int):
            f[at : at + max(2, round(0.004 * rate)), :2] = rng.choice([-1, 1]) * 250.0
    return f


def _late_onset(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
    for start, _ in _loads(f):
        f[start : start + round(rng.uniform(0.1, 0.16) * rate), :2] *= rng.uniform(0, 0.4)
    return f


def _ranged(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
    for start, _ in _loads(f):
        f[start + round(rng.uniform(0.03, 0.08) * rate) :, :2] *= rng.choice([0.5, 2.0])
    return f


def _flipped(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
    for start, _ in _loads(f):
        f[start + round(rng.uniform(0.05, 0.1) * rate) :, :2] *= -1.0
    return f


def _backward(f: np.ndarray, _: float, __: np.random.Generator) -> np.ndarray:
    for start, stop in _loads(f):
        f[start:stop, :2] = f[start:stop, :2][::-1]
    return f


def _skewed(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
    axis = int(np.argmax(np.abs(f[:, :2]).max(axis=0)))
    f[:, axis] = np.roll(f[:, axis], round(rng.uniform(0.012, 0.04) * rate))
    return f


def _half_gain(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
    factor, sign = rng.choice([0.4, 0.5, 0.6]), rng.choice([-1, 1])
    return np.where(sign * f > 0, f * [factor, factor, 1.0], f)


def _thresholded(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
    f[f[:, 2] < rng.uniform(200, 400)] = 0.0
    return f


def _wrapped(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
    top = rng.uniform(0.5, 0.8) * np.abs(f[:, :2]).max()
    f[:, :2] = (f[:, :2] + top) % (2 * top) - top
    return f


def _bit_stuck(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
    bit = 2 ** int(rng.integers(4, 6))
    f[:, :2] = (np.round(f[:, :2]).astype(int) | bit).astype(float)
    return f


def _turned_about(f: np.ndarray, angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return f @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])


def _two_copies(f: np.ndarray, rate: float, rng: np.random.Generator) -> np.ndarray:
    return 0.5 * (f + np.roll(f, round(rng.uniform(0.04, 0.09) * rate), axis=0))


def _mixed_feet(forces: list[np.ndarray], trial: Trial, rng: np.random.Generator) -> list:
    if len({len(f) for f in forces}) > 1:
        return forces
    share, total = rng.uniform(0.12, 0.3), np.sum(forces, axis=0)
    up = walkway_of(trial).up
    return [f + share * ((rest := total - f) - np.outer(rest @ up, up)) for f in forces]


def _channels_exchanged(forces: list[np.ndarray], trial: Trial, rng: np.random.Generator) -> list:
    loaded = [i for i, f in enumerate(forces) if np.abs(f @ walkway_of(trial).up).max() > 100]
    up = walkway_of(trial).up
    if len(loaded) > 1 and len(forces[loaded[0]]) == len(forces[loaded[1]]):
        i, j = loaded[:2]
        a, b = (forces[k] - np.outer(forces[k] @ up, up) for k in (i, j))
        forces[i], forces[j] = forces[i] - a + b, forces[j] - b + a
    return forces


def _other_person(forces: list[np.ndarray], trial: Trial, rng: np.random.Generator) -> list:
    """The shear over the weight of a lighter or heavier person."""
    up, gain = walkway_of(trial).up, float(rng.choice([0.55, 0.65, 1.45, 1.6]))
    made = []
    for force in forces:
        normal = np.outer(force @ up, up)
        made.append(normal + gain * (force - normal))
    return made


MORE_FAULTS: dict[str, TrialFault] = {
    "soft compression of the shear": _forces(
        _shear(
            lambda f, _, r: (
                (top := r.uniform(0.4, 0.8) * max(np.abs(f).max(), 1.0)) * np.tanh(f / top)
            )
        )
    ),
    "soft compression of the normal force": _forces(
        lambda f, _, r: np.column_stack(
            (f[:, :2], (top := r.uniform(0.5, 0.9) * f[:, 2].max()) * np.tanh(f[:, 2] / top))
        )
    ),
    "gain that grows with the shear": _forces(
        _shear(lambda f, _, r: f * (np.abs(f) / max(np.abs(f).max(), 1.0)) ** r.uniform(0.3, 0.8))
    ),
    "dead band of the shear": _forces(
        _shear(lambda f, _, r: np.sign(f) * np.maximum(np.abs(f) - r.uniform(15, 40), 0))
    ),
    "backlash of the shear": _forces(_shear(lambda f, _, r: _hysteresis(f, r.uniform(12, 35)))),
    "gain of the shear on one plate": _forces(
        _shear(lambda f, _, r: f * r.choice([0.5, 0.65, 1.5, 1.8])), "one"
    ),
    "gain of the normal force on one plate": _forces(
        lambda f, _, r: f * [1, 1, r.choice([0.6, 0.75, 1.4, 1.7])], "one"
    ),
    "shear of one plate turned": _forces(lambda f, _, r: f * [-1, -1, 1], "one"),
    "x and y exchanged on one plate": _forces(lambda f, _, r: f[:, [1, 0, 2]], "one"),
    "gains of x and y of different ranges": _forces(
        lambda f, _, r: f * [r.choice([0.4, 0.5, 2.0]), r.choice([0.4, 0.5, 2.0]), 1]
    ),
    "one polarity with another gain": _forces(_half_gain),
    "shear wraps over its range": _forces(_wrapped),
    "a bit of the converter stuck": _forces(_bit_stuck),
    "sign of the shear lost": _forces(_shear(lambda f, _, r: np.abs(f))),
    "mean of a window of the shear": _forces(
        _shear(lambda f, q, r: _boxcar(f, round(r.uniform(0.06, 0.14) * q)))
    ),
    "mean of a window of all": _forces(
        lambda f, q, r: _boxcar(f, round(r.uniform(0.05, 0.12) * q))
    ),
    "median of a window": _forces(lambda f, q, r: _median(f, round(r.uniform(0.08, 0.16) * q))),
    "splined from a low rate": _forces(lambda f, q, r: _splined(f, q, r.uniform(10, 25))),
    "stairs of a low rate": _forces(lambda f, q, r: _stairs(f, q, r.uniform(15, 40))),
    "coupled over a capacitor": _forces(lambda f, q, r: _high_passed(f, q, r.uniform(0.3, 1.5))),
    "plate on a loose mount": _forces(
        _shear(lambda f, q, r: _resonant(f, q, r.uniform(4, 9), r.uniform(0.3, 0.8)))
    ),
    "plate that rings": _forces(_ringing),
    "creep under load": _forces(_creep),
    "loose plug at the peak": _forces(_burst),
    "shear at the rail now and then": _forces(_rail),
    "shear begins late": _forces(_late_onset),
    "range switched in the step": _forces(_ranged),
    "polarity lost in the step": _forces(_flipped),
    "shear read backward": _forces(_backward),
    "one channel scanned late": _forces(_skewed),
    "forces below a threshold at zero": _forces(_thresholded),
    "shear leaks into the normal force": _forces(
        lambda f, _, r: (
            f + np.outer(f[:, 0] + f[:, 1], [0, 0, r.uniform(0.6, 1.5) * r.choice([-1, 1])])
        )
    ),
    "x leaks into y": _forces(
        lambda f, _, r: f @ np.array([[1, a := r.uniform(0.5, 1), 0], [a, 1, 0], [0, 0, 1]])
    ),
    "plate turned about the vertical": _forces(
        lambda f, _, r: _turned_about(f, math.radians(r.uniform(20, 70) * r.choice([-1, 1])))
    ),
    "two copies of a step averaged": _forces(_two_copies),
    "force of the other plate leaks in": _plates(_mixed_feet),
    "shear of two plates exchanged": _plates(_channels_exchanged),
    "shear in per cent of another body": _plates(_other_person),
    "rate of the plates wrong": _clocks((0.5, 2.0), markers=False),
    "all rates wrong": _clocks((0.5, 2.0), markers=True),
}  # fmt: skip
