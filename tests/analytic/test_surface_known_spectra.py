"""Spectra whose law is known: what is fitted, inverted and cut along lines is that law."""

import numpy as np
import pytest

from underfoot.surface import HeightMap, IsotropicSpectrum, ProfileSpectrum, isotropic_from_profile
from underfoot.surface.lay import lines_across
from underfoot.surface.scan import height_cautions, unlikely_height
from underfoot.surface.spectrum import power_law

HURST, STEP = 0.7, 2 * np.pi / 4e-3
RINGS = STEP * np.arange(1, 257)


def drawn(kind, seed, turn=0.0):
    """Return a spectrum of random waves: flat up to ``turn`` (rad/m), self-affine above."""
    power = 1 + 2 * HURST if kind is ProfileSpectrum else 2 + 2 * HURST
    mean = np.maximum(RINGS, turn) ** -power
    density = mean * np.random.default_rng(seed).exponential(size=RINGS.size)
    reliable = (float(RINGS[0]), float(RINGS[-1]))
    if kind is ProfileSpectrum:
        return ProfileSpectrum(RINGS, density, reliable)
    return IsotropicSpectrum(RINGS, density, 2 * np.pi * RINGS * STEP, reliable)


@pytest.mark.parametrize("kind", [ProfileSpectrum, IsotropicSpectrum])
def test_the_error_of_a_hurst_exponent_is_that_of_repeated_surfaces(kind):
    shown = drawn(IsotropicSpectrum, 0)
    fits = [power_law(drawn(kind, seed), shown)[0] for seed in range(300)]
    values = np.array([one.value for one in fits])
    errors = np.array([one.uncertainty for one in fits])
    assert values.mean() == pytest.approx(HURST, abs=3 * values.std() / np.sqrt(300) + 0.01)
    held = np.mean(np.abs(values - HURST) < 1.96 * errors)
    assert 0.89 < held < 0.985  # 95 % less what few rings cost; a half or double error is outside


@pytest.mark.parametrize("kind", [ProfileSpectrum, IsotropicSpectrum])
def test_a_roll_off_is_found_where_the_waves_begin_to_fall(kind):
    turn = RINGS[11]
    found = [power_law(drawn(kind, seed, turn), drawn(IsotropicSpectrum, 0)) for seed in range(40)]
    lengths = np.array([roll_off for _, roll_off, _ in found], dtype=float)
    assert np.median(lengths) == pytest.approx(2 * np.pi / turn, rel=0.25)
    assert np.median([hurst.value for hurst, *_ in found]) == pytest.approx(HURST, abs=0.05)


@pytest.mark.parametrize("power", [1.6, 3.4])
def test_waves_beyond_the_last_fall_as_the_last_half_decade_does(power):
    """Of q^-1.4 that turns steeper at the last half decade, C(q) there is that of the steeper."""
    from scipy.special import gamma

    q = np.geomspace(1e3, 1e6, 2000)
    turn = 1e6 / np.sqrt(10)
    c = np.where(q < turn, (q / turn) ** -1.4, (q / turn) ** -power)
    found = isotropic_from_profile(ProfileSpectrum(q, c, (1e3, 1e6)))
    end = found.wavenumber > 1.3 * turn
    hurst = (power - 1) / 2
    exact = (
        (found.wavenumber / turn) ** -(power + 1)
        * gamma(hurst + 1)
        / (np.sqrt(np.pi) * gamma(hurst + 0.5) * turn)
    )
    np.testing.assert_allclose(found.density[end], exact[end], rtol=0.05)


def test_the_mean_square_of_a_profile_stays_with_the_waves_of_its_surface():
    """A profile's waves around q come from the surface's waves at and above q, none below."""
    q = np.geomspace(1e3, 1e6, 2000)
    profile = ProfileSpectrum(q, q**-2.4, (1e3, 1e6))
    found = isotropic_from_profile(profile)
    at = np.array([3e3, 1e4, 3e4])
    k = np.linspace(0, 1, 20001)[1:] ** 3 * 9e5  # along y
    log_q, log_c = np.log(found.wavenumber), np.log(found.density)
    again = [
        2 * np.trapezoid(np.exp(np.interp(np.log(np.hypot(one, k)), log_q, log_c)), k) for one in at
    ]
    np.testing.assert_allclose(again, at**-2.4, rtol=0.03)


@pytest.mark.parametrize("degrees", [20, 45, 70, 130])
def test_lines_across_a_slanted_lay_lie_inside_the_map(degrees):
    """On a plane every line is straight from end to end; none is a short one of a corner."""
    across = np.radians(degrees)
    x, y = np.meshgrid(2e-6 * np.arange(80), 3e-6 * np.arange(60), indexing="ij")
    plane = HeightMap(0.2 * x - 0.1 * y, 2e-6, spacing_y=3e-6)
    lines = lines_across(plane, across, 7)
    assert len(lines) == 7
    rise = 0.2 * np.cos(across) - 0.1 * np.sin(across)
    for line in lines:
        slope = np.diff(line.heights) / line.spacing
        np.testing.assert_allclose(slope, rise, atol=0.03)  # the spline bends at the map's rim
    longest = min(158e-6 / abs(np.cos(across)), 177e-6 / abs(np.sin(across)))
    for line in lines:
        assert 0.65 * longest < (line.heights.size - 1) * line.spacing <= longest


@pytest.mark.parametrize(
    ("rq", "said"),
    [(10e-9, "no floor"), (90e-9, ""), (5e-6, ""), (0.2e-3, ""), (0.02, "no roughness")],
)
def test_only_heights_that_no_floor_has_are_asked_about(rq, said):
    assert said in unlikely_height(rq)
    assert bool(unlikely_height(rq)) == bool(said)
    assert len(height_cautions(rq)) == bool(said)
