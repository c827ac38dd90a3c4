"""Is a step what it looks like? Checks of signals, markers and results, each with its limit.

The limits are wide against the real steps that come with this package; where no publication is
named, they are assumed. A flag that matters makes a step "caution".
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from underfoot.core import UnderfootError
from underfoot.core.constants import GRAVITY
from underfoot.core.remark import Message

from ..recording.axes import LEVEL, DirectionSource, Ramp, body_markers
from ..recording.measurement import Flag, remark
from ..recording.signals import (
    CONTACT_FORCE,
    LowPass,
    frames_between,
    longest_run,
    low_passed,
    runs,
)
from ..recording.trial import Marker, Plate, once_a_record
from .body_weight import BodyWeight
from .events import Stance
from .likelihood import unlikely_flags
from .processed import comb_depths, dead_time
from .slips import contact_from_heel, heel_motion, marker_jumps
from .step import Step
from .step_features import BUMP, FASTEST, USUAL_DURATION, USUAL_SPEED, VERTICAL
from .walkway import Walkway

_ASSUMED = "assumed; kept by every real step that comes with this package"


@dataclass(frozen=True, slots=True)
class Limit:
    """A bound of a plausible value, in ``unit``, and where it comes from."""

    name: str
    value: float
    unit: str
    source: str = _ASSUMED

    def flag(self, measured: float, message: Message) -> Flag:
        """Return the flag of a value beyond the limit."""
        return Flag(self.name, message, True, float(measured), self.value, self.unit, self.source)

    def above(self, measured: float, message: Message) -> tuple[Flag, ...]:
        """Return the flag of a value if it lies above the limit."""
        return (self.flag(measured, message),) if measured > self.value else ()


RCOF = Limit(
    "RCOF of level walking", 0.30, "1",
    "mean 0.20 and standard deviation 0.03 between adults who walk straight on level floor "
    "(Redfern et al. 2001, Chang et al. 2011; from memory, not verified), 3.3 of them on both "
    "sides: 1 sound step in 1000",
)  # fmt: skip
LOW_RCOF = Limit("RCOF of level walking", 0.10, "1", RCOF.source)
HIGH_PEAK = Limit("peak over body weight", 1.6, "1")
MEAN_LOW = Limit(
    "mean over body weight", 0.74, "1",
    "two stances of 58 to 66 % of a stride carry body weight together: 0.76 to 0.86; 0.79 to 0.93 "
    "in 6 recorded steps of children",
)  # fmt: skip
MEAN_HIGH = Limit("mean over body weight", 0.97, "1", MEAN_LOW.source)
SLOW_MEAN_LOW = Limit(
    "mean over body weight", 0.68, "1",
    "slow and old people stand for up to 73 % of a stride (from memory: Nilsson and Thorstensson "
    "1989, Winter 1991); walking below 0.9 m/s, or a stance above 0.8 s where no marker tells",
)  # fmt: skip
HUMP = Limit("single hump", 1.05, "1")  # largest mid-stance force over both humps
SLOW_HUMP = Limit("single hump", 1.1, "1", "a slow walk has a flat force (assumed, below 0.9 m/s)")
LOADING_RATE = Limit("loading rate", 100.0, "1/s")
USUAL_STANCE = Limit("stance time", 1.0, "s")
LONG_STANCE = Limit(
    "stance time", 1.3, "s", "a walk of 0.5 m/s, as the mean force over body weight tells"
)
SHORT_STANCE = Limit("stance time", 0.45, "s")
SHORT_PACE, LONG_PACE = (
    Limit(
        "pace", value, "1",
        "stance time sqrt(g / h) sqrt(v / sqrt(g h)), h the height of the pelvis: 1.2 to 1.6 from "
        "children to adults at 0.5 to 1.8 m/s, as the step grows with the root of the speed "
        "(Sekiya et al. 1996, from memory); clocks wrong by two move it by 1.41",
    )
    for value in (0.95, 1.85)
)  # fmt: skip
REST_JUMP = Limit("jump from rest", 0.2, "1")
SHEAR_SPIKE = Limit("spike", 30.0, "N")
NORMAL_SPIKE = Limit("spike", 120.0, "N")
STEP = Limit(
    "step of the forces", 0.03, "1",
    "beyond the steps of 3 ms to both sides, over the mean force; up to 0.011 in 16 recorded steps",
)  # fmt: skip
AVERAGED = Limit(
    "moving average", 16.0, "dB",
    "depth of the spectrum at multiples of one frequency (processed.comb_depth): mean 8.0 and "
    "standard deviation 1.9 in 18 recorded contacts, four of them; none of averages below 30 ms, "
    "or with noise added later, is this deep",
)  # fmt: skip
DEAD_BAND = Limit("dead band", 0.0, "s", "no recorded contact rests at its unloaded level")
HELD = Limit("held samples", 0.004, "s")
STRAIGHT = Limit("straight lines", 0.03, "s", "up to 0.021 s in 16 recorded steps")
DRAWN = Limit("samples drawn out", 0.006, "s", "forces need 150 samples a second and more")
DROP_OUT = Limit("drop-out", 0.0, "s")
DRIFT = Limit(
    "baseline drift", 0.01, "1", "change of RCOF by the unloaded level before or after the step"
)
VIBRATION = Limit(
    "vibration", 0.01, "1", "two standard deviations of the unloaded, filtered shear in RCOF"
)
SHEAR_BEFORE = Limit(
    "shear before contact", 0.004, "1",
    "shear over the mean force of the stance; up to 0.002 in 16 recorded steps, up to 0.007 after",
)  # fmt: skip
SHEAR_AFTER = Limit("shear after toe off", 0.01, "1", SHEAR_BEFORE.source)
FILTERED = Limit(
    "already filtered", 0.01, "1",
    "forces at 50 to 100 Hz over those at 10 to 30 Hz: 0.05 and more in 18 unfiltered real steps, "
    "below 0.013 in the same steps after a low-pass of 25 Hz",
)  # fmt: skip
TURNS = Limit(
    "turns of the shear", 7.0, "1",
    "maxima and minima of the shear along and across, filtered at 36 Hz, that stand out by 0.6 % "
    "of the mean force, between 8 and 50 % of the stance; up to 7 in 16 recorded steps",
)  # fmt: skip
OTHER_FOOT = Limit(
    "shear against the other foot",
    1.5,
    "1",
    "3.3 standard deviations of the ratio of two steps that scatter by 9 % each, which adults do",
)
CHILDS_FOOT = Limit(
    "shear against the other foot", 2.0, "1", "the same with 15 %, below 40 kg (assumed)"
)
TURN = Limit("turn", math.radians(20.0), "rad")
SHEAR_TURN = Limit(
    "turn", math.radians(60.0), "rad",
    "angle between braking and driving where no marker tells the walk, less an even sideways force "
    "of up to a tenth of the normal one: 106 deg in a recorded turn",
)  # fmt: skip
SIDEWAYS = 0.1  # of the normal force: the foot stands up to 0.1 m beside a body of 1 m
CLIMB = Limit("climb", 0.15, "m/s")
PLATE_HEIGHT = Limit("plate height", 0.03, "m")
FAST = Limit("walking speed", 2.2, "m/s", "people run above 2.0 to 2.1 m/s (textbook value)")
LATE = Limit(
    "forces against markers", 0.06, "s", "times the stance over 0.65 s: slow feet land slowly"
)
SLOW, _SLOW_STANCE, _SLOW_MEAN = 0.9, 0.8, 0.78  # m/s, s, body weights
_LOADING = (0.08, 0.5)  # share of the stance in which the turns of the shear are counted
_STANDS_OUT = 0.006
_QUIET = 0.2  # s of unloaded record looked at before and after a step
_MARGIN = 0.025  # s away from the load
_OUTSIDE = 0.004, 0.04  # s from contact or toe off in which nothing loads the plate


def step_flags(
    step: Step,
    low_pass: LowPass,
    features: Mapping[str, float],
    levels: Sequence[np.ndarray],
) -> tuple[Flag, ...]:
    """Return what is doubtful about signals, markers and features of one accepted step.

    ``low_pass``: the filter of its forces. ``features``: those of ``judged_features``. ``levels``:
    ``unloaded_levels``.
    """
    forces = (*unknown_heel(step.walk), *_force_flags(step))
    if any(flag.name == FILTERED.name for flag in forces):  # says why there are no bumps
        features = {name: v for name, v in features.items() if not name.startswith(BUMP)}
    return (
        *forces,
        *_level_flags(step, low_pass, levels),
        *_path_flags(step),
        *_marker_flags(step),
        *(unlikely_flags(features, speed=step.speed) if features else (_NOT_JUDGED,)),
        *([] if not features or VERTICAL[0] in features else [_TOO_FAST]),
    )


def unknown_heel(walk: Walkway) -> tuple[Flag, ...]:
    """Return the caution of a recording whose markers have no heel among them, by their names."""
    count = 0 if walk.heels else len(body_markers(walk.trial.markers))
    if not count:
        return ()
    text = Message(
        "none of {count} markers is recognised as a heel: a slip can't be "
        "seen, and then the ratio is not required friction; name it under "
        "[landmarks] in profile.toml",
        count=count,
    )
    return (Flag("heel", text),)


def unseen(walk: Walkway) -> tuple[Flag, ...]:
    """Return what can't be seen in a whole recording for want of markers or of a body mass."""
    flags = unknown_heel(walk)
    count = len(body_markers(walk.trial.markers))
    if not count:
        text = Message("no markers: slips, turns, slopes and a gain of the shear can't be seen")
        flags += (Flag("markers", text),)
    elif not walk.pelvis:
        text = Message(
            "none of {count} markers is recognised as the pelvis's: a gain of "
            "the shear can't be seen; name them under [landmarks] in "
            "profile.toml",
            count=count,
        )
        flags += (Flag("pelvis", text),)
    if walk.weight is None:
        text = Message(
            "no body mass: a gain of the normal force can't be seen; write it "
            "into conditions.csv or profile.toml"
        )
        flags += (Flag("body mass", text),)
    return flags


