"""Markers of heels, errors of the reduced model and sums of studies, by motions made by hand."""

from dataclasses import astuple
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.slip.dynamics import observation
from underfoot.slip.dynamics.observation import (
    AFTER,
    BEFORE,
    RATE,
    SWING_SPEED,
    _pulses,
    heel_marker,
)
from underfoot.slip.dynamics.reduced_model import SPEED_SCALE, error_of
from underfoot.slip.dynamics.study import FrictionDraws, SlipStudy


def motion_at(speed, *, duration=0.4, still_sliding=False, heel_speed=0.5):
    time = np.linspace(0.0, duration, 81)
    made = SimpleNamespace(
        time=time,
        speed=np.full(time.size, speed),
        still_sliding=still_sliding,
        walker=SimpleNamespace(heel_speed=heel_speed),
    )
    return cast(Any, made)


def test_a_marker_goes_with_a_heel_that_slides_and_comes_from_its_swing():
    frames, place = heel_marker(motion_at(0.5, still_sliding=True))
    assert frames[0] == pytest.approx(-BEFORE)
    assert frames[-1] == pytest.approx(0.4)
    assert np.diff(frames) == pytest.approx(1 / RATE)
    x, y, z = place.T
    slides = frames >= 0
    assert x[slides] == pytest.approx(0.5 * frames[slides], abs=1e-9)
    assert not y.any()
    assert z[slides] == pytest.approx(0.02)  # it lifts only where it came to rest
    swing = frames < -1e-9
    assert (x[swing] < 0).all()
    assert (z[swing] > 0.02).all()
    assert np.all(np.diff(x) >= 0)
    # before contact the faster the earlier, until it rests where the record begins
    v = np.diff(x) * RATE
    assert v[np.searchsorted(frames, -0.2)] > v[np.searchsorted(frames, -0.01)]
    assert v[0] < 0.1
    # halfway between the beginning and 0.35 s before contact: half of the largest speed
    half = np.searchsorted(frames, -0.5 * (BEFORE + 0.35))
    assert v[half] == pytest.approx(0.5 * SWING_SPEED, rel=0.03)


def test_a_foot_that_rests_stays_a_while_and_then_lifts():
    frames, place = heel_marker(motion_at(0.0, heel_speed=0.0))
    assert frames[-1] == pytest.approx(0.4 + AFTER, abs=1 / RATE)
    x, _, z = place.T
    rests = (frames >= 0) & (frames <= 0.55)
    assert x[rests] == pytest.approx(0.0, abs=1e-9)
    assert z[rests] == pytest.approx(0.02)
    late = frames > 0.55 + 2 / RATE
    assert late.any()
    assert (x[late] > 0).all()
    flown = frames[late] - 0.55
    assert z[late] == pytest.approx(0.02 + 5 * flown**2 + 0.3 * flown)
    assert x[-1] == pytest.approx(10 * flown[-1] ** 2, rel=0.03)


def run_of(speed, shift=0.0, load=0.0):
    """Return a full run at a steady speed (m/s) whose film carries ``load`` of 100 N."""
    time = np.linspace(0.0, 1.0, 11)
    return SimpleNamespace(
        walker=speed + shift,
        time=time,
        speed=np.full(11, speed),
        peak_speed=speed,
        distance=speed * time,
        normal=np.full(11, 100.0),
        fluid_load=np.full(11, load),
    )


def errors(runs, carried=0.0):
    sole = SimpleNamespace(
        motion=lambda speed: run_of(speed), carried_at=lambda run: (np.full(11, carried), None)
    )
    return error_of(cast(Any, sole), cast(Any, runs))


def test_errors_of_the_reduced_model_are_root_mean_squares_of_what_differs():
    told = errors([run_of(1.0, 0.3), run_of(1.0, -0.4)], carried=20.0)
    rms = np.sqrt((0.3**2 + 0.4**2) / 2)
    assert astuple(told) == pytest.approx((2, rms, rms, rms, 0.2, 1.0))  # of one second: the way
    exact = errors([run_of(1.0, load=20.0)], carried=20.0)
    assert astuple(exact) == pytest.approx((1, 0, 0, 0, 0, 1.0))


@pytest.mark.parametrize(("shift", "same"), [(2.0, 0.5), (0.1, 1.0)])
def test_slip_or_none_is_judged_on_both_models(shift, same):
    held = run_of(0.5 * SPEED_SCALE, shift * SPEED_SCALE)
    told = errors([held, run_of(2 * SPEED_SCALE)])
    assert told.same_outcome == same


