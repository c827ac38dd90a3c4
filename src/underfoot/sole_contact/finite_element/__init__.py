"""Sole by finite elements: compliance of the real treaded shape.

NGSolve and netgen are loaded only when a sole is meshed.
"""

from .compliance import finite_element_compliance as finite_element_compliance
from .compliance import sole_land as sole_land
from .compliance import sole_prisms as sole_prisms
from .elasticity import LandCompliance as LandCompliance
from .elasticity import Rubber as Rubber
from .elasticity import land_compliance as land_compliance
from .mesh import Layers as Layers
from .mesh import SoleMesh as SoleMesh
from .mesh import sole_mesh as sole_mesh
from .plan import Plan as Plan
from .plan import plan_of as plan_of
