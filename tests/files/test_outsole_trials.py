"""Outsole files as designers have them: read right without an option, or refused in words."""

import itertools
import math
import os
import zipfile
from dataclasses import replace

import numpy as np
import pytest
import shapely
import trimesh
from scipy.spatial.transform import Rotation

import trial_soles as made
from outsole_bodies import heel_body, sole_body, triangles
from soles_solved import sole_of_file, sole_of_mesh
from underfoot.core import DataError, InputError
from underfoot.shoe._kernels.covering_discs import channel_width
from underfoot.shoe.files import FileSettings, Mesh, outsole_from_file
from underfoot.shoe.files.cad import stated_unit
from underfoot.shoe.files.read import read_mesh
from underfoot.shoe.tread_measures import tread_measures

HALF, WHOLE = FileSettings(spacing=0.5e-3), FileSettings(spacing=1e-3)
TRIALS = {trial.name: trial for trial in made.trials()}
REFUSED = {"pair, STL": "--side left", "pair, STEP": "--side left"}
LONG = ("scan", "underside", "assembly")


def read(corners, settings=WHOLE, **parts):
    mesh = Mesh(np.ascontiguousarray(corners, dtype=np.float32), "made here", **parts)
    return sole_of_mesh(mesh, settings).outsole


def said(outsole):
    return " ".join(outsole.surface.remarks)


def slow_where_long(name):
    marks = [pytest.mark.slow] if any(word in name for word in LONG) else []
    return pytest.param(name, marks=marks)


@pytest.mark.parametrize("name", [slow_where_long(n) for n in TRIALS if n not in REFUSED])
def test_files_are_read_right_without_an_option(tmp_path, name):
    trial = TRIALS[name]
    # widths are known within half a cell; holes of a scan are not told from steps on 1 mm
    settings = HALF if trial.truth.width or "holes" in name else WHOLE
    if name == "floor plane of a scan":  # on 0.5 mm the edges of its lugs lie on cells' middles
        settings = FileSettings()
    solved, _ = sole_of_file(trial.write(tmp_path), settings)
    found, measures, truth = solved.outsole, solved.measures, trial.truth
    assert measures.land_ratio == pytest.approx(truth.land, abs=0.02)
    assert measures.length * 1e3 == pytest.approx(truth.length, abs=2)
    if truth.depth:
        assert measures.channel_depth[1] * 1e3 == pytest.approx(truth.depth, rel=0.05)
    if truth.width:  # known within half a cell of the map
        assert measures.channel_width[1] * 1e3 == pytest.approx(truth.width, rel=0.08, abs=0.26)
    assert truth.foot in (None, found.foot)


@pytest.mark.parametrize("name", REFUSED)
def test_pairs_are_refused_with_the_remedy_and_parted_when_asked(tmp_path, name):
    path = TRIALS[name].write(tmp_path)
    with pytest.raises(DataError, match="holds a pair") as caught:
        outsole_from_file(path, HALF)
    assert REFUSED[name] in str(caught.value)


@pytest.mark.slow
def test_either_shoe_of_a_pair_can_be_chosen(tmp_path):
    path = TRIALS["pair, STL"].write(tmp_path)
    truth = TRIALS["pair, STL"].truth
    for side in ("left", "right"):
        found = outsole_from_file(path, FileSettings(spacing=5e-4, side=side))
        assert found.foot == side
        assert found.surface.land_ratio == pytest.approx(truth.land, abs=0.02)
    straight = triangles(sole_body(step=3e-3))
    straight[..., 1] *= 0.0  # no width
    with pytest.raises((DataError, InputError)):
        read(straight)


def test_draft_is_that_of_the_walls(tmp_path):
    for name, degrees in (("draft of 8 degrees", 8.0), ("drafted piece 70 x 66", 8.0),
                          ("hexagons, flat", 0.0)):  # fmt: skip
        found = sole_of_file(TRIALS[name].write(tmp_path), HALF)[0].outsole
        assert np.degrees(found.draft) == pytest.approx(degrees, abs=0.2)