def subject(crossed, peaks, speed=1.0, pressures=None):
    motion = SimpleNamespace(
        distance=np.array([0.0, 0.1, 0.3]),
        time=np.array([0.0, 0.1, 0.2]),
        speed=np.array([0.0, 1.0, 3.0]),
    )
    seen = SimpleNamespace(crossed=crossed, row_peaks=peaks, peak_speed=speed)
    return SimpleNamespace(seen=seen, motion=motion, pressures=pressures, walker=None)


def study_of(*subjects, x=(), y=()):
    array = SimpleNamespace(rows=2, places=lambda walker: (np.array(x), np.array(y)))
    return cast(Any, SimpleNamespace(subjects=subjects, array=array))


def test_rows_of_sensors_are_means_over_those_who_crossed():
    study = study_of(subject(True, (4.0, 2.0)), subject(True, (8.0, 2.0)), subject(False, (90, 90)))
    assert SlipStudy.rows(study) == pytest.approx([6.0, 2.0])
    assert np.isnan(SlipStudy.rows(study_of(subject(False, (1.0, 1.0))))).all()


def test_a_sensor_meets_the_speed_at_which_the_heel_passes_it():
    pressures = np.zeros((3, 3, 2))
    pressures[1] = [[5.0, 6.0], [7.0, 8.0], [9.0, 10.0]]
    crossed = subject(True, (1.0,), pressures=pressures)
    told = SlipStudy.sensor_passages(
        study_of(
            crossed, subject(False, (), pressures=pressures), x=(0.1, 0.2, 0.4), y=(-0.01, 0.02)
        )
    )
    # the third row lies beyond where the heel came
    assert told["peak"] == pytest.approx([5, 6, 7, 8])
    assert told["row"] == pytest.approx([1, 1, 2, 2])
    assert told["lateral"] == pytest.approx([0.01, 0.02, 0.01, 0.02])
    assert told["speed"] == pytest.approx([1.0, 1.0, 2.0, 2.0])


def at_level(values, crossed):
    found = {"speed": np.array(values), "crossed": np.array(crossed)}
    return SimpleNamespace(of=found.__getitem__)


def test_a_draw_of_the_friction_has_walkers_of_its_level_and_crossed_ones_where_asked():
    levels = (
        at_level([1.0, 1.0, 9.0], [1, 1, 0]),
        at_level([2.0, 2.0, 8.0], [1, 1, 0]),
        at_level([3.0, 3.0, 3.0], [0, 0, 0]),
    )
    draws = FrictionDraws(cast(Any, levels), np.array([0, 1, 2, 1]), np.full(4, 0.2), seed=3)
    over_sensors = draws.means("speed", 7, crossed=True)
    assert over_sensors == pytest.approx([1, 2, np.nan, 2], nan_ok=True)
    assert draws.means("speed", 4000) == pytest.approx([11 / 3, 4, 3, 4], abs=0.25)
    assert draws.means("speed", 40) == pytest.approx(draws.means("speed", 40))
    # few walkers scatter from draw to draw
    many = FrictionDraws(cast(Any, levels), np.ones(400, int), np.full(400, 0.2), seed=3)
    assert many.means("speed", 9).std() == pytest.approx(np.sqrt(8) / 3, rel=0.15)


@pytest.mark.parametrize("middle", [0.05, 0.2, 0.35])
def test_a_pulse_is_seen_wherever_in_the_motion_it_comes(middle):
    """A half wave of 0.1 s and 40 kPa: above 10 % of its peak for 0.094 s."""
    motion = motion_at(1.0)
    wave = np.clip(1 - ((motion.time - middle) / 0.05) ** 2, 0.0, None)
    pressures = np.zeros((motion.time.size, 2, 3))
    pressures[:, 1, 2] = 40e3 * wave
    rows, duration, highest = _pulses(motion, pressures, seed=1)
    assert highest == rows[1] == pytest.approx(40e3, rel=0.03)
    assert rows[0] < 2e3
    assert duration == pytest.approx(0.1, abs=0.01)


@pytest.mark.parametrize("peak", [None, 1.2])
def test_a_slip_without_a_peak_says_so_and_one_with_it_does_not(monkeypatch, peak):
    reading = SimpleNamespace(value=peak, flags=(), reason="it rises to its end")
    seen = SimpleNamespace(
        peak_speed=reading, end=0.4, start=SimpleNamespace(value=0.1), slipped=True
    )
    monkeypatch.setattr(observation, "judge_slip", lambda _: seen)
    motion = motion_at(1.0)
    motion.distance, motion.notes = motion.time, ()
    motion.walker.landing, motion.walker.lateral = 0.1, 0.0
    array = SimpleNamespace(columns=3, spacing=0.02)
    told = observation.observe_slip(motion, None, cast(Any, array))
    assert told.peak_speed == (peak or 0.0)
    assert told.flags == (() if peak else ("no peak: it rises to its end",))
    assert (told.crossed, told.distance) == (True, pytest.approx(0.4))
