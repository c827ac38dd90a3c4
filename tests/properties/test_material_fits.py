"""Synthetic materials are found again, with the error that the band states."""

import numpy as np
import pytest

from underfoot.block.one_term_fit import fit_single_exponential
from underfoot.core import DataError, InputError, RangeError
from underfoot.material import (
    ArrheniusShift,
    DynamicSweep,
    RelaxationCurve,
    RelaxationSpectrum,
    WlfShift,
    dynamic_master_curve,
    fit_arrhenius,
    fit_dynamic,
    fit_relaxation,
    fit_wlf,
    relaxation_master_curve,
    single_exponential_spectrum,
)
from underfoot.trials.machines.compression import compression_moduli

TAU = np.geomspace(1e-6, 1e6, 37)
BROAD = RelaxationSpectrum(1e6, 1e6 * (0.5 + 3 * np.exp(-((np.log10(TAU) + 1) ** 2) / 4)), TAU)


def test_relaxation_gives_the_loss_modulus_back_within_its_band():
    t = np.geomspace(1e-4, 1e4, 120)
    inside, errors = [], []
    for seed in range(6):
        noise = 1 + 0.01 * np.random.default_rng(seed).standard_normal(t.size)
        fit = fit_relaxation(t, BROAD.relaxation_modulus(t) * noise)
        w = np.geomspace(3e-4, 3e3, 50)
        band = fit.band(w)
        true = BROAD.loss_modulus(w)
        inside.append(np.mean((band.loss_low <= true) & (true <= band.loss_high)))
        errors.append(fit.spectrum.loss_modulus(w) / true - 1)
        assert not band.extrapolated.any()
        assert fit.rms_residual == pytest.approx(0.01, rel=0.25)
    assert np.mean(inside) > 0.85  # of a nominal 0.95
    assert np.sqrt(np.mean(np.square(errors))) < 0.035


def test_dynamic_fit_is_five_times_better_and_weighs_the_noisier_part_down():
    w = np.geomspace(1e-3, 1e5, 80)
    generator = np.random.default_rng(1)
    modulus = BROAD.complex_modulus(w)
    fit = fit_dynamic(
        w,
        modulus.real * (1 + 0.01 * generator.standard_normal(80)),
        modulus.imag * (1 + 0.03 * generator.standard_normal(80)),
    )
    inner = np.geomspace(3e-3, 3e4, 50)
    error = fit.spectrum.loss_modulus(inner) / BROAD.loss_modulus(inner) - 1
    assert np.sqrt(np.mean(error**2)) < 0.015
    assert np.std(fit.residuals["storage modulus"]) == pytest.approx(0.01, rel=0.35)
    assert np.std(fit.residuals["loss modulus"]) == pytest.approx(0.03, rel=0.35)
    band, true = fit.band(inner), BROAD.loss_modulus(inner)
    assert np.mean((band.loss_low <= true) & (true <= band.loss_high)) > 0.8
    assert np.mean(band.loss_high - band.loss_low) < 0.06 * np.mean(true)
    assert fit.band([1e-5, 1.0, 1e7]).extrapolated.tolist() == [True, False, True]


def test_few_sharp_terms_are_followed():
    few = RelaxationSpectrum(1e6, [5e6, 2e6, 1e7], [2e-3, 0.7, 110.0])
    w = np.geomspace(1e-4, 1e5, 120)
    fit = fit_dynamic(w, few.storage_modulus(w), few.loss_modulus(w), noise=0.0)
    np.testing.assert_allclose(fit.spectrum.loss_modulus(w), few.loss_modulus(w), rtol=0.06)
    assert fit.rms_residual < 0.02


def test_equation_7_is_recovered_with_its_error():
    true = single_exponential_spectrum(0.59e6, 0.44e6, 0.025)
    t = np.linspace(1.0, 240.0, 200)
    exact = fit_single_exponential(t, true.relaxation_modulus(t))
    assert exact.decay_rate.value == pytest.approx(0.025, rel=1e-5)
    assert exact.quality == "good"
    pulls = []
    for seed in range(30):
        noisy = true.relaxation_modulus(t) + 2e3 * np.random.default_rng(seed).standard_normal(200)
        rate = fit_single_exponential(t, noisy).decay_rate
        pulls.append((rate.value - 0.025) / rate.uncertainty)
    assert 0.6 < np.std(pulls) < 1.5


