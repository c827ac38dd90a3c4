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

from underfoot.core import ConvergenceError
from underfoot.core.arrays import Array, Mask
from underfoot.core.sparse import Factorization, factorization
from underfoot.film import Pattern, SparseLayout

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
        # beside the cells the field goes on as it decays along a line
        screened = (fit.screening * spacing) ** 2
        decayed = math.sqrt(screened + screened**2 / 4) - screened / 2
        inner = pattern.neighbours_of(np.ones(size))[1:].sum(axis=0)
        self._screened = np.full((5, size), -1.0)
        self._screened[0] = inner + (4 - inner) * decayed + screened
        # rows of v (by v, by q) and of q (by q, by v), as ``factorise`` fills them
        own, columns, beside = pattern.rows, pattern.columns, pattern.beside
        self._layout = SparseLayout(
            np.concatenate([own, own, own + size, own[:1] + size]),
            np.concatenate([columns, beside, beside, columns[:1]]),
            (2 * size, 2 * size),
        )
        self._factors: Factorization | None = None

    def factorise(self, linear: Linearisation, backend: str | None) -> BorderedSolve:
        """Return the solver for a linearised problem."""
        pattern, size = self.pattern, self.pattern.size
        full, film = linear.full, linear.film
        yields = 1 / (1 + linear.stiffness * self.local)
        resisted = linear.stiffness * yields * self.scale
        source = self.source * yields
        balance, through = np.zeros((2, 5, size))
        balance[0] = 1.0  # a dry cell: v = 0
        rows = np.zeros(size)
        if film is not None:
            cavity, wet = film.cavity.cells, full.copy()
            wet[cavity] = True
            # fraction in units of pressure: so that both kinds of column have the size of A
            own, unit = film.by_fraction[0, cavity], np.zeros(size)
            unit[cavity] = film.by_pressure[0, cavity] / np.where(own > 0, own, 1.0)
            mixed = film.by_pressure * pattern.neighbours_of(full)
            mixed += film.by_gap * pattern.neighbours_of(self.local * yields * full)
            mixed += film.by_fraction * pattern.neighbours_of(unit)
            scale = np.where(wet, np.abs(mixed[0]), 1.0)
            balance = np.where(wet, mixed / scale, balance)
            through = film.by_gap * pattern.neighbours_of(self.scale * yields) * (wet / scale)
            rows = full * film.diagonal / scale
        screened = self._screened.copy()
        screened[0] += self.source * resisted
        blocks = np.concatenate([balance, through, screened, -(source * full)[None]])
        matrix = self._layout.matrix(blocks)
        if self._factors is None:
            self._factors = factorization(matrix, backend)
        else:
            self._factors.factorise(matrix)
        column = -np.concatenate([through.sum(axis=0), self.source * resisted])
        return BorderedSolve(
            self, self._factors, full, yields, resisted, rows, pattern.matrix(through), column
        )


class BorderedSolve:
    """Solve of the block system bordered by the approach (column) and the load (row)."""

    def __init__(
        self,
        layout: Preconditioner,
        factors: Factorization,
        full: Mask,
        yields: Array,
        resisted: Array,
        rows: Array,
        through: sp.csr_matrix,
        column: Array,
    ) -> None:
        self._factors, self._scale = factors, layout.scale
        self._rows, self._through = rows, through
        self._yields, self._resisted = yields * full, resisted
        # what is due in a cell that is not full: of its pressure, of the gap and of the field
        self._due = yields * ~full
        self._bent, self._source = layout.local / layout.scale * ~full, layout.source * self._due
        self._answer = self._pressure(factors.solve(column)) - resisted
        self._pivot = float(self._answer.mean())
        if self._pivot == 0.0 or not np.isfinite(self._pivot):
            raise ConvergenceError("the load does not depend on the approach", where="sole_contact")

    def __call__(self, right: Array) -> Array:
        """Return the pressure change of the cells and the change of the approach."""
        due = right[:-1]
        balance = self._rows * due - self._through @ (self._bent * due)
        solved = self._factors.solve(np.concatenate([balance, self._source * due]))
        result = np.empty_like(right)
        plain = np.add(self._pressure(solved), self._due * due, out=result[:-1])
        approach = (plain.sum() / plain.size - right[-1]) / self._pivot
        plain -= approach * self._answer
        result[-1] = approach * self._scale
        return result

    def _pressure(self, solved: Array) -> Array:
        """Return the change of total pressure that belongs to (v, q)."""
        by_fluid, bent = solved.reshape(2, -1)
        return self._yields * by_fluid - self._resisted * bent
