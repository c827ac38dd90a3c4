"""How worn a sole is between two states, and what a series of wear assumes, as it says it."""

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

import underfoot.shoe.worn as shapes
from underfoot.compute import sole
from underfoot.questions import worn_states
from underfoot.questions.wear import _assumptions
from underfoot.questions.worn_states import PARTS, measures_between


def test_between_two_states_the_removed_thickness_is_linear(monkeypatch):
    """States remove 0, 2 and 8 mm in the middle of a strip: a quarter of the way 1 mm."""
    removed = {1: np.array([[0.0, 2e-3, 0.0]]), 2: np.array([[1e-3, 8e-3, 0.0]])}

    def state(number):
        worn = SimpleNamespace(x=np.arange(3.0), y=np.zeros(1), removed=removed[number])
        return SimpleNamespace(worn=worn)

    new = SimpleNamespace(with_wear=lambda shape: shape)
    monkeypatch.setattr(sole, "new_sole", lambda _: new)
    monkeypatch.setattr(sole, "archard_state", state)
    monkeypatch.setattr(shapes, "WornMap", lambda x, y, blend: (x.size, y.size) == (3, 1) and blend)
    monkeypatch.setattr(shapes, "wear_measures", lambda blend: blend)
    cases = cast(Any, [0, 1, 2])
    found = np.array(measures_between(cases, cases, "archard", None))[:, 0]
    assert len(found) == 2 * PARTS + 1
    share = np.linspace(0, 2, 2 * PARTS + 1)
    for place, first, second in ((0, 0.0, 1e-3), (1, 2e-3, 8e-3), (2, 0.0, 0.0)):
        expected = np.interp(share, [0, 1, 2], [0.0, first, second])
        assert found[:, place] == pytest.approx(expected)


def test_wear_by_walking_is_worn_at_an_angle_and_half_its_range_to_either_side():
    wear = SimpleNamespace(angle=math.radians(10), angle_range=math.radians(6), edge_radius=0.15e-3)
    case = SimpleNamespace(shoe=SimpleNamespace(wear=wear))
    shape, *_ = _assumptions(cast(Any, case), "archard", [])
    assert "at 7, 10 and 13 deg" in shape


@pytest.mark.parametrize("mode", ["plane", "walk", "patch"])
def test_a_shape_that_is_known_is_measured_in_even_parts_of_each_step(monkeypatch, mode):
    def worn(case, of, steps, deepest):
        return [(case, of, deepest, number / steps) for number in range(steps + 1)]

    monkeypatch.setattr(worn_states, "worn_cases", worn)
    monkeypatch.setattr(worn_states, "measures_of", lambda case: case)
    cases = cast(Any, ["new", 1, 2])
    found = measures_between(cast(Any, "case"), cases, mode, 3e-3)
    assert [one[:3] for one in found] == [("case", mode, 3e-3)] * (2 * PARTS + 1)
    np.testing.assert_allclose([one[3] for one in found], np.linspace(0, 1, 2 * PARTS + 1))
