"""Closed forms behind the speed effect: spectrum, Hertz, shared load, by hand, sampling."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from underfoot.core import InputError, RangeError, SourcedValue
from underfoot.friction import (
    AsperityEHL,
    MeanFilmSharing,
    ShearStrength,
    ViscoelasticArea,
    modulus_exponent,
    propagate_spread,
    self_affine_scale,
    shear_strength_from_cof,
    spectrum_scale,
)
from underfoot.friction.speed_effect import fluid_share
from underfoot.reference import hertz_point, soft_ehl_film
from underfoot.surface import IsotropicSpectrum, asperities, spectral_moments

RQ, LONG, HURST = 8e-6, 0.8e-3, 0.8


def density(q):
    """Isotropic spectrum, mean square Rq^2 (q/q0)^(-2H) beyond q."""
    return HURST * RQ**2 / math.pi * (2 * math.pi / LONG) ** (2 * HURST) * q ** (-2 * HURST - 2)


def test_self_affine_moments_against_quadrature():
    scale = self_affine_scale(5e-6, rq=RQ, longest_wave=LONG, hurst=HURST)
    low, high = 2 * math.pi / LONG, 2 * math.pi / 5e-6

    def moment(order, a, b):
        # over ln q: the spectrum spans many decades
        return quad(
            lambda x: 2 * math.pi * math.exp(x) ** (order + 2) * density(math.exp(x)),
            math.log(a), math.log(b), epsrel=1e-10, limit=200,
        )[0]  # fmt: skip

    assert scale.slope == pytest.approx(math.sqrt(moment(2, low, high)), rel=1e-8)
    fourth = 3 / 8 * moment(4, low, high)
    assert scale.radius == pytest.approx(3 * math.sqrt(math.pi) / (8 * math.sqrt(fourth)), rel=1e-8)
    assert scale.fine_roughness == pytest.approx(math.sqrt(moment(0, high, 1e4 * high)), rel=1e-5)


def test_a_measured_spectrum_gives_the_asperities_of_the_surface_room():
    q = np.geomspace(2 * math.pi / LONG, 2 * math.pi / 1e-6, 4000)
    edges = np.concatenate(([q[0]], np.sqrt(q[1:] * q[:-1]), [q[-1]]))
    spectrum = IsotropicSpectrum(q, density(q), np.pi * np.diff(edges**2), (q[0], q[-1]))
    found = spectrum_scale(5e-6, spectrum)
    moments = spectral_moments(spectrum, (q[0], 2 * math.pi / 5e-6))
    assert found.radius == pytest.approx(asperities(moments).radius, rel=1e-12)
    exact = self_affine_scale(5e-6, rq=RQ, longest_wave=LONG, hurst=HURST)
    assert found.radius == pytest.approx(exact.radius, rel=2e-3)
    assert found.slope == pytest.approx(exact.slope, rel=2e-3)
    with pytest.raises(RangeError, match="no spectrum on one side"):
        spectrum_scale(1e-6, spectrum)
    for last, enough in ((-3, True), (-2, False), (1, True), (0, False)):  # two on either side
        wave = 2 * math.pi / (1.001 * q[last])
        if enough:
            assert spectrum_scale(wave, spectrum).radius > 0
        else:
            with pytest.raises(RangeError, match="no spectrum on one side"):
                spectrum_scale(wave, spectrum)


def test_the_film_is_that_of_a_hertz_contact_with_the_spots_pressure():
    """Load and mean pressure of the asperity agree with Hertz; the film with Eq. 18."""
    scale = self_affine_scale(2.5e-6, rq=RQ, longest_wave=LONG)
    modulus, pressure, viscosity, speed = 2e6, 2e5, 5e-3, 0.4
    stiffness = modulus / 0.75
    spot = float(scale.spot_pressure(pressure / stiffness)) * stiffness
    load = 9 * math.pi**3 / 32 * (spot / stiffness) ** 3 * 2 * stiffness * scale.radius**2
    hertz = hertz_point(load, scale.radius, stiffness)
    assert load / (math.pi * hertz.half_width**2) == pytest.approx(spot, rel=1e-9)
    film = AsperityEHL(scale, modulus).film_thickness(
        viscosity=viscosity, speed=speed, contact_pressure=pressure
    )
    _, least = soft_ehl_film(
        viscosity=viscosity, entrainment_speed=speed / 2, load=load, radius=scale.radius,
        effective_modulus=2 * stiffness,
    )  # fmt: skip
    assert float(film) == pytest.approx(least, rel=1e-12)
    bearing = AsperityEHL(scale, modulus, 0.5, 20e-9).adhesion_left(
        viscosity=viscosity, speed=speed, contact_pressure=pressure
    )
    assert float(bearing) == pytest.approx(math.erfc(least / (math.sqrt(2) * 20e-9)))


def test_shared_load_satisfies_its_equation_and_its_limits():
    film, dry = np.meshgrid(np.geomspace(1e-4, 20.0, 40), np.array([0.0, 0.3, 1.3]))
    share = fluid_share(film, dry)
    residual = (1 - share) - np.exp(-(film * share**-0.65 - dry))
    assert np.abs(residual).max() < 1e-12
    assert np.all(np.diff(share, axis=1) >= 0)
    # a thin film holds the dry gap open: f = (h_full / h_dry)^(1 / 0.65)
    assert float(fluid_share(1e-4, 1.3)) == pytest.approx((1e-4 / 1.3) ** (1 / 0.65), rel=2e-3)
    assert float(fluid_share(50.0, 1.3)) == pytest.approx(1.0)
    assert float(fluid_share(0.0, 1.3)) == 0.0


def test_mean_film_with_a_thick_film_leaves_nothing_and_matches_eq_18():
    rival = MeanFilmSharing(23.3e-3, 20.9, 2e6, 8.3e-6, entrainment=1.0)
    _, least = soft_ehl_film(
        viscosity=41e-3, entrainment_speed=1.0, load=20.9, radius=23.3e-3, effective_modulus=2e6
    )
    assert float(rival.film_thickness(viscosity=41e-3, speed=1.0)) == pytest.approx(least)
    assert least / 8.31e-6 == pytest.approx(2.08, abs=0.01)  # lambda of 75 % glycerol at 1 m/s
    left = rival.adhesion_left(viscosity=10.0, speed=1.0, contact_pressure=1e5)
    assert float(left) == pytest.approx(0.0, abs=1e-9)


def test_viscoelastic_area_by_hand():
    assert ViscoelasticArea(0.2).adhesion_left(
        viscosity=1.0, speed=np.array([0.0, 0.31]), contact_pressure=1e5
    ) == pytest.approx([1.0, 32.0**-0.2])
    assert modulus_exponent(lambda w: 1e6 * w**0.15, 1.0, 1e4) == pytest.approx(0.15)
    assert modulus_exponent(lambda w: np.full(w.shape, 1e6), 1.0, 1e4) == 0.0


def test_shear_strength_from_a_measured_adhesion():
    found = shear_strength_from_cof(0.4, 2.661e5, 0.35, "made up")
    assert found(0.3) == pytest.approx(0.4 * 2.661e5 / 0.35)
    bell = ShearStrength(1e6, "made up", width=0.1, peak_speed=0.01)
    assert bell(np.array([1.0, 1e-4])) == pytest.approx(1e6 * math.exp(-0.4))
    with pytest.raises(InputError, match="real_contact_fraction"):
        shear_strength_from_cof(0.4, 1e5, 0.0, "made up")


A = SourcedValue(2.0, "1", "made up", 0.1)
B = SourcedValue(5.0, "1", "made up", 0.2)
EXACT = SourcedValue(1.0, "1", "made up")


def test_propagation_of_a_sum_is_that_of_variances():
    found = propagate_spread(
        lambda v: [v["a"] + v["b"], v["a"] - v["b"] + v["c"]], {"a": A, "b": B, "c": EXACT},
        model_deviation=0.3, samples=8000, seed=1,
    )  # fmt: skip
    whole = math.sqrt(0.1**2 + 0.2**2 + 0.3**2)
    assert found.value == pytest.approx([7.0, -2.0])
    assert found.deviation == pytest.approx([whole, whole], rel=0.03)
    assert found.high - found.low == pytest.approx([3.92 * whole] * 2, rel=0.05)
    assert found.share == pytest.approx({"a": 1 / 14, "b": 4 / 14, "model": 9 / 14}, abs=0.03)
    assert found.left_out == ("c",)


def test_the_same_seed_gives_the_same_interval_and_another_one_does_not():
    run = [
        propagate_spread(lambda v: v["a"] ** 2, {"a": A}, samples=300, seed=s).low
        for s in (3, 3, 4)
    ]
    assert run[0] == run[1]
    assert run[0] != run[2]


def test_a_wide_positive_input_stays_positive():
    """tau of 50 % glycerol: 0.19 with a spread of 0.17 (G.2.2); a normal draw goes below 0."""
    tau = SourcedValue(0.19, "m/s", "report G.2.2", 0.17)
    found = propagate_spread(lambda v: v["tau"], {"tau": tau}, samples=20000, seed=0)
    assert found.low > 0
    assert float(found.deviation) == pytest.approx(0.17, rel=0.05)


@pytest.mark.parametrize(
    ("function", "inputs", "options", "word"),
    [
        (lambda v: v["a"], {"a": SourcedValue(None, reason="not measured")}, {}, "not measured"),
        (lambda v: v["a"], {"a": A}, {"samples": 5}, "samples"),
        (lambda v: math.nan, {"a": A}, {}, "not finite"),
        (lambda v: v["a"], {"a": A}, {"confidence": 1.0}, "confidence"),
    ],
)
def test_bad_propagation_is_refused(function, inputs, options, word):
    with pytest.raises(InputError, match=word):
        propagate_spread(function, inputs, **options)
