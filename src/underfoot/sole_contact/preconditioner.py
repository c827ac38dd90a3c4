"""Sparse stand-in for the dense contact Jacobian: the elastic symbol as a screened pole.

With C(k) ~ w + g / (b^2 + k^2) the pole is a field q with (b^2 - lap) q = g dp, so the linearised
problem becomes a sparse block system in (v, q), factorised directly, with the approach as a border.
GMRES iterations then do not grow with the grid. A second pole takes the same iterations and twice
the factorisation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from underfoot.core import ConvergenceError
from underfoot.core.arrays import Array
from underfoot.core.sparse import Factorization, factorization
from underfoot.film import Pattern

from .compliance import Compliance
from .film_balance import Linearisation

SCREENINGS = 100


@dataclass(frozen=True, slots=True)
class PoleFit:
    """C(k) ~ local + strength / (screening^2 + k^2)."""

    local: float  # m/Pa
    strength: float  # 1/(Pa m)
    screening: float  # 1/m
    error: float  # largest relative error on the fitted range


def pole_fit(compliance: Compliance, longest: float, spacing: float) -> PoleFit:
    """Return the pole that fits the symbol best between ``longest`` wave (m) and the grid's.

    Of ``SCREENINGS`` trial screenings that whose relative misfit is least in the mean square;
    neither part is negative.
    """
    k = np.geomspace(2 * np.pi / longest, np.pi / spacing, 60)
    target = compliance.symbol(k)
    screenings = np.geomspace(k[0] / 3, k[-1] * 3, SCREENINGS)
    pole = 1 / (screenings[:, None] ** 2 + k**2) / target
    flat = 1 / target
    # least squares of a pole + b flat = 1 for each screening; a negative part is left out
    pp, pf, ff = (pole**2).sum(axis=1), pole @ flat, flat @ flat
    p1, f1 = pole.sum(axis=1), flat.sum()
    strength = (p1 * ff - f1 * pf) / (pp * ff - pf**2)
    local = (pp * f1 - pf * p1) / (pp * ff - pf**2)
    strength, local = (
        np.where(local < 0, p1 / pp, np.where(strength < 0, 0.0, strength)),
        np.where(local < 0, 0.0, np.where(strength < 0, f1 / ff, local)),
    )
    misfit = strength[:, None] * pole + local[:, None] * flat - 1
    best = int((misfit**2).sum(axis=1).argmin())
    return PoleFit(
        float(local[best]),
        float(strength[best]),
        float(screenings[best]),
        float(np.abs(misfit[best]).max()),
    )


class Preconditioner:
    """Layout of the block system on one set of cells; filled and factorised at each Newton step.

    Unknowns of a cell: v, the change of fluid pressure where it is full or of liquid fraction where
    it is cavitated (in units of pressure), and q, the field of the pole in units of ``scale`` s, a
    typical self compliance (m/Pa). Gap and total pressure are eliminated cell by
    cell: with kappa the stiffness of the asperities, w the local part of the compliance, delta the
    change of approach over s, e the change of
    fluid pressure that is due where a cell is not full,

        dh = (w (chi v + e) + s (q - delta)) / (1 + kappa w),  chi = 1 where full, else 0
        dp = chi v + e - kappa dh
    """

    def __init__(self, pattern: Pattern, fit: PoleFit, scale: float, spacing: float) -> None:
        size = pattern.size
        self.pattern = pattern
        self.scale = scale
        self.local = fit.local
        self.source = fit.strength * spacing**2 / scale  # of q, over dp
        diagonal = np.arange(size)
        # beside the cells the field goes on as it decays along a line
        screened = (fit.screening * spacing) ** 2
        decayed = math.sqrt(screened + screened**2 / 4) - screened / 2
        inner = pattern.neighbours_of(np.ones(size))[1:].sum(axis=0)
        self._screened = np.full((5, size), -1.0)
        self._screened[0] = inner + (4 - inner) * decayed + screened
        # blocks of the rows of v (by v, by q) and of q (by q, by v), as ``factorise`` fills them
        rows = [pattern.rows, pattern.rows, pattern.rows + size, diagonal + size]
        own = pattern.indices.astype(np.int64)
        columns = [own, own + size, own + size, diagonal]
        row, column = np.concatenate(rows), np.concatenate(columns)
        self._total = 2 * size
        self._order = np.lexsort((column, row))
        self._indices = column[self._order].astype(np.int32)
        self._indptr = np.searchsorted(row[self._order], np.arange(self._total + 1)).astype(
            np.int32
        )
        self._factors: Factorization | None = None

    def factorise(self, linear: Linearisation, backend: str | None) -> BorderedSolve:
        """Return the solver for a linearised problem."""
        pattern, size = self.pattern, self.pattern.size
        full = linear.full
        yields = 1 / (1 + linear.stiffness * self.local)
        scale = np.ones(size)
        balance, by_gap = np.zeros((5, size)), np.zeros((5, size))
        balance[0] = 1.0  # a dry cell: v = 0
        if linear.film is not None:
            film = linear.film
            cavity = np.zeros(size, dtype=bool)
            cavity[linear.cavitated] = True
            wet = full | cavity
            pressure, fraction = film.by_pressure, film.by_fraction
            # fraction in units of pressure: so that both kinds of column have the size of A
            unit = pressure[0] / np.where(fraction[0] > 0, fraction[0], 1.0)
            of_cavity = pattern.neighbours_of(cavity.astype(float)) > 0
            of_full = pattern.neighbours_of(full.astype(float)) > 0
            mixed = np.where(of_full, pressure, 0.0)
            mixed += np.where(of_cavity, fraction * pattern.neighbours_of(unit), 0.0)
            balance = np.where(wet, mixed, balance)
            by_gap = np.where(wet, film.by_gap, 0.0) * pattern.neighbours_of(yields)
            balance = balance + by_gap * self.local * of_full
            scale = np.abs(balance[0])
            balance, by_gap = balance / scale, by_gap / scale
        through = pattern.data(by_gap * self.scale)
        resisted = linear.stiffness * yields * self.scale
        screened = self._screened.copy()
        screened[0] += self.source * resisted
        data = [pattern.data(balance), through, pattern.data(screened)]
        values = np.concatenate([*data, -self.source * yields * full])[self._order]
        matrix = sp.csr_matrix((values, self._indices, self._indptr), (self._total,) * 2)
        if self._factors is None:
            self._factors = factorization(matrix, backend)
        else:
            self._factors.factorise(matrix)
        by_unfilled = pattern.matrix(by_gap * self.local)
        lifted = np.bincount(pattern.rows, weights=through, minlength=size).astype(np.float64)
        column = -np.concatenate([lifted, self.source * resisted])
        rows = 1.0 if linear.film is None else linear.film.diagonal / scale
        return BorderedSolve(self, self._factors, full, yields, resisted, rows, by_unfilled, column)


class BorderedSolve:
    """Solve of the block system bordered by the approach (column) and the load (row)."""

    def __init__(
        self,
        layout: Preconditioner,
        factors: Factorization,
        full: NDArray[np.bool_],
        yields: Array,
        resisted: Array,
        rows: Array | float,
        by_unfilled: sp.csr_matrix,
        column: Array,
    ) -> None:
        self._layout, self._factors = layout, factors
        self._full, self._yields, self._resisted = full, yields, resisted
        self._rows, self._by_unfilled = rows, by_unfilled
        self._answer = self._pressure(factors.solve(column), 0.0) - resisted
        self._pivot = float(self._answer.mean())
        if self._pivot == 0.0 or not np.isfinite(self._pivot):
            raise ConvergenceError("the load does not depend on the approach", where="sole_contact")

    def __call__(self, right: Array) -> Array:
        """Return the pressure change of the cells and the change of the approach."""
        unfilled = np.where(self._full, 0.0, right[:-1])
        balance = np.where(self._full, right[:-1] * self._rows, 0.0) - self._by_unfilled @ unfilled
        source = self._layout.source * self._yields * unfilled
        plain = self._pressure(self._factors.solve(np.concatenate([balance, source])), unfilled)
        approach = (float(plain.mean()) - float(right[-1])) / self._pivot
        result = np.empty(right.size)
        result[:-1] = plain - approach * self._answer
        result[-1] = approach * self._layout.scale
        return result

    def _pressure(self, solved: Array, unfilled: Array | float) -> Array:
        """Return the change of total pressure that belongs to (v, q)."""
        by_fluid, bent = solved.reshape(2, -1)
        fluid = np.where(self._full, by_fluid, 0.0) + unfilled
        return self._yields * fluid - self._resisted * bent
