"""The surface that pages draw: edges where the design has them, areas, heights, walls."""

import math

import numpy as np
import pytest

from underfoot import load
from underfoot.compute.sole import drawn_map
from underfoot.report.surface_mesh import _along_edge, _cut_where_lines_meet, surface_mesh
from underfoot.shoe import Facet, Heel, Rocker, Tread, heel_map, heel_surface

FINE = 0.3e-3
WHOLE = {
    "plan": "sole", "side": "right", "length": "290 mm", "width": "68 mm",
    "waist_width": "58 mm", "ball_width": "102 mm", "edge_radius": "2 mm",
}  # fmt: skip


def heel(pattern, **tread):
    return Heel(
        length=0.07, width=0.065, rear_radius=0.03, outsole_thickness=0.02,
        profile=Facet(math.radians(8), 0.02), tread=Tread(pattern, 9e-3, 4e-3, 3e-3, **tread),
    )  # fmt: skip


def mesh_of(surface):
    return surface_mesh(surface.x, surface.y, surface.height, surface.land)


def along(mesh, pairs):
    """Places on lines between pairs of points, seven on each."""
    shares = np.linspace(0.05, 0.95, 7)[:, None, None]
    ends = mesh.points[pairs]
    return (ends[:, 0] * (1 - shares) + ends[:, 1] * shares).reshape(-1, 3)


def area_of(mesh, faces):
    a, b, c = mesh.points[faces][:, :, :2].transpose(1, 0, 2)
    return np.abs(np.linalg.det(np.stack([b - a, c - a], axis=-1))).sum() / 2


@pytest.mark.parametrize(
    "tread",
    [heel("hexagons"), heel("circles"), heel("bars", angle=math.radians(30)), heel("grid")],
    ids=lambda shape: shape.tread.pattern,
)
def test_edges_of_lugs_and_rim_lie_where_they_were_designed(tread):
    mesh = mesh_of(heel_surface(tread, spacing=FINE))
    lug = along(mesh, mesh.walls[:, :2])
    within = tread.inward_distance(lug[:, 0], lug[:, 1]) > 1e-3  # beside the rim it is the edge
    off = np.abs(tread.tread.channel_distance(lug[within, 0], lug[within, 1]))
    assert np.quantile(off, 0.99) < 0.3e-3
    assert off.mean() < 0.08e-3
    rim = along(mesh, mesh.sides)
    off = np.abs(tread.inward_distance(rim[:, 0], rim[:, 1]))
    assert off.max() < 0.3e-3
    # and covers as much as the design: lugs and plan form
    land = mesh.land[mesh.triangles[:, 0]]
    assert area_of(mesh, mesh.triangles) == pytest.approx(tread.plan_area, rel=5e-3)
    fine = heel_surface(tread, spacing=0.1e-3)
    walls = mesh.points[mesh.walls]
    half_cell_at_edges = np.hypot(*(walls[:, 1] - walls[:, 0])[:, :2].T).sum() * FINE / 2
    assert area_of(mesh, mesh.triangles[land]) == pytest.approx(
        fine.land.sum() * fine.spacing**2, abs=half_cell_at_edges
    )


@pytest.mark.parametrize("pattern", ["hexagons", "circles", "grid", "bars", "transverse"])
def test_with_the_crossings_of_cells_lugs_are_drawn_within_a_twentieth_of_a_millimetre(pattern):
    """On cells of 0.15 mm and, of a whole sole, 0.2 mm: corners as well as arcs."""
    shape = heel(pattern)
    for spacing in (0.15e-3, 0.2e-3):
        sole = heel_map(shape, shoe_angle=0.0, spacing=spacing)
        height = np.where(sole.inside, sole.clearance, np.nan)
        mesh = surface_mesh(sole.x, sole.y, height, sole.land, sole.cut)
        lugs = mesh.walls[mesh.land[mesh.walls[:, 0]] != mesh.land[mesh.walls[:, 2]]]
        x, y = along(mesh, lugs[:, :2])[:, :2].T
        within = shape.inward_distance(x, y) > 2 * spacing  # what lies on the rim is the rim's
        off = np.abs(shape.tread.channel_distance(x, y))[within]
        assert off.max() < 0.05e-3
        assert np.quantile(off, 0.9) < 0.025e-3
        plain = surface_mesh(sole.x, sole.y, height, sole.land)
        assert len(lugs) < 4 * len(plain.walls), "as few lines as it takes"


