"""Tread patterns, sipes and outlines against brute force and closed forms."""

import math

import numpy as np
import pytest
from scipy.ndimage import distance_transform_edt

from underfoot.core import InputError
from underfoot.shoe import Facet, Heel, Sipes, Tread, heel_map, heel_surface
from underfoot.shoe.parametric import ShoeOutline, ToeSpring, WholeSole
from underfoot.shoe.tread import Groove

KINDS = {
    "blocks": {"lug_length": 7e-3},
    "bars": {"angle": 0.4},
    "chevrons": {"arm_length": 9e-3, "angle": 0.6},
    "circles": {},
    "hexagons": {"angle": 0.2},
    "waves": {"wave_length": 20e-3, "wave_height": 6e-3, "angle": 0.3},
    "rings": {"ring_width": 1.5e-3},
    "graded_circles": {"front_lug_width": 3e-3, "graded_length": 20e-3},
}
SPACING = 5e-5


@pytest.mark.parametrize("pattern", KINDS)
def test_distance_is_that_to_the_nearest_wall(pattern):
    tread = Tread(pattern, 5e-3, 2e-3, 2e-3, **KINDS[pattern])
    line = np.arange(-15e-3, 15e-3, SPACING)
    x, y = np.meshgrid(line, line, indexing="ij")
    found = tread.channel_distance(x, y)
    brute = np.where(
        found > 0, distance_transform_edt(found > 0), -distance_transform_edt(found <= 0)
    )
    middle = (np.abs(x) < 1e-2) & (np.abs(y) < 1e-2)
    assert np.abs(found - brute * SPACING)[middle].max() < 1.5 * SPACING
    if pattern == "graded_circles":
        return  # its share is a mean over its length: below
    # 15 periods or more: the share of land is that of an endless tread but for the border
    assert (found <= 0).mean() == pytest.approx(tread.land_ratio, abs=0.04)


@pytest.mark.parametrize("pattern", KINDS)
def test_distance_beside_grooves_is_that_to_the_nearest_wall(pattern):
    grooves = (Groove((2e-3, 1e-3), 1.6e-3, 8e-3, 0.5), Groove((-5e-3, 0.0), 2e-3, angle=-0.2))
    tread = Tread(pattern, 5e-3, 2e-3, 2e-3, **KINDS[pattern], grooves=grooves)
    line = np.arange(-15e-3, 15e-3, SPACING)
    x, y = np.meshgrid(line, line, indexing="ij")
    found = tread.channel_distance(x, y)
    middle = (np.abs(x) < 1e-2) & (np.abs(y) < 1e-2) & (found <= 0)
    brute = -distance_transform_edt(found <= 0)[middle] * SPACING
    assert np.abs(found[middle] - brute).max() < 1.5 * SPACING


def test_a_groove_takes_its_area_and_the_tread_s_depth_at_any_angle():
    kind = {"length": 0.06, "width": 0.06, "rear_radius": 0.028, "outsole_thickness": 0.02}
    plain = Heel(**kind, tread=Tread("bars", 24e-3, 3e-3, 2e-3))
    for angle in (0.0, 0.4, math.pi / 2):
        groove = Groove((39e-3, 4e-3), 2e-3, 12e-3, angle)  # within the second bar
        cut = Heel(**kind, tread=Tread("bars", 24e-3, 3e-3, 2e-3, grooves=(groove,)))
        for spacing in (1e-3, 0.6e-3, 0.25e-3):
            maps = [heel_map(each, shoe_angle=0.0, spacing=spacing) for each in (plain, cut)]
            lost = maps[0].land_area - maps[1].land_area
            assert lost == pytest.approx(24e-6, rel=0.04 if spacing > 0.5e-3 else 5e-3)
        before, after = (heel_surface(each, spacing=2e-4) for each in (plain, cut))
        assert np.allclose(after.height[before.land & ~after.land], 2e-3)


def test_grooves_move_with_the_lugs_that_they_part():
    tread = Tread("hexagons", 6e-3, 2e-3, 2e-3, grooves=(Groove((3e-3, 0.0), 1e-3, 7e-3, 0.3),))
    x, y = np.meshgrid(np.linspace(-0.02, 0.02, 81), np.linspace(-0.02, 0.02, 81))
    moved = tread.shift_grooves((2e-3, -3e-3)).channel_distance(x + 2e-3, y - 3e-3)
    assert moved == pytest.approx(tread.channel_distance(x, y), abs=1e-12)


