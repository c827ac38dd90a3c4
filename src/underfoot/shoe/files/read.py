"""Triangles from a file, whatever its format; the content decides, not the name."""

import os
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core import Cache, DataError, InputError, content_hash, nearest_match
from underfoot.core.files import checksum
from underfoot.core.optional import optional_module


@dataclass(frozen=True, slots=True)
class Mesh:
    """Triangles as a file holds them.

    Parameters:
        triangles: (n, 3, 3) float32: triangle, corner, coordinate, in the unit of the file.
        format: "STL (binary)", "STL (text)", "STEP", "OBJ" or "PLY".
        unit: Length of the file's unit in m, None when the format does not say.
        remarks: Remarks of the reader, sentences.
    """

    triangles: NDArray[np.float32]
    format: str
    unit: float | None = None
    remarks: tuple[str, ...] = ()


_HEADER, _RECORD = 84, 50
_FACET = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("extra", "<u2")])
_NUMBER = rb"[-+0-9.eE]+|[-+]?(?:nan|inf)[a-z]*"
_CORNER = re.compile(
    rb"vertex\s+(" + _NUMBER + rb")\s+(" + _NUMBER + rb")\s+(" + _NUMBER + rb")", re.IGNORECASE
)


def looks_like_stl(head: bytes, path: Path) -> bool:
    """Return whether a file is an STL: text with facets, or a size that fits its face count."""
    if head.lstrip()[:5].lower() == b"solid" and b"facet" in head.lower():
        return True
    if head.lstrip()[:5].lower() == b"solid" and b"endsolid" in head.lower():
        return True
    if len(head) < _HEADER:
        return False
    promised = int.from_bytes(head[80:84], "little")
    size = path.stat().st_size
    if size == _HEADER + _RECORD * promised:
        return True
    # a truncated or padded one: binary content under a name that promises STL
    binary = b"\0" in head[:_HEADER] or b"\0" in head[_HEADER : _HEADER + _RECORD]
    return binary and path.suffix.lower() == ".stl"


def read_stl(path: Path) -> Mesh:
    """Return the triangles of an STL file.

    Raises:
        DataError: Truncated, or a text STL whose corners don't make triangles.
    """
    size = path.stat().st_size
    with path.open("rb") as stream:
        head = stream.read(_HEADER)
    promised = int.from_bytes(head[80:84], "little") if len(head) == _HEADER else -1
    if promised >= 0 and size == _HEADER + _RECORD * promised:
        return Mesh(_binary(path, promised), "STL (binary)")
    if head.lstrip()[:5].lower() == b"solid":
        return _text(path)
    whole = (size - _HEADER) // _RECORD
    if promised > whole:
        raise DataError(
            f"the file is cut short: it promises {promised} faces and holds {max(whole, 0)}",
            where=str(path),
            remedy="Export or copy it again",
        )
    spare = size - _HEADER - _RECORD * promised
    remark = f"{spare} bytes after the last of {promised} faces were left aside."
    return Mesh(_binary(path, promised), "STL (binary)", remarks=(remark,))


def _binary(path: Path, count: int) -> NDArray[np.float32]:
    records = np.fromfile(path, dtype=_FACET, count=count, offset=_HEADER)
    return np.ascontiguousarray(records["corners"], dtype=np.float32)


def _text(path: Path) -> Mesh:
    data = path.read_bytes()
    corners = _CORNER.findall(data)
    mentioned = len(re.findall(rb"\bvertex\b", data, re.IGNORECASE))
    facets = len(re.findall(rb"\bendfacet\b", data, re.IGNORECASE))
    if mentioned != len(corners) or len(corners) != 3 * facets:
        line = _first_bad_line(data)
        raise DataError(
            f"{facets} facets have {len(corners)} readable corners instead of {3 * facets}"
            + (f"; the first line that cannot be read is {line}" if line else ""),
            where=str(path),
            remedy="The text is cut short or damaged: export the outsole again, as binary STL",
        )
    try:
        numbers = np.array(corners, dtype="S").astype(np.float32)
    except ValueError as error:
        raise DataError(f"a corner is no number ({error})", where=str(path)) from error
    ended = re.search(rb"\bendsolid\b", data[-400:], re.IGNORECASE) is not None
    remark = "The text has no end mark (endsolid): it may be cut short."
    return Mesh(numbers.reshape(-1, 3, 3), "STL (text)", remarks=() if ended else (remark,))


def _first_bad_line(data: bytes) -> str:
    for number, line in enumerate(data.splitlines(), start=1):
        if line.strip().lower().startswith(b"vertex") and not _CORNER.search(line):
            return f"{number}: {line.strip()[:60].decode('ascii', errors='replace')}"
    return ""


LONGEST_SIDE = 3.0
"""Of a triangle on a STEP surface, mm."""
SHORTEST_SIDE = 0.4
"""Wanted on rounded edges, mm."""
SIDES_PER_RADIUS = 5.0
"""A chord leaves a circle of radius R by R / 200 at most."""
_MILLIMETRE = 1e-3
_LOST_SHARE = 2e-3  # of the area: less is the chords' own


