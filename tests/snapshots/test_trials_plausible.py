"""Checks of a step: what each measures exactly, and its limit, just below and just above."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from underfoot.core.constants import GRAVITY
from underfoot.trials.recording.axes import LEVEL, DirectionSource
from underfoot.trials.recording.signals import LowPass
from underfoot.trials.walking import plausibility as check

UP, ON = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
RATE = 1000.0


class Record(SimpleNamespace):
    """A plate or marker of a few values, which answers may be kept for."""

    __hash__ = object.__hash__


def plate(force, rate=RATE, **more) -> Any:
    return Record(force=np.asarray(force, float), rate=rate, corners=None, **more)


def hump(count=700, peak=800.0):
    """Normal force of a step that is highest at a quarter and three quarters, N."""
    x = np.linspace(0, 1, count)
    return (
        peak
        * np.minimum(1.0, 8 * np.minimum(x, 1 - x))
        * (1 - 0.3 * np.exp(-(((x - 0.5) / 0.15) ** 2)))
    )


def forces(normal, along=0.0, across=0.0):
    return np.column_stack([0 * normal + along, 0 * normal + across, normal])


def names(flags):
    return [flag.name for flag in flags]


def only(flags):
    (flag,) = flags
    return flag


def test_a_spike_stands_out_from_two_milliseconds_to_both_sides():
    for rate, width, size in ((1000.0, 1, 50.0), (1000.0, 3, 50.0), (1000.0, 4, 0.0),
                              (800.0, 2, 50.0), (799.0, 2, 0.0), (799.0, 1, 50.0)):  # fmt: skip
        values = np.zeros((40, 2))
        values[20 : 20 + width, 1] = -50.0
        assert check._spike(values, rate) == pytest.approx(size), (rate, width)
    slope = np.arange(40.0)[:, None]
    assert check._spike(slope, RATE) == 0.0
    slope[20] += 7.0  # two steps above the sample two before, five above that two after
    assert check._spike(slope, RATE) == pytest.approx(5.0)


def test_a_step_is_what_goes_beyond_those_of_three_milliseconds_around():
    force = np.zeros((200, 3))
    force[100:] = [3.0, 4.0, 0.0]
    assert check._step(force, RATE) == pytest.approx(5.0)
    force[98:] += [1.0, 0.0, 0.0]  # a step of 1 N two samples before
    assert check._step(force, RATE) == pytest.approx(math.hypot(2.0, 4.0))
    edge = np.zeros((200, 3))
    edge[3:] = 9.0  # the first 2 % are the foot's own
    assert check._step(edge, RATE) == 0.0
    assert check._step(np.zeros((6, 3)), RATE) == 0.0


def test_what_is_fast_in_the_forces_is_weighed_against_what_is_slow():
    time = np.arange(2000) / RATE

    def waves(**size):
        every = sum(a * np.sin(2 * math.pi * int(f[1:]) * time) for f, a in size.items())
        return forces(every, 0.5 * every)

    one = check._high_share(waves(f20=10.0, f70=1.0), RATE)
    # mean power of 100 bins of 0.5 Hz against that of 40
    assert one == pytest.approx(0.1 * math.sqrt(40 / 100), rel=0.02)
    for inside, outside in (("f52", "f48"), ("f98", "f103")):
        assert check._high_share(waves(f20=10.0, **{inside: 1.0}), RATE) > 0.05
        assert check._high_share(waves(f20=10.0, **{outside: 1.0}), RATE) < 0.02
    assert check._high_share(waves(f12=10.0, f70=1.0), RATE) == pytest.approx(one, rel=0.05)
    assert check._high_share(waves(f33=10.0, f70=1.0), RATE) > 10 * one
    assert check._high_share(waves(f20=1.0)[:400], 100.0) == math.inf
    assert check._high_share(np.zeros((500, 3)), RATE) == math.inf


def test_levels_of_an_unloaded_plate_move_the_ratio():
    level = np.array([3.0, -4.0, 10.0])
    error = check.baseline_error([0.1 * level, level], UP, 500.0, 0.2)
    assert error == pytest.approx(math.hypot(5.0, 2.0) / 500)
    assert check.baseline_error([], UP, 500.0, 0.2) == 0.0
    assert check.baseline_error([level], UP, 0.0, 0.0) == pytest.approx(5.0)


def step_of(force, start, stop, **more) -> Any:
    """A step on a plate, with what the checks read of it."""
    made = plate(force)
    stance = SimpleNamespace(
        start=start, stop=stop, duration=(stop - start) / RATE, walking=ON, by_hand=(), side="left",
        peak=float(made.force[start:stop, 2].max()), plate="one", heel="", contact=start / RATE,
        toe_off=stop / RATE, direction=SimpleNamespace(source=DirectionSource.MARKERS),
    )  # fmt: skip
    trial = SimpleNamespace(markers={}, plates=(), events=())
    axes = SimpleNamespace(up=UP, ramp=LEVEL)
    walk = SimpleNamespace(up=UP, weight=None, trial=trial, pelvis=(), heels={}, axes=axes)
    given = {"plate": made, "stance": stance, "walk": walk, "speed": None,
             "contacts": ((start, stop),), "force": made.force[start:stop],
             "smooth_force": made.force[start:stop]}  # fmt: skip
    return SimpleNamespace(**(given | more))


def test_levels_are_taken_near_a_step_and_clear_of_any_load():
    force = np.zeros((2000, 3))
    force[:, 0] = np.arange(2000.0)
    force[1000:1300, 2] = 700.0
    before, after = check.unloaded_levels(step_of(force, 1000, 1300))
    assert before[0] == pytest.approx(np.arange(775, 975).mean())
    assert after[0] == pytest.approx(np.arange(1325, 1525).mean())
    step = step_of(force, 1000, 1300, contacts=((940, 944), (1000, 1300), (1340, 1400)))
    before, after = check.unloaded_levels(step)
    assert before[0] == pytest.approx(
        np.concatenate([np.arange(775, 915), np.arange(969, 975)]).mean()
    )
    assert after[0] == pytest.approx(np.arange(1425, 1525).mean())
    force[970:] = np.nan
    assert len(check.unloaded_levels(step_of(force, 1000, 1300))) == 1
    assert check.unloaded_levels(step_of(force, 44, 1300)) == []  # 19 samples are left before
    assert len(check.unloaded_levels(step_of(force, 46, 1300))) == 1


def test_turns_of_the_shear_are_counted_while_the_foot_is_loaded():
    x = np.linspace(0, 1, 1001)
    for waves in (5, 10):
        shear = 20 * np.sin(2 * math.pi * waves * x)
        inside = np.arange(1, 4 * waves, 2) / (4 * waves)
        turns = int(((inside > 0.08) & (inside < 0.5)).sum())
        force = forces(np.full(1001, 500.0), shear)
        assert check._turns(force, ON, UP) == turns
        assert check._turns(force[:, [1, 0, 2]], ON, UP) == turns
    for size, counted in ((3.1, True), (2.9, False)):  # between top and dale
        force = forces(np.full(1001, 500.0), size / 2 * np.sin(2 * math.pi * 10 * x))
        assert (check._turns(force, ON, UP) > 2) == counted


def test_shear_before_and_after_a_stance_is_that_beyond_what_is_further_away():
    force = np.zeros((2000, 3))
    force[800:1400, 2] = 500.0
    force[:, 0] = 2.0
    force[760:796, 0] += 3.0
    force[1404:1440, 1] -= 4.0
    before, after = check._shear_outside(plate(force), step_of(force, 800, 1400).stance, UP)
    assert (before, after) == pytest.approx((3.0 / 500, 4.0 / 500))
    force[700, 2] = 30.0
    before, after = check._shear_outside(plate(force), step_of(force, 800, 1400).stance, UP)
    assert (before, after) == pytest.approx((0.0, 4.0 / 500))
    short = force[:1450]
    assert check._shear_outside(plate(short), step_of(short, 800, 1400).stance, UP)[1] == 0.0


def test_an_unloaded_plate_that_swings():
    time = np.arange(4000) / RATE
    force = forces(0 * time, 3.0 * np.sin(2 * math.pi * 10 * time) + time, 2.0)
    force[1500:2200, 2] = 600.0
    made = plate(force)
    noise = check._noise(made, tuple(UP), ((1500, 2200),), LowPass(cutoff=36.0))
    assert noise == pytest.approx(3.0 / math.sqrt(2), rel=0.03)
    assert (
        check._noise(plate(force[:1590]), tuple(UP), ((99 - 0, 1590),), LowPass(cutoff=36.0)) == 0.0
    )


@pytest.mark.parametrize("degrees", [0.0, 20.0, 59.0, 61.0])
def test_the_angle_from_braking_to_driving(degrees):
    """An even sideways force of up to a tenth of the normal one is the foot's place."""
    count = 600
    normal = np.full(count, 700.0)
    turn = math.radians(degrees)
    force = forces(normal)
    force[:300, 0] = -90.0
    force[300:, :2] = 90.0 * np.array([math.cos(turn), math.sin(turn)])
    step = step_of(np.concatenate([force]), 0, count, body=(None,) * 4)
    even = force[:, 1].mean() / 700.0
    rest = np.array([[-90.0, -even * 700], [90 * math.cos(turn), 90 * math.sin(turn) - even * 700]])
    expected = math.acos(float(-rest[0] @ rest[1]) / np.prod(np.linalg.norm(rest, axis=1)))
    assert check._braking_to_driving(step) == pytest.approx(expected, abs=1e-6)
    step.stance.walking = None
    assert check._braking_to_driving(step) == 0.0
    assert check._angle(ON, UP) == pytest.approx(math.pi / 2)
    assert check._angle(ON, 0 * UP) == 0.0


