"""Soles as triangles, as data of the viewer and as files of other programs, of a few cells."""

import json
import math
from typing import Any

import numpy as np
import pytest

from small_soles import fake, scene_lines, sole
from snapshot import held, refusal
from underfoot.core import SourcedValue, Status
from underfoot.questions.outcomes import CaseOutcome
from underfoot.questions.wear import WearSeries
from underfoot.questions.wear_limit import WearPoint
from underfoot.report.designed_sole import DesignedSole
from underfoot.report.drawn_sole import drawn_sole
from underfoot.report.light_mesh import light_mesh, spacing_for
from underfoot.report.quantities import quantities
from underfoot.report.sole_export import WRITERS, export_result
from underfoot.report.sole_mesh import sole_mesh
from underfoot.report.solver_input import _rows, _wrap_numbers, forces_on_nodes, with_middle_nodes
from underfoot.report.surface_mesh import surface_mesh
from underfoot.report.thumbnail import _runs
from underfoot.report.viewer import scene_section, viewer_scene
from underfoot.report.wear_page import wear_scene
from underfoot.shoe import Heel, Tread, WearPlane, heel_map, heel_surface
from underfoot.shoe.worn import wear_measures

SMALL = sole(side=2e-3, long=0.04, sensors=0)
SHORT = sole(side=2e-3, long=0.02, sensors=0)
SLOPED = Heel(length=0.03, width=0.024, rear_radius=0.01, outsole_thickness=0.02,
              tread=Tread("bars", 6e-3, 3e-3, 2e-3, angle=math.radians(20)))  # fmt: skip
ROUND = Heel(length=0.03, width=0.024, rear_radius=0.01, outsole_thickness=0.02,
             tread=Tread("circles", 7e-3, 3e-3, 2e-3))  # fmt: skip


def mesh_lines(mesh):
    """Return what triangles come to, whichever comes first and however a square is cut."""
    a, b, c = mesh.points[mesh.triangles].transpose(1, 0, 2)
    area = np.abs(np.linalg.det(np.stack([b - a, c - a], axis=-1)[:, :2])) / 2
    on_land = mesh.land[mesh.triangles[:, 0]]
    walls = mesh.points[mesh.walls]
    rim = mesh.points[mesh.sides]
    return {
        "counts": [len(each) for each in (mesh.points, mesh.triangles, mesh.walls, mesh.sides)],
        "land": [int(mesh.land.sum()), int(on_land.sum())],
        "area (mm²)": [1e6 * area.sum(), 1e6 * area[on_land].sum()],
        "volume (mm³)": 1e9 * (area * (a + b + c)[:, 2] / 3).sum(),
        "walls (mm)": [1e3 * np.hypot(*(walls[:, 1] - walls[:, 0])[:, :2].T).sum(),
                       1e3 * np.abs(walls[:, 0] - walls[:, 2])[:, 2].sum()],
        "rim (mm)": 1e3 * np.hypot(*(rim[:, 1] - rim[:, 0])[:, :2].T).sum(),
        "box (mm)": 1e3 * np.array([mesh.points.min(axis=0), mesh.points.max(axis=0)]),
        "middle (mm)": 1e3 * mesh.points.mean(axis=0),
    }  # fmt: skip


def stepped():
    """Return axes, heights and land of a hill with two steps, one of them steep everywhere."""
    x, y = 1e-3 * np.arange(14.0), 1e-3 * np.arange(11.0)
    height = 2e-4 * np.sin(x[:, None] * 400) * np.cos(y * 300) + np.where(
        x[:, None] > 6e-3, 4e-3, 0
    )
    height = np.where((y > 8e-3) & (x[:, None] < 3e-3), np.nan, height + 0.05 * y)
    return x, y, height, np.broadcast_to(y < 5e-3, height.shape)


