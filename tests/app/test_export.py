"""``underfoot export``: files that other programs open, with the numbers of the result in them."""

import dataclasses
import json
import math
import struct

import meshio
import numpy as np
import pytest
import trimesh
from typer.testing import CliRunner

from underfoot.cli.app import app
from underfoot.compute.run import run
from underfoot.core import DataError, InputError
from underfoot.core.fields import Fields, from_xarray
from underfoot.report.drawn_sole import drawn_sole
from underfoot.report.export import export_result
from underfoot.report.sole_mesh import sole_mesh
from underfoot.shoe import Facet, Heel, Tread, WearPlane, heel_surface
from underfoot.shoe.worn import WornMap, WornPatch


@pytest.fixture(scope="module")
def run_folder(worn_shoe_result, tmp_path_factory):
    return worn_shoe_result.save(tmp_path_factory.mktemp("export") / "run")


def underfoot(*arguments):
    return CliRunner().invoke(app, list(map(str, arguments)))


def test_glb_stands_upright_in_metres_with_values_and_colours(worn_shoe_result, tmp_path):
    written = export_result(worn_shoe_result, tmp_path / "sole.glb", field="fluid_pressure")
    assert written.length_unit == "m"
    assert written.fields["_FLUID_PRESSURE"] == "Pa"
    (surface,) = trimesh.load(tmp_path / "sole.glb", process=False).geometry.values()
    fields = worn_shoe_result.fields
    inside = fields.inside.values
    side = float(np.diff(fields.x.values[:2])[0])
    x, y = fields.x.values[inside.any(axis=1)], fields.y.values[inside.any(axis=0)]
    across, up, forward = surface.extents
    assert forward == pytest.approx(np.ptp(x) + side, rel=1e-6)
    assert across == pytest.approx(np.ptp(y) + side, rel=1e-6)
    assert up < min(across, forward)
    assert surface.bounds[0][1] == pytest.approx(0.0, abs=1e-4), "it does not stand on the floor"
    pressure = surface.vertex_attributes["_FLUID_PRESSURE"].ravel()
    assert pressure.max() == pytest.approx(float(fields.fluid_pressure.max()), rel=1e-6)
    # the pressure times the area seen from below is the load
    faces = surface.faces
    area = surface.area_faces * -surface.face_normals[:, 1]
    load = float((area * pressure[faces[:, 0]]).sum())
    assert load == pytest.approx(float(fields.position_fluid_load[0]), rel=2e-3)
    colours = surface.visual.vertex_colors
    rubber = colours[pressure == 0]
    assert (np.ptp(rubber[:, :3].astype(int), axis=1) < 10).all()
    assert (np.ptp(colours[pressure > 0.5 * pressure.max()][:, :3].astype(int), axis=1) > 40).all()


def test_glb_is_a_valid_container(worn_shoe_result, tmp_path):
    export_result(worn_shoe_result, tmp_path / "sole.glb")
    data = (tmp_path / "sole.glb").read_bytes()
    magic, version, length = struct.unpack("<4sII", data[:12])
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack("<I4s", data[12:20])
    assert kind == b"JSON"
    scene = json.loads(data[20 : 20 + size])
    (mesh,) = scene["meshes"]
    attributes = mesh["primitives"][0]["attributes"]
    assert {"POSITION", "COLOR_0", "_CONTACT_PRESSURE", "_FLUID_PRESSURE"} <= set(attributes)
    count = {scene["accessors"][index]["count"] for index in attributes.values()}
    assert len(count) == 1


def test_vtu_holds_the_fields_cell_by_cell(worn_shoe_result, tmp_path):
    export_result(worn_shoe_result, tmp_path / "sole.vtu")
    read = meshio.read(tmp_path / "sole.vtu")
    fields = worn_shoe_result.fields
    inside = fields.inside.values
    for name, unit in (("contact_pressure", "Pa"), ("film_thickness", "m")):
        (values,) = read.cell_data[f"{name} ({unit})"]
        np.testing.assert_array_equal(values[: inside.sum()], fields[name].values[inside])
        assert np.isnan(values[inside.sum() :]).all(), "walls carry no field"
    (quads,) = (block.data for block in read.cells if block.type == "quad")
    middles = read.points[quads[: inside.sum()]].mean(axis=1)
    x, y = np.meshgrid(fields.x.values, fields.y.values, indexing="ij")
    np.testing.assert_allclose(middles[:, :2], np.stack([x[inside], y[inside]], axis=1), atol=1e-12)


def test_ply_and_obj_are_in_millimetres_and_say_so(worn_shoe_result, tmp_path):
    for kind in ("ply", "obj"):
        path = tmp_path / f"sole.{kind}"
        written = export_result(worn_shoe_result, path)
        assert "mm" in written.sentence()
        surface = trimesh.load(path, process=False)
        assert surface.extents[0] == pytest.approx(
            1e3 * np.ptp(drawn_sole(worn_shoe_result.fields).x), rel=0.05
        )
        assert b"mm" in path.read_bytes()[:400]
        colours = surface.visual.vertex_colors[:, :3].astype(int)
        assert len(np.unique(colours, axis=0)) > 20


