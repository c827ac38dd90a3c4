"""Soles by a few lengths: treads of every pattern, profiles, plan forms, what fits and what not."""

import math
from dataclasses import replace

import numpy as np
import pytest

from snapshot import held, refusal
from sole_shapes import CUT, FORMS, HEEL, LETTERS, OUTLINE, SINGLE, TREADS, TURNED
from underfoot.shoe._kernels import tread_pattern
from underfoot.shoe.ball_joint import BallJoint, rolled_height
from underfoot.shoe.free_land import FreeLand, free_land, height_map
from underfoot.shoe.parametric.sole import ShoeOutline, SoleProfile, ToeSpring, WholeSole
from underfoot.shoe.shape import Facet, Flat, Rocker, fit_wear
from underfoot.shoe.tread import PATTERNS, ArcChannel, Groove, Sipes
from underfoot.shoe.worn.forms import WearPlane, WornMap, WornPatch

X, Y = np.meshgrid(np.linspace(-3.1e-3, 47.3e-3, 22), np.linspace(-23.7e-3, 21.1e-3, 19))


@pytest.mark.parametrize("name", [*TREADS, *TURNED, *CUT])
def test_treads(file_regression, name):
    tread = (TREADS | TURNED | CUT)[name]
    moved = tread.shift_grooves((2e-3, -1e-3))
    answers = {
        "smallest lug": tread.smallest_lug, "pitch": tread.pitch, "land": tread.land_ratio,
        "periods": tread.periods, "walls": tread.wall_line,
        "into": tread.channel_distance(X, Y),
        "into row": tread.channel_distance(X, Y)[4, :12],
        "moved": (moved.offset, moved.grooves, moved.channel_distance(X, Y)),
    }  # fmt: skip
    if tread.sipes:
        answers["slits"] = tread.slit_distance(X, Y)
    held(file_regression, answers, f"tread {name}")


@pytest.mark.parametrize("name", [n for n in PATTERNS if n not in ("chevrons", "graded_circles")])
def test_a_tread_is_the_same_a_period_on(name):
    tread = TURNED[f"{name}, moved and turned"]
    tread = replace(tread, yaw=0.0)
    for shift in tread.periods:
        there = tread.channel_distance(X + shift[0], Y + shift[1])
        np.testing.assert_allclose(there, tread.channel_distance(X, Y), atol=2e-6)


def test_letters_and_free_land(file_regression):
    terms = {"cos1_cos0": 1.0, "sin2_cos1": 0.5, "cos0_sin3": -0.3}
    held(
        file_regression,
        {
            "letters": _drawn(LETTERS),
            "land": _drawn(SINGLE),
            "heights": height_map(terms, (6, 8)),
            "ring": _drawn(_free({"cos1_cos1": 1.0}, 0.35)),
            "inverse": _drawn(_free({"cos1_cos0": -1.0, "cos0_cos1": -1.0}, 0.55)),
            "too narrow": refusal(_free, {"cos1_cos1": 1.0}, 0.5, land=4e-3),
        },
    )


def _free(terms, share, land=1.2e-3) -> FreeLand:
    return free_land(tuple(terms.items()), (6e-3, 5e-3), share, land, 1.2e-3)


def _drawn(one):
    corners = np.array([1e-3, -4e-3]), np.array([15e-3, 6e-3])
    rings = [np.array(ring) for ring in (*one.shells, *one.holes)]
    return {
        "rings": (len(one.shells), rings),
        "corner": one.corner,
        "pitch": one.pitch,
        "area": one.area,
        "stroke": one.stroke,
        "walls": one.segments,
        "outlines": np.concatenate([lug for lug, _ in one.outlines(*corners)]),
        "holes": [len(holes) for _, holes in one.outlines(*corners)],
    }


def test_distances_of_patterns(file_regression):
    x, y = X.ravel(), Y.ravel()
    zigzag = tread_pattern.zigzag_line(6e-3, 0.5)
    held(
        file_regression,
        {
            "bar": tread_pattern.bar_distance(np.linspace(-9e-3, 9e-3, 10), 3e-3, 2e-3),
            "block": tread_pattern.block_distance(x, y, (5e-3, 3e-3), (2e-3, 1e-3)),
            "circle": tread_pattern.circle_distance(x, y, 5e-3, 2e-3),
            "hexagon": tread_pattern.hexagon_distance(x, y, 5e-3, 2e-3),
            "ring": tread_pattern.ring_distance(x, y, 5e-3, 2e-3, 1e-3),
            "graded": tread_pattern.graded_circle_distance(x, y, (3e-3, 6e-3), 2e-3, 30e-3),
            "folded": tread_pattern.folded_bar_distance(x, y, zigzag, 4e-3, 2e-3),
            "zigzag": zigzag,
            "wave": tread_pattern.wave_line(12e-3, 4e-3),
            "rotated": tread_pattern.rotate_coordinates(x, y, 0.3),
        },
    )


