"""Modules that have moved: for one version, an old path answers with a warning."""

import sys
import warnings
from collections.abc import Sequence
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType

UNTIL = "0.4"
"""Version from which the old paths are gone."""
_RECORDING = "axes measurement plates protocols signals tester_calibration trial"
_WALKING = (
    "belts describe events gait gait_context likelihood plausibility slips step_features walkway"
)
_MACHINES = "pin_on_disk pressure_map relaxation_test tester_checks"
_TRIALS, _ANALYSIS = "underfoot.trials.", "underfoot_trial_analysis."
HOMES = {
    "underfoot_app": "underfoot.app",
    "underfoot_block": "underfoot.block",
    "underfoot_block.g1": "underfoot.studies.g1",
    "underfoot_design_studies": "underfoot.explore",
    "underfoot_design_studies.free_land": "underfoot.shoe.free_land",
    "underfoot_design_studies.free_tread": "underfoot.case.free_tread",
    "underfoot_design_studies.live": "underfoot.report.live_study",
    "underfoot_design_studies.report": "underfoot.report.design_study",
    "underfoot_places": "underfoot.places",
    "underfoot_places.report": "underfoot.report.places",
    "underfoot_readers": "underfoot.trials.readers",
    **{
        f"underfoot_readers.{name}": f"underfoot.report.{name}"
        for name in ("designed_sole", "sole_export", "sole_mesh")
    },
    "underfoot_simulator": "underfoot.trials.simulator",
    "underfoot_studies": "underfoot.studies",
    "underfoot_trial_analysis": "underfoot.trials.study",
    _ANALYSIS + "statistics": "underfoot.trials.statistics",
    _ANALYSIS + "compound": "underfoot.calibrate.compound",
    _ANALYSIS + "c3d_writer": "underfoot.trials.readers.c3d_writer",
    **{_ANALYSIS + name: f"underfoot.trials.machines.{name}" for name in _MACHINES.split()},
    **{
        _ANALYSIS + name: f"underfoot.trials.pages.{name}"
        for name in ("report", "figures", "court_bundle")
    },
    **{_TRIALS + name: f"{_TRIALS}recording.{name}" for name in _RECORDING.split()},
    **{_TRIALS + name: f"{_TRIALS}walking.{name}" for name in _WALKING.split()},
    **{
        _TRIALS + name: f"{_TRIALS}machines.{name}"
        for name in ("slip_friction", "stribeck_fit", "pressures")
    },
    "underfoot.material.compression": "underfoot.trials.machines.compression",
    "underfoot.report.html": "underfoot.core.html",
    "underfoot.report.page": "underfoot.core.page",
}
"""New home of each module or package of 0.2; what is below a package moved with it."""


def new_home(name: str) -> str | None:
    """Return the new path of a module that has moved, None for any other."""
    old, below = name, ""
    while old:
        if old in HOMES:
            return HOMES[old] + below
        old, dot, last = old.rpartition(".")
        below = dot + last + below
    return None


class MovedFinder(MetaPathFinder, Loader):
    """Answers an import of an old path with the module at its new one."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return what loads a module that has moved."""
        return ModuleSpec(fullname, self) if new_home(fullname) else None

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Return the module at the new path."""
        home = new_home(spec.name) or ""
        warnings.warn(
            f"{spec.name} is now {home}; the old path ends with {UNTIL}",
            FutureWarning,
            stacklevel=2,
        )
        module = import_module(home)
        spec.loader_state = module.__spec__
        return module

    def exec_module(self, module: ModuleType) -> None:
        """Give the module, which ran at its new path, its own specification back."""
        if module.__spec__ is not None:
            module.__spec__ = module.__spec__.loader_state


def answer_old_paths() -> None:
    """Let old paths be imported."""
    if not any(isinstance(finder, MovedFinder) for finder in sys.meta_path):
        sys.meta_path.append(MovedFinder())
