"""Dry rough contact: sliding half-space, theories, pressure-gap laws, tables of both."""

from .exponential import ExponentialLaw
from .law import PressureGapLaw
from .steady import SteadySliding, steady_sliding

__all__ = ["ExponentialLaw", "PressureGapLaw", "SteadySliding", "steady_sliding"]
