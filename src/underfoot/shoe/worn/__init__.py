"""Wear of soles: patches, maps, Archard wear step by step, and how worn a sole is."""

from .archard import ArchardStep as ArchardStep
from .archard import archard_wear as archard_wear
from .forms import WornMap as WornMap
from .forms import WornPatch as WornPatch
from .measures import WearMeasures as WearMeasures
from .measures import surface_wear_measures as surface_wear_measures
from .measures import wear_measures as wear_measures
from .surface import worn_surface as worn_surface
from .walking import FloorCuts as FloorCuts
from .walking import WalkingWear as WalkingWear
