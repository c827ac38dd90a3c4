"""What is solved at one instant under the sole, and a solution of it."""

from dataclasses import dataclass

from underfoot.core.arrays import Array, Mask
from underfoot.film import Conductance
from underfoot.rough_contact.pressure_gap_law import PressureGapLaw
from underfoot.shoe.cut_cells import CutCells

from .compliance import Compliance
from .sole_state import SolverSettings


@dataclass(frozen=True, slots=True)
class Problem:
    """What does not change during a run; SI, arrays (nx, ny).

    Pressures here and in ``State`` are loads of cells per area of a whole one: where an outline
    cuts the cell, that of the contact is ``cut.area`` times the pressure at its centre, that of the
    fluid ``cut.film_area`` times. ``SoleState`` has the pressures.
    """

    clearance: Array
    spacing: float
    compliance: Compliance
    law: PressureGapLaw
    viscosity: float | None
    wall_speed: float
    largest_gap: float
    decay: float  # m, gap over which the asperity pressure falls by about e
    settings: SolverSettings
    cut: CutCells
    drained: Mask | None = None  # cells with a slit that is a way out: no film, but contact

    def gap(self, pressure: Array, approach: float) -> Array:
        """Return the mean gap of a pressure field and an approach."""
        return self.clearance - approach + self.compliance.apply(pressure)

    def conductance(self, gap: Array, before: Array | None = None) -> Conductance:
        """Return what lets the fluid flow between rough walls at a gap, or as a mean over a step.

        With the gap ``before`` a time step (m) its mean with ``gap``, that at the end of it,

            m = 2 h_0^2 h^2 / (h_0 + h)   in place of h^3

        makes a step exact, however long, for a plate that a constant pressure squeezes (Stefan
        1874: 1 / h^2 grows evenly). The cube at the end of a long step lets too little out.
        """
        assert self.viscosity is not None
        factor, slope = self.law.flow_factor(gap), self.law.flow_factor_slope(gap)
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
