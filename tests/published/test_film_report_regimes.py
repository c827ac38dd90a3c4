"""Lubrication regimes of the report's pin-on-disk (G.2, Fig. 19), from its printed inputs."""

import numpy as np
import pytest

from underfoot.film import (
    FilmRegime,
    Lubrication,
    film_regime,
    lubrication_by_lambda,
    soft_ehl,
)

SPEEDS = np.array([0.05, *np.arange(1, 11) / 10])
PIN = {"load": 20.9, "radius": 23.3e-3, "effective_modulus": 2.0e6}
RQ = (8.2e-6, 1.34e-6)
VISCOSITY = {
    "water": 0.52e-3,
    "detergent 1.5 %": 1.8e-3,
    "glycerol 25 %": 1.9e-3,
    "glycerol 50 %": 5.54e-3,
    "glycerol 75 %": 41e-3,
    "canola oil": 74.6e-3,
}
# worked out independently from the report's inputs: the ratio at 1 m/s, two decimals
LAMBDA = dict(zip(VISCOSITY, (0.12, 0.27, 0.28, 0.57, 2.08, 3.07), strict=True))


def ratios(fluid, speed_is="sliding", **change):
    film = soft_ehl(viscosity=VISCOSITY[fluid], speed=SPEEDS, speed_is=speed_is, **(PIN | change))
    return film.lambda_ratio(*RQ)


def regimes(fluid, **more):
    return [lubrication_by_lambda(value) for value in ratios(fluid, **more)]


@pytest.mark.parametrize("fluid", VISCOSITY)
def test_lambda_at_one_metre_per_second(fluid):
    assert ratios(fluid)[-1] == pytest.approx(LAMBDA[fluid], abs=0.006)


@pytest.mark.parametrize("fluid", ["water", "detergent 1.5 %", "glycerol 25 %", "glycerol 50 %"])
def test_boundary_lubrication_at_every_speed(fluid):
    """Stated for the first three; 'primarily boundary' covers the fourth."""
    assert set(regimes(fluid)) == {Lubrication.BOUNDARY}


@pytest.mark.parametrize("fluid", ["glycerol 75 %", "canola oil"])
@pytest.mark.parametrize("speed_is", ["sliding", "entrainment"])
def test_boundary_to_mixed_with_speed(fluid, speed_is):
    found = regimes(fluid, speed_is=speed_is)
    assert found[0] == Lubrication.BOUNDARY
    assert Lubrication.MIXED in found
    assert [*Lubrication].index(found[-1]) >= 1


def test_where_mixed_lubrication_begins():
    for fluid, begins in (("glycerol 75 %", 0.32), ("canola oil", 0.18)):
        fine = np.linspace(0.05, 1, 951)
        film = soft_ehl(viscosity=VISCOSITY[fluid], speed=fine, speed_is="sliding", **PIN)
        first = fine[np.argmax(film.lambda_ratio(*RQ) >= 1)]
        assert first == pytest.approx(begins, abs=0.01)


def test_canola_touches_full_film_only_by_the_sliding_speed():
    """lambda 3.07 at 1 m/s with the report's use of the sliding speed, 1.96 with the mean one."""
    assert regimes("canola oil")[-1] == Lubrication.FULL_FILM
    assert regimes("canola oil")[-2] == Lubrication.MIXED
    assert regimes("canola oil", speed_is="entrainment")[-1] == Lubrication.MIXED


@pytest.mark.parametrize("fluid", VISCOSITY)
def test_radius_as_printed_leaves_every_fluid_in_boundary_lubrication(fluid):
    """With R' in micrometres neither mixed statement comes out."""
    assert ratios(fluid, radius=23.3e-6).max() < 0.02


def test_detergent_and_quarter_glycerol_appear_merged():
    assert ratios("glycerol 25 %") == pytest.approx(ratios("detergent 1.5 %"), rel=0.04)


def test_water_is_lowest():
    assert all((ratios("water") < ratios(other)).all() for other in list(VISCOSITY)[1:])


@pytest.mark.parametrize("fluid", VISCOSITY)
def test_isoviscous_elastic(fluid):
    """The report places the contact there by the map of Esfahanian and Hamrock."""
    given = {"viscosity": VISCOSITY[fluid], "entrainment_speed": 0.5, **PIN}
    found, films = film_regime(**given)
    assert found == FilmRegime.ISOVISCOUS_ELASTIC
    assert films[found] > 100 * films[FilmRegime.ISOVISCOUS_RIGID]
    # an oil's answer to pressure (2e-8 1/Pa) does not matter at rubber's pressures
    assert film_regime(**given, pressure_viscosity=2e-8)[0] == FilmRegime.ISOVISCOUS_ELASTIC


def test_the_formula_is_used_outside_its_fit():
    film = soft_ehl(viscosity=74.6e-3, speed=1.0, **PIN)
    assert {breach.quantity for breach in film.breaches} == {
        "dimensionless speed U",
        "dimensionless load W",
    }
