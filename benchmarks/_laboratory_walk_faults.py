"""Twenty kinds of faults of a gait laboratory, by an author who had not read the checks.

Written from what goes wrong between a foot and a table of numbers: who steps where, which sensor
reports, what a buffer, an export or a helper makes of it. Each changes a whole trial.
"""

import numpy as np
from scipy.ndimage import gaussian_filter1d

from benchmarks._more_walk_faults import TrialFault, _forces, _loads, _plates, _shear
from underfoot.trials import Trial, walkway_of

Random = np.random.Generator


def _weight(f: np.ndarray) -> float:
    return float(np.quantile(f[:, 2], 0.98))


def _curve(f: np.ndarray, count: int) -> np.ndarray:
    """A stance (n, k) drawn out over another number of samples."""
    at = np.linspace(0.0, len(f) - 1.0, count)
    return np.column_stack([np.interp(at, np.arange(len(f)), column) for column in f.T])


def _bump(count: int, first: float, last: float) -> np.ndarray:
    share = np.linspace(0.0, 1.0, count)
    inside = (share > first) & (share < last)
    return np.where(inside, np.sin(np.pi * (share - first) / (last - first)) ** 2, 0.0)


def _loaded_alike(forces: list[np.ndarray], up: np.ndarray) -> list[int]:
    """Numbers of the plates that bear a step, where they are several of one length."""
    loaded = [i for i, f in enumerate(forces) if (f @ up).max() > 100.0]
    alike = len(loaded) > 1 and len({len(forces[i]) for i in loaded}) == 1
    return loaded if alike else []


# ------------------------------------------------------------------ who stands where
def _on_one_plate(forces: list[np.ndarray], trial: Trial, rng: Random) -> list:
    up = walkway_of(trial).up
    if loaded := _loaded_alike(forces, up):
        forces[loaded[0]] = np.sum([forces[i] for i in loaded], axis=0)
        for i in loaded[1:]:
            forces[i] = rng.normal(0.0, 0.5, forces[i].shape)
    return forces


