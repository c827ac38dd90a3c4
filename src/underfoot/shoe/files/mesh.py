"""What a mesh file says, body by body, and the triangles that are made of it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError
from underfoot.core.arrays import Array
from underfoot.core.remark import Message

AGAIN = "It may be cut short or damaged: export the outsole again"
MOST_UNFOLDED = 20_000_000
"""Faces of a file with all its instances; more is no sole."""
_FAR = 16.0  # extents from the origin: single precision there loses what shows on a sole
_COARSE, _TOO_COARSE = 3e-5, 2e-4  # step of the coordinates over the longest extent
_SAMPLE = 20_000

Kind = Literal["model", "support", "modifier"]


@dataclass(frozen=True, slots=True)
class Unmet:
    """Something a file asks for that was not done.

    Parameters:
        what: Its name in the format, as "extension KHR_draco_mesh_compression".
        required: Whether the geometry is another one without it.
        remedy: What to export instead.
    """

    what: str
    required: bool
    remedy: str = "Export the outsole without it, or as STEP or STL"


@dataclass(frozen=True, slots=True)
class FileBody:
    """A body as its format describes it.

    Parameters:
        vertices: (n, 3) in its own frame; float32 where the file holds no more.
        faces: (m, 3) numbers of vertices; None: three vertices in a row make a face.
        name, layer: "" where the format has none; layers, groups and parents joined by "/".
        visible: False: hidden, switched off or not to be printed.
        kind: "model"; "support" and "modifier" are no part of the shape.
        placement: (4, 4) from its frame to the file's; a mirroring one turns its faces over.
    """

    vertices: NDArray[np.floating]
    faces: NDArray[np.integer] | None = None
    name: str = ""
    layer: str = ""
    visible: bool = True
    kind: Kind = "model"
    placement: Array = field(default_factory=lambda: np.eye(4))

    @property
    def label(self) -> str:
        """Layer and name, "Rubber/Outsole"."""
        return "/".join(part for part in (self.layer, self.name) if part)

    @property
    def size(self) -> int:
        """How many faces it has."""
        return self.vertices.shape[0] // 3 if self.faces is None else self.faces.shape[0]

    def triangles(self, origin: Array) -> NDArray[np.float32]:
        """Return its triangles (n, 3, 3) where they lie in the file, from ``origin``."""
        matrix, shift = self.placement[:3, :3], self.placement[:3, 3] - origin
        points = self.vertices
        if points.dtype != np.float32 or shift.any() or not np.array_equal(matrix, np.eye(3)):
            with np.errstate(invalid="ignore", over="ignore"):
                points = (points @ matrix.T + shift).astype(np.float32)
        soup = points.reshape(-1, 3, 3) if self.faces is None else points[self.faces]
        if np.linalg.det(matrix) < 0:
            soup = soup[:, ::-1]
        return np.ascontiguousarray(soup, dtype=np.float32)


@dataclass(frozen=True, slots=True)
class MeshFile:
    """What a file says.

    Parameters:
        format: "STL (binary)", "3MF", "OBJ" and so on.
        bodies: All of them, hidden ones and helpers too.
        unit: Length of the file's unit in m, None when the format does not say.
        unmet: What the file asks for that the reader did not do.
        remarks: Remarks of the reader, sentences.
    """

    format: str
    bodies: Sequence[FileBody]
    unit: float | None = None
    unmet: tuple[Unmet, ...] = ()
    remarks: tuple[Message, ...] = ()


@dataclass(frozen=True, slots=True)
class Mesh:
    """Triangles of the visible model of a file.

    Parameters:
        triangles: (n, 3, 3) float32: triangle, corner, coordinate, in the unit of the file.
        format: "STL (binary)", "STL (text)", "STEP", "OBJ" and so on.
        unit: Length of the file's unit in m, None when the format does not say.
        remarks: Remarks of the reader, sentences.
        bodies: Names of the bodies in the file, "" where it has none; () when it tells no bodies.
        body: (n,) number of the body of each triangle; None when the file tells no bodies.
        origin: Of the triangles in the file's coordinates; far from zero single precision would
            lose the tread.
        unmet: Optional things the file asks for that were not done.
    """

    triangles: NDArray[np.float32]
    format: str
    unit: float | None = None
    remarks: tuple[Message, ...] = ()
    bodies: tuple[str, ...] = ()
    body: NDArray[np.int32] | None = None
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    unmet: tuple[Unmet, ...] = ()


def assemble_mesh(file: MeshFile, where: str) -> Mesh:
    """Return the triangles of what is visible and model in a file, placed.

    Raises:
        DataError: Something required was not done; nothing is visible; no faces; a face names a
            vertex that is not there; coordinates too coarse so far from the origin.
    """
    required = [each for each in file.unmet if each.required]
    if required:
        names = ", ".join(dict.fromkeys(each.what for each in required))
        raise DataError(
            Message(
                "the {format} file needs {names}, which is not read: its shape would be another",
                format=file.format,
                names=names,
            ),
            where=where,
            remedy=required[0].remedy,
        )
    filled = [body for body in file.bodies if body.size]
    shown = [body for body in filled if body.visible and body.kind == "model"]
    left = [body for body in filled if not (body.visible and body.kind == "model")]
    if left and not shown:
        raise DataError(
            Message(
                "the {format} file shows no model: {kinds}", format=file.format, kinds=_kinds(left)
            ),
            where=where,
            remedy="Make the outsole visible, or a part of the model, and export again",
        )
    if not shown:
        raise DataError(
            Message("the {format} file holds no faces", format=file.format), where=where
        )
    for body in shown:
        _check(body, file.format, where)
    origin, remarks = _origin(shown, where)
    soups = [body.triangles(origin) for body in shown]
    labels = _labels(shown)
    several = len(shown) > 1
    named = several or bool(labels[0])
    told = [Message("{bodies} left out.", bodies=_kinds(left))] if left else []
    told += [
        Message("Not done, as the file may do without: {what}.", what=each.what)
        for each in file.unmet
    ]
    return Mesh(
        triangles=soups[0] if not several else np.concatenate(soups),
        format=file.format,
        unit=file.unit,
        remarks=(*file.remarks, *told, *remarks),
        bodies=tuple(labels) if named else (),
        body=np.repeat(np.arange(len(soups), dtype=np.int32), [soup.shape[0] for soup in soups])
        if named
        else None,
        origin=(float(origin[0]), float(origin[1]), float(origin[2])),
        unmet=file.unmet,
    )


def _check(body: FileBody, kind: str, where: str) -> None:
    faces, count = body.faces, body.vertices.shape[0]
    if faces is not None and (faces.min() < 0 or faces.max() >= count):
        bad = int(faces.max()) if faces.max() >= count else int(faces.min())
        raise DataError(
            Message(
                "a face of the {kind} file names vertex {bad} of {count}",
                kind=kind,
                bad=bad,
                count=count,
            ),
            where=where,
            remedy=AGAIN,
        )


def _kinds(left: Iterable[FileBody]) -> Message:
    """Return bodies that are no visible model by what they are, in words."""
    groups: dict[str, list[str]] = {}
    for body in left:
        groups.setdefault(body.kind if body.kind != "model" else "hidden", []).append(body.label)
    words = []
    for kind, names in groups.items():
        known = [Message('"{name}"', name=name) for name in dict.fromkeys(filter(None, names))][:4]
        words.append(
            Message(
                "{count} {kind} {count:body|bodies}{names}",
                count=len(names),
                kind=kind,
                names=Message(" ({names})", names=known) if known else "",
            )
        )
    return Message("{bodies: and }", bodies=words)


def _labels(bodies: Sequence[FileBody]) -> list[str]:
    """Return the bodies' labels without the layers that all of them share."""
    layers = [body.layer.split("/") if body.layer else [] for body in bodies]
    common = 0
    if len(bodies) > 1:
        while all(len(each) > common and each[common] == layers[0][common] for each in layers):
            common += 1
    return [
        "/".join(part for part in (*layer[common:], body.name) if part)
        for layer, body in zip(layers, bodies, strict=True)
    ]


