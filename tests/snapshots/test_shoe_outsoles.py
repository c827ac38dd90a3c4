"""Outsoles from triangles: every option, decision and repair, and what is no sole."""

import math
from dataclasses import replace

import numpy as np
import pytest

import sole_forms as made
from outsole_bodies import flat, grooved, heel_body, sole_body, triangles, turned
from snapshot import held, refusal, tried
from underfoot.shoe.files import cleaning, orientation
from underfoot.shoe.files.bodies import found_outsole
from underfoot.shoe.files.carriers import group_bodies, span_mask
from underfoot.shoe.files.draft import wall_draft
from underfoot.shoe.files.floor import without_floor
from underfoot.shoe.files.mesh import Mesh, Unmet
from underfoot.shoe.files.no_sole import (
    Shape,
    check_carried,
    check_sole,
    check_surface,
    check_tread,
)
from underfoot.shoe.files.outsole import outsole_from_mesh
from underfoot.shoe.files.settings import FileSettings, length_unit, likely_unit
from underfoot.shoe.files.view import Soundness, soundness, view, without_copies

COARSE = FileSettings(spacing=1e-3)
LUGS = made.triangles()
HEEL = triangles(heel_body(step=2e-3))
SOLE = triangles(sole_body(grooved(pitch=24e-3, width=8e-3), step=4e-3))
LEFT = triangles(sole_body(grooved(pitch=24e-3, width=8e-3), step=4e-3, right=False))
PLAIN = triangles(sole_body(flat, step=8e-3, toe=0.0))


def mesh(corners, unit=None, bodies=None):
    """A mesh of corners, or of bodies by their names."""
    if bodies is None:
        return Mesh(np.asarray(corners, np.float32), "made here", unit)
    soups = [np.asarray(one, np.float32) for one in bodies.values()]
    number = np.repeat(np.arange(len(soups), dtype=np.int32), [len(one) for one in soups])
    return Mesh(np.concatenate(soups), "made here", unit, (), tuple(bodies), number)


def _shifted(corners, *shift):
    return np.asarray(corners) + np.array(shift)


SPIKE = np.array([[[20, 0, -9], [20.4, 0, 3], [20, 0.4, 3]]])
READ = {
    "lugs": (mesh(LUGS), {}),
    "lugs upside down": (mesh(turned(LUGS, (math.pi, 0, 0))), {}),
    "askew": (mesh(turned(LUGS, (0.3, 0.5, 0.7))), {}),
    "heel": (mesh(HEEL), {}),
    "heel with its sides chosen": (mesh(HEEL), {"down": "-z", "forward": "+x"}),
    "heel turned over": (mesh(HEEL), {"down": "flip", "forward": "flip"}),
    "heel down": (mesh(HEEL), {"down": "+z"}),
    "heel in inches": (mesh(HEEL / 25.4), {"unit": "inch"}),
    "heel of a stated unit": (mesh(HEEL / 10, unit=1e-2), {}),
    "mirrored": (mesh(HEEL), {"mirror": True}),
    "sole": (mesh(SOLE), {}),
    "forepart": (mesh(SOLE), {"region": "forepart"}),
    "a length of it": (mesh(SOLE), {"region": "heel", "region_length": 0.05}),
    "the foot stated": (mesh(SOLE), {"foot": "left"}),
    "plain": (mesh(PLAIN), {"down": "-z"}),
    "plain and thick": (mesh(PLAIN), {}),
    "side of one": (mesh(HEEL), {"side": "left"}),
    "with a spike": (mesh(np.concatenate([HEEL, SPIKE, _shifted(SPIKE, 40, 40, 0)])), {}),
    "open": (mesh(HEEL[: len(HEEL) - 40]), {}),
    "twice": (mesh(np.concatenate([HEEL, HEEL[:50]])), {}),
    "with its floor": (
        mesh(None, bodies={"sole": LUGS, "floor": made.triangles([made.floor()])}), {}
    ),
    "with its last": (
        mesh(None, bodies={"outsole": LUGS, "last": made.triangles([made.tall_last()])}), {}
    ),
    "chosen": (mesh(None, bodies={"a": LUGS, "b": HEEL}), {"solid": "a"}),
    "a pair": (mesh(None, bodies={"a": SOLE, "b": _shifted(LEFT, 0, 120, 0)}), {}),
    "the left of a pair": (
        mesh(None, bodies={"a": SOLE, "b": _shifted(LEFT, 0, 120, 0)}), {"side": "left"}
    ),
    "beyond any unit": (mesh(HEEL * 41.0), {}),
    "a longer region": (mesh(HEEL), {"region_length": 0.07}),
    "forepart of a heel": (mesh(HEEL), {"region": "forepart"}),
    "one triangle": (mesh(HEEL[:1]), {}),
    "loose triangles": (mesh(HEEL[::40]), {}),
    "a box": (mesh(made.triangles([made.base()])), {}),
    "a tall box": (mesh(made.triangles([made.tall_last()])), {}),
    "no such body": (mesh(None, bodies={"a": LUGS, "b": HEEL}), {"solid": "c"}),
}  # fmt: skip


