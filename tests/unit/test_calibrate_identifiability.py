"""Profiles of a misfit: what data fix and what they leave open."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from underfoot.core import InputError
from underfoot.studies.identifiability import (
    Fixed,
    chi_square,
    limit,
    model_error,
    profile,
)

GRID = np.linspace(-3.0, 5.0, 801)


def test_the_interval_of_a_mean_is_1_96_standard_errors():
    data, deviation = np.array([0.4, 1.0, 1.6, 1.2]), 0.5
    misfit = chi_square(GRID[:, None], data, deviation)
    found = profile("mean", "m", GRID, misfit, data=4)
    half = 1.959964 * deviation / 2
    assert found.fixed is Fixed.FIXED
    assert found.best == pytest.approx(data.mean(), abs=0.006)
    assert found.low == pytest.approx(data.mean() - half, abs=2e-3)
    assert found.high == pytest.approx(data.mean() + half, abs=2e-3)


def test_two_parameters_in_one_sum_are_not_identifiable():
    a = np.linspace(0.0, 2.0, 41)
    misfit = chi_square((a[:, None] + a[None, :])[..., None], [2.0], 0.1)
    found = profile("a", "1", a, misfit, data=1)
    assert found.fixed is Fixed.NOT_IDENTIFIABLE
    assert found.best is None
    assert found.text() == "not identifiable"


def test_one_open_side_is_a_bound_without_a_number():
    x = np.linspace(0.0, 10.0, 201)
    found = profile("x", "1", x, chi_square(np.exp(-x)[:, None], [0.0], 0.1), data=1)
    assert found.fixed is Fixed.LOWER_BOUND
    assert found.best is None
    assert found.low == pytest.approx(-np.log(0.1 * np.sqrt(3.8415)), abs=0.02)
    assert found.text().startswith("above 1.6")


def test_a_wrong_model_gives_no_value():
    x = np.linspace(0.0, 1.0, 11)
    misfit = chi_square(np.stack([x, -x], axis=-1), [5.0, 5.0], 0.1)
    found = profile("x", "1", x, misfit, data=2)
    assert found.fixed is Fixed.REFUTED
    assert found.best is None
    assert found.misfit > limit(2)


@given(st.floats(-1, 3), st.floats(0.05, 0.6))
def test_tighter_data_never_widen_the_interval(truth, deviation):
    wide = profile("x", "1", GRID, chi_square(GRID[:, None], [truth], deviation), data=1)
    tight = profile("x", "1", GRID, chi_square(GRID[:, None], [truth], deviation / 2), data=1)
    assert tight.high - tight.low < wide.high - wide.low
    assert wide.low <= truth <= wide.high


def test_model_error_is_of_logarithms():
    mean, rms = model_error([2.0, 0.5], [1.0, 1.0])
    assert mean == pytest.approx(0.0)
    assert rms == pytest.approx(np.log(2.0))
    with pytest.raises(InputError):
        model_error([0.0], [1.0])


def test_what_is_refused():
    with pytest.raises(InputError):
        profile("x", "1", [1.0, 1.0, 2.0], [1.0, 2.0, 3.0], data=1)
    with pytest.raises(InputError):
        profile("x", "1", [1.0, 2.0, 3.0], [1.0, 2.0], data=1)
    with pytest.raises(InputError):
        chi_square([1.0], [1.0], 0.0)
