"""Slips whose other foot slides too or lands on its toe, and heels whose start nobody can bound."""

import math
from dataclasses import replace

import numpy as np
import pytest
from test_trials_walking import slipping

from underfoot.trials.recording.trial import Marker
from underfoot.trials.walking import gait_context
from underfoot.trials.walking.events import stances
from underfoot.trials.walking.slips import HeelMotion, OutcomeLimits, _slip_start, slip_of
from underfoot.trials.walking.walkway import walkway_of


def with_toe(way: float, rise: float = 0.0):
    """Return the slip of a left heel whose right toe slides by ``way`` (m) from its contact on."""
    trial = slipping()
    heel = trial.markers["LHEE"]
    gone = np.clip((heel.time - 2.22) / 0.4, 0, 1)
    still = np.zeros_like(gone)
    path = np.column_stack([0.5 + way * gone, still + 0.2, still + 0.02 + rise * gone])
    toe = Marker(path, heel.rate)
    walk = walkway_of(replace(trial, markers={**trial.markers, "RTOE": toe}))
    return walk, stances(walk)[-1]


@pytest.mark.parametrize(("way", "told"), [(0.025, False), (0.034, True), (0.1, True)])
def test_a_trailing_foot_that_slides_beyond_a_microslip_is_told(way, told):
    walk, last = with_toe(way)
    course = gait_context.slip_course(walk, last, slip_of(walk, last))
    assert course.trailing_slip == pytest.approx(way, abs=2e-3)
    flags = {flag.name: flag for flag in course.flags}
    assert ("trailing foot" in flags) is told
    if told:
        one = flags["trailing foot"]
        assert (one.matters, one.limit, one.unit) == (True, 0.03, "m")
        assert one.measured == course.trailing_slip
        assert f"slides by {1e3 * course.trailing_slip:.0f} mm" in str(one)
    wide = gait_context.slip_course(walk, last, slip_of(walk, last), OutcomeLimits(0.1, 0.2, 0.3))
    assert "trailing foot" not in {flag.name for flag in wide.flags}


def test_a_foot_that_lands_on_its_toe_missteps(monkeypatch):
    walk, last = with_toe(0.0)
    one = slip_of(walk, last)
    for angle, said in (
        (-20.0, "toe comes down first (-20 deg)"),
        (-5.4, "(-5 deg)"),
        (-4.6, ""),
        (5.0, ""),
    ):
        turned = np.radians([angle, 0.0])
        monkeypatch.setattr(gait_context, "_foot_angle", lambda _, t=turned: (None, t))
        course = gait_context.slip_course(walk, last, one)
        told = [str(flag) for flag in course.flags if flag.name == "misstep"]
        assert said in "".join(told)
        assert bool(told) == bool(said)
        assert bool(course.misstep) == bool(said)


def motion(speed: np.ndarray, rate: float = 200.0) -> HeelMotion:
    time = np.arange(len(speed)) / rate
    path = np.zeros((len(speed), 3))
    none = np.zeros(len(speed), dtype=bool)
    return HeelMotion(time, path, path, speed, none, 1e-5, 1e-4, none, 0.01)


def test_a_start_that_is_even_on_both_sides_is_not_shifted():
    time = np.arange(81) / 200.0
    even = motion(0.1 + 40 * (time - 0.2) ** 2)
    start, off, shift = _slip_start(even, 40, 10.0)
    assert (start, shift) == (pytest.approx(0.2, abs=1e-4), pytest.approx(0.0, abs=1e-4))
    assert off >= 1 / 200 / math.sqrt(12)
    steep = np.where(time < 0.2, 160.0, 10.0)
    start, _, shift = _slip_start(motion(0.1 + steep * (time - 0.2) ** 2), 40, 10.0)
    assert shift > 1e-3  # the filter moved it to the slower side
    assert start + shift == pytest.approx(0.2, abs=1 / 200)  # a frame
    lost = 0.1 + 40 * (time - 0.2) ** 2
    lost[:40] = np.nan
    start, off, shift = _slip_start(motion(lost), 40, 10.0)
    width = math.sqrt(math.log(2) / 2) / math.pi / 10
    assert (start, shift) == (pytest.approx(0.2), 0.0)
    assert off == pytest.approx(math.hypot(1 / 200 / math.sqrt(12), width))
