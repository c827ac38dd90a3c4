"""A study of persons in three shoes, from file names to the mixed model."""

import csv
import json
from itertools import combinations

import pytest

from commands import process
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.simulator.folder import NAMES, SHOES, simulated_study
from underfoot.trials.study import analyse_folder


def findings(analysis):
    return {f.name: f for f in analysis.study.findings}


def test_persons_are_the_units(tmp_path):
    simulated_study(tmp_path, persons=5, trials=2)
    analysis = analyse_folder(tmp_path, protocol("level_walking"), names=NAMES, processes=1)
    # sound made-up walks whose recordings hold the person's mass: no mark on any
    assert {file.verdict for file in analysis.files} == {"accepted"}
    table = analysis.study.tables[0]
    rows = {row[0]: dict(zip(table.columns, row, strict=True)) for row in table.rows}
    assert set(rows) == {*SHOES, "all"}
    assert (rows["hard"]["persons"], rows["hard"]["trials"], rows["hard"]["steps"]) == (5, 10, 10)
    # By hand from the truth: means of persons first.
    truth: dict[str, dict[str, list[float]]] = {}
    with (tmp_path / "truth.csv").open(newline="") as stream:
        for row in csv.DictReader(stream):
            person, shoe, _ = row["file"].split("_")
            truth.setdefault(shoe, {}).setdefault(person, []).append(float(row["rcof"]))
    means = [sum(v) / len(v) for v in truth["soft"].values()]
    assert rows["soft"]["RCOF"] == pytest.approx(sum(means) / 5, abs=1.5e-3)
    spread = (sum((m - sum(means) / 5) ** 2 for m in means) / 4) ** 0.5
    assert rows["soft"]["RCOF SD"] == pytest.approx(spread, abs=1.5e-3)
    assert rows["soft"]["RCOF 95 % high"] - rows["soft"]["RCOF 95 % low"] == pytest.approx(
        2 * 2.776445 * spread / 5**0.5, rel=0.1
    )
    found = findings(analysis)
    assert list(found)[:3] == ["repeated_rcof", "mixed_rcof", "tukey_rcof_shoe"]
    assert found["mixed_rcof"].table.rows[0][1:3] == (2, 8)
    assert any("5 persons" in text for text in found["anova_rcof_type_3"].cautions)
    assert "n" not in {row[0] for f in found.values() for row in f.table.rows}
    assert {*found["mixed_rcof"].files} == {f"mixed_rcof.{ending}" for ending in ("csv", "R", "py")}


def test_without_persons_files_are_the_units_and_it_is_said(tmp_path):
    simulated_study(tmp_path, persons=3, trials=2)
    pattern = r"_(?P<shoe>[a-z]+)_"
    analysis = analyse_folder(tmp_path, protocol("level_walking"), names=pattern, processes=1)
    table = analysis.study.tables[0]
    assert "files" in table.columns
    assert any("every file counts as one" in note for note in table.notes)
    assert "mixed_rcof" not in findings(analysis)


@pytest.mark.slow
def test_the_interval_of_a_mixed_model_holds_the_truth(tmp_path):
    simulated_study(tmp_path, persons=12, trials=4, seed=3)
    (tmp_path / "a").mkdir()
    done = process(
        "trials", "analyse", tmp_path, "--protocol", "level_walking", "--names", NAMES,
        "--out", tmp_path / "a", "--processes", 2,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    with (tmp_path / "a" / "tables" / "tukey_rcof_shoe.csv").open(newline="") as stream:
        lines = [line for line in stream if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    scale = 1.003  # of the resultant's peak over the braking peak in the made-up step
    assert len(rows) == 3
    for row, (one, two) in zip(rows, combinations(SHOES, 2), strict=True):
        assert (row["first"], row["second"]) == (one, two)
        difference = scale * (SHOES[one] - SHOES[two])
        assert float(row["95 % low"]) <= difference <= float(row["95 % high"])
    stored = list((tmp_path / "a" / ".files").glob("*.json"))
    assert len(stored) == 144
    assert json.loads(stored[0].read_text())[0]["verdict"] in ("accepted", "caution")
