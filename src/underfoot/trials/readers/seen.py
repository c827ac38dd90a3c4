"""Which samples of a marker's path were measured: not held, not filled in, no sign of a loss.

Capture systems write what they did not see in many ways: the last place again, a straight line
between two places, one number in all coordinates. Rows that come faster than the cameras hold every
marker for whole frames: that is a slower clock, not a loss.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from underfoot.core.missing import mask_of_codes

from ..recording.signals import longest_run, runs

HELD, STRAIGHT, SIGN = "held", "straight", "sign"
KINDS = {
    HELD: "repeat the place before or after",
    STRAIGHT: "lie on a straight line between two places",
    SIGN: "hold a number that stands for a lost marker",
}
_SHORTEST_HOLD = 2  # steps of nothing
_SHORTEST_LINE = 6  # second differences of nothing
_STANDS_OUT = 4.0  # steps of the file's last digit that no rounding makes
_JUMP = 2.0  # times the step beside it: longer than any that a path of its own makes
_BESIDE = 3  # steps beside a stretch that tell how it moves there
_AROUND = 12  # frames around a line that tell how its path bends
_CORNER = 3.0  # times that bend: the corner at the end of a line that was drawn
_RESOLVED = 0.1  # share of a path's moving frames on a line, above which it is too coarse to tell
_FAR, _FAR_SPREADS = 50.0, 20.0  # m and quartile ranges from a path's middle: nobody goes there
_NO_FORCE, _FEW = 100.0, 0.2  # N, and share of the samples, of a number that is a code
_ENOUGH = 4096  # frames that tell the last digit of a path
_SLOWER = 1.5  # rows a camera frame


@dataclass(frozen=True, slots=True)
class CameraClock:
    """Rows at which the cameras gave a new frame: ``rows`` (n,) and their ``frames`` (n,)."""

    rows: np.ndarray
    frames: np.ndarray
    rows_a_frame: float
    first: float
    """Row at which frame 0 came; before the file where its first rows hold an older frame."""

    def blank_unseen(self, positions: np.ndarray) -> np.ndarray:
        """Return positions (frames, 3), NaN in frames that never came."""
        path = np.full((int(self.frames[-1]) + 1, 3), np.nan)
        path[self.frames] = positions[self.rows]
        return path


def camera_clock(paths: Mapping[str, np.ndarray]) -> CameraClock | None:
    """Return the clock of cameras slower than the rows (n, 3) of all markers, or None.

    All markers stand still to the last digit between two frames, and frames come evenly: but for a
    row more or less, and whole frames that were lost.
    """
    moving = [p for p in paths.values() if len(p) > 20 and (np.diff(p, axis=0) != 0.0).any()]
    if not moving:
        return None
    changed = np.zeros(len(moving[0]), dtype=bool)
    for path in moving:
        if len(path) != len(changed):
            return None
        same = (path[1:] == path[:-1]) | (np.isnan(path[1:]) & np.isnan(path[:-1]))
        changed[1:] |= ~same.all(axis=1)
    rows = np.flatnonzero(changed)
    if len(rows) < 10:
        return None
    gaps = np.diff(rows)
    usual = float(np.median(gaps))
    ordinary = gaps[gaps < 1.5 * usual + 1.0]
    mean = float(ordinary.mean())
    if mean < _SLOWER or (np.abs(gaps - mean) < 1.0).mean() < 0.9:
        return None
    whole = np.round((rows - rows[0]) / mean).astype(int)
    for _ in range(3):  # the mean of all frames, the lost ones counted
        mean = float(np.polynomial.polynomial.polyfit(whole, rows, 1)[1])
        whole = np.round((rows - rows[0]) / mean).astype(int)
    if (np.diff(whole) < 1).any() or np.abs(rows - rows[0] - mean * whole).max() > 1.5:
        return None
    sizes = [_steps(path)[rows - 1] / _digit(path) for path in moving]
    if not np.median(np.nanmax(np.nan_to_num(sizes), axis=0)) > _STANDS_OUT:
        return None  # slower than the last digit tells, not than the cameras
    rows, whole = np.concatenate(([0], rows)), np.concatenate(([0], whole + 1))
    return CameraClock(rows, whole, mean, float(rows[1]) - mean)


def unseen(path: np.ndarray, *, every_repeat: bool = False) -> dict[str, np.ndarray]:
    """Return masks (n,) by kind (``KINDS``) of the samples of a path (n, 3) that were not measured.

    Held: two or more steps of nothing at whose end, or begin, the path leaps to where it would have
    come by itself: further than twice the steps beside it and than the last digit explains. A foot
    that stands stops and starts without a leap. Straight: six or more second differences of nothing
    with a corner at each end, in a path
    that moves and is seldom straight elsewhere. Signs: one number in all three
    coordinates, which no place in a laboratory has twice, or a place that nobody goes to.

    ``every_repeat``: every repeated place was lost, as the system that wrote it says.
    """
    lost = {}
    for kind, mask_of in ((SIGN, _signs), (HELD, partial(_held_frames, every=every_repeat)),
                          (STRAIGHT, _straight)):  # fmt: skip
        mask = mask_of(path)
        if mask.any():
            lost[kind] = mask
            path = np.where(mask[:, None], np.nan, path)
    return lost


def coded_forces(force: np.ndarray) -> np.ndarray:
    """Return which samples (n,) of a plate's force (n, 3), N, hold a number for "not measured".

    One number in all three directions; or, in one of them, a few samples of one and the same
    number that lies farther from all others than these from each other.
    """
    one = (force[:, 0] == force[:, 1]) & (force[:, 1] == force[:, 2])
    lost = one & (np.abs(force[:, 0]) >= _NO_FORCE)
    for values in np.where(lost[:, None], np.nan, force).T:
        lost |= mask_of_codes(values, apart=1.0, least=_NO_FORCE, most=_FEW)
    return lost


def _signs(path: np.ndarray) -> np.ndarray:
    """One number three times, or a place far from all others (m)."""
    one = (path[:, 0] == path[:, 1]) & (path[:, 1] == path[:, 2])
    usual = ~one & np.isfinite(path @ np.ones(3))
    rest = path if usual.all() else path[usual]
    if len(rest) < 4:
        return np.asarray(one)
    low, middle, high = np.percentile(rest, (25, 50, 75), axis=0)
    far = _largest(path - middle) > _FAR + _FAR_SPREADS * (high - low).max()
    return np.asarray(one | far)


def _largest(parts: np.ndarray) -> np.ndarray:
    """Largest size (n,) of three components (n, 3); NaN with one of them."""
    x, y, z = np.abs(parts).T  # numpy's max over three takes several times as long
    return np.maximum(np.maximum(x, y), z)


def _steps(path: np.ndarray) -> np.ndarray:
    """Largest component of each step (n - 1,); NaN beside what was not seen."""
    return _largest(np.diff(path, axis=0)) if len(path) > 1 else np.zeros(0)


def _digit(path: np.ndarray) -> float:
    """Return the last digit of a path's coordinates: that of the file, else of single precision."""
    values = np.unique(path[np.isfinite(path).all(axis=1)][:_ENOUGH])
    size = float(np.abs(values).max(initial=0.0))
    single = 1.2e-7 * size
    gaps = np.diff(values)
    digit = float(np.min(gaps[gaps > single], initial=np.inf))
    if not np.isfinite(digit):
        return single
    count = values / digit
    return digit if (np.abs(count - np.round(count)) < 0.05).all() else single


