"""Whole soles through a step of walking, and by the test methods that load the forepart."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import underfoot as uf
from underfoot.case import Case
from underfoot.compute.run import run
from underfoot.compute.sole import forefoot_breaches, rolls, sole_map, trim_map
from underfoot.core import InputError
from underfoot.questions.method import method_name, method_prediction
from underfoot.shoe.ball_joint import MOST_BEND, BallJoint, rolled_height
from underfoot.slip.dynamics.gait import packaged_histories

EXAMPLE = Path(__file__).parents[2] / "examples" / "whole_sole_walking.toml"
BODY_WEIGHT = 70 * 9.80665
HEEL = """
shoe = "work_shoe_half_tread"
floor = "vinyl_g4"
contaminant = "glycerol_50pct"
motion = "slip_tester_g4"
"""


@pytest.fixture(scope="module")
def case() -> Case:
    return uf.load(EXAMPLE)


@pytest.mark.parametrize("name", ["heel_strike_to_heel_rise", "heel_strike_to_toe_off"])
def test_the_history_is_the_mean_of_the_recorded_steps_at_equal_shares(
    case: Case, name: str
) -> None:
    motion = case.replace("motion", name).motion.build()
    assert motion is not None
    steps = packaged_histories()
    stance = np.mean([step.duration for step in steps])
    share = np.round(motion.time / stance / 0.025) * 0.025
    np.testing.assert_allclose(share * stance, motion.time, atol=6e-4)
    loads = np.mean([np.interp(share * s.duration, s.time, s.normal) for s in steps], axis=0)
    np.testing.assert_allclose(motion.normal_force[1:], loads[1:] * BODY_WEIGHT, atol=0.6)
    angles = [
        np.interp(share * s.duration, s.time, s.foot_angle)
        for s in steps
        if s.foot_angle is not None
    ]
    assert len(angles) == 10
    np.testing.assert_allclose(motion.shoe_angle, np.mean(angles, axis=0), atol=np.radians(0.06))


def test_what_comes_near_the_floor_at_any_angle_is_computed(case: Case) -> None:
    rolling = sole_map(case, 3e-3)
    assert rolling.x[-1] - rolling.x[0] > 0.28  # all of the sole of 290 mm
    heel = sole_map(case.replace({"motion": "heel_strike_to_flat", "motion.speed": 0.3}), 3e-3)
    assert heel.x[-1] > 0.19  # flat at last: as far as the toe spring, not the rear 45 mm
    whole = rolling.whole
    assert whole is not None
    reach = 0.012
    first, all_of_it = (trim_map(whole, reach, by) for by in (rolls(case).max(), rolls(case)))
    assert first.x[-1] < 0.1 < all_of_it.x[-1]


def test_a_raised_heel_is_said_of_a_sole_that_does_not_bend(case: Case) -> None:
    sole = sole_map(case, 3e-3)
    assert not forefoot_breaches(case, sole)
    (breach,) = forefoot_breaches(case, replace(sole, joint=None))
    assert "forefoot does not bend" in str(breach)
    assert "-46.7" in str(breach)
    held = case.replace("motion", "en_iso_13287_forepart")
    tested = sole_map(held, 3e-3)
    assert tested.joint is None  # a shoe on its tester is held as it is
    assert not forefoot_breaches(held, tested)


def test_the_forepart_stays_level_until_the_toes_are_bent_and_then_rises() -> None:
    x = np.linspace(0.0, 0.3, 301)
    joint = BallJoint(0.2, map_angle=0.0)
    flat = np.zeros((x.size, 1))
    for degrees in (10.0, -5.0, -25.0, -45.0):
        angle = np.radians(degrees)
        height = rolled_height(x, flat, angle, joint)[:, 0]
        slope = np.gradient(height, x)
        rear, fore = slope[x < 0.18], slope[x > 0.22]
        np.testing.assert_allclose(rear, np.sin(angle), atol=1e-9)
        expected = angle if angle > 0 else min(angle + MOST_BEND, 0.0)
        np.testing.assert_allclose(fore, np.sin(expected), atol=1e-9)
        assert np.all(np.diff(slope) >= -1e-9)  # never hollow
    plain = rolled_height(x, flat + 1e-3, 0.1, None)
    np.testing.assert_array_equal(plain, (flat + 1e-3) * np.cos(0.1) + x[:, None] * np.sin(0.1))
    np.testing.assert_array_equal(plain, rolled_height(x, flat + 1e-3, 0.1, joint))
    turned = rolled_height(x, flat, -0.3, BallJoint(0.2, map_angle=0.1))  # at -0.2 rad
    assert np.gradient(turned[:, 0], x)[-1] == pytest.approx(np.sin(-0.1))


def test_a_backward_motion_is_steady_with_the_other_sign() -> None:
    motion = Case.from_text(HEEL).replace({"motion.backward": True}).motion
    assert motion.build() is None
    assert motion.end_time is None
    assert motion.sliding_speed == -motion.speed
    assert not motion.forward


@pytest.mark.parametrize("method", ["iso13287-forepart", "iso13287-flat", "astmf2913-forepart"])
def test_a_heel_piece_is_refused_where_the_method_loads_more(method: str) -> None:
    with pytest.raises(InputError, match="heel piece"):
        method_prediction(Case.from_text(HEEL), method, with_band=False, quick=True)


def test_the_angle_of_the_slip_prediction_study() -> None:
    case = Case.from_text(HEEL)
    entry = case.catalogue.entry("setup", method_name("slip-prediction-13-deg", case))
    assert entry.sourced_value("motion.shoe_angle", "rad").value == pytest.approx(np.radians(13))
    assert 400 <= (entry.sourced_value("motion.normal_force", "N").value or 0) <= 500


@pytest.mark.slow
@pytest.mark.parametrize("tread", ["hexagons", "chevrons"])
def test_a_whole_sole_walks_from_heel_to_toe(case: Case, tread: str) -> None:
    if tread == "chevrons":
        herringbone = {"lug_width": "8 mm", "channel_width": "6 mm", "arm_length": "20 mm"}
        pattern = {"pattern": tread, "depth": "3.5 mm", "angle": "35 deg", **herringbone}
        case = case.replace("shoe.tread", pattern)
    result = run(case.replace("numerics.tread_positions", 1), quick=True)
    assert result.status.usable
    assert not any("forefoot" in caution for caution in result.cautions())
    fields = result.fields
    time, load = fields["time"].values, fields["load_history"].values
    angle, centre = fields["shoe_angle_history"].values, fields["centre_of_pressure_history"].values
    area = fields["contact_area_history"].values
    assert time[-1] == pytest.approx(0.569)
    assert np.all(fields["fluid_load_history"].values <= load * 1.001)
    assert np.all(np.diff(centre) > -1e-4)  # the load travels from the heel to the toe
    assert centre[angle > np.radians(9)].max() < 0.03
    assert centre[-1] > 0.25  # on the toe
    flat = np.abs(angle) < np.radians(0.3)
    assert area[flat].max() > 1.5 * area[angle > np.radians(3)].max()


@pytest.mark.slow
def test_the_forepart_by_the_method_slides_backward_on_the_ball(case: Case) -> None:
    tested = case.replace({"motion": "en_iso_13287_forepart", "numerics.tread_positions": 1})
    result = run(tested, quick=True)
    assert result.status.usable
    assert result.fields["speed_history"].values[-1] == pytest.approx(-0.3)
    assert result.fields["centre_of_pressure_history"].values[-1] > 0.18
    assert not any("forefoot" in caution for caution in result.cautions())
