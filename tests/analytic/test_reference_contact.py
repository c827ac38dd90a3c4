"""Closed forms against their limits and against each other."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from underfoot import reference


def test_hertz_point_balances_force_and_indents_by_a_squared_over_radius():
    contact = reference.hertz_point(2.0, 5e-3, 3e6)
    total, _ = quad(
        lambda r: 2 * np.pi * r * reference.hertz_point_pressure(r, contact),
        0,
        contact.half_width,
    )
    assert total == pytest.approx(2.0, rel=1e-8)
    # surface displacement at the centre of a Hertz pressure: pi a p0 / (2 E*)  (Johnson 3.42a)
    assert contact.approach == pytest.approx(
        np.pi * contact.half_width * contact.peak_pressure / (2 * 3e6), rel=1e-12
    )


def test_hertz_line_peak_pressure_follows_from_its_strip():
    contact = reference.hertz_line(300.0, 2e-3, 4e6)
    # p0 = a E* / (2 R), Johnson (1985) Eq. 4.44 with 4.45
    assert contact.peak_pressure == pytest.approx(contact.half_width * 4e6 / (2 * 2e-3), rel=1e-12)
    assert contact.mean_pressure == pytest.approx(np.pi / 4 * contact.peak_pressure, rel=1e-12)


@pytest.mark.parametrize("ratio", [0.01, 0.1, 0.3, 0.6, 0.9, 0.999])
def test_westergaard_pressure_and_gap_are_consistent(ratio):
    amplitude, wavelength, modulus = 3e-6, 2e-4, 5e6
    full = reference.sinusoid_full_contact_pressure(amplitude, wavelength, modulus)
    pressure = ratio * full
    b = reference.sinusoid_contact_fraction(pressure, full) * wavelength / 2
    mean, _ = quad(lambda x: reference.sinusoid_pressure(x, pressure, wavelength, full), 0, b)
    assert 2 * mean / wavelength == pytest.approx(pressure, rel=1e-7)
    gap, _ = quad(
        lambda x: reference.sinusoid_gap(x, pressure, amplitude, wavelength, full),
        b,
        wavelength / 2,
        epsabs=1e-20,
    )
    expected = reference.sinusoid_mean_gap(pressure, amplitude, full)
    assert 2 * gap / wavelength == pytest.approx(expected, rel=1e-6)


def test_westergaard_solves_the_half_space_equation():
    """gap = A p - h + constant, with A the Fourier compliance; singular ends limit the grid."""
    n, amplitude, wavelength, modulus = 8192, 3e-6, 2e-4, 5e6
    x = (np.arange(n) - n // 2) * wavelength / n
    full = reference.sinusoid_full_contact_pressure(amplitude, wavelength, modulus)
    pressure = reference.sinusoid_pressure(x, 0.37 * full, wavelength, full)
    k = 2 * np.pi * np.fft.rfftfreq(n, wavelength / n)
    spectrum = np.fft.rfft(pressure)
    spectrum[1:] *= reference.half_space_compliance(k[1:], modulus)
    spectrum[0] = 0
    gap = np.fft.irfft(spectrum, n) - amplitude * np.cos(2 * np.pi * x / wavelength)
    expected = reference.sinusoid_gap(x, 0.37 * full, amplitude, wavelength, full)
    error = (gap - gap.mean()) - (expected - expected.mean())
    assert np.abs(error).max() < 2e-5 * amplitude


def test_without_pressure_the_gap_is_the_sinusoid():
    x = np.linspace(0.0, 1.0, 9)
    gap = reference.sinusoid_gap(x, 0.0, 2e-6, 1.0, 1e6)
    assert gap == pytest.approx(4e-6 * np.sin(np.pi * x) ** 2)


def test_westergaard_ends():
    full = reference.sinusoid_full_contact_pressure(1e-6, 1e-4, 1e6)
    assert full == pytest.approx(np.pi * 1e4)
    assert reference.sinusoid_contact_fraction(0.0, full) == 0.0
    assert reference.sinusoid_contact_fraction(2 * full, full) == 1.0
    assert reference.sinusoid_mean_gap([0.0, full], 1e-6, full) == pytest.approx([1e-6, 0.0])
    x = np.linspace(-5e-5, 5e-5, 11)
    touching = reference.sinusoid_pressure(x, full, 1e-4, full)
    assert touching.min() == pytest.approx(0.0, abs=1e-9 * full)
    # a cylinder of the crest's radius 1/(a q^2) describes the first touch
    radius = (1e-4 / (2 * np.pi)) ** 2 / 1e-6
    light = 1e-6 * full
    line = reference.hertz_line(light * 1e-4, radius, 1e6)
    assert reference.sinusoid_contact_fraction(light, full) * 1e-4 / 2 == pytest.approx(
        line.half_width, rel=1e-5
    )


def test_sliding_sinusoid_is_the_mean_of_pressure_times_slope():
    a, wavelength, modulus, p0 = 2e-7, 1e-4, 3e6 + 0.6e6j, 1e5
    q = 2 * np.pi / wavelength
    x = np.linspace(0, wavelength, 256, endpoint=False)
    # floor at rest, rubber moving along -x past it: the wave leads by the loss angle
    pressure = p0 + np.real(q * modulus / 2 * a * np.exp(1j * q * x))
    slope = -a * q * np.sin(q * x)
    expected = np.mean(pressure * slope) / p0
    assert reference.sliding_sinusoid_cof(p0, a, wavelength, modulus) == pytest.approx(expected)


def test_checkerboard_equals_its_waves():
    a, wavelength, p0 = 2e-7, 1e-4, 1e5
    modulus = 3e6 + 0.6e6j
    k = 2 * np.pi / wavelength
    n = 32
    grid = np.arange(n) * wavelength / n
    h = a * np.cos(k * grid)[:, None] * np.cos(k * grid)[None, :]
    q = 2 * np.pi * np.fft.fftfreq(n, wavelength / n)
    qx, qy = np.meshgrid(q, q, indexing="ij")
    e = np.where(qx > 0, modulus, np.where(qx < 0, modulus.conjugate(), modulus.real))
    power = np.abs(np.fft.fft2(h) / n**2) ** 2
    expected = np.sum(qx * np.hypot(qx, qy) * e.imag * power) / (2 * p0)
    assert reference.sliding_checkerboard_cof(p0, a, wavelength, modulus) == pytest.approx(expected)


@pytest.mark.parametrize(
    "cof", [reference.sliding_sinusoid_cof, reference.sliding_checkerboard_cof]
)
def test_sliding_forms_refuse_partial_contact(cof):
    with pytest.raises(ValueError, match="full contact needs"):
        cof(100.0, 2e-6, 1e-4, 3e6 + 1e6j)
    with pytest.raises(ValueError, match="full contact needs"):
        cof([1e9, 100.0], 2e-6, 1e-4, 3e6 + 1e6j)  # one of several


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.49, 0.5])
def test_bonded_layer_limits(nu):
    thickness, young = 4e-3, 5e6
    thick = reference.bonded_layer_compliance(
        np.array([50.0, 1e3]) / thickness, thickness, young, nu
    )
    half = reference.half_space_compliance(np.array([50.0, 1e3]) / thickness, young / (1 - nu**2))
    np.testing.assert_allclose(thick, half, rtol=1e-12)
    k = np.array([0.9e-3, 1.1e-3, 0.01]) / thickness
    below, above, gentle = reference.bonded_layer_compliance(k, thickness, young, nu)
    if nu < 0.5:
        oedometer = thickness * (1 + nu) * (1 - 2 * nu) / (young * (1 - nu))
        assert below == pytest.approx(oedometer, rel=1e-12)
        assert above == pytest.approx(oedometer, rel=2e-3)
    else:
        squeeze = k**2 * thickness**3 / (3 * young / 3)
        np.testing.assert_allclose([below, above, gentle], squeeze, rtol=5e-4)


def test_incompressible_layer_needs_no_cancellation_luck():
    k = np.geomspace(1e-4, 1e3, 300) / 4e-3
    compliance = reference.bonded_layer_compliance(k, 4e-3, 5e6, 0.5)
    assert np.all(compliance > 0)
    assert np.all(np.isfinite(compliance))
    rise = np.diff(np.log(compliance)) / np.diff(np.log(k))
    assert rise.max() < 2.02
    assert rise.min() > -1.02


@pytest.mark.parametrize(
    ("call", "match"),
    [
        (lambda: reference.hertz_point(-1, 1, 1), "force"),
        (lambda: reference.hertz_line(1, 0, 1), "radius"),
        (lambda: reference.sinusoid_full_contact_pressure(1, 1, np.nan), "modulus"),
        (lambda: reference.bonded_layer_compliance(1.0, 1.0, 1.0, 0.6), "Poisson"),
        (lambda: reference.sinusoid_contact_fraction(-1.0, 1.0), "pressure"),
    ],
)
def test_refusals(call, match):
    with pytest.raises(ValueError, match=match):
        call()


def test_one_pressure_below_zero_among_others_is_refused():
    with pytest.raises(ValueError, match="pressure must be zero or positive"):
        reference.sinusoid_contact_fraction([1e3, -1.0], 1e5)


@pytest.mark.parametrize("nu", [0.3, 0.49, 0.5])
@pytest.mark.parametrize("q", [1.001e-3, 1.5e-3, 1.99e-3, 0.1])
def test_a_bonded_layer_is_bentalls_from_a_thousandth_on(nu, q):
    """The sum in the numerator, free of what cancels: a sinh 2q - 2q, by its series."""
    a, thickness, modulus = 3 - 4 * nu, 0.01, 5e6
    sinh = sum((2 * q) ** n / math.factorial(n) for n in range(3, 25, 2))
    over = (a - 1) * 2 * q + a * sinh
    under = a * math.cosh(2 * q) + 2 * q**2 + 5 - 12 * nu + 8 * nu**2
    exact = 2 * (1 - nu**2) * thickness / (modulus * q) * over / under
    found = reference.bonded_layer_compliance(q / thickness, thickness, modulus, nu)
    assert float(found) == pytest.approx(exact, rel=1e-6, abs=0)
