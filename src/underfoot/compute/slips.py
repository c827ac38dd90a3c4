"""From a case to the people who walk on its floor, and their slips."""

import math
from collections.abc import Sequence

from underfoot.case import Case
from underfoot.case.people import Walkers
from underfoot.core import InputError, Progress, silent
from underfoot.core.remark import Message
from underfoot.core.threads import threads_limited
from underfoot.film import NewtonianFilm
from underfoot.slip.dynamics import (
    FloorSensors,
    GaitHistory,
    Population,
    Setting,
    SlipStudy,
    Spread,
    packaged_histories,
    slip_study,
)
from underfoot.sole_contact.lug_edges import EdgedLaw
from underfoot.sole_contact.sole_state import SolverSettings

from .numbers import required_friction
from .prepare import prepare_case
from .solve import pool_depth, start_film

WIDE = 3.0
"""Standard deviations to either side of a stated mean that are drawn at least."""


def slip_setting(case: Case, *, quick: bool = True) -> Setting:
    """Return shoe, floor and fluid of a case as a slip needs them.

    ``quick`` takes the coarse grid: a slip is some hundred contacts.
    """
    spacing = case.numerics.quick_grid_spacing if quick else case.numerics.grid_spacing
    parts, strangers = prepare_case(case, spacing), case.model_copy(update={"slip": Walkers()})
    return Setting(
        sole=parts.sole,
        compliance=parts.compliance,
        asperities=parts.asperities,
        friction=parts.law,
        viscosity=parts.viscosity,
        settings=SolverSettings(
            pool_depth=pool_depth(case),
            start_film=start_film(case, steady=False),
            rise_time=case.motion.force_rise_time,
            tolerance=case.numerics.tolerance,
            film=None if isinstance(parts.film, NewtonianFilm) else parts.film,
        ),
        shoe_angle=case.motion.shoe_angle,
        key=f"{strangers.hash} {spacing:.6g}",
        edged=parts.local_law if isinstance(parts.local_law, EdgedLaw) else None,
    )


def slip_population(
    case: Case, *, subjects: int | None = None, histories: Sequence[GaitHistory] | None = None
) -> Population:
    """Return the people of a case; ``histories`` of your own replace the packaged steps.

    Raises:
        InputError: A required friction outside 0 to 1, landing places in the wrong order.
    """
    people, risk = case.slip, case.risk
    if not 0 <= risk.rcof_mean <= 1:
        raise InputError(f"{risk.rcof_mean:g}", where="risk.rcof_mean", allowed="0 to 1")
    for name in ("landing", "weight_transfer"):
        if getattr(people, f"{name}_from") > getattr(people, f"{name}_to"):
            raise InputError(
                Message("lies beyond slip.{name}_to", name=name),
                where=f"slip.{name}_from",
                allowed=Message("at most {name}_to", name=name),
            )

    def spread_of(path: str, low: float, high: float) -> Spread:
        mean, sd = case.sourced_value(f"{path}_mean"), case.value(f"{path}_sd")
        assert mean.value is not None
        least = max(mean.value - WIDE * sd, mean.value / 2)  # of people unlike adults on the level
        ends = min(low, least), max(high, mean.value + WIDE * sd)
        return Spread(mean.value, sd, *ends, mean.source, mean.assumed)

    angle, asked = case.motion.shoe_angle, case.sourced_value("risk.rcof_mean")
    needed = required_friction(case)
    return Population(
        subjects=people.subjects if subjects is None else subjects,
        seed=people.seed,
        histories=tuple(histories) if histories else packaged_histories(),
        mass=spread_of("slip.mass", 20.0, 200.0),
        rcof=Spread(needed.mean, needed.sd, 0.0, 1.0, asked.source, asked.assumed),
        walking_speed=spread_of("slip.walking_speed", 0.5, 2.5),
        heel_speed=spread_of("slip.heel_speed", 0.02, 2.0),
        shoe_angle=Spread(
            angle,
            people.shoe_angle_sd,
            min(max(angle - math.radians(8), math.radians(1)), angle),
            angle + math.radians(8),
            "slip.shoe_angle_sd",
        ),
        landing=(people.landing_from, people.landing_to),
        lateral=Spread(0.0, people.lateral_sd, -0.05, 0.05, "slip.lateral_sd"),
        effective_mass=people.effective_mass,
        recorded_angle=people.shoe_angle == "recorded",
        rcof_step=Spread(0.0, people.rcof_step_sd, -0.2, 0.2, "slip.rcof_step_sd", False),
        heel_brake=people.heel_brake,
        brake_time=spread_of("slip.brake_time", 0.004, 0.2),
        weight_transfer=(people.weight_transfer_from, people.weight_transfer_to),
    )


def slip_sensors(case: Case) -> FloorSensors:
    """Return the sensors in the floor of a case."""
    people = case.slip
    return FloorSensors(
        people.sensor_rows, people.sensor_columns, people.sensor_spacing, people.sensor_inlet
    )


@threads_limited(1)
def slips(
    case: Case,
    *,
    subjects: int | None = None,
    histories: Sequence[GaitHistory] | None = None,
    full: bool = False,
    fine: bool = False,
    progress: Progress = silent,
) -> SlipStudy:
    """Return the slips of a case's population: who slips, how fast, how far.

    Parameters:
        case: Shoe, floor, fluid and people.
        subjects: How many; the case's by default.
        histories: Steps of your own in place of the packaged ones.
        full: Everybody through the full model instead of the reduced one fitted to it.
        fine: The case's fine grid instead of the coarse one.
        progress: Receives stage, fraction and residual; an exception it raises stops the work, and
            the slips done so far are found again by the next call.

    Raises:
        InputError: People who can't be; a sole that does not fit the grid.
        ConvergenceError: Too few slips could be solved.
    """
    people = case.slip
    return slip_study(
        slip_setting(case, quick=not fine),
        slip_population(case, subjects=subjects, histories=histories),
        array=slip_sensors(case),
        full=full,
        fit_runs=people.fit_runs,
        held_out=people.test_runs,
        step=people.time_step,
        progress=progress,
    )
