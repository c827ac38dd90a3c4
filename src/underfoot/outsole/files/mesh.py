"""Triangles from a file, whatever its format; the content decides, not the name."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError, InputError, nearest_match

SUFFIXES = {
    ".stl": "STL",
    ".step": "STEP",
    ".stp": "STEP",
    ".obj": "OBJ",
    ".ply": "PLY",
}
"""Endings of file names and the format they promise."""


@dataclass(frozen=True, slots=True)
class Mesh:
    """Triangles as a file holds them.

    Parameters
    ----------
    triangles
        (n, 3, 3) float32: triangle, corner, coordinate, in the unit of the file.
    format
        "STL (binary)", "STL (text)", "STEP", "OBJ" or "PLY".
    unit
        Length of the file's unit in m, None when the format does not say.
    remarks
        What was noticed while reading, in words.
    """

    triangles: NDArray[np.float32]
    format: str
    unit: float | None = None
    remarks: tuple[str, ...] = ()


def read_mesh(path: Path | str) -> Mesh:
    """Return the triangles of an STL, STEP, OBJ or PLY file.

    Errors
    ------
    InputError
        No such file, or an ending that is none of these.
    DataError
        Empty, truncated or corrupt; not what its name promises; no faces.
    """
    path = Path(path)
    head = _head(path)
    promised = SUFFIXES.get(path.suffix.lower())
    found = _format_of(head, path)
    if found is None and promised is None:
        raise InputError(
            f'a file named "{path.name}" is not read',
            where=str(path),
            allowed="STEP (.step, .stp), STL, OBJ, PLY",
            remedy="Export the outsole as STEP, or a scan as STL",
        )
    if found is None:
        raise DataError(
            f"the file is named {path.suffix} but holds no {promised}: it begins with "
            f"{_shown(head)}",
            where=str(path),
            remedy="Export the outsole again as STL or STEP",
        )
    mesh = _reader(found)(path)
    if mesh.triangles.shape[0] == 0:
        raise DataError("the file holds no faces", where=str(path))
    if found != promised:
        ending = path.suffix or "no ending"
        said = f"The file is named {ending} but holds {found}; it was read as {found}."
        mesh = Mesh(mesh.triangles, mesh.format, mesh.unit, (said, *mesh.remarks))
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
        raise DataError(f"the file can't be read ({error.strerror})", where=str(path)) from error
    if not head:
        raise DataError("the file is empty", where=str(path), remedy="Export or copy it again")
    return head


def _format_of(head: bytes, path: Path) -> str | None:
    from .stl import looks_like_stl

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


def _reader(found: str) -> Callable[[Path], Mesh]:
    if found == "STL":
        from .stl import read_stl

        return read_stl
    if found == "STEP":
        from .step import read_step

        return read_step
    from .trimesh_formats import read_with_trimesh

    return read_with_trimesh


def _shown(head: bytes) -> str:
    text = head[:40].split(b"\n")[0].decode("ascii", errors="replace")
    return f'"{text}"' if text.isprintable() else f"bytes {head[:8].hex(' ')}"
