"""Contaminants: viscosity with temperature and concentration, and the adhesion they block."""

from .cheng_2008 import (
    glycerol_mass_fraction,
    glycerol_water_breaches,
    glycerol_water_density,
    glycerol_water_viscosity,
    water_viscosity,
)
from .contaminant import Contaminant, ViscosityComparison, compared_viscosity, glycerol_water
from .strobel_2012 import BLOCKING, AdhesionBlocking, adhesion_blocking, strobel_breaches

__all__ = [
    "BLOCKING",
    "AdhesionBlocking",
    "Contaminant",
    "ViscosityComparison",
    "adhesion_blocking",
    "compared_viscosity",
    "glycerol_mass_fraction",
    "glycerol_water",
    "glycerol_water_breaches",
    "glycerol_water_density",
    "glycerol_water_viscosity",
    "strobel_breaches",
    "water_viscosity",
]
