"""Wear: what is removed against closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.shoe import Facet, Flat, Heel, Sipes, Tread, WearPlane, heel_map
from underfoot.shoe.grids import cut_heel
from underfoot.shoe.worn import (
    WalkingWear,
    WornMap,
    WornPatch,
    archard_wear,
    walking,
    wear_measures,
)
from underfoot.shoe.worn.archard import pressure_on_sole

HEEL = Heel(
    length=0.06,
    width=0.06,
    rear_radius=0.028,
    outsole_thickness=0.025,
    profile=Facet(math.radians(10), 0.03),
    tread=Tread("hexagons", 6e-3, 2.4e-3, 2e-3),
)


def uniform(pressure, spacing=1e-3):
    def contact(shape, angle):
        sole = heel_map(shape, shoe_angle=angle, spacing=spacing)
        return sole, np.where(sole.land, pressure, 0.0)

    return contact


def test_even_pressure_wears_evenly_and_takes_k_p_s():
    found = archard_wear(
        HEEL,
        angles=[math.radians(10)],
        depth=1e-3,
        contact=uniform(2e5),
        wear_rate=1e-12,
        spacing=1e-3,
    )
    assert found.worn.depth == pytest.approx(1e-3, rel=1e-6)
    assert found.sliding_distance == pytest.approx(1e-3 / (1e-12 * 2e5), rel=1e-6)
    inside = HEEL.inward_distance(*np.meshgrid(found.worn.x, found.worn.y, indexing="ij")) > 2e-3
    assert np.allclose(found.worn.removed[inside], 1e-3, rtol=1e-6)


def test_removed_volume_is_wear_rate_times_load_times_way():
    def rear_only(shape, angle):
        sole = heel_map(shape, shoe_angle=angle, spacing=1e-3)
        across = np.exp(-(sole.y[None, :] ** 2) / (2 * 0.012**2))
        along = np.exp(-((sole.x[:, None] - 0.02) ** 2) / (2 * 0.008**2))
        return sole, np.where(sole.land, 3e5 * across * along, 0.0)

    sole, pressure = rear_only(HEEL, math.radians(10))
    load = pressure.sum() * sole.spacing**2
    found = archard_wear(
        HEEL,
        angles=[math.radians(10)],
        depth=0.2e-3,
        contact=rear_only,
        wear_rate=1e-12,
        spacing=1e-3,
    )
    volume = wear_measures(replace(HEEL, wear=found.worn)).removed_volume
    assert volume == pytest.approx(1e-12 * load * found.sliding_distance, rel=0.03)


def test_the_way_goes_with_the_wear_rate_and_the_shape_does_not():
    kind = {"angles": [0.1], "depth": 1e-3, "contact": uniform(1e5), "spacing": 2e-3}
    slow = archard_wear(HEEL, wear_rate=1e-13, **kind)
    fast = archard_wear(HEEL, wear_rate=1e-12, **kind)
    assert slow.sliding_distance == pytest.approx(10 * fast.sliding_distance)
    assert np.allclose(slow.worn.removed, fast.worn.removed)


def test_going_on_from_a_step_is_the_same_as_not_stopping():
    kind = {"angles": [0.1], "contact": uniform(1e5), "spacing": 2e-3, "wear_rate": 1e-12}
    half = archard_wear(HEEL, depth=0.5e-3, **kind)
    whole = archard_wear(HEEL, depth=1e-3, begin=half, **kind)
    assert whole.sliding_distance == pytest.approx(
        archard_wear(HEEL, depth=1e-3, **kind).sliding_distance
    )


def test_patch_of_given_area_is_found_again():
    patch = WornPatch(2e-3, 0.03, 0.024, position=0.03, taper=math.radians(20))
    found = wear_measures(replace(HEEL, wear=patch), spacing=2.5e-4)
    assert found.worn_patch_area == pytest.approx(patch.area, rel=0.01)
    assert found.worn_patch_length == pytest.approx(0.03, abs=5e-4)
    assert found.characteristic_length == pytest.approx(math.sqrt(0.03 * 0.024), rel=0.02)
    assert found.tread_left == 0.0
    assert found.removed_depth == pytest.approx(2e-3)


def test_rectangle_wears_nothing_beyond_its_taper():
    patch = WornPatch(1e-3, 0.02, 0.02, position=0.03, form="rectangle", taper=math.radians(45))
    new = np.zeros(3)
    worn = patch.worn_height(np.array([0.03, 0.0405, 0.0415]), np.zeros(3), new, HEEL)
    assert worn == pytest.approx([1e-3, 0.5e-3, 0.0], abs=1e-12)


def test_even_plane_removes_depth_times_land():
    flat = replace(HEEL, profile=Facet(0.0, 0.03), edge_radius=0.0)
    found = wear_measures(replace(flat, wear=WearPlane(0.5e-3)), spacing=2.5e-4)
    land = flat.plan_area * flat.tread.land_ratio
    assert found.removed_volume == pytest.approx(0.5e-3 * land, rel=0.03)
    assert found.tread_left == pytest.approx(1.5e-3)
    assert found.worn_patch_area == 0.0


def test_map_is_bilinear_between_its_nodes():
    worn = WornMap(np.array([0.0, 0.01]), np.array([0.0, 0.01]), np.array([[0, 0], [1e-3, 3e-3]]))
    assert worn.thickness(0.005, 0.005) == pytest.approx(1e-3)
    assert worn.depth == 3e-3


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ({"length": 0.07, "width": 0.02}, "larger than the shoe"),
        ({"length": 0.02, "width": 0.07}, "larger than the shoe"),
        ({"length": 0.02, "width": 0.02, "position": 0.08}, "beside the sole"),
    ],
)
def test_patches_that_do_not_fit(kind, words):
    with pytest.raises(InputError, match=words):
        WornPatch(2e-3, **kind).on(HEEL)


def test_wear_deeper_than_the_sole():
    with pytest.raises(InputError, match="goes through the outsole"):
        replace(HEEL, wear=WornPatch(0.03, 0.02, 0.02))


def test_walking_at_one_angle_alone_is_the_plane_of_that_angle(monkeypatch):
    monkeypatch.setattr(walking, "LANDING", ((math.radians(7), 1.0),))
    x = np.linspace(0.0, HEEL.length, 50)
    walked, ground = (
        HEEL.with_wear(wear).land_height(x, np.zeros(x.size))
        for wear in (WalkingWear(1.3e-3), WearPlane(1.3e-3, math.radians(7)))
    )
    assert np.allclose(walked, ground, atol=2e-6)


def test_walking_takes_at_each_angle_what_is_borne_there():
    x, height = np.linspace(0.0, 0.06, 601), np.zeros(601)
    width, volume = np.full(601, 0.05), 1e-6
    offsets, worn = walking._round(x, height, width, volume)
    assert (width * (worn - height)).sum() == pytest.approx(
        volume * sum(share for _, share in walking.LANDING), rel=1e-9
    )
    assert len(offsets) == len(walking.LANDING)


def test_a_worn_patch_below_the_measuring_cell_is_measured():
    depth = HEEL.tread.depth
    bulged = replace(HEEL, profile=Flat(), crown_radius=0.01, wear=WearPlane(depth + 5e-6))
    # gone from 10 um of tread on: a strip of half width sqrt(2 R (5 + 10) um)
    strip = 2 * math.sqrt(2 * 0.01 * 15e-6) * HEEL.length
    for spacing in (0.5e-3, 1e-3):
        found = wear_measures(bulged, spacing=spacing).worn_patch_area
        assert found == pytest.approx(strip, rel=0.5)


def peaked(shape, angle):
    sole = heel_map(shape, shoe_angle=angle, spacing=1e-3)
    return sole, np.where(sole.land, 2e5 * (1 + sole.x[:, None] / 0.06), 0.0)


def test_wear_ends_at_the_depth_asked_for_in_steps_of_the_size_asked_for():
    met = []

    def seen(shape, angle):
        met.append(angle)
        return uniform(2e5)(shape, angle)

    kind = {"wear_rate": 1e-12, "spacing": 2e-3, "angles": [0.1]}
    archard_wear(HEEL, depth=1e-3, contact=seen, step=0.25e-3, **kind)
    assert len(met) == 4
    found = archard_wear(HEEL, depth=0.3e-3, contact=peaked, **kind)
    assert found.worn.depth == pytest.approx(0.3e-3, rel=1e-6)


def test_the_same_angle_twice_is_that_angle_and_no_contact_is_refused():
    kind = {"depth": 0.5e-3, "wear_rate": 1e-12, "spacing": 2e-3}
    once, twice = (
        archard_wear(HEEL, contact=uniform(2e5), angles=[0.1] * n, **kind) for n in (1, 2)
    )
    assert twice.sliding_distance == pytest.approx(once.sliding_distance)
    with pytest.raises(InputError, match="nowhere touches"):
        archard_wear(HEEL, contact=uniform(0.0), angles=[0.1], **kind)


def test_pressure_is_read_where_a_node_of_the_tilted_sole_lies():
    """x' = x cos a - z sin a + origin: a pressure linear along the floor is met to 1 %."""
    tilt, bevel = 0.3, replace(HEEL, tread=None)
    sole = heel_map(bevel, shoe_angle=tilt, spacing=1e-3)
    pressure = np.where(sole.land, 1e5 * (1 + sole.x[:, None] / 0.06), 0.0)
    x, y = np.linspace(0.012, 0.045, 12), np.array([0.0])
    z, start = bevel.land_height(x, 0 * x), bevel.land_height(np.zeros(1), np.zeros(1))[0]
    assert np.ptp(z) > 1e-3
    lies = x * math.cos(tilt) - (z - start) * math.sin(tilt)
    found = pressure_on_sole(bevel, sole, pressure, tilt, x, y)[:, 0]
    assert found == pytest.approx(1e5 * (1 + lies / 0.06), rel=0.01)


