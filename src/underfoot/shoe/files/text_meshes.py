"""OBJ and OFF: faces of any number of corners in text."""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError
from underfoot.core.arrays import Array
from underfoot.core.remark import Message

from .mesh import AGAIN, FileBody, MeshFile, Unmet
from .polygons import triangulate_polygons

OBJ_WORDS = frozenset(
    b"v vt vn vp f fo l p o g s mg mtllib usemtl maplib usemap lod bevel c_interp d_interp "
    b"shadow_obj trace_obj ctech stech cstype deg bmat step curv curv2 surf parm trim hole scrv sp "
    b"end con bsp bzp cdc cdp res call csh".split()
)
"""First words of the lines of an OBJ."""
_SHAPES = {b"surf": "free-form surfaces (surf)", b"bsp": "free-form patches (bsp)",
           b"bzp": "free-form patches (bzp)", b"cdp": "free-form patches (cdp)",
           b"call": "another file (call)", b"csh": "a command (csh)"}  # fmt: skip
_OFF = re.compile(rb"(ST)?(C)?(N)?(4)?(n)?OFF$")


def read_obj(path: Path) -> MeshFile:
    """Return the bodies of an OBJ, its objects and groups; lines and points are no faces.

    Raises:
        DataError: A line that is no vertex or face; a vertex that is not there; a face that
            crosses itself; no faces.
    """
    where = str(path)
    data = path.read_bytes()
    if b"\\" in data:  # a line that goes on
        data = re.sub(rb"\\[ \t]*\r?\n", b" ", data)
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    points: list[bytes] = []
    faces: list[bytes] = []
    before: list[int] = []  # vertices given before each face
    owners: list[int] = []
    numbers: dict[tuple[bytes, bytes], int] = {}
    thing = group = b""
    owner = -1
    unmet: dict[Unmet, None] = {}
    unknown: set[str] = set()
    for line in data.split(b"\n"):
        word, _, rest = line.partition(b" ")
        if word != b"v" and word != b"f":
            parts = line.split(None, 1)  # tabs, blanks before the word
            if not parts:
                continue
            word, rest = parts[0], parts[1] if len(parts) > 1 else b""
        if word == b"v":
            points.append(rest)
        elif word == b"f" or word == b"fo":
            if owner < 0:
                owner = numbers.setdefault((thing, group), len(numbers))
            faces.append(rest)
            before.append(len(points))
            owners.append(owner)
        elif word == b"o":
            thing, group, owner = rest.strip(), b"", -1
        elif word == b"g":
            group, owner = rest.strip(), -1
        elif word in _SHAPES:
            unmet[Unmet(_SHAPES[word], True, "Export the outsole as a mesh, or as STEP")] = None
        elif word not in OBJ_WORDS and not word.startswith(b"#"):
            unknown.add(word[:20].decode("latin-1"))
    if not faces:
        what = Message("{count} points and no faces", count=len(points)) if points else "no faces"
        if not unmet:
            raise _without_faces("OBJ", what, where)
    vertices = _rows(points, {3, 4, 6, 7}, "vertex", where)[:, :3]
    plain = b"\n".join(faces)
    if b"#" in plain:
        plain = re.sub(rb"#[^\n]*", b"", plain)
    if b"/" in plain:
        plain = re.sub(rb"/[^\s]*", b"", plain)
    words = plain.split(b"\n") if faces else []
    counts = np.fromiter(map(len, map(bytes.split, words)), dtype=np.int64, count=len(words))
    given = _whole(plain, int(counts.sum()), words, where)
    if (given == 0).any():
        raise DataError("a face names vertex 0; they count from 1", where=where, remedy=AGAIN)
    known = np.repeat(np.array(before, dtype=np.int64), counts)
    corners = np.where(given < 0, known + given, given - 1)
    if corners.size and corners.min() < 0:
        bad = int(np.argmin(corners))
        raise DataError(
            Message(
                "a face names vertex {given}, and {known} are given before it",
                given=given[bad],
                known=known[bad],
            ),
            where=where,
            remedy=AGAIN,
        )
    names = [(o.decode("utf-8", "replace"), g.decode("utf-8", "replace")) for o, g in numbers]
    owner_of = np.array(owners, dtype=np.int64)
    bodies = []
    for n, (o, g) in enumerate(names):
        mine = owner_of == n if len(names) > 1 else np.ones(len(owners), dtype=bool)
        own = corners if mine.all() else corners[np.repeat(mine, counts)]
        made = triangulate_polygons(vertices, counts[mine], own, "OBJ", where)
        layer, name = (o, g) if o and g else ("", o or g)
        bodies.append(FileBody(vertices, made, name, layer))
    remarks = ()
    if unknown:
        few = ", ".join(sorted(unknown)[:4])
        remarks = (Message("Lines of the OBJ that begin with {few} were left out.", few=few),)
    return MeshFile("OBJ", bodies, unmet=tuple(unmet), remarks=remarks)


