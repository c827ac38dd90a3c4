"""Primal-dual active set for p >= 0, gap >= 0, p gap = 0, mean p = p0 on one grid."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum, auto
from typing import Any

import numpy as np

from underfoot.core.arrays import AnyArray
from underfoot.core.threads import on_host

from .krylov import Restriction, Workspace, residual_correction
from .members import count_true, each, flat, members
from .operators import Operators

_SWITCH = 1e-5
"""Error at which the residual is taken in double precision: ten times the rounding of single."""
_PATIENCE = 4
"""Steps without a new least error after which the inner solves are made ten times more exact."""
_HOPELESS = 3
"""Rounds of patience after which the way is given up."""
_THINNER = 0.6
_HARD_STEPS = 40
_MATTRESS_TOLERANCE = 1e-3


@dataclass(slots=True)
class ContactState:
    """Pressure and gap (scaled fields), steps taken, the error of every step, products made."""

    pressure: AnyArray
    gap: AnyArray
    steps: int
    error: float
    converged: bool
    history: list[float]
    full: bool = False
    products: int = 0


def _unheard(error: float) -> None:
    pass


@dataclass(frozen=True, slots=True)
class Search:
    """How far a contact is solved.

    ``exact``: the last steps take their residual in double precision. Without ``settle`` a solution
    with some negative pressures will do, as a start for a finer grid. ``reduction`` is the share of
    its residual that an inner solve leaves; ``report`` receives the least error so far after each
    step.
    """

    tolerance: float
    max_steps: int
    exact: bool
    settle: bool = True
    reduction: float = 0.15
    report: Callable[[float], None] = _unheard


class _End(Enum):
    """What a step left of a member: it goes on, goes on in double precision, or leaves."""

    ON = auto()
    EXACT = auto()
    DONE = auto()
    FAILED = auto()


@dataclass(slots=True)
class _Course:
    """How far the contact of one member is; ``number`` is its place among those that began."""

    number: int
    mean_pressure: float
    load: float
    reduction: float
    products: int = 0
    error: float = math.inf
    lowest: float = -1.0
    best: float = math.inf
    since: int = 0
    rounds: int = 0
    history: list[float] = field(default_factory=list)

    def hear(self, error: float, lowest: float) -> None:
        """Take the error and the least pressure of a step."""
        self.error, self.lowest = error, lowest
        self.history.append(error)
        self.best, self.since = (error, 0) if error < self.best else (self.best, self.since + 1)
        if self.since >= _PATIENCE:
            self.reduction, self.since = max(0.1 * self.reduction, 1e-4), 0
            self.rounds += 1

    def end(self, search: Search, double: bool) -> _End:
        """Return what follows from the last step."""
        if self.rounds >= _HOPELESS or not self.error < 1e6:
            return _End.FAILED
        settled = self.lowest >= 0.0 or not search.settle
        if self.error <= search.tolerance and settled and (double or not search.exact):
            return _End.DONE
        if search.exact and not double and self.error <= max(_SWITCH, 3.0 * search.tolerance):
            return _End.EXACT
        return _End.ON

    def state(self, pressure: AnyArray, gap: AnyArray, converged: bool = True) -> ContactState:
        """Return how it ended."""
        steps, history = len(self.history), self.history
        return ContactState(
            pressure, gap, steps, self.error, converged, history, products=self.products
        )


@dataclass(slots=True)
class _Batch:
    """Members that take their steps together; without a ``gap`` it is found from the pressure."""

    operators: Operators
    courses: list[_Course]
    pressure: AnyArray
    contact: AnyArray
    gap: AnyArray = None

    def of(self, index: Sequence[int]) -> "_Batch":
        """Return the members ``index`` alone."""
        courses = [self.courses[n] for n in index]
        fields = (self.pressure, self.contact, self.gap)
        parts = (None if one is None else members(one, index) for one in fields)
        return _Batch(self.operators.of(index), courses, *parts)

    def clip_negative(
        self, n: int, height: AnyArray, double: bool
    ) -> tuple[AnyArray, AnyArray, float]:
        """Return (pressure, gap, error) of a member with its negative pressures taken out."""
        course = self.courses[n]
        course.products += 1
        p = members(self.pressure, [n])
        return _clip_pressure(self.operators.of([n]), p, height, course.load, double)


def solved_contacts(
    operators: Operators,
    height: AnyArray,
    pressure: AnyArray,
    mean_pressure: Sequence[float],
    workspace: Workspace,
    search: Search,
) -> list[ContactState]:
    """Return the contacts of ``height`` (1, nx, ny) under each mean pressure, a member each.

    ``pressure`` (members, nx, ny) are first guesses; their support counts.

    Where the active set cycles (strong loss over a narrow band of speeds), by way of ever thinner
    mattresses on the body: a mattress (compliance + constant) makes the problem diagonally
    dominant, so that the set settles from any start; each thinner one starts from the contact of
    the one before. Slower, and one member after the other.
    """
    states: list[Any] = _on_grid(operators, height, pressure, mean_pressure, workspace, search)
    for n, mean in enumerate(mean_pressure):
        if not states[n].converged:
            products = states[n].products
            states[n] = None  # its fields make room
            guess = members(pressure, [n])
            states[n] = _by_mattresses(operators.of([n]), height, guess, mean, workspace, search)
            states[n].products += products
    return states


def _by_mattresses(
    operators: Operators,
    height: AnyArray,
    pressure: AnyArray,
    mean: float,
    workspace: Workspace,
    search: Search,
) -> ContactState:
    """Return the contact of one member by ever thinner mattresses."""
    least, softness = operators.softness_range()
    before, workspace.steps = workspace.steps, _HARD_STEPS
    last = replace(search, reduction=min(search.reduction, 0.03))
    soft = Search(max(_MATTRESS_TOLERANCE, search.tolerance), 12, False, reduction=last.reduction)
    steps, products = 0, 0
    while softness > 0.1 * least:
        with operators.soften_body(softness):
            (state,) = _on_grid(operators, height, pressure, [mean], workspace, soft)
        steps, products = steps + state.steps, products + state.products
        if state.converged:
            pressure = state.pressure
        del state  # its fields make room for the next
        softness *= _THINNER
    with operators.soften_body(0.0):
        (state,) = _on_grid(operators, height, pressure, [mean], workspace, last)
    workspace.steps = before
    state.steps += steps
    state.products += products
    return state


def _on_grid(
    operators: Operators,
    height: AnyArray,
    pressure: AnyArray,
    mean_pressure: Sequence[float],
    workspace: Workspace,
    search: Search,
) -> list[ContactState]:
    """Return the contacts by the active set alone.

    Each step solves A p = h - d on the present contact with the load as a side condition, then
    takes nodes with p <= 0 out and nodes that the gap of that solution penetrates in. The gap of
    the unclipped solution decides, and a first guess with too much contact is better than one with
    too little: both keep the set from cycling (inverse of an M-matrix: Hintermueller, Ito and
    Kunisch 2002). The error is the largest of the deepest penetration, the pressure-weighted mean
    |gap| and the relative error of the load; it counts only when no pressure is negative.

    Members that are done leave the batch; their last steps, in double precision, begin together.
    """
    points = height.shape[-2] * height.shape[-1]
    courses = [
        _Course(n, mean, mean * points, search.reduction) for n, mean in enumerate(mean_pressure)
    ]
    states: dict[int, ContactState] = {}
    xp = operators.xp
    batch = _Batch(operators, courses, pressure, pressure > 0.0)
    del pressure
    for double in (False, True) if search.exact else (False,):
        waiting: list[_Batch] = []
        while batch.courses:
            ends = _step(batch, height, workspace, search, double, states)
            failed, exact, on = (
                [n for n, end in enumerate(ends) if end is one]
                for one in (_End.FAILED, _End.EXACT, _End.ON)
            )
            if len(on) == len(ends):
                continue
            rest = batch.of(on) if on else _Batch(operators, [], None, None)
            batch.gap = None
            if failed:
                workspace.release()
            for n in failed:
                course = batch.courses[n]
                *fields, course.error = batch.clip_negative(n, height, double)
                states[course.number] = course.state(*fields, converged=False)
            if exact:
                waiting.append(batch.of(exact))
            batch = rest
        if waiting:
            batch = _join_batches(operators, waiting)
            del waiting
            workspace.release()
            batch.pressure = xp.astype(batch.pressure, xp.float64)
    return [states[n] for n in range(len(courses))]


def _join_batches(operators: Operators, batches: list[_Batch]) -> _Batch:
    """Return the members of several batches, without a gap, as one."""
    if len(batches) == 1:
        return batches[0]
    courses = [course for batch in batches for course in batch.courses]
    fields = zip(*((batch.pressure, batch.contact) for batch in batches), strict=True)
    joined = (operators.xp.concat(one) for one in fields)
    members_of = operators.of([course.number for course in courses])
    return _Batch(members_of, courses, *joined)


def _step(
    batch: _Batch,
    height: AnyArray,
    workspace: Workspace,
    search: Search,
    double: bool,
    states: dict[int, ContactState],
) -> list[_End]:
    """Take one step and return what it left of each member; ``states`` receives what is done."""
    operators, courses = batch.operators, batch.courses
    spent = [len(course.history) >= search.max_steps for course in courses]
    if any(spent):
        return [_End.FAILED if over else _End.ON for over in spent]
    xp, began = operators.xp, operators.count
    part = Restriction(batch.contact, xp)
    if part.points in part.nodes:
        return _close_members(batch, height, search, [n == part.points for n in part.nodes], states)
    if 0 in part.nodes:
        empty = operators.asarray(np.array([[[n == 0]] for n in part.nodes]))
        batch.contact = xp.where(empty, height == xp.max(height), batch.contact)
        part = Restriction(batch.contact, xp)
    p = batch.pressure
    if any(course.lowest < 0.0 for course in courses):
        p = batch.pressure = xp.where(batch.contact, p, 0.0)
    negligible = 0.3 * search.tolerance if double else max(0.3 * search.tolerance, 1e-7)
    loads = on_host(xp.sum(flat(p, xp), axis=1)).tolist()
    missing = [course.load - load for course, load in zip(courses, loads, strict=True)]
    short = [
        lack / nodes if abs(lack) > negligible * course.load else 0.0
        for lack, nodes, course in zip(missing, part.nodes, courses, strict=True)
    ]
    if any(short):
        p = batch.pressure = xp.where(batch.contact, p + each(short, p), p)
        batch.gap = None
    if batch.gap is None:
        batch.gap = _gap(operators, p, height, double)
    residual = part.take(batch.gap)
    batch.gap = None  # before the next one is made: fields are what a large grid costs
    part.centre(residual)
    residual = xp.astype(residual, xp.float32)
    residual *= -1.0
    reduction = [course.reduction for course in courses]
    p += part.full_field(residual_correction(operators, part, residual, reduction, workspace))
    residual = None
    if double:
        workspace.release()
    batch.gap = gap = _gap(operators, p, height, double)
    residual = part.take(gap)
    mean = part.mean(residual)
    gap -= mean[:, :, None]
    residual -= mean
    residual *= part.take(p)  # the pressure is zero beside the contact
    part = None
    loads_carried = xp.sum(xp.abs(residual), axis=1), xp.sum(flat(p, xp), axis=1)
    residual = None
    least = xp.min(flat(gap, xp), axis=1), xp.min(flat(p, xp), axis=1)
    measured = zip(courses, *on_host(xp.stack((*loads_carried, *least))).tolist(), strict=True)
    for course, carried, total, deepest, lowest in measured:
        error = max(-deepest, carried / course.load, abs(total / course.load - 1.0))
        course.hear(error, lowest)
        course.products += operators.count - began
    search.report(max(course.best for course in courses))
    ends = [course.end(search, double) for course in courses]
    for n, course in enumerate(courses):
        if ends[n] is _End.DONE:
            states[course.number] = course.state(members(p, [n]), members(gap, [n]))
    if not {_End.ON, _End.EXACT}.intersection(ends):
        return ends
    kept = p > 0.0
    batch.contact = kept | ((gap < 0.0) & ~batch.contact)
    del kept
    if any(course.lowest < 0.0 for course in courses):
        batch.gap = gap = None
    for n, course in enumerate(courses):
        if double and ends[n] is _End.ON and course.error <= search.tolerance:
            # a node on the very edge may change sides for ever: see whether it matters
            *trial, error = batch.clip_negative(n, height, double)
            if error <= search.tolerance:
                course.history[-1] = course.error = error
                states[course.number], ends[n] = course.state(*trial), _End.DONE
    return ends


def _close_members(
    batch: _Batch,
    height: AnyArray,
    search: Search,
    closed: list[bool],
    states: dict[int, ContactState],
) -> list[_End]:
    """Take the ``closed`` members to full contact, done where no pressure of it is negative."""
    operators, before = batch.operators, batch.pressure
    xp = operators.xp
    height = xp.broadcast_to(height, before.shape)
    batch.gap = None
    full = (
        operators.exact_pressure(height)
        if search.exact
        else operators.pressure(xp.astype(height, xp.float32))
    )
    full += each([course.mean_pressure for course in batch.courses], full)
    touching = full > 0.0
    points, nodes = height.shape[-2] * height.shape[-1], count_true(flat(touching, xp), xp)
    ends = [_End.ON] * len(nodes)
    for n, course in enumerate(batch.courses):
        course.products += int(closed[n])
        if closed[n] and nodes[n] == points:
            ends[n] = _End.DONE
            course.history.append(0.0)
            course.error = 0.0
            p = members(full, [n])
            states[course.number] = course.state(p, xp.zeros_like(p))
            states[course.number].full = True
    if _End.ON in ends:
        taken = operators.asarray(np.array(closed)[:, None, None])
        batch.pressure = xp.where(taken, xp.astype(full, before.dtype), before)
        batch.contact = xp.where(taken, touching, batch.contact)
    return ends


def _clip_pressure(
    operators: Operators, p: AnyArray, height: AnyArray, load: float, double: bool
) -> tuple[AnyArray, AnyArray, float]:
    """Return (pressure, gap, error) with the negative pressures of ``p`` taken out."""
    xp = operators.xp
    p = xp.clip(p, 0.0, None)
    p *= load / max(float(xp.sum(p)), 1e-300)
    gap = _gap(operators, p, height, double)
    gap -= float(xp.sum(gap * p)) / load
    carried = gap * p
    carried *= xp.sign(carried)
    return p, gap, max(-float(xp.min(gap)), float(xp.sum(carried)) / load)


def _gap(operators: Operators, pressure: AnyArray, height: AnyArray, double: bool) -> AnyArray:
    if double:
        gap = operators.exact_displacement(pressure)
        gap -= height
        return gap
    gap = operators.displacement(pressure)
    gap -= operators.xp.astype(height, operators.xp.float32)
    return gap
