"""Results for other programs: the sole with its fields as GLB, PLY, OBJ, VTU or CSV."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from underfoot.compute.sole import file_outsole
from underfoot.core import DataError, InputError, UnderfootError, unknown_name
from underfoot.core.fields import Fields
from underfoot.core.optional import optional_module
from underfoot.core.presentation import quantity_text
from underfoot.core.remark import Message

from .designed_sole import DesignedSole
from .drawn_sole import DrawnSole, drawn_sole
from .light_mesh import light_mesh, spacing_for
from .quantities import AREAS, DrawnQuantity, quantities, raw, scale, shown_values
from .results import designed_surface
from .sole_mesh import UndersideMesh, sole_mesh
from .surface_mesh import DRAWN, TOLERANCE, SurfaceMesh, surface_mesh

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.compute.result import Result

RUBBER = (148, 152, 156, 255)
"""Colour of what carries none of the field, as on the pages."""
AREA = "area"
"""The area of a face seen from below: a pressure times it, summed, is the load."""
WORK = "Writing a sole for other programs"


@dataclass(frozen=True, slots=True)
class Exported:
    """What was written: the file, its unit of length, its axes, and what its fields are in."""

    path: Path
    length_unit: str
    axes: str
    coloured_by: str
    fields: dict[str, str]
    remark: str = ""

    def sentence(self) -> str:
        """Return what was written in one sentence."""
        fields = ", ".join(f"{name} ({unit})" for name, unit in self.fields.items())
        colours = f"; colours: {self.coloured_by}" if self.coloured_by else ""
        told = f"; {self.remark}" if self.remark else ""
        lengths = Message(
            "lengths in {length_unit}, {axes}", length_unit=self.length_unit, axes=self.axes
        )
        return f"{self.path}: {lengths}; fields: {fields}{colours}{told}"


@dataclass(frozen=True)
class _Scene:
    """A sole with its fields, ready to be written; ``case`` where its own sole can be made."""

    name: str
    sole: DrawnSole
    pressed: bool
    values: dict[str, NDArray[np.float64]]
    units: dict[str, str]
    quantity: DrawnQuantity
    case: Case | None
    remark: str

    @property
    def title(self) -> str:
        """What the colours show."""
        return f"{self.quantity.title}, {self.quantity.unit}"

    @cached_property
    def mesh(self) -> UndersideMesh:
        """A face for every cell."""
        return sole_mesh(self.sole, pressed=self.pressed)

    @cached_property
    def picture(self) -> NDArray[np.uint8]:
        """Colour (RGBA) of every cell, as the page shows the quantity."""
        return _colours(shown_values(self.values[self.quantity.name], self.quantity), self.quantity)

    @property
    def colours(self) -> NDArray[np.uint8]:
        """Colour of every corner of the faces."""
        cells = np.concatenate([self.picture.reshape(-1, 4), [RUBBER]]).astype(np.uint8)
        return np.repeat(cells[self.mesh.cell], 4, axis=0)

    def surface(self) -> tuple[SurfaceMesh, tuple[float, ...]]:
        """Return the sole as few triangles, and within what (m) its lugs are of the drawing.

        A second length is that of slivers which the rim leaves of a lug of a file. Where neither
        crossings nor faces are known, as of a scan, a line passes within ``TOLERANCE`` cells of
        where cells change, half a cell off the drawing; those of a file are the cells of its map.
        """
        sole, case = self.sole, self.case
        if case is None:
            made = surface_mesh(sole.x, sole.y, sole.height, sole.land)
            return made, ((TOLERANCE + 0.5) * sole.spacing,)
        outsole = case.shoe.outsole
        side = spacing_for(sole, designed=outsole is None)
        made = designed_surface(case, side)
        if outsole is None:
            return made, (max(DRAWN, TOLERANCE * side),)
        on_cells = (TOLERANCE + 0.5) * max(side, outsole.map_spacing)
        return made, (DRAWN, on_cells) if len(file_outsole(case).edges) else (on_cells,)

    def of_faces(self, name: str) -> NDArray[np.float64]:
        """Return a field (SI) on the faces, nan on walls and where there is none."""
        values = np.append(self.values[name].ravel(), np.nan)
        return values[self.mesh.cell]

    def of_points(self, name: str) -> NDArray[np.float32]:
        """Return a field (SI) on the corners of the faces; 0 on walls and where there is none.

        A corner has a quarter of its face's area.
        """
        share = 0.25 if name == AREA else 1.0
        return np.repeat(share * np.nan_to_num(self.of_faces(name)), 4).astype(np.float32)


def export_result(
    result: Result, path: Path | str, *, field: str | None = None, pressed: bool = False
) -> Exported:
    """Write the sole of a result with its fields as colours and as values (SI).

    Parameters:
        result: A run with its fields.
        path: Ends with the kind: .glb (m, upright: y up, z forward), .ply or .obj (mm, z up),
            .vtu (m, z up, values on the cells), .csv (one row a cell, all in SI).
        field: What the colours show, by its name in ``result.nc``; by default the first of the
            page. OBJ and PLY carry colours, VTU and CSV values only.
        pressed: The sole as the load presses it, not undeformed.

    Raises:
        DataError: A result without fields, or without the pressed shape.
        InputError: Another kind of file, or a field that the result does not hold.
    """
    path = Path(path)
    write = WRITERS.get(path.suffix.lower().lstrip("."))
    if write is None:
        raise InputError(
            Message('"{suffix}" is no kind of file for a sole with fields', suffix=path.suffix),
            where="--to",
            allowed=", ".join(WRITERS),
        )
    fields = quantities([result.data]) if "x" in result.data.sizes else ()
    if not fields:
        raise DataError(
            "the result has no fields on the sole",
            where=result.name,
            remedy="Run the case again with --out; its folder must hold result.nc",
        )
    chosen = next((each for each in fields if each.name == field), fields[0])
    if field is not None and chosen.name != field:
        raise unknown_name("field", field, [each.name for each in fields], where="--field")
    made = _scene(result, fields, chosen, pressed)
    written = write(made, path)
    return written if written.remark else replace(written, remark=made.remark)


def _scene(
    result: Result, quantities: tuple[DrawnQuantity, ...], chosen: DrawnQuantity, pressed: bool
) -> _Scene:
    dataset = result.data
    sole, values, remark, case = _fields(result, [quantity.name for quantity in quantities])
    if pressed and sole.pressed is None:
        raise DataError(
            "the result does not hold the shape of the pressed sole",
            where=result.name,
            remedy="It was made by an older version: run the case again",
        )
    units = {
        quantity.name: str(dataset[quantity.name].attrs.get("units", "1"))
        for quantity in quantities
    }
    area = np.where(np.isfinite(sole.height), sole.spacing**2, np.nan)
    return _Scene(
        result.name,
        sole,
        pressed,
        values | {AREA: area},
        units | {AREA: "m^2"},
        chosen,
        case,
        "; ".join(filter(None, (remark, _position(dataset)))),
    )


def _position(dataset: Fields) -> str:
    """Return of which position of the tread the fields are; empty where there is one alone."""
    if "position_fluid_load" not in dataset or dataset["position_fluid_load"].values.size < 2:
        return ""
    loads, own = dataset["position_fluid_load"], dataset["position_fluid_load"].attrs
    here, mean = quantity_text(own["as_described"], "N"), quantity_text(loads.values.mean(), "N")
    return Message(
        "the fields are of the sole as the case describes it, one of {size} positions "
        "or angles: {here} on the film there, {mean} in the mean",
        size=loads.values.size,
        here=here,
        mean=mean,
    )


def _fields(
    result: Result, names: list[str]
) -> tuple[DrawnSole, dict[str, NDArray[np.float64]], str, Case | None]:
    """Return the sole, its fields (SI), what there is to tell, and the case that draws the sole.

    The sole as designed; where its file is gone the solver's cells, on which a pressure is the load
    over the area of a whole cell.
    """
    from underfoot.case import Case

    dataset = result.data
    try:
        case = Case.from_text(result.case_text)
        designed = DesignedSole.of_case(dataset, case)
    except UnderfootError as error:
        sole = drawn_sole(dataset)
        kept = {name: raw(dataset, name) for name in names}
        for name in {*AREAS} & {*names}:
            if AREAS[name] in dataset:
                kept[name] = kept[name] * raw(dataset, AREAS[name])
        remark = Message(
            "drawn from the solver's cells, as the sole can't be made: {error}", error=error
        )
        return sole, {name: sole.place_field(field) for name, field in kept.items()}, remark, None
    return designed.drawn, {name: designed.field(name) for name in names}, "", case


def _colours(values: NDArray[np.float64], quantity: DrawnQuantity) -> NDArray[np.uint8]:
    """Return the colour (RGBA) of every value, as the page shows the quantity."""
    import matplotlib

    limits = scale([values.ravel()], quantity)
    if quantity.logarithmic:
        share = np.log(values / limits.low) / np.log(limits.high / limits.low)
    else:
        share = (values - limits.low) / (limits.high - limits.low)
    known = np.isfinite(share)
    table = matplotlib.colormaps[quantity.colours](np.clip(np.nan_to_num(share), 0, 1), bytes=True)
    table[~known] = RUBBER
    return table


def _surface(scene: _Scene, points: NDArray[np.float64]) -> Any:
    trimesh = optional_module("trimesh", "cad", WORK)
    return trimesh.Trimesh(points, scene.mesh.triangles, vertex_colors=scene.colours, process=False)


def _write_glb(scene: _Scene, path: Path) -> Exported:
    """Write few triangles with the colours as a picture on them, fields on their corners."""
    trimesh = optional_module("trimesh", "cad", WORK)
    from PIL import Image

    surface, within = scene.surface()
    sole, values = scene.sole, {name: each for name, each in scene.values.items() if name != AREA}
    light = light_mesh(surface, sole, values, pressed=scene.pressed)
    # a rim of rubber around the cells: walls have its colour
    picture = np.empty((sole.x.size + 2, sole.y.size + 2, 4), np.uint8)
    picture[:] = RUBBER
    picture[1:-1, 1:-1] = scene.picture
    size = np.array(picture.shape[:2])
    place = np.full((len(light.points), 2), 0.5) / size
    ends = light.points[: light.below, :2] - [sole.x[0], sole.y[0]]
    place[: light.below] = (ends / sole.spacing + 1.5) / size
    colours = np.flip(picture.transpose(1, 0, 2), axis=0)
    lengths = [f"{1e3 * each:.2f} mm" for each in within]
    told = Message(
        "edges of lugs within {length}", length=", slivers at the rim within ".join(lengths)
    )
    told = "; ".join(filter(None, (told, scene.remark)))
    material = trimesh.visual.material.PBRMaterial(
        baseColorTexture=Image.fromarray(colours[..., :3]),
        metallicFactor=0.0,
        roughnessFactor=0.9,
        doubleSided=True,
    )
    # glTF: y up, z forward, so x is to the left
    mesh = trimesh.Trimesh(
        light.points[:, [1, 2, 0]],
        light.triangles,
        process=False,
        visual=trimesh.visual.TextureVisuals(uv=place, material=material),
    )
    fields = {f"_{name.upper()}": unit for name, unit in scene.units.items()}
    for name in scene.values:
        values = light.area if name == AREA else light.fields[name]
        mesh.vertex_attributes[f"_{name.upper()}"] = values.astype(np.float32)
    mesh.metadata |= {"units": fields, "colours": scene.title, "remark": told}
    world = trimesh.Scene()
    world.add_geometry(mesh, node_name=scene.name, geom_name=scene.name)
    path.write_bytes(world.export(file_type="glb", include_normals=False))
    return Exported(path, "m", "y up, z forward", scene.title, fields, told)


def _write_ply(scene: _Scene, path: Path) -> Exported:
    surface = _surface(scene, scene.mesh.points * 1e3)
    for name in scene.values:
        surface.vertex_attributes[name] = scene.of_points(name)
    data = surface.export(file_type="ply", include_attributes=True)
    header = ["lengths in mm, z up, x forward", f"colours: {scene.title}"]
    header += [f"remark: {scene.remark}"] if scene.remark else []
    header += [f"{name} in {unit}" for name, unit in scene.units.items()]
    head, _, body = data.partition(b"\n")  # "ply"; the comments follow the line of the format
    kind, _, rest = body.partition(b"\n")
    comments = "".join(f"comment {line}\n" for line in header).encode("ascii", "replace")
    path.write_bytes(head + b"\n" + kind + b"\n" + comments + rest)
    return Exported(path, "mm", "z up, x forward", scene.title, scene.units)


def _write_obj(scene: _Scene, path: Path) -> Exported:
    surface = _surface(scene, scene.mesh.points * 1e3)
    comment = Message(
        "lengths in mm, z up, x forward; colours of the corners: {title}", title=scene.title
    )
    path.write_text(surface.export(file_type="obj", header=comment), encoding="utf-8")
    return Exported(path, "mm", "z up, x forward", scene.title, {})


def _write_vtu(scene: _Scene, path: Path) -> Exported:
    meshio = optional_module("meshio", "paraview", WORK)
    fields = {f"{name} ({scene.units[name]})": [scene.of_faces(name)] for name in scene.values}
    for name in {AREA, *AREAS} & {*scene.values}:  # no nan in what is summed over an area
        fields[f"{name} ({scene.units[name]})"] = [np.nan_to_num(scene.of_faces(name))]
    fields["outside (1)"] = [(scene.mesh.cell >= 0).astype(float)]
    quads = [("quad", scene.mesh.quads)]
    meshio.Mesh(scene.mesh.points, quads, cell_data=fields).write(str(path))
    if scene.remark:
        head, line, rest = path.read_bytes().partition(b"?>\n")
        remark = scene.remark.replace("--", "-").encode("ascii", "replace")
        path.write_bytes(head + line + b"<!-- " + remark + b" -->\n" + rest)
    return Exported(path, "m", "z up, x forward", "", scene.units)


def _write_csv(scene: _Scene, path: Path) -> Exported:
    sole = scene.sole
    known = np.isfinite(sole.height)
    rows, columns = np.nonzero(known)
    table = {"x (m)": sole.x[rows], "y (m)": sole.y[columns], "height (m)": sole.height[known]}
    if sole.pressed is not None:
        table["pressed height (m)"] = sole.pressed[known]
    table["land (1)"] = sole.land[known].astype(float)
    table |= {f"{name} ({scene.units[name]})": each[known] for name, each in scene.values.items()}
    names, values = ",".join(table), np.stack(list(table.values()), axis=1)
    np.savetxt(path, values, fmt="%.7g", delimiter=",", header=names, comments="")
    return Exported(path, "m", "x forward, y to the left", "", scene.units)


WRITERS: dict[str, Callable[[_Scene, Path], Exported]] = {
    "glb": _write_glb,
    "ply": _write_ply,
    "obj": _write_obj,
    "vtu": _write_vtu,
    "csv": _write_csv,
}
"""The function that writes each kind of file."""
