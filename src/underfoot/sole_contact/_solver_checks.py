"""What the coupled solver refuses, with the place and what is allowed."""

import math

import numpy as np

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.core.checks import between, choice, not_negative, positive
from underfoot.core.remark import Message
from underfoot.core.sparse import BACK_ENDS, back_end
from underfoot.shoe.geometry import SoleMap

from .sole_state import SolverSettings

LARGEST_ANGLE = math.pi / 3


def check_setup(
    sole: SoleMap,
    self_compliance: Array,
    viscosity: float | None,
    typical_force: float,
    settings: SolverSettings,
) -> None:
    """Refuse values that are not finite or not physical, and grids that don't match."""
    positive(typical_force, "normal_force", "N")
    positive(sole.spacing, "spacing", "m")
    for name in ("pool_depth", "start_film", "rise_time", "tolerance"):
        positive(getattr(settings, name), f"settings.{name}")
    if viscosity is not None:
        positive(viscosity, "viscosity", "Pa s")
    for name in ("most_newton", "most_time_steps"):
        if getattr(settings, name) < 1:
            raise InputError(
                Message("{settings} allows no step", settings=getattr(settings, name)),
                where=f"settings.{name}",
                allowed="1 or more",
            )
    if not -math.inf < settings.cavity_pressure <= 0:
        raise InputError(
            Message(
                "{cavity_pressure:g} Pa is above the pressure of the air or not finite",
                cavity_pressure=settings.cavity_pressure,
            ),
            where="settings.cavity_pressure",
            allowed="0 Pa or less",
        )
    if settings.backend is not None:
        back_end(choice(settings.backend, BACK_ENDS, "settings.backend"))
    clearance = np.asarray(sole.clearance)
    if clearance.ndim != 2 or np.isnan(clearance).any() or not np.isfinite(clearance).any():
        raise InputError(
            "the clearance holds NaN or no finite height",
            where="sole.clearance",
            allowed="heights in m, inf outside the plan form",
        )
    if (clearance < 0).any():
        raise InputError(
            "the clearance is negative somewhere",
            where="sole.clearance",
            allowed="heights above the lowest point, so 0 or more",
        )
    if np.shape(self_compliance) != clearance.shape:
        raise InputError(
            Message("the compliance has shape {shape}", shape=str(np.shape(self_compliance))),
            where="compliance",
            allowed=Message("the shape of the sole, {shape}", shape=str(clearance.shape)),
        )
    if not (np.isfinite(self_compliance).all() and (self_compliance > 0).all()):
        raise InputError(
            "a cell doesn't give way under pressure",
            where="compliance",
            allowed="a positive self compliance everywhere",
        )


def check_times(settings: SolverSettings) -> None:
    """Refuse a run that ends before its load is up."""
    positive(settings.rise_time, "settings.rise_time", "s")
    if settings.end_time is None:
        return
    positive(settings.end_time, "settings.end_time", "s")
    if settings.end_time < settings.rise_time:
        raise InputError(
            Message(
                "the run ends at {end_time} s, before the load is up", end_time=settings.end_time
            ),
            where="settings.end_time",
            allowed=Message(
                "at least settings.rise_time, {rise_time} s", rise_time=settings.rise_time
            ),
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
    positive(duration, "settings.rise_time" if rising else "duration", "s")
    (positive if rising else not_negative)(normal_force, "normal_force", "N")
    if not math.isfinite(speed):
        raise InputError(
            Message("{value} is not finite", value=speed),
            where="speed",
            allowed="a finite speed, m/s",
        )
    if shoe_angle is not None:
        between(shoe_angle, -LARGEST_ANGLE, LARGEST_ANGLE, "shoe_angle", "-60 deg to 60 deg")
