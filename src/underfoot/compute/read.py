"""What is read from a solved case: its numbers, their errors by the grid, and words on both."""

from dataclasses import dataclass, replace

import numpy as np

from underfoot.case import Case
from underfoot.case.motion import SLOWEST
from underfoot.core import Breach, Progress, SourcedValue, silent
from underfoot.core.remark import NOTHING, Amount, Message
from underfoot.friction import FrictionLaw, PairContactLaw, SampledCof
from underfoot.friction.pair_contact import UnexpectedReading
from underfoot.shoe.lug_drainage import LugDrainage, lug_drainage
from underfoot.slip import SlipRisk
from underfoot.sole_contact.edge_peak import peak_pressure
from underfoot.sole_contact.motion_history import LANDED
from underfoot.sole_contact.slits import slit_words

from . import numbers
from .micro_contact import micro_contact
from .numerical_error import NumericalErrors, numerical_errors, with_numerical_error
from .position_draws import TreadPositions
from .prepare import Prepared
from .sensors import blind_sensor
from .sole import overload_breaches
from .solve import Solution, start_film
from .steadiness import later_numbers, steady_slide, with_steadiness
from .summary import FILM_MATTERS


@dataclass(frozen=True, slots=True)
class ResultNumbers:
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
    progress: Progress = silent,
) -> ResultNumbers:
    """Return the numbers of a solved case, as means over the positions of its tread.

    Raises:
        InputError: A grid check with a compliance of one grid.
    """
    case, contact = parts.case, solution.contact
    overload = overload_breaches(contact, parts.context.youngs_modulus)
    if not contact.status.usable:
        nothing = numbers.undetermined_numbers(case, contact.status)
        labels: dict[str, str] = {"no_result": numbers.no_result_words(contact, overload)}
        return ResultNumbers(nothing, labels, solution.friction.sampled, overload)
    friction, sampled = solution.friction.sums, solution.friction.sampled
    if positions:
        friction, sampled = positions.friction(friction, sampled)
    errors = numerical_errors(parts, solution, positions, progress)
    if sampled is not None and isinstance(errors, NumericalErrors):
        cof, name = friction.cof, numbers.sole_name(case)
        error = errors.deviation("cof")
        sampled = with_numerical_error(sampled, error, cof=float(cof), sole=name)
        friction = replace(friction, cof=sampled.sourced_value("cof", cof))
    sensor = solution.sensor
    values, risk = numbers.scalars(case, contact, friction, sensor, sampled, parts.slip_model)
    values |= later_numbers(parts, contact) | steady_slide(parts, contact)
    values |= solution.recorder.array_scalars()
    micro = micro_contact(parts, contact)
    values |= {} if micro is None else micro.scalars()
    if positions:
        values = positions.average_numbers(values)
    values = with_steadiness(values)
    drawn = positions.draw_scalar if positions else None
    values = numbers.with_film_spread(
        values, solution.friction.film_odds, drawn, solution.friction.stated
    )
    values = numbers.with_stated(values, solution.friction.stated)
    drainage = None
    if contact.fluid_load > FILM_MATTERS * contact.normal_force:
        drainage = lug_drainage(parts.sole, contact.fluid_pressure, contact.film_thickness)
    share = float(values["fluid_load"]) / contact.normal_force
    remarks = {
        "drainage": drainage.advice() if drainage else NOTHING,
        "overload": numbers.overload_words(overload),
        "slope": numbers.slope_words(case),
        **(positions.labels() if positions else {}),
    }
    labels = numbers.regime(share) | numbers.spread_origin(sampled)
    unknown = micro is not None or parts.context.leak_deviation > 0
    if unknown and not solution.spreads and share > FILM_MATTERS:
        labels["film_spread"] = Message(
            "leaves out the roughness that lets fluid leak, which could not be estimated"
        )
    else:
        labels["film_spread_basis"] = Message("with the roughness that lets fluid leak")
    rocker = case.origins.get("shoe.heel.profile.radius")
    if rocker is None or not rocker.leaf.assumed:
        labels["film_heel_basis"] = Message("with lengths of the heel that nobody measured")
    labels |= _remarks(parts, solution, remarks) | solution.stated.labels()
    if isinstance(errors, NumericalErrors):
        values = errors.widen_numbers(values)
        errors = errors.sentence(values)
    labels["grid_error"] = errors
    if overload:
        reason = "not resolved: pressures above the modulus of the rubber, which gives way"
        values["peak_fluid_pressure"] = SourcedValue(None, "Pa", reason=reason)
    return ResultNumbers(values, labels, sampled, overload, risk, drainage)


def _remarks(parts: Prepared, solution: Solution, more: dict[str, str]) -> dict[str, str]:
    """Return what is to be said of the contact, ``more`` with it, in a reader's order."""
    case, sole, contact = parts.case, parts.sole, solution.contact
    lugs, slits, sensor = solution.friction.lugs, sole.slits, solution.sensor
    giving = "compliance" not in parts.objects and case.compliance.cut
    peak = peak_pressure(sole, contact.total_pressure, cell_load=contact.cell_load)
    remarks = {
        "lug_edges": NOTHING
        if lugs is None
        else Message("{edges}{chamfer}", edges=lugs.summary(), chamfer=chamfer_remark(case)),
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
        if sole.cells or sole.tread_depth.any()
        else Message(
            "Square cells do not resolve where the film enters: COF and film load of a flat heel "
            'may be off by half; numerics.cells_along = "auto" resolves it.'
        ),
        "sensor": blind_sensor(case, sensor, contact),
        "floor_reading": " ".join(map(str, _unexpected_readings(parts.law))),
    }
    return {name: remark for name, remark in (remarks | more).items() if remark}


def _unexpected_readings(law: FrictionLaw) -> tuple[UnexpectedReading, ...]:
    """Return what was read of the floor and not foretold."""
    return law.draws.outside if isinstance(law, PairContactLaw) else ()


def _last_instant(case: Case) -> Message:
    """Return when the numbers of a motion that ends are taken, and what is assumed of its start."""
    history, end = case.motion.build(), case.motion.end_time
    if end is None:
        return NOTHING
    parts = [Message("at {time}", time=Amount(end, "s"))]
    if history is not None and np.ptp(history.shoe_angle):
        angle = Amount(float(history.shoe_angle[-1]), "rad")
        parts = [
            Message(
                "at the end of the motion ({time}, shoe angle {angle})",
                time=Amount(end, "s"),
                angle=angle,
            )
        ]
    if history is not None and abs(history.speed[-1]) < SLOWEST:
        rest = Amount(SLOWEST, "m/s")
        parts.append(
            Message("where the shoe is at rest: that of sliding off at {speed}", speed=rest)
        )
    if case.contaminant is not None:
        film = Amount(start_film(case, steady=False), "m")
        parts.append(Message("from {film} above the floor at touch-down", film=film))
        if history is not None and history.normal_force[0] > 0:
            rise = Amount(min(case.motion.force_rise_time, LANDED), "s")
            load = Amount(float(history.normal_force[0]), "N")
            parts.append(Message("where {load} come up within {rise}", load=load, rise=rise))
    return Message("{parts}", parts=parts)


def chamfer_remark(case: Case) -> Message:
    """Return what the chamfer of lugs counts as for the film at their edges, if there is one."""
    if not case.value("shoe.tread.edge_chamfer"):
        return NOTHING
    return Message(
        "; chamfered edges count as sharp ones, 0.1 mm round (assumed: no source for their film)"
    )
