"""The sole as a solid (plan form, profile, lugs, sipes, rounded edges), and as a file for CAD."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError, UnderfootError
from underfoot.core.optional import optional_module
from underfoot.core.remark import Message

from ..grids import plan_outline
from ..shape import SoleShape
from ..tread import LATTICES, ArcChannel
from .modelling import (
    MM,
    Outline,
    arc_edge,
    groove_outlines,
    hollow_outlines,
    kernel,
    lug_outlines,
    outline_wire,
    plate_with_holes,
    raise_face,
    rim_face,
    slit_outlines,
)
from .slab import break_points, slab
from .worn_solid import worn_solid

LEAST_PRINTABLE = 0.3e-3
"""m: walls and slits below this can be neither printed nor moulded (assumed: common nozzles)."""
_TOUCHED = 1e-9  # m^2 of a lug within the plan form: less is a lug beside it
_BELOW = 1e-3  # m under the sole plane where cutting prisms begin


@dataclass(frozen=True, slots=True)
class SoleSolid:
    """A solid of the modelling kernel in mm, with what could not be made as described.

    ``volume`` in m^3; ``lugs`` is the number of lugs that meet the plan form (0 untreaded).
    """

    body: Any
    volume: float
    lugs: int
    remarks: tuple[str, ...] = ()


def sole_solid(shape: SoleShape) -> SoleSolid:
    """Return the sole, worn as it is, as a solid: the same description that ``heel_map`` samples.

    The land is cut from a slab, its rim and its lugs' edges are rounded by fillets; a channel keeps
    its depth straight above the land. Fillets roll along the surface, the map's rounding is
    straight above it: on a bevel of 10 degrees they differ by less than 2 % of the radius. Wear is
    cut from it last (``worn_solid``).

    Raises:
        InputError: A lug, channel or sipe too small to be made; a toe or bevel through the top.
    """
    check_printable(shape)
    remarks: list[str] = []
    body = slab(shape) * raise_face(rim_face(shape.rim_arcs(), -_BELOW), 0.3)
    if shape.edge_radius > 0:
        rim = [i for i, edge in enumerate(body.edges) if _on_lower_rim(edge, shape)]
        body = _round_edges(body, rim, shape.edge_radius, "the lower rim", remarks)
    lower = body
    tread, lugs = shape.tread, []
    if tread is not None and tread.depth > 0:
        lugs = lug_outlines(shape, tread)
        plate = plate_with_holes(lugs, -_BELOW)
        body = body - raise_face(plate, 0.3) * _layer(lower, tread.depth)
        hollows = hollow_outlines(lugs, tread)
        if hollows:
            body = body - _prisms(hollows) * _layer(lower, tread.depth)
        if tread.grooves:
            cuts = groove_outlines(shape, tread.grooves)
            body = body - _prisms(cuts) * _layer(lower, tread.depth)
        edge = tread.edge_radius or tread.edge_chamfer
        if edge > 0:
            edges = [(i, edge) for i, edge in enumerate(body.edges) if _on_lug(edge, shape)]
            whole = _free_lugs(lugs, shape)
            free = [i for i, edge in edges if _belongs(edge, whole)]
            if free:
                flat = tread.edge_chamfer > 0
                body = _round_edges(body, free, edge, "the lugs' edges", remarks, chamfer=flat)
            if len(free) < len(edges):
                remarks.append(
                    f"{len(edges) - len(free)} of {len(edges)} edges of lugs stay sharp: "
                    "they meet the rim, a groove or the end of the bevel"
                )
        if tread.sipes is not None:
            sipes = tread.sipes
            first = sipes.spacing / 2 if sipes.offset is None else sipes.offset
            along, across = tread.offset
            first += along * math.cos(sipes.angle) + across * math.sin(sipes.angle)
            slits = slit_outlines(shape, sipes.width, sipes.spacing, sipes.angle, first)
            body = body - _prisms(slits) * _layer(lower, sipes.depth)
    if shape.arc_channel is not None and shape.arc_channel.depth > 0:
        body = body - _half_ring(shape.arc_channel) * _layer(lower, shape.arc_channel.depth)
    body = worn_solid(body, shape)
    return SoleSolid(body, float(body.mass) / MM**3, _on_sole(lugs, shape), tuple(remarks))


def _on_sole(lugs: Sequence[Outline], shape: SoleShape) -> int:
    """Return how many lugs meet the plan form: bars beyond it count as none."""
    import shapely

    plan = shapely.Polygon(plan_outline(shape))
    areas = [
        shapely.Point(*lug.points[0]).buffer(lug.radius)
        if lug.radius > 0
        else shapely.Polygon(lug.points)
        for lug in lugs
    ]
    return sum(plan.intersection(area).area > _TOUCHED for area in areas)


def check_printable(shape: SoleShape) -> None:
    """Refuse what cannot be made: too fine, or cut through the top."""
    tread = shape.tread
    fine: list[tuple[str, str, float]] = []
    if tread is not None and tread.depth > 0:
        fine += [("tread.lug_width", "a lug", tread.smallest_lug)]
        fine += [("tread.channel_width", "a channel", tread.channel_width)]
        fine += [("tread.grooves", "a groove", groove.width) for groove in tread.grooves]
        if tread.sipes is not None:
            fine += [("sipes.width", "a sipe", tread.sipes.width)]
            left = tread.sipes.spacing - tread.sipes.width
            fine += [("sipes.spacing", "a wall between sipes", left)]
    if shape.arc_channel is not None and shape.arc_channel.depth > 0:
        fine += [("arc_channel.width", "an arc channel", shape.arc_channel.width)]
    for where, name, size in fine:
        if size < LEAST_PRINTABLE:
            raise InputError(
                f"{name} of {size * 1e3:g} mm can be neither printed nor moulded",
                where=where,
                allowed=Message("at least {least:g} mm", least=LEAST_PRINTABLE * 1e3),
            )
    x = np.linspace(0.0, shape.length, 201)
    half = np.full_like(x, shape.width / 2)
    deepest = max([0.0 if tread is None else tread.depth, 0.0])
    crown = 0.0 if shape.crown_radius is None else float(half[0] ** 2 / (2 * shape.crown_radius))
    rear = x < shape.length / 2
    highest = float(shape.profile.height(x[rear]).max()) + crown + deepest
    if highest >= shape.outsole_thickness:
        raise InputError(
            f"bevel, crown and tread together reach {highest * 1e3:.3g} mm, through the outsole",
            where="heel.outsole_thickness",
            allowed=f"above {highest * 1e3:.3g} mm for this profile",
        )


def _layer(lower: Any, depth: float) -> Any:
    """Return the layer of ``depth`` over the land: the body without itself raised."""
    return lower - lower.Move(depth * MM * kernel().Z)


def _prisms(outlines: Sequence[Outline]) -> Any:
    return kernel().Compound(
        [raise_face(kernel().Face(outline_wire(outline, -_BELOW)), 0.3) for outline in outlines]
    )


def _half_ring(channel: ArcChannel) -> Any:
    x = channel.position + channel.radius
    outer, inner = channel.radius + channel.width / 2, channel.radius - channel.width / 2

    def half_disc(radius: float) -> Any:
        ends = [kernel().Pnt(x * MM, side * radius * MM, -_BELOW * MM) for side in (-1, 1)]
        return kernel().Face(
            kernel().Wire(
                [arc_edge(x, 0.0, radius, math.pi / 2, -_BELOW), kernel().Segment(ends[0], ends[1])]
            )
        )

    return raise_face(half_disc(outer), 0.3) - raise_face(half_disc(inner), 0.3)


def _round_edges(
    body: Any,
    edges: list[int],
    radius: float,
    name: str,
    remarks: list[str],
    *,
    chamfer: bool = False,
) -> Any:
    """Return the body with fillets; where the kernel cannot make them the edges stay sharp."""
    from .rounding import round_edges  # also run as a program of its own

    filleted = round_edges(body, edges, radius, chamfer=chamfer)
    if filleted is None:
        remarks.append(
            Message(
                "left sharp: {name}, {radius:g} mm cannot be rolled along all of it",
                name=name,
                radius=radius * 1000.0,
            )
        )
        return body
    return filleted


def _on_lower_rim(edge: Any, shape: SoleShape) -> bool:
    """Whether an edge joins the land and the side wall of the plan form."""
    ends = np.array([[v.p[0], v.p[1], v.p[2]] for v in edge.vertices]) / MM
    x, y, z = ends.T
    land = shape.profile.height(x)
    if shape.crown_radius is not None:
        land = land + y**2 / (2 * shape.crown_radius)
    if np.abs(z - land).max() > 1e-6 or np.abs(shape.inward_distance(x, y)).max() > 1e-6:
        return False
    middle = np.array([edge.center.x, edge.center.y]) / MM
    across = len(x) == 2 and abs(x[0] - x[1]) < 1e-7
    inner = abs(float(shape.inward_distance(middle[:1], middle[1:])[0])) > 1e-5
    return not (across and inner)


def _on_lug(edge: Any, shape: SoleShape) -> bool:
    """Whether an edge joins the land of a lug and a wall of a channel, clear of the rim."""
    tread = shape.tread
    assert tread is not None
    ends = np.array([[v.p[0], v.p[1], v.p[2]] for v in edge.vertices]) / MM
    x, y, z = ends.T
    if np.abs(z - shape.unworn_height(x, y)).max() > 1e-5:
        return False
    if np.abs(tread.channel_distance(x, y)).max() > 1e-6:
        return False
    middle = np.array([edge.center.x, edge.center.y]) / MM
    off = float(np.abs(tread.channel_distance(middle[:1], middle[1:]))[0])
    return off < 1e-6 or tread.pattern in LATTICES


def _free_lugs(lugs: Sequence[Outline], shape: SoleShape) -> list[Outline]:
    """Return the lugs that keep clear of rounded rim, grooves and kinks of the profile.

    The kernel cannot roll a fillet over those.
    """
    assert shape.tread is not None
    clear = shape.edge_radius + 2 * (shape.tread.edge_radius or shape.tread.edge_chamfer)
    kinks = np.array(break_points(shape)[1:-1])
    fitting = []
    for lug in lugs:
        low, high = lug.points.min(axis=0) - lug.radius, lug.points.max(axis=0) + lug.radius
        around = np.array([[low[0], low[1]], [high[0], low[1]], [low[0], high[1]], high])
        if shape.inward_distance(around[:, 0], around[:, 1]).min() < clear:
            continue
        (x, y), reach = (low + high) / 2, math.hypot(*(high - low)) / 2 + clear
        if any(groove.channel_distance(x, y) > -reach for groove in shape.tread.grooves):
            continue
        if ((kinks > low[0] - clear) & (kinks < high[0] + clear)).any():
            continue
        fitting.append(lug)
    return fitting


def _belongs(edge: Any, lugs: Sequence[Outline]) -> bool:
    """Whether an edge lies on one of these lugs."""
    ends = np.array([[v.p[0], v.p[1]] for v in edge.vertices]) / MM
    for lug in lugs:
        low, high = lug.points.min(axis=0) - lug.radius, lug.points.max(axis=0) + lug.radius
        if (ends > low - 1e-6).all() and (ends < high + 1e-6).all():
            return True
    return False


WRITING = "Writing the solid of a sole"
KINDS = (".step", ".stp", ".stl", ".obj", ".ply")
VOLUME_TOLERANCE = 1e-2
"""Largest relative difference of a mesh's volume from the solid's: flat triangles, round parts."""


@dataclass(frozen=True, slots=True)
class SoleFile:
    """What was written and how it was checked by reading it again.

    ``volume`` (m^3) is that of the solid, ``read_volume`` that of the file; ``triangles`` is 0 for
    STEP. Files are in mm.
    """

    path: Path
    volume: float
    read_volume: float
    triangles: int
    lugs: int
    remarks: tuple[str, ...]


def write_sole(shape: SoleShape, path: Path | str, *, solid: SoleSolid | None = None) -> SoleFile:
    """Write the sole as STEP, STL, OBJ or PLY in mm and read it back.

    Parameters:
        shape: The sole in metres.
        path: Ends with the kind of file.
        solid: Of the same shape, where it was made already.

    Raises:
        InputError: Another kind of file; a sole that cannot be made.
        UnderfootError: The file read back is not the solid: not watertight, or of another volume.
    """
    path = Path(path)
    kind = path.suffix.lower()
    if kind not in KINDS:
        raise InputError(
            f'"{path.suffix}" is no kind of file for a sole',
            where="--out",
            allowed=", ".join(KINDS),
        )
    made = solid or sole_solid(shape)
    draft = path.with_name(f"{path.stem}.draft{kind}")
    try:
        volume, triangles = _write_draft(made, draft, path)
        draft.replace(path)
    finally:
        draft.unlink(missing_ok=True)
    return SoleFile(path, made.volume, volume, triangles, made.lugs, made.remarks)


def _write_draft(made: SoleSolid, draft: Path, path: Path) -> tuple[float, int]:
    """Write ``draft`` and return the volume (m^3) and triangles read back from it.

    Raises:
        UnderfootError: What was read back is not the solid, which ``path`` then never holds.
    """
    if draft.suffix in (".step", ".stp"):
        made.body.WriteStep(str(draft))
        volume, triangles, tolerance = float(kernel().OCCGeometry(str(draft)).shape.mass), 0, 1e-6
    else:
        sole_mesh(made).export(str(draft))
        back = _read(draft)
        if not back.is_watertight:
            raise UnderfootError(
                "the mesh of the sole is not watertight",
                where=str(path),
                remedy="Write a STEP file instead.",
            )
        volume, triangles, tolerance = float(back.volume), len(back.faces), VOLUME_TOLERANCE
    volume /= MM**3
    if abs(volume / made.volume - 1) > tolerance:
        raise UnderfootError(
            Message(
                "the file holds {volume:.3f} cm3, the solid {solid:.3f} cm3",
                volume=volume * 1000000.0,
                solid=made.volume * 1000000.0,
            ),
            where=str(path),
        )
    return volume, triangles


def sole_mesh(made: SoleSolid) -> Any:
    """Return the triangles of a solid (``trimesh.Trimesh``, mm), corners joined."""
    trimesh = optional_module("trimesh", "cad", WRITING)

    # the kernel hands its triangles out only for drawing: corners as (x, y, z, number of face)
    drawn = made.body._webgui_data()["Bezier_trig_points"][:3]
    corners = np.stack([np.array(each).reshape(-1, 4)[:, :3] for each in drawn], axis=1)
    corners = corners.reshape(-1, 3)
    # corners of one edge come from both of its faces, equal within the kernel's tolerance
    for decimals in (6, 5, 4, 3):
        joined, index = np.unique(np.round(corners, decimals), axis=0, return_inverse=True)
        faces = np.asarray(index).reshape(-1, 3)
        proper = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
        candidate = trimesh.Trimesh(joined, _without_pairs(faces[proper]), process=False)
        # of a sliver between two walls the kernel may draw nothing
        if candidate.is_watertight or trimesh.repair.fill_holes(candidate, use_fan=True):
            return candidate
    return _mesh_body(made)


def _without_pairs(faces: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return triangles (n, 3) without those that lie back to back: they enclose nothing."""
    _, index, count = np.unique(
        np.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    return faces[count[index.ravel()] == 1]


def _mesh_body(made: SoleSolid) -> Any:
    """Return the surface mesh of the finite-element mesher: slower, but closed on any solid."""
    trimesh = optional_module("trimesh", "cad", WRITING)
    step = optional_module("netgen.meshing", "cad", WRITING).MeshingStep.MESHSURFACE

    mesh = kernel().OCCGeometry(made.body).GenerateMesh(maxh=5.0, perfstepsend=step)
    points = np.array([point.p for point in mesh.Points()])
    faces = np.array([[v.nr - 1 for v in part.vertices] for part in mesh.Elements2D()])
    return trimesh.Trimesh(points, faces, process=False)


def _read(path: Path) -> Any:
    trimesh = optional_module("trimesh", "cad", WRITING)

    return trimesh.load_mesh(str(path))
