"""CAD files as they are read: units, names, triangles; crowns, wear and drafts of solids.

Of ``underfoot.shoe.parametric.worn_solid``.
"""

import math
import pickle
import re
from dataclasses import replace

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.shoe.files import cad
from underfoot.shoe.parametric import rounding
from underfoot.shoe.parametric.modelling import MM, lug_outlines
from underfoot.shoe.parametric.mould import write_drafted
from underfoot.shoe.parametric.slab import break_points, land_profile
from underfoot.shoe.parametric.solid import (
    SoleSolid,
    _free_lugs,
    _without_pairs,
    check_printable,
    sole_mesh,
    sole_solid,
    write_sole,
)
from underfoot.shoe.shape import Facet, Heel, Rocker
from underfoot.shoe.tread import Groove, Tread
from underfoot.shoe.worn.forms import WearPlane, WornPatch

HEAD = "S" * 72 + "S      1\n"


def iges(*fields: str) -> bytes:
    """The global section of an IGES file: its fields in lines of 72 characters."""
    text = ",".join(fields) + ";"
    lines = [text[at : at + 72].ljust(72) + f"G{at // 72 + 1:7d}" for at in range(0, len(text), 72)]
    return (HEAD + "\n".join(lines) + "\n").encode()


FIELDS = ["1H,", "1H;", "7Ha,b;c,d", "8Hfile.igs", "5Hmaker", "3H1.0", "32", "38", "6", "308", "15",
          "4Hname", "1.0", "UNIT", "2HMM", "1", "0.01", "15H20240101.120000", "1E-06"]  # fmt: skip


@pytest.mark.parametrize(
    ("flag", "unit"),
    [("1", 0.0254), ("2", 1e-3), ("4", 0.3048), ("6", 1.0), ("10", 0.01), ("3", None), ("", None),
     ("x", None)],
)  # fmt: skip
def test_the_unit_of_an_iges_file_is_its_fourteenth_field(tmp_path, flag, unit):
    path = tmp_path / "a.igs"
    path.write_bytes(iges(*(flag if each == "UNIT" else each for each in FIELDS)))
    assert cad.stated_unit(path, "IGES") == unit


def test_fields_of_iges_hold_any_character_where_their_length_says_so():
    text = ",".join(FIELDS).encode() + b";"
    for number, field in enumerate(FIELDS):
        assert cad._iges_field(text, number) == field.encode()
    assert cad._iges_field(text, len(FIELDS)) == b""
    assert cad._iges_field(b" 3Ha,b , 7 ;", 1) == b"7"


def si(prefix: str) -> str:
    return f"#7=( LENGTH_UNIT() NAMED_UNIT(*)\n SI_UNIT({prefix},.METRE.) );"


def test_units_of_step_files(tmp_path):
    path = tmp_path / "a.stp"

    def unit(text: str) -> float | None:
        path.write_text(f"DATA;\n#6=(NAMED_UNIT(*)PLANE_ANGLE_UNIT());\n{text}\nENDSEC;")
        return cad.stated_unit(path, "STEP")

    for prefix, metres in (("$", 1.0), (".MILLI.", 1e-3), (".CENTI.", 1e-2), (".DECI.", 0.1),
                           (".MICRO.", 1e-6), (".KILO.", 1e3), (".NANO.", None)):  # fmt: skip
        assert unit(si(prefix)) == metres
    based = ("#8=(CONVERSION_BASED_UNIT('INCH',#9) LENGTH_UNIT() NAMED_UNIT(#4));\n"
             "#9=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE({}),#7);\n")  # fmt: skip
    assert unit(based.format("25.4") + si(".MILLI.")) == pytest.approx(0.0254)
    assert unit(based.format("2.54E+1") + si(".MILLI.")) == pytest.approx(0.0254)
    assert unit(based.format("0.3048") + si("$")) == pytest.approx(0.3048)
    assert unit(based.format("0.3048")) is None
    assert unit(based.format("0.3048") + si(".NANO.")) == pytest.approx(0.3048)
    assert unit("") is None
    assert cad.stated_unit(path, "BREP") is None


def brick(occ, length, width, height, x=0.0):
    return occ.Box((x, 0, 0), (x + length, width, height))