def test_a_decay_beyond_the_test_is_not_identified():
    slow = single_exponential_spectrum(1e6, 0.5e6, 1e-4)
    t = np.linspace(1.0, 240.0, 100)
    rate = fit_single_exponential(t, slow.relaxation_modulus(t)).decay_rate
    assert rate.uncertainty is None
    assert "not identified" in rate.reason


def _sweeps(law, kelvin, w=None, noise=0.0, seed=0):
    w = np.geomspace(0.6, 600.0, 12) if w is None else w
    generator = np.random.default_rng(seed)
    found = []
    for t in kelvin:
        modulus = BROAD.shift_times(law.shift_factor(t)).complex_modulus(w)
        jitter = 1 + noise * generator.standard_normal((2, w.size))
        found.append(DynamicSweep(w, modulus.real * jitter[0], modulus.imag * jitter[1], t))
    return found


@pytest.mark.parametrize("shift_by", ["storage", "both"])
def test_wlf_superposition_is_found_again(shift_by):
    law = WlfShift(8.86, 101.6, 273.15 + 30)
    kelvin = 273.15 + np.arange(-10.0, 71.0, 8.0)
    master = dynamic_master_curve(_sweeps(law, kelvin, noise=0.003), 273.15 + 30, shift_by=shift_by)
    off = master.shifts.log10_shift_factors - law.log10_shift_factor(kelvin)
    assert np.abs(off).max() < 0.15
    assert np.all(np.abs(off) < 3.0 * master.shifts.log10_errors + 0.02)
    assert master.shifts.law.log10_shift_factor(300.0) == pytest.approx(
        law.log10_shift_factor(300.0), abs=0.03
    )
    assert isinstance(master.shifts.law, WlfShift)
    spectrum = master.spectrum().spectrum
    w = np.geomspace(1e-2, 1e4, 30)
    np.testing.assert_allclose(spectrum.loss_modulus(w), BROAD.loss_modulus(w), rtol=0.06)


def test_arrhenius_and_wlf_fits():
    kelvin = np.linspace(280.0, 340.0, 7)
    law = ArrheniusShift(120e3, 300.0)
    found = fit_arrhenius(kelvin, law.log10_shift_factor(kelvin), 300.0)
    assert found.activation_energy == pytest.approx(120e3)
    assert found.rms < 1e-10
    assert "kJ/mol" in str(found)
    wlf = WlfShift(17.44, 51.6, 253.15)
    assert wlf.shift_factor(253.15) == 1.0
    assert "WLF" in str(fit_wlf(kelvin, wlf.log10_shift_factor(kelvin), 253.15))
    with pytest.raises(RangeError, match="pole"):
        wlf.log10_shift_factor(200.0)
    with pytest.raises(RangeError, match="0 K"):
        law.shift_factor(-5.0)
    with pytest.raises(DataError, match="different temperatures"):
        fit_wlf([300.0, 310.0], [0.0, -1.0], 300.0)
    with pytest.raises(DataError, match="missing"):
        fit_arrhenius([300.0, np.nan], [0.0, -1.0], 300.0)


def test_relaxation_superposition():
    law = WlfShift(8.86, 101.6, 303.15)
    t = np.geomspace(0.1, 100.0, 15)
    kelvin = np.array([290.0, 297.0, 304.0, 311.0])
    curves = [
        RelaxationCurve(t, BROAD.shift_times(law.shift_factor(k)).relaxation_modulus(t), k)
        for k in kelvin[::-1]
    ]
    master = relaxation_master_curve(curves, 304.0)
    expected = law.log10_shift_factor(kelvin) - law.log10_shift_factor(304.0)
    np.testing.assert_allclose(master.shifts.log10_shift_factors, expected, atol=0.02)


