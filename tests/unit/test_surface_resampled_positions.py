"""A profile resampled to an even spacing lies where its positions say, wherever they begin."""

import numpy as np
import pytest

from underfoot.surface import profile_from_positions


@pytest.mark.parametrize("start", [0.0, 5e-3, -2e-3])
def test_the_spacing_does_not_hang_on_where_the_profile_begins(start):
    even = np.linspace(0.0, 4e-3, 401)
    uneven = even + 3e-6 * np.sin(np.arange(401.0))
    uneven[[0, -1]] = even[[0, -1]]
    profile = profile_from_positions(start + uneven, 2.0 * uneven, resample=True)
    assert profile.spacing == pytest.approx(1e-5, rel=1e-9)
    # a line stays a line
    assert np.asarray(profile.heights) == pytest.approx(2.0 * even, abs=1e-12)
