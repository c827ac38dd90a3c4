"""The heel marker's smoothed path and speed, and contacts found from it alone."""

import math
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from underfoot.core import InputError, unknown_name

from .signals import MARKER_FILTER, LowPass, bridged, low_passed, runs
from .trial import Marker

PLANES = {"horizontal": "speed in the plane of the floor", "3d": "speed in three dimensions"}
DERIVATIVES = {
    "differences": "central differences of the filtered path",
    "savitzky-golay": "Savitzky-Golay derivative, 3rd order, window of the same cutoff",
}
SLIP_SPEED = 0.2  # m/s, the grant report's (G.6.1)
_JUMP = 0.01  # m off the path of the frames around it; no marker does that for a frame or two
_AROUND = 3  # frames to each side that a jump is judged by


@dataclass(frozen=True, slots=True)
class SlipDefinition:
    """What counts as a slip and how its speed is got.

    Above the peak slipping speed ``threshold`` (m/s) it is a slip. ``plane`` and ``derivative`` are
    keys of ``PLANES`` and ``DERIVATIVES``; ``filter`` is the low-pass of the marker's path, its
    cutoff also sets the window of Savitzky-Golay. Gaps of the marker up to ``longest_gap`` (s) are
    bridged. A local minimum or peak of the speed must stand out by ``prominence`` (m/s), or it is
    noise; at ``heel_lift`` (m) over its lowest since contact the heel has left the floor.
    """

    threshold: float = SLIP_SPEED
    plane: str = "horizontal"
    filter: LowPass = field(default_factory=lambda: MARKER_FILTER)
    derivative: str = "differences"
    longest_gap: float = 0.1
    prominence: float = 0.01
    heel_lift: float = 0.03

    def __post_init__(self) -> None:
        if self.plane not in PLANES:
            raise unknown_name("plane", self.plane, PLANES, where="slip.plane")
        if self.derivative not in DERIVATIVES:
            raise unknown_name("derivative", self.derivative, DERIVATIVES, where="slip.derivative")
        if (
            min(self.longest_gap, self.prominence) < 0
            or not min(self.threshold, self.heel_lift) > 0
        ):
            words = "threshold, gap, prominence and heel lift can't be negative"
            raise InputError(words, where="slip")

    def conventions(self) -> dict[str, str]:
        """Return the choices in words."""
        plain = self.derivative == "differences"
        return {
            "speed": PLANES[self.plane],
            "marker filter": str(self.filter) if plain else f"cutoff {self.filter.cutoff:g} Hz",
            "derivative": DERIVATIVES[self.derivative],
            "slip start": "first local minimum of the heel's speed after contact",
            "gaps": f"bridged up to {1e3 * self.longest_gap:g} ms",
            "prominence": f"minima stand out by {self.prominence:g} m/s",
            "heel lift": f"search ends when the heel is {1e3 * self.heel_lift:g} mm up",
            "threshold": f"slip above {self.threshold:g} m/s",
        }


@dataclass(frozen=True, slots=True)
class HeelMotion:
    """A heel marker's smoothed path: ``time`` (n,), ``position`` and ``velocity`` (n, 3).

    ``speed`` (n,) is in the plane asked for; ``noise`` is the standard deviation of the raw
    marker about the smoothed path (m) and ``speed_noise`` what it makes of the speed (m/s).
    ``filled`` (n,) marks bridged frames; positions in longer gaps are NaN. ``jumps`` (n,) marks
    frames that leapt off the path or lay at zero and were taken as missing;
    ``acceleration_noise`` is what the noise makes of the speed's rate of change (m/s^2).
    """

    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    speed: np.ndarray
    filled: np.ndarray
    noise: float
    speed_noise: float
    jumps: np.ndarray
    acceleration_noise: float = 0.0


def marker_jumps(positions: np.ndarray) -> np.ndarray:
    """Return True for frames (n,) in which a marker (n, 3) leaps off its path or lies at zero.

    A leap: more than 10 mm and six robust standard deviations from the median of the seven frames
    around it. Exact zeros are what some systems write for a lost marker.
    """
    jumps = (positions == 0.0).all(axis=1)
    known = np.flatnonzero(np.isfinite(positions).all(axis=1) & ~jumps)
    if len(known) <= 2 * _AROUND:
        return jumps
    path = positions[known]
    windows = np.lib.stride_tricks.sliding_window_view(path, 2 * _AROUND + 1, axis=0)
    middle = path[_AROUND:-_AROUND]
    away = np.linalg.norm(middle - np.median(windows, axis=2), axis=1)
    around = np.lib.stride_tricks.sliding_window_view(np.pad(away, _AROUND, mode="edge"), 7)
    usual = 1.4826 * np.median(around, axis=1)
    jumps[known[_AROUND:-_AROUND][away > np.maximum(_JUMP, 6.0 * usual)]] = True
    return jumps