def test_a_round_heel_has_no_teeth():
    mesh = mesh_of(heel_surface(heel("grid"), spacing=FINE))
    way = mesh.points[mesh.sides[:, 1], :2] - mesh.points[mesh.sides[:, 0], :2]
    middle = mesh.points[mesh.sides].mean(axis=1)
    behind = middle[:, 0] < 0.025  # the round part: the rim turns slowly
    x, y = (middle[behind, :2] - [0.03, 0.0]).T
    about = np.arctan2(y, x)
    order = np.argsort(about)
    turn = np.arctan2(*way[behind][order].T[::-1])
    steps = np.abs((np.diff(turn) + math.pi / 2) % math.pi - math.pi / 2)
    assert np.degrees(steps.max()) < 40, "stairs turn by 45 or 90 degrees"


def test_heights_are_those_of_the_cells_with_few_triangles():
    shape = Heel(length=0.07, width=0.065, rear_radius=0.03, outsole_thickness=0.02,
                 profile=Rocker(0.15, 0.05), tread=Tread("hexagons", 9e-3, 4e-3, 3e-3))  # fmt: skip
    surface = heel_surface(shape, spacing=FINE)
    mesh = mesh_of(surface)
    corners = mesh.points[mesh.triangles]
    middle = corners.mean(axis=1)
    height = shape.land_height(middle[:, 0], middle[:, 1])
    height = height + np.where(mesh.land[mesh.triangles[:, 0]], 0.0, 3e-3)
    off = np.abs(middle[:, 2] - height)
    assert np.quantile(off, 0.99) < 0.06e-3
    assert len(mesh.triangles) < surface.inside.sum() / 8


def test_a_step_within_the_land_is_a_wall_and_mirrored_soles_have_mirrored_areas():
    x = y = (np.arange(80) + 0.5) * FINE
    height = np.where((x < 0.012)[:, None] & (y < 0.01), 2e-3, 0.0) * np.ones((80, 80))
    land = np.ones_like(height, bool)
    mesh = surface_mesh(x, y, height, land)
    wall = mesh.points[mesh.walls]
    drop = np.abs(wall[:, 0, 2] - wall[:, 2, 2])
    np.testing.assert_allclose(drop, 2e-3, rtol=1e-6)
    length = np.hypot(*(wall[:, 1, :2] - wall[:, 0, :2]).T).sum()
    assert length == pytest.approx(0.022, rel=0.03)
    np.testing.assert_array_equal(wall[:, 0, :2], wall[:, 2, :2])
    turned = surface_mesh(x, y, height[:, ::-1], land)
    high = [area_of(m, m.triangles[(m.points[m.triangles][:, :, 2] > 1e-3).all(axis=1)])
            for m in (mesh, turned)]  # fmt: skip
    assert high[0] == pytest.approx(0.012 * 0.01, rel=0.03)
    assert high[1] == pytest.approx(high[0], rel=0.02)


def test_lines_that_come_back_on_themselves_leave_few_triangles():
    """A whole sole's rim cuts lugs to slivers, whose corners lie beyond their next place."""
    case = load("examples/work_shoe_full_tread_glycerol.toml").replace(
        {"shoe.heel": WHOLE, "shoe.tread.pattern": "hexagons"}
    )
    sole = drawn_map(case.replace("motion.shoe_angle", "0 deg"), 0.4e-3)
    sole = sole.whole or sole
    height = np.where(sole.inside, sole.clearance, np.nan)
    mesh = surface_mesh(sole.x, sole.y, height, sole.land, sole.cut)
    assert len(mesh.points) < 20_000
    assert area_of(mesh, mesh.triangles) == pytest.approx(sole.inside.sum() * 0.4e-3**2, rel=2e-3)


def test_lines_are_cut_where_they_meet():
    places, lines = _cut_where_lines_meet(
        np.array([[[0, 0], [3, 0]], [[3, 0], [1, 0]], [[2, -1], [2, 1]]]) * 1.0
    )
    parts = {tuple(sorted(map(tuple, places[line].tolist()))) for line in lines}
    straight = [((x, 0.0), (x + 1.0, 0.0)) for x in (0.0, 1.0, 2.0)]
    assert parts == {*straight, ((2.0, -1.0), (2.0, 0.0)), ((2.0, 0.0), (2.0, 1.0))}


@pytest.mark.parametrize("before", [4, 5, 6, 9])
@pytest.mark.parametrize("after", [4, 5, 6, 9])
def test_a_corner_that_was_cut_off_moves_to_where_its_sides_meet(before, after):
    """However few places lie on a side: two that are trusted tell its direction."""
    places = np.array(
        [[-n, 0.0] for n in range(before, 0, -1)]
        + [[-0.2, 0.2]]
        + [[0.0, n] for n in range(1, after + 1)]
    )
    lines = _along_edge(places, list(range(len(places))), 0.1)
    assert lines.tolist() == [[0, before], [before, before + after]]
    assert places[before] == pytest.approx([0.0, 0.0], abs=1e-12)
