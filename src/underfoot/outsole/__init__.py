"""Whole shoes: geometry, compliance, contact with fluid, and how a floor sensor reads it."""

from .geometry import SoleMap
from .heel import Heel
from .heel_grid import heel_map
from .profile import Facet, Flat, Profile, Rocker
from .reading import SensorReading, floor_sensor_reading
from .tread import ArcChannel, Tread
from .wear import WearPlane

__all__ = [
    "ArcChannel",
    "Facet",
    "Flat",
    "Heel",
    "Profile",
    "Rocker",
    "SensorReading",
    "SoleMap",
    "Tread",
    "WearPlane",
    "floor_sensor_reading",
    "heel_map",
]
