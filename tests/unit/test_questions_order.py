"""One rule for which of two is higher, equal or not to be told; what would tell them apart."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import norm

from underfoot.case import Case
from underfoot.core import SourcedValue
from underfoot.questions.order import (
    DECIDED,
    SEEN,
    Order,
    OrderVerdict,
    certainty_after_reading,
    order_of_draws,
    order_of_values,
)
from underfoot.questions.separation import REPEATS, of_conditions

DRAWS = np.exp(0.5 * np.random.default_rng(1).standard_normal(4000))


def test_a_difference_that_nobody_sees_is_equal_however_sure_its_order():
    """COF 0.135 and 0.132, all else shared: above 99 % higher, and 2 % apart."""
    found = order_of_draws(0.135 * DRAWS, 0.132 * DRAWS)
    assert (found.higher, found.within, found.verdict) == (1.0, 1.0, OrderVerdict.EQUAL)
    assert order_of_draws(0.15 * DRAWS, 0.13 * DRAWS).verdict is OrderVerdict.HIGHER


def test_a_skewed_interval_is_no_bell():
    """0.1 (0.025 to 0.419) and 0.008 (0 to 0.016): value and 1.96 sd overlap, the intervals not."""
    wide = SourcedValue(0.1, "1", uncertainty=0.1, interval=(0.025, 0.419))
    low = SourcedValue(0.008, "1", uncertainty=0.004, interval=(0.0, 0.016))
    found = order_of_values(wide, low)
    assert found.higher > 0.99
    assert found.verdict is OrderVerdict.HIGHER
    assert order_of_values(wide, SourcedValue(0.1, "1")) is None


@given(a=st.floats(0.05, 0.5), b=st.floats(0.05, 0.5), s=st.floats(0.01, 0.1))
def test_independent_normal_values_in_closed_form(a, b, s):
    values = [SourcedValue(x, "1", uncertainty=s) for x in (a, b)]
    found, turned = order_of_values(*values), order_of_values(*values[::-1])
    assert found.higher == pytest.approx(norm.cdf((a - b) / (s * math.sqrt(2))), abs=2e-3)
    assert found.higher + turned.higher == pytest.approx(1)
    assert found.within == turned.within


@given(higher=st.floats(0, 1), within=st.floats(0, 1))
def test_each_statement_holds_with_three_quarters(higher, within):
    verdict = Order(higher, within).verdict
    sure = {
        OrderVerdict.EQUAL: within,
        OrderVerdict.HIGHER: higher,
        OrderVerdict.LOWER: 1 - higher,
        OrderVerdict.OPEN: 1.0,
    }
    assert sure[verdict] >= DECIDED
    if verdict is OrderVerdict.OPEN:
        assert max(within, higher, 1 - higher) < DECIDED


def test_a_reading_tells_what_differs_by_more_than_testers_repeat():
    apart = np.exp(0.5 * np.random.default_rng(2).standard_normal(4000))
    near = np.exp(0.02 * np.random.default_rng(2).standard_normal(4000))
    assert certainty_after_reading(DRAWS * apart, DRAWS, REPEATS) > 0.85
    assert certainty_after_reading(DRAWS * near, DRAWS, REPEATS) < 0.6
    # of a normal prior and reading: 1 - atan(repeats / spread) / pi
    exact = 1 - math.atan(REPEATS / 0.5) / math.pi
    assert certainty_after_reading(DRAWS * apart, DRAWS, REPEATS) == pytest.approx(exact, abs=0.02)
    assert pytest.approx(0.1) == SEEN


@pytest.mark.slow
def test_what_would_tell_is_computed_under_what_both_share():
    first = Case.load("examples/outsoles/heel_hexagons_glycerol.toml")
    second = Case.load("examples/outsoles/heel_chevrons_glycerol.toml")
    found = of_conditions(first, second)
    assert {one.kind for one in found} >= {"fluid", "angle"}
    assert "glycerol_90pct" not in [one.value for one in found]
    for one in found:
        assert one.told == pytest.approx(one.order.told)
    other = second.replace("contaminant", "water")
    assert not [one for one in of_conditions(first, other) if one.kind == "fluid"]
