"""Polygons of a file are cut the same wherever they lie, and sides that cross are told."""

import numpy as np
import pytest

from underfoot.core import DataError
from underfoot.shoe.files.polygons import _convex, triangulate_polygons

ARROW = [(0, 0), (4, 0), (1, 1), (0, 4)]  # turns back at its third corner
WINDOW = [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0), (1, 1), (1, 3), (3, 3), (3, 1), (1, 1)]
BOW = [(0, 0), (4, 4), (4, 0), (0, 4)]


def cut(ring, shift, turn):
    plane = np.column_stack([np.array(ring, float), np.zeros(len(ring))]) + shift
    vertices = plane[:, turn]
    count = len(ring)
    return vertices, triangulate_polygons(vertices, [count], np.arange(count), "OBJ", "a.obj")


@pytest.mark.parametrize("turn", [(0, 1, 2), (2, 0, 1), (1, 2, 0)])
@pytest.mark.parametrize("shift", [(0, 0, 0), (1000, -700, 300)])
def test_hollow_and_framed_polygons_are_cut_inside_and_crossed_ones_told(shift, turn):
    for ring, area in ((ARROW, 4.0), (WINDOW, 12.0)):
        vertices, triangles = cut(ring, shift, turn)
        corners = vertices[triangles]
        areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
        assert np.abs(areas.sum(axis=0)).max() == pytest.approx(area)
        assert np.linalg.norm(areas, axis=1).sum() == pytest.approx(area)  # none lies outside
    with pytest.raises(DataError, match="cross"):
        cut(BOW, shift, turn)


@pytest.mark.parametrize("corners", [5, 7, 9, 11])
@pytest.mark.parametrize("turns", [2, 3])
def test_a_star_turns_alike_at_each_corner_and_is_not_convex(corners, turns):
    """{5/2}, {7/3}: twice or three times around; the polygon of the same corners once."""
    angle = 2 * np.pi * np.arange(corners) / corners
    for tilt in np.linspace(0.1, 1.5, 7):
        ring = np.column_stack((np.cos(angle), np.sin(angle) * np.cos(tilt), np.sin(angle)))
        star = ring[(turns * np.arange(corners)) % corners]
        assert _convex(np.stack((ring, star))).tolist() == [True, False]
