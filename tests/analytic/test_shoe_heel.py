"""Parametric heel against closed forms."""

import math

import numpy as np
import pytest

from underfoot.shoe import ArcChannel, Facet, Flat, Heel, Rocker, Tread, WearPlane, heel_map

MM = 1e-3


def heel(**changes):
    """Plan form of the report's emulation (60 x 60 mm, rear radius 28 mm; assumed there)."""
    given = {
        "length": 60 * MM,
        "width": 60 * MM,
        "rear_radius": 28 * MM,
        "outsole_thickness": 10 * MM,
    }
    return Heel(**(given | changes))


def test_plan_area_of_a_rounded_rectangle():
    sole = heel_map(heel(front_radius=10 * MM), shoe_angle=0.0, spacing=0.125 * MM)
    corners = (1 - math.pi / 4) * 2 * (28**2 + 10**2)
    assert sole.plan_area == pytest.approx((3600 - corners) * MM**2, rel=2e-4)
    assert heel(front_radius=10 * MM).plan_area == pytest.approx((3600 - corners) * MM**2)
    assert sole.land_ratio == 1.0


@pytest.mark.parametrize(("pattern", "ratio"), [("grid", (2 / 3) ** 2), ("transverse", 2 / 3)])
def test_land_ratio_over_whole_pitches(pattern, ratio):
    """Lugs of 5 mm, channels of 2.5 mm: 60 mm hold exactly eight pitches."""
    tread = Tread(pattern, 5 * MM, 2.5 * MM, 3 * MM)
    sole = heel_map(heel(rear_radius=0.0, tread=tread), shoe_angle=0.0, spacing=0.5 * MM)
    assert tread.land_ratio == pytest.approx(ratio)
    assert sole.land_ratio == pytest.approx(
        ratio, rel=1e-9
    )  # the pattern keeps 1e-12 m off centres


def test_longitudinal_lug_is_centred():
    """Lugs centred on the centre line: 7 whole lugs and two of 2.5 mm at the sides of 60 mm."""
    tread = Tread("longitudinal", 5 * MM, 2.5 * MM, 3 * MM)
    sole = heel_map(heel(rear_radius=0.0, tread=tread), shoe_angle=0.0, spacing=0.5 * MM)
    assert sole.land_ratio == pytest.approx((7 * 5 + 2 * 2.5) / 60, rel=1e-12)
    middle = np.abs(sole.y) < 2.5 * MM
    assert sole.land[sole.inside.any(axis=1)][:, middle].all()


def test_flat_sole_is_a_wedge():
    angle = math.radians(10)
    sole = heel_map(heel(), shoe_angle=angle, spacing=0.5 * MM)
    where = np.nonzero(sole.inside)
    expected = sole.x[where[0]] * math.tan(angle)
    assert sole.clearance[where] == pytest.approx(expected - expected.min(), abs=1e-12)


