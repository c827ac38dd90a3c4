"""Pressure and liquid fraction of one instant: where the film is full, and where it is not."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from underfoot.core import ConvergenceError

from ._kernels.jfo import Film, coarser, finer, largest_flow, net_outflow, operators
from ._kernels.pattern import Pattern
from .linear import Factorization, factorization

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

ROUNDING = 1e-13
"""Pressures and fractions that miss their bound by less, in units of flow, count as meeting it."""
PATIENCE = 8
"""Sets tried without fewer wrong cells before only half of them are exchanged."""
MOST_SETS = 400
FEWEST_CELLS = 32
"""Shortest axis that is still halved for a first guess."""


class Solved(NamedTuple):
    """Fields (nx, ny) of one instant."""

    pressure: Array
    fraction: Array
    full: Flags
    excess: Array  # m^3/s, above 0 where full, below where cavitated
    residual: float  # largest imbalance of a cell over the largest flow
    iterations: int


class FilmSolver:
    """Solves films on one mask; the sparsity and its analysis are kept between instants.

    A p + T theta = b with p >= 0, theta <= 1, p (1 - theta) = 0: a horizontal linear
    complementarity problem whose columns, however mixed, form an M-matrix, so that the solution is
    unique (Sznajder and Gowda 1995). All wrong cells are exchanged at once (the semismooth Newton
    step); when that gains nothing for a while, a random half of them (seeded), which breaks cycles.
    """

    def __init__(self, mask: Flags, backend: str | None = None) -> None:
        self._pattern = Pattern(mask)
        self._backend = backend
        self._factors: Factorization | None = None

    def solve(self, film: Film, full: Flags | None = None) -> Solved:
        """Return the film, from a first guess of the ``full`` cells (None: from coarser grids)."""
        if full is None:
            full = self._guess(film)
        pattern = self._pattern
        parts = operators(film)
        by_pressure = pattern.rows_of(parts.by_pressure)
        by_fraction = pattern.rows_of(parts.by_fraction)
        outside = ~film.mask
        known = -pattern.gather(
            net_outflow(
                film,
                parts,
                np.where(outside, film.rim_pressure, 0.0),
                np.where(outside, film.rim_fraction, 0.0),
            )
        )
        hold, carry = by_pressure[0], by_fraction[0]
        # a cell that nothing leaves but by pressure can't be cavitated: it would fill for ever
        kept = carry <= 1e-14 * carry.max()
        carry = np.where(kept, 1.0, carry)
        by_pressure = by_pressure / np.where(pattern.columns >= 0, hold[pattern.columns], 1.0)
        scaled = by_fraction / np.where(pattern.columns >= 0, carry[pattern.columns], 1.0)

        is_full = pattern.gather(full) | kept
        fewest, patience, partly = pattern.size + 1, PATIENCE, False
        draw = np.random.default_rng(0)
        iterations = 0
        while True:
            iterations += 1
            of_full = pattern.neighbours_of(is_full.astype(float)) > 0
            rows = pattern.matrix(np.where(of_full, by_pressure, scaled))
            right = known - np.where(of_full, by_fraction, 0.0).sum(axis=0)
            flows = self._solution(rows, right)
            slack = max(ROUNDING * carry.max(), 4e-16 * float(np.abs(flows).max()))
            wrong = np.where(is_full, (flows < -slack) & ~kept, flows > carry + slack)
            count = int(np.count_nonzero(wrong))
            if count == 0:
                break
            if iterations == MOST_SETS:
                raise ConvergenceError(
                    f"the full cells did not settle in {MOST_SETS} sets ({count} cells are wrong)",
                    where="film.mass_conserving",
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
        pressure = pattern.scatter(np.where(is_full, np.maximum(flows / hold, 0.0), 0.0))
        fraction = pattern.scatter(np.where(is_full, 1.0, np.clip(flows / carry, 0.0, 1.0)))
        pressure = np.where(outside, film.rim_pressure, pressure)
        fraction = np.where(outside, film.rim_fraction, fraction)
        left = pattern.gather(net_outflow(film, parts, pressure, fraction))
        scale = largest_flow(film, parts, pressure, fraction)
        residual = float(np.abs(left).max()) / scale if scale > 0 else 0.0
        return Solved(
            pressure,
            fraction,
            pattern.scatter(is_full.astype(float)) > 0,
            pattern.scatter(np.where(is_full, flows, flows - carry)),
            residual,
            iterations,
        )

    def _solution(self, rows, right: Array) -> Array:
        if self._factors is None:
            self._factors = factorization(rows, self._backend)
        else:
            self._factors.factorise(rows)
        flows = self._factors.solve(right)
        return flows + self._factors.solve(right - rows @ flows)

    def _guess(self, film: Film) -> Flags:
        coarse = coarser(film, FEWEST_CELLS)
        if coarse is None:
            return np.ones_like(film.mask)
        solved = FilmSolver(coarse.mask, self._backend).solve(coarse)
        return finer(solved.excess, film.mask.shape) >= 0.0
