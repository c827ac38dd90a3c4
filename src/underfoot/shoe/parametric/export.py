"""Soles as files for the CAD, the printer and the mould maker."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import InputError, UnderfootError
from underfoot.core.optional import optional_module

from ..shape import SoleShape
from .modelling import MM, kernel
from .solid import SoleSolid, sole_solid

WRITING = "Writing the solid of a sole"
KINDS = (".step", ".stp", ".stl", ".obj", ".ply")
VOLUME_TOLERANCE = 1e-2
"""Largest relative difference of a mesh's volume from the solid's: flat triangles, round parts."""


@dataclass(frozen=True, slots=True)
class SoleFile:
    """What was written and how it was checked by reading it again.

    ``volume`` (m^3) is that of the solid, ``read_volume`` that of the file; ``triangles`` is 0 for
    STEP. Files are in mm.
    """

    path: Path
    volume: float
    read_volume: float
    triangles: int
    lugs: int
    remarks: tuple[str, ...]


def write_sole(shape: SoleShape, path: Path | str, *, solid: SoleSolid | None = None) -> SoleFile:
    """Write the new sole as STEP, STL, OBJ or PLY in mm and read it back.

    Parameters:
        shape: The sole in metres.
        path: Ends with the kind of file.
        solid: Of the same shape, where it was made already.

    Raises:
        InputError: Another kind of file; a sole that cannot be made.
        UnderfootError: The file read back is not the solid: not watertight, or of another volume.
    """
    path = Path(path)
    kind = path.suffix.lower()
    if kind not in KINDS:
        raise InputError(
            f'"{path.suffix}" is no kind of file for a sole',
            where="--out",
            allowed=", ".join(KINDS),
        )
    made = solid or sole_solid(shape)
    if kind in (".step", ".stp"):
        made.body.WriteStep(str(path))
        volume, triangles, tolerance = float(kernel().OCCGeometry(str(path)).shape.mass), 0, 1e-6
    else:
        surface = sole_mesh(made)
        surface.export(str(path))
        back = _read(path)
        if not back.is_watertight:
            raise UnderfootError(
                "the mesh of the sole is not watertight",
                where=str(path),
                remedy="Write a STEP file instead.",
            )
        volume, triangles, tolerance = float(back.volume), len(back.faces), VOLUME_TOLERANCE
    volume /= MM**3
    if abs(volume / made.volume - 1) > tolerance:
        raise UnderfootError(
            f"the file holds {volume * 1e6:.3f} cm3, the solid {made.volume * 1e6:.3f} cm3",
            where=str(path),
        )
    return SoleFile(path, made.volume, volume, triangles, made.lugs, made.remarks)


def sole_mesh(made: SoleSolid) -> Any:
    """Return the triangles of a solid (``trimesh.Trimesh``, mm), corners joined."""
    trimesh = optional_module("trimesh", "cad", WRITING)

    # the kernel hands its triangles out only for drawing: corners as (x, y, z, number of face)
    drawn = made.body._webgui_data()["Bezier_trig_points"][:3]
    corners = np.stack([np.array(each).reshape(-1, 4)[:, :3] for each in drawn], axis=1)
    corners = corners.reshape(-1, 3)
    # corners of one edge come from both of its faces, equal within the kernel's tolerance
    for decimals in (6, 5, 4, 3):
        joined, index = np.unique(np.round(corners, decimals), axis=0, return_inverse=True)
        faces = np.asarray(index).reshape(-1, 3)
        proper = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
        candidate = trimesh.Trimesh(joined, faces[proper], process=False)
        if candidate.is_watertight:
            return candidate
    return _meshed(made)


def _meshed(made: SoleSolid) -> Any:
    """Return the surface mesh of the finite-element mesher: slower, but closed on any solid."""
    trimesh = optional_module("trimesh", "cad", WRITING)
    step = optional_module("netgen.meshing", "cad", WRITING).MeshingStep.MESHSURFACE

    mesh = kernel().OCCGeometry(made.body).GenerateMesh(maxh=5.0, perfstepsend=step)
    points = np.array([point.p for point in mesh.Points()])
    faces = np.array([[v.nr - 1 for v in part.vertices] for part in mesh.Elements2D()])
    return trimesh.Trimesh(points, faces, process=False)


def _read(path: Path) -> Any:
    trimesh = optional_module("trimesh", "cad", WRITING)

    return trimesh.load_mesh(str(path))
