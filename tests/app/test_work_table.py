"""The table of variants: inputs that differ, results of present inputs, files with units."""

import csv
import shutil
from pathlib import Path

import pytest
from openpyxl import load_workbook

from underfoot.app import work_table
from underfoot.core import silent


@pytest.fixture
def entries(worn_shoe_result, worn_shoe_case, tmp_path):
    """Return a computed variant, one that changed since, one without a result, one that is none."""
    worn_shoe_result.save(tmp_path / "computed")
    shutil.copytree(tmp_path / "computed", tmp_path / "changed")
    texts = {
        "computed": worn_shoe_result.case_text,
        "changed": worn_shoe_case.replace("motion.speed", "0.31 m/s").to_toml(),
        "new": worn_shoe_case.replace("motion.speed", "0.5 m/s").to_toml(),
        "broken": "[shoe",
    }
    for name, text in texts.items():
        (tmp_path / f"{name}.toml").write_text(text)
    return [(n, str(tmp_path / f"{n}.toml"), str(tmp_path / n)) for n in texts]


def test_rows_say_what_their_numbers_are_of(entries, worn_shoe_result):
    found = work_table.rows(entries, progress=silent)
    rows = {row["name"]: row for row in found["rows"]}
    assert [rows[n]["state"] for n in rows] == ["current", "earlier", "not_computed", "unreadable"]
    assert ("motion.speed", "m/s") in found["inputs"]
    assert rows["new"]["motion.speed"] == pytest.approx(0.5)
    assert rows["computed"]["cof"] == worn_shoe_result.value("cof")
    assert rows["broken"]["remark"]


@pytest.mark.parametrize("kind", ["csv", "xlsx"])
def test_files_have_interval_and_unit_and_no_number_of_earlier_inputs(
    entries, worn_shoe_result, kind
):
    file = work_table.written(entries, "table", kind, progress=silent)
    if kind == "csv":
        lines = list(csv.reader(Path(file).read_text(encoding="utf-8").splitlines()))
    else:
        _, *lines = load_workbook(file)["variants"].iter_rows(values_only=True)
    rows = {line[0]: dict(zip(lines[0], line, strict=True)) for line in lines[1:]}
    cof, load = (worn_shoe_result.scalars[name] for name in ("cof", "fluid_load"))
    assert float(rows["computed"]["cof (1)"]) == pytest.approx(cof.value)
    ends = [float(rows["computed"][f"cof, 95 % {end} (1)"]) for end in ("low", "high")]
    assert ends == pytest.approx(list(cof.interval))
    assert float(rows["computed"]["fluid_load (N)"]) == pytest.approx(load.value)
    assert float(rows["new"]["motion.speed (m/s)"]) == pytest.approx(0.5)
    assert not rows["changed"]["cof (1)"]
    assert rows["changed"]["state"] == "earlier"


def test_a_changed_file_is_read_anew(entries):
    work_table.rows(entries, progress=silent)
    case = entries[2][1]
    text = Path(case).read_text(encoding="utf-8")
    Path(case).write_text(text.replace("0.5 m/s", "0.55 m/s"), encoding="utf-8")
    row = work_table.rows(entries, progress=silent)["rows"][2]
    assert row["motion.speed"] == pytest.approx(0.55)
