"""Ends of what a place may say, fluids of machines and bounds of a ratio, by their values."""

import numpy as np
import pytest

from underfoot.core import RangeError
from underfoot.friction.shoe_class import slip_tests
from underfoot.places.choice import _left
from underfoot.places.machines import FLUIDS
from underfoot.places.place import _shoe


@pytest.mark.parametrize(
    ("path", "ends"), [("cof", (0.01, 2.0)), ("price", (0.0, 1e5)), ("months", (0.1, 240.0))]
)
def test_a_shoe_says_numbers_from_end_to_end_and_none_beyond(path, ends):
    def shoe(value):
        reading = {"test": next(iter(slip_tests())), "cof": 0.3}
        entry = {"name": "a", "from": "work_shoe_full_tread", "reading": [reading]}
        (reading if path == "cof" else entry)[path] = value
        return _shoe(entry)

    for value in ends:
        shoe(value)
    for value in (ends[0] - 1e-3, 1.001 * ends[1]):
        with pytest.raises(RangeError, match=path):
            shoe(value)


def test_fluids_of_machines_go_from_thin_to_thick():
    ends = {name: fluid.viscosity for name, fluid in FLUIDS.items()}
    assert ends.pop("dry") is None
    assert all(0 < low <= high for low, high in ends.values())
    assert ends["water"] == (1e-3, 1e-3)
    thickest = [ends[name][1] for name in ("water", "detergent", "oil", "ramp oil")]
    assert thickest == sorted(thickest)


def test_the_ratio_of_means_lies_between_its_bounds_also_where_few_draws_make_it():
    """Two draws of a hundred lie beyond 2.5 and 97.5 %."""
    even, rare = np.ones(100), np.ones(100)
    rare[:2] = 1000.0
    mean = (98 + 2000) / 100
    assert _left(rare, even) == pytest.approx((1.0, mean, mean))
    assert _left(even, rare) == pytest.approx((1 / mean, 1 / mean, 1.0))
    halved = _left(0.5 * rare, rare)
    assert halved == pytest.approx((0.5, 0.5, 0.5))
