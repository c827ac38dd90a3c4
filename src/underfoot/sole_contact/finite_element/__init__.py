"""Sole by finite elements: compliance of the real treaded shape.

NGSolve and netgen are loaded only when a sole is meshed.
"""

from .compliance import FiniteElementCompliance, finite_element_compliance, sole_land
from .elasticity import LandCompliance, Rubber, land_compliance
from .mesh import Layers, SoleMesh, sole_mesh
from .plan import Plan, plan_of

__all__ = [
    "FiniteElementCompliance",
    "LandCompliance",
    "Layers",
    "Plan",
    "Rubber",
    "SoleMesh",
    "finite_element_compliance",
    "land_compliance",
    "plan_of",
    "sole_land",
    "sole_mesh",
]
