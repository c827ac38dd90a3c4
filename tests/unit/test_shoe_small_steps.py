"""Steps of soles by their values: faces, lugs that take a fillet, ends, numbers, components."""

from itertools import permutations
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.core import DataError, InputError
from underfoot.shoe._kernels.arcs import biarc
from underfoot.shoe._kernels.covering_discs import channel_width
from underfoot.shoe._kernels.elements import _number
from underfoot.shoe._kernels.regions import across_channels
from underfoot.shoe.files import FileSettings, edges, outsole
from underfoot.shoe.files.mesh import Mesh, _check
from underfoot.shoe.files.threemf import _Object, _Package, _Volume
from underfoot.shoe.files.view import without_copies
from underfoot.shoe.grids import cut_heel
from underfoot.shoe.parametric import solid
from underfoot.shoe.parametric.sole import ShoeOutline
from underfoot.shoe.tread_measures import LUG_REACH, _without_ends
from underfoot.shoe.worn.surface import _Extent


@pytest.mark.parametrize(
    ("faces", "bad"),
    [([[0, 1, 2], [1, 2, 4]], 4), ([[0, 9, 2], [1, 2, 3]], 9), ([[0, 1, 2], [3, -1, 2]], -1)],
)
def test_a_face_without_a_vertex_is_named_by_it(faces, bad):
    body = SimpleNamespace(faces=np.array(faces), vertices=np.zeros((4, 3)))
    with pytest.raises(DataError, match=f"vertex {bad} of 4"):
        _check(cast(Any, body), "PLY", "sole.ply")
    body.faces = np.array([[0, 1, 2], [3, 2, 1]])
    _check(cast(Any, body), "PLY", "sole.ply")


@pytest.mark.parametrize(
    ("kink", "lug", "free"),
    [
        (0.0, (20, 30, 5), True),
        (17.5, (20, 30, 5), True),  # with rounded edges of 1 and rims of 0.5 mm: clear by 2 mm
        (18.5, (20, 30, 5), False),
        (25.0, (20, 30, 5), False),
        (31.5, (20, 30, 5), False),
        (32.5, (20, 30, 5), True),
        (0.0, (20, 30, 17.5), True),
        (0.0, (20, 30, 18.5), False),  # of 20 mm to the rim
        (0.0, (45, 55, 5), True),  # a circle around it ends 9.07 mm from its middle
        (0.0, (46, 56, 5), False),  # 9 mm from a groove
    ],
)
def test_a_lug_takes_a_fillet_where_it_keeps_clear_of_all_that_bends(monkeypatch, kink, lug, free):
    start, stop, half = lug
    groove = SimpleNamespace(channel_distance=lambda x, y: -abs(x - 60.0))
    shape = SimpleNamespace(
        edge_radius=1.0,
        tread=SimpleNamespace(edge_radius=0.5, edge_chamfer=0.0, grooves=[groove]),
        inward_distance=lambda x, y: 20.0 - np.abs(y),
    )
    monkeypatch.setattr(solid, "break_points", lambda _: [-99.0, kink, 99.0])
    corners = np.array([[start, -half], [stop, -half], [stop, half], [start, half]], float)
    outline = SimpleNamespace(points=corners, radius=0.0)
    fitting = solid._free_lugs(cast(Any, [outline]), cast(Any, shape))
    assert len(fitting) == free


def test_a_heel_is_as_wide_as_its_half_circle_fits_behind_it():
    """Its widest place is at 16 % of the length: half its width is at most twice that."""
    widest = 4 * 0.16 * 0.25
    ShoeOutline(length=0.25, heel_width=widest - 1e-6, waist_width=0.05, ball_width=0.1)
    with pytest.raises(InputError, match="at most 160 mm") as told:
        ShoeOutline(length=0.25, heel_width=widest + 1e-6, waist_width=0.05, ball_width=0.1)
    assert told.value.where == "heel.heel_width"


