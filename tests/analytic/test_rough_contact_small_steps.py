"""Steps of rough contact with a value of their own: rims, components of flow, light loads."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.rough_contact._kernels.complementarity import _clipped
from underfoot.rough_contact._kernels.periodic import boundary_length
from underfoot.rough_contact.flow_factor import _cut_components
from underfoot.rough_contact.persson import yang_persson_mean_gap
from underfoot.rough_contact.pressure_gap_law import persson_law


def test_the_rim_of_a_contact_is_its_sides_also_over_the_edge_of_the_cell():
    contact = np.zeros((10, 12), bool)
    contact[2:5, 4:9] = True  # 3 by 5 nodes
    dx, dy = 2.0, 0.5
    rim = 2 * 5 * dy + 2 * 3 * dx
    assert boundary_length(contact, (dx, dy), np) == rim
    moved = np.roll(contact, (6, 6), (0, 1))
    assert boundary_length(moved, (dx, dy), np) == rim
    assert boundary_length(~contact, (dx, dy), np) == rim
    two = contact | np.roll(contact, 5, 0)  # as large a one, two nodes further
    assert boundary_length(two, (dx, dy), np) == 2 * rim
    assert boundary_length(np.ones((4, 4), bool), (dx, dy), np) == 0.0


def test_a_component_is_cut_where_it_goes_over_the_edge_of_the_cell():
    """Cells 0 to 11 of 3 rows by 4: faces from a cell to its next along rows and columns."""
    label = np.array([0, 1, 1, 0, 2, 1, 1, 3, 2, 4, 4, 3])
    cell = np.array([3, 1, 5, 8, 9, 7])
    neighbour = np.array([0, 2, 6, 4, 10, 11])  # 3 to 0 is over the edge of a row
    cut = _cut_components(label, cell, neighbour, (3, 4))
    assert cut.tolist() == (label == 0).tolist()
    over = _cut_components(label, np.array([8]), np.array([0]), (3, 4))  # from the last row
    assert over.tolist() == (label == 2).tolist()


def test_at_light_loads_the_gap_falls_as_the_logarithm_of_the_pressure():
    """Persson 2007: p = beta E* exp(-u / u0), so that each factor of two closes the same gap."""
    q = np.geomspace(1e3, 1e6, 200)
    spectrum = 1e-8 * q**-3.6
    pressure = 0.25 * 2.0 ** np.arange(6)
    gap = yang_persson_mean_gap(pressure, q, spectrum, 5e6, 0.5)
    np.testing.assert_allclose(np.diff(gap), np.diff(gap)[0], rtol=0.01)
    assert np.all(np.diff(gap) < 0)
    # of pressure over modulus alone
    np.testing.assert_allclose(
        yang_persson_mean_gap(2 * pressure, q, spectrum, 1e7, 0.5), gap, rtol=1e-9
    )
    for bad in (0.0, -1.0, np.nan):
        with pytest.raises(InputError, match="positive"):
            yang_persson_mean_gap([1e5, bad], q, spectrum, 5e6, 0.5)


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.5])
def test_the_law_of_a_gap_holds_for_shares_of_the_pressure_that_flattens_the_surface(ratio):
    """1e-4 to 0.5 of E* h', with <h'^2> = 2 pi int q^3 C dq = 2 pi c [q^0.4 / 0.4]."""
    q = np.geomspace(1e3, 1e6, 400)
    law = persson_law(q, 1e-8 * q**-3.6, 5e6, ratio)
    slope = np.sqrt(2 * np.pi * 1e-8 * (1e6**0.4 - 1e3**0.4) / 0.4)
    full = 5e6 / (1 - ratio**2) * slope
    ends = law.ranges["pressure"]
    assert (ends.low, ends.high) == pytest.approx((1e-4 * full, 0.5 * full), rel=1e-3)
    assert law.pressure(law.gap) == pytest.approx(law.node_pressure)
    assert (law.node_pressure.min(), law.node_pressure.max()) == pytest.approx(
        (ends.low, ends.high)
    )


@pytest.mark.parametrize(("outside", "error"), [(-7.0, 9.0), (9.0, 1.0)])
def test_a_search_that_ends_early_tells_how_deep_nodes_lie_in_each_other(outside, error):
    """Pressures of 1, 1, 0 and -1 carry 4: 2 at two nodes, whose gaps of 1 and 3 lie about 2."""
    gap = np.array([1.0, 3.0, 5.0, outside])
    operators = SimpleNamespace(xp=np, exact_displacement=lambda pressure: gap.copy())
    pressure = np.array([1.0, 1.0, 0.0, -1.0])
    p, found, told = _clipped(cast(Any, operators), pressure, np.zeros(4), 4.0, True)
    np.testing.assert_allclose(p, [2, 2, 0, 0])
    np.testing.assert_allclose(found, gap - 2)
    assert told == pytest.approx(error)
