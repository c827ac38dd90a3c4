"""Film under a soft worn heel as a plane strip: where cells along the sliding lead.

A facet 30 mm long that lies flat, an inlet of 10 deg, rubber of 5.3 MPa, 7.6 N/mm, 219 mPa s at 0.7
m/s. Cells let in too little film, never too much, and less and less so at first order.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from underfoot.rough_contact.pressure_gap_law import ExponentialLaw
from underfoot.shoe.row_division import row_cells
from underfoot.sole_contact import stepping
from underfoot.sole_contact.compliance import half_space_compliance
from underfoot.sole_contact.row_compliance import RowCompliance
from underfoot.sole_contact.sole_state import SolverSettings
from underfoot.sole_contact.solver import solve_sliding
from underfoot.studies.validation import _strip

MODULUS, POISSON, WIDTH = 5.3e6, 0.5, 0.066
LOAD = 500 / WIDTH  # N/m
LAW = ExponentialLaw(0.75 * 6.635e6, POISSON, 11.16e-6)


def plane_strain(compliance, cells, _land):
    """Return the deflection of a half-plane under each cell: exact for even pressure (Flamant)."""
    x = (cells.parent // cells.shape[1] + cells.offset) * cells.spacing
    half = 0.5 * cells.width * cells.spacing
    away = x[None, :] - x[:, None]

    def integral(t):
        return t * np.log(np.maximum(np.abs(t), 1e-30) / WIDTH) - t

    plane = MODULUS / (1 - POISSON**2)
    give = -2 / (math.pi * plane) * (integral(away + half) - integral(away - half))
    give *= cells.land[:, None] * cells.land[None, :]
    own = np.maximum(give.diagonal(), 1e-3 * give.max())
    squares = cells.shape[0] * cells.shape[1]
    numbers = np.arange(cells.size)
    none = sp.csr_matrix((np.zeros(cells.size), (cells.parent, numbers)), (squares, cells.size))
    return RowCompliance(compliance, cells.shape, none, none.T.tocsr(), sp.csr_matrix(give), own)


def strip(spacing, columns, corner=30e-3):
    """Return the strip at rest in its film."""
    square, fine = (_strip(corner, math.tan(math.radians(10)), spacing, n) for n in (1, columns))
    none, empty = np.zeros(0, dtype=np.intp), np.zeros(0)
    cells = replace(row_cells(square, fine), south=none, north=none, overlap=empty, crossing=empty)
    elastic = {"modulus": MODULUS, "poisson_ratio": POISSON}
    solved = solve_sliding(
        replace(square, cells=cells),
        half_space_compliance(cells.shape, spacing, **elastic),
        LAW,
        viscosity=0.219,
        speed=0.7,
        normal_force=spacing * LOAD,
        settings=SolverSettings(end_time=None),
    )
    assert solved.status.usable
    return solved


def share(*given):
    """Return the share of the load on the film."""
    solved = strip(*given)
    return solved.fluid_load / solved.normal_force


@pytest.fixture(autouse=True)
def _plane(monkeypatch):
    monkeypatch.setattr(stepping, "row_compliance", plane_strain)


@pytest.mark.slow
def test_the_film_converges_from_below_at_first_order():
    shares = np.array([share(0.6e-3, columns) for columns in (16, 32, 64, 128)])
    gained = np.diff(shares)
    assert np.all(gained > 0)
    np.testing.assert_array_less(gained[1:], 0.65 * gained[:-1])
    limit = shares[-1] + gained[-1]
    assert share(0.3e-3, 64) == pytest.approx(limit, rel=0.02)
    assert shares[0] == pytest.approx(limit, rel=0.10)  # the cells of a run by default


def test_the_place_of_the_corner_on_the_cells_does_not_matter():
    spacing = 1e-3
    shares = [share(spacing, 16, 30e-3 + part * spacing) for part in (0.0, 0.25, 0.5, 0.75)]
    assert max(shares) < 1.04 * min(shares)


def test_ruptured_film_carries_on_what_the_inlet_let_in():
    solved = strip(0.3e-3, 32)
    ruptured = solved.cavitated[:, 1] & (solved.x > 13e-3) & (solved.x < 26e-3)
    assert ruptured.sum() > 10
    gap = solved.film_thickness[ruptured, 1]
    assert gap.max() > 1.15 * gap.min()
    # the floor goes to -x: a cell is filled by the one east of it
    between = 2 * gap[1:-1] * gap[2:] / (gap[1:-1] + gap[2:])  # int h^-2 dx over int h^-3 dx
    passing = between * solved.liquid_fraction[ruptured, 1][2:]
    assert passing.max() < 1.02 * passing.min()
