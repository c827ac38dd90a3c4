"""Whole shoes: geometry, compliance, contact with fluid, and how a floor sensor reads it."""

from .geometry import SoleMap
from .heel import Facet, Flat, Heel, Profile, Rocker, heel_map
from .tread import ArcChannel, Tread
from .wear import WearPlane

__all__ = [
    "ArcChannel",
    "Facet",
    "Flat",
    "Heel",
    "Profile",
    "Rocker",
    "SoleMap",
    "Tread",
    "WearPlane",
    "heel_map",
]
