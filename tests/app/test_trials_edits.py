"""Edits by hand act on the step they name, are logged with the number, or end the run."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from underfoot.trials import Edit, read_trial, required_frictions, stances, walkway_of
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.simulator import simulated_folder
from underfoot.trials.study import analyse_folder
from underfoot.trials.study.file_result import FileResult, Number, Sample
from underfoot.trials.walking.events import EditError

DATA = Path(__file__).parents[1] / "data" / "trials"
WALK = DATA / "biomechzoo" / "HC030A05.c3d"
HEAD = "file,step,edit,value,why\n"


@pytest.fixture
def walks(tmp_path):
    shutil.copy(WALK, tmp_path)
    return tmp_path


def _edited(folder: Path, rows: str, name: str = "level_walking"):
    (folder / "edits.csv").write_text(HEAD + rows)
    return analyse_folder(folder, protocol(name), processes=1)


def test_a_moved_contact_moves_the_number_and_both_are_logged(walks):
    """Step 1 peaks 40 ms after 3.028 s: a contact at 3.08 s leaves that peak out."""
    before = analyse_folder(walks, protocol("level_walking"), processes=1).files[0]
    after = _edited(walks, "HC030A05.c3d,3.1 s,contact,3.080 s,seen in the video\n")
    one = after.files[0]
    (row,) = one.edits
    assert (row.step, row.what) == ("step 1 on plate 2", "contact")
    assert (row.before, row.after) == ("3.0280 s", "3.0800 s")
    assert row.number_before == pytest.approx(0.216, abs=5e-4)
    assert row.number_after == one.steps[0].rcof
    assert one.main["rcof"] != before.main["rcof"]
    assert one.steps[1].rcof == before.steps[1].rcof
    (table,) = (table for table in after.tables if table.name == "edits")
    assert table.rows[0][-1] == "seen in the video"


def test_a_step_is_excluded_with_its_reason(walks):
    one = _edited(walks, "HC030A05.c3d,2,exclude,,targeted the plate\n").files[0]
    assert one.main["rcof"] == pytest.approx(0.2159, abs=1e-4)
    assert one.steps[1].reason == "excluded by hand: targeted the plate"
    assert one.edits[0].number_before == pytest.approx(0.2523, abs=1e-4)
    assert one.edits[0].number_after is None


def test_side_and_toe_off_are_set():
    trial = read_trial(WALK)
    edits = (
        Edit(1, "side", "left", "markers exchanged"),
        Edit(2, "toe off", 4.1, "the other foot"),
    )
    first, second = stances(walkway_of(trial.with_edits(*edits)))
    assert (first.side, first.heel) == ("left", "LHEE")
    assert second.toe_off == 4.1
    rcof = [
        step.measurement.value for step in required_frictions(walkway_of(trial.with_edits(*edits)))
    ]
    assert rcof[0] == pytest.approx(0.2159, abs=1e-4)


def test_one_foot_on_two_plates_is_given_to_one_of_them():
    trial = read_trial(WALK)
    second = trial.plates[1]
    both = replace(
        trial,
        plates=(
            replace(second, force=0.8 * second.force),
            replace(second, name="plate 9", force=0.4 * second.force),
        ),
    )
    assert not any(stance.accepted for stance in stances(walkway_of(both)))
    (taken, left) = stances(
        walkway_of(both.with_edits(Edit(1, "plate", "plate 2", "toes only on 9")))
    )
    assert taken.accepted
    assert taken.plate == "plate 2"
    assert "by hand: the step is on plate 2" in left.reason


@pytest.mark.parametrize(
    ("rows", "line", "message"),
    [
        ("HC030A05.c3d,1,contact,99 s,x\n", 2, "outside the record"),
        ("HC030A05.c3d,7,contact,3.06 s,x\n", 2, "there is no step 7"),
        ("HC030A05.c3d,9.5 s,exclude,,x\n", 2, "there is no step at 9.5 s"),
        ("HC030A5.c3d,1,exclude,,x\n", 2, "there is no file"),
        ("HC030A05.c3d,1,contact,3.028 s,x\n", 2, "changes nothing"),
        ("HC030A05.c3d,1,side,right,x\n", 2, "the right foot already"),
        ("HC030A05.c3d,1,plate,plate 2,x\n", 2, "changes nothing"),
        ("HC030A05.c3d,1,plate,plate 3,x\n", 2, "plate 3"),
        ("HC030A05.c3d,1,contact,4 s,x\n", 2, "end before it begins"),
        ("HC030A05.c3d,1,exclude,,x\nHC030A05.c3d,3.1 s,contact,3.1 s,y\n", 3, "contradicts"),
        ("\nHC030A05.c3d,1,contact,3.1 s,x\nHC030A05.c3d,1,contact,3.2 s,y\n", 4, "contradicts"),
        ("HC030A05.c3d,1,exclude,,\n", 2, "needs its reason"),
        ("HC030A05.c3d,1,landing,3 s,x\n", 2, "unknown edit"),
        ("HC030A05.c3d,1,contact,3.06,x\n", 2, "is no time"),
        ("HC030A05.c3d,one,exclude,,x\n", 2, "is no time"),
        ("HC030A05.c3d,1,side,west,x\n", 2, "left, right"),
    ],
)
def test_an_edit_that_can_not_act_ends_the_run(walks, rows, line, message):
    with pytest.raises(EditError, match=message) as error:
        _edited(walks, rows)
    assert f"edits.csv, line {line}" in str(error.value)


def test_edits_of_a_slip_act_and_log_its_speed(tmp_path):
    simulated_folder("slips", tmp_path, count=3)
    before = analyse_folder(tmp_path, protocol("report_g6"), processes=1)
    after = _edited(tmp_path, "slip_003.c3d,2,contact,2500 ms,marker lost\n", "report_g6")
    assert after.files[0] == before.files[0]
    (row,) = after.files[2].edits
    assert row.quantity == "peak slipping speed"
    assert row.number_before == before.files[2].main["peak_slipping_speed"]
    assert row.number_after == after.files[2].main["peak_slipping_speed"]
    assert row.number_before != row.number_after


def test_where_there_are_no_steps_a_run_can_be_excluded(tmp_path):
    simulated_folder("tester", tmp_path, count=2)
    one = _edited(tmp_path, "work_none_scan_1.csv,1,exclude,,belt slipped\n", "report_g4")
    named = {result.file: result for result in one.files}["work_none_scan_1.csv"]
    assert named.verdict == "refused"
    assert named.edits[0].why == "belt slipped"
    with pytest.raises(EditError, match="has no steps"):
        _edited(tmp_path, "work_none_scan_1.csv,1,contact,1 s,x\n", "report_g4")


def test_edits_do_not_touch_the_forces():
    trial = read_trial(WALK)
    edited = trial.with_edits(Edit(1, "contact", 3.05, "video"))
    assert edited.edits[0].why == "video"
    assert trial.edits == ()
    assert np.array_equal(edited.plates[0].force, trial.plates[0].force)


def test_a_stored_result_is_what_it_was(walks):
    """Numbers, steps and edits come back as the rows that they were, whatever JSON knows."""
    one = _edited(walks, "HC030A05.c3d,2,exclude,,targeted the plate\n").files[0]
    boards = ((8.7, 9.1, 0.1), (17.3, 17.6, 0.0))
    one = replace(one, curves={}, sample=Sample("a table", (14.1, 14.5), "ramp", boards))
    again = FileResult.from_dict(json.loads(json.dumps(one.as_dict(), default=list)))
    assert again == one
    assert (again.main, again.facts) == (one.main, one.facts)
    assert again.main["rcof"] == again.numbers[-1].value
    assert {type(row) for row in again.numbers} == {Number}
    assert [row.as_dict() for row in again.numbers] == [row.as_dict() for row in one.numbers]
    assert again.steps[1].by_hand == ("exclude",)
    assert again.edits[0].why == "targeted the plate"
    assert again.sample.boards == boards
