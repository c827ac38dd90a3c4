"""Laws from a table and from trials: exact at the readings, marked beyond them."""

import numpy as np
import pytest

from underfoot.calibrate import stribeck_law_from_fit
from underfoot.core import InputError
from underfoot.friction import (
    FrictionLaw,
    SpeedTableLaw,
    StribeckLaw,
    sampled_cof,
    stribeck_cof,
)
from underfoot.trials.machines.stribeck_fit import stribeck_fit

SPEED = np.array([0.1, 0.2, 0.4, 0.8])
COF = np.array([0.6, 0.5, 0.3, 0.08])


def table(**options):
    return SpeedTableLaw(SPEED, COF, "made up", **options)


def test_readings_are_met_and_the_middle_is_linear_in_log_speed():
    law = table(cof_hysteresis=0.1, viscosity=5e-3)
    assert isinstance(law, FrictionLaw)
    parts = law(2e5, SPEED, 1e-4)
    assert parts.adhesion + parts.hysteresis == pytest.approx(COF * 2e5)
    assert parts.hysteresis == pytest.approx(np.minimum(COF, 0.1) * 2e5)
    assert parts.viscous == pytest.approx(5e-3 * SPEED / 1e-4)
    middle = law(1.0, np.sqrt(0.02), 1e-4)
    assert float(middle.adhesion + middle.hysteresis) == pytest.approx(0.55)


def test_ends_are_kept_and_marked():
    law = table(cof_deviation=[0.01, 0.02, 0.03, 0.04], pressure=(1e5, 3e5))
    assert law(1.0, np.array([0.0, -5.0]), 1e-4).total == pytest.approx([0.6, 0.08])
    found = law.breaches(contact_pressure=5e5, speed=2.0, film_thickness=1e-5)
    assert {one.quantity for one in found} == {"sliding speed", "contact pressure"}
    sampled = sampled_cof(law, [[1e5]], [[0.0]], [[1e-4]], speed=0.2)
    assert sampled.cof.std() == pytest.approx(0.02, rel=0.02)
    assert sampled_cof(table(), [[1e5]], [[0.0]], [[1e-4]], speed=0.2) is None


@pytest.mark.parametrize(
    ("speed", "cof", "options", "word"),
    [
        (SPEED[::-1], COF, {}, "rise"),
        (SPEED, COF[:2], {}, "speeds"),
        (SPEED, -COF, {}, "negative"),
        (SPEED, COF, {"cof_deviation": [0.1, np.nan, 0.1, 0.1]}, "cof_deviation"),
        (SPEED, COF, {"cof_hysteresis": -0.1}, "cof_hysteresis"),
        (SPEED, COF, {"viscosity": 0.0}, "viscosity"),
    ],
)
def test_bad_tables_are_refused(speed, cof, options, word):
    with pytest.raises(InputError, match=word):
        SpeedTableLaw(speed, cof, "made up", **options)


def test_a_fit_of_trials_becomes_the_law_it_was_made_from():
    speed = np.repeat(np.linspace(0.05, 1.0, 12), 3)
    noise = np.random.default_rng(2).normal(0.0, 0.005, speed.size)
    fit = stribeck_fit(speed, stribeck_cof(speed, 0.6, 0.25, 0.12) + noise)
    law = stribeck_law_from_fit(fit, source="made up", viscosity=5e-3)
    assert isinstance(law, StribeckLaw)
    solid = law(1.0, np.array([0.05, 0.5]), 1.0)
    expected = stribeck_cof(np.array([0.05, 0.5]), 0.6, 0.25, 0.12)
    assert solid.adhesion + solid.hysteresis == pytest.approx(expected, abs=0.01)
    spread = sampled_cof(law, [[1e5]], [[0.0]], [[1.0]], speed=0.3).cof.std()
    assert 0.005 < spread < 0.02  # the readings' own noise and that of the fitted numbers


def test_a_flat_fit_is_no_law_of_speed():
    speed = np.repeat(np.linspace(0.05, 1.0, 12), 3)
    flat = 0.16 + np.random.default_rng(3).normal(0.0, 0.02, speed.size)
    with pytest.raises(InputError, match="SpeedTableLaw"):
        stribeck_law_from_fit(stribeck_fit(speed, flat), source="made up")