def test_forces_on_straight_lines():
    rng = np.random.default_rng(3)
    force = rng.normal(size=(700, 3)).cumsum(axis=0)
    assert not names(check._straight_flags(force, RATE))
    for count, told in ((30, False), (31, True)):
        drawn = force.copy()
        drawn[200 : 200 + count, 1] = np.linspace(3.0, 40.0, count)
        flags = [*check._straight_flags(drawn, RATE)]
        assert names(flags) == (["straight lines"] if told else [])
        if told:
            assert flags[0].measured == pytest.approx(count / RATE)
    for every, told in ((7, True), (5, False)):
        slow = np.arange(0, 701, every)
        knots = rng.normal(size=(len(slow), 3)).cumsum(axis=0)
        lines = np.column_stack([np.interp(np.arange(690), slow, k) for k in knots.T])
        assert ("samples drawn out" in names(check._straight_flags(lines, RATE))) == told


def stance(duration, weight=None, mean=600.0, speed=None, height=None):
    made = step_of(forces(hump(round(duration * RATE))), 0, round(duration * RATE))
    made.stance.duration = duration
    if weight:
        made.walk.weight = SimpleNamespace(newtons=weight, source="a scale")
    if height:
        made.speed = speed
        made.plate.corners = np.zeros((4, 3)) + 0.02 * UP
        path = np.tile([0.0, 0.0, height + 0.02], (50, 1))
        made.walk.pelvis = ("a",)
        made.walk.trial.markers["a"] = Record(positions=path, missing=np.zeros(50, bool))
    return [*check._stance_flags(made, mean)]


