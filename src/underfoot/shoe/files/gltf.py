"""glTF and GLB: all of the core that bears on shape, and the extensions of geometry."""

import base64
import binascii
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

from underfoot.core import DataError
from underfoot.core.arrays import Array
from underfoot.core.optional import optional_module
from underfoot.core.remark import Message

from .mesh import AGAIN, MOST_UNFOLDED, FileBody, MeshFile, Unmet

_LONGEST, _SHORTEST = 2.0, 0.02  # m: what glTF may hold when its metres are meant
_COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
_DRACO = "KHR_draco_mesh_compression"
_INSTANCES = "EXT_mesh_gpu_instancing"
_HIDDEN = "KHR_node_visibility"
_PACKED = ("EXT_meshopt_compression", "KHR_meshopt_compression", "MESHOPT_compression")
_DONE = {_DRACO, _INSTANCES, _HIDDEN, "KHR_mesh_quantization"}
_LOOKS = ("KHR_materials_", "KHR_texture_", "KHR_lights_", "KHR_xmp", "KHR_animation_",
          "EXT_texture_", "EXT_lights_", "MSFT_texture_", "KHR_techniques_", "ADOBE_materials_",
          "EXT_materials_", "EXT_mesh_features", "EXT_structural_metadata", "KHR_audio",
          "KHR_interactivity", "KHR_node_selectability", "KHR_node_hoverability")  # fmt: skip
"""Beginnings of extensions that bear on looks, not on shape."""
_TRIANGLES, _STRIP, _FAN = 4, 5, 6


def read_gltf(path: Path) -> MeshFile:
    """Return the meshes of the scene that a glTF or GLB file shows, a body for each primitive.

    Its metres count where they make a size of a shoe.

    Raises:
        DataError: Damaged; glTF 1; a file beside it is missing; nodes that hold each other.
    """
    return _Asset(path).build_mesh()


