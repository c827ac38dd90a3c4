"""What holds for every surface."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.surface import (
    HeightMap,
    Profile,
    height_numbers,
    isotropic_spectrum,
    long_waves,
    profile_from_positions,
    profile_spectrum,
    self_affine,
)

seeds = st.integers(0, 10_000)


def mean_square(spectrum):
    return float(np.sum(spectrum.density * spectrum.area))


@settings(deadline=None, max_examples=30)
@given(seeds, st.floats(1e-3, 1e3), st.floats(-1e3, 1e3))
def test_numbers_scale_with_the_heights_and_ignore_the_level(seed, factor, level):
    z = np.random.default_rng(seed).standard_normal(200)
    one, other = height_numbers(z), height_numbers(factor * z + level)
    for name in ("ra", "rq", "rp", "rv", "rt"):
        assert getattr(other, name) == pytest.approx(
            factor * getattr(one, name), rel=1e-6, abs=1e-9
        )
    assert other.rsk == pytest.approx(one.rsk, rel=1e-4, abs=1e-4)
    assert one.ra <= one.rq <= max(one.rp, one.rv)
    assert one.rku >= 1.0 + one.rsk**2 - 1e-12


@settings(deadline=None, max_examples=30)
@given(seeds, st.sampled_from(["drop", "regression", "periodic"]), st.floats(4.0, 40.0))
def test_the_filter_is_linear_and_keeps_constants(seed, ends, cutoff):
    a, b = np.random.default_rng(seed).standard_normal((2, 150))
    f, g, both, level = (
        long_waves(Profile(z, 1.0, periodic=True), cutoff, ends).heights
        for z in (a, b, 2 * a - 3 * b, np.full(150, 7.0))
    )
    np.testing.assert_allclose(both, 2 * f - 3 * g, atol=1e-10)
    np.testing.assert_allclose(level, 7.0, rtol=1e-12)
    assert np.abs(f).max() <= 3 * np.abs(a).max()


@settings(deadline=None, max_examples=20)
@given(seeds, st.integers(8, 40), st.integers(8, 40), st.floats(1e-7, 1e-3))
def test_parseval_on_any_grid(seed, nx, ny, spacing):
    z = np.random.default_rng(seed).standard_normal((nx, ny))
    z -= z.mean()
    found = isotropic_spectrum(HeightMap(z, spacing, periodic=True))
    assert mean_square(found) == pytest.approx(np.mean(z**2), rel=1e-10)
    line = Profile(z[:, 0], spacing, periodic=True)
    assert mean_square(profile_spectrum(line)) == pytest.approx(z[:, 0].var(), rel=1e-10)


@settings(deadline=None, max_examples=20)
@given(seeds, st.floats(0.0, 1.0), st.floats(0.3, 3.0))
def test_generated_surfaces_are_repeatable_and_exact(seed, hurst, stretch):
    settings_ = (64, 1e-6, 2e-6, hurst, 64e-6, 4e-6, seed)
    one = self_affine(*settings_, anisotropy=stretch)
    np.testing.assert_array_equal(one.heights, self_affine(*settings_, anisotropy=stretch).heights)
    assert one.rms_height == pytest.approx(2e-6, rel=1e-10)
    assert abs(one.heights.mean()) < 1e-18
    if stretch > 1.5:  # ridges along x: flatter along x than across
        dx, dy = (np.diff(one.heights, axis=k).std() for k in (0, 1))
        assert dx < dy


@settings(deadline=None, max_examples=20)
@given(seeds, st.floats(1e-7, 1e-4), st.integers(2, 300))
def test_rounded_positions_count_as_even(seed, spacing, n):
    digit = 0.3 * spacing
    x = np.round(spacing * np.arange(n) / digit) * digit
    found = profile_from_positions(x, np.zeros(n), rounding=0.51 * digit + 0.02 * spacing)
    assert found.spacing == pytest.approx(spacing, rel=0.35 / (n - 1) + 1e-9)