def test_how_long_a_stance_lasts():
    assert not stance(0.99)
    assert not stance(0.46)
    assert only(stance(1.01)).limit == 1.0
    assert "running" in str(only(stance(0.44)))
    # a slow walk has a lower mean, and may stand for longer
    assert not stance(1.29, 800.0, 0.77 * 800)
    assert only(stance(1.31, 800.0, 0.77 * 800)).limit == 1.3
    assert only(stance(1.29, 800.0, 0.79 * 800)).limit == 1.0
    # where markers tell speed and height: sqrt(g / h) sqrt(v / sqrt(g h)) times the time
    for pace, name in ((1.84, ""), (1.86, "long"), (0.96, ""), (0.94, "short")):
        height, speed = 0.9, 1.3
        swing = math.sqrt(GRAVITY / height)
        duration = pace / (swing * math.sqrt(speed / (height * swing)))
        flags = stance(duration, speed=speed, height=height)
        assert bool(flags) == bool(name), pace
        if flags:
            assert only(flags).measured == pytest.approx(pace, rel=1e-6)
            assert ("sampling rate right" in str(flags[0])) == (name == "long")
    assert only(stance(1.01, speed=1.3, height=0.19)).limit == 1.0
    assert only(stance(1.01, speed=1.3, height=0.21)).name == "pace"


def of_forces(normal, start=300, weight=None, speed=None, **more):
    rest = np.zeros(300)
    whole = np.concatenate([rest[:start], normal, rest])
    made = step_of(forces(whole), start, start + len(normal), speed=speed, **more)
    if weight:
        made.walk.weight = SimpleNamespace(newtons=weight, source="a scale")
    return {flag.name: flag for flag in check._force_flags(made)}


def test_forces_of_a_walk_against_body_weight():
    normal = hump()
    peak, mean = normal.max(), normal.mean()
    for share, told in ((1.59, False), (1.61, True)):
        found = of_forces(normal, weight=peak / share)
        assert ("peak over body weight" in found) == told
    for share, speed, told in ((0.75, 1.2, False), (0.73, 1.2, True), (0.69, 0.8, False),
                               (0.67, 0.8, True), (0.73, 0.91, True), (0.96, 1.2, False),
                               (0.98, 1.2, True), (0.73, None, True)):  # fmt: skip
        found = of_forces(normal, weight=mean / share, speed=speed)
        assert ("mean over body weight" in found) == told, (share, speed)
        if told:
            assert found["mean over body weight"].measured == pytest.approx(share)
    long = hump(810)  # without markers a stance above 0.8 s is a slow one
    assert "mean over body weight" not in of_forces(long, weight=long.mean() / 0.7)
    short = hump(790)
    assert "mean over body weight" in of_forces(short, weight=short.mean() / 0.7)


