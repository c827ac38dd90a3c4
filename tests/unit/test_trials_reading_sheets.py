"""Sheets of readings as laboratories keep them: who read in German, rows of means, runs beside."""

import pytest

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