_NOT_JUDGED = remark(
    "likelihood not judged: recorded steps on level ground tell it "
    "neither for a ramp nor for made-up recordings"
)


_TOO_FAST = remark(
    "shape of the normal force not judged: above {speed} m/s sound steps have others", speed=FASTEST
)


def rcof_flags(value: float, ramp: Ramp = LEVEL, speed: float | None = None) -> tuple[Flag, ...]:
    """Return the flag of an RCOF that walking does not need.

    On a ramp the limits of level walking widen by the tangent of the angle, which is what a body
    at rest there adds or takes off. Below 1.3 m/s, the ``speed`` they are of, the lower one falls
    as the usual RCOF does with the step's length, the root of the speed.
    """
    usual = 0.5 * (RCOF.value + LOW_RCOF.value)
    fall = usual * (1.0 - math.sqrt(min(speed / USUAL_SPEED, 1.0))) if speed else 0.0
    low = max(LOW_RCOF.value - fall, 0.0)
    slope = math.tan(abs(ramp.angle))
    where = Message("level, straight walking")
    if slope:
        where = Message("straight walking on a {ramp}", ramp=ramp.name)
    if value > RCOF.value + slope:
        return (
            RCOF.flag(
                value,
                Message("RCOF {value:.2f} is more than {where} needs", value=value, where=where),
            ),
        )
    if value < low - slope:
        return (
            LOW_RCOF.flag(
                value, Message("RCOF {value:.2f} is less than walking needs", value=value)
            ),
        )
    return ()


