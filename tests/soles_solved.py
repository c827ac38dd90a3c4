"""Outsoles of meshes, each solved once: files of one sole hold the same faces in any order."""

from collections import OrderedDict
from functools import cached_property
from pathlib import Path

import numpy as np

from underfoot.shoe.files import FileSettings, Mesh, outsole_from_mesh, read_mesh
from underfoot.shoe.tread_measures import tread_measures

MOST = 24  # are kept


class SolvedSole:
    """The outsole in a mesh."""

    def __init__(self, mesh: Mesh, settings: FileSettings | None) -> None:
        self.outsole = outsole_from_mesh(mesh, settings)

    @cached_property
    def measures(self):
        return tread_measures(self.outsole.surface)


_solved: OrderedDict[tuple, SolvedSole] = OrderedDict()


def sole_of_mesh(mesh: Mesh, settings: FileSettings | None = None) -> SolvedSole:
    """Return the outsole in a mesh; one of the same faces, bodies and unit isn't solved again."""
    rows = np.asarray(mesh.triangles, dtype=np.float32).reshape(-1, 9)
    body = np.zeros(len(rows), np.int32) if mesh.body is None else mesh.body
    order = np.lexsort((body, *rows.T))
    faces = rows[order].tobytes(), body[order].tobytes()
    key = (*faces, mesh.bodies, mesh.unit, mesh.origin, settings)
    if key not in _solved:
        _solved[key] = SolvedSole(mesh, settings)
        if len(_solved) > MOST:
            _solved.popitem(last=False)
    _solved.move_to_end(key)
    return _solved[key]


def sole_of_file(path: Path, settings: FileSettings | None = None) -> tuple[SolvedSole, str]:
    """Return the outsole in a file, and what its reader said."""
    mesh = read_mesh(path, settings.unit if settings else "auto")
    return sole_of_mesh(mesh, settings), " ".join(mesh.remarks)
