"""Sheets of readings as laboratories keep them: who read in German, rows of means, runs beside."""

import openpyxl
import pytest

from underfoot.core import InputError
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.study import analyse_folder

COF = (0.20, 0.21, 0.22)


def analysed(folder, text):
    (folder / "sheet.csv").write_text(text, encoding="utf-8")
    return analyse_folder(folder, protocol("machine_cof"), processes=1)


def by(folder, head, names=("A", "B")):
    """Return the tables of three floors that two read, the second 0.01, 0.02 and 0.03 higher."""
    rows = [
        f"F{floor};{name};{cof + 0.1 * floor + 0.01 * k * (1 + floor)}"
        for floor in range(3)
        for k, name in enumerate(names)
        for cof in COF
    ]
    return {t.name: t for t in analysed(folder, f"Boden;{head};COF\n" + "\n".join(rows)).tables}


@pytest.mark.parametrize("names", [("A", "B"), ("1", "2")])
@pytest.mark.parametrize(
    ("head", "name"),
    [
        ("operator", "operator"),
        ("Prüfer", "operator"),
        ("Bediener", "operator"),
        ("Gerät", "machine"),
        ("tribometer", "machine"),
        ("Labor", "laboratory"),
    ],
)
def test_who_read_is_compared_under_every_heading(tmp_path, head, name, names):
    """Precision, ICC and Bland-Altman were left out without a word under a German heading."""
    tables = by(tmp_path, head, names)
    assert {f"precision_{name}", f"icc_{name}", f"bland_altman_{name}"} <= tables.keys()
    bias = next(row for row in tables[f"bland_altman_{name}"].rows if row[0] == "bias")
    assert bias[1] == pytest.approx(-0.02)


@pytest.mark.parametrize("label", ["Mittelwert", "mean", "SD", "Standardabweichung", "max", "MW"])
def test_rows_of_means_below_a_sheet_are_no_samples(tmp_path, label):
    """A floor called "SD" had a COF of 0.01."""
    rows = "".join(f"F0;{cof}\n" for cof in COF)
    (file,) = analysed(tmp_path, f"Boden;COF\n{rows}{label};0.01\n").files
    assert file.verdict == "refused"
    assert f'line 5: "{label}" is no sample' in str(file.reasons[0])


@pytest.mark.parametrize("head", ["Lauf", "Versuch", "Messung", "run"])
def test_runs_beside_each_other_are_read_beside_their_means(tmp_path, head):
    heads = ";".join(f"{head} {n}" for n in (1, 2, 3))
    text = f"Boden;{heads};MW;s\nF0;0,20;0,21;0,22;0,21;0,01\nF1;0,30;0,31;0,32;0,31;0,01\n"
    found = {file.conditions["boden"]: file.main["cof"] for file in analysed(tmp_path, text).files}
    assert found == {"F0": pytest.approx(0.21), "F1": pytest.approx(0.31)}


def workbook(path, sheets):
    book = openpyxl.Workbook(write_only=True)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    book.save(path)


def test_every_sheet_of_a_workbook_is_read(tmp_path):
    """A floor of PTV 20 stood on the second sheet and in no result."""
    head = ["slider", "condition", "ptv"]
    sheets = {
        "Info": [["laboratory", "number"], ["L", 12]],
        "Tile A": [head, *(["96", "wet", ptv] for ptv in (40, 40, 41, 40, 40))],
        "Tile B": [head, *(["96", "wet", ptv] for ptv in (20, 20, 21, 20, 20))],
        "Tile C": [[*head, "humidity"], *(["96", "wet", ptv, 50] for ptv in (30, 30, 31, 30, 30))],
    }
    workbook(tmp_path / "floors.xlsx", sheets)
    files = analyse_folder(tmp_path, protocol("en_16165_pendulum"), processes=1).files
    assert [file.main["ptv"] for file in files] == pytest.approx([40.2, 20.2, 30.2])


def test_two_sheets_of_conditions_with_other_headings_are_refused(tmp_path):
    """The persons on the second sheet had no conditions."""
    (tmp_path / "a.csv").write_text("COF\n0.2\n0.21\n", encoding="utf-8")
    sheets = {"one": [["file", "floor"], ["a", "T"]], "two": [["file", "shoe"], ["a", "S"]]}
    workbook(tmp_path / "conditions.xlsx", sheets)
    with pytest.raises(InputError, match="one, two"):
        analyse_folder(tmp_path, protocol("machine_cof"), processes=1)


def classes(folder, sheets, method, table):
    for name, text in sheets.items():
        (folder / name).write_text(text, encoding="utf-8")
    analysis = analyse_folder(folder, protocol(method), processes=1)
    (found,) = (t for t in analysis.tables if t.name == table)
    place = [str(column) for column in found.columns].index("class")
    return [row[place] for row in found.rows]


def test_floors_of_two_files_are_two_samples(tmp_path):
    """Floors of 8 and 20 degrees were one floor of 14 degrees, R10."""
    sheets = {
        f"tile{angle}.csv": "operator,angle\n"
        + "".join(f"{who},{angle + 0.1 * n}\n" for who in "AB" for n in range(3))
        for angle in (8, 20)
    }
    assert classes(tmp_path, sheets, "en_16165_shod_ramp", "walkers") == ["R9", "R11"]


def test_walkers_in_files_of_their_own_share_a_named_sample(tmp_path):
    sheets = {
        f"{who}.csv": "sample,operator,angle\n"
        + "".join(f"T,{who},{angle + 0.1 * n}\n" for n in range(3))
        for who, angle in (("A", 18.4), ("B", 19.8))
    }
    assert classes(tmp_path, sheets, "en_16165_shod_ramp", "walkers") == ["R11"]


def test_a_floor_is_not_told_apart_by_its_results(tmp_path):
    """The direction of PTV 36 was a floor of its own, of low slip potential."""
    rows = "T;96;wet;0;36;36;37;36;36;36;Pass;\nT;96;wet;90;24;24;23;24;24;24;Fail;wet patch\n"
    head = "Tile;Slider;Condition;Direction;1;2;3;4;5;Mean PTV;Result;Remarks\n"
    sheets = {"sheet.csv": head + rows}
    found = classes(tmp_path, sheets, "en_16165_pendulum", "lowest")
    assert found == ["high slip potential"]


@pytest.mark.parametrize(
    ("remarks", "cofs"),
    [(("", "", "patch"), [0.45]), (("wet", "dry", "dry"), [0.3, 0.525])],
)
def test_remarks_on_every_reading_tell_samples_apart(tmp_path, remarks, cofs):
    """Only a remark about some of the readings is none of the sample's."""
    rows = "".join(
        f"F;{cof};{remark}\n" for cof, remark in zip((0.3, 0.5, 0.55), remarks, strict=True)
    )
    files = analysed(tmp_path, f"Boden;COF;Bemerkung\n{rows}").files
    assert sorted(file.main["cof"] for file in files) == pytest.approx(cofs)