def test_sipes_are_counted(tmp_path):
    def slit(x, y):
        return 3e-3 * ((np.mod(x, 10e-3) > 9.5e-3) & (np.abs(y) < 15e-3))

    found = read(triangles(heel_body(slit, step=0.25e-3)), FileSettings(spacing=0.25e-3))
    measures = tread_measures(found.surface)
    assert measures.sipe_count == 5  # the sixth has no wall at the front end: a step, no slit
    assert measures.sipe_length == pytest.approx(5 * 30e-3, rel=0.15)


@pytest.mark.slow
def test_noise_of_a_scan_is_that_of_its_points():
    body = sole_body(lambda x, y: np.zeros_like(x), length=0.28, step=0.7e-3)
    vertices, faces = body
    rng = np.random.default_rng(5)
    for noise in (0.02, 0.08):
        points = vertices * 1e3
        points[:, 2] += rng.normal(0, noise, len(points))
        told = said(read(points[faces], FileSettings(spacing=0.25e-3, down="-z")))
        value = float(told.split("noise of ")[1].split(" um")[0])
        assert value == pytest.approx(noise * 1e3, rel=0.12)


SOLID = {
    "one triangle": lambda: trimesh.Trimesh([[0, 0, 0], [280, 0, 0], [0, 90, 0]], [[0, 1, 2]]),
    "plane": lambda: trimesh.Trimesh(
        [[0, 0, 0], [280, 0, 0], [280, 95, 0], [0, 95, 0]], [[0, 1, 2], [0, 2, 3]]
    ),
    "cube": lambda: trimesh.creation.box((90, 90, 90)),
    "large cube": lambda: trimesh.creation.box((280, 280, 280)),
    "needle": lambda: trimesh.creation.box((300, 1, 1)),
    "strip": lambda: trimesh.creation.box((300, 25, 5)),
    "sphere": lambda: trimesh.creation.icosphere(radius=50, subdivisions=4),
    "torus": lambda: trimesh.creation.torus(38, 12),
    "large torus": lambda: trimesh.creation.torus(110, 30),
    "cylinder": lambda: trimesh.creation.cylinder(radius=40, height=280),
    "disc": lambda: trimesh.creation.cylinder(radius=140, height=10),
    "line": lambda: trimesh.Trimesh([[0, 0, 0], [280, 0, 0], [140, 0, 0]], [[0, 1, 2]]),
}


@pytest.mark.parametrize("name", SOLID)
def test_shapes_that_are_no_sole_are_refused_with_the_reason(name):
    with pytest.raises((DataError, InputError), match=r"this is no sole|no unit makes|has an area"):
        read(SOLID[name]().triangles)


def test_loose_triangles_are_no_sole():
    corners = np.random.default_rng(2).uniform((0, 0, 0), (290, 95, 30), (20_000, 3, 3))
    with pytest.raises(DataError, match="no two of its faces share an edge"):
        read(corners)


@pytest.mark.parametrize("place", [(900, 900, 0), (150, 10, -200)])
def test_a_speck_apart_from_the_sole_is_left_out(place):
    sole = plain_sole(lugs=made.bars)
    speck = np.array(place) + np.array([[[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]]])
    found = read(np.concatenate([sole, speck]), HALF)
    alone = read(sole, HALF)
    assert tread_measures(found.surface).land_ratio == pytest.approx(
        tread_measures(alone.surface).land_ratio, abs=1e-3
    )
    assert (found.down, found.forward) == (alone.down, alone.forward)
    assert "speck apart" in said(found)


@pytest.mark.parametrize("gap", [0.02, 1.0])
def test_lugs_that_float_under_their_base_are_no_pair(gap):
    base = made.slab(PLAN, 4.0, 4.0 + made.SLAB)
    lugs = [
        made.prism(part.simplify(1e-3), -gap, 4.0 - gap)
        for lug in made.bars(PLAN)
        for part in made._polygons(lug.intersection(PLAN))
        if part.area > 1
    ]
    measures = tread_measures(read(np.concatenate([base, *lugs]), HALF).surface)
    assert measures.land_ratio == pytest.approx(0.600, abs=0.006)
    assert measures.channel_depth[1] * 1e3 == pytest.approx(4.0 + gap, abs=0.05)


def test_stray_corner_is_named_with_its_place():
    sole = triangles(sole_body(step=2e-3))
    stray = sole[:1].copy()
    stray[0, 0] = (1e6, 0, 0)
    found = read(np.concatenate([sole, stray]), HALF)
    assert "1 stray corner far off all others, at (1e+06, 0, 0)" in said(found)
    assert found.surface.length == pytest.approx(0.28, abs=1e-3)