def other_foot_flags(
    shear: float, others: Sequence[float], weight: BodyWeight | None = None
) -> tuple[Flag, ...]:
    """Return the flag of a step whose RCOF differs from that of the recording's other plates.

    ``shear``: its RCOF; ``others``: those of the other plates. Children, by their ``weight``,
    scatter more.
    """
    if not others:
        return ()
    middle = float(np.median(others))
    ratio = max(shear / middle, middle / shear) if min(shear, middle) > 0 else math.inf
    words = Message(
        "RCOF {here:.2f} here and {others:.2f} on the other plates: a gain or a turn",
        here=shear,
        others=middle,
    )
    child = weight is not None and weight.newtons < 40.0 * GRAVITY
    return (CHILDS_FOOT if child else OTHER_FOOT).above(ratio, words)


def _pace(step: Step) -> float | None:
    """Stance time made free of size and speed by the height of the pelvis (see ``LONG_PACE``)."""
    walk, speed, corners = step.walk, step.speed, step.plate.corners
    up, markers = tuple(walk.up.tolist()), (walk.trial.markers[name] for name in walk.pelvis)
    usual = [_usual_height(marker, up) for marker in markers]
    heights = [height for height in usual if height is not None]
    if speed is None or not heights or corners is None:
        return None
    height = float(np.median(heights)) - float(corners.mean(axis=0) @ walk.up)
    if not height > 0.2:
        return None
    swing = math.sqrt(GRAVITY / height)
    return step.stance.duration * swing * math.sqrt(speed / (height * swing))


