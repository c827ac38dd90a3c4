"""The slip as it happens: the foot as a mass, contact and film carried in time, a population."""

from .full_model import FullRun, Setting, SoleFoot, full_run, full_runs
from .gait import GaitHistory, history_text, load_history, packaged_histories
from .motion import FootContact, SlipMotion, slip_motion
from .observation import ObservedSlip, Outcome, OutcomeLimits, judged, observed
from .recorded import recorded_histories, step_history
from .reduced_model import (
    FitError,
    ReducedFit,
    ReducedSole,
    cof_table,
    design,
    error_of,
    fitted_reduced,
)
from .sensors import FloorSensors, PressureShape, array_pressures, pressure_shape
from .study import SlipStudy, SubjectSlip, slip_study
from .walker import Population, Spread, Walker

__all__ = [
    "FitError",
    "FloorSensors",
    "FootContact",
    "FullRun",
    "GaitHistory",
    "ObservedSlip",
    "Outcome",
    "OutcomeLimits",
    "Population",
    "PressureShape",
    "ReducedFit",
    "ReducedSole",
    "Setting",
    "SlipMotion",
    "SlipStudy",
    "SoleFoot",
    "Spread",
    "SubjectSlip",
    "Walker",
    "array_pressures",
    "cof_table",
    "design",
    "error_of",
    "fitted_reduced",
    "full_run",
    "full_runs",
    "history_text",
    "judged",
    "load_history",
    "observed",
    "packaged_histories",
    "pressure_shape",
    "recorded_histories",
    "slip_motion",
    "slip_study",
    "step_history",
]