@pytest.mark.parametrize("name", FORMS)
def test_forms_of_soles(file_regression, name):
    shape = FORMS[name]
    x, y = np.meshgrid(
        np.linspace(-2e-3, shape.length + 2e-3, 21),
        np.linspace(-0.53, 0.53, 11) * shape.width,
        indexing="ij",
    )
    held(
        file_regression,
        {
            "extent": (shape.length, shape.width, shape.outsole_thickness),
            "area": shape.plan_area,
            "rim": shape.rim_arcs(),
            "inward": shape.inward_distance(x, y),
            "inward of rows": shape.inward_distance(x, y)[[0, 3, 10, 20], :],
            "land": shape.land_height(x, y),
            "new": shape.unworn_height(x, y),
            "middle row": shape.land_height(x, y)[:12, 5],
            "worn": shape.worn_off(x, y),
            "line": shape.centre_line(),
            "as new": shape.with_wear(None).worn_off(x, y).max(),
            "with a patch": shape.with_wear(WornPatch(1e-3, 0.02, 0.01, 0.03, 2e-3)).land_height(
                x, y
            ),
        },
        f"form {name}",
    )


def test_the_rim_encloses_the_area_and_the_distance_is_0_on_it():
    from underfoot.shoe._kernels.arcs import points_on

    for shape in FORMS.values():
        points = points_on(shape.rim_arcs(), 2e-4)
        x, y = points.T
        assert np.abs(shape.inward_distance(x, y)).max() < 1e-8
        area = float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2
        assert area == pytest.approx(shape.plan_area, rel=1e-4)


def test_profiles(file_regression):
    x = np.linspace(-0.01, 0.29, 12)
    toe = ToeSpring(0.02, 0.2, 0.28)
    joint = BallJoint(0.18, 0.1)
    height = np.linspace(0, 5e-3, 24).reshape(12, 2)
    held(
        file_regression,
        {
            "flat": Flat().height(x),
            "facet": Facet(0.3, 0.02).height(x),
            "rocker": Rocker(0.05, 0.03).height(x),
            "toe": (toe.radius, toe.height(x)),
            "both": SoleProfile(Facet(0.3, 0.02), toe).height(x),
            "rear alone": SoleProfile(Rocker(0.05, 0.03)).height(x),
            "forepart": [joint.forepart(a) for a in (-0.8, -0.6, -0.5, -0.2, 0.0, 0.3)],
            "straight": rolled_height(x, height, 0.2, None),
            "up": rolled_height(x, height, 0.2, joint),
            "bent": rolled_height(x, height, -0.3, joint),
            "bent most": rolled_height(x, height, -0.9, joint)[:, 1],
            "in the zone": rolled_height(
                np.linspace(0.166, 0.194, 12), np.zeros((12, 1)), -0.4, joint
            ),
        },
    )


def _tread(**changes):
    return replace(TREADS["grid"], **changes)


