"""Gait histories out of recordings: force plates, and heel and toe markers where there are any."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.core.constants import GRAVITY
from underfoot.trials.readers import read_trial
from underfoot.trials.recording.signals import low_passed
from underfoot.trials.recording.trial import Marker, Trial
from underfoot.trials.walking.body_weight import body_mass
from underfoot.trials.walking.events import Stance
from underfoot.trials.walking.gait import RcofDefinition, RequiredFriction, required_frictions
from underfoot.trials.walking.gait_context import FLAT, heel_speed
from underfoot.trials.walking.slips import HeelMotion, heel_motion
from underfoot.trials.walking.walkway import Walkway, of_walkway, walkway_of

from .gait import LEAST_LOAD, GaitHistory

DUTY = 0.62  # stance over stride of level walking (assumed, textbook value)
RATE = 200.0  # Hz of the tables
_TOE = re.compile(r"toe$|mt2$|mt1$", re.IGNORECASE)


def recorded_histories(path: Path | str, *, mass: float | None = None) -> list[GaitHistory]:
    """Return a history for every accepted step of a recording (any file ``trials`` reads).

    Parameters:
        path: C3D, MOT or table with force plates.
        mass: Of the person, kg; None takes the file's, else body weight is estimated as mean normal
            force of the stance x 2 x 0.62 (two stances of 62 % of a stride carry it together).

    Raises:
        InputError: No accepted step; the reasons are listed.
    """
    walk = walkway_of(read_trial(Path(path)))
    steps = required_frictions(walk)
    histories = [
        step_history(walk, step, mass=mass, name=f"{Path(path).stem} {step.stance.plate}")
        for step in steps
        if step.measurement.value is not None
    ]
    if not histories:
        reasons = [s.stance.reason or s.measurement.reason for s in steps] or ["no contact"]
        raise InputError(
            "no step can be used: " + "; ".join(dict.fromkeys(reasons)), where=str(path)
        )
    return histories


@of_walkway
def step_history(
    walk: Walkway, step: RequiredFriction, *, mass: float | None = None, name: str = ""
) -> GaitHistory:
    """Return one accepted step as a history: forces low-passed as for RCOF, 200 samples a second.

    Foot angle: from the line heel marker to toe marker (or first or second metatarsal head of the
    same side), against its angle while the foot lies flat (30 to 50 % of stance). Heel velocity:
    ``heel_over_floor``.
    """
    stance = step.stance
    assert stance.walking is not None  # an RCOF has one
    plate = walk.plate(stance.plate)
    force = low_passed(plate.force, plate.rate, RcofDefinition().filter)
    force = force[stance.start : stance.stop]
    normal = np.maximum(force @ walk.up, 0.0)
    shear = force - np.outer(force @ walk.up, walk.up)
    own = mass or body_mass(walk.trial)
    weight = own * GRAVITY if own else float(normal.mean()) * 2 * DUTY
    since = np.arange(len(normal)) / plate.rate
    size = np.linalg.norm(shear, axis=1)
    braking = np.where(shear @ stance.walking < 0, size, -size)
    ratio = np.where(normal > LEAST_LOAD * weight, braking / np.maximum(normal, 1.0), 0.0)
    time = np.arange(0.0, since[-1] + 0.5 / plate.rate, 1 / RATE)
    how = f"{own:g} kg" if own else f"estimated {weight:.0f} N: mean normal force x 2 x {DUTY:g}"
    return GaitHistory(
        name or stance.plate,
        time,
        np.interp(time, since, normal / weight),
        np.interp(time, since, ratio),
        _foot_angle(walk, stance, time),
        walking_speed=_walking_speed(walk, stance),
        heel_speed=heel_speed(walk, stance),
        heel_velocity=_heel_velocity(walk, stance, time),
        source=how,
    )


def _foot_angle(walk: Walkway, stance: Stance, time: Array) -> Array | None:
    """Return the foot's angle at ``time`` since contact, where heel and toe are recorded."""
    heel, toe = _heel_and_toe(walk, stance)
    if heel is None or toe is None:
        return None
    line = toe.positions - heel.positions
    tilt = np.arctan2(line @ walk.up, line @ stance.walking)
    share = (heel.time - stance.contact) / stance.duration
    flat = (share > FLAT[0]) & (share < FLAT[1])
    if not flat.any():
        return None
    angle = np.interp(time + stance.contact, heel.time, tilt - np.median(tilt[flat]))
    return angle if np.isfinite(angle).all() else None


def _heel_velocity(walk: Walkway, stance: Stance, time: Array) -> Array | None:
    """Return the heel's velocity over the floor at ``time``, where heel and toe are recorded."""
    heel, toe = _heel_and_toe(walk, stance)
    corners = walk.plate(stance.plate).corners
    if heel is None or toe is None or corners is None or stance.walking is None:
        return None
    motion, up = heel_motion(heel, walk.up), walk.up
    level = corners.mean(axis=0) @ up
    own = heel_over_floor(motion, heel_motion(toe, up), up, stance.walking, level)
    velocity = np.interp(time + stance.contact, motion.time, own)
    return velocity if np.isfinite(velocity).all() else None


def heel_over_floor(
    heel: HeelMotion, toe: HeelMotion, up: Array, walking: Array, level: float
) -> Array:
    """Return the velocity (n,) along ``walking`` of a heel under its marker, m/s.

    v - w h: marker's velocity less its height above the floor (``level``, m) times the rate at
    which the line from heel to toe marker falls. A heel that rolls without sliding has 0.
    """
    line, turning = toe.position - heel.position, toe.velocity - heel.velocity
    along, rise = line @ walking, line @ up
    falling = (rise * (turning @ walking) - along * (turning @ up)) / (along**2 + rise**2)
    return heel.velocity @ walking - falling * np.maximum(heel.position @ up - level, 0.0)


def _heel_and_toe(walk: Walkway, stance: Stance) -> tuple[Marker | None, Marker | None]:
    """Return both markers as seen from the surface: on a belt, from the belt."""
    toe_name = _toe_of(walk.trial, stance.heel) if stance.heel else None
    heel, toe = (
        walk.marker(name, stance.plate, stance.contact) if name else None
        for name in (stance.heel, toe_name)
    )
    same = heel is not None and toe is not None and len(toe.positions) == len(heel.positions)
    return heel, toe if same else None


def _toe_of(trial: Trial, heel: str) -> str | None:
    side = heel.strip()[0].lower()
    names = [n for n in trial.markers if _TOE.search(n) and n.strip()[0].lower() == side]
    names.sort(key=lambda n: (not n.lower().endswith("toe"), not n.lower().endswith("mt2")))
    return names[0] if names else None


def _walking_speed(walk: Walkway, stance: Stance) -> float | None:
    velocity = walk.body_velocity(stance.plate, stance.contact, stance.toe_off)
    if velocity is None or not np.isfinite(velocity).all():
        return None
    speed = float(np.linalg.norm(velocity))
    return speed if 0.3 < speed < 3 else None
