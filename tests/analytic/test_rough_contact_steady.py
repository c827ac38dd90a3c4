"""Steady sliding against closed forms."""

import math

import numpy as np
import pytest

from underfoot.core import Status
from underfoot.material import RelaxationSpectrum
from underfoot.reference import (
    bonded_layer_compliance,
    hertz_point,
    hertz_point_pressure,
    sinusoid_contact_fraction,
    sinusoid_full_contact_pressure,
    sinusoid_gap,
    sinusoid_mean_gap,
    sinusoid_pressure,
    sliding_checkerboard_cof,
    sliding_sinusoid_cof,
)
from underfoot.rough_contact import SlidingSettings, steady_sliding

TIGHT = SlidingSettings(tolerance=1e-8)

LENGTH = 0.4e-3
BROAD = RelaxationSpectrum(1e6, [4e5] * 6, 10.0 ** -np.arange(1.0, 7.0))
"""Young's modulus 1 to 3.4 MPa, one term per decade."""


def profile(nodes: int, amplitude: float, offset: float = 0.0) -> np.ndarray:
    x = (np.arange(nodes) + offset) / nodes
    return np.repeat(amplitude * np.cos(2 * np.pi * x)[:, None], 4, axis=1)


def checkerboard(nodes: int, amplitude: float) -> np.ndarray:
    c = np.cos(2 * np.pi * np.arange(nodes) / nodes)
    return amplitude * c[:, None] * c[None, :]


@pytest.mark.parametrize("speed", [0.001, 0.1, 10.0])
@pytest.mark.parametrize("poisson_ratio", [0.3, 0.5])
def test_sinusoid_in_full_contact(speed, poisson_ratio):
    amplitude, q = 2e-6, 2 * np.pi / LENGTH
    modulus = BROAD.complex_modulus(q * speed) / (1 - poisson_ratio**2)
    pressure = 0.6 * q * amplitude * abs(modulus)
    result = steady_sliding(
        profile(32, amplitude), LENGTH / 32, BROAD, speed, pressure, poisson_ratio
    )
    expected = sliding_sinusoid_cof(pressure, amplitude, LENGTH, modulus)
    assert result.full_contact
    assert result.status is Status.CONVERGED
    assert result.real_contact_fraction == 1.0
    assert result.mean_gap == 0.0
    assert result.cof_hysteresis == pytest.approx(expected, rel=1e-6)
    assert result.cof_slope == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("speed", [0.01, 1.0])
def test_checkerboard_in_full_contact(speed):
    amplitude, q = 2e-6, 2 * np.pi / LENGTH
    modulus = BROAD.complex_modulus(q * speed) / 0.75
    pressure = 0.8 * q * amplitude * abs(modulus)
    result = steady_sliding(checkerboard(32, amplitude), LENGTH / 32, BROAD, speed, pressure)
    expected = sliding_checkerboard_cof(pressure, amplitude, LENGTH, modulus)
    assert result.full_contact
    assert result.cof_hysteresis == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("ratio", [0.1, 0.3, 0.6, 0.9])
def test_westergaard_partial_contact(ratio):
    amplitude, young = 1e-5, 1e6
    full = sinusoid_full_contact_pressure(amplitude, LENGTH, young / 0.75)
    nodes = 2048
    result = steady_sliding(
        profile(nodes, amplitude, 0.3),
        LENGTH / nodes,
        young,
        0.0,
        ratio * full,
        settings=TIGHT,
    )
    x = (np.arange(nodes) + 0.3) / nodes * LENGTH
    expected = sinusoid_contact_fraction(ratio * full, full)
    assert result.status is Status.CONVERGED
    assert result.real_contact_fraction_corrected == pytest.approx(expected, rel=2e-3)
    mean_gap = sinusoid_mean_gap(ratio * full, amplitude, full)
    assert result.mean_gap == pytest.approx(mean_gap, rel=2e-3)
    exact = sinusoid_pressure(x, ratio * full, LENGTH, full)
    assert np.abs(result.pressure[:, 1] - exact).mean() < 2e-3 * ratio * full
    gap = sinusoid_gap(x, ratio * full, amplitude, LENGTH, full)
    assert np.abs(result.gap[:, 1] - gap).max() < 2e-3 * amplitude


def test_hertz_sphere():
    # contact radius 0.05 of the cell: neighbouring spheres change the result by less than 0.1 %
    nodes, length, radius, young = 1024, 2e-3, 5e-3, 1e6
    contact_radius = 1e-4
    force = 4.0 / 3.0 * (young / 0.75) * contact_radius**3 / radius
    x = (np.arange(nodes) - nodes / 2 + 0.3) * length / nodes
    height = -(x[:, None] ** 2 + x[None, :] ** 2) / (2 * radius)
    result = steady_sliding(height, length / nodes, young, 0.0, force / length**2)
    hertz = hertz_point(force, radius, young / 0.75)
    area = result.real_contact_fraction_corrected * length**2
    assert result.pressure.max() == pytest.approx(hertz.peak_pressure, rel=5e-3)
    assert math.sqrt(area / math.pi) == pytest.approx(hertz.half_width, rel=5e-3)
    exact = hertz_point_pressure(np.hypot(x[:, None], x[None, :]), hertz)
    assert np.abs(result.pressure - exact).sum() < 0.015 * exact.sum()


