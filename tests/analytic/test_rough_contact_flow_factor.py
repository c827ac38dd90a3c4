"""Pressure flow factors against exact effective conductances and published trends."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.core import InputError
from underfoot.rough_contact.flow_factor import flow_factors
from underfoot.surface import self_affine


def grid(n):
    return 2 * np.pi * (np.arange(n) + 0.5) / n


def test_smooth_gap_gives_one():
    factors = flow_factors(np.full((16, 24), 3e-6), 1e-6)
    assert factors.along == pytest.approx(1.0, rel=1e-12)
    assert factors.across == pytest.approx(1.0, rel=1e-12)
    assert factors.coupling == 0.0
    assert factors.mean_gap == pytest.approx(3e-6)


def test_grooves_give_harmonic_and_arithmetic_means_of_second_order():
    a = 0.6
    # <(1 + a cos x)^-3> and <(1 + a cos x)^3>, exact
    harmonic = (1 - a**2) ** 2.5 / (1 + a**2 / 2)
    arithmetic = 1 + 1.5 * a**2
    errors = []
    for n in (32, 64, 128):
        gap = np.repeat((1 + a * np.cos(grid(n)))[:, None], 8, axis=1)
        factors = flow_factors(gap)
        assert factors.across == pytest.approx(arithmetic, rel=20 / n**2)
        errors.append(abs(factors.along / harmonic - 1))
    assert errors[-1] < 1e-3
    assert np.log2(errors[0] / errors[1]) > 1.9
    assert np.log2(errors[1] / errors[2]) > 1.9


@pytest.mark.parametrize("strength", [0.5, 2.0, 5.0])
def test_two_dimensional_cell_with_exact_conductance(strength):
    """g^3 = exp(A cos x cos y): shifting by half a wave inverts it, so Keller's (1964) and
    Dykhne's (1971) reciprocal theorem gives the effective g^3 = 1 exactly."""
    errors = []
    for n in (32, 64):
        gap = np.exp(strength / 3 * np.cos(grid(n))[:, None] * np.cos(grid(n))[None, :])
        factors = flow_factors(gap)
        errors.append(abs(factors.mean * factors.mean_gap**3 - 1))
        assert factors.along == pytest.approx(factors.across, rel=1e-10)
    assert errors[1] < 2e-3
    assert errors[1] < errors[0] / 3.5 + 1e-12


def test_small_roughness_lowers_isotropic_flow_by_the_square():
    """phi = 1 - (3/2) (sigma/h)^2 for isotropic roughness: Elrod (1979), second order."""
    h = self_affine(128, 1e-6, 1e-6, 0.8, 32e-6, 8e-6, seed=1).heights
    factors = flow_factors(h + 20e-6, 1e-6)
    assert (1 - factors.mean) * 20**2 == pytest.approx(1.5, rel=0.05)


@pytest.mark.parametrize(("ratio", "tolerance"), [(3.0, 0.06), (4.0, 0.03), (6.0, 0.015)])
def test_patir_cheng_isotropic_trend(ratio, tolerance):
    """1 - 0.90 exp(-0.56 h/sigma): Patir and Cheng (1978), fitted to their coarse-grid runs."""
    values = []
    for seed in range(3):
        h = self_affine(128, 1e-6, 1e-6, 0.8, 32e-6, 12e-6, seed=seed).heights
        values.append(flow_factors(np.maximum(h + ratio * 1e-6, 0.0), 1e-6).mean)
    assert np.mean(values) == pytest.approx(1 - 0.9 * np.exp(-0.56 * ratio), rel=tolerance)


def test_what_does_not_percolate_lets_nothing_through():
    gap = np.full((32, 32), 2e-6)
    gap[10, :] = 0.0
    wall = flow_factors(gap)
    assert wall.along == 0.0
    assert wall.across > 0.5
    gap[:, 5] = 0.0
    sealed = flow_factors(gap)
    assert (sealed.along, sealed.across, sealed.coupling) == (0.0, 0.0, 0.0)
    assert flow_factors(np.zeros((8, 8))).mean == 0.0


def test_enclosed_pockets_add_nothing():
    gap = np.full((48, 48), 2e-6)
    gap[10:20, 10:20] = 0.0
    with_pocket = gap.copy()
    with_pocket[13:17, 13:17] = 2e-6
    conductance = [f.along * f.mean_gap**3 for f in map(flow_factors, (gap, with_pocket))]
    assert conductance[0] == pytest.approx(conductance[1], rel=1e-9)


def test_pocket_across_the_edge_of_the_cell():
    gap = np.zeros((32, 32))
    gap[:4, 10:20] = gap[-4:, 10:20] = 1e-6  # cut by the edge, does not wind around
    assert flow_factors(gap).mean == 0.0


def test_half_plane_channel_is_exact():
    gap = np.zeros((32, 32))
    gap[:, 8:24] = 2e-6
    factors = flow_factors(gap)
    assert factors.along * factors.mean_gap**3 == pytest.approx(0.5 * (2e-6) ** 3, rel=1e-9)
    assert factors.across == 0.0


def test_stretched_cells_follow_the_stretched_grid():
    n = 96
    x = grid(n)
    gap = 1 + 0.5 * np.cos(x)[:, None] * np.cos(x)[None, :]
    coarse = 1 + 0.5 * np.cos(grid(n // 2))[:, None] * np.cos(x)[None, :]
    square, stretched = flow_factors(gap), flow_factors(coarse, (2.0, 1.0))
    assert stretched.along == pytest.approx(square.along, rel=2e-3)
    assert stretched.across == pytest.approx(square.across, rel=2e-3)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10_000), level=st.floats(-0.5, 3.0), rows=st.integers(3, 20))
def test_bounds_scaling_and_transpose(seed, level, rows):
    rng = np.random.default_rng(seed)
    gap = np.maximum(rng.standard_normal((rows, 14)) + level, 0.0)
    factors = flow_factors(gap)
    if factors.mean_gap == 0.0:
        return
    upper = np.mean(gap**3) / factors.mean_gap**3
    for value in (factors.along, factors.across):
        assert 0.0 <= value <= upper * (1 + 1e-9)
    assert abs(factors.coupling) <= np.sqrt(factors.along * factors.across) * (1 + 1e-6) + 1e-11
    scaled = flow_factors(7e-6 * gap, 1e-6)
    assert scaled.along == pytest.approx(factors.along, rel=1e-6, abs=1e-11)
    turned = flow_factors(gap.T)
    assert turned.along == pytest.approx(factors.across, rel=1e-6, abs=1e-11)
    assert turned.across == pytest.approx(factors.along, rel=1e-6, abs=1e-11)
    assert factors.residual < 1e-9
    moved = flow_factors(np.roll(gap, (2, 5), (0, 1)))
    assert moved.along == pytest.approx(factors.along, rel=1e-6, abs=1e-11)
    assert moved.coupling == pytest.approx(factors.coupling, rel=1e-6, abs=1e-9)


def test_bad_gaps_are_refused():
    with pytest.raises(InputError, match="not finite"):
        flow_factors(np.full((4, 4), np.nan))
    with pytest.raises(InputError, match="smallest gap"):
        flow_factors(np.where(np.eye(5) > 0, -1e-6, 1e-6))
    with pytest.raises(InputError, match="shape"):
        flow_factors(np.ones(7))
