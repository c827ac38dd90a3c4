"""Worn soles: forms of wear, cuts of walking, steps of contact, how worn they are; solids."""

import math
from dataclasses import replace

import numpy as np
import pytest

from snapshot import held, refusal
from sole_shapes import FORMS, HEEL, LETTERS, OUTLINE, SINGLE, TREADS
from underfoot.shoe.grids import heel_map, heel_surface
from underfoot.shoe.parametric import modelling
from underfoot.shoe.parametric.modelling import (
    Outline,
    groove_outlines,
    hollow_outlines,
    lug_outlines,
    slit_outlines,
)
from underfoot.shoe.parametric.slab import break_points, land_profile
from underfoot.shoe.parametric.sole import ToeSpring, WholeSole
from underfoot.shoe.parametric.solid import check_printable, sole_solid, write_sole
from underfoot.shoe.shape import Facet, Heel, Rocker
from underfoot.shoe.tread import ArcChannel, Groove, Sipes, Tread
from underfoot.shoe.worn.archard import ArchardStep, archard_wear, pressure_on_sole
from underfoot.shoe.worn.forms import WearPlane, WornMap, WornPatch
from underfoot.shoe.worn.measures import WearMeasures, surface_wear_measures, wear_measures
from underfoot.shoe.worn.surface import worn_surface
from underfoot.shoe.worn.walking import FloorCuts, WalkingWear

X, Y = np.meshgrid(np.linspace(-2e-3, 62e-3, 17), np.linspace(-26e-3, 26e-3, 14), indexing="ij")
TREADED = replace(HEEL, tread=Tread("grid", 6e-3, 3e-3, 3e-3), profile=Facet(0.12, 0.02))
MAP = WornMap(
    np.linspace(0, 0.06, 4), np.linspace(-0.025, 0.025, 3), 1e-3 * np.arange(12.0).reshape(4, 3) / 4
)
WEARS = {
    "level": WearPlane(1e-3),
    "plane": WearPlane(2e-3, 0.2),
    "none": WearPlane(0.0, 0.1),
    "patch": WornPatch(3.2e-3, 0.03, 0.02),
    "patch aside": WornPatch(3e-3, 0.02, 0.01, 0.03, -8e-3, "rectangle", 0.2),
    "map": MAP,
    "walking": WalkingWear(1.5e-3),
    "walking little": WalkingWear(2e-5),
    "cuts": FloorCuts(1e-3, ((0.1, 1e-3), (0.3, 2e-3))),
}


@pytest.mark.parametrize("name", WEARS)
def test_wears(file_regression, name):
    wear = WEARS[name]
    worn = TREADED.with_wear(wear)
    surface = heel_surface(TREADED, spacing=1.5e-3)
    rubbed = worn_surface(surface, wear)
    measures = wear_measures(worn, spacing=1.1e-3)
    assert isinstance(measures, WearMeasures)
    held(
        file_regression,
        {
            "wear": worn.wear, "land": worn.land_height(X, Y), "off": worn.worn_off(X, Y),
            "measures": measures, "length": measures.characteristic_length, "surface": rubbed,
            "of surface": surface_wear_measures(surface, rubbed),
            "map": heel_map(worn, shoe_angle=0.1, spacing=1.5e-3),
            "whole": wear_measures(FORMS["right sole"].with_wear(wear), spacing=4e-3)
            if name in ("level", "walking") else None,
        },
        f"wear {name}",
    )  # fmt: skip


def test_patches_and_maps(file_regression):
    x, y = X[:, ::3], Y[:, ::3]
    held(
        file_regression,
        {
            "ellipse": WornPatch(1e-3, 0.03, 0.02).distance(x, y),
            "rectangle": WornPatch(1e-3, 0.03, 0.02, 0.04, 0.01, "rectangle").distance(x, y),
            "areas": [WornPatch(1e-3, 0.03, 0.02, form=f).area for f in ("ellipse", "rectangle")],
            "thickness": MAP.thickness(x, y),
            "at": MAP.thickness(np.array([0.0, 0.03, 0.9]), np.array(0.0)),
            "depth": MAP.depth,
            "plane": WearPlane(1e-3, 0.2).height(x[:, 0], *TREADED.centre_line()),
        },
    )


