"""The heel marker's smoothed path and speed; a human slip: start, peak speed, distance, class."""

import math
from dataclasses import dataclass, field
from enum import StrEnum
from functools import lru_cache

import numpy as np

from underfoot.core import InputError, unknown_name
from underfoot.core.remark import NOTHING, Message

from ..recording.measurement import Flag, Measurement, caution
from ..recording.signals import MARKER_FILTER, LowPass, bridge_gaps, low_passed, runs
from ..recording.trial import Marker, once_a_record
from .events import Stance
from .step import Step
from .walkway import Walkway, of_walkway

PLANES = {
    "horizontal": Message("speed in the plane of the floor"),
    "3d": Message("speed in three dimensions"),
}
DERIVATIVES = {
    "differences": Message("central differences of the filtered path"),
    "savitzky-golay": Message("Savitzky-Golay derivative, 3rd order, window of the same cutoff"),
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

    def conventions(self) -> dict[str, Message]:
        """Return the choices, a line each."""
        cutoff = Message("cutoff {cutoff:g} Hz", cutoff=self.filter.cutoff)
        return {
            "speed": PLANES[self.plane],
            "marker filter": (
                self.filter.description if self.derivative == "differences" else cutoff
            ),
            "derivative": DERIVATIVES[self.derivative],
            "slip start": Message("first local minimum of the heel's speed after contact"),
            "gaps": Message("bridged up to {gap:g} ms", gap=1e3 * self.longest_gap),
            "prominence": Message("minima stand out by {least:g} m/s", least=self.prominence),
            "heel lift": Message(
                "search ends when the heel is {lift:g} mm up", lift=1e3 * self.heel_lift
            ),
            "threshold": Message("slip above {limit:g} m/s", limit=self.threshold),
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
    from scipy.ndimage import median_filter

    path = positions[known]
    middle = median_filter(path, (2 * _AROUND + 1, 1))[_AROUND:-_AROUND]
    away = np.linalg.norm(path[_AROUND:-_AROUND] - middle, axis=1)
    usual = 1.4826 * median_filter(away, 2 * _AROUND + 1, mode="nearest")
    jumps[known[_AROUND:-_AROUND][away > np.maximum(_JUMP, 6.0 * usual)]] = True
    return jumps


def heel_motion(
    marker: Marker, up: np.ndarray, definition: SlipDefinition | None = None
) -> HeelMotion:
    """Return the smoothed path, velocity and speed of a heel marker.

    Frames that are not equally spaced and a filter that does not fit the rate are InputErrors.
    """
    return _motion(marker, tuple(up.tolist()), definition or SlipDefinition())


@once_a_record
def _motion(marker: Marker, up: tuple[float, ...], definition: SlipDefinition) -> HeelMotion:
    if marker.times is not None:
        raise InputError("frames are not equally spaced", where="marker")
    jumps = marker_jumps(marker.positions)
    seen_path = np.where(jumps[:, None], np.nan, marker.positions)
    path, filled = bridge_gaps(seen_path, round(definition.longest_gap * marker.rate))
    position = np.full(path.shape, np.nan)
    velocity = np.full(path.shape, np.nan)
    residuals: list[np.ndarray] = []
    plain = definition.filter.kind == "none" and definition.derivative == "differences"
    window = 2 * _half_window(marker.rate, definition.filter.cutoff) + 1
    shortest = 3 if plain else max(30, window)
    for start, stop in runs(np.asarray(np.isfinite(path).all(axis=1))):
        if stop - start < shortest:
            continue
        smooth, velocity[start:stop] = _smooth_path(path[start:stop], marker.rate, definition)
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
    in 0.4 s; of two within 0.3 s the first, unless the second is 3 mm lower (a heel that hovers
    before it lands). For recordings without a force plate: of 18 real steps 17 were found, 8 ms
    early to 20 ms late, 4 ms late in the middle.
    """
    return list(_landings(marker, tuple(up.tolist()), definition or SlipDefinition()))


@once_a_record
def _landings(
    marker: Marker, up: tuple[float, ...], definition: SlipDefinition
) -> tuple[float, ...]:
    motion = _motion(marker, up, definition)
    height = motion.position @ np.array(up)
    if np.isfinite(height).sum() < 5:
        return ()
    limit = float(np.nanpercentile(height, 1)) + 0.008
    before = round(0.4 * marker.rate)
    found: list[int] = []
    here = height[1:-1]
    falls = (height[:-2] > here) & (here <= height[2:]) & (here < limit)
    for i in (1 + np.flatnonzero(falls)).tolist():
        if np.nanmax(height[max(0, i - before) : i]) - height[i] <= 0.03:
            continue
        if not found or motion.time[i] - motion.time[found[-1]] > 0.3:
            found.append(i)
        elif height[found[-1]] - height[i] > 0.003:
            found[-1] = i
    return tuple(float(motion.time[i]) for i in found)


def _smooth_path(
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

    M = ((N + 1) / f + 4.6) / 3.2, f the cutoff over half the rate. N = 2: on a symmetric window
    the cubic smoother is the quadratic one. Within 5 % from M = 13 to 30, 17 % at M = 6.
    Source: Schafer 2011, IEEE Signal Processing Magazine 28(4):111, Eq. 12.
    """
    return max(2, round((3.0 * rate / (2.0 * cutoff) + 4.6) / 3.2))


@lru_cache(maxsize=16)
def _noise_gains(rate: float, definition: SlipDefinition) -> tuple[float, float]:
    """Standard deviation of speed (1/s) and acceleration (1/s^2) for unit white noise an axis."""
    impulse = np.zeros(max(201, 4 * round(rate / definition.filter.cutoff) + 1))
    impulse[len(impulse) // 2] = 1.0
    speed = _smooth_path(impulse, rate, definition)[1]
    return float(np.linalg.norm(speed)), float(np.linalg.norm(np.gradient(speed, 1 / rate)))


class Outcome(StrEnum):
    """Class of a step by the distance that the heel slipped.

    It is not what "slipped" means: a slip is a peak heel speed above 0.2 m/s (report G.6.1,
    ``SlipDefinition``).
    """

    NO_SLIP = "no slip"
    MICROSLIP = "microslip"
    SLIDE = "slide"
    LONG_SLIDE = "long slide"


@dataclass(frozen=True, slots=True)
class OutcomeLimits:
    """Distances (m) up to which a step counts as no slip, microslip and slide; long slide beyond.

    30 and 100 mm: Leamon and Li 1990 (from memory, not verified; the four classes are those of
    Liu et al. 2013, PLoS ONE 8:e68989, who call the last one "slip"). 13 mm: the most that a heel
    moved in the recorded steps of dry walking between slip start and slip end (assumed).
    """

    no_slip: float = 0.013
    microslip: float = 0.03
    slide: float = 0.10

    def __post_init__(self) -> None:
        if not 0 < self.no_slip < self.microslip < self.slide:
            raise InputError("limits do not rise", where="slip.limits")

    def outcome(self, distance: float) -> Outcome:
        """Return the class of a distance in m."""
        if distance <= self.no_slip:
            return Outcome.NO_SLIP
        if distance <= self.microslip:
            return Outcome.MICROSLIP
        return Outcome.SLIDE if distance <= self.slide else Outcome.LONG_SLIDE


_MEASURED = {
    "slip start": "s", "peak slipping speed": "m/s", "slip distance": "m", "slip margin": "m/s",
}  # fmt: skip
FALSE_ALARMS = "up to 0.23 m/s and 16 mm in 34 steps of dry walking"
_WIDTH = math.sqrt(math.log(2.0) / 2.0) / math.pi
"""Standard deviation of the Gaussian whose gain is one half at 1 Hz (s): the filters here halve
at their cutoff."""


@dataclass(frozen=True, slots=True)
class Slip:
    """One contact of a heel, judged. ``slipped`` (by speed) is None when it can't be told.

    ``outcome`` is the class by distance, ``way`` the direction of the slide: forward, backward or
    sideways, empty when the heel stays.
    """

    contact: float
    start: Measurement
    end: float
    peak_speed: Measurement
    distance: Measurement
    margin: Measurement
    slipped: bool | None
    motion: HeelMotion | None = None
    peak_time: float = math.nan
    outcome: Outcome | None = None
    way: str = ""

    @property
    def slides(self) -> bool:
        """True when the heel slid further than a microslip: forces are then available friction."""
        return self.outcome in (Outcome.SLIDE, Outcome.LONG_SLIDE)


def slip(
    marker: Marker | None,
    contact: float,
    *,
    up: np.ndarray,
    walking: np.ndarray | None = None,
    leaves: float | None = None,
    definition: SlipDefinition | None = None,
    limits: OutcomeLimits | None = None,
    flags: tuple[Flag, ...] = (),
) -> Slip:
    """Return the slip (or its absence) after a heel contact.

    Slip start is the first local minimum of the heel's speed after contact, less the shift that
    the filter gives a minimum between unlike sides; the peak slipping speed is the largest speed
    between it and the second local minimum, the moment the foot leaves the plate, the heel lifts
    by 30 mm, or the record ends, whichever is first. Distance is the displacement of the heel in
    the floor's plane between start and end.

    Without ``marker`` (the heel's) it is "not estimated". ``contact`` is the time of heel contact
    and ``leaves`` that at which the foot leaves the plate (s), if there is one; ``up`` and
    ``walking`` are unit vectors (3,), ``walking`` only to say whether the heel went backward.

    Source: grant report G.5.1 and G.6.1; horizontal plane by default because heel lift adds
    vertical speed at the end.
    """
    definition = definition or SlipDefinition()
    choices = definition.conventions()

    def without(reason: Message, motion: HeelMotion | None = None) -> Slip:
        start, speed, distance, margin = (
            Measurement.not_estimated(name, reason, unit=unit, flags=flags, conventions=choices)
            for name, unit in _MEASURED.items()
        )
        return Slip(contact, start, math.nan, speed, distance, margin, None, motion)

    if marker is None:
        return without(Message("there is no heel marker"))
    motion = heel_motion(marker, up, definition)
    first = int(np.searchsorted(motion.time, contact))
    if first >= len(motion.time) - 2 or contact < motion.time[0]:
        return without(Message("the contact lies outside the marker's record"), motion)
    last, ended = _window_end(motion, first, up, leaves, definition.heel_lift)
    lost = ~np.isfinite(motion.speed[first : last + 1])
    if lost.any():
        when = 1e3 * (motion.time[first + int(np.argmax(lost))] - contact)
        if lost[: max(3, round(0.1 * marker.rate))].any():
            why = Message(" ({note})", note=marker.note) if marker.note else NOTHING
            missing = Message(
                "the heel marker is missing {time:.0f} ms after contact{why}", time=when, why=why
            )
            return without(missing, motion)
        last = first + int(np.argmax(lost)) - 1
        ended = Message("the marker is lost {time:.0f} ms after contact", time=when)
    if last - first < 4:
        return without(Message("fewer than five frames of the heel after contact"), motion)
    reach = round(0.5 * marker.rate / definition.filter.cutoff)
    minima = _minima(motion.speed, first, last, reach, definition.prominence)
    if not len(minima):
        none = Message(
            "the heel's speed has no local minimum after contact until {ended}", ended=ended
        )
        return without(none, motion)
    if minima[0] < first:
        early = 1e3 * (contact - motion.time[minima[0]])
        flags += (
            caution(
                "the speed's minimum lies {early:.0f} ms before contact: the filter's blur",
                early=early,
            ),
        )
    begin = int(minima[0])
    stop, by = last, ended
    if len(minima) > 1:
        stop, by = int(minima[1]), Message("second local minimum")
    top = begin + int(np.argmax(motion.speed[begin : stop + 1]))
    peak = float(motion.speed[top])
    choices["search ends"] = by
    approach = slice(max(0, first - 2 * reach), stop + 1)
    leapt = int(motion.jumps[approach].sum())
    if leapt:
        text = Message(
            "{leapt} frames of the heel marker leap off its path: taken as missing", leapt=leapt
        )
        flags += (Flag("marker jumps", text, True, leapt, 0.0, "1"),)
    count = int((motion.filled & ~motion.jumps)[first : stop + 1].sum())
    if count:
        flags += (caution("{count} frames of the heel marker were bridged", count=count),)
    later = float(np.nanmax(motion.speed[stop : last + 1], initial=0.0))
    if peak <= definition.threshold < later:
        flags += (caution("the heel reaches {later:.2f} m/s after the search's end", later=later),)
    if walking is not None and motion.velocity[top] @ walking < -0.5 * peak and peak > 0.05:
        flags += (caution("the heel moves backward at its peak speed"),)
    if top == stop and len(minima) < 2:
        flags += (caution("the speed still grows when the search ends: {by}", by=by),)
    moved = motion.position[stop] - motion.position[begin]
    moved -= (moved @ up) * up
    distance = float(np.linalg.norm(moved))
    outcome = (limits or OutcomeLimits()).outcome(distance)
    slipped = peak > definition.threshold
    if slipped != (outcome in (Outcome.SLIDE, Outcome.LONG_SLIDE)):
        values = {"peak": peak, "outcome": str(outcome), "distance": 1e3 * distance}
        text = (
            Message(
                "slip by speed ({peak:.2f} m/s, {above:.2f} m/s above the rule) but {outcome} by "
                "distance ({distance:.0f} mm): a false alarm of the rule looks like this "
                "({alarms})",
                **values,
                above=peak - definition.threshold,
                alarms=FALSE_ALARMS,
            )
            if slipped
            else Message(
                "no slip by speed ({peak:.2f} m/s) but {outcome} by distance ({distance:.0f} mm)",
                **values,
            )
        )
        flags += (Flag("speed against distance", text, True, peak, definition.threshold, "m/s"),)
    start, start_uncertainty, shift = _slip_start(motion, begin, definition.filter.cutoff)
    choices["slip start"] = Message(
        "{start}, less {shift:.1f} ms that the filter shifts it",
        start=choices["slip start"],
        shift=1e3 * shift,
    )
    choices["uncertainty"] = Message(
        "marker noise through the filter; for the start, the filter's shift too"
    )

    def value(name: str, number: float, sd: float) -> Measurement:
        return Measurement(name, number, _MEASURED[name], sd, flags=flags, conventions=choices)

    return Slip(
        contact,
        value("slip start", start, start_uncertainty),
        float(motion.time[stop]),
        value("peak slipping speed", peak, motion.speed_noise),
        value("slip distance", distance, math.sqrt(2.0) * motion.noise),
        value("slip margin", peak - definition.threshold, motion.speed_noise),
        slipped,
        motion,
        float(motion.time[top]),
        outcome,
        _way(moved, walking, up) if outcome is not Outcome.NO_SLIP else "",
    )


def _way(moved: np.ndarray, walking: np.ndarray | None, up: np.ndarray) -> str:
    """Direction of a slide against the walk: within 45 degrees of it, of its opposite, or not."""
    if walking is None:
        return ""
    along, across = float(moved @ walking), float(abs(moved @ np.cross(up, walking)))
    if across > abs(along):
        return "sideways"
    return "forward" if along > 0 else "backward"


def _slip_start(motion: HeelMotion, begin: int, cutoff: float) -> tuple[float, float, float]:
    """Return the start of a slip, its standard uncertainty and the filter's shift (s).

    A filter of width w moves the minimum between steep braking and slow speeding up towards the
    slower side. For two parabolas of curvature ratio r the shift z w solves
    phi + z Phi = r (phi - z (1 - Phi)); for a sharp corner of slope ratio r, Phi(z) = r / (1 + r).
    The ratio is that of the rises three widths to either side. The parabolas' shift is taken off;
    the corner's bounds it (triangular distribution). Further: the frame's rounding, and the noise
    of the acceleration over the curvature at the minimum.
    """
    from scipy.special import ndtr, ndtri

    width = _WIDTH / cutoff
    here = _instant(motion, begin)
    rate = 1.0 / (motion.time[1] - motion.time[0])
    low, before, after = np.interp(
        [here, here - 3 * width, here + 3 * width], motion.time, motion.speed
    )
    bend = float(np.sum(motion.speed[begin - 1 : begin + 2] * [1.0, -2.0, 1.0])) * rate**2
    frame = 1.0 / rate / math.sqrt(12.0)
    noise = motion.acceleration_noise / bend if bend > 0 else width
    if not np.isfinite(before + after):
        return here, math.hypot(frame, width), 0.0
    left, right = max(before - low, 1e-6), max(after - low, 1e-6)
    corner = width * float(ndtri(np.clip(left / (left + right), 1e-4, 1 - 1e-4)))
    z = np.linspace(-4.0, 4.0, 8001)
    density = np.exp(-0.5 * z**2) / math.sqrt(2.0 * math.pi)
    slope = right * (density + z * ndtr(z)) - left * (density - z * (1.0 - ndtr(z)))
    shift = width * float(np.interp(0.0, slope, z))
    shape = (corner - shift) / math.sqrt(6.0)
    return here - shift, math.hypot(frame, min(noise, width), shape), shift


@of_walkway
def slip_of(
    walk: Walkway,
    stance: Stance,
    *,
    definition: SlipDefinition | None = None,
    limits: OutcomeLimits | None = None,
) -> Slip:
    """Return the slip after a contact with a force plate, by the heel of that foot.

    On a belt the heel's speed is that over the belt. A contact rejected as a step may still be a
    slip (a foot that slides off a plate is no clean step): its reason is kept as a flag.
    """
    walking, up, step = stance.walking, walk.up, Step(walk, stance)
    if walking is None:
        walking = walk.direction(step.plate, stance.start, stance.stop).vector
    marker = step.heel or step.markers.get(walk.heels.get(stance.side, ""))
    flags = (caution("not a clean step: {reason}", reason=stance.reason),) if stance.reason else ()
    if walking is not None:
        up, walking = walk.axes.ramp.surface(up, walking)  # a heel slides along the surface
    return slip(
        marker, stance.contact, up=up, walking=walking, leaves=stance.toe_off,
        definition=definition, limits=limits, flags=flags,
    )  # fmt: skip


def _window_end(
    motion: HeelMotion, first: int, up: np.ndarray, leaves: float | None, heel_lift: float
) -> tuple[int, Message]:
    last, ended = len(motion.time) - 1, Message("the record ends")
    if leaves is not None and leaves < motion.time[-1]:
        last, ended = (
            int(np.searchsorted(motion.time, leaves)),
            Message("the foot leaves the plate"),
        )
    height = motion.position[first : last + 1] @ up
    known = height[np.isfinite(height)]
    if len(known):
        lifted = height - np.minimum.accumulate(np.nan_to_num(height, nan=np.inf)) > heel_lift
        if lifted.any():
            last, ended = first + int(np.argmax(lifted)), Message("the heel lifts")
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