def test_bricks_of_cad_files(file_regression, tmp_path):
    """Triangles lie on the faces, and their area and volume are those of the bricks."""
    occ = pytest.importorskip("netgen.occ")
    first, second = brick(occ, 90.0, 8.0, 6.0), brick(occ, 30.0, 8.0, 9.0, 100.0)
    first.name, second.name = "sole", "heel"
    both = occ.Compound([first, second])
    shapes = {"one": first, "two": both, "faces": occ.Compound(list(first.faces)[:3])}
    answers = {}
    for name, shape in shapes.items():
        for kind in ("STEP", "BREP"):
            path = tmp_path / f"{name}.{kind.lower()}"
            if kind == "STEP":
                shape.WriteStep(str(path))
            else:
                shape.WriteBrep(str(path), True, True, 3, True)
            unit = "auto" if kind == "STEP" else "mm"
            cad.mesh_into(str(path), kind, unit, str(tmp_path / "answer"))
            mesh = pickle.loads((tmp_path / "answer").read_bytes())
            low, high = mesh.triangles.min(axis=(0, 1)), mesh.triangles.max(axis=(0, 1))
            sides = mesh.triangles[:, 1:] - mesh.triangles[:, :1]
            area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum() / 2
            longest = np.linalg.norm(mesh.triangles - np.roll(mesh.triangles, 1, axis=1), axis=2)
            assert longest.max() < 2 * cad.LONGEST_SIDE
            bodies = [
                tuple(float(side) for side in np.ptp(part.reshape(-1, 3), axis=0))
                for part in (mesh.triangles[mesh.body == n] for n in range(len(mesh.bodies)))
                if len(part)
            ]
            answers[f"{name} {kind}"] = (
                mesh.unit, mesh.bodies, mesh.remarks, low, high, round(float(area), 2), bodies,
                np.unique(mesh.body),
            )  # fmt: skip
            one = 2 * (90 * 8 + 90 * 6 + 8 * 6)
            two = one + 2 * (30 * 8 + 30 * 9 + 8 * 9)
            if name != "faces":
                assert area == pytest.approx(one if name == "one" else two, rel=1e-4)
    path = tmp_path / "one.step"
    for unit in ("mm", "m", "inch"):
        cad.mesh_into(str(path), "STEP", unit, str(tmp_path / "answer"))
        mesh = pickle.loads((tmp_path / "answer").read_bytes())
        answers[f"in {unit}"] = (
            (type(mesh).__name__, str(mesh))
            if isinstance(mesh, Exception)
            else (mesh.unit, np.ptp(mesh.triangles.reshape(-1, 3), axis=0))
        )
    path.write_text("ISO-10303-21;\nEND-ISO-10303-21;")
    cad.mesh_into(str(path), "STEP", "auto", str(tmp_path / "answer"))
    answers["empty"] = str(pickle.loads((tmp_path / "answer").read_bytes()))
    wire = occ.Segment(occ.Pnt(0, 0, 0), occ.Pnt(100, 0, 0))
    wire.WriteBrep(str(tmp_path / "wire.brep"), True, True, 3, True)
    answers["wire"] = refusal(cad._mesh_solid, tmp_path / "wire.brep", "BREP", "mm")
    held(file_regression, answers)


def test_what_is_drawn_stands_in_where_a_mesh_fails(file_regression, monkeypatch, tmp_path):
    """Faces that the mesher leaves out come from the triangles for drawing."""
    occ = pytest.importorskip("netgen.occ")
    shape = brick(occ, 90.0, 40.0, 12.0)
    drawn, body = cad._drawing_triangles(shape, np.arange(6, dtype=np.int32))
    assert drawn.shape == (12, 3, 3)
    assert body.tolist() == [0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5]
    sides = [np.ptp(drawn[body == n].reshape(-1, 3), axis=0) for n in range(6)]
    assert [tuple(side) for side in sides] == [
        (0, 40, 12), (0, 40, 12), (90, 0, 12), (90, 0, 12), (90, 40, 0), (90, 40, 0)
    ]  # fmt: skip
    assert cad._area(drawn) == pytest.approx(2 * (90 * 40 + 90 * 12 + 40 * 12), rel=1e-6)
    path = tmp_path / "a.step"
    occ.Compound([brick(occ, 90.0, 8.0, 6.0), brick(occ, 30.0, 8.0, 9.0, 100.0)]).WriteStep(
        str(path)
    )
    corners, answers = cad._corners, {}
    for name, share in (("little lost", 0.999), ("some lost", 0.99), ("half lost", 0.5)):

        def fewer(mesh, number_of, share=share):
            triangles, bodies = corners(mesh, number_of)
            return triangles[: int(share * len(triangles))], bodies[: int(share * len(triangles))]

        monkeypatch.setattr(cad, "_corners", fewer)
        made = cad._mesh_solid(path, "STEP", "auto")
        assert np.unique(made.body).tolist() == [0, 1]
        assert (len(made.triangles) == 24) == (name != "little lost")
        answers[name] = made.remarks
    monkeypatch.setattr(cad, "_drawing_triangles", lambda *_: (drawn[:4] / 10, body[:4]))
    half = cad._mesh_solid(path, "STEP", "auto")
    assert re.match(r"4\d\.\d% of the area", str(half.remarks[1]))
    assert len(half.remarks) == 2
    monkeypatch.setattr(cad, "_corners", lambda *_: 1 / 0)
    monkeypatch.setattr(cad, "_drawing_triangles", lambda *_: (drawn[:0], body[:0]))
    answers["nothing"] = refusal(cad._mesh_solid, path, "STEP", "auto").replace(str(path), "a.step")
    held(file_regression, answers)


