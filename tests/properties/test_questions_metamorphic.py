"""What is asked in another way has the same answer: order, names, scale."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.case import Case
from underfoot.questions.changes import possible_changes
from underfoot.questions.comparison import case_differences
from underfoot.questions.contact import mirror_map
from underfoot.questions.order import certainty_after_reading, order_of_draws
from underfoot.questions.separation import REPEATS, _conditions
from underfoot.surface import HeightMap

NORMAL = np.random.default_rng(4).standard_normal((2, 4000))
FIRST, SECOND = 0.30 * np.exp(0.10 * NORMAL[0]), 0.27 * np.exp(0.15 * NORMAL[1])
SMOOTH = Case.load("examples/work_shoe_untreaded_glycerol.toml")
TREAD = Case.load("examples/work_shoe_full_tread_glycerol.toml")


@settings(max_examples=8, deadline=None)
@given(st.floats(0.01, 100.0))
def test_an_order_is_one_of_ratios(factor):
    before, after = order_of_draws(FIRST, SECOND), order_of_draws(factor * FIRST, factor * SECOND)
    assert after.higher == before.higher
    assert after.within == pytest.approx(before.within, abs=5e-4)  # of 4,000 draws two
    told, again = (certainty_after_reading(a * FIRST, a * SECOND, REPEATS) for a in (1.0, factor))
    assert again == pytest.approx(told)


def test_an_order_is_mirrored_when_two_are_swapped_and_counts_no_draw_twice():
    one, two = order_of_draws(FIRST, SECOND), order_of_draws(SECOND, FIRST)
    assert one.higher + two.higher == pytest.approx(1.0)
    assert one.within == pytest.approx(two.within, abs=5e-4)
    assert one.told == pytest.approx(two.told, abs=5e-4)
    mixed = np.random.default_rng(0).permutation(FIRST.size)
    assert order_of_draws(FIRST[mixed], SECOND[mixed]) == one
    assert order_of_draws(np.tile(FIRST, 2), np.tile(SECOND, 2)) == one
    told = certainty_after_reading(FIRST, SECOND, REPEATS)
    assert certainty_after_reading(SECOND, FIRST, REPEATS) == pytest.approx(told, abs=1e-3)


def test_what_two_cases_can_share_does_not_depend_on_which_is_first_or_on_names():
    told = list(_conditions(SMOOTH, TREAD))
    assert told
    assert list(_conditions(TREAD, SMOOTH)) == told
    named = [case.replace({"name": f"other {k}"}) for k, case in enumerate((SMOOTH, TREAD))]
    assert list(_conditions(*named)) == told
    faster = TREAD.replace({"motion.speed": 2 * TREAD.motion.speed})
    kinds = {kind for kind, *_ in _conditions(SMOOTH, faster)}
    assert "angle" not in kinds
    assert "fluid" in kinds
    water = TREAD.replace({"contaminant": "water"})
    assert "fluid" not in {kind for kind, *_ in _conditions(SMOOTH, water)}


def test_changes_that_can_be_made_do_not_depend_on_its_name():
    def changes(case):
        return {change.name: change.values for change in possible_changes(case)}

    told = changes(TREAD)
    assert told
    assert changes(TREAD.replace({"name": "other"})) == told


def test_differences_of_cases_follow_their_order():
    rows = case_differences([SMOOTH, TREAD])
    turned = case_differences([TREAD, SMOOTH])
    assert rows
    assert [(name, two, one) for name, one, two in rows] == [tuple(row) for row in turned]
    assert not case_differences([SMOOTH, SMOOTH])
    shared = [row[:2] for row in case_differences([SMOOTH, TREAD, SMOOTH])]
    assert shared == [tuple(row[:2]) for row in rows]


@settings(max_examples=20, deadline=None)
@given(shift=st.floats(-1e-3, 1e-3), factor=st.floats(0.1, 10.0))
def test_a_mirrored_map_is_levelled_whatever_height_and_scale_it_was_measured_at(shift, factor):
    heights = 1e-6 * np.random.default_rng(1).standard_normal((8, 6))
    told = mirror_map(HeightMap(heights, 1e-6)).heights
    moved = mirror_map(HeightMap(factor * heights + shift, 1e-6)).heights
    assert moved == pytest.approx(factor * told, abs=1e-12)
    turned = mirror_map(HeightMap(heights[::-1], 1e-6)).heights
    assert turned[:8] == pytest.approx(told[7::-1][:8], abs=1e-12)
