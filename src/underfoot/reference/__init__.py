"""Closed forms that solvers are held against; imports nothing else of this package."""

from .contact import (
    HertzContact,
    bonded_layer_compliance,
    half_space_compliance,
    hertz_line,
    hertz_point,
    hertz_point_pressure,
    sinusoid_contact_fraction,
    sinusoid_full_contact_pressure,
    sinusoid_gap,
    sinusoid_mean_gap,
    sinusoid_pressure,
    sliding_checkerboard_cof,
    sliding_sinusoid_cof,
)

__all__ = [
    "HertzContact",
    "bonded_layer_compliance",
    "half_space_compliance",
    "hertz_line",
    "hertz_point",
    "hertz_point_pressure",
    "sinusoid_contact_fraction",
    "sinusoid_full_contact_pressure",
    "sinusoid_gap",
    "sinusoid_mean_gap",
    "sinusoid_pressure",
    "sliding_checkerboard_cof",
    "sliding_sinusoid_cof",
]
