"""Triangles from a file, whatever its format; the content decides, not the name."""

import json
import re
import zipfile
from codecs import BOM_UTF8, BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from underfoot.core import DataError, InputError
from underfoot.core.errors import missing_file
from underfoot.core.optional import optional_module
from underfoot.core.registry import find_offer
from underfoot.core.remark import Message
from underfoot.core.text import decode_text

from .cad import read_cad
from .gltf import read_gltf
from .mesh import AGAIN, Mesh, MeshFile, assemble_mesh
from .ply import read_ply
from .rhino import read_rhino
from .stl import looks_like_stl, read_stl
from .text_meshes import OBJ_WORDS, read_obj, read_off
from .threemf import read_3mf

SUFFIXES = {
    ".stl": "STL",
    ".step": "STEP",
    ".stp": "STEP",
    ".iges": "IGES",
    ".igs": "IGES",
    ".brep": "BREP",
    ".obj": "OBJ",
    ".ply": "PLY",
    ".off": "OFF",
    ".glb": "GLB",
    ".gltf": "GLTF",
    ".3mf": "3MF",
    ".3dm": "3DM",
}
"""Endings of file names and the format they promise."""
FORMATS = "STEP, IGES, BREP, 3DM, STL, OBJ, PLY, OFF, GLB, GLTF, 3MF"
_MAGIC = {
    b"ISO-10303-21": "STEP",
    b"ply\n": "PLY",
    b"ply\r": "PLY",
    b"glTF": "GLB",
    b"3D Geometry File Format": "3DM",
    b"DBRep_DrawableShape": "BREP",
    b"CASCADE Topology": "BREP",
    b"Open CASCADE Topology": "BREP",
}
_FOREIGN = {
    b"Kaydara FBX": "FBX",
    b"BLENDER": "Blender",
    b"AC10": "DWG",
    b"\xd0\xcf\x11\xe0": "SolidWorks or another program's own",
    b"**ABCDEF": "Parasolid",
    b"%PDF": "PDF",
    b"Rar!": "RAR",
    b"\x1f\x8b": "gzip",
    b"7z\xbc\xaf": "7-Zip",
}
"""Beginnings of files that designers send and that hold no readable geometry."""
_IGES_LINE = re.compile(rb"^.{72}S\s*\d+\s*$")
_OBJ_VERTEX = re.compile(rb"^[ \t]*v([ \t]+[-+.\deE]+){3}", re.MULTILINE)
_OBJ_HEAD = 4_000_000
"""Bytes of an .obj file in which a vertex is looked for: comments and curves may come first."""
_MESHES: dict[str, Callable[[Path], MeshFile]] = {
    "STL": read_stl,
    "OBJ": read_obj,
    "PLY": read_ply,
    "OFF": read_off,
    "GLB": read_gltf,
    "GLTF": read_gltf,
    "3MF": read_3mf,
    "3DM": read_rhino,
}


def read_mesh(path: Path | str, unit: str = "auto") -> Mesh:
    """Return the triangles of a file.

    Parameters:
        path: STEP, IGES, BREP, 3DM, STL, OBJ, PLY, OFF, GLB, GLTF or 3MF.
        unit: Chosen in place of the one that a CAD file states; see ``read_cad``.

    Raises:
        InputError: No such file, no regular file, a format that is not read, a CAD file whose unit
            makes it no shoe.
        DataError: Empty, truncated or corrupt; not what its name promises; no faces.
    """
    path = Path(path)
    head = _head(path)
    if head.startswith((BOM_UTF8, BOM_UTF16_LE, BOM_UTF16_BE)):
        return _of_text(path, unit)
    optional_module("numba", "cad", "Reading a sole from a file")
    ending = path.suffix.lower()
    if ending not in SUFFIXES and (reader := find_offer("outsole_readers", ending[1:])):
        return reader(path)
    promised = SUFFIXES.get(ending)
    content = _format_of(head, path)
    if content is None and promised is None:
        raise InputError(
            Message('a file named "{name}" is not read', name=path.name),
            where=str(path),
            allowed=FORMATS,
            remedy="Export the outsole as STEP, or a scan as STL",
        )
    if content is None:
        raise DataError(
            Message(
                "the file is named {suffix} but holds no {format}: it begins with {beginning}",
                suffix=path.suffix,
                format=promised,
                beginning=_first_characters(head),
            ),
            where=str(path),
            remedy="Export the outsole again as STL or STEP",
        )
    mesh = _read(path, content, unit)
    if mesh.triangles.shape[0] == 0:
        raise DataError("the file holds no faces", where=str(path))
    bad = np.count_nonzero(~np.isfinite(mesh.triangles).all(axis=(1, 2)))
    if bad:
        raise DataError(
            Message("a corner of {bad} faces is no number", bad=bad), where=str(path), remedy=AGAIN
        )
    if content != promised:
        remark = Message(
            "The file is named {ending} but holds {content}; it was read as {content}.",
            ending=path.suffix,
            content=content,
        )
        if not path.suffix:
            remark = Message(
                "The file has no ending and holds {content}; it was read as {content}.",
                content=content,
            )
        mesh = replace(mesh, remarks=(remark, *mesh.remarks))
    return mesh


