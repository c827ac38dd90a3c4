"""STEP: exact surfaces with a unit, turned into triangles by netgen."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core import Cache, DataError, content_hash
from underfoot.core.files import checksum
from underfoot.core.optional import optional_module

from .mesh import Mesh

LONGEST_SIDE = 3.0
"""Of a triangle on a STEP surface, mm."""
SHORTEST_SIDE = 0.4
"""Wanted on rounded edges, mm."""
SIDES_PER_RADIUS = 5.0
"""A chord leaves a circle of radius R by R / 200 at most."""
_MILLIMETRE = 1e-3
_LOST_SHARE = 2e-3  # of the area: less is the chords' own


def read_step(path: Path) -> Mesh:
    """Return triangles on the surfaces of a STEP file, in mm (its own unit is converted).

    Sides are at most 3 mm and at most a fifth of the radius of curvature, but 0.4 mm need not be
    undercut: a chord is within 0.04 mm of a radius of 28 mm. The triangles are kept in the cache.

    Raises:
        DataError: No STEP geometry, no surfaces, or surfaces that cannot be turned into triangles.
    """
    cache = Cache("outsole_step-1")
    key = content_hash(checksum(path), [LONGEST_SIDE, SHORTEST_SIDE, SIDES_PER_RADIUS])
    stored = cache.load(key)
    if stored is None:
        triangles, remarks = _meshed(path)
        stored = {"triangles": triangles, "remarks": np.array(remarks, dtype=np.str_)}
        cache.store(key, stored)
    remarks = tuple(str(line) for line in stored["remarks"])
    return Mesh(stored["triangles"], "STEP", _MILLIMETRE, remarks)


def _meshed(path: Path) -> tuple[NDArray[np.float32], list[str]]:
    occ = optional_module("netgen.occ", "cad", "Reading STEP")
    meshing = optional_module("netgen.meshing", "cad", "Reading STEP")
    with _quiet(meshing.SetMessageImportance):
        try:
            geometry = occ.OCCGeometry(str(path))
        except Exception as error:  # netgen raises one class of its own for everything
            raise DataError(
                "the STEP file cannot be read: no geometry in it, or it is cut short or damaged",
                where=str(path),
                remedy="Export the outsole again as STEP AP214 or AP242",
            ) from error
        shape = geometry.shape
        faces, solids = list(shape.faces), list(shape.solids)
        if not faces:
            raise DataError(
                "the STEP file holds no surfaces (only curves, points or nothing)",
                where=str(path),
                remedy="Export the outsole as a solid",
            )
        exact = float(sum(face.mass for face in faces))
        try:
            mesh = geometry.GenerateMesh(
                maxh=LONGEST_SIDE,
                minh=SHORTEST_SIDE,
                curvaturesafety=SIDES_PER_RADIUS,
                perfstepsend=meshing.MeshingStep.MESHSURFACE,
                optsteps2d=1,
            )
            triangles = _corners(mesh)
        except Exception:
            triangles = np.zeros((0, 3, 3), np.float32)
        meshed = _area(triangles)
        remarks = [_inventory(len(solids), len(faces))]
        if meshed < (1 - _LOST_SHARE) * exact:
            drawn = _drawing_triangles(shape)
            lost = 1 - max(meshed, _area(drawn)) / exact
            if _area(drawn) > meshed:
                triangles = drawn
                remarks.append(
                    "Some of its surfaces could not be meshed finely; the coarser triangles for "
                    "drawing were taken: roundings may be off by tenths of a millimetre."
                )
            if lost > _LOST_SHARE:
                remarks.append(f"{lost:.1%} of the area of its surfaces could not be meshed.")
    if triangles.shape[0] == 0:
        raise DataError(
            "the surfaces of the STEP file could not be turned into triangles",
            where=str(path),
            remedy="Export the outsole as STL from the design software",
        )
    return triangles, remarks


def _inventory(solids: int, faces: int) -> str:
    surfaces = f"{faces} surface" + ("s" if faces != 1 else "")
    if solids == 0:
        return (
            f"The STEP file holds {surfaces} and no solid; a height map needs no solid, so the "
            "surfaces were taken as they are."
        )
    return f"The STEP file holds {solids} solid" + ("s" if solids > 1 else "") + f", {surfaces}."


def _corners(mesh: Any) -> NDArray[np.float32]:
    points = np.asarray(mesh.Coordinates(), dtype=np.float64)
    nodes = np.asarray(mesh.Elements2D().NumPy()["nodes"], dtype=np.int64)[:, :3] - 1
    return np.ascontiguousarray(points[nodes], dtype=np.float32)


def _drawing_triangles(shape: Any) -> NDArray[np.float32]:
    """Return the triangles that OCC makes for drawing: coarse, but of every surface it can draw."""
    data = shape._webgui_data()["Bezier_trig_points"]
    corners = [np.asarray(data[n], dtype=np.float32).reshape(-1, 4)[:, :3] for n in range(3)]
    return np.ascontiguousarray(np.stack(corners, axis=1))


def _area(triangles: NDArray[np.float32]) -> float:
    sides = triangles[:, 1:] - triangles[:, :1]
    return float(np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum() / 2)


@contextmanager
def _quiet(set_importance: Callable[[int], None]) -> Iterator[None]:
    """Silence what the C++ libraries print: the exceptions carry their own text."""
    sys.stdout.flush()
    standard_output = os.dup(1)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        set_importance(0)
        yield
    finally:
        os.dup2(standard_output, 1)
        os.close(standard_output)
        os.close(nowhere)
