"""Friction of sole, floor and fluid together: local laws and Eq. (1) over the whole sole."""

from .adhesion_blocking import AdhesionBlockingLaw
from .asperity_ehl import ONE_CURVE, OWN_BOUNDARY, AsperityEHL, CalibratedLevels, asperity_ehl_law
from .asperity_scale import AsperityScale, self_affine_scale, spectrum_scale
from .boundary import BoundaryLaw
from .bowden_tabor import BowdenTaborLaw, ShearStrength, shear_strength_from_cof
from .coefficient import FrictionCoefficients, cof
from .constant import ConstantLaw
from .law import FrictionLaw, FrictionParts, UncertainInputs
from .measured import BoundaryFriction, boundary_friction_at, friction_left, viscous_decay
from .moore_2012 import StribeckLaw, stribeck_cof, stribeck_law_at
from .pair_contact import Pair, PairContactLaw, PairDraws, packaged_pair_draws, read_pair_draws
from .propagation import Propagated, propagated
from .rival_speed_effects import MeanFilmSharing, ViscoelasticArea, modulus_exponent
from .sampled_cof import SampledCof, sampled_cof, sampled_points
from .speed_effect import SpeedEffect, SpeedEffectLaw, cof_with_speed
from .speed_table import SpeedTableLaw

__all__ = [
    "ONE_CURVE",
    "OWN_BOUNDARY",
    "AdhesionBlockingLaw",
    "AsperityEHL",
    "AsperityScale",
    "BoundaryFriction",
    "BoundaryLaw",
    "BowdenTaborLaw",
    "CalibratedLevels",
    "ConstantLaw",
    "FrictionCoefficients",
    "FrictionLaw",
    "FrictionParts",
    "MeanFilmSharing",
    "Pair",
    "PairContactLaw",
    "PairDraws",
    "Propagated",
    "SampledCof",
    "ShearStrength",
    "SpeedEffect",
    "SpeedEffectLaw",
    "SpeedTableLaw",
    "StribeckLaw",
    "UncertainInputs",
    "ViscoelasticArea",
    "asperity_ehl_law",
    "boundary_friction_at",
    "cof",
    "cof_with_speed",
    "friction_left",
    "modulus_exponent",
    "packaged_pair_draws",
    "propagated",
    "read_pair_draws",
    "sampled_cof",
    "sampled_points",
    "self_affine_scale",
    "shear_strength_from_cof",
    "spectrum_scale",
    "stribeck_cof",
    "stribeck_law_at",
    "viscous_decay",
]
