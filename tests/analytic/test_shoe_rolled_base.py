"""What a wide paraboloid rolled under a height map reaches: gaps, and lines against all chords."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.shoe._kernels.rolling import rolled_base

RADIUS, SPACING = 0.5, 1e-3


@pytest.mark.parametrize("axis", [0, 1])
def test_a_gap_is_entered_by_its_width(axis):
    """w^2 / (8 R); along x the paraboloid stands at places 2 mm apart, so within 1 um."""
    height = np.zeros((81, 61))
    across = np.moveaxis(height, axis, 0)
    across[20:41] = 5e-3  # between the lugs beside it: 22 mm
    base = np.moveaxis(rolled_base(height, SPACING, RADIUS, (0.5, 0.3)), axis, 0)
    assert base[30] == pytest.approx(0.022**2 / (8 * RADIUS), abs=1.01e-6)
    assert base[5:15] == pytest.approx(0, abs=1.01e-6)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.one_of(st.floats(0, 8e-3), st.just(np.nan)), min_size=2, max_size=25),
    st.sampled_from([0.01, 0.3, 3.0]),
)
def test_a_line_is_its_lower_hull_with_bounded_slopes(line, slope):
    """The highest straight line under z + y^2 / (2 R), over all slopes at which it can turn."""
    height = np.array(line)
    base = rolled_base(height[None], SPACING, RADIUS, (0.0, slope))[0]
    inside = np.isfinite(height)
    assert np.array_equal(np.isfinite(base), inside)
    y = SPACING * np.arange(height.size)
    raised = (height + y**2 / (2 * RADIUS))[inside]
    at = y[inside]
    bounds = -slope + y[0] / RADIUS, slope + y[-1] / RADIUS
    apart = np.subtract.outer(at, at)
    chords = np.subtract.outer(raised, raised)[apart > 0] / apart[apart > 0]
    rises = np.clip([*bounds, *chords], *bounds)
    for y_here, found in zip(at, base[inside], strict=True):
        under = np.min(raised + rises[:, None] * (y_here - at), axis=1, initial=np.inf)
        assert found == pytest.approx(under.max() - y_here**2 / (2 * RADIUS), abs=1e-12)
