"""``underfoot test`` and ``underfoot sensitivity`` as a person uses them, and their arithmetic."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import norm

from commands import called, process
from underfoot import run
from underfoot.case import Case
from underfoot.core import InputError
from underfoot.questions.method import Basis, method_name, method_prediction, probability_at_least

TEXT = """
name = "Worn work shoe"
shoe = "work_shoe_untreaded"
floor = "vinyl_g4"
contaminant = "glycerol_90pct"
motion = "slip_tester_g4"
numerics.quick_grid_spacing = "2.5 mm"
numerics.cells_along = 1
numerics.tread_positions = 1
"""


@pytest.fixture(autouse=True)
def _own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path / "cache"))


@pytest.fixture
def case_file(tmp_path) -> Path:
    path = tmp_path / "case.toml"
    path.write_text(TEXT, encoding="utf-8")
    return path


def test_probability_is_that_of_the_normal_distribution() -> None:
    assert probability_at_least(0.3, 0.05, 0.31) == pytest.approx(norm.sf(0.31, 0.3, 0.05))
    assert probability_at_least(0.31, 0.0, 0.31) == 1.0
    assert probability_at_least(0.3, 0.0, 0.31) == 0.0


def test_the_method_sets_motion_floor_and_fluid() -> None:
    case = Case.from_text(TEXT)
    found = method_prediction(case, "report-whole-shoe", with_band=False, quick=True)
    (condition,) = found.conditions
    assert condition.contaminant == "glycerol_50pct"
    own = {row.name: row for row in found.requirements}
    assert own["shoe angle"].required == "7 deg"
    assert own["floor"].basis is Basis.ASSUMED
    assert own["averaging window"].used == "steady sliding"
    alone = case.replace({"motion": "whole_shoe_g6", "contaminant": "glycerol_50pct"})
    expected = run(alone.replace("motion.steady", True), quick=True)["cof"].value
    assert condition.cof.value == pytest.approx(expected, rel=1e-9)
    assert condition.probability is None
    assert condition.limit is None


def test_a_limit_becomes_a_probability_and_keeping_a_part_is_a_departure() -> None:
    case = Case.from_text(TEXT)
    found = method_prediction(case, "iso13287", keep=["contaminant"], with_band=False, quick=True)
    row = next(row for row in found.requirements if row.name.startswith("contaminant,"))
    assert row.basis is Basis.DEPARTURE
    assert "glycerol_90pct" in row.used
    tile = found.conditions[0]
    assert tile.limit is not None
    assert tile.limit.value == 0.31
    assert tile.cof.value is not None
    spread = np.log(tile.high / tile.cof.value) / norm.ppf(0.975)
    expected = norm.sf(np.log(0.31), np.log(tile.cof.value), spread)
    assert tile.probability == pytest.approx(expected)


def test_unknown_methods_and_parts_are_answered_with_the_nearest() -> None:
    case = Case.from_text(TEXT)
    assert method_name("ISO-13287", case) == "en_iso_13287"
    with pytest.raises(InputError, match="en_iso_13287"):
        method_name("iso_1328", case)
    with pytest.raises(InputError, match="contaminant"):
        method_prediction(case, "iso13287", keep=["contaminants"])


@pytest.mark.slow
def test_command_writes_what_it_shows(case_file, tmp_path) -> None:
    out = tmp_path / "out"
    done = process("test", case_file, "--method", "report-whole-shoe", "--quick", "--out", out)
    assert done.returncode == 0, done.stderr
    stored = json.loads((out / "test.json").read_text(encoding="utf-8"))
    value = stored["conditions"][0]["cof"]["value"]
    assert f"COF {value:.3f}" in done.stdout
    with (out / "conditions.csv").open(encoding="utf-8") as stream:
        (row,) = csv.DictReader(stream)
    assert float(row["cof"]) == value
    refused = called("test", case_file, "--quick", "--out", out)
    assert refused.returncode != 0
    assert "--overwrite" in refused.stderr


@pytest.mark.slow
def test_sensitivity_command(case_file, tmp_path) -> None:
    out = tmp_path / "out"
    # at an instant: to where it slides steadily, squares this coarse have no answer at every end
    instant = '{ from = "slip_tester_g4", duration = "120 ms" }'
    case_file.write_text(TEXT.replace('"slip_tester_g4"', instant), encoding="utf-8")
    done = process("sensitivity", case_file, "--out", out, "--json")
    assert done.returncode == 0, done.stderr
    quantities = json.loads(done.stdout)["quantities"]
    load = quantities["fluid_load"]
    spread = math.sqrt(sum(each["deviation"] ** 2 for each in load["effects"]))
    assert load["from_inputs"] == pytest.approx(spread)
    assert (out / "sensitivity.png").read_bytes()[:4] == b"\x89PNG"
    with (out / "sensitivity.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert {row["quantity"] for row in rows} == set(quantities)
