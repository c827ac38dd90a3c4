"""Dry rough contact: sliding half-space, theories, pressure-gap laws, tables of both."""

from .composite import composite_surface
from .contact_table import ContactTable
from .cutoff import CutoffDependence, cutoff_dependence
from .exponential import ExponentialLaw
from .flow_factor import FlowFactors, flow_factors
from .greenwood_williamson_1966 import greenwood_williamson
from .law import PressureGapLaw
from .persson import persson
from .steady import SteadySliding, steady_sliding
from .table_error import leave_out_errors
from .tabulated_law import TabulatedLaw
from .theory_contact import TheoryContact
from .theory_law import persson_law
from .transient import TransientSliding, transient_sliding

__all__ = [
    "ContactTable",
    "CutoffDependence",
    "ExponentialLaw",
    "FlowFactors",
    "PressureGapLaw",
    "SteadySliding",
    "TabulatedLaw",
    "TheoryContact",
    "TransientSliding",
    "composite_surface",
    "cutoff_dependence",
    "flow_factors",
    "greenwood_williamson",
    "leave_out_errors",
    "persson",
    "persson_law",
    "steady_sliding",
    "transient_sliding",
]
