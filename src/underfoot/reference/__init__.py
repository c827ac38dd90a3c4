"""Closed forms that solvers are held against; imports nothing else of this package."""

from .contact import HertzContact as HertzContact
from .contact import bonded_layer_compliance as bonded_layer_compliance
from .contact import half_space_compliance as half_space_compliance
from .contact import hertz_line as hertz_line
from .contact import hertz_point as hertz_point
from .contact import hertz_point_pressure as hertz_point_pressure
from .contact import sinusoid_contact_fraction as sinusoid_contact_fraction
from .contact import sinusoid_full_contact_pressure as sinusoid_full_contact_pressure
from .contact import sinusoid_gap as sinusoid_gap
from .contact import sinusoid_mean_gap as sinusoid_mean_gap
from .contact import sinusoid_pressure as sinusoid_pressure
from .contact import sliding_checkerboard_cof as sliding_checkerboard_cof
from .contact import sliding_sinusoid_cof as sliding_sinusoid_cof
from .lubrication import inclined_bearing_load as inclined_bearing_load
from .lubrication import inclined_bearing_pressure as inclined_bearing_pressure
from .lubrication import parabolic_bearing_load as parabolic_bearing_load
from .lubrication import soft_ehl_film as soft_ehl_film
from .lubrication import squeeze_disc_gap as squeeze_disc_gap
from .lubrication import squeeze_disc_load as squeeze_disc_load
from .lubrication import squeeze_disc_pressure as squeeze_disc_pressure
from .lubrication import step_bearing_load as step_bearing_load
from .lubrication import tapered_wedge_load as tapered_wedge_load