def test_lugs_at_the_rim_are_as_high_as_most_within_a_lugs_reach():
    height = np.random.default_rng(4).uniform(2e-3, 4e-3, (41, 31))
    all_over = np.ones(height.shape, bool)
    made = _without_ends(height, all_over, all_over, LUG_REACH / 4)  # four cells to each side
    windows = np.lib.stride_tricks.sliding_window_view(np.pad(height, 4, mode="edge"), (9, 9))
    usual = np.median(windows, axis=(2, 3))
    middle = np.s_[4:-4, 4:-4]
    np.testing.assert_array_equal(made[middle], height[middle])
    at_rim = ~np.pad(np.ones((33, 23), bool), 4)
    np.testing.assert_allclose(made[at_rim], usual[at_rim])


@pytest.mark.parametrize(
    "text",
    ["1.5", " 1.5", "1.5  ", "\t-2e3 ", "+.5", "7.", "-0.25E-2", "1e+2", "12345678.875", "0", "-3"],
)
def test_a_number_of_a_file_is_that_of_python_whatever_stands_around_it(text):
    around = np.frombuffer(f"9{text}9".encode(), np.uint8)
    value, good = _number(around, 1, len(text) + 1)
    assert good
    assert value == pytest.approx(float(text), rel=1e-15)


@pytest.mark.parametrize("text", ["", "  ", "-", "+", ".", "e5", "1.5x", "x1", "1 2", "1..2", "1e"])
def test_what_is_no_number_is_none(text):
    around = np.frombuffer(f"9{text}9".encode(), np.uint8)
    assert not _number(around, 1, len(text) + 1)[1]


@pytest.mark.parametrize(
    ("parts", "told", "kinds"),
    [
        ("12", [("1", "model"), ("2", "modifier")], ["model", "modifier"]),
        ("12", [("2", "modifier"), ("1", "model")], ["model", "modifier"]),  # in another order
        ("12", [("2", "modifier")], ["model", "modifier"]),
        ("11", [("1", "model"), ("1", "modifier")], ["model", "modifier"]),  # one object twice
        ("12", [], ["model", "model"]),
    ],
)
def test_a_slicer_tells_of_a_component_by_its_number_or_its_turn(parts, told, kinds):
    face, none = np.array([[0, 1, 2]]), np.zeros((0, 3), int)
    objects = {
        ("p", number): _Object(number, "model", np.eye(3), face, ())
        for number in dict.fromkeys(parts)
    }
    placed = tuple((("p", number), np.eye(4)) for number in parts)
    objects["p", "9"] = _Object("whole", "model", np.zeros((0, 3)), none, placed)
    reader = object.__new__(_Package)
    reader._of = objects.__getitem__
    volumes = tuple(
        _Volume(f"v{number}", cast(Any, kind), component=number) for number, kind in told
    )
    bodies = list(reader._bodies(("p", "9"), np.eye(4), (), "model", True, volumes))
    assert [body.kind for body in bodies] == kinds


@pytest.mark.parametrize(
    ("cells", "ends"), [(3.5, (0.0, 3.5)), (4.5, (-1.0, 5.5)), (20.0, (-1.0, 21.0))]
)
def test_a_line_of_a_lug_of_more_than_four_cells_runs_on_to_the_rim(monkeypatch, cells, ends):
    """By 2 mm beyond one cell of 1 mm before its end, on either side."""
    at = 1e-3 * np.linspace(0.0, cells, 15)
    points = np.stack([at, np.full(15, 3e-3)], axis=1)
    lines = np.stack([points[:-1], points[1:]], axis=1)
    surface = SimpleNamespace(spacing=1e-3, inside=np.ones((4, 4), bool))
    land = SimpleNamespace(land=np.zeros((4, 4), bool))
    every = np.ones(len(lines), bool)
    monkeypatch.setattr(edges, "section_lines", lambda *_: [lines])
    monkeypatch.setattr(edges, "drawn_surface", lambda _: land)
    monkeypatch.setattr(edges, "_beside", lambda *_: (every, ~every, every))
    none = cast(Any, None)
    made = edges.lug_lines(none, none, none, cast(Any, surface), 1e-3)
    assert (made[..., 0].min(), made[..., 0].max()) == pytest.approx(1e-3 * np.array(ends))
    np.testing.assert_allclose(made[..., 1], 3e-3)
    np.testing.assert_allclose(made[1:, 0], made[:-1, 1])  # one way without a gap


