"""Figures have as many places as panels, and no more rows than these fill."""

from types import SimpleNamespace
from typing import Any, cast

import pytest

from underfoot.report.question_figures import sensitivity_figure


@pytest.mark.parametrize(("count", "rows"), [(1, 1), (2, 1), (3, 2), (4, 2)])
def test_panels_of_a_sensitivity_stand_two_in_a_row(count, rows):
    names = [f"quantity {k}" for k in range(count)]
    nominal = SimpleNamespace(
        name="a case", number=lambda _: 1.0, scalars=dict.fromkeys(names, SimpleNamespace(unit="1"))
    )
    shown = SimpleNamespace(
        nominal=nominal,
        ranked=lambda _: [],
        band=lambda _: SimpleNamespace(value=1.0, deviation=None),
    )
    figure = sensitivity_figure(cast(Any, shown), {name: name for name in names})
    assert len(figure.axes) == count
    grids = [axes.get_subplotspec().get_gridspec() for axes in figure.axes]
    assert {(grid.nrows, grid.ncols) for grid in grids} == {(rows, 2)}
