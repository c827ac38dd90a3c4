"""Whole shoes: geometry, compliance, contact with fluid, and how a floor sensor reads it."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .geometry import SoleMap
from .heel import Heel
from .heel_grid import heel_map
from .heel_surface import heel_surface
from .profile import Facet, Flat, Profile, Rocker
from .reading import SensorReading, floor_sensor_reading
from .sole_surface import SoleSurface, surface_map
from .tread import ArcChannel, Tread
from .wear import WearPlane

if TYPE_CHECKING:
    from .compliance import (
        Compliance,
        ConvolutionCompliance,
        half_space_compliance,
        layered_compliance,
    )
    from .sole_state import SoleState, SolverSettings
    from .solver import SoleContact, solve_sliding
    from .stepping import SlidingSole, rolled_clearance

# the solver loads sparse linear algebra, which geometry and reading do not need
_LATER = {
    "Compliance": "compliance",
    "ConvolutionCompliance": "compliance",
    "SlidingSole": "stepping",
    "SoleContact": "solver",
    "SoleState": "sole_state",
    "SolverSettings": "sole_state",
    "half_space_compliance": "compliance",
    "layered_compliance": "compliance",
    "rolled_clearance": "stepping",
    "solve_sliding": "solver",
}

__all__ = [
    "ArcChannel",
    "Compliance",
    "ConvolutionCompliance",
    "Facet",
    "Flat",
    "Heel",
    "Profile",
    "Rocker",
    "SensorReading",
    "SlidingSole",
    "SoleContact",
    "SoleMap",
    "SoleState",
    "SoleSurface",
    "SolverSettings",
    "Tread",
    "WearPlane",
    "floor_sensor_reading",
    "half_space_compliance",
    "heel_map",
    "heel_surface",
    "layered_compliance",
    "rolled_clearance",
    "solve_sliding",
    "surface_map",
]


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_LATER[name]}", __name__), name)
