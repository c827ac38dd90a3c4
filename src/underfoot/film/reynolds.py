"""Pressure of a film between given walls: Reynolds' equation with cavitation."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import ConvergenceError, InputError

from ._kernels.jfo import Film, coarser, finer, net_outflow, operators
from ._kernels.pattern import Pattern
from .linear import factorization

Array = NDArray[np.float64]
MOST_SETS = 60
FEWEST_CELLS = 32  # shortest axis that is still halved for a first guess
OPEN = 100.0  # gap of the open surroundings over the largest gap of the film


@dataclass(frozen=True, slots=True)
class FilmPressure:
    """Pressure of a film and what it does; arrays (nx, ny).

    ``void_rate`` is the volume per time and area (m/s) that the cavitated cells open up: the
    complementary part of p >= 0.
    """

    pressure: Array
    cavitated: NDArray[np.bool_]
    void_rate: Array
    rim_outflow: float  # m^3/s that leaves the film through its rim
    load: float  # N
    iterations: int


def film_pressure(
    gap: ArrayLike,
    *,
    spacing: float,
    viscosity: float,
    speed: float,
    opening_speed: ArrayLike = 0.0,
    film: ArrayLike | None = None,
    flow_factor: ArrayLike = 1.0,
    backend: str | None = None,
) -> FilmPressure:
    """Return the pressure of an incompressible film between walls whose gap is known.

    -div(phi h^3 / (12 eta) grad p) - (V / 2) dh/dx + dh/dt = lambda,
    p >= 0, lambda >= 0, p lambda = 0

    The upper wall slides at V along +x over a floor at rest; a gap that widens towards +x builds
    pressure. Finite volumes with the exact flux through a step between two cells; second order for
    smooth gaps.

    Parameters
    ----------
    gap
        (nx, ny) m, above 0 where there is film.
    spacing, viscosity, speed
        Cell size in m, Pa s, m/s (negative: backward).
    opening_speed
        dh/dt, m/s; negative when the walls approach. Scalar or (nx, ny).
    film
        (nx, ny) True where there is film; elsewhere p = 0 (at the cell's centre, or at its face
        where its gap is inf: open surroundings). None: all cells but the outermost. Nothing flows
        through the edges of the array.
    flow_factor
        phi, scalar or (nx, ny).

    Raises
    ------
    InputError
        Values that are not finite or not physical.
    ConvergenceError
        The set of cavitated cells did not settle.

    Source: Reynolds 1886; complementarity after Christopherson 1941.
    """
    h = np.asarray(gap, dtype=float)
    mask = _film_mask(h, film)
    _check(h, mask, spacing, viscosity, speed, opening_speed, flow_factor)
    safe = np.where(np.isfinite(h), h, OPEN * h[mask].max())
    safe = np.maximum(safe, h[mask].min())
    conductance = np.broadcast_to(np.asarray(flow_factor, dtype=float), h.shape)
    conductance = conductance * safe**3 / (12 * viscosity)
    instant = Film(
        gap=safe,
        along=conductance,
        across=conductance,
        carried=-0.5 * speed * safe,
        mask=mask,
        rim_pressure=np.zeros_like(safe),
        rim_fraction=np.ones_like(safe),
        dx=spacing,
        dy=spacing,
        storage=None,
        content=np.broadcast_to(np.asarray(opening_speed, dtype=float), h.shape),
    )
    solved = _settled(instant, backend)
    outflow = net_outflow(instant, operators(instant), solved.pressure, instant.rim_fraction)
    return FilmPressure(
        pressure=solved.pressure,
        cavitated=solved.cavitated,
        void_rate=solved.void / spacing**2,
        rim_outflow=float(outflow[mask].sum()),
        load=float(solved.pressure.sum()) * spacing**2,
        iterations=solved.iterations,
    )


class _Settled(NamedTuple):
    """Fields (nx, ny) of one grid."""

    pressure: Array
    cavitated: NDArray[np.bool_]
    void: Array  # m^3/s that a cavitated cell opens up
    excess: Array  # m^3/s, above 0 where full, below where cavitated
    iterations: int


def _settled(film: Film, backend: str | None) -> _Settled:
    """Return the pressure of a film whose ``content`` holds dh/dt, m/s.

    The set of cavitated cells moves by about a cell an iteration, so that the search starts from
    that of a grid with cells of twice the size.
    """
    pattern = Pattern(film.mask)
    parts = operators(film)
    blank, full = np.zeros_like(film.gap), np.ones_like(film.gap)
    opening = film.content * film.dx * film.dy
    source = pattern.gather(net_outflow(film, parts, blank, full) + opening)
    coefficients = pattern.rows_of(parts.by_pressure)
    matrix = pattern.matrix(coefficients)
    diagonal = coefficients[0]
    unit = np.zeros_like(coefficients)
    unit[0] = 1.0
    cavitated = pattern.gather(_guess(film, backend))
    factors = None
    iterations = 0
    while True:
        iterations += 1
        rows = pattern.matrix(np.where(cavitated, unit, coefficients / diagonal))
        if factors is None:
            factors = factorization(rows, backend)
        else:
            factors.factorise(rows)
        pressure = factors.solve(np.where(cavitated, 0.0, -source / diagonal))
        net = matrix @ pressure + source
        scale = 1e-12 * max(float(np.abs(pressure).max()), 1e-300)
        updated = pressure - np.where(cavitated, net, 0.0) / diagonal < -scale
        if (updated == cavitated).all():
            break
        if iterations == MOST_SETS:
            raise ConvergenceError(
                f"the cavitated cells did not settle in {MOST_SETS} iterations",
                where="film.film_pressure",
                remedy="Refine the grid or smooth the gap.",
            )
        cavitated = updated
    pressure = np.where(cavitated, 0.0, pressure)
    void = np.where(cavitated, matrix @ pressure + source, 0.0)
    return _Settled(
        pattern.scatter(pressure),
        pattern.scatter(cavitated.astype(float)) > 0,
        pattern.scatter(void),
        pattern.scatter(np.where(cavitated, -void, pressure * diagonal)),
        iterations,
    )


def _guess(film: Film, backend: str | None) -> NDArray[np.bool_]:
    """Return the cavitated cells of a coarser grid; none where there is no such grid."""
    coarse = coarser(film, FEWEST_CELLS)
    if coarse is not None:
        try:
            return finer(_settled(coarse, backend).excess, film.mask.shape) < 0.0
        except ConvergenceError:
            pass  # a first guess only
    return np.zeros_like(film.mask)


def _film_mask(gap: Array, film: ArrayLike | None) -> NDArray[np.bool_]:
    if film is not None:
        return np.asarray(film, dtype=bool)
    mask = np.zeros(gap.shape, dtype=bool)
    mask[1:-1, 1:-1] = True
    return mask


def _check(
    gap: Array,
    mask: NDArray[np.bool_],
    spacing: float,
    viscosity: float,
    speed: float,
    opening_speed: ArrayLike,
    flow_factor: ArrayLike,
) -> None:
    for where, value in (("spacing", spacing), ("viscosity", viscosity)):
        if not (math.isfinite(value) and value > 0):
            raise InputError(
                f"{value} is not positive", where=where, allowed="a finite value above 0"
            )
    if not math.isfinite(speed):
        raise InputError(f"{speed} is not finite", where="speed", allowed="a finite speed, m/s")
    if gap.ndim != 2 or mask.shape != gap.shape or not mask.any():
        raise InputError("the film has no cell", where="film", allowed="a mask like the gap")
    inner = gap[mask]
    if not (np.isfinite(inner).all() and (inner > 0).all()):
        raise InputError(
            "the gap is not positive everywhere in the film", where="gap", allowed="above 0, in m"
        )
    if not np.isfinite(np.asarray(opening_speed, dtype=float)).all():
        raise InputError("dh/dt is not finite", where="opening_speed")
    factor = np.asarray(flow_factor, dtype=float)
    if not (np.isfinite(factor).all() and (factor > 0).all()):
        raise InputError("the flow factor is not positive", where="flow_factor", allowed="above 0")
