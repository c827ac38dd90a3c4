"""What a reviewer found wrong once, each as a test that would fail again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.trials import (
    DEFINITIONS,
    Marker,
    Measurement,
    PlateAccuracy,
    Trial,
    finished_plate,
    mean_of,
    profile_from,
    read_trial,
    required_friction,
    required_frictions,
    slip,
    stances,
    walkway_of,
)
from underfoot.trials.recording.plates import channel_forces, ordered_corners, plate_axes
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.recording.signals import is_saturated, unloaded_samples
from underfoot.trials.simulator import (
    Defects,
    SlipTruth,
    simulated_folder,
    slip_truth,
    walk_c3d,
    walk_with_slip,
)
from underfoot.trials.study import analyse_folder
from underfoot.trials.study.steps import rcof_definition
from underfoot.trials.walking.events import no_contact_reason
from underfoot.trials.walking.gait_context import gait_context
from underfoot.trials.walking.slips import Outcome

DATA = Path(__file__).parents[1] / "data" / "trials"
UP = np.array([0.0, 0.0, 1.0])


@pytest.fixture(scope="module")
def walk() -> Trial:
    return read_trial(DATA / "biomechzoo" / "HC030A05.c3d")


# ------------------------------------------------------------------------- sliding heels


def test_a_step_whose_heel_slides_has_no_required_friction(tmp_path):
    """Heel at 0.61 m/s on plate 2: the ratio there is ACOF; the dry step on plate 1 counts."""
    truth = SlipTruth(rcof=0.23, acof=0.16, peak_speed=0.61)
    path = tmp_path / "slip.c3d"
    path.write_bytes(walk_c3d(walk_with_slip(truth, Defects(), np.random.default_rng(2))))
    dry, sliding = required_frictions(walkway_of(read_trial(path)))
    assert dry.measurement.value == pytest.approx(0.23, abs=0.005)
    assert sliding.measurement.value is None
    assert "available friction (ACOF), not required" in sliding.measurement.reason
    one = analyse_folder(tmp_path, protocol("level_walking"), processes=1).files[0]
    assert one.main["rcof"] == dry.measurement.value


def test_slip_start_lies_within_twice_its_uncertainty():
    """200 made-up slips: 90 to 97 % of the truths lie within 2 u."""
    inside, late = 0, []
    for number in range(200):
        truth, defects, _ = slip_truth(number, 5)
        recording = walk_with_slip(truth, defects, np.random.default_rng([5, number]))
        one = slip(Marker(recording.markers["LHEE"], 200.0), 2.2, up=UP)
        assert one.start.value is not None
        assert one.start.uncertainty is not None
        error = one.start.value - recording.truth["slip_start"]
        inside += abs(error) <= 2.0 * one.start.uncertainty
        late.append(error)
    assert 180 <= inside <= 194
    assert abs(np.mean(late)) < 0.003


def test_the_heel_s_lift_is_no_slip_distance():
    """Distance is that in the floor's plane: a heel that rises 20 mm while it slides 60 mm."""
    time = np.arange(0.0, 1.5, 0.005)
    speed = np.where(time < 0.5, 1.5, 0.02)
    ramp = (time >= 0.54) & (time < 0.94)
    speed[ramp] += 0.3 * np.sin(np.pi * (time[ramp] - 0.54) / 0.4)
    height = 0.02 * np.clip((time - 0.54) / 0.4, 0.0, 1.0)
    path = np.column_stack((np.cumsum(speed) * 0.005, np.zeros(len(time)), height))
    flat = path * [1.0, 1.0, 0.0]
    lifted, level = (slip(Marker(p, 200.0), 0.5, up=UP).distance.value for p in (path, flat))
    assert lifted == pytest.approx(level, rel=1e-6)


