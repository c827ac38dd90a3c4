"""What the mean film leaves of adhesion solves its equation, for stiff and soft, pressed or not."""

import math

import numpy as np
import pytest

from underfoot.friction.rival_speed_effects import MeanFilmSharing

STIFF, RQ = 2e6, 4e-6


@pytest.mark.parametrize("gap", [-1.0, 0.2, 0.6, 2.5])
def test_the_load_that_asperities_keep_is_that_of_the_gap(gap):
    """1 - f = exp(-(h - h_dry)) in decay lengths Rq/2; h_dry is never below 0."""
    pressure = 0.375 * STIFF / math.exp(gap)
    law = MeanFilmSharing(5e-3, 20.9, 1e7, RQ, pressure, stiffness=STIFF)
    speeds = np.array([1e-3, 0.01, 0.1, 1.0])
    left = law.adhesion_left(viscosity=0.1, speed=speeds, contact_pressure=1e5)
    film = law.film_thickness(viscosity=0.1, speed=speeds) / (RQ / 2)
    height = film * (1 - left) ** -0.65
    between = (left > 1e-6) & (left < 1 - 1e-6)
    assert between.sum() >= 3
    expected = np.exp(-(height - max(gap, 0.0)))
    assert left[between] == pytest.approx(expected[between], rel=1e-3)
    assert (np.diff(left) < 0).all()
    assert law.adhesion_left(viscosity=None, speed=speeds, contact_pressure=1e5).tolist() == [1] * 4
