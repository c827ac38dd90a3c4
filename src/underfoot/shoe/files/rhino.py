"""3DM, the files of Rhino: meshes, and surfaces by the meshes Rhino saved with them."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError
from underfoot.core.arrays import Array
from underfoot.core.optional import optional_module
from underfoot.core.remark import Message

from .mesh import MOST_UNFOLDED, FileBody, MeshFile, Unmet

_UNITS = {
    "Angstroms": 1e-10,
    "Nanometers": 1e-9,
    "Microns": 1e-6,
    "Millimeters": 1e-3,
    "Centimeters": 1e-2,
    "Decimeters": 0.1,
    "Meters": 1.0,
    "Dekameters": 10.0,
    "Hectometers": 100.0,
    "Kilometers": 1e3,
    "Microinches": 25.4e-9,
    "Mils": 25.4e-6,
    "Inches": 0.0254,
    "Feet": 0.3048,
    "Yards": 0.9144,
    "Miles": 1609.344,
}
_SHADE = (
    "In Rhino, shade the view and save without the option 'Save small', or export the outsole as "
    "STEP"
)


def read_rhino(path: Path) -> MeshFile:
    """Return the objects of a 3DM file, those within blocks too, by their layers and names.

    Surfaces, polysurfaces and extrusions count by the render meshes that Rhino saves with them.
    Within a block a member has its own layer, visibility and name.

    Raises:
        DataError: Damaged; nothing in it has a mesh; blocks that hold each other.
    """
    rhino = optional_module("rhino3dm", "cad", "Reading 3DM")
    try:
        model = rhino.File3dm.Read(str(path))
    except Exception as error:
        raise DataError(
            Message("the 3DM file cannot be read ({error})", error=error), where=str(path)
        ) from error
    if model is None:
        raise DataError(
            "the 3DM file cannot be read: it is cut short or damaged",
            where=str(path),
            remedy="Save it again in Rhino",
        )
    reader = _Reader(rhino, model, str(path))
    bodies = [body for item in model.Objects if not _of_block(item)
              for body in reader.bodies(item, np.eye(4), "", True, ())]  # fmt: skip
    if not bodies and not reader.unmet:
        what = Message("the 3DM file holds no meshes and no surfaces")
        if reader.bare:
            what = Message("the 3DM file holds {count} surfaces without a mesh", count=reader.bare)
        raise DataError(what, where=str(path), remedy=_SHADE)
    if reader.bare:
        reader.unmet[
            Unmet(
                Message("{count} surfaces without a saved mesh", count=reader.bare), False, _SHADE
            )
        ] = None
    unit = _UNITS.get(str(model.Settings.ModelUnitSystem).rsplit(".", 1)[-1])
    return MeshFile("3DM", bodies, unit, tuple(reader.unmet))


def _of_block(item: Any) -> bool:
    return bool(item.Attributes.IsInstanceDefinitionObject)


@dataclass
class _Reader:
    rhino: Any
    model: Any
    where: str
    bare: int = 0
    faces: int = 0
    unmet: dict[Unmet, None] = field(default_factory=dict)

    def bodies(
        self, item: Any, place: Array, within: str, shown: bool, above: tuple[str, ...]
    ) -> Iterator[FileBody]:
        """Yield the bodies of an object or of the members of a block, placed.

        Parameters:
            within: Layer and name of the block's instance: those of members without their own.
            shown: Whether what holds it is visible.
            above: The blocks that hold it.
        """
        attributes, geometry = item.Attributes, item.Geometry
        shown = shown and bool(attributes.Visible)
        mode = str(getattr(attributes, "Mode", "")).rsplit(".", 1)[-1]
        shown = shown and mode != "Hidden"
        layer, visible = self._layer(attributes.LayerIndex)
        shown = shown and visible
        name = attributes.Name or ""
        if isinstance(geometry, self.rhino.InstanceReference):
            yield from self._members(geometry, place, name or within, shown, above)
            return
        for corners, faces in self._meshes(geometry, shown):
            self.faces += faces.shape[0]
            if self.faces > MOST_UNFOLDED:
                raise DataError(
                    Message("the 3DM file unfolds to more than {most} faces", most=MOST_UNFOLDED),
                    where=self.where,
                    remedy="Export the outsole alone, once",
                )
            yield FileBody(corners, faces, name or within, layer, shown, "model", place)

    def _members(
        self, reference: Any, place: Array, within: str, shown: bool, above: tuple[str, ...]
    ) -> Iterator[FileBody]:
        identity = str(reference.ParentIdefId)
        if identity in above:
            raise DataError(
                "its blocks hold each other",
                where=self.where,
                remedy="Explode the blocks in Rhino and save again",
            )
        block = self.model.InstanceDefinitions.FindId(reference.ParentIdefId)
        members = list(block.GetObjectIds()) if block else []
        if not members and shown:
            source = getattr(block, "SourceArchive", "") if block else ""
            what = (
                Message('the linked file "{source}"', source=source)
                if source
                else "a block that is not in it"
            )
            self.unmet[Unmet(what, True, "Embed the block in Rhino and save again")] = None
        inner = place @ np.array(reference.Xform.ToFloatArray(True), dtype=float).reshape(4, 4)
        for member in members:
            item = self.model.Objects.FindId(str(member))
            if item is not None:
                yield from self.bodies(item, inner, within, shown, (*above, identity))

    def _layer(self, index: int) -> tuple[str, bool]:
        """Return the path of a layer, and whether it and all that hold it are on."""
        layers = self.model.Layers
        if not 0 <= index < len(layers):
            return "", True
        layer = layers[index]
        visible, parent, path = bool(layer.Visible), layer, layer.FullPath
        by_id = {str(each.Id): each for each in layers}
        for _ in range(len(layers)):
            parent = by_id.get(str(parent.ParentLayerId))
            if parent is None:
                break
            visible = visible and bool(parent.Visible)
        return path, visible

    def _meshes(self, geometry: Any, shown: bool) -> Iterator[tuple[Array, np.ndarray]]:
        """Yield vertices and triangles of an object; count its surfaces without a mesh."""
        soups = []
        for mesh in _saved_meshes(self.rhino, geometry):
            if mesh is None:
                self.bare += shown
                continue
            soups.append(_mesh(mesh))
        if soups:
            starts = np.cumsum([0, *(corners.shape[0] for corners, _ in soups[:-1])])
            yield (
                np.concatenate([corners for corners, _ in soups]),
                np.concatenate([f + n for (_, f), n in zip(soups, starts, strict=True)]),
            )


def _mesh(mesh: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices and triangles of a mesh; a quadrilateral is cut where it stays within."""
    points = [mesh.Vertices[n] for n in range(len(mesh.Vertices))]
    corners = np.array([(p.X, p.Y, p.Z) for p in points], dtype=np.float64).reshape(-1, 3)
    single = corners.astype(np.float32)
    faces = np.array([mesh.Faces[n] for n in range(len(mesh.Faces))], dtype=np.int64)
    faces = faces.reshape(-1, 4)
    four = faces[:, 2] != faces[:, 3]
    quads = faces[four]
    cut = _cut(corners, quads)
    # what single precision holds is said to be no more: far off the origin it is too coarse
    return (
        single if np.array_equal(single, corners) else corners,
        np.concatenate([faces[~four, :3], cut]),
    )


def _cut(corners: Array, quads: np.ndarray) -> np.ndarray:
    """Return the triangles of quadrilaterals, cut across the corner that points inward."""
    a, b, c, d = (corners[quads[:, n]] for n in range(4))
    first = np.cross(b - a, c - a), np.cross(c - a, d - a)
    folded = np.einsum("nk,nk->n", *first) < 0
    turned = np.where(folded[:, None], np.roll(quads, -1, axis=1), quads)
    return np.concatenate([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]])


def _saved_meshes(rhino: Any, geometry: Any) -> Iterator[Any]:
    """Yield the mesh of each surface of an object, None where none was saved."""
    if isinstance(geometry, rhino.Mesh):
        yield geometry
    elif isinstance(geometry, rhino.Brep):
        for number in range(len(geometry.Faces)):
            yield geometry.Faces[number].GetMesh(rhino.MeshType.Any)
    elif isinstance(geometry, rhino.Extrusion):
        yield geometry.GetMesh(rhino.MeshType.Any)
    elif isinstance(geometry, rhino.SubD | rhino.Surface):
        yield None