def _held_frames(path: np.ndarray, *, every: bool) -> np.ndarray:
    held = np.zeros(len(path), dtype=bool)
    steps = _steps(path)
    still = steps == 0.0
    if not still.any():
        return held
    if every:
        held[1:] = still
        return held
    digit = _digit(path)
    for start, stop in runs(still):  # samples start to stop are one place
        if stop - start < _SHORTEST_HOLD or (start == 0 and stop == len(steps)):
            continue
        before, after = steps[max(start - 1 - _BESIDE, 0) : start], steps[stop : stop + 1 + _BESIDE]
        leaps_in, leaps_out = _leaps(before[::-1], digit), _leaps(after, digit)
        if leaps_in or leaps_out:
            held[start + 1 : stop] = True
            held[start] |= leaps_in
            held[stop] |= leaps_out
    return held


def _leaps(steps: np.ndarray, digit: float) -> bool:
    """Whether the first of some steps leads further than those behind it explain."""
    if not steps.size or not steps[0] > _STANDS_OUT * digit:
        return False
    rest = steps[1:][np.isfinite(steps[1:])]
    return not rest.size or steps[0] > _JUMP * float(rest.max())


def _straight(path: np.ndarray) -> np.ndarray:
    straight = np.zeros(len(path), dtype=bool)
    if len(path) < 4 * _SHORTEST_LINE:
        return straight
    bends = _largest(np.diff(path, 2, axis=0))
    digit = _digit(path)
    allowed = 2.01 * digit  # that much a rounded line bends
    if longest_run(bends <= allowed) < _SHORTEST_LINE:
        return straight
    steps = _steps(path)
    moving = np.fmin(steps[1:], steps[:-1]) > _STANDS_OUT * digit
    line = (bends <= allowed) & moving
    stretches = [(a, b) for a, b in runs(line) if b - a >= _SHORTEST_LINE]
    if not stretches:
        return straight
    inside = np.zeros(len(line), dtype=bool)
    for a, b in stretches:
        inside[a:b] = True
    others = moving & ~inside & np.isfinite(bends)
    if others.sum() < 2 * _SHORTEST_LINE or (line & others).sum() > _RESOLVED * others.sum():
        return straight
    for a, b in stretches:  # bends a to b - 1 are those of samples a + 1 to b
        around = bends[max(a - _AROUND, 0) : b + _AROUND]
        usual = max(allowed, _middle(around[around > allowed]))
        corners = [float(np.nanmax(bends[i : i + 2], initial=0.0)) for i in (a - 2, b) if i >= 0]
        corners = [corner for corner in corners if corner]
        if corners and min(corners) > _CORNER * usual:
            straight[a + 1 : b + 1] = True
    return straight


def _middle(values: np.ndarray) -> float:
    return float(np.median(values)) if values.size else 0.0
