"""Sampled intervals from case to result folder, summary and sentence."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute.result import Result
from underfoot.compute.run import run
from underfoot.core.presentation import value_text

EXAMPLE = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"
COARSE = {
    "numerics.quick_grid_spacing": "3 mm",
    "numerics.tread_positions": 1,  # the spread of the law alone
    "models.friction": "asperity_ehl",
}


@pytest.fixture(scope="module")
def case():
    return Case.load(EXAMPLE, settings=COARSE)


@pytest.fixture(scope="module")
def result(case):
    return run(case, quick=True)


def test_cof_and_its_parts_carry_an_interval_that_holds_them(result):
    names = ("cof", "cof_adhesion", "cof_hysteresis", "cof_viscous", "slip_probability")
    for name in names:
        one = result.scalars[name]
        low, high = one.interval
        assert low <= one.value <= high
        assert one.uncertainty > 0
    assert "the law itself" in result.labels["cof_spread_from"]
    assert "seed 0" in result.labels["cof_spread_how"]


def test_the_seed_is_the_case_s(case, result):
    again = run(case, quick=True)
    assert again.scalars["cof"].interval == result.scalars["cof"].interval
    other = run(case.replace("numerics.seed", 1), quick=True)
    assert other.scalars["cof"].value == result.scalars["cof"].value
    assert other.scalars["cof"].interval != result.scalars["cof"].interval
    width, other_width = (
        math.log(high / low)
        for low, high in (one.scalars["cof"].interval for one in (result, other))
    )
    assert other_width == pytest.approx(width, rel=0.1)  # of 500 draws


def test_a_wider_input_widens_the_interval(case, result):
    wider = case.replace({"interface.hysteresis_cof": {"value": 0.1243, "uncertainty": 0.06}})
    found = run(wider, quick=True).scalars
    assert np.ptp(found["cof"].interval) > 1.2 * np.ptp(result.scalars["cof"].interval)
    assert np.ptp(found["slip_probability"].interval) > np.ptp(
        result.scalars["slip_probability"].interval
    )


def test_files_and_words_show_it(result, tmp_path):
    result.save(tmp_path / "out")
    stored = json.loads((tmp_path / "out" / "result.json").read_text())
    assert stored["cof"]["interval"] == list(result.scalars["cof"].interval)
    with (tmp_path / "out" / "summary.csv").open() as stream:
        rows = {row["quantity"]: row for row in csv.DictReader(stream)}
    assert float(rows["cof"]["low_95"]) == result.scalars["cof"].interval[0]
    assert rows["contact_area"]["low_95"] == ""
    assert Result.load(tmp_path / "out").scalars["cof"] == result.scalars["cof"]
    shown = {label: (value, remark) for label, value, remark in result.table().rows}
    low, high = result.scalars["cof"].interval
    assert f"{low:.3f} to {high:.3f}" in " ".join(shown["Coefficient of friction"])
    assert any("Uncertainty of the COF" in note for note in result.remarks()["Notes"])


def test_a_skewed_interval_takes_the_place_of_one_deviation(result):
    from dataclasses import replace

    skewed = replace(result.scalars["cof"], value=0.1, uncertainty=0.05, interval=(0.08, 0.3))
    assert value_text("cof", skewed) == "0.100 (0.080 to 0.300)"
    even = replace(skewed, interval=(0.0, 0.2))
    assert value_text("cof", even) == "0.100 ± 0.050"


@pytest.mark.slow
def test_overloaded_rubber_has_no_peak_of_the_film_pressure():
    """It grows with the grid; the sensor's, a mean over its face, does not."""
    crushed = {
        "shoe.material.shore_a": 60,
        "motion.normal_force": "1500 N",
        "motion.shoe_angle": "20 deg",
        "numerics.tread_positions": 1,
    }
    path = EXAMPLE.with_name("work_shoe_full_tread_glycerol.toml")
    result = run(Case.load(path, settings=crushed), quick=True)
    assert result.usable
    assert "above the modulus" in " ".join(result.headline())
    peak = result.scalars["peak_fluid_pressure"]
    assert peak.value is None
    assert "not resolved" in peak.reason
    assert result.value("peak_fluid_pressure_sensor") > 0
