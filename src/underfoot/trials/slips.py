"""A human slip from the heel marker: start, peak speed, distance, slip or no slip."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from underfoot.core import InputError, unknown_name

from .axes import Axes, axes_of, heel_of, walking_direction
from .baseline import runs
from .events import Stance
from .filters import MARKER_FILTER, LowPass, bridged, low_passed
from .measurement import Measurement
from .plates import plate_named
from .trial import Marker, Trial

PLANES = {
    "horizontal": "speed in the plane of the floor",
    "3d": "speed in three dimensions",
}
DERIVATIVES = {
    "differences": "central differences of the filtered path",
    "savitzky-golay": "Savitzky-Golay derivative, 3rd order, window of the same cutoff",
}
SLIP_SPEED = 0.2  # m/s, the grant report's (G.6.1)


@dataclass(frozen=True, slots=True)
class SlipDefinition:
    """What counts as a slip and how its speed is got.

    Parameters
    ----------
    threshold
        Peak slipping speed above which it is a slip (m/s).
    plane
        A key of ``PLANES``.
    filter
        Low-pass of the marker's path; its cutoff also sets the window of Savitzky-Golay.
    derivative
        A key of ``DERIVATIVES``.
    longest_gap
        Gaps of the marker up to this are bridged (s).
    prominence
        A local minimum or peak of the speed must stand out by this (m/s), or it is noise.
    heel_lift
        Height over its lowest since contact at which the heel has left the floor (m).
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
            not self.threshold > 0
            or self.longest_gap < 0
            or self.prominence < 0
            or self.heel_lift <= 0
        ):
            raise InputError(
                "threshold, gap, prominence and heel lift can't be negative", where="slip"
            )

    def conventions(self) -> dict[str, str]:
        """Return the choices in words."""
        return {
            "speed": PLANES[self.plane],
            "marker filter": (
                str(self.filter)
                if self.derivative == "differences"
                else f"cutoff {self.filter.cutoff:g} Hz"
            ),
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
    ``filled`` (n,) marks bridged frames; positions in longer gaps are NaN.
    """

    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    speed: np.ndarray
    filled: np.ndarray
    noise: float
    speed_noise: float


@dataclass(frozen=True, slots=True)
class Slip:
    """One contact of a heel, judged. ``slipped`` is None when it can't be told."""

    contact: float
    start: Measurement
    end: float
    peak_speed: Measurement
    distance: Measurement
    margin: Measurement
    slipped: bool | None
    motion: HeelMotion | None = None
    peak_time: float = math.nan


def heel_motion(
    marker: Marker, up: np.ndarray, definition: SlipDefinition | None = None
) -> HeelMotion:
    """Return the smoothed path, velocity and speed of a heel marker.

    Errors
    ------
    InputError
        The frames are not equally spaced, or the filter does not fit the rate.
    """
    definition = definition or SlipDefinition()
    if marker.times is not None:
        raise InputError("frames are not equally spaced", where="marker")
    path, filled = bridged(marker.positions, round(definition.longest_gap * marker.rate))
    position = np.full(path.shape, np.nan)
    velocity = np.full(path.shape, np.nan)
    residuals: list[np.ndarray] = []
    half = _half_window(marker.rate, definition.filter.cutoff)
    shortest = max(30, 2 * half + 1)
    if definition.filter.kind == "none" and definition.derivative == "differences":
        shortest = 3
    seen = np.asarray(np.isfinite(path).all(axis=1))
    for start, stop in runs(seen):
        if stop - start < shortest:
            continue
        smooth, velocity[start:stop] = _smoothed(path[start:stop], marker.rate, definition)
        position[start:stop] = smooth
        # Differences of neighbours see the noise and not the motion.
        residuals.append(np.diff(path[start:stop] - smooth, axis=0)[~filled[start + 1 : stop]])
    noise = 0.0
    if residuals and sum(map(len, residuals)) > 3:
        jumps = np.abs(np.concatenate(residuals))
        noise = 1.4826 * float(np.median(jumps)) / math.sqrt(2.0)
    seen_velocity = velocity
    if definition.plane == "horizontal":
        seen_velocity = velocity - np.outer(velocity @ up, up)
    speed = np.linalg.norm(seen_velocity, axis=1)
    return HeelMotion(
        marker.time,
        position,
        velocity,
        speed,
        filled,
        noise,
        noise * _noise_gain(marker, definition),
    )


def slip(
    marker: Marker | None,
    contact: float,
    *,
    up: np.ndarray,
    walking: np.ndarray | None = None,
    leaves: float | None = None,
    definition: SlipDefinition | None = None,
    flags: tuple[str, ...] = (),
) -> Slip:
    """Return the slip (or its absence) after a heel contact.

    Slip start is the first local minimum of the heel's speed after contact; the peak slipping
    speed is the largest speed between it and the second local minimum, the moment the foot
    leaves the plate, the heel lifts by 30 mm, or the record ends, whichever is first. Distance
    is the displacement of the heel in the floor's plane between start and end.

    Parameters
    ----------
    marker
        Heel marker; None gives "not estimated".
    contact
        Time of heel contact (s).
    up, walking
        Unit vectors (3,); ``walking`` only to say whether the heel went backward.
    leaves
        Time at which the foot leaves the plate (s), if there is a plate.

    Source: grant report G.5.1 and G.6.1; horizontal plane by default because heel lift adds
    vertical speed at the end.
    """
    definition = definition or SlipDefinition()
    said = definition.conventions()

    def without(reason: str, motion: HeelMotion | None = None) -> Slip:
        start, speed, distance, margin = (
            Measurement.not_estimated(name, reason, unit=unit, flags=flags, conventions=said)
            for name, unit in (
                ("slip start", "s"),
                ("peak slipping speed", "m/s"),
                ("slip distance", "m"),
                ("slip margin", "m/s"),
            )
        )
        return Slip(contact, start, math.nan, speed, distance, margin, None, motion)

    if marker is None:
        return without("there is no heel marker")
    motion = heel_motion(marker, up, definition)
    first = int(np.searchsorted(motion.time, contact))
    if first >= len(motion.time) - 2 or contact < motion.time[0]:
        return without("the contact lies outside the marker's record", motion)
    last, ended = _window_end(motion, first, up, leaves, definition.heel_lift)
    window = motion.speed[first : last + 1]
    lost = ~np.isfinite(window)
    if lost.any():
        when = 1e3 * (motion.time[first + int(np.argmax(lost))] - contact)
        if lost[: max(3, round(0.1 * marker.rate))].any():
            return without(f"the heel marker is missing {when:.0f} ms after contact", motion)
        last = first + int(np.argmax(lost)) - 1
        window = motion.speed[first : last + 1]
        ended = f"the marker is lost {when:.0f} ms after contact"
    if len(window) < 5:
        return without("fewer than five frames of the heel after contact", motion)
    reach = round(0.5 * marker.rate / definition.filter.cutoff)
    minima = _minima(motion.speed, first, last, reach, definition.prominence)
    if len(minima) and minima[0] < first:
        early = 1e3 * (contact - motion.time[minima[0]])
        flags += (f"the speed's minimum lies {early:.0f} ms before contact: the filter's blur",)
    if not len(minima):
        return without(f"the heel's speed has no local minimum after contact until {ended}", motion)
    begin = int(minima[0])
    stop = int(minima[1]) if len(minima) > 1 else last
    by = "second local minimum" if len(minima) > 1 else ended
    top = begin + int(np.argmax(motion.speed[begin : stop + 1]))
    peak = float(motion.speed[top])
    said["search ends"] = by
    if motion.filled[first : stop + 1].any():
        count = int(motion.filled[first : stop + 1].sum())
        flags += (f"{count} frames of the heel marker were bridged",)
    later = motion.speed[stop : last + 1]
    if len(later) and peak <= definition.threshold < float(np.nanmax(later)):
        flags += (f"the heel reaches {float(np.nanmax(later)):.2f} m/s after the search's end",)
    if walking is not None and motion.velocity[top] @ walking < -0.5 * peak and peak > 0.05:
        flags += ("the heel moves backward at its peak speed",)
    if top == stop and len(minima) < 2:
        flags += (f"the speed still grows when the search ends: {by}",)
    moved = motion.position[stop] - motion.position[begin]
    moved = moved - (moved @ up) * up
    frame = 1.0 / marker.rate
    said["uncertainty"] = "marker noise through the filter; the filter's own bias is not in it"

    def value(name: str, number: float, unit: str, sd: float) -> Measurement:
        return Measurement(name, number, unit, sd, flags=flags, conventions=said)

    return Slip(
        contact=contact,
        start=value("slip start", _instant(motion, begin), "s", frame / math.sqrt(12.0)),
        end=float(motion.time[stop]),
        peak_speed=value("peak slipping speed", peak, "m/s", motion.speed_noise),
        distance=value(
            "slip distance", float(np.linalg.norm(moved)), "m", math.sqrt(2.0) * motion.noise
        ),
        margin=value("slip margin", peak - definition.threshold, "m/s", motion.speed_noise),
        slipped=peak > definition.threshold,
        motion=motion,
        peak_time=float(motion.time[top]),
    )


def slip_of(
    trial: Trial,
    stance: Stance,
    *,
    axes: Axes | None = None,
    definition: SlipDefinition | None = None,
    heels: Mapping[str, str] | None = None,
) -> Slip:
    """Return the slip after a contact with a force plate, by the heel of that foot.

    A contact rejected as a step may still be a slip (a foot that slides off a plate is no clean
    step): its reason is kept as a flag.
    """
    axes = axes or axes_of(trial)
    plate = plate_named(trial, stance.plate)
    walking = stance.walking
    if walking is None:
        walking, _ = walking_direction(trial, plate, stance.start, stance.stop, axes.up)
    marker = trial.marker(stance.heel) if stance.heel else heel_of(trial, stance.side, heels)
    flags = (f"not a clean step: {stance.reason}",) if stance.reason else ()
    return slip(
        marker,
        stance.contact,
        up=axes.up,
        walking=walking,
        leaves=stance.toe_off,
        definition=definition,
        flags=flags,
    )


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


def _window_end(
    motion: HeelMotion, first: int, up: np.ndarray, leaves: float | None, heel_lift: float
) -> tuple[int, str]:
    last, ended = len(motion.time) - 1, "the record ends"
    if leaves is not None and leaves < motion.time[-1]:
        last, ended = int(np.searchsorted(motion.time, leaves)), "the foot leaves the plate"
    height = motion.position[first : last + 1] @ up
    known = height[np.isfinite(height)]
    if len(known):
        lifted = height - np.minimum.accumulate(np.nan_to_num(height, nan=np.inf)) > heel_lift
        if lifted.any():
            last, ended = first + int(np.argmax(lifted)), "the heel lifts"
    return last, ended


def _instant(motion: HeelMotion, i: int) -> float:
    """Time of a minimum between frames: vertex of the parabola through it and its neighbours."""
    before, here, after = motion.speed[i - 1 : i + 2]
    bend = before - 2.0 * here + after
    share = 0.5 * (before - after) / bend if bend > 0 else 0.0
    step = motion.time[i + 1] - motion.time[i]
    return float(motion.time[i] + np.clip(share, -0.5, 0.5) * step)


def _minima(speed: np.ndarray, first: int, last: int, reach: int, prominence: float) -> np.ndarray:
    """Frames of the local minima of the speed after contact, frame ``first``, to ``last``.

    Where a heel slips at once, smoothing can move its minimum before the contact: when the speed
    already grows at contact, the last minimum at most ``reach`` frames before it comes first.
    The approach is looked at too, or a minimum right at contact would not stand out.
    """
    from scipy.signal import find_peaks

    begin = max(0, first - 6 * reach)
    lost = np.flatnonzero(~np.isfinite(speed[begin:first]))
    begin += int(lost[-1]) + 1 if len(lost) else 0
    found = begin + find_peaks(-speed[begin : last + 1], prominence=max(prominence, 1e-9))[0]
    before = found[(found < first) & (found >= first - reach)]
    after = found[found >= first]
    if len(before) and speed[first + 1] > speed[first]:
        return np.concatenate((before[-1:], after))
    return after


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


def _noise_gain(marker: Marker, definition: SlipDefinition) -> float:
    """Standard deviation of the speed for unit white noise of the marker, per axis (1/s)."""
    impulse = np.zeros(max(201, 4 * round(marker.rate / definition.filter.cutoff) + 1))
    impulse[len(impulse) // 2] = 1.0
    return float(np.linalg.norm(_smoothed(impulse, marker.rate, definition)[1]))
