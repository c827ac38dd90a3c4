"""``underfoot export``: files that other programs open, with the numbers of the result in them."""

import dataclasses
import json
import math
import struct
from pathlib import Path

import meshio
import numpy as np
import pytest
import trimesh
from scipy.ndimage import binary_dilation
from scipy.spatial import cKDTree
from typer.testing import CliRunner

from underfoot.case import Case
from underfoot.cli.app import app
from underfoot.compute.run import run
from underfoot.compute.sole import drawn_map, sole_map
from underfoot.core import DataError, InputError
from underfoot.core.fields import Fields, from_xarray
from underfoot.report.designed_sole import FINEST, DesignedSole
from underfoot.report.drawn_sole import drawn_sole
from underfoot.report.sole_export import export_result
from underfoot.report.sole_mesh import sole_mesh
from underfoot.shoe import Facet, Heel, Tread, WearPlane, heel_surface
from underfoot.shoe.files import outsole_from_file
from underfoot.shoe.worn import WornMap, WornPatch


@pytest.fixture(scope="module")
def run_folder(worn_shoe_result, tmp_path_factory):
    return worn_shoe_result.save(tmp_path_factory.mktemp("export") / "run")


def underfoot(*arguments):
    return CliRunner().invoke(app, list(map(str, arguments)))


def exported_loads(path):
    """Contact and fluid load (N): of each face, or corner, the pressure times the area, summed."""
    if path.suffix == ".vtu":
        read = meshio.read(path)
        table = {name: values[0] for name, values in read.cell_data.items()}
        names = ("contact_pressure (Pa)", "fluid_pressure (Pa)", "area (m^2)")
        # the areas are those of the faces seen from below
        points, quads = read.points, read.cells[0].data
        seen = np.cross(points[quads[:, 2]] - points[quads[:, 0]],
                        points[quads[:, 3]] - points[quads[:, 1]])[:, 2] / 2  # fmt: skip
        known = table["outside (1)"] == 1
        assert not any(np.isnan(table[name]).any() for name in names)
        np.testing.assert_allclose(-seen[known], table["area (m^2)"][known], rtol=1e-6)
    elif path.suffix == ".csv":
        lines = path.read_text().splitlines()
        table = dict(zip(lines[0].split(","), np.loadtxt(lines[1:], delimiter=",").T, strict=True))
        names = ("contact_pressure (Pa)", "fluid_pressure (Pa)", "area (m^2)")
    elif path.suffix == ".glb":
        (surface,) = trimesh.load(path, process=False).geometry.values()
        table = {name: values.ravel() for name, values in surface.vertex_attributes.items()}
        names = ("_CONTACT_PRESSURE", "_FLUID_PRESSURE", "_AREA")
        pressure = table["_CONTACT_PRESSURE"][surface.faces].mean(axis=1)
        load = pressure @ (surface.area_faces * -surface.face_normals[:, 1])
        assert load == pytest.approx(pressure_load(table, names[0], names[2]), rel=1e-4)
    else:
        raw = trimesh.load(path, process=False).metadata["_ply_raw"]["vertex"]["data"]
        table = {name: np.asarray(raw[name], float) for name in raw.dtype.names}
        names = ("contact_pressure", "fluid_pressure", "area")
    return [pressure_load(table, name, names[2]) for name in names[:2]]


def pressure_load(table, pressure, area):
    return float(np.nansum(np.asarray(table[pressure], float) * np.asarray(table[area], float)))


def solved_loads(result):
    fields = result.fields
    side = float(np.median(np.diff(fields.x.values)))
    pairs = (("contact_pressure", "cell_area"), ("fluid_pressure", "cell_film_area"))
    return [
        float(np.nansum(fields[one].values * fields[share].values)) * side**2
        for one, share in pairs
    ]


@pytest.mark.parametrize("kind", ["glb", "ply", "vtu", "csv"])
def test_pressures_of_an_export_integrate_to_the_load(worn_shoe_result, kind, tmp_path):
    export_result(worn_shoe_result, tmp_path / f"sole.{kind}")
    found = exported_loads(tmp_path / f"sole.{kind}")
    assert found == pytest.approx(solved_loads(worn_shoe_result), rel=1e-4)
    assert sum(found) == pytest.approx(500.0, rel=5e-3)


def test_a_sole_is_drawn_on_square_cells_whatever_it_is_solved_on(worn_shoe_case):
    """A flat sole in a fluid is solved on up to 32 cells in one: ten times the time to draw."""
    drawn, solved = (made(worn_shoe_case, 2e-3) for made in (drawn_map, sole_map))
    assert drawn.cells is None
    assert solved.cells is not None
    np.testing.assert_array_equal(drawn.clearance, solved.clearance)


def scan_of(path, place):
    """Write a sole's file as a scan: points every 0.5 mm with noise of 30 um, one sheet."""
    sole = outsole_from_file(path).surface
    x, y = (np.arange(each[0], each[-1], 0.5e-3) for each in (sole.x, sole.y))
    nearest = (np.rint((each - of[0]) / sole.spacing).astype(int) for each, of in
               ((x, sole.x), (y, sole.y)))  # fmt: skip
    z = sole.height[np.ix_(*nearest)]
    z = z + np.random.default_rng(4).normal(0, 30e-6, z.shape)
    points = 1e3 * np.stack([*np.meshgrid(x, y, indexing="ij"), z], axis=-1)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    faces = np.concatenate([np.stack([a, c, b], -2), np.stack([a, d, c], -2)]).reshape(-1, 3, 3)
    faces = faces[np.isfinite(faces).all(axis=(1, 2))]
    trimesh.Trimesh(faces.reshape(-1, 3), np.arange(len(faces) * 3).reshape(-1, 3)).export(place)
    return place


EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.slow
@pytest.mark.parametrize("sole", ["parametric", "file", "scan"])
def test_pressures_of_treads_integrate_to_the_load_and_lugs_end_as_drawn(sole, tmp_path):
    place = EXAMPLES / "measured" / "heel.stl"
    if sole == "scan":
        place = scan_of(place, tmp_path / "scan.stl")
    case = Case.load(EXAMPLES / "outsoles" / "heel_hexagons_glycerol.toml")
    if sole != "parametric":
        shoe = {"from": "work_shoe_half_tread", "outsole": {"file": str(place)}}
        case = Case.from_mapping(
            {"shoe": shoe, "floor": "vinyl_g4", "contaminant": "glycerol_90pct",
             "motion": {"from": "slip_tester_g4"}}
        )  # fmt: skip
    result = run(case, quick=True)
    loads = solved_loads(result)
    for kind in ("glb", "ply", "vtu", "csv"):
        export_result(result, tmp_path / f"sole.{kind}")
        assert exported_loads(tmp_path / f"sole.{kind}") == pytest.approx(loads, rel=5e-3)
    # ends of lugs: against the same sole on cells of 0.1 mm
    drawn, truth = DesignedSole.of_case(result.data, case).drawn, sole_map(case, 0.1e-3)
    assert drawn.spacing <= FINEST
    edges = [binary_dilation(land) & ~land & known for land, known in
             ((drawn.land, np.isfinite(drawn.height)), (truth.land, truth.inside))]  # fmt: skip
    ends = [
        np.stack([each.x[i], each.y[j]], axis=1)
        for each, (i, j) in zip((drawn, truth), map(np.nonzero, edges), strict=True)
    ]
    away, _ = cKDTree(ends[1]).query(ends[0])
    assert np.quantile(away, 0.99) < 0.3e-3 + 0.1e-3 / 2


def test_a_sole_whose_file_is_gone_is_exported_from_the_cells(worn_shoe_result, tmp_path):
    text = worn_shoe_result.case_text + '\n[shoe.outsole]\nfile = "/nowhere/sole.stl"\n'
    gone = dataclasses.replace(worn_shoe_result, case_text=text)
    written = export_result(gone, tmp_path / "sole.vtu")
    assert "drawn from the solver's cells" in written.sentence()
    assert exported_loads(tmp_path / "sole.vtu") == pytest.approx(solved_loads(gone), rel=1e-4)


def test_glb_stands_upright_in_metres_with_colours(worn_shoe_result, tmp_path):
    written = export_result(worn_shoe_result, tmp_path / "sole.glb", field="fluid_pressure")
    assert written.length_unit == "m"
    assert written.fields["_FLUID_PRESSURE"] == "Pa"
    (surface,) = trimesh.load(tmp_path / "sole.glb", process=False).geometry.values()
    fields = worn_shoe_result.fields
    inside = fields.inside.values
    x, y = fields.x.values[inside.any(axis=1)], fields.y.values[inside.any(axis=0)]
    across, up, forward = surface.extents
    assert forward == pytest.approx(np.ptp(x) + 2e-3, abs=1.5e-3)
    assert across == pytest.approx(np.ptp(y) + 2e-3, abs=1.5e-3)
    assert up < min(across, forward)
    assert surface.bounds[0][1] == pytest.approx(0.0, abs=1e-4), "it does not stand on the floor"
    pressure = surface.vertex_attributes["_FLUID_PRESSURE"].ravel()
    # a cell's pressure is the mean over it: what is drawn between cells may rise above at a peak
    cells = np.stack([surface.vertices[:, 2], surface.vertices[:, 0]])[:, pressure > 0]
    film = fields.fluid_pressure.values
    top = np.unravel_index(np.argmax(film), film.shape)
    peak = fields.x.values[top[0]], fields.y.values[top[1]]
    in_cell = (np.abs(cells - np.array(peak)[:, None]) < 1e-3).all(axis=0)
    drawn = pressure[pressure > 0]
    assert drawn[in_cell].mean() == pytest.approx(film.max(), rel=0.05)
    assert film.max() < drawn.max() < 1.1 * film.max()
    colours = surface.visual.to_color().vertex_colors
    rubber = colours[pressure == 0]
    grey = np.ptp(rubber[:, :3].astype(int), axis=1) < 10
    assert grey.mean() > 0.9, "beside a lug its colour may show"
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
    assert {"POSITION", "TEXCOORD_0", "_CONTACT_PRESSURE", "_FLUID_PRESSURE"} <= set(attributes)
    count = {scene["accessors"][index]["count"] for index in attributes.values()}
    assert len(count) == 1


def test_vtu_holds_the_fields_between_those_of_the_cells(worn_shoe_result, tmp_path):
    export_result(worn_shoe_result, tmp_path / "sole.vtu")
    read = meshio.read(tmp_path / "sole.vtu")
    (area,) = read.cell_data["area (m^2)"]
    (film,) = read.cell_data["film_thickness (m)"]
    assert np.isnan(film[~np.isfinite(area)]).all(), "walls carry no field"
    fields = worn_shoe_result.fields
    known = fields.film_thickness.values[fields.inside.values]
    assert np.nanmin(film) >= known.min() * (1 - 1e-6)
    assert np.nanmax(film) <= known.max() * (1 + 1e-6)
    assert np.nanmean(film) == pytest.approx(known.mean(), rel=0.02)


@pytest.mark.slow
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


@pytest.mark.slow
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

    worn = HEEL.with_wear(wear)
    made = sole_solid(worn)
    lost = sole_solid(HEEL).volume - made.volume
    assert lost == pytest.approx(removed_volume(worn), rel=within)
    written = write_sole(worn, tmp_path / "worn.step", solid=made)
    assert written.read_volume == pytest.approx(made.volume, rel=1e-6)
