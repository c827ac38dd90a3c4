"""A tread moved under a sole that is known by its heights alone."""

import math
from dataclasses import replace

import numpy as np
import pytest

from underfoot.shoe import Facet, Flat, Heel, Tread, heel_surface
from underfoot.shoe.tread_shift import carried_base, moved_tread, tread_periods

MM = 1e-3
FURTHER = {"chevrons": {"arm_length": 12 * MM}, "blocks": {"lug_length": 9 * MM}}
FACET = Facet(math.radians(10), 30 * MM)


def heel(pattern="transverse", offset=0.0, profile=FACET, **further):
    tread = Tread(pattern, 6 * MM, 4 * MM, 3.5 * MM, offset=(offset, 0.0), **further)
    return Heel(
        length=60 * MM,
        width=66 * MM,
        rear_radius=28 * MM,
        outsole_thickness=25 * MM,
        edge_radius=2 * MM,
        profile=profile,
        tread=tread,
    )


def heights(shape):
    """The surface as a file gives it: without the base."""
    return replace(heel_surface(shape, spacing=0.25 * MM), base=None)


@pytest.mark.parametrize(
    ("pattern", "angle"),
    [
        ("transverse", 0.0),
        ("bars", 0.5),
        ("longitudinal", 0.0),
        ("grid", 0.3),
        ("hexagons", 0.0),
        ("blocks", 0.2),
        ("chevrons", 0.6),
    ],
)
def test_the_periods_of_a_tread_map_its_pattern_onto_itself(pattern, angle):
    shape = heel(pattern, profile=Flat(), angle=angle, **FURTHER.get(pattern, {}))
    assert shape.tread is not None
    found, true = tread_periods(heights(shape)), shape.tread.periods
    assert found.shape == true.shape
    x, y = np.meshgrid(np.arange(-20, 20) * MM, np.arange(-20, 20) * MM)
    into = shape.tread.channel_distance(x, y)
    for period in found:  # within a cell of the height map, across as along
        moved = shape.tread.channel_distance(x + period[0], y + period[1])
        assert np.abs(moved - into).max() < 0.25 * MM


def test_lugs_without_a_pattern_move_by_the_widths_of_lug_and_channel():
    surface = heights(heel(profile=Flat()))
    rng = np.random.default_rng(0)
    edges = np.cumsum(rng.uniform(2, 9, 40)) * MM
    channel = np.searchsorted(edges, surface.x) % 2 == 1
    land = surface.inside & ~channel[:, None]
    odd = replace(surface, land=land, height=np.where(land, 0.0, surface.height))
    periods = tread_periods(odd)
    assert periods.shape[1] == 2
    assert 4 * MM < np.hypot(*periods.T).min() < 50 * MM


@pytest.mark.parametrize("offset", [0.0, 2 * MM, 4 * MM, 6 * MM, 8 * MM])
def test_a_bevel_is_found_wherever_channels_hide_its_corner(offset):
    shape = heel(offset=offset)
    surface = heights(shape)
    x, y = np.meshgrid(surface.x, surface.y, indexing="ij")
    within = surface.inside & (shape.inward_distance(x, y) > 3 * MM)
    base, true = carried_base(surface)[within], shape.land_height(x, y)[within]
    assert np.abs(base - true).max() < 10e-6
    assert np.abs(surface.land_base[within] - true).max() > 80e-6  # a straight line cuts it off


def test_rounded_lug_edges_move_with_their_lugs():
    shape = heel(edge_radius=1 * MM, profile=Flat())
    surface = heights(shape)
    x, y = np.meshgrid(surface.x, surface.y, indexing="ij")
    moved = moved_tread(surface, (3 * MM, 0.0), tread_periods(surface))
    there = heights(heel(offset=3 * MM, edge_radius=1 * MM, profile=Flat()))
    inner = (shape.inward_distance(x, y) > 3 * MM) & (np.abs(x - 32 * MM) < 18 * MM)
    same = moved.land == there.land
    assert np.mean(same[surface.inside]) > 0.999
    off = np.abs(moved.height - there.height)[inner & same]
    assert np.percentile(off, 99) < 30e-6  # what a floor reaches counts as flat


@pytest.mark.parametrize("shift", [(3 * MM, 0.0), (-4.5 * MM, 0.0), (7.25 * MM, 0.0)])
def test_a_moved_tread_is_the_tread_drawn_there(shift):
    shape = heel(offset=1 * MM)
    surface = heights(shape)
    moved = moved_tread(surface, shift, tread_periods(surface))
    there = heel_surface(heel(offset=1 * MM + shift[0]), spacing=0.25 * MM)
    inside = surface.inside
    assert np.array_equal(moved.inside, inside)
    assert np.mean(moved.land[inside] != there.land[inside]) < 1e-3
    x, y = np.meshgrid(surface.x, surface.y, indexing="ij")
    land = moved.land & there.land & (shape.inward_distance(x, y) > 3 * MM)
    assert np.abs(moved.height - there.height)[land].max() < 10e-6
    assert moved.tread_depth[land] == pytest.approx(3.5 * MM, abs=0.1 * MM)


def test_a_sole_without_a_tread_moves_by_its_own_width():
    shifts = tread_periods(heights(replace(heel(profile=Flat()), tread=None)))
    assert shifts.shape == (2, 2)
    assert np.isfinite(shifts).all()
    assert shifts[0, 0] == shifts[1, 1] > 0
