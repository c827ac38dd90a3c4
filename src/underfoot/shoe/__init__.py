"""Geometry of shoes: parametric soles, outsole files, treads, wear and their measures."""

from underfoot.core.deprecation import package_names

from .geometry import SoleMap as SoleMap
from .geometry import SoleSurface as SoleSurface
from .grids import floor_lines as floor_lines
from .grids import heel_map as heel_map
from .grids import heel_surface as heel_surface
from .grids import place_on_floor as place_on_floor
from .grids import surface_map as surface_map
from .shape import Facet as Facet
from .shape import Flat as Flat
from .shape import Heel as Heel
from .shape import HeelProfile as HeelProfile
from .shape import Rocker as Rocker
from .tread import ArcChannel as ArcChannel
from .tread import Sipes as Sipes
from .tread import Tread as Tread
from .worn.forms import WearPlane as WearPlane

__getattr__ = package_names(__name__, gone="0.5", Profile="HeelProfile")
