"""Triangles from a file, whatever its format; the content decides, not the name."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from underfoot.core import DataError, InputError, nearest_match
from underfoot.core.optional import optional_module

from .mesh import Mesh
from .step import read_step
from .stl import looks_like_stl, read_stl

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
