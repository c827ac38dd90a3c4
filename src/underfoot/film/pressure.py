"""Pressure and liquid of a film between walls whose gap is known, steady and in time."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, fields, replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import ConvergenceError, InputError, Progress, silent
from underfoot.core.arrays import Array, Mask
from underfoot.core.checks import positive
from underfoot.core.remark import Message
from underfoot.core.sparse import Factorization, factorization

from .operator import Conductance, FilmOperator, Pattern, film_operator

OPEN = 100.0
"""Gap of the open surroundings over the largest gap of the film."""
ROUNDING = 1e-13
"""Pressures and fractions that miss their bound by less, in units of flow, count as meeting it."""
STALLED = 1e-9
"""The same once sets gain nothing: where a film forms again on a face, rounding alone tells whether
the cell beside it is full at pressure 0."""
PATIENCE = 8
"""Sets tried without fewer wrong cells before only half of them are exchanged."""
MOST_SETS = 400
FEWEST_CELLS = 32
"""Shortest axis that is still halved for a first guess."""


@dataclass(frozen=True, slots=True, eq=False)
class Film:
    """Walls, liquid and rim of a film; arrays (nx, ny), scalars stand for uniform fields.

    Parameters:
        gap: m, above 0 where there is film, inf where the surroundings are open.
        spacing: Cell size in m, one or (along x, along y).
        viscosity, speed: Pa s; V, sliding speed of the upper wall along +x over the lower one, m/s.
            A gap that widens towards +x builds pressure.
        upper_speed: Speed of the upper wall along +x on the grid, m/s. 0: the grid moves with it (a
            sole that slides over a floor); equal to ``speed``: the grid rests on the lower wall;
            with ``speed`` 0: both walls move alike (rolling).
        mask: True where there is film; elsewhere the pressure is ``rim_pressure`` and liquid enters
            with ``rim_fraction`` (at the cell's centre, or at its face where its gap is inf). None:
            all cells but the outermost. Nothing flows through the edges of the array.
        flow_factor: phi, one or (along x, along y).
        shear_flow: s = sigma phi_s, m: flow that roughness carries, positive where the upper wall's
            roughness carries more (``patir_cheng_shear_flow``).
        rim_pressure, rim_fraction: Pa above the pressure in cavities (so the ambient pressure, 1e5
            Pa, if cavities hold vapour; 0 if they fill with air), 0 or more; 0 to 1, below 1 only
            where that pressure is 0 (a starved inlet).

    Raises:
        InputError: Values that are not finite or not physical.
    """

    gap: ArrayLike
    spacing: float | tuple[float, float]
    viscosity: float
    speed: float
    upper_speed: float = 0.0
    mask: ArrayLike | None = None
    flow_factor: ArrayLike | tuple[ArrayLike, ArrayLike] = 1.0
    shear_flow: ArrayLike = 0.0
    rim_pressure: ArrayLike = 0.0
    rim_fraction: ArrayLike = 1.0

    def __post_init__(self) -> None:
        _grids(self)


@dataclass(frozen=True, slots=True)
class FilmPressure:
    """Film that ruptures and reforms without losing liquid; arrays (nx, ny).

    ``fraction`` theta is the share of the gap that holds liquid: 1 where the film is full, below 1
    where it has ruptured and the pressure is that of the cavity, 0.
    """

    pressure: Array  # Pa above the cavity's
    fraction: Array  # 0 to 1
    gap: Array  # m
    cavitated: Mask
    load: float  # N, pressure over the film's cells
    rim_outflow: float  # m^3/s of liquid that leaves the film through its rim
    mass_residual: float  # largest imbalance of a cell over the largest flow of a face
    iterations: int
    time: float = 0.0  # s

    @property
    def content(self) -> Array:
        """Return the liquid per area, theta h (m)."""
        return self.fraction * self.gap


def film_pressure(
    film: Film,
    *,
    before: ArrayLike | None = None,
    time_step: float | None = None,
    backend: str | None = None,
) -> FilmPressure:
    """Return pressure and liquid fraction of a film between walls whose gap is known.

    d(theta h)/dt + d/dx[theta (U h + V s / 2)] = div(phi h^3 / (12 eta) grad p)
    p >= 0, theta <= 1, p (1 - theta) = 0,   U = upper_speed - V / 2

    Volume is conserved in the cavity and across its borders (the conditions of Jakobsson, Floberg
    and Olsson), so that a film reforms where the liquid to fill the gap has arrived. Where nothing
    cavitates it is Reynolds' equation. Load of second order in the cell size; the liquid of a
    cavity is carried upwind and stepped by implicit Euler, both of first order.

    Parameters:
        film: Walls, liquid and rim.
        before, time_step: Liquid per area (m) at the start of a step of ``time_step`` (s), at whose
            end the walls are those of ``film``. Neither: a steady film. Walls that close at v over
            a full film: ``before = gap + v time_step``.
        backend: Sparse factorization: "pardiso", "superlu" or None for the fastest installed.

    Raises:
        InputError: Values that are not finite or not physical.
        ConvergenceError: The set of full cells did not settle.

    Source: Reynolds 1886; Jakobsson and Floberg 1957, Olsson 1965; pressure-fraction form of Bayada
    and of Giacopini et al. (2010, J. Tribol. 132:041702); semismooth Newton after Woloszynski,
    Podsiadlo and Stachowiak (2015, Tribol. Lett. 58:18).
    """
    if (before is None) != (time_step is None):
        raise InputError(
            "a step needs the liquid before it and its length",
            where="before" if before is None else "time_step",
            remedy="Give before and time_step, or neither for a steady film.",
        )
    grids = _grids(film)
    if before is not None and time_step is not None:
        positive(time_step, "time_step")
        content = _field(before, grids.gap.shape, "before")
        if (content < 0).any():
            raise InputError(
                "the liquid before the step is negative", where="before", allowed="0 m or more"
            )
        grids = replace(grids, content=content, time_step=time_step)
    return _FilmSolver(grids.mask, backend).solve(grids, time=time_step or 0.0)[0]


def film_history(
    film: Film,
    gap_at: Callable[[float], ArrayLike],
    times: Iterable[float],
    *,
    start_fraction: ArrayLike = 1.0,
    backend: str | None = None,
    progress: Progress = silent,
) -> Iterator[FilmPressure]:
    """Yield the film at each of ``times`` (s) after the first, while the gap changes.

    ``gap_at(t)`` is the gap (nx, ny) m on the grid at time t, in place of the gap of ``film``: it
    holds the squeeze and the motion of textured walls. The film starts at the first time with
    ``start_fraction``. One implicit Euler step from each time to the next; equation and errors as
    ``film_pressure``.

    Parameters:
        film: The problem; its gap is replaced.
        gap_at: Gap (nx, ny) m at a time in s.
        times: s, ascending; the first is the start.
        start_fraction: Liquid fraction of the gap at the start, 0 to 1.
        backend: Name of the sparse solver; None takes the fastest installed.
        progress: Called with stage, fraction and residual; an exception it raises stops the work.
    """
    instants = np.asarray(list(times), dtype=float)
    if instants.ndim != 1 or instants.size < 2 or not (np.diff(instants) > 0).all():
        raise InputError(
            "the times do not increase", where="times", allowed="two or more rising times, s"
        )
    gap = np.asarray(gap_at(float(instants[0])), dtype=float)
    start = _field(start_fraction, gap.shape, "start_fraction")
    _check_fraction(start, "start_fraction")
    content = start * np.where(np.isfinite(gap), gap, 0.0)
    solver: _FilmSolver | None = None
    full = None
    for count, (earlier, now) in enumerate(pairwise(instants), start=1):
        grids = replace(
            _grids(replace(film, gap=gap_at(float(now)))),
            content=content,
            time_step=float(now - earlier),
        )
        if solver is None:
            solver = _FilmSolver(grids.mask, backend)
        instant, _ = solver.solve(grids, full, float(now))
        full, content = ~instant.cavitated, instant.content
        progress("film history", count / (instants.size - 1), instant.mass_residual)
        yield instant


@dataclass(frozen=True, slots=True, eq=False)
class _Grids:
    """A film as fields (nx, ny) on one grid, and the grids of half its size."""

    gap: Array
    along: Array  # phi_x h^3 / (12 eta), m^3/(Pa s)
    across: Array
    roughness_flow: Array  # V s / 2, m^2/s
    mask: Mask
    rim_pressure: Array
    rim_fraction: Array
    spacing: tuple[float, float]
    speed: float  # U
    content: Array
    time_step: float | None = None

    def operator(self) -> FilmOperator:
        nil = np.zeros_like(self.gap)  # the gap is given: its derivatives are not asked for
        dx, dy = self.spacing
        return film_operator(
            self.gap,
            Conductance(self.along, nil),
            Conductance(self.across, nil),
            spacing=self.spacing,
            speed=self.speed,
            storage=0.0 if self.time_step is None else dx * dy / self.time_step,
            roughness_flow=self.roughness_flow,
        )

    def coarser(self) -> _Grids | None:
        """Return the film on cells twice as large; None when no axis can lose half its cells."""
        axes = tuple(axis for axis in (0, 1) if self.gap.shape[axis] >= FEWEST_CELLS)
        mask = _halve_field(self.mask.astype(float), axes) > 0.5
        if not axes or not mask.any():
            return None
        coarse = {
            part.name: _halve_field(value, axes)
            for part in fields(self)
            if isinstance(value := getattr(self, part.name), np.ndarray) and part.name != "mask"
        }
        dx, dy = (size * (2 if axis in axes else 1) for axis, size in enumerate(self.spacing))
        return replace(self, mask=mask, spacing=(dx, dy), **coarse)


class _FilmSolver:
    """Solves films on one mask; the sparsity and its analysis are kept between instants.

    A p + T theta = b with p >= 0, theta <= 1, p (1 - theta) = 0: a horizontal linear
    complementarity problem whose columns, however mixed, form an M-matrix, so that the solution is
    unique (Sznajder and Gowda 1995). All wrong cells are exchanged at once (the semismooth Newton
    step); when that gains nothing for a while, a random half of them (seeded), which breaks cycles.
    """

    def __init__(self, mask: Mask, backend: str | None) -> None:
        self._pattern = Pattern(mask)
        self._backend = backend
        self._factors: Factorization | None = None

    def solve(
        self, film: _Grids, full: Mask | None = None, time: float = 0.0
    ) -> tuple[FilmPressure, Array]:
        """Return the film, and a flow (m^3/s) above 0 where it is full, below 0 in cavities.

        ``full`` is a first guess of the full cells; None takes it from coarser grids.
        """
        if full is None:
            full = self._guess(film)
        pattern, operator = self._pattern, film.operator()
        by_pressure = pattern.rows_of(operator.by_pressure)
        by_fraction = pattern.rows_of(operator.by_fraction)
        rim_pressure = np.where(film.mask, 0.0, film.rim_pressure)
        rim_fraction = np.where(film.mask, 0.0, film.rim_fraction)
        known = -pattern.gather(operator.imbalance(rim_pressure, rim_fraction, film.content))
        hold, carry = by_pressure[0], by_fraction[0]
        # a cell that nothing leaves but by pressure can't be cavitated: it would fill for ever
        always_full = carry <= 1e-14 * carry.max()
        carry = np.where(always_full, 1.0, carry)
        # columns in units of flow: p times what it drives out of its own cell, theta likewise
        by_pressure = by_pressure / pattern.neighbours_of(hold, outside=1.0)
        by_flow = by_fraction / pattern.neighbours_of(carry, outside=1.0)

        is_full = pattern.gather(full) | always_full
        fewest, patience, partly = math.inf, PATIENCE, False
        draw = np.random.default_rng(0)
        iterations = 0
        while True:
            iterations += 1
            of_full = pattern.neighbours_of(is_full)
            rows = pattern.matrix(np.where(of_full, by_pressure, by_flow))
            right = known - np.where(of_full, by_fraction, 0.0).sum(axis=0)
            flows = self._solution(rows, right)
            settled = STALLED if partly else ROUNDING
            slack = max(settled * carry.max(), 4e-16 * float(np.abs(flows).max()))
            wrong = np.where(is_full, (flows < -slack) & ~always_full, flows > carry + slack)
            count = int(np.count_nonzero(wrong))
            if count == 0:
                break
            if iterations == MOST_SETS:
                raise ConvergenceError(
                    f"the full cells did not settle in {MOST_SETS} sets ({count} cells are wrong)",
                    where="film.film_pressure",
                    remedy="Refine the grid, smooth the gap or take smaller time steps.",
                )
            if count < fewest:
                fewest, patience, partly = count, PATIENCE, False
            elif patience > 0:
                patience -= 1
            else:
                partly = True
            if partly:
                wrong &= draw.random(wrong.size) < 0.5
            is_full = is_full ^ wrong
        pressure = rim_pressure + pattern.scatter(
            np.where(is_full, np.maximum(flows / hold, 0.0), 0.0)
        )
        fraction = rim_fraction + pattern.scatter(
            np.where(is_full, 1.0, np.clip(flows / carry, 0.0, 1.0))
        )
        missing = pattern.gather(operator.imbalance(pressure, fraction, film.content))
        flow_x, flow_y = operator.flows(pressure, fraction)
        inside, (dx, dy) = film.mask.astype(float), film.spacing
        through_x, through_y = flow_x * np.diff(inside, axis=0), flow_y * np.diff(inside, axis=1)
        # an imbalance is measured by the largest flow through a face or into a store
        sizes = (
            operator.carry.value,
            operator.kx.value * np.diff(pressure, axis=0),
            flow_y,
            operator.storage * operator.gap,
            operator.storage * film.content,
        )
        scale = max(float(np.abs(part).max(initial=0.0)) for part in sizes)
        solved = FilmPressure(
            pressure=pressure,
            fraction=fraction,
            gap=film.gap,
            cavitated=film.mask & ~pattern.scatter(is_full),
            load=float(pressure[film.mask].sum()) * dx * dy,
            rim_outflow=float(-through_x.sum() - through_y.sum()),
            mass_residual=float(np.abs(missing).max()) / scale if scale > 0 else 0.0,
            iterations=iterations,
            time=time,
        )
        return solved, pattern.scatter(np.where(is_full, flows, flows - carry))

    def _solution(self, rows, right: Array) -> Array:
        if self._factors is None:
            self._factors = factorization(rows, self._backend)
        else:
            self._factors.factorise(rows)
        flows = self._factors.solve(right)
        return flows + self._factors.solve(right - rows @ flows)

    def _guess(self, film: _Grids) -> Mask:
        coarse = film.coarser()
        if coarse is None:
            return np.ones_like(film.mask)
        _, excess = _FilmSolver(coarse.mask, self._backend).solve(coarse)
        return _finer(excess, film.mask.shape) >= 0.0


def _grids(film: Film) -> _Grids:
    """Return the fields of a film that can be; see the errors of ``Film``."""
    dx, dy = film.spacing if isinstance(film.spacing, tuple) else (film.spacing, film.spacing)
    for where, value in (("spacing", dx), ("spacing", dy), ("viscosity", film.viscosity)):
        positive(value, where)
    for where, value in (("speed", film.speed), ("upper_speed", film.upper_speed)):
        if not math.isfinite(value):
            raise InputError(
                Message("{value} is not finite", value=value),
                where=where,
                allowed="a finite speed, m/s",
            )
    gap = np.asarray(film.gap, dtype=float)
    mask = _mask(gap, film.mask)
    inner = gap[mask]
    if not (np.isfinite(inner).all() and (inner > 0).all()) or np.isnan(gap).any():
        raise InputError(
            "the gap is not positive everywhere in the film",
            where="gap",
            allowed="above 0, in m; inf outside the film where the floor is open",
        )
    factor = film.flow_factor
    pair = factor if isinstance(factor, tuple) and len(factor) == 2 else (factor, factor)
    along, across = (_field(part, gap.shape, "flow_factor") for part in pair)
    if not ((along > 0).all() and (across > 0).all()):
        raise InputError("a flow factor is not positive", where="flow_factor", allowed="above 0")
    shear_flow = _field(film.shear_flow, gap.shape, "shear_flow")
    pressure = _field(film.rim_pressure, gap.shape, "rim_pressure")
    fraction = _field(film.rim_fraction, gap.shape, "rim_fraction")
    if (pressure[~mask] < 0).any():
        raise InputError(
            "the pressure at the rim is below that of the cavities",
            where="rim_pressure",
            allowed="0 or more, Pa above the pressure in cavities",
        )
    _check_fraction(fraction[~mask], "rim_fraction")
    if ((pressure > 0) & (fraction < 1))[~mask].any():
        raise InputError(
            "a rim under pressure is full of liquid",
            where="rim_fraction",
            allowed="1 where rim_pressure is above 0",
        )
    bounded = np.maximum(np.where(np.isfinite(gap), gap, OPEN * inner.max()), inner.min())
    smooth = bounded**3 / (12 * film.viscosity)
    return _Grids(
        gap=bounded,
        along=along * smooth,
        across=across * smooth,
        roughness_flow=0.5 * film.speed * shear_flow,
        mask=mask,
        rim_pressure=pressure,
        rim_fraction=fraction,
        spacing=(dx, dy),
        speed=film.upper_speed - 0.5 * film.speed,
        content=np.zeros_like(gap),
    )


def _mask(gap: Array, mask: ArrayLike | None) -> Mask:
    if mask is None:
        cells = np.zeros(gap.shape, dtype=bool)
        if gap.ndim == 2:
            cells[1:-1, 1:-1] = True
    else:
        cells = np.asarray(mask, dtype=bool)
    if gap.ndim != 2 or cells.shape != gap.shape or not cells.any() or cells.all():
        raise InputError(
            "the film has no cell or no rim",
            where="mask",
            allowed="a mask (nx, ny) like the gap, with cells of both kinds",
        )
    return cells


def _field(value: ArrayLike, shape: tuple[int, ...], where: str) -> Array:
    field = np.asarray(value, dtype=float)
    if field.shape not in ((), shape):
        raise InputError(
            f"shape {field.shape} is not that of the gap", where=where, allowed=f"one or {shape}"
        )
    if not np.isfinite(field).all():
        raise InputError("a value is not finite", where=where)
    return np.broadcast_to(field, shape)


def _check_fraction(values: Array, where: str) -> None:
    if not ((values >= 0) & (values <= 1)).all():
        raise InputError("a liquid fraction is not 0 to 1", where=where, allowed="0 to 1")


def _halve_field(field: Array, axes: tuple[int, ...]) -> Array:
    """Return the means of neighbouring cells along ``axes``; an odd last cell counts twice."""
    for axis in axes:
        if field.shape[axis] % 2:
            field = np.concatenate([field, np.take(field, [-1], axis)], axis=axis)
        even, odd = (np.take(field, range(part, field.shape[axis], 2), axis) for part in (0, 1))
        field = 0.5 * (even + odd)
    return field


def _finer(field: Array, shape: tuple[int, ...]) -> Array:
    """Return a coarse ``field`` on the grid of ``shape``, linear between cell centres."""
    for axis in (0, 1):
        if field.shape[axis] == shape[axis]:
            continue
        size = field.shape[axis]
        before = np.take(field, np.maximum(np.arange(size) - 1, 0), axis)
        after = np.take(field, np.minimum(np.arange(size) + 1, size - 1), axis)
        pair = np.stack([0.75 * field + 0.25 * before, 0.75 * field + 0.25 * after], axis + 1)
        field = pair.reshape(*field.shape[:axis], 2 * size, *field.shape[axis + 1 :])
    return field[: shape[0], : shape[1]]
