"""Asperity theories against their own limits and exact special cases."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import digamma, erf

from underfoot import reference
from underfoot.core import InputError, RangeError, Status
from underfoot.rough_contact import ExponentialLaw
from underfoot.rough_contact.greenwood_williamson_1966 import greenwood_williamson
from underfoot.rough_contact.persson import (
    GAP_GAMMA,
    cumulative,
    persson,
    persson_growth,
    yang_persson_mean_gap,
)
from underfoot.surface import SpectralMoments, asperities

HURST = 0.8


def decay_length(q, c):
    """Return u0 of p ~ exp(-u / u0) at light load."""
    root = np.sqrt(cumulative(q**3 * c, q))
    fine = np.concatenate([[0.0], np.geomspace(1e-7 * root[-1], root[-1], 1200)])
    return 2 * GAP_GAMMA * np.trapezoid(np.interp(fine, root, 1 / q), fine)


def persson_friction(*args, **options):
    return persson_growth(*args, **options)[1][:, -1]


def persson_fractions(*args):
    return persson_growth(*args)[0][0]


def spectrum(rms=5e-6, first=2e4, last=2e6, count=400):
    q = np.geomspace(first, last, count)
    c = q ** (-2 * (1 + HURST))
    m0 = 2 * np.pi * np.trapezoid(q**2 * c, np.log(q))
    return q, c * rms**2 / m0


def rubber(frequency):
    """Ten terms, one a decade, loss tangent near 0.2."""
    w = np.asarray(frequency)[..., None]
    tau = np.logspace(-8, 1, 10)
    return 1.5e6 + np.sum(0.5e6 * tau**-0.05 * 1j * w * tau / (1 + 1j * w * tau), axis=-1)


def moments(q, c):
    m0, m2, m4 = (np.trapezoid(q ** (n + 2) * c, np.log(q)) for n in (0, 2, 4))
    return SpectralMoments(2 * np.pi * m0, np.pi * m2, 0.75 * np.pi * m4, (q[0], q[-1]))


def rms_gradient(q, c):
    return np.sqrt(2 * moments(q, c).m2)


def test_persson_elastic_area_is_the_error_function():
    q, c = spectrum()
    gradient = rms_gradient(q, c)
    for pressure in (1e3, 1e5, 3e6):
        fractions = persson_fractions(pressure, q, c, 2e6)
        stiffness = 2e6 / 0.75
        assert fractions[-1] == pytest.approx(
            erf(np.sqrt(2) * pressure / (stiffness * gradient)), rel=1e-9
        )
        assert fractions[0] == 1.0
        assert np.all(np.diff(fractions) <= 0)


def test_persson_light_load_slope():
    q, c = spectrum()
    gradient = rms_gradient(q, c)
    pressure = 1e-4 * 2e6 / 0.75 * gradient
    kappa = persson_fractions(pressure, q, c, 2e6)[-1] / 1e-4
    assert kappa == pytest.approx(np.sqrt(8 / np.pi), rel=1e-6)


def test_sliding_area_lies_between_the_relaxed_and_the_glassy_one():
    q, c = spectrum()
    at = {v: persson_fractions(2e5, q, c, rubber, v)[-1] for v in (0.0, 0.01, 1.0, 1e9)}
    assert at[0.0] > at[0.01] > at[1.0] > at[1e9]
    stiff = float(rubber(np.array([1e20]))[0].real)
    assert at[1e9] == pytest.approx(persson_fractions(2e5, q, c, stiff)[-1], rel=1e-2)


def test_persson_friction_in_full_contact_is_the_sum_over_waves():
    """One narrow ring: <cos(phi) Im E*> times q^2 <h^2>/(2 p), by an independent angular sum."""
    q = np.geomspace(0.999e5, 1.001e5, 9)
    c = np.ones(9)
    m0 = 2 * np.pi * np.trapezoid(q**2 * c, np.log(q))
    rms = 1e-7
    c *= rms**2 / m0
    pressure, speed = 1e9, 0.3
    angle = (np.arange(20000) + 0.5) * 2 * np.pi / 20000
    signed = np.cos(angle)
    loss = np.sign(signed) * rubber(np.abs(1e5 * speed * signed)).imag / 0.75
    expected = (1e5) ** 2 * rms**2 * np.mean(signed * loss) / (2 * pressure) * 1e5 / 1e5
    got = persson_friction(pressure, q, c, rubber, speed)[0]
    assert got == pytest.approx(expected, rel=1e-4)


def test_persson_ring_bounds_the_closed_form_of_one_wave():
    """All waves along x would give the sliding sinusoid; directions take cos(phi) away."""
    q = np.geomspace(0.999e5, 1.001e5, 9)
    c = np.ones(9)
    c *= (1e-7) ** 2 / (2 * np.pi * np.trapezoid(q**2 * c, np.log(q)))

    def constant_loss(w):
        return 2e6 + 4e5j * (np.asarray(w) > 0)

    along = reference.sliding_sinusoid_cof(
        1e9, 1e-7 * np.sqrt(2), 2 * np.pi / 1e5, constant_loss(1.0) / 0.75
    )
    ring = persson_friction(1e9, q, c, constant_loss, 0.3)[0]
    assert ring == pytest.approx(along * 2 / np.pi, rel=1e-3)


def test_friction_is_odd_in_speed_and_zero_without_loss():
    q, c = spectrum()
    forth = persson_friction([1e5, 1e6], q, c, rubber, 0.5)
    np.testing.assert_allclose(persson_friction([1e5, 1e6], q, c, rubber, -0.5), -forth)
    assert np.all(persson_friction([1e5], q, c, 2e6, 0.5) == 0.0)
    assert np.all(persson_friction([1e5], q, c, rubber, 0.0) == 0.0)
    growing = persson_growth(1e5, q, c, rubber, 0.5)[1][0]
    assert np.all(np.diff(growing) >= 0)
    bare = persson_friction([1e5, 1e6], q, c, rubber, 0.5, gamma=1.0)
    assert np.all(bare > forth)


def test_mean_gap_follows_stored_energy():
    """p = -dU/du with U = (pi/2) E* int q^2 C [gamma P + (1-gamma) P^3] dq, by differences."""
    q, c = spectrum(count=40_000)  # the sum below is slow to converge at the first wave
    stiffness, gamma = 2e6 / 0.75, 0.45
    w = np.empty_like(q)
    w[0] = np.inf
    steps = 0.5 * np.diff(np.log(q)) * (q[1:] ** 4 * c[1:] + q[:-1] ** 4 * c[:-1])
    w[1:] = 1 / np.sqrt(np.pi * np.cumsum(steps))

    def energy(p):
        fraction = erf(w * p / stiffness)
        density = q**2 * c * (gamma * fraction + (1 - gamma) * fraction**3)
        return np.pi / 2 * stiffness * np.trapezoid(density * q, np.log(q))

    for p in (2e4, 2e5, 1e6):
        gap = yang_persson_mean_gap([p * 0.99, p * 1.01], *spectrum(), 2e6)
        work = energy(p * 1.01) - energy(p * 0.99)
        assert -work / (gap[1] - gap[0]) == pytest.approx(p, rel=3e-3)


def test_mean_gap_closes_and_decays_exponentially():
    q, c = spectrum()
    gap = yang_persson_mean_gap([10.0, 20.0, 1e9], q, c, 2e6)
    assert gap[2] == pytest.approx(0.0, abs=1e-12)
    decay = decay_length(q, c)
    assert gap[0] - gap[1] == pytest.approx(decay * np.log(2), rel=1e-3)
    # Persson (2007) Phys. Rev. Lett. 99:125502: u0 about 0.5 rms; with gamma 0.45 for 0.5 less
    assert 0.4 * 5e-6 < decay < 0.52 * 5e-6


def test_greenwood_williamson_integrals_and_exponential_range():
    band = moments(*spectrum())
    summits = asperities(band)
    young, nu = 2e6, 0.5
    contact = greenwood_williamson([1e3, 1e4], band, young, nu)
    for pressure, area, gap, spots in zip(
        contact.pressure,
        contact.real_contact_fraction,
        contact.mean_gap,
        contact.spot_density,
        strict=True,
    ):
        s = summits.height_sd
        d = gap - summits.mean_height

        def height_density(z, s=s):
            return np.exp(-((z / s) ** 2) / 2) / (s * np.sqrt(2 * np.pi))

        def integral(power, d=d, s=s, density=height_density):
            return quad(lambda z: (z - d) ** power * density(z), d, d + 12 * s, epsabs=0)[0]

        factor = 4 / 3 * young / (1 - nu**2) * summits.density * np.sqrt(summits.radius)
        assert factor * integral(1.5) == pytest.approx(pressure, rel=1e-6)
        assert np.pi * summits.density * summits.radius * integral(1.0) == pytest.approx(
            area, rel=1e-6
        )
        assert summits.density * integral(0.0) == pytest.approx(spots, rel=1e-6)


def test_theories_share_one_result_and_say_what_they_do_not_give():
    q, c = spectrum()
    band = moments(q, c)
    elastic = persson([2e5, 4e5], q, c, 2e6)
    sliding = persson([2e5, 4e5], q, c, rubber, 0.1)
    summits = greenwood_williamson([2e3, 4e3], band, 2e6)
    assert elastic.mean_gap is not None
    assert sliding.mean_gap is None
    assert "stored energy" in sliding.not_estimated
    assert sliding.cof_hysteresis.min() > 0
    assert "elastic" in summits.not_estimated
    for result in (elastic, sliding, summits):
        assert result.real_contact_fraction.shape == result.pressure.shape
        assert result.source
    assert persson([10.0], q, c, 2e6).status is Status.OUT_OF_RANGE
    assert greenwood_williamson([2e3, 4e3], band, 2e6).status is Status.CONVERGED
    assert greenwood_williamson([5e5], band, 2e6).status is Status.OUT_OF_RANGE


def test_bad_input_is_refused():
    q, c = spectrum()
    band = moments(q, c)
    with pytest.raises(InputError, match="rise"):
        persson([1e5], q[::-1], c, 2e6)
    with pytest.raises(InputError, match="zero or more"):
        persson([1e5], q, -c, 2e6)
    with pytest.raises(InputError, match="above zero"):
        persson([0.0], q, c, 2e6)
    with pytest.raises(InputError, match="modulus: -2"):
        persson([1e5], q, c, -2e6)
    with pytest.raises(InputError, match="positive"):
        yang_persson_mean_gap([-1.0], q, c, 2e6)
    with pytest.raises(InputError, match="positive"):
        greenwood_williamson([0.0], band, 2e6)
    with pytest.raises(RangeError, match="carries"):
        greenwood_williamson([1e12], band, 2e6)
    with pytest.raises(InputError, match="bandwidth"):
        greenwood_williamson([1e3], SpectralMoments(1.0, 1.0, 0.8, (1.0, 2.0)), 2e6)


def test_constants_of_the_exponential_law_against_the_theory_it_is_taken_from():
    """Self-affine, Hurst exponent 0.8, q1 >> q0; integrals by hand (Beta(2, 1/2) = 4/3).

    u0 = gamma int q^2 C / (int q^3 C)^(1/2) dq = gamma sqrt(0.32 / pi) (10 / 3) Rq, and the
    intercept beta = sqrt(2) exp((psi(2) - psi(1/2) - euler) / 2 + (1 - gamma) / gamma k) q0 Rq
    with k = int 3 erf(t)^2 exp(-t^2) dt / t.
    """
    k = quad(lambda t: 3.0 * erf(t) ** 2 * np.exp(-t * t) / t, 0.0, 8.0)[0]
    decay = GAP_GAMMA * np.sqrt(0.32 / np.pi) * 10.0 / 3.0
    shape = 0.5 * (digamma(0.5) - digamma(2.0) - np.euler_gamma) + (1.0 - GAP_GAMMA) / GAP_GAMMA * k
    intercept = np.sqrt(2.0) * np.exp(shape)
    q = np.geomspace(1e3, 1e8, 6000)
    c = 1e-20 * (q / 1e3) ** -3.6
    rms = np.sqrt(2.0 * np.pi * np.trapezoid(q * c, q))
    young = 3e6
    assert decay_length(q, c) == pytest.approx(decay * rms, rel=1e-3)
    light = 1e-7 * young
    gap = yang_persson_mean_gap([light], q, c, young)[0]
    beta = light / (young / 0.75) * np.exp(gap / (decay * rms))
    assert beta == pytest.approx(intercept * 1e3 * rms, rel=2e-3)

    law = ExponentialLaw(young, 0.5, 2e-6)
    assert law.decay_length == pytest.approx(decay * 2e-6, rel=0.05)
    assert law.decay_length == pytest.approx(1e-6, rel=1e-12)
    assert law.reference_pressure == pytest.approx(0.375 * young / 0.75, rel=1e-12)
    assert 0.375 / intercept == pytest.approx(
        0.262, abs=0.002
    )  # q0 Rq that the constant stands for
    gaps = np.array([1e-7, 1e-6, 4e-6])
    assert law.mean_gap(law.pressure(gaps)) == pytest.approx(gaps, rel=1e-12)
    assert law.mean_gap(2.0 * law.reference_pressure) == pytest.approx(-law.decay_length)


@pytest.mark.parametrize("scales", [30, 300, 3000])
def test_the_exponential_law_follows_the_theory_up_to_its_tested_range(scales):
    """For q0 Rq = 0.26, what its constant stands for."""
    rms = 10e-6
    q, c = spectrum(rms, 0.26 / rms, 0.26 / rms * scales)
    law = ExponentialLaw(3e6, 0.5, rms)
    end = law.reference_pressure
    assert law.breaches(pressure=end, speed=0.0) == []
    assert law.breaches(pressure=1.01 * end, speed=0.0)
    pressure = end * np.geomspace(0.01, 1.0, 9)
    theory = yang_persson_mean_gap(pressure, q, c, 3e6)
    assert law.mean_gap(pressure) == pytest.approx(theory, abs=0.2 * rms)
    assert theory[-1] == pytest.approx(0.05 * rms, abs=0.02 * rms)


def test_pressure_gap_laws_present_themselves():
    law = ExponentialLaw(3e6, 0.5, 2e-6)
    assert len(repr(law)) < 200
    frame = law.to_frame()
    assert frame["mean gap m"].to_numpy() == pytest.approx(law.mean_gap(frame["pressure Pa"]))
    assert "exponential" in law.summary()
    assert "<table>" in law._repr_html_()
