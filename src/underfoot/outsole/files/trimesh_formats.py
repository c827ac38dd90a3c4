"""OBJ and PLY, read by trimesh."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from underfoot.core import DataError

from .mesh import Mesh


def read_with_trimesh(path: Path) -> Mesh:
    """Return the triangles of an OBJ or PLY file; polygons come as triangles.

    Errors
    ------
    DataError
        Damaged, or points without faces.
    """
    import trimesh

    with path.open("rb") as stream:
        kind = "PLY" if stream.read(16).lstrip().startswith(b"ply") else "OBJ"
        stream.seek(0)
        try:
            found = trimesh.load(stream, file_type=kind.lower(), process=False, force="mesh")
        except Exception as error:  # trimesh raises whatever its parser meets
            raise DataError(
                f"the {kind} file can't be read ({type(error).__name__}: {error})",
                where=str(path),
                remedy="It may be cut short or damaged: export the outsole again",
            ) from error
    vertices = np.asarray(getattr(found, "vertices", np.zeros((0, 3))), dtype=np.float32)
    faces = np.asarray(getattr(found, "faces", np.zeros((0, 3))), dtype=np.int64).reshape(-1, 3)
    if faces.shape[0] == 0:
        points = _points_alone(path, kind)
        raise DataError(
            f"the {kind} file holds {points}",
            where=str(path),
            remedy="Mesh the scan in the scanner's software and export it as STL or PLY",
        )
    if faces.min() < 0 or faces.max() >= vertices.shape[0]:
        raise DataError(
            f"a face names corner {faces.max()} of {vertices.shape[0]}",
            where=str(path),
            remedy="It may be cut short or damaged: export the outsole again",
        )
    return Mesh(np.ascontiguousarray(vertices[faces]), kind)


def _points_alone(path: Path, kind: str) -> str:
    """Return how many points a file without faces holds, in words."""
    if kind == "PLY":
        head = path.read_bytes()[:4096].split(b"end_header")[0]
        told = re.search(rb"element vertex (\d+)", head)
        count = int(told[1]) if told else 0
    else:
        count = len(re.findall(rb"^v\s", path.read_bytes(), re.MULTILINE))
    return f"{count} points and no faces" if count else "no faces"