def surfaces():
    """Yield surfaces of each way to know where lugs end, by name."""
    x, y, height, land = stepped()
    yield "steps", surface_mesh(x, y, height, land)
    tooth = np.where(np.arange(9)[:, None] % 2, 0.0, 5e-3) + 1e-4 * np.arange(7.0)
    yield "all of it steep", surface_mesh(x[:9], y[:7], tooth, tooth >= 0)
    for name, shape in (("bars", SLOPED), ("circles", ROUND)):
        made = heel_map(shape, shoe_angle=0.0, spacing=0.7e-3)
        flat = np.where(made.inside, made.clearance, np.nan)
        yield f"{name} of cells", surface_mesh(made.x, made.y, flat, made.land)
        yield f"{name} with crossings", surface_mesh(made.x, made.y, flat, made.land, made.cut)
    side = 0.5e-3
    x, y = np.arange(side / 2, 0.016, side), np.arange(side / 2, 0.012, side)
    turned = np.array([[4.1, 0.0], [9.3, 0.0], [12.2, 12.0], [7.0, 12.0]]) * 1e-3
    lug = np.abs((x[:, None] - 8.15e-3 - 2.9e-3 * (y / 0.012 - 0.5)) / 2.6e-3) < 1
    ring = np.array([[0.1, 0.1], [15.9, 0.1], [15.9, 11.9], [0.1, 11.9]]) * 1e-3
    edges, rim = (np.stack([each, np.roll(each, -1, 0)], axis=1) for each in (turned, ring))
    height = np.where(lug, 0.0, 2e-3)
    yield "drawn", surface_mesh(x, y, height, lug, edges=edges[1::2], rim=rim, reach=2 * side)
    yield "drawn far off", surface_mesh(x, y, height, lug, edges=edges, rim=rim, reach=side / 50)
    within = np.array([[4.1, 3.2], [9.3, 2.1], [12.2, 8.9], [7.0, 9.3]]) * 1e-3
    begin, way = within, np.roll(within, -1, 0) - within
    off = [way[k, 0] * (y - begin[k, 1]) - way[k, 1] * (x[:, None] - begin[k, 0]) for k in range(4)]
    closed, sides = np.min(off, axis=0) > 0, np.stack([begin, begin + way], axis=1)
    reach: dict[str, Any] = {"edges": sides, "rim": rim, "reach": 2 * side}
    yield "drawn, closed", surface_mesh(x, y, np.where(closed, 0.0, 2e-3), closed, **reach)
    yield "rim alone", surface_mesh(x, y, height, lug, rim=rim, reach=side)


def test_surfaces(file_regression):
    held(file_regression, scene_lines({name: mesh_lines(made) for name, made in surfaces()}))


def faces_of(mesh):
    corners = mesh.points[mesh.quads]
    cells = np.bincount(mesh.cell[mesh.cell >= 0], minlength=10)
    return [len(corners), (mesh.cell < 0).sum(), cells.max(), corners.mean(axis=(0, 1)),
            corners.std(axis=(0, 1)), mesh.triangles[:2]]  # fmt: skip


def whole_and_part():
    """Return fields of a part of a sole with the heights of the whole around it."""
    x, y = SMALL["x"].values, SMALL["y"].values
    along, across = np.arange(-3, 23) * 2e-3 + x[0], np.arange(-1, 21) * 2e-3 + y[0]
    whole = 1e-3 + 0.1 * along[:, None] + 0 * across
    whole[:, :1] = np.nan
    names = ("whole_x", "whole_y")
    return SMALL.assign(
        {
            "whole_clearance": (names, whole), "whole_land": (names, np.isfinite(whole) * 1.0),
            "whole_pressed_height": (names, 0.9 * whole), "whole_x": ("whole_x", along),
            "whole_y": ("whole_y", across),
        }
    )  # fmt: skip


def test_cells_of_a_sole(file_regression):
    told = {}
    bare = {n: v for n, v in SMALL.data_vars.items() if n in ("contact_pressure", "inside", "x")}
    for name, data in (("small", SMALL), ("part", whole_and_part())):
        made = drawn_sole(data)
        told[name] = [made, made.plane, made.in_part, made.place_field(np.ones((2, 20, 20))).shape,
                      np.nansum(made.place_field(np.ones((20, 20)))), faces_of(sole_mesh(made)),
                      faces_of(sole_mesh(made, pressed=True))]  # fmt: skip
    flat = drawn_sole(type(SMALL)(bare, SMALL.coords))
    told["without heights"] = [flat, flat.plane]
    held(file_regression, scene_lines(told))


def fine_map(side=1e-3, long=0.04):
    """Return a sole as it was designed: bars of 16 mm, whose ends lie between cells of 2 mm."""
    x, y = np.arange(side / 2, long, side), np.arange(side / 2, 0.04, side) - 0.02
    inside = (x[:, None] > 0.01) | (np.abs(y) < 0.012)
    land = inside & (np.floor(x[:, None] / 8.4e-3) % 3 > 0)
    clearance = np.where(land, 0.0, 3e-3) + x[:, None] ** 2
    return fake(x=x, y=y, spacing=side, inside=inside, land=land, clearance=clearance, whole=None)


def test_fields_on_the_sole_as_it_was_designed(file_regression):
    made = DesignedSole(SMALL, fine_map())
    whole = DesignedSole(SMALL, fake(whole=fine_map(side=1.5e-3)))
    without = {n: v for n, v in SMALL.data_vars.items() if n not in ("pressed_height", "cell_area")}
    plain = DesignedSole(type(SMALL)(without, SMALL.coords), fine_map())
    told = scene_lines(
        {
            "drawn": made.drawn,
            "fields": {q.name: made.field(q.name) for q in quantities([SMALL])},
            "whole": [whole.drawn, whole.field("fluid_pressure")],
            "plain": [plain.drawn.pressed, plain.field("contact_pressure")],
        }
    )  # fmt: skip
    held(file_regression, told)


