"""Ratios of slips of draws of which few or none slip."""

import numpy as np
import pytest

from underfoot.places.choice import _lever, _slip_ratio

MANY = 400


def test_draws_in_which_nobody_slips_have_no_ratio():
    half, quarter, none = (np.full(MANY, share) for share in (0.5, 0.25, 0.0))
    after, before = np.concatenate([half, none]), np.concatenate([quarter, none])
    assert _slip_ratio(after, before) == pytest.approx((2.0, 2.0, 2.0))
    assert _slip_ratio(before, after) == pytest.approx((0.5, 0.5, 0.5))


def test_draws_that_slip_before_or_after_alone_count():
    half, none = np.full(MANY, 0.5), np.zeros(MANY)
    low, middle, high = _slip_ratio(np.concatenate([none, half]), np.concatenate([half, half]))
    assert (low, middle, high) == pytest.approx((0.0, 0.5, 1.0))
    low, middle, high = _slip_ratio(np.concatenate([half, half]), np.concatenate([none, half]))
    assert (low, middle) == pytest.approx((1.0, 2.0))
    assert high > 1e200


def test_a_lever_is_certain_by_the_draws_with_fewer_slips():
    after, before = np.array([0.1, 0.2, 0.3, 0.4]), np.array([0.2, 0.2, 0.2, 0.8])
    lever = _lever("wiped up", after, before)
    assert lever == type(lever)("wiped up", _slip_ratio(after, before), 0.625)
