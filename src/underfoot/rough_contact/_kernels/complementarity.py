"""Primal-dual active set for p >= 0, gap >= 0, p gap = 0, mean p = p0 on one grid."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from underfoot.core.arrays import AnyArray
from underfoot.core.threads import on_host

from .krylov import Restriction, Workspace, residual_correction
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
    """Pressure and gap (scaled fields), steps taken, and the error of every step."""

    pressure: AnyArray
    gap: AnyArray
    steps: int
    error: float
    converged: bool
    history: list[float]
    full: bool = False


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


def solved_contact(
    operators: Operators,
    height: AnyArray,
    pressure: AnyArray,
    mean_pressure: float,
    workspace: Workspace,
    search: Search,
) -> ContactState:
    """Return the contact of ``height`` from a first guess of the pressure (its support counts).

    Where the active set cycles (strong loss over a narrow band of speeds), by way of ever thinner
    mattresses on the body: a mattress (compliance + constant) makes the problem diagonally
    dominant, so that the set settles from any start; each thinner one starts from the contact of
    the one before. Slower.
    """
    state = _on_grid(operators, height, pressure, mean_pressure, workspace, search)
    if state.converged:
        return state
    least, softness = operators.softness_range()
    before, workspace.steps = workspace.steps, _HARD_STEPS
    last = replace(search, reduction=min(search.reduction, 0.03))
    soft = Search(max(_MATTRESS_TOLERANCE, search.tolerance), 12, False, reduction=last.reduction)
    steps, state = 0, None
    while softness > 0.1 * least:
        with operators.softened(softness):
            state = _on_grid(operators, height, pressure, mean_pressure, workspace, soft)
        steps += state.steps
        if state.converged:
            pressure = state.pressure
        state = None  # its fields make room for the next
        softness *= _THINNER
    with operators.softened(0.0):
        state = _on_grid(operators, height, pressure, mean_pressure, workspace, last)
    workspace.steps = before
    state.steps += steps
    return state


def _on_grid(
    operators: Operators,
    height: AnyArray,
    pressure: AnyArray,
    mean_pressure: float,
    workspace: Workspace,
    search: Search,
) -> ContactState:
    """Return the contact by the active set alone.

    Each step solves A p = h - d on the present contact with the load as a side condition, then
    takes nodes with p <= 0 out and nodes that the gap of that solution penetrates in. The gap of
    the unclipped solution decides, and a first guess with too much contact is better than one with
    too little: both keep the set from cycling (inverse of an M-matrix: Hintermueller, Ito and
    Kunisch 2002). The error is the largest of the deepest penetration, the pressure-weighted mean
    |gap| and the relative error of the load; it counts only when no pressure is negative.
    """
    tolerance, exact, reduction = search.tolerance, search.exact, search.reduction
    xp = operators.xp
    points = height.shape[0] * height.shape[1]
    load = mean_pressure * points
    double = False
    contact = pressure > 0.0
    p = pressure
    gap: AnyArray = None
    history: list[float] = []
    error = float("inf")
    lowest = -1.0
    best, since, rounds = error, 0, 0
    step = 0
    for step in range(1, search.max_steps + 1):
        part = Restriction(contact, xp)
        if part.nodes == points:
            closed = (
                operators.exact_pressure(height)
                if exact
                else operators.pressure(xp.astype(height, xp.float32))
            )
            p = closed + mean_pressure
            contact, gap = p > 0.0, None
            if bool(xp.all(contact)):
                return ContactState(p, xp.zeros_like(p), step, 0.0, True, [*history, 0.0], True)
            p = xp.astype(p, xp.float64 if double else xp.float32)
            del closed
            part = Restriction(contact, xp)
        if part.nodes == 0:
            contact = height == xp.max(height)
            part = Restriction(contact, xp)
        if lowest < 0.0:
            p = xp.where(contact, p, xp.zeros_like(p))
        missing = load - float(xp.sum(p))
        negligible = 0.3 * tolerance if double else max(0.3 * tolerance, 1e-7)
        if abs(missing) > negligible * load:
            p = xp.where(contact, p + missing / part.nodes, p)
            gap = None
        if gap is None:
            gap = _gap(operators, p, height, double)
        residual = part.take(gap)
        gap = None  # before the next one is made: fields are what a large grid costs
        part.centre(residual)
        residual = xp.astype(residual, xp.float32)
        residual *= -1.0
        p += part.spread(residual_correction(operators, part, residual, reduction, workspace))
        residual = None
        if double:
            workspace.release()
        gap = _gap(operators, p, height, double)
        residual = part.take(gap)
        mean = xp.sum(residual) / part.nodes
        gap -= mean
        residual -= mean
        residual *= part.take(p)  # the pressure is zero beside the contact
        measured = xp.sum(xp.abs(residual)), xp.sum(p), xp.min(gap), xp.min(p)
        residual = None
        carried, total, deepest, lowest = on_host(xp.stack(measured)).tolist()
        error = max(-deepest, carried / load, abs(total / load - 1.0))
        history.append(error)
        best, since = (error, 0) if error < best else (best, since + 1)
        search.report(best)
        if since >= _PATIENCE:
            reduction, since, rounds = max(0.1 * reduction, 1e-4), 0, rounds + 1
        if rounds >= _HOPELESS or not error < 1e6:
            break
        kept = p > 0.0
        settled = lowest >= 0.0 or not search.settle
        if error <= tolerance and settled and (double or not exact):
            return ContactState(p, gap, step, error, True, history)
        contact = kept | ((gap < 0.0) & ~contact)
        if exact and not double and error <= max(_SWITCH, 3.0 * tolerance):
            double = True
            gap = None
            workspace.release()
            p = xp.astype(p, xp.float64)
            continue
        if lowest < 0.0:
            gap = None
        if error <= tolerance and double:
            # a node on the very edge may change sides for ever: see whether it matters
            trial, its_gap, its_error = _clipped(operators, p, height, load, double)
            if its_error <= tolerance:
                history[-1] = its_error
                return ContactState(trial, its_gap, step, its_error, True, history)
    gap = part = None
    workspace.release()
    p, gap, error = _clipped(operators, p, height, load, double)
    return ContactState(p, gap, step, error, False, history)


def _clipped(
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
