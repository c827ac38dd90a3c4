"""Whole-shoe contact with fluid: a sole pressed and slid over a flooded floor."""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from underfoot.core import ConvergenceError, Progress, silent
from underfoot.core.threads import threads_limited
from underfoot.rough_contact.pressure_gap_law import PressureGapLaw
from underfoot.shoe.geometry import SoleMap

from ._solver_checks import check_demand, check_times
from .compliance import Compliance
from .lug_edges import LugInlet
from .march import Counts, History
from .sole_state import SoleState, SolverSettings
from .stepping import Bookmark, Reporting, SlidingSole

AFTER = 3.0  # lengths that a sole slides in a step after a change
PIECES, FINEST = 6.0, 8.0
"""Pieces of land that the floor passes in as many time steps as a stage takes at least, and how
many times as many it takes at most: with longer steps the film of lugs near starvation is off by up
to a fifth (docs/guide/performance.md)."""


@dataclass(frozen=True, slots=True)
class SoleContact(SoleState):
    """The last instant of a run (see ``SoleState``) with its history in time and its cost.

    ``instant`` is what ``solve_on`` goes on from. ``later``: what becomes of it where load, speed
    and shoe angle are held for as long again, and for a sole's length of sliding at least; None
    where it is the steady state, or not known.
    """

    history: History
    counts: Counts
    instant: Bookmark
    later: SoleState | None = None


@threads_limited(1)
def solve_sliding(
    sole: SoleMap,
    compliance: Compliance,
    law: PressureGapLaw,
    *,
    viscosity: float | None,
    speed: float,
    normal_force: float,
    settings: SolverSettings | None = None,
    progress: Progress = silent,
    watch: Callable[[SoleState], None] | None = None,
    inlet: LugInlet | None = None,
) -> SoleContact:
    """Return contact pressure, fluid pressure and film under a sole pressed and slid.

    The load rises linearly over ``settings.rise_time`` and stays; the result is the state at
    ``settings.end_time``, with what becomes of it ``later``, or the steady one. Equations:
    ``SlidingSole``.

    Parameters:
        sole: Undeformed sole over the floor.
        compliance: Surface deflection under pressure on the same grid.
        law: Asperity pressure and flow factor against the mean gap.
        viscosity: Pa s; None for a dry floor, which is solved as the load rises, without time.
        speed: Sliding speed of the shoe along +x, m/s; negative slides backward, 0 only squeezes.
        normal_force: Full load, N.
        settings: Start, times and accuracy.
        progress: Receives stage, fraction of the time and residual; an exception it raises stops
            the work.
        watch: Receives the state after every inner step.
        inlet: As in ``SlidingSole``.

    Raises:
        InputError: A value that is not finite or not physical.
        ConvergenceError: Not even the first instant could be solved.
    """
    settings = settings or SolverSettings()
    check_demand(settings.rise_time, normal_force, speed, None, rising=True)
    check_times(settings)
    dry = viscosity is None  # without memory: it is done when the load is there
    end = settings.rise_time if dry else settings.end_time
    sliding = SlidingSole(
        sole,
        compliance,
        law,
        viscosity=viscosity,
        settings=settings,
        typical_force=normal_force,
        reporting=Reporting(progress, end_time=end, watch=watch),
        inlet=inlet,
    )
    rise = settings.rise_time
    passing = math.inf if dry else passing_time(sole, speed)
    state = sliding.advance(
        rise,
        normal_force=normal_force,
        speed=speed,
        longest_step=longest_step(rise, passing) / settings.time_resolution,
    )
    counts = sliding.counts
    left = settings.most_time_steps - counts.time_steps - counts.rejected
    if not dry and state.status.usable and left > 0:
        if end is None:
            state = sliding.settle(normal_force=normal_force, speed=speed, most_steps=left)
        elif end > rise:
            state = sliding.advance(
                end - rise,
                normal_force=normal_force,
                speed=speed,
                longest_step=longest_step(max(end - rise, rise), passing)
                / settings.time_resolution,
                most_steps=left,
            )
    now = with_history(state, sliding)
    return now if dry or end is None else held_on(now, sliding)


