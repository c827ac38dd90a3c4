"""Closed forms of the film: soft EHL, squeeze times, tapered wedge, flow factors, regimes."""

import itertools
import math

import numpy as np
import pytest

from film_between_walls import closing_film
from underfoot.core import InputError, RangeError
from underfoot.film import (
    FilmRegime,
    Lubrication,
    compare_regimes,
    effective_modulus,
    film_regime,
    fluid_load_share,
    lambda_ratio,
    lubrication_by_lambda,
    lubrication_by_load_share,
    patir_cheng_breaches,
    patir_cheng_mean_gap,
    patir_cheng_pressure_factors,
    patir_cheng_shear_factor,
    patir_cheng_shear_flow,
    radius_of_parabola,
    rectangle_torsion_constant,
    regime_map,
    side_leakage,
    soft_ehl,
    squeeze_gap,
    squeeze_time_disc,
    squeeze_time_rectangle,
    tapered_wedge,
    wedge_film,
    wedge_load_factor,
)
from underfoot.reference import lubrication
from underfoot.rough_contact import ExponentialLaw

BALL = {"viscosity": 0.05, "load": 5.0, "radius": 0.02, "effective_modulus": 4e6}


def test_soft_ehl_is_the_reference_formula():
    film = soft_ehl(speed=0.3, ellipticity=2.0, **BALL)
    central, least = lubrication.soft_ehl_film(entrainment_speed=0.15, ellipticity=2.0, **BALL)
    assert film.central == pytest.approx(central, rel=1e-12)
    assert film.minimum == pytest.approx(least, rel=1e-12)
    sliding = soft_ehl(speed=0.15, speed_is="sliding", ellipticity=2.0, **BALL)
    assert sliding.minimum == pytest.approx(least, rel=1e-12)
    assert soft_ehl(speed=0.0, **BALL).minimum == 0.0


def test_group_form_is_the_same_film():
    """8.70 g_E^0.67 is the same fit in other groups: within a tenth over two decades of speed."""
    for speed in (0.01, 0.1, 1.0):
        direct = soft_ehl(speed=2 * speed, **BALL).minimum
        grouped = film_regime(entrainment_speed=speed, **BALL)[1][FilmRegime.ISOVISCOUS_ELASTIC]
        assert grouped == pytest.approx(float(direct), rel=0.1)


def test_hard_or_fast_contacts_leave_the_soft_regime():
    hard = {**BALL, "effective_modulus": 2e11, "load": 0.01}
    assert film_regime(entrainment_speed=1.0, **hard)[0] == FilmRegime.ISOVISCOUS_RIGID
    steel = {"viscosity": 0.1, "load": 100.0, "radius": 0.01, "effective_modulus": 2.2e11}
    found = film_regime(entrainment_speed=1.0, pressure_viscosity=2e-8, **steel)[0]
    assert found == FilmRegime.PIEZOVISCOUS_ELASTIC


def test_radius_modulus_and_lambda():
    assert radius_of_parabola(1 / (2 * 23.3e-3)) == pytest.approx(23.3e-3)
    assert effective_modulus(2e6, 0.5) == pytest.approx(2e6 * 8 / 3)
    assert lambda_ratio(5e-6, 3e-6, 4e-6) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("end", "times"), [(5e-6, (13e-3, 1.1, 3.2)), (20e-6, (0.8e-3, 67e-3, 0.20))]
)
def test_squeeze_times_under_a_heel(end, times):
    """14 mm disc, 250 N, from 0.6 mm: worked out independently, two digits."""
    found = squeeze_time_disc(
        viscosity=[0.9e-3, 74.6e-3, 219e-3], radius=14e-3, load=250, start_gap=0.6e-3, end_gap=end
    )
    assert found == pytest.approx(times, rel=0.03)


def test_squeeze_gap_inverts_the_time():
    given = {"viscosity": 0.219, "load": 250.0, "start_gap": 0.6e-3}
    time = squeeze_time_disc(radius=14e-3, end_gap=7e-6, **given)
    shape = math.pi / 2 * 14e-3**4
    assert squeeze_gap(time, torsion_constant=shape, **given) == pytest.approx(7e-6)
    exact = lubrication.squeeze_disc_gap(time, radius=14e-3, **given)
    assert squeeze_gap(time, torsion_constant=shape, **given) == pytest.approx(exact)