def _rows(lines: list[bytes], widths: set[int], what: str, where: str) -> Array:
    """Return the numbers of lines (n, 3 at least), of which all must have as many as allowed."""
    if not lines:
        return np.zeros((0, 3))
    if any(b"#" in line for line in lines):
        lines = [line.partition(b"#")[0] for line in lines]
    counts = set(map(len, map(bytes.split, lines)))
    try:
        if counts <= widths and len(counts) == 1:
            return np.loadtxt(lines, dtype=np.float64, comments=None, ndmin=2, encoding="latin-1")
        if counts <= widths:
            return np.array([line.split()[:3] for line in lines], dtype="S").astype(np.float64)
    except ValueError:
        pass
    for number, line in enumerate(lines, start=1):
        words = line.split()
        if len(words) not in widths or not all(map(_is_number, words)):
            shown = line.strip()[:60].decode("latin-1")
            wrong = Message('{what} {number} is "{shown}"', what=what, number=number, shown=shown)
            if b"," in line:
                wrong = Message("{wrong}: a comma is no decimal point", wrong=wrong)
            raise DataError(
                wrong,
                where=where,
                allowed=Message(
                    "{widths} numbers", widths=" or ".join(str(n) for n in sorted(widths))
                ),
                remedy=AGAIN,
            )
    raise AssertionError


def _is_number(word: bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return b"_" not in word


def _whole(text: bytes, count: int, lines: list[bytes], where: str) -> NDArray[np.int64]:
    """Return the whole numbers of faces."""
    try:
        found = np.array(text.split(), dtype="S").astype(np.int64)
    except (ValueError, OverflowError):
        found = np.zeros(0, dtype=np.int64)
    if found.size == count:
        return found
    for number, line in enumerate(lines, start=1):
        if not all(re.fullmatch(rb"[-+]?\d+", word) for word in line.split()):
            shown = line.strip()[:60].decode("latin-1")
            raise DataError(
                Message('face {number} is "{shown}"', number=number, shown=shown),
                where=where,
                remedy=AGAIN,
            )
    raise DataError("a face names no whole number", where=where, remedy=AGAIN)


def _without_faces(kind: str, content: str, where: str) -> DataError:
    return DataError(
        Message("the {kind} file holds {content}", kind=kind, content=content),
        where=where,
        remedy="Mesh the scan in the scanner's software and export it as STL or PLY",
    )


def read_off(path: Path) -> MeshFile:
    """Return the one body of an OFF: plain, with colours, normals or texture, homogeneous.

    Raises:
        DataError: Binary, of another dimension, cut short; a face that crosses itself.
    """
    where = str(path)
    lines = [line.partition(b"#")[0].split() for line in path.read_bytes().splitlines()]
    lines = [line for line in lines if line]
    if lines and lines[0][0].isdigit():  # the word at its head may be left out
        lines.insert(0, [b"OFF"])
    kind = _OFF.match(lines[0][0]) if lines else None
    if kind is None or lines[0][1:2] == [b"BINARY"]:
        raise DataError("a binary OFF file is not read", where=where, remedy="Export it as text")
    lines[0] = lines[0][1:]
    lines = [line for line in lines if line]
    if kind[5]:  # its dimension comes first
        if not lines or lines[0][0] != b"3":
            raise DataError("an OFF file of another dimension than 3 is not read", where=where)
        lines[0] = lines[0][1:]
        lines = [line for line in lines if line]
    width = 4 if kind[4] else 3
    try:
        vertex_count, face_count = int(lines[0][0]), int(lines[0][1])
        rows, polygons = lines[1 : 1 + vertex_count], lines[1 + vertex_count :][:face_count]
        if len(polygons) < face_count or min(vertex_count, face_count) < 0:
            raise DataError(
                Message(
                    "the OFF file promises {vertices} vertices and {faces} faces, its lines "
                    "hold {vertex_lines} and {face_lines}",
                    vertices=vertex_count,
                    faces=face_count,
                    vertex_lines=len(rows),
                    face_lines=len(polygons),
                ),
                where=where,
                remedy=AGAIN,
            )
        points = np.array([row[:width] for row in rows], dtype="S").astype(np.float64)
        points = points.reshape(-1, width)
        counts = np.array([int(line[0]) for line in polygons], dtype=np.int64)
        corners = [line[1 : 1 + n] for line, n in zip(polygons, counts, strict=True)]
        if any(len(each) != n for each, n in zip(corners, counts, strict=True)):
            raise ValueError("a face has fewer corners than it says")
        flat = np.array([word for corner in corners for word in corner], dtype="S").astype(np.int64)
    except (ValueError, IndexError, OverflowError) as error:
        raise DataError(
            Message("the OFF file is not read ({error})", error=error), where=where, remedy=AGAIN
        ) from error
    if not face_count:
        raise _without_faces(
            "OFF", Message("{count} points and no faces", count=vertex_count), where
        )
    if kind[4]:
        points = points[:, :3] / points[:, 3:]
    return MeshFile(
        "OFF", [FileBody(points, triangulate_polygons(points, counts, flat, "OFF", where))]
    )
