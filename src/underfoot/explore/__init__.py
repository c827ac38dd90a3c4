"""Design studies: what is varied in a case, run anywhere, resumed, learned from and optimised."""

from __future__ import annotations

from typing import TYPE_CHECKING

from underfoot.core.deprecation import package_names

if TYPE_CHECKING:
    from .plan import StudyPlan
    from .result import StudyResult
    from .study import Study
    from .study_file import load_plan
    from .sweeps import optimise, sweep

_HOMES = {
    "Study": ".study",
    "StudyPlan": ".plan",
    "StudyResult": ".result",
    "load_plan": ".study_file",
    "optimise": ".sweeps",
    "sweep": ".sweeps",
}

__all__ = ["Study", "StudyPlan", "StudyResult", "load_plan", "optimise", "sweep"]

__getattr__ = package_names(__name__, _HOMES)
