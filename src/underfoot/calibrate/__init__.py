"""Closures fitted to measurements, with intervals; where theory and measurement meet."""

from underfoot.core.deprecation import package_names

from .law_file import LawTable as LawTable
from .law_file import TrialReadings as TrialReadings
from .law_file import law_file_text as law_file_text
from .law_file import law_table as law_table
from .law_file import trial_readings as trial_readings
from .least_squares import Calibration as Calibration
from .least_squares import Parameter as Parameter
from .least_squares import calibrate_model as calibrate_model
from .stribeck_curve import StribeckCurve as StribeckCurve
from .stribeck_curve import stribeck_curve as stribeck_curve
from .stribeck_points import CofPoints as CofPoints
from .stribeck_points import Pin as Pin
from .stribeck_points import fluid_points as fluid_points
from .stribeck_points import pin_on_disk as pin_on_disk
from .stribeck_points import roughness_series as roughness_series
from .trial_laws import stribeck_law_from_fit as stribeck_law_from_fit

__getattr__ = package_names(__name__, gone="0.5", calibrated="calibrate_model")
