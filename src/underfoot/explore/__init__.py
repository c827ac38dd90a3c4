"""Design studies: what is varied in a case, run anywhere, resumed, learned from and optimised."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .plan import StudyPlan
    from .result import StudyResult
    from .study import Study
    from .study_file import load_plan
    from .sweeps import optimise, sweep

_HOMES = {
    "Study": "study",
    "StudyPlan": "plan",
    "StudyResult": "result",
    "load_plan": "study_file",
    "optimise": "sweeps",
    "sweep": "sweeps",
}

__all__ = ["Study", "StudyPlan", "StudyResult", "load_plan", "optimise", "sweep"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_HOMES[name]}", __name__), name)
