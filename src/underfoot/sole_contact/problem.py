"""What is solved at one instant under the sole, and a solution of it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from underfoot.core.arrays import Array, Mask
from underfoot.film import Conductance
from underfoot.rough_contact.pressure_gap_law import PressureGapLaw
from underfoot.shoe.row_cells import Indices, RowCells

from .row_compliance import RowCompliance
from .sole_state import SolverSettings

_SAME_HEIGHT = 1e-9  # m
_SAME = 1e-6


@dataclass(frozen=True)
class Problem:
    """What does not change during a run; SI, arrays (n,) of cells.

    Pressures here and in ``State`` are loads of cells per area of the cell: where an outline cuts
    it, that of the contact is ``contact_share`` times the pressure at its centre, that of the fluid
    ``film_share`` times. ``SoleState`` has the pressures.
    """

    cells: RowCells
    clearance: Array
    compliance: RowCompliance
    law: PressureGapLaw
    viscosity: float | None
    wall_speed: float
    largest_gap: float
    decay: float  # m, gap over which the asperity pressure falls by about e
    settings: SolverSettings
    drained: Mask | None = None  # cells with a slit that is a way out: no film, but contact
    mirror: Indices | None = None  # the cell across of each, where sole and body are symmetric

    @property
    def spacing(self) -> float:
        """Side of a square cell, m."""
        return self.cells.spacing

    @cached_property
    def contact_share(self) -> Array:
        """Share of each cell on which the contact presses."""
        return self.cells.area / self.cells.width

    @cached_property
    def film_share(self) -> Array:
        """Share of each cell on which the fluid presses."""
        return self.cells.film_area / self.cells.width

    def load(self, pressure: Array) -> float:
        """Return the load (N) of a pressure field."""
        return float(pressure @ self.cells.width) * self.spacing**2

    def gap(self, pressure: Array, approach: float) -> Array:
        """Return the mean gap of a pressure field and an approach."""
        return self.clearance - approach + self.compliance.apply(pressure)

    def symmetric(self, values: Array) -> Array:
        """Return the mean of values and their mirror image; as they are where no mirror is."""
        return values if self.mirror is None else 0.5 * (values + values[self.mirror])

    def conductance(self, gap: Array, before: Array | None = None) -> Conductance:
        """Return what lets the fluid flow between rough walls at a gap, or as a mean over a step.

        With the gap ``before`` a time step (m) its mean with ``gap``, that at the end of it,

            m = 2 h_0^2 h^2 / (h_0 + h)   in place of h^3

        makes a step exact, however long, for a plate that a constant pressure squeezes (Stefan
        1874: 1 / h^2 grows evenly). The cube at the end of a long step lets too little out.
        """
        assert self.viscosity is not None
        factor, slope = self.law.flow_factor(gap), self.law.flow_factor_slope(gap)
        if self.settings.film is not None:
            film = self.settings.film.flow_factor(gap, abs(self.wall_speed))
            factor, slope = factor * film.value, slope * film.value + factor * film.slope
        if before is None:
            square = gap * gap / (12 * self.viscosity)
            return Conductance(factor * gap * square, (3 * factor + slope * gap) * square)
        both = before + gap
        mean = (before * gap) ** 2 / (6 * self.viscosity * both)
        by_gap = mean * (2 * before + gap) / (gap * both)
        return Conductance(factor * mean, factor * by_gap + slope * mean)


@dataclass(slots=True)
class State:
    """A solved instant; loads of cells as ``Problem`` says."""

    pressure: Array  # total, Pa
    approach: float  # m
    gap: Array  # m, not clipped
    fluid: Array  # Pa
    contact: Array  # Pa
    cavitated: Mask
    fraction: Array  # share of the gap that holds liquid, 1 outside the film


def mirror_across(problem: Problem) -> Indices | None:
    """Return the mirror image of each cell across the sliding; None where the sole is none.

    Measured: heights, areas and what deflects under a random pressure are those of the image.
    """
    cells, (_, ny) = problem.cells, problem.cells.shape
    i, j = np.divmod(cells.parent, ny)
    place = np.round(cells.offset, 9)
    image = np.empty(cells.size, dtype=np.intp)
    image[np.lexsort((place, j, i))] = np.lexsort((place, ny - 1 - j, i))
    where = np.stack([i, j, place, cells.land])
    there = np.stack([i, ny - 1 - j, place, cells.land])
    if not np.array_equal(where[:, image], there):
        return None
    parts = [cells.width, cells.area, cells.film_area, problem.clearance * (_SAME / _SAME_HEIGHT)]
    if problem.drained is not None:
        parts.append(problem.drained.astype(float))
    if any(np.abs(part - part[image]).max() > _SAME for part in parts):
        return None
    pressure = np.random.default_rng(0).random(cells.size) * cells.land
    risen = problem.compliance.apply(pressure)
    turned = problem.compliance.apply(pressure[image])[image]
    return image if np.abs(risen - turned).max() <= _SAME * np.abs(risen).max() else None