def test_csv_has_a_row_a_cell_in_si(worn_shoe_result, tmp_path):
    export_result(worn_shoe_result, tmp_path / "sole.csv")
    lines = (tmp_path / "sole.csv").read_text().splitlines()
    names = lines[0].split(",")
    inside = worn_shoe_result.fields.inside.values
    assert len(lines) == 1 + inside.sum()
    table = np.loadtxt(lines[1:], delimiter=",")
    pressure = table[:, names.index("fluid_pressure (Pa)")]
    fields = worn_shoe_result.fields
    side, area = float(np.diff(fields.x.values[:2])[0]), fields.cell_film_area.values[inside]
    load = pressure @ area * side**2
    assert load == pytest.approx(float(fields.position_fluid_load[0]), rel=1e-5)


def test_the_pressed_sole_lies_flat_where_it_touches(worn_shoe_case):
    # on squares: finer cells know a corner that the middle of a square does not show
    worn_shoe_result = run(worn_shoe_case.replace("numerics.cells_along", 1), quick=True)
    sole = drawn_sole(worn_shoe_result.fields)
    free, pressed = sole_mesh(sole), sole_mesh(sole, pressed=True)
    assert free.quads.shape == pressed.quads.shape
    fields = worn_shoe_result.fields
    pressure = (fields.contact_pressure + fields.fluid_pressure).values[sole.in_data]
    loaded = pressure > 0.5 * pressure.max()
    film = fields.film_thickness.values[sole.in_data]
    # under load it lies as high as the film is thick
    np.testing.assert_allclose(sole.pressed[loaded], film[loaded], atol=2e-6)


def test_refusals_say_what_is_missing(worn_shoe_result, run_folder, tmp_path):
    with pytest.raises(InputError, match="glb"):
        export_result(worn_shoe_result, tmp_path / "sole.fbx")
    with pytest.raises(InputError, match="fluid_pressure"):
        export_result(worn_shoe_result, tmp_path / "sole.glb", field="fluid_presure")
    empty = dataclasses.replace(worn_shoe_result, data=Fields())
    with pytest.raises(DataError, match="no fields"):
        export_result(empty, tmp_path / "sole.glb")
    old = worn_shoe_result.fields.drop_vars("pressed_height")
    older = dataclasses.replace(worn_shoe_result, data=from_xarray(old))
    with pytest.raises(DataError, match="run the case again"):
        export_result(older, tmp_path / "a.vtu", pressed=True)
    assert not list(tmp_path.iterdir())


def test_the_command_writes_beside_the_result_and_never_over_a_file(run_folder):
    done = underfoot("export", run_folder, "--to", "glb")
    assert done.exit_code == 0, done.output
    assert "lengths in m" in done.output
    assert (run_folder / "sole.glb").stat().st_size > 1000
    again = underfoot("export", run_folder, "--to", "glb")
    assert again.exit_code == 2
    other = underfoot("export", run_folder, "--to", "glb", "--out", run_folder / "x.ply")
    assert other.exit_code == 2
    (run_folder / "sole.glb").unlink()


HEEL = Heel(
    length=0.06, width=0.06, rear_radius=0.028, outsole_thickness=0.02,
    profile=Facet(math.radians(10), 0.03), tread=Tread("grid", 9e-3, 5e-3, 3e-3),
)  # fmt: skip
PLACE = np.linspace(0.0, 0.06, 31), np.linspace(-0.03, 0.03, 31)
WORN = WornMap(*PLACE, 2e-3 * np.exp(-((PLACE[0][:, None] - 8e-3) ** 2 + PLACE[1] ** 2) / 0.012**2))


def removed_volume(shape):
    spacing = 0.1e-3
    return sum(
        sign * np.nansum(heel_surface(each, spacing=spacing).height) * spacing**2
        for sign, each in ((1, shape), (-1, HEEL))
    )


@pytest.mark.parametrize(
    ("wear", "within"),
    [
        (WearPlane(2e-3, math.radians(12)), 1e-3),
        pytest.param(WornPatch(depth=2e-3, length=0.03, width=0.03), 5e-3, marks=pytest.mark.slow),
        pytest.param(WORN, 0.03, marks=pytest.mark.slow),
    ],
    ids=("plane", "patch", "map"),
)
def test_the_worn_solid_has_lost_what_the_map_has(wear, within, tmp_path):
    from underfoot.shoe.parametric import sole_solid, write_sole

    worn = HEEL.worn(wear)
    made = sole_solid(worn)
    lost = sole_solid(HEEL).volume - made.volume
    assert lost == pytest.approx(removed_volume(worn), rel=within)
    written = write_sole(worn, tmp_path / "worn.step", solid=made)
    assert written.read_volume == pytest.approx(made.volume, rel=1e-6)
