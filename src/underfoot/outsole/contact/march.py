"""Implicit time stepping of the contact: the load rises, the sole slides, the film drains."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation

from underfoot.core import Progress

from .newton import Cells, Problem, State, implicit_step
from .preconditioner import PoleFit

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
EASY = 7  # Newton steps below which the time step grows
GROWTH = 1.5
CUT = 2.5
LETS_GO = 1.05  # times the pool depth; without it a cell at the brink flips at every step
MARGIN = 3  # cells around the pool that may come into contact within a step


@dataclass(slots=True)
class History:
    """What each accepted time step left behind."""

    time: list[float] = field(default_factory=list)
    load: list[float] = field(default_factory=list)
    fluid_load: list[float] = field(default_factory=list)
    approach: list[float] = field(default_factory=list)
    residual: list[float] = field(default_factory=list)


@dataclass(slots=True)
class Counts:
    """How much work it took."""

    time_steps: int = 0
    rejected: int = 0
    newton: int = 0
    krylov: int = 0
    cells: int = 0


@dataclass(slots=True)
class March:
    """End of a run."""

    state: State
    film: Mask
    time: float
    finished: bool
    history: History
    counts: Counts
    residuals: list[float]


def march(
    problem: Problem,
    fit: PoleFit,
    start: State,
    *,
    load_at: Callable[[float], float],
    first_step: float,
    longest_step: Callable[[float], float],
    end_time: float,
    pool_depth: float,
    settled: Callable[[State, State, float, float], bool] | None,
    fraction: Callable[[float], float],
    most_steps: int,
    progress: Progress,
    stage: str,
) -> March:
    """Return the state at ``end_time``, or earlier when ``settled`` says that nothing moves."""
    state, time, step = start, 0.0, first_step
    shortest = first_step * 1e-4
    cells: Cells | None = None
    counts, history = Counts(), History()
    residuals: list[float] = []
    area = problem.spacing**2
    film = _film_mask(problem, state.gap, pool_depth, None)
    while counts.time_steps + counts.rejected < most_steps and time < end_time * (1 - 1e-12):
        step = min(step, longest_step(time), end_time - time)
        film = _film_mask(problem, state.gap, pool_depth, film)
        cells = _cells(problem, fit, cells, film)
        counts.cells = max(counts.cells, cells.pattern.size)
        target = time + step

        attempt = implicit_step(
            problem,
            cells,
            state,
            load=load_at(target),
            duration=step,
            film=film,
            tick=partial(progress, stage, fraction(target)),
        )
        counts.newton += attempt.newton
        counts.krylov += attempt.krylov
        residuals = attempt.residuals
        if attempt.state is None or _escaped(problem, cells, attempt.state.gap):
            counts.rejected += 1
            step /= CUT
            if step < shortest:
                return March(state, film, time, False, history, counts, residuals)
            continue
        previous, state, time = state, attempt.state, target
        counts.time_steps += 1
        history.time.append(time)
        history.load.append(load_at(time))
        history.fluid_load.append(float(state.fluid.sum()) * area)
        history.approach.append(state.approach)
        history.residual.append(residuals[-1])
        if settled is not None and settled(previous, state, step, time):
            return March(state, film, time, True, history, counts, residuals)
        if attempt.newton < EASY:
            step *= GROWTH
    finished = time >= end_time * (1 - 1e-12) and settled is None
    return March(state, film, time, finished, history, counts, residuals)


def _film_mask(problem: Problem, gap: Array, pool_depth: float, before: Mask | None) -> Mask:
    """Return the cells that the pool reaches; one that held film lets go a little later."""
    film = gap < pool_depth
    if before is not None:
        film |= before & (gap < LETS_GO * pool_depth)
    film &= problem.clearance < 0.5
    film[[0, -1]] = film[:, [0, -1]] = False  # the rim of the grid is open to the surroundings
    if not film.any():
        film = problem.clearance < problem.clearance.min() + 2e-5
    return film


def _cells(problem: Problem, fit: PoleFit, cells: Cells | None, film: Mask) -> Cells:
    """Return cells that hold the film with room to spare, the present ones if they do."""
    if (
        cells is not None
        and not (film & ~cells.mask).any()
        and cells.pattern.size < 1.3 * film.sum() + 500
    ):
        return cells
    mask = np.asarray(binary_dilation(film, iterations=MARGIN), dtype=bool) & (
        problem.clearance < 0.5
    )
    return Cells(mask, problem, fit)


def _escaped(problem: Problem, cells: Cells, gap: Array) -> bool:
    """Return whether the sole touches the floor outside the cells of the step."""
    return bool((gap[~cells.mask] < 20 * problem.decay).any())
