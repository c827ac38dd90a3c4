"""Sole geometry and sensor refuse what can't be, and say why."""

import math

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.shoe import ArcChannel, Facet, Heel, Rocker, SoleMap, Tread, WearPlane, heel_map
from underfoot.sole_contact import floor_sensor_reading

MM = 1e-3
GOOD = {
    "length": 60 * MM,
    "width": 60 * MM,
    "rear_radius": 28 * MM,
    "outsole_thickness": 10 * MM,
}


@pytest.mark.parametrize(
    ("changes", "where"),
    [
        ({"length": 0.0}, "heel.length"),
        ({"width": -60 * MM}, "heel.width"),
        ({"outsole_thickness": math.nan}, "heel.outsole_thickness"),
        ({"rear_radius": -1 * MM}, "heel.rear_radius"),
        ({"rear_radius": 31 * MM}, "heel.rear_radius"),
        ({"edge_radius": 40 * MM}, "heel.edge_radius"),
        ({"crown_radius": 0.0}, "heel.crown_radius"),
        ({"tread": Tread("grid", 5 * MM, 2.4 * MM, 12 * MM)}, "tread.depth"),
        ({"wear": WearPlane(10 * MM)}, "wear.depth"),
        ({"arc_channel": ArcChannel(20 * MM, 30 * MM, 4 * MM, 11 * MM)}, "arc_channel.depth"),
    ],
)
def test_bad_heel(changes, where):
    with pytest.raises(InputError) as caught:
        Heel(**(GOOD | changes))
    assert caught.value.where == where


@pytest.mark.parametrize(
    ("build", "where"),
    [
        (lambda: Tread("grid", 0.0, 2 * MM, 1 * MM), "tread.lug_width"),
        (lambda: Tread("grid", 5 * MM, -2 * MM, 1 * MM), "tread.channel_width"),
        (lambda: Tread("grid", 5 * MM, 2 * MM, -1 * MM), "tread.depth"),
        (lambda: Tread("grid", 5 * MM, 2 * MM, 1 * MM, 2 * MM), "tread.edge_radius"),
        (lambda: Facet(math.radians(80), 30 * MM), "profile.angle"),
        (lambda: Facet(0.1, 0.0), "profile.length"),
        (lambda: Rocker(20 * MM, 25 * MM), "profile.start"),
        (lambda: WearPlane(-1 * MM), "wear.depth"),
        (lambda: WearPlane(1 * MM, -0.1), "wear.angle"),
        (lambda: WearPlane(1 * MM, math.nan), "wear.angle"),
        (lambda: ArcChannel(1 * MM, 30 * MM, 4 * MM, 1 * MM), "arc_channel.width"),
    ],
)
def test_bad_parts(build, where):
    with pytest.raises(InputError) as caught:
        build()
    assert caught.value.where == where


def test_unknown_pattern_names_the_nearest():
    with pytest.raises(InputError, match="transverse") as caught:
        Tread("transvers", 5 * MM, 2 * MM, 1 * MM)
    assert caught.value.nearest == "transverse"


def test_channel_narrower_than_the_grid_names_the_spacing_needed():
    heel = Heel(**GOOD, tread=Tread("grid", 5 * MM, 2.4 * MM, 3 * MM))
    with pytest.raises(InputError, match=r"0\.6 mm or less") as caught:
        heel_map(heel, shoe_angle=0.1, spacing=3 * MM)
    assert caught.value.where == "tread.channel_width"


def test_coarse_channel_is_listed():
    heel = Heel(**GOOD, tread=Tread("grid", 5 * MM, 2.4 * MM, 3 * MM))
    found = heel_map(heel, shoe_angle=0.1, spacing=1 * MM).breaches
    assert [b.quantity for b in found] == ["cells of the grid across the channel"]
    assert found[0].low == pytest.approx(2.4)
    assert not heel_map(heel, shoe_angle=0.1, spacing=0.6 * MM).breaches


def test_narrow_lug_is_refused():
    heel = Heel(**GOOD, tread=Tread("grid", 1 * MM, 5 * MM, 3 * MM))
    with pytest.raises(InputError, match="lug"):
        heel_map(heel, shoe_angle=0.1, spacing=1 * MM)


def test_plan_form_smaller_than_the_grid():
    with pytest.raises(InputError, match="plan form") as caught:
        heel_map(Heel(**GOOD), shoe_angle=0.1, spacing=20 * MM)
    assert caught.value.where == "grid.spacing"


@pytest.mark.parametrize(
    "changes",
    [
        {"spacing": 0.0},
        {"spacing": -1 * MM},
        {"spacing": math.nan},
        {"shoe_angle": math.radians(70)},
        {"shoe_angle": math.nan},
        {"padding": -1 * MM},
    ],
)
def test_bad_grid(changes):
    with pytest.raises(InputError):
        heel_map(Heel(**GOOD), **({"shoe_angle": 0.1, "spacing": 1 * MM} | changes))


def test_a_sole_map_without_land_is_refused():
    sole = heel_map(Heel(**GOOD), shoe_angle=0.1, spacing=2 * MM)
    with pytest.raises(InputError, match="no land"):
        SoleMap(
            sole.x,
            sole.y,
            sole.clearance,
            sole.inside,
            np.zeros_like(sole.land),
            sole.tread_depth,
            sole.spacing,
            sole.outline,
        )
    with pytest.raises(InputError, match="shape"):
        SoleMap(
            sole.x[1:],
            sole.y,
            sole.clearance,
            sole.inside,
            sole.land,
            sole.tread_depth,
            sole.spacing,
            sole.outline,
        )


@pytest.mark.parametrize(
    "changes",
    [
        {"inlet_diameter": -1 * MM},
        {"scan_spacing": 0.0},
        {"sampling_step": math.inf},
        {"gap_cap": 0.0},
        {"scans": 0},
        {"scans": 2.5},
        {"offsets": 4},
    ],
)
def test_bad_sensor(changes):
    x = np.arange(10) * MM
    with pytest.raises(InputError):
        floor_sensor_reading(x, x, np.zeros((10, 10)), np.ones((10, 10)), **changes)


def test_bad_fields():
    x = np.arange(10) * MM
    good, gap = np.zeros((10, 10)), np.ones((10, 10))
    with pytest.raises(InputError, match="shape"):
        floor_sensor_reading(x, x, good[1:], gap)
    with pytest.raises(InputError, match="square"):
        floor_sensor_reading(x, 2 * x, good, gap)
    bad = good.copy()
    bad[3, 3] = math.nan
    with pytest.raises(InputError, match="not finite"):
        floor_sensor_reading(x, x, bad, gap)
    with pytest.raises(InputError, match="not a number"):
        floor_sensor_reading(x, x, good, bad)