def test_slips_are_classed_by_distance_and_way():
    walking = np.array([1.0, 0.0, 0.0])
    kinds = Outcome.LONG_SLIDE, Outcome.SLIDE, Outcome.NO_SLIP
    for peak, way, outcome in zip((1.2, 0.35, 0.06), (1.0, -1.0, 1.0), kinds, strict=True):
        time = np.arange(0.0, 1.5, 0.005)
        speed = np.where(time < 0.5, 1.5, 0.01)
        ramp = (time >= 0.54) & (time < 0.84)
        pulse = np.zeros(len(time))
        pulse[ramp] = peak * np.sin(np.pi * (time[ramp] - 0.54) / 0.3)
        x = np.cumsum(np.where(time < 0.5, speed, 0.01 + way * pulse)) * 0.005
        path = np.column_stack((x, np.zeros(len(time)), np.zeros(len(time))))
        one = slip(Marker(path, 200.0), 0.5, up=UP, walking=walking)
        assert one.outcome is outcome
        if outcome is not Outcome.NO_SLIP:
            assert one.way == ("forward" if way > 0 else "backward")


def test_a_false_alarm_of_the_speed_rule_is_named():
    """A heel that starts to 0.45 m/s for a tenth of a second: a slip by speed, not by distance."""
    truth = SlipTruth(peak_speed=0.45, rise=0.05, fall=0.06)
    recording = walk_with_slip(truth, Defects(), np.random.default_rng(1))
    one = slip(Marker(recording.markers["LHEE"], 200.0), 2.2, up=UP)
    assert one.slipped
    assert one.outcome is Outcome.MICROSLIP
    (flag,) = [f for f in one.peak_speed.caution_flags if f.name == "speed against distance"]
    assert "false alarm" in flag.message
    assert flag.limit == 0.2


# ----------------------------------------------------------------------------- plates


def test_a_wandering_level_is_still_unloaded():
    """Unloaded 89 % of 5 s, the level wanders between -18 and -13 N."""
    time = np.arange(0.0, 5.0, 1e-3)
    level = -15.5 + 2.5 * np.sin(2 * np.pi * 0.3 * time)
    level += np.random.default_rng(0).normal(0.0, 0.8, len(time))
    loaded = (time > 2.0) & (time < 2.55)
    mask = unloaded_samples(np.where(loaded, 700.0, level), 1000.0)
    assert mask.sum() > 0.85 * (~loaded).sum()
    assert not mask[loaded].any()


def test_a_noisy_treadmill_is_unloaded_between_its_steps():
    """A belt unloaded a third of 30 s with 15 N of noise: the level is found within 1 N."""
    time = np.arange(0.0, 30.0, 1e-3)
    share = (time % 1.05) / 0.7
    load = np.where(share < 1, 750.0 * np.sin(np.pi * np.clip(share, 0, 1)) ** 0.5, 0.0)
    noise = np.random.default_rng(1).normal(6.0, 15.0, len(time))
    mask = unloaded_samples(load + noise, 1000.0)
    assert mask.sum() > 0.5 * (load == 0).sum()
    assert (load + noise)[mask].mean() == pytest.approx(6.0, abs=1.0)


def test_standing_on_a_coarse_converter_is_not_saturated():
    steps = 7.5
    time = np.arange(0.0, 5.0, 1e-3)
    load = np.clip((time - 1.0) / 0.3, 0.0, 1.0) * 700.0 + 4.0 * np.sin(2 * np.pi * 0.5 * time)
    assert not is_saturated(steps * np.round(load / steps), 1000.0)
    stepped_on = np.where(time < 2.0, load, 0.0)
    assert is_saturated(np.minimum(stepped_on, 500.0), 1000.0)


