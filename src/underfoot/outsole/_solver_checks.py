"""What the coupled solver refuses, with the place and what is allowed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError, unknown_name
from underfoot.film import available_backends

if TYPE_CHECKING:
    from .geometry import SoleMap
    from .solver import SolverSettings

Array = NDArray[np.float64]


def check_inputs(
    sole: SoleMap,
    self_compliance: Array,
    viscosity: float | None,
    speed: float,
    normal_force: float,
    settings: SolverSettings,
) -> None:
    """Refuse values that are not finite or not physical, and grids that don't match."""
    positive = {
        "normal_force": normal_force,
        "spacing": sole.spacing,
        "settings.pool_depth": settings.pool_depth,
        "settings.start_film": settings.start_film,
        "settings.rise_time": settings.rise_time,
        "settings.end_time": settings.end_time,
        "settings.tolerance": settings.tolerance,
    }
    if viscosity is not None:
        positive["viscosity"] = viscosity
    for where, value in positive.items():
        if not (math.isfinite(value) and value > 0):
            raise InputError(
                f"{value} is not positive", where=where, allowed="a finite value above 0"
            )
    for where, count in (
        ("settings.most_newton", settings.most_newton),
        ("settings.most_time_steps", settings.most_time_steps),
    ):
        if count < 1:
            raise InputError(f"{count} allows no step", where=where, allowed="1 or more")
    if settings.end_time < settings.rise_time and not settings.steady:
        raise InputError(
            f"the run ends at {settings.end_time} s, before the load is up",
            where="settings.end_time",
            allowed=f"at least settings.rise_time, {settings.rise_time} s",
        )
    if settings.backend is not None and settings.backend not in available_backends():
        raise unknown_name(
            "sparse back end", settings.backend, available_backends(), where="settings.backend"
        )
    if not math.isfinite(speed):
        raise InputError(f"{speed} is not finite", where="speed", allowed="a finite speed, m/s")
    clearance = np.asarray(sole.clearance)
    if clearance.ndim != 2 or np.isnan(clearance).any() or not np.isfinite(clearance).any():
        raise InputError(
            "the clearance holds NaN or no finite height",
            where="sole.clearance",
            allowed="heights in m, inf outside the plan form",
        )
    if np.shape(self_compliance) != clearance.shape:
        raise InputError(
            f"the compliance has shape {np.shape(self_compliance)}",
            where="compliance",
            allowed=f"the shape of the sole, {clearance.shape}",
        )
    if not (np.isfinite(self_compliance).all() and (self_compliance > 0).all()):
        raise InputError(
            "a cell doesn't give way under pressure",
            where="compliance",
            allowed="a positive self compliance everywhere",
        )
    if (clearance < 0).any():
        raise InputError(
            "the clearance is negative somewhere",
            where="sole.clearance",
            allowed="heights above the lowest point, so 0 or more",
        )
