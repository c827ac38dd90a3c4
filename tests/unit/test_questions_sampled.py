"""Draws over the open inputs: arithmetic on made-up outcomes."""

import math

import numpy as np
import pytest

from underfoot.core import InputError, SourcedValue, Status
from underfoot.questions.outcomes import CaseOutcome
from underfoot.questions.sensitivity import InputEffect, Sensitivity
from underfoot.studies.sampled import sample_inputs

CLIPPED = math.sqrt(0.5160)
"""Standard deviation of a standard normal number held between -1 and 1."""


def outcome(load: float, status: Status = Status.CONVERGED) -> CaseOutcome:
    scalars = {"load": SourcedValue(load, "N", source="made up")}
    return CaseOutcome("x", "h", scalars, {}, status, "", (), (), 0.0)


def effect(path: str, low: float, high: float) -> InputEffect:
    return InputEffect(path, "", 0.0, 1.0, "1", outcome(low), outcome(high))


def test_without_effects_every_draw_is_the_value():
    found = Sensitivity(outcome(3.0), ())
    assert sample_inputs(found, "load", least=0.01, draws=10) == pytest.approx(np.full(10, 3.0))
    assert sample_inputs(found, "load", value=7.0, least=0.01, draws=10) == pytest.approx(
        np.full(10, 7.0)
    )


def test_two_factors_multiply():
    """ln N has the sum of both variances."""
    found = Sensitivity(outcome(8.0), (effect("a", 4.0, 16.0), effect("b", 16.0, 4.0)))
    logs = np.log2(sample_inputs(found, "load", least=0.01, draws=200_000))
    assert logs.mean() == pytest.approx(3.0, abs=0.01)
    assert logs.std() == pytest.approx(math.sqrt(2.0) * CLIPPED, rel=0.01)
    assert logs.min() >= 1.0 - 1e-12  # held at the computed ends
    assert logs.max() <= 5.0 + 1e-12


def test_no_load_passes_the_normal_force():
    found = Sensitivity(outcome(450.0), (effect("a", 300.0, 499.0), effect("b", 440.0, 498.0)))
    draws = sample_inputs(found, "load", least=0.01, most=500.0)
    assert draws.max() < 500.0
    assert np.median(draws) > 400.0


def test_an_optimum_moves_the_draws_to_one_side():
    found = Sensitivity(outcome(10.0), (effect("a", 30.0, 20.0),))
    assert sample_inputs(found, "load", least=0.01).min() >= 10.0


def test_an_end_that_was_not_computed_mirrors_the_other():
    lost = InputEffect("a", "", 0.0, 1.0, "1", outcome(1.0, Status.NOT_CONVERGED), outcome(20.0))
    draws = sample_inputs(Sensitivity(outcome(10.0), (lost,)), "load", least=0.01)
    assert draws.min() == pytest.approx(5.0)
    assert draws.max() == pytest.approx(20.0)


def test_readings_below_the_least_count_as_the_least():
    found = Sensitivity(outcome(0.0), (effect("a", 0.0, 0.001),))
    assert sample_inputs(found, "load", least=0.01, draws=100) == pytest.approx(np.full(100, 0.01))


def test_same_seed_same_draws():
    found = Sensitivity(outcome(8.0), (effect("a", 4.0, 16.0),))
    first, again, other = (sample_inputs(found, "load", least=0.01, seed=s) for s in (1, 1, 2))
    assert (first == again).all()
    assert not (first == other).all()


@pytest.mark.parametrize(
    "wrong", [{"least": 0.0}, {"least": 1.0, "most": 0.5}, {"least": 0.1, "factors": [0.0]}]
)
def test_bounds_that_cannot_be_are_refused(wrong):
    with pytest.raises(InputError):
        sample_inputs(Sensitivity(outcome(8.0), ()), "load", **wrong)
