"""PLY, text and binary: any properties, polygons, strips."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from underfoot.core import DataError
from underfoot.core.remark import Message

from .gltf import strip_faces
from .mesh import AGAIN, FileBody, MeshFile
from .polygons import triangulate_polygons
from .text_meshes import _without_faces

_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2",
    "ushort": "u2", "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "int64": "i8", "uint64": "u8", "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
_CORNERS = ("vertex_indices", "vertex_index", "vertex_indexes")
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}

Columns = dict[str, np.ndarray]


@dataclass(frozen=True, slots=True)
class _Property:
    """A property of an element; ``length`` is the type of a list's length, "" for one value."""

    name: str
    kind: str
    length: str = ""


@dataclass(frozen=True, slots=True)
class _Element:
    name: str
    count: int
    properties: list[_Property]


def read_ply(path: Path) -> MeshFile:
    """Return the one body of a PLY file.

    Raises:
        DataError: A heading that is not read; cut short; points without faces; a face that crosses
            itself.
    """
    where = str(path)
    data = path.read_bytes()
    order, elements, body = _heading(data, where)
    columns: dict[str, Columns] = {}
    try:
        values = np.array(data[body:].split(), dtype="S") if not order else None
        place = 0 if values is not None else body
        for element in elements:
            if values is not None:
                columns[element.name], place = _of_text(values, place, element)
            else:
                columns[element.name], place = _of_bytes(data, place, element, order)
    except (ValueError, IndexError, OverflowError) as error:
        raise DataError(
            Message("the PLY file is not read ({error})", error=error), where=where, remedy=AGAIN
        ) from error
    vertex = columns.get("vertex", {})
    if not {"x", "y", "z"} <= set(vertex):
        raise DataError("the PLY file has no vertices with x, y and z", where=where, remedy=AGAIN)
    vertices = np.stack([vertex[name] for name in "xyz"], axis=1)
    with np.errstate(invalid="ignore"):  # a nan that signals
        doubles = vertices.astype(np.float64)
    if vertices.dtype != np.float32:
        vertices = doubles
    faces = [np.zeros((0, 3), dtype=np.int64)]
    for name, strips in (("face", False), ("tristrips", True)):
        own = columns.get(name, {})
        corners = next((own[each] for each in _CORNERS if each in own), None)
        if corners is None:
            continue
        counts = own["\0counts"]
        if not strips:
            faces.append(triangulate_polygons(doubles, counts, corners, "PLY", where))
            continue
        for strip in np.split(corners, np.cumsum(counts)[:-1]):
            for piece in np.split(strip, np.flatnonzero(strip < 0)):
                piece = piece[piece >= 0]
                faces.append(strip_faces(piece) if piece.size > 2 else faces[0])
    triangles = np.concatenate(faces)
    if triangles.shape[0] == 0:
        raise _without_faces(
            "PLY", Message("{count} points and no faces", count=vertices.shape[0]), where
        )
    return MeshFile("PLY", [FileBody(vertices, triangles)])


def _heading(data: bytes, where: str) -> tuple[str, list[_Element], int]:
    """Return the byte order ("" for text), the elements, and where the values begin."""
    end = data.find(b"end_header")
    after = data.find(b"\n", end)
    if data[end + 10 : end + 11] == b"\r" and data[end + 11 : end + 12] != b"\n":
        after = end + 10
    if end < 0 or after < 0:
        raise DataError("the heading of the PLY file has no end", where=where, remedy=AGAIN)
    order, elements = None, []
    for line in data[:end].decode("latin-1").splitlines():
        words = line.split()
        if words[:1] == ["format"]:
            order = _ORDERS.get(words[1] if len(words) > 1 else "")
        elif words[:1] == ["element"] and len(words) == 3 and words[2].isdigit():
            elements.append(_Element(words[1], int(words[2]), []))
        elif words[:1] == ["property"] and elements:
            words += [""] * (3 - len(words))  # of no type: refused
            kinds = [_TYPES.get(word) for word in words[2:-1] if words[1] == "list"] or [
                _TYPES.get(words[1])
            ]
            if None in kinds or len(kinds) > 2:
                raise DataError(
                    Message('the PLY heading has "{line}"', line=line), where=where, remedy=AGAIN
                )
            *length, kind = (str(each) for each in kinds)
            elements[-1].properties.append(_Property(words[-1], kind, length[0] if length else ""))
    if order is None:
        raise DataError(
            "the PLY file states no format that is read", where=where, allowed=", ".join(_ORDERS)
        )
    return order, elements, after + 1


