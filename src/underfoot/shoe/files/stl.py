"""STL, binary and text."""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError
from underfoot.core.remark import Message

from .mesh import FileBody, Mesh, MeshFile
from .view import soundness

_HEADER, _RECORD = 84, 50
_FACET = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("extra", "<u2")])
_NUMBER = rb"[-+0-9.eE]+|[-+]?(?:nan|inf)[a-z]*"
_CORNER = re.compile(
    rb"vertex\s+(" + _NUMBER + rb")\s+(" + _NUMBER + rb")\s+(" + _NUMBER + rb")", re.IGNORECASE
)
_SOLID = re.compile(rb"^[ \t]*solid\b[ \t]*([^\r\n]*)", re.IGNORECASE | re.MULTILINE)


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


def read_stl(path: Path) -> MeshFile:
    """Return the bodies of an STL file: one, or the named solids of a text file.

    Raises:
        DataError: Truncated, or a text STL whose corners don't make triangles.
    """
    size = path.stat().st_size
    with path.open("rb") as stream:
        head = stream.read(_HEADER + _RECORD)
    promised = int.from_bytes(head[80:84], "little") if len(head) >= _HEADER else -1
    spare = size - _HEADER - _RECORD * promised
    if promised >= 0 and spare == 0:
        return _binary(path, promised)
    if head.lstrip()[:5].lower() == b"solid" and not _is_binary(head, promised, spare):
        return _text(path)
    whole = (size - _HEADER) // _RECORD
    if promised > whole:
        raise DataError(
            Message(
                "the file is cut short: it promises {promised} faces and holds {count}",
                promised=promised,
                count=max(whole, 0),
            ),
            where=str(path),
            remedy="Export or copy it again",
        )
    remark = Message(
        "{spare} bytes after the last of {promised} faces were left aside.",
        spare=spare,
        promised=promised,
    )
    return _binary(path, promised, (remark,))


def _is_binary(head: bytes, promised: int, spare: int) -> bool:
    """Return whether bytes behind "solid" are no text and its number of facets fits the size."""
    odd = any(byte < 9 or byte > 126 for byte in head[80:])
    return odd and (spare >= 0 or promised < 0 or b"\0" in head)


def _binary(path: Path, count: int, remarks: tuple[Message, ...] = ()) -> MeshFile:
    records = np.fromfile(path, dtype=_FACET, count=count, offset=_HEADER)
    corners = np.ascontiguousarray(records["corners"], dtype=np.float32)
    return MeshFile("STL (binary)", [FileBody(corners.reshape(-1, 3))], remarks=remarks)


def _text(path: Path) -> MeshFile:
    data = path.read_bytes()
    corners = _CORNER.findall(data)
    mentioned = len(re.findall(rb"\bvertex\b", data, re.IGNORECASE))
    facets = len(re.findall(rb"\bendfacet\b", data, re.IGNORECASE))
    if mentioned != len(corners) or len(corners) != 3 * facets:
        line = _first_bad_line(data)
        comma = re.search(rb"^\s*vertex\s+[-+\d]+,\d", data, re.IGNORECASE | re.MULTILINE)
        what = Message(
            "{facets} facets have {count} readable corners instead of {needed}",
            facets=facets,
            count=len(corners),
            needed=3 * facets,
        )
        if line:
            what = Message(
                "{what}; the first line that cannot be read is {line}", what=what, line=line
            )
        raise DataError(
            what,
            where=str(path),
            remedy="Its numbers have decimal commas: export it with decimal points, or binary"
            if comma
            else "The text is cut short or damaged: export the outsole again, as binary STL",
        )
    try:
        numbers = np.array(corners, dtype="S").astype(np.float64)
    except ValueError as error:
        raise DataError(
            Message("a corner is no number ({error})", error=error), where=str(path)
        ) from error
    numbers = numbers.reshape(-1, 3)
    remarks = ()
    if not re.search(rb"\bendsolid\b", data[-400:], re.IGNORECASE):
        soup = Mesh(numbers.reshape(-1, 3, 3).astype(np.float32), "STL (text)")
        sound = soundness(soup, str(path))
        if not sound.closed or sound.crowded_edges:
            raise DataError(
                Message(
                    "the text ends after {facets} facets without the end mark endsolid, and "
                    "they leave its surface open: it is cut short",
                    facets=facets,
                ),
                where=str(path),
                remedy="Export or copy it again; where no facet is missing, add a last line "
                "endsolid",
            )
        remarks = (
            Message(
                "The text ends without the end mark endsolid; it was read, as its "
                "facets leave no surface open."
            ),
        )
    return MeshFile("STL (text)", _solids(data, numbers), remarks=remarks)


def _solids(data: bytes, corners: NDArray[np.float64]) -> list[FileBody]:
    """Return a body for each solid of a text STL, named as its first line says."""
    bodies, done = [], 0
    begins = list(_SOLID.finditer(data))
    for n, begin in enumerate(begins):
        end = begins[n + 1].start() if n + 1 < len(begins) else len(data)
        if len(begins) == 1:
            count = corners.shape[0]
        else:
            count = 3 * len(re.findall(rb"\bendfacet\b", data[begin.end() : end], re.IGNORECASE))
        name = begin[1].decode("utf-8", "replace").strip()
        bodies.append(FileBody(corners[done : done + count], name=name))
        done += count
    if len(bodies) == 1:  # programs write their own name there, or the file's
        return [FileBody(corners)]
    return bodies


def _first_bad_line(data: bytes) -> str:
    for number, line in enumerate(data.splitlines(), start=1):
        if line.strip().lower().startswith(b"vertex") and not _CORNER.search(line):
            return f"{number}: {line.strip()[:60].decode('ascii', errors='replace')}"
    return ""
