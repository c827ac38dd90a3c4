"""What a fit of the reduced model begins with, where it has a value of its own."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.rough_contact import ExponentialLaw
from underfoot.slip.dynamics._kernels import reduced as kernel
from underfoot.slip.dynamics.reduced_model import (
    NAMES,
    SIGNED,
    _area_constants,
    _bounds,
    _gap_decay,
)


@pytest.mark.parametrize("growth", [-4.0, 0.0, 6.0])
def test_the_loaded_area_is_found_again_that_runs_were_made_of(growth):
    """A = 3e-4 m2 (N / 500)^0.7 exp(growth (angle - middle))."""
    load, angle = (each.ravel() for each in np.meshgrid([100, 400, 900], [0.15, 0.2, 0.3]))
    area = 3e-4 * (load / 500) ** 0.7 * np.exp(growth * (angle - 0.2))
    rows = list(zip(load, angle, area, strict=True))
    idle = [(0.0, 0.2, 1.0), (500.0, 0.2, 0.0)]  # a foot in the air tells nothing of its area
    assert _area_constants(rows + idle, 0.2) == pytest.approx((3e-4, 0.7, growth), abs=1e-9)


def test_without_another_angle_the_area_grows_with_none():
    rows = [(load, 0.2, 3e-4 * (load / 500) ** 0.7) for load in (100.0, 400.0, 900.0)]
    assert _area_constants(rows, 0.25) == pytest.approx((3e-4, 0.7, 0.0))


@pytest.mark.parametrize("decay", [2e-6, 3e-5])
def test_asperities_that_fall_by_e_tell_their_decay(decay):
    law = ExponentialLaw(2e6, 0.5, 2 * decay)  # falls by e over half of Rq
    setting = SimpleNamespace(asperities=law)
    assert _gap_decay(cast(Any, setting)) == pytest.approx(2 * decay, rel=1e-6)


def test_a_fit_begins_inside_its_bounds_and_only_what_has_a_sign_may_turn_it():
    guess = np.full(kernel.COUNT, 0.5)
    guess[kernel.START] = 2e-5
    guess[list(SIGNED)] = 0.0
    low, high = _bounds(guess)
    assert np.all(low < guess)
    assert np.all(guess < high)
    signed = np.isin(np.arange(kernel.COUNT), SIGNED)
    assert np.all(low[~signed] > 0)
    np.testing.assert_array_equal(low[signed], -high[signed])


def test_each_constant_of_the_reduced_model_has_a_place_of_its_own():
    places = [getattr(kernel, name.removesuffix("_film").upper()) for name in NAMES]
    assert places == list(range(kernel.COUNT))


@pytest.mark.parametrize("power", [1.0, 2.0, 4.0])
def test_the_decay_is_told_where_the_asperities_bear_a_third_of_a_megapascal(power):
    """p = 3e5 Pa (20 um / h)^n: twice the gap over n at h = 20 um, more or less elsewhere."""

    def pressure(gap):
        return np.where(gap < 3e-4, 3e5 * (20e-6 / gap) ** power, 0.0)  # no contact far away

    law = SimpleNamespace(pressure=pressure, stiffness=lambda gap: power * pressure(gap) / gap)
    found = _gap_decay(cast(Any, SimpleNamespace(asperities=law)))
    assert found == pytest.approx(2 * 20e-6 / power, rel=0.03)
