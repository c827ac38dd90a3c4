"""A sole carried in time: load, sliding speed and shoe angle change, contact and film follow."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from underfoot.core import ConvergenceError, InputError, Progress, Status, silent
from underfoot.core.arrays import Array
from underfoot.core.remark import Message
from underfoot.rough_contact.pressure_gap_law import PressureGapLaw
from underfoot.shoe.ball_joint import BallJoint, rolled_height
from underfoot.shoe.cut_cells import CutCells
from underfoot.shoe.geometry import SoleMap
from underfoot.shoe.row_cells import RowCells
from underfoot.shoe.row_division import row_cells

from ._solver_checks import check_demand, check_setup
from .compliance import Compliance
from .lug_edges import LugInlet
from .march import Counts, Demand, History, March
from .preconditioner import pole_fit
from .problem import Problem, State, mirror_across
from .row_compliance import row_compliance
from .sole_state import CellState, SoleState, SolverSettings

FAR = 1.0  # m, clearance that stands for "outside the plan form"
FIRST_STEP = 1 / 30  # of the rise time
PASSED = (
    10.0,
    1e-3,
)  # times the tolerance, at most the second: a force balance that is crossed, not reached
LOWEST = 20e-6  # m: no lower does a sole begin whose first step did not find the floor
LEAST_LOAD = 1e-3  # of the largest load so far: what a foot about to lift still weighs
LEAST_STEPS = 100  # in which ``LONGEST_TIME`` is marched at least
LONGEST_TIME = 1e5  # s, when a film that still moves is given up as not steady
STEADY_STEP = 0.25  # share of the elapsed time over which a steady state must not move
STEADY_CHANGE = 2e-4  # share of film, or of contact, by which it may change over such a step
STEADY_MOVE = 3e-3  # share of the load that may change its place then
REJECTED = (4, 20)  # steps that fail on the way to a steady state: from none to all of ``SLOW``
SLOW = 0.01  # share of film, and of contact, by which a film that rests may change where steps fail
HOVERING = 10  # steps that lie within ``SLOW`` where a film never rests
LIFTED = 2.4e-3  # m, how far pressure may lift a film, from a thin pool too
MEMORY = 0.5  # of the time in which a sole slides its length: what a film remembers
MOST_STRETCH = 0.15  # of the grid along x, by which a sole may roll away from its map's angle


@dataclass(frozen=True, slots=True)
class Reporting:
    """Callbacks of a ``SlidingSole``, called as it steps.

    Parameters:
        progress: Receives stage, fraction of the time and residual; an exception it raises stops
            the work.
        stage: What the work is called.
        end_time: s, to report progress against.
        watch: Receives the state after every inner step.
    """

    progress: Progress = silent
    stage: str = "Pressing and sliding the sole"
    end_time: float | None = None
    watch: Callable[[SoleState], None] | None = None


@dataclass(frozen=True, slots=True)
class Bookmark:
    """An instant of a ``SlidingSole`` for another to start from."""

    march: tuple[Problem, State, NDArray[np.bool_], float]
    time: float
    load: float
    speed: float | None
    shoe_angle: float


class SlidingSole:
    """Contact and film of a sole, carried in time.

    h = G - d + C[p_t],  p_t = p_f + p_c,  p_c = P(h),  sum p_t dA = F(t)
    -div(phi h^3 / (12 eta) grad p_f) - (V / 2) dh/dx + dh/dt = lambda,  p_f >= 0, lambda >= 0,
    p_f lambda = 0

    Parameters:
        sole: Undeformed sole over the floor, at ``shoe_angle``.
        compliance: Surface deflection under pressure on the same grid.
        law: Asperity pressure and flow factor against the mean gap.
        viscosity: Pa s; None for a dry floor, where time does nothing.
        settings: Pool, start film, first step (``FIRST_STEP`` of ``rise_time``) and accuracy.
        shoe_angle: Angle (rad, toe up positive) at which ``sole`` was made; at others it is
            ``rolled_clearance``.
        typical_force: N, a load of the order to come: sets the scale of the asperity law.
        reporting: Callbacks that are called as the sole steps.
        before: The problem of another case, whose compliance serves again on the same sole.
        inlet: What edges of lugs let in; None: what cells have, which is too much under lugs.

    The sole starts ``settings.start_film`` above the floor, unloaded. Cells are fixed to the sole:
    rolling by ``a`` from its map's angle a0 leaves them cos(a) / cos(a0) too long, refused beyond
    15 %.
    """

    def __init__(
        self,
        sole: SoleMap,
        compliance: Compliance,
        law: PressureGapLaw,
        *,
        viscosity: float | None,
        settings: SolverSettings | None = None,
        shoe_angle: float = 0.0,
        typical_force: float = 500.0,
        reporting: Reporting | None = None,
        before: Problem | None = None,
        inlet: LugInlet | None = None,
    ) -> None:
        settings = settings or SolverSettings()
        check_setup(sole, compliance.self_compliance, viscosity, typical_force, settings)
        self.sole = sole
        self.settings = settings
        self.viscosity = viscosity
        self.history = History()
        self._reporting = reporting or Reporting()
        self._map_angle = self._angle = shoe_angle
        self._time = self._load = self._largest_load = 0.0
        self._typical_force = typical_force
        self._speed: float | None = None
        cells = sole.cells or row_cells(sole)
        clearance = _bound_clearance(cells.clearance)
        extent = max(cells.shape) * sole.spacing
        if before and before.cells is cells and before.compliance.squares is compliance:
            between_cells = before.compliance
        else:
            between_cells = row_compliance(compliance, cells, sole.land & sole.inside)
        decay, touch = asperity_scale(law, typical_force / (0.01 * extent**2))
        problem = Problem(
            cells=cells,
            clearance=clearance,
            compliance=between_cells,
            law=law,
            viscosity=viscosity,
            wall_speed=0.0,
            largest_gap=min(max(4 * settings.pool_depth, LIFTED), 5e-3),
            decay=decay,
            settings=settings,
            drained=None if sole.slits is None else cells.of(sole.slits.drained),
        )
        problem = replace(problem, mirror=mirror_across(problem))
        lift = settings.start_film if viscosity is not None else touch
        self._lift = 0.0 if viscosity is None else lift
        blank = np.zeros_like(clearance)
        self._march = March(
            problem,
            pole_fit(compliance, extent, sole.spacing * float(cells.width.min())),
            State(blank, -lift, clearance + lift, blank, blank, blank > 0, np.ones_like(blank)),
            pool_depth=settings.pool_depth,
            first_step=settings.rise_time * FIRST_STEP,
            inlet=inlet,
        )
        self._leaps = False

    @property
    def time(self) -> float:
        """Time carried so far, s."""
        return self._time

    @property
    def counts(self) -> Counts:
        """Work done so far."""
        return self._march.counts

    def advance(
        self,
        duration: float,
        *,
        normal_force: float,
        speed: float,
        shoe_angle: float | None = None,
        longest_step: float | None = None,
        most_steps: int | None = None,
    ) -> SoleState:
        """Carry contact and film on by ``duration`` and return them.

        Load, speed and shoe angle go linearly from where they are to the values given (load from
        0, speed from the value given at the first call), in as many inner steps as convergence
        asks for.

        Parameters:
            duration: s.
            normal_force: Load at the end, N; below 1e-3 of the largest so far (before any, of
                ``typical_force``) it counts as that much: a foot that lifts off is not followed.
            speed: Sliding speed of the shoe along +x at the end, m/s; negative slides backward.
            shoe_angle: At the end, rad; None keeps it.
            longest_step: Longest inner step, s; None: the whole duration if it converges.
            most_steps: Inner steps, rejected ones included; None for ``settings.most_time_steps``.

        Returns:
            SoleState: Status NOT_CONVERGED and the last good instant (``time`` says which) when a
                step could not be made small enough; the sole then stays there.
        """
        check_demand(duration, normal_force, speed, shoe_angle)
        ramp = self._ramp(duration, normal_force, speed, shoe_angle)
        end = self._time + duration
        done = self._loop(ramp, end, longest_step or math.inf, most_steps, None)
        return self._state(done)

    def settle(
        self, *, normal_force: float, speed: float, most_steps: int | None = None
    ) -> SoleState:
        """Carry on at constant load and speed until nothing moves, and return that.

        At rest: over a step of a quarter of the elapsed time, in which the sole slides its own
        length, the load on the film changes by less than 2e-4 of itself or, where less touches, of
        what touches, and less than 3e-3 of the load moves to another place. From the fifth to the
        twentieth step that failed, a film may change by 0.06 to 1 % over half the elapsed time, in
        which the sole slides at least twice its length; after ``LONGEST_TIME`` one is at rest whose
        last ten steps lie within 1 %. A film or a contact of less than 1 % of the load counts as
        1 %.
        """
        check_demand(1.0, normal_force, speed, None)
        self._speed = speed
        self._load = normal_force
        load = self._march.problem.load
        loading = max(2 * self.settings.rise_time, self._time)
        passing, rejected = self.sliding_time(speed), self.counts.rejected

        def least(film: float) -> float:
            return max(min(film, normal_force - film), SLOW * normal_force)

        def slow(share: float = SLOW) -> bool:
            begin = self._time - max(2 * passing, 0.5 * self._time)
            film = self.history.fluid_load
            if not film:
                return False
            change = abs(film[-1] - float(np.interp(begin, self.history.time, film)))
            return begin > loading and change < share * least(film[-1])

        def hovers() -> bool:
            film = np.array(self.history.fluid_load[-HOVERING:])
            return bool(np.ptp(film) < SLOW * least(film[-1]))

        def is_settled(before: State, step: float) -> bool:
            after = self._march.state
            share = np.interp(self.counts.rejected - rejected, REJECTED, (0.0, SLOW))
            if slow(float(share)):
                return True
            change = load(np.abs(after.pressure - before.pressure))
            moved = abs(load(after.fluid - before.fluid))
            return (
                self._time > loading
                and step > max(min(STEADY_STEP * self._time, 0.5 * longest_step), passing)
                and moved < STEADY_CHANGE * least(self.history.fluid_load[-1])
                and change < STEADY_MOVE * normal_force
            )

        longest = max(LONGEST_TIME, 100 * passing)
        # what a step takes from its start (faces that lean, edges that let in) needs several steps
        longest_step = longest / LEAST_STEPS
        ramp = self._ramp(longest, normal_force, speed, None)
        done = self._loop(ramp, longest, longest_step, most_steps, is_settled)
        rests = hovers if self._time >= longest * (1 - 1e-12) else slow
        return self._state(done or rests())

    def begin(
        self,
        *,
        normal_force: float,
        speed: float,
        shoe_angle: float | None = None,
        rise_time: float = 0.0,
    ) -> None:
        """Set what holds at time 0, before the first ``advance``, which ramps from here.

        Without it the load starts at 0 and the speed at that of the first ``advance``. In a fluid
        the load comes up within the ``rise_time`` (s) before, which nobody watches: no step takes a
        sole from the air to a load that stands there at once.
        """
        check_demand(1.0, normal_force, speed, shoe_angle)
        if self.counts.time_steps:
            raise InputError("the sole is moving already", where="begin", allowed="a new sole")
        if shoe_angle is not None and shoe_angle != self._angle:
            self._check_stretch(shoe_angle)
            self._march.turn(self._clearance(shoe_angle))
            self._angle = shoe_angle
        if rise_time and normal_force and self.viscosity is not None:
            watched, self._reporting = self._reporting, replace(self._reporting, watch=None)
            longest = rise_time / self.settings.time_resolution
            self.advance(rise_time, normal_force=normal_force, speed=speed, longest_step=longest)
            self._reporting, self._time, self.history = watched, 0.0, History()
        self._load, self._speed = normal_force, speed

    def bookmark(self) -> Bookmark:
        """Return this instant, for another sole to take over."""
        march = self._march
        return Bookmark(
            (march.problem, march.state, march.film, march.step),
            self._time,
            self._load,
            self._speed,
            self._angle,
        )

    def take_over(self, mark: Bookmark, first_step: float) -> None:
        """Start where another sole on the same grid was; the change comes with the next step.

        ``first_step`` (s) is the length of it. What the sole went through stays the other's.
        """
        _, state, film, _ = mark.march
        march = self._march
        if state.pressure.shape != march.state.pressure.shape:
            raise InputError(
                Message("a state of {size} cells", size=state.pressure.size),
                where="take_over",
                allowed=Message("{size}, those of this sole", size=march.state.pressure.size),
            )
        march.state, march.film, march.step = state, film, first_step
        self._load, self._speed = mark.load, mark.speed
        self._leaps = True

    def sliding_time(self, speed: float) -> float:
        """Return the time (s) in which the sole slides its own length at a speed; 0 at rest."""
        length = float(np.ptp(self.sole.x[self.sole.inside.any(axis=1)]))
        return length / abs(speed) if speed else 0.0

    def close_history(self) -> None:
        """End the history: what comes is another that nobody watches."""
        self.history = History()
        self._reporting = replace(self._reporting, watch=None)

    def _ramp(
        self, duration: float, normal_force: float, speed: float, shoe_angle: float | None
    ) -> Callable[[float], tuple[float, float, float]]:
        """Return load, speed and angle against time, linear from now to the values given."""
        start, load = self._time, self._load
        first = speed if self._speed is None else self._speed
        angle = self._angle
        last = angle if shoe_angle is None else shoe_angle
        self._check_stretch(last)
        self._largest_load = max(self._largest_load, normal_force)
        least = LEAST_LOAD * (self._largest_load or self._typical_force)

        def at(time: float) -> tuple[float, float, float]:
            share = min((time - start) / duration, 1.0)
            return (
                max(load + share * (normal_force - load), least),
                first + share * (speed - first),
                angle + share * (last - angle),
            )

        return at

    def _loop(
        self,
        ramp: Callable[[float], tuple[float, float, float]],
        end: float,
        longest_step: float,
        most_steps: int | None,
        settled: Callable[[State, float], bool] | None,
    ) -> bool:
        """Step to ``end`` or until ``settled``; return whether that was reached."""
        march, history, report = self._march, self.history, self._reporting
        counts = march.counts
        most = most_steps or self.settings.most_time_steps
        before = counts.time_steps + counts.rejected
        exact = self.settings.tolerance
        passed = max(exact, min(PASSED[0] * exact, PASSED[1]))
        while self._time < end * (1 - 1e-12):
            if counts.time_steps + counts.rejected - before >= most:
                return False
            start = self._time

            def demand(duration: float) -> Demand:
                load, speed, angle = ramp(self._time + duration)
                clearance = march.problem.clearance
                if angle != self._angle:
                    clearance = self._clearance(angle)
                now = self._load, self._speed, self._angle
                settles = settled is not None
                if speed and (load, speed, angle) == now:
                    # steps longer than the memory of the film swing
                    settles |= duration > MEMORY * self.sliding_time(speed)
                last = settled is not None or self._time + duration > end * (1 - 1e-12)
                leaps = self._leaps or settles
                return Demand(load, -speed, clearance, exact if last else passed, leaps, settles)

            fraction = self._fraction(min(start + march.step, end))
            state = march.state
            taken = march.advance(
                min(end - start, longest_step),
                demand,
                lambda residual, fraction=fraction: report.progress(
                    report.stage, fraction, residual
                ),
            )
            if taken == 0.0:
                if self.counts.time_steps == 0 and self._lift > LOWEST:
                    # a thin fluid holds nothing up, and one step does not find the floor from there
                    self._lift *= 0.5
                    march.lower(self._lift)
                    continue
                return False
            self._time = end if end - start - taken < 1e-12 * end else start + taken
            self._load, self._speed, self._angle = ramp(self._time)
            history.time.append(self._time)
            history.load.append(self._load)
            history.fluid_load.append(march.problem.load(march.state.fluid))
            history.approach.append(march.state.approach)
            history.residual.append(march.residuals[-1])
            history.speed.append(self._speed)
            history.shoe_angle.append(self._angle)
            if report.watch is not None:
                report.watch(self._state(True))
            if settled is not None and settled(state, taken):
                return True
        return settled is None

    def _fraction(self, time: float) -> float:
        end = self._reporting.end_time
        return time / (time + self.settings.rise_time) if end is None else min(time / end, 1.0)

    def _clearance(self, angle: float) -> Array:
        return _bound_clearance(
            _rolled_cells(self.sole, angle - self._map_angle, self._march.problem.cells)
        )

    def _check_stretch(self, angle: float) -> None:
        if self.sole.joint is not None:  # what is behind it leaves the floor
            angle = self.sole.joint.forepart(angle)
        stretch = abs(math.cos(angle) / math.cos(self._map_angle) - 1)
        if stretch > MOST_STRETCH:
            raise InputError(
                Message(
                    "a shoe angle of {angle:.3g} deg stretches a grid made at "
                    "{grid_angle:.3g} deg by {stretch:.0%}",
                    angle=math.degrees(angle),
                    grid_angle=math.degrees(self._map_angle),
                    stretch=stretch,
                ),
                where="shoe_angle",
                allowed=Message(
                    "angles whose cosine is within {most_stretch:.0%} of the map's",
                    most_stretch=MOST_STRETCH,
                ),
                remedy="Make the map at the middle of the angles",
            )

    def _state(self, done: bool) -> SoleState:
        if self.counts.time_steps == 0:
            raise ConvergenceError(
                "the contact could not be solved even at the start of loading",
                history=self._march.residuals,
                where="sole_contact",
                remedy="Start from a thicker film, refine the grid or check the pressure law.",
            )
        status = Status.CONVERGED if done else Status.NOT_CONVERGED
        march, sole = self._march, self.sole
        state, problem = march.state, march.problem
        cells, refined = problem.cells, sole.cells is not None
        contact = np.maximum(state.contact, 0.0)  # negative only by what the tolerance leaves
        fluid = np.maximum(state.fluid, self.settings.cavity_pressure * problem.film_share)
        film_thickness = np.clip(state.gap, 0.0, self.settings.pool_depth)
        on_land = (cells.land if refined else 1.0) * cells.width
        areas = []
        for area in (cells.area, cells.film_area):
            land = cells.sums(area * on_land / cells.width)
            areas.append(np.where(land > 0, land, 1.0))
        film = cells.sums(march.film * cells.width)
        finest = CellState(
            contact_pressure=contact / problem.contact_share,
            fluid_pressure=fluid / problem.film_share,
            film_thickness=film_thickness,
            wet=march.film,
            area=cells.area,
            film_area=cells.film_area,
            square=cells.parent,
        )
        return SoleState(
            x=sole.x,
            y=sole.y,
            spacing=sole.spacing,
            contact_pressure=cells.sums(contact * cells.width) / areas[0],
            fluid_pressure=cells.sums(fluid * cells.width) / areas[1],
            film_thickness=cells.means(film_thickness, on_land),
            liquid_fraction=cells.means(state.fraction, on_land),
            wet=(film > 0) & sole.inside,
            cavitated=cells.sums((state.cavitated & march.film) * cells.width) > 0.5 * film,
            cut=replace(sole.cut or CutCells.none(cells.shape), area=areas[0], film_area=areas[1]),
            cells=finest if refined else None,
            approach=state.approach,
            normal_force=self._load,
            speed=self._speed or 0.0,
            shoe_angle=self._angle,
            time=self._time,
            status=status,
            remedy=status.remedy,
            residuals=tuple(march.residuals),
        )


def rolled_clearance(x: Array, clearance: Array, roll: float, joint: BallJoint | None) -> Array:
    """Return the clearance in m of a sole rolled by ``roll`` (rad, toe up), inf outside.

    Of ``rolled_height`` at places ``x`` (n,) with clearances (n, m), the lowest put at 0. Cells
    stay with the sole.
    """
    rolled = rolled_height(x, np.where(np.isfinite(clearance), clearance, FAR), roll, joint)
    rolled = np.where(np.isfinite(clearance), rolled, np.inf)
    return rolled - rolled.min()


def _rolled_cells(sole: SoleMap, roll: float, cells: RowCells) -> Array:
    """Return the clearance (m) of the cells of a sole rolled by ``roll`` (rad)."""
    x = sole.x[cells.parent // cells.shape[1]] + cells.offset * cells.spacing
    return rolled_clearance(x, cells.clearance[:, None], roll, sole.joint).ravel()


def rolled_sole(sole: SoleMap, roll: float) -> SoleMap:
    """Return a sole rolled by ``roll`` (rad, toe up) from its map; cells stay with the sole."""
    clearance = rolled_clearance(sole.x, sole.clearance, roll, sole.joint)
    cells = sole.cells and replace(sole.cells, clearance=_rolled_cells(sole, roll, sole.cells))
    return replace(sole, clearance=clearance, cells=cells)


def asperity_scale(law: PressureGapLaw, pressure: float) -> tuple[float, float]:
    """Return the gap over which the law decays at ``pressure``, and where it has all but faded."""
    gaps = np.geomspace(1e-8, 1e-2, 400)
    values = law.pressure(gaps)
    near = int(np.argmin(np.abs(np.log(np.maximum(values, 1e-300) / pressure))))
    decay = float(values[near] / max(float(law.stiffness(gaps[near : near + 1])[0]), 1e-300))
    faint = values < 1e-3 * pressure
    touch = float(gaps[int(np.argmax(faint))]) if faint.any() else float(gaps[-1])
    return decay, touch


def _bound_clearance(clearance: Array) -> Array:
    """Return clearances from 0 to FAR: what the solver takes for outside is far, not infinite."""
    bounded = np.minimum(np.where(np.isfinite(clearance), clearance, FAR), FAR)
    return bounded - bounded.min()
