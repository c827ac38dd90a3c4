"""Warmth of a film: how fast fluids thin, the heat of sliding, and what it does to a full film."""

import math

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute.run import run
from underfoot.fluid.temperature import (
    FLOOR,
    ROOM,
    ROOM_DEVIATION,
    SOLE,
    sliding_heat,
    viscosity_slope,
)


def test_fluids_thin_as_tables_say():
    """Water 1.0016 and 0.8900 mPa s at 20 and 25 C; oils between 21 and 30 kJ/mol."""
    assert viscosity_slope(0.95e-3) == pytest.approx(math.log(1.0016 / 0.8900) / 5, rel=0.05)
    low, high = (energy / 8.314 / ROOM**2 for energy in (21e3, 30e3))
    assert low < viscosity_slope(75e-3, oil=True) < high
    slopes = [viscosity_slope(viscosity) for viscosity in (1e-3, 5e-3, 40e-3, 0.22, 1.0)]
    assert slopes == sorted(slopes)
    # 90 % glycerol by mass: 219 mPa s at 20 C and 109 at 30 C (Segur and Oberstar 1951)
    assert viscosity_slope(0.18) == pytest.approx(math.log(219 / 109) / 10, rel=0.06)


def test_a_room_is_anywhere_between_its_two_temperatures():
    every = np.linspace(20.0, 25.0, 100_001) + 273.15
    assert (every.mean(), every.std()) == pytest.approx((ROOM, ROOM_DEVIATION), rel=1e-4)


def test_the_heat_of_sliding_is_that_of_conduction_into_both_faces():
    """Explicit differences in both half-spaces of one conductivity, unit effusivity each."""
    cof, pressure, speed, length = 0.1, 2e5, 0.7, 0.05
    time, flux = length / speed, cof * pressure * speed
    step = 0.02 * math.sqrt(time)  # diffusivity and heat capacity 1 in units of effusivity
    pause = 0.25 * step**2
    temperature = np.zeros(400)
    for _ in range(round(time / pause)):
        change = np.diff(temperature, append=0.0) - np.diff(temperature, prepend=0.0)
        change[0] = temperature[1] - temperature[0] + flux * step
        temperature += pause / step**2 * change
    surface = temperature[0] + 0.5 * flux * step
    found = sliding_heat(cof, pressure, speed, length)
    assert found * (SOLE + FLOOR) == pytest.approx(surface, rel=0.02)
    assert 3.0 < found < 4.5  # K: one step of a slip tester


@pytest.mark.slow
def test_a_full_film_is_not_exact():
    case = Case.load("examples/work_shoe_untreaded_glycerol.toml")
    full = case.replace({"contaminant.viscosity": "1 Pa*s", "numerics.tread_positions": 1})
    result = run(full, quick=True)
    scalars = result.scalars
    assert scalars["fluid_load"].value > 0.9 * scalars["normal_force"].value
    low, high = scalars["cof"].interval
    assert high / low > 1.25  # a film that is known to 2 % has 1.04
    assert scalars["cof_viscous"].uncertainty > 0.05 * scalars["cof_viscous"].value
    assert "warmth of the film" in result.labels["cof_spread_from"]
    assert "taken as exact" not in result.labels["cof_spread_from"]
    assert np.log(low / scalars["cof"].value) < np.log(0.9)