def light_lines(light):
    corners = light.points[light.triangles]
    return {
        "counts": [len(light.points), len(light.triangles), light.below],
        "area": light.area.sum(), "middle": light.points.mean(axis=0),
        "box": [light.points.min(axis=0), light.points.max(axis=0)],
        "longest": np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(),
        "down": np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).sum(axis=0),
        "fields": {name: [each.max(), each @ light.area, each.mean()]
                   for name, each in light.fields.items()},
    }  # fmt: skip


def test_few_triangles_with_fields(file_regression):
    made = drawn_sole(SHORT)
    surface = surface_mesh(made.x, made.y, made.height, made.land)
    values = {q.name: SHORT[q.name].values.astype(float) for q in quantities([SHORT])}
    told = {str(pressed): light_lines(light_mesh(surface, made, values, pressed=pressed))
            for pressed in (False, True)}  # fmt: skip
    told["unloaded"] = light_lines(
        light_mesh(surface, made, {"film_thickness": values["clearance"]})
    )
    whole = fake(x=np.array([0, 0.3]), y=np.array([0, 0.1]))
    told["spacing"] = [
        spacing_for(one, designed=designed) for one in (made, whole) for designed in (True, False)
    ]
    assert spacing_for(whole) == spacing_for(whole, designed=True)
    held(file_regression, scene_lines(told))


def result_of(data, **more) -> Any:
    return fake(name="A sole <1>", data=data, case_text="name = 'x'\nnothing", **more)


def positions(values=(100.0, 120.0), described=111.0):
    return SHORT.assign({"position_fluid_load": (("position",), np.array(values),
                                                 {"as_described": described})})  # fmt: skip


def glb_json(path):
    data = path.read_bytes()
    size = int.from_bytes(data[12:16], "little")
    return json.loads(data[20 : 20 + size])


@pytest.mark.parametrize("kind", WRITERS)
def test_files_of_other_programs(file_regression, tmp_path, kind):
    told = {}
    for name, data, options in (
        ("plain", SHORT, {}),
        ("pressed", positions(), {"field": "film_thickness", "pressed": True}),
    ):
        path = tmp_path / f"{name}.{kind}"
        written = export_result(result_of(data), path, **options)
        sentence = written.sentence().replace(str(path), "FILE")
        told[name] = [sentence, written.length_unit, written.axes, written.coloured_by]
        if kind == "glb":
            shown = glb_json(path)
            (mesh,) = shown["meshes"]
            told[name] += [shown["materials"], mesh["extras"], sorted(shown["accessors"][0]),
                           [each.get("count") for each in shown["accessors"]],
                           [each.get("max") for each in shown["accessors"]]]  # fmt: skip
        elif kind == "csv":
            head, *rows = path.read_text().splitlines()
            told[name] += [head, np.array([row.split(",") for row in rows], float).sum(axis=0)]
            told[name] = scene_lines(told[name])
        elif kind == "ply":
            head, _, body = path.read_bytes().partition(b"end_header\n")
            told[name] += [head.decode(), len(body), sum(body[::7])]
        elif kind == "vtu":
            text = path.read_bytes()
            told[name] += [
                text.count(b"\n"),
                text[:420].partition(b"<UnstructuredGrid")[0].decode(),
            ]
        else:
            lines = path.read_text().splitlines()
            told[name] += [lines[:3], len(lines), lines[-1]]
    held(file_regression, told, hide=r"meshio v[\d.]+|trimesh\S*")


def test_cells_in_a_vtu(file_regression, tmp_path):
    import meshio

    export_result(result_of(SMALL), tmp_path / "sole.vtu")
    read = meshio.read(tmp_path / "sole.vtu")
    fields = {name: [np.isnan(each[0]).sum(), np.nansum(each[0])] for name, each in
              read.cell_data.items()}  # fmt: skip
    held(file_regression, scene_lines({"points": read.points.sum(axis=0), "fields": fields}))


def test_exports_that_are_refused(file_regression, tmp_path):
    empty = type(SMALL)()
    flat = type(SMALL)({n: v for n, v in SMALL.data_vars.items() if n != "pressed_height"},
                       SMALL.coords)  # fmt: skip
    held(
        file_regression,
        [
            refusal(export_result, result_of(SMALL), tmp_path / "a.stl"),
            refusal(export_result, result_of(SMALL), tmp_path / "a"),
            refusal(export_result, result_of(empty), tmp_path / "a.csv"),
            refusal(export_result, result_of(SMALL), tmp_path / "a.csv", field="pressure"),
            refusal(export_result, result_of(flat), tmp_path / "a.csv", pressed=True),
            export_result(result_of(positions((100.0,))), tmp_path / "A.CSV").remark,
        ],
    )


