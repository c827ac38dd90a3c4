"""Outsoles from files: STEP, STL, OBJ and PLY to a height map in the sole's frame."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .mesh import Mesh
    from .outsole import FileOutsole, outsole_from_file, outsole_from_mesh
    from .read import read_mesh
    from .settings import FileSettings

# netgen, trimesh and the compiled kernels load only when a file is read
_LATER = {
    "FileOutsole": "outsole",
    "FileSettings": "settings",
    "Mesh": "mesh",
    "outsole_from_file": "outsole",
    "outsole_from_mesh": "outsole",
    "read_mesh": "read",
}

__all__ = [
    "FileOutsole",
    "FileSettings",
    "Mesh",
    "outsole_from_file",
    "outsole_from_mesh",
    "read_mesh",
]


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_LATER[name]}", __name__), name)
