"""Wear takes material away, and more wear takes more."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.shoe import Facet, Heel, Tread, WearPlane, heel_map
from underfoot.shoe.worn import WalkingWear, WornPatch, wear_measures

PATTERNS = {
    "grid": {},
    "blocks": {"lug_length": 8e-3},
    "bars": {"angle": 0.4},
    "chevrons": {"arm_length": 12e-3, "angle": 0.5},
    "circles": {},
    "hexagons": {},
}


@st.composite
def heels(draw):
    name = draw(st.sampled_from(sorted(PATTERNS)))
    depth = draw(st.floats(0.5e-3, 4e-3))
    return Heel(
        length=0.06,
        width=0.06,
        rear_radius=draw(st.floats(0.005, 0.028)),
        outsole_thickness=0.025,
        profile=Facet(math.radians(draw(st.floats(0, 12))), 0.03),
        edge_radius=draw(st.floats(0, 3e-3)),
        tread=Tread(
            name,
            draw(st.floats(4e-3, 9e-3)),
            draw(st.floats(2.4e-3, 4e-3)),
            depth,
            **PATTERNS[name],
        ),
    )


@given(heels(), st.floats(0.05, 1.0), st.floats(0, 20), st.booleans())
@settings(max_examples=25, deadline=None)
def test_more_wear_takes_more(heel, share, angle, plane):
    depth = heel.tread.depth
    wears = [
        WearPlane(depth * part, math.radians(angle))
        if plane
        else WornPatch(depth * part, 0.04, 0.03)
        for part in (share, min(1.0, 1.3 * share))
    ]
    less, more = (wear_measures(replace(heel, wear=wear), spacing=1e-3) for wear in wears)
    for measures in (less, more):
        assert 0 <= measures.tread_left <= measures.mean_tread_left <= depth + 1e-12
        assert 0 <= measures.worn_patch_area <= heel.plan_area * 1.05
        assert 0 <= measures.removed_volume <= measures.removed_depth * heel.plan_area * 1.05
    assert more.removed_volume >= less.removed_volume - 1e-15
    assert more.tread_left <= less.tread_left + 1e-12
    assert more.worn_patch_area >= less.worn_patch_area - 1e-12


@given(heels(), st.floats(0.05e-3, 5e-3), st.floats(1.0, 1.5))
@settings(max_examples=10, deadline=None)
def test_walking_never_gives_material_back(heel, depth, more):
    x = np.linspace(0.0, heel.length, 400)
    new = heel.unworn_height(x, np.zeros(x.size))
    less, later = (
        heel.with_wear(WalkingWear(each)).land_height(x, np.zeros(x.size)) - new
        for each in (depth, more * depth)
    )
    assert less.min() >= 0.0
    assert (later >= less - 1e-9).all()
    assert less.max() == pytest.approx(depth, rel=0.03, abs=30e-6)


@given(heels())
@settings(max_examples=2, deadline=None)
def test_a_sole_walked_through_is_that_of_a_shoe_without_tread(heel):
    wear = WalkingWear(0.012)
    worn, bare = (
        heel_map(shape.with_wear(wear), shoe_angle=math.radians(7), spacing=1e-3)
        for shape in (heel, replace(heel, tread=None))
    )
    under = bare.clearance < 2e-3
    assert worn.land[under].all()
    assert np.allclose(worn.clearance[under], bare.clearance[under])