def test_lines_of_a_solver(file_regression):
    """A cell loads the triangle around its middle; one beside all triangles the nearest corner."""
    corners = np.array([(0, 0, 0), (4, 0, 0), (0, 4, 1), (4, 4, 0), (2, 2, 3), (5, 5, 3.0)])
    nodes, prisms, land = with_middle_nodes(
        corners, np.array([[0, 1, 2, 4, 3, 5]]), np.array([[0, 1, 2], [1, 3, 2]])
    )
    load = np.zeros((6, 5))
    load[1, 1], load[3, 2], load[5, 4], load[0, 0] = 5.0, 7.0, 2.0, -1.0
    x, y = np.arange(6.0), np.arange(5.0) + 0.2
    forces = forces_on_nodes(nodes, land, x, y, load)
    assert forces.sum() == pytest.approx(14.0)
    held(
        file_regression,
        {
            "nodes": nodes, "prisms": prisms, "land": land, "forces": forces,
            "inside alone": forces_on_nodes(nodes, land, x[:4], y[:3], load[:4, :3]),
            "rows": list(_rows(np.arange(1, 3), nodes[:2] / 3)),
            "wrapped": _wrap_numbers(list(range(35))),
            "runs": _runs(np.array([[0, 1, 1, 0], [1, 0, 0, 1]], bool)),
        },
    )  # fmt: skip


def with_past(axis):
    frames = np.arange(1.0, 4)[:, None, None] * SMALL["contact_pressure"].values
    return SMALL.assign(
        {
            "contact_pressure_history": ((axis, "x", "y"), frames, {"units": "Pa"}),
            axis: (axis, np.array([0.0, 0.0123, 0.2])),
            **{f"lug_{name}": ("lug", np.array([0.01 * k, np.nan]))
               for k, name in enumerate(("x", "y", "groove", "groove_side"))},
        }
    )  # fmt: skip


def test_scenes(file_regression):
    from underfoot.compute.histories import MARCH

    march = with_past(MARCH)
    scenes = {
        "one": viewer_scene([result_of(march)]),
        "two": viewer_scene([result_of(march), result_of(with_past("instant"))]),
        "part": viewer_scene([result_of(whole_and_part())]),
    }
    told: dict[str, Any] = {name: scene_lines(made) for name, made in scenes.items()}
    del told["two"]["panes"][0]["surface"], told["part"]["panes"][0]["surface"]
    told["html"] = {
        str(count): scene_section(scenes["one"] | {"panes": scenes["one"]["panes"] * count})
        for count in (1, 2, 5)
    }
    held(
        file_regression,
        told,
        hide=r'"data": "[^"]*"|"(?:viridis|RdBu_r|cividis|YlGnBu_r)": "[^"]*"',
    )


def worn(depth):
    wear = {"wear": WearPlane(depth=depth, angle=math.radians(5))} if depth else {}
    return Heel(length=0.03, width=0.024, rear_radius=0.01, outsole_thickness=0.02,
                tread=Tread("bars", 6e-3, 3e-3, 2e-3), **wear)  # fmt: skip


def outcome(cof):
    scalars = {"cof": SourcedValue(cof, uncertainty=0.01)}
    return CaseOutcome("Heel", "hash", scalars, {}, Status.CONVERGED, "", (), (), 1.0)


@pytest.mark.parametrize("maps", [False, True])
def test_a_scene_of_wear(file_regression, maps):
    soles = [worn(depth) for depth in (0.0, 0.4e-3)]
    points = tuple(WearPoint(wear_measures(one), outcome(cof)) for one, cof in
                   zip(soles, (0.2, math.nan), strict=True))  # fmt: skip
    shown = tuple(heel_surface(one, spacing=1e-3 if maps else 0.6e-3) for one in soles)
    bare = heel_surface(Heel(length=0.03, width=0.024, rear_radius=0.01, outsole_thickness=0.02),
                        spacing=1e-3)  # fmt: skip
    more: dict[str, Any] = {}
    if maps:
        pressure = [np.where(one.land, 1e5 * k, 50.0) for k, one in enumerate((*shown, bare))]
        more = {"untreaded": outcome(0.1), "soles": (*shown, bare),
                "maps": [{"contact_pressure": each, "fluid_pressure": 0.1 * each + 99}
                         for each in pressure]}  # fmt: skip
    series = WearSeries("heel", "plane", 5.0, points, {}, (), **{"soles": shown} | more)
    held(file_regression, scene_lines(wear_scene(series)))
