"""Tables of a page of trials: what has no room is joined by its columns, not by their headings."""

import pytest

from underfoot.trials.pages.report import _compact, _without_conditions, lead_sentence, page_table
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.study import FolderAnalysis, study_of
from underfoot.trials.study.file_result import FileResult, Number, StepResult
from underfoot.trials.study.tables import (
    HOLM_P,
    P_VALUE,
    TrialTable,
    file_table,
    finding,
    number_columns,
)


def test_mean_sd_and_interval_of_several_quantities_share_a_cell():
    four, other = (tuple(number_columns(name)) for name in ("rcof", "acof"))
    row = ("soft", 0.2, 0.01, 0.19, 0.21, 0.3, None, None, None)
    table = TrialTable.of("conditions", "", ("shoe", *four, *other), [row])
    shown = _compact(table)
    assert shown.columns == ("shoe", "RCOF: mean (SD), 95 %", "ACOF: mean (SD), 95 %")
    assert shown.rows == (("soft", "0.200 (0.010), 0.190 to 0.210", "0.300"),)
    one = table.only(range(7))  # no interval of the second is known
    assert _compact(one) == one


def test_a_condition_called_as_a_column_of_ours_stays_what_it_is():
    """ "p" was printed as a chance, "slip" as yes or no."""
    noted = {"p": 2.5, "p 1": 0.00001, "heel crossed the array": 0.25}
    files = [FileResult("a.c3d", numbers=(Number("slip", 1.0, main="slip"),), conditions=noted)]
    shown = page_table(file_table(files))
    (row,) = shown["rows"]
    cells = dict(zip(shown["columns"], row, strict=True))
    assert cells["p"] == "2.5"
    assert cells["p 1"] == "0.0000100"
    assert cells["heel crossed the array"] == "0.25"
    assert cells["slip"] == "yes"
    made = finding("t", "T", ("factor", P_VALUE, HOLM_P), [("shoe", 1e-6, 0.02)])
    assert page_table(made.table)["rows"] == [["shoe", "< 0.0001", "0.0200"]]


@pytest.mark.parametrize(
    "name", ["trials", "n", "persons", "steps", "verdict", "RCOF", "slip", "p", "reasons"]
)
def test_a_condition_called_as_a_column_of_ours_is_a_column_of_its_own(name):
    """A file of the table "conditions" had two columns "trials"; "verdict" left the page."""
    files = [
        FileResult(
            f"{i}.c3d",
            numbers=(
                Number("rcof", 0.2 + 0.002 * (i % 5), main="rcof"),
                Number("rcof", 0.2, item="step 1 on plate 1"),
                Number("slip", 0.0, main="slip"),
            ),
            conditions={"subject": f"S{i // 4}", name: "ab"[i % 2]},
            steps=(StepResult(rcof=0.2, walking_speed=1.3, number=1),),
        )
        for i in range(12)
    ]
    level = protocol("level_walking")
    study = study_of(files, level)
    analysis = FolderAnalysis(level, tuple(files), study, (), ())
    for table in analysis.tables:
        assert len({*table.columns}) == len(table.columns), table.name
    told = page_table(_without_conditions(file_table(files)))
    assert told["columns"] == ["file", "verdict", "RCOF", "slip"]
    assert all(row[1] == "accepted" for row in told["rows"])
    (noted,) = (i for i, h in enumerate(file_table(files).heads) if h.name == name and h.always)
    assert [row[noted] for row in file_table(files).rows[:2]] == ["a", "b"]
    (table,) = (table for table in study.tables if table.name == "conditions")
    cells = dict(zip(table.columns, table.rows[-1], strict=True))
    assert (cells["persons"], cells["trials"], cells["steps"]) == (3, 12, 12)
    assert cells["RCOF"] == pytest.approx(0.2035)
    assert lead_sentence(analysis).endswith("(3 persons, 12 trials, 12 steps).")
