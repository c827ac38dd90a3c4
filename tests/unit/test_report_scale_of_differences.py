"""Colours of a map of differences reach as far as what moved, whatever stands still beside it."""

import numpy as np
import pytest

from underfoot.report.maps import _REACH, _difference_style
from underfoot.report.quantities import DrawnQuantity

PRESSURE = DrawnQuantity("contact_pressure", "Contact pressure", 1.0, "Pa")


def test_cells_that_stand_still_do_not_narrow_the_scale():
    moved = np.linspace(-8.0, 2.0, 201)
    beside = np.concatenate([moved, np.full(5000, 1e-6), [np.nan]])
    _, alone = _difference_style([moved[np.abs(moved) > 8e-3]], PRESSURE)
    style, scale = _difference_style([beside], PRESSURE)
    assert (scale.low, scale.high) == pytest.approx((alone.low, alone.high))
    assert scale.high == pytest.approx(np.quantile(np.abs(moved[np.abs(moved) > 8e-3]), _REACH))
    assert (scale.low, scale.peak) == pytest.approx((-scale.high, scale.high))
    assert (style.unit, style.colours, style.logarithmic) == ("Pa", "RdBu_r", False)


def test_nothing_moved_has_a_scale_of_one():
    _, scale = _difference_style([np.zeros(9), np.full(3, np.nan)], PRESSURE)
    assert (scale.low, scale.high) == (-1.0, 1.0)
