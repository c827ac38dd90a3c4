"""The walk around a step: speed, length, cadence, foot angle, heel speed; curves over stance."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .axes import Axes, marker_velocity, toe_candidates
from .filters import LowPass, bridged, low_passed
from .heel import heel_motion
from .plates import plate_named
from .stance import Stance
from .trial import Marker, Trial

FLAT = (0.3, 0.5)  # share of the stance in which the foot lies flat
PERCENT = np.arange(101)
_FOOT_FILTER = LowPass(cutoff=10.0)


@dataclass(frozen=True, slots=True)
class GaitContext:
    """What a reviewer asks about a step; SI, None where it was not recorded.

    ``walking_speed`` of the body during the stance; ``step_length`` along the walk and
    ``step_time`` since the other foot's contact; ``cadence`` 1 / step time (steps a second);
    ``foot_angle`` between sole and floor at contact, toe up positive; ``heel_speed`` of the heel
    at contact, in the plane of the floor.
    """

    walking_speed: float | None = None
    step_length: float | None = None
    step_time: float | None = None
    cadence: float | None = None
    foot_angle: float | None = None
    heel_speed: float | None = None


def gait_context(
    trial: Trial,
    stance: Stance,
    found: Sequence[Stance],
    axes: Axes,
    heels: Mapping[str, str] | None = None,
) -> GaitContext:
    """Return the walk around one of the stances ``found`` in a trial."""
    walk = marker_velocity(trial, stance.contact, stance.toe_off, axes.up)
    length, time = _step(trial, stance, found)
    angle = foot_angle(trial, stance, axes)
    return GaitContext(
        walking_speed=None if walk is None else _number(float(np.linalg.norm(walk))),
        step_length=length,
        step_time=time,
        cadence=1.0 / time if time else None,
        foot_angle=None if angle is None else _number(float(angle[1][0])),
        heel_speed=heel_speed(trial, stance, axes),
    )


def heel_speed(trial: Trial, stance: Stance, axes: Axes) -> float | None:
    """Return the heel's speed at contact in the plane of the floor (m/s), None where unknown."""
    if not stance.heel or trial.marker(stance.heel).times is not None:
        return None
    motion = heel_motion(trial.marker(stance.heel), axes.up)
    return _number(float(np.interp(stance.contact, motion.time, motion.speed)))


def _step(
    trial: Trial, stance: Stance, found: Sequence[Stance]
) -> tuple[float | None, float | None]:
    """Return length and time since the contact of the other foot (0.25 to 1.5 s before)."""
    before = [
        other
        for other in found
        if 0.25 < stance.contact - other.contact < 1.5
        and {other.side, stance.side} == {"left", "right"}
    ]
    if not before:
        return None, None
    other = max(before, key=lambda one: one.contact)
    time = stance.contact - other.contact
    if not (stance.heel and other.heel) or stance.walking is None:
        return None, time
    first, second = (_standing_place(trial.marker(one.heel), one) for one in (other, stance))
    return _number(float((second - first) @ stance.walking)), time


def _standing_place(heel: Marker, stance: Stance) -> np.ndarray:
    """Median place (3,) of a heel between 10 and 40 % of its stance; NaN where it is not seen."""
    share = (heel.time - stance.contact) / max(stance.duration, 1e-9)
    inside = (share > 0.1) & (share < 0.4) & ~heel.missing
    return np.median(heel.positions[inside], axis=0) if inside.sum() > 2 else np.full(3, np.nan)


def foot_angle(trial: Trial, stance: Stance, axes: Axes) -> tuple[np.ndarray, np.ndarray] | None:
    """Return times (n,) from contact to toe off and the angle of sole and floor (rad), or None.

    From the line heel marker to toe marker of the same side, low-passed at 10 Hz, against its
    angle while the foot lies flat (30 to 50 % of stance).
    """
    toes = toe_candidates(trial)[stance.side] if stance.side != "unknown" else []
    if not (stance.heel and toes) or stance.walking is None:
        return None
    heel, toe = trial.marker(stance.heel), trial.marker(toes[0])
    if len(heel.positions) != len(toe.positions) or heel.rate != toe.rate or heel.times is not None:
        return None
    line, _ = bridged(toe.positions - heel.positions, round(0.1 * heel.rate))
    near = (heel.time > stance.contact - 0.2) & (heel.time < stance.toe_off + 0.2)
    time, line = heel.time[near], line[near]
    if len(line) < 30 or not np.isfinite(line).all():
        return None
    if heel.rate > 2.3 * _FOOT_FILTER.cutoff:
        line = low_passed(line, heel.rate, _FOOT_FILTER)
    tilt = np.unwrap(np.arctan2(line @ axes.up, line @ stance.walking))
    share = (time - stance.contact) / stance.duration
    flat = (share > FLAT[0]) & (share < FLAT[1])
    if not flat.any():
        return None
    steps = np.arange(stance.contact, stance.toe_off, 1.0 / heel.rate)
    return steps, np.interp(steps, time, tilt - np.median(tilt[flat]))


def stance_curves(
    trial: Trial, stance: Stance, ratio: np.ndarray, low_pass: LowPass, axes: Axes
) -> dict[str, np.ndarray]:
    """Return forces (N) and ratio at 0, 1 ... 100 % of a stance, (101,) each.

    ``vertical`` (on a ramp: normal to it), ``braking`` (positive when the floor pushes backward),
    ``to the left``, ``ratio``.
    """
    plate = plate_named(trial, stance.plate)
    force = low_passed(plate.force, plate.rate, low_pass)[stance.start : stance.stop]
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