class _Asset:
    def __init__(self, path: Path) -> None:
        self.path, self.where = path, str(path)
        data = path.read_bytes()
        self.chunk: bytes | None = None
        if data[:4] == b"glTF":
            data = self._chunks(data)
        try:
            self.json: dict[str, Any] = json.loads(data)
        except (ValueError, RecursionError) as error:
            raise self._error(
                Message("the GLB file's description is no JSON ({error})", error=error)
            ) from error
        self.format = "GLB" if self.chunk is not None or path.suffix == ".glb" else "GLTF"
        self.unmet: dict[Unmet, None] = {}
        self.faces = 0

    def build_mesh(self) -> MeshFile:
        """Return the bodies of the scene."""
        try:
            self._demands()
            roots = self._roots()
            bodies = [body for n in roots for body in self._node(n, np.eye(4), (), True, ())]
        except KeyError as error:
            raise self._error(
                Message(
                    "the {format} file lacks {error}, which it needs",
                    format=self.format,
                    error=error,
                )
            ) from error
        except (IndexError, TypeError, ValueError, AttributeError, RecursionError) as error:
            raise self._error(
                Message(
                    "the {format} file contradicts itself ({error})",
                    format=self.format,
                    error=error,
                )
            ) from error
        unit, remarks = self._unit(bodies)
        return MeshFile(self.format, bodies, unit, tuple(self.unmet), remarks)

    def _chunks(self, data: bytes) -> bytes:
        version, length = np.frombuffer(data, "<u4", 2, 4) if len(data) >= 20 else (0, 0)
        if version != 2:
            raise self._error(
                Message("it is GLB of version {version}", version=version),
                "Export it as glTF 2.0",
                allowed="version 2",
            )
        if length > len(data):
            raise self._error(
                Message(
                    "it is cut short: {count} bytes of {length}", count=len(data), length=length
                )
            )
        place, text = 12, b""
        while place + 8 <= length:
            size, kind = (int(n) for n in np.frombuffer(data, "<u4", 2, place))
            content = data[place + 8 : place + 8 + size]
            if len(content) < size:
                raise self._error("a chunk of the GLB file is cut short")
            if kind == 0x4E4F534A and not text:
                text = content
            elif kind == 0x004E4942 and self.chunk is None:
                self.chunk = content
            place += 8 + size
        self.chunk = self.chunk or b""
        return text

    def _demands(self) -> None:
        version = str(self.json.get("asset", {}).get("version", ""))
        if not version.startswith("2."):
            raise self._error(
                Message('it is glTF of version "{version}"', version=version),
                "Export it as glTF 2.0",
                allowed="version 2",
            )
        required = set(self.json.get("extensionsRequired", ()))
        for name in sorted(required | set(self.json.get("extensionsUsed", ()))):
            # where packing is no demand, the numbers lie there unpacked too
            done = name not in required if name in _PACKED else name in _DONE
            if not done and not name.startswith(_LOOKS):
                self._unmet(Message("extension {name}", name=name), name in required)

    def _unmet(self, what: str, required: bool) -> None:
        packed = any(name in what for name in _PACKED)
        remedy = "Export it uncompressed (gltfpack without -c), or as STL" if packed else (
            "Export the outsole without it, or as STL"
        )  # fmt: skip
        self.unmet[Unmet(what, required, remedy)] = None

    def _roots(self) -> list[int]:
        scenes = self.json.get("scenes", [])
        if scenes:
            return list(scenes[self.json.get("scene", 0)].get("nodes", []))
        nodes = self.json.get("nodes", [])
        held = {child for node in nodes for child in node.get("children", ())}
        return [n for n in range(len(nodes)) if n not in held]

    def _node(
        self, number: int, place: Array, names: tuple[str, ...], shown: bool, above: tuple[int, ...]
    ) -> Iterator[FileBody]:
        if number in above:
            raise self._error(
                Message("its nodes hold each other: {number} is within itself", number=number)
            )
        node = self.json["nodes"][number]
        extensions = node.get("extensions", {})
        place = place @ _local(node)
        shown = shown and extensions.get(_HIDDEN, {}).get("visible", True)
        name = str(node.get("name", ""))
        if "mesh" in node:
            if "skin" in node:
                self._unmet("a skin that bends the mesh", required=True)
            parts = [self._primitive(*primitive) for primitive in self._primitives(node)]
            for instance in self._instances(extensions.get(_INSTANCES)):
                mesh = self.json["meshes"][node["mesh"]]
                for vertices, faces in parts:
                    self.faces += faces.shape[0]
                    if self.faces > MOST_UNFOLDED:
                        raise self._error(
                            Message(
                                "the {format} file unfolds to more than {most} faces",
                                format=self.format,
                                most=MOST_UNFOLDED,
                            ),
                            "Export the outsole alone, once",
                        )
                    own = name or str(mesh.get("name", ""))
                    layer = "/".join(filter(None, names))
                    yield FileBody(vertices, faces, own, layer, shown, "model", place @ instance)
        for child in node.get("children", ()):
            yield from self._node(child, place, (*names, name), shown, (*above, number))

    def _primitives(self, node: dict[str, Any]) -> Iterator[tuple[dict[str, Any], list[float]]]:
        mesh = self.json["meshes"][node["mesh"]]
        weights = node.get("weights", mesh.get("weights", []))
        for primitive in mesh["primitives"]:
            if primitive.get("mode", _TRIANGLES) >= _TRIANGLES:  # else points and lines
                yield primitive, weights

    def _primitive(self, primitive: dict[str, Any], weights: list[float]) -> tuple[Array, Any]:
        """Return vertices (n, 3) and faces (m, 3) of a primitive."""
        attributes = primitive["attributes"]
        if "POSITION" not in attributes:
            return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
        packed = primitive.get("extensions", {}).get(_DRACO)
        if packed is not None:
            vertices, order = self._unpack(packed, self.json["accessors"][attributes["POSITION"]])
        else:
            vertices = self._accessor(attributes["POSITION"])
            order = np.arange(vertices.shape[0])
            if "indices" in primitive:
                order = self._accessor(primitive["indices"]).astype(np.int64).ravel()
        if vertices.ndim != 2 or vertices.shape[1] != 3:
            raise self._error("the places of its corners are no vectors of three numbers")
        for target, weight in zip(primitive.get("targets", ()), weights, strict=False):
            if weight and "POSITION" in target:
                vertices = vertices + weight * self._accessor(target["POSITION"])
        mode = primitive.get("mode", _TRIANGLES)
        if mode == _TRIANGLES:
            faces = order[: order.size // 3 * 3].reshape(-1, 3)
        elif mode == _STRIP:
            faces = strip_faces(order)
        elif mode == _FAN:
            first = np.full(max(0, order.size - 2), order[0] if order.size else 0)
            faces = np.stack([order[1:-1], order[2:], first], axis=1)
        else:
            raise self._error(
                Message("a primitive has the mode {mode}", mode=mode), allowed="0 to 6"
            )
        return vertices, faces

    def _unpack(self, packed: dict[str, Any], shape: dict[str, Any]) -> tuple[Array, Any]:
        """Return vertices and indices that Draco packed, which come as triangles."""
        draco = optional_module(
            "DracoPy", "cad", Message("Reading the extension {name}", name=_DRACO)
        )
        try:
            mesh = draco.decode(bytes(self._view(packed["bufferView"])[0]))
            own = mesh.get_attribute_by_unique_id(packed["attributes"]["POSITION"])
            vertices, faces = np.asarray(own["data"]), np.asarray(mesh.faces)
        except Exception as error:  # whatever its parser meets
            raise self._error(
                Message("its mesh packed by Draco is damaged ({error})", error=error)
            ) from error
        if vertices.shape[0] != shape["count"]:
            raise self._error(
                Message(
                    "Draco unpacks {shape} vertices, {count} are promised",
                    shape=vertices.shape[0],
                    count=shape["count"],
                )
            )
        if shape.get("normalized"):
            vertices = _normalise(vertices)
        return vertices, faces.astype(np.int64).ravel()

    def _instances(self, accessor: dict[str, Any] | None) -> list[Array]:
        if accessor is None:
            return [np.eye(4)]
        rows = {name: self._accessor(n) for name, n in accessor["attributes"].items()}
        count = next(iter(rows.values())).shape[0]
        words = {"TRANSLATION": "translation", "ROTATION": "rotation", "SCALE": "scale"}
        return [
            _local({word: rows[name][n] for name, word in words.items() if name in rows})
            for n in range(count)
        ]

    def _accessor(self, number: int) -> Array:
        """Return the values of an accessor (n, width): strided, sparse, normalised."""
        accessor = self.json["accessors"][number]
        kind = np.dtype(_COMPONENTS[accessor["componentType"]])
        width, count = _WIDTHS[accessor["type"]], accessor["count"]
        if not 0 <= count <= 3 * MOST_UNFOLDED:
            raise self._error(Message("an accessor promises {count} values", count=count))
        values = np.zeros((count, width), dtype=kind)
        if "bufferView" in accessor:
            values = self._rows(accessor, kind, width, count)
        sparse = accessor.get("sparse")
        if sparse:
            values = values.copy()
            places = self._rows(
                sparse["indices"], np.dtype(_COMPONENTS[sparse["indices"]["componentType"]]), 1,
                sparse["count"],
            )  # fmt: skip
            values[places.ravel()] = self._rows(sparse["values"], kind, width, sparse["count"])
        return _normalise(values) if accessor.get("normalized") else values

    def _rows(self, accessor: dict[str, Any], kind: np.dtype, width: int, count: int) -> np.ndarray:
        data, stride = self._view(accessor["bufferView"])
        begin, size = accessor.get("byteOffset", 0), kind.itemsize * width
        stride = stride or size
        if count and (begin < 0 or begin + (count - 1) * stride + size > data.size):
            raise self._error("an accessor reaches beyond the bytes of its view: it is cut short")
        data = np.ascontiguousarray(data[begin:])
        rows = np.lib.stride_tricks.as_strided(data, (count, size), (stride, 1), writeable=False)
        return np.ascontiguousarray(rows).view(kind)

    def _view(self, number: int) -> tuple[np.ndarray, int]:
        """Return the bytes of a buffer view and their stride, 0 where they lie close."""
        accessor = self.json["bufferViews"][number]
        buffer = self.json["buffers"][accessor["buffer"]]
        for name in _PACKED:  # its own numbers unpacked, unless they are a stand-in without bytes
            stand_in = buffer.get("extensions", {}).get(name, {}).get("fallback")
            if stand_in and "uri" not in buffer and name in accessor.get("extensions", {}):
                self._unmet(Message("extension {name}", name=name), required=True)
        begin = accessor.get("byteOffset", 0)
        data = self._buffer(accessor["buffer"])
        if begin < 0 or begin + accessor["byteLength"] > data.size:
            if any(each.required for each in self.unmet):  # a packed file's stand-in
                return np.zeros(accessor["byteLength"], np.uint8), accessor.get("byteStride", 0)
            raise self._error("a buffer view reaches beyond its buffer: it is cut short")
        return data[begin : begin + accessor["byteLength"]], accessor.get("byteStride", 0)

    def _buffer(self, number: int) -> np.ndarray:
        uri = self.json["buffers"][number].get("uri")
        if uri is None:
            return np.frombuffer(self.chunk or b"", dtype=np.uint8)
        if uri.startswith("data:"):
            try:
                data = base64.b64decode(uri.partition(",")[2], validate=True)
            except binascii.Error as error:
                raise self._error("a buffer within the file is damaged") from error
            return np.frombuffer(data, dtype=np.uint8)
        beside = self.path.parent / unquote(uri)
        if not beside.is_file():
            raise self._error(
                Message('the file of its numbers "{uri}" is not there', uri=uri),
                "Put it beside the file, or export GLB, which holds all in one",
            )
        return np.fromfile(beside, dtype=np.uint8)

    def _unit(self, bodies: list[FileBody]) -> tuple[float | None, tuple[Message, ...]]:
        with np.errstate(invalid="ignore"):
            corners = [
                body.vertices.astype(np.float64) @ body.placement[:3, :3].T + body.placement[:3, 3]
                for body in bodies
                if body.visible and body.vertices.size
            ]
            if not corners:
                return None, ()
            size = float(np.ptp(np.concatenate(corners), axis=0).max())
        if _SHORTEST <= size <= _LONGEST:
            return 1.0, ()
        return None, (
            Message(
                "glTF is in metres, which would make this file {length:.4g} m long.", length=size
            ),
        )

    def _error(self, what: str, remedy: str = AGAIN, allowed: str | None = None) -> DataError:
        return DataError(what, where=self.where, allowed=allowed, remedy=remedy)


def strip_faces(order: np.ndarray) -> np.ndarray:
    """Return the triangles (n, 3) of a strip, every other one turned; flat joints left out."""
    faces = np.stack([order[:-2], order[1:-1], order[2:]], axis=1)
    faces[1::2] = faces[1::2, ::-1]
    a, b, c = faces.T
    return faces[(a != b) & (b != c) & (c != a)]


def _normalise(values: np.ndarray) -> Array:
    if values.dtype.kind == "f":
        return values
    return np.maximum(values / float(np.iinfo(values.dtype).max), -1.0)


def _local(node: dict[str, Any]) -> Array:
    """Return the matrix (4, 4) of a node or an instance."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = np.asarray(node.get("rotation", (0, 0, 0, 1)), dtype=np.float64)
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = turn * np.asarray(node.get("scale", (1, 1, 1)), dtype=np.float64)
    matrix[:3, 3] = np.asarray(node.get("translation", (0, 0, 0)), dtype=np.float64)
    return matrix
