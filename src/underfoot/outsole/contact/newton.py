"""One implicit step of the coupled problem by a semismooth Newton method.

Unknowns: the total pressure p of each cell of the wet region and the approach d.

    h = G - d + C p,   p_f = p - P(h)
    film cell:       -div(phi h^3/(12 eta) grad p_f) + div(U h / 2) + dh/dt = 0
    cavitated cell:  p_f = 0
    load:            sum p dA = F

A cell counts as cavitated when p_f - R / c <= 0, with R its net outflow and c the diagonal of the
condensed Jacobian; scaling by the conduction alone makes the set cycle at short time steps.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from underfoot.core import ConvergenceError
from underfoot.film import Pattern, Upwinding, film_flow, upwinding

from ..compliance import Compliance
from .gmres import krylov_solution
from .preconditioner import PoleFit, Preconditioner

if TYPE_CHECKING:
    from underfoot.asperity.law import PressureGapLaw

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
SMALLEST_GAP = 2e-7  # m; the flow sees no thinner film (the pressure law does)
STALL = 12  # Newton steps without halving the residual after which a shorter time step is tried
STALE = 10  # GMRES iterations above which the next Newton step gets a new factorization
NEAR = 0.3  # share to which the last Newton step must have brought the residual for that
FORCING = 0.3  # share of the residual to which GMRES solves, once the residual is small
THIN = 2e-4  # m; steps are limited where the film is thinner


@dataclass(frozen=True, slots=True)
class Problem:
    """What does not change during a run; SI, arrays (nx, ny)."""

    clearance: Array
    spacing: float
    compliance: Compliance
    law: PressureGapLaw
    viscosity: float | None
    wall_speed: float
    largest_gap: float
    decay: float  # m, gap over which the asperity pressure falls by about e
    backend: str | None
    tolerance: float
    most_newton: int
    krylov_tolerance: float

    def gap(self, pressure: Array, approach: float) -> Array:
        """Return the mean gap of a pressure field and an approach."""
        return self.clearance - approach + self.compliance.apply(pressure)


@dataclass(slots=True)
class State:
    """A solved instant."""

    pressure: Array  # total, Pa
    approach: float  # m
    gap: Array  # m, not clipped
    fluid: Array  # Pa
    contact: Array  # Pa
    cavitated: Mask
    imbalance: float = 0.0


@dataclass(slots=True)
class Attempt:
    """How one Newton solve went."""

    state: State | None
    newton: int
    krylov: int
    residuals: list[float] = field(default_factory=list)

    @property
    def converged(self) -> bool:
        """True when the tolerance was met."""
        return self.state is not None


class Cells:
    """The wet region: its cells, sparsity and preconditioner layout."""

    def __init__(self, mask: Mask, problem: Problem, fit: PoleFit) -> None:
        self.mask = mask
        self.pattern = Pattern(mask)
        self.self_compliance = self.pattern.gather(problem.compliance.self_compliance)
        scale = float(np.median(self.self_compliance))
        self.preconditioner = Preconditioner(self.pattern, fit, scale, problem.spacing)


def implicit_step(
    problem: Problem,
    cells: Cells,
    start: State,
    *,
    load: float,
    duration: float | None,
    film: Mask,
    tick: Callable[[float], None],
) -> Attempt:
    """Return the state after ``duration`` (None: at rest) under ``load``, if Newton finds it.

    ``film`` marks the cells that the pool reaches; ``tick`` receives the residual of each step.
    """
    pattern = cells.pattern
    area = problem.spacing**2
    wet = pattern.gather(film)
    dry = problem.viscosity is None
    old_gap = np.clip(start.gap, SMALLEST_GAP, problem.largest_gap)
    lean = None if dry else _lean(problem, old_gap)
    pressure = np.where(cells.mask, start.pressure, 0.0)
    approach = start.approach
    gap = start.gap
    # a sole that rolls changes its clearance: Newton brings it in, or the guess cuts the floor
    missing = problem.gap(pressure, approach) - gap
    attempt = Attempt(None, 0, 0)
    size = pattern.size
    unit = np.zeros((5, size))
    unit[0] = 1.0
    change = np.inf
    solve, count = None, 0
    faint = 1e-9 * load / (size * area)

    for iteration in range(problem.most_newton + 1):
        local_gap = pattern.gather(gap)
        total = pattern.gather(pressure)
        asperity = problem.law.pressure(local_gap)
        stiffness = problem.law.stiffness(local_gap)
        fluid = total - asperity
        if dry:
            cavitated = np.ones(size, dtype=bool)
            residual = fluid
            by_pressure, by_gap = unit, unit * stiffness
            imbalance = 0.0
        else:
            flow = _film(problem, pattern, gap, old_gap, fluid, duration, lean)
            net, by_fluid, by_h, reference = flow
            diagonal = by_fluid[0] * (1 + stiffness * cells.self_compliance)
            diagonal += np.abs(by_h[0]) * cells.self_compliance
            # At rest nothing flows and nothing is pressed: such a cell counts as film.
            cavitated = (fluid - net / diagonal < -faint) | ~wet
            residual = np.where(cavitated, fluid, net / diagonal)
            imbalance = float(np.abs(net[~cavitated]).sum()) / reference
            by_h = by_h + by_fluid * pattern.neighbours_of(stiffness)
            by_pressure = np.where(cavitated, unit, by_fluid / diagonal)
            by_gap = np.where(cavitated, unit * stiffness, by_h / diagonal)
        shortage = load - float(pressure.sum()) * area
        wrong = float(np.abs(fluid[cavitated]).sum()) * area / load
        lacking = pattern.gather(missing)
        error = max(imbalance, wrong, abs(shortage) / load, min(change, 1.0) * 0.1)
        error = max(error, 0.01 * float(np.abs(lacking).max()) / problem.decay)
        attempt.residuals.append(error)
        tick(error)
        if error < problem.tolerance:
            attempt.state = State(
                pressure,
                approach,
                gap,
                pattern.scatter(np.where(cavitated, 0.0, fluid)),
                pattern.scatter(np.where(cavitated, total, asperity)),
                pattern.scatter(cavitated.astype(float)) > 0,
                imbalance,
            )
            return attempt
        if iteration == problem.most_newton or _hopeless(attempt.residuals):
            break

        near = len(attempt.residuals) > 1 and error < NEAR * attempt.residuals[-2]
        if solve is None or count > STALE or not near:
            try:
                solve = cells.preconditioner.factorise(by_pressure, by_gap, problem.backend)
            except ConvergenceError:
                break
        jacobian_p = pattern.matrix(by_pressure)
        jacobian_h = pattern.matrix(by_gap)

        def product(vector: Array, jp=jacobian_p, jh=jacobian_h) -> Array:
            field = problem.compliance.apply(pattern.scatter(vector[:-1]))
            out = np.empty_like(vector)
            out[:-1] = jp @ vector[:-1] + jh @ (pattern.gather(field) - vector[-1])
            out[-1] = vector[:-1].mean()
            return out

        right = np.append(-residual - jacobian_h @ lacking, shortage / (size * area))
        # far from the solution an exact Newton step is wasted
        exact = problem.krylov_tolerance
        step, count, _ = krylov_solution(
            product, solve, right, tolerance=min(max(exact, FORCING * error), 30 * exact)
        )
        attempt.krylov += count
        attempt.newton += 1
        if not np.isfinite(step).all():
            break
        delta = pattern.scatter(step[:-1])
        rise = problem.compliance.apply(delta) - step[-1] + missing
        share = _step_share(problem, local_gap, pattern.gather(rise))
        pressure = pressure + share * delta
        approach += share * float(step[-1])
        gap = gap + share * rise
        missing = (1 - share) * missing
        change = float(np.abs(delta).sum()) * area / load if share == 1.0 else np.inf
    return attempt


def _hopeless(residuals: list[float]) -> bool:
    """Return whether the iteration runs away or has stalled."""
    if len(residuals) < 3:
        return False
    if residuals[-1] > 1e3 * max(residuals[0], 1.0):
        return True
    return len(residuals) > STALL and min(residuals[-STALL:]) > 0.5 * min(residuals[:-STALL])


def _film(
    problem: Problem,
    pattern: Pattern,
    gap: Array,
    old_gap: Array,
    fluid: Array,
    duration: float | None,
    lean: Upwinding | None,
) -> tuple[Array, Array, Array, float]:
    """Return net outflow, its (5, size) derivatives by fluid pressure and gap, and a scale."""
    viscosity = problem.viscosity
    assert viscosity is not None
    area = problem.spacing**2
    clipped = np.clip(gap, SMALLEST_GAP, problem.largest_gap)
    free = ((gap > SMALLEST_GAP) & (gap < problem.largest_gap)).astype(float)
    factor = problem.law.flow_factor(clipped)
    slope = problem.law.flow_factor_slope(clipped)
    conductance = factor * clipped**3 / (12 * viscosity)
    conductance_slope = (3 * factor + slope * clipped) * clipped**2 / (12 * viscosity)
    flow = film_flow(
        clipped,
        pattern.scatter(fluid),
        conductance,
        conductance_slope,
        spacing=problem.spacing,
        wall_speed=problem.wall_speed,
        lean=lean,
    )
    net = flow.outflow
    by_gap = pattern.rows_of(flow.by_gap)
    reference = flow.magnitude
    if duration is not None:
        squeeze = (clipped - old_gap) * (area / duration)
        net = net + squeeze
        by_gap[0] += area / duration
        reference += float(np.abs(pattern.gather(squeeze)).sum())
    by_gap *= pattern.neighbours_of(pattern.gather(free))
    return pattern.gather(net), pattern.rows_of(flow.by_pressure), by_gap, reference + 1e-30


def _lean(problem: Problem, gap: Array) -> Upwinding:
    """Return the upwinding that belongs to the gap at the start of the step."""
    viscosity = problem.viscosity
    assert viscosity is not None
    carried = 0.5 * abs(problem.wall_speed) * problem.spacing * problem.compliance.self_compliance
    conductance = problem.law.flow_factor(gap) * gap**3 / (12 * viscosity)
    return upwinding(gap, carried, conductance, from_a=problem.wall_speed < 0)


def _step_share(problem: Problem, gap: Array, rise: Array) -> float:
    """Return the share of a Newton step that keeps the thin film from jumping."""
    thin = gap < THIN
    if not thin.any():
        return 1.0
    size = np.abs(gap[thin])
    change = rise[thin]
    down = np.maximum(0.7 * size, 1.5 * problem.decay)
    up = np.maximum(3.0 * size, 3.0 * problem.decay)
    room = np.where(change < 0, down / np.maximum(-change, 1e-30), up / np.maximum(change, 1e-30))
    return float(min(1.0, max(0.05, room.min())))