@pytest.mark.parametrize("name", READ)
def test_outsoles(file_regression, name):
    one, options = READ[name]
    coarse = 2e-3 if len(one.triangles) > len(HEEL) else 1e-3
    held(file_regression, _read(one, COARSE, {"spacing": coarse, **options}), f"outsole {name}")


def _read(one, settings, options):
    try:
        return outsole_from_mesh(one, replace(settings, **options))
    except Exception as error:  # which one is held
        return {"refused": f"{type(error).__name__}: {error}"}


def test_settings(file_regression):
    assert FileSettings() == FileSettings(spacing=0.25e-3, region="whole", unit="auto")
    changes = {
        "unit": {"unit": "ft"}, "down": {"down": "z"}, "forward": {"forward": "up"},
        "foot": {"foot": "both"}, "region": {"region": "toe"}, "side": {"side": "flip"},
        "axis": {"down": "-z", "forward": "+z"}, "spacing": {"spacing": 0.0},
        "length": {"region_length": -1.0}, "fine": {"spacing": 1.99e-5},
        "nan": {"region_length": math.nan},
    }  # fmt: skip
    FileSettings(spacing=2e-5, down="flip", forward="flip", region_length=1e-3)
    held(file_regression, {name: refusal(FileSettings, **one) for name, one in changes.items()})


LENGTHS = (
    (280, 100), (28, 10), (11, 4), (0.28, 0.1), (70, 60), (7, 6), (2.8, 2.3), (130, 80), (130, 60),
    (109, 70), (111, 70), (39, 30), (40, 30), (349, 100), (351, 100), (5.1, 4), (1000, 300),
    (160, 94), (160, 95), (13.7, 5), (0.0001, 0.00005),
)  # fmt: skip


def test_units(file_regression):
    answers = {}
    for length, width in LENGTHS:
        answers[f"{length} x {width}"] = tried(length_unit, length, width, where="a.stl")
    answers["likely"] = [likely_unit(length, width) for length, width in LENGTHS]
    for name, given in {
        "chosen": {"chosen": "cm"}, "stated": {"in_file": 1e-2},
        "both": {"chosen": "cm", "in_file": 1e-3},
        "too long": {"chosen": "m"}, "too short": {"in_file": 1e-6}, "longest": {"chosen": "inch"},
        "of a scene": {"in_file": 0.05, "longest": 2.0}, "just": {"in_file": 0.5 / 28},
        "just short": {"in_file": 0.02 / 28},
    }.items():  # fmt: skip
        answers[name] = tried(length_unit, 28, 10, where="a.stl", **given)
    held(file_regression, answers)


X, Y = np.meshgrid(np.arange(60) * 1e-3, np.arange(50) * 1e-3, indexing="ij")
PLAN = ((X - 0.03) / 0.03) ** 2 + ((Y - 0.025) / 0.025) ** 2 < 1


def _map(height, plan=PLAN):
    return np.where(plan, height, np.nan)


