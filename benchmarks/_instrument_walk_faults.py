"""Twenty kinds of faults of instruments, exports and feet; their author had not read the checks.

Written from how a plate is wired and calibrated, how numbers are stored and filtered, and what a
person does on a plate beside walking. Each changes a whole trial.
"""

import math
from dataclasses import replace

import numpy as np
from scipy.fft import dct, idct
from scipy.signal import savgol_filter

from benchmarks._laboratory_walk_faults import _bump, _curve, _weight
from benchmarks._more_walk_faults import TrialFault, _forces, _loads, _plates, _shear
from underfoot.trials import Trial, walkway_of

Random = np.random.Generator


def _along(f: np.ndarray) -> int:
    return int(np.argmax(np.abs(f[:, :2]).max(axis=0)))


def _sign(rng: Random) -> float:
    return float(rng.choice([-1.0, 1.0]))


# ------------------------------------------------------------------ how a plate is made
def _in_the_frame_of_the_foot(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Components along the foot, which lands toe up and leaves with its heel up."""
    axis, way = _along(f), _sign(rng)
    landing, leaving = np.radians(rng.uniform(12.0, 25.0)), np.radians(rng.uniform(30.0, 55.0))
    for start, stop in _loads(f):
        share = np.linspace(0.0, 1.0, stop - start)
        pitch = np.interp(share, [0.0, 0.15, 0.6, 1.0], [landing, 0.0, 0.0, -leaving]) * way
        shear, normal = f[start:stop, axis].copy(), f[start:stop, 2].copy()
        f[start:stop, axis] = np.cos(pitch) * shear - np.sin(pitch) * normal
        f[start:stop, 2] = np.cos(pitch) * normal + np.sin(pitch) * shear
    return f


def _gain_falls_with_load(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Cells that stiffen: the shear is read the smaller the more stands on them."""
    load = np.clip(f[:, 2], 0.0, None) / max(_weight(f), 1.0)
    f[:, :2] *= (1.0 - rng.uniform(0.2, 0.5) * load)[:, None]
    return f


def _square_crosstalk(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    load = np.clip(f[:, 2], 0.0, None)
    size = rng.uniform(0.03, 0.1, 2) * rng.choice([-1, 1], 2)
    f[:, :2] += np.outer(load**2 / max(_weight(f), 1.0), size)
    return f


def _crosstalk_along_the_plate(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Crosstalk of the normal force that changes its sign at the middle of the plate."""
    size, axis = rng.uniform(0.04, 0.12) * _sign(rng), _along(f)
    for start, stop in _loads(f):
        f[start:stop, axis] += size * np.linspace(-1.0, 1.0, stop - start) * f[start:stop, 2]
    return f


def _one_shear_cell_dead(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A shear is the sum of two cells; that of one end is dead, the other carries what is near."""
    near, far = rng.uniform(0.6, 0.9), rng.uniform(0.1, 0.4)
    first, last = (near, far) if rng.random() < 0.5 else (far, near)
    axis = _along(f)
    for start, stop in _loads(f):
        f[start:stop, axis] *= np.linspace(first, last, stop - start)
    return f


def _moment_as_shear(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """The moment about an axis, in N m over a scale, in the column of a shear."""
    scale, axis = rng.uniform(0.15, 0.4), _along(f)
    for start, stop in _loads(f):
        arm = np.linspace(-0.12, 0.14, stop - start) + rng.uniform(-0.05, 0.05)
        f[start:stop, axis] = arm * f[start:stop, 2] * scale / 0.2
    return f


def _one_sided_clip(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """An amplifier with one supply: one polarity ends at the rail."""
    way = _sign(rng)
    top = rng.uniform(0.3, 0.7) * max(float((way * f).max()), 1.0)
    return way * np.minimum(way * f, top)


def _beat(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Carriers of two amplifiers beat: the gain swings."""
    time = np.arange(len(f)) / rate
    swing = np.sin(2 * np.pi * rng.uniform(3.0, 9.0) * time + rng.uniform(0.0, 6.0))
    return f * (1.0 + rng.uniform(0.25, 0.5) * swing)[:, None]


def _telephone(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Bursts of a telephone, rectified by the amplifier."""
    time = np.arange(len(f)) / rate
    for start, stop in _loads(f):
        at = time[start] + rng.uniform(0.0, 0.6) * (time[stop - 1] - time[start])
        inside = (time > at) & (time < at + rng.uniform(0.05, 0.25))
        gate = (time / 0.0046) % 1.0 < 0.5
        f[:, :2] += np.outer(inside & gate, rng.uniform(20.0, 80.0) * rng.choice([-1, 1], 2))
    return f


# ------------------------------------------------------------------ how numbers are kept
def _lossy(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Compressed in blocks: small terms of a cosine transform are dropped, the others rounded."""
    count = round(rng.uniform(0.1, 0.3) * rate)
    step = rng.uniform(0.15, 0.4) * max(float(np.abs(f[:, :2]).max()), 1.0)
    for at in range(0, len(f), count):
        terms = np.asarray(dct(f[at : at + count], axis=0, norm="ortho"))
        unit = step * math.sqrt(len(terms)) / 4.0
        f[at : at + count] = idct(np.round(terms / unit) * unit, axis=0, norm="ortho")
    return f


def _local_parabolas(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    width = min(2 * round(rng.uniform(0.1, 0.2) * rate) + 1, len(f) - 1 + len(f) % 2)
    return np.asarray(savgol_filter(f, width, 2, axis=0))


def _shrunk(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Wavelets (Haar) below a threshold taken for noise and all others made smaller by it."""
    levels = int(math.log2(0.15 * rate))
    span = 2**levels
    rows = np.pad(f, ((0, -len(f) % span), (0, 0)), mode="edge")
    limit = rng.uniform(0.3, 0.8) * max(float(np.abs(f[:, :2]).max()), 1.0)
    coarse, details = rows, []
    for _ in range(levels):
        even, odd = coarse[::2], coarse[1::2]
        detail = (even - odd) / math.sqrt(2.0)
        details.append(np.sign(detail) * np.maximum(np.abs(detail) - limit, 0.0))
        coarse = (even + odd) / math.sqrt(2.0)
    for detail in reversed(details):
        grown = np.empty((2 * len(coarse), f.shape[1]))
        grown[::2] = (coarse + detail) / math.sqrt(2.0)
        grown[1::2] = (coarse - detail) / math.sqrt(2.0)
        coarse = grown
    return coarse[: len(f)]


def _narrow_field(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Whole newtons in a field of three characters: the sign takes one, the rest is cut."""
    whole = np.round(f)
    out = whole.copy()
    for limit, factor in ((-1000.0, 100.0), (-100.0, 10.0)):
        rows = (whole <= limit) & (out == whole)
        out[rows] = np.trunc(whole[rows] / factor)
    rows = whole >= 1000.0
    out[rows] = np.trunc(whole[rows] / 10.0)
    return out


def _comma_lost(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Tenths of a newton written without their comma; whole newtons have none to lose."""
    tenths = np.round(10.0 * f)
    return np.where(tenths % 10 == 0, tenths / 10.0, tenths)


def _rows_by_name(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Rows sorted by their number as text: 1, 10, 100, 2."""
    return f[sorted(range(len(f)), key=lambda row: str(row + 1))]


def _over_own_peak(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Each column drawn over its own peak, and all of them multiplied by a body weight."""
    peaks = np.maximum(np.abs(f).max(axis=0), 1.0)
    return f / peaks * peaks[2] * np.array([*rng.uniform(0.2, 0.5, 2), 1.0])


# ------------------------------------------------------------------ what feet do
def _dragged(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A foot that drags before it stands: braking by the friction of the sole."""
    axis = _along(f)
    way = np.sign(f[np.argmax(np.abs(f[:, axis])), axis]) * _sign(rng)
    drag = rng.uniform(0.2, 0.4)
    for start, stop in _loads(f):
        slides = _bump(stop - start, -0.1, rng.uniform(0.15, 0.3))
        kept = f[start:stop, axis]
        f[start:stop, axis] = (1.0 - slides) * kept + slides * way * drag * f[start:stop, 2]
    return f


def _other_heel_clips(forces: list[np.ndarray], trial: Trial, rng: Random) -> list:
    """The other heel lands on the rim of the plate before the foot has left it."""
    up = walkway_of(trial).up
    order = [i for i in range(3) if not up[i]] + [int(np.argmax(np.abs(up)))]
    for force in forces:
        f = force[:, order]
        for start, stop in _loads(f):
            count = stop - start
            at = start + round(rng.uniform(0.5, 0.75) * count)
            landing = f[start : start + stop - at].copy() * rng.uniform(0.4, 1.0)
            f[at:stop] += landing * np.linspace(1.0, 0.6, stop - at)[:, None]
        force[:, order] = f
    return forces


def _hopped(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A hop: one peak of two to three body weights, and little shear."""
    for start, stop in _loads(f):
        count = round((stop - start) * rng.uniform(0.4, 0.6))
        one = _curve(f[start:stop], count)
        one[:, 2] = _bump(count, 0.0, 1.0) * rng.uniform(2.0, 3.0) * _weight(f)
        one[:, :2] *= rng.uniform(0.3, 1.5)
        f[start:stop] = 0.0
        f[start : start + count] = one
    return f


def _markers_turned(trial: Trial, rng: Random) -> Trial:
    """Axes of the cameras turned about the vertical against those of the plates."""
    up = walkway_of(trial).up
    angle = np.radians(rng.uniform(60.0, 120.0)) * _sign(rng)
    x, y, z = up
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn = np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
    return replace(
        trial,
        markers={n: replace(m, positions=m.positions @ turn.T) for n, m in trial.markers.items()},
    )


INSTRUMENT_FAULTS: dict[str, TrialFault] = {
    "in the frame of the foot": _forces(_in_the_frame_of_the_foot),
    "gain of the shear falls with the load": _forces(_gain_falls_with_load),
    "crosstalk with the square of the load": _forces(_square_crosstalk),
    "crosstalk that turns along the plate": _forces(_crosstalk_along_the_plate),
    "one of two shear cells dead": _forces(_one_shear_cell_dead),
    "moment in the column of a shear": _forces(_moment_as_shear),
    "one polarity at the rail": _forces(_shear(_one_sided_clip)),
    "beat of two carriers": _forces(_shear(_beat)),
    "bursts of a telephone": _forces(_telephone),
    "lossy compression in blocks": _forces(_lossy),
    "smoothed by local parabolas": _forces(_local_parabolas),
    "small wavelets taken for noise": _forces(_shrunk),
    "field too narrow for the sign": _forces(_narrow_field),
    "decimal comma lost": _forces(_comma_lost),
    "rows sorted as text": _forces(_rows_by_name),
    "each column over its own peak": _forces(_over_own_peak),
    "foot that drags at landing": _forces(_dragged),
    "other heel on the rim": _plates(_other_heel_clips),
    "hops": _forces(_hopped),
    "cameras turned against the plates": _markers_turned,
}
