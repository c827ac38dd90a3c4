"""The walk around a step, curves over stance, and what happens around a slip."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from underfoot.core.remark import NOTHING, Message

from ..recording.measurement import Flag
from ..recording.signals import MARKER_FILTER, LowPass, bridge_gaps, frames_between, low_passed
from ..recording.trial import Marker
from .events import Stance
from .slips import OutcomeLimits, Slip, heel_motion
from .step import Step
from .walkway import Walkway, of_walkway

FLAT = (0.3, 0.5)  # share of the stance in which the foot lies flat
PERCENT = np.arange(101)
_FOOT_FILTER = LowPass(cutoff=10.0)


@dataclass(frozen=True, slots=True)
class GaitContext:
    """What a reviewer asks about a step; SI, None where it was not recorded.

    ``walking_speed`` of the body during the stance; ``step_length`` along the walk and
    ``step_time`` since the other foot's contact; ``cadence`` 1 / step time (steps a second);
    ``foot_angle`` between sole and floor at contact, toe up positive; ``heel_speed`` of the heel
    at contact, in the plane of the floor; ``belt_speed`` of a treadmill under the foot. On a belt
    all of them are over the belt.
    """

    walking_speed: float | None = None
    step_length: float | None = None
    step_time: float | None = None
    cadence: float | None = None
    foot_angle: float | None = None
    heel_speed: float | None = None
    belt_speed: float | None = None


@of_walkway
def gait_context(walk: Walkway, stance: Stance, stances: Sequence[Stance]) -> GaitContext:
    """Return the walk around one of the ``stances`` of a trial, as seen from its surface."""
    step, belt = Step(walk, stance), walk.belts.get(stance.plate)
    body, angle = step.body.flat, _foot_angle(step)
    length, time = _length_and_time(step, stances)
    return GaitContext(
        walking_speed=None if body is None else _number(float(np.linalg.norm(body))),
        step_length=length,
        step_time=time,
        cadence=1.0 / time if time else None,
        foot_angle=None if angle is None else _number(float(angle[1][0])),
        heel_speed=_heel_speed(step),
        belt_speed=None if belt is None else belt.speed(stance.contact),
    )


@of_walkway
def heel_speed(walk: Walkway, stance: Stance) -> float | None:
    """Return the heel's speed at contact in the plane of the floor (m/s), None where unknown."""
    return _heel_speed(Step(walk, stance))


def _heel_speed(step: Step) -> float | None:
    heel = step.heel
    if heel is None or heel.times is not None:
        return None
    motion = heel_motion(heel, step.walk.up)
    return _number(float(np.interp(step.stance.contact, motion.time, motion.speed)))


def _length_and_time(step: Step, stances: Sequence[Stance]) -> tuple[float | None, float | None]:
    """Return length and time since the contact of the other foot (0.25 to 1.5 s before)."""
    stance = step.stance
    before = [
        other
        for other in stances
        if 0.25 < stance.contact - other.contact < 1.5
        and {other.side, stance.side} == {"left", "right"}
    ]
    if not before:
        return None, None
    other = max(before, key=lambda one: one.contact)
    time = stance.contact - other.contact
    heels = [(step.markers.get(one.heel), one) for one in (other, stance)]
    if stance.walking is None:
        return None, time
    first, second = (_standing_place(heel, one) for heel, one in heels)
    return _number(float((second - first) @ stance.walking)), time


def _standing_place(heel: Marker | None, stance: Stance) -> np.ndarray:
    """Median place (3,) of a heel between 10 and 40 % of its stance; NaN where it is not seen."""
    if heel is None:
        return np.full(3, np.nan)
    near = frames_between(heel.time, stance.contact, stance.toe_off)
    share = (heel.time[near] - stance.contact) / max(stance.duration, 1e-9)
    inside = (share > 0.1) & (share < 0.4) & ~heel.missing[near]
    places = heel.positions[near][inside]
    return np.median(places, axis=0) if len(places) > 2 else np.full(3, np.nan)


@of_walkway
def foot_angle(walk: Walkway, stance: Stance) -> tuple[np.ndarray, np.ndarray] | None:
    """Return times (n,) from contact to toe off and the angle of sole and floor (rad), or None.

    From the line heel marker to toe marker of the same side, low-passed at 10 Hz, against its
    angle while the foot lies flat (30 to 50 % of stance).
    """
    return _foot_angle(Step(walk, stance))


