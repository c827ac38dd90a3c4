"""How likely a method reads at least its limit, where the interval of COF is wider on one side."""

import math
from types import SimpleNamespace

import pytest
from scipy.stats import norm

from underfoot.core import SourcedValue
from underfoot.questions.method import _condition


def chance(limit, interval, value=0.2):
    """Return the probability of a COF with an interval to reach a limit."""
    cof = SourcedValue(value, "1", uncertainty=0.02, interval=interval)
    entry = SimpleNamespace(
        values={"limits.flat": limit}, sourced_value=lambda *_: SourcedValue(limit, "1")
    )
    outcome = SimpleNamespace(
        usable=True, scalars={"cof": cof}, number=lambda _: value, standard_deviation=lambda _: 0.02
    )
    case = SimpleNamespace(floor=None, contaminant=None)
    return _condition(entry, "flat", case, outcome, None).probability


@pytest.mark.parametrize("interval", [(0.19, 0.8), (0.03, 0.21), (0.1, 0.4)])
def test_each_side_of_the_interval_counts_for_the_limits_on_it(interval):
    for limit in (0.1, 0.195, 0.2001, 0.25, 0.5):
        apart = math.log(limit / 0.2)
        end = interval[0] if apart < 0 else interval[1]
        wide = abs(math.log(end / 0.2)) / 1.96
        assert chance(limit, interval) == pytest.approx(norm.sf(apart / wide), abs=1e-3)
    assert [chance(end, interval) for end in interval] == pytest.approx([0.975, 0.025], abs=1e-3)


def test_a_spread_without_an_interval_counts_on_both_sides():
    below, above = chance(0.2 / 1.1, None), chance(0.2 * 1.1, None)
    assert below == pytest.approx(norm.cdf(math.log(1.1) / 0.1), abs=1e-6)
    assert below + above == pytest.approx(1)
