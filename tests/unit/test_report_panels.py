"""Figures have as many places as panels, and no more rows than these fill."""

from types import SimpleNamespace
from typing import Any, cast

import pytest

from underfoot.report.question_figures import sensitivity_figure
from underfoot.report.studies_page import _cell


@pytest.mark.parametrize(("count", "rows"), [(1, 1), (2, 1), (3, 2), (4, 2)])
def test_panels_of_a_sensitivity_stand_two_in_a_row(count, rows):
    names = [f"quantity {k}" for k in range(count)]
    nominal = SimpleNamespace(
        name="a case", number=lambda _: 1.0, scalars=dict.fromkeys(names, SimpleNamespace(unit="1"))
    )
    shown = SimpleNamespace(
        nominal=nominal,
        ranked_effects=lambda _: [],
        band=lambda _: SimpleNamespace(value=1.0, deviation=None),
    )
    figure = sensitivity_figure(cast(Any, shown), {name: name for name in names})
    assert len(figure.axes) == count
    grids = [cast(Any, axes.get_subplotspec()).get_gridspec() for axes in figure.axes]
    assert {(grid.nrows, grid.ncols) for grid in grids} == {(rows, 2)}


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0, "0"), (0.123456, "0.1235"), (12345.6, "1.235e+04"), (1e-3, "0.001"),
     (1.23456e-4, "0.000123"), (-123456.0, "-1.23e+05"), (None, "-"), (float("nan"), "-")],
)  # fmt: skip
def test_a_cell_has_four_digits_three_where_its_number_is_far_from_one(value, text):
    assert _cell(value) == (text, True)
