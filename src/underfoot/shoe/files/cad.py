"""STEP, IGES and BREP: surfaces that OCC reads and Netgen turns into triangles."""

import json
import os
import pickle
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core import Cache, DataError, InputError, content_hash
from underfoot.core.files import checksum
from underfoot.core.optional import optional_module
from underfoot.core.remark import Message, from_stored, stored_form

from .mesh import Mesh
from .settings import length_unit

LONGEST_SIDE = 3.0
"""Of a triangle on a surface, mm."""
SHORTEST_SIDE = 0.4
"""Wanted on rounded edges, mm."""
SIDES_PER_RADIUS = 5.0
"""A chord leaves a circle of radius R by R / 200 at most."""
LONGEST_MESHING = 300
"""Of one file, s."""
_MILLIMETRE = 1e-3
_LOST_SHARE = 2e-3  # of the area: less is the chords' own
_PREFIXES = {
    b"$": 1.0,
    b".MILLI.": 1e-3,
    b".CENTI.": 1e-2,
    b".DECI.": 0.1,
    b".MICRO.": 1e-6,
    b".KILO.": 1e3,
}
_IGES_UNITS = {1: 0.0254, 2: 1e-3, 4: 0.3048, 6: 1.0, 10: 1e-2}
_ENDINGS = {"STEP": ".step", "IGES": ".iges", "BREP": ".brep"}


def read_cad(path: Path, kind: str, unit: str = "auto") -> Mesh:
    """Return triangles on the surfaces of a STEP, IGES or BREP file.

    Sides are at most 3 mm and at most a fifth of the radius of curvature, but 0.4 mm need not be
    undercut: a chord is within 0.04 mm of a radius of 28 mm. The length is looked at before any
    triangle is made. The triangles are kept in the cache.

    Parameters:
        path: The file; its ending means nothing.
        kind: "STEP", "IGES" or "BREP".
        unit: "auto" takes the unit in the file (STEP, IGES); another name takes the file's numbers
            to be in that unit.

    Raises:
        InputError: Too long or too short for a shoe in the unit of the file.
        DataError: No geometry, no surfaces, or surfaces that cannot be turned into triangles.
    """
    cache = Cache("outsole_cad-1")
    settings = [kind, unit, LONGEST_SIDE, SHORTEST_SIDE, SIDES_PER_RADIUS]
    key = content_hash(checksum(path), settings)
    stored = cache.load(key)
    if stored is None:
        mesh = _meshed_apart(path, kind, unit)
        assert mesh.body is not None
        stored = {
            "triangles": mesh.triangles,
            "body": mesh.body,
            "unit": np.array(mesh.unit or np.nan),
            "bodies": np.array(mesh.bodies, dtype=np.str_),
            "remarks": np.array([json.dumps(stored_form(line)) for line in mesh.remarks], np.str_),
        }
        cache.store(key, stored)
    stated = float(stored["unit"])
    return Mesh(
        stored["triangles"],
        kind,
        None if np.isnan(stated) else stated,
        tuple(from_stored(json.loads(str(line))) for line in stored["remarks"]),
        tuple(str(name) for name in stored["bodies"]),
        stored["body"],
    )


def _reading(kind: str) -> Message:
    return Message("Reading {kind}", kind=kind)


def _meshed_apart(path: Path, kind: str, unit: str) -> Mesh:
    """Return what ``mesh_into`` finds in a process of its own: OCC dies on some damaged files.

    Raises:
        InputError, DataError: As ``read_cad``; the process died or took too long.
    """
    optional_module("netgen", "cad", _reading(kind))
    # nothing that it calls is compiled: without Numba it starts in half the time
    call = "import sys; sys.modules['numba'] = None; from underfoot.core.pool import kill_with; "
    call += f"kill_with({os.getpid()}); "  # a reader that is stopped leaves no mesher behind
    call += "from underfoot.shoe.files.cad import mesh_into; mesh_into(*sys.argv[1:])"
    with tempfile.TemporaryDirectory() as folder:
        answer = Path(folder) / "mesh"
        arguments = [sys.executable, "-c", call, str(path), kind, unit, str(answer)]
        try:
            subprocess.run(arguments, timeout=LONGEST_MESHING, capture_output=True, check=False)
        except subprocess.TimeoutExpired:
            what = Message(
                "the {kind} file could not be turned into triangles within {longest} s",
                kind=kind,
                longest=LONGEST_MESHING,
            )
        else:
            if answer.exists():
                mesh = pickle.loads(answer.read_bytes())
                if isinstance(mesh, Exception):
                    raise mesh
                return mesh
            what = Message("the {kind} file ends the reader of CAD files: it is damaged", kind=kind)
    raise DataError(
        what,
        where=str(path),
        remedy="Export the outsole again as STEP AP214 or AP242, or as STL",
    )


