"""Columns of numbers that stand for levels, and columns that only say who it was."""

import pytest
from test_trials_small_studies import crossed, files_of

from underfoot.trials.recording.protocols import protocol
from underfoot.trials.statistics import names_persons
from underfoot.trials.study import analyse_folder
from underfoot.trials.study.conditions import conditions_of
from underfoot.trials.study.study import study_of
from underfoot.trials.study.study_guard import study_doubts

LEVEL = protocol("level_walking")
PERSONS = [f"S{i}" for i in range(6) for _ in range(6)]


def noted(tmp_path, heading, cells, persons=PERSONS):
    """Return a condition of every file, as a table of conditions notes it."""
    rows = [
        f"f{n}.c3d,{who},{cell}" for n, (who, cell) in enumerate(zip(persons, cells, strict=True))
    ]
    table = tmp_path / "conditions.csv"
    table.write_text("\n".join([f"file,subject,{heading}", *rows]), encoding="utf-8")
    name = heading.split(" (")[0]
    return [one.get(name) for one in conditions_of(tmp_path).values()]


@pytest.mark.parametrize(
    ("heading", "cells", "levels"),
    [
        ("shoe", [1, 2, 3] * 12, {"1", "2", "3"}),
        ("shoe", ["1", "", "3"] * 12, {None, "1", "3"}),
        ("hardness (Shore A)", [45, 60, 75] * 12, {"45 Shore A", "60 Shore A", "75 Shore A"}),
        ("group", [1] * 18 + [2] * 18, {"1", "2"}),
    ],
)
def test_numbers_that_stand_for_levels_are_levels(tmp_path, heading, cells, levels):
    assert set(noted(tmp_path, heading, cells)) == levels


@pytest.mark.parametrize(
    ("heading", "cells"),
    [
        ("age", [20 + i // 12 for i in range(36)]),
        ("shoe size", [42 + i // 18 for i in range(36)]),
        ("order", [1, 2, 3] * 12),
        ("trial", [1, 2, 3] * 12),
        ("speed (m/s)", [1, 2, 3] * 12),
        ("mass (kg)", [60 + i // 12 for i in range(36)]),
        ("dose", [0.5, 1.0, 1.5] * 12),
        ("score", list(range(36))),
        ("code of the person", [i // 6 for i in range(36)]),
    ],
)
def test_measured_numbers_and_numbers_of_one_person_are_none(tmp_path, heading, cells):
    assert all(isinstance(value, float) for value in noted(tmp_path, heading, cells))


def samples(tmp_path, head, rows):
    """Return PTV by sample of a table of readings."""
    text = "\n".join([head, *(",".join(map(str, row)) for row in rows)])
    (tmp_path / "readings.csv").write_text(text, encoding="utf-8")
    files = analyse_folder(tmp_path, protocol("en_16165_pendulum")).files
    return {str(one.conditions.get("floor")): one.main["ptv"] for one in files}


def test_floors_that_are_numbered_are_samples_each(tmp_path):
    # all were one sample: of 15 readings the last five, "low slip potential" for a floor of 24
    rows = [(floor, "wet", 96, ptv + i % 2) for floor, ptv in ((1, 24), (2, 36), (3, 48))
            for i in range(5)]  # fmt: skip
    found = samples(tmp_path, "floor,condition,slider,PTV", rows)
    assert found == pytest.approx({"1": 24.4, "2": 36.4, "3": 48.4})


@pytest.mark.parametrize("head", ["swing", "temperature", "reading", "temperature (°C)"])
def test_numbers_beside_readings_make_no_samples(tmp_path, head):
    rows = [("A", "wet", 96, i % 3, 36) for i in range(5)]
    assert len(samples(tmp_path, f"floor,condition,slider,{head},PTV", rows)) == 1


def test_a_factor_that_says_who_it_was_is_told_and_no_doubt():
    rows = [
        ({**c, "date": f"2024-03-{c['subject'][1:]}", "group": "ab"[int(c["subject"][1:]) % 2]}, *x)
        for c, *x in crossed(6, "abc")
    ]
    files = files_of(rows)
    assert not [d for d in study_doubts(files, LEVEL) if "date" in str(d)]
    study = study_of(files, LEVEL)
    assert not any("date" in table.columns for table in study.tables if table.name != "steps")
    notes = [str(note) for note in study.findings[0].table.notes]
    assert "date: each person has one of their own: its effect is not estimated" in notes


def test_only_a_factor_with_a_level_a_person_names_persons():
    assert names_persons(["a", "a", "b"], ["1", "1", "2"])
    assert not names_persons(["a", "a", "b"], ["1", "2", "3"])
    assert not names_persons(["a", "b", "b"], ["1", "1", "2"])
    assert not names_persons(["a", "a"], ["1", "1"])
    assert not names_persons(["a", "b"], [])


def test_measured_numbers_that_are_not_compared_are_named():
    rows = [({**c, "age": 20.0 + i}, *x) for i, (c, *x) in enumerate(crossed(6, "abc"))]
    notes = study_of(files_of(rows), LEVEL).tables[0].notes
    assert "Measured numbers are no levels and are not compared: age." in notes
    plain = study_of(files_of(crossed(6, "abc")), LEVEL).tables[0].notes
    assert not [note for note in plain if "not compared" in note]


@pytest.mark.parametrize("blank", ["n.a.", "NA", "k.A.", "–", "keine Angabe", "."])
def test_cells_that_say_nothing_are_empty(tmp_path, blank):
    assert noted(tmp_path, "speed (m/s)", [1.2, blank, 1.3] * 12)[:3] == [1.2, None, 1.3]
    (tmp_path / "conditions.csv").unlink()
    rows = [("A", "wet", 96, value) for value in (36, blank, 38, 37, 37, 37)]
    assert samples(tmp_path, "floor,condition,slider,PTV", rows) == {"A": 37.0}


@pytest.mark.parametrize("head", ["run 1,run 2,run 3", "Messung 1,Messung 2,Messung 3", "1,2,3"])
def test_a_wide_table_of_a_machine_is_read_or_told_how_to_write_it(tmp_path, head):
    rows = "A,tile,0.21,0.22,0.20\nB,tile,0.31,0.30,0.32\n"
    (tmp_path / "readings.csv").write_text(f"shoe,floor,{head}\n{rows}", encoding="utf-8")
    files = analyse_folder(tmp_path, protocol("machine_cof")).files
    found = {one.conditions["shoe"]: one.main["cof"] for one in files}
    assert found == pytest.approx({"A": 0.21, "B": 0.31})
    # a protocol of logs says which protocol reads a table
    (refused,) = analyse_folder(tmp_path, protocol("en_iso_13287")).files
    assert "--protocol machine_cof" in refused.reasons[0]
    named = "floor,shoe A,shoe B\ntile,0.21,0.31\n"
    (tmp_path / "readings.csv").write_text(named, encoding="utf-8")
    (refused,) = analyse_folder(tmp_path, protocol("machine_cof")).files
    assert "Write one reading a row" in refused.reasons[0]
