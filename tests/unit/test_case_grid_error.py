"""What grid and steps in time leave open: exact for first-order errors, in words and spread."""

from dataclasses import replace
from pathlib import Path

import pytest

from underfoot.case import Case
from underfoot.compute.contact import solved_motion
from underfoot.compute.numbers import (
    GRID_NAMES,
    discretisation_words,
    grid_errors,
    step_errors,
    with_discretisation_errors,
)
from underfoot.compute.run import run
from underfoot.core import SourcedValue, Status

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_first_order_error_is_found_exactly():
    def reading(spacing):
        return dict(zip(GRID_NAMES, (100 + 5 * spacing, 40 - 2 * spacing, 1e5), strict=True))

    errors = grid_errors(reading(0.6), reading(1.0), 1.0 / 0.6)
    assert errors["fluid_load"] == pytest.approx(5 * 0.6)
    assert errors["fluid_load_sensor"] == pytest.approx(2 * 0.6)
    assert errors["peak_fluid_pressure_sensor"] == 0.0
    # the same of a time step, whose half is solved too
    assert step_errors(reading(1.0), reading(0.5))["fluid_load"] == pytest.approx(5 * 1.0)


def test_the_error_joins_a_known_spread_and_is_said():
    numbers = {
        "fluid_load": SourcedValue(100.0, "N", source="s", reason="not known"),
        "fluid_load_sensor": SourcedValue(40.0, "N", source="s", uncertainty=3.0, note="tracks"),
        "peak_fluid_pressure_sensor": SourcedValue(1e5, "Pa", source="s", uncertainty=0.0),
    }
    grid = dict(zip(GRID_NAMES, (5.0, 4.0, 2e3), strict=True))
    steps = dict(zip(GRID_NAMES, (1.0, 12.0, 0.0), strict=True))
    found = with_discretisation_errors(numbers, grid, steps)
    assert found["fluid_load_sensor"].uncertainty == pytest.approx(13.0)
    assert found["fluid_load"].uncertainty is None
    assert "grid error about 4 N, of the steps in time 12 N" in found["fluid_load_sensor"].note
    words = discretisation_words(found, grid, steps, 0.6e-3, 1e-3)
    assert "from 1 and 0.6 mm" in words
    assert "steps in time: fluid load +- 1 N" in words
    dry = with_discretisation_errors(numbers, grid, {})
    assert dry["fluid_load_sensor"].uncertainty == pytest.approx(5.0)
    assert "steps" not in dry["fluid_load_sensor"].note


@pytest.mark.parametrize("name", ["untreaded_glycerol", "full_tread_dry"])
def test_a_run_tells_of_grid_and_steps(name):
    case = Case.load(EXAMPLES / f"work_shoe_{name}.toml").replace(
        {
            "numerics.grid_check": True,
            "numerics.grid_spacing": "1 mm",
            "numerics.quick_grid_spacing": "1.2 mm",
        }
    )
    words = run(case).labels["grid_error"]
    assert "from 1.2 and 1 mm" in words
    assert ("from twice as many on 1.2 mm" in words) == ("dry" not in name)


def test_a_check_that_does_not_converge_is_told(monkeypatch):
    def fails_with_more_steps(*given, finer=1, **options):
        contact = solved_motion(*given, finer=finer, **options)
        return replace(contact, status=Status.NOT_CONVERGED) if finer > 1 else contact

    monkeypatch.setattr("underfoot.compute.run.solved_motion", fails_with_more_steps)
    case = Case.load(EXAMPLES / "work_shoe_untreaded_glycerol.toml").replace(
        {
            "numerics.grid_check": True,
            "numerics.grid_spacing": "2 mm",
            "numerics.quick_grid_spacing": "3 mm",
        }
    )
    assert run(case).labels["grid_error"].startswith("not estimated: a march on 3 mm")