def test_the_free_moment_of_a_type_3_plate_turns_as_its_force_couple():
    """fx12 backward at +y and fx34 forward at -y turn the plate by b (fx34 - fx12)."""
    signals = np.zeros((1, 8))
    signals[0, 0], signals[0, 1] = -10.0, 10.0
    _, moment = channel_forces(3, signals, np.array([0.12, 0.2, 0.0]), None)
    # r x F of -10 N along x at y = +0.2 and 10 N along x at y = -0.2: both +2 N m about z.
    np.testing.assert_allclose(moment, [[0.0, 0.0, 4.0]])
    signals[0, :2] = 0.0
    signals[0, 2], signals[0, 3] = 10.0, -10.0  # fy14 at x = +a, fy23 at x = -a
    _, moment = channel_forces(3, signals, np.array([0.12, 0.2, 0.0]), None)
    np.testing.assert_allclose(moment, [[0.0, 0.0, 2.4]])


@pytest.mark.parametrize("order", [[0, 1, 3, 2], [0, 2, 1, 3], [0, 3, 1, 2], [0, 1, 2, 3]])
def test_crossed_corners_are_put_in_order(order):
    corners = np.array([[0.6, 0.9, 0], [0.6, 0.0, 0], [0.0, 0.0, 0], [0.0, 0.9, 0]])
    mended, changed = ordered_corners(corners[order])
    assert changed == (order != [0, 1, 2, 3])
    np.testing.assert_array_equal(mended[0], corners[0])
    assert plate_axes(mended)[2, 2] == pytest.approx(-1.0)


# ------------------------------------------------------------------------------ files


def test_a_plate_with_crossed_corners_lies_as_the_others_of_its_file():
    """Mean forces as the maker's own text of the recording is read (biomdp, the same name)."""
    trial = read_trial(DATA / "biomdp" / "kistler_DJ_2plates.c3d", subtract_baseline=False)
    for plate, mean in zip(
        trial.plates, [(-2.314, 3.763, 357.763), (1.336, -6.376, 231.456)], strict=True
    ):
        assert plate.force.mean(axis=0) == pytest.approx(mean, abs=0.5)
    assert [any("crossed" in f.message for f in p.flags) for p in trial.plates] == [False, True]


def test_more_markers_than_announced_are_read(tmp_path):
    """28 tracked and further virtual markers: NumMarkers counts the tracked ones."""
    text = (DATA / "bmc" / "walk1.trc").read_text().splitlines()
    head = text[2].split("\t")
    head[3] = "20"
    text[2] = "\t".join(head)
    (tmp_path / "walk1.trc").write_text("\n".join(text) + "\n")
    trial = read_trial(tmp_path / "walk1.trc")
    assert len(trial.markers) == 28
    assert any("NumMarkers is 20" in note for note in trial.notes)


def test_a_bad_partner_does_not_take_the_good_file_along(tmp_path):
    (tmp_path / "walk1.forces").write_bytes((DATA / "bmc" / "walk1.forces").read_bytes())
    (tmp_path / "walk1.trc").write_text("PathFileType\t4\nbroken\n")
    one = analyse_folder(tmp_path, protocol("level_walking"), processes=1).files[0]
    assert one.verdict == "caution"
    assert any("walk1.trc" in reason for reason in one.reasons)
    assert one.main["rcof"] == pytest.approx(0.19, abs=0.02)


def _table(tmp_path, head: str) -> Trial:
    path = tmp_path / "t.csv"
    columns = head.count(",")
    rows = [f"{i / 1000:.3f}" + ",1" * columns for i in range(300)]
    path.write_text(head + "\n" + "\n".join(rows) + "\n")
    return read_trial(path)


def test_four_causes_of_no_contact_are_told_apart(tmp_path):

    def reason(trial):
        return no_contact_reason(walkway_of(trial))

    assert reason(Trial("t")) == "the file holds no force plate"
    assert "no columns are recognised" in reason(_table(tmp_path, "time,Kraft X1,Kraft Z1"))
    unit = reason(_table(tmp_path, "time (s),Fx (furlong),Fy (furlong),Fz (furlong)"))
    assert '"furlong" is not one known unit of force' in unit
    assert "protocol for testers" in reason(_table(tmp_path, "time (s),COF,speed (m/s)"))
    idle = reason(_table(tmp_path, "time (s),Fx (N),Fy (N),Fz (N)"))
    assert "nobody steps on a force plate: the largest vertical force is 0 N" in idle


