"""Contact and film of a prepared case in time, with the friction and the readings at its end."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from underfoot.case import Case
from underfoot.core import ConvergenceError, Progress, silent
from underfoot.core.pool import in_processes
from underfoot.core.progress import part
from underfoot.film import FilmModel, NewtonianFilm
from underfoot.friction import FrictionLaw
from underfoot.friction.sampled_cof import FLOW, GAP, LEAK
from underfoot.rough_contact.pressure_gap_law import PressureGapLaw, TabulatedLaw
from underfoot.shoe import SoleMap
from underfoot.sole_contact import SensorReading
from underfoot.sole_contact.compliance import Compliance
from underfoot.sole_contact.lug_edges import EdgedLaw, LugInlet
from underfoot.sole_contact.motion_history import solve_history
from underfoot.sole_contact.sole_state import SoleState, SolverSettings
from underfoot.sole_contact.solver import SoleContact, solve_on, solve_sliding

from .contact_friction import ContactFriction, contact_friction
from .histories import Recorder
from .micro_contact import micro_contact
from .positions import Place, TreadPositions, place_numbers, position_count, tread_positions
from .prepare import Prepared, prepared
from .sensors import scanned
from .sole import sole_map

LEAST_FILM = 1e-3
"""Share of the load from which it is computed how unknown a film is."""
MOST_STEPS = 20
"""Parts, failed ones included, that a step may fall into: more would cost as much as a march."""


@dataclass(frozen=True, slots=True)
class Solution:
    """The contact of a prepared case at the end of its motion, and what was taken down on the way.

    Attributes:
        friction: Of the contact, as the tread lies.
        sensor: What the scans of the floor read.
        spreads: ``film_spreads``.
    """

    contact: SoleContact
    recorder: Recorder
    friction: ContactFriction
    sensor: SensorReading
    spreads: Mapping[str, tuple[float, float]]


def solved(parts: Prepared, progress: Progress = silent) -> Solution:
    """Return the contact of a prepared case.

    Raises:
        ConvergenceError: Not even the first contact could be solved.
    """
    case, sole = parts.case, parts.sole
    recorder = Recorder(case, parts.local_law, sole, parts.viscosity)
    contact = solved_motion(
        case,
        sole,
        parts.compliance,
        parts.asperities,
        parts.film,
        parts.local_law,
        watch=recorder,
        progress=progress,
    )
    spreads = film_spreads(parts, contact, progress)
    law = parts.local_law
    friction = contact_friction(case, parts.context, law, sole, contact, spreads=spreads)
    sensor = scanned(case, sole, contact, viscosity=parts.viscosity)
    return Solution(contact, recorder, friction, sensor, spreads)


def film_spreads(
    parts: Prepared, contact: SoleContact, progress: Progress = silent
) -> dict[str, tuple[float, float]]:
    """Return what one standard deviation less and more of a gap adds to ln F / (W - F).

    F is the load on the film, W the whole; by name of the part of the rough contact (``ROUGH``):
    gap and flow of measured surfaces, else the roughness that lets fluid leak. The contact goes on
    in two steps with and without the change; that of a motion history is solved again, on the quick
    grid as the tread lies. Empty where the film bears less than ``LEAST_FILM`` of the load, a rough
    contact was given, or a contact could not be solved.
    """
    law, film = parts.asperities, contact.fluid_load / contact.normal_force
    given = "rough_contact" in parts.objects or parts.film is None
    if given or not contact.status.usable or not LEAST_FILM < film < 1:
        return {}
    rough = micro_contact(parts, contact)
    if isinstance(law, TabulatedLaw) and rough is not None:
        gap, flow = 1 + rough.gap_deviation, 1 + rough.flow_deviation
        changed = {
            GAP: (law.changed(1 / gap, 1.0), law.changed(gap, 1.0)),
            FLOW: (law.changed(1.0, 1 / flow), law.changed(1.0, flow)),
        }
    elif deviation := parts.context.leak_deviation:
        leaks = (_leaking(parts, math.exp(sign * deviation)) for sign in (-1, 1))
        changed = {LEAK: tuple(leaks)}
    else:
        return {}
    odds = _odds_on(parts, contact, progress)
    try:
        unchanged = odds(law)
        return {
            name: (odds(less) - unchanged, odds(more) - unchanged)
            for name, (less, more) in changed.items()
        }
    except ConvergenceError:
        return {}


def _leaking(parts: Prepared, factor: float) -> PressureGapLaw:
    """Return the rough contact on ``factor`` times the roughness that lets fluid leak."""
    rq = parts.context.rq.scaled(factor)
    return parts.case.rough_contact.build(replace(parts.context, rq=rq))


def _odds_on(
    parts: Prepared, contact: SoleContact, progress: Progress
) -> Callable[[PressureGapLaw], float]:
    """Return a function: ln F / (W - F) of a contact on other asperities."""
    case, sole, compliance = parts.case, parts.sole, parts.compliance
    steady = case.motion.build() is None
    if not steady and "compliance" not in parts.objects:
        sole = sole_map(case, case.numerics.quick_grid_spacing)
        compliance = parts.compliance_on(sole)

    def odds(asperities: PressureGapLaw) -> float:
        local_law = replace(parts, asperities=asperities).law_on(sole)
        if steady:
            on = sole, compliance, asperities
            end = continued(contact, case, *on, parts.film, local_law)[-1]
        else:
            end = solved_motion(
                case, sole, compliance, asperities, parts.film, local_law, progress=progress
            )
        if not end.status.usable:
            raise ConvergenceError(str(end.status), history=[])
        share = min(max(end.fluid_load / end.normal_force, 1e-6), 1 - 1e-6)
        return math.log(share / (1 - share))

    return odds


def solved_at(
    parts: Prepared,
    place: Place,
    spacing: float,
    *,
    finer: float = 1,
    progress: Progress = silent,
) -> tuple[SoleMap, SoleContact]:
    """Return sole and contact with the tread at a place, on cells of ``spacing`` (m).

    ``finer``: ``solver_settings``.
    """
    case = parts.case
    sole = sole_map(case, spacing, shift=place.shift, turn=place.turn)
    compliance, law = parts.compliance_on(sole, place.turn), parts.law_on(sole)
    more: Any = {"finer": finer, "progress": progress}
    return sole, solved_motion(case, sole, compliance, parts.asperities, parts.film, law, **more)


def averaged(
    parts: Prepared,
    solution: Solution,
    *,
    quick: bool,
    processes: int = 1,
    progress: Progress = silent,
) -> TreadPositions | None:
    """Return the numbers at more positions of the tread or shoe angles.

    None without a contact, and where the case asks for one position.
    Up to ``processes`` positions are solved at the same time, each on one thread: the digits are
    those of one process. A compliance that was given holds for the position of the run alone.
    """
    total = position_count(parts.case, quick=quick)
    if total == 1 or "compliance" in parts.objects or not solution.contact.status.usable:
        return None

    def at_places(
        places: Sequence[Place], spacing: float
    ) -> Iterator[tuple[int, Mapping[str, float] | None]]:
        if processes > 1 and not parts.objects:
            numbers_at = _PlaceNumbers(parts.case, parts.spacing, spacing)
            yield from in_processes(
                numbers_at, places, processes, progress=progress, stage="Tread positions"
            )
            return
        count = len(places)
        for k, place in enumerate(places):
            name = f"Tread position {total - count + k + 1} of {total}"
            march = part(progress, k / count, (k + 1) / count, name)
            yield k, _numbers_at(parts, place, spacing, march)

    case_numbers = place_numbers(
        parts.case, parts.local_law, parts.sole, solution.contact, parts.viscosity
    )
    return tread_positions(parts.case, case_numbers, at_places, spacing=parts.spacing, quick=quick)


@dataclass(frozen=True)
class _PlaceNumbers:
    """The numbers of a case at places of its tread; each process prepares the case by itself."""

    case: Case
    own_spacing: float
    spacing: float

    @cached_property
    def _parts(self) -> Prepared:
        return prepared(self.case, self.own_spacing)

    def __call__(self, place: Place) -> Mapping[str, float] | None:
        return _numbers_at(self._parts, place, self.spacing)


def _numbers_at(
    parts: Prepared, place: Place, spacing: float, progress: Progress = silent
) -> Mapping[str, float] | None:
    """Return the numbers of a result at a place; None where its contact did not converge."""
    try:
        sole, contact = solved_at(parts, place, spacing, progress=progress)
    except ConvergenceError:
        return None
    if not contact.status.usable:
        return None
    return place_numbers(parts.case, parts.law_on(sole), sole, contact, parts.viscosity)


def pool_depth(case: Case) -> float:
    """Return the depth of the fluid on the floor, m; on a dry floor the default, unused."""
    return 0.6e-3 if case.contaminant is None else case.contaminant.pool_depth


def solver_settings(
    case: Case, film: FilmModel | None = None, *, finer: float = 1
) -> SolverSettings:
    """Return how the contact of the case is solved, with ``finer`` times the steps in time."""
    motion = case.motion
    return SolverSettings(
        time_resolution=SolverSettings().time_resolution * finer,
        pool_depth=pool_depth(case),
        start_film=motion.start_film,
        rise_time=motion.force_rise_time,
        end_time=motion.end_time,
        steady=motion.to_steady_state,
        tolerance=case.numerics.tolerance,
        film=None if isinstance(film, NewtonianFilm) else film,
    )


def edge_inlet(case: Case, law: FrictionLaw | EdgedLaw) -> LugInlet | None:
    """Return what the edges of lugs let in; None where the local friction knows none."""
    if not isinstance(law, EdgedLaw):
        return None
    return law.inlet(case.motion.normal_force, case.motion.speed)


def solved_motion(
    case: Case,
    sole: SoleMap,
    compliance: Compliance,
    asperities: PressureGapLaw,
    film: FilmModel | None,
    law: FrictionLaw | EdgedLaw,
    *,
    finer: float = 1,
    watch: Callable[[SoleState], None] | None = None,
    progress: Progress = silent,
) -> SoleContact:
    """Return contact and film at the end of the case's motion; ``finer``: ``solver_settings``.

    ``law`` is the local friction: where it knows the edges of lugs, these say what film enters.
    """
    motion, history, parts = case.motion, case.motion.build(), (sole, compliance, asperities)
    common: dict[str, Any] = {
        "viscosity": None if film is None else film.viscosity,
        "settings": solver_settings(case, film, finer=finer),
        "progress": progress,
        "watch": watch,
        "inlet": edge_inlet(case, law),
    }
    if history is not None:
        return solve_history(*parts, history, map_angle=motion.shoe_angle, **common)
    return solve_sliding(*parts, speed=motion.speed, normal_force=motion.normal_force, **common)


def continued(
    start: SoleContact,
    case: Case,
    sole: SoleMap,
    compliance: Compliance,
    asperities: PressureGapLaw,
    film: FilmModel | None,
    law: FrictionLaw | EdgedLaw,
    *,
    turn: float = 0.0,
) -> list[SoleContact]:
    """Return what a steady contact becomes under a changed case after one step and after two.

    ``turn``: change of the shoe angle since the map was made, rad.

    Raises:
        InputError: Another grid.
        ConvergenceError: A step could not be made.
    """
    settings = replace(solver_settings(case, film), most_time_steps=MOST_STEPS)
    return solve_on(
        start,
        sole,
        compliance,
        asperities,
        viscosity=None if film is None else film.viscosity,
        speed=case.motion.speed,
        normal_force=case.motion.normal_force,
        turn=turn,
        duration=settings.end_time,
        steps=2,
        settings=settings,
        inlet=edge_inlet(case, law),
    )