@once_a_record
def _usual_height(marker: Marker, up: tuple[float, ...]) -> float | None:
    if marker.missing.all():
        return None
    return float(np.nanmedian(marker.positions @ np.array(up)))


def _stance_flags(step: Step, mean: float) -> Iterator[Flag]:
    """Flags of the length of a stance whose mean normal force is ``mean`` (N)."""
    weight, speed, duration, pace = step.walk.weight, step.speed, step.stance.duration, _pace(step)
    if pace is not None and speed is not None:
        times = {"duration": duration, "speed": speed}
        long = Message(
            "stance of {duration:.2f} s: is the sampling rate right for {speed:.2f} m/s?", **times
        )
        short = Message(
            "stance of {duration:.2f} s: running, or a wrong rate for {speed:.2f} m/s", **times
        )
        yield from LONG_PACE.above(pace, long)
        if pace < SHORT_PACE.value:
            yield SHORT_PACE.flag(pace, short)
        return
    long = Message("stance of {duration:.2f} s: is the sampling rate right?", duration=duration)
    short = Message("stance of {duration:.2f} s: running, or a wrong rate", duration=duration)
    # A slow walk has both feet down for longer: its mean is lower, that of a wrong clock is not.
    slow = weight is not None and mean < _SLOW_MEAN * weight.newtons
    yield from (LONG_STANCE if slow else USUAL_STANCE).above(duration, long)
    if duration < SHORT_STANCE.value:
        yield SHORT_STANCE.flag(duration, short)