def test_elastic_sliding_has_no_friction():
    height = checkerboard(64, 1e-5) + 0.3 * np.roll(checkerboard(64, 1e-5), (5, 9), (0, 1))
    for speed in (0.0, 0.5, -0.5):
        result = steady_sliding(height, LENGTH / 64, 1e6, speed, 2e4)
        assert 0.05 < result.real_contact_fraction < 0.9
        assert abs(result.cof_hysteresis) < 1e-10


def test_zero_speed_is_the_relaxed_elastic_contact():
    height = checkerboard(64, 1e-5)
    still = steady_sliding(height, LENGTH / 64, BROAD, 0.0, 2e4)
    elastic = steady_sliding(height, LENGTH / 64, 1e6, 0.3, 2e4)
    assert still.cof_hysteresis == 0.0
    assert "relaxed" in still.notes[0]
    np.testing.assert_allclose(still.pressure, elastic.pressure, rtol=0, atol=1e-3 * 2e4)


def test_friction_turns_round_with_the_speed():
    generator = np.random.default_rng(3)
    height = checkerboard(64, 1e-5) + checkerboard(64, 4e-6)[::-1] ** 2 * 1e5
    height += np.roll(checkerboard(64, 3e-6), generator.integers(64, size=2), (0, 1))
    forward = steady_sliding(height, LENGTH / 64, BROAD, 0.1, 2e4)
    backward = steady_sliding(height[::-1], LENGTH / 64, BROAD, -0.1, 2e4)
    assert forward.cof_hysteresis > 1e-3
    assert backward.cof_hysteresis == pytest.approx(-forward.cof_hysteresis, rel=1e-4)
    assert backward.real_contact_fraction == forward.real_contact_fraction


def test_two_ways_to_the_friction_agree_on_a_fine_grid():
    result = steady_sliding(checkerboard(256, 1e-5), LENGTH / 256, BROAD, 0.1, 3e4)
    assert not result.full_contact
    assert result.cof_slope == pytest.approx(result.cof_hysteresis, rel=1e-3)


def test_report_material_gives_no_friction_and_says_why():
    # the report's rubber: G0 0.59 MPa, Ginf 0.44 MPa, one term with beta 0.025 1/s; E = 3 G
    material = RelaxationSpectrum(1.32e6, [0.45e6], [40.0])
    result = steady_sliding(checkerboard(64, 1e-5), LENGTH / 64, material, 0.1, 2e4)
    assert abs(result.cof_hysteresis) < 1e-6
    assert any("loss tangent" in note for note in result.notes)


def test_broad_material_gives_no_such_note():
    result = steady_sliding(checkerboard(64, 1e-5), LENGTH / 64, BROAD, 0.1, 2e4)
    assert result.notes == ()


@pytest.mark.parametrize("poisson_ratio", [0.3, 0.5])
def test_sinusoid_on_a_layer(poisson_ratio):
    amplitude, q, thickness = 2e-6, 2 * np.pi / LENGTH, 0.2 * LENGTH
    compliance = float(bonded_layer_compliance(q, thickness, 1e6, poisson_ratio))
    result = steady_sliding(
        profile(32, amplitude),
        LENGTH / 32,
        1e6,
        0.0,
        1.5 * amplitude / compliance,
        poisson_ratio,
        layer_thickness=thickness,
    )
    assert result.full_contact
    swing = 0.5 * np.ptp(result.pressure)
    assert swing == pytest.approx(amplitude / compliance, rel=1e-9)


def test_thick_layer_is_a_half_space():
    height = checkerboard(64, 1e-5)
    half_space = steady_sliding(height, LENGTH / 64, BROAD, 0.1, 2e4)
    layer = steady_sliding(height, LENGTH / 64, BROAD, 0.1, 2e4, layer_thickness=5 * LENGTH)
    assert layer.cof_hysteresis == pytest.approx(half_space.cof_hysteresis, rel=1e-6)
    thin = steady_sliding(height, LENGTH / 64, BROAD, 0.1, 2e4, layer_thickness=0.02 * LENGTH)
    assert thin.real_contact_fraction < 0.8 * half_space.real_contact_fraction


def test_trends_of_a_broad_spectrum():
    # real area falls with speed and with roughness, friction rises with floor roughness
    height = checkerboard(64, 1e-5)
    slow, fast = (steady_sliding(height, LENGTH / 64, BROAD, v, 2e4) for v in (0.1, 1.0))
    rough = steady_sliding(2 * height, LENGTH / 64, BROAD, 0.1, 2e4)
    assert fast.real_contact_fraction < slow.real_contact_fraction
    assert rough.real_contact_fraction < slow.real_contact_fraction
    assert rough.cof_hysteresis > slow.cof_hysteresis
