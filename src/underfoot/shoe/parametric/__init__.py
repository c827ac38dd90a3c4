"""Soles from a few lengths and angles, as height maps for the solver and as solids for the CAD."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .outline import ShoeOutline
from .sole import WholeSole
from .toe_spring import SoleProfile, ToeSpring

if TYPE_CHECKING:
    from .export import SoleFile, write_sole
    from .solid import SoleSolid, sole_solid

# the modelling kernel is large and only the export needs it
_LATER = {
    "SoleFile": "export",
    "SoleSolid": "solid",
    "sole_solid": "solid",
    "write_sole": "export",
}

__all__ = [
    "ShoeOutline",
    "SoleFile",
    "SoleProfile",
    "SoleSolid",
    "ToeSpring",
    "WholeSole",
    "sole_solid",
    "write_sole",
]


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_LATER[name]}", __name__), name)
