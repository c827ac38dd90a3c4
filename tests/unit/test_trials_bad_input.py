"""What is no step, no slip or no number is told as such, with the reason."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from underfoot.core import DataError, InputError
from underfoot.core.remark import Message
from underfoot.trials import (
    Channel,
    Marker,
    Measurement,
    Plate,
    Trial,
    axes_of,
    described_file,
    file_checksum,
    finished_plate,
    heel_candidates,
    read_trial,
    required_frictions,
    slip_of,
    stances,
    walkway_of,
)

DATA = Path(__file__).parents[1] / "data" / "trials"
WALK = DATA / "biomechzoo" / "HC030A05.c3d"
UP = np.array([0.0, 0.0, 1.0])


@pytest.fixture(scope="module")
def walk() -> Trial:
    return read_trial(WALK)


def _refinished(plate: Plate, force: np.ndarray, **changes) -> Plate:
    given = {
        "rate": plate.rate,
        "start": plate.start,
        "up": UP,
        "moment": plate.moment,
        "corners": plate.corners,
    }
    return finished_plate(plate.name, force, **{**given, **changes})


def _reasons(trial: Trial) -> list[str]:
    return [f.measurement.reason for f in required_frictions(walkway_of(trial))]


def test_an_overloaded_plate_is_rejected(walk):
    second = walk.plates[1]
    clipped = second.force.copy()
    clipped[:, 2] = np.minimum(clipped[:, 2], 400.0)
    plate = _refinished(second, clipped)
    assert plate.saturated
    assert _reasons(replace(walk, plates=(plate,))) == ["the plate is saturated"]


def test_two_feet_on_one_plate_are_rejected(walk):
    one, two = walk.plates
    corners = np.concatenate((one.corners, two.corners))
    low, high = corners.min(axis=0), corners.max(axis=0)
    union = np.array(
        [[high[0], high[1], 0], [low[0], high[1], 0], [low[0], low[1], 0], [high[0], low[1], 0]]
    )
    both = _refinished(one, one.force + two.force, corners=union, moment=None)
    (reason,) = _reasons(replace(walk, plates=(both,)))
    assert "both heels" in reason or "more than one foot" in reason
    blind = replace(walk, plates=(both,), markers={})
    (step,) = required_frictions(walkway_of(blind))  # without markers the shape of the force tells
    assert step.verdict == "caution"
    assert "single hump" in [flag.name for flag in step.measurement.caution_flags]


def test_one_foot_across_two_plates_is_rejected(walk):
    second = walk.plates[1]
    left = _refinished(second, 0.6 * second.force, corners=second.corners)
    right = replace(_refinished(second, 0.5 * second.force), name="plate 9")
    reasons = _reasons(replace(walk, plates=(left, right)))
    assert len(reasons) == 2
    assert all("one foot on both, or a jump" in reason for reason in reasons)


def test_a_partial_hit_is_rejected(walk):
    second = walk.plates[1]
    (reason,) = _reasons(replace(walk, plates=(_refinished(second, 0.5 * second.force),)))
    assert reason.startswith("partial: ")
    assert "% of body weight" in reason


def _bump(duration: float, height: float, shear: float = 0.0) -> Trial:
    time = np.arange(0.0, 3.0, 1e-3)
    inside = (time > 1.0) & (time < 1.0 + duration)
    shape = np.where(inside, np.sin(np.pi * (time - 1.0) / duration), 0.0)
    force = np.outer(height * shape, [0.0, 0.0, 1.0])
    force[:, 0] = shear * height * shape * np.where(time < 1.0 + duration / 2, -1.0, 1.0)
    return Trial("bump", plates=(finished_plate("plate 1", force, rate=1000.0, up=UP),))


def test_jumps_and_other_contacts_are_no_gait():
    assert "too short" in _reasons(_bump(0.25, 2000.0, 0.1))[0]  # running
    assert "standing" in _reasons(_bump(1.8, 700.0, 0.1))[0]
    landing = _bump(0.8, 700.0, 0.1)
    force = landing.plates[0].force.copy()
    force[1040:1080, 2] += 2500.0 * np.hanning(40)
    spike = finished_plate("plate 1", force, rate=1000.0, up=UP)
    assert "an impact" in _reasons(replace(landing, plates=(spike,)))[0]
    hop = replace(
        _bump(0.6, 700.0, 0.0),
        markers={f"m{i}": Marker(np.full((300, 3), 0.1 * i), 100.0) for i in range(4)},
    )
    assert "markers move at 0.00 m/s only" in _reasons(hop)[0]
    assert "no walking direction" in _reasons(_bump(0.6, 700.0, 0.0))[0]


def test_an_empty_and_a_never_empty_plate():
    noise = np.random.default_rng(0).normal(0.0, 0.5, (3000, 3))
    empty = finished_plate("plate 1", noise + np.array([3.0, 0.0, -8.0]), rate=1000.0, up=UP)
    assert empty.baseline == pytest.approx([3.0, 0.0, -8.0], abs=0.1)
    assert any("shear baseline of 3.0 N" in flag.message for flag in empty.flags)
    assert _reasons(Trial("empty", plates=(empty,))) == []
    stood = finished_plate("plate 1", noise + np.array([0.0, 0.0, 700.0]), rate=1000.0, up=UP)
    assert stood.baseline is None
    assert any("never unloaded" in flag.message for flag in stood.flags)
    assert _reasons(Trial("stood", plates=(stood,))) == ["begins before the record"]


def test_upside_down_forces_are_turned_and_said(walk):
    plate = walk.plates[1]
    turned = _refinished(plate, -plate.force, moment=-plate.moment)
    assert any("signs reversed" in flag.message for flag in turned.flags)
    np.testing.assert_allclose(turned.force, plate.force, atol=1e-9)
    np.testing.assert_allclose(
        np.nan_to_num(turned.centre_of_pressure), np.nan_to_num(plate.centre_of_pressure), atol=1e-9
    )


def test_wrong_units_are_noticed(walk):
    plate = walk.plates[1]
    kilo = _refinished(plate, plate.force / 1e3)
    assert any("is the unit right" in flag.message for flag in kilo.flags)
    milli = _refinished(plate, plate.force * 1e3)
    assert any("is the unit right" in flag.message for flag in milli.flags)


def test_lost_samples_reject_the_step(walk):
    plate = walk.plates[1]
    force = plate.force.copy()
    middle = int((stances(walkway_of(walk))[0].contact + 0.1 - plate.start) * plate.rate)
    force[middle : middle + 40] = np.nan
    holes = _refinished(plate, force)
    reasons = _reasons(replace(walk, plates=(holes,)))
    assert "samples without a number" in reasons[0] or "too short" in reasons[0]


def test_a_heel_missing_at_contact_gives_no_slip(walk):
    stance = stances(walkway_of(walk))[0]
    heel = walk.marker(stance.heel)
    path = heel.positions.copy()
    first = int((stance.contact - heel.start) * heel.rate)
    path[first - 15 : first + 15] = np.nan
    trial = replace(walk, markers={**walk.markers, stance.heel: replace(heel, positions=path)})
    found = slip_of(walkway_of(trial), stance)
    assert found.slipped is None
    assert "missing" in found.peak_speed.reason


def test_names_are_found_forgivingly_and_missed_ones_suggested(walk):
    assert walk.channel("FORCE.FX1") is walk.channels["Force.Fx1"]
    with pytest.raises(DataError, match='Did you mean "LHEE"'):
        walk.marker("LHEEL")
    with pytest.raises(DataError, match="has no channels"):
        Trial("nothing").channel("Fz")
    assert file_checksum(WALK) == walk.checksum


def test_measurements_hold_a_number_or_a_reason():
    assert Measurement("rcof", 0.2).reason == "uncertainty not estimated"
    assert str(Measurement.not_estimated("rcof", "cut")) == "rcof: not estimated (cut)"
    with pytest.raises(ValueError, match="neither"):
        Measurement("rcof", None)
    with pytest.raises(ValueError, match="use None and a reason"):
        Measurement("rcof", float("nan"))
    with pytest.raises(ValueError, match="not allowed"):
        Measurement("rcof", 0.2, uncertainty=-1.0)
    with pytest.raises(ValueError, match="but no value"):
        Measurement("rcof", None, uncertainty=0.1, reason="x")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "empty"),
        (b"\n\n \n", "empty"),
        (b"\x00\x01\x02binary\x00", "not a text file"),
        (b"time,Fz\n", "no table"),
        (b"time,Fz\n0.0,1\n0.1,2\n0.1,3\n0.3,4\n", "does not increase at row 3"),
        (b"time (kg),Fz\n0.0,1\n0.1,2\n", "no time column"),
        (b"time,Fz\n0.0,1\n0.1,2\n0.2,3,9\n0.3,4\n", "3 cells, the header 2"),
        (b"time,Fx,Fz\n0.0,1,1\n0.1,2,2\n0.2,3,3\n0.3,", "truncated"),
    ],
)
def test_bad_tables_are_refused(tmp_path, content, message):
    path = tmp_path / "bad.csv"
    path.write_bytes(content)
    with pytest.raises(DataError, match=message):
        read_trial(path)


def test_missing_files_and_folders_are_refused(tmp_path):
    with pytest.raises(DataError, match="can't be read"):
        read_trial(tmp_path / "none.c3d")
    with pytest.raises(DataError, match="can't be read"):
        read_trial(tmp_path)


@pytest.mark.parametrize("name", ["biomechzoo/HC030A05.c3d", "bmc/walk1.trc", "bmc/walk1.forces"])
@pytest.mark.parametrize("share", [0.001, 0.05, 0.5, 0.98])
def test_truncated_recordings_are_refused(tmp_path, name, share):
    data = (DATA / name).read_bytes()
    path = tmp_path / Path(name).name
    path.write_bytes(data[: int(share * len(data))])
    with pytest.raises(DataError):
        read_trial(path)


def test_a_log_of_several_steps_needs_a_choice():
    path = DATA / "cetr" / "HT-2n-6-4_2_001.csv"
    with pytest.raises(DataError, match="holds 2 steps"):
        read_trial(path)
    assert read_trial(path, step=2).name.endswith("step 2")
    with pytest.raises(DataError, match="no step 3"):
        read_trial(path, step=3)


def test_duplicate_and_single_columns(tmp_path):
    path = tmp_path / "d.csv"
    path.write_text("time,Fz,Fz,Fz #2\n" + "".join(f"{i / 10},1,2,3\n" for i in range(9)))
    trial = read_trial(path)
    assert list(trial.channels) == ["time", "Fz", "Fz #2", "Fz #2 #2"]
    assert [c.values[0] for c in list(trial.channels.values())[1:]] == [1.0, 2.0, 3.0]
    assert any("duplicate" in note for note in trial.notes)


def test_channels_know_their_time():
    even = Channel(np.zeros(3), "N", 10.0, start=1.0)
    np.testing.assert_allclose(even.time, [1.0, 1.1, 1.2])
    uneven = Channel(np.zeros(2), "N", 10.0, times=np.array([0.0, 5.0]))
    np.testing.assert_allclose(uneven.time, [0.0, 5.0])


def _described(*arguments: str):
    from typer.testing import CliRunner

    from underfoot.cli.trials import trials_app

    return CliRunner().invoke(trials_app, ["describe", *arguments])


def test_describe_shows_what_was_taken_and_left():
    told = _described(str(DATA / "opensim" / "leg69_stance_grf.mot"))
    assert told.exit_code == 0
    for words in ("vertical +y", "rejected: begins before the record", "caution: RCOF 0.166"):
        assert words in told.output
    assert "treadmill" in told.output
    assert "Butterworth, 2nd order forward and backward" in told.output
    assert "at 1000 Hz" in _described(str(WALK)).output


def test_describe_joins_two_files_and_prints_json():
    folder = DATA / "bmc"
    told = _described(str(folder / "walk1.trc"), "--with", str(folder / "walk1.forces"), "--json")
    (one,) = json.loads(told.output)
    assert [s["side"] for s in one["stances"] if s["accepted"]] == ["left", "right", "left"]
    assert one["axes"]["vertical"] == "+y"


def test_describe_says_what_is_wrong(tmp_path):
    told = _described(str(tmp_path / "none.c3d"))
    assert told.exit_code == 3
    assert told.exception is None or isinstance(told.exception, SystemExit)
    assert _described(str(WALK), "--definition", "peak3").exit_code == 2
    assert _described(str(WALK), "--vertical", "up").exit_code == 2
    with pytest.raises(InputError, match='Did you mean "peak-3"'):
        described_file(WALK, definition="peak3")
    log = DATA / "cetr" / "HT-2n-6-4_2_001.csv"
    with pytest.raises(InputError, match="one trial each"):
        described_file(log, companion=WALK)


@pytest.mark.parametrize(
    ("label", "side"),
    [
        ("LHEE", "left"),
        ("Matt:RHEE", "right"),
        ("L.Heel", "left"),
        ("r heel", "right"),
        ("LCAL", "left"),
        ("RightHeel", "right"),
        ("Right_TalonInf", "right"),
        ("lateral heel R", "right"),
        ("heel", "unknown"),
        ("LHeelForce", None),
        ("LKNE", None),
    ],
)
def test_heels_are_recognised_by_the_labels_met_in_laboratories(label, side):
    trial = Trial("x", markers={label: Marker(np.zeros((5, 3)), 100.0)})
    found = [key for key, names in heel_candidates(trial).items() if names]
    assert found == ([side] if side else [])


def test_the_vertical_axis_comes_from_what_there_is(walk):
    bare = replace(walk, plates=(), events=(), vertical=None)
    assert axes_of(bare).up @ UP == 1.0
    assert "differ most" in axes_of(bare).up_from
    assert axes_of(Trial("x")).up_from.startswith("assumed")
    assert axes_of(walk, vertical="-y").up @ np.array([0.0, -1.0, 0.0]) == 1.0


def test_what_was_not_determined_is_no_number():
    missing = Measurement.not_estimated("acof", Message("the shoe is not loaded"))
    with pytest.raises(DataError, match="acof: was not determined: the shoe is not loaded"):
        float(missing)
    assert float(Measurement("n", 3, uncertainty=0.1)) == 3.0
