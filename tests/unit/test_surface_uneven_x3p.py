"""An X3P profile whose points have positions of their own."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from underfoot.surface.instruments import _x3p_profile


def test_points_of_a_profile_are_read_by_their_positions():
    x = 1e-6 * np.arange(20)
    z = 1e-7 * np.sin(x / 3e-6)
    points = np.column_stack([x, np.zeros(20), z]).reshape(20, 1, 3)
    layer = SimpleNamespace(is_regular_grid=False, points=lambda: points)
    profile = _x3p_profile(layer, np.zeros(20), "read", False, False, Path("a.x3p"))
    assert profile.spacing == pytest.approx(1e-6)
    assert profile.heights == pytest.approx(z)
