"""What is read from a solved case: its numbers, their errors by the grid, and words on both."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from underfoot.case import Case
from underfoot.core import Breach, InputError, Progress, SourcedValue, display, silent
from underfoot.friction import SampledCof
from underfoot.shoe import SoleMap
from underfoot.shoe.lug_drainage import LugDrainage, lug_drainage
from underfoot.slip import SlipRisk
from underfoot.sole_contact.edge_peak import peak_pressure
from underfoot.sole_contact.slits import slit_words
from underfoot.sole_contact.solver import SoleContact

from . import numbers
from .contact_friction import friction_sums
from .positions import Place, TreadPositions
from .prepare import Prepared
from .sensors import blind_sensor, scanned
from .sole import overload_breaches
from .solve import Solution, solved_at
from .summary import FILM_MATTERS

RESOLVED = 16
"""Cells along the sliding in one spacing that hold the inlet of a film at a rim or corner."""


@dataclass(frozen=True, slots=True)
class Reading:
    """The numbers of a result, and what is to be said of them.

    Attributes:
        sampled: Draws of COF over its inputs and the positions of the tread.
        risk: Behind the slip probability; None where the contact is no result.
        drainage: Of the lugs, where the film matters.
        overload: Breaches of what the rubber bears.
    """

    values: dict[str, SourcedValue]
    labels: dict[str, str]
    sampled: SampledCof | None
    overload: list[Breach]
    risk: SlipRisk | None = None
    drainage: LugDrainage | None = None


def readings(
    parts: Prepared,
    solution: Solution,
    positions: TreadPositions | None,
    *,
    quick: bool,
    progress: Progress = silent,
) -> Reading:
    """Return the numbers of a solved case, as means over the positions of its tread.

    Raises:
        InputError: A grid check with a compliance of one grid.
    """
    case, contact = parts.case, solution.contact
    overload = overload_breaches(contact, parts.context.youngs_modulus)
    if not contact.status.usable:
        nothing = numbers.undetermined(case, contact.status)
        labels = {"no_result": numbers.no_result_words(contact, overload)}
        return Reading(nothing, labels, solution.friction.sampled, overload)
    friction, sampled = solution.friction.sums, solution.friction.sampled
    if positions:
        friction, sampled = positions.friction(friction, sampled)
    sensor = solution.sensor
    values, risk = numbers.scalars(case, contact, friction, sensor, sampled, parts.slip_model)
    values |= solution.recorder.array_scalars()
    if positions:
        values = positions.averaged(values)
    drainage = None
    if contact.fluid_load > FILM_MATTERS * contact.normal_force:
        drainage = lug_drainage(parts.sole, contact.fluid_pressure, contact.film_thickness)
    share = (values["fluid_load"].value or 0.0) / contact.normal_force
    remarks = {
        "drainage": drainage.words() if drainage else "",
        "overload": numbers.overload_words(overload),
        **(positions.labels() if positions else {}),
    }
    labels = numbers.regime(share) | numbers.spread_origin(sampled)
    labels |= _remarks(parts, solution, remarks)
    if case.numerics.grid_check and not quick:
        values, labels = _grid_checked(parts, solution, values, labels, progress)
    return Reading(values, labels, sampled, overload, risk, drainage)


def _remarks(parts: Prepared, solution: Solution, more: dict[str, str]) -> dict[str, str]:
    """Return what is to be said of the contact, ``more`` with it, in a reader's order."""
    case, sole, contact = parts.case, parts.sole, solution.contact
    lugs, slits, sensor = solution.friction.lugs, sole.slits, solution.sensor
    giving = "compliance" not in parts.objects and case.compliance.cut
    peak = peak_pressure(sole, contact.total_pressure, cell_load=contact.cell_load)
    remarks = {
        "lug_edges": "" if lugs is None else lugs.words() + chamfer_remark(case),
        "drainage": "",
        "sipes": ""
        if slits is None or not slits.length.any()
        else slit_words(slits, giving=giving),
        "cof_spread_basis": getattr(parts.law, "spread_basis", ""),
        "tread_position": "",
        "shoe_angle": "",
        "overload": "",
        "instant": _last_instant(case),
        "edge_peak": peak.remark,
        "film_inlet": ""
        if sole.cells or case.numerics.grid_check or sole.tread_depth.any()
        else "Square cells do not resolve where the film enters: COF and film load of a flat heel "
        "may be off by half; numerics.cells_along = 16 resolves it.",
        "sensor": blind_sensor(case, sensor, contact),
    }
    return {name: remark for name, remark in (remarks | more).items() if remark}


def _grid_checked(
    parts: Prepared,
    solution: Solution,
    values: dict[str, SourcedValue],
    labels: dict[str, str],
    progress: Progress,
) -> tuple[dict[str, SourcedValue], dict[str, str]]:
    """Return numbers and labels with the errors of the grid and of the steps in time."""
    if "compliance" in parts.objects:
        raise InputError(
            "a compliance that was given holds for one grid",
            where="numerics.grid_check",
            remedy="Set numerics.grid_check = false",
        )
    case, viscosity = parts.case, parts.viscosity
    columns = max(RESOLVED, case.numerics.cells_along)
    resolved = replace(parts, case=case.replace("numerics.cells_along", columns))
    spacing = case.numerics.quick_grid_spacing
    place: dict[str, Any] = {"place": Place(), "spacing": spacing, "progress": progress}
    cells = f"cells of {display(spacing, 'm')}, {columns} along the sliding"
    on_cells = [solved_at(resolved, **place)]
    if viscosity is not None:  # a dry contact has no memory: its steps are not steps in time
        on_cells.append(solved_at(resolved, **place, finer=2))
    if not all(contact.status.usable for _, contact in on_cells):
        failed = f"not estimated: a march on {cells} did not converge"
        return values, {**labels, "grid_error": failed}

    def read(sole: SoleMap, contact: SoleContact) -> dict[str, float]:
        friction = friction_sums(parts.law_on(sole), contact, case.motion.speed)
        sensor = scanned(case, sole, contact, viscosity=viscosity)
        return numbers.readings(contact, friction.cof.value or 0.0, sensor)

    there = [read(*each) for each in on_cells]
    errors = (
        numbers.grid_errors(read(parts.sole, solution.contact), there[0]),
        numbers.step_errors(*there) if len(there) > 1 else {},
    )
    values = numbers.with_discretisation_errors(values, *errors)
    return values, {
        **labels,
        "grid_error": numbers.discretisation_words(values, *errors, cells),
    }


def _last_instant(case: Case) -> str:
    """Return when and at which angle a motion that turns ends; empty where the angle is held."""
    history = case.motion.build()
    if history is None or not np.ptp(history.shoe_angle):
        return ""
    time, angle = display(history.time[-1], "s"), display(history.shoe_angle[-1], "rad")
    return f"at the end of the motion ({time}, shoe angle {angle})"


def chamfer_remark(case: Case) -> str:
    """Return what the chamfer of lugs counts as for the film at their edges; "" without one."""
    if not case.value("shoe.tread.edge_chamfer"):
        return ""
    return "; chamfered edges count as sharp ones, 0.1 mm round (assumed: no source for their film)"