# ---------------------------------------------------------------------------- numbers


def test_rcof_of_persons_not_of_steps_and_means(tmp_path):
    from underfoot.questions.slips import measured_rcof
    from underfoot.trials.pages.report import csv_text

    simulated_folder("slips", tmp_path, count=4)
    analysis = analyse_folder(tmp_path, protocol("report_g6"), processes=1)
    table = next(table for table in analysis.tables if table.name == "measurements")
    path = tmp_path / "measurements.csv"
    path.write_text(csv_text(table))
    people: dict[str, list[float]] = {}
    for one in analysis.files:
        for step in one.steps:
            if step.rcof is not None:
                people.setdefault(one.conditions["subject"], []).append(step.rcof)
    means = [np.mean(values) for values in people.values()]
    read = measured_rcof(path)
    assert len(means) == 2
    assert read.mean == pytest.approx(np.mean(means))
    assert read.sd == pytest.approx(np.std(means, ddof=1))
    assert "between 2 persons" in read.text
    path.write_text("file,person,item,quantity,value,caution\na,S1,step 1,rcof,0.2,\n")
    with pytest.raises(InputError, match="there is no spread"):
        measured_rcof(path)


def test_standard_deviation_and_standard_error_have_different_signs():
    mean = mean_of([Measurement("rcof", value) for value in (0.20, 0.22, 0.24)])
    assert mean.spread == pytest.approx(0.02)
    assert mean.uncertainty == pytest.approx(0.02 / np.sqrt(3))
    assert "±" not in str(mean)
    assert "SD 0.02" in str(mean)
    assert "±" in str(Measurement("rcof", 0.2, uncertainty=0.01))


def test_one_step_has_an_uncertainty_of_its_plate_and_filter(walk):
    stance = stances(walkway_of(walk))[0]
    usual = required_friction(walkway_of(walk), stance).measurement
    exact = replace(
        walk, plates=tuple(replace(p, accuracy=PlateAccuracy(0.0, 0.0)) for p in walk.plates)
    )
    rest = required_friction(walkway_of(exact), stance).measurement
    assert usual.uncertainty**2 - rest.uncertainty**2 == pytest.approx(
        (2 * (0.01 * usual.value) ** 2 + 0.01**2) / 3, rel=1e-6
    )
    assert 0.001 < rest.uncertainty < 0.01
    assert "readings of the filter's name" in usual.conventions["uncertainty"]


def test_the_specification_of_plates_comes_from_the_profile():
    one = profile_from({"accuracy": {"gain": "0.5 %", "crosstalk": "2 %", "source": "data sheet"}})
    assert one.accuracy == PlateAccuracy(0.005, 0.02, "data sheet")
    with pytest.raises(InputError, match="shares"):
        profile_from({"accuracy": {"gain": "200 %"}})
    with pytest.raises(InputError, match="crosstalk"):
        profile_from({"accuracy": {"cross": "1 %"}})


def test_a_protocol_takes_every_definition(tmp_path):
    (tmp_path / "HC030A05.c3d").write_bytes((DATA / "biomechzoo" / "HC030A05.c3d").read_bytes())
    head = '[protocol.mine]\ntitle = "x"\nkind = "gait"\nsource = "x"\n[protocol.mine.method]\n'
    folder = tmp_path / "catalogue"
    folder.mkdir()

    def rcof(lines: str) -> list[float]:
        (folder / "mine.toml").write_text(head + lines)
        found = analyse_folder(tmp_path, protocol("mine", [folder]), processes=1)
        return [step.rcof for step in found.files[0].steps]

    trial = read_trial(tmp_path / "HC030A05.c3d")
    for name, lines in (
        ("peak-3", 'definition = "peak-3"\n'),
        ("anterior-posterior", 'rcof_shear = "anterior-posterior"\n'),
        ("unfiltered", 'rcof_filter = "none"\n'),
        ("gate-body-weight", 'rcof_gate_body_weight = "15 %"\n'),
        ("plain-maximum", 'rcof_peak = "plain-maximum"\nrcof_braking = "no"\n'),
    ):
        expected = [
            s.measurement.value for s in required_frictions(walkway_of(trial), DEFINITIONS[name])
        ]
        assert rcof(lines) == expected
    (folder / "mine.toml").write_text(head + 'rcof_peek = "x"\n')
    wrong = protocol("mine", [folder])
    with pytest.raises(InputError, match="rcof_peak"):
        rcof_definition(wrong)