KIND = {"length": 0.05, "width": 0.04, "rear_radius": 0.0, "outsole_thickness": 0.02}
BARS = Tread("transverse", 8e-3, 4e-3, 3e-3)


def test_a_drafted_sole_has_walls_that_lean_into_their_channels(tmp_path):
    """The land stays; each foot moves by depth x tan(draft): the volume grows by two wedges."""
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("netgen.occ")
    shape, draft = Heel(**KIND, tread=BARS), 0.1
    made = sole_solid(shape)
    path = tmp_path / "sole.stl"
    write_drafted(shape, made, draft, path)
    plain, back = sole_mesh(made), trimesh.load_mesh(path)
    assert back.is_watertight
    walls = sum(
        1
        for lug in lug_outlines(shape, BARS)
        for x in (lug.points[:, 0].min(), lug.points[:, 0].max())
        if 1e-4 < x < 0.05 - 1e-4
    )
    wedge = 0.5 * 3e-3**2 * math.tan(draft) * 0.04
    grown = (float(back.volume) - float(plain.volume)) / MM**3
    assert grown == pytest.approx(walls * wedge, rel=1e-3)
    x = np.unique(np.round(np.asarray(back.vertices)[np.abs(back.vertices[:, 2] - 3) < 1e-3, 0], 4))
    on_land = np.unique(np.round(np.asarray(back.vertices)[back.vertices[:, 2] < 1e-6, 0], 4))
    shift = 3 * math.tan(draft)
    feet = {round(v, 2) for v in x}
    for wall in on_land[(on_land > 0.01) & (on_land < 49.99)]:
        assert round(wall + shift, 2) in feet or round(wall - shift, 2) in feet


CROWNED = {
    "flat": Heel(**KIND, crown_radius=0.3),
    "facet": Heel(**KIND, crown_radius=0.2, profile=Facet(0.12, 0.015)),
}


@pytest.mark.parametrize("name", CROWNED)
def test_a_crown_and_a_profile_take_their_parts_of_a_solid(name):
    """Volume is the thickness less profile and crown, integrated over the plan form."""
    pytest.importorskip("netgen.occ")
    shape = CROWNED[name]
    x = np.linspace(0, 0.05, 5001)
    crown = 0.04**3 / 12 / (2 * shape.crown_radius) * 0.05
    land = np.trapezoid(shape.profile.height(x), x) * 0.04
    assert sole_solid(shape).volume == pytest.approx(0.05 * 0.04 * 0.02 - crown - land, rel=2e-5)


def test_profiles_of_slabs_change_where_their_parts_meet():
    facet = Heel(**KIND, profile=Facet(0.12, 0.015))
    assert break_points(facet) == pytest.approx([-0.5e-3, 0.015, 0.0505])
    assert break_points(Heel(**KIND, profile=Rocker(0.08, 0.02))) == pytest.approx(
        [-0.5e-3, 0.02, 0.0505]
    )
    assert break_points(Heel(**KIND)) == pytest.approx([-0.5e-3, 0.0505])
    rocker = Heel(**KIND, profile=Rocker(0.08, 0.02))
    x = np.array([-0.5e-3, 0.0, 0.01, 0.02, 0.03])
    into = np.maximum(0.02 - x, 0)
    assert land_profile(rocker, x) == pytest.approx(0.08 - np.sqrt(0.08**2 - into**2))


WORN = {
    "level": WearPlane(1e-3),
    "plane": WearPlane(3e-3, 0.15),
    "patch": WornPatch(2e-3, 0.025, 0.03, 0.03, 0.0, "rectangle", 0.2),
}


@pytest.mark.parametrize("name", WORN)
def test_wear_is_cut_from_a_solid(name):
    """What is gone is the volume between the worn land and the new one."""
    pytest.importorskip("netgen.occ")
    new, wear = Heel(**KIND), WORN[name]
    worn = new.with_wear(wear)
    x, y = np.meshgrid(
        (np.arange(500) + 0.5) * 1e-4, (np.arange(400) + 0.5) * 1e-4 - 0.02, indexing="ij"
    )
    gone = float(worn.worn_off(x, y).sum()) * 1e-8
    assert gone > 1e-7
    made = sole_solid(new).volume - sole_solid(worn).volume
    assert made == pytest.approx(gone, rel=1e-4 if name != "patch" else 0.1)


