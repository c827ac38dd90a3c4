"""Meshes in a turned frame answer as in their own; floors that lie aslant are seen level."""

import math

import numpy as np
import pytest

import sole_forms as made
from underfoot.shoe._kernels.mesh_edges import overlap_lines
from underfoot.shoe.files.bodies import found_outsole
from underfoot.shoe.files.floor import _level_axes
from underfoot.shoe.files.mesh import Mesh
from underfoot.shoe.files.settings import FileSettings


def turn(about, angle):
    """The matrix of a turn about an axis of the frame."""
    cosine, sine = math.cos(angle), math.sin(angle)
    one, two = (n for n in range(3) if n != about)
    matrix = np.eye(3)
    matrix[[one, one, two, two], [one, two, one, two]] = cosine, -sine, sine, cosine
    return matrix


TURNS = {
    "about x": turn(0, 0.7), "about y": turn(1, 0.7), "about z": turn(2, 0.7),
    "about all": turn(0, 0.4) @ turn(1, -0.6) @ turn(2, 1.1),
}  # fmt: skip


def sheet(height, up=True, side=4.0):
    corners = np.array([(0, 0), (side, 0), (side, side), (0, side)])
    points = np.column_stack([corners, np.full(4, height)])
    faces = points[[[0, 1, 2], [0, 2, 3]]]
    return faces if up else faces[:, ::-1]


def box(low, high):
    return made.triangles(
        [made.prism(np.array([(0, 0), (4, 0), (4, 4), (0, 4)], float), low, high)]
    )


APART = 0.1
FORMS = {
    "a box": box(0.0, 1.0),
    "boxes that overlap": np.concatenate([box(0.0, 1.0), box(0.5, 2.0)]),
    "a double face": np.concatenate([sheet(0.0), sheet(APART, up=False)]),
    "a face is missing": np.concatenate([box(0.0, 1.0), sheet(2.0)]),
    "one face": sheet(0.5),
}


@pytest.mark.parametrize("way", TURNS)
@pytest.mark.parametrize("form", FORMS)
def test_lines_through_a_mesh_meet_the_same_in_any_frame(form, way):
    corners, frame = FORMS[form], TURNS[way]
    body = np.zeros(len(corners), np.int32)
    for near in (0.5 * APART, 0.9 * APART, 1.1 * APART, 0.6):
        grid = ((0.13, 0.27), 0.5, (8, 8), near)
        here = overlap_lines(corners.astype("f8"), body, np.eye(3), *grid)
        # the rows of a frame are its axes: what is turned into it lies as before
        assert overlap_lines(corners @ frame, body, frame, *grid) == here
        assert here[4] > 0
    double = [overlap_lines(FORMS["a double face"].astype("f8"), np.zeros(4, np.int32), np.eye(3),
                            (0.13, 0.27), 0.5, (8, 8), near)[1] > 0
              for near in (0.9 * APART, 1.1 * APART)]  # fmt: skip
    assert double == [False, True]


@pytest.mark.parametrize("tilt", [0.05, -0.03])
def test_a_floor_that_lies_aslant_beside_walls_is_seen_level(tilt):
    """Most of what is nearly level counts, whatever stands upright beside it."""
    ring = np.array([(0, 0), (280, 0), (280, 100), (0, 100)], float)
    body = made.triangles([made.prism(ring, 0.0, 9.0)]) @ turn(1, tilt).T
    axes = _level_axes(body.astype(np.float32))
    up = turn(1, tilt) @ [0.0, 0.0, 1.0]
    assert abs(axes[2] @ up) == pytest.approx(1.0, abs=1e-6)
    assert abs(axes[2] @ [0.0, 0.0, 1.0]) < 1.0 - 1e-4


@pytest.mark.parametrize(("parts", "down"), [
    ([(30.0, 60.0)], -1.0), ([(30.0, 40.0), (30.0, 60.0)], -1.0),
    ([(-60.0, -30.0)], 1.0), ([(-60.0, -30.0), (-40.0, -30.0)], 1.0),
    ([(-40.0, 60.0), (-40.0, -30.0)], 0.0), ([(-40.0, 60.0), (30.0, 45.0)], 0.0),
])  # fmt: skip
def test_the_ground_is_away_from_all_other_parts_together(parts, down):
    """Other parts of a shoe above, below, and around an outsole of 9 mm."""
    ring = np.array([(0, -50), (280, -50), (280, 50), (0, 50)], float)
    bodies = {"Outsole": (0.0, 9.0), **{f"Upper {n}": part for n, part in enumerate(parts)}}
    soups = [made.triangles([made.prism(ring, *ends)]).astype("f4") for ends in bodies.values()]
    number = np.repeat(np.arange(len(soups), dtype=np.int32), [len(one) for one in soups])
    mesh = Mesh(np.concatenate(soups), "made here", 1e-3, (), tuple(bodies), number)
    found = found_outsole(mesh, FileSettings(spacing=1e-3), "a.obj")
    if down:
        assert np.asarray(found.down) == pytest.approx([0.0, 0.0, down], abs=1e-6)
    else:
        assert found.down is None
