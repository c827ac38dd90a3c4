"""3DM, the files of Rhino: meshes, and surfaces by the meshes Rhino saved with them."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError
from underfoot.core.arrays import Array
from underfoot.core.optional import optional_module

from .mesh import Mesh

_UNITS = {
    "Millimeters": 1e-3,
    "Centimeters": 1e-2,
    "Meters": 1.0,
    "Inches": 0.0254,
    "Feet": 0.3048,
    "Microns": 1e-6,
}
_DEEPEST = 20  # blocks within blocks


def read_rhino(path: Path) -> Mesh:
    """Return the triangles of a 3DM file; each visible object is a body named "layer/object".

    Surfaces, polysurfaces and extrusions count by the render meshes that Rhino saves with them.

    Raises:
        DataError: Damaged, or nothing in it has a mesh.
    """
    rhino = optional_module("rhino3dm", "cad", "Reading 3DM")
    try:
        model = rhino.File3dm.Read(str(path))
    except Exception as error:
        raise DataError(f"the 3DM file cannot be read ({error})", where=str(path)) from error
    if model is None:
        raise DataError(
            "the 3DM file cannot be read: it is cut short or damaged",
            where=str(path),
            remedy="Save it again in Rhino",
        )
    names, soups, bare, hidden = [], [], 0, 0
    identity = np.eye(4)
    for item in model.Objects:
        attributes = item.Attributes
        layer = _layer(model, attributes.LayerIndex)
        if attributes.IsInstanceDefinitionObject:
            continue
        if not attributes.Visible or (layer is not None and not layer.Visible):
            hidden += 1
            continue
        soup, without = _soup(rhino, model, item.Geometry, identity, 0)
        bare += without
        if soup:
            label = "/".join(part for part in (layer.FullPath if layer else "", attributes.Name)
                             if part)  # fmt: skip
            names.append(label)
            soups.append(np.concatenate(soup).astype(np.float32))
    if not soups:
        what = f"{bare} surfaces without a mesh" if bare else "no meshes and no surfaces"
        raise DataError(
            f"the 3DM file holds {what}",
            where=str(path),
            remedy="In Rhino, shade the view and save without the option 'Save small', or export "
            "the outsole as STEP",
        )
    remarks = []
    if bare:
        remarks.append(f"{bare} surfaces of the 3DM file have no saved mesh and were left out.")
    if hidden:
        remarks.append(f"{hidden} hidden objects of the 3DM file were left out.")
    unit = _UNITS.get(str(model.Settings.ModelUnitSystem).rsplit(".", 1)[-1])
    return Mesh(
        triangles=np.concatenate(soups),
        format="3DM",
        unit=unit,
        remarks=tuple(remarks),
        bodies=tuple(names),
        body=np.repeat(np.arange(len(soups), dtype=np.int32), [s.shape[0] for s in soups]),
    )


def _layer(model: Any, index: int) -> Any:
    return model.Layers[index] if 0 <= index < len(model.Layers) else None


def _soup(
    rhino: Any, model: Any, geometry: Any, place: Array, depth: int
) -> tuple[list[Array], int]:
    """Return the triangles of an object, placed, and how many of its surfaces have no mesh."""
    if isinstance(geometry, rhino.InstanceReference) and depth < _DEEPEST:
        block = model.InstanceDefinitions.FindId(geometry.ParentIdefId)
        inner = place @ np.array(geometry.Xform.ToFloatArray(True), dtype=float).reshape(4, 4)
        soups, bare = [], 0
        for identity in block.GetObjectIds() if block else ():
            member = model.Objects.FindId(str(identity))
            if member is not None:
                more, without = _soup(rhino, model, member.Geometry, inner, depth + 1)
                soups, bare = soups + more, bare + without
        return soups, bare
    soups, bare = [], 0
    for mesh in _meshes(rhino, geometry):
        if mesh is None:
            bare += 1
            continue
        count = len(mesh.Vertices)
        points = [mesh.Vertices[n] for n in range(count)]
        corners = np.array([(p.X, p.Y, p.Z) for p in points]).reshape(-1, 3)
        faces = np.array([mesh.Faces[n] for n in range(len(mesh.Faces))], dtype=int).reshape(-1, 4)
        quads = faces[faces[:, 2] != faces[:, 3]]
        faces = np.concatenate([faces[:, :3], quads[:, [0, 2, 3]]])
        soups.append((corners @ place[:3, :3].T + place[:3, 3])[faces])
    return soups, bare


def _meshes(rhino: Any, geometry: Any) -> Iterator[Any]:
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
