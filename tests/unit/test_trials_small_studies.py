"""Studies with too little in them: what can be told is told, the rest has its reason."""

import itertools
import re
from dataclasses import replace

import numpy as np
import pytest

from underfoot.core import DataError
from underfoot.core.unit_text import plain_number
from underfoot.trials.pages.report import page_table
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.statistics import effect_size
from underfoot.trials.study import analyse_folder
from underfoot.trials.study.file_result import FileResult, Number, StepResult
from underfoot.trials.study.study import study_of
from underfoot.trials.study.study_guard import study_doubts
from underfoot.trials.study.study_tests import _t_tests, comparison_findings

LEVEL = protocol("level_walking")


def files_of(rows):
    """One file a row of (conditions, RCOF); a scatter of 0.004 is added to each."""
    rng = np.random.default_rng(0)
    return [
        FileResult(
            f"f{n:03d}.c3d",
            numbers=(Number("rcof", rcof + rng.normal(0, scatter), main="rcof"),),
            conditions=conditions,
            steps=(StepResult(rcof=rcof, walking_speed=1.3, contact=0.1, peak_force=700.0),),
        )
        for n, (conditions, rcof, scatter) in enumerate(rows)
    ]


def crossed(persons, shoes, floors=("",), trials=2, scatter=0.004, kept=lambda *cell: True):
    return [
        ({"subject": f"S{i:02d}", "shoe": shoe, **({"floor": floor} if floor else {})},
         0.2 + 0.02 * k, scatter)
        for i in range(persons)
        for k, shoe in enumerate(shoes)
        for floor in floors
        if kept(i, shoe, floor)
        for _ in range(trials)
    ]  # fmt: skip


STUDIES = {
    "one person": crossed(1, "abc", trials=4),
    "one person and one shoe": crossed(1, "a", trials=4),
    "one trial of each": [({"subject": f"S{i:02d}", "shoe": "ab"[i % 2]}, 0.2, 0.01)
                          for i in range(10)],
    "all the same value": crossed(6, "a", scatter=0.0),
    "the same value in a shoe": crossed(6, "abc", scatter=0.0),
    "a factor of one level": crossed(6, "ab", ("tile",)),
    "30 conditions of two persons": crossed(2, [f"s{k}" for k in range(30)], trials=1),
    "empty cells": crossed(6, "abc", "xy", kept=lambda i, shoe, floor: shoe + floor != "cy"),
    "empty cells of persons": crossed(6, "abc", "xy", kept=lambda i, shoe, f: (i + ord(shoe)) % 3),
    "every person an own shoe": [({"subject": f"S{i:02d}", "shoe": f"s{i}"}, 0.2, 0.004)
                                 for i in range(6) for _ in range(3)],
    "one person in a group": [({**c, "group": "old" if c["subject"] == "S00" else "young"}, v, s)
                              for c, v, s in crossed(5, "ab")],
    "no persons": [({"shoe": c["shoe"]}, v, s) for c, v, s in crossed(5, "ab")],
    "no conditions": [({}, 0.2, 0.004)] * 5,
    "one file": crossed(1, "a", trials=1),
}  # fmt: skip


@pytest.mark.parametrize("name", STUDIES)
def test_what_can_be_told_is_told_and_the_rest_has_its_reason(name):
    files = files_of(STUDIES[name])
    study = study_of(files, LEVEL)
    assert not study.notes
    (conditions,) = (table for table in study.tables if table.name == "conditions")
    assert conditions.rows
    for one in study.findings:
        if "not done" in one.table.columns:
            assert all(one.table.rows[0])
            continue
        for row in one.table.rows:
            shown = [cell for cell in row if isinstance(cell, float)]
            assert np.isfinite(shown).all(), (one.name, row)
    for doubt in study_doubts(files, LEVEL):
        told = str(doubt).split('"')
        if "early" in str(doubt):  # one level is not early and late
            assert told[1] != told[3]


def test_a_comparison_that_nothing_is_left_of_says_why():
    study = study_of(files_of(STUDIES["every person an own shoe"]), LEVEL)
    (lost,) = (one for one in study.findings if "not done" in one.table.columns)
    assert "shoe" in str(lost.table.rows[0][0])


def test_a_column_of_one_value_is_named_on_the_page():
    """One value, or one a file: no factor of any study, and the page says which and why."""
    told = 'floor: RCOF is known at one value only, "tile": the effect of floor is not estimated'
    rows = crossed(6, "ab", ("tile",))
    rows = [({**c, "note": f"n{i}"}, v, s) for i, (c, v, s) in enumerate(rows)]
    study = study_of(files_of(rows), LEVEL)
    assert study.findings[0].table.notes[-2:] == (
        told, "note: RCOF is known once at each value: the effect of note is not estimated"
    )  # fmt: skip
    assert not any(told in caution for one in study.findings for caution in one.cautions)
    assert {row[0] for one in study.findings if one.name == "mixed_rcof" for row in one.table.rows
            } == {"shoe"}  # fmt: skip
    for kind, response in (
        ("report_g6", "acof"),
        ("en_iso_13287", "cof"),
        ("level_walking", "rcof"),
    ):
        files = [
            FileResult(f"{i}.csv", numbers=(Number(response, 0.2 + 0.01 * i, main=response),
                                            Number("slip", 0.0, main="slip")),
                       conditions={"outsole": "a", "order": "a", "shoe": "a"})
            for i in range(4)
        ]  # fmt: skip
        lost = [
            row[0] for one in study_of(files, protocol(kind)).findings for row in one.table.rows
            if one.table.columns == ("not done",)
        ]  # fmt: skip
        assert any('at one value only, "a"' in text for text in lost), kind
    assert comparison_findings("tau_hydro", [], {"fluid": []})[0].table.rows == (
        ("fluid: tau_hydro is known nowhere: the effect of fluid is not estimated",),
    )