REFUSED = {
    "facet of 60 deg": lambda: Facet(math.radians(60.1), 0.02),
    "facet of less than none": lambda: Facet(-0.01, 0.02),
    "facet without length": lambda: Facet(0.1, 0.0),
    "rocker without radius": lambda: Rocker(0.0, 0.01),
    "rocker from nowhere": lambda: Rocker(0.1, 0.0),
    "upright rocker": lambda: Rocker(0.03, 0.03),
    "length": lambda: replace(HEEL, length=0.0),
    "width": lambda: replace(HEEL, width=-0.05),
    "thickness": lambda: replace(HEEL, outsole_thickness=math.nan),
    "rear corners": lambda: replace(HEEL, rear_radius=0.0251),
    "front corners": lambda: replace(HEEL, front_radius=-1e-3),
    "edge": lambda: replace(HEEL, edge_radius=0.026),
    "corners of a short heel": lambda: replace(HEEL, length=0.03, rear_radius=0.016),
    "crown": lambda: replace(HEEL, crown_radius=0.0),
    "deep tread": lambda: replace(HEEL, tread=_tread(depth=0.012)),
    "deep arc": lambda: replace(HEEL, arc_channel=ArcChannel(0.01, 0.02, 4e-3, 0.013)),
    "deep wear": lambda: replace(HEEL, wear=WearPlane(0.012)),
    "pattern": lambda: _tread(pattern="grids"),
    "lug": lambda: _tread(lug_width=0.0),
    "channel": lambda: _tread(channel_width=-1e-3),
    "depth": lambda: _tread(depth=-1e-3),
    "edge radius": lambda: _tread(edge_radius=-1e-3),
    "edge radius of the lug": lambda: _tread(edge_radius=3.1e-3),
    "edge radius of the depth": lambda: _tread(edge_radius=2.1e-3, depth=2e-3),
    "chamfer": lambda: _tread(edge_chamfer=3.01e-3),
    "both edges": lambda: _tread(edge_radius=1e-3, edge_chamfer=1e-3),
    "missing length": lambda: _tread(pattern="blocks"),
    "unused length": lambda: _tread(lug_length=5e-3),
    "length of a block": lambda: _tread(pattern="blocks", lug_length=0.0),
    "missing letters": lambda: _tread(pattern="lettering"),
    "unused letters": lambda: _tread(letters=LETTERS),
    "chevrons of 75 deg": lambda: replace(TREADS["chevrons"], angle=1.32),
    "turned further": lambda: _tread(angle=3.15),
    "rings without hollow": lambda: replace(TREADS["rings"], ring_width=3e-3),
    "deep sipes": lambda: _tread(sipes=Sipes(1e-3, 4.1e-3, 5e-3)),
    "wide sipes": lambda: Sipes(2.5e-3, 2e-3, 5e-3),
    "sipes turned further": lambda: Sipes(1e-3, 2e-3, 5e-3, 3.2),
    "sipes of no depth": lambda: Sipes(1e-3, 0.0, 5e-3),
    "sipes of no spacing": lambda: Sipes(1e-3, 1e-3, 0.0),
    "groove": lambda: Groove((0.0, 0.0), 0.0),
    "groove of no length": lambda: Groove((0.0, 0.0), 1e-3, 0.0),
    "arc at the rear": lambda: ArcChannel(2e-3, 0.02, 4e-3, 1e-3),
    "narrow arc": lambda: ArcChannel(0.01, 3e-3, 6e-3, 1e-3),
    "arc of no radius": lambda: ArcChannel(0.01, 0.0, 4e-3, 1e-3),
    "arc of less than no depth": lambda: ArcChannel(0.01, 0.02, 4e-3, -1e-3),
    "side": lambda: replace(OUTLINE, side="both"),
    "waist": lambda: replace(OUTLINE, waist_width=0.0661),
    "waist of the ball": lambda: replace(OUTLINE, waist_width=0.064, ball_width=0.062),
    "short sole": lambda: replace(OUTLINE, length=0.1999),
    "wide heel": lambda: ShoeOutline(0.2, 0.1281, 0.06, 0.1),
    "heel width": lambda: replace(OUTLINE, heel_width=0.0),
    "toe": lambda: ToeSpring(0.0801, 0.2, 0.28),
    "toe beyond": lambda: ToeSpring(0.01, 0.29, 0.28),
    "toe of no height": lambda: ToeSpring(0.0, 0.2, 0.28),
    "toe from nowhere": lambda: ToeSpring(0.01, 0.0, 0.28),
    "thickness of a sole": lambda: WholeSole(OUTLINE, 0.0),
    "edge of a sole": lambda: WholeSole(OUTLINE, 0.01, edge_radius=0.0301),
    "edge below": lambda: WholeSole(OUTLINE, 0.01, edge_radius=-1e-3),
    "wear of less": lambda: WearPlane(-1e-3),
    "wear at 45 deg": lambda: WearPlane(1e-3, 0.8),
    "wear below": lambda: WearPlane(1e-3, -0.01),
    "patch": lambda: WornPatch(-1e-3, 0.02, 0.02),
    "patch without length": lambda: WornPatch(1e-3, 0.0, 0.02),
    "patch without width": lambda: WornPatch(1e-3, 0.02, 0.0),
    "patch of a form": lambda: WornPatch(1e-3, 0.02, 0.02, form="disc"),
    "steep patch": lambda: WornPatch(1e-3, 0.02, 0.02, taper=1.06),
    "flat patch": lambda: WornPatch(1e-3, 0.02, 0.02, taper=0.008),
    "long patch": lambda: fit_wear(WornPatch(1e-3, 0.0601, 0.02), HEEL),
    "wide patch": lambda: fit_wear(WornPatch(1e-3, 0.02, 0.0501), HEEL),
    "patch beside": lambda: fit_wear(WornPatch(1e-3, 0.02, 0.02, 0.03, 0.0251), HEEL),
    "patch behind": lambda: fit_wear(WornPatch(1e-3, 0.02, 0.02, -1e-4), HEEL),
    "map of another size": lambda: WornMap(np.arange(3.0), np.arange(2.0), np.zeros((2, 3))),
    "map of less": lambda: WornMap(np.arange(2.0), np.arange(2.0), np.array([[0, 0], [0, -1.0]])),
    "map of nan": lambda: WornMap(np.arange(2.0), np.arange(2.0), np.full((2, 2), np.nan)),
}