def test_print_supports_are_named_and_carry_nothing():
    sole = triangles(sole_body(step=2e-3))
    pillars = [
        trimesh.creation.cylinder(radius=0.8, segment=[(x, y, -12), (x, y, 1)]).triangles
        for x, y in ((60, 5), (150, -10), (220, 12))
    ]
    found = read(np.concatenate([sole, *pillars]))
    assert "3 slender bodies (print supports), up to 1.6 thick, the first at (60, 5, -5.5) in" in (
        said(found)
    )
    land = read(sole).surface.land_ratio
    assert found.surface.land_ratio == pytest.approx(land, abs=0.005)


def test_plane_that_is_hardly_larger_is_cut():
    sole = triangles(sole_body(step=2e-3))
    plane = trimesh.creation.box((292, 100, 0.001)).triangles + np.array([140, 0, -0.5])
    found = read(np.concatenate([sole, plane]), FileSettings(spacing=5e-4, cut_floor=True))
    assert "was cut as floor" in said(found)
    whole = read(sole, HALF).surface
    assert found.surface.land_ratio == pytest.approx(whole.land_ratio, abs=0.01)


def test_arch_of_a_raised_heel_is_no_land():
    def arched(x, y):
        return 9e-3 * ((x > 0.08) & (x < 0.16))

    found = read(triangles(sole_body(arched, step=1e-3)))
    assert "an arch" in said(found)
    x = found.surface.x
    middle = (x > 0.09) & (x < 0.15)
    assert not found.surface.land[middle].any()
    assert found.surface.land[(x < 0.07)].any()


def test_body_is_chosen_by_name(tmp_path):
    path = TRIALS["OBJ with the last above"].write(tmp_path)
    found = outsole_from_file(path, FileSettings(spacing=5e-4, solid="A"))
    assert 'Outsole as chosen: "a"; left out: "b".' in said(found)
    with pytest.raises(InputError, match=r'unknown body "soul".*a, b'):
        outsole_from_file(path, FileSettings(solid="soul"))


def test_unit_line_of_a_step_that_makes_it_no_shoe_is_refused_before_meshing(tmp_path):
    occ = pytest.importorskip("netgen.occ")
    path = tmp_path / "sole.step"
    occ.Compound([made.step_bars(occ)]).WriteStep(str(path))
    made.restate_unit(path, *made._METRE)
    begin = sum(os.times()[:4])  # with the process that looks at it
    with pytest.raises(InputError, match=r"240 m long.*240 mm in mm: choose it with --unit mm"):
        read_mesh(path)
    assert sum(os.times()[:4]) - begin < 2
    chosen = outsole_from_file(path, FileSettings(unit="mm", spacing=5e-4))
    assert chosen.surface.length == pytest.approx(0.24, abs=1e-3)
    assert stated_unit(path, "STEP") == 1.0
    occ.Compound([made.step_bars(occ, 1 / 25.4)]).WriteStep(str(path))
    made.restate_unit(path, *made._INCH)
    assert stated_unit(path, "STEP") == pytest.approx(0.0254)


