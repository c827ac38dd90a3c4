"""Soles from a few lengths and angles, as height maps for the solver and as solids for the CAD."""

from .sole import ShoeOutline as ShoeOutline
from .sole import SoleProfile as SoleProfile
from .sole import ToeSpring as ToeSpring
from .sole import WholeSole as WholeSole
from .solid import SoleFile as SoleFile
from .solid import SoleSolid as SoleSolid
from .solid import sole_solid as sole_solid
from .solid import write_sole as write_sole
