"""Dry rough contact: sliding half-space, theories, pressure-gap laws, tables of both."""

from .composite import composite_surface as composite_surface
from .contact_table import ContactTable as ContactTable
from .contact_table import leave_out_errors as leave_out_errors
from .cutoff import CutoffDependence as CutoffDependence
from .cutoff import cutoff_dependence as cutoff_dependence
from .flow_factor import FlowFactors as FlowFactors
from .flow_factor import flow_factors as flow_factors
from .greenwood_williamson_1966 import greenwood_williamson as greenwood_williamson
from .greenwood_williamson_1966 import greenwood_williamson_law as greenwood_williamson_law
from .persson import persson as persson
from .pressure_gap_law import ExponentialLaw as ExponentialLaw
from .pressure_gap_law import PressureGapLaw as PressureGapLaw
from .pressure_gap_law import TabulatedLaw as TabulatedLaw
from .pressure_gap_law import persson_law as persson_law
from .scales import table_over_scales as table_over_scales
from .steady import SlidingSettings as SlidingSettings
from .steady import SteadySliding as SteadySliding
from .steady import contacts_of as contacts_of
from .steady import contacts_on_card as contacts_on_card
from .steady import steady_sliding as steady_sliding
from .theory import TheoryContact as TheoryContact
