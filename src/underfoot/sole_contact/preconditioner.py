"""Sparse stand-in for the dense contact Jacobian: the elastic symbol as a sum of screened poles.

With C(k) ~ w + sum_j g_j / (b_j^2 + k^2), each pole is a field q_j with (b_j^2 - lap) q_j = g_j dp,
so the linearised problem becomes a sparse block system in (v, q_1, q_2), factorised directly, with
the approach as a border. GMRES iterations then do not grow with the grid.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.optimize import minimize, nnls

from underfoot.core import ConvergenceError
from underfoot.core.arrays import Array
from underfoot.core.sparse import Factorization, factorization
from underfoot.film import Pattern

from .compliance import Compliance
from .film_balance import Linearisation

POLES = 1


@dataclass(frozen=True, slots=True)
class PoleFit:
    """C(k) ~ local + sum strength / (screening^2 + k^2)."""

    local: float  # m/Pa
    strengths: tuple[float, ...]  # 1/(Pa m)
    screenings: tuple[float, ...]  # 1/m
    error: float  # largest relative error on the fitted range


def pole_fit(compliance: Compliance, longest: float, spacing: float) -> PoleFit:
    """Return the screened poles that fit the symbol between ``longest`` wave (m) and the grid's."""
    k = np.geomspace(2 * np.pi / longest, np.pi / spacing, 60)
    target = compliance.symbol(k)

    def weights(log_screening: Array) -> tuple[Array, float]:
        columns = 1 / (np.exp(log_screening)[None, :] ** 2 + k[:, None] ** 2)
        scaled = np.column_stack([columns, np.ones_like(k)]) / target[:, None]
        size = np.linalg.norm(scaled, axis=0)
        weight, misfit = nnls(scaled / size, np.ones_like(k))
        return weight / size, misfit

    start = np.log(np.geomspace(k[0] * 3, k[-1] / 5, POLES))
    best = minimize(
        lambda value: weights(value)[1],
        start,
        method="Nelder-Mead",
        options={"xatol": 1e-2, "fatol": 1e-4},
    )
    strengths, _ = weights(best.x)
    screenings = np.exp(best.x)
    fitted = (strengths[:-1] / (screenings**2 + k[:, None] ** 2)).sum(axis=1) + strengths[-1]
    return PoleFit(
        float(strengths[-1]),
        tuple(float(value) for value in strengths[:-1]),
        tuple(float(value) for value in screenings),
        float(np.abs(fitted / target - 1).max()),
    )


class Preconditioner:
    """Layout of the block system on one set of cells; filled and factorised at each Newton step.

    Unknowns of a cell: v, the change of fluid pressure where it is full or of liquid fraction where
    it is cavitated (in units of pressure), and q_1, q_2, the fields of the poles in units of
    ``scale`` s, a typical self compliance (m/Pa). Gap and total pressure are eliminated cell by
    cell: with kappa the stiffness of the asperities, w the local part of the compliance, delta the
    change of approach over s, e the change of
    fluid pressure that is due where a cell is not full,

        dh = (w (chi v + e) + s (q_1 + q_2 - delta)) / (1 + kappa w),  chi = 1 where full, else 0
        dp = chi v + e - kappa dh
    """

    def __init__(self, pattern: Pattern, fit: PoleFit, scale: float, spacing: float) -> None:
        size = pattern.size
        self.pattern = pattern
        self.scale = scale
        self.local = fit.local
        self.poles = len(fit.strengths)
        self.source = np.array(fit.strengths) * spacing**2 / scale  # of q, over dp
        diagonal = np.arange(size)
        laplacian = np.full((5, size), -1.0)
        laplacian[0] = 4.0
        # blocks of (v, q_1, q_2) rows, in the order of ``factorise``
        blocks = [(0, column, None) for column in range(self.poles + 1)]
        rows = [pattern.rows for _ in blocks]
        columns = [pattern.indices.astype(np.int64) + column * size for _, column, _ in blocks]
        self._screened = []
        for row, screening in enumerate(fit.screenings, start=1):
            operator = laplacian.copy()
            operator[0] += (screening * spacing) ** 2
            self._screened.append(operator)
            rows.append(pattern.rows + row * size)
            columns.append(pattern.indices.astype(np.int64) + row * size)
            for column in range(self.poles + 1):
                if column != row:
                    rows.append(diagonal + row * size)
                    columns.append(diagonal + column * size)
        row, column = np.concatenate(rows), np.concatenate(columns)
        self._total = (self.poles + 1) * size
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
        data = [pattern.data(balance)]
        through = pattern.data(by_gap * self.scale)
        data += [through] * self.poles
        resisted = linear.stiffness * yields * self.scale
        for row in range(1, self.poles + 1):
            source = self.source[row - 1]
            operator = self._screened[row - 1].copy()
            operator[0] += source * resisted
            data.append(pattern.data(operator))
            data.append(-source * yields * full)
            data += [source * resisted] * (self.poles - 1)
        values = np.concatenate(data)[self._order]
        matrix = sp.csr_matrix((values, self._indices, self._indptr), (self._total,) * 2)
        if self._factors is None:
            self._factors = factorization(matrix, backend)
        else:
            self._factors.factorise(matrix)
        by_unfilled = pattern.matrix(by_gap * self.local)
        column = np.concatenate(
            [-np.bincount(pattern.rows, weights=through, minlength=size).astype(np.float64)]
            + [-source * resisted for source in self.source]
        )
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
        sources = [source * self._yields * unfilled for source in self._layout.source]
        plain = self._pressure(self._factors.solve(np.concatenate([balance, *sources])), unfilled)
        approach = (float(plain.mean()) - float(right[-1])) / self._pivot
        result = np.empty(right.size)
        result[:-1] = plain - approach * self._answer
        result[-1] = approach * self._layout.scale
        return result

    def _pressure(self, solved: Array, unfilled: Array | float) -> Array:
        """Return the change of total pressure that belongs to (v, q_1, q_2)."""
        parts = solved.reshape(self._layout.poles + 1, -1)
        fluid = np.where(self._full, parts[0], 0.0) + unfilled
        return self._yields * fluid - self._resisted * parts[1:].sum(axis=0)