@pytest.mark.parametrize("pattern", KINDS)
def test_largest_depth_of_a_lug_is_half_its_width(pattern):
    tread = Tread(pattern, 5e-3, 2e-3, 2e-3, **KINDS[pattern])
    line = np.arange(0, 40e-3, SPACING)
    x, y = np.meshgrid(line, line, indexing="ij")
    deepest = -tread.channel_distance(x, y).min()
    half = 0.75e-3 if pattern == "rings" else 2.5e-3
    if pattern == "waves":  # its lugs are measured along the shoe, narrower across the flanks
        assert 0.7 * half < deepest < 1.2 * half
        return
    # only in the bend of a chevron a lug is wider than across its arms
    assert deepest >= half - SPACING
    if pattern != "chevrons":
        assert deepest <= half + 1e-9


@pytest.mark.parametrize(
    "tread",
    [
        Tread("waves", 5e-3, 2e-3, 2e-3, wave_length=20e-3, wave_height=6e-3),
        Tread("rings", 10e-3, 3e-3, 2e-3, ring_width=2e-3),
        Tread("chevrons", 5e-3, 2e-3, 2e-3, arm_length=9e-3, angle=0.6),
    ],
    ids=lambda tread: tread.pattern,
)
def test_land_over_one_period_is_the_analytic_share(tread):
    first, second = tread.periods
    # midpoints of a fine grid over the cell that both periods span
    share = (np.arange(600) + 0.5) / 600
    a, b = np.meshgrid(share, share, indexing="ij")
    x, y = (a * first[k] + b * second[k] for k in (0, 1))
    land = float((tread.channel_distance(x, y) <= 0).mean())
    assert land == pytest.approx(tread.land_ratio, abs=2e-3)


def test_land_of_graded_lugs_is_the_mean_over_their_length():
    length = 140e-3  # 20 rows
    tread = Tread("graded_circles", 6e-3, 1e-3, 2e-3, front_lug_width=3e-3, graded_length=length)
    x = 3e-3 + (np.arange(2800) + 0.5) / 2800 * length
    y = (np.arange(500) + 0.5) / 500 * tread.periods[0, 1]
    land = (tread.channel_distance(*np.meshgrid(x, y, indexing="ij")) <= 0).mean()
    assert land == pytest.approx(tread.land_ratio, abs=3e-3)
    rear, front = (tread.channel_distance(*np.meshgrid(x[k], y)).min() for k in (0, -1))
    assert rear == pytest.approx(-3e-3, rel=0.02)
    assert front == pytest.approx(-1.5e-3, rel=0.02)


def test_existing_patterns_turned_by_a_right_angle_are_each_other():
    x, y = np.meshgrid(np.linspace(0, 0.05, 101), np.linspace(-0.03, 0.03, 91), indexing="ij")
    along = Tread("longitudinal", 5e-3, 2.4e-3, 2e-3)
    bars = Tread("bars", 5e-3, 2.4e-3, 2e-3, angle=math.pi / 2, offset=(0.0, -2.5e-3))
    assert np.allclose(along.channel_distance(x, y), bars.channel_distance(x, y), atol=1e-9)


def test_sipes_cut_their_share_and_no_deeper():
    sipes = Sipes(1.2e-3, 1e-3, 6e-3, angle=0.3)
    kind = {"length": 0.06, "width": 0.06, "rear_radius": 0.028, "outsole_thickness": 0.02}
    plain = Heel(**kind, tread=Tread("bars", 9e-3, 3e-3, 2e-3))
    slit = Heel(**kind, tread=Tread("bars", 9e-3, 3e-3, 2e-3, sipes=sipes))
    before = heel_surface(plain, spacing=2e-4)
    after = heel_surface(slit, spacing=2e-4)
    assert after.land_area / before.land_area == pytest.approx(1 - 1.2 / 6, rel=0.02)
    cut = before.land & ~after.land
    assert np.allclose(after.height[cut], 1e-3)


