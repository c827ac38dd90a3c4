"""Steps of rough contact with a value of their own: rims, components of flow, light loads."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.rough_contact import contact_table
from underfoot.rough_contact._kernels.complementarity import _clip_pressure
from underfoot.rough_contact._kernels.periodic import boundary_length
from underfoot.rough_contact.flow_factor import FlowFactors, _cut_components, flow_factors
from underfoot.rough_contact.greenwood_williamson_1966 import (
    greenwood_williamson,
    greenwood_williamson_law,
)
from underfoot.rough_contact.persson import FRICTION_GAMMA, persson_growth, yang_persson_mean_gap
from underfoot.rough_contact.pressure_gap_law import persson_law
from underfoot.rough_contact.sliding_input import loss_reason
from underfoot.rough_contact.steady import _fraction_done
from underfoot.surface import SpectralMoments


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
    p, found, told = _clip_pressure(cast(Any, operators), pressure, np.zeros(4), 4.0, True)
    np.testing.assert_allclose(p, [2, 2, 0, 0])
    np.testing.assert_allclose(found, gap - 2)
    assert told == pytest.approx(error)


@pytest.mark.parametrize("gamma", [FRICTION_GAMMA, 0.8])
def test_each_scale_loses_less_where_it_meets_less_of_the_rubber(gamma):
    """Of what full contact loses to a wave, gamma + (1 - gamma) P^2, P the contact down to it."""
    q = np.geomspace(2e4, 2e6, 4000)

    def rubber(w):
        return 2e6 + 4e5j * (np.asarray(w) > 0)

    given = (4e3, q, 1e-8 * q**-3.6, rubber, 0.3)
    fraction, lost = (each[0] for each in persson_growth(*given, gamma=gamma))
    _, whole = (each[0] for each in persson_growth(*given, gamma=1.0))
    assert fraction[0] == 1.0
    assert fraction[-1] < 0.4  # both ends of it count
    middle = 0.5 * (fraction[1:] + fraction[:-1])
    ratio = np.diff(lost) / np.diff(whole)
    np.testing.assert_allclose(ratio, gamma + (1 - gamma) * middle**2, rtol=1e-4)


@pytest.mark.parametrize("ratio", [0.3, 0.5])
def test_a_law_of_summits_begins_at_a_hundred_thousandth_and_ends_at_five_percent(ratio):
    """Of E* times the root of m2, half the mean square of the slope; then of the contact."""
    q = np.geomspace(1e4, 1e6, 400)
    spectrum = 1e-10 * q**-3.6
    law = greenwood_williamson_law(q, spectrum, 5e6, ratio, flow_factor=lambda gap: 0.5 + 0 * gap)
    m0, m2, m4 = (
        weight * np.pi * np.trapezoid(q ** (1 + 2 * n) * spectrum, q)
        for n, weight in enumerate((2.0, 1.0, 0.75))
    )
    assert law.node_pressure.min() == pytest.approx(1e-5 * 5e6 / (1 - ratio**2) * np.sqrt(m2))
    assert law.gap.min() > 0
    np.testing.assert_array_equal(law.node_flow_factor, 0.5)
    end = law.ranges["pressure"]
    moments = SpectralMoments(m0, m2, m4, (q[0], q[-1]))
    contact = greenwood_williamson([end.high, 1.06 * end.high], moments, 5e6, ratio)
    below, above = contact.real_contact_fraction
    assert below <= 0.05 < above
    assert end.low == 0.0
    bare = greenwood_williamson_law(q, spectrum, 5e6, ratio)
    np.testing.assert_array_equal(bare.node_flow_factor, 1.0)


def test_no_gap_lets_nothing_through_and_rests_on_no_flow():
    for gap in (np.zeros((8, 6)), np.full((8, 6), 1e-9)):
        none = flow_factors(gap, closed=1e-9)
        assert none == FlowFactors(0.0, 0.0, 0.0, 0.0, 0.0)
    alone = np.zeros((8, 6))
    alone[3, 2] = 6e-6  # open, and closed all around
    assert flow_factors(alone) == FlowFactors(0.0, 0.0, 0.0, 6e-6 / 48, 0.0)


@pytest.mark.parametrize(
    ("error", "done"),
    [(10.0, 0.0), (1.0, 0.0), (1e-2, 1 / 3), (1e-3, 0.5), (1e-6, 1.0), (1e-9, 1.0), (0.0, 1.0)],
)
def test_a_search_is_done_by_the_powers_of_ten_that_are_behind_it(error, done):
    assert _fraction_done(error, 1e-6) == pytest.approx(done)


@pytest.mark.parametrize(
    ("tangents", "told"),
    [
        ({0.0: 0.0, 0.5: 0.0, 30.0: 0.0}, True),
        ({0.0: 0.0, 0.5: 0.3, 30.0: 0.0}, False),  # the slowest wave alone loses
        ({0.0: 0.0, 0.5: 0.0, 30.0: 0.3}, False),
        ({0.0: 0.0, 0.5: 0.0}, True),  # all waves slower than 1 rad/s
        ({0.0: 0.0}, False),  # nothing slides
    ],
)
def test_a_rubber_that_loses_nothing_at_any_wave_is_the_reason(tangents, told):
    w = np.array(list(tangents))
    reason = loss_reason(1e6 * (1 + 1j * np.array(list(tangents.values()))), w)
    assert bool(reason) == told


def on_finer_waves(p, *_, **__):
    """Return what finer waves leave open at a pressure (Pa): 1 um at 1 bar, half at twice that."""
    return 0.1 / np.asarray(p)


def test_points_out_of_contact_stand_off_by_their_gap_at_the_mean_pressure_of_the_contact():
    """Two columns at 1 and 3 bar, two 5 um apart: gaps of 1, 1/3 and at 2 bar 1/2 um on top."""
    pressure = np.repeat([[1e5, 3e5, 0.0, 0.0]], 6, axis=0)
    gap = np.where(pressure > 0, 7e-6, 5e-6)  # in contact it is the solver's rounding
    finer = SimpleNamespace(
        pressure=np.array([1e4, 2e5]),
        mean_gap=on_finer_waves,
        real_contact_fraction=lambda p, *_: 1e-6 * p,
        cof_hysteresis=lambda p, *_: 1e-6 * p,
        flow_factor=lambda p, *_, **__: np.ones(np.shape(p)),
    )
    contact, friction = (
        SimpleNamespace(pressure=pressure, gap=gap, cof_hysteresis=hysteresis)
        for hysteresis in (9.0, 0.5)
    )
    part = SimpleNamespace(finer=finer, speed=0.1, spacing=1e-6)
    area, hysteresis, mean, along, across = contact_table._averages(
        cast(Any, contact), cast(Any, friction), cast(Any, part)
    )
    gaps = np.array([1.0, 1 / 3, 5.5, 5.5])
    assert area == pytest.approx(0.1)
    # above 2 bar in full contact: 0.1 of 1 bar and 0.2 of 2 bar, over the 4 bar that are carried
    assert hysteresis == pytest.approx(0.5 + (0.1 * 1 + 0.2 * 2) / 4)
    assert mean == pytest.approx(1e-6 * gaps.mean())
    assert along == pytest.approx(np.mean(gaps**3) / gaps.mean() ** 3)
    assert across < 0.1 * along  # through the contact


@pytest.mark.parametrize("bad", [(), (0,), (1,), (0, 1)])
def test_a_node_of_a_table_needs_its_contact_and_its_friction(monkeypatch, bad):
    """Whichever of both didn't converge, the node is a hole with the larger error."""

    def solved(k, error):
        status = SimpleNamespace(usable=k not in bad)
        return SimpleNamespace(
            status=status, complementarity_error=error, breaches=(), negligible_loss=""
        )

    monkeypatch.setattr(contact_table, "_averages", lambda *_: [1.0, 2.0, 3.0, 4.0, 5.0])
    part = SimpleNamespace(pressure=np.array([1e5]))
    column = contact_table._average_part(
        cast(Any, part), iter([cast(Any, solved(0, 1e-3))]), iter([cast(Any, solved(1, 2e-3))])
    )
    values = np.array([column[name][0] for name in contact_table.QUANTITIES])
    np.testing.assert_array_equal(values, [np.nan] * 5 if bad else [1, 2, 3, 4, 5])
    assert column["error"] == [2e-3]
