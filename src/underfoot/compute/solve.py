"""Contact and film of a prepared case in time, with the friction and the readings at its end."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from underfoot.case import Case
from underfoot.core import ConvergenceError, InputError, Progress, silent
from underfoot.core.pool import in_processes
from underfoot.core.progress import part
from underfoot.core.remark import Message
from underfoot.film import FilmModel, NewtonianFilm
from underfoot.friction import FrictionLaw
from underfoot.friction.sampled_cof import FLOW, GAP, LEAK
from underfoot.rough_contact.pressure_gap_law import PressureGapLaw, TabulatedLaw
from underfoot.sole_contact import SensorReading
from underfoot.sole_contact.lug_edges import EdgedLaw, LugInlet
from underfoot.sole_contact.motion_history import solve_history
from underfoot.sole_contact.sole_state import SoleState, SolverSettings
from underfoot.sole_contact.solver import SoleContact, solve_on, solve_sliding

from .contact_friction import ContactFriction, contact_friction
from .histories import Recorder
from .micro_contact import micro_contact
from .position_draws import TreadPlace, TreadPositions, log_film_odds
from .positions import (
    TURNED,
    case_places,
    has_lugs,
    place_numbers,
    position_count,
    shoe_angles,
    tread_positions,
)
from .prepare import Prepared, prepare_case
from .sensors import scan_reading
from .sole import sole_map
from .stated_spreads import Numbers, StatedEffects, solved_effects, stated_spreads

LEAST_FILM = 1e-3
"""Share of the load from which it is computed how unknown a film is."""
STATED_SHARE = 0.5
"""Share of the work of a march that both ends of a stated spread take."""
OF_PLAN = ("heel", "tread", "outsole", "wear")
"""Parts of a shoe that make the map of its sole."""
LANDING = 0.2e-3
"""Height from which a sole lands in a deeper pool, m. The time to squeeze a film goes with 1 / h^2:
what lies above takes a hundredth of what a film of 20 um takes."""
HISTORY_FINER = 2
"""How many times the steps of a held load a history takes: a shoe that rolls leaves its film."""
OWN_MARCH = 0.4
"""Share of a history's work at its own place that is its own march; the changes' are the rest."""
MOST_STEPS = 20
"""Parts, failed ones included, that a step may fall into: more would cost as much as a march."""


@dataclass(frozen=True, slots=True)
class Solution:
    """The contact of a prepared case at the end of its motion, and what was taken down on the way.

    Attributes:
        friction: Of the contact, as the tread lies.
        sensor: What the scans of the floor read.
        spreads: ``film_spreads``.
        stated: ``stated_effects``.
    """

    contact: SoleContact
    recorder: Recorder
    friction: ContactFriction
    sensor: SensorReading
    spreads: Mapping[str, tuple[float, float]]
    stated: StatedEffects


def solve_case(parts: Prepared, progress: Progress = silent, *, processes: int = 1) -> Solution:
    """Return the contact of a prepared case; ``processes`` as in ``average_positions``.

    Raises:
        ConvergenceError: Not even the first contact could be solved.
    """
    case, sole, law = parts.case, parts.sole, parts.local_law
    recorder = Recorder(case, law, sole, parts.viscosity)
    done = 1.0 if case.motion.build() is None else OWN_MARCH
    own = 1.0 / (1.0 + STATED_SHARE * len(stated_spreads(case)))
    contact = solved_motion(parts, watch=recorder, progress=part(progress, 0.0, own * done))
    spreads = film_spreads(parts, contact, part(progress, own * done, own))
    stated = StatedEffects()
    if contact.status.usable:
        rest = part(progress, own, 1.0)
        stated = stated_effects(parts, contact, rest, processes=processes)
    on = case, parts.context, law, sole, contact
    drawn_law = law_without(parts, stated)
    friction = contact_friction(*on, spreads=spreads, stated=stated, drawn_law=drawn_law)
    sensor = scan_reading(case, sole, contact, viscosity=parts.viscosity)
    return Solution(contact, recorder, friction, sensor, spreads, stated)


def stated_effects(
    parts: Prepared, contact: SoleContact, progress: Progress = silent, *, processes: int = 1
) -> StatedEffects:
    """Return what the spreads that a case states do to its numbers.

    Each number is taken at one standard deviation less and more. Where sliding is steady and the
    sole stays as it is, the finished contact goes on in two steps, without lugs to the shoe angles
    of a run too, and is compared with such steps of the case itself. Else both are solved from the
    start on the quick grid, as the tread lies at the places of a quick run (``effect_places``).
    """
    steady = parts.case.motion.end_time is None
    beside = not has_lugs(parts.case) and parts.case.numerics.tread_positions > 1
    turns = shoe_angles() if beside else (TreadPlace(),)

    def step_case(case: Case) -> Numbers | None:
        same = all(getattr(case.shoe, name) == getattr(parts.case.shoe, name) for name in OF_PLAN)
        if not (steady and same and case.motion.shoe_angle == parts.case.motion.shoe_angle):
            return None
        try:
            here = prepare_case(case, parts.spacing, parts.objects)
            ends = [continue_contact(contact, here, turn=place.turn)[-1] for place in turns]
        except (InputError, ConvergenceError):
            return None
        usable = all(end.status.usable for end in ends)
        return _mean([place_numbers(here, end) for end in ends]) if usable else None

    def march_cases(cases: Sequence[Case]) -> list[Numbers | None]:
        asked = [(k, place) for k, case in enumerate(cases) for place in effect_places(case)]
        numbers = _NumbersOfCases(tuple(cases), _effect_spacing(parts), parts.objects)
        ended: list[list[Numbers]] = [[] for _ in cases]
        count = 1 if parts.objects else processes
        stage = "Stated spreads"
        for index, each in in_processes(numbers, asked, count, progress=progress, stage=stage):
            if each is not None:
                ended[asked[index][0]].append(each)
        return [_mean(each) for each in ended]

    return solved_effects(parts.case, step_case, march_cases)


def effect_places(case: Case) -> tuple[TreadPlace, ...]:
    """Return where the tread lies as the effect of a stated spread is solved."""
    one = case.numerics.tread_positions == 1 or case.motion.build() is not None
    if one:
        return (TreadPlace(),)
    return case_places(case, quick=True) if has_lugs(case) else shoe_angles()


def law_without(parts: Prepared, stated: StatedEffects) -> FrictionLaw | EdgedLaw | None:
    """Return the local friction that draws nothing of what ``stated`` holds.

    None where its own is that: nothing is stated, or a law was given, which the effects leave as
    it is.
    """
    exact = None if "friction" in parts.objects else stated.exact(parts.case)
    if exact is None:
        return None
    geometry = parts.sole, parts.compliance
    return prepare_case(exact, parts.spacing, parts.objects, geometry=geometry).local_law


def _effect_spacing(parts: Prepared) -> float:
    return (
        parts.spacing if "compliance" in parts.objects else parts.case.numerics.quick_grid_spacing
    )


def _mean(numbers: Sequence[Numbers]) -> Numbers | None:
    """Return the means of numbers over places; None without any."""
    if not numbers:
        return None
    names = set.intersection(*(set(each) for each in numbers))
    return {name: float(np.mean([each[name] for each in numbers])) for name in names}


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
            GAP: (law.change_gap_and_flow(1 / gap, 1.0), law.change_gap_and_flow(gap, 1.0)),
            FLOW: (law.change_gap_and_flow(1.0, 1 / flow), law.change_gap_and_flow(1.0, flow)),
        }
    elif deviation := parts.context.leak_deviation:
        leaks = (_leaking(parts, math.exp(sign * deviation)) for sign in (-1, 1))
        changed = {LEAK: tuple(leaks)}
    else:
        return {}
    case, moving = parts.case, parts
    steady = case.motion.build() is None
    quick = case.numerics.quick_grid_spacing
    if not steady and "compliance" not in parts.objects and parts.spacing != quick:
        moving = parts.on(sole_map(case, quick))

    def odds(asperities: PressureGapLaw, report: Progress) -> float:
        here = moving.on(asperities=asperities)
        end = (
            continue_contact(contact, here)[-1] if steady else solved_motion(here, progress=report)
        )
        if not end.status.usable:
            raise ConvergenceError(str(end.status), history=[])
        return film_odds(end)

    own = not steady and moving is parts
    laws = [*[law] * (not own), *(each for both in changed.values() for each in both)]
    steps = np.linspace(0.0, 1.0, len(laws) + 1)
    try:
        ends = [odds(one, part(progress, *steps[k : k + 2])) for k, one in enumerate(laws)]
    except ConvergenceError:
        return {}
    unchanged = film_odds(contact) if own else ends.pop(0)
    pairs = zip(ends[::2], ends[1::2], strict=True)
    return {
        name: (less - unchanged, more - unchanged)
        for name, (less, more) in zip(changed, pairs, strict=True)
    }


def film_odds(contact: SoleContact) -> float:
    """Return ln F / (W - F) of the load F on the film of W."""
    film, whole = contact.fluid_load, contact.normal_force
    return float(log_film_odds(film, whole - film))


def _leaking(parts: Prepared, factor: float) -> PressureGapLaw:
    """Return the rough contact on ``factor`` times the roughness that lets fluid leak."""
    rq = parts.context.rq.scale_value(factor)
    return parts.case.rough_contact.build(replace(parts.context, rq=rq))


def solved_at(
    parts: Prepared, place: TreadPlace, spacing: float, *, progress: Progress = silent
) -> tuple[Prepared, SoleContact]:
    """Return case and contact with the tread at a place, on cells of ``spacing`` (m)."""
    sole = sole_map(parts.case, spacing, shift=place.shift, turn=place.turn, yaw=place.yaw)
    here = parts.on(sole, turn=place.turn)
    return here, solved_motion(here, finer=place.finer, progress=progress)


def average_positions(
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
    if (
        position_count(parts.case, quick=quick) == 1
        or "compliance" in parts.objects
        or not solution.contact.status.usable
    ):
        return None

    def at_places(
        asked: Sequence[tuple[TreadPlace, float]],
    ) -> Iterator[tuple[int, Mapping[str, float] | None]]:
        if processes > 1 and not parts.objects:
            yield from in_processes(
                _PlaceNumbers(parts.case, parts.spacing),
                asked,
                processes,
                progress=progress,
                stage="Tread positions",
            )
            return
        ends = np.cumsum([0.0, *(spacing**-2 for _, spacing in asked)])
        for k, (place, spacing) in enumerate(asked):
            begin, end = ends[k : k + 2] / ends[-1]
            name = Message("Position {number} of {count}", number=k + 2, count=len(asked) + 1)
            yield k, _numbers_at(parts, place, spacing, part(progress, begin, end, name))

    known = {TreadPlace(): place_numbers(parts, solution.contact)}
    if has_lugs(parts.case):
        known |= _turn_and_solve(parts, solution.contact)
    return tread_positions(parts.case, known, at_places, spacing=parts.spacing, quick=quick)


def _turn_and_solve(parts: Prepared, contact: SoleContact) -> dict[TreadPlace, Mapping[str, float]]:
    """Return the numbers of a contact that goes on in two steps with the shoe turned up and down.

    Empty where the steps can't be made, or the motion follows a history.
    """
    if parts.case.motion.build() is not None:
        return {}
    try:
        ends = [continue_contact(contact, parts, turn=place.turn)[-1] for place in TURNED]
    except ConvergenceError:
        return {}
    return {place: place_numbers(parts, end) for place, end in zip(TURNED, ends, strict=True)}


@dataclass(frozen=True)
class _PlaceNumbers:
    """The numbers of a case at places of its tread; each process prepares the case by itself."""

    case: Case
    own_spacing: float

    @cached_property
    def _parts(self) -> Prepared:
        return prepare_case(self.case, self.own_spacing)

    def __call__(self, asked: tuple[TreadPlace, float]) -> Mapping[str, float] | None:
        return _numbers_at(self._parts, *asked)


@dataclass(frozen=True)
class _NumbersOfCases:
    """The numbers of changed cases, each as its tread lies at a place."""

    cases: tuple[Case, ...]
    spacing: float
    objects: Mapping[str, Any]

    def __call__(self, asked: tuple[int, TreadPlace]) -> Numbers | None:
        number, place = asked
        try:
            parts = prepare_case(self.cases[number], self.spacing, self.objects)
        except InputError:
            return None
        return _numbers_at(parts, place, self.spacing)


def _numbers_at(
    parts: Prepared, place: TreadPlace, spacing: float, progress: Progress = silent
) -> Mapping[str, float] | None:
    """Return the numbers of a result at a place; None where its contact did not converge."""
    try:
        here, contact = solved_at(parts, place, spacing, progress=progress)
    except ConvergenceError:
        return None
    if not contact.status.usable:
        return None
    return place_numbers(here, contact)


def pool_depth(case: Case) -> float:
    """Return the depth of the fluid on the floor, m; on a dry floor the default, unused."""
    return 0.6e-3 if case.contaminant is None else case.contaminant.pool_depth


def start_film(case: Case, *, steady: bool) -> float:
    """Return the height of the sole's lowest point above the floor when its load begins, m.

    The surface of the pool where none is given, since there the fluid begins to bear, but at most
    ``LANDING``. Sliding that goes on until it is ``steady`` forgets it, and begins lower.
    """
    if case.motion.start_film is not None:
        return case.motion.start_film
    landing = min(pool_depth(case), LANDING)
    return SolverSettings().start_film if steady else landing


def solver_settings(
    case: Case, film: FilmModel | None = None, *, finer: float = 1
) -> SolverSettings:
    """Return how the contact of the case is solved, with ``finer`` times the steps in time."""
    motion = case.motion
    if motion.build() is not None:
        finer *= HISTORY_FINER
    return SolverSettings(
        time_resolution=SolverSettings().time_resolution * finer,
        pool_depth=pool_depth(case),
        start_film=start_film(case, steady=motion.end_time is None),
        rise_time=motion.force_rise_time,
        end_time=motion.end_time,
        tolerance=case.numerics.tolerance,
        film=None if isinstance(film, NewtonianFilm) else film,
    )


def _inlet(parts: Prepared) -> LugInlet | None:
    """Return what the edges of lugs let in; None where the local friction knows none."""
    law, motion = parts.local_law, parts.case.motion
    return law.inlet(motion.normal_force, motion.speed) if isinstance(law, EdgedLaw) else None


def solved_motion(
    parts: Prepared,
    *,
    finer: float = 1,
    watch: Callable[[SoleState], None] | None = None,
    progress: Progress = silent,
) -> SoleContact:
    """Return contact and film at the end of the case's motion; ``finer`` as in ``solver_settings``.

    Where the local friction knows the edges of lugs, these say what film enters.
    """
    motion, history = parts.case.motion, parts.case.motion.build()
    on = parts.sole, parts.compliance, parts.asperities
    common: dict[str, Any] = {
        "viscosity": parts.viscosity,
        "settings": solver_settings(parts.case, parts.film, finer=finer),
        "progress": progress,
        "watch": watch,
        "inlet": _inlet(parts),
    }
    if history is not None:
        return solve_history(*on, history, map_angle=motion.shoe_angle, **common)
    return solve_sliding(
        *on, speed=motion.sliding_speed, normal_force=motion.normal_force, **common
    )


def continue_contact(
    start: SoleContact, parts: Prepared, *, turn: float = 0.0
) -> list[SoleContact]:
    """Return what a steady contact becomes under a changed case after one step and after two.

    ``turn``: change of the shoe angle since the map was made, rad.

    Raises:
        InputError: Another grid.
        ConvergenceError: A step could not be made.
    """
    settings = replace(solver_settings(parts.case, parts.film), most_time_steps=MOST_STEPS)
    return solve_on(
        start,
        parts.sole,
        parts.compliance,
        parts.asperities,
        viscosity=parts.viscosity,
        speed=parts.case.motion.sliding_speed,
        normal_force=parts.case.motion.normal_force,
        turn=turn,
        duration=start.time,
        steps=2,
        settings=settings,
        inlet=_inlet(parts),
    )
