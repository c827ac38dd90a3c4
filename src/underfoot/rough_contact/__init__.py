"""Dry rough contact: sliding half-space, theories, pressure-gap laws, tables of both."""

from .composite import composite_surface
from .contact_table import ContactTable, leave_out_errors
from .cutoff import CutoffDependence, cutoff_dependence
from .flow_factor import FlowFactors, flow_factors
from .greenwood_williamson_1966 import greenwood_williamson
from .persson import persson
from .pressure_gap_law import ExponentialLaw, PressureGapLaw, TabulatedLaw, persson_law
from .steady import SlidingSettings, SteadySliding, steady_sliding
from .theory import TheoryContact
from .transient import TransientSettings, TransientSliding, transient_sliding

__all__ = [
    "ContactTable",
    "CutoffDependence",
    "ExponentialLaw",
    "FlowFactors",
    "PressureGapLaw",
    "SlidingSettings",
    "SteadySliding",
    "TabulatedLaw",
    "TheoryContact",
    "TransientSettings",
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