def test_flat_curves_say_that_their_shift_is_unknown():
    flat = [DynamicSweep([1, 2, 4, 8], [5e6] * 4, [1e5] * 4, t) for t in (290.0, 300.0)]
    assert dynamic_master_curve(flat).shifts.log10_errors.max() > 10.0


def test_what_can_not_be_superposed_is_refused():
    law = WlfShift(8.86, 101.6, 303.15)
    with pytest.raises(DataError, match="do not overlap"):
        dynamic_master_curve(_sweeps(law, [263.0, 330.0], np.geomspace(1.0, 10.0, 8)))
    with pytest.raises(DataError, match="two temperatures"):
        dynamic_master_curve(_sweeps(law, [300.0]))
    with pytest.raises(DataError, match="two tests at"):
        dynamic_master_curve(_sweeps(law, [300.0, 300.0]))
    with pytest.raises(DataError, match="no temperature"):
        dynamic_master_curve(
            [*_sweeps(law, [300.0]), DynamicSweep([1, 2, 3, 4], [1, 2, 3, 4], [1] * 4)]
        )
    with pytest.raises(RangeError, match="reference temperature"):
        dynamic_master_curve(_sweeps(law, [300.0, 305.0]), 400.0)
    with pytest.raises(InputError, match="shift_by"):
        dynamic_master_curve(_sweeps(law, [300.0, 305.0]), shift_by="loss")


def test_equations_13_to_16_as_printed():
    # T = 6.1 mm, A = 552 mm^2 (report); forces of a linear spring of 1 MN/m and its half.
    found = compression_moduli(122.0, 1220.0, 671.0, 6.1e-3, 552e-6)
    assert found.short_time_stiffness == pytest.approx((1220 - 122) / (0.18 * 6.1e-3))
    assert found.short_time_modulus == pytest.approx(found.short_time_stiffness * 12.2e-3 / 552e-6)
    assert found.long_time_stiffness == pytest.approx(0.5 * found.short_time_stiffness)
    assert found.long_time_modulus == pytest.approx(0.5 * found.short_time_modulus)
    # A linear pair compressed by 0.2 T gives its own stiffness: that is where 0.18 comes from.
    stiffness = 1220.0 / (0.2 * 6.1e-3)
    assert compression_moduli(
        0.02 * 6.1e-3 * stiffness, 1220.0, 1220.0, 6.1e-3, 552e-6
    ).short_time_stiffness == pytest.approx(stiffness)
    with pytest.raises(InputError, match="F_inf"):
        compression_moduli(100.0, 50.0, 80.0, 6e-3, 5e-4)
    with pytest.raises(InputError, match="thickness"):
        compression_moduli(1.0, 3.0, 2.0, 0.0, 5e-4)


@pytest.mark.parametrize(
    ("t", "modulus", "says"),
    [
        ([1, 2, 2, 3], [4, 3, 2, 1], "time goes from 2 s to 2 s"),
        ([0, 1, 2, 3], [4, 3, 2, 1], "time: row 1 is 0"),
        ([1, 2, 3, 4], [4, 3, -2, 1], "row 3 is -2"),
        ([1, 2, 3, 4], [4, np.nan, 2, 1], "first at row 2"),
        ([1, 2, 3], [3, 2, 1], "four points"),
        ([1, 2, 3, 4], [3, 2, 1], "same length"),
    ],
)
def test_bad_curves_are_refused(t, modulus, says):
    with pytest.raises(DataError, match=says):
        fit_relaxation(t, modulus)


def test_bad_settings_are_refused():
    t = np.geomspace(1.0, 100.0, 20)
    fit = fit_relaxation(t, BROAD.relaxation_modulus(t))
    with pytest.raises(InputError, match="level"):
        fit.band([1.0], 1.5)
    with pytest.raises(InputError, match="frequency"):
        fit.band([0.0])
    with pytest.raises(InputError, match="terms"):
        fit_relaxation(t, BROAD.relaxation_modulus(t), terms_per_decade=0)
    with pytest.raises(DataError, match="0 K"):
        RelaxationCurve(t, BROAD.relaxation_modulus(t), -20.0)