def test_facet_at_its_angle_lies_flat_and_keeps_its_true_length():
    angle, length = math.radians(10), 30 * MM
    sole = heel_map(heel(profile=Facet(angle, length)), shoe_angle=angle, spacing=0.25 * MM)
    centre = sole.clearance[:, sole.y.size // 2]
    flat = centre < 1e-12
    assert flat.sum() * sole.spacing == pytest.approx(length / math.cos(angle), abs=0.25 * MM)
    assert np.all(
        flat[sole.x < length / math.cos(angle) - 0.25 * MM]
        | ~np.isfinite(centre[sole.x < length / math.cos(angle) - 0.25 * MM])
    )
    front = sole.x[np.isfinite(centre)] - length / math.cos(angle)
    assert centre[np.isfinite(centre)][front > 0] == pytest.approx(
        front[front > 0] * math.tan(angle), abs=1e-9
    )


def test_a_tilted_rocker_is_the_same_circle():
    """Rotating a circle leaves a circle: clearance R - sqrt(R^2 - s^2) about its lowest point."""
    radius, start, angle = 80 * MM, 25 * MM, math.radians(10)
    sole = heel_map(heel(profile=Rocker(radius, start)), shoe_angle=angle, spacing=0.25 * MM)
    centre = sole.clearance[:, sole.y.size // 2]
    rear_height = radius - math.sqrt(radius**2 - start**2)
    centre_of_circle = start * math.cos(angle) - radius * math.sin(angle)
    lowest = centre_of_circle + rear_height * math.sin(angle)  # rear end at x = 0
    on_circle = (sole.x > 0.5 * MM) & (sole.x < lowest + radius * math.sin(angle) - 0.5 * MM)
    s = sole.x[on_circle] - lowest
    expected = radius - np.sqrt(radius**2 - s**2)
    assert centre[on_circle] == pytest.approx(expected - expected.min(), abs=1e-9)


def test_crown():
    sole = heel_map(heel(crown_radius=300 * MM, rear_radius=0.0), shoe_angle=0.0, spacing=0.5 * MM)
    row = sole.clearance[sole.x.size // 2]
    inside = np.isfinite(row)
    expected = sole.y[inside] ** 2 / (2 * 300 * MM)
    assert row[inside] == pytest.approx(expected - expected.min(), abs=1e-12)


def test_edge_radius_is_a_quarter_circle():
    sole = heel_map(heel(edge_radius=2 * MM, rear_radius=0.0), shoe_angle=0.0, spacing=0.1 * MM)
    row = sole.clearance[sole.x.size // 2]
    into = 30 * MM - np.abs(sole.y)
    rim = (into > 0) & (into < 2 * MM)
    expected = 2 * MM - np.sqrt((2 * MM) ** 2 - (2 * MM - into[rim]) ** 2)
    assert row[rim] == pytest.approx(expected, abs=1e-9)


def test_wear_of_a_flat_sole_makes_a_facet():
    angle = math.radians(10)
    depth = 30 * MM * math.tan(angle)
    worn = heel(wear=WearPlane(depth, angle))
    faceted = heel(profile=Facet(angle, 30 * MM))
    maps = [heel_map(h, shoe_angle=angle, spacing=0.5 * MM) for h in (worn, faceted)]
    both = maps[0].inside & maps[1].inside
    assert np.array_equal(maps[0].inside, maps[1].inside)
    assert maps[0].clearance[both] == pytest.approx(maps[1].clearance[both], abs=1e-12)


def test_wear_removes_its_depth_at_most():
    """The deepest cut is the depth, also on a rounded sole (defining property of the cut)."""
    angle, depth = math.radians(12), 1.3 * MM
    new = heel(profile=Rocker(80 * MM, 25 * MM), edge_radius=2 * MM)
    worn = heel(profile=Rocker(80 * MM, 25 * MM), edge_radius=2 * MM, wear=WearPlane(depth, angle))
    x, y = np.meshgrid(np.linspace(0, 60 * MM, 2401), np.linspace(-30, 30, 31) * MM, indexing="ij")
    inside = new.inward_distance(x, y) > 0
    removed = (worn.land_height(x, y) - new.land_height(x, y))[inside]
    assert removed.min() == 0.0
    assert removed.max() == pytest.approx(depth, rel=1e-4)
    assert removed.max() <= depth


def test_even_wear_lowers_the_lugs():
    tread = Tread("grid", 5 * MM, 2.4 * MM, 3 * MM)
    new = heel_map(heel(tread=tread), shoe_angle=0.0, spacing=0.6 * MM)
    worn = heel_map(heel(tread=tread, wear=WearPlane(1 * MM)), shoe_angle=0.0, spacing=0.6 * MM)
    assert np.array_equal(new.land, worn.land)
    assert new.tread_depth[new.land] == pytest.approx(3 * MM)
    assert worn.tread_depth[worn.land] == pytest.approx(2 * MM)
    channel = new.inside & ~new.land
    assert worn.clearance[channel] == pytest.approx(2 * MM)


def test_wear_to_the_ground_of_the_channels_leaves_an_untreaded_sole():
    tread = Tread("grid", 5 * MM, 2.4 * MM, 3 * MM, edge_radius=0.5 * MM)
    worn = heel_map(heel(tread=tread, wear=WearPlane(3.5 * MM)), shoe_angle=0.0, spacing=0.6 * MM)
    assert np.array_equal(worn.land, worn.inside)
    assert worn.clearance[worn.inside] == pytest.approx(0.0, abs=1e-15)
    assert not worn.tread_depth.any()


def test_depth_zero_is_untreaded():
    bare = heel_map(heel(), shoe_angle=0.1, spacing=0.6 * MM)
    zero = heel_map(
        heel(tread=Tread("grid", 5 * MM, 2.4 * MM, 0.0)), shoe_angle=0.1, spacing=0.6 * MM
    )
    assert np.array_equal(bare.clearance, zero.clearance)
    assert np.array_equal(bare.land, zero.land)


def test_lugs_under_a_bevelled_rim_keep_their_depth():
    """Land and depth are decided before tilting: a rounded, tilted rim is no tread."""
    rounded = heel(profile=Rocker(80 * MM, 25 * MM), edge_radius=2 * MM, crown_radius=300 * MM)
    untreaded = heel_map(rounded, shoe_angle=0.17, spacing=0.6 * MM)
    assert np.array_equal(untreaded.land, untreaded.inside)
    assert not untreaded.tread_depth.any()


def test_channel_bottom_lies_at_its_depth():
    """A channel of depth d lies d cos(angle) over the land it cuts."""
    angle = math.radians(10)
    facet = Facet(angle, 30 * MM)
    tread = Tread("transverse", 5 * MM, 2.4 * MM, 3 * MM)
    sole = heel_map(heel(profile=facet, tread=tread), shoe_angle=angle, spacing=0.3 * MM)
    on_facet = sole.inside & (sole.x < 30 * MM)[:, None]
    assert sole.clearance[on_facet & sole.land] == pytest.approx(0.0, abs=1e-12)
    assert sole.clearance[on_facet & ~sole.land] == pytest.approx(3 * MM * math.cos(angle))


def test_arc_channel_area_and_place():
    """A half ring of mean radius r and width w covers pi r w."""
    arc = ArcChannel(position=12 * MM, radius=16 * MM, width=4 * MM, depth=1 * MM)
    sole = heel_map(heel(rear_radius=28 * MM, arc_channel=arc), shoe_angle=0.0, spacing=0.2 * MM)
    channel = sole.inside & ~sole.land
    assert channel.sum() * sole.spacing**2 == pytest.approx(math.pi * 16 * 4 * MM**2, rel=5e-3)
    assert not sole.tread_depth.any()
    centre = sole.x[channel[:, sole.y.size // 2]]
    assert centre.min() == pytest.approx(10 * MM, abs=0.2 * MM)
    assert centre.max() == pytest.approx(14 * MM, abs=0.2 * MM)


def test_outline_is_closed_and_encloses_the_plan_area():
    sole = heel_map(heel(front_radius=5 * MM), shoe_angle=0.0, spacing=0.5 * MM)
    x, y = sole.outline.T
    assert np.array_equal(sole.outline[0], sole.outline[-1])
    area = 0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])
    assert area == pytest.approx(heel(front_radius=5 * MM).plan_area, rel=1e-3)


def test_flat_profile_is_zero():
    assert not Flat().height(np.linspace(-1, 1, 5)).any()