def test_a_line_around_a_lug_is_left_as_it_is(monkeypatch):
    turn = np.linspace(0.0, 2 * np.pi, 33)
    points = 8e-3 * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    lines = np.stack([points[:-1], points[1:]], axis=1)
    surface = SimpleNamespace(spacing=1e-3, inside=np.ones((4, 4), bool))
    every = np.ones(len(lines), bool)
    monkeypatch.setattr(edges, "section_lines", lambda *_: [lines])
    monkeypatch.setattr(edges, "drawn_surface", lambda _: SimpleNamespace(land=~surface.inside))
    monkeypatch.setattr(edges, "_beside", lambda *_: (every, ~every, every))
    none = cast(Any, None)
    made = edges.lug_lines(none, none, none, cast(Any, surface), 1e-3)
    assert len(made) == len(lines)
    assert np.linalg.norm(made, axis=2) == pytest.approx(8e-3, abs=1e-7)


@pytest.mark.parametrize(
    ("edge", "rise"),
    [
        ({"edge_radius": 1e-3}, 1e-3 * (1 - np.sqrt(1 - np.array([0, 0, 0.5, 1.0]) ** 2))),
        ({"edge_chamfer": 1e-3}, 1e-3 * np.array([0, 0, 0.5, 1.0])),
        ({}, np.zeros(4)),
    ],
    ids=["rounded", "chamfered", "sharp"],
)
def test_the_land_rises_towards_the_edge_of_its_lug_alone(edge, rise):
    """Places 5, 1, 1/2 and 0 mm within a lug and one in the channel, 3 mm deep."""
    inside = 1e-3 * np.array([5.0, 1.0, 0.5, 0.0, -1.0])
    tread = SimpleNamespace(
        **{"edge_radius": 0.0, "edge_chamfer": 0.0} | edge,
        depth=3e-3,
        sipes=None,
        channel_distance=lambda x, y: -inside,
    )
    flat = np.full(5, 2e-4)
    heel = SimpleNamespace(
        tread=tread, arc_channel=None, unworn_height=lambda *_: flat, land_height=lambda *_: flat
    )
    height, land, lug = cut_heel(cast(Any, heel), flat, flat)
    np.testing.assert_allclose(height, 2e-4 + np.append(rise, 3e-3))
    assert land.tolist() == [True] * 4 + [False]
    np.testing.assert_allclose(lug, 3e-3)


def test_a_channel_has_its_width_and_what_is_none_has_no_width():
    region = np.zeros((20, 12), bool)
    region[4:7] = True
    region[10:15] = True
    width = channel_width(region, 0.5e-3)
    expected = np.zeros(20)
    expected[4:7], expected[10:15] = 1.5e-3, 2.5e-3
    np.testing.assert_allclose(width[:, 4:8], np.repeat(expected[:, None], 4, axis=1))
    assert not width[~region].any()


