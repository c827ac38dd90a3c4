"""One rough contact, told in other ways: the numbers stay, turn round or scale with it."""

import numpy as np
import pytest

from underfoot.material import RelaxationSpectrum
from underfoot.rough_contact import SlidingSettings, flow_factors, steady_sliding

TIMES = np.array([1e-1, 1e-2, 1e-3, 1e-4])
RUBBER = RelaxationSpectrum(1e6, [5e5] * 4, TIMES)
SPACING = (1e-5, 1.5e-5)
SPEED, PRESSURE = 0.1, 1e5


def heights(shape=(48, 64), seed=3):
    """Return heights of waves of eight points and more, 3 um rms."""
    generator = np.random.default_rng(seed)
    spectrum = np.fft.rfft2(generator.standard_normal(shape))
    q = np.hypot(np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])[None, :])
    spectrum[q > 1 / 8] = 0.0
    h = np.fft.irfft2(spectrum, s=shape)
    return 3e-6 * h / h.std()


def numbers(height, spacing=SPACING, rubber=RUBBER, speed=SPEED, pressure=PRESSURE, **given):
    settings = SlidingSettings(tolerance=1e-8)
    made = steady_sliding(height, spacing, rubber, speed, pressure, settings=settings, **given)
    assert made.complementarity_error <= 1e-8
    fraction = made.real_contact_fraction_corrected
    return np.array([fraction, made.cof_hysteresis, 1e6 * made.mean_gap, made.rms_slope])


@pytest.fixture(scope="module")
def plain():
    made = numbers(heights())
    assert 0.05 < made[0] < 0.9
    assert made[1] > 0.01
    return made


@pytest.mark.parametrize("times", [(2, 1), (1, 2), (2, 3)])
def test_a_surface_laid_side_by_side_is_the_same_surface(plain, times):
    np.testing.assert_allclose(numbers(np.tile(heights(), times)), plain, rtol=1e-6)


def test_left_and_right_are_alike(plain):
    np.testing.assert_allclose(numbers(heights()[:, ::-1]), plain, rtol=1e-6)


def test_a_surface_turned_round_slides_backward(plain):
    turned = numbers(heights()[::-1, ::-1], speed=-SPEED)
    np.testing.assert_allclose(turned, plain * [1, -1, 1, 1], rtol=1e-6)


def test_lengths_in_another_unit(plain):
    bigger = numbers(7 * heights(), (7 * SPACING[0], 7 * SPACING[1]), speed=7 * SPEED)
    np.testing.assert_allclose(bigger, plain * [1, 1, 7, 1], rtol=1e-6)


def test_time_in_another_unit(plain):
    slower = RelaxationSpectrum(1e6, [5e5] * 4, 60 * TIMES)
    np.testing.assert_allclose(
        numbers(heights(), rubber=slower, speed=SPEED / 60), plain, rtol=1e-6
    )


def test_force_in_another_unit(plain):
    stiffer = numbers(heights(), rubber=RUBBER.scale_moduli(9.81), pressure=9.81 * PRESSURE)
    np.testing.assert_allclose(stiffer, plain, rtol=1e-6)


def test_a_base_level_changes_nothing(plain):
    np.testing.assert_allclose(numbers(heights() + 1e-3), plain, rtol=1e-6)


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.3])
def test_a_compressible_half_space_is_a_softer_one(plain, poisson_ratio):
    softer = RUBBER.scale_moduli((1 - poisson_ratio**2) / 0.75)
    made = numbers(heights(), rubber=softer, poisson_ratio=poisson_ratio)
    np.testing.assert_allclose(made, plain, rtol=1e-6)


def test_flow_of_a_gap_turned_a_quarter_changes_its_directions():
    gap = np.maximum(heights() + 4e-6, 0.0)
    one, turned = flow_factors(gap, SPACING), flow_factors(gap.T.copy(), SPACING[::-1])
    assert (turned.along, turned.across) == pytest.approx((one.across, one.along), rel=1e-9)
    assert turned.coupling == pytest.approx(one.coupling, rel=1e-6, abs=1e-12)
    assert one.along != pytest.approx(one.across, rel=1e-3)


@pytest.mark.parametrize("change", ["tiled", "moved", "in mm", "mirrored"])
def test_flow_of_one_gap_told_in_other_ways(change):
    gap = np.maximum(heights() + 4e-6, 0.0)
    one = flow_factors(gap, SPACING)
    other, spacing, length, sign = gap, SPACING, 1.0, 1.0
    if change == "tiled":
        other = np.tile(gap, (2, 2))
    elif change == "moved":
        other = np.roll(gap, (5, 9), (0, 1))
    elif change == "in mm":
        other, spacing, length = 1e3 * gap, (1e3 * SPACING[0], 1e3 * SPACING[1]), 1e3
    else:
        other, sign = gap[:, ::-1], -1.0
    made = flow_factors(other, spacing)
    assert (made.along, made.across) == pytest.approx((one.along, one.across), rel=1e-9)
    assert made.coupling == pytest.approx(sign * one.coupling, rel=1e-6, abs=1e-12)
    assert made.mean_gap == pytest.approx(length * one.mean_gap, rel=1e-12)
