"""The grid's share in a reading: exact for a first-order error, said in words and spread."""

import pytest

from underfoot.compute.numbers import GRID_NAMES, grid_errors, grid_words, with_grid_errors
from underfoot.core import SourcedValue


def test_first_order_error_is_found_exactly():
    def reading(spacing):
        return dict(zip(GRID_NAMES, (100 + 5 * spacing, 40 - 2 * spacing, 1e5), strict=True))

    errors = grid_errors(reading(0.6), reading(1.0), 1.0 / 0.6)
    assert errors["fluid_load"] == pytest.approx(5 * 0.6)
    assert errors["fluid_load_sensor"] == pytest.approx(2 * 0.6)
    assert errors["peak_fluid_pressure_sensor"] == 0.0


def test_the_error_joins_a_known_spread_and_is_said():
    numbers = {
        "fluid_load": SourcedValue(100.0, "N", source="s", reason="not known"),
        "fluid_load_sensor": SourcedValue(40.0, "N", source="s", uncertainty=3.0, note="tracks"),
        "peak_fluid_pressure_sensor": SourcedValue(1e5, "Pa", source="s", uncertainty=0.0),
    }
    errors = dict(zip(GRID_NAMES, (5.0, 4.0, 2e3), strict=True))
    found = with_grid_errors(numbers, errors)
    assert found["fluid_load_sensor"].uncertainty == pytest.approx(5.0)
    assert found["fluid_load"].uncertainty is None
    assert "grid error about 4 N" in found["fluid_load_sensor"].note
    assert "1 and 0.6 mm" in grid_words(found, errors, 0.6e-3, 1e-3)
