"""Regions of masks, discs in them, edges and bodies of triangles, height buffers, XML numbers."""

import math

import numpy as np
import pytest

from snapshot import held
from underfoot.shoe._kernels.arcs import arc, biarc, inward_distance, points_on
from underfoot.shoe._kernels.components import closed_bodies, components, extents_of_bodies
from underfoot.shoe._kernels.covering_discs import channel_width, covering_value, local_width
from underfoot.shoe._kernels.elements import element_numbers
from underfoot.shoe._kernels.height_buffer import extents, height_buffer, tilted_rows
from underfoot.shoe._kernels.mesh_edges import hash_key, overlap_lines, shared_edges, soup_keys
from underfoot.shoe._kernels.regions import (
    across_channels,
    between_land,
    carried_on,
    distance_to,
    distance_within,
    draining,
    grow_mask,
    nearest_true,
    pieces,
    rim,
    shrunk,
    without_holes,
    without_specks,
)
from underfoot.shoe._kernels.rolling import rolled_base

X, Y = np.meshgrid(np.arange(23.0), np.arange(19.0), indexing="ij")
MASK = (np.hypot(X - 8.3, Y - 7.6) < 7) & (np.hypot(X - 7, Y - 9) > 2.2) & (Y != 5)
MASK[18:22, 12:16] = MASK[17, 2] = MASK[18, 3] = MASK[22, 0] = True
NAMED = {
    "empty": np.zeros((5, 4), bool),
    "full": np.ones((5, 4), bool),
    "one": np.eye(6, 5, dtype=bool),
    "lugs": MASK,
}


@pytest.mark.parametrize("name", NAMED)
def test_regions(file_regression, name):
    mask = NAMED[name]
    i, j = (part[: mask.shape[0], : mask.shape[1]] for part in (X, Y))
    height = 0.3 * i + 0.01 * (j - 7) ** 2 + np.where(mask, 0.0, 5.0)
    answers = {
        "pieces": pieces(mask), "diagonal": pieces(mask, diagonal=True),
        "grown": (grow_mask(mask, 1), grow_mask(mask, 3)),
        "shrunk": (shrunk(mask, 1), shrunk(mask, 2)),
        "holes": without_holes(mask), "rim": (rim(mask), rim(mask, 2)),
        "specks": [without_specks(mask, n) for n in (1, 2, 17)],
        "within": distance_within(mask), "draining": draining(mask | (j > 5), ~mask & (j > 5)),
        "width": (local_width(mask, 2.0), channel_width(mask, 2.0)),
        "value": covering_value(mask, np.where(mask, height, 0.0)),
    }  # fmt: skip
    if mask.any():
        answers |= {
            "to": distance_to(mask), "nearest": nearest_true(mask),
            "carried": carried_on(height, mask), "across": across_channels(height, mask),
            "between": between_land(height, mask),
        }  # fmt: skip
    held(file_regression, answers, f"regions {name}")


def test_a_paraboloid_under_heights(file_regression):
    height = 1e-3 * (0.2 * np.cos(X / 2) + 0.002 * (Y - 9) ** 2) + np.where(MASK, 0.0, 3e-3)
    height[np.hypot(X - 11, Y - 9) > 11.2] = np.nan
    base = rolled_base(height, 1e-3, 0.5, (0.5, 0.3))
    good = np.isfinite(height)
    assert (base[good] <= height[good] + 1e-12).all()
    nowhere = height.copy()
    nowhere[:, 3] = nowhere[5] = np.nan
    held(
        file_regression,
        {
            "base": base,
            "steep": rolled_base(height, 1e-3, 0.02, (3.0, 0.1)),
            "with rows of nothing": rolled_base(nowhere, 2e-3, 0.1, (0.1, 0.3)),
            "row": base[8, 2:14],
        },
    )


def _box(low, high):
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    points = np.array(low) + corners * (np.array(high) - low)
    return np.ascontiguousarray(points[faces], dtype=np.float32)


ONE, OTHER = _box((0.3, 0.2, 0), (9.6, 5.3, 2.5)), _box((3.2, 1.1, 1.5), (7.4, 4.6, 4))
BESIDE = _box((9.6, 0.2, 0), (12.1, 5.3, 2.5))
SOUPS = {
    "a box": ONE,
    "two that cross": np.concatenate([ONE, OTHER]),
    "two that touch": np.concatenate([ONE, BESIDE]),
    "open": ONE[2:],
    "turned over": np.concatenate([ONE[:3], ONE[3:4, ::-1], ONE[4:]]),
    "twice": np.concatenate([ONE, ONE[[3, 5]], ONE[7:8, [1, 2, 0]]]),
    "damaged": np.concatenate([ONE, ONE[:1, [0, 0, 1]], np.full((2, 3, 3), np.nan, "f4")]),
    "none": ONE[:0],
    "inward": np.ascontiguousarray(ONE[:, ::-1]),
}


