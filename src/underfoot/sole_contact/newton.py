"""One implicit step of the coupled problem by a semismooth Newton method.

Unknowns: the total pressure p of each cell of the wet region and the approach d; the liquid
fraction theta of cavitated cells follows from them by their own mass balance.

    h = G - d + C p,   p_f = p - P(h)
    full cell:       R(p_f, theta, h) = 0,  theta = 1       R: ``film.face_operator.FaceOperator``
    cavitated cell:  p_f = p_cavity,  R(p_f, theta, h) = 0
    dry cell:        p_f = 0
    load:            sum p dA = F

A cell is full when p_f - p_cavity - (R + R_theta (1 - theta)) / c > 0, with R its balance and c the
diagonal of the condensed Jacobian: one rule for both sides, since R is 0 in a cavity and theta is 1
in a full cell. Scaling by the conduction alone makes the set cycle at short time steps.

The pool: a cell that it does not reach (a gap deeper than the pool, or beyond the sole) is at the
pressure of the air and holds the pool's depth, which fills any gap that the pool reaches. So liquid
enters the film at the film's own gap (theta = 1), and a cell that comes into the pool starts full.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core import ConvergenceError
from underfoot.core.arrays import Array, Mask
from underfoot.film.face_operator import Faces, Inlet
from underfoot.film.operator import Upwinding

from .film_balance import FilmBalance, Linearisation
from .gmres import krylov_solution
from .preconditioner import PoleFit, Preconditioner
from .problem import Problem, State
from .row_compliance import RowCompliance

STALL = 12  # Newton steps without halving the residual after which a shorter time step is tried
FORCING = 0.3  # share of the residual to which GMRES solves, once the residual is small
STUCK = 3  # such steps after which gaps that are pressed shut count as fixed
CYCLES = (2, 3, 4)  # Newton steps after which a balance may come again
CYCLE = 0.05  # relative difference of such balances that counts as none
SWING = 1.2  # largest over smallest balance within a cycle: one that only falls slowly has none
THIN = 2e-4  # m; steps are limited where the film is thinner


@dataclass(slots=True)
class Attempt:
    """How one Newton solve went."""

    state: State | None
    newton: int
    krylov: int
    residuals: list[float] = field(default_factory=list)


class Cells:
    """Cells that a step may change and those beside them: faces, compliance, preconditioner.

    A step is solved on these alone: its cost is that of what is wet, not of the sole. The first
    ``size`` are unknowns, in the order of the whole sole; those beside them hold no pressure.
    """

    def __init__(self, mask: Mask, problem: Problem, fit: PoleFit) -> None:
        self.mask = mask  # (cells of the whole sole,)
        whole = problem.cells
        joined_x = mask[whole.west] | mask[whole.east]
        joined_y = mask[whole.south] | mask[whole.north]
        beside = np.zeros_like(mask)
        for cells, joined in (
            (whole.west, joined_x),
            (whole.east, joined_x),
            (whole.south, joined_y),
            (whole.north, joined_y),
        ):
            beside[cells[joined]] = True
        unknown = np.flatnonzero(mask)
        self.numbers = np.concatenate([unknown, np.flatnonzero(beside & ~mask)])
        self.size = unknown.size
        number = np.full(mask.size, -1)
        number[self.numbers] = np.arange(self.numbers.size)
        self.x_faces = joined_x
        self.faces = Faces(
            self.numbers.size,
            self.size,
            whole.spacing,
            number[whole.west[joined_x]],
            number[whole.east[joined_x]],
            whole.distance[joined_x],
            whole.node[joined_x],
            whole.lean[:, joined_x],
            whole.rise[:, joined_x],
            number[whole.south[joined_y]],
            number[whole.north[joined_y]],
            whole.overlap[joined_y],
            whole.crossing[joined_y],
        )
        self._part = whole.part(self.numbers)
        self._mirror = None
        if problem.mirror is not None:
            across = number[problem.mirror[self.numbers]]
            self._mirror = across if (across >= 0).all() else None
        self._compliance = problem.compliance.within(self.numbers)
        # for directions of a Newton step: GMRES solves to 1e-3, balances are in double precision
        self.direction = problem.compliance.within(self.numbers, np.float32)
        scale = float(np.median(self._compliance.self_compliance[: self.size]))
        width = self._part.width[: self.size]
        self.preconditioner = Preconditioner(self.faces, fit, scale, width)

    def problem(self, whole: Problem) -> Problem:
        """Return the problem on these cells."""
        return replace(
            whole,
            cells=self._part,
            clearance=whole.clearance[self.numbers],
            compliance=self._compliance,
            drained=None,
            mirror=self._mirror,
        )

    def state(self, whole: State) -> State:
        """Return the state on these cells."""
        names = ("pressure", "gap", "fluid", "contact", "cavitated", "fraction")
        return replace(whole, **{name: getattr(whole, name)[self.numbers] for name in names})

    def on_whole(self, state: State, problem: Problem, deflection: RowCompliance) -> State:
        """Return a state on these cells as one of the whole sole, unloaded beside them.

        ``deflection`` of the whole sole, of any precision, gives the gap of the other cells.
        """

        def field_of(values: NDArray[Any], beside: float = 0.0) -> NDArray[Any]:
            field = np.full(self.mask.shape, beside, dtype=values.dtype)
            field[self.numbers] = values
            return field

        pressure = field_of(state.pressure)
        risen = deflection.apply(pressure.astype(np.float32))
        gap = problem.symmetric(problem.clearance - state.approach + risen)
        gap[self.numbers] = state.gap
        return State(
            pressure,
            state.approach,
            gap,
            field_of(state.fluid),
            field_of(state.contact),
            field_of(state.cavitated),
            field_of(state.fraction, 1.0),
        )


def implicit_step(
    problem: Problem,
    cells: Cells,
    start: State,
    *,
    load: float,
    duration: float,
    film: Mask,
    content: Array,
    tolerance: float,
    leaps: bool,
    upstream: Upwinding | None,
    inlet: Inlet | None,
    tick: Callable[[float], None],
) -> Attempt:
    """Return the state after ``duration`` under ``load``, if Newton finds it.

    All are on the cells given. ``film`` marks the cells that the pool reaches, ``content`` (m)
    is the liquid that they hold at the start, ``tolerance`` the largest relative imbalance; for
    ``leaps`` and ``upstream`` (None on a dry floor) see ``FilmBalance``; ``tick`` receives the
    residual of each Newton step.
    """
    faces, size = cells.faces, cells.size
    area = problem.spacing**2
    width = problem.cells.width[:size]
    wet = film[:size]
    floor = np.where(wet, problem.settings.cavity_pressure, 0.0) * problem.film_share[:size]
    land = problem.contact_share[:size]
    full = np.zeros(size, dtype=bool)
    balance = None
    if upstream is not None:
        full = wet & ~start.cavitated[:size]
        balance = FilmBalance(
            problem, faces, film, start.gap, content, duration, leaps, upstream, inlet
        )

    def pad_values(values: NDArray[Any], beside: float = 0.0) -> NDArray[Any]:
        field = np.full(faces.count, beside, dtype=values.dtype)
        field[:size] = values
        return field

    pressure = pad_values(start.pressure[:size])
    approach = start.approach
    gap = start.gap
    # a sole that rolls changes its clearance: Newton brings it in, or the guess cuts the floor
    missing = problem.gap(pressure, approach) - gap
    attempt = Attempt(None, 0, 0)
    change = np.inf
    balances: list[float] = []
    whole = float(width.sum())
    faint = 1e-9 * load / (whole * area)

    for iteration in range(problem.settings.most_newton + 1):
        local_gap = gap[:size]
        total = pressure[:size]
        asperity = land * problem.law.pressure(local_gap)
        stiffness = land * problem.law.stiffness(local_gap)
        above = total - asperity - floor
        rows, residual, imbalance = None, above, 0.0
        if balance is not None:
            rows = balance.rows(gap, above, stiffness, full, faint, _stuck(balances))
            full = rows.full
            residual = np.where(full, rows.imbalance / rows.diagonal, above)
            imbalance = rows.error
        shortage = load - problem.load(pressure)
        wrong = float(np.abs(np.where(full, np.minimum(above, 0.0), above)) @ width)
        lacking = missing[:size]
        balances.append(max(imbalance, wrong * area / load, abs(shortage) / load))
        error = max(balances[-1], min(change, 1.0) * 0.1)
        error = max(error, 0.01 * float(np.abs(lacking).max()) / problem.decay)
        attempt.residuals.append(error)
        tick(error)
        if error < tolerance:
            attempt.state = State(
                pressure,
                approach,
                gap,
                pad_values(floor + np.where(full, above, 0.0)),
                pad_values(np.where(full, asperity, total - floor)),
                film & ~pad_values(full),
                np.ones_like(gap) if rows is None else np.minimum(rows.fraction, 1.0),
            )
            return attempt
        if iteration == problem.settings.most_newton or _hopeless(attempt.residuals):
            break

        linear = Linearisation(faces, stiffness, full, rows)
        try:
            solve = cells.preconditioner.factorise(linear, problem.settings.backend)
        except ConvergenceError:
            break

        def product(vector: Array, linear=linear) -> Array:
            deflection = cells.direction.apply(pad_values(vector[:-1].astype(np.float32)))
            out = np.empty_like(vector)
            out[:-1] = linear.residual(vector[:-1], deflection[:size] - vector[-1])
            out[-1] = (vector[:-1] @ width) / whole
            return out

        right = -residual - linear.residual(np.zeros(size), lacking)
        # far from the solution an exact Newton step is wasted
        exact = problem.settings.krylov_tolerance
        step, count, _ = krylov_solution(
            product,
            solve,
            np.append(right, shortage / (whole * area)),
            tolerance=min(max(exact, FORCING * error), 30 * exact),
        )
        attempt.krylov += count
        attempt.newton += 1
        if not np.isfinite(step).all():
            break
        # rounding grows where a film under soft rubber is hardly unique: the image tells it
        delta = problem.symmetric(pad_values(step[:-1]))
        rise = problem.symmetric(problem.compliance.apply(delta) - step[-1] + missing)
        share = _step_share(problem, local_gap, rise[:size])
        if _cycling(balances):
            share *= 0.5
        pressure = pressure + share * delta
        approach += share * float(step[-1])
        gap = gap + share * rise
        missing = (1 - share) * missing
        # a shortened step says nothing about how far the solution still is
        change = problem.load(np.abs(delta)) / load if share == 1.0 else np.inf
    return attempt


def _hopeless(residuals: list[float]) -> bool:
    """Return whether the iteration runs away or has stalled."""
    if len(residuals) < 3:
        return False
    if residuals[-1] > 1e3 * max(residuals[0], 1.0):
        return True
    return _stuck(residuals, STALL)


def _stuck(balances: list[float], steps: int = STUCK) -> bool:
    """Return whether so many steps have not halved what was reached before."""
    return len(balances) > steps and min(balances[-steps:]) > 0.5 * min(balances[:-steps])


def _cycling(balances: list[float]) -> bool:
    """Return whether cells leave and join the film in turn, so that balances come again."""
    now = np.array(balances[-3:])
    return any(
        len(balances) >= period + 3
        and bool((np.abs(now - balances[-3 - period : -period]) < CYCLE * now).all())
        and max(balances[-period - 1 :]) > SWING * min(balances[-period - 1 :])
        for period in CYCLES
    )


def _step_share(problem: Problem, gap: Array, rise: Array) -> float:
    """Return the share of a Newton step that keeps the thin film from jumping."""
    thin = gap < THIN
    if not thin.any():
        return 1.0
    size, change, decay = np.abs(gap[thin]), rise[thin], problem.decay
    down, up = np.maximum(0.7 * size, 1.5 * decay), 3.0 * np.maximum(size, decay)
    room = np.where(change < 0, down, up) / np.maximum(np.abs(change), 1e-30)
    return float(min(1.0, max(0.05, room.min())))
