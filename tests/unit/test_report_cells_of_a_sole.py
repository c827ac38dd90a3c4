"""A sole of a few cells drawn: its faces, and the scales of its pictures."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.report.design_study import explorer
from underfoot.report.drawn_sole import DrawnSole
from underfoot.report.outsole import outsole_figure
from underfoot.report.sole_mesh import sole_mesh
from underfoot.shoe import Heel, Tread, heel_surface
from underfoot.shoe.tread_measures import channel_depth, tread_measures

SIDE = 2e-3


def test_the_faces_of_cells_stand_on_their_corners_and_cover_the_sole_once():
    nx, ny = 5, 4
    height = np.where((np.arange(nx) % 2 == 0)[:, None] & np.ones((nx, ny), bool), 0.0, 3e-3)
    height[0, 0] = np.nan
    x, y = SIDE * np.arange(nx), SIDE * (np.arange(ny) - 1.0)
    whole = slice(None), slice(None)
    mesh = sole_mesh(DrawnSole(x, y, SIDE, height, None, height == 0.0, whole, whole))
    corners = mesh.points[:, :2] / SIDE - 0.5
    assert corners == pytest.approx(np.round(corners), abs=1e-9)
    a, b, c, d = np.moveaxis(mesh.points[mesh.quads], 1, 0)
    normal = 0.5 * np.cross(c - a, d - b)
    known = int(np.isfinite(height).sum())
    assert normal[mesh.cell >= 0, 2] == pytest.approx(np.full(known, -(SIDE**2)))
    assert normal[mesh.cell < 0, 2] == pytest.approx(0.0, abs=1e-15)
    assert normal[:, :2].sum(axis=0) == pytest.approx([0.0, 0.0], abs=1e-12)  # walls all around


def test_the_depth_of_channels_is_drawn_up_to_the_deepest():
    heel = Heel(
        length=0.04, width=0.04, rear_radius=0.015, outsole_thickness=0.02,
        tread=Tread("grid", lug_width=8e-3, channel_width=4e-3, depth=3e-3),
    )  # fmt: skip
    surface = heel_surface(heel, spacing=1e-3)
    figure = outsole_figure(surface, tread_measures(surface))
    image = figure.axes[1].collections[0]
    assert image.get_clim() == pytest.approx((0.0, 1e3 * float(np.nanmax(channel_depth(surface)))))


def test_no_reason_of_a_design_ends_the_script_that_it_stands_in():
    reason = "no </script><b>"
    design = SimpleNamespace(number=0, changes={}, reason=reason)
    plan = SimpleNamespace(dimensions=[], shown_goals=[], goals=[])
    result = SimpleNamespace(
        plan=plan, front=[], meets_requirements=lambda _: [True],
        goal_estimates=lambda designs, goals: (np.zeros((1, 0)), None),
    )  # fmt: skip
    shown = explorer(cast(Any, result), cast(Any, [design]))
    assert "<b>" not in shown
    assert "no \\u003c/script>\\u003cb>" in shown


@pytest.mark.parametrize(
    ("length", "width", "tall"), [(0.06, 0.04, 6), (0.12, 0.04, 10), (0.04, 0.06, 4.5)]
)
def test_the_picture_of_an_outsole_is_as_tall_as_its_sole_within_a_page(length, width, tall):
    heel = Heel(length=length, width=width, rear_radius=5e-3, outsole_thickness=0.02)
    surface = heel_surface(heel, spacing=SIDE)
    figure = outsole_figure(surface, tread_measures(surface))
    assert figure.get_size_inches() == pytest.approx([12.5, tall], rel=0.02)