def _contact(shape, angle):
    sole = heel_map(shape, shoe_angle=angle, spacing=2e-3)
    return sole, np.where(sole.land, 1e5 * np.exp(-sole.clearance.clip(0, 1) / 5e-4), 0.0)


def test_steps_of_wear(file_regression):
    told = []
    options = {"contact": _contact, "wear_rate": 1e-12, "spacing": 4e-3, "angles": [0.1, 0.2]}
    new = replace(HEEL, tread=Tread("transverse", 8e-3, 6e-3, 3e-3))

    def progress(what, share):
        told.append((what, share))

    state = archard_wear(new, depth=0.6e-3, progress=progress, **options)
    more = archard_wear(new, depth=0.8e-3, begin=state, step=0.5e-3, **options)
    assert isinstance(state, ArchardStep)
    assert state.worn.depth == pytest.approx(0.6e-3)
    assert more.sliding_distance > state.sliding_distance
    sole, pressure = _contact(new, 0.15)
    x, y = np.linspace(0, 0.06, 9), np.linspace(-0.02, 0.02, 5)
    held(
        file_regression,
        {
            "state": state, "told": told, "more": more,
            "nothing": archard_wear(new, depth=0.0, **options),
            "pressure": pressure_on_sole(new, sole, pressure, 0.15, x, y),
            "no angle": refusal(archard_wear, new, depth=1e-3, **(options | {"angles": []})),
            "no rate": refusal(archard_wear, new, depth=1e-3, **(options | {"wear_rate": 0.0})),
            "no spacing": refusal(archard_wear, new, depth=1e-3, **(options | {"spacing": 0.0})),
            "no step": refusal(archard_wear, new, depth=1e-3, step=0.0, **options),
            "less": refusal(archard_wear, new, depth=-1e-3, **options),
            "in the air": refusal(
                archard_wear, new, depth=1e-3,
                **(options | {"contact": lambda s, a: (sole, 0 * pressure)}),
            ),
        },
    )  # fmt: skip


LUGS = {
    **{name: tread for name, tread in TREADS.items() if name != "lettering"},
    "turned": replace(TREADS["grid"], angle=0.3, offset=(2e-3, 1e-3)),
    "turned hexagons": replace(TREADS["hexagons"], angle=-0.2, offset=(2e-3, 1e-3)),
    "letters": replace(TREADS["lettering"], letters=LETTERS, angle=0.1),
    "free": replace(TREADS["lettering"], letters=SINGLE),
}


def _drawn(outlines):
    rings = [one.points for one in outlines]
    return {
        "count": len(outlines),
        "points": np.concatenate(rings),
        "radii": np.array([one.radius for one in outlines]),
        "holes": np.concatenate([np.zeros((1, 2)), *(h for one in outlines for h in one.holes)]),
    }


def test_outlines_of_lugs(file_regression):
    shape = Heel(0.03, 0.026, 0.01, 0.012)
    answers = {}
    for name, tread in LUGS.items():
        lugs = lug_outlines(shape, tread)
        hollows = hollow_outlines(lugs, tread)
        answers[name] = {"lugs": _drawn(lugs), "hollows": _drawn(hollows) if hollows else 0}
        for lug in lugs:
            x, y = lug.points.T
            area = np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))
            assert area > 0 or lug.radius > 0
    grooves = [Groove((0.01, 2e-3), 2e-3), Groove((0.02, 0.0), 1e-3, 8e-3, 0.4)]
    answers["grooves"] = _drawn(groove_outlines(shape, grooves))
    answers["slits"] = _drawn(slit_outlines(shape, 0.4e-3, 5e-3, 0.3, 1e-3))
    held(file_regression, answers)


PROFILES = {
    "flat": HEEL,
    "facet": TREADED,
    "rocker": replace(HEEL, profile=Rocker(0.05, 0.03)),
    "sole": WholeSole(OUTLINE, 0.012, Facet(0.1, 0.03), ToeSpring(0.01, 0.2, 0.28)),
    "rocking sole": WholeSole(OUTLINE, 0.012, Rocker(0.2, 0.04), ToeSpring(0.01, 0.2, 0.28)),
    "long facet": replace(HEEL, profile=Facet(0.05, 0.07)),
}


def test_profiles_of_slabs(file_regression):
    answers = {}
    for name, shape in PROFILES.items():
        x = np.linspace(-0.02, shape.length + 0.02, 12)
        answers[name] = {"breaks": break_points(shape), "land": land_profile(shape, x)}
    held(file_regression, answers)


