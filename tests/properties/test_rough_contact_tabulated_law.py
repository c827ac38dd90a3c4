"""The tabulated pressure-gap law: smooth, monotone, and what it must be to be a law."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.core import InputError, ValidityRange
from underfoot.rough_contact import ExponentialLaw, PressureGapLaw
from underfoot.rough_contact._kernels.monotone import interpolated_grid
from underfoot.rough_contact.pressure_gap_law import TabulatedLaw

GAP = np.array([1e-6, 2e-6, 3.5e-6, 6e-6, 9e-6])


def law(flow=(0.0, 0.02, 0.2, 0.5, 0.7), gap=GAP):
    exact = ExponentialLaw(2e6, 0.5, 5e-6)
    return TabulatedLaw(
        "table",
        "test",
        gap,
        exact.pressure(gap),
        np.asarray(flow, dtype=float),
        ranges={"pressure": ValidityRange(1e4, 1e6, "Pa"), "speed": ValidityRange(0.1, 1.0, "m/s")},
    )


def test_it_is_a_pressure_gap_law_and_reproduces_an_exponential():
    exact, table = ExponentialLaw(2e6, 0.5, 5e-6), law()
    assert isinstance(table, PressureGapLaw)
    gap = np.linspace(1e-6, 30e-6, 200)
    np.testing.assert_allclose(table.pressure(gap), exact.pressure(gap), rtol=1e-9)
    np.testing.assert_allclose(table.stiffness(gap), exact.stiffness(gap), rtol=1e-9)
    np.testing.assert_allclose(table.mean_gap(table.pressure(gap)), gap, rtol=1e-9)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 100_000), count=st.integers(3, 9))
def test_derivatives_are_derivatives_and_nothing_turns_back(seed, count):
    rng = np.random.default_rng(seed)
    gap = np.cumsum(rng.uniform(0.05, 2.0, count)) * 1e-6
    pressure = 1e6 * np.exp(-np.cumsum(rng.uniform(0.01, 3.0, count)))
    flow = np.sort(rng.uniform(0, 1, count)) * (rng.random(count) > 0.2).cumprod()[::-1]
    table = TabulatedLaw("t", "s", gap, pressure, np.maximum.accumulate(flow))
    g = np.linspace(-2e-6, gap[-1] * 1.5, 700)
    step = 1e-12
    for value, slope, sign in (
        (table.pressure, table.stiffness, -1.0),
        (table.flow_factor, table.flow_factor_slope, 1.0),
    ):
        difference = sign * (value(g + step) - value(g - step)) / (2 * step)
        scale = np.abs(slope(g)).max() + np.abs(value(g)).max() * 1e3
        assert np.abs(difference - slope(g)).max() < 2e-3 * scale
        assert np.all(slope(g) >= -1e-9 * scale)
    assert np.all(table.stiffness(g) > 0)
    assert np.all((table.flow_factor(g) >= 0) & (table.flow_factor(g) <= 1))
    # once differentiable at the nodes: slopes from both sides meet
    for node in gap:
        for slope in (table.stiffness, table.flow_factor_slope):
            left, right = slope(np.array([node - 1e-14, node + 1e-14]))
            assert left == pytest.approx(right, rel=1e-4, abs=1e-6 * np.abs(slope(g)).max())


def test_tails():
    table = law()
    assert table.pressure(-5e-6) > table.pressure(0.0) > table.pressure(1e-6)
    falls = np.diff(table.pressure(np.array([-3e-6, -2e-6, -1e-6])))
    assert falls[0] == pytest.approx(falls[1])  # linear tail
    assert table.flow_factor(1e-3) == pytest.approx(1.0)
    assert table.flow_factor(-1e-6) == 0.0
    open_below = law(flow=(0.1, 0.2, 0.3, 0.5, 0.7))
    assert 0.0 < open_below.flow_factor(-1e-6) < 0.1
    channels = law(flow=(1.1, 1.3, 1.5, 1.4, 1.2))  # grooves along the flow exceed 1
    assert channels.flow_factor(1e-3) == pytest.approx(1.0)


def test_ranges_are_reported():
    table = law()
    assert not table.breaches(pressure=5e5, speed=-0.5)
    found = table.breaches(pressure=[5e5, 2e6], speed=3.0)
    assert {breach.quantity for breach in found} == {"pressure", "speed"}


@pytest.mark.parametrize(
    ("gap", "flow"),
    [
        (GAP[::-1], (0, 0.1, 0.2, 0.3, 0.4)),
        (GAP[:2], (0, 0.1)),
        (GAP, (0, 0.1, np.nan, 0.3, 0.4)),
        (GAP, (-0.1, 0.1, 0.2, 0.3, 0.4)),
    ],
)
def test_bad_nodes_are_refused(gap, flow):
    with pytest.raises(InputError):
        law(flow=flow, gap=gap)


def test_grid_interpolation_is_exact_at_nodes_and_for_planes():
    x, y = np.array([0.0, 1.0, 2.5, 3.0]), np.array([-1.0, 0.0, 2.0])
    values = 2 * x[:, None] - 3 * y[None, :] + 1
    at_x, at_y = np.meshgrid(np.linspace(0, 3, 7), np.linspace(-1, 2, 5), indexing="ij")
    value, slope = interpolated_grid(x, y, values, at_x, at_y)
    np.testing.assert_allclose(value, 2 * at_x - 3 * at_y + 1, atol=1e-12)
    np.testing.assert_allclose(slope, 2.0, atol=1e-12)
    rough = np.random.default_rng(1).standard_normal((4, 3))
    nodes_x, nodes_y = np.meshgrid(x, y, indexing="ij")
    np.testing.assert_allclose(interpolated_grid(x, y, rough, nodes_x, nodes_y)[0], rough)
    column, _ = interpolated_grid(x, y[:1], rough[:, :1], x, np.zeros(4))
    np.testing.assert_allclose(column, rough[:, 0])