def test_what_no_sole_can_be(file_regression):
    held(file_regression, {name: refusal(make) for name, make in REFUSED.items()})


def test_what_is_just_possible():
    Facet(math.radians(60), 0.02)
    Facet(0.0, 0.02)
    Rocker(0.0301, 0.03)
    replace(HEEL, rear_radius=0.025, edge_radius=0.025, tread=_tread(depth=0.0119))
    replace(HEEL, wear=WearPlane(0.0, 0.0))
    replace(HEEL, wear=WearPlane(1e-3, math.radians(45)))
    _tread(edge_radius=3e-3)
    _tread(edge_chamfer=3e-3)
    _tread(depth=0.0, edge_radius=9e-3)
    _tread(depth=0.0, sipes=Sipes(1e-3, 4e-3, 5e-3))
    _tread(sipes=Sipes(1e-3, 4e-3, 5e-3))
    _tread(angle=math.radians(180))
    replace(TREADS["chevrons"], angle=math.radians(75))
    replace(TREADS["rings"], ring_width=2.99e-3)
    Sipes(2.49e-3, 2e-3, 5e-3, math.radians(-180))
    ArcChannel(0.01, 0.02, 0.0199, 0.0)
    ShoeOutline(0.2, 0.128, 0.06, 0.1)
    ShoeOutline(0.2, 0.06, 0.06, 0.1)
    ToeSpring(0.0799, 0.2, 0.28)
    WholeSole(OUTLINE, 0.01, edge_radius=0.03)
    for taper in (0.5, 60.0):
        WornPatch(0.0, 0.02, 0.02, taper=math.radians(taper))
    assert fit_wear(WornPatch(1e-3, 0.06, 0.05), HEEL).area == pytest.approx(math.pi / 4 * 3e-3)
    assert fit_wear(WornPatch(1e-3, 0.02, 0.02, 0.03, 0.0249), HEEL)
    assert fit_wear(WearPlane(1e-3), HEEL).depth == 1e-3


@pytest.mark.parametrize("chamfer", [0.0, 0.5e-3])
def test_lugs_are_free_that_keep_clear_of_a_kink(chamfer):
    """By the lug's length and, on both sides, the rim's rounding and two of its own."""
    from underfoot.shoe.parametric.modelling import Outline
    from underfoot.shoe.parametric.solid import _free_lugs

    square = np.array([[0.0, 0.0], [6e-3, 0.0], [6e-3, 6e-3], [0.0, 6e-3]])
    lug = Outline(square + np.array([0.04, -3e-3]))
    clear = 1e-3 + 2 * (chamfer or 0.3e-3)
    tread = replace(
        TREADS["grid"] if "grid" in TREADS else next(iter(TREADS.values())),
        edge_chamfer=chamfer, edge_radius=0.0 if chamfer else 0.3e-3, grooves=(),
    )  # fmt: skip
    for kink, free in (
        (0.04 - 1.01 * clear, True), (0.04 - 0.99 * clear, False), (0.043, False),
        (0.046 + 0.99 * clear, False), (0.046 + 1.01 * clear, True),
    ):  # fmt: skip
        shape = replace(HEEL, length=0.09, width=0.07, rear_radius=0.01, front_radius=0.01,
                        edge_radius=1e-3, tread=tread, profile=Facet(0.1, kink))  # fmt: skip
        assert bool(_free_lugs([lug], shape)) == free, kink
