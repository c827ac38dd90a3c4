"""STL, binary and text."""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError

from .mesh import Mesh

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
    if not re.search(rb"\bendsolid\b", data[-400:], re.IGNORECASE):
        raise DataError(
            f"the text ends after {facets} facets without the end mark endsolid: it is cut short",
            where=str(path),
            remedy="Export or copy it again; where all facets are there, add a last line endsolid",
        )
    return Mesh(numbers.reshape(-1, 3, 3), "STL (text)")


def _first_bad_line(data: bytes) -> str:
    for number, line in enumerate(data.splitlines(), start=1):
        if line.strip().lower().startswith(b"vertex") and not _CORNER.search(line):
            return f"{number}: {line.strip()[:60].decode('ascii', errors='replace')}"
    return ""
