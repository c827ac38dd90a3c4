"""Which files are trials of whom: folders, names, tables, spelling."""

import shutil

import pytest

from underfoot.core import InputError
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.simulator import simulated_folder
from underfoot.trials.study import analyse_folder
from underfoot.trials.study.conditions import study_folder

PATTERN = r"S(?P<subject>\d+)_(?P<shoe>[A-Za-z]+)_(?P<n>\d+)"


def touch(folder, *names):
    for name in names:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("time (s),Fx (N),Fy (N),Fz (N)\n0,1,1,1\n0.001,1,1,1\n")


def conditions(folder, **options):
    return {r.name: dict(r.conditions) for r in study_folder(folder, **options).recordings}


def test_folders_of_persons(tmp_path):
    touch(tmp_path, "S01/hard/w1.csv", "S01/soft/w1.csv", "S02/hard/w1.csv")
    touch(tmp_path, "S02/soft/w1.csv", "S02/.hidden/w.csv")
    assert conditions(tmp_path) == {
        "S01/hard/w1.csv": {"subject": "S01", "folder 2": "hard"},
        "S01/soft/w1.csv": {"subject": "S01", "folder 2": "soft"},
        "S02/hard/w1.csv": {"subject": "S02", "folder 2": "hard"},
        "S02/soft/w1.csv": {"subject": "S02", "folder 2": "soft"},
    }


def test_names_by_a_pattern(tmp_path):
    touch(tmp_path, "a/S01_hard_1.csv", "a/S01_soft_2.csv", "b/S02_hard_1.csv")
    found = conditions(tmp_path, names=PATTERN)
    assert found["b/S02_hard_1.csv"] == {"subject": "02", "shoe": "hard", "n": "1"}
    touch(tmp_path, "b/other.csv")
    with pytest.raises(InputError, match=r"1 of 4 names do not match.*b/other\.csv"):
        study_folder(tmp_path, names=PATTERN)
    with pytest.raises(InputError, match="no named group"):
        study_folder(tmp_path, names=r"S(\d+)")
    with pytest.raises(InputError, match="pattern of names is wrong"):
        study_folder(tmp_path, names=r"S(?P<subject")


def test_tables_in_each_folder_and_above(tmp_path):
    touch(tmp_path, "S1/a.csv", "S1/b.csv", "S2/a.csv")
    (tmp_path / "S1" / "conditions.csv").write_text(
        "file,shoe,mass (kg)\na.csv,hard,70\nb.csv,soft,70\n"
    )
    (tmp_path / "conditions.csv").write_text("file,shoe\nS2/a.csv,soft\ngone.csv,x\n")
    made = study_folder(tmp_path)
    found = {r.name: dict(r.conditions) for r in made.recordings}
    assert found["S1/a.csv"] == {"subject": "S1", "shoe": "hard", "mass": 70.0}
    assert found["S2/a.csv"] == {"subject": "S2", "shoe": "soft"}
    assert any("gone.csv" in note for note in made.notes)
    (tmp_path / "conditions.csv").write_text("file,shoe\na.csv,soft\n")
    with pytest.raises(InputError, match="names 2 files"):
        study_folder(tmp_path)
    (tmp_path / "conditions.csv").write_text("file,shoe\nS1/a.csv,soft\n")
    with pytest.raises(InputError, match='"soft" by one source and "hard" by another'):
        study_folder(tmp_path)


def test_spellings_are_asked_about(tmp_path):
    touch(tmp_path, "a.csv", "b.csv", "c.csv", "d.csv")
    table = "file,subject,shoe\na.csv,1,hard\nb.csv,1,Hard\nc.csv,2,hard \nd.csv,2,soft\n"
    (tmp_path / "conditions.csv").write_text(table)
    with pytest.raises(InputError, match=r'shoe is written "hard" \(2 files\), "Hard"') as caught:
        study_folder(tmp_path)
    assert "--merge-spelling" in str(caught.value)
    found = conditions(tmp_path, merge_spelling=True)
    assert {c["shoe"] for c in found.values()} == {"hard", "soft"}
    assert {c["subject"] for c in found.values()} == {"1", "2"}


def test_notes_are_no_trials(tmp_path):
    touch(tmp_path, "walk.csv", "notes.txt", "Notes day 2.txt", "README.txt", "notch_1.csv")
    made = study_folder(tmp_path)
    assert [r.name for r in made.recordings] == ["notch_1.csv", "walk.csv"]
    assert sum("notes by its name" in note for note in made.notes) == 3


def test_sessions_of_opencap(tmp_path):
    touch(
        tmp_path,
        "P/OpenCapData_1/MarkerData/walk1.trc",
        "P/OpenCapData_1/OpenSimData/Kinematics/walk1.mot",
    )
    meta = tmp_path / "P" / "OpenCapData_1" / "sessionMetadata.yaml"
    meta.write_text("subjectID: subject7\nmass_kg: 71.5\nheight_m: 1.8\niphoneModel:\n  Cam0: x\n")
    (recording,) = study_folder(tmp_path).recordings
    assert [p.suffix for p in recording.paths] == [".trc", ".mot"]
    assert recording.conditions["subject"] == "subject7"
    assert recording.conditions["mass"] == 71.5


def test_reports_inside_are_left_aside(tmp_path):
    touch(tmp_path, "walk.csv", "results/tables/steps.csv")
    (tmp_path / "results" / "analysis.txt").write_text("x")
    made = study_folder(tmp_path)
    assert [r.name for r in made.recordings] == ["walk.csv"]
    assert any("results" in note for note in made.notes)


def test_a_nested_folder_is_analysed(tmp_path):
    flat, nested = tmp_path / "flat", tmp_path / "nested"
    simulated_folder("slips", flat, count=4)
    for i, path in enumerate(sorted(flat.glob("*.c3d"))):
        target = nested / f"S{i % 2}" / path.name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, target)
    shutil.copy(flat / "profile.toml", nested)
    analysis = analyse_folder(nested, protocol("report_g6"), processes=1)
    assert [f.file for f in analysis.files][:2] == ["S0/slip_001.c3d", "S0/slip_003.c3d"]
    assert {f.conditions["subject"] for f in analysis.files} == {"S0", "S1"}
