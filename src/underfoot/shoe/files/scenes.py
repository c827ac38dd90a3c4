"""OBJ, PLY, OFF, GLB, GLTF and 3MF: scenes of named meshes, as trimesh reads them."""

import logging
import re
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import DataError
from underfoot.core.optional import optional_module

from .mesh import Mesh

AGAIN = "It may be cut short or damaged: export the outsole again"
_LONGEST, _SHORTEST = 2.0, 0.02  # m: what glTF may hold when its metres are meant


def read_scene(path: Path, kind: str) -> Mesh:
    """Return the triangles of an OBJ, PLY, OFF, GLB, GLTF or 3MF file; polygons as triangles.

    3MF states its unit; glTF prescribes metres, which counts where it makes a size of a shoe.

    Raises:
        DataError: Damaged, or points without faces.
    """
    trimesh = optional_module("trimesh", "cad", f"Reading {kind}")
    if kind == "3MF":
        optional_module("lxml", "cad", "Reading 3MF")
        optional_module("networkx", "cad", "Reading 3MF")
    options: dict[str, Any] = {"process": False}
    if kind == "OBJ":
        options |= {"skip_materials": True, "split_objects": True, "split_groups": True}
    logging.getLogger("trimesh").addHandler(logging.NullHandler())
    try:
        if kind == "GLTF":  # its numbers lie in a file beside it
            scene = trimesh.load_scene(path, file_type="gltf", **options)
        else:
            with path.open("rb") as stream:
                scene = trimesh.load_scene(stream, file_type=kind.lower(), **options)
        parts = _parts(scene)
    except Exception as error:  # trimesh raises whatever its parser meets
        raise DataError(f"the {kind} file cannot be read", where=str(path), remedy=AGAIN) from error
    if not parts:
        content = _points_alone(path, kind)
        raise DataError(
            f"the {kind} file holds {content}",
            where=str(path),
            remedy="Mesh the scan in the scanner's software and export it as STL or PLY",
        )
    soups = []
    for _, vertices, faces in parts:
        if faces.min() < 0 or faces.max() >= vertices.shape[0]:
            raise DataError(
                f"a face names corner {faces.max()} of {vertices.shape[0]}",
                where=str(path),
                remedy=AGAIN,
            )
        soups.append(np.ascontiguousarray(vertices[faces], dtype=np.float32))
    unit, remarks = None, []
    if kind == "3MF":
        unit = trimesh.units.unit_conversion(scene.units or "millimeters", "meters")
    elif kind in ("GLB", "GLTF"):
        size = float(np.ptp(np.concatenate([s.reshape(-1, 3) for s in soups]), axis=0).max())
        unit = 1.0 if _SHORTEST <= size <= _LONGEST else None
        if unit is None:
            remarks.append(f"glTF is in metres, which would make this file {size:.4g} m long.")
    body = np.repeat(np.arange(len(soups), dtype=np.int32), [s.shape[0] for s in soups])
    several = len(soups) > 1
    return Mesh(
        triangles=np.concatenate(soups),
        format=kind,
        unit=unit,
        remarks=tuple(remarks),
        bodies=tuple(name for name, _, _ in parts) if several else (),
        body=body if several else None,
    )


def _parts(scene: Any) -> list[tuple[str, np.ndarray, np.ndarray]]:
    """Return name, vertices (n, 3) and faces (n, 3) of each mesh where it stands in the scene."""
    parts = []
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name]
        faces = np.asarray(getattr(mesh, "faces", np.zeros((0, 3))), dtype=np.int64).reshape(-1, 3)
        if faces.shape[0] == 0:
            continue
        vertices = np.asarray(mesh.vertices, dtype=np.float64)
        parts.append((str(node), vertices @ matrix[:3, :3].T + matrix[:3, 3], faces))
    return parts


def _points_alone(path: Path, kind: str) -> str:
    """Return how many points a file without faces holds, in words."""
    if kind == "PLY":
        head = path.read_bytes()[:4096].split(b"end_header")[0]
        count_line = re.search(rb"element vertex (\d+)", head)
        count = int(count_line[1]) if count_line else 0
    elif kind == "OBJ":
        count = len(re.findall(rb"^v\s", path.read_bytes(), re.MULTILINE))
    else:
        count = 0
    return f"{count} points and no faces" if count else "no faces"
