"""Steps of soles by their values: faces, lugs that take a fillet, ends, numbers, components."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.core import DataError, InputError
from underfoot.shoe._kernels.elements import _number
from underfoot.shoe.files.mesh import _check
from underfoot.shoe.files.threemf import _Object, _Package, _Volume
from underfoot.shoe.parametric import solid
from underfoot.shoe.parametric.sole import ShoeOutline
from underfoot.shoe.tread_measures import LUG_REACH, _without_ends


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