def read_step(path: Path) -> Mesh:
    """Return triangles on the surfaces of a STEP file, in mm (its own unit is converted).

    Sides are at most 3 mm and at most a fifth of the radius of curvature, but 0.4 mm need not be
    undercut: a chord is within 0.04 mm of a radius of 28 mm. The triangles are kept in the cache.

    Raises:
        DataError: No STEP geometry, no surfaces, or surfaces that cannot be turned into triangles.
    """
    cache = Cache("outsole_step-1")
    key = content_hash(checksum(path), [LONGEST_SIDE, SHORTEST_SIDE, SIDES_PER_RADIUS])
    stored = cache.load(key)
    if stored is None:
        triangles, remarks = _meshed(path)
        stored = {"triangles": triangles, "remarks": np.array(remarks, dtype=np.str_)}
        cache.store(key, stored)
    remarks = tuple(str(line) for line in stored["remarks"])
    return Mesh(stored["triangles"], "STEP", _MILLIMETRE, remarks)


def _meshed(path: Path) -> tuple[NDArray[np.float32], list[str]]:
    occ = optional_module("netgen.occ", "cad", "Reading STEP")
    meshing = optional_module("netgen.meshing", "cad", "Reading STEP")
    with _quiet(meshing.SetMessageImportance):
        try:
            geometry = occ.OCCGeometry(str(path))
        except Exception as error:  # netgen raises one class of its own for everything
            raise DataError(
                "the STEP file cannot be read: no geometry in it, or it is cut short or damaged",
                where=str(path),
                remedy="Export the outsole again as STEP AP214 or AP242",
            ) from error
        shape = geometry.shape
        faces, solids = list(shape.faces), list(shape.solids)
        if not faces:
            raise DataError(
                "the STEP file holds no surfaces (only curves, points or nothing)",
                where=str(path),
                remedy="Export the outsole as a solid",
            )
        exact = float(sum(face.mass for face in faces))
        try:
            mesh = geometry.GenerateMesh(
                maxh=LONGEST_SIDE,
                minh=SHORTEST_SIDE,
                curvaturesafety=SIDES_PER_RADIUS,
                perfstepsend=meshing.MeshingStep.MESHSURFACE,
                optsteps2d=1,
            )
            triangles = _corners(mesh)
        except Exception:
            triangles = np.zeros((0, 3, 3), np.float32)
        meshed = _area(triangles)
        remarks = [_inventory(len(solids), len(faces))]
        if meshed < (1 - _LOST_SHARE) * exact:
            drawn = _drawing_triangles(shape)
            lost = 1 - max(meshed, _area(drawn)) / exact
            if _area(drawn) > meshed:
                triangles = drawn
                remarks.append(
                    "Some of its surfaces could not be meshed finely; the coarser triangles for "
                    "drawing were taken: roundings may be off by tenths of a millimetre."
                )
            if lost > _LOST_SHARE:
                remarks.append(f"{lost:.1%} of the area of its surfaces could not be meshed.")
    if triangles.shape[0] == 0:
        raise DataError(
            "the surfaces of the STEP file could not be turned into triangles",
            where=str(path),
            remedy="Export the outsole as STL from the design software",
        )
    return triangles, remarks


def _inventory(solids: int, faces: int) -> str:
    surfaces = f"{faces} surface" + ("s" if faces != 1 else "")
    if solids == 0:
        return (
            f"The STEP file holds {surfaces} and no solid; a height map needs no solid, so the "
            "surfaces were taken as they are."
        )
    return f"The STEP file holds {solids} solid" + ("s" if solids > 1 else "") + f", {surfaces}."


def _corners(mesh: Any) -> NDArray[np.float32]:
    points = np.asarray(mesh.Coordinates(), dtype=np.float64)
    nodes = np.asarray(mesh.Elements2D().NumPy()["nodes"], dtype=np.int64)[:, :3] - 1
    return np.ascontiguousarray(points[nodes], dtype=np.float32)


def _drawing_triangles(shape: Any) -> NDArray[np.float32]:
    """Return the triangles that OCC makes for drawing: coarse, but of every surface it can draw."""
    data = shape._webgui_data()["Bezier_trig_points"]
    corners = [np.asarray(data[n], dtype=np.float32).reshape(-1, 4)[:, :3] for n in range(3)]
    return np.ascontiguousarray(np.stack(corners, axis=1))


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


SUFFIXES = {
    ".stl": "STL",
    ".step": "STEP",
    ".stp": "STEP",
    ".obj": "OBJ",
    ".ply": "PLY",
}
"""Endings of file names and the format they promise."""


