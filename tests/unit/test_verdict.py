"""The verdict on a step: both ends of the interval of the slip probability decide."""

import pytest

from underfoot.compute.summary import verdict, verdict_sentence
from underfoot.core import SourcedValue


def slips(value, low, high, note=""):
    return {"slip_probability": SourcedValue(value, interval=(low, high), note=note)}


@pytest.mark.parametrize(
    ("value", "low", "high", "word"),
    [
        (1e-5, 0.0, 9e-4, "grips"),
        (1e-5, 0.0, 2e-3, "doubtful"),  # one end is enough to doubt it
        (0.5, 0.06, 0.9, "slips"),
        (0.9, 0.04, 0.99, "doubtful"),
    ],
)
def test_both_ends_of_the_interval_decide(value, low, high, word):
    assert verdict(slips(value, low, high), {}) == word


def test_a_pressure_that_rubber_cannot_bear_leaves_a_doubt():
    assert verdict(slips(1e-5, 0.0, 9e-4), {"overload": "20% of the load"}) == "doubtful"
    assert verdict(slips(0.5, 0.2, 0.9), {"overload": "20% of the load"}) == "slips"


def test_it_says_what_it_means_for_steps():
    assert verdict_sentence(slips(0.5, 0.0, 0.99), {}) == (
        "doubtful",
        "from below 0.1 % to 99 % of steps may slip (95 % interval)",
    )
    word, steps = verdict_sentence(slips(0.5, 0.2, 0.9, "extrapolated: far"), {})
    assert word == "slips"
    assert steps == "more than 1 of 20 steps slips (95 % interval, extrapolated)"
    assert verdict_sentence({}, {}) == ("", "")
