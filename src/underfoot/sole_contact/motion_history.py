"""A sole that follows a history of load, sliding speed and shoe angle."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from underfoot.core import InputError, Progress, Status, silent
from underfoot.core.arrays import Array
from underfoot.core.remark import Message
from underfoot.core.threads import threads_limited
from underfoot.rough_contact.pressure_gap_law import PressureGapLaw
from underfoot.shoe.geometry import SoleMap

from .compliance import Compliance
from .lug_edges import LugInlet
from .sole_state import SoleState, SolverSettings
from .solver import SoleContact, held_on, longest_step, passing_time, with_history
from .stepping import Reporting, SlidingSole

STEPS = 3.5
"""Inner steps into which the whole history falls at least, over the time resolution; every point of
the history ends one."""
LANDED = 0.01
"""s before a history, at most, in which the load comes up that stands at its first instant: as the
first 314 N of the recorded steps do. A shorter ``rise_time`` of the settings holds."""


@dataclass(frozen=True, slots=True)
class MotionHistory:
    """What the foot does: arrays (n,) with n of 2 or more, straight lines between the points.

    ``time`` s from 0, rising; ``normal_force`` N, 0 or more, somewhere above; ``speed`` m/s along
    +x (negative backward); ``shoe_angle`` rad, toe up positive.
    """

    time: Array
    normal_force: Array
    speed: Array
    shoe_angle: Array

    def __post_init__(self) -> None:
        shape = np.shape(self.time)
        for name in self.__slots__:
            values = np.asarray(getattr(self, name), dtype=float)
            if values.shape != shape or values.ndim != 1 or values.size < 2:
                raise InputError(
                    Message("{label} has shape {shape}", label=name, shape=str(values.shape)),
                    where=f"history.{name}",
                    allowed=Message(
                        "one row as long as time, {shape}, of 2 or more", shape=str(shape)
                    ),
                )
            if not np.isfinite(values).all():
                raise InputError("a value is not finite", where=f"history.{name}")
            object.__setattr__(self, name, values)
        if self.time[0] != 0 or not (np.diff(self.time) > 0).all():
            raise InputError(
                Message("time goes from {time:g} s and must rise", time=self.time[0]),
                where="history.time",
                allowed="0 first, then rising",
            )
        if (self.normal_force < 0).any() or not (self.normal_force > 0).any():
            raise InputError(
                Message(
                    "the load goes from {min:g} to {max:g} N",
                    min=self.normal_force.min(),
                    max=self.normal_force.max(),
                ),
                where="history.normal_force",
                allowed="0 N or more, somewhere above",
            )


@threads_limited(1)
def solve_history(
    sole: SoleMap,
    compliance: Compliance,
    law: PressureGapLaw,
    history: MotionHistory,
    *,
    viscosity: float | None,
    map_angle: float,
    settings: SolverSettings | None = None,
    progress: Progress = silent,
    watch: Callable[[SoleState], None] | None = None,
    inlet: LugInlet | None = None,
) -> SoleContact:
    """Return the contact and film at the end of a history, with what it went through.

    ``later`` holds what drives the sole at the end.

    Parameters:
        sole, compliance, law, viscosity, settings, progress, watch, inlet: As in ``SlidingSole``.
        history: Load, speed and shoe angle against time.
        map_angle: Shoe angle (rad) at which ``sole`` was made; the sole rolls from there.

    Raises:
        InputError: A history that can't be; an angle too far from the map's.
        ConvergenceError: Not even the first instant could be solved.
    """
    sliding = SlidingSole(
        sole,
        compliance,
        law,
        viscosity=viscosity,
        settings=settings,
        shoe_angle=map_angle,
        typical_force=float(history.normal_force.max()),
        reporting=Reporting(progress, "Following the motion", float(history.time[-1]), watch),
        inlet=inlet,
    )
    rows = np.column_stack([history.time, history.normal_force, history.speed, history.shoe_angle])
    _, force, speed, angle = (float(value) for value in rows[0])
    before = min(sliding.settings.rise_time, LANDED)
    sliding.begin(normal_force=force, speed=speed, shoe_angle=angle, rise_time=before)
    duration, fastest = float(history.time[-1]), float(np.abs(history.speed).max())
    passing = math.inf if viscosity is None else passing_time(sole, fastest)
    longest = min(duration / STEPS, longest_step(duration, passing))
    longest /= sliding.settings.time_resolution
    state = None
    for before, after in pairwise(rows):
        _, force, speed, angle = (float(value) for value in after)
        state = sliding.advance(
            float(after[0] - before[0]),
            normal_force=force,
            speed=speed,
            shoe_angle=angle,
            longest_step=longest,
        )
        if state.status is not Status.CONVERGED:
            break
    assert state is not None  # a history has two points or more
    return held_on(with_history(state, sliding), sliding)