def test_cautions_of_steps_are_counted_and_decide_the_verdict(tmp_path):
    """The 90 degree turn of this file is used with a caution; the straight walk is accepted."""
    for name in ("HC030A05.c3d", "HC036A23.c3d"):
        (tmp_path / name).write_bytes((DATA / "biomechzoo" / name).read_bytes())
    straight, turned = analyse_folder(tmp_path, protocol("level_walking"), processes=1).files
    assert straight.verdict == "accepted"
    assert (straight.facts["steps"], straight.facts["steps_with_caution"]) == (2.0, 0.0)
    assert turned.verdict == "caution"
    assert turned.facts["steps_with_caution"] == 1.0
    assert any("turns by 26 deg" in reason for reason in turned.reasons)


# ---------------------------------------------------------------- the walk around a step


def test_gait_context_of_a_made_up_walk(tmp_path):
    from underfoot.trials.simulator.activities import activity, activity_c3d

    path = tmp_path / "walk.c3d"
    path.write_bytes(activity_c3d(activity("walk", np.random.default_rng(1))))
    trial = read_trial(path)
    found = stances(walkway_of(trial))
    first, second = (gait_context(walkway_of(trial), stance, found) for stance in found)
    assert first.step_length is None
    assert second.step_length == pytest.approx(0.62, abs=0.01)
    assert second.step_time == pytest.approx(0.55, abs=0.02)
    assert second.cadence == pytest.approx(1 / 0.55, rel=0.03)
    assert second.walking_speed == pytest.approx(1.3, rel=0.05)
    assert second.foot_angle == pytest.approx(0.0, abs=0.05)


def test_gait_context_of_a_real_walk(walk):
    """A child of 45.8 kg at 1.05 m/s lands on its heel, 15 to 30 deg toe up."""
    found = stances(walkway_of(walk))
    one = gait_context(walkway_of(walk), found[1], found)
    assert 0.9 < one.walking_speed < 1.2
    assert 0.4 < one.step_length < 0.7
    assert one.step_time == pytest.approx(found[1].contact - found[0].contact)
    assert np.radians(5) < one.foot_angle < np.radians(40)
    assert 0.05 < one.heel_speed < 1.5


def test_what_is_held_shows_itself_shortly(walk):
    step = required_frictions(walkway_of(walk))[0]
    for one in (walk, step, step.measurement):
        assert len(repr(one)) < 200
        assert len(one.summary().splitlines()) > 3
        assert "<table>" in one._repr_html_()
        assert len(one.to_frame()) == len(one.table().rows)


def test_a_plate_never_unloaded_is_a_caution():
    stood = finished_plate("plate 1", np.full((3000, 3), [0.0, 0.0, 700.0]), rate=1000.0, up=UP)
    assert [flag.name for flag in stood.flags if flag.matters] == ["baseline"]


def test_a_trial_itself_answers_with_a_warning_for_one_version():
    trial = read_trial(DATA / "biomechzoo" / "HC030A05.c3d")
    with pytest.warns(FutureWarning, match=r"required_frictions\(walkway_of\(trial\)\)"):
        steps = required_frictions(trial)  # pyright: ignore[reportArgumentType]
    expected = required_frictions(walkway_of(trial))
    assert [s.measurement for s in steps] == [s.measurement for s in expected]
