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
from underfoot.film.face_operator import FaceMatrix, Faces
from underfoot.film.operator import SparseLayout

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

    def __init__(self, faces: Faces, fit: PoleFit, scale: float, width: Array) -> None:
        size = faces.size
        self.faces, self.width = faces, width
        self.scale = scale
        self.local = fit.local
        self.source = fit.strength * faces.spacing**2 / scale  # of q, over dp
        screened = (fit.screening * faces.spacing) ** 2
        # beside the cells the field goes on as it decays along a line
        decayed = math.sqrt(screened + screened**2 / 4) - screened / 2
        inner = (faces.ahead < size) & (faces.behind < size)
        link = np.concatenate([1 / faces.distance, faces.overlap])
        length = np.concatenate([np.ones(faces.west.size), faces.overlap])
        diagonal = np.zeros(faces.count)
        rim = np.zeros(faces.count)
        for cells in (faces.ahead, faces.behind):
            diagonal += np.bincount(cells, inner * link, faces.count)
            rim += np.bincount(cells, inner * length, faces.count)
        around = np.zeros(faces.count)
        around[:size] = 2 + 2 * width - rim[:size]
        diagonal += np.maximum(around, 0.0) * decayed
        diagonal[:size] += screened * width
        self._screened = FaceMatrix(faces, diagonal, -link, -link)
        # rows of v (by v, by q) and of q (by q, by v), as ``factorise`` fills them
        rows, columns = faces.layout
        rows = np.minimum(rows, size - 1)
        numbers = np.arange(size)
        self._layout = SparseLayout(
            np.concatenate([rows, rows, rows + size, numbers + size]),
            np.concatenate(
                [
                    columns,
                    np.where(columns < 0, -1, columns + size),
                    np.where(columns < 0, -1, columns + size),
                    numbers,
                ]
            ),
            (2 * size, 2 * size),
        )
        self._factors: Factorization | None = None

    def factorise(self, linear: Linearisation, backend: str | None) -> BorderedSolve:
        """Return the solver for a linearised problem."""
        faces, size = self.faces, self.faces.size

        def pad_values(values: Array) -> Array:
            field = np.zeros(faces.count)
            field[:size] = values
            return field

        full, film = linear.full, linear.film
        yields = 1 / (1 + linear.stiffness * self.local)
        resisted = linear.stiffness * yields * self.scale
        source = self.source * yields * self.width
        none = np.zeros(faces.ahead.size)
        balance = FaceMatrix(faces, pad_values(np.ones(size)), none, none)  # a dry cell: v = 0
        through = FaceMatrix(faces, np.zeros(faces.count), none, none)
        rows = np.zeros(size)
        if film is not None:
            cavity, wet = film.cavity.cells, full.copy()
            wet[cavity] = True
            # fraction in units of pressure: so that both kinds of column have the size of A
            diagonal, unit = film.by_fraction.diagonal[cavity], np.zeros(size)
            unit[cavity] = film.by_pressure.diagonal[cavity] / np.where(diagonal > 0, diagonal, 1.0)
            mixed = film.by_pressure.columns(pad_values(full.astype(float)))
            mixed = mixed.plus(film.by_gap.columns(pad_values(self.local * yields * full)))
            mixed = mixed.plus(film.by_fraction.columns(pad_values(unit)))
            scale = np.where(wet, np.abs(mixed.diagonal[:size]), 1.0)
            held = pad_values(wet / scale)
            balance = mixed.rows(held)
            balance.diagonal[:size] += ~wet
            through = film.by_gap.columns(pad_values(self.scale * yields)).rows(held)
            rows = full * film.diagonal / scale
        screened = self._screened.coefficients
        screened[:size] += self.source * resisted * self.width
        blocks = (balance.coefficients, through.coefficients, screened, -(source * full))
        matrix = self._layout.matrix(np.concatenate(blocks))
        if self._factors is None:
            self._factors = factorization(matrix, backend)
        else:
            self._factors.factorise(matrix)
        by_field = through.matrix()
        column = -np.concatenate(
            [np.asarray(by_field.sum(axis=1)).ravel(), self.source * resisted * self.width]
        )
        return BorderedSolve(self, self._factors, full, yields, resisted, rows, by_field, column)


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
        self._bent = layout.local / layout.scale * ~full
        self._source = layout.source * self._due * layout.width
        self._width = layout.width / layout.width.sum()
        self._answer = self._pressure(factors.solve(column)) - resisted
        self._pivot = float(self._answer @ self._width)
        if self._pivot == 0.0 or not np.isfinite(self._pivot):
            raise ConvergenceError("the load does not depend on the approach", where="sole_contact")

    def __call__(self, right: Array) -> Array:
        """Return the pressure change of the cells and the change of the approach."""
        due = right[:-1]
        balance = self._rows * due - self._through @ (self._bent * due)
        solved = self._factors.solve(np.concatenate([balance, self._source * due]))
        result = np.empty_like(right)
        plain = np.add(self._pressure(solved), self._due * due, out=result[:-1])
        approach = (plain @ self._width - right[-1]) / self._pivot
        plain -= approach * self._answer
        result[-1] = approach * self._scale
        return result

    def _pressure(self, solved: Array) -> Array:
        """Return the change of total pressure that belongs to (v, q)."""
        by_fluid, bent = solved.reshape(2, -1)
        return self._yields * by_fluid - self._resisted * bent
