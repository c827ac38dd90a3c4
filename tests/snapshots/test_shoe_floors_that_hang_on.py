"""Floors that hang together with a body: what of a plane goes and what stays."""

import itertools

import numpy as np
import pytest

import sole_forms as made
from underfoot.shoe.files.floor import without_floor
from underfoot.shoe.files.mesh import Mesh
from underfoot.shoe.files.settings import FileSettings

STEP = 20.0
CUT = FileSettings(spacing=1e-3, cut_floor=True)


def box(low, high):
    """A body over 80 by 40 mm, from one height to another."""
    ring = np.array([(0, -20), (80, -20), (80, 20), (0, 20)], float)
    return made.triangles([made.prism(ring, low, high)])


def floor(leave_out=False):
    """Two triangles a cell of 20 mm, -40 to 120 and -60 to 60 mm; without those under the body."""
    cells = []
    for x, y in itertools.product(np.arange(-40.0, 120.0, STEP), np.arange(-60.0, 60.0, STEP)):
        if leave_out and 0 <= x < 80 and -20 <= y < 20:
            continue
        a, b, c, d = (
            (x + i * STEP, y + j * STEP, 0.0) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))
        )
        cells += [(a, b, c), (a, c, d)]
    return np.array(cells)


def left_of(*parts):
    corners = np.concatenate(parts).astype(np.float32)
    left, down, told = without_floor(Mesh(corners, "made here", None), CUT)
    assert "was cut as floor" in " ".join(map(str, told))
    return left.triangles, down


@pytest.mark.parametrize("leave_out", [False, True])
def test_a_body_keeps_its_land_that_lies_in_the_floor(leave_out):
    """It stands on the floor with all its land: what reaches beyond it goes."""
    body = box(0.0, 12.0)
    left, down = left_of(body, floor(leave_out))
    low = left[:, :, 2].max(axis=1) < 1e-6
    assert np.count_nonzero(~low) == np.count_nonzero(body[:, :, 2].max(axis=1) > 1e-6)
    assert np.abs(left[low][:, :, 1]).max() <= 20.0
    assert left[low].mean(axis=1)[:, 0] == pytest.approx(
        np.clip(left[low].mean(axis=1)[:, 0], 0, 80)
    )
    assert down is None


def test_a_floor_goes_whole_where_the_body_reaches_through_it():
    """Its sides cross the plane, in which none of its land lies."""
    body = np.concatenate([box(-6.0, 0.0), box(0.0, 12.0)])
    body = body[np.abs(body[:, :, 2]).max(axis=1) > 1e-6]  # the sides meet at the floor
    left, down = left_of(body, floor(leave_out=True))
    assert len(left) == len(body)
    assert np.abs(left[:, :, 2]).max(axis=1).min() > 1e-6
    assert down is None
