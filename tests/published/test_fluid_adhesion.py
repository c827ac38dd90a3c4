"""Eq. 26 with Table 5 of the grant report (Strobel et al. 2012)."""

import math

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.fluid import BLOCKING, AdhesionBlocking, adhesion_blocking, strobel_breaches

PRINTED = {
    "water": (4.3263, 0.0531),
    "detergent 1.5 %": (2.6125, 0.0399),
    "glycerol 25 %": (2.5707, 0.0822),
    "glycerol 50 %": (2.8006, 0.1027),
    "glycerol 75 %": (2.3826, 0.0927),
    "canola oil": (1.7556, 0.0106),
}


def test_table_5():
    assert {name: (fluid.alpha, fluid.beta) for name, fluid in BLOCKING.items()} == PRINTED
    canola = adhesion_blocking("canola oil")
    np.testing.assert_allclose(canola.lubricated_adhesion([0.0, 10.0]), [1.7556, 1.8616])
    # alpha as a COF at 20.9 N: 0.207 for water, 0.084 for canola oil.
    assert adhesion_blocking("water").lubricated_adhesion_cof(0.0) == pytest.approx(0.207, abs=5e-4)
    assert canola.lubricated_adhesion_cof(0.0) == pytest.approx(0.084, abs=5e-4)
    # G.3.2: highest for water, lowest for canola, at any dry adhesion of the tests.
    at = {name: fluid.lubricated_adhesion(10.0) for name, fluid in BLOCKING.items()}
    assert max(at, key=at.__getitem__) == "water"
    assert min(at, key=at.__getitem__) == "canola oil"


def test_force_and_cof_form_agree_at_the_tested_load():
    fluid = adhesion_blocking("glycerol 50 %")
    assert fluid.lubricated_adhesion_cof(8.0 / 20.9) * 20.9 == pytest.approx(
        fluid.lubricated_adhesion(8.0)
    )


def test_uncertainty_and_the_crossover_are_told():
    water = adhesion_blocking("water")
    high = water.estimate(15.0)
    assert high.uncertainty == pytest.approx(1.05 * math.sqrt(math.pi / 2))
    assert high.note == ""
    low = water.estimate(2.0)
    assert low.value > 2.0
    assert "more than the dry adhesion" in low.note
    assert water.lubricated_adhesion(water.crossover) == pytest.approx(water.crossover)


def test_extrapolation_is_marked():
    assert strobel_breaches(normal_force=20.9, speed=0.01, viscosity=1.9e-3) == []
    found = strobel_breaches(normal_force=500.0, speed=0.7, viscosity=0.219)
    assert {breach.quantity for breach in found} == {"normal_force", "speed", "viscosity"}
    assert "500 N" in str(found[0])


@pytest.mark.parametrize(
    "other", [{"normal_force": 30.0}, {"speed": 0.015}, {"viscosity": 0.1}, {"viscosity": 4e-4}]
)
def test_one_load_and_one_speed_were_tested(other):
    told = {"normal_force": 20.9, "speed": 0.01, "viscosity": 1.9e-3} | other
    assert len(strobel_breaches(**told)) == 1


def test_bad_input():
    with pytest.raises(InputError, match="Did you mean"):
        adhesion_blocking("canola")
    with pytest.raises(InputError, match="negative"):
        adhesion_blocking("water").lubricated_adhesion(-1.0)
    with pytest.raises(InputError, match="alpha"):
        AdhesionBlocking(-1.0, 0.1)