def _foot_angle(step: Step) -> tuple[np.ndarray, np.ndarray] | None:
    stance, heel, toe = step.stance, step.heel, step.toe
    if heel is None or toe is None or stance.walking is None:
        return None
    if len(heel.positions) != len(toe.positions) or heel.rate != toe.rate or heel.times is not None:
        return None
    time, line = _bridged_between(stance.contact - 0.2, stance.toe_off + 0.2, toe, heel)
    if len(line) < 30 or not np.isfinite(line).all():
        return None
    if heel.rate > 2.3 * _FOOT_FILTER.cutoff:
        line = low_passed(line, heel.rate, _FOOT_FILTER)
    tilt = np.unwrap(np.arctan2(line @ step.walk.up, line @ stance.walking))
    share = (time - stance.contact) / stance.duration
    flat = (share > FLAT[0]) & (share < FLAT[1])
    if not flat.any():
        return None
    steps = np.arange(stance.contact, stance.toe_off, 1.0 / heel.rate)
    return steps, np.interp(steps, time, tilt - np.median(tilt[flat]))


@of_walkway
def stance_curves(
    walk: Walkway, stance: Stance, ratio: np.ndarray, low_pass: LowPass
) -> dict[str, np.ndarray]:
    """Return forces (N) and ratio at 0, 1 ... 100 % of a stance, (101,) each.

    ``vertical`` (on a ramp: normal to it), ``braking`` (positive when the floor pushes backward),
    ``to the left``, ``ratio``.
    """
    axes, force = walk.axes, Step(walk, stance).filtered_force[low_pass]
    walking = stance.walking if stance.walking is not None else np.zeros(3)
    normal, forward = axes.ramp.surface(axes.up, walking)
    curves = {
        "vertical": force @ normal,
        "braking": -(force @ forward),
        "to the left": force @ np.cross(axes.up, walking),
        "ratio": np.nan_to_num(ratio),
    }
    share = np.linspace(0.0, 100.0, len(force))
    return {name: np.interp(PERCENT, share, values) for name, values in curves.items()}


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


FALL = 0.8  # of the pelvis's height before contact; assumed: a recovering walker squats less
_RISEN = 0.93  # of it, at which the walker stands again; assumed
_AFTER = 1.5  # s looked at after contact
_TOE_FIRST = np.radians(-5.0)
_PELVIS = re.compile(r"pelv|troch|hip$|(^|[ _.:\-])[lr]?v?sac", re.IGNORECASE)  # its height tells


@dataclass(frozen=True, slots=True)
class SlipCourse:
    """How a slip went on; lengths in m, None where markers don't tell.

    ``body`` is "recovery", "fall" or empty, with the reason in ``body_reason``; ``toe_slip`` the
    way of the toe between 40 and 90 % of a stance whose heel did not slide, ``trailing_slip``
    that of the other foot while it stood, between contact and the slip's end; ``misstep`` says
    how the foot came down wrongly.
    """

    body: str = ""
    body_reason: Message = NOTHING
    toe_slip: float | None = None
    trailing_slip: float | None = None
    misstep: Message = NOTHING
    flags: tuple[Flag, ...] = ()


@of_walkway
def slip_course(
    walk: Walkway, stance: Stance, slip: Slip, limits: OutcomeLimits | None = None
) -> SlipCourse:
    """Return what happened around a slip (or a step without one)."""
    limits = limits or OutcomeLimits()
    step = Step(walk, stance)
    body, why = _body(walk, slip)
    toe = None if slip.slides else _toe_way(step)
    trailing = _trailing_way(step, slip)
    misstep = _misstep(step)
    flags = _toe_flags(toe, limits)
    if trailing is not None and trailing > limits.microslip:
        text = Message("the trailing foot slides by {way:.0f} mm", way=1e3 * trailing)
        flags += (Flag("trailing foot", text, True, trailing, limits.microslip, "m"),)
    if misstep:
        flags += (Flag("misstep", Message("misstep: {misstep}", misstep=misstep)),)
    return SlipCourse(body, why, toe, trailing, misstep, flags)


def push_off_flags(step: Step) -> tuple[Flag, ...]:
    """Return the caution of a toe that slides while its foot pushes off.

    In 10 recorded steps with toes it moves by up to 16 mm.
    """
    return _toe_flags(_toe_way(step), OutcomeLimits())


def _toe_flags(way: float | None, limits: OutcomeLimits) -> tuple[Flag, ...]:
    if way is None or way <= limits.microslip:
        return ()
    text = Message("the toe slides by {way:.0f} mm: a toe slip", way=1e3 * way)
    return (Flag("toe slip", text, True, way, limits.microslip, "m"),)