def test_sipes_below_two_cells_are_slits_in_the_land():
    kind = {"length": 0.06, "width": 0.06, "rear_radius": 0.028, "outsole_thickness": 0.02}
    slit = Heel(**kind, tread=Tread("bars", 9e-3, 3e-3, 2e-3, sipes=Sipes(0.5e-3, 1e-3, 4e-3)))
    plain = Heel(**kind, tread=Tread("bars", 9e-3, 3e-3, 2e-3))
    found = heel_map(slit, shoe_angle=0.1, spacing=6e-4)
    assert found.slits is not None
    assert heel_map(slit, shoe_angle=0.1, spacing=2.5e-4).slits is None
    assert np.array_equal(found.land, heel_map(plain, shoe_angle=0.1, spacing=6e-4).land)


@pytest.mark.parametrize("side", ["left", "right"])
def test_outline_distance_against_a_fine_polygon(side):
    from shapely.geometry import Point, Polygon

    from underfoot.shoe._kernels.arcs import points_on

    sole = WholeSole(ShoeOutline(0.29, 0.068, 0.058, 0.1, side), 0.012)
    polygon = Polygon(points_on(sole.rim_arcs(), 2e-5))
    places = np.random.default_rng(1).uniform([-0.02, -0.07], [0.31, 0.07], (150, 2))
    exact = [
        math.copysign(polygon.exterior.distance(Point(p)), 1 if polygon.contains(Point(p)) else -1)
        for p in places
    ]
    assert np.abs(sole.inward_distance(*places.T) - exact).max() < 1e-8
    assert sole.plan_area == pytest.approx(polygon.area, rel=1e-6)


def test_outline_distance_is_the_same_in_blocks():
    """Far-off arcs are left out of a block; none of them is the nearest of any of its points."""
    from underfoot.shoe._kernels.arcs import BLOCK

    sole = WholeSole(ShoeOutline(0.29, 0.068, 0.058, 0.1, "right"), 0.012)
    x, y = np.meshgrid(np.linspace(-0.02, 0.31, 401), np.linspace(-0.07, 0.06, 301))
    whole = sole.inward_distance(x, y)
    assert x.size > 3 * BLOCK
    rows = [sole.inward_distance(*row) for row in zip(x, y, strict=True)]
    assert np.array_equal(whole, rows)


def test_left_and_right_are_mirror_images():
    left, right = (
        WholeSole(ShoeOutline(0.29, 0.068, 0.058, 0.1, side), 0.012) for side in ("left", "right")
    )
    places = np.random.default_rng(2).uniform([0, -0.05], [0.29, 0.05], (200, 2))
    mirrored = right.inward_distance(places[:, 0], -places[:, 1])
    assert np.allclose(left.inward_distance(*places.T), mirrored, atol=1e-12)
    # the tip of a right shoe lies towards its medial side, on the left
    assert right.inward_distance(np.array([0.28]), np.array([0.012]))[0] > 0
    assert right.inward_distance(np.array([0.28]), np.array([-0.03]))[0] < 0


def test_whole_sole_reaches_the_solver():
    sole = WholeSole(
        ShoeOutline(0.29, 0.068, 0.058, 0.1),
        0.012,
        Facet(math.radians(10), 0.03),
        ToeSpring(0.012, 0.2, 0.29),
        edge_radius=2e-3,
        tread=Tread("hexagons", 8e-3, 3e-3, 3e-3),
    )
    found = heel_map(sole, shoe_angle=math.radians(10), spacing=1e-3)
    assert found.plan_area == pytest.approx(sole.plan_area * math.cos(math.radians(10)), rel=0.02)
    assert found.land_ratio == pytest.approx((8 / 11) ** 2, abs=0.04)
    flat = heel_surface(sole, spacing=1e-3)
    at_tip = flat.height[-3, np.isfinite(flat.height[-3])].min()
    assert 0.008 < at_tip < 0.012 + 3e-3 + 2e-3


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ({"pattern": "hexagon"}, "hexagons"),
        ({"pattern": "blocks"}, "lug_length"),
        ({"pattern": "grid", "lug_length": 5e-3}, "not used"),
        ({"pattern": "chevrons", "arm_length": 9e-3, "angle": 1.5}, "75 deg"),
        ({"pattern": "grid", "sipes": Sipes(5e-4, 3e-3, 4e-3)}, "deeper than the tread"),
    ],
)
def test_refused_treads(kind, words):
    with pytest.raises(InputError, match=words):
        Tread(**{"lug_width": 5e-3, "channel_width": 2e-3, "depth": 2e-3, **kind})
