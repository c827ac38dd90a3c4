"""One compound, told in other ways: moduli scale, times shift, and the order says nothing."""

from dataclasses import replace

import numpy as np
import pytest

from underfoot.material import (
    DynamicSweep,
    RelaxationCurve,
    RelaxationSpectrum,
    WlfShift,
    dynamic_master_curve,
    fit_dynamic,
    fit_relaxation,
    relaxation_master_curve,
)

TIMES = np.geomspace(1e-4, 1e4, 17)
BROAD = RelaxationSpectrum(1e6, 2e6 * np.exp(-((np.log10(TIMES) + 1) ** 2) / 6), TIMES)
W = np.geomspace(1e-3, 1e5, 40)
T = np.geomspace(1e-3, 1e3, 40)
KELVIN = 273.15 + np.array([10.0, 18.0, 26.0, 34.0, 42.0])
LAW = WlfShift(8.86, 101.6, KELVIN[2])


def alike(one, other, rel=1e-9):
    np.testing.assert_allclose(other.complex_modulus(W), one.complex_modulus(W), rtol=rel)
    np.testing.assert_allclose(other.relaxation_modulus(T), one.relaxation_modulus(T), rtol=rel)


def test_the_order_of_terms_and_a_term_in_two_halves_change_nothing():
    order = np.random.default_rng(0).permutation(TIMES.size)
    alike(BROAD, RelaxationSpectrum(1e6, BROAD.term_moduli[order], TIMES[order]))
    halves = np.concatenate([BROAD.term_moduli * 0.5, BROAD.term_moduli * 0.5])
    alike(BROAD, RelaxationSpectrum(1e6, halves, np.concatenate([TIMES, TIMES])))


def test_stiffness_scales_moduli_and_temperature_shifts_times():
    hard = BROAD.scale_moduli(3.0)
    np.testing.assert_allclose(hard.complex_modulus(W), 3 * BROAD.complex_modulus(W))
    np.testing.assert_allclose(hard.loss_tangent(W), BROAD.loss_tangent(W))
    assert hard.instantaneous_modulus == pytest.approx(3 * BROAD.instantaneous_modulus)
    cold = BROAD.shift_times(100.0)
    np.testing.assert_allclose(cold.complex_modulus(W), BROAD.complex_modulus(100 * W))
    np.testing.assert_allclose(cold.relaxation_modulus(100 * T), BROAD.relaxation_modulus(T))
    alike(cold.shift_times(0.01), BROAD)


def test_moduli_of_negative_frequencies_are_conjugate():
    np.testing.assert_allclose(BROAD.complex_modulus(-W), np.conj(BROAD.complex_modulus(W)))


def noisy(seed=2):
    modulus = BROAD.complex_modulus(W)
    jitter = 1 + 0.01 * np.random.default_rng(seed).standard_normal((2, W.size))
    return modulus.real * jitter[0], modulus.imag * jitter[1]


def test_a_sweep_fits_the_same_in_other_order_and_in_other_units():
    storage, loss = noisy()
    one = fit_dynamic(W, storage, loss)
    order = np.random.default_rng(1).permutation(W.size)
    mixed = fit_dynamic(W[order], storage[order], loss[order])
    alike(one.spectrum, mixed.spectrum, 1e-6)
    hard = fit_dynamic(W, 1e3 * storage, 1e3 * loss)
    np.testing.assert_allclose(hard.spectrum.term_moduli, 1e3 * one.spectrum.term_moduli, rtol=1e-5,
                               atol=1e-6 * hard.spectrum.term_moduli.max())  # fmt: skip
    fast = fit_dynamic(60 * W, storage, loss)
    np.testing.assert_allclose(fast.spectrum.relaxation_times, one.spectrum.relaxation_times / 60)
    for other in (mixed, hard, fast):
        assert other.rms_residual == pytest.approx(one.rms_residual, rel=1e-3)
        assert other.quality == one.quality
    bands = [fit.band(w) for fit, w in ((one, W[5:35]), (fast, 60 * W[5:35]))]
    np.testing.assert_allclose(bands[1].loss_low, bands[0].loss_low, rtol=1e-2)
    np.testing.assert_allclose(bands[1].loss_high, bands[0].loss_high, rtol=1e-2)


