"""Real relaxation and dynamic tests (pyvisco's example data, BSD 3-clause, see tests/data)."""

from pathlib import Path

import numpy as np
import pytest

from underfoot.block.one_term_fit import fit_single_exponential
from underfoot.material import (
    dynamic_master_curve,
    fit_relaxation,
    read_dynamic,
    read_relaxation,
    relaxation_master_curve,
)

DATA = Path(__file__).parents[1] / "data" / "viscoelastic" / "pyvisco"


@pytest.fixture(scope="module")
def master():
    (curve,) = read_relaxation(DATA / "time_user_master.csv")
    return curve


def test_thirty_decades_are_followed(master):
    assert master.time.size == 481
    assert master.temperature is None
    fit = fit_relaxation(master.time, master.modulus)
    assert fit.quality == "good"
    assert fit.rms_residual < 0.003
    assert fit.largest_residual < 0.02
    assert np.all(fit.spectrum.term_moduli >= 0.0)
    assert "rms" in str(fit)


def test_storage_and_loss_against_an_independent_transform(master):
    """E*(w) = E_0 + int E'(t) exp(-i w t) dt of the readings, interpolated between them."""
    from scipy.interpolate import PchipInterpolator

    t = np.geomspace(master.time[0], master.time[-1], 20_001)
    curve = PchipInterpolator(np.log(master.time), np.log(master.modulus))
    modulus = np.exp(curve(np.log(t)))
    slopes = np.diff(modulus) / np.diff(t)
    w = np.geomspace(10.0 / t[-1], 0.1 / t[0], 60)
    exact = np.empty(60, dtype=complex)
    for i, one in enumerate(w):  # exact for a modulus that is linear over each short step
        phase = np.exp(-1j * one * t)
        exact[i] = modulus[0] + (phase[:-1] - phase[1:]) @ slopes / (1j * one)
    fitted = fit_relaxation(master.time, master.modulus).spectrum.complex_modulus(w)
    np.testing.assert_allclose(fitted.real, exact.real, rtol=0.015)
    loss = np.abs(fitted.imag / exact.imag - 1.0)
    assert np.median(loss) < 0.05
    assert loss.max() < 0.25  # the loss is 1 % of the modulus where this is found


def test_one_exponential_reports_that_it_is_bad(master):
    fit = fit_single_exponential(master.time, master.modulus)
    assert fit.quality == "bad"
    assert fit.largest_residual > 1.0  # 140 %
    assert "fit_relaxation" in str(fit)


def test_dynamic_sweeps_at_21_temperatures():
    sweeps = read_dynamic(DATA / "freq_user_raw.csv")
    assert len(sweeps) == 21
    assert sweeps[0].temperature == pytest.approx(273.15 - 49.9, abs=0.1)
    assert sweeps[0].angular_frequency[0] == pytest.approx(2 * np.pi * 0.1)
    assert sweeps[0].storage_modulus[0] == pytest.approx(8097.175545e6)
    master = dynamic_master_curve(sweeps, 298.15)
    shifts = master.shifts
    assert np.all(np.diff(shifts.log10_shift_factors) < 0.0)
    assert np.interp(298.15, shifts.temperatures, shifts.log10_shift_factors) == pytest.approx(0.0)
    assert shifts.mismatch.max() < 0.02
    fit = master.spectrum()
    # E' superposes; E'' (rising at 100 Hz at every temperature: the instrument) does not.
    assert np.sqrt(np.mean(fit.residuals["storage modulus"] ** 2)) < 0.04
    assert fit.quality == "rough"
    # Above the glass transition WLF holds; over the whole range its residual says it doesn't.
    assert shifts.wlf.rms > 0.5


def test_time_and_frequency_readings_of_one_test_shift_alike():
    sweeps, curves = (
        read_dynamic(DATA / "freq_user_raw.csv"),
        read_relaxation(DATA / "time_user_raw.csv"),
    )
    by_frequency = dynamic_master_curve(sweeps, 298.15).shifts
    relaxed = relaxation_master_curve(curves, 298.15)
    np.testing.assert_allclose(
        relaxed.shifts.log10_shift_factors, by_frequency.log10_shift_factors, atol=1e-3
    )
    assert np.all(np.diff(relaxed.time) > 0.0)
    assert relaxed.spectrum().quality == "good"


def test_reference_temperature_moves_the_curve_by_the_shift():
    sweeps = read_dynamic(DATA / "freq_user_raw.csv")
    here, there = (dynamic_master_curve(sweeps, t) for t in (298.15, 340.0))
    step = np.log10(there.angular_frequency[0] / here.angular_frequency[0])
    expected = -np.interp(340.0, here.shifts.temperatures, here.shifts.log10_shift_factors)
    assert step == pytest.approx(expected, abs=1e-9)
    np.testing.assert_array_equal(here.storage_modulus, there.storage_modulus)
