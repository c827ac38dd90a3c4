"""``trials edit``, ``definitions``, ``export`` and the tidy tables, as a person uses them."""

import csv
import shutil
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from underfoot.cli.trials import trials_app
from underfoot.trials import join_trials, read_trial, required_frictions, walkway_of
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.study import analyse_folder

DATA = Path(__file__).parents[1] / "data" / "trials"
WALK = DATA / "biomechzoo" / "HC030A05.c3d"


def _run(*arguments: object):
    return CliRunner().invoke(trials_app, [str(a) for a in arguments])


def test_edit_shows_both_numbers_and_analyse_uses_it(tmp_path):
    shutil.copy(WALK, tmp_path)
    file = tmp_path / WALK.name
    done = _run("edit", file, "--step", 1, "--contact", "3.080 s", "--reason", "seen in the video")
    assert done.exit_code == 0, done.output
    assert "RCOF 0.2159 ->" in done.output
    assert (tmp_path / "edits.csv").read_text().splitlines() == [
        "file,step,edit,value,why",
        "HC030A05.c3d,1,contact,3.080 s,seen in the video",
    ]
    one = analyse_folder(tmp_path, protocol("level_walking"), processes=1).files[0]
    assert one.edits[0].number_before == pytest.approx(0.2159, abs=1e-4)
    assert one.edits[0].number_after == one.steps[0].rcof
    again = _run("edit", file, "--step", 1, "--contact", "3.1 s", "--reason", "other")
    assert again.exit_code == 2
    assert len((tmp_path / "edits.csv").read_text().splitlines()) == 2
    assert _run("edit", file, "--step", 2, "--reason", "nothing").exit_code == 2


def test_export_is_read_by_ezc3d_and_gives_the_same_steps(tmp_path):
    ezc3d = pytest.importorskip("ezc3d")
    out = tmp_path / "walk.c3d"
    assert _run("export", WALK, "--out", out).exit_code == 0
    theirs = ezc3d.c3d(str(out), extract_forceplat_data=True)
    events = theirs["parameters"]["EVENT"]
    assert events["LABELS"]["value"] == ["Foot Strike", "Foot Off"] * 2
    assert events["CONTEXTS"]["value"] == ["Right", "Right", "Left", "Left"]
    np.testing.assert_allclose(events["TIMES"]["value"][1], [3.028, 3.644, 3.545, 4.173], atol=1e-5)
    source = read_trial(WALK)
    for plate, other in zip(theirs["data"]["platform"], source.plates, strict=True):
        np.testing.assert_allclose(plate["force"].T, other.force, atol=1e-3)
    before = [s.measurement.value for s in required_frictions(walkway_of(source))]
    after = [s.measurement.value for s in required_frictions(walkway_of(read_trial(out)))]
    assert after == pytest.approx(before, abs=1e-6)
    assert _run("export", WALK, "--out", out).exit_code == 2


def test_export_of_text_files_keeps_the_numbers(tmp_path):
    """450 Hz forces beside 150 Hz markers; the plates of .forces have no corners."""
    out = tmp_path / "walk1.c3d"
    files = DATA / "bmc" / "walk1.trc", DATA / "bmc" / "walk1.forces"
    assert _run("export", files[0], "--with", files[1], "--out", out).exit_code == 0
    trial = read_trial(out)
    source = join_trials(*(read_trial(file) for file in files))
    steps = [s.stance for s in required_frictions(walkway_of(source)) if s.measurement.estimated]
    strikes = [event.time for event in trial.events if event.name == "heel contact"]
    assert strikes == pytest.approx([stance.contact for stance in steps], abs=1e-4)


def test_the_ending_says_the_format_of_an_export(tmp_path):
    """Whatever ended in .sto or .csv was C3D."""
    assert _run("export", WALK, "--out", tmp_path / "a.csv").exit_code == 2
    assert not (tmp_path / "a.csv").exists()
    for name in ("a.sto", "a.mot"):
        assert _run("export", WALK, "--out", tmp_path / name).exit_code == 0
    assert (tmp_path / "a.sto").read_text() == (tmp_path / "a.mot").read_text()
    (one, *_), (other, *_) = (read_trial(f).plates for f in (tmp_path / "a.sto", WALK))
    assert np.abs(one.force).max() == pytest.approx(np.abs(other.force).max(), rel=1e-3)


def test_definitions_of_a_folder(tmp_path):
    shutil.copy(WALK, tmp_path)
    (tmp_path / "bad.c3d").write_bytes(b"x")
    done = _run("definitions", tmp_path, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    with (tmp_path / "out" / "definitions.csv").open() as stream:
        rows = {row["definition"]: row for row in csv.DictReader(stream)}
    assert len(rows) == 11
    assert float(rows["default"]["mean RCOF"]) == pytest.approx(0.2341, abs=1e-4)
    assert float(rows["unfiltered"]["mean change"]) > 0.005
    with (tmp_path / "out" / "definitions_steps.csv").open() as stream:
        assert len(list(csv.DictReader(stream))) == 2
    assert "bad.c3d" in done.output


def test_tidy_tables_hold_every_step_and_the_curves(tmp_path):
    shutil.copy(WALK, tmp_path / "S1_soft.c3d")
    shutil.copy(DATA / "bmc" / "Gait.c3d", tmp_path / "S2_soft.c3d")
    (tmp_path / "conditions.csv").write_text(
        "file,subject,shoe\nS1_soft.c3d,S1,soft\nS2_soft.c3d,S2,soft\n"
    )
    analysis = analyse_folder(tmp_path, protocol("level_walking"), processes=1)
    tables = {table.name: table for table in analysis.tables}
    steps = tables["steps_wide"]
    assert len(steps.rows) == 4
    at = {name: i for i, name in enumerate(steps.columns)}
    assert [row[at["side"]] for row in steps.rows] == ["right", "left", "right", "left"]
    assert all(row[at["walking_speed (m/s)"]] > 0.9 for row in steps.rows)
    long = tables["steps_long"]
    kinds = {row[long.columns.index("quantity")] for row in long.rows}
    assert {"rcof", "cadence", "step_length", "foot_angle", "heel_speed"} <= kinds
    curves = tables["stance_curves"]
    assert len(curves.rows) == 101
    assert curves.rows[0][curves.columns.index("persons")] == 2
    ratio = [row[curves.columns.index("mean ratio")] for row in curves.rows]
    assert 0.15 < max(ratio[3:25]) < 0.35
    assert max(row[curves.columns.index("SD vertical (N)")] for row in curves.rows) > 50.0


@pytest.mark.parametrize(
    ("words", "answer"),
    [
        # Cohen 1988, table 2.3.5 and 2.4.1: d = 0.5 at 80 %: 64 in each group, 34 pairs
        ("groups --difference 0.01 --sd 0.02", "64 persons in each group: power 0.80"),
        ("paired --difference 0.01 --sd 0.02", "34 persons: power 0.80"),
        ("repeated --difference 0.01 --sd 0.02 --conditions 3", ", 3 conditions: power 0.8"),
        ("paired --difference 0.01", "--sd: is missing"),
        ("groups --sd 0.02", "--difference: is missing"),
        ("slips", "--shares: is missing"),
        ("slips_equivalent --shares 0.1 0.1", "--difference: is missing"),
    ],
)
def test_persons_of_a_study_hang_on_what_is_stated_alone(words, answer):
    ended = CliRunner().invoke(trials_app, ["persons", *words.split()])
    assert answer in ended.output + str(ended.exception or "")
    assert (ended.exit_code == 0) == ("missing" not in answer)
