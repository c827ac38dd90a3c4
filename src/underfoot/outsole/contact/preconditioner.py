"""Sparse stand-in for the dense contact Jacobian: the elastic symbol as a sum of screened poles.

With C(k) ~ w + sum_j g_j / (b_j^2 + k^2), each pole is a field q_j with (b_j^2 - lap) q_j = g_j dp,
so the Jacobian Jp dp + Jh (C dp - d) becomes a sparse block system in (dp, q_1, q_2), factorised
directly, with the approach d as a border. GMRES iterations then do not grow with the grid.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.optimize import minimize, nnls

from underfoot.core import ConvergenceError
from underfoot.film import Factorization, Pattern, factorization

from ..compliance import Compliance

Array = NDArray[np.float64]
POLES = 2


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
        found, misfit = nnls(scaled / size, np.ones_like(k))
        return found / size, misfit

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
    """Layout of the block system on one set of cells; filled and factorised at each Newton step."""

    def __init__(self, pattern: Pattern, fit: PoleFit, scale: float, spacing: float) -> None:
        """``scale`` is a typical self compliance (m/Pa): the unit of q_j and of the approach."""
        size = pattern.size
        self.pattern = pattern
        self.scale = scale
        self.local = fit.local
        blocks = 1 + len(fit.strengths)
        laplacian = np.zeros((5, size))
        laplacian[0] = 4.0
        laplacian[1:] = -1.0
        rows, columns = [], []
        constant: list[Array] = []
        for block in range(blocks):
            rows.append(pattern.rows)
            columns.append(pattern.indices.astype(np.int64) + block * size)
        for index, (strength, screening) in enumerate(
            zip(fit.strengths, fit.screenings, strict=True), start=1
        ):
            operator = laplacian.copy()
            operator[0] += (screening * spacing) ** 2
            rows.append(pattern.rows + index * size)
            columns.append(pattern.indices.astype(np.int64) + index * size)
            constant.append(pattern.data(operator))
            rows.append(np.arange(size) + index * size)
            columns.append(np.arange(size))
            constant.append(np.full(size, -strength * spacing**2 / scale))
        row = np.concatenate(rows)
        column = np.concatenate(columns)
        self._order = np.lexsort((column, row))
        self._indices = column[self._order].astype(np.int32)
        total = blocks * size
        self._indptr = np.searchsorted(row[self._order], np.arange(total + 1)).astype(np.int32)
        self._constant = np.concatenate(constant)
        self._poles = blocks - 1
        self._total = total
        self._factors: Factorization | None = None

    def factorise(
        self, by_pressure: Array, by_deflection: Array, backend: str | None
    ) -> BorderedSolve:
        """Return the solver for these (5, size) Jacobian coefficients."""
        pattern = self.pattern
        size = pattern.size
        direct = pattern.data(by_pressure + by_deflection * self.local)
        through = pattern.data(by_deflection * self.scale)
        data = np.concatenate([direct, *([through] * self._poles), self._constant])
        matrix = sp.csr_matrix(
            (data[self._order], self._indices, self._indptr), shape=(self._total, self._total)
        )
        if self._factors is None:
            self._factors = factorization(matrix, backend)
        else:
            self._factors.factorise(matrix)
        column = np.zeros(self._total)
        column[:size] = -np.bincount(pattern.rows, weights=through, minlength=size)
        return BorderedSolve(self._factors, self._factors.solve(column), size, self.scale)


class BorderedSolve:
    """Solve of the block system bordered by the approach (column) and the load (row)."""

    def __init__(self, factors: Factorization, answer: Array, size: int, scale: float) -> None:
        self._factors = factors
        self._answer = answer
        self._size = size
        self._scale = scale
        self._pivot = float(answer[:size].mean())
        if self._pivot == 0.0 or not np.isfinite(self._pivot):
            raise ConvergenceError("the load does not depend on the approach", where="outsole")

    def __call__(self, right: Array) -> Array:
        """Return the pressure change of the cells and the change of the approach."""
        full = np.zeros(self._answer.size)
        full[: self._size] = right[:-1]
        plain = self._factors.solve(full)[: self._size]
        approach = (float(plain.mean()) - float(right[-1])) / self._pivot
        result = np.empty(self._size + 1)
        result[:-1] = plain - approach * self._answer[: self._size]
        result[-1] = approach * self._scale
        return result