def mesh_into(path: str, kind: str, unit: str, answer: str) -> None:
    """Write the triangles of a CAD file, or the error it raises, pickled to the file ``answer``."""
    outcome: Mesh | Exception
    try:
        outcome = _mesh_solid(Path(path), kind, unit)
    except (InputError, DataError) as error:
        outcome = error.with_traceback(None)
        outcome.__cause__ = outcome.__context__ = None
    Path(answer).write_bytes(pickle.dumps(outcome))


def stated_unit(path: Path, kind: str) -> float | None:
    """Return the unit of length that the file states, m; None where it states none.

    STEP: the unit of the first line with LENGTH_UNIT (SI with its prefix, or based on a conversion
    to such a unit). IGES: flag 14 of the global section.
    """
    data = path.read_bytes()
    if kind == "IGES":
        lines = [line[:72] for line in data.splitlines() if line[72:73] == b"G"]
        flag = _iges_field(b"".join(lines), 13)
        return _IGES_UNITS.get(int(flag)) if flag.isdigit() else None
    if kind == "BREP":
        return None
    text = re.sub(rb"\s+", b"", data)
    # a conversion based unit names another line: 25.4 of that line's millimetres
    based = re.search(
        rb"=\((?=[^;]*LENGTH_UNIT\(\))[^;]*CONVERSION_BASED_UNIT\('[^']*',#(\d+)\)[^;]*;", text
    )
    if based:
        factor = re.search(
            rb"#" + based[1] + rb"=[^;]*LENGTH_MEASURE\(([-+.\dEe]+)\),#(\d+)\);", text
        )
        if factor:
            base = re.search(rb"#" + factor[2] + rb"=([^;]*);", text)
            return float(factor[1]) * (_si_length(base[1]) or 1.0) if base else None
    simple = re.search(rb"=\((?=[^;]*LENGTH_UNIT\(\))([^;]*SI_UNIT[^;]*);", text)
    return _si_length(simple[1]) if simple else None


def _iges_field(text: bytes, number: int) -> bytes:
    """Return a field of an IGES section; texts are written as their length, H and characters."""
    place = begin = 0
    for _ in range(number + 1):
        written = re.compile(rb"\s*(\d+)H").match(text, place)
        begin = place
        if written:
            place = written.end() + int(written[1])
        end = re.compile(rb"[,;]").search(text, place)
        if end is None:
            return b""
        place = end.end()
    return text[begin : place - 1].strip()


def _si_length(line: bytes) -> float | None:
    stated = re.search(rb"SI_UNIT\(([^,]*),\.METRE\.\)", line)
    return _PREFIXES.get(stated[1]) if stated else None


def _mesh_solid(path: Path, kind: str, unit: str) -> Mesh:
    occ = optional_module("netgen.occ", "cad", _reading(kind))
    meshing = optional_module("netgen.meshing", "cad", _reading(kind))
    with _quiet(meshing.SetMessageImportance):
        geometry = _geometry(occ, path, kind)
        shape = geometry.shape
        if not list(shape.faces):
            raise DataError(
                Message(
                    "the {kind} file holds no surfaces (only curves, points or nothing)", kind=kind
                ),
                where=str(path),
                remedy="Export the outsole as a solid",
            )
        scale, number = _scale(shape, path, kind, unit)
        names = _names(geometry)
        if scale != 1.0:
            shape = shape.Scale(occ.Pnt(0, 0, 0), scale)
            geometry = occ.OCCGeometry(shape)
        faces, solids = list(shape.faces), list(shape.solids)
        exact = float(sum(face.mass for face in faces))
        owner = {face: number for number, solid in enumerate(solids) for face in solid.faces}
        number_of = np.array([owner.get(face, len(solids)) for face in faces], dtype=np.int32)
        try:
            mesh = geometry.GenerateMesh(
                maxh=LONGEST_SIDE,
                minh=SHORTEST_SIDE,
                curvaturesafety=SIDES_PER_RADIUS,
                perfstepsend=meshing.MeshingStep.MESHSURFACE,
                optsteps2d=1,
            )
            triangles, body = _corners(mesh, number_of)
        except Exception:
            triangles, body = np.zeros((0, 3, 3), np.float32), np.zeros(0, np.int32)
        remarks = [_inventory(kind, len(solids), len(faces))]
        meshed = _area(triangles)
        if meshed < (1 - _LOST_SHARE) * exact:
            drawn, drawn_body = _drawing_triangles(shape, number_of)
            lost = 1 - max(meshed, _area(drawn)) / exact
            if _area(drawn) > meshed:
                triangles, body = drawn, drawn_body
                remarks.append(
                    Message(
                        "Some of its surfaces could not be meshed finely; the coarser "
                        "triangles for drawing were taken: roundings may be off by tenths "
                        "of a millimetre."
                    )
                )
            if lost > _LOST_SHARE:
                remarks.append(
                    Message(
                        "{lost:.1%} of the area of its surfaces could not be meshed.", lost=lost
                    )
                )
    if triangles.shape[0] == 0:
        raise DataError(
            Message(
                "the surfaces of the {kind} file could not be turned into triangles", kind=kind
            ),
            where=str(path),
            remedy="Export the outsole as STL from the design software",
        )
    if number is not None:  # as in the file: its unit is found or chosen like that of an STL
        triangles = triangles / np.float32(number)
    stated = _MILLIMETRE if number is None else None
    return Mesh(triangles, kind, stated, tuple(remarks), (*names, "") if names else (), body)


