"""The foot as a mass between what the body asks and what the floor gives."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from underfoot.core import InputError, Progress, Status, silent
from underfoot.core.arrays import Array
from underfoot.core.constants import GRAVITY
from underfoot.core.remark import Message

from .walker import Walker

STEP = 8e-3
"""s, longest step of the foot's motion."""
MOST_SWEEPS = 60
STILL, SLIDING = 1e-9, 1e-6  # m/s: a foot at rest, and one that still slides at the end


COLUMNS = (
    "time",
    "speed",
    "distance",
    "normal",
    "drive",
    "friction",
    "fluid_load",
    "shoe_angle",
    "work_in",
    "dissipated",
)
"""Arrays of a ``SlipMotion``, in their order."""


class Instant(Protocol):
    """Contact and film after a step."""

    @property
    def fluid_load(self) -> float:
        """Load carried by the fluid, N."""
        ...

    @property
    def usable(self) -> bool:
        """False when the solver gave up."""
        ...

    def friction(self, speed: float) -> float:
        """Return the friction force (N, 0 or more) if the foot slid forward at ``speed``."""
        ...


class FootContact(Protocol):
    """Contact and film under a sole, carried in time."""

    def advance(
        self, duration: float, *, normal_force: float, speed: float, shoe_angle: float
    ) -> Instant:
        """Carry on by ``duration``; load, speed and angle go linearly to the values given."""
        ...


@dataclass(frozen=True, slots=True)
class SlipMotion:
    """The foot against time; arrays (n,), SI.

    ``drive`` is r F, ``friction`` what the floor gives (N, against sliding), ``fluid_load`` the
    load on the film (N). ``work_in`` (of drive and brake), ``dissipated`` and ``kinetic`` are
    energies since contact (J), ``kinetic`` the energy itself. ``still_sliding`` says that the
    history ended first.
    """

    walker: Walker
    time: Array
    speed: Array
    distance: Array
    normal: Array
    drive: Array
    friction: Array
    fluid_load: Array
    shoe_angle: Array
    work_in: Array
    dissipated: Array
    status: Status
    model: str
    notes: tuple[str, ...] = ()

    @property
    def kinetic(self) -> Array:
        """Kinetic energy of the foot, J."""
        return 0.5 * self.walker.moving_mass * self.speed**2

    @property
    def still_sliding(self) -> bool:
        """True when the foot still slides at the end."""
        return bool(self.speed[-1] > SLIDING)

    @property
    def peak_speed(self) -> float:
        """Largest speed after the first minimum of the speed, m/s (no filter, no marker)."""
        return float(self.speed[self._first_minimum :].max())

    @property
    def slip_start(self) -> tuple[float, float] | None:
        """Time (s) and load (body weights) at the first minimum of the speed; None without one."""
        at = self._first_minimum
        if at < 0:
            return None
        return float(self.time[at]), float(self.normal[at]) / (self.walker.mass * GRAVITY)

    @property
    def _first_minimum(self) -> int:
        rising = np.flatnonzero(np.diff(self.speed) > 1e-12)
        return int(rising[0]) if rising.size else -1


