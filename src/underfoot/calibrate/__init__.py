"""Closures fitted to measurements, with intervals; where theory and measurement meet."""

from .blind import BlindTest, Prediction, blind_test, leave_one_out, stribeck_left_out
from .law_file import LawTable, TrialReadings, law_file_text, law_table, trial_readings
from .least_squares import Calibration, Parameter, calibrated
from .speed_effects import Mechanism, calibrated_mechanism, mechanism, mechanisms, predicted
from .stribeck_curve import StribeckCurve, stribeck_curve
from .stribeck_points import CofPoints, Pin, fluid_points, pin_on_disk, roughness_series
from .trial_laws import stribeck_law_from_fit

__all__ = [
    "BlindTest",
    "Calibration",
    "CofPoints",
    "LawTable",
    "Mechanism",
    "Parameter",
    "Pin",
    "Prediction",
    "StribeckCurve",
    "TrialReadings",
    "blind_test",
    "calibrated",
    "calibrated_mechanism",
    "fluid_points",
    "law_file_text",
    "law_table",
    "leave_one_out",
    "mechanism",
    "mechanisms",
    "pin_on_disk",
    "predicted",
    "roughness_series",
    "stribeck_curve",
    "stribeck_law_from_fit",
    "stribeck_left_out",
    "trial_readings",
]
