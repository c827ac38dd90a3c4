"""Steps of studies with a value of their own: a strip's film by quadrature, nested paths, grids."""

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from underfoot.studies.calibration import profile_figure
from underfoot.studies.corpus import Side, _effects
from underfoot.studies.corpus_cases import _nested
from underfoot.studies.validation import _strip_load
from underfoot.studies.verdict import Quantity, grid_value


@pytest.mark.parametrize(("corner", "slope", "pool"), [(2e-3, 0.02, 1e-4), (5e-3, 0.1, 3e-4)])
def test_a_strip_carries_what_its_pressure_adds_up_to(corner, slope, pool):
    film, viscosity, speed = 2e-5, 0.2, 0.5
    inlet = corner + (pool - film) / slope
    x = np.unique(
        np.concatenate([np.linspace(0, corner, 20001), np.linspace(corner, inlet, 20001)])
    )
    h = film + slope * np.maximum(x - corner, 0.0)
    still = np.trapezoid(h**-2.0, x) / np.trapezoid(h**-3.0, x)
    pressure = 6 * viscosity * speed * cumulative_trapezoid((still - h) / h**3, x, initial=0)
    assert abs(pressure[-1]) < 1e-6 * pressure.max()
    load = _strip_load(film, corner, slope, pool, viscosity=viscosity, speed=speed)
    assert abs(load) == pytest.approx(abs(np.trapezoid(pressure, x)), rel=1e-4)


def test_a_path_is_tables_in_tables():
    assert _nested("shoe.tread.lug_width", "5 mm") == {"shoe": {"tread": {"lug_width": "5 mm"}}}
    assert _nested("shoe", 1) == {"shoe": 1}


def test_a_probability_is_the_share_of_draws_between_two_ends():
    drawn = Quantity.of(0.5, draws=np.linspace(0, 1, 100_001))
    assert drawn.probability(0.2, 0.5) == pytest.approx(0.3, abs=0.01)
    assert drawn.probability(-1.0, 0.5) == pytest.approx(0.5, abs=0.01)
    assert drawn.probability(0.9, 2.0) == pytest.approx(0.1, abs=0.01)
    assert drawn.probability(2.0, 3.0) == 0.0
    assert Quantity.of([1.0, 2.0, 3.0, 4.0]).probability(1.5, 3.5) == 0.5
    assert Quantity.of(1.0).probability(0.5, 1.5) is None


def test_the_value_of_one_grid_is_that_grid_s_and_not_converged():
    one = grid_value([(1e-3, 7.0)], 1.0)
    assert (one.value, one.converged) == (7.0, False)
    assert math.isnan(grid_value([], 1.0).value)


def effect(name, rises, over, under):
    """Return a published effect of 2 mm and its computed sides."""
    contrast = SimpleNamespace(
        source="s", effect=name, fluid="water", topic="depth", published="", rises=rises, step=2.0
    )
    return contrast, over, under


def test_an_effect_is_judged_by_both_of_its_sides():
    under = Side(0.2, np.full(4, 0.2))
    over = Side(0.3, 0.2 * np.array([2.0, 2.0, 1.0, 0.5]))
    none = Side(math.nan, np.array([math.nan]), "no steady state")
    table, quantities = _effects(
        cast(
            Any,
            [
                effect("rises", True, over, under),
                effect("falls", False, over, under),
                effect("without over", True, none, under),
                effect("without under", True, over, none),
            ],
        )
    )
    rows = [dict(zip(table.columns, row, strict=True)) for row in table.rows]
    assert [row["verdict"] == "not computed" for row in rows] == [False, False, True, True]
    chances = [row["probability of the sign"] for row in rows]
    assert chances == [0.625, 0.375, None, None]  # a draw that ties counts half
    assert rows[0]["computed ratio"] == pytest.approx(1.5)
    assert rows[0]["per mm"] == pytest.approx(0.05)
    low, high = np.quantile([2.0, 2.0, 1.0, 0.5], (0.025, 0.975))
    assert (rows[0]["low 95 %"], rows[0]["high 95 %"]) == pytest.approx((low, high))
    assert quantities["effects.right_sign"].values[0] == 0.5  # of the two that are computed


def test_a_profile_is_drawn_over_its_parameter_and_no_higher_than_a_thousand():
    profile = SimpleNamespace(
        name="area", unit="1", grid=np.array([1.0, 2.0, 3.0]), profile=np.array([4.0, 0.0, 5e4]),
        misfit=0.0, low=1.5, high=None, fixed="fixed", text=lambda: "",
    )  # fmt: skip
    figure = profile_figure(cast(Any, [SimpleNamespace(profile=profile, default=2.0)]))
    (panel,) = figure.panels
    drawn, _, *ends = panel.layers
    assert [(*one.x, one.label) for one in ends] == [(1.5, "end of 95 %"), (2.0, "default")]
    np.testing.assert_array_equal(drawn.x, [1, 2, 3])
    np.testing.assert_array_equal(drawn.y, [4, 0, 1e3])
