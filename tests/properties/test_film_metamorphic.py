"""One soft film, told in other units and by its exponents."""

import numpy as np
import pytest

from underfoot.film import FilmRegime, effective_modulus, film_regime, lambda_ratio, soft_ehl

BALL = {"load": 10.0, "radius": 0.01, "effective_modulus": 1e7}
WET = {"viscosity": 0.1, **BALL}


@pytest.mark.parametrize("length", [1e3, 0.0254])
def test_lengths_in_another_unit(length):
    """Pa s and Pa hold 1/m: forces in newtons stay."""
    other = {
        "viscosity": 0.1 / length**2,
        "load": 10.0,
        "radius": 0.01 * length,
        "effective_modulus": 1e7 / length**2,
    }
    one, two = soft_ehl(speed=0.5, **WET), soft_ehl(speed=0.5 * length, **other)
    assert float(two.minimum) == pytest.approx(length * float(one.minimum), rel=1e-12)
    assert float(two.central) == pytest.approx(length * float(one.central), rel=1e-12)
    oil = {"radius_ratio": 2.0}
    _, films = film_regime(entrainment_speed=0.25, pressure_viscosity=2e-8, **oil, **WET)
    _, others = film_regime(
        entrainment_speed=0.25 * length, pressure_viscosity=2e-8 * length**2, **oil, **other
    )
    assert list(others) == list(films) == list(FilmRegime)
    for regime, film in films.items():
        assert others[regime] == pytest.approx(length * film, rel=1e-12)


@pytest.mark.parametrize(
    ("quantity", "minimum", "central"),
    [("speed", 0.65, 0.64), ("viscosity", 0.65, 0.64), ("load", -0.21, -0.22)],
)
def test_a_film_grows_by_the_exponents_of_its_source(quantity, minimum, central):
    given = {"speed": 0.5, **WET}
    one, two = soft_ehl(**given), soft_ehl(**{**given, quantity: 3.0 * given[quantity]})
    assert float(two.minimum / one.minimum) == pytest.approx(3.0**minimum, rel=1e-12)
    assert float(two.central / one.central) == pytest.approx(3.0**central, rel=1e-12)


def test_the_sliding_speed_as_it_is_makes_a_film_of_twice_the_speed():
    sliding = soft_ehl(speed=0.5, speed_is="sliding", **WET)
    entrained = soft_ehl(speed=1.0, speed_is="entrainment", **WET)
    assert float(sliding.entrainment_speed) == float(entrained.entrainment_speed) == 0.5
    assert float(sliding.minimum) == float(entrained.minimum)


@pytest.mark.parametrize(
    ("number", "low", "high"),
    [
        ("dimensionless speed U", 0.5e-8, 5.1e-8),
        ("dimensionless load W", 0.2e-3, 2.2e-3),
        ("ellipticity k", 1.0, 12.0),
    ],
)
def test_a_film_is_within_its_fit_from_end_to_end_and_nowhere_else(number, low, high):
    """U = eta u / (E' R') and W = F / (E' R'^2), of which the others are held inside."""

    def beyond(value):
        numbers = {"dimensionless speed U": 2e-8, "dimensionless load W": 1e-3}
        numbers |= {"ellipticity k": 3.0, number: value}
        speed, load, k = numbers.values()
        film = soft_ehl(
            viscosity=0.1, speed=2 * speed * 1e7 * 0.01 / 0.1, load=load * 1e7 * 0.01**2,
            radius=0.01, effective_modulus=1e7, ellipticity=k,
        )  # fmt: skip
        return [breach.quantity for breach in film.breaches]

    assert beyond(1.001 * low) == beyond(0.999 * high) == []
    assert beyond(0.999 * low) == beyond(1.001 * high) == [number]


def test_regimes_at_a_radius_ratio_by_hand():
    _, films = film_regime(entrainment_speed=0.25, pressure_viscosity=2e-8, radius_ratio=2.0, **WET)
    u, w, k = 0.1 * 0.25 / 1e5, 10.0 / 1e3, 2.0 ** (2 / np.pi)
    gv, ge = 2e-8 * 1e7 * w**3 / u**2, w ** (8 / 3) / u**2
    grouped = [
        256 * 0.75**2 * (0.131 * np.pi / 4 + 1.683) ** 2,
        8.70 * ge**0.67 * (1 - 0.85 * np.exp(-0.31 * k)),
        141 * gv**0.375 * (1 - np.exp(-0.0774)),
        3.42 * gv**0.49 * ge**0.17 * (1 - np.exp(-0.68 * k)),
    ]
    expected = np.array(grouped) * 0.01 * (u / w) ** 2
    np.testing.assert_allclose(list(films.values()), expected, rtol=1e-12)


def test_lambda_needs_one_rough_wall_and_no_more():
    assert float(lambda_ratio(6e-6, 0.0, 3e-6)) == pytest.approx(2.0)
    assert float(lambda_ratio(6e-6, 3e-6, 0.0)) == pytest.approx(2.0)
    assert effective_modulus(3e6, 0.5) == pytest.approx(8e6)
