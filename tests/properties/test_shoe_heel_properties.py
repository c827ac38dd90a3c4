"""What holds for every parametric heel."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.shoe import ArcChannel, Facet, Flat, Heel, Rocker, Tread, WearPlane, heel_map

MM = 1e-3
PROFILES = st.one_of(
    st.just(Flat()),
    st.builds(Facet, st.floats(0, math.radians(25)), st.floats(5 * MM, 50 * MM)),
    st.builds(Rocker, st.floats(60 * MM, 200 * MM), st.floats(5 * MM, 50 * MM)),
)
TREADS = st.one_of(
    st.none(),
    st.builds(
        Tread,
        st.sampled_from(["grid", "transverse", "longitudinal"]),
        st.floats(3 * MM, 12 * MM),
        st.floats(2.1 * MM, 8 * MM),
        st.floats(0.6 * MM, 6 * MM),
        st.floats(0, 0.5 * MM),
    ),
)
HEELS = st.builds(
    Heel,
    length=st.floats(40 * MM, 90 * MM),
    width=st.floats(40 * MM, 80 * MM),
    rear_radius=st.floats(0, 20 * MM),
    outsole_thickness=st.just(12 * MM),
    front_radius=st.floats(0, 20 * MM),
    profile=PROFILES,
    edge_radius=st.floats(0, 4 * MM),
    crown_radius=st.one_of(st.none(), st.floats(100 * MM, 1.0)),
    tread=TREADS,
    arc_channel=st.one_of(st.none(), st.just(ArcChannel(15 * MM, 25 * MM, 4 * MM, 1 * MM))),
    wear=st.one_of(
        st.none(), st.builds(WearPlane, st.floats(0, 8 * MM), st.floats(0, math.radians(20)))
    ),
)


@settings(deadline=None, max_examples=40)
@given(heel=HEELS, angle=st.floats(math.radians(-10), math.radians(30)))
def test_every_map_is_sound(heel, angle):
    sole = heel_map(heel, shoe_angle=angle, spacing=1.0 * MM)
    assert np.isfinite(sole.clearance[sole.inside]).all()
    assert np.isinf(sole.clearance[~sole.inside]).all()
    assert sole.clearance.min() == 0.0
    assert not (sole.land & ~sole.inside).any()
    assert sole.tread_depth.min() >= 0.0
    assert not sole.tread_depth[~sole.land].any()
    depth = 0.0 if heel.tread is None else heel.tread.depth
    assert sole.tread_depth.max() <= depth
    for name in ("clearance", "inside", "land", "tread_depth"):
        array = getattr(sole, name)
        assert np.array_equal(array, array[:, ::-1]), name
    assert np.array_equal(sole.y, -sole.y[::-1])


@settings(deadline=None, max_examples=20)
@given(heel=HEELS, depth=st.floats(0, 8 * MM), more=st.floats(0, 3 * MM))
def test_more_wear_never_adds_material(heel, depth, more):
    import dataclasses

    x, y = np.meshgrid(np.linspace(0, heel.length, 61), np.linspace(0, heel.width / 2, 31))
    heights = [
        dataclasses.replace(heel, wear=WearPlane(d, 0.2)).land_height(x, y)
        for d in (0.0, depth, depth + more)
    ]
    assert (heights[1] >= heights[0]).all()
    assert (heights[2] >= heights[1]).all()
