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
    from .sole_state import SolverSettings

Array = NDArray[np.float64]


def check_setup(
    sole: SoleMap,
    self_compliance: Array,
    viscosity: float | None,
    typical_force: float,
    settings: SolverSettings,
) -> None:
    """Refuse values that are not finite or not physical, and grids that don't match."""
    positive = {
        "normal_force": typical_force,
        "spacing": sole.spacing,
        "settings.pool_depth": settings.pool_depth,
        "settings.start_film": settings.start_film,
        "settings.rise_time": settings.rise_time,
        "settings.tolerance": settings.tolerance,
    }
    if viscosity is not None:
        positive["viscosity"] = viscosity
    for where, value in positive.items():
        _check_positive(value, where)
    for where, count in (
        ("settings.most_newton", settings.most_newton),
        ("settings.most_time_steps", settings.most_time_steps),
    ):
        if count < 1:
            raise InputError(f"{count} allows no step", where=where, allowed="1 or more")
    if settings.backend is not None and settings.backend not in available_backends():
        raise unknown_name(
            "sparse back end", settings.backend, available_backends(), where="settings.backend"
        )
    shape = np.shape(sole.clearance)
    check_clearance(np.asarray(sole.clearance), shape)
    if np.shape(self_compliance) != shape:
        raise InputError(
            f"the compliance has shape {np.shape(self_compliance)}",
            where="compliance",
            allowed=f"the shape of the sole, {shape}",
        )
    if not (np.isfinite(self_compliance).all() and (self_compliance > 0).all()):
        raise InputError(
            "a cell doesn't give way under pressure",
            where="compliance",
            allowed="a positive self compliance everywhere",
        )


def check_times(settings: SolverSettings) -> None:
    """Refuse a run that ends before its load is up."""
    _check_positive(settings.rise_time, "settings.rise_time")
    _check_positive(settings.end_time, "settings.end_time")
    if settings.end_time < settings.rise_time and not settings.steady:
        raise InputError(
            f"the run ends at {settings.end_time} s, before the load is up",
            where="settings.end_time",
            allowed=f"at least settings.rise_time, {settings.rise_time} s",
        )


def check_demand(
    duration: float,
    normal_force: float,
    speed: float,
    shoe_angle: float | None,
    *,
    rising: bool = False,
) -> None:
    """Refuse a step in time that can't be: ``rising`` asks for a load above 0."""
    _check_positive(duration, "settings.rise_time" if rising else "duration")
    if rising:
        _check_positive(normal_force, "normal_force")
    if not (math.isfinite(normal_force) and normal_force >= 0):
        raise InputError(
            f"{normal_force} is not a load", where="normal_force", allowed="0 N or more"
        )
    if not math.isfinite(speed):
        raise InputError(f"{speed} is not finite", where="speed", allowed="a finite speed, m/s")
    if shoe_angle is not None and not abs(shoe_angle) <= math.pi / 3:
        raise InputError(
            f"{shoe_angle} rad is not a shoe angle",
            where="shoe_angle",
            allowed="-60 deg to 60 deg",
        )


def check_clearance(clearance: Array, shape: tuple[int, ...]) -> None:
    """Refuse a clearance with holes, of another shape or below its lowest point."""
    if clearance.ndim != 2 or np.isnan(clearance).any() or not np.isfinite(clearance).any():
        raise InputError(
            "the clearance holds NaN or no finite height",
            where="sole.clearance",
            allowed="heights in m, inf outside the plan form",
        )
    if clearance.shape != shape:
        raise InputError(
            f"the clearance has shape {clearance.shape}", where="clearance_at", allowed=f"{shape}"
        )
    if (clearance < 0).any():
        raise InputError(
            "the clearance is negative somewhere",
            where="sole.clearance",
            allowed="heights above the lowest point, so 0 or more",
        )


def _check_positive(value: float, where: str) -> None:
    if not (math.isfinite(value) and value > 0):
        raise InputError(f"{value} is not positive", where=where, allowed="a finite value above 0")
