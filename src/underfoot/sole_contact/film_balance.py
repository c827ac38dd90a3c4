"""Mass balance of the film under the sole in one Newton iterate, and its linearisation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from underfoot.core.arrays import Array, Mask
from underfoot.film.face_operator import (
    FaceMatrix,
    FaceOperator,
    Faces,
    Inlet,
    RowCavity,
    face_operator,
)
from underfoot.film.operator import Upwinding

from .problem import Problem

SMALLEST_GAP = 2e-7  # m; the flow sees no thinner film (the pressure law does)
HELD = 1e-3  # of the liquid in the film, which counts as moved in a step even where nothing moves


@dataclass(frozen=True)
class Linearisation:
    """Coupled problem at one iterate, linear in total pressure and gap; (size,).

    full cell:       (A dp_f + T dtheta + B dh) / diagonal,   dp_f = dp + kappa dh
    other cells:     dp + kappa dh
    cavitated cell:  dtheta such that A dp_f + T dtheta + B dh = 0
    """

    faces: Faces
    stiffness: Array  # kappa = -dP/dh, Pa/m
    full: Mask
    film: FilmRows | None = None  # None where no cell holds film

    @cached_property
    def _matrices(self):
        assert self.film is not None
        film = self.film
        by_fields = self.faces.pair.matrix(
            np.concatenate([film.by_pressure.coefficients, film.by_gap.coefficients])
        )
        return by_fields, film.by_fraction.matrix()

    def residual(self, pressure: Array, gap: Array) -> Array:
        """Return what the rows become by a change of total pressure (Pa) and of gap (m)."""
        fluid = pressure + self.stiffness * gap
        if self.film is None:
            return fluid
        by_fields, by_fraction = self._matrices
        net = by_fields @ np.concatenate([self.full * fluid, gap])
        net += by_fraction @ self.film.cavity.filled_by(-net)
        return np.where(self.full, net / self.film.diagonal, fluid)


@dataclass(frozen=True, slots=True)
class FilmRows:
    """Mass balance of one iterate: (size,) of the unknowns, matrices of all cells."""

    full: Mask
    imbalance: Array  # m^3/s
    diagonal: Array  # condensed, m^3/(Pa s)
    by_pressure: FaceMatrix
    by_fraction: FaceMatrix
    by_gap: FaceMatrix
    fraction: Array  # (cells,)
    cavity: RowCavity
    error: float  # sum of imbalances over what the walls carry and the gaps store


class FilmBalance:
    """Mass balance of the film in one time step.

    ``film`` marks the cells that the pool reaches, ``content`` (m) is the liquid they hold at the
    start, when the gap is ``gap``. A step that ``leaps`` to what comes after a change takes the
    flow at its end: with the mean over the step (``Problem.conductance``) steps longer than the
    memory of the film swing about the steady state. ``upstream`` is how far faces lean.
    """

    def __init__(
        self,
        problem: Problem,
        faces: Faces,
        film: Mask,
        gap: Array,
        content: Array,
        duration: float,
        leaps: bool,
        upstream: Upwinding,
        inlet: Inlet | None = None,
    ) -> None:
        self._problem, self._faces, self._film = problem, faces, film
        self._content = content
        self._storage = problem.spacing**2 / duration * problem.cells.film_area
        self._share = problem.film_share
        self._wet = film[: faces.size]
        self._give = problem.compliance.self_compliance[: faces.size]
        self._before = None if leaps else gap
        self._upstream, self._inlet = upstream, inlet

    def rows(
        self, gap: Array, fluid: Array, stiffness: Array, full: Mask, faint: float, stuck: bool
    ) -> FilmRows:
        """Return the balance at a gap (cells,) and a fluid pressure (size,), Pa above the cavities.

        ``fluid`` is load per area of a cell, as are the columns by pressure. Which cells are full
        is judged on the balance of those that were, ``full``. Where Newton is ``stuck``, gaps that
        are pressed shut count as fixed, as the flow sees them.
        """
        faces, wet, give, problem = self._faces, self._wet, self._give, self._problem
        size = faces.size
        operator = face_operator(
            faces,
            gap,
            problem.conductance,
            before=self._before,
            limits=(SMALLEST_GAP, problem.largest_gap),
            speed=0.5 * problem.wall_speed,
            storage=self._storage,
            upstream=self._upstream,
            inlet=self._inlet,
        )
        by_pressure = operator.by_pressure.columns(1 / self._share)
        by_fraction = operator.by_fraction

        before = full
        pressure, fraction, net, cavity = self._balance(operator, fluid, before)
        by_gap = operator.by_gap(pressure, fraction)
        diagonal = by_pressure.diagonal[:size] * (1 + stiffness * give)
        shut = (gap[:size] < SMALLEST_GAP) & stuck
        diagonal += np.abs(by_gap.diagonal[:size]) * give * ~shut
        lacks = by_fraction.diagonal[:size] * (1 - fraction[:size])
        # at rest nothing flows and nothing is pressed: such a cell counts as full
        full = wet & (fluid - (net + lacks) / diagonal >= -faint)
        if (full != before).any():
            pressure, fraction, net, cavity = self._balance(operator, fluid, full)
            by_gap = operator.by_gap(pressure, fraction)
        overfull = by_fraction.diagonal[:size] * np.maximum(fraction[:size] - 1, 0.0)
        through = operator.wall_transport(fraction)
        carried = np.bincount(faces.west, through, faces.count)
        carried -= np.bincount(faces.east, through, faces.count)
        stored = self._storage * np.abs(operator.gap * fraction - self._content)
        wrong = np.where(full, np.abs(net), np.where(wet, overfull, 0.0)).sum()
        held = HELD * self._storage * self._content
        moved = float((np.abs(carried) + stored + held)[self._film].sum()) + 1e-30
        # a gap that is pressed shut can open again: rows that did not know had no solution; but
        # where it stays shut, rows that wait for it to open creep
        moves = gap <= problem.largest_gap
        moves[:size] &= (gap[:size] >= SMALLEST_GAP) | (not stuck)
        by_gap = by_gap.columns(moves.astype(np.float64))
        return FilmRows(
            full,
            net,
            diagonal,
            by_pressure,
            by_fraction,
            by_gap,
            fraction,
            cavity,
            float(wrong) / moved,
        )

    def _balance(
        self, operator: FaceOperator, fluid: Array, full: Mask
    ) -> tuple[Array, Array, Array, RowCavity]:
        """Return pressure and liquid fraction (cells,), imbalance (size,), cavity of a set."""
        size, floor = self._faces.size, self._problem.settings.cavity_pressure
        by_fraction = operator.by_fraction
        empty = self._wet & ~full
        cavity = RowCavity(by_fraction, empty)
        pressure, fraction = np.zeros((2, self._faces.count))
        pressure[:size] = full * (fluid / self._share[:size]) + floor * self._wet
        fraction += 1.0
        fraction[:size] -= empty
        net = operator.imbalance(pressure, fraction, self._content)[:size]
        filled = cavity.filled_by(-net)
        fraction[:size] += filled
        # linear in the fraction
        return pressure, fraction, net + by_fraction.matrix() @ np.minimum(filled, 1.0), cavity