def test_pressure_is_carried_across_a_wide_channel():
    wide = replace(HEEL, tread=Tread("transverse", 8e-3, 14e-3, 2e-3))
    sole = heel_map(wide, shoe_angle=0.1, spacing=1e-3)
    pressure = np.where(sole.land, 2e5, 0.0)
    x = np.linspace(0.01, 0.05, 41)
    assert pressure_on_sole(wide, sole, pressure, 0.1, x, np.array([0.0])) == pytest.approx(2e5)


def test_a_chamfer_that_wear_has_passed_is_gone():
    tread = Tread("transverse", 10e-3, 4e-3, 4e-3, edge_chamfer=1e-3)
    heel = Heel(length=0.06, width=0.06, rear_radius=0.01, outsole_thickness=0.02, tread=tread)
    worn = replace(heel, wear=WearPlane(2e-3))
    x, y = np.meshgrid(np.linspace(5e-3, 55e-3, 400), [0.0], indexing="ij")
    height, land, _ = cut_heel(worn, x, y)
    np.testing.assert_allclose(height[land], 2e-3, atol=1e-9)
    new, land, _ = cut_heel(heel, x, y)
    assert new[land].max() > 0.5e-3


def test_a_fine_sipe_loses_what_the_lugs_lose():
    tread = Tread("transverse", 10e-3, 4e-3, 4e-3, sipes=Sipes(0.4e-3, 3e-3, 5e-3))
    heel = Heel(length=0.06, width=0.06, rear_radius=0.01, outsole_thickness=0.02, tread=tread)
    depths = [
        heel_map(replace(heel, wear=wear), shoe_angle=0.0, spacing=1e-3).slits.depth.max()
        for wear in (None, WearPlane(2e-3))
    ]
    assert depths == pytest.approx([3e-3, 1e-3], abs=1e-6)
