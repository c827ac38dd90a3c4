"""Motions of the foot with a known exact answer."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

from slip_floors import WEIGHT, Floor, constant, dry_sole, walker
from underfoot.core import InputError, Status
from underfoot.slip.dynamics import (
    GaitHistory,
    SlipMotion,
    Walker,
    packaged_histories,
    slip_motion,
)
from underfoot.slip.dynamics._kernels import reduced as kernel
from underfoot.slip.dynamics.motion import COLUMNS


def test_without_friction_speed_is_the_integral_of_the_drive():
    person = walker(packaged_histories()[0], 0.22, heel_speed=1.0)
    for motion in (slip_motion(person, Floor()), dry_sole(0.0).motion(person)):
        gained = np.concatenate(
            [[0.0], np.cumsum(0.5 * (motion.drive[1:] + motion.drive[:-1]) * np.diff(motion.time))]
        )
        assert np.abs(motion.speed - 1.0 - gained / person.moving_mass).max() < 1e-12
        assert motion.still_sliding
        assert "lower bound" in motion.notes[0]


def test_without_friction_drive_and_brake_the_heel_keeps_its_speed():
    person = walker(constant(0.2), 0.0)
    for motion in (slip_motion(person, Floor()), dry_sole(0.0).motion(person)):
        assert np.abs(motion.speed - 0.3).max() < 1e-14
        assert motion.still_sliding


def test_the_brake_alone_stops_the_heel_with_its_time_constant():
    person = walker(constant(0.2), 0.0, heel_brake="constant", brake_time=0.02)
    for motion in (slip_motion(person, Floor()), dry_sole(0.0).motion(person)):
        assert np.abs(motion.speed - 0.3 * np.exp(-motion.time / 0.02)).max() < 1e-9  # rest
        kept = 0.5 * person.moving_mass * (0.3 * np.exp(-motion.time / 0.02)) ** 2
        assert np.abs(motion.work_in - (kept - kept[0])).max() < 1e-12
        assert motion.slip_start is None


@dataclass
class AsDry:
    """A floor that gives the shear of the dry step, whatever the speed."""

    person: Walker
    time: float = 0.0
    fluid_load: float = 0.0
    usable: bool = True

    def advance(self, duration, *, normal_force, speed, shoe_angle):
        self.time += duration
        return AsDry(self.person, self.time)

    def friction(self, speed):
        return float(self.person.demands(np.array([self.time]))[1][0])


@pytest.mark.parametrize("history", packaged_histories(), ids=lambda history: history.name)
def test_friction_as_on_the_dry_floor_gives_the_dry_motion(history):
    """By drive and brake together: the equation that the brake is defined by."""
    person = Walker(history, rcof=0.2, walking_speed=1.2, weight_transfer=0.3)
    motion = slip_motion(person, AsDry(person), step=5e-3)
    rests = int(np.argmax(motion.speed == 0.0))
    assert rests >= 2
    # in the first step friction goes with the load, not with the dry shear
    change = np.diff(motion.speed - person.dry_speed(motion.time))[1 : rests - 1]
    assert np.abs(change).max(initial=0.0) < 1e-12


def test_constant_friction_as_on_the_dry_floor_gives_the_dry_motion():
    person = walker(constant(0.2), 0.2, heel_brake="constant", brake_time=0.011)
    for motion in (slip_motion(person, Floor(cof=0.2)), dry_sole(0.2).motion(person)):
        assert np.abs(motion.speed - person.dry_speed(motion.time)).max() < 1e-9


def test_a_slipping_foot_takes_on_its_share_of_the_load():
    time = np.linspace(0, 0.5, 201)
    history = GaitHistory("rising", time, 0.2 + 2.0 * time, np.full(201, 0.2))
    person = walker(history, 0.2, heel_brake="constant", brake_time=0.02, weight_transfer=0.4)
    for motion in (
        slip_motion(person, Floor(cof=0.1), step=5e-4),
        dry_sole(0.1).motion(person, step=5e-4),
    ):
        # forces balance where the brake, m V0 / T exp(-t / T), has fallen to (0.2 - 0.1) F
        fine = np.linspace(0, 0.1, 100001)
        brake = person.moving_mass * 0.3 / 0.02 * np.exp(-fine / 0.02)
        begin = fine[np.argmax(brake < 0.1 * (0.2 + 2.0 * fine) * WEIGHT)]
        at_start = 0.2 + 2.0 * begin
        taken = np.maximum(0.4 * (0.2 + 2.0 * motion.time), at_start)
        later = motion.time > begin + 2e-3
        # slip start lies within a step, in which the load grows by 2 x 5e-4
        assert np.abs(motion.normal / WEIGHT - taken)[later].max() < 1e-3
        assert motion.drive[later] == pytest.approx(0.2 * motion.normal[later])
        assert motion.slip_start == pytest.approx((begin, at_start), abs=2e-3)


@pytest.mark.parametrize("cof", [0.25, 0.6])
def test_friction_above_the_demand_stops_the_heel_where_it_should(cof):
    person = walker(constant(0.2), 0.2)
    stop = 0.5 * 0.3**2 * person.moving_mass / ((cof - 0.2) * WEIGHT)
    full = slip_motion(person, Floor(cof=cof), step=1e-3)
    fast = dry_sole(cof).motion(person, step=1e-3)
    for motion in (full, fast):
        assert motion.speed[-1] == 0.0
        assert not motion.still_sliding
        # within what the foot moves in the step in which it stops
        assert motion.distance[-1] == pytest.approx(stop, abs=0.3 * 1e-3)
        assert motion.friction[-1] == pytest.approx(0.2 * WEIGHT)
    assert np.abs(full.speed - fast.speed[: full.speed.size]).max() < 1e-9


def test_friction_below_the_demand_lets_it_accelerate():
    person = walker(constant(0.2), 0.2)
    rate = (0.2 - 0.05) * WEIGHT / person.moving_mass
    for motion in (slip_motion(person, Floor(cof=0.05)), dry_sole(0.05).motion(person)):
        assert np.abs(motion.speed - 0.3 - rate * motion.time).max() < 1e-10
        assert motion.distance[-1] == pytest.approx(0.3 * 0.5 + 0.5 * rate * 0.25, rel=1e-9)


def test_drag_ends_at_its_terminal_speed():
    person = walker(constant(0.2, 2.0), 0.2)
    motion = slip_motion(person, Floor(drag=200.0))
    assert motion.speed[-1] == pytest.approx(0.2 * WEIGHT / 200.0, rel=1e-6)


def test_a_resting_foot_starts_when_the_demand_passes_friction():
    time = np.linspace(0, 0.5, 201)
    history = GaitHistory("ramp", time, np.ones(201), 0.4 * time)
    person = Walker(history, mass=70, rcof=0.2, heel_speed=0.0, effective_mass=8 / 70)
    asked = person.demands(time)[1] / WEIGHT
    start = float(np.interp(0.1, asked, time))
    for motion in (
        slip_motion(person, Floor(cof=0.1), step=1e-3),
        dry_sole(0.1).motion(person, step=1e-3),
    ):
        moving = motion.time[np.argmax(motion.speed > 0)]
        assert start <= moving <= start + 2.5e-3
        exact = 0.5 * 0.8 * (motion.time - start) ** 2 * WEIGHT / person.moving_mass
        exact = np.where(motion.time > start, exact * asked[-1] / 0.4, 0.0)
        assert np.abs(motion.speed - exact).max() < 0.02 * exact.max()


def test_film_of_the_reduced_model_squeezes_as_h_over_root_of_time():
    constants = np.ones(kernel.COUNT)
    constants[[kernel.AREA, kernel.AREA_POWER, kernel.AREA_ANGLE]] = 1e-3, 0.0, 0.0
    constants[kernel.STIFFNESS], constants[kernel.DECAY] = 1e-30, 1e-6  # no contact
    constants[[kernel.LEAK_ANGLE, kernel.WEDGE_ANGLE]] = 0.0  # the angle stays at its middle
    constants[kernel.LEAK], constants[kernel.START] = 1e5, 50e-6
    times = np.linspace(0, 0.3, 601)
    load = np.full(times.size, 500.0)
    zero = np.zeros(times.size)
    table = np.array([0.0, 1.0]), np.array([0.2, 0.2])
    film = kernel.carry_slip(
        times, load, zero, zero, zero, 1.0, zero, 8.0, constants, 0.219, 6e-4, *table, 0.0
    )[1]
    rate = 1e5 * (500.0 / 1e-3) / (12 * 0.219)
    exact = 1 / np.sqrt(1 / (50e-6) ** 2 + 2 * rate * times)
    assert np.abs(film / exact - 1).max() < 1e-4


def test_wedge_holds_the_film_that_its_inlet_draws_in():
    constants = np.ones(kernel.COUNT)
    constants[[kernel.AREA, kernel.AREA_POWER, kernel.AREA_ANGLE]] = 1e-3, 0.0, 0.0
    constants[kernel.STIFFNESS], constants[kernel.DECAY] = 1e-30, 1e-6
    constants[[kernel.LEAK_ANGLE, kernel.WEDGE_ANGLE]] = 0.0  # the angle stays at its middle
    constants[[kernel.LEAK, kernel.START, kernel.WEDGE, kernel.LENGTH]] = 1e-9, 50e-6, 30.0, 0.03
    times = np.linspace(0, 3.0, 3001)
    load, zero, speed = (np.full(times.size, v) for v in (500.0, 0.0, 0.5))
    table = np.array([0.0, 1.0]), np.array([0.2, 0.2])
    out = kernel.carry_slip(
        times, load, zero, zero, speed, 1.0, speed, 8.0, constants, 0.219, 6e-4, *table, 0.0
    )
    inlet = 30.0 * 0.219 * 0.5 / 5e5
    assert out[1][-1] == pytest.approx(1 / (1 / 6e-4 + 1 / inlet), rel=1e-6)
    assert out[2][-1] == pytest.approx(0.219 * 0.5 * 1e-3 / out[1][-1], rel=1e-6)


@pytest.mark.parametrize(
    ("changes", "where"),
    [
        ({"mass": -70.0}, "mass"),
        ({"mass": math.nan}, "mass"),
        ({"rcof": 1.2}, "rcof"),
        ({"rcof": -0.1}, "rcof"),
        ({"heel_speed": -1.0}, "heel_speed"),
        ({"effective_mass": 0.0}, "effective_mass"),
        ({"heel_brake": "reckorded"}, "recorded"),
        ({"brake_time": 0.0}, "brake_time"),
        ({"weight_transfer": 1.2}, "weight_transfer"),
        ({"rcof_step": math.nan}, "rcof_step"),
    ],
)
def test_people_who_cannot_be_are_refused(changes, where):
    with pytest.raises(InputError, match=where):
        walker(constant(0.2), **({"rcof": 0.2} | changes))


def test_a_step_longer_than_a_tenth_of_the_history_is_refused():
    person = walker(constant(0.2), 0.2)
    with pytest.raises(InputError, match="step"):
        slip_motion(person, Floor(), step=0.2)
    with pytest.raises(InputError, match="step"):
        dry_sole(0.1).motion(person, step=-1.0)


def test_the_length_of_a_step_goes_inversely_with_the_walking_speed():
    """Same step length: at twice the speed of the recording the foot is on the floor half as long.

    The recording's own speed counts where it is known, 1.35 m/s where it is not.
    """
    recorded = GaitHistory(
        "recorded", np.linspace(0.0, 0.6, 61), np.ones(61), np.full(61, 0.2), walking_speed=1.0
    )
    for speed, duration in ((0.5, 1.2), (1.0, 0.6), (2.0, 0.3)):
        step = Walker(recorded, walking_speed=speed).step
        assert step.duration == pytest.approx(duration)
    unknown = constant(0.2, duration=0.6)
    assert Walker(unknown, walking_speed=2.7).step.duration == pytest.approx(0.3)
    assert Walker(unknown).step.duration == pytest.approx(0.6)


@pytest.mark.parametrize(
    ("speed", "peak"),
    [
        ([0.9, 0.4, 0.2, 0.5, 0.3], 0.5),  # the landing, 0.9, is before the first minimum
        ([0.3, 0.1, 0.2, 0.05, 0.6, 0.0], 0.6),
        ([0.5, 0.3, 0.1, 0.0], 0.0),  # only slows down: no peak after its minimum
        ([0.2, 0.4, 0.6], 0.6),
    ],
)
def test_peak_speed_is_the_largest_after_the_first_minimum(speed, peak):
    speed = np.array(speed)
    zeros = np.zeros(speed.size)
    time = 0.01 * np.arange(speed.size)
    person = Walker(constant(0.2))
    motion = SlipMotion(person, time, speed, *[zeros] * 8, Status.CONVERGED, "full")
    assert motion.peak_speed == peak


def test_rcof_of_a_history_is_that_of_braking():
    time = np.linspace(0, 0.6, 61)
    ratio = 0.2 * np.sin(np.pi * time / 0.3) * np.where(time < 0.3, 1, -1)
    ratio[time > 0.3] += 0.35 * np.sin(np.pi * (time[time > 0.3] - 0.3) / 0.3)
    history = GaitHistory("pushed off", time, np.ones(61), ratio)
    assert history.ratio[history.time > 0.3].max() > 0.5
    assert history.rcof == pytest.approx(0.2, rel=0.01)


@pytest.mark.parametrize("cof", [0.02, 0.15, 0.3, 0.6])
@pytest.mark.parametrize("brake", [None, 0.011, 0.03])
def test_the_compiled_motion_is_the_motion_in_every_column(cof, brake):
    changes = {} if brake is None else {"heel_brake": "constant", "brake_time": brake}
    person = walker(constant(0.2), 0.2, **changes)
    full = slip_motion(person, Floor(cof=cof), step=1e-3)
    fast = dry_sole(cof).motion(person, step=1e-3)
    for name in COLUMNS:
        ours, theirs = getattr(fast, name), getattr(full, name)
        np.testing.assert_allclose(ours[1:], theirs[1:], rtol=1e-9, atol=1e-12, err_msg=name)
    braked = person.moving_mass * np.diff(person.dry_speed(fast.time)) / 1e-3
    rests = fast.speed[1:] == 0.0
    asked = np.maximum(fast.drive[1:] + braked, 0.0)[rests]
    assert fast.friction[1:][rests] == pytest.approx(np.minimum(asked, cof * WEIGHT))