def heel_motion(
    marker: Marker, up: np.ndarray, definition: SlipDefinition | None = None
) -> HeelMotion:
    """Return the smoothed path, velocity and speed of a heel marker.

    Frames that are not equally spaced and a filter that does not fit the rate are InputErrors.
    """
    definition = definition or SlipDefinition()
    if marker.times is not None:
        raise InputError("frames are not equally spaced", where="marker")
    jumps = marker_jumps(marker.positions)
    seen_path = np.where(jumps[:, None], np.nan, marker.positions)
    path, filled = bridged(seen_path, round(definition.longest_gap * marker.rate))
    position = np.full(path.shape, np.nan)
    velocity = np.full(path.shape, np.nan)
    residuals: list[np.ndarray] = []
    plain = definition.filter.kind == "none" and definition.derivative == "differences"
    window = 2 * _half_window(marker.rate, definition.filter.cutoff) + 1
    shortest = 3 if plain else max(30, window)
    for start, stop in runs(np.asarray(np.isfinite(path).all(axis=1))):
        if stop - start < shortest:
            continue
        smooth, velocity[start:stop] = _smoothed(path[start:stop], marker.rate, definition)
        position[start:stop] = smooth
        # Differences of neighbours see the noise and not the motion.
        residuals.append(np.diff(path[start:stop] - smooth, axis=0)[~filled[start + 1 : stop]])
    noise = 0.0
    if residuals and sum(map(len, residuals)) > 3:
        steps = np.abs(np.concatenate(residuals))
        noise = 1.4826 * float(np.median(steps)) / math.sqrt(2.0)
    vertical = np.outer(velocity @ up, up) if definition.plane == "horizontal" else 0.0
    speed = np.linalg.norm(velocity - vertical, axis=1)
    gain, rate_gain = _noise_gains(marker.rate, definition)
    path_of = marker.time, position, velocity, speed
    return HeelMotion(*path_of, filled, noise, noise * gain, jumps, noise * rate_gain)


def contact_from_heel(
    marker: Marker, up: np.ndarray, definition: SlipDefinition | None = None
) -> list[float]:
    """Return the times (s) at which a heel comes down, from its marker alone.

    Local minima of the smoothed height within 8 mm of the lowest, after a fall of 30 mm or more
    in 0.4 s. For recordings without a force plate: of 18 real steps 17 were found, 8 ms early
    to 20 ms late, 4 ms late in the middle.
    """
    motion = heel_motion(marker, up, definition)
    height = motion.position @ up
    if np.isfinite(height).sum() < 5:
        return []
    limit = float(np.nanpercentile(height, 1)) + 0.008
    before = round(0.4 * marker.rate)
    found: list[float] = []
    for i in range(1, len(height) - 1):
        if not (height[i - 1] > height[i] <= height[i + 1] and height[i] < limit):
            continue
        fallen = float(np.nanmax(height[max(0, i - before) : i])) - height[i]
        when = float(motion.time[i])
        if fallen > 0.03 and (not found or when - found[-1] > 0.3):
            found.append(when)
    return found


def _smoothed(
    path: np.ndarray, rate: float, definition: SlipDefinition
) -> tuple[np.ndarray, np.ndarray]:
    if definition.derivative == "differences":
        smooth = low_passed(path, rate, definition.filter)
        return smooth, np.asarray(np.gradient(smooth, 1.0 / rate, axis=0))
    from scipy.signal import savgol_filter

    length = 2 * _half_window(rate, definition.filter.cutoff) + 1
    smooth = np.asarray(savgol_filter(path, length, 3, axis=0))
    slope = savgol_filter(path, length, 3, deriv=1, delta=1.0 / rate, axis=0)
    return smooth, np.asarray(slope)


def _half_window(rate: float, cutoff: float) -> int:
    """Half window of a 3rd-order Savitzky-Golay filter with this -3 dB cutoff.

    Source: Schafer 2011, IEEE Signal Processing Magazine 28(4):111, Eq. 12.
    """
    return max(2, round((4.0 * rate / (2.0 * cutoff) + 4.6) / 3.2))


@lru_cache(maxsize=16)
def _noise_gains(rate: float, definition: SlipDefinition) -> tuple[float, float]:
    """Standard deviation of speed (1/s) and acceleration (1/s^2) for unit white noise an axis."""
    impulse = np.zeros(max(201, 4 * round(rate / definition.filter.cutoff) + 1))
    impulse[len(impulse) // 2] = 1.0
    speed = _smoothed(impulse, rate, definition)[1]
    return float(np.linalg.norm(speed)), float(np.linalg.norm(np.gradient(speed, 1 / rate)))