def test_repairs_of_heights(file_regression):
    tread = np.where((X // 6e-3) % 2 < 1, 0.0, 3e-3)
    damaged = _map(tread)
    damaged[10:12, 20:23] = np.nan
    damaged[20, 25] = -4e-3
    damaged[30, 20:22] = -5e-3
    damaged[0:2, 0:3] = 1e-3
    damaged[57:60, 0:2] = 1e-3
    large = _map(tread)
    large[20:31, 15:26] = np.nan
    two = _map(tread, PLAN & (np.abs(X - 0.03) > 4e-3))
    specks = np.where((np.arange(60)[:, None] % 6 < 3) & (np.arange(50) % 5 < 3), 0.0, np.nan)
    ledge = _map(tread, PLAN | (X < 0.01))
    ledge[X < 4e-3] = 9e-3
    answers = {}
    for name, height in {
        "damaged": damaged, "large": large, "two": two, "specks": specks, "sound": _map(tread)
    }.items():  # fmt: skip
        answers[name] = cleaning.clean_height_map(height, 1e-3)
    for name, height, deep in (
        ("ledge", ledge, 3e-3), ("deep", ledge, 9e-3), ("none", _map(tread), 3e-3),
        ("welt", _map(tread + 8e-3 * (np.abs(Y - 0.025) > 0.02)), 3e-3),
    ):  # fmt: skip
        inside = np.isfinite(height)
        base = np.where(inside, 0.0, np.nan)
        land = inside & ((height < 1e-3) | (height > 4e-3))
        answers[f"ledges of {name}"] = cleaning.without_ledges(height, land, base, 1e-3, deep)
    answers["outline"] = cleaning.plan_outline(PLAN, X[:, 0], Y[0], 1e-3)
    held(file_regression, answers)


def _shape(**changes):
    given = {"height": _map(0 * X, PLAN | True), "spacing": 1e-3, "thickness": 5e-3,
             "tallness": 9e-3, "standing": 0.8, "noise": 1e-5}  # fmt: skip
    return Shape(**(given | changes))


def test_no_soles(file_regression):
    ring = np.hypot(X - 0.03, Y - 0.025) < 0.013
    wide = {"height": np.zeros((60, 50))}
    shapes = {
        "flat": _shape(thickness=1e-5), "noisy": _shape(noise=0.51e-3),
        "narrow": _shape(height=np.zeros((60, 19))), "broad": _shape(height=np.zeros((160, 151))),
        "slender": _shape(height=np.zeros((141, 20))), "stout": _shape(height=np.zeros((201, 140))),
        "holes": _shape(height=_map(0 * X, ~ring)), "on its edge": _shape(standing=0.079),
        "tall": _shape(tallness=0.04, standing=0.34), "tall and short": _shape(tallness=0.04),
    }  # fmt: skip
    answers = {name: refusal(check_sole, one, "a.stl") for name, one in shapes.items()}
    sound = (
        _shape(noise=0.49e-3), _shape(height=np.zeros((60, 20))), _shape(standing=0.081),
        _shape(height=np.zeros((160, 150))), _shape(height=np.zeros((139, 20))),
        _shape(height=np.zeros((199, 140))), _shape(tallness=0.0375, standing=0.1),
        _shape(height=np.zeros((250, 90)), tallness=0.09, standing=0.36), _shape(**wide),
        _shape(thickness=1e-5, height=_map(1e-3 * X + 1e-4 * (X > 0.03), PLAN | True)),
    )  # fmt: skip
    for one in sound:
        check_sole(one, "a.stl")
    none = Soundness(4, 1, 1, 6, 0, 0, 0, 0.0)
    answers["loose"] = refusal(check_surface, none, "a.stl")
    answers["one"] = refusal(
        check_surface, replace(none, faces=1, degenerate=0, not_finite=0, open_edges=3), "a.stl"
    )
    check_surface(replace(none, open_edges=5), "a.stl")
    answers["no tread"] = refusal(check_tread, _shape(thickness=12.1e-3), False, "a.stl")
    check_tread(_shape(thickness=12e-3), False, "a.stl")
    check_tread(_shape(thickness=12.1e-3), True, "a.stl")
    parts = (np.arange(60)[:, None] % 12 < 9) & (np.arange(50) % 12 < 9)
    answers["parts"] = refusal(check_carried, parts, parts, 1e-3, (), "a.stl")
    unmet = (Unmet("curves", False, "Mesh it"),)
    answers["parts of"] = refusal(check_carried, parts, parts, 1e-3, unmet, "a.stl")
    check_carried(PLAN, PLAN, 1e-3, (), "a.stl")
    check_carried(parts, parts & (X > 0.005), 1e-3, (), "a.stl")
    two = (np.arange(60)[:, None] < 20) | (np.arange(60)[:, None] > 25) & (Y >= 0)
    check_carried(two & (Y >= 0), two & (Y >= 0), 1e-3, (), "a.stl")
    held(file_regression, answers)


def test_how_a_sole_lies(file_regression):
    axes = np.eye(3)
    bowl = _map(20 * (X - 0.02) ** 2 + 0.02 * Y)
    lugs = _map(np.where((X // 6e-3) % 2 < 1, 0.0, 3e-3) + 0.05 * X)
    heel = PLAN & (X < 0.045)
    toe = PLAN & (X > 0.012)
    bent = np.abs(Y - 0.025 - 4 * (X - 0.03) ** 2) < 0.012 + 0.1 * X
    answers = {
        "units": [orientation.unit_vector(d) for d in ("+x", "-y", "-z")],
        "named": [
            orientation.named_direction(np.array(v)) for v in ([1, 0, 0], [0, -1, 0], [0.6, 0, 0.8])
        ],
    }
    for name, corners in {
        "lugs": LUGS,
        "heel": HEEL,
        "sole": SOLE,
        "askew": turned(SOLE, (0.1, 0.2, 0.5)),
        "cut askew": turned(HEEL, (0, 0, 0.15)),
    }.items():
        soup = np.asarray(corners, np.float32)
        answers[f"box of {name}"] = [
            orientation.box_axes(soup, FileSettings(**options))
            for options in ({}, {"forward": "+y"}, {"down": "-x"}, {"down": "-z", "forward": "-x"})
        ] + [orientation.box_axes(soup, FileSettings(), np.array([0.0, 1.0, 0.0]))]
        answers[f"on faces of {name}"] = orientation.on_its_faces(soup, axes)
        answers[f"standing {name}"] = orientation.standing_axes(soup, axes, 1e-3)
        seen = view(soup, axes * 1e-3, 2e-3)
        answers[f"ground of {name}"] = [
            orientation.ground_side(seen, FileSettings(down=d)) for d in ("auto", "flip", "-z")
        ]
        answers[f"seen {name}"] = seen
        answers[f"draft of {name}"] = wall_draft(soup, seen, seen.lowest)
    for name, height in {
        "bowl": bowl,
        "lugs": lugs,
        "flat": _map(0 * X),
        "point": _map(0 * X, (X < 1e-3) & (Y < 1e-3)),
    }.items():
        plane = orientation.resting_plane(height, 1e-3)
        answers[f"plane of {name}"] = {
            "plane": plane, "share": orientation.standing_share(height, 1e-3),
            "broad": orientation.broad_rest(height, 1e-3, plane),
            "other": orientation.other_rest(height, 1e-3),
            "level": orientation.level_axes(axes, plane),
            "tread": orientation.tread_share(height, 1e-3),
        }  # fmt: skip
    for name, plan in {
        "heel": heel,
        "toe": toe,
        "oval": PLAN,
        "bent": bent,
        "box": PLAN | True,
    }.items():
        answers[f"ends of {name}"] = {
            "toe": [orientation.toe_end(plan, s, FileSettings(forward=f))
                    for s in (1e-3, 2.2e-3) for f in ("auto", "flip", "+x")],
            "cut": [orientation.cut_ends(plan, axis, 1e-3) for axis in (0, 1)],
            "straight": [orientation.straight_ends(plan, axis) for axis in (0, 1)],
            "off": [orientation.off_centre(plan, axis) for axis in (0, 1)],
            "foot": [orientation.foot_of(plan, 1e-3, FileSettings(foot=f))
                     for f in ("auto", "left", "right")],
        }  # fmt: skip
    answers["nothing"] = (orientation.tread_share(_map(0 * X, PLAN & False), 1e-3),
                          orientation.standing_share(_map(0 * X, PLAN & False), 1e-3))  # fmt: skip
    held(file_regression, answers)


def _slab(x, y, z):
    ring = np.array([(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])], float)
    return made.triangles([made.prism(ring, *z)])


BASE = made.triangles([made.base()])
TREAD = np.concatenate([made.triangles([one]) for one in made.all_lugs()])
FOUND = {
    "one": {"sole": LUGS},
    "by name": {"Outsole": LUGS, "Midsole": _slab((0, 80), (-32, 32), (9, 20))},
    "by the other's name": {"x": LUGS, "Upper": _slab((0, 80), (-32, 32), (9, 20))},
    "a stack": {"x": LUGS, "y": _slab((0, 80), (-32, 32), (9, 20))},
    "a stack turned over": {"x": LUGS * [1, 1, -1], "y": _slab((0, 80), (-32, 32), (-20, -9))},
    "a stack without tread": {
        "x": _slab((0, 80), (-32, 32), (0, 9)), "y": _slab((0, 80), (-32, 32), (9, 20))
    },
    "base and lugs": {"a": BASE, "b": TREAD},
    "lugs apart": {"a": BASE, "b": _shifted(TREAD, 0, 0, -3)},
    "a plate": {"a": LUGS, "b": _slab((-10, 90), (-40, 40), (-2, 0))},
    "supports": {"a": LUGS, **{
        f"s{n}": _slab((10 * n, 10 * n + 2), (0, 2), (9, 40)) for n in (1, 2, 3)}},
    "specks": {"a": LUGS, "b": _slab((200, 200.2), (0, 0.2), (0, 0.2))},
    "only a last": {"Last": LUGS, "Foam": BASE},
    "floor named": {"Rubber": LUGS, "Floor": _slab((-30, 110), (-60, 60), (-9, 0))},
    "five others": {"Outsole": LUGS, **{
        f"Lace {n}": _slab((0, 1), (-1 - n, -n), (9, 11)) for n in range(5)}},
}  # fmt: skip


def test_which_bodies_are_the_outsole(file_regression):
    answers = {}
    for number, (name, bodies) in enumerate(FOUND.items()):
        one = mesh(None, bodies=bodies)
        answers[name] = {"group": group_bodies(one)}
        ways = {"auto": {}}
        if number % 4 == 0:  # of some also what a user states
            ways |= {"flip": {"down": "flip"}, "chosen": {"solid": "a"}}
        for how, options in ways.items():
            try:
                found = found_outsole(one, replace(COARSE, **options), "a.obj")
            except Exception as error:  # which one is held
                answers[name][how] = f"{type(error).__name__}: {error}"
                continue
            answers[name][how] = {
                "faces": [len(each.triangles) for each in found.meshes], "down": found.down,
                "told": found.remarks, "ground": found.ground, "guess": found.ground_assumed,
            }  # fmt: skip
    answers["span"] = span_mask(np.eye(6, 8, dtype=bool) | (np.arange(8) == 5))
    held(file_regression, answers)


def test_floors_left_in_a_file(file_regression):
    grid = np.arange(-30.0, 111.0, 20.0)
    table = np.concatenate([_slab((x, x + 20), (-60, 60), (-0.01, 0))[:2] for x in grid])
    top = LUGS[LUGS[:, :, 2].max(axis=1) < 8.9]
    answers = {}
    for name, corners in {
        "table under a body": np.concatenate([LUGS, table]),
        "table under a scan": np.concatenate([top, table]),
        "none": LUGS,
        "a plane": table,
        "plate": np.concatenate([LUGS, _slab((-30, 110), (-60, 60), (-3, 0))]),
    }.items():
        for cut in (False, True):
            left, down, told = without_floor(mesh(corners), replace(COARSE, cut_floor=cut))
            answers[f"{name}, {cut}"] = (len(left.triangles), down, told)
    held(file_regression, answers)


def test_soundness(file_regression):
    nan = np.full((2, 3, 3), np.nan, np.float32)
    answers = {}
    for name, corners in {
        "sound": LUGS, "open": LUGS[3:], "twice": np.concatenate([LUGS, LUGS[:7]]),
        "turned": np.concatenate([LUGS[:4, ::-1], LUGS[4:]]), "inward": LUGS[:, ::-1],
        "damaged": np.concatenate([LUGS, nan, LUGS[:1, [0, 0, 1]]]),
        "crowded": np.concatenate([LUGS, LUGS[:1] * [1, 1, 0.5]]),
        "minus zero": LUGS * np.array([1, 1, -1.0]),
    }.items():  # fmt: skip
        found = soundness(mesh(corners), "a.stl")
        answers[name] = (found, found.closed, found.remarks())
    answers["none"] = refusal(soundness, mesh(nan), "a.stl")
    answers["copies"] = len(
        without_copies(np.asarray(np.concatenate([LUGS, LUGS[:9, ::-1]]), "f4"))
    )
    assert answers["copies"] == len(LUGS)
    answers["cells"] = refusal(view, LUGS.astype("f4"), np.eye(3), 1e-3)
    held(file_regression, answers)
