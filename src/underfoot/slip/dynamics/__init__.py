"""The slip as it happens: the foot as a mass, contact and film carried in time, a population."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .fitting import FitError, ReducedFit, design, error_of, fitted_reduced
    from .gait import GaitHistory, history_text, load_history, packaged_histories
    from .kept_runs import FullRun, full_run, full_runs
    from .motion import FootContact, SlipMotion, slip_motion
    from .observation import ObservedSlip, Outcome, OutcomeLimits, judged, observed
    from .recorded import recorded_histories, step_history
    from .reduced import ReducedSole, cof_table
    from .sensors import PressureShape, SensorArray, array_pressures, pressure_shape
    from .sole_contact import Setting, SoleFoot
    from .study import SlipStudy, SubjectSlip, slip_study
    from .walker import Population, Spread, Walker

_PLACES = {
    "fitting": ("FitError", "ReducedFit", "design", "error_of", "fitted_reduced"),
    "kept_runs": ("FullRun", "full_run", "full_runs"),
    "gait": ("GaitHistory", "history_text", "load_history", "packaged_histories"),
    "motion": ("FootContact", "SlipMotion", "slip_motion"),
    "observation": ("ObservedSlip", "Outcome", "OutcomeLimits", "judged", "observed"),
    "recorded": ("recorded_histories", "step_history"),
    "reduced": ("ReducedSole", "cof_table"),
    "sensors": ("PressureShape", "SensorArray", "array_pressures", "pressure_shape"),
    "sole_contact": ("Setting", "SoleFoot"),
    "study": ("SlipStudy", "SubjectSlip", "slip_study"),
    "walker": ("Population", "Spread", "Walker"),
}
_LATER = {name: module for module, names in _PLACES.items() for name in names}

__all__ = [
    "FitError",
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
    "SensorArray",
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


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_LATER[name]}", __name__), name)