def test_two_persons_have_no_effect_size():
    with pytest.raises(DataError, match="effect size"):
        effect_size([0.2, 0.21], [0.22, 0.24], paired=True)
    study = study_of(files_of(crossed(2, "ab", trials=1)), LEVEL)
    (tukey,) = (one for one in study.findings if one.name.startswith("tukey"))
    assert tukey.table.rows[0][-3:] == (None, None, None)
    assert "Hedges' g is not estimated" in tukey.table.notes[0]


@pytest.mark.parametrize("name", STUDIES)
def test_a_page_prints_numbers_that_a_person_reads(name):
    study = study_of(files_of(STUDIES[name]), LEVEL)
    for table in (*study.tables, *(one.table for one in study.findings)):
        page = page_table(table)
        for text in (*itertools.chain(*page["rows"]), *page["notes"], *page["below"]):
            assert not re.search(r"\de[-+]?\d", text), (table.name, text)


@pytest.mark.parametrize(
    ("value", "text"),
    [(9.19e-12, "below 0.000001"), (-9e-12, "above -0.000001"), (2.61e-5, "0.0000261"),
     (0.0, "0"), (0.123, "0.123"), (5.8e16, "above 1,000,000"), (-np.inf, "below -1,000,000")],
)  # fmt: skip
def test_what_is_too_small_or_large_is_told_by_its_bound(value, text):
    assert plain_number(value) == text


def table_of(tmp_path, name, text):
    (tmp_path / "table.csv").write_text(text)
    analysis = analyse_folder(tmp_path, protocol(name), processes=1)
    return analysis, {table.name: table for table in analysis.study.tables}


def test_one_reading_has_no_uncertainty(tmp_path):
    """It was printed as 0.000 in the column of the COF."""
    rows = "sample,PTV\nA,36\n" + "B,36\nB,37\n" * 2 + "C,36\n" * 5
    _, tables = table_of(tmp_path, "en_16165_pendulum", rows)
    one, several, equal = (
        dict(zip(tables["samples"].columns, row, strict=True)) for row in tables["samples"].rows
    )
    assert (one["u"], one["u of COF"], one["PTV SD"]) == (None, None, None)
    assert isinstance(several["u of COF"], float)
    assert several["u of COF"] > 0
    notes = " ".join(tables["samples"].notes)
    assert "Of a single reading" in notes
    assert "Of equal readings" in notes
    # five equal readings of whole numbers: no scatter would say that nothing scatters
    assert (equal["PTV"], equal["PTV SD"], equal["PTV 95 % low"]) == (36, None, None)
    assert (equal["u"], equal["u of COF"]) == (None, None)


@pytest.mark.parametrize(("machine", "told"), [("", True), ("BOT-3000E", False)])
def test_a_cof_without_its_machine_is_doubted(tmp_path, machine, told):
    rows = "sample,machine,cof\n" + "".join(f"A,{machine},{c}\n" for c in (0.41, 0.4, 0.42))
    analysis, tables = table_of(tmp_path, "machine_cof", rows)
    assert any('"machine" is noted for no reading' in str(one) for one in analysis.doubts) == told
    assert tables["samples"].rows[0][-1] == pytest.approx(0.01 / 3**0.5)


def test_one_person_has_no_scatter_and_the_page_says_so():
    notes = {
        name: " ".join(study_of(files_of(STUDIES[name]), LEVEL).tables[0].notes)
        for name in ("one person", "empty cells")
    }
    assert "Of one of the persons alone SD and interval are not estimated" in notes["one person"]
    assert "not estimated" not in notes["empty cells"]


def test_scatter_of_rounding_alone_is_none():
    """Persons who all have the same value in each shoe: F was 5.8e16."""
    study = study_of(files_of(STUDIES["the same value in a shoe"]), LEVEL)
    mixed = next(one for one in study.findings if one.name == "mixed_rcof")
    assert "not done" in mixed.table.columns


def test_trials_of_one_person_tell_of_that_person():
    study = study_of(files_of(STUDIES["one person"]), LEVEL)
    (anova,) = (one for one in study.findings if one.name.startswith("anova"))
    assert "one person" in " ".join(anova.cautions)


@pytest.mark.parametrize(("counts", "tested"), [((1, 5), False), ((2, 2), True), ((5, 1), False)])
def test_t_tests_take_two_trials_or_more_of_each_level(counts, tested):
    rows = [({"shoe": shoe}, 0.2 + 0.02 * k, 0.004)
            for k, shoe in enumerate("ab") for _ in range(counts[k])]  # fmt: skip
    files = files_of(rows)
    assert bool(_t_tests(files, "shoe", ["a", "b"], "")) == tested
    walked = [replace(one, conditions={**one.conditions, "who": k % 2 * "S1" or "S0"})
              for k, one in enumerate(files)]  # fmt: skip
    assert bool(_t_tests(walked, "shoe", ["a", "b"], "who")) == tested