def test_rectangle_squeeze_against_the_solver():
    """F = 3 eta J v / h^3 of a 6 mm x 10 mm lug; torsion constants of Timoshenko and Goodier."""
    assert rectangle_torsion_constant(1, 1) == pytest.approx(0.1406, abs=5e-5)
    assert rectangle_torsion_constant(1, 2) == pytest.approx(0.229 * 2, abs=1e-3)
    spacing, gap, speed = 1e-4, 1e-4, 1e-3
    field = np.full((61, 101), gap)
    load = closing_film(field, speed, spacing=spacing, viscosity=0.2).load
    shape = rectangle_torsion_constant(6e-3, 10e-3)
    assert load == pytest.approx(3 * 0.2 * shape * speed / gap**3, rel=2e-3)
    given = {"viscosity": 0.2, "load": 50.0, "start_gap": 1e-4, "end_gap": 9e-5}
    time = squeeze_time_rectangle(length=6e-3, width=10e-3, **given)
    mid = 3 * 0.2 * shape / 50 * 1e-5 / 9.5e-5**3
    assert time == pytest.approx(mid, rel=0.01)


@pytest.mark.parametrize("ratio", sorted(lubrication.SIDE_LEAKAGE))
@pytest.mark.parametrize("taper", [1.0, 1.189, 2.0])
def test_side_leakage_table(ratio, taper):
    """Three digits of an independent finite-volume solution."""
    assert side_leakage(ratio, taper) == pytest.approx(
        lubrication.SIDE_LEAKAGE[ratio][taper], abs=6e-4
    )


@pytest.mark.parametrize(
    ("ratio", "peak"), [(0.25, 0.0425), (0.5, 0.0394), (1, 0.0272), (2, 0.0126), (4, 0.0046)]
)
def test_peak_pressure_of_the_best_wedge(ratio, peak):
    """p_max h0^2 / (6 eta u l) of the same independent solution."""
    wedge = tapered_wedge(
        viscosity=0.1,
        speed=0.5,
        length=0.01,
        width=0.01 / ratio,
        leading_gap=2.189e-5,
        trailing_gap=1e-5,
    )
    unit = 6 * 0.1 * 0.5 * 0.01 / 1e-10
    assert wedge.peak_pressure / unit == pytest.approx(peak, abs=6e-5)
    assert 0 < wedge.pressure_centre < 0.005


def test_tapered_wedge_limits():
    given = {"viscosity": 0.1, "speed": 0.5, "length": 0.01}
    gaps = {"leading_gap": 3e-5, "trailing_gap": 1e-5}
    wide = tapered_wedge(width=100.0, **given, **gaps)
    infinite = lubrication.inclined_bearing_load(**given, **gaps)
    assert wide.load / 100.0 == pytest.approx(infinite, rel=1e-4)
    # narrow: p = 3 eta u h' (b^2 / 4 - y^2) / h^3, so F = eta u b^3 / 4 (1/h0^2 - 1/h1^2)
    narrow = tapered_wedge(width=2e-5, **given, **gaps)
    short = 0.1 * 0.5 * (2e-5) ** 3 / 4 * (1e10 - 1 / 9e-10)
    assert narrow.load == pytest.approx(short, rel=0.02)


def test_wedge_film_carries_the_load():
    given = {"viscosity": 0.2, "speed": 0.5, "length": 0.02, "width": 0.03}
    h0 = wedge_film(load=200.0, taper=1.5, **given)
    wedge = tapered_wedge(leading_gap=2.5 * h0, trailing_gap=h0, **given)
    assert wedge.load == pytest.approx(200.0, rel=1e-9)


def test_wedge_load_factor():
    assert wedge_load_factor(1.189) == pytest.approx(0.02671, abs=5e-6)
    assert wedge_load_factor(1.189) > max(wedge_load_factor(1.15), wedge_load_factor(1.23))
    for taper in (1e-4, 3e-3, 0.00999, 0.01001, 0.05):
        terms = [
            (-1) ** (k + 1) * (1 / k - 2.0 ** (1 - k)) * taper ** (k - 2) for k in range(3, 12)
        ]
        assert wedge_load_factor(taper) == pytest.approx(sum(terms), rel=1e-7), taper
    assert wedge_load_factor(0.0099999) == pytest.approx(wedge_load_factor(0.0100001), rel=3e-5)


