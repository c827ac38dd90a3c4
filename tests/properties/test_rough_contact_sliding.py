"""What holds for any surface."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from underfoot.core import Status
from underfoot.material import RelaxationSpectrum
from underfoot.rough_contact import SlidingSettings, steady_sliding

TIGHT = SlidingSettings(tolerance=1e-8)

MATERIAL = RelaxationSpectrum(1e6, [5e5] * 5, [1e-1, 1e-2, 1e-3, 1e-4, 1e-5])
SPACING = 1e-5


def surface(seed: int, shape: tuple[int, int], exponent: float, skew: float) -> np.ndarray:
    """Return random heights of 1 um rms, from white noise to smooth, peaks sharpened by skew."""
    generator = np.random.default_rng(seed)
    q = np.hypot(np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])[None, :])
    q[0, 0] = np.inf
    h = np.fft.irfft2(np.fft.rfft2(generator.standard_normal(shape)) * q**-exponent, s=shape)
    h /= h.std()
    h = np.exp(skew * h)
    return 1e-6 * (h - h.mean()) / h.std()


surfaces = st.builds(
    surface,
    st.integers(0, 2**32 - 1),
    st.sampled_from([(8, 8), (16, 12), (33, 20), (32, 32), (64, 32), (7, 9), (64, 4)]),
    st.floats(0.0, 3.0),
    st.sampled_from([-1.0, -0.1, 0.1, 1.0]),
)
speeds = st.sampled_from([0.0, 1e-3, 0.1, -0.1, 5.0])
pressures = st.floats(3.0, 6.0).map(lambda power: 10.0**power)


@settings(deadline=None, max_examples=120)
@given(surfaces, speeds, pressures)
def test_contact_conditions_hold_or_it_says_that_it_failed(height, speed, pressure):
    result = steady_sliding(height, SPACING, MATERIAL, speed, pressure)
    assert result.pressure.min() >= 0.0
    assert result.gap.min() >= 0.0
    assert not np.any(result.pressure * result.gap)
    assert result.pressure.mean() == pytest.approx(pressure, rel=1e-12)
    assert np.isfinite(result.cof_hysteresis)
    assert result.cof_hysteresis * speed >= 0.0
    if result.status is Status.NOT_CONVERGED:
        assert any("not a result" in note for note in result.notes)
        return
    assert result.complementarity_error <= 1e-6
    # the gap belongs to the pressure: displacement by the compliance, one free constant
    qx = 2 * np.pi * np.fft.fftfreq(height.shape[0], SPACING)[:, None]
    qy = 2 * np.pi * np.fft.fftfreq(height.shape[1], SPACING)[None, :]
    q = np.hypot(qx, qy)
    q[0, 0] = 1.0
    modulus = MATERIAL.complex_modulus(qx * speed) / 0.75
    if height.shape[0] % 2 == 0:
        row = height.shape[0] // 2
        modulus[row] = 1.0 / (1.0 / modulus[row]).real
    spectrum = np.fft.fft2(result.pressure) * 2.0 / (q * modulus)
    spectrum[0, 0] = 0.0
    gap = np.fft.ifft2(spectrum).real - height
    gap -= np.average(gap, weights=result.pressure)
    assert np.abs(gap - result.gap).max() < 3e-6 * height.std() + 1e-12 * np.abs(height).max()


@settings(deadline=None, max_examples=25)
@given(surfaces, speeds, pressures, st.floats(0.1, 10.0), st.floats(0.1, 10.0))
@example(surface(258804, (8, 8), 0.375, 0.1), 0.0, 1235.0, 1.0, 5.9)  # two nodes in contact
@example(surface(272, (8, 8), 0.0, 0.1), 1e-3, 1000.0, 1.0, 1.0)  # an empty active set
def test_scaling_of_height_pressure_and_modulus(height, speed, pressure, tall, stiff):
    one = steady_sliding(height, SPACING, MATERIAL, speed, pressure, settings=TIGHT)
    stiffer = MATERIAL.scale_moduli(stiff)
    other = steady_sliding(
        tall * height,
        SPACING,
        stiffer,
        speed,
        tall * stiff * pressure,
        settings=TIGHT,
    )
    if not (one.status.usable and other.status.usable):
        return
    scale = pressure / max(one.real_contact_fraction, 1e-3)
    np.testing.assert_allclose(other.pressure / (tall * stiff), one.pressure, atol=1e-3 * scale)
    assert other.mean_gap / tall == pytest.approx(one.mean_gap, abs=1e-4 * height.std())
    assert other.cof_hysteresis / tall == pytest.approx(one.cof_hysteresis, rel=1e-3, abs=1e-9)


@settings(deadline=None, max_examples=25)
@given(surfaces, speeds, pressures, st.integers(0, 63), st.integers(0, 63))
def test_moving_the_surface_changes_nothing(height, speed, pressure, i, j):
    one = steady_sliding(height, SPACING, MATERIAL, speed, pressure)
    other = steady_sliding(np.roll(height, (i, j), (0, 1)), SPACING, MATERIAL, speed, pressure)
    if one.status.usable and other.status.usable:
        assert other.mean_gap == pytest.approx(one.mean_gap, abs=1e-4 * height.std())
        assert other.cof_hysteresis == pytest.approx(one.cof_hysteresis, rel=1e-3, abs=1e-9)


@settings(deadline=None, max_examples=20)
@given(surfaces, speeds, pressures)
def test_more_load_means_more_contact_and_less_gap(height, speed, pressure):
    one = steady_sliding(height, SPACING, MATERIAL, 0.0 * speed, pressure)
    more = steady_sliding(height, SPACING, MATERIAL, 0.0 * speed, 1.5 * pressure)
    if one.status.usable and more.status.usable:
        assert more.real_contact_fraction >= one.real_contact_fraction
        assert more.mean_gap <= one.mean_gap * (1 + 1e-5) + 1e-5 * height.std()
