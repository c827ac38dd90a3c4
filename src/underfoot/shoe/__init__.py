"""Geometry of shoes: parametric soles, outsole files, treads, wear and their measures."""

from .geometry import SoleMap as SoleMap
from .heel import Heel as Heel
from .heel_grid import heel_map as heel_map
from .heel_grid import heel_surface as heel_surface
from .profile import Facet as Facet
from .profile import Flat as Flat
from .profile import Profile as Profile
from .profile import Rocker as Rocker
from .sole_surface import SoleSurface as SoleSurface
from .sole_surface import surface_map as surface_map
from .tread import ArcChannel as ArcChannel
from .tread import Sipes as Sipes
from .tread import Tread as Tread
from .worn.plane import WearPlane as WearPlane
