"""Readers of soles at the edge between two answers: small files with their right value."""

import math

import numpy as np
import pytest

from underfoot.core import DataError, InputError
from underfoot.shoe import Heel, Tread
from underfoot.shoe._kernels.components import extents_of_bodies
from underfoot.shoe.files.ply import read_ply
from underfoot.shoe.files.stl import looks_like_stl, read_stl
from underfoot.shoe.parametric.solid import LEAST_PRINTABLE, check_printable

FACET = np.zeros((), np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("e", "<u2")]))


def stl(promised, whole, spare=b"", name=b"made by hand"):
    """Return a binary STL that promises faces, holds some, and has bytes behind them."""
    faces = np.repeat(FACET, whole)
    faces["corners"][:] = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    return name.ljust(80, b"\0") + promised.to_bytes(4, "little") + faces.tobytes() + spare


@pytest.mark.parametrize(
    ("content", "faces"),
    [
        (stl(3, 3), 3),
        (stl(3, 3, b"x" * 7), 3),
        (stl(3, 4), 3),
        (stl(3, 3, name=b"solid from a scanner"), 3),
        (stl(3, 3, b"x", name=b"solid from a scanner"), 3),
    ],
)
def test_a_binary_stl_has_the_faces_that_it_promises(tmp_path, content, faces):
    file = tmp_path / "sole.stl"
    file.write_bytes(content)
    assert looks_like_stl(content[:200], file)
    made = read_stl(file)
    (body,) = made.bodies
    assert body.vertices.shape == (3 * faces, 3)
    spare = len(content) - 84 - 50 * faces
    assert [str(spare) in line for line in made.remarks] == [True] * (spare > 0)


@pytest.mark.parametrize(("promised", "whole"), [(3, 2), (1, 0), (4_000_000_000, 2)])
def test_an_stl_cut_short_says_what_it_promises_and_holds(tmp_path, promised, whole):
    file = tmp_path / "sole.stl"
    file.write_bytes(stl(promised, whole, b"\1" * 49))
    with pytest.raises(DataError, match=f"promises {promised} faces and holds {whole}"):
        read_stl(file)


PLY = b"""ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 2 0
3 0 1 2
"""


@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r"])
def test_a_ply_has_the_same_corners_with_every_end_of_line(tmp_path, end):
    file = tmp_path / "sole.ply"
    file.write_bytes(PLY.replace(b"\n", end))
    (body,) = read_ply(file).bodies
    np.testing.assert_array_equal(body.vertices, [[0, 0, 0], [1, 0, 0], [0, 2, 0]])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b"format ascii 1.0", b"format"),
        (b"format ascii 1.0", b"format morse 1.0"),
        (b"property float x", b"property wide x"),
        (b"property float x", b"property float"),
        (b"end_header\n", b""),
        (b"element face 1", b"element face one"),
        (b"element face 1", b"element face"),
    ],
)
def test_a_heading_that_does_not_tell_how_to_read_on_is_refused(tmp_path, old, new):
    file = tmp_path / "sole.ply"
    file.write_bytes(PLY.replace(old, new))
    with pytest.raises(DataError):
        read_ply(file)


def test_extents_and_areas_of_bodies_are_along_the_axes_asked_for():
    """Two triangles of two bodies, a third body without any; axes turned about z by 90 degrees."""
    first = [[0, 0, 0], [4, 0, 0], [0, 3, 0]]
    second = [[1, 1, 1], [1, 1, 3], [1, 6, 1]]
    triangles = np.array([first, second, first], np.float32)
    axes = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    low, high, area = extents_of_bodies(triangles, np.array([0, 1, 0], np.int32), axes, 3)
    np.testing.assert_array_equal(low[:2], [[0, -4, 0], [1, -1, 1]])
    np.testing.assert_array_equal(high[:2], [[3, 0, 0], [6, -1, 3]])
    np.testing.assert_allclose(area, [12, 5, 0])
    assert (low[2] == math.inf).all()
    assert (high[2] == -math.inf).all()


def heel(thickness=10e-3, channel=4e-3, depth=4e-3):
    tread = Tread("transverse", 6e-3, channel, depth)
    return Heel(
        length=60e-3, width=60e-3, rear_radius=20e-3, outsole_thickness=thickness, tread=tread
    )


def test_what_can_be_printed_ends_at_the_least_width():
    check_printable(heel(channel=LEAST_PRINTABLE))
    with pytest.raises(InputError, match=r"a channel of .* can be neither printed nor moulded"):
        check_printable(heel(channel=0.99 * LEAST_PRINTABLE))


def test_a_tread_ends_within_the_outsole():
    check_printable(heel(depth=4e-3, thickness=4.01e-3))
    with pytest.raises(InputError, match="through the outsole"):
        check_printable(heel(depth=4e-3, thickness=4e-3))
