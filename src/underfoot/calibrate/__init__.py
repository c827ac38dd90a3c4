"""Closures fitted to measurements, with intervals; where theory and measurement meet."""

from .law_file import LawTable, TrialReadings, law_file_text, law_table, trial_readings
from .least_squares import Calibration, Parameter, calibrated
from .mechanisms import (
    CALIBRATION_FLUID,
    BlindTest,
    Mechanism,
    MechanismComparison,
    MechanismTests,
    Prediction,
    blind_test,
    calibrated_mechanism,
    compare_mechanisms,
    leave_one_out,
    mechanism,
    mechanisms,
    predicted,
    stribeck_left_out,
)
from .stribeck_curve import StribeckCurve, stribeck_curve
from .stribeck_points import CofPoints, Pin, fluid_points, pin_on_disk, roughness_series
from .trial_laws import stribeck_law_from_fit

__all__ = [
    "CALIBRATION_FLUID",
    "BlindTest",
    "Calibration",
    "CofPoints",
    "LawTable",
    "Mechanism",
    "MechanismComparison",
    "MechanismTests",
    "Parameter",
    "Pin",
    "Prediction",
    "StribeckCurve",
    "TrialReadings",
    "blind_test",
    "calibrated",
    "calibrated_mechanism",
    "compare_mechanisms",
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
