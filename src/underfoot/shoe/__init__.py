"""Geometry of shoes: parametric soles, outsole files, treads, wear and their measures."""

from .geometry import SoleMap
from .heel import Heel
from .heel_grid import heel_map, heel_surface
from .profile import Facet, Flat, Profile, Rocker
from .sole_surface import SoleSurface, surface_map
from .tread import ArcChannel, Sipes, Tread
from .worn.plane import WearPlane

__all__ = [
    "ArcChannel",
    "Facet",
    "Flat",
    "Heel",
    "Profile",
    "Rocker",
    "Sipes",
    "SoleMap",
    "SoleSurface",
    "Tread",
    "WearPlane",
    "heel_map",
    "heel_surface",
    "surface_map",
]