def _of_text(values: np.ndarray, place: int, element: _Element) -> tuple[Columns, int]:
    """Return the columns of an element from the words of a file, and where the next begins."""
    lists = [each for each in element.properties if each.length]
    if not element.count or not element.properties:
        return {}, place
    width, first = len(element.properties), 0
    if lists:
        first = int(values[place + element.properties.index(lists[0])]) if len(lists) == 1 else -1
        width = width + first if first >= 0 else 0
    rows = values[place : place + element.count * width]
    if width and rows.size == element.count * width:
        table = rows.reshape(element.count, width)
        if not lists:
            return {
                each.name: table[:, n].astype(np.float64)
                for n, each in enumerate(element.properties)
            }, place + rows.size
        at = element.properties.index(lists[0])
        lengths = table[:, at].astype(np.float64)
        if (lengths == width - len(element.properties)).all():
            corners = table[:, at + 1 : at + 1 + first].astype(np.float64).astype(np.int64)
            beside = np.delete(table, np.arange(at, at + 1 + first), axis=1).astype(np.float64)
            names = [each.name for each in element.properties if not each.length]
            lengths = lengths.astype(np.int64)
            single = dict(zip(names, beside.T, strict=True))
            return {
                **single,
                lists[0].name: corners.ravel(),
                "\0counts": lengths,
            }, place + rows.size
    if not lists:
        raise ValueError(f"it ends within its {element.count} {element.name} lines")
    found: list[np.ndarray] = []
    counts = np.zeros(element.count, dtype=np.int64)
    singles = {each.name: np.zeros(element.count) for each in element.properties if not each.length}
    wanted = next((each for each in lists if each.name in _CORNERS), lists[0])
    for n in range(element.count):
        for each in element.properties:
            if not each.length:
                singles[each.name][n] = float(values[place])
                place += 1
                continue
            length = int(values[place])
            if length < 0 or place + 1 + length > values.size:
                raise ValueError(f"it ends within its {element.count} {element.name} lines")
            if each is wanted:
                found.append(values[place + 1 : place + 1 + length])
                counts[n] = length
            place += 1 + length
    corners = np.concatenate(found).astype(np.float64).astype(np.int64)
    return {**singles, wanted.name: corners, "\0counts": counts}, place


def _of_bytes(data: bytes, place: int, element: _Element, order: str) -> tuple[Columns, int]:
    """Return the columns of an element from the bytes of a file, and where the next begins."""
    lists = [each for each in element.properties if each.length]
    if not element.count or not element.properties:
        return {}, place
    ended = ValueError(f"it ends within its {element.count} {element.name} records")
    lengths = {}
    at = place
    for each in element.properties:  # lists as long as the first record's
        if each.length:
            kind = np.dtype(order + each.length)
            if at + kind.itemsize > len(data):
                raise ended
            lengths[each.name] = int(np.frombuffer(data, kind, 1, at)[0])
            at += kind.itemsize + lengths[each.name] * np.dtype(each.kind).itemsize
        else:
            at += np.dtype(each.kind).itemsize
    fields = []
    for each in element.properties:
        if each.length:
            fields.append((f"\0{each.name}", order + each.length))
            fields.append((each.name, order + each.kind, (lengths[each.name],)))
        else:
            fields.append((each.name, order + each.kind))
    record = np.dtype(fields)
    wanted = next((each for each in lists if each.name in _CORNERS), lists[0] if lists else None)
    if place + element.count * record.itemsize <= len(data):
        rows = np.frombuffer(data, record, element.count, place)
        if all((rows[f"\0{name}"] == length).all() for name, length in lengths.items()):
            end = place + element.count * record.itemsize
            names = [each.name for each in element.properties if not each.length]
            columns: Columns = {n: rows[n].astype(rows[n].dtype.newbyteorder("=")) for n in names}
            if wanted is not None:
                columns[wanted.name] = rows[wanted.name].astype(np.int64).ravel()
                columns["\0counts"] = np.full(element.count, lengths[wanted.name])
            return columns, end
    if wanted is None:
        raise ended
    found: list[np.ndarray] = []
    counts = np.zeros(element.count, dtype=np.int64)
    singles = {
        each.name: np.zeros(element.count, each.kind)
        for each in element.properties
        if not each.length
    }
    for n in range(element.count):
        for each in element.properties:
            kind = np.dtype(order + each.kind)
            if not each.length:
                if place + kind.itemsize > len(data):
                    raise ended
                singles[each.name][n] = np.frombuffer(data, kind, 1, place)[0]
                place += kind.itemsize
                continue
            head = np.dtype(order + each.length)
            if place + head.itemsize > len(data):
                raise ended
            length = int(np.frombuffer(data, head, 1, place)[0])
            place += head.itemsize
            if length < 0 or place + length * kind.itemsize > len(data):
                raise ended
            if each is wanted:
                found.append(np.frombuffer(data, kind, length, place))
                counts[n] = length
            place += length * kind.itemsize
    corners = np.concatenate(found).astype(np.int64)
    return {**singles, wanted.name: corners, "\0counts": counts}, place
