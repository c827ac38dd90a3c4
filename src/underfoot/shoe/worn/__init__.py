"""Wear of soles: patches, maps, Archard wear step by step, and how worn a sole is."""

from .archard import ArchardStep, archard_wear
from .map import WornMap
from .measures import WearMeasures, surface_wear_measures, wear_measures
from .patch import WornPatch
from .surface import worn_surface

__all__ = [
    "ArchardStep",
    "WearMeasures",
    "WornMap",
    "WornPatch",
    "archard_wear",
    "surface_wear_measures",
    "wear_measures",
    "worn_surface",
]
