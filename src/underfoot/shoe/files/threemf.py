"""3MF: the core of the format, its production extension, and the volumes that slicers tell."""

import posixpath
import re
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

from underfoot.core import DataError, nearest_match
from underfoot.core.arrays import Array
from underfoot.core.optional import optional_module
from underfoot.core.remark import Message

from .._kernels.elements import COMPLETE, MISSING, NO_NUMBER, OTHER, element_numbers
from .mesh import AGAIN, MOST_UNFOLDED, FileBody, Kind, MeshFile, Unmet

MOST_INFLATED = 1e9
"""Bytes of the parts that are read, unpacked: a 3MF of 12 million faces."""
MOST_PACKED = 200
"""Times its size that a part may unpack to: numbers of a mesh pack to a tenth."""
_SMALL = 20_000_000  # bytes: a part below is read however it is packed
_SCHEMA = "http://schemas.microsoft.com/3dmanufacturing/"
_CORE = _SCHEMA + "core/2015/02"
_PRODUCTION = _SCHEMA + "production/2015/06"
_START = _SCHEMA + "2013/01/3dmodel"
_DONE = {
    _CORE: "core",
    _PRODUCTION: "production",
    _SCHEMA + "material/2015/02": "materials",
    _SCHEMA + "trianglesets/2021/07": "triangle sets",
}
"""Namespaces that are read, or that do not bear on the shape."""
UNITS = {
    "micron": 1e-6,
    "millimeter": 1e-3,
    "centimeter": 1e-2,
    "inch": 0.0254,
    "foot": 0.3048,
    "meter": 1.0,
}
"""Unit words of the format, m."""
_TYPES: dict[str, Kind] = {
    "model": "model",
    "surface": "model",
    "support": "support",
    "solidsupport": "support",
    "other": "modifier",
}
_VOLUMES: dict[str, Kind | None] = {
    "modelpart": "model",
    "normal_part": "model",
    "parametermodifier": "modifier",
    "modifier_part": "modifier",
    "supportblocker": "support",
    "support_blocker": "support",
    "supportenforcer": "support",
    "support_enforcer": "support",
    "negativevolume": None,
    "negative_part": None,
}
"""Kinds of volumes in the words of PrusaSlicer and Bambu Studio; None takes material away."""
_CURA: dict[str, Kind | None] = {
    "support_mesh": "support",
    "anti_overhang_mesh": "support",
    "infill_mesh": "modifier",
    "cutting_mesh": None,
}
_LISTS = {"vertices": ("vertex", ("x", "y", "z")), "triangles": ("triangle", ("v1", "v2", "v3"))}
_WITHOUT = "Apply it in the program it comes from, and export the outsole as STL or STEP"

Key = tuple[str, str]
"""Part of the package and id of an object in it."""


def _title(space: str) -> str:
    """Return the words by which a namespace tells its extension: all but its host and month."""
    words = re.search(r"/3dmanufacturing/(.+?)/\d{4}/\d\d$", space)
    return words[1] if words else space


@dataclass(frozen=True, slots=True)
class _Object:
    """An object of a model part; ``parts`` are the objects it holds, and where."""

    name: str
    kind: Kind | None
    vertices: Array
    faces: np.ndarray
    parts: tuple[tuple[Key, Array], ...]


@dataclass(frozen=True, slots=True)
class _Volume:
    """What a slicer says of a part of an object: faces from ``first`` to ``last``, or a component.

    ``component`` is the id of the object it is, "" for a range of faces.
    """

    name: str
    kind: Kind | None
    first: int = 0
    last: int = -1
    component: str = ""


def read_3mf(path: Path) -> MeshFile:
    """Return what a 3MF file builds: each mesh of each item and component is a body.

    Parts of a package are read as the production extension has them. Objects of type support and
    other, and the modifiers and supports of PrusaSlicer, Bambu Studio and Cura are told apart.

    Raises:
        DataError: Damaged; something that the format requires is missing; two units; parts that
            hold each other; more faces or bytes than a sole has.
    """
    optional_module("lxml", "cad", "Reading 3MF")
    with zipfile.ZipFile(path) as archive:
        return _Package(archive, str(path)).build_mesh()


