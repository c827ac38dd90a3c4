"""The march in time against closed forms and against steady sliding."""

import numpy as np
import pytest

from underfoot.block.prony_march import (
    advance_memory,
    known_displacement,
    prony_step,
    relaxed_memory,
)
from underfoot.core import Cancelled, Status
from underfoot.material import RelaxationSpectrum
from underfoot.reference import sliding_sinusoid_cof
from underfoot.rough_contact import steady_sliding
from underfoot.rough_contact._kernels.periodic import ShiftedMap
from underfoot.studies.transient import TransientSettings as Settings
from underfoot.studies.transient import transient_sliding

LENGTH = 0.4e-3
MATERIAL = RelaxationSpectrum(1e6, [6e5, 6e5, 6e5], [1e-3, 1e-4, 1e-5])


def rough(nodes: int, seed: int, rms: float) -> np.ndarray:
    q = np.hypot(
        np.fft.fftfreq(nodes, 1 / nodes)[:, None], np.fft.rfftfreq(nodes, 1 / nodes)[None, :]
    )
    band = (q >= 1) & (q <= nodes / 8)
    noise = np.fft.rfft2(np.random.default_rng(seed).standard_normal((nodes, nodes)))
    h = np.fft.irfft2(noise * np.where(band, np.where(band, q, 1.0) ** -1.8, 0.0))
    return rms * h / h.std()


@pytest.mark.parametrize("frequency_times_time", [0.1, 1.0, 10.0])
def test_sinusoid_in_full_contact(frequency_times_time):
    nodes, amplitude, q = 64, 2e-6, 2 * np.pi / LENGTH
    speed = 0.1
    material = RelaxationSpectrum(1e6, [1e6], [frequency_times_time / (q * speed)])
    height = np.repeat(amplitude * np.cos(2 * np.pi * np.arange(nodes) / nodes)[:, None], 4, axis=1)
    modulus = material.complex_modulus(q * speed) / 0.75
    pressure = 0.8 * q * amplitude * abs(modulus)
    result = transient_sliding(
        height,
        LENGTH / nodes,
        material,
        speed,
        pressure=pressure,
        settings=Settings(max_periods=12, steady_tolerance=1e-4),
    )
    expected = sliding_sinusoid_cof(pressure, amplitude, LENGTH, modulus)
    assert result.real_contact_fraction[-1] == 1.0
    assert result.cof_hysteresis == pytest.approx(expected, rel=3e-3)


def test_steady_end_of_the_march():
    height = rough(64, 1, 4e-6)
    steady = steady_sliding(height, LENGTH / 64, MATERIAL, 0.1, 3e4)
    march = transient_sliding(
        height,
        LENGTH / 64,
        MATERIAL,
        0.1,
        pressure=3e4,
        settings=Settings(steps_per_spacing=2),
    )
    assert march.steady
    assert march.status is Status.CONVERGED
    assert march.cof_hysteresis == pytest.approx(steady.cof_hysteresis, rel=2e-2)
    last = march.real_contact_fraction[-128:].mean()
    assert last == pytest.approx(steady.real_contact_fraction, rel=2e-2)
    assert march.mean_gap[-1] == pytest.approx(steady.mean_gap, rel=2e-2)
    np.testing.assert_allclose(march.pressure, 3e4, rtol=1e-5)


def test_time_step_is_second_order():
    height = rough(32, 1, 4e-6)
    exact = steady_sliding(height, LENGTH / 32, MATERIAL, 0.1, 3e4).cof_slope
    errors = [
        abs(
            transient_sliding(
                height,
                LENGTH / 32,
                MATERIAL,
                0.1,
                pressure=3e4,
                settings=Settings(steps_per_spacing=k, steady_tolerance=1e-4),
            ).cof_hysteresis
            - exact
        )
        for k in (1, 4)
    ]
    assert errors[1] < errors[0] / 10


def test_fixed_height_gives_the_load_that_fixed_load_needs():
    height = rough(32, 2, 4e-6)
    steady = steady_sliding(height, LENGTH / 32, MATERIAL, 0.1, 3e4)
    march = transient_sliding(
        height,
        LENGTH / 32,
        MATERIAL,
        0.1,
        separation=steady.mean_gap,
        settings=Settings(max_periods=6),
    )
    assert march.steady
    assert march.pressure[-64:].mean() == pytest.approx(3e4, rel=3e-2)
    # pressed on at rest, the relaxed rubber carries less at the same height
    assert march.pressure[0] < 0.9 * march.pressure[-1]


