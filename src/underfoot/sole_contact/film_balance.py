"""Mass balance of the film under the sole in one Newton iterate, and its linearisation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from underfoot.core.arrays import Array, Mask
from underfoot.film import Cavity, FilmOperator, Pattern, film_operator, upwinding

from .problem import Problem

SMALLEST_GAP = 2e-7  # m; the flow sees no thinner film (the pressure law does)


@dataclass(frozen=True)
class Linearisation:
    """Coupled problem at one iterate, linear in total pressure and gap; (size,), (5, size).

    full cell:       (A dp_f + T dtheta + B dh) / diagonal,   dp_f = dp + kappa dh
    other cells:     dp + kappa dh
    cavitated cell:  dtheta such that A dp_f + T dtheta + B dh = 0
    """

    pattern: Pattern
    stiffness: Array  # kappa = -dP/dh, Pa/m
    full: Mask
    film: FilmRows | None = None  # None where no cell holds film

    @cached_property
    def _matrices(self):
        assert self.film is not None
        film, pattern = self.film, self.pattern
        by_fields = pattern.pair.matrix(np.concatenate([film.by_pressure, film.by_gap]))
        return by_fields, pattern.matrix(film.by_fraction)

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
    """Mass balance of one iterate on the numbered cells: (size,), stencils (5, size)."""

    full: Mask
    imbalance: Array  # m^3/s
    diagonal: Array  # condensed, m^3/(Pa s)
    by_pressure: Array
    by_fraction: Array
    by_gap: Array
    fraction: Array  # (nx, ny)
    cavity: Cavity
    error: float  # sum of imbalances over what the walls carry and the gaps store


class FilmBalance:
    """Mass balance of the film in one time step.

    ``film`` marks the cells that the pool reaches, ``content`` (m) is the liquid they hold at the
    start, when the gap is ``gap``. A step that ``leaps`` to what comes after a change takes the
    flow at its end: with the mean over the step (``Problem.conductance``) steps longer than the
    memory of the film swing about the steady state.
    """

    def __init__(
        self,
        problem: Problem,
        pattern: Pattern,
        film: Mask,
        gap: Array,
        content: Array,
        duration: float,
        leaps: bool,
    ) -> None:
        self._problem, self._pattern, self._film = problem, pattern, film
        self._content = content
        self._storage = problem.spacing**2 / duration * problem.cut.film_area
        self._area = pattern.gather(problem.cut.film_area)
        self._areas = pattern.neighbours_of(self._area, 1.0)
        self._wet = pattern.gather(film)
        self._give = pattern.gather(problem.compliance.self_compliance)
        # upwinding from the gap at the start of the step: it stays out of the Newton matrix
        start = np.clip(gap, SMALLEST_GAP, problem.largest_gap)
        self._before = None if leaps else start
        carried = 0.5 * abs(problem.wall_speed) * problem.spacing
        self._lean = upwinding(
            start,
            carried * problem.compliance.self_compliance,
            problem.conductance(start).value,
            from_a=problem.wall_speed < 0,
        )

    def rows(
        self, gap: Array, fluid: Array, stiffness: Array, full: Mask, faint: float
    ) -> FilmRows:
        """Return the balance at a gap (nx, ny) and a fluid pressure (size,), Pa above the cavities.

        ``fluid`` is load per area of a whole cell, as are the columns by pressure. Which cells are
        full is judged on the balance of those that were, ``full``.
        """
        pattern, wet, give = self._pattern, self._wet, self._give
        problem = self._problem
        bounded = np.clip(gap, SMALLEST_GAP, problem.largest_gap)
        conductance = problem.conductance(bounded, self._before)
        operator = film_operator(
            bounded,
            conductance,
            conductance,
            spacing=(problem.spacing, problem.spacing),
            speed=0.5 * problem.wall_speed,
            storage=self._storage,
            upwinding=self._lean,
            edges=(problem.cut.along[:-1], problem.cut.across[:, :-1]),
        )
        by_pressure = pattern.rows_of(operator.by_pressure)
        by_pressure /= self._areas
        by_fraction = pattern.rows_of(operator.by_fraction)

        before = full
        pressure, fraction, net, cavity = self._balance(operator, by_fraction, fluid, before)
        by_gap = pattern.gather(operator.by_gap(pressure, fraction)[0])
        diagonal = by_pressure[0] * (1 + stiffness * give) + np.abs(by_gap) * give
        lacks = by_fraction[0] * (1 - pattern.gather(fraction))
        # at rest nothing flows and nothing is pressed: such a cell counts as full
        full = wet & (fluid - (net + lacks) / diagonal >= -faint)
        if (full != before).any():
            pressure, fraction, net, cavity = self._balance(operator, by_fraction, fluid, full)
        # where the gap is clipped the film does not follow the walls
        free = pattern.neighbours_of(pattern.gather(bounded == gap))
        overfull = by_fraction[0] * np.maximum(pattern.gather(fraction) - 1, 0.0)
        through = operator.carried(fraction)
        carried = np.zeros_like(gap)
        carried[:-1] += through
        carried[1:] -= through
        stored = self._storage * np.abs(operator.gap * fraction - self._content)
        wrong = np.where(full, np.abs(net), np.where(wet, overfull, 0.0)).sum()
        return FilmRows(
            full,
            net,
            diagonal,
            by_pressure,
            by_fraction,
            free * pattern.rows_of(operator.by_gap(pressure, fraction)),
            fraction,
            cavity,
            float(wrong) / (float((np.abs(carried) + stored)[self._film].sum()) + 1e-30),
        )

    def _balance(
        self, operator: FilmOperator, by_fraction: Array, fluid: Array, full: Mask
    ) -> tuple[Array, Array, Array, Cavity]:
        """Return pressure and liquid fraction (nx, ny), imbalance (size,) and cavity of a set."""
        pattern, floor = self._pattern, self._problem.settings.cavity_pressure
        empty = self._wet & ~full
        cavity = Cavity(pattern, by_fraction, empty)
        pressure = pattern.scatter(full * (fluid / self._area) + floor * self._wet)
        fraction = 1.0 - pattern.scatter(empty)
        net = pattern.gather(operator.imbalance(pressure, fraction, self._content))
        filled = cavity.filled_by(-net)
        fraction += pattern.scatter(filled)
        # linear in the fraction
        net += (by_fraction * pattern.neighbours_of(np.minimum(filled, 1.0))).sum(axis=0)
        return pressure, fraction, net, cavity
