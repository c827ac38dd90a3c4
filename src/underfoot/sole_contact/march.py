"""Time steps of the contact: each updates the wet cells, and one that fails is tried shorter."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.ndimage import binary_dilation

from underfoot.core.arrays import Array, Mask
from underfoot.film.face_operator import Inlet, leaning
from underfoot.film.operator import Upwinding

from .film_balance import SMALLEST_GAP
from .lug_edges import LugInlet
from .lug_inlet import LeadingEdges
from .newton import Cells, implicit_step
from .preconditioner import PoleFit
from .problem import Problem, State

EASY = 7  # Newton steps below which the time step grows
GROWTH = 2.0
STILL, FASTER = 3, 4.0  # Newton steps at most on the way to a steady state, and growth then
LEAST_SHARE = 0.1  # of its way that a cell goes where steps swing
CUT = 2.5
SHORTEST = 1e-4  # of the first step, below which the march gives up
BEARS = 1e3  # Pa, of a film that is no edge of the pool: a pocket, which pressure may lift above it
TOUCHES = 20.0  # times the decay of the asperities' pressure, a gap across which they may touch
LETS_GO = 1.05  # times the pool depth; without it a cell at the brink flips at every step
ROOM = 1.3  # times the cells needed now, beyond which they are chosen anew
MARGIN = 3  # cells around the pool that may come into contact within a step
DEEP = 0.6e-3  # m over the pool: cells further from the floor (deep channels) may not


@dataclass(slots=True)
class History:
    """What each accepted time step left behind."""

    time: list[float] = field(default_factory=list)
    load: list[float] = field(default_factory=list)
    fluid_load: list[float] = field(default_factory=list)
    approach: list[float] = field(default_factory=list)
    residual: list[float] = field(default_factory=list)
    speed: list[float] = field(default_factory=list)
    shoe_angle: list[float] = field(default_factory=list)


@dataclass(slots=True)
class Counts:
    """How much work it took."""

    time_steps: int = 0
    rejected: int = 0
    newton: int = 0
    krylov: int = 0
    cells: int = 0


@dataclass(frozen=True, slots=True)
class Demand:
    """What holds at the end of a step: load N, floor speed m/s and clearance of the sole m.

    ``tolerance`` is how exactly, relative; ``leaps``: only what comes after the step matters;
    ``settles``: nothing changes but the contact, on its way to a steady state.
    """

    load: float
    wall_speed: float
    clearance: Array
    tolerance: float
    leaps: bool
    settles: bool = False


class March:
    """The state in time. ``step`` is the length (s) that the next step tries."""

    def __init__(
        self,
        problem: Problem,
        fit: PoleFit,
        start: State,
        *,
        pool_depth: float,
        first_step: float,
        inlet: LugInlet | None = None,
    ) -> None:
        self.problem = problem
        self.state = start
        self.film: Mask = _film_mask(problem, start.gap, pool_depth, None)
        self.step = first_step
        self.counts = Counts()
        self.residuals: list[float] = []
        self._fit = fit
        # of cells that neither pool nor floor reaches
        self._whole = problem.compliance.within(np.arange(start.gap.size), np.float32)
        self._pool_depth = pool_depth
        self._first, self._shortest = first_step, first_step * SHORTEST
        self._cells: Cells | None = None
        self._before: tuple[Array, float] | None = None  # gap before the last step, its length
        self._settling: list[tuple[State, State]] = []  # start and end of the last two steps
        self._lugs = inlet
        self._edges: dict[bool, LeadingEdges] = {}  # by the way that the floor moves

    def turn(self, clearance: Array) -> None:
        """Put another clearance under the state, without time passing."""
        state, change = self.state, clearance - self.problem.clearance
        self.problem = replace(self.problem, clearance=clearance)
        self.state = replace(state, gap=state.gap + change)
        self.film = _film_mask(self.problem, self.state.gap, self._pool_depth, None)

    def lower(self, way: float) -> None:
        """Bring a sole that nothing holds yet closer to the floor by ``way`` (m), at once."""
        state = self.state
        self.state = replace(state, gap=state.gap - way, approach=state.approach + way)
        self.film = _film_mask(self.problem, self.state.gap, self._pool_depth, None)
        self.step = self._first

    def advance(
        self, most: float, demand_after: Callable[[float], Demand], tick: Callable[[float], None]
    ) -> float:
        """Take one step of at most ``most`` seconds; return what it took, 0 where none holds.

        ``demand_after`` gives what holds after so many seconds; ``tick`` receives the residual of
        each Newton step.
        """
        limited = self.step > most
        duration = min(self.step, most)
        start = self.state
        while True:
            demand = demand_after(duration)
            if demand.settles and len(self._settling) == 2:
                start = _calm_start(*self._settling)
            problem = replace(
                self.problem, clearance=demand.clearance, wall_speed=demand.wall_speed
            )
            # the film follows a sole that rolls: where it will be, not where it was
            gap = self.state.gap
            if demand.clearance is not self.problem.clearance:
                gap = gap + (demand.clearance - self.problem.clearance)
            film = low = _film_mask(problem, gap, self._pool_depth, self._film_that_stays)
            if problem.drained is not None:  # no film, but they touch the floor
                low = film | (problem.drained & (gap < self._pool_depth))
            low = low | (gap < 1.5 * TOUCHES * problem.decay)  # out of a thin pool
            near = gap < self._pool_depth + DEEP
            self._cells = _cells(problem, self._fit, self._cells, low, near)
            self.counts.cells = max(self.counts.cells, self._cells.size)
            cells = self._cells
            attempt = implicit_step(
                cells.problem(problem),
                cells,
                cells.state(self.state),
                load=demand.load,
                duration=duration,
                film=film[cells.numbers],
                content=self._content()[cells.numbers],
                tolerance=demand.tolerance,
                leaps=demand.leaps,
                upstream=self._upstream(
                    problem, cells, start if demand.leaps else self._ahead(duration)
                ),
                inlet=self._inlet(problem, cells, start),
                tick=tick,
            )
            self.counts.newton += attempt.newton
            self.counts.krylov += attempt.krylov
            self.residuals = attempt.residuals
            state = attempt.state and cells.on_whole(attempt.state, problem, self._whole)
            # it must not touch the floor outside the cells of the step
            beside = TOUCHES * problem.decay
            if state is not None and not (state.gap[~cells.mask] < beside).any():
                self._settling = [*self._settling[-1:], (start, state)] if demand.settles else []
                self._before = self.state.gap, duration
                self.problem, self.state, self.film = problem, state, film
                self.counts.time_steps += 1
                grown = duration * (GROWTH if attempt.newton < EASY else 1.0)
                if demand.settles and attempt.newton <= STILL:
                    grown = duration * FASTER
                # a step cut short by the end of a stage says nothing against longer ones
                self.step = max(grown, self.step) if limited else grown
                return duration
            self.counts.rejected += 1
            duration /= CUT
            limited = False
            if duration < self._shortest:
                return 0.0

    def _ahead(self, duration: float) -> State:
        """Return the state with the gap that goes on as in the last step, for what faces lean."""
        if self._before is None:
            return self.state
        gap, last = self._before
        share = min(duration / last, GROWTH)
        return replace(self.state, gap=self.state.gap + share * (self.state.gap - gap))

    @property
    def _film_that_stays(self) -> Mask:
        """Cells that keep their film a little longer; ones that bear keep it however high."""
        brink = self.state.gap < LETS_GO * self._pool_depth
        return self.film & (brink | (self.state.fluid > BEARS))

    def _upstream(self, problem: Problem, cells: Cells, start: State) -> Upwinding | None:
        """Return how far the faces of the cells lean upstream; None on a dry floor.

        From the gap at the start of the step: so it stays out of the Newton matrix.
        """
        if problem.viscosity is None:
            return None
        rows = problem.cells
        gap = np.clip(start.gap, SMALLEST_GAP, problem.largest_gap)
        carried = 0.5 * abs(problem.wall_speed) * rows.spacing * rows.width
        lean = leaning(
            rows,
            gap,
            rows.width,
            carried * problem.compliance.self_compliance,
            problem.conductance(gap).value,
            backward=problem.wall_speed < 0,
        )
        return Upwinding(*(part[cells.x_faces] for part in lean))

    def _inlet(self, problem: Problem, cells: Cells, start: State) -> Inlet | None:
        """Return what edges of lugs let in, from the state at the start of the step."""
        if self._lugs is None or problem.viscosity is None:
            return None
        rows, backward = problem.cells, problem.wall_speed < 0
        if backward not in self._edges:
            self._edges[backward] = LeadingEdges(self._lugs, rows, backward=backward)
        inlet = self._edges[backward].inlet(problem, start, rows.west.size)
        return Inlet(*(part[cells.x_faces] for part in inlet))

    def _content(self) -> Array:
        """Return the liquid per area, m: of the film, and of the pool where it is undisturbed."""
        pool = np.clip(self.state.gap, SMALLEST_GAP, self._pool_depth)
        held = np.clip(self.state.gap, SMALLEST_GAP, self.problem.largest_gap)
        return np.where(self.film, self.state.fraction * held, pool)


def _calm_start(before: tuple[State, State], last: tuple[State, State]) -> State:
    """Return where pressures and gaps should start so that a step ends where it starts.

    What a step takes from its start (faces that lean, edges that let in) overshoots the steady
    state when steps are longer than the memory of the film: steps swing, from one side to the other
    or round in threes. So each cell's secant through the last two steps, ``before`` and ``last``
    with their starts and ends, says how much of the way it goes.
    """
    (first, _), (start, now) = before, last
    calmed = {}
    for name in ("pressure", "gap", "fluid"):
        ends = [(getattr(step[0], name), getattr(step[1], name)) for step in (before, last)]
        was, way = (end - begin for begin, end in ends)
        moved = getattr(start, name) - getattr(first, name)
        bent = was - way
        share = np.divide(moved, bent, out=np.ones_like(moved), where=moved * bent > 0)
        calmed[name] = getattr(start, name) + np.clip(share, LEAST_SHARE, 1.0) * way
    return replace(now, **calmed)


def _film_mask(problem: Problem, gap: Array, pool_depth: float, before: Mask | None) -> Mask:
    """Return the cells that the pool reaches; one that held film lets go a little later."""
    film = gap < pool_depth
    if before is not None:
        film |= before
    film &= problem.clearance < 0.5
    if problem.drained is not None:
        film &= ~problem.drained
    film &= ~problem.cells.at_rim  # open to the surroundings
    if not film.any():
        film = problem.clearance < problem.clearance.min() + 2e-5
    return film


def _cells(problem: Problem, fit: PoleFit, cells: Cells | None, low: Mask, near: Mask) -> Cells:
    """Return cells that hold the ``low`` ones with room to spare, the present cells if they do.

    ``near`` are those that may meet pool or floor within a step.
    """
    squares = problem.cells
    wide = binary_dilation(squares.sums(low.astype(float)) > 0, iterations=MARGIN)
    mask = low | (squares.of(np.asarray(wide, dtype=bool)) & near)
    mask &= problem.clearance < 0.5
    if (
        cells is not None
        and not (low & ~cells.mask).any()
        and cells.size < ROOM * np.count_nonzero(mask)
    ):
        return cells
    return Cells(mask, problem, fit)