def test_rounding_runs_as_a_program(tmp_path):
    """An edge of a brick loses (1 - pi/4) r^2 of its length by a fillet, r^2 / 2 by a chamfer."""
    occ = pytest.importorskip("netgen.occ")
    shape = brick(occ, 30.0, 20.0, 10.0)
    before, after = tmp_path / "a.brep", tmp_path / "b.brep"
    shape.WriteBrep(str(before), withTriangles=False, withNormals=False)
    edges = [n for n, edge in enumerate(shape.edges) if abs(edge.mass - 30.0) < 1e-6]
    for kind, lost in (("fillet", (1 - math.pi / 4) * 4.0), ("chamfer", 2.0)):
        rounding.main([str(before), str(after), kind, "2.0", str(edges[0]), str(edges[3])])
        volume = occ.OCCGeometry(str(after)).shape.mass
        assert volume == pytest.approx(6000.0 - 2 * 30.0 * lost, rel=1e-6)


def test_lugs_that_a_fillet_can_roll_round():
    """They keep the rounded rim, grooves and kinks at least so far: two widths and the rim's."""
    blocks = Tread("blocks", 8e-3, 4e-3, 3e-3, 0.5e-3, lug_length=8e-3)
    plain = Heel(**KIND, tread=blocks)
    lugs = lug_outlines(plain, blocks)

    def free(shape: Heel) -> set[int]:
        whole = _free_lugs(lugs, shape)
        return {n for n, lug in enumerate(lugs) if any(lug is each for each in whole)}

    def extent(n: int) -> np.ndarray:
        return np.array([lugs[n].points.min(axis=0), lugs[n].points.max(axis=0)])

    inside = {
        n for n in range(len(lugs))
        if (extent(n)[0] >= [1e-3, -0.019]).all() and (extent(n)[1] <= [0.049, 0.019]).all()
    }  # fmt: skip
    assert free(plain) == inside
    assert len(inside) >= 4
    # a rounded rim asks for its radius more
    rounded = replace(plain, edge_radius=2e-3)
    assert free(rounded) <= inside
    # a groove that passes a lug at less than the clearance takes it out
    one = max(inside)
    side = extent(one)
    for gap, out in ((0.5e-3, True), (6e-3, False)):
        place = (float(side[0, 0] - gap - 0.5e-3), 0.0)
        grooved = replace(plain, tread=replace(blocks, grooves=(Groove(place, 1e-3),)))
        assert (one not in free(grooved)) or not out
    # a kink of the profile under a lug takes it out
    middle = float(side[:, 0].mean())
    kinked = replace(plain, profile=Facet(0.05, middle))
    assert one not in free(kinked)
    beside = replace(plain, profile=Facet(0.05, float(side[0, 0] - 1.1e-3)))
    assert one in free(beside)
    near = replace(plain, profile=Facet(0.05, float(side[0, 0] - 0.9e-3)))
    assert one not in free(near)


def test_triangles_back_to_back_are_left_out():
    faces = np.array([[0, 1, 2], [2, 1, 3], [1, 2, 0], [3, 4, 5]])
    assert _without_pairs(faces).tolist() == [[2, 1, 3], [3, 4, 5]]


def test_files_that_are_not_the_solid_are_refused(tmp_path):
    pytest.importorskip("netgen.occ")
    made = sole_solid(Heel(**KIND))
    for kind, wrong in ((".stl", 1.011), (".step", 1.0001), (".obj", 0.985)):
        other = SoleSolid(made.body, made.volume * wrong, 0)
        with pytest.raises(Exception, match="the solid"):
            write_sole(Heel(**KIND), tmp_path / f"a{kind}", solid=other)
    for kind, right in ((".stl", 1.009), (".ply", 0.991)):
        other = SoleSolid(made.body, made.volume * right, 0, ("told",))
        answer = write_sole(Heel(**KIND), tmp_path / f"a{kind}", solid=other)
        assert answer.read_volume == pytest.approx(made.volume, rel=1e-6)
        assert (answer.triangles, answer.remarks) == (12, ("told",))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.ply", "a.stl"]


def test_a_bevel_is_refused_where_it_comes_through_the_top():
    for thickness, fits in ((3e-3 + 0.02 * math.tan(0.1) + 1e-5, True),
                            (3e-3 + 0.02 * math.tan(0.1) - 1e-5, False)):  # fmt: skip
        shape = Heel(**{**KIND, "outsole_thickness": thickness}, tread=BARS,
                     profile=Facet(0.1, 0.02))  # fmt: skip
        if fits:
            check_printable(shape)
        else:
            assert "through the outsole" in refusal(check_printable, shape)