def test_a_relaxation_test_fits_the_same_in_other_units():
    modulus = BROAD.relaxation_modulus(T) * (
        1 + 0.01 * np.random.default_rng(3).standard_normal(T.size)
    )
    one = fit_relaxation(T, modulus)
    slow, hard = fit_relaxation(3600 * T, modulus), fit_relaxation(T, 7 * modulus)
    np.testing.assert_allclose(
        slow.spectrum.relaxation_modulus(3600 * T), one.spectrum.relaxation_modulus(T), rtol=1e-6
    )
    np.testing.assert_allclose(
        hard.spectrum.relaxation_modulus(T), 7 * one.spectrum.relaxation_modulus(T), rtol=1e-6
    )
    assert one.rms_residual == pytest.approx(slow.rms_residual, rel=1e-4)


def test_a_band_is_wider_for_the_same_test_with_more_scatter():
    widths = []
    for scatter in (0.005, 0.02):
        jitter = 1 + scatter * np.random.default_rng(5).standard_normal((2, W.size))
        modulus = BROAD.complex_modulus(W)
        band = fit_dynamic(W, modulus.real * jitter[0], modulus.imag * jitter[1]).band(W[8:32])
        widths.append(np.mean((band.loss_high - band.loss_low) / band.loss_high))
    assert 2 < widths[1] / widths[0] < 8  # four times the scatter


def sweeps(w=None):
    w = np.geomspace(0.6, 600.0, 10) if w is None else w
    found = []
    for kelvin in KELVIN:
        modulus = BROAD.shift_times(LAW.shift_factor(kelvin)).complex_modulus(w)
        found.append(DynamicSweep(w, modulus.real, modulus.imag, kelvin))
    return found


@pytest.mark.parametrize("shift_by", ["storage", "both"])
def test_a_master_curve_knows_no_order_of_tests_and_no_unit(shift_by):
    one = dynamic_master_curve(sweeps(), shift_by=shift_by)
    mixed = dynamic_master_curve([sweeps()[k] for k in (3, 0, 4, 2, 1)], shift_by=shift_by)
    hard = dynamic_master_curve(
        [
            replace(s, storage_modulus=5 * s.storage_modulus, loss_modulus=5 * s.loss_modulus)
            for s in sweeps()
        ],
        shift_by=shift_by,
    )
    fast = dynamic_master_curve(
        [replace(s, angular_frequency=10 * s.angular_frequency) for s in sweeps()],
        shift_by=shift_by,
    )
    for other in (mixed, hard, fast):
        np.testing.assert_allclose(
            other.shifts.log10_shift_factors, one.shifts.log10_shift_factors, atol=1e-4
        )
    np.testing.assert_allclose(hard.storage_modulus, 5 * one.storage_modulus, rtol=1e-6)
    np.testing.assert_allclose(
        np.sort(fast.angular_frequency), np.sort(10 * one.angular_frequency), rtol=1e-3
    )


def test_another_reference_temperature_shifts_all_by_one_factor():
    middle = dynamic_master_curve(sweeps(), KELVIN[2])
    cold = dynamic_master_curve(sweeps(), KELVIN[0])
    apart = cold.shifts.log10_shift_factors - middle.shifts.log10_shift_factors
    np.testing.assert_allclose(apart, apart[0], atol=1e-9)
    assert middle.shifts.log10_shift_factors[2] == pytest.approx(0, abs=1e-12)
    assert cold.shifts.log10_shift_factors[0] == pytest.approx(0, abs=1e-12)
    assert apart[0] == pytest.approx(-LAW.log10_shift_factor(KELVIN[0]), abs=0.1)
    # a colder reference: the same moduli at lower frequencies
    np.testing.assert_allclose(
        np.sort(cold.angular_frequency), np.sort(middle.angular_frequency) * 10 ** apart[0]
    )


def test_relaxation_tests_shift_as_sweeps_do():
    t = np.geomspace(0.1, 100.0, 12)
    curves = [
        RelaxationCurve(t, BROAD.shift_times(LAW.shift_factor(k)).relaxation_modulus(t), k)
        for k in KELVIN
    ]
    found = relaxation_master_curve(curves, KELVIN[2]).shifts.log10_shift_factors
    np.testing.assert_allclose(found, LAW.log10_shift_factor(KELVIN), atol=0.15)
    mixed = relaxation_master_curve(curves[::-1], KELVIN[2])
    np.testing.assert_allclose(mixed.shifts.log10_shift_factors, found, atol=1e-9)
