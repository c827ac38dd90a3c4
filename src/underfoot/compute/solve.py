"""Contact and film of a prepared case in time, with the friction and the readings at its end."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from underfoot.case import Case
from underfoot.core import ConvergenceError, Progress, silent
from underfoot.core.pool import in_processes
from underfoot.core.progress import part
from underfoot.film import FilmModel, NewtonianFilm
from underfoot.friction import FrictionLaw
from underfoot.friction.sampled_cof import FLOW, GAP
from underfoot.rough_contact.pressure_gap_law import PressureGapLaw, TabulatedLaw
from underfoot.shoe import SoleMap
from underfoot.sole_contact import SensorReading
from underfoot.sole_contact.compliance import Compliance
from underfoot.sole_contact.lug_edges import EdgedLaw, LugInlet
from underfoot.sole_contact.motion_history import solve_history
from underfoot.sole_contact.sole_state import SoleState, SolverSettings
from underfoot.sole_contact.solver import SoleContact, solve_sliding

from .contact_friction import ContactFriction, contact_friction
from .histories import Recorder
from .micro_contact import micro_contact
from .positions import Place, TreadPositions, place_numbers, position_count, tread_positions
from .prepare import Prepared, prepared
from .sensors import scanned
from .sole import sole_map
from .summary import FILM_MATTERS


@dataclass(frozen=True, slots=True)
class Solution:
    """The contact of a prepared case at the end of its motion, and what was taken down on the way.

    Attributes:
        friction: Of the contact, as the tread lies.
        sensor: What the scans of the floor read.
    """

    contact: SoleContact
    recorder: Recorder
    friction: ContactFriction
    sensor: SensorReading


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
    rough = film_spreads(parts, contact, progress)
    friction = contact_friction(case, parts.context, parts.local_law, sole, contact, rough=rough)
    sensor = scanned(case, sole, contact, viscosity=parts.viscosity)
    return Solution(contact, recorder, friction, sensor)


def film_spreads(
    parts: Prepared, contact: SoleContact, progress: Progress = silent
) -> dict[str, float]:
    """Return what a standard deviation of a rough contact's gap and flow adds to ln F / (W - F).

    F is the load on the film, W the whole; on the quick grid, as the tread lies. Empty where the
    rough contact is none of measured surfaces, the film bears too little to matter, or one of the
    contacts could not be solved.
    """
    case = parts.case
    rough = micro_contact(parts, contact)
    film = contact.fluid_load / contact.normal_force
    if rough is None or parts.film is None or not contact.status.usable:
        return {}
    if not (FILM_MATTERS < film < 1) or not isinstance(parts.asperities, TabulatedLaw):
        return {}
    sole = sole_map(case, case.numerics.quick_grid_spacing)
    compliance = parts.compliance if "compliance" in parts.objects else parts.compliance_on(sole)
    local_law = parts.law_on(sole)

    def odds(asperities: TabulatedLaw) -> float:
        here = solved_motion(
            case, sole, compliance, asperities, parts.film, local_law, progress=progress
        )
        if not here.status.usable:
            raise ConvergenceError(str(here.status), history=[])
        share = min(max(here.fluid_load / here.normal_force, 1e-6), 1 - 1e-6)
        return math.log(share / (1 - share))

    law = parts.asperities
    wider = law.changed(1 + rough.gap_deviation, 1.0)
    freer = law.changed(1.0, 1 + rough.flow_deviation)
    try:
        own = odds(law)
        return {GAP: odds(wider) - own, FLOW: odds(freer) - own}
    except ConvergenceError:
        return {}


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
