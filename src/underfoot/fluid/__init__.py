"""Contaminants: viscosity with temperature and concentration, and the adhesion they block."""

from .cheng_2008 import glycerol_mass_fraction as glycerol_mass_fraction
from .cheng_2008 import glycerol_water_breaches as glycerol_water_breaches
from .cheng_2008 import glycerol_water_density as glycerol_water_density
from .cheng_2008 import glycerol_water_viscosity as glycerol_water_viscosity
from .cheng_2008 import water_viscosity as water_viscosity
from .contaminant import Contaminant as Contaminant
from .contaminant import ViscosityComparison as ViscosityComparison
from .contaminant import compared_viscosity as compared_viscosity
from .contaminant import glycerol_water as glycerol_water
from .strobel_2012 import BLOCKING as BLOCKING
from .strobel_2012 import AdhesionBlocking as AdhesionBlocking
from .strobel_2012 import adhesion_blocking as adhesion_blocking
from .strobel_2012 import strobel_breaches as strobel_breaches
