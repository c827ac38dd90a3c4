"""One implicit step of the coupled problem by a semismooth Newton method.

Unknowns: the total pressure p of each cell of the wet region and the approach d; the liquid
fraction theta of cavitated cells follows from them by their own mass balance.

    h = G - d + C p,   p_f = p - P(h)
    full cell:       R(p_f, theta, h) = 0,  theta = 1       R: ``underfoot.film.FilmOperator``
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
from underfoot.film import Pattern

from .compliance import compliance_within
from .film_balance import FilmBalance, Linearisation
from .gmres import krylov_solution
from .preconditioner import PoleFit, Preconditioner
from .problem import Problem, State

STALL = 12  # Newton steps without halving the residual after which a shorter time step is tried
STALE = 10  # GMRES iterations above which the next Newton step gets a new factorization
NEAR = 0.3  # share to which the last Newton step must have brought the residual for that
FORCING = 0.3  # share of the residual to which GMRES solves, once the residual is small
CYCLE = 0.05  # relative difference of balances two Newton steps apart that counts as none
RIM = 2  # cells beside the wet ones that the upwinding of their faces looks at
THIN = 2e-4  # m; steps are limited where the film is thinner


@dataclass(slots=True)
class Attempt:
    """How one Newton solve went."""

    state: State | None
    newton: int
    krylov: int
    residuals: list[float] = field(default_factory=list)


class Cells:
    """The wet region: the box of the grid around it, its cells, sparsity and preconditioner.

    A step is solved on the box alone: its cost is that of what is wet, not of the sole.
    """

    def __init__(self, mask: Mask, problem: Problem, fit: PoleFit) -> None:
        self.mask = mask
        rows, columns = (np.flatnonzero(mask.any(axis=axis)) for axis in (1, 0))
        self.box = (
            slice(max(int(rows[0]) - RIM, 0), int(rows[-1]) + RIM + 1),
            slice(max(int(columns[0]) - RIM, 0), int(columns[-1]) + RIM + 1),
        )
        self.pattern = Pattern(mask[self.box])
        self._compliance = compliance_within(problem.compliance, self.box)
        # for directions of a Newton step: GMRES solves to 1e-3, balances are in double precision
        self.direction = compliance_within(problem.compliance, self.box, np.float32)
        scale = float(np.median(self.pattern.gather(self._compliance.self_compliance)))
        self.preconditioner = Preconditioner(self.pattern, fit, scale, problem.spacing)

    def problem(self, whole: Problem) -> Problem:
        """Return the problem on the box."""
        return replace(
            whole,
            clearance=whole.clearance[self.box],
            compliance=self._compliance,
            cut=whole.cut.part(self.box),
        )

    def state(self, whole: State) -> State:
        """Return the state on the box."""
        names = ("pressure", "gap", "fluid", "contact", "cavitated", "fraction")
        return replace(whole, **{name: getattr(whole, name)[self.box] for name in names})

    def on_whole(self, state: State, problem: Problem) -> State:
        """Return a state on the box as one on the whole grid, unloaded beside it."""

        def placed(values: NDArray[Any], beside: float = 0.0) -> NDArray[Any]:
            field = np.full(self.mask.shape, beside, dtype=values.dtype)
            field[self.box] = values
            return field

        pressure = placed(state.pressure)
        return State(
            pressure,
            state.approach,
            problem.gap(pressure, state.approach),
            placed(state.fluid),
            placed(state.contact),
            placed(state.cavitated),
            placed(state.fraction, 1.0),
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
    tick: Callable[[float], None],
) -> Attempt:
    """Return the state after ``duration`` under ``load``, if Newton finds it.

    All are on the box of the cells. ``film`` marks the cells that the pool reaches, ``content`` (m)
    is the liquid that they hold at the start, ``tolerance`` the largest relative imbalance; for
    ``leaps`` see ``FilmBalance``; ``tick`` receives the residual of each Newton step.
    """
    pattern = cells.pattern
    area = problem.spacing**2
    size = pattern.size
    wet = pattern.gather(film)
    floor = np.where(wet, problem.settings.cavity_pressure, 0.0)
    floor = floor * pattern.gather(problem.cut.film_area)
    land = pattern.gather(problem.cut.area)
    full = np.zeros(size, dtype=bool)
    balance = None
    if problem.viscosity is not None:
        full = wet & ~pattern.gather(start.cavitated)
        balance = FilmBalance(problem, pattern, film, start.gap, content, duration, leaps)
    pressure = np.where(pattern.mask, start.pressure, 0.0)
    approach = start.approach
    gap = start.gap
    # a sole that rolls changes its clearance: Newton brings it in, or the guess cuts the floor
    missing = problem.gap(pressure, approach) - gap
    attempt = Attempt(None, 0, 0)
    change = np.inf
    solve, count = None, 0
    balances: list[float] = []
    faint = 1e-9 * load / (size * area)

    for iteration in range(problem.settings.most_newton + 1):
        local_gap = pattern.gather(gap)
        total = pattern.gather(pressure)
        asperity = land * problem.law.pressure(local_gap)
        stiffness = land * problem.law.stiffness(local_gap)
        above = total - asperity - floor
        rows, residual, imbalance = None, above, 0.0
        if balance is not None:
            rows = balance.rows(gap, above, stiffness, full, faint)
            full = rows.full
            residual = np.where(full, rows.imbalance / rows.diagonal, above)
            imbalance = rows.error
        shortage = load - float(pressure.sum()) * area
        wrong = float(np.abs(np.where(full, np.minimum(above, 0.0), above)).sum())
        lacking = pattern.gather(missing)
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
                pattern.scatter(floor + np.where(full, above, 0.0)),
                pattern.scatter(np.where(full, asperity, total - floor)),
                film & ~pattern.scatter(full),
                np.ones_like(gap) if rows is None else np.minimum(rows.fraction, 1.0),
            )
            return attempt
        if iteration == problem.settings.most_newton or _hopeless(attempt.residuals):
            break

        linear = Linearisation(pattern, stiffness, full, rows)
        # a factorization serves the next step too while the sets and the stiffness settle
        near = len(attempt.residuals) > 1 and error < NEAR * attempt.residuals[-2]
        if solve is None or count > STALE or not near:
            try:
                solve = cells.preconditioner.factorise(linear, problem.settings.backend)
            except ConvergenceError:
                break

        def product(vector: Array, linear=linear) -> Array:
            field = cells.direction.apply(pattern.scatter(vector[:-1].astype(np.float32)))
            out = np.empty_like(vector)
            out[:-1] = linear.residual(vector[:-1], pattern.gather(field) - vector[-1])
            out[-1] = vector[:-1].sum() / size
            return out

        right = -residual - linear.residual(np.zeros(size), lacking)
        # far from the solution an exact Newton step is wasted
        exact = problem.settings.krylov_tolerance
        step, count, _ = krylov_solution(
            product,
            solve,
            np.append(right, shortage / (size * area)),
            tolerance=min(max(exact, FORCING * error), 30 * exact),
        )
        attempt.krylov += count
        attempt.newton += 1
        if not np.isfinite(step).all():
            break
        delta = pattern.scatter(step[:-1])
        rise = problem.compliance.apply(delta) - step[-1] + missing
        share = _step_share(problem, local_gap, pattern.gather(rise))
        if _cycling(balances):
            share *= 0.5
        pressure = pressure + share * delta
        approach += share * float(step[-1])
        gap = gap + share * rise
        missing = (1 - share) * missing
        # a shortened step says nothing about how far the solution still is
        change = float(np.abs(delta).sum()) * area / load if share == 1.0 else np.inf
    return attempt


def _hopeless(residuals: list[float]) -> bool:
    """Return whether the iteration runs away or has stalled."""
    if len(residuals) < 3:
        return False
    if residuals[-1] > 1e3 * max(residuals[0], 1.0):
        return True
    return len(residuals) > STALL and min(residuals[-STALL:]) > 0.5 * min(residuals[:-STALL])


def _cycling(balances: list[float]) -> bool:
    """Return whether cells leave and join the film in turn: every second balance is the same."""
    if len(balances) < 5:
        return False
    before, now = np.array(balances[-5:-2]), np.array(balances[-3:])
    return bool((np.abs(now - before) < CYCLE * now).all())


def _step_share(problem: Problem, gap: Array, rise: Array) -> float:
    """Return the share of a Newton step that keeps the thin film from jumping."""
    thin = gap < THIN
    if not thin.any():
        return 1.0
    size, change, decay = np.abs(gap[thin]), rise[thin], problem.decay
    down, up = np.maximum(0.7 * size, 1.5 * decay), 3.0 * np.maximum(size, decay)
    room = np.where(change < 0, down, up) / np.maximum(np.abs(change), 1e-30)
    return float(min(1.0, max(0.05, room.min())))