def test_a_force_that_is_largest_in_mid_stance_is_no_walk():
    for share, speed, told in ((1.04, 1.2, False), (1.06, 1.2, True), (1.06, 0.9, False),
                               (1.06, 0.91, True), (1.09, 0.8, False), (1.11, 0.8, True),
                               (1.06, None, True)):  # fmt: skip
        x = np.linspace(0, 1, 701)
        normal = 500 * np.minimum(1.0, 8 * np.minimum(x, 1 - x))
        normal[300:400] = 500 * share
        assert ("single hump" in of_forces(normal, speed=speed)) == told, (share, speed)


def test_a_force_that_jumps_from_rest():
    normal = hump()
    for share, told in ((0.29, False), (0.31, True)):  # 0.2 and 100 / rate
        made = normal.copy()
        made[:60] = share * 700.0
        assert ("jump from rest" in of_forces(made, weight=700.0)) == told
    made[:] = np.maximum(normal, 300.0)
    assert "jump from rest" not in of_forces(made, start=0, weight=700.0)
    # without a body mass 0.9 of the peak stands for it
    made = np.maximum(normal, 0.31 * 0.9 * normal.max())
    assert "jump from rest" in of_forces(made)
    made = np.maximum(normal, 0.29 * 0.9 * normal.max())
    assert "jump from rest" not in of_forces(made)


def test_rates_of_loading():
    for steep, told in ((99.0, False), (101.0, True)):
        normal = hump()
        normal[:] = 400.0
        normal[100:108] = 400 + np.arange(8) * steep * 700.0 / RATE
        normal[108:] = normal[107]
        found = of_forces(normal, weight=700.0)
        assert ("loading rate" in found) == told
        late = of_forces(normal[::-1], weight=700.0)
        assert "loading rate" not in late


def test_samples_that_were_held_or_lost():
    normal = hump() + np.random.default_rng(1).normal(size=700)
    for count, told in ((3, False), (4, True), (5, True)):
        made = normal.copy()
        made[200 : 200 + count] = made[200]
        assert ("held samples" in of_forces(made)) == told
    low = normal.copy()
    low[5:15] = 40.0
    assert "held samples" not in of_forces(low)
    lost = normal.copy()
    lost[300:303] = 19.0
    assert of_forces(lost)["drop-out"].measured == pytest.approx(3 / RATE)
    lost[300:303] = 21.0
    assert "drop-out" not in of_forces(lost)
    for size, told in ((119.0, False), (125.0, True)):
        made = hump()
        made[350] += size
        assert ("spike" in of_forces(made)) == told


def walked(**more):
    made = step_of(forces(hump()), 0, 700, **more)
    return {flag.name: flag for flag in check._path_flags(made)}


def body(speed=1.2, climb=0.0, turn=0.0, second=None):
    whole = np.array([speed, 0.0, climb])
    first = np.array([1.0, 0.0, 0.0]) * (speed if second is None else second)
    later = speed * np.array([math.cos(turn), math.sin(turn), 0.0])
    return whole, whole * [1, 1, 0], first, later


def test_how_a_body_moves_over_its_step():
    for climb, told in ((0.149, False), (0.151, True), (-0.151, True)):
        assert ("climb" in walked(body=body(climb=climb))) == told
    for speed, told in ((2.19, False), (2.21, True)):
        assert ("walking speed" in walked(body=body(speed))) == told
    for degrees, told in ((19.9, False), (20.1, True)):
        assert ("turn" in walked(body=body(turn=math.radians(degrees)))) == told
    for slow, told in ((0.29, False), (0.31, True)):
        assert ("turn" in walked(body=body(turn=1.0, second=slow))) == told
    assert not walked(body=(*body()[:2], None, None))
    assert not walked(body=(*body()[:3], None))


def test_plates_of_other_heights_are_stairs():
    def corners(height):
        return Record(name=f"{height}", usable=True, corners=np.zeros((4, 3)) + height * UP)

    for height, told in ((0.029, False), (0.031, True)):
        made = step_of(forces(hump()), 0, 700, body=body())
        made.walk.trial.plates = (corners(0.0), corners(height))
        made.stance.plate = "0.0"
        found = {flag.name: flag for flag in check._path_flags(made)}
        assert ("plate height" in found) == told
        made.walk.trial.plates[1].usable = False
        assert not [*check._path_flags(made)]
    made.stance.direction.source = DirectionSource.SHEAR
    assert names(check._path_flags(made)) == ["walking direction"]
