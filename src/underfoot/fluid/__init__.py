"""Contaminants: viscosity with temperature and concentration, and the adhesion they block."""

from .cheng_2008 import (
    glycerol_mass_fraction,
    glycerol_water_breaches,
    glycerol_water_density,
    glycerol_water_viscosity,
    water_viscosity,
)

__all__ = [
    "glycerol_mass_fraction",
    "glycerol_water_breaches",
    "glycerol_water_density",
    "glycerol_water_viscosity",
    "water_viscosity",
]
