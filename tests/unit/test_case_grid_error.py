"""What grid and steps in time leave open: exact for first-order errors, in words and spread."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from underfoot.case import Case
from underfoot.compute.numbers import (
    GRID_NAMES,
    discretisation_words,
    grid_errors,
    step_errors,
    with_discretisation_errors,
)
from underfoot.compute.run import run
from underfoot.compute.solve import solved_motion
from underfoot.core import SourcedValue, Status

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_errors_are_differences_to_the_resolved_cells_and_by_halved_steps():
    plain, resolved = (
        dict(zip(GRID_NAMES, values, strict=True))
        for values in ((0.04, 100.0, 40.0, 1e5), (0.06, 90.0, 43.0, 1e5))
    )
    errors = grid_errors(plain, resolved)
    assert errors == pytest.approx(dict(zip(GRID_NAMES, (0.02, 10.0, 3.0, 0.0), strict=True)))
    # a first-order error of the steps: what half of them leaves, twice
    assert step_errors(plain, resolved)["fluid_load"] == pytest.approx(2 * 10.0)


def test_the_error_joins_a_known_spread_and_interval_and_is_told():
    numbers = {
        "cof": SourcedValue(0.04, uncertainty=0.003, interval=(0.036, 0.05)),
        "fluid_load": SourcedValue(100.0, "N", source="s", reason="not known"),
        "fluid_load_sensor": SourcedValue(40.0, "N", source="s", uncertainty=3.0, note="tracks"),
        "peak_fluid_pressure_sensor": SourcedValue(1e5, "Pa", source="s", uncertainty=0.0),
    }
    grid = dict(zip(GRID_NAMES, (0.003, 5.0, 4.0, 2e3), strict=True))
    steps = dict(zip(GRID_NAMES, (0.0, 1.0, 12.0, 0.0), strict=True))
    found = with_discretisation_errors(numbers, grid, steps)
    assert found["cof"].interval == pytest.approx((0.035, 0.04 + math.hypot(0.01, 0.003)))
    assert found["fluid_load_sensor"].uncertainty == pytest.approx(13.0)
    assert found["fluid_load"].uncertainty is None
    assert "grid error about 4 N, of the steps in time 12 N" in found["fluid_load_sensor"].note
    words = discretisation_words(found, grid, steps, "cells of 1 mm")
    assert "difference to cells of 1 mm" in words
    assert "steps in time: cof +- 0, fluid load +- 1 N" in words
    dry = with_discretisation_errors(numbers, grid, {})
    assert dry["fluid_load_sensor"].uncertainty == pytest.approx(5.0)
    assert "steps" not in dry["fluid_load_sensor"].note


@pytest.mark.parametrize("name", ["untreaded_glycerol", "full_tread_dry"])
def test_a_run_tells_of_grid_and_steps(name):
    case = Case.load(EXAMPLES / f"work_shoe_{name}.toml").replace(
        {
            "numerics.grid_check": True,
            "numerics.tread_positions": 1,
            "numerics.grid_spacing": "1 mm",
            "numerics.quick_grid_spacing": "1.2 mm",
        }
    )
    result = run(case)
    words = result.labels["grid_error"]
    assert "cells of 1.2 mm, 16 along the sliding" in words
    assert ("steps in time" in words) == ("dry" not in name)
    if "untreaded" in name:  # square cells can't hold the inlet: the interval says so
        plain = run(case.replace("numerics.grid_check", False))
        checked, unchecked = (each.scalars["cof"].interval for each in (result, plain))
        assert checked is not None
        assert unchecked is not None
        assert checked[1] > unchecked[1]


def test_a_check_that_does_not_converge_is_told(monkeypatch):
    def fails_with_more_steps(*given, finer=1, **options):
        contact = solved_motion(*given, finer=finer, **options)
        return replace(contact, status=Status.NOT_CONVERGED) if finer > 1 else contact

    monkeypatch.setattr("underfoot.compute.solve.solved_motion", fails_with_more_steps)
    case = Case.load(EXAMPLES / "work_shoe_untreaded_glycerol.toml").replace(
        {
            "numerics.grid_check": True,
            "numerics.grid_spacing": "2 mm",
            "numerics.quick_grid_spacing": "3 mm",
        }
    )
    assert run(case).labels["grid_error"].startswith("not estimated: a march on cells of 3 mm")
