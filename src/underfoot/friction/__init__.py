"""Friction of sole, floor and fluid together: local laws and Eq. (1) over the whole sole."""

from .adhesion_blocking import AdhesionBlockingLaw
from .boundary import BoundaryLaw
from .coefficient import FrictionCoefficients, cof
from .constant import ConstantLaw
from .law import FrictionDeviation, FrictionLaw, FrictionParts
from .measured import BoundaryFriction, boundary_friction_at, friction_left, viscous_decay
from .moore_2012 import StribeckLaw, stribeck_cof, stribeck_law_at

__all__ = [
    "AdhesionBlockingLaw",
    "BoundaryFriction",
    "BoundaryLaw",
    "ConstantLaw",
    "FrictionCoefficients",
    "FrictionDeviation",
    "FrictionLaw",
    "FrictionParts",
    "StribeckLaw",
    "boundary_friction_at",
    "cof",
    "friction_left",
    "stribeck_cof",
    "stribeck_law_at",
    "viscous_decay",
]
