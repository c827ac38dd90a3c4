"""A jump, a run, stairs, a turn or standing is never an accepted step of level walking."""

from dataclasses import replace

import numpy as np
import pytest

from underfoot.trials import Trial, axes_of, body_weight, finished_plate, read_trial, walkway_of
from underfoot.trials import required_frictions as steps_of
from underfoot.trials.simulator.activities import ACTIVITIES, activity, activity_c3d

UP = np.array([0.0, 0.0, 1.0])


def _trial(tmp_path, name, *, markers=True, crossed=False, mass=0.0) -> Trial:
    recording = activity(name, np.random.default_rng(1), markers=markers)
    path = tmp_path / "one.c3d"
    path.write_bytes(activity_c3d(recording, crossed=crossed, mass=mass))
    return read_trial(path)


def _on_one_plate(trial: Trial) -> Trial:
    """Both feet on one plate whose corners nobody wrote down: no centre of pressure either."""
    force = trial.plates[0].force + trial.plates[1].force
    return replace(trial, plates=(finished_plate("plate 1", force, rate=1000.0, up=UP),))


@pytest.mark.parametrize("crossed", [False, True])
@pytest.mark.parametrize("mass", [0.0, 70.0])
@pytest.mark.parametrize("markers", [True, False])
@pytest.mark.parametrize("name", [name for name in ACTIVITIES if name != "walk"])
def test_no_other_activity_is_an_accepted_step(tmp_path, name, markers, mass, crossed):
    trial = _trial(tmp_path, name, markers=markers, mass=mass, crossed=crossed)
    for recording in (trial, _on_one_plate(trial)):
        assert all(step.verdict != "accepted" for step in steps_of(walkway_of(recording)))


@pytest.mark.parametrize("mass", [0.0, 70.0])
@pytest.mark.parametrize("markers", [True, False])
def test_walking_is_accepted(tmp_path, markers, mass):
    steps = steps_of(walkway_of(_trial(tmp_path, "walk", markers=markers, mass=mass)))
    assert [step.verdict for step in steps] == ["accepted", "accepted"]
    for step in steps:
        assert step.measurement.value == pytest.approx(0.2, abs=0.005)


def test_crossed_corners_are_put_in_order_and_said(tmp_path):
    """A drop jump over two plates, one written with corners 1, 2, 4, 3: both plates count."""
    plain = _trial(tmp_path, "drop_jump", markers=False)
    crossed = _trial(tmp_path, "drop_jump", markers=False, crossed=True)
    for plate, other in zip(crossed.plates, plain.plates, strict=True):
        assert plate.usable
        np.testing.assert_allclose(plate.force, other.force, atol=1e-6)
        assert "corners" in [flag.name for flag in plate.flags]
    reasons = [step.measurement.reason for step in steps_of(walkway_of(crossed))]
    assert any("one foot on both, or a jump" in reason for reason in reasons)


def test_standing_gives_body_weight(tmp_path):
    trial = _trial(tmp_path, "jump", markers=False)
    weight = body_weight(trial, axes_of(trial))
    assert weight is not None
    assert weight.standing
    assert weight.newtons == pytest.approx(70.0 * 9.80665, rel=0.01)
    assert body_weight(_trial(tmp_path, "walk", markers=False)) is None
