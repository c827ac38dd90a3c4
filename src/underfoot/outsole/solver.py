"""Whole-shoe contact with fluid: a sole pressed and slid over a flooded floor."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from underfoot.core import ConvergenceError, Progress, Status, silent

from ._solver_checks import check_inputs
from .compliance import Compliance
from .contact.march import Counts, History, March, march
from .contact.newton import Problem, State
from .contact.preconditioner import pole_fit

if TYPE_CHECKING:
    from underfoot.asperity.law import PressureGapLaw

    from .geometry import SoleMap

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
FAR = 1.0  # m, clearance that stands for "outside the plan form"
FIRST_STEP = 1 / 150  # of the rise time
LONGEST_TIME = 1e5  # s, when a film that still moves is given up as not steady
STEADY_STEP = 0.25  # share of the elapsed time over which a steady state must not move
STEADY_CHANGE = 3e-4  # share of the load by which the pressures may change over such a step


@dataclass(frozen=True, slots=True)
class SolverSettings:
    """How the sole meets the floor and how exactly it is solved.

    Parameters
    ----------
    pool_depth
        Depth of the fluid on the floor, m; deeper gaps hold no film. 0.6 mm is 150 ml on
        0.4 m x 0.6 m (report, G.6.1).
    start_film
        Height of the lowest point above the floor when the load starts to rise, m (assumed).
    rise_time
        Time over which the load rises linearly to its full value, s (report, G.4.1: 30 ms).
    end_time
        Time at which the result is taken, s (assumed: 90 ms of sliding under full load).
    steady
        Go on until nothing moves instead of stopping at ``end_time``.
    tolerance
        Largest relative imbalance of volume, of load and of the cavitation condition.
    backend
        Sparse factorization: "pardiso", "superlu" or None for the fastest installed.
    """

    pool_depth: float = 0.6e-3
    start_film: float = 50e-6
    rise_time: float = 0.03
    end_time: float = 0.12
    steady: bool = False
    tolerance: float = 1e-4
    backend: str | None = None
    most_newton: int = 40
    most_time_steps: int = 400
    krylov_tolerance: float = 1e-3
    time_resolution: float = 8.0


@dataclass(frozen=True, slots=True)
class SoleContact:
    """Pressures and film under the sole; arrays (nx, ny), SI.

    ``film_thickness`` is the mean gap, at most the pool depth. ``wet`` marks the film (cavitated
    cells included, see ``cavitated``). ``approach`` is how far the rigid foot has come down since
    the lowest point touched the floor. ``status`` other than CONVERGED: not a result, see
    ``remedy``.
    """

    x: Array
    y: Array
    spacing: float
    contact_pressure: Array
    fluid_pressure: Array
    film_thickness: Array
    wet: Mask
    cavitated: Mask
    approach: float
    normal_force: float
    time: float
    status: Status
    remedy: str
    history: History
    residuals: tuple[float, ...]
    counts: Counts

    @property
    def fluid_load(self) -> float:
        """Load carried by the fluid, N."""
        return float(self.fluid_pressure.sum()) * self.spacing**2

    @property
    def contact_load(self) -> float:
        """Load carried by asperities, N."""
        return float(self.contact_pressure.sum()) * self.spacing**2

    @property
    def total_pressure(self) -> Array:
        """Fluid and contact pressure together, Pa."""
        return self.fluid_pressure + self.contact_pressure


def solve_sliding(
    sole: SoleMap,
    compliance: Compliance,
    law: PressureGapLaw,
    *,
    viscosity: float | None,
    speed: float,
    normal_force: float,
    settings: SolverSettings | None = None,
    progress: Progress = silent,
) -> SoleContact:
    """Return contact pressure, fluid pressure and film under a sole pressed and slid.

    h = G - d + C[p_t],  p_t = p_f + p_c,  p_c = P(h),  sum p_t dA = F(t)
    -div(phi h^3 / (12 eta) grad p_f) - (V / 2) dh/dx + dh/dt = lambda,  p_f >= 0, lambda >= 0,
    p_f lambda = 0

    Parameters
    ----------
    sole
        Undeformed sole over the floor.
    compliance
        Surface deflection under pressure on the same grid.
    law
        Asperity pressure and flow factor against the mean gap.
    viscosity
        Pa s; None for a dry floor, which is solved as the load rises, without time.
    speed
        Sliding speed of the shoe along +x, m/s; negative slides backward, 0 only squeezes.
    normal_force
        Full load, N.
    settings
        Start, times and accuracy.
    progress
        Receives stage, fraction of the time and residual; an exception it raises stops the work.

    Raises
    ------
    InputError
        A value that is not finite or not physical.
    ConvergenceError
        Not even the first instant could be solved.
    """
    settings = settings or SolverSettings()
    check_inputs(sole, compliance.self_compliance, viscosity, speed, normal_force, settings)
    clearance = np.where(np.isfinite(sole.clearance), sole.clearance, FAR)
    clearance = np.minimum(clearance, FAR)
    clearance = clearance - clearance.min()
    extent = max(clearance.shape) * sole.spacing
    decay, touch = asperity_scale(law, normal_force / (0.01 * extent**2))
    problem = Problem(
        clearance=clearance,
        spacing=sole.spacing,
        compliance=compliance,
        law=law,
        viscosity=viscosity,
        wall_speed=-speed,
        largest_gap=min(4 * settings.pool_depth, 5e-3),
        decay=decay,
        backend=settings.backend,
        tolerance=settings.tolerance,
        most_newton=settings.most_newton,
        krylov_tolerance=settings.krylov_tolerance,
    )
    fit = pole_fit(compliance, extent, sole.spacing)
    lift = settings.start_film if viscosity is not None else touch
    blank = np.zeros_like(clearance)
    start = State(blank, -lift, clearance + lift, blank, blank, blank > 0)
    rise = settings.rise_time

    def load_at(time: float) -> float:
        return normal_force * min(time / rise, 1.0)

    end_time = LONGEST_TIME if settings.steady else settings.end_time
    if viscosity is None:
        end_time = rise  # a dry contact has no memory: it is done when the load is there

    def longest_step(time: float) -> float:
        if time < rise * (1 - 1e-9):
            return min(rise / settings.time_resolution, rise - time)
        if settings.steady:
            return math.inf
        return max(settings.end_time - rise, rise) / settings.time_resolution

    def fraction(time: float) -> float:
        return time / (time + rise) if settings.steady else min(time / end_time, 1.0)

    def settled(before: State, after: State, step: float, time: float) -> bool:
        change = float(np.abs(after.pressure - before.pressure).sum()) * sole.spacing**2
        moved = abs(float((after.fluid - before.fluid).sum())) * sole.spacing**2
        return (
            time > 2 * rise
            and step > STEADY_STEP * time
            and max(change, moved) < STEADY_CHANGE * normal_force
        )

    result = march(
        problem,
        fit,
        start,
        load_at=load_at,
        first_step=rise * FIRST_STEP,
        longest_step=longest_step,
        end_time=end_time,
        pool_depth=settings.pool_depth,
        settled=settled if settings.steady and viscosity is not None else None,
        fraction=fraction,
        most_steps=settings.most_time_steps,
        progress=progress,
        stage="Pressing and sliding the sole",
    )
    return _result(sole, result, normal_force, settings)


def asperity_scale(law: PressureGapLaw, pressure: float) -> tuple[float, float]:
    """Return the gap over which the law decays at ``pressure``, and where it has all but faded."""
    gaps = np.geomspace(1e-8, 1e-2, 400)
    values = law.pressure(gaps)
    near = int(np.argmin(np.abs(np.log(np.maximum(values, 1e-300) / pressure))))
    decay = float(values[near] / max(float(law.stiffness(gaps[near : near + 1])[0]), 1e-300))
    faint = values < 1e-3 * pressure
    touch = float(gaps[int(np.argmax(faint))]) if faint.any() else float(gaps[-1])
    return decay, touch


def _result(
    sole: SoleMap, end: March, normal_force: float, settings: SolverSettings
) -> SoleContact:
    if end.counts.time_steps == 0:
        raise ConvergenceError(
            "the contact could not be solved even at the start of loading",
            history=end.residuals,
            where="outsole.solver",
            remedy="Start from a thicker film, refine the grid or check the pressure law.",
        )
    status = Status.CONVERGED if end.finished else Status.NOT_CONVERGED
    state = end.state
    film = np.clip(state.gap, 0.0, settings.pool_depth)
    return SoleContact(
        x=sole.x,
        y=sole.y,
        spacing=sole.spacing,
        contact_pressure=np.maximum(state.contact, 0.0),  # rounding in unloaded cells
        fluid_pressure=state.fluid,
        film_thickness=film,
        wet=end.film & sole.inside,
        cavitated=state.cavitated & end.film,
        approach=state.approach,
        normal_force=normal_force,
        time=end.time,
        status=status,
        remedy=status.remedy,
        history=end.history,
        residuals=tuple(end.residuals),
        counts=end.counts,
    )