def _of_text(path: Path, unit: str) -> Mesh:
    """Return the triangles of a text file with a byte-order mark, as shells of Windows write it."""
    text = decode_text(path.read_bytes(), str(path), AGAIN)
    with TemporaryDirectory() as folder:
        plain = Path(folder, path.name)
        plain.write_text(text, encoding="utf-8")
        return read_mesh(plain, unit)


def _read(path: Path, content: str, unit: str) -> Mesh:
    if content in ("STEP", "IGES", "BREP"):
        return read_cad(path, content, unit)
    return assemble_mesh(_MESHES[content](path), str(path))


def _head(path: Path) -> bytes:
    if path.is_dir():
        raise InputError(
            Message("{path} is a folder", path=path), where=str(path), allowed="a file"
        )
    if path.exists() and not path.is_file():
        raise InputError(
            Message("{path} is no regular file (a pipe or a device)", path=path),
            where=str(path),
            allowed="a file",
        )
    try:
        with path.open("rb") as stream:
            head = stream.read(4096)
    except FileNotFoundError as error:
        raise missing_file(path, where=str(path)) from error
    except OSError as error:
        raise DataError(
            Message("the file cannot be read ({strerror})", strerror=error.strerror),
            where=str(path),
        ) from error
    if not head:
        raise DataError("the file is empty", where=str(path), remedy="Export or copy it again")
    return head


def _format_of(head: bytes, path: Path) -> str | None:
    """Return the format that the first bytes tell, None when they tell none.

    Raises:
        DataError: An archive or a format of another program.
    """
    start = head.lstrip()
    for beginning, name in _MAGIC.items():
        if start.startswith(beginning):
            return name
    if start.startswith(b"PK\3\4"):
        return _zipped_format(path)
    for beginning, name in _FOREIGN.items():
        if head.startswith(beginning):
            raise DataError(
                Message("this is a {name} file", name=name),
                where=str(path),
                allowed=FORMATS,
                remedy="Export the outsole as STEP, or a scan as STL",
            )
    if _IGES_LINE.match(head.split(b"\n")[0].rstrip(b"\r")):
        return "IGES"
    first = next((line for line in head.splitlines() if line.split(b"#")[0].strip()), b"")
    counts = path.suffix.lower() == ".off" and re.fullmatch(rb"\s*\d+\s+\d+(\s+\d+)?\s*", first)
    if counts or re.match(rb"\s*(ST)?C?N?4?n?OFF\b", first):
        return "OFF"
    if start.startswith(b"{") and _is_gltf(path):
        return "GLTF"
    if looks_like_stl(head, path):
        return "STL"
    return "OBJ" if _is_obj(head, path) else None


def _is_obj(head: bytes, path: Path) -> bool:
    """Return whether the lines begin with words of an OBJ, one of them a vertex."""
    named = path.suffix.lower() == ".obj"
    if named and not _OBJ_VERTEX.search(head):
        with path.open("rb") as stream:
            head = stream.read(_OBJ_HEAD)
    head = re.sub(rb"\\[ \t]*\r?\n", b" ", head).replace(b"\r", b"\n")
    if not _OBJ_VERTEX.search(head):
        return False
    words = [line.split(None, 1)[0] for line in head.splitlines() if line.strip()]
    known = [word in OBJ_WORDS or word.startswith(b"#") for word in words[:-1]]
    return all(known) or (named and b"\0" not in head)


def _zipped_format(path: Path) -> str:
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
    except (zipfile.BadZipFile, OSError) as error:
        raise DataError(
            "the file is an archive that is cut short or damaged",
            where=str(path),
            remedy="Export or copy it again",
        ) from error
    if any(name.lower().endswith(".model") for name in names):
        return "3MF"
    shown = ", ".join(names[:5]) + (" ..." if len(names) > 5 else "")
    raise DataError(
        Message("the file is a ZIP archive that holds {shown}", shown=shown or "nothing"),
        where=str(path),
        remedy="Unpack it and give the outsole's own file",
    )


def _is_gltf(path: Path) -> bool:
    try:
        content = json.loads(path.read_bytes())
    except ValueError:
        return False
    return isinstance(content, dict) and "asset" in content


def _first_characters(head: bytes) -> str:
    text = head[:40].split(b"\n")[0].decode("ascii", errors="replace")
    return f'"{text}"' if text.isprintable() else Message("bytes {bytes}", bytes=head[:8].hex(" "))
