"""The pole that stands for a compliance: exact where it is one, and no part of it is negative."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.sole_contact.preconditioner import SCREENINGS, pole_fit

LONGEST, SPACING = 0.1, 1e-3


def fit_of(symbol):
    return pole_fit(cast(Any, SimpleNamespace(symbol=symbol)), LONGEST, SPACING)


def screenings():
    k = np.geomspace(2 * np.pi / LONGEST, np.pi / SPACING, 60)
    return np.geomspace(k[0] / 3, k[-1] * 3, SCREENINGS)


@pytest.mark.parametrize("place", [5, SCREENINGS // 2])
def test_a_pole_and_a_part_alike_in_all_waves_are_found_again(place):
    screening = screenings()[place]
    found = fit_of(lambda k: 2e-9 + 3e-4 / (screening**2 + k**2))
    assert (found.local, found.strength) == pytest.approx((2e-9, 3e-4), rel=1e-6)
    assert found.screening == pytest.approx(screening)
    assert found.error == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(
    ("symbol", "local", "strength"),
    [
        (lambda k: 1e-12 * k, True, False),  # grows with the wave number: no pole does
        (lambda k: 1e-3 / k**4, False, True),  # falls faster than any pole: nothing beside it
    ],
)
def test_a_part_that_would_be_negative_is_left_out(symbol, local, strength):
    found = fit_of(symbol)
    assert (found.local > 0, found.strength > 0) == (local, strength)
    assert (found.local == 0) != local
    assert (found.strength == 0) != strength