@pytest.mark.parametrize("name", SOUPS)
def test_triangles(file_regression, name):
    soup = np.ascontiguousarray(SOUPS[name])
    turn = math.cos(0.3), math.sin(0.3)
    axes = np.array([[turn[0], 0, turn[1]], [0, 1, 0], [-turn[1], 0, turn[0]]])
    edges, faces, counts, volume = soup_keys(soup, (soup + np.float32(0)).view(np.uint32))
    edges.sort()
    body, count = components(soup)
    answers = {
        "counts": counts, "volume": volume, "shared": shared_edges(edges),
        "same faces": len(np.unique(faces)), "bodies": (body, count),
        "closed": closed_bodies(soup),
        "extents of bodies": extents_of_bodies(soup, body, axes, count + 1),
        "view": height_buffer(soup, axes, (-0.4, 0.3), 0.7, (17, 9)),
        "straight": height_buffer(soup, np.eye(3), (0.05, 0.15), 0.5, (27, 12)),
        "lines": [
            overlap_lines(soup, own, frame, (0.19, 0.27), 0.53, (27, 11), 1e-3)
            for own in (body, np.zeros(len(soup), np.int32)) for frame in (np.eye(3), axes)
        ],
    }  # fmt: skip
    if soup.size:
        answers["extents"] = extents(soup, axes)
    held(file_regression, answers, f"soup {name}")


def test_the_hash_is_one_to_one_on_many():
    keys = np.arange(2000, dtype=np.uint64) * np.uint64(977)
    assert len({int(hash_key(key)) for key in keys}) == 2000


def test_rows_of_a_tilted_sole(file_regression):
    x, y = np.arange(0.0, 23.0), np.arange(0.0, 19.0)
    base = 0.02 * (X - 9) ** 2 + 0.01 * Y
    answers = {}
    for angle in (-0.2, 0.0, 0.35):
        places = (np.arange(-5.0, 28.0, 0.7), np.array([-1.0, 0.2, 4.5, 9.0, 18.2, 25.0]))
        answers[str(angle)] = tilted_rows(
            (x, y), base, MASK | (X < 20), places, math.cos(angle), math.sin(angle)
        )
    held(file_regression, answers)


def test_arcs(file_regression):
    start, end = np.array([0.0, 0.0]), np.array([3.0, 2.0])
    along, up = np.array([1.0, 0.0]), np.array([0.0, 1.0])
    rim_of_arcs = np.array(
        [
            [2.0, 0.0, 0.0, 2.0, 0.0, 0.0, 2.0],
            [0.0, 2.0, -2.0, 0.0, -2.0, 2.0, -2.0],
            [-2.0, 0.0, 2.0, 0.0, 0.0, 0.0, math.inf],
        ]
    )
    x, y = (X.ravel() - 11) / 4, (Y.ravel() - 8) / 4
    held(
        file_regression,
        {
            "biarc": biarc(start, along, end, up),
            "back": biarc(start, along, end, -along),
            "parallel": biarc(start, along, end, along),
            "straight": biarc(start, along, np.array([4.0, 0.0]), along),
            "arc": arc(start, up, end),
            "line": arc(start, along, np.array([2.0, 1e-7])),
            "nearly": arc(start, along, np.array([2.0, 1e-5])),
            "into": inward_distance(x, y, rim_of_arcs),
            "points": points_on(rim_of_arcs, 0.5),
            "few": points_on(rim_of_arcs, 10.0),
        },
    )
    many = np.linspace(-3, 3, 40_000)
    whole = inward_distance(many, 0.3 * many, rim_of_arcs)
    apart = [inward_distance(many[n::2], 0.3 * many[n::2], rim_of_arcs) for n in (0, 1)]
    np.testing.assert_allclose(whole[::2], apart[0])
    np.testing.assert_allclose(whole[1::2], apart[1])


TEXTS = {
    "plain": '<p a="1" b="-2.5" c="3e-2"/><p c="6" a="4" b="5"/>',
    "spaced": ' \n<p\ta = "1"  b=\'2\' c="+3." more="x" /> <p a="4" b=".5" c="6E+1"/>\n',
    "with ends": '<p a="1" b="2" c="3"></p>',
    "another tag": '<p a="1" b="2" c="3"/><q a="1" b="2" c="3"/>',
    "longer tag": '<pp a="1" b="2" c="3"/>',
    "missing": '<p a="1" b="2"/>',
    "no number": '<p a="1" b="x" c="3"/>',
    "no number within": '<p a="1" b="1e" c="3"/>',
    "empty number": '<p a="1" b="" c="3"/>',
    "sign alone": '<p a="1" b="-" c="3"/>',
    "comment": '<!-- <p a="1" b="2" c="3"/> -->',
    "cut short": '<p a="1" b="2" c="3"',
    "cut within": '<p a="1" b="2',
    "cut behind a name": '<p a',
    "long number": '<p a="12345678.87654321" b="0.000000000123" c="123456789012345678901"/>',
    "many": '<p a="1" b="2" c="3"/>' * 9,
    "nothing": "  ",
}  # fmt: skip


def test_numbers_of_elements(file_regression):
    answers = {}
    for name, text in TEXTS.items():
        out = np.zeros((12, 3))
        data = np.frombuffer(text.encode(), np.uint8)
        names = np.frombuffer(b"abc", np.uint8)
        state, count = element_numbers(data, np.frombuffer(b"p", np.uint8), names, 1, out)
        answers[name] = (state, count, out[:3])
    held(file_regression, answers)