def slip_motion(
    walker: Walker,
    contact: FootContact,
    *,
    step: float = STEP,
    model: str = "full",
    observe: Callable[[float, Instant], None] | None = None,
    progress: Progress = silent,
) -> SlipMotion:
    """Return the motion of a foot that lands on the floor and slides, or does not.

    m dV/dt = r(t) F(t) + m dV_dry/dt - FF(V, film, contact),  V >= 0

    by the trapezoidal rule for V with contact and film carried to the predicted speed. V_dry is
    the heel's speed on a dry floor, where friction is r F: the body brakes the landing heel. From
    slip start until it rests the foot takes on no more load than ``Walker.weight_transfer`` of that
    of the dry step, or what it bears already. At rest friction is what the body asks, up to its
    greatest value at the lowest speed. A foot is not pushed backward. It ends when the foot rests
    and braking is over, or with the history.

    Parameters:
        walker: Who steps.
        contact: Fresh, unloaded.
        step: Longest step, s.
        observe: Called with the time and the contact after every step.

    Raises:
        InputError: A step that is not positive or longer than a tenth of the history.
    """
    history = walker.step
    end = history.duration
    if not (math.isfinite(step) and 0 < step <= end / 10):
        raise InputError(f"{step:g} s", where="step", allowed=f"above 0, up to {end / 10:.3g} s")
    mass, over = walker.moving_mass, history.end_of_braking
    count = math.ceil(end / step)
    times = np.linspace(0.0, end, count + 1)
    normals, drives, angles = walker.demands(times)
    braked = np.diff(walker.dry_speed(times))
    at_start: float | None = None
    speed, distance = walker.heel_speed, 0.0
    acceleration = 0.0
    friction = 0.0
    work_in = dissipated = 0.0
    rows = [(0.0, speed, 0.0, 0.0, float(drives[0]), 0.0, 0.0, float(angles[0]), 0.0, 0.0)]
    status = Status.CONVERGED
    begin, begin_load = float(drives[0]), float(normals[0])
    for i in range(count):
        duration = float(times[i + 1] - times[i])
        normal, drive = float(normals[i + 1]), float(drives[i + 1])
        if at_start is not None and normal > at_start:
            share = max(at_start / normal, walker.weight_transfer)
            normal, drive = share * normal, share * drive
        brake = mass * float(braked[i]) / duration
        guess = max(speed + duration * acceleration + float(braked[i]), 0.0)
        instant = contact.advance(
            duration, normal_force=normal, speed=guess, shoe_angle=float(angles[i + 1])
        )
        if not instant.usable:
            status = Status.NOT_CONVERGED
            break
        if observe is not None:
            observe(float(times[i + 1]), instant)
        if i == 0 and normal > 0:
            # the floor has not been asked yet: as much friction for each newton as a step later
            friction = instant.friction(speed) * float(normals[0]) / normal
        net = begin + brake - friction
        new, friction_now = _new_speed(instant, speed, duration / (2 * mass), net, drive + brake)
        most = friction_now if new > STILL else instant.friction(0.0)
        moved = 0.5 * (speed + new) * duration
        mean_drive = 0.5 * (begin + drive) + brake
        work_in += mean_drive * moved
        # what friction really took, also when the foot came to rest within the step
        dissipated += (mean_drive - mass * (new - speed) / duration) * moved
        acceleration = (drive - friction_now) / mass if new > 0 else 0.0
        distance += moved
        excess = drive + brake - most
        if new <= STILL:
            at_start = None
        elif at_start is None and excess > 0:
            # where the forces balance: the minimum of the speed
            before = min(net, 0.0) / (min(net, 0.0) - excess)
            at_start = begin_load + before * (normal - begin_load)
        # a resting foot is held by as much as is asked of the most that the floor gives
        speed, friction, begin, begin_load = new, most, drive, normal
        rows.append(
            (
                float(times[i + 1]),
                speed,
                distance,
                normal,
                drive,
                friction_now,
                instant.fluid_load,
                float(angles[i + 1]),
                work_in,
                dissipated,
            )
        )
        progress("Slipping", float(times[i + 1]) / end, None)
        if speed <= STILL and times[i + 1] > over:
            break
    notes = still_sliding_notes(speed, end) if status is Status.CONVERGED else ()
    columns: Any = np.array(rows).T  # in the order of the fields
    return SlipMotion(walker, *columns, status=status, model=model, notes=notes)


def still_sliding_notes(speed: float, end: float) -> tuple[str, ...]:
    """Return the caution about a foot that still slides (m/s) when its history ends (s)."""
    if speed <= SLIDING:
        return ()
    return (
        Message(
            "still sliding at {speed:.2f} m/s when the history of {end:.2f} s ends: "
            "distance is a lower bound",
            speed=speed,
            end=end,
        ),
    )


def _new_speed(
    instant: Instant, speed: float, share: float, net: float, drive: float
) -> tuple[float, float]:
    """Return speed and friction at the end of a step; friction at rest is what is asked.

    Root of V - speed - share (net + drive - FF(V)) by the Illinois form of the secant method,
    between rest and the speed without friction.
    """
    most = instant.friction(0.0)
    if speed <= STILL:
        if drive <= most:
            return 0.0, max(drive, 0.0)
        net = max(net, 0.0)

    def excess(v: float, friction: float) -> float:
        return v - speed - share * (net + drive - friction)

    low, high = 0.0, speed + share * (net + drive)
    at_low = excess(low, most)
    if at_low >= 0 or high <= STILL:
        return 0.0, min(max(drive, 0.0), most)
    friction = instant.friction(high)
    at_high = excess(high, friction)
    new, side = high, 0
    for _ in range(MOST_SWEEPS):
        if at_high - at_low <= 0:
            break
        new = (low * at_high - high * at_low) / (at_high - at_low)
        friction = instant.friction(new)
        value = excess(new, friction)
        if abs(value) < 1e-12 or high - low < 1e-12:
            break
        if value < 0:
            low, at_low = new, value
            at_high = 0.5 * at_high if side < 0 else at_high
            side = -1
        else:
            high, at_high = new, value
            at_low = 0.5 * at_low if side > 0 else at_low
            side = 1
    return new, friction