def _geometry(occ: Any, path: Path, kind: str) -> Any:
    """Return what OCC reads; it goes by the ending, so the file is read under its content's."""
    with tempfile.TemporaryDirectory() as folder:
        known = Path(folder) / f"outsole{_ENDINGS[kind]}"
        try:
            os.symlink(path.resolve(), known)
        except OSError:  # no links on this system
            shutil.copyfile(path, known)
        try:
            return occ.OCCGeometry(str(known))
        except Exception as error:  # netgen raises one class of its own for everything
            raise DataError(
                Message(
                    "the {kind} file cannot be read: no geometry in it, or it is cut short "
                    "or damaged",
                    kind=kind,
                ),
                where=str(path),
                remedy="Export the outsole again as STEP AP214 or AP242",
            ) from error


def _scale(shape: Any, path: Path, kind: str, unit: str) -> tuple[float, float | None]:
    """Return the factor that makes it millimetres and how many mm a number of the file is then.

    The latter is None where the file states the unit and it counts.

    Raises:
        InputError: Its length is no shoe's: nothing of it is meshed.
    """
    low, high = (np.array(tuple(corner)) for corner in shape.bounding_box)
    sides = np.sort(high - low)[::-1]
    stated = stated_unit(path, kind)
    # what OCC gives is millimetres where a unit is stated, else the numbers of the file
    numbers = sides * (_MILLIMETRE / stated if stated else 1.0)
    metres, _ = length_unit(
        float(numbers[0]),
        float(numbers[1]),
        chosen=unit,
        in_file=stated,
        where=str(path),
        longest=LONGEST_SCENE,
    )
    number = metres / _MILLIMETRE
    free = stated is None or unit != "auto"
    return float(numbers[0] / sides[0] * number), number if free else None


LONGEST_SCENE = 2.0
"""Of shoe and floor in one CAD file, m."""


def _names(geometry: Any) -> tuple[str, ...]:
    """Return the name of each solid: its own, else that of the part it is alone in."""
    solids = list(geometry.shape.solids)
    parts: dict[Any, str] = {}
    tree = geometry.GetAssemblyTree() if hasattr(geometry, "GetAssemblyTree") else None
    nodes = [tree] if tree else []
    while nodes:
        node = nodes.pop()
        nodes += list(node.children)
        inside = list(node.shape.solids) if node.shape and not node.is_assembly else []
        if len(inside) == 1:
            parts[inside[0]] = node.name
    return tuple(str(solid.name or parts.get(solid, "")) for solid in solids)


def _inventory(kind: str, solids: int, faces: int) -> Message:
    if solids == 0:
        return Message(
            "The {kind} file holds {faces} {faces:surface|surfaces} and no solid; a height map "
            "needs no solid, so the surfaces were taken as they are.",
            kind=kind,
            faces=faces,
        )
    return Message(
        "The {kind} file holds {solids} {solids:solid|solids}, {faces} {faces:surface|surfaces}.",
        kind=kind,
        solids=solids,
        faces=faces,
    )


def _corners(
    mesh: Any, number_of: NDArray[np.int32]
) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    points = np.asarray(mesh.Coordinates(), dtype=np.float64)
    elements = mesh.Elements2D().NumPy()
    nodes = np.asarray(elements["nodes"], dtype=np.int64)[:, :3] - 1
    faces = np.asarray(elements["index"], dtype=np.int64) - 1
    return np.ascontiguousarray(points[nodes], dtype=np.float32), number_of[faces]


def _drawing_triangles(
    shape: Any, number_of: NDArray[np.int32]
) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Return the triangles that OCC makes for drawing: coarse, but of every surface it can draw."""
    # corners as (x, y, z, number of face); the triangles of one face have no form in Python
    drawn = shape._webgui_data()["Bezier_trig_points"][:3]
    corners = np.stack([np.array(each, dtype=np.float32).reshape(-1, 4) for each in drawn], axis=1)
    face = corners[:, 0, 3].astype(np.int64)
    return np.ascontiguousarray(corners[:, :, :3]), number_of[face]


def _area(triangles: NDArray[np.float32]) -> float:
    sides = triangles[:, 1:] - triangles[:, :1]
    return float(np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum() / 2)


@contextmanager
def _quiet(set_importance: Callable[[int], None]) -> Iterator[None]:
    """Silence what the C++ libraries print: the exceptions carry their own text."""
    sys.stdout.flush()
    standard_output = os.dup(1)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        set_importance(0)
        yield
    finally:
        os.dup2(standard_output, 1)
        os.close(standard_output)
        os.close(nowhere)