def _heel(**changes):
    return replace(TREADED, **changes)


def test_what_can_be_made(file_regression):
    grid = TREADED.tread
    cases = {
        "lug": _heel(tread=replace(grid, lug_width=0.29e-3)),
        "channel": _heel(tread=replace(grid, channel_width=0.29e-3)),
        "groove": _heel(tread=replace(grid, grooves=(Groove((0.02, 0.0), 0.2e-3),))),
        "sipe": _heel(tread=replace(grid, sipes=Sipes(0.2e-3, 1e-3, 3e-3))),
        "wall": _heel(tread=replace(grid, sipes=Sipes(0.3e-3, 1e-3, 0.59e-3 + 0.02e-3))),
        "arc": _heel(arc_channel=ArcChannel(0.01, 0.02, 0.2e-3, 1e-3)),
        "bevel": _heel(outsole_thickness=5.4e-3),
        "crown": _heel(outsole_thickness=6e-3, crown_radius=0.5),
    }
    answers = {
        name: refusal(check_printable, shape) for name, shape in cases.items() if name != "wall"
    }
    check_printable(cases["wall"])
    check_printable(_heel(outsole_thickness=5.42e-3))
    check_printable(_heel(outsole_thickness=6.1e-3, crown_radius=0.5))
    check_printable(_heel(tread=replace(grid, depth=0.0, lug_width=1e-5, edge_radius=0.0)))
    check_printable(_heel(tread=replace(grid, lug_width=0.3e-3, channel_width=0.3e-3)))
    held(file_regression, answers)


SOLIDS = {
    "plain": Heel(0.03, 0.026, 0.01, 0.012),
    "bars": Heel(0.03, 0.026, 0.0, 0.012, tread=Tread("transverse", 8e-3, 4e-3, 3e-3)),
    "sipes": Heel(
        0.03, 0.026, 0.01, 0.012, profile=Facet(0.1, 0.01),
        tread=Tread("transverse", 8e-3, 4e-3, 3e-3, sipes=Sipes(0.5e-3, 2e-3, 6e-3, 0.1),
                    grooves=(Groove((0.015, 0.0), 2e-3, angle=1.5),)),
    ),
    "rings": Heel(
        0.03, 0.026, 0.01, 0.012, tread=Tread("rings", 12e-3, 4e-3, 3e-3, ring_width=3e-3),
        wear=WearPlane(1e-3, 0.1),
    ),
    "arc": Heel(
        0.03, 0.026, 0.01, 0.012, profile=Rocker(0.06, 0.02),
        arc_channel=ArcChannel(6e-3, 7e-3, 3e-3, 2e-3),
    ),
}  # fmt: skip


def test_solids(file_regression, tmp_path):
    pytest.importorskip("netgen.occ")
    answers = {}
    for name, shape in SOLIDS.items():
        made = sole_solid(shape)
        low, high = (np.array(tuple(corner)) for corner in made.body.bounding_box)
        answers[name] = {
            "volume": round(made.volume * 1e9, 1), "lugs": made.lugs, "told": made.remarks,
            "box": np.round(np.concatenate([low, high]), 3), "middle": [
                round(value, 2) + 0.0 for value in tuple(made.body.center)],
        }  # fmt: skip
    plain = SOLIDS["plain"]
    assert answers["plain"]["volume"] == pytest.approx(plain.plan_area * 0.012 * 1e9, rel=1e-3)
    assert answers["bars"]["lugs"] == 3
    bars = SOLIDS["bars"]
    written = write_sole(bars, tmp_path / "sole.stl")
    answers["file"] = (written.volume, written.read_volume, written.triangles, written.lugs)
    answers["kind"] = refusal(write_sole, bars, tmp_path / "sole.dxf")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["sole.stl"]
    held(file_regression, answers)


def test_letters_turn_anticlockwise():
    ring = np.array([[0, 0], [0, 1], [1, 1], [1, 0.0]])
    for one in (ring, ring[::-1]):
        turned = modelling._anticlockwise(one)
        x, y = turned.T
        assert np.dot(x, np.roll(y, -1)) > np.dot(y, np.roll(x, -1))
    assert Outline(ring).radius == 0.0
    assert math.isinf(Groove((0.0, 0.0), 1e-3).length)