def _origin(bodies: Sequence[FileBody], where: str) -> tuple[Array, list[Message]]:
    """Return where coordinates count from and a remark where the file holds them coarsely."""
    with np.errstate(over="ignore", invalid="ignore"):
        sampled = []
        for body in bodies:
            part = body.vertices[:: max(1, body.vertices.shape[0] * len(bodies) // _SAMPLE)]
            part = part.astype(np.float64)
            sampled.append(part @ body.placement[:3, :3].T + body.placement[:3, 3])
        points = np.concatenate(sampled)
    points = points[np.isfinite(points).all(axis=1)]
    if points.shape[0] == 0:
        return np.zeros(3), []
    low, middle, high = np.percentile(points, (1, 50, 99), axis=0)
    size = float((high - low).max())
    step = max(_step(body) for body in bodies)
    if size > 0 and step > _COARSE * size:
        steps = Message(
            "its coordinates hold steps of {step:.2g}, {share:.1e} of its length",
            step=step,
            share=step / size,
        )
        if step > _TOO_COARSE * size:
            raise DataError(
                Message(
                    "{steps}: so far from the origin single precision loses the tread", steps=steps
                ),
                where=where,
                remedy="Move it to the origin in the program it comes from, and export again",
            )
        return middle, [Message("So far from the origin {steps}.", steps=steps)]
    return (middle if float(np.abs(middle).max()) > _FAR * size else np.zeros(3)), []


def _step(body: FileBody) -> float:
    """Return the step between the numbers that a body's single precision can tell; 0 for double."""
    if body.vertices.dtype != np.float32 or body.vertices.shape[0] == 0:
        return 0.0
    part = body.vertices[:: max(1, body.vertices.shape[0] // _SAMPLE)]
    part = part[np.isfinite(part).all(axis=1)]
    scale = float(np.abs(body.placement[:3, :3]).max())
    return float(np.spacing(np.float32(np.median(np.abs(part).max(axis=1))))) * scale if part.size \
        else 0.0  # fmt: skip