def held_on(now: SoleContact, sliding: SlidingSole) -> SoleContact:
    """Return a contact with what it becomes ``later``, where all that drives the sole is held."""
    duration = max(now.time, sliding.sliding_time(now.speed))
    if not now.status.usable or sliding.viscosity is None:
        return now
    longest = longest_step(duration, passing_time(sliding.sole, now.speed))
    sliding.close_history()
    later = sliding.advance(
        duration,
        normal_force=now.normal_force,
        speed=now.speed,
        longest_step=longest / sliding.settings.time_resolution,
    )
    return replace(now, later=later if later.status.usable else None)


def passing_time(sole: SoleMap, speed: float) -> float:
    """Return the time (s) in which the floor passes the piece of land that a cell lies in.

    Mean over the cells of the land; infinite at rest.
    """
    land = np.pad(sole.land & sole.inside, ((1, 1), (0, 0))).astype(np.int8)
    ends = np.diff(land.T, axis=1)  # pieces along the sliding follow one another in each row
    lengths = np.nonzero(ends < 0)[1] - np.nonzero(ends > 0)[1]
    length = float((lengths**2).sum()) / float(lengths.sum()) * sole.spacing
    return length / abs(speed) if speed else math.inf


def longest_step(stage: float, passing: float) -> float:
    """Return the longest time step (s, at a time resolution of 1) in a stage of so many seconds."""
    return min(max(PIECES * passing, stage / FINEST), stage)


@threads_limited(1)
def solve_on(
    start: SoleContact,
    sole: SoleMap,
    compliance: Compliance,
    law: PressureGapLaw,
    *,
    viscosity: float | None,
    speed: float,
    normal_force: float,
    turn: float = 0.0,
    duration: float,
    steps: int = 1,
    settings: SolverSettings | None = None,
    inlet: LugInlet | None = None,
) -> list[SoleContact]:
    """Return what a finished contact becomes under a changed sole, fluid, load or speed.

    The change is there at the end of the first implicit step: an instant of another history, which
    forgets its start as the film under a lug does. Far cheaper than a march from the air.

    Parameters:
        start: Contact of a sole on the same grid.
        sole, compliance, law, viscosity, speed, normal_force: As in ``solve_sliding``, changed.
        turn: Change of the shoe angle since the map was made, rad.
        duration: Of one step, s; a sole that slides takes at most ``AFTER`` times its length.
        steps: How many; the contact after each is returned.
        inlet: As in ``SlidingSole``.

    Raises:
        InputError: Another grid.
        ConvergenceError: The step could not be made.
    """
    sliding = SlidingSole(
        sole,
        compliance,
        law,
        viscosity=viscosity,
        settings=settings,
        typical_force=normal_force,
        before=start.instant.march[0],
        inlet=inlet,
    )
    if speed:  # the film has its new state then, and longer steps often fail
        duration = min(duration, AFTER * sliding.sliding_time(speed))
    sliding.take_over(start.instant, duration)
    found = []
    for step in range(steps):
        state = sliding.advance(
            duration,
            normal_force=normal_force,
            speed=speed,
            shoe_angle=turn or None,
            # the change in two parts: one that lifts the sole is too much for Newton's method
            longest_step=duration / 2 if step == 0 else None,
        )
        if not state.status.usable:
            raise ConvergenceError(
                "the step to the changed case could not be made",
                history=state.residuals,
                where="sole_contact",
                remedy="Run the changed case",
            )
        found.append(with_history(state, sliding))
    return found


def with_history(state: SoleState, sliding: SlidingSole) -> SoleContact:
    """Return a state with the history and the cost of the sole that it comes from."""
    solved = {part.name: getattr(state, part.name) for part in fields(SoleState)}
    return SoleContact(
        **solved,
        history=sliding.history,
        counts=replace(sliding.counts),
        instant=sliding.bookmark(),
    )
