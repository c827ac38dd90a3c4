"""What every passive material obeys, whatever its terms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.material import RelaxationSpectrum, fit_wlf, shore_a_gent, youngs_modulus_gent

terms = st.lists(st.tuples(st.floats(0.0, 1e9), st.floats(-9.0, 9.0)), min_size=0, max_size=8).map(
    lambda pairs: ([m for m, _ in pairs], [10.0**e for _, e in pairs])
)


@settings(deadline=None, max_examples=60)
@given(st.floats(1e3, 1e9), terms)
def test_passive_and_monotonic(equilibrium, parts):
    spectrum = RelaxationSpectrum(equilibrium, *parts)
    w = np.geomspace(1e-10, 1e10, 81)
    modulus = spectrum.complex_modulus(w)
    slack = 1e-12 * spectrum.instantaneous_modulus
    assert np.all(modulus.imag >= 0.0)
    assert np.all(np.diff(modulus.real) >= -slack)
    assert np.all(modulus.real <= spectrum.instantaneous_modulus + slack)
    relaxation = spectrum.relaxation_modulus(np.geomspace(1e-10, 1e10, 81))
    assert np.all(np.diff(relaxation) <= slack)
    assert np.all(relaxation >= equilibrium - slack)
    np.testing.assert_array_equal(spectrum.complex_modulus(-w), np.conj(modulus))


@settings(deadline=None, max_examples=60)
@given(st.floats(1e3, 1e9), terms, st.floats(-6.0, 6.0))
def test_a_shift_in_time_is_a_shift_in_frequency(equilibrium, parts, decades):
    spectrum = RelaxationSpectrum(equilibrium, *parts)
    w = np.geomspace(1e-3, 1e3, 7)
    moved = spectrum.shift_times(10.0**decades).complex_modulus(w)
    np.testing.assert_allclose(moved, spectrum.complex_modulus(w * 10.0**decades), rtol=1e-9)


@settings(deadline=None, max_examples=40)
@given(st.floats(0.0, 99.0))
def test_hardness_there_and_back(shore_a):
    assert shore_a_gent(youngs_modulus_gent(shore_a)) == pytest.approx(shore_a, abs=1e-8)


@settings(deadline=None, max_examples=25)
@given(st.floats(2.0, 30.0), st.floats(30.0, 200.0), st.floats(-20.0, 60.0))
def test_wlf_constants_are_recovered(c1, c2, reference):
    away = np.linspace(-0.6 * c2, 80.0, 12)
    law = fit_wlf(reference + 273.15 + away, -c1 * away / (c2 + away), reference + 273.15)
    assert law.c1 == pytest.approx(c1, rel=1e-4)
    assert law.c2 == pytest.approx(c2, rel=1e-4)