def test_patir_cheng_pressure_factors():
    # isotropic: 1 - 0.9 exp(-0.56 H), as public bearing codes have it
    phi = patir_cheng_pressure_factors([1e-6, 3e-6], 1e-6)
    assert phi[0] == pytest.approx(1 - 0.9 * np.exp([-0.56, -1.68]))
    assert phi[1] == pytest.approx(phi[0])
    # turned by a right angle, the directions change places
    along, across = patir_cheng_pressure_factors(2e-6, 1e-6, anisotropy=5.0)
    turned = patir_cheng_pressure_factors(2e-6, 1e-6, anisotropy=0.2)
    assert along == pytest.approx(turned[1])
    assert across == pytest.approx(turned[0])
    assert along > 1 > across
    # a published log-linear fit of C and r for gamma below 1 (public bearing code)
    for gamma in (1 / 9, 1 / 6, 1 / 3):
        c, r = 0.89679 - 0.26591 * math.log(gamma), 0.43006 - 0.10828 * gamma + 0.23821 * gamma**2
        fit = 1 - c * math.exp(-r * 3)
        found = patir_cheng_pressure_factors(3e-6, 1e-6, anisotropy=gamma)[0]
        assert found == pytest.approx(fit, abs=0.01)
    assert patir_cheng_pressure_factors(1e-3, 1e-6)[0] == pytest.approx(1)
    assert len(patir_cheng_breaches([0.2e-6, 1e-6], 1e-6)) == 1
    assert patir_cheng_breaches(1e-6, 1e-6) == []


@pytest.mark.parametrize("gamma", [1 / 9, 1 / 6, 1 / 3, 1, 3, 6, 9])
def test_shear_factor_is_continuous_and_fades(gamma):
    before, after = patir_cheng_shear_factor([4.9999e-6, 5.0001e-6], 1e-6, anisotropy=gamma)
    assert after == pytest.approx(before, rel=2e-3)
    assert patir_cheng_shear_factor(1e-4, 1e-6, anisotropy=gamma) < 1e-9


def test_shear_factor_by_the_table_and_between_its_rows():
    """At H = 1 A1 exp(alpha3 - alpha2), at H = 8 A2 exp(-2); between rows linear in ln gamma."""
    near = {1 / 9: 0.9665, 1 / 6: 0.9361, 1 / 3: 0.8954, 1: 0.7956, 3: 0.5459, 6: 0.4698, 9: 0.3757}
    far = {1 / 9: 0.2512, 1 / 6: 0.2374, 1 / 3: 0.2113, 1: 0.1524, 3: 0.0752, 6: 0.0525, 9: 0.0399}
    for gap, table in ((1e-6, near), (8e-6, far)):

        def factor(gamma, gap=gap):
            return float(patir_cheng_shear_factor(gap, 1e-6, anisotropy=gamma))

        assert [factor(gamma) for gamma in table] == pytest.approx([*table.values()], abs=1e-4)
        for low, high in itertools.pairwise(table):
            middle = factor(math.sqrt(low * high))
            assert middle == pytest.approx((factor(low) + factor(high)) / 2)


def test_shear_flow_of_two_walls():
    assert patir_cheng_shear_flow(3e-6, 1e-6, 1e-6) == 0.0
    rough_above = patir_cheng_shear_flow(3e-6, 1e-6, 0.2e-6)
    assert rough_above > 0
    assert patir_cheng_shear_flow(3e-6, 0.2e-6, 1e-6) == pytest.approx(-rough_above)
    assert patir_cheng_shear_flow(3e-6, 0.0, 0.0) == 0.0


def test_mean_gap_of_gaussian_walls():
    heights = np.random.default_rng(0).normal(size=400_000) * 1e-6
    for gap in (0.5e-6, 2e-6):
        exact = np.maximum(gap + heights, 0).mean()
        assert patir_cheng_mean_gap(gap, 1e-6) == pytest.approx(exact, rel=5e-3)
    assert patir_cheng_mean_gap(1e-5, 1e-6) == pytest.approx(1e-5)


def test_regimes_and_why_they_differ():
    assert lubrication_by_lambda(0.99) == Lubrication.BOUNDARY
    assert lubrication_by_lambda(1.0) == Lubrication.MIXED
    assert lubrication_by_lambda(3.1) == Lubrication.FULL_FILM
    assert lubrication_by_load_share(0.05) == Lubrication.BOUNDARY
    assert lubrication_by_load_share(0.95) == Lubrication.FULL_FILM
    assert compare_regimes(2.0, 0.5).agree
    thick, thin = compare_regimes(0.8, 0.95), compare_regimes(3.5, 0.4)
    assert not thick.agree
    assert "flatten" in thick.why
    assert not thin.agree
    assert "summits" in thin.why


