"""Order of convergence of rough contact, and steadiness of its cost."""

import numpy as np
import pytest

from underfoot.material import RelaxationSpectrum
from underfoot.reference import sinusoid_full_contact_pressure, sinusoid_mean_gap
from underfoot.rough_contact import SlidingSettings, steady_sliding

TIGHT = SlidingSettings(tolerance=1e-9)

LENGTH, AMPLITUDE = 1e-3, 1e-5
FULL = sinusoid_full_contact_pressure(AMPLITUDE, LENGTH, 1e6 / 0.75)


def profile(nodes: int, offset: float) -> np.ndarray:
    x = (np.arange(nodes) + offset) / nodes
    return np.repeat(AMPLITUDE * np.cos(2 * np.pi * x)[:, None], 4, axis=1)


def order(nodes, errors) -> float:
    return -float(np.polyfit(np.log(nodes), np.log(errors), 1)[0])


def test_mean_gap_is_second_order():
    # the error depends on where the grid falls on the contact edge (a sawtooth), so it is the rms
    # over positions and loads that has an order; the plain area is of first order only
    generator = np.random.default_rng(0)
    nodes = [16, 32, 64, 128, 256, 512]
    errors = []
    for n in nodes:
        squares = []
        for _ in range(24):
            pressure = generator.uniform(0.1, 0.8) * FULL
            height = profile(n, generator.random())
            result = steady_sliding(height, LENGTH / n, 1e6, 0.0, pressure, settings=TIGHT)
            exact = sinusoid_mean_gap(pressure, AMPLITUDE, FULL)
            squares.append((result.mean_gap / exact - 1) ** 2)
        errors.append(np.sqrt(np.mean(squares)))
    assert errors[-1] < 1e-4
    assert order(nodes, errors) > 1.9


def test_friction_is_second_order():
    material = RelaxationSpectrum(1e6, [1e6], [1e-3])
    generator = np.random.default_rng(1)
    pressure = 0.3 * FULL
    fine = [
        steady_sliding(
            profile(4096, s),
            LENGTH / 4096,
            material,
            0.1,
            pressure,
            settings=TIGHT,
        )
        for s in (0.0, 0.4)
    ]
    exact = np.mean([r.cof_slope for r in fine])
    nodes = [32, 64, 128, 256, 512]
    errors = []
    for n in nodes:
        runs = [
            steady_sliding(
                profile(n, s),
                LENGTH / n,
                material,
                0.1,
                pressure,
                settings=TIGHT,
            ).cof_slope
            for s in generator.random(16)
        ]
        errors.append(np.sqrt(np.mean((np.array(runs) / exact - 1) ** 2)))
    assert fine[0].cof_hysteresis == pytest.approx(exact, rel=1e-5)
    assert order(nodes, errors) > 1.9


def self_affine(n: int) -> np.ndarray:
    q = np.hypot(np.fft.fftfreq(n, 1 / n)[:, None], np.fft.rfftfreq(n, 1 / n)[None, :])
    band = (q >= 4) & (q <= n / 8)
    amplitude = np.where(band, np.where(band, q, 1.0) ** -1.8, 0.0)
    noise = np.fft.rfft2(np.random.default_rng(1).standard_normal((n, n)))
    h = np.fft.irfft2(noise * amplitude, s=(n, n))
    slope = np.hypot(*(np.gradient(h, 1 / n))).std()
    return 0.2 * h / slope


@pytest.mark.parametrize("speed", [0.0, 100.0])
def test_products_grow_slowly_with_the_grid(speed):
    # the cost is counted in FFT products with the fine grid's operator; with n the number of
    # nodes they grow slower than n^(1/4), on surfaces that gain roughness with the grid
    material = RelaxationSpectrum(1.0, 0.3 * np.ones(8), 10.0 ** -np.arange(8.0))
    counts = []
    sides = [64, 128, 256, 512]
    for n in sides:
        result = steady_sliding(self_affine(n), 1 / n, material, speed, 0.02)
        assert result.complementarity_error <= 1e-6
        counts.append(result.operator_applications)
    assert -order(np.square(sides), counts) < 0.25
