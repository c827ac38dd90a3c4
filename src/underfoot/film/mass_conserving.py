"""Film with mass-conserving cavitation (Jakobsson, Floberg and Olsson), steady and transient."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import InputError, Progress, silent

from ._kernels.jfo import Film, operators
from .complementarity import FilmSolver, Solved

Array = NDArray[np.float64]
OPEN = 100.0  # gap of the open surroundings over the largest gap of the film


@dataclass(frozen=True, slots=True)
class MassConservingFilm:
    """Film that ruptures and reforms without losing liquid; arrays (nx, ny).

    ``fraction`` theta is the share of the gap that holds liquid: 1 where the film is full, below 1
    where it has ruptured and the pressure is that of the cavity, 0.
    """

    pressure: Array  # Pa above the cavity's
    fraction: Array  # 0 to 1
    gap: Array  # m
    cavitated: NDArray[np.bool_]
    load: float  # N, pressure over the film's cells
    rim_outflow: float  # m^3/s of liquid that leaves the film through its rim
    mass_residual: float  # largest imbalance of a cell over the largest flow of a face
    iterations: int
    time: float = 0.0  # s

    @property
    def content(self) -> Array:
        """Return the liquid per area, theta h (m)."""
        return self.fraction * self.gap


def mass_conserving_film(
    gap: ArrayLike,
    *,
    spacing: float | tuple[float, float],
    viscosity: float,
    speed: float,
    upper_speed: float = 0.0,
    film: ArrayLike | None = None,
    flow_factor: ArrayLike | tuple[ArrayLike, ArrayLike] = 1.0,
    shear_flow: ArrayLike = 0.0,
    rim_pressure: ArrayLike = 0.0,
    rim_fraction: ArrayLike = 1.0,
    before: ArrayLike | None = None,
    time_step: float | None = None,
    backend: str | None = None,
) -> MassConservingFilm:
    """Return pressure and liquid fraction of a film between walls whose gap is known.

    d(theta h)/dt + d/dx[theta (U h + V s / 2)] = div(phi h^3 / (12 eta) grad p)
    p >= 0, theta <= 1, p (1 - theta) = 0,   U = upper_speed - V / 2

    Volume is conserved in the cavity and across its borders (the conditions of Jakobsson, Floberg
    and Olsson), so that a film reforms where the liquid to fill the gap has arrived. Where nothing
    cavitates it is Reynolds' equation, and ``film_pressure`` gives the same. Load of second order
    in the cell size; the liquid of a cavity is carried upwind and stepped by implicit Euler, both
    of first order.

    Parameters
    ----------
    gap
        (nx, ny) m, above 0 where there is film.
    spacing
        Cell size in m, one or (along x, along y).
    viscosity, speed
        Pa s; V, sliding speed of the upper wall along +x over the lower one, m/s.
    upper_speed
        Speed of the upper wall along +x on the grid, m/s. 0: the grid moves with it (a sole that
        slides over a floor, as in ``film_pressure``); equal to ``speed``: the grid rests on the
        lower wall; with ``speed`` 0: both walls move alike (rolling).
    film
        (nx, ny) True where there is film; elsewhere the pressure is ``rim_pressure`` and liquid
        enters with ``rim_fraction`` (at the cell's centre, or at its face where its gap is inf).
        None: all cells but the outermost. Nothing flows through the edges of the array.
    flow_factor
        phi, one or (along x, along y), scalars or (nx, ny).
    shear_flow
        s = sigma phi_s, m, scalar or (nx, ny): flow that roughness carries, positive where the
        upper wall's roughness carries more (``patir_cheng_shear_flow``).
    rim_pressure, rim_fraction
        Pa above the pressure in cavities (so the ambient pressure, 1e5 Pa, if cavities hold
        vapour; 0 if they fill with air), 0 or more; 0 to 1, below 1 only where that pressure is 0
        (a starved inlet).
    before, time_step
        Liquid per area (m) at the start of a step of ``time_step`` (s). Neither: a steady film.

    Raises
    ------
    InputError
        Values that are not finite or not physical.
    ConvergenceError
        The set of full cells did not settle.

    Source: Jakobsson and Floberg 1957, Olsson 1965; pressure-fraction form of Bayada and of
    Giacopini et al. (2010, J. Tribol. 132:041702); semismooth Newton after Woloszynski, Podsiadlo
    and Stachowiak (2015, Tribol. Lett. 58:18).
    """
    if (before is None) != (time_step is None):
        raise InputError(
            "a step needs the liquid before it and its length",
            where="before" if before is None else "time_step",
            remedy="Give before and time_step, or neither for a steady film.",
        )
    instant = _film(
        np.asarray(gap, dtype=float),
        spacing=spacing,
        viscosity=viscosity,
        speed=speed,
        upper_speed=upper_speed,
        film=film,
        flow_factor=flow_factor,
        shear_flow=shear_flow,
        rim_pressure=rim_pressure,
        rim_fraction=rim_fraction,
        before=before,
        time_step=time_step,
    )
    solved = FilmSolver(instant.mask, backend).solve(instant)
    return _result(instant, solved, time_step or 0.0)


def mass_conserving_history(
    gap_at: Callable[[float], ArrayLike],
    times: Iterable[float],
    *,
    spacing: float | tuple[float, float],
    viscosity: float,
    speed: float,
    upper_speed: float = 0.0,
    film: ArrayLike | None = None,
    flow_factor: ArrayLike | tuple[ArrayLike, ArrayLike] = 1.0,
    shear_flow: ArrayLike = 0.0,
    rim_pressure: ArrayLike = 0.0,
    rim_fraction: ArrayLike = 1.0,
    start_fraction: ArrayLike = 1.0,
    backend: str | None = None,
    progress: Progress = silent,
) -> Iterator[MassConservingFilm]:
    """Yield the film at each of ``times`` (s) after the first, while the gap changes.

    ``gap_at(t)`` is the gap (nx, ny) m on the grid at time t: it holds the squeeze and the motion
    of textured walls. The film starts at the first time with ``start_fraction``. One implicit
    Euler step from each time to the next; equation, other parameters and errors as
    ``mass_conserving_film``.
    """
    instants = np.asarray(list(times), dtype=float)
    if instants.ndim != 1 or instants.size < 2 or not (np.diff(instants) > 0).all():
        raise InputError(
            "the times do not increase", where="times", allowed="two or more rising times, s"
        )
    gap = np.asarray(gap_at(float(instants[0])), dtype=float)
    start = _field(start_fraction, gap.shape, "start_fraction")
    if not ((start >= 0) & (start <= 1)).all():
        raise InputError("a liquid fraction is not 0 to 1", where="start_fraction")
    content = start * np.where(np.isfinite(gap), gap, 0.0)
    solver: FilmSolver | None = None
    full = None
    for count, (earlier, now) in enumerate(pairwise(instants), start=1):
        instant = _film(
            np.asarray(gap_at(float(now)), dtype=float),
            spacing=spacing,
            viscosity=viscosity,
            speed=speed,
            upper_speed=upper_speed,
            film=film,
            flow_factor=flow_factor,
            shear_flow=shear_flow,
            rim_pressure=rim_pressure,
            rim_fraction=rim_fraction,
            before=content,
            time_step=float(now - earlier),
        )
        if solver is None:
            solver = FilmSolver(instant.mask, backend)
        solved = solver.solve(instant, full)
        full = solved.full
        found = _result(instant, solved, float(now))
        content = found.content
        progress("film history", count / (instants.size - 1), found.mass_residual)
        yield found


def _result(film: Film, solved: Solved, time: float) -> MassConservingFilm:
    area = film.dx * film.dy
    parts = operators(film)
    upstream = np.where(parts.carry > 0, solved.fraction[:-1], solved.fraction[1:])
    flux_x = parts.carry * upstream - parts.kx * np.diff(solved.pressure, axis=0)
    flux_y = -parts.ky * np.diff(solved.pressure, axis=1)
    inside = film.mask.astype(float)
    leaving = -(flux_x * np.diff(inside, axis=0)).sum() - (flux_y * np.diff(inside, axis=1)).sum()
    return MassConservingFilm(
        pressure=solved.pressure,
        fraction=solved.fraction,
        gap=film.gap,
        cavitated=film.mask & ~solved.full,
        load=float(solved.pressure[film.mask].sum()) * area,
        rim_outflow=float(leaving),
        mass_residual=solved.residual,
        iterations=solved.iterations,
        time=time,
    )


def _film(
    gap: Array,
    *,
    spacing: float | tuple[float, float],
    viscosity: float,
    speed: float,
    upper_speed: float,
    film: ArrayLike | None,
    flow_factor: ArrayLike | tuple[ArrayLike, ArrayLike],
    shear_flow: ArrayLike,
    rim_pressure: ArrayLike,
    rim_fraction: ArrayLike,
    before: ArrayLike | None,
    time_step: float | None,
) -> Film:
    dx, dy = spacing if isinstance(spacing, tuple) else (spacing, spacing)
    positive = [("spacing", dx), ("spacing", dy), ("viscosity", viscosity)]
    if time_step is not None:
        positive.append(("time_step", time_step))
    for where, value in positive:
        if not (math.isfinite(value) and value > 0):
            raise InputError(
                f"{value} is not positive", where=where, allowed="a finite value above 0"
            )
    for where, value in (("speed", speed), ("upper_speed", upper_speed)):
        if not math.isfinite(value):
            raise InputError(f"{value} is not finite", where=where, allowed="a finite speed, m/s")
    mask = _mask(gap, film)
    inner = gap[mask]
    if not (np.isfinite(inner).all() and (inner > 0).all()):
        raise InputError(
            "the gap is not positive everywhere in the film", where="gap", allowed="above 0, in m"
        )
    if np.isnan(gap).any():
        raise InputError("the gap holds NaN", where="gap", allowed="inf where the floor is open")
    along, across = _factors(flow_factor, gap.shape)
    extra = _field(shear_flow, gap.shape, "shear_flow")
    pressure = _field(rim_pressure, gap.shape, "rim_pressure")
    fraction = _field(rim_fraction, gap.shape, "rim_fraction")
    rim = ~mask
    if (pressure[rim] < 0).any():
        raise InputError(
            "the pressure at the rim is below that of the cavities",
            where="rim_pressure",
            allowed="0 or more, Pa above the pressure in cavities",
        )
    if not ((fraction[rim] >= 0) & (fraction[rim] <= 1)).all():
        raise InputError("a liquid fraction is not 0 to 1", where="rim_fraction", allowed="0 to 1")
    if ((pressure[rim] > 0) & (fraction[rim] < 1)).any():
        raise InputError(
            "a rim under pressure is full of liquid",
            where="rim_fraction",
            allowed="1 where rim_pressure is above 0",
        )
    safe = np.where(np.isfinite(gap), gap, OPEN * inner.max())
    safe = np.maximum(safe, inner.min())
    smooth = safe**3 / (12 * viscosity)
    content = _field(0.0 if before is None else before, gap.shape, "before")
    if (content < 0).any():
        raise InputError("the liquid before the step is negative", where="before", allowed="m, 0+")
    storage = None
    if time_step is not None:
        storage = np.where(mask, dx * dy / time_step, 0.0)
    return Film(
        gap=safe,
        along=along * smooth,
        across=across * smooth,
        carried=(upper_speed - 0.5 * speed) * safe + 0.5 * speed * extra,
        mask=mask,
        rim_pressure=pressure,
        rim_fraction=fraction,
        dx=dx,
        dy=dy,
        storage=storage,
        content=content,
    )


def _mask(gap: Array, film: ArrayLike | None) -> NDArray[np.bool_]:
    if film is None:
        mask = np.zeros(gap.shape, dtype=bool)
        if gap.ndim == 2:
            mask[1:-1, 1:-1] = True
    else:
        mask = np.asarray(film, dtype=bool)
    if gap.ndim != 2 or mask.shape != gap.shape or not mask.any() or mask.all():
        raise InputError(
            "the film has no cell or no rim",
            where="film",
            allowed="a mask (nx, ny) like the gap, with cells of both kinds",
        )
    return mask


def _factors(
    given: ArrayLike | tuple[ArrayLike, ArrayLike], shape: tuple[int, ...]
) -> tuple[Array, Array]:
    pair = given if isinstance(given, tuple) and len(given) == 2 else (given, given)
    along, across = (_field(one, shape, "flow_factor") for one in pair)
    if not ((along > 0).all() and (across > 0).all()):
        raise InputError("a flow factor is not positive", where="flow_factor", allowed="above 0")
    return along, across


def _field(given: ArrayLike, shape: tuple[int, ...], where: str) -> Array:
    field = np.asarray(given, dtype=float)
    if field.shape not in ((), shape):
        raise InputError(
            f"shape {field.shape} is not that of the gap", where=where, allowed=f"one or {shape}"
        )
    if not np.isfinite(field).all():
        raise InputError("a value is not finite", where=where)
    return np.broadcast_to(field, shape)
