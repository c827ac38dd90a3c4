"""Treadmills: belts are found with their speed; a foot slides only if it slides on its belt."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from underfoot.core import DataError
from underfoot.trials import mean_of, read_trial, required_frictions, walkway_of
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.recording.trial import MADE_UP
from underfoot.trials.simulator import simulated_folder, treadmill_walk, walk_c3d
from underfoot.trials.study import analyse_folder

DATA = Path(__file__).parents[1] / "data" / "trials"


def _recording(tmp_path, **how):
    made = treadmill_walk(np.random.default_rng(1), **how)
    path = tmp_path / "belt.c3d"
    path.write_bytes(walk_c3d(made, mass=70.0))
    return made, read_trial(path)


@pytest.mark.parametrize("speeds", [(1.25, 1.25), (0.8, 1.4)])
def test_a_belt_recording_of_45_stances(tmp_path, speeds):
    made, trial = _recording(tmp_path, speeds=speeds)
    walk = walkway_of(trial)
    steps = required_frictions(walk)
    assert len(steps) == 45
    accepted = [step for step in steps if step.verdict == "accepted"]
    assert len(accepted) >= 40
    mean = np.mean([step.measurement.value for step in accepted])
    assert mean == pytest.approx(made.truth["rcof"], abs=0.005)
    for plate, speed, side in zip(("plate 1", "plate 2"), speeds, ("right", "left"), strict=True):
        assert walk.belts[plate].speed(10.0) == pytest.approx(speed, rel=0.03)
        assert {step.stance.side for step in steps if step.stance.plate == plate} == {side}
    said = accepted[0].measurement.conventions
    assert said["surface"] == "treadmill belt, level"
    assert said["belt"].startswith(f"{speeds[0]:.1f}"[:-1])
    assert "foot markers" in said["belt"]


def test_without_markers_the_centre_of_pressure_tells_the_belt(tmp_path):
    _, trial = _recording(tmp_path, stances=9)
    belts = walkway_of(replace(trial, markers={})).belts
    for belt in belts.values():
        assert belt.source == "centre of pressure"
        assert abs(belt.speed(3.0) - 1.25) < 3 * belt.uncertainty + 0.03 * 1.25
    assert len(belts) == 2


def test_a_heel_that_slides_on_the_belt_has_no_required_friction(tmp_path):
    _, trial = _recording(tmp_path, stances=9, slip=0.12)
    steps = required_frictions(walkway_of(trial))
    slides = [step for step in steps if "slides" in step.measurement.reason]
    assert [step.stance.number for step in slides] == [5]
    assert slides[0].slip.distance.value == pytest.approx(0.12, rel=0.1)


@pytest.mark.parametrize(
    "name", ["biomechzoo/HC030A05.c3d", "bmc/Gait.c3d", "kineticstoolkit/c3d_sample.c3d"]
)
def test_a_floor_is_no_belt(name):
    assert not walkway_of(read_trial(DATA / name)).belts


def test_a_recorded_walk_on_a_split_belt():
    """Twelve seconds of one person on two narrow belts, forces filtered at some 6 Hz (gaitalytics).

    Both feet are on one belt again and again: such contacts are rejected, the others are doubted.
    """
    walk = walkway_of(read_trial(DATA / "gaitalytics" / "treadmill_events.c3d"))
    assert [belt.source for belt in walk.belts.values()] == ["foot markers"] * 2
    assert [belt.speed(5.0) for belt in walk.belts.values()] == pytest.approx(
        [1.10, 1.10], abs=0.01
    )
    steps = required_frictions(walk)
    assert len(steps) == 22
    assert not any("slides" in step.measurement.reason for step in steps)
    # The first contact is cut by the record: when it began says nothing of the second.
    assert [s.stance.accepted for s in steps[:3]] == [False, True, True]
    kept = [step.measurement for step in steps if step.measurement.estimated]
    assert len(kept) == 8
    assert all("already filtered" in {f.name for f in m.caution_flags} for m in kept)
    mean = mean_of(kept)
    assert mean.value == pytest.approx(0.149, abs=0.001)
    assert mean.conventions["surface"] == "treadmill belt, level"
    assert "belt" not in mean.conventions


def test_a_recorded_leg_on_a_belt(tmp_path):
    """A leg in its plane (GaitAnalysisToolKit's test data), written as D-Flow does, across at zero.

    Two whole stances; the third ends after the record.
    """
    lines = (DATA / "gaitanalysistoolkit" / "rawdata.txt").read_text().splitlines()
    names = lines[0].lstrip("% ").split()
    columns = dict(zip(names, np.loadtxt(lines[1:]).T, strict=True))
    load = columns["FP2.ForY"]
    flat = np.zeros(len(load))
    columns |= {"FP2.ForZ": flat, "FP2.CopY": flat, "FP2.CopZ": flat}
    columns["FP2.CopX"] = np.where(load > 20, columns.pop("FP2.MomZ") / np.maximum(load, 20), 0)
    columns |= {name[:-1] + "Z": flat for name in names if name.endswith("PosX")}
    path = tmp_path / "leg.txt"
    rows = np.column_stack(list(columns.values()))
    text = ["\t".join(columns), *("\t".join(f"{v:.5f}" for v in row) for row in rows)]
    path.write_text("\n".join(text))
    trial = read_trial(path)
    assert trial.source == "D-Flow text"
    walk = walkway_of(trial)
    assert walk.belts["FP2"].speed(8.0) == pytest.approx(0.98, abs=0.03)
    # Body against the belt: shoulder and trochanter stay where they are.
    steps = required_frictions(walk)
    assert [step.measurement.estimated for step in steps] == [True, True, False]
    assert all(0.1 < step.measurement.value < 0.2 for step in steps[:2])
    assert all(step.slip.distance.value < 0.02 for step in steps[:2])


def test_a_recorded_stance_on_a_belt_by_its_centre_of_pressure():
    walk = walkway_of(read_trial(DATA / "opensim" / "leg69_stance_grf.mot"))
    assert walk.belts["plate 1"].speed(0.0) == pytest.approx(1.03, abs=0.05)


def test_the_methods_name_the_belts_and_their_speed(tmp_path):
    simulated_folder("treadmill", tmp_path / "in", count=1)
    analysis = analyse_folder(tmp_path / "in", protocol("level_walking"), processes=1)
    text = " ".join(analysis.methods)
    assert "Treadmill belts carried " in text
    assert "level" in text


def _dflow(tmp_path, trial, change=lambda table: table):
    """A trial as a D-Flow export: y up, frames at 100 Hz stamped up to 2 ms early or late."""
    turn = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])  # x right, y up, z ahead
    plates = [(p.name.replace("plate ", "FP"), p) for p in trial.plates]
    count = len(plates[0][1].force) // 10
    table = {
        "TimeStamp": 50.0
        + 0.01 * np.arange(count)
        + np.random.default_rng(1).uniform(-0.002, 0.002, count),
        "FrameNumber": np.arange(count) + 7.0,
    }
    for name, marker in trial.markers.items():
        place = marker.positions[: 2 * count : 2] @ turn.T
        table |= {f"{name}.Pos{a}": place[:, i] for i, a in enumerate("XYZ")}
    for name, plate in plates:
        for kind, values in (("Cop", plate.centre_of_pressure), ("For", plate.force)):
            values = np.nan_to_num(values.reshape(count, 10, 3).mean(axis=1)) @ turn.T
            table |= {f"{name}.{kind}{a}": values[:, i] for i, a in enumerate("XYZ")}
    table["Channel1.Anlg"] = np.zeros(count)
    table = change(table)
    path = tmp_path / "walk.txt"
    rows = zip(*table.values(), strict=True)
    path.write_text(
        "\n".join(["\t".join(table), *("\t".join(f"{v:.6f}" for v in r) for r in rows)])
    )
    return path


def test_dflow_text_gives_plates_markers_and_even_time(tmp_path):
    made, trial = _recording(tmp_path, stances=9)

    def lost(table):
        table["LTOE.PosX"][40:45] = table["LTOE.PosX"][39]
        table["LTOE.PosY"][40:45] = table["LTOE.PosY"][39]
        table["LTOE.PosZ"][40:45] = table["LTOE.PosZ"][39]
        return {name: np.delete(values, 60) for name, values in table.items()}

    read = read_trial(_dflow(tmp_path, trial, lost))
    assert read.source == "D-Flow text"
    assert [plate.name for plate in read.plates] == ["FP1", "FP2"]
    assert len(read.markers) == len(trial.markers)
    assert read.plates[0].rate == pytest.approx(100.0, rel=1e-3)
    assert read.markers["LTOE"].missing.nonzero()[0].tolist() == [*range(40, 45), 60]
    assert any("1 frames are not in the file" in note for note in read.notes)
    # The export has lost that it is made up: its force line is not that of a body.
    read = replace(read, settings={"software": MADE_UP})
    steps = [s for s in required_frictions(walkway_of(read)) if s.measurement.value is not None]
    assert len(steps) >= 8
    mean = np.mean([step.measurement.value for step in steps])
    assert mean == pytest.approx(made.truth["rcof"], abs=0.02)  # plates at 100 Hz


def test_a_recorded_dflow_file_is_read():
    """The first 59 frames of an empty treadmill: 30 markers, two plates, 100 Hz."""
    trial = read_trial(DATA / "gaitanalysistoolkit" / "stationary_60_lines.txt")
    assert (len(trial.plates), len(trial.markers)) == (2, 30)
    assert trial.plates[0].rate == pytest.approx(100.0, rel=0.01)
    assert all("never loaded" in str(plate.flags) for plate in trial.plates)


def test_damaged_dflow_text_says_where(tmp_path):
    _, trial = _recording(tmp_path, stances=4)

    def backwards(table):
        return {**table, "FrameNumber": table["FrameNumber"][::-1]}

    with pytest.raises(DataError, match="frame numbers do not increase"):
        read_trial(_dflow(tmp_path, trial, backwards))