@pytest.mark.parametrize(
    ("end", "turned"),
    [
        ((40.0, 10.0), 0.0),  # the middle is half way wherever both go on alike
        ((0.0, 30.0), 0.0),
        ((40.0, 10.0), 1e-7),
        ((40.0, 10.0), 0.8),
        ((30.0, -5.0), -1.2),
    ],
)
def test_two_arcs_lead_from_one_direction_to_another_without_a_kink(end, turned):
    start, begin = np.array([0.0, 0.0]), np.array([1.0, 0.0])
    last = np.array([np.cos(turned), np.sin(turned)])
    arcs = biarc(start, begin, 1e-3 * np.array(end), last)
    ways = []
    for x0, y0, x1, y1, cx, cy, radius in arcs:
        for x, y in ((x0, y0), (x1, y1)):
            assert np.hypot(x - cx, y - cy) == pytest.approx(abs(radius))
            ways.append(np.array([cy - y, x - cx]) / radius)
    one, two = arcs
    np.testing.assert_allclose([*one[:2], *two[2:4]], [0, 0, *1e-3 * np.array(end)], atol=1e-12)
    np.testing.assert_allclose(one[2:4], two[:2], atol=1e-12)
    for way, expected in zip(ways, (begin, ways[2], ways[2], last), strict=True):
        np.testing.assert_allclose(way, expected, atol=1e-6)
    if turned == 0.0:
        np.testing.assert_allclose(one[2:4], 0.5e-3 * np.array(end))


def test_a_triangle_is_the_same_whichever_corner_comes_first():
    corners = np.array([[0, 0, 0], [3, 0.5, 1], [1, 2, -1]], np.float32)
    orders = list(permutations(range(3)))
    other = corners + np.array([0, 0, 1e-4], np.float32)
    soup = np.concatenate([[corners[list(order)] for order in orders], [other, other[::-1]]])
    np.testing.assert_array_equal(without_copies(soup), [soup[0], other])


def test_land_beside_a_channel_tells_the_land_across_it_not_along_a_diagonal():
    y = np.arange(20.0)
    height = np.broadcast_to(y**2, (16, 20)).copy()
    land = np.ones((16, 20), dtype=bool)
    land[6:10] = False  # a channel across the rise of its land
    across = across_channels(height, land)
    np.testing.assert_allclose(across[7, 3:-3], y[3:-3] ** 2)
    assert np.isnan(across_channels(height, land & (np.arange(16) < 8)[:, None])[12, 10])


def test_the_rim_of_a_height_map_belongs_to_it_and_nothing_beyond_does():
    x, y = 1e-3 * np.arange(5), 1e-3 * np.arange(-3, 4)
    surface = SimpleNamespace(x=x, y=y, spacing=1e-3, inside=np.ones((5, 7), dtype=bool))
    extent = _Extent(cast(Any, surface), np.zeros((5, 7)))
    for ends, along in ((x, True), (y, False)):
        for place, inward in (
            (ends[0], 1), (ends[-1], 1), (ends[0] - 1e-3, -1), (ends[-1] + 1e-3, -1),
        ):  # fmt: skip
            at = (place, 0.0) if along else (2e-3, place)
            assert extent.inward_distance(*map(np.array, at)) == inward


@pytest.mark.parametrize(
    ("feet", "left"), [(("left", "right"), 0), (("right", "left"), 1), ((None, None), None)]
)
def test_of_a_pair_the_shoe_of_the_side_asked_for_is_read(monkeypatch, feet, left):
    shoes = [SimpleNamespace(foot=foot) for foot in feet]
    pair = SimpleNamespace(meshes=[0, 1], remarks=[])
    monkeypatch.setattr(outsole, "soundness", lambda *_: None)
    monkeypatch.setattr(outsole, "check_surface", lambda *_: None)
    monkeypatch.setattr(outsole, "found_outsole", lambda *_: pair)
    monkeypatch.setattr(outsole, "_outsole", lambda mesh, *_: shoes[mesh])
    mesh = Mesh(np.zeros((1, 3, 3)), "STL")
    chosen = FileSettings(side="left")
    if left is None:
        with pytest.raises(DataError, match="not determined and not determined"):
            outsole.outsole_from_mesh(mesh, chosen)
    else:
        assert outsole.outsole_from_mesh(mesh, chosen) is shoes[left]