def read_mesh(path: Path | str) -> Mesh:
    """Return the triangles of an STL, STEP, OBJ or PLY file.

    Raises:
        InputError: No such file, or an ending that is none of these.
        DataError: Empty, truncated or corrupt; not what its name promises; no faces.
    """
    path = Path(path)
    head = _head(path)
    optional_module("numba", "cad", "Reading a sole from a file")
    promised = SUFFIXES.get(path.suffix.lower())
    content = _format_of(head, path)
    if content is None and promised is None:
        raise InputError(
            f'a file named "{path.name}" is not read',
            where=str(path),
            allowed="STEP (.step, .stp), STL, OBJ, PLY",
            remedy="Export the outsole as STEP, or a scan as STL",
        )
    if content is None:
        raise DataError(
            f"the file is named {path.suffix} but holds no {promised}: it begins with "
            f"{_first_characters(head)}",
            where=str(path),
            remedy="Export the outsole again as STL or STEP",
        )
    mesh = _READERS[content](path)
    if mesh.triangles.shape[0] == 0:
        raise DataError("the file holds no faces", where=str(path))
    if content != promised:
        ending = path.suffix or "no ending"
        remark = f"The file is named {ending} but holds {content}; it was read as {content}."
        mesh = replace(mesh, remarks=(remark, *mesh.remarks))
    return mesh


def _head(path: Path) -> bytes:
    if path.is_dir():
        raise InputError(f"{path} is a folder", where=str(path), allowed="a file")
    try:
        with path.open("rb") as stream:
            head = stream.read(4096)
    except FileNotFoundError as error:
        near = [other.name for other in path.parent.glob("*")] if path.parent.is_dir() else []
        raise InputError(
            f"there is no file {path}", where=str(path), nearest=nearest_match(path.name, near)
        ) from error
    except OSError as error:
        raise DataError(f"the file cannot be read ({error.strerror})", where=str(path)) from error
    if not head:
        raise DataError("the file is empty", where=str(path), remedy="Export or copy it again")
    return head


def _format_of(head: bytes, path: Path) -> str | None:
    start = head.lstrip()
    if start.startswith(b"ISO-10303-21"):
        return "STEP"
    if start.startswith((b"ply\n", b"ply\r")):
        return "PLY"
    if looks_like_stl(head, path):
        return "STL"
    lines = [line.split(None, 1)[0] for line in head.splitlines() if line.strip()]
    known = {b"v", b"vn", b"vt", b"f", b"o", b"g", b"s", b"mtllib", b"usemtl", b"#"}
    corners = re.search(rb"^v\s+[-+.\d]+\s+[-+.\d]+", head, re.MULTILINE)
    if corners and all(word in known or word.startswith(b"#") for word in lines[:-1]):
        return "OBJ"
    return None


def _first_characters(head: bytes) -> str:
    text = head[:40].split(b"\n")[0].decode("ascii", errors="replace")
    return f'"{text}"' if text.isprintable() else f"bytes {head[:8].hex(' ')}"


def _obj_or_ply(path: Path) -> Mesh:
    """Return the triangles of an OBJ or PLY file; polygons come as triangles.

    Raises:
        DataError: Damaged, or points without faces.
    """
    trimesh = optional_module("trimesh", "cad", "Reading OBJ and PLY")
    with path.open("rb") as stream:
        kind = "PLY" if stream.read(16).lstrip().startswith(b"ply") else "OBJ"
        stream.seek(0)
        try:
            geometry = trimesh.load(stream, file_type=kind.lower(), process=False, force="mesh")
        except Exception as error:  # trimesh raises whatever its parser meets
            raise DataError(
                f"the {kind} file cannot be read ({type(error).__name__}: {error})",
                where=str(path),
                remedy="It may be cut short or damaged: export the outsole again",
            ) from error
    vertices = np.asarray(getattr(geometry, "vertices", np.zeros((0, 3))), dtype=np.float32)
    faces = np.asarray(getattr(geometry, "faces", np.zeros((0, 3))), dtype=np.int64).reshape(-1, 3)
    if faces.shape[0] == 0:
        content = _points_alone(path, kind)
        raise DataError(
            f"the {kind} file holds {content}",
            where=str(path),
            remedy="Mesh the scan in the scanner's software and export it as STL or PLY",
        )
    if faces.min() < 0 or faces.max() >= vertices.shape[0]:
        raise DataError(
            f"a face names corner {faces.max()} of {vertices.shape[0]}",
            where=str(path),
            remedy="It may be cut short or damaged: export the outsole again",
        )
    return Mesh(np.ascontiguousarray(vertices[faces]), kind)


def _points_alone(path: Path, kind: str) -> str:
    """Return how many points a file without faces holds, in words."""
    if kind == "PLY":
        head = path.read_bytes()[:4096].split(b"end_header")[0]
        count_line = re.search(rb"element vertex (\d+)", head)
        count = int(count_line[1]) if count_line else 0
    else:
        count = len(re.findall(rb"^v\s", path.read_bytes(), re.MULTILINE))
    return f"{count} points and no faces" if count else "no faces"


_READERS = {"STL": read_stl, "STEP": read_step, "OBJ": _obj_or_ply, "PLY": _obj_or_ply}
