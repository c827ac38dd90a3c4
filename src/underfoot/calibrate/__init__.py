"""Closures fitted to measurements, with intervals; where theory and measurement meet."""

from .blind import BlindTest, Prediction, blind_test, leave_one_out, stribeck_left_out
from .least_squares import Calibration, Parameter, calibrated
from .speed_effects import Mechanism, calibrated_mechanism, mechanism, mechanisms, predicted
from .stribeck_curve import StribeckCurve, stribeck_curve
from .stribeck_points import CofPoints, Pin, fluid_points, pin_on_disk, roughness_series
from .trial_laws import stribeck_law_from_fit

__all__ = [
    "BlindTest",
    "Calibration",
    "CofPoints",
    "Mechanism",
    "Parameter",
    "Pin",
    "Prediction",
    "StribeckCurve",
    "blind_test",
    "calibrated",
    "calibrated_mechanism",
    "fluid_points",
    "leave_one_out",
    "mechanism",
    "mechanisms",
    "pin_on_disk",
    "predicted",
    "roughness_series",
    "stribeck_curve",
    "stribeck_law_from_fit",
    "stribeck_left_out",
]
