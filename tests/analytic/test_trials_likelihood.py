"""The screen by likelihood: the same on both sides, right by mechanics, silent on sound steps."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from underfoot.trials import finished_plate, read_trial, required_frictions, walkway_of
from underfoot.trials.walking.likelihood import (
    UNLIKELY,
    Reference,
    impossible,
    references,
    unlikely_flags,
)
from underfoot.trials.walking.step import Step
from underfoot.trials.walking.step_features import VERTICAL, judged_features, step_features

DATA = Path(__file__).parents[1] / "data" / "trials"
SOUND = ["biomechzoo/HC030A05.c3d", "bmc/Gait.c3d", "kineticstoolkit/c3d_sample.c3d"]


def _changed(trial, change):
    """The trial with ``change`` (force, up) on the raw forces of its plates."""
    up = walkway_of(trial).up
    plates = tuple(
        finished_plate(
            p.name, change(p.force, up), rate=p.rate, start=p.start, up=up, corners=p.corners,
            centre_of_pressure=p.centre_of_pressure,
        )
        for p in trial.plates
    )  # fmt: skip
    return replace(trial, plates=plates)


def _shear(trial, factor):
    def change(force, up):
        normal = np.outer(force @ up, up)
        return normal + factor * (force - normal)

    return _changed(trial, change)


def test_likelihood_is_students_of_a_new_step_and_the_same_on_both_sides():
    one = Reference("x", 0.8, 0.05, 8, 16, False, True, "", "")
    reach = stats.t(15).isf(UNLIKELY / 2) * 0.05 * np.sqrt(1 + 1 / 8)
    assert one.likelihood(0.8 + reach) == pytest.approx(UNLIKELY, rel=1e-9)
    assert one.likelihood(0.8 - reach) == pytest.approx(UNLIKELY, rel=1e-9)
    assert one.limit(0.9) == pytest.approx(0.8 + reach)
    assert one.limit(0.1) == pytest.approx(0.8 - reach)
    for value in (0.8 + 1.01 * reach, 0.8 - 1.01 * reach):
        (flag,) = [f for f in unlikely_flags({"x": value}, (one,)) if f.matters]
        assert flag.likelihood < UNLIKELY
        assert flag.measured == pytest.approx(value)


def test_a_speed_that_nobody_recorded_widens_the_limits_as_a_line_over_the_speed():
    """z = (1.0 - 0.6) / 0.2 = 2: variance 1 + (1 + 4) / 8."""
    one = Reference("x", 0.8, 0.05, 8, 16, False, True, "", "", 1.0, 1.6, 0.2)
    t = stats.t(15).isf(UNLIKELY / 2)
    assert one.limit(0.9, speed=0.6) == pytest.approx(0.8 + t * 0.05 * np.sqrt(1 + 5 / 8))
    assert one.likelihood(one.limit(0.1, speed=1.8), 1.8) == pytest.approx(UNLIKELY, rel=1e-9)
    assert one.limit(0.9, speed=1.3) == one.limit(0.9) < one.limit(0.9, speed=0.9)
    value = 0.5 * (one.limit(0.9) + one.limit(0.9, speed=0.6))
    assert [f for f in unlikely_flags({"x": value}, (one,)) if f.matters]
    assert not [f for f in unlikely_flags({"x": value}, (one,), speed=0.6) if f.matters]


@pytest.mark.parametrize("name", SOUND)
def test_sound_recorded_steps_are_accepted(name):
    assert {step.verdict for step in required_frictions(walkway_of(read_trial(DATA / name)))} == {
        "accepted"
    }


@pytest.mark.parametrize("name", SOUND)
@pytest.mark.parametrize("factor", [0.4, 0.5, 2.0])
def test_a_gain_of_the_shear_is_noticed_on_both_sides(name, factor):
    """No mass is needed: the force no longer points to the pelvis."""
    steps = required_frictions(walkway_of(_shear(read_trial(DATA / name), factor)))
    assert steps
    assert all(step.verdict != "accepted" for step in steps)


def test_the_force_points_to_the_pelvis_and_the_mass_follows_from_its_acceleration():
    """Mechanics on a real walk of 45.8 kg: the features follow the gain of the channels."""
    trial = read_trial(DATA / SOUND[0])
    features, halved = (
        step_features(Step(walk := walkway_of(t), required_frictions(walk)[0].stance))
        for t in (trial, _changed(trial, lambda f, up: f - 0.3 * np.outer(f @ up, up)))
    )
    assert np.exp(features["mass by acceleration"]) == pytest.approx(1.0, abs=0.05)
    assert 0.65 < np.exp(features["slope of the force line"]) < 0.95
    ratio = np.exp(halved["mass by acceleration"] - features["mass by acceleration"])
    assert ratio == pytest.approx(0.7, abs=0.01)
    slope = halved["slope of the force line"] - features["slope of the force line"]
    assert np.exp(slope) == pytest.approx(1 / 0.7, rel=0.01)


def test_an_impossible_step_is_rejected_with_the_reason():
    known = references()
    slope = next(one for one in known if one.feature == "slope of the force line")
    assert slope.bound
    assert not impossible({slope.feature: slope.mean})
    words = impossible({slope.feature: slope.mean + 12 * slope.sd})
    assert "is impossible" in words
    (first, *_) = required_frictions(walkway_of(_shear(read_trial(DATA / SOUND[0]), 4.0)))
    assert first.verdict == "rejected"
    assert "impossible" in first.measurement.reason


def test_what_cannot_be_judged_is_said():
    trial = read_trial(DATA / "bmc" / "Gait.c3d")
    bare = required_frictions(walkway_of(replace(trial, markers={})))[0].measurement
    words = [flag.message for flag in bare.flags if not flag.matters]
    assert any("body mass" in text and "can't be judged" in text for text in words)
    assert any("pelvis markers" in text for text in words)


def test_a_turn_is_unlikely_as_a_straight_step():
    (turn,) = required_frictions(walkway_of(read_trial(DATA / "biomechzoo" / "HC036A23.c3d")))
    assert "sideways ratio" in {flag.name for flag in turn.measurement.caution_flags}


@pytest.mark.parametrize(
    ("late", "name"), [(30, "shear after toe off"), (-20, "shear before contact")]
)
def test_shear_where_nothing_loads_the_plate_is_noticed(late, name):
    trial = read_trial(DATA / SOUND[0])

    def shifted(force, up):
        normal = np.outer(force @ up, up)
        return normal + np.roll(force - normal, late, axis=0)

    for step in required_frictions(walkway_of(_changed(trial, shifted))):
        assert name in {flag.name for flag in step.measurement.caution_flags}


def test_samples_missing_without_a_trace_are_noticed():
    trial = read_trial(DATA / SOUND[0])

    def lost(force, up):
        out, at = force.copy(), int(np.flatnonzero(force @ up > 20.0)[0]) + 40
        out[at:-30] = force[at + 30 :]
        return out

    for step in required_frictions(walkway_of(_changed(trial, lost))):
        assert "step of the forces" in {flag.name for flag in step.measurement.caution_flags}


def test_the_sideways_line_to_the_pelvis_sees_crosstalk():
    """By mechanics: a share of the normal force that appears sideways moves it by itself."""
    trial = read_trial(DATA / SOUND[0])
    offsets = [
        step_features(Step(walk := walkway_of(t), required_frictions(walk)[0].stance))[
            "sideways offset of the force line"
        ]
        for t in (trial, _changed(trial, lambda f, up: f + np.outer(f @ up, [0.05, 0.0, 0.0])))
    ]
    assert abs(offsets[1] - offsets[0]) == pytest.approx(0.05, abs=0.002)


def test_leaks_between_channels_move_their_feature_by_themselves():
    """By mechanics: of the shear 0.5 that goes into another channel moves its slope by 0.5."""
    trial = read_trial(DATA / SOUND[0])  # walks along y
    plain, aside, normal = (
        step_features(Step(walk := walkway_of(t), required_frictions(walk)[0].stance))
        for t in (
            trial,
            _changed(trial, lambda f, _: f + np.outer(f[:, 1], [0.5, 0.0, 0.0])),
            _changed(trial, lambda f, _: f + np.outer(f[:, 1], [0.0, 0.0, 0.5])),
        )
    )
    change = aside["shear in the sideways force"] - plain["shear in the sideways force"]
    assert abs(change) == pytest.approx(0.5, abs=0.03)  # she walks a few degrees off y
    assert abs(normal["shear in the mass"] - plain["shear in the mass"]) == pytest.approx(
        0.5, abs=0.1
    )


def test_a_plate_that_rings_is_noticed():
    trial = read_trial(DATA / SOUND[0])

    def ringing(force, _):
        out, at = force.copy(), int(np.flatnonzero(force[:, 2] > 20.0)[0])
        time = np.arange(len(out) - at) / 1000.0
        out[at:, :2] += (60 * np.exp(-time / 0.1) * np.sin(2 * np.pi * 20 * time))[:, None]
        return out

    for step in required_frictions(walkway_of(_changed(trial, ringing))):
        assert "turns of the shear" in {flag.name for flag in step.measurement.caution_flags}


def test_the_shape_of_the_normal_force_is_not_judged_in_fast_walks():
    trial = read_trial(DATA / SOUND[0])
    (first, *_) = required_frictions(walkway_of(trial))
    way = first.stance.walking
    faster = {
        name: replace(m, positions=m.positions + np.outer(m.time, 0.8 * way))
        for name, m in trial.markers.items()
    }
    slow, fast = (
        judged_features(Step(w, first.stance))
        for w in map(walkway_of, (trial, replace(trial, markers=faster)))
    )
    assert set(slow) - set(fast) == set(VERTICAL)


@pytest.mark.parametrize("rate", [25.0, 100.0])
def test_forces_drawn_out_on_lines_are_noticed(rate):
    trial = read_trial(DATA / SOUND[0])

    def drawn(force, up):
        time = np.arange(len(force)) / 1000.0
        knots = np.arange(0.0, time[-1], 1.0 / rate)
        return np.column_stack(
            [np.interp(time, knots, np.interp(knots, time, column)) for column in force.T]
        )

    for step in required_frictions(walkway_of(_changed(trial, drawn))):
        assert "samples drawn out" in {flag.name for flag in step.measurement.caution_flags}


def test_shear_that_ends_early_lags_the_normal_force_at_toe_off_alone():
    """Of a stance's second half 20 samples sooner, 17 ms at 1200 a second."""
    trial = read_trial(DATA / SOUND[0])
    stance = required_frictions(walkway_of(trial))[0].stance
    middle, sooner = (stance.start + stance.stop) // 2, 20

    def moved(force, up):
        normal = np.outer(force @ up, up)
        shear = force - normal
        shear[middle:-sooner] = shear[middle + sooner :]
        return normal + shear

    plain, early = (
        step_features(Step(walkway_of(t), stance)) for t in (trial, _changed(trial, moved))
    )
    rate = walkway_of(trial).plate(stance.plate).rate
    at_contact, at_toe_off = (
        early[name] - plain[name]
        for name in ("shear after normal at contact", "shear after normal at toe off")
    )
    assert at_contact == 0.0
    assert at_toe_off == pytest.approx(-sooner / rate, abs=2.1 / rate)
    assert plain["shear after normal at contact"] != plain["shear after normal at toe off"]