def test_regime_map_against_its_parts():
    law = ExponentialLaw(2e6, 0.5, 8.2e-6)
    viscosity, speed = [1e-3, 0.1, 10.0], [0.1, 1.0]
    pin = {"load": 20.9, "radius": 23.3e-3, "effective_modulus": 2e6}
    found = regime_map(
        viscosity, speed, rq_first=8.2e-6, rq_second=1.34e-6, law=law, mean_pressure=266e3, **pin
    )
    film = soft_ehl(viscosity=0.1, speed=1.0, **pin)
    assert found.lambda_ratio[1, 1] == pytest.approx(film.lambda_ratio(8.2e-6, 1.34e-6))
    assert found.fluid_share[1, 1] == pytest.approx(fluid_load_share(film.central, law, 266e3))
    assert (np.diff(found.fluid_share, axis=0) >= 0).all()
    assert found.fluid_share[0, 0] == 0.0
    assert found.fluid_share[2, 1] > 0.9


@pytest.mark.parametrize(
    ("call", "where"),
    [
        (lambda: soft_ehl(speed=0.1, **BALL | {"viscosity": 0.0}), "viscosity"),
        (lambda: soft_ehl(speed=-0.1, **BALL), "speed"),
        (lambda: soft_ehl(speed=0.1, speed_is="slidding", **BALL), "speed_is"),
        (lambda: effective_modulus(1e6, 0.6), "poisson_ratio"),
        (lambda: lambda_ratio(1e-6, 0.0, 0.0), "rq_first"),
        (lambda: film_regime(entrainment_speed=0.0, **BALL), "entrainment_speed"),
        (lambda: lubrication_by_load_share(1.2), "fluid_share"),
        (lambda: lubrication_by_lambda(math.nan), "lambda_ratio"),
        (lambda: patir_cheng_pressure_factors(0.0, 1e-6), "gap"),
        (lambda: patir_cheng_pressure_factors(1e-6, math.inf), "rq"),
        (lambda: side_leakage(-1.0, 1.0), "length_over_width"),
        (lambda: wedge_load_factor(0.0), "taper"),
        (
            lambda: squeeze_time_disc(
                viscosity=0.1, radius=0.01, load=1.0, start_gap=1e-5, end_gap=1e-4
            ),
            "end_gap",
        ),
        (
            lambda: squeeze_time_disc(
                viscosity=0.1, radius=0.01, load=0.0, start_gap=1e-4, end_gap=1e-5
            ),
            "load",
        ),
        (
            lambda: tapered_wedge(
                viscosity=0.1,
                speed=0.5,
                length=0.01,
                width=0.01,
                leading_gap=1e-5,
                trailing_gap=2e-5,
            ),
            "leading_gap",
        ),
        (
            lambda: regime_map(
                0.1,
                1.0,
                load=1.0,
                radius=0.01,
                effective_modulus=1e6,
                rq_first=1e-6,
                rq_second=0.0,
                mean_pressure=1e5,
            ),
            "law",
        ),
    ],
)
def test_bad_input_names_its_place(call, where):
    with pytest.raises(InputError) as caught:
        call()
    assert caught.value.where == where


def test_anisotropy_beyond_the_table():
    with pytest.raises(RangeError, match="1/9 to 9"):
        patir_cheng_shear_factor(1e-6, 1e-6, anisotropy=20.0)


@pytest.mark.parametrize(("gamma", "beyond"), [(9.0, 9.001), (1 / 9, 0.999 / 9)])
def test_the_table_of_anisotropy_ends_at_nine(gamma, beyond):
    """A ratio of lengths that is 9 but for rounding is still in it."""
    for of in (patir_cheng_pressure_factors, patir_cheng_shear_factor):
        assert np.isfinite(of(3e-6, 1e-6, anisotropy=gamma * (1 + 1e-12))).all()
        assert np.isfinite(of(3e-6, 1e-6, anisotropy=gamma * (1 - 1e-12))).all()
        with pytest.raises(RangeError, match="1/9 to 9"):
            of(3e-6, 1e-6, anisotropy=beyond)


def test_patir_cheng_factors_are_linear_in_the_logarithm_of_gamma():
    def along(gamma):
        return float(patir_cheng_pressure_factors(3e-6, 1e-6, anisotropy=gamma)[0])

    assert along(math.sqrt(3)) == pytest.approx((along(1) + along(3)) / 2)
    assert along(math.sqrt(18)) == pytest.approx((along(3) + along(6)) / 2)
