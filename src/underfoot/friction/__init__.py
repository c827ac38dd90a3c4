"""Friction of sole, floor and fluid together: local laws and Eq. (1) over the whole sole."""

from underfoot.core.deprecation import package_names

from .adhesion_blocking import AdhesionBlockingLaw as AdhesionBlockingLaw
from .asperity_ehl import ONE_CURVE as ONE_CURVE
from .asperity_ehl import OWN_BOUNDARY as OWN_BOUNDARY
from .asperity_ehl import AsperityEHL as AsperityEHL
from .asperity_ehl import CalibratedLevels as CalibratedLevels
from .asperity_ehl import asperity_ehl_law as asperity_ehl_law
from .asperity_scale import AsperityScale as AsperityScale
from .asperity_scale import self_affine_scale as self_affine_scale
from .asperity_scale import spectrum_scale as spectrum_scale
from .boundary import BoundaryLaw as BoundaryLaw
from .bowden_tabor import BowdenTaborLaw as BowdenTaborLaw
from .bowden_tabor import ShearStrength as ShearStrength
from .bowden_tabor import shear_strength_from_cof as shear_strength_from_cof
from .coefficient import FrictionCoefficients as FrictionCoefficients
from .coefficient import cof as cof
from .constant import ConstantLaw as ConstantLaw
from .law import FrictionLaw as FrictionLaw
from .law import FrictionParts as FrictionParts
from .law import UncertainInputs as UncertainInputs
from .measured import BoundaryFriction as BoundaryFriction
from .measured import boundary_friction_at as boundary_friction_at
from .measured import friction_left as friction_left
from .measured import viscous_decay as viscous_decay
from .moore_2012 import StribeckLaw as StribeckLaw
from .moore_2012 import stribeck_cof as stribeck_cof
from .moore_2012 import stribeck_law_at as stribeck_law_at
from .pair_contact import Pair as Pair
from .pair_contact import PairContactLaw as PairContactLaw
from .pair_contact import PairDraws as PairDraws
from .pair_contact import packaged_pair_draws as packaged_pair_draws
from .pair_contact import read_pair_draws as read_pair_draws
from .propagation import Propagated as Propagated
from .propagation import propagate_spread as propagate_spread
from .rival_speed_effects import MeanFilmSharing as MeanFilmSharing
from .rival_speed_effects import ViscoelasticArea as ViscoelasticArea
from .rival_speed_effects import modulus_exponent as modulus_exponent
from .sampled_cof import SampledCof as SampledCof
from .sampled_cof import sampled_cof as sampled_cof
from .sampled_cof import sampled_points as sampled_points
from .speed_effect import SpeedEffect as SpeedEffect
from .speed_effect import SpeedEffectLaw as SpeedEffectLaw
from .speed_effect import cof_with_speed as cof_with_speed
from .speed_table import SpeedTableLaw as SpeedTableLaw

__getattr__ = package_names(__name__, gone="0.5", propagated="propagate_spread")