def _body(walk: Walkway, slip: Slip) -> tuple[str, Message]:
    """Recovery or fall by the height of the pelvis's markers."""
    if not slip.slides:
        return "", Message("no slide to recover from")
    markers = [
        marker
        for name, marker in walk.trial.markers.items()
        if (name in walk.pelvis or _PELVIS.search(name)) and marker.times is None
    ]
    if not markers:
        return "", Message("no marker of the pelvis")
    markers = [m for m in markers if len(m.positions) == len(markers[0].positions)]
    if all(m.missing.all() for m in markers):
        return "", Message("no marker of the pelvis is seen")
    time = markers[0].time
    near = frames_between(time, slip.contact - 0.6, slip.contact + _AFTER)
    time = time[near]
    heights = np.array([m.positions[near] @ walk.up for m in markers])
    seen = np.isfinite(heights).any(axis=0)
    height = np.full(len(time), np.nan)
    height[seen] = np.nanmean(heights[:, seen], axis=0)
    before = height[(time > slip.contact - 0.6) & (time < slip.contact)]
    after = height[(time >= slip.contact) & (time < slip.contact + _AFTER)]
    if not (np.isfinite(before).any() and np.isfinite(after).any()):
        return "", Message("the pelvis is not seen before and after contact")
    usual, lowest = float(np.nanmedian(before)), float(np.nanmin(after))
    down = Message(
        "the pelvis goes down to {share:.0f} % of its height", share=100 * lowest / usual
    )
    if lowest < FALL * usual:
        return "fall", Message(
            "{down}; a fall below {limit:.0f} % (assumed)", down=down, limit=100 * FALL
        )
    if float(after[np.isfinite(after)][-1]) < _RISEN * usual:
        return "", Message("{down} and is not up again when the record ends", down=down)
    return "recovery", down


def _toe_way(step: Step) -> float | None:
    stance, marker, up = step.stance, step.toe, step.walk.up
    begin, end = (stance.contact + share * stance.duration for share in (0.4, 0.9))
    return None if marker is None else _way(marker, begin, _lifts(marker, begin, end, up), up)


def _lifts(marker: Marker, begin: float, end: float, up: np.ndarray) -> float:
    """Return when a toe is 30 mm above its lowest place between two times, or the second (s)."""
    near = frames_between(marker.time, begin, end)
    height = marker.positions[near] @ up
    inside = np.isfinite(height)
    if inside.sum() < 3:
        return end
    lifted = inside & (height > height[inside].min() + 0.03)
    return float(marker.time[near][lifted][0]) if lifted.any() else end


def _trailing_way(step: Step, slip: Slip) -> float | None:
    stance, up = step.stance, step.walk.up
    other = {"left": "right", "right": "left"}.get(stance.side, "unknown")
    marker = None if other == "unknown" else step.markers.get(step.walk.toes.get(other, ""))
    if marker is None or not np.isfinite(slip.end):
        return None
    # The trailing foot stands on its toe until it lifts.
    if (~marker.missing[frames_between(marker.time, stance.contact, slip.end)]).sum() < 3:
        return None
    end = _lifts(marker, stance.contact, slip.end, up)
    return _way(marker, stance.contact, end, up)


def _way(marker: Marker, begin: float, end: float, up: np.ndarray) -> float | None:
    """Largest displacement (m) in the floor's plane from ``begin`` until ``end``."""
    if marker.times is not None:
        return None
    time, path = _bridged_between(begin - 0.3, end + 0.3, marker)
    if len(path) < 30 or not np.isfinite(path).all() or marker.rate < 2.3 * MARKER_FILTER.cutoff:
        return None
    path = low_passed(path, marker.rate, MARKER_FILTER)
    flat = path - np.outer(path @ up, up)
    inside = (time >= begin) & (time <= end)
    if inside.sum() < 2:
        return None
    return float(np.linalg.norm(flat[inside] - flat[inside][0], axis=1).max())


def _bridged_between(
    begin: float, end: float, marker: Marker, base: Marker | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Return times (n,) between two and a marker's place there, from ``base`` or the laboratory.

    Gaps of up to 0.1 s are bridged, also those that reach out of it.
    """
    gap = round(0.1 * marker.rate)
    near = frames_between(marker.time, begin, end, beside=gap + 3)
    path = marker.positions[near] - (0.0 if base is None else base.positions[near])
    time = marker.time[near]
    inside = (time > begin) & (time < end)
    return time[inside], bridge_gaps(path, gap)[0][inside]


def _misstep(step: Step) -> Message:
    angle = _foot_angle(step)
    if angle is not None and angle[1][0] < _TOE_FIRST:
        return Message("the toe comes down first ({angle:.0f} deg)", angle=np.degrees(angle[1][0]))
    return NOTHING