def _assisted(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Somebody else's foot on the plate for a part of the step."""
    for start, stop in _loads(f):
        first = rng.uniform(-0.1, 0.2)
        push = _bump(stop - start, first, first + rng.uniform(0.5, 0.9))
        force = np.append(rng.normal(0.0, 0.12, 2), 1.0) * rng.uniform(0.15, 0.4) * _weight(f)
        f[start:stop] += np.outer(push, force)
    return f


def _tethered(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A belt or a trolley that pulls: the shear of each stance leans on one side."""
    axis = int(np.argmax(np.abs(f[:, :2]).max(axis=0)))
    f[:, axis] += rng.uniform(0.05, 0.12) * rng.choice([-1, 1]) * f[:, 2]
    return f


def _stamped(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    for start, stop in _loads(f):
        blow = _bump(stop - start, 0.0, rng.uniform(0.12, 0.25)) * rng.uniform(0.5, 1.2)
        f[start:stop] *= 1.0 + np.outer(blow, [rng.uniform(1.0, 2.5)] * 2 + [1.0])
    return f


def _skated(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A sole that slides: the shear is what the floor gives."""
    most = rng.uniform(0.07, 0.13) * np.maximum(f[:, 2], 0.0)
    size = np.linalg.norm(f[:, :2], axis=1)
    held = np.where(f[:, 2] > 20.0, np.minimum(1.0, most / np.maximum(size, 1e-9)), 1.0)
    f[:, :2] *= held[:, None]
    return f


def _on_a_mat(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A mat that bridges the joint takes the more of the shear the more it is drawn."""
    share = rng.uniform(0.25, 0.45)
    size = np.linalg.norm(f[:, :2], axis=1)
    f[:, :2] *= (1.0 - share * (0.5 + 0.5 * size / max(size.max(), 1.0)))[:, None]
    return f


# ------------------------------------------------------------------ which sensor reports
def _weak_cell(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """One of four vertical cells is weak; the foot walks onto it or off it."""
    for start, stop in _loads(f):
        near = np.linspace(0.1, 0.7, stop - start)[:: int(rng.choice([-1, 1]))]
        f[start:stop, 2] *= 1.0 - rng.uniform(0.5, 1.0) * near
    return f


def _ghosts(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A multiplexer that has not settled: each channel holds a part of the one before."""
    left = rng.uniform(0.06, 0.2)
    return (1.0 - left) * f + left * f[:, [2, 0, 1]]


def _levelled(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Automatic gain: the shear over its own envelope."""
    size = gaussian_filter1d(np.linalg.norm(f[:, :2], axis=1), rng.uniform(0.06, 0.15) * rate)
    f[:, :2] *= (0.5 * (top := max(size.max(), 1.0)) / (size + 0.2 * top))[:, None]
    return f


def _jumping_zero(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    for start, stop in _loads(f):
        at = start + round(rng.uniform(0.08, 0.3) * (stop - start))
        f[at:stop, :2] += rng.uniform(0.03, 0.09) * _weight(f) * rng.choice([-1, 1], 2)
    return f


# ------------------------------------------------------------------ buffers, exports, helpers
def _blocks_exchanged(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    for start, stop in _loads(f):
        count = round(rng.uniform(0.05, 0.1) * rate)
        at = start + round(rng.uniform(0.03, 0.1) * (stop - start))
        first, then = f[at : at + count].copy(), f[at + count : at + 2 * count].copy()
        f[at : at + len(then)], f[at + len(then) : at + len(then) + count] = then, first
    return f


def _exchanged_midway(forces: list[np.ndarray], trial: Trial, rng: Random) -> list:
    up = walkway_of(trial).up
    if loaded := _loaded_alike(forces, up):
        i, j = loaded[:2]
        on = np.flatnonzero(forces[i] @ up > 100.0)
        at = on[0] + round(rng.uniform(0.1, 0.4) * (on[-1] - on[0]))
        a, b = forces[i].copy(), forces[j].copy()
        forces[i][at:], forces[j][at:] = b[at:], a[at:]
    return forces


def _both_normals(forces: list[np.ndarray], trial: Trial, rng: Random) -> list:
    """The normal force of all plates beside the shear of one."""
    up = walkway_of(trial).up
    if len({len(f) for f in forces}) > 1:
        return forces
    whole = np.sum(forces, axis=0) @ up
    on = [f @ up > 10.0 for f in forces]
    return [
        f + np.outer(np.where(is_on, whole - f @ up, 0.0), up)
        for f, is_on in zip(forces, on, strict=True)
    ]


def _of_another_trial(forces: list[np.ndarray], trial: Trial, rng: Random) -> list:
    """Forces of another person's step, as heavy, under these markers."""
    return _replaced(forces, trial, rng, normal=True)


def _imputed(forces: list[np.ndarray], trial: Trial, rng: Random) -> list:
    """A lost shear, filled in with that of somebody else."""
    return _replaced(forces, trial, rng, normal=False)


def _replaced(forces: list[np.ndarray], trial: Trial, rng: Random, *, normal: bool) -> list:
    up = walkway_of(trial).up
    order = [i for i in range(3) if not up[i]] + [int(np.argmax(np.abs(up)))]
    rows = _other_stances()
    mine = _along(trial, forces, order)
    other = rows[int(rng.integers(len(rows)))]
    if mine is None or any(np.array_equal(other, one) for one in _stances_of(trial)):
        other = rows[(int(rng.integers(len(rows))) + 1) % len(rows)]
    axis, sign = mine or (0, 1.0)
    for force in forces:
        f = force[:, order]
        for start, stop in _loads(f):
            put = _curve(other, stop - start) * f[start:stop, 2].mean()
            f[start:stop, axis] = sign * put[:, 0]
            f[start:stop, 1 - axis] = put[:, 1]
            if normal:
                f[start:stop, 2] = put[:, 2]
        force[:, order] = f
    return forces


def _along(trial: Trial, forces: list[np.ndarray], order: list[int]) -> tuple[int, float] | None:
    walking = walkway_of(trial).axes.walking
    if walking is None:
        return None
    way = walking[order][:2]
    axis = int(np.argmax(np.abs(way)))
    return axis, float(np.sign(way[axis]))


def _stances_of(trial: Trial) -> list[np.ndarray]:
    """Stances (n, 3) along, across and up, over their mean normal force."""
    up = walkway_of(trial).up
    order = [i for i in range(3) if not up[i]] + [int(np.argmax(np.abs(up)))]
    mine = _along(trial, [], order)
    if mine is None:
        return []
    axis, sign = mine
    found = []
    for plate in trial.plates:
        f = plate.force[:, order]
        for start, stop in _loads(f):
            one = f[start:stop] / f[start:stop, 2].mean()
            if 0.4 * plate.rate < stop - start < 1.2 * plate.rate:
                found.append(np.column_stack((sign * one[:, axis], one[:, 1 - axis], one[:, 2])))
    return found


_KNOWN: list[np.ndarray] = []


def _other_stances() -> list[np.ndarray]:
    if not _KNOWN:
        from benchmarks.walk_screen import recordings

        _KNOWN.extend(one for _, trial in recordings() for one in _stances_of(trial))
    return _KNOWN


def _mean_taken_off(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A baseline taken from the middle of each stance: what the shear is there is called zero."""
    for start, stop in _loads(f):
        a, b = (round(x * (stop - start)) for x in np.sort(rng.uniform(0.05, 0.95, 2)))
        f[start:stop, :2] -= f[start + a : start + max(b, a + 20), :2].mean(axis=0)
    return f


def _drawn_out(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """The shear is set over the stance by other ends than the normal force."""
    for start, stop in _loads(f):
        count = round((stop - start) * rng.uniform(1.15, 1.4))
        f[start:stop, :2] = _curve(f[start:stop, :2], count)[: stop - start]
    return f


def _gap_filled(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Samples lost after landing, filled by a straight line."""
    for start, stop in _loads(f):
        a = start + round(rng.uniform(0.0, 0.04) * (stop - start))
        b = start + round(rng.uniform(0.2, 0.35) * (stop - start))
        f[a:b] = np.linspace(f[a], f[b], b - a)
    return f


def _sign_lost(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """A column too narrow for the sign of large numbers."""
    most = rng.uniform(0.3, 0.7) * np.abs(f).max()
    return np.where(f < -most, -f, f)


def _outliers_off(f: np.ndarray, rate: float, rng: Random) -> np.ndarray:
    """Peaks taken for outliers, and a line drawn between what is left."""
    frames = np.arange(len(f))
    for axis in range(f.shape[1]):
        column = f[:, axis]
        keep = np.abs(column) < rng.uniform(0.4, 0.75) * np.abs(column).max()
        if keep.any():
            f[:, axis] = np.interp(frames, frames[keep], column[keep])
    return f


LABORATORY_FAULTS: dict[str, TrialFault] = {
    "both feet in one plate": _plates(_on_one_plate),
    "another person's foot on the plate": _forces(_assisted),
    "pulled by a belt or a trolley": _forces(_tethered),
    "stamping": _forces(_stamped),
    "sole that skates": _forces(_skated),
    "mat that bridges the joint": _forces(_on_a_mat),
    "one weak cell under the plate": _forces(_weak_cell),
    "multiplexer that has not settled": _forces(_ghosts),
    "automatic gain of the shear": _forces(_levelled),
    "zero jumps within the step": _forces(_jumping_zero),
    "blocks of a buffer exchanged": _forces(_blocks_exchanged),
    "plates exchanged from midway on": _plates(_exchanged_midway),
    "normal force of all plates": _plates(_both_normals),
    "forces of another person's step": _plates(_of_another_trial),
    "shear filled in from another step": _plates(_imputed),
    "zero of the shear from within the step": _forces(_mean_taken_off),
    "shear drawn out over the step": _forces(_drawn_out),
    "landing filled in by a line": _forces(_gap_filled),
    "sign of large numbers lost": _forces(_shear(_sign_lost)),
    "peaks of the shear taken for outliers": _forces(_shear(_outliers_off)),
}