def test_no_contact_above_the_highest_peak():
    height = rough(32, 2, 4e-6)
    march = transient_sliding(
        height,
        LENGTH / 32,
        MATERIAL,
        0.1,
        separation=1.01 * np.ptp(height),
        settings=Settings(max_periods=2),
    )
    assert not march.pressure.any()
    assert not march.shear.any()
    assert np.isnan(march.cof_hysteresis)


def test_rough_shoe_swings_the_shear_but_loses_no_energy_when_elastic():
    floor, shoe = rough(32, 3, 4e-6), rough(32, 4, 4e-6)
    nearly_elastic = RelaxationSpectrum(1e6, [1.0], [1e-3])
    march = transient_sliding(
        floor,
        LENGTH / 32,
        nearly_elastic,
        0.1,
        pressure=3e4,
        shoe_height=shoe,
        settings=Settings(max_periods=3),
    )
    swing = np.abs(march.shear).max() / 3e4
    assert swing > 5e-3
    assert abs(march.cof_hysteresis) < 0.05 * swing


def test_fresh_contact_is_smaller_and_grows():
    height = rough(32, 5, 4e-6)
    runs = [
        transient_sliding(
            height,
            LENGTH / 32,
            MATERIAL,
            0.01,
            pressure=3e4,
            settings=Settings(start=start, max_periods=1),
        )
        for start in ("relaxed", "fresh")
    ]
    assert runs[1].real_contact_fraction[0] < 0.9 * runs[0].real_contact_fraction[0]


def test_cancelled_run_keeps_its_history():
    def stop(stage: str, fraction: float, residual: float | None = None) -> None:
        if fraction > 0.3:
            raise Cancelled("stop")

    march = transient_sliding(
        rough(32, 6, 4e-6),
        LENGTH / 32,
        MATERIAL,
        0.1,
        pressure=3e4,
        settings=Settings(max_periods=2),
        progress=stop,
    )
    assert march.status is Status.CANCELLED
    assert march.time.size == 38
    assert np.isfinite(march.shear).all()


def test_slow_terms_are_named_when_the_run_is_not_steady():
    slow = RelaxationSpectrum(1e6, [1e6], [1.0])
    march = transient_sliding(
        rough(32, 7, 4e-6),
        LENGTH / 32,
        slow,
        0.1,
        pressure=3e4,
        settings=Settings(max_periods=2, steady_tolerance=1e-9),
    )
    assert march.status is Status.NOT_CONVERGED
    assert "slow relaxation" in march.notes[0]


def test_march_of_a_material_point_is_exact_for_a_ramp():
    # stress of a displacement growing at unit rate: E_inf t + sum E_i tau_i (1 - exp(-t/tau_i))
    moduli, times = np.array([0.5, 0.3]), np.array([0.2, 3.0])
    start, rest = 1.0, 0.2
    fractions = moduli / start
    step = prony_step(fractions, 1.0 / times, 0.1)
    displacement = np.zeros((1, 1))
    memory = relaxed_memory(displacement, fractions)
    for n in range(1, 30):
        known = known_displacement(memory, displacement, step)
        new = np.full((1, 1), 0.1 * n)
        stress = step.stiffening * start * (new - known)
        advance_memory(memory, displacement, new, step)
        displacement = new
        t = 0.1 * n
        exact = rest * t + float(np.sum(moduli * times * (1 - np.exp(-t / times))))
        assert float(stress[0, 0]) == pytest.approx(exact, rel=1e-12)


def test_map_shifted_by_part_of_a_spacing():
    x = np.arange(32) / 32 * LENGTH
    q = 2 * np.pi * 3 / LENGTH
    shifted = ShiftedMap(np.repeat(np.cos(q * x)[:, None], 4, axis=1), LENGTH / 32)
    np.testing.assert_allclose(shifted.at(0.3e-5)[:, 2], np.cos(q * (x + 0.3e-5)), atol=1e-12)
    expected = -q * np.sin(q * (x + 0.3e-5))
    np.testing.assert_allclose(shifted.slope_at(0.3e-5)[:, 1], expected, atol=1e-9 * q)