def test_content_decides_in_every_direction(tmp_path):
    occ = pytest.importorskip("netgen.occ")
    step = tmp_path / "a.step"
    occ.Box((0, 0, 0), (64, 60, 15)).WriteStep(str(step))
    step.rename(tmp_path / "a.stl")
    mesh = read_mesh(tmp_path / "a.stl")
    assert mesh.format == "STEP"
    assert "named .stl but holds STEP" in mesh.remarks[0]
    heel = triangles(heel_body())
    for kind in ("obj", "ply", "off", "glb", "3mf"):
        path = made.by_trimesh(kind, heel)(tmp_path)
        other = path.rename(tmp_path / f"{kind}.step")
        assert read_mesh(other).format == kind.upper()
    with zipfile.ZipFile(tmp_path / "bomb.3mf", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", bytes(501_000_000))
    with pytest.raises(DataError, match=r"unpacks from .* to 501 MB.*200 times its size"):
        read_mesh(tmp_path / "bomb.3mf")
    with zipfile.ZipFile(tmp_path / "zip.stl", "w") as archive:
        archive.writestr("sole.step", "x")
    with pytest.raises(DataError, match=r"ZIP archive that holds sole.step.*Unpack"):
        read_mesh(tmp_path / "zip.stl")
    (tmp_path / "drawing.stl").write_bytes(b"AC1027" + bytes(500))
    with pytest.raises(DataError, match="this is a DWG file"):
        read_mesh(tmp_path / "drawing.stl")


def test_cad_file_that_kills_its_reader_is_refused(tmp_path, monkeypatch):
    pytest.importorskip("netgen.occ")
    from underfoot.shoe.files import cad

    path = TRIALS["STEP mm"].write(tmp_path)
    monkeypatch.setattr(cad.sys, "executable", "false")  # a program that only fails
    with pytest.raises(DataError, match="ends the reader of CAD files"):
        read_mesh(path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names on this system")
def test_pipe_is_refused(tmp_path):
    os.mkfifo(tmp_path / "sole.stl")
    with pytest.raises(InputError, match="no regular file"):
        read_mesh(tmp_path / "sole.stl")


def test_text_stl_without_an_end_is_refused(tmp_path):
    corners = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    one = f"facet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n"
    (tmp_path / "half.stl").write_text("solid x\n" + one * 5)
    with pytest.raises(DataError, match="after 5 facets without the end mark"):
        read_mesh(tmp_path / "half.stl")


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8-sig"])
def test_text_files_of_windows_shells_are_read(tmp_path, encoding):
    heel = triangles(heel_body())
    path = made.by_trimesh("obj", heel)(tmp_path)
    plain = read_mesh(path)
    path.write_text(path.read_text(), encoding=encoding)
    assert np.array_equal(read_mesh(path).triangles, plain.triangles)


def test_rhino_file_tells_bodies_by_layer_and_object(tmp_path):
    rhino = pytest.importorskip("rhino3dm")
    model = rhino.File3dm()
    model.Settings.ModelUnitSystem = rhino.UnitSystem.Centimeters
    sole = triangles(sole_body(step=3e-3)) / 10
    last = trimesh.creation.box((28, 9, 8)).triangles + np.array([14, 0, 5.6])
    hidden = trimesh.creation.box((40, 40, 40)).triangles
    for name, body, visible in (
        ("Outsole", sole, True),
        ("Leisten", last, True),
        ("Old", hidden, False),
    ):
        layer = rhino.Layer()
        layer.Name, layer.Visible = name, visible
        attributes = rhino.ObjectAttributes()
        attributes.LayerIndex, attributes.Name = model.Layers.Add(layer), "part"
        mesh = rhino.Mesh()
        for corner in np.asarray(body, dtype=float).reshape(-1, 3):
            mesh.Vertices.Add(*map(float, corner))
        for n in range(0, 3 * len(body), 3):
            mesh.Faces.AddFace(n, n + 1, n + 2)
        model.Objects.AddMesh(mesh, attributes)
    path = tmp_path / "shoe.3dm"
    assert model.Write(str(path), 7)
    found = outsole_from_file(path, HALF)
    assert found.unit == 0.01
    assert 'Outsole by name: "Outsole/part"; left out: "Leisten/part".' in said(found)
    assert '1 hidden body ("Old/part") left out' in said(found)
    assert found.surface.length == pytest.approx(0.28, abs=1e-3)
    path.write_bytes(path.read_bytes()[:2000])
    with pytest.raises(DataError, match="3DM"):
        read_mesh(path)


def test_iges_is_read_in_its_unit(tmp_path):
    pytest.importorskip("netgen.occ")
    path = tmp_path / "sole.igs"
    path.write_text(made.iges_block((0, 0, 0), (6.4, 6.0, 1.5), unit=10))
    mesh = read_mesh(path)
    assert mesh.format == "IGES"
    assert mesh.unit == 1e-3
    low, high = mesh.triangles.min(axis=(0, 1)), mesh.triangles.max(axis=(0, 1))
    assert high - low == pytest.approx([64, 60, 15], abs=1e-3)


def test_layers_of_an_assembly_tell_where_the_ground_is(tmp_path):
    bodies = {"midsole": trimesh.creation.box((280, 95, 25)).triangles + np.array([140, 0, 27.0])}
    sole = triangles(sole_body(lambda x, y: np.zeros_like(x), toe=0.0, step=3e-3))
    path = made.obj_groups({"outsole": sole * [1, 1, 0.9], **bodies})(tmp_path)
    found = outsole_from_file(path, HALF)
    assert found.down == "-z"
    assert "Ground side: away from the rest of the file" in said(found)
    assert "Assumed: the ground side" not in said(found)


def test_outsole_of_a_file_keeps_its_options_in_the_case(tmp_path):
    from underfoot.report.outsole import case_text, inspect_outsole

    path = TRIALS["OBJ with the last above"].write(tmp_path)
    inspection = inspect_outsole(path, FileSettings(spacing=5e-4, solid="a", cut_floor=True))
    text = case_text(inspection, tmp_path)
    assert 'solid = "a"' in text
    assert "cut_floor = true" in text
    assert "side" not in text


PLAN = made.outline()


def plain_sole(plan=PLAN, lugs=made.hexagons):
    """Triangles (mm) of a slab of 6 mm with lugs of 4 mm, toe at +x, ground at -z."""
    return made.treaded(plan, lugs(plan), 4.0)[0]


@pytest.mark.parametrize("length", [85, 137, 165])
def test_forepart_is_no_heel_turned_round(length):
    piece = PLAN.intersection(made.shapely.box(298.5 - length, -200, 400, 200))
    found = read(plain_sole(piece))
    assert found.forward == "+x"
    assert "Assumed: a forepart, cut at its rear" in said(found)
    assert "--forward flip" in said(found)
    assert found.foot in ("", "right")


def test_a_stated_foot_that_the_plan_denies_and_a_side_without_a_pair_are_told():
    sole = plain_sole()
    foot = read(sole).foot
    other = {"left": "right", "right": "left"}[foot]
    assert "bends as that of the other foot" not in said(read(sole, replace(WHOLE, foot=foot)))
    denied = read(sole, replace(WHOLE, foot=other))
    assert denied.foot == other
    assert "bends as that of the other foot" in said(denied)
    assert "no pair to choose from" in said(read(sole, replace(WHOLE, side="left")))


@pytest.mark.parametrize("length", [60, 95])
def test_heel_piece_is_assumed_and_can_be_swapped(length):
    piece = plain_sole(PLAN.intersection(made.shapely.box(-10, -200, length, 200)))
    found = read(piece)
    assert found.forward == "+x"
    assert "Assumed: a heel piece, cut at its front" in said(found)
    assert read(piece, FileSettings(spacing=1e-3, forward="flip")).forward == "-x"


def heel_cut(degrees, sides=35.5, width=70.0):
    """A heel rounded behind whose sides run straight for ``sides`` mm to an oblique front."""
    shapely = made.shapely
    round_end = shapely.Point(35, 0).buffer(35, quad_segs=32)
    body = shapely.union_all([round_end, shapely.box(35, -width / 2, 35 + 2 * sides, width / 2)])
    lean = math.tan(math.radians(degrees)) * width / 2
    front = [(-9, -width), (35 + sides - 2 * lean, -width), (35 + sides + 2 * lean, width)]
    return body.intersection(shapely.Polygon([*front, (-9, width)]))


@pytest.mark.parametrize(
    ("degrees", "sides", "turned"),
    [(0, 34, 90), (7.3, 31, 0), (-12, 28, 90), (20, 35.5, 0), (20, 35.5, 90), (15, 42, 0)],
)
def test_a_heel_as_wide_as_long_points_to_its_cut(degrees, sides, turned):
    plan = made.shapely.affinity.rotate(heel_cut(degrees, sides), turned, origin=(0, 0))
    found = read(plain_sole(plan, made.bars))
    assert found.forward == ("+x", "+y")[turned // 90]


@pytest.mark.parametrize(
    ("margin", "height"),
    [(40, 10.0), (-5, 10.0), (5, 0.0), (0, 0.0)],  # behind the sole, level with its land
)
def test_table_plane_at_any_margin_is_cut(margin, height):
    x0, y0, x1, y1 = PLAN.bounds
    size = x1 - x0 + 2 * margin, y1 - y0 + 2 * margin, 0.001
    middle = (x0 + x1) / 2, (y0 + y1) / 2, height
    plane = trimesh.creation.box(size).triangles + np.array(middle)
    sole = plain_sole()
    found, alone = read(np.concatenate([sole, plane])), read(sole)
    assert "was taken as floor and cut (12 faces)" in said(found)
    assert (found.down, found.forward, found.foot) == ("-z", "+x", "right")
    assert found.surface.land_ratio == pytest.approx(alone.surface.land_ratio, abs=1e-3)


def scan_on_table(margin, table, tilt=0.0, step=0.8, noise=0.05):
    """Triangles (mm) of one sheet: the tread up, a table beside it at the height ``table``."""
    land = made.shapely.union_all(made.hexagons(PLAN)).intersection(PLAN)
    x0, y0, x1, y1 = PLAN.bounds
    places = (
        np.arange(low - margin, high + margin + step, step) for low, high in ((x0, x1), (y0, y1))
    )
    x, y = np.meshgrid(*places, indexing="ij")
    inside, raised = (made.shapely.contains_xy(plan, x, y) for plan in (PLAN, land))
    z = np.where(raised, 0.0, np.where(inside, -4.0, table))
    z += np.random.default_rng(1).normal(0, noise, z.shape) + np.tan(np.radians(tilt)) * x
    p = np.stack([x, y, z], axis=-1)
    a, b, c, d = p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]
    return np.concatenate([np.stack([a, b, c], -2), np.stack([a, c, d], -2)]).reshape(-1, 3, 3)


@pytest.mark.slow
@pytest.mark.parametrize(("margin", "tilt"), [(40, 0.0), (10, 0.0), (0, 0.0), (10, 1.5)])
def test_table_that_a_scan_hangs_together_with_is_cut(margin, tilt):
    found = read(scan_on_table(margin, -25.0, tilt), HALF)
    assert "was taken as floor and cut" in said(found)
    assert found.surface.length == pytest.approx(0.2985, abs=2e-3)
    alone = read(scan_on_table(0, np.nan), HALF)
    assert found.surface.land_ratio == pytest.approx(alone.surface.land_ratio, abs=0.02)
    assert found.foot == alone.foot == "left"


def test_table_level_with_the_land_of_a_scan_is_told_and_cut_when_asked():
    scan = scan_on_table(5, 0.0)
    told = said(read(scan, HALF))
    assert "Assumed: a level plane" in told
    assert "cut_floor = true" in told
    found = read(scan, FileSettings(spacing=5e-4, cut_floor=True))
    assert found.surface.length == pytest.approx(0.2985, abs=3e-3)


@pytest.mark.parametrize("height", [-1.0, 11.0])
def test_build_plate_under_a_sole_is_left_out(height):
    x0, y0, x1, y1 = PLAN.bounds
    plate = trimesh.creation.box((310, 110, 2)).triangles
    plate = plate + np.array([(x0 + x1) / 2, (y0 + y1) / 2, height])
    found = read(np.concatenate([plain_sole(), plate]))
    assert "is a plate under or over the sole and was left out" in said(found)
    assert found.thickness == pytest.approx(10e-3, abs=1e-4)


@pytest.mark.parametrize(
    "body",
    [trimesh.creation.box(size).triangles for size in ((300, 100, 100), (280, 100, 30))]
    + [made.slab(PLAN, 0, 22.0)],
    ids=("block", "flat block", "midsole"),
)
def test_block_or_midsole_is_no_outsole_unless_its_ground_side_is_stated(body):
    with pytest.raises(DataError, match=r"no tread and is .* mm thick.*--down"):
        read(body)
    if np.ptp(body[..., 2]) < 50:
        found = read(body, FileSettings(spacing=1e-3, down="-z"))
        assert found.surface.land_ratio == 1.0


def test_file_of_a_midsole_alone_is_refused_by_its_name():
    mesh = {"body": np.zeros(len(plain_sole()), int), "bodies": ("Midsole EVA",)}
    with pytest.raises(
        DataError, match=r'no body of the file is an outsole: "Midsole EVA".*--solid'
    ):
        read(plain_sole(), **mesh)
    chosen = FileSettings(spacing=1e-3, solid="midsole")
    assert read(plain_sole(), chosen, **mesh).surface.length == pytest.approx(0.2985, abs=1e-3)


@pytest.mark.parametrize(
    ("channel", "spacing"), [(2.0, 0.25e-3), (3.0, 0.5e-3), (4.0, 0.25e-3), (4.0, 0.5e-3)]
)
def test_channel_is_as_wide_as_drawn_on_every_grid(channel, spacing):
    piece = PLAN.intersection(made.shapely.box(-10, -200, 60, 200))
    sole = plain_sole(piece, lambda plan: made.bars(plan, 6.0, channel))
    found = read(sole, FileSettings(spacing=spacing, down="-z", forward="+x"))
    assert tread_measures(found.surface).channel_width[1] * 1e3 == pytest.approx(channel, abs=1e-6)


@pytest.mark.parametrize("degrees", [0, 15, 30, 45])
def test_width_of_an_oblique_channel_has_no_bias(degrees):
    spacing, width = 0.25e-3, 3e-3
    x, y = np.meshgrid(*(np.arange(160) * spacing,) * 2, indexing="ij")
    across = x * np.cos(np.radians(degrees)) + y * np.sin(np.radians(degrees))
    found = []
    for offset in np.linspace(15e-3, 16e-3, 13)[:-1]:
        band = np.abs(across - offset) < width / 2
        found.append(np.median(channel_width(band, spacing)[band]))
    assert np.mean(found) == pytest.approx(width, abs=spacing / 3)


def test_a_sole_that_lies_far_tilted_on_its_land_is_turned_level():
    """15 degrees off: more than one stands on a stud, but its land lies all in that plane."""
    turn = Rotation.from_euler("xy", (13, -7), degrees=True).as_matrix().T
    body, land = made.treaded(PLAN, made.hexagons(PLAN, 9, 4), 3.0)
    tilted = read(body @ turn)
    measures = tread_measures(tilted.surface)
    assert measures.land_ratio == pytest.approx(land / PLAN.area, abs=0.005)
    assert np.array(measures.channel_depth) * 1e3 == pytest.approx(3.0, abs=0.02)
    assert "Turned by 15" in said(tilted)


def test_lower_lugs_are_no_floor_of_the_channels_beside_them():
    """Bars 7/3.5, each other one 0.8 mm lower: channels stay 4 mm deep and 3.5 mm wide."""
    lugs = made.bars(PLAN, 7, 3.5)
    high, land = made.treaded(PLAN, lugs[::2], 4.0)
    parts = [p for lug in lugs[1::2] for p in shapely.get_parts(lug.intersection(PLAN))]
    lower = [p for p in parts if p.area > 1]
    body = np.concatenate([high, *(made.prism(p, 0.8, 4.0 + made.SUNK) for p in lower)])
    outsole = read(body, HALF)
    measures = tread_measures(outsole.surface)
    assert measures.land_ratio == pytest.approx(land / PLAN.area, abs=0.01)
    assert np.array(measures.channel_depth) * 1e3 == pytest.approx(4.0, abs=0.02)
    assert measures.channel_width[1] * 1e3 == pytest.approx(3.5, abs=0.26)
    lug_height = outsole.surface.tread_depth[outsole.surface.land]
    assert float(np.percentile(lug_height, 5)) == pytest.approx(4e-3, abs=0.02e-3)
    assert "Lugs that stand 0.8 mm lower" in said(outsole)


def test_lugs_with_rounded_edges_are_as_high_as_drawn():
    """Bars 8/4 on a heel, 3.5 mm high, edges of 1.5 mm: the land between edges tells the height."""
    plan, high, radius = shapely.box(0, -33, 70, 33), 3.5, 1.5
    turn = np.linspace(0, np.pi / 2, 9)
    layers = [made.slab(plan, high, high + 4)]
    for lug in made.bars(plan, 8, 4):
        inner = lug.intersection(plan)
        layers.append(made.prism(inner, radius, high + made.SUNK))
        for a, b in itertools.pairwise(turn):
            cut = inner.buffer(radius * (np.cos((a + b) / 2) - 1), join_style="mitre")
            low, top = radius * (1 - np.sin([b, a]))
            layers.append(made.prism(cut, low, top + 0.02))
    measures = tread_measures(read(np.concatenate(layers), FileSettings()).surface)
    assert measures.channel_depth[1] * 1e3 == pytest.approx(high, abs=0.05)
