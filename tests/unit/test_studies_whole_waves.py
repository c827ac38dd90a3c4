"""Means over whole waves of a floor."""

import numpy as np
import pytest

from underfoot.studies.g1 import whole_wavelength_mean


@pytest.mark.parametrize(("waves", "expected"), [(0.9, None), (1.0, 2.5), (2.3, 2.0), (3.0, 2.0)])
def test_the_mean_is_over_the_whole_waves_after_the_first(waves, expected):
    """A wave about 2 that begins with 0.5 more: in the first wave alone the rest counts too."""
    wavelength = 0.4e-3
    distance = np.concatenate([np.zeros(5), np.linspace(0.0, waves * wavelength, 4000)[1:]])
    phase = distance / wavelength
    values = 2.0 + np.sin(2 * np.pi * phase) + 0.5 * (phase <= 1.0)
    found = whole_wavelength_mean(distance, values, wavelength)
    assert found == (None if expected is None else pytest.approx(expected, abs=2e-3))