def _force_flags(step: Step) -> Iterator[Flag]:
    stance, plate, speed = step.stance, step.plate, step.speed
    up, weight, rate = step.walk.up, step.walk.weight, plate.rate
    normal = step.force @ up
    yield from _stance_flags(step, float(normal.mean()))
    thirds = len(normal) // 3
    humps = max(normal[:thirds].max(), normal[2 * thirds :].max())
    middle = float(normal[thirds : 2 * thirds].max())
    if middle > (HUMP.value if speed is None or speed > SLOW else SLOW_HUMP.value) * humps:
        text = Message("the force is largest in mid-stance: running or hopping, not walking")
        yield HUMP.flag(middle / float(humps), text)
    if weight is not None:
        ratio, mean = stance.peak / weight.newtons, float(normal.mean()) / weight.newtons
        yield from HIGH_PEAK.above(
            ratio,
            Message(
                "peak of {ratio:.2f} body weights ({source})", ratio=ratio, source=weight.source
            ),
        )
        slow = stance.duration > _SLOW_STANCE if speed is None else speed < SLOW
        low = SLOW_MEAN_LOW if slow else MEAN_LOW
        if not low.value <= mean <= MEAN_HIGH.value:
            limit = low if mean < low.value else MEAN_HIGH
            text = Message(
                "mean force of {mean:.2f} body weights ({source}): gain or unit?",
                mean=mean,
                source=weight.source,
            )
            yield limit.flag(mean, text)
    own = weight.newtons if weight else 0.9 * stance.peak
    jump = float(normal[0] - plate.force[max(stance.start - 1, 0)] @ up) / own
    if stance.start and jump > REST_JUMP.value + 100.0 / rate:
        text = Message(
            "the force jumps from rest to {share:.0f} % of body weight in one sample",
            share=100 * jump,
        )
        yield REST_JUMP.flag(jump, text)
    smooth = step.smooth_force
    slope = float(np.diff((smooth @ up)[: len(smooth) // 2]).max(initial=0.0)) * rate / own
    yield from LOADING_RATE.above(
        slope, Message("loading rate of {rate:.0f} body weights a second", rate=slope)
    )
    yield from _sample_flags(plate, stance, up)


def _sample_flags(plate: Plate, stance: Stance, up: np.ndarray) -> Iterator[Flag]:
    rate = plate.rate
    margin = round(_MARGIN * rate)
    part = plate.force[max(0, stance.start - margin) : stance.stop + margin]
    normal = part @ up
    shear = part - np.outer(normal, up)
    spikes = [(_spike(normal[:, None], rate), NORMAL_SPIKE), (_spike(shear, rate), SHEAR_SPIKE)]
    spikes = [(size, limit) for size, limit in spikes if size > limit.value]
    if spikes:
        size, limit = max(spikes, key=lambda pair: pair[0])
        yield limit.flag(
            size, Message("a spike of {size:.0f} N lasts three samples at most", size=size)
        )
    inner = slice(margin, len(part) - margin)
    step = _step(part[inner], rate) / max(float(normal[inner].mean()), 1.0)
    text = Message(
        "the forces step by {share:.0f} % of their mean in one sample: samples missing?",
        share=100 * step,
    )
    yield from STEP.above(step, text)
    still = (np.diff(part[inner], axis=0) == 0.0).all(axis=1) & (normal[inner][1:] > 50.0)
    held = longest_run(still) + 1
    if held >= 4 and held / rate >= HELD.value:
        text = Message("all forces stand still for {held} samples: held values", held=held)
        yield HELD.flag(held / rate, text)
    depth, window = comb_depths(plate.force, rate, stance.start, stance.stop, up)
    text = Message(
        "the forces lack every multiple of {rate:.0f} Hz: a moving average of {time:.0f} ms",
        rate=1.0 / max(window, 1e-3),
        time=1e3 * window,
    )
    yield from AVERAGED.above(depth, text)
    dead = max(dead_time(one, rate, stance.start, stance.stop) for one in plate.force.T)
    text = Message(
        "a force rests at its zero for {time:.0f} ms under load: a dead band", time=1e3 * dead
    )
    yield from DEAD_BAND.above(dead, text)
    yield from _straight_flags(part[inner], rate)
    firm = normal[inner]
    edge = max(1, len(firm) // 20)
    lost = firm[edge:-edge] < 20.0
    text = Message("the force drops out for {count} samples", count=int(lost.sum()))
    yield from DROP_OUT.above(lost.sum() / rate, text)
    if rate >= 150.0:
        begin, end = stance.start - 2 * margin, stance.start + (stance.stop - stance.start) // 4
        share = _high_share(plate.force[max(0, begin) : end], rate)
        if share < FILTERED.value:
            text = Message("nothing in the forces is faster than 25 Hz: they were filtered before")
            yield FILTERED.flag(share, text)


def _straight_flags(force: np.ndarray, rate: float) -> Iterator[Flag]:
    """Flags of samples (n, 3) on straight, sloping lines: drawn between others, not measured."""
    first, second = np.diff(force, axis=0)[1:], np.diff(force, 2, axis=0)
    drawn = (np.abs(second) < 1e-3 * np.abs(first)) & (first != 0.0)
    lengths = [(stop - start + 2) / rate for mask in drawn.T for start, stop in runs(mask)]
    longest = max(lengths, default=0.0)
    words = Message(
        "a force runs straight for {time:.0f} ms: a gap filled by a line", time=1e3 * longest
    )
    yield from STRAIGHT.above(longest, words)
    if drawn.mean() > 0.5:
        usual = float(np.median(lengths))
        words = Message(
            "forces lie on lines of {time:.0f} ms: recorded slower, then drawn out",
            time=1e3 * usual,
        )
        yield from DRAWN.above(usual, words)


def _spike(values: np.ndarray, rate: float) -> float:
    """Largest excursion (n, k) that stands out from the samples up to 2 ms to both sides.

    Two samples to each side from 800 Hz on, else one: a heel's impact lasts longer.
    """
    reach = 2 if rate >= 800.0 else 1
    here = values[reach:-reach]
    before, after = here - values[: -2 * reach], here - values[2 * reach :]
    out = np.where(before * after > 0, np.minimum(np.abs(before), np.abs(after)), 0.0)
    return float(out.max(initial=0.0))


def _step(force: np.ndarray, rate: float) -> float:
    """Largest step (N) of forces (n, 3) beyond the largest ones of 3 ms to both sides.

    The first and last 2 % are the foot's own.
    """
    reach, edge = max(2, round(0.003 * rate)), len(force) // 50
    steps = np.abs(np.diff(force[edge : len(force) - edge], axis=0))
    if len(steps) < 2 * reach + 1:
        return 0.0
    windows = np.lib.stride_tricks.sliding_window_view(steps, reach, axis=0).max(axis=2)
    around = np.maximum(windows[: -reach - 1], windows[reach + 1 :])
    beyond = np.maximum(steps[reach:-reach] - around, 0.0)
    return float(np.linalg.norm(beyond, axis=1).max())


def _high_share(force: np.ndarray, rate: float) -> float:
    """Amplitude of the forces (n, 3) at 50 to 100 Hz over that at 10 to 30 Hz, about contact."""
    line = np.linspace(0.0, 1.0, len(force))[:, None]
    force = force - (force[0] + (force[-1] - force[0]) * line)
    power = np.abs(np.fft.rfft(force * np.hanning(len(force))[:, None], axis=0)) ** 2
    frequency = np.fft.rfftfreq(len(force), 1.0 / rate)
    high = (frequency >= 50.0) & (frequency < min(100.0, 0.45 * rate))
    low = (frequency >= 10.0) & (frequency < 30.0)
    if not high.any() or not power[low].any():
        return math.inf
    return math.sqrt(float(power[high].mean(axis=0).sum() / power[low].mean(axis=0).sum()))


def unloaded_levels(step: Step) -> list[np.ndarray]:
    """Return the mean forces (3,) of up to 0.2 s unloaded record before and after a step.

    A side with less than 20 ms between the margins of neighbouring loads is left out.
    """
    plate, stance, rate = step.plate, step.stance, step.plate.rate
    margin, quiet = round(_MARGIN * rate), round(_QUIET * rate)
    free = _free(plate, step.contacts, margin)
    begin, end = max(0, stance.start - margin), stance.stop + margin
    found = []
    for window in (slice(max(0, begin - quiet), begin), slice(end, end + quiet)):
        force = plate.force[window][free[window]]
        force = force[np.isfinite(force).all(axis=1)]
        if len(force) >= max(5, 0.02 * rate):
            found.append(force.mean(axis=0))
    return found


@once_a_record
def _free(plate: Plate, contacts: tuple[tuple[int, int], ...], margin: int) -> np.ndarray:
    """Mask of the samples (n,) further than ``margin`` from any contact; not to be written to."""
    free = np.ones(len(plate.force), dtype=bool)
    for start, stop in contacts:
        free[max(0, start - margin) : stop + margin] = False
    return free


def baseline_error(
    levels: Sequence[np.ndarray], up: np.ndarray, normal: float, rcof: float
) -> float:
    """Return what the unloaded levels (3,) around a step, if not zero, do to its RCOF.

    ``normal``: force (N) at the peak of the ratio, which is ``rcof``; ``up``: normal to the floor.
    """
    effects = [
        math.hypot(float(np.linalg.norm(level - (level @ up) * up)), rcof * float(level @ up))
        for level in levels
    ]
    return max(effects, default=0.0) / max(normal, 1.0)


def _turns(force: np.ndarray, walking: np.ndarray, up: np.ndarray) -> int:
    """Count the maxima and minima of the shear while the foot is loaded, along and across.

    ``force`` (n, 3) is the smoothed one of the stance, ``walking`` (3,) its direction.
    """
    from scipy.signal import find_peaks

    begin, end = (round(share * len(force)) for share in _LOADING)
    least = _STANDS_OUT * float((force @ up).mean())
    axes = walking, np.cross(up, walking)
    parts = [sign * (force @ axis)[begin:end] for axis in axes for sign in (1, -1)]
    return sum(len(find_peaks(part, prominence=least)[0]) for part in parts)


def _level_flags(step: Step, low_pass: LowPass, levels: Sequence[np.ndarray]) -> Iterator[Flag]:
    stance, up, normal = step.stance, step.walk.up, 0.8 * step.stance.peak
    drift = baseline_error(levels, up, normal, 0.2)
    text = Message(
        "the unloaded level before or after the step moves RCOF by {drift:.3f}: drift", drift=drift
    )
    yield from DRIFT.above(drift, text)
    noise = _noise(step.plate, tuple(up.tolist()), step.contacts, low_pass)
    text = Message(
        "the unloaded plate swings by {noise:.1f} N (standard deviation): vibration", noise=noise
    )
    yield from VIBRATION.above(2.0 * noise / normal, text)
    if stance.by_hand:  # who sets an instant may leave load outside
        return
    before, after = _shear_outside(step.plate, stance, up)
    late = Message("the shear was shifted or filtered by itself")
    text = Message(
        "shear of {share:.1f} % of the mean force before the foot is down: {late}",
        share=100 * before,
        late=late,
    )
    yield from SHEAR_BEFORE.above(before, text)
    text = Message(
        "shear of {share:.1f} % of the mean force after the foot has left: {late}",
        share=100 * after,
        late=late,
    )
    yield from SHEAR_AFTER.above(after, text)


def _shear_outside(plate: Plate, stance: Stance, up: np.ndarray) -> tuple[float, float]:
    """Mean shear just before and just after a stance, against further away, over its mean force.

    Where another load is near, or the record ends, there is nothing to compare: 0.
    """
    near, far = (round(time * plate.rate) for time in _OUTSIDE)
    near = max(1, near)
    mean = float((plate.force[stance.start : stance.stop] @ up).mean())
    found = []
    for values in (plate.force[: stance.start][::-1], plate.force[stance.stop :]):
        close, away = values[near:far], values[far + near : 4 * far]
        quiet = len(close) > 5 and len(away) > 10 and np.abs(away @ up).max() < CONTACT_FORCE
        if not quiet:
            found.append(0.0)
            continue
        push = close.mean(axis=0) - away.mean(axis=0)
        found.append(float(np.linalg.norm(push - (push @ up) * up)) / mean)
    return found[0], found[1]


@once_a_record
def _noise(
    plate: Plate,
    vertical: tuple[float, ...],
    contacts: tuple[tuple[int, int], ...],
    low_pass: LowPass,
) -> float:
    """Standard deviation (N) of the filtered shear about its slow level, unloaded."""
    parts, up = [], np.array(vertical)
    for start, stop in runs(_free(plate, contacts, round(2 * _MARGIN * plate.rate))):
        part = plate.force[start:stop]
        if stop - start < max(40, 0.1 * plate.rate) or not np.isfinite(part).all():
            continue
        try:
            part = low_passed(part, plate.rate, low_pass)
        except UnderfootError:
            continue
        line = np.linspace(-0.5, 0.5, len(part))[:, None]
        part = part - part.mean(axis=0)
        part = part - line * (line * part).sum(axis=0) / (line**2).sum()
        parts.append(((part - np.outer(part @ up, up)) ** 2).sum(axis=1))
    return float(np.sqrt(np.concatenate(parts).mean())) if parts else 0.0


def _path_flags(step: Step) -> Iterator[Flag]:
    walk, stance, axes = step.walk, step.stance, step.walk.axes
    if stance.direction.source is DirectionSource.SHEAR:
        yield Flag(
            "walking direction",
            Message(
                "no markers and no centre of pressure: the walking direction comes from the shear "
                "alone, and whether this was a walk can't be checked"
            ),
        )
    normal = axes.up if stance.walking is None else axes.ramp.surface(axes.up, stance.walking)[0]
    heights = {
        plate.name: float(plate.corners.mean(axis=0) @ normal)
        for plate in walk.trial.plates
        if plate.usable and plate.corners is not None
    }
    if stance.plate in heights:
        away = max(abs(height - heights[stance.plate]) for height in heights.values())
        text = Message(
            "plates differ by {height:.0f} mm in height: stairs or a step", height=1e3 * away
        )
        yield from PLATE_HEIGHT.above(away, text)
    turns = 0
    if stance.walking is not None:
        turns = _turns(step.smooth_force, stance.walking, axes.up)
    text = Message(
        "the shear rises and falls {turns} times while the foot is loaded: the plate rings",
        turns=turns,
    )
    yield from TURNS.above(turns, text)
    whole, _, first, second = step.body
    if whole is None:
        angle = _braking_to_driving(step)
        text = Message(
            "driving is turned by {angle:.0f} deg against braking: a turn",
            angle=math.degrees(angle),
        )
        yield from SHEAR_TURN.above(angle, text)
        return
    climb = float(whole @ axes.up)
    speed = float(np.linalg.norm(whole - climb * axes.up))
    slope = axes.ramp.angle if axes.ramp.plate_frame == "horizontal" else 0.0
    expected = speed * math.tan(slope)
    text = Message("the body rises at {climb:.2f} m/s: stairs, a ramp or a jump", climb=climb)
    if slope:
        text = Message(
            "the body rises at {climb:.2f} m/s, the ramp at {expected:.2f} m/s",
            climb=climb,
            expected=expected,
        )
    yield from CLIMB.above(abs(climb - expected), text)
    yield from FAST.above(speed, Message("{speed:.1f} m/s is faster than people walk", speed=speed))
    if first is None or second is None:
        return
    if min(np.linalg.norm(first), np.linalg.norm(second)) < 0.3:
        return
    angle = _angle(first, second)
    text = Message("the walk turns by {angle:.0f} deg during the step", angle=math.degrees(angle))
    yield from TURN.above(angle, text)


def _braking_to_driving(step: Step) -> float:
    """Angle (rad) between the braking and the opposite of the driving impulse of a step.

    The even sideways force of a foot that stands beside the body is taken off before.
    """
    walk, walking, force = step.walk, step.stance.walking, step.force
    if walking is None:
        return 0.0
    up, forward = walk.axes.ramp.gravity(walk.up, walking)
    normal, across = force @ up, np.cross(up, forward)
    shear = force - np.outer(normal, up)
    even = float((shear @ across).mean() / normal.mean())
    shear = shear - np.outer(min(max(even, -SIDEWAYS), SIDEWAYS) * normal, across)
    half = len(shear) // 2
    along = shear @ forward
    braking = shear[:half][along[:half] < 0].sum(axis=0)
    driving = shear[half:][along[half:] > 0].sum(axis=0)
    return _angle(braking, -driving)


def _angle(first: np.ndarray, second: np.ndarray) -> float:
    size = float(np.linalg.norm(first) * np.linalg.norm(second))
    return math.acos(min(1.0, max(-1.0, float(first @ second) / size))) if size else 0.0


def _marker_flags(step: Step) -> Iterator[Flag]:
    walk, stance = step.walk, step.stance
    by_hand = "side" in stance.by_hand
    for event in walk.trial.events:
        sides = {event.side, stance.side}
        near = event.name == "heel contact" and abs(event.time - stance.contact) < 0.15
        if near and sides == {"left", "right"} and not by_hand:
            yield Flag(
                "side",
                Message(
                    "the {side} heel stands here, the file's own event at {time:.2f} s "
                    "says {event}: markers exchanged?",
                    side=stance.side,
                    time=event.time,
                    event=event.side,
                ),
            )
    if not walk.heels:
        return
    if not stance.heel:
        if step.plate.corners is not None and not by_hand:
            text = Message(
                "no heel marker comes down on the plate: are forces and markers in time?"
            )
            yield Flag("foot", text)
        return
    heel = walk.trial.markers[stance.heel]  # over the whole record, also on a belt
    if heel.times is not None:
        jumps = marker_jumps(heel.positions)
    else:
        jumps = heel_motion(heel, walk.up).jumps
        landings = [t for t in contact_from_heel(heel, walk.up) if abs(t - stance.contact) < 0.4]
        gap = min((abs(t - stance.contact) for t in landings), default=0.0)
        text = Message(
            "heel and force come down {gap:.0f} ms apart: forces late or early", gap=1e3 * gap
        )
        slowness = max(stance.duration / USUAL_DURATION, 1.0)
        yield from replace(LATE, value=LATE.value * slowness).above(gap, text)
    near = frames_between(heel.time, stance.contact - 0.1, stance.toe_off)
    inside = (heel.time[near] > stance.contact - 0.1) & (heel.time[near] < stance.toe_off)
    leaps = int(jumps[near][inside].sum())
    if leaps:
        text = Message("the heel marker leaps off its path in {leaps} frames", leaps=leaps)
        yield Flag("marker jumps", text, True, leaps, 0.0, "1")