class _Package:
    """The parts of a 3MF archive, read when an item asks for them."""

    def __init__(self, archive: zipfile.ZipFile, where: str) -> None:
        self.archive, self.where = archive, where
        self.names = {"/" + unquote(name).lstrip("/").casefold(): name
                      for name in archive.namelist()}  # fmt: skip
        self.roots: dict[str, Any] = {}
        self.objects: dict[Key, _Object] = {}
        self.units: dict[str, str] = {}
        self.unmet: dict[Unmet, None] = {}
        self.counts: dict[Key, int] = {}

    def build_mesh(self) -> MeshFile:
        """Return the bodies of all items."""
        start = self._start()
        root = self._root(start)
        volumes, hidden = self._volumes()
        items = root.findall(f"{{{_CORE}}}build/{{{_CORE}}}item")
        if root.find(f"{{{_CORE}}}build") is None:
            raise self._error("the 3MF file has no build section, which says what is made")
        if not items:
            raise self._error("the build section of the 3MF file is empty: nothing is to be made")
        bodies: list[FileBody] = []
        asked = [(self._key(item, start, "item"), item) for item in items]
        if sum(self._count(key, ()) for key, _ in asked) > MOST_UNFOLDED:
            raise self._error(
                Message("the 3MF file unfolds to more than {most} faces", most=MOST_UNFOLDED),
                "Export the outsole alone, once",
            )
        for key, item in asked:
            shown = item.get("printable", "1") not in ("0", "false") and key[1] not in hidden
            place = self._transform(item)
            bodies += self._bodies(key, place, (), "model", shown, volumes.get(key[1], ()))
        stated = {unit: part for part, unit in self.units.items()}
        if len(stated) > 1:
            words = " and ".join(f'"{unit}" in {part}' for unit, part in stated.items())
            raise self._error(
                Message("its parts contradict each other on the unit: {wording}", wording=words),
                _WITHOUT,
            )
        return MeshFile("3MF", bodies, UNITS[self.units[start]], tuple(self.unmet))

    def _start(self) -> str:
        """Return the part that the package begins with."""
        relations = self.names.get("/_rels/.rels")
        if relations is not None:
            for each in self._xml(relations):
                if isinstance(each.tag, str) and each.get("Type") == _START:
                    return self._part("/", each.get("Target", ""))
        models = [name for name in self.names if name.endswith(".model")]
        if len(models) != 1:
            raise self._error(
                "no part of the 3MF package says where it begins: _rels/.rels has no relationship "
                "of the type 3dmodel"
            )
        return models[0]

    def _part(self, base: str, target: str) -> str:
        joined = posixpath.normpath(posixpath.join(posixpath.dirname(base), unquote(target)))
        part = joined.casefold()
        if part not in self.names:
            raise self._error(
                Message('the 3MF package has no part "{target}", which it names', target=target),
                nearest=nearest_match(part, self.names),
            )
        return part

    def _data(self, name: str) -> bytes:
        entry = self.archive.getinfo(name)
        if entry.file_size > MOST_INFLATED or (
            entry.file_size > _SMALL and entry.file_size > MOST_PACKED * entry.compress_size
        ):
            raise self._error(
                Message(
                    "its part {name} unpacks from {compress_size:.3g} to {file_size:.4g} MB",
                    name=name,
                    compress_size=entry.compress_size / 1000000.0,
                    file_size=entry.file_size / 1000000.0,
                ),
                "Export a coarser mesh (0.1 mm is fine enough), or as binary STL",
                allowed=Message(
                    "{most:.0f} MB, and {times} times its size",
                    most=MOST_INFLATED / 1000000.0,
                    times=MOST_PACKED,
                ),
            )
        try:
            return self.archive.read(entry)
        # zipfile raises NotImplementedError of a packing that it does not know, RuntimeError of a
        # password
        except (zipfile.BadZipFile, OSError, EOFError, NotImplementedError, RuntimeError) as error:
            raise self._error(
                Message("its part {name} cannot be unpacked ({error})", name=name, error=error)
            ) from error
        except Exception as error:  # zlib and lzma have errors of their own
            raise self._error(
                Message("its part {name} is damaged ({error})", name=name, error=error)
            ) from error

    def _xml(self, name: str, data: bytes | None = None) -> Any:
        etree = optional_module("lxml.etree", "cad", "Reading 3MF")
        parser = etree.XMLParser(
            resolve_entities=False, no_network=True, huge_tree=True, remove_comments=True
        )
        try:
            root = etree.fromstring(self._data(name) if data is None else data, parser)
        except etree.XMLSyntaxError as error:
            raise self._error(
                Message("its part {name} is no XML ({error})", name=name, error=error)
            ) from error
        if root.getroottree().docinfo.doctype:
            raise self._error(
                Message("its part {name} has a document type, which 3MF forbids", name=name)
            )
        return root

    def _root(self, part: str) -> Any:
        """Return the root of a model part, its objects read, its lists of numbers taken out."""
        if part in self.roots:
            return self.roots[part]
        name = self.names[part]
        data = self._data(name)
        if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
            text = data.decode("utf-16", errors="replace")
            data = re.sub(r"^\s*<\?xml.*?\?>", "", text, flags=re.DOTALL).encode()
        if b"<!--" in data:
            data = re.sub(rb"<!--.*?-->", b"", data, flags=re.DOTALL)
        lists: list[np.ndarray] = []
        bare = data if b"<![CDATA[" in data else b"".join(self._without_lists(data, lists, name))
        root = self.roots[part] = self._xml(name, bare)
        if root.tag != f"{{{_CORE}}}model":
            raise self._error(
                Message("its part {name} is no 3MF model but {tag}", name=name, tag=root.tag)
            )
        unit = self.units[part] = root.get("unit", "millimeter")
        if unit not in UNITS:
            raise self._error(
                Message('"{unit}" is no unit of the 3MF format', unit=unit),
                allowed=", ".join(UNITS),
                nearest=nearest_match(unit, UNITS),
            )
        self._demands(root)
        for each in root.iterfind(f"{{{_CORE}}}resources/{{{_CORE}}}object"):
            key = part, each.get("id", "")
            if not key[1]:
                raise self._error(Message("an object of {name} has no id", name=name))
            if key in self.objects:
                raise self._error(
                    Message("two objects of {name} have the id {key}", name=name, key=key[1])
                )
            self.objects[key] = self._object(each, part, lists)
        return root

    def _without_lists(self, data: bytes, lists: list[np.ndarray], name: str) -> Iterator[bytes]:
        """Yield the XML with each list of vertices or triangles replaced by its number."""
        place = 0
        text = np.frombuffer(data, dtype=np.uint8)
        for begin in re.finditer(rb"<((?:[\w.-]+:)?)(vertices|triangles)\s*>", data):
            prefix, what = begin[1], begin[2].decode()
            end = data.find(b"</" + begin[1] + begin[2], begin.end())
            if begin.start() < place or end < 0:
                continue
            values = self._numbers(text[begin.end() : end], prefix, what, name)
            if values is None:
                continue
            yield data[place : begin.end()]
            yield b'<%slist n="%d"/>' % (prefix, len(lists))
            lists.append(values)
            place = end
        yield data[place:]

    def _numbers(self, text: np.ndarray, prefix: bytes, what: str, part: str) -> Array | None:
        """Return the numbers of a list (n, 3), None where it holds more than its elements."""
        tag, names = _LISTS[what]
        out = np.empty((int(np.count_nonzero(text == ord("<"))), 3), dtype=np.float64)
        state, count = element_numbers(
            text,
            np.frombuffer(prefix + tag.encode(), dtype=np.uint8),
            np.frombuffer("".join(names).encode(), dtype=np.uint8),
            len(names[0]),
            out,
        )
        if state == OTHER:
            return None
        self._check(state, count, tag, names, part)
        return out[:count]

    def _check(self, state: int, count: int, tag: str, names: tuple[str, ...], part: str) -> None:
        if state in (MISSING, NO_NUMBER):
            at = {"tag": tag, "number": count, "part": part, "names": names}
            lacks = Message(
                "{tag} {number} of {part} lacks one of {names}, which the format requires", **at
            )
            no_number = Message(
                "{tag} {number} of {part} has no number as {names}, which the format requires", **at
            )
            raise self._error(lacks if state == MISSING else no_number)
        assert state == COMPLETE

    def _read_list(self, mesh: Any, what: str, lists: list[np.ndarray], part: str) -> Array:
        """Return the numbers of a mesh's vertices or triangles."""
        tag, names = _LISTS[what]
        whole = mesh.find(f"{{{_CORE}}}{what}")
        if whole is None:
            raise self._error(
                Message(
                    "a mesh of {part} has no {what}, which the format requires",
                    part=part,
                    what=what,
                )
            )
        taken = whole.find(f"{{{_CORE}}}list")
        if taken is not None:
            return lists[int(taken.get("n"))]
        rows = []
        for count, each in enumerate(whole.iterfind(f"{{{_CORE}}}{tag}")):
            try:
                rows.append([float(each.attrib[name]) for name in names])
            except KeyError:
                self._check(MISSING, count, tag, names, part)
            except ValueError:
                self._check(NO_NUMBER, count, tag, names, part)
        return np.array(rows, dtype=np.float64).reshape(-1, 3)

    def _demands(self, root: Any) -> None:
        """Note the extensions that a model part requires or recommends and that are not read."""
        for attribute, required in (("requiredextensions", True), ("recommendedextensions", False)):
            for prefix in root.get(attribute, "").split():
                space = root.nsmap.get(prefix)
                if space is None:
                    raise self._error(
                        Message(
                            'the file requires an extension "{prefix}" and names no such namespace',
                            prefix=prefix,
                        )
                    )
                if space not in _DONE:
                    self._unmet(Message("the 3MF extension {title}", title=_title(space)), required)

    def _unmet(self, what: str, required: bool) -> None:
        self.unmet[Unmet(what, required, _WITHOUT)] = None

    def _object(self, each: Any, part: str, lists: list[np.ndarray]) -> _Object:
        known = each.get("type", "model")
        if known not in _TYPES:
            raise self._error(
                Message('object {each} is of the type "{known}"', each=each.get("id"), known=known),
                allowed=", ".join(_TYPES),
            )
        kind: Kind | None = _TYPES[known]
        for said in each.iterfind(f".//{{{_CORE}}}metadata"):
            word = said.get("name", "").rpartition(":")[2]
            if word in _CURA and (said.text or "").strip().lower() == "true":
                kind = _CURA[word]
        for attribute, value in each.attrib.items():
            if attribute.endswith("}meshresolution") and value == "lowres":
                self._unmet("slices in place of a coarse mesh", required=True)
        mesh, parts = each.find(f"{{{_CORE}}}mesh"), each.find(f"{{{_CORE}}}components")
        vertices, faces = np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
        placed: list[tuple[Key, Array]] = []
        if mesh is not None:
            vertices = self._read_list(mesh, "vertices", lists, part)
            numbers = self._read_list(mesh, "triangles", lists, part)
            faces = numbers.astype(np.int32)
            if not np.array_equal(faces, numbers):
                raise self._error(
                    Message("a triangle of {part} names a vertex by no whole number", part=part)
                )
            spaces = {str(child.tag).rpartition("}")[0][1:] for child in mesh}
            for space in sorted(spaces - set(_DONE)):
                self._unmet(
                    Message("the 3MF extension {title}", title=_title(space)), required=False
                )
        elif parts is not None:
            for child in parts.iterfind(f"{{{_CORE}}}component"):
                placed.append((self._key(child, part, "component"), self._transform(child)))
        else:
            content = next((c.tag for c in each if not str(c.tag).startswith(f"{{{_CORE}}}")), None)
            number = each.get("id")
            what = Message("a mesh or components in object {number}", number=number)
            if content:
                space = str(content).rpartition("}")[0][1:]
                what = Message(
                    "the 3MF extension {title} in object {number}",
                    title=_title(space),
                    number=number,
                )
            self._unmet(what, required=True)
        name = each.get("name") or each.get("partnumber") or ""
        return _Object(name, kind, vertices, faces, tuple(placed))

    def _key(self, each: Any, part: str, what: str) -> Key:
        number = each.get("objectid")
        if number is None:
            raise self._error(
                Message(
                    "{what} of {part} has no objectid, which the format requires",
                    what=what,
                    part=part,
                )
            )
        path = each.get(f"{{{_PRODUCTION}}}path")
        return (self._part("/", path) if path else part), number

    def _transform(self, each: Any) -> Array:
        text = each.get("transform")
        matrix = np.eye(4)
        if text is None:
            return matrix
        try:
            values = np.array([float(word) for word in text.split()])
            matrix[:3] = values.reshape(4, 3).T
        except ValueError as error:
            raise self._error(
                Message('the transform "{text}" is not read', text=text[:60]),
                allowed="twelve numbers",
            ) from error
        if not np.isfinite(matrix).all() or np.linalg.det(matrix[:3, :3]) == 0:
            raise self._error(
                Message('the transform "{text}" flattens what it places', text=text[:60])
            )
        return matrix

    def _of(self, key: Key) -> _Object:
        self._root(key[0])
        if key not in self.objects:
            there = [number for part, number in self.objects if part == key[0]]
            raise self._error(
                Message(
                    "{name} has no object {key}, which is to be built",
                    name=self.names[key[0]],
                    key=key[1],
                ),
                allowed=", ".join(there[:10]) or "no object is there",
            )
        return self.objects[key]

    def _count(self, key: Key, above: tuple[Key, ...]) -> int:
        """Return how many faces and parts an object unfolds to."""
        if key in above:
            ids = " in ".join(number for _, number in (*above[above.index(key) :], key))
            raise self._error(Message("its objects hold each other: {ids}", ids=ids), _WITHOUT)
        if key not in self.counts:
            each = self._of(key)
            inner = (self._count(one, (*above, key)) + 1 for one, _ in each.parts)
            self.counts[key] = each.faces.shape[0] + sum(inner)
        return self.counts[key]

    def _bodies(
        self,
        key: Key,
        place: Array,
        above: tuple[str, ...],
        kind: Kind | None,
        shown: bool,
        volumes: tuple[_Volume, ...],
    ) -> Iterator[FileBody]:
        """Yield the meshes of an object, placed; what is held by a support is a support."""
        each = self._of(key)
        kind = each.kind if kind == "model" else kind
        layer = "/".join(filter(None, above))
        ranges = [volume for volume in volumes if not volume.component]
        pieces = ranges or [_Volume("", "model", 0, each.faces.shape[0] - 1)]
        rest = np.ones(each.faces.shape[0], dtype=bool)
        for piece in pieces:
            rest[piece.first : piece.last + 1] = False
        if each.faces.size:
            for piece in (*pieces, _Volume("", "model")):
                faces = each.faces[piece.first : piece.last + 1] if piece.last >= 0 else \
                    each.faces[rest]  # fmt: skip
                own = kind if piece.kind == "model" else piece.kind
                if faces.size:
                    yield self._body(each, faces, piece.name or each.name, layer, own, shown, place)
        told = [volume for volume in volumes if volume.component]
        in_turn = [one[1] for one, _ in each.parts] == [volume.component for volume in told]
        for n, (one, own_place) in enumerate(each.parts):
            of_it = told[n : n + 1] if in_turn else [v for v in told if v.component == one[1]]
            volume = of_it[0] if of_it else _Volume("", "model")
            inner = kind if volume.kind == "model" else volume.kind
            names = (*above, each.name, volume.name)
            yield from self._bodies(one, place @ own_place, names, inner, shown, ())

    def _body(
        self, each: _Object, faces: np.ndarray, name: str, layer: str, kind: Kind | None,
        shown: bool, place: Array,
    ) -> FileBody:  # fmt: skip
        if kind is None:
            if shown:
                taken = Message('a volume that takes material away ("{name}")', name=name or layer)
                self._unmet(taken, required=True)
            kind = "modifier"
        return FileBody(each.vertices, faces, name, layer, shown, kind, place)

    def _volumes(self) -> tuple[dict[str, tuple[_Volume, ...]], set[str]]:
        """Return what slicers say of the volumes of objects, by id, and which are hidden."""
        found: dict[str, tuple[_Volume, ...]] = {}
        hidden: set[str] = set()
        for part, name in self.names.items():
            if not re.fullmatch(r"/metadata/.*model.*\.config", part):
                continue
            for each in self._xml(name).iterfind(".//object"):
                said = _metadata(each)
                if said.get("printable") in ("0", "false"):
                    hidden.add(each.get("id", ""))
                volumes = [self._volume(one) for one in each if one.tag in ("volume", "part")]
                found[each.get("id", "")] = tuple(volumes)
        return found, hidden

    def _volume(self, each: Any) -> _Volume:
        said = _metadata(each)
        word = (said.get("volume_type") or each.get("subtype") or "").casefold()
        if not word:  # before there were types
            word = "parametermodifier" if said.get("modifier") == "1" else "modelpart"
        if word not in _VOLUMES:
            self._unmet(Message('a volume of the kind "{word}"', word=word), required=True)
        name, kind = said.get("name", ""), _VOLUMES.get(word)
        if each.tag == "part":
            return _Volume(name, kind, component=each.get("id", ""))
        try:
            return _Volume(name, kind, int(each.get("firstid")), int(each.get("lastid")))
        except (TypeError, ValueError) as error:
            raise self._error("a volume of the slicer's settings names no faces") from error

    def _error(
        self, what: str, remedy: str = AGAIN, allowed: str | None = None, nearest: str | None = None
    ) -> DataError:
        return DataError(what, where=self.where, allowed=allowed, nearest=nearest, remedy=remedy)


def _metadata(each: Any) -> dict[str, str]:
    return {one.get("key", ""): one.get("value", "") for one in each.iterfind("metadata")}
