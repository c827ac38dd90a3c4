"""Slip models: limits, monotony, population mean against other ways to compute it."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.stats import norm

from underfoot.core import InputError, RangeError, SourcedValue
from underfoot.slip import (
    ADULTS_LEVEL_WALKING,
    MODELS,
    Beschorner2016,
    Chang2004,
    RcofPopulation,
    ReportG6,
    SlipModel,
    needed_acof,
    slip_model,
    slip_risk,
)

LOGISTIC = [ReportG6(), Beschorner2016()]


def acof(value, deviation=None):
    return SourcedValue(value, "1", source="test", uncertainty=deviation)


@pytest.mark.parametrize("name", MODELS)
def test_every_model_keeps_the_contract(name):
    model = slip_model(name)
    assert isinstance(model, SlipModel)
    assert model.name == name
    assert model.source
    assert model.assumptions
    grid = np.linspace(0.0, 0.6, 61)
    single = model(grid, 0.2)
    people = model.population(grid, 0.2, 0.03)
    for risk in (single, people):
        assert ((risk >= 0) & (risk <= 1)).all()
        assert (np.diff(risk) <= 0).all()
        assert risk[0] > 0.99
        assert risk[-1] < 1e-6
    assert isinstance(model(0.2, 0.2), float)
    assert model.population(grid, 0.2, 0.0) == pytest.approx(single, rel=1e-12)
    assert (np.diff(model.population(0.2, grid, 0.03)) >= 0).all()


def test_unknown_model_names_the_nearest():
    with pytest.raises(InputError, match="report_g6"):
        slip_model("report_g5")


@pytest.mark.parametrize("model", LOGISTIC, ids=lambda m: m.name)
@pytest.mark.parametrize("sd", [0.01, 0.03, 0.1, 0.4])
def test_population_mean_against_quadrature(model, sd):
    for a in (0.0, 0.1, 0.2, 0.35):

        def integrand(z, a=a):
            odds = model.slope * (a - (0.2 + sd * z) + 0.06) * (1 if model.slope < 0 else -1)
            return norm.pdf(z) / (1 + math.exp(-odds))

        expected = quad(integrand, -10, 10, epsabs=1e-12, limit=400)[0]
        assert model.population(a, 0.2, sd) == pytest.approx(expected, abs=1e-9)


def test_population_mean_against_sampling():
    rng = np.random.default_rng(5)
    people = rng.normal(0.2, 0.03, 400_000)
    people = people[(people >= 0) & (people <= 1)]
    for model in (*LOGISTIC, Chang2004()):
        sampled = np.mean(model(0.21, people))
        assert model.population(0.21, 0.2, 0.03) == pytest.approx(sampled, abs=4e-3)


def test_chang_is_the_normal_distribution():
    model = Chang2004()
    assert model.population(0.2, 0.2, 0.03) == pytest.approx(0.5)
    assert model.population(0.23, 0.2, 0.03) == pytest.approx(norm.cdf(-1))
    assert model.population(0.1, 0.2, 0.0) == 1.0
    assert model(0.2, np.array([0.19, 0.2, 0.21])) == pytest.approx([0.0, 0.5, 1.0])


@settings(deadline=None, max_examples=60)
@given(
    a=st.floats(0, 1),
    more=st.floats(0, 0.3),
    mean=st.floats(0, 0.6),
    sd=st.floats(0, 0.2),
    name=st.sampled_from(sorted(MODELS)),
)
def test_more_friction_never_adds_risk(a, more, mean, sd, name):
    model = slip_model(name)
    low, high = model.population(a, mean, sd), model.population(a + more, mean, sd)
    assert 0 <= high <= low + 1e-12 <= 1 + 1e-9
    assert model.population(a, min(mean + more, 1.0), sd) >= low - 1e-12


def test_risk_carries_its_band():
    model, people = ReportG6(log_slope_sd=0.0, fifty_percent_sd=0.0), ADULTS_LEVEL_WALKING
    found = slip_risk(acof(0.15, 0.02), model=model)
    assert found.at_best_estimate == pytest.approx(model.population(0.15, people.mean, people.sd))
    for end, sign in ((found.low, 1), (found.high, -1)):
        at = model.population(0.15 + sign * 1.95996 * 0.02, people.mean, people.sd)
        assert end == pytest.approx(at, rel=3e-3)  # half a stratum of 4000 draws
    assert found.low < found.probability.value < found.high
    rng = np.random.default_rng(11)
    sampled = model.population(np.maximum(rng.normal(0.15, 0.02, 5000), 0), people.mean, people.sd)
    assert found.probability.value == pytest.approx(sampled.mean(), abs=0.006)
    assert found.probability.uncertainty == pytest.approx(sampled.std(), abs=0.006)
    assert found.probability.assumed
    assert any("Required friction 0.2" in text for text in found.assumptions)


@pytest.mark.parametrize("model", LOGISTIC, ids=lambda m: m.name)
def test_what_publications_differ_by_is_in_the_band(model):
    """The mean over a normal x50 is that over a population wider by its spread, in one integral."""
    exact = dataclasses.replace(model, log_slope_sd=0.0, fifty_percent_sd=0.0)
    level = dataclasses.replace(model, log_slope_sd=0.0)
    people, friction = RcofPopulation(0.2, 0.03), acof(0.22, 0.01)
    found = slip_risk(friction, rcof=people, model=level)
    spread = math.hypot(people.sd, level.fifty_percent_sd, friction.uncertainty)
    assert found.probability.value == pytest.approx(exact.population(0.22, 0.2, spread), abs=3e-3)
    known = slip_risk(friction, rcof=people, model=exact)
    assert found.high - found.low > 3 * (known.high - known.low)


@given(risk=st.floats(0.01, 0.6), name=st.sampled_from(sorted(MODELS)), sd=st.floats(0.01, 0.08))
@settings(deadline=None, max_examples=25)
def test_friction_that_is_enough_is_one_whose_risk_meets_the_target(risk, name, sd):
    """At the friction that is needed, with the spread it has, the risk is the target."""
    model, people, present = slip_model(name), RcofPopulation(0.2, 0.03), acof(0.2, sd)
    needed = needed_acof(risk, rcof=people, model=model, acof=present)
    there = acof(needed, needed * sd / 0.2)
    assert slip_risk(there, rcof=people, model=model).probability.value == pytest.approx(
        risk, abs=1e-4
    )


@pytest.mark.parametrize("degrees", [-5.0, 0.0, 3.0, 10.0])
def test_a_slope_asks_as_if_every_person_were_turned_with_it(degrees):
    slope, people = math.radians(degrees), RcofPopulation(0.2, 0.03)
    persons = np.random.default_rng(3).normal(0.2, 0.03, 200_000)
    turned = np.tan(slope + np.arctan(persons))
    there = people.on_slope(slope)
    assert there.mean == pytest.approx(turned.mean(), abs=5e-4)
    assert there.sd == pytest.approx(turned.std(), abs=5e-4)


def test_risk_without_uncertainty_has_no_band():
    found = slip_risk(acof(0.15), rcof=RcofPopulation(0.19, 0.02, "measured"))
    assert found.low is None
    assert found.probability.uncertainty is None
    assert found.probability.reason
    assert not found.probability.assumed


def test_chang_with_uncertain_acof_adds_the_variances():
    """P = Phi((mean R - mean A) / sqrt(s_R^2 + s_A^2)) is the mean over the uncertain ACOF."""
    found = slip_risk(acof(0.24, 0.04), rcof=RcofPopulation(0.2, 0.03), model=Chang2004())
    assert found.probability.value == pytest.approx(norm.cdf(-0.04 / 0.05), abs=1e-6)


@pytest.mark.parametrize(
    "build",
    [
        lambda: RcofPopulation(1.2, 0.03),
        lambda: RcofPopulation(-0.1, 0.03),
        lambda: RcofPopulation(math.nan, 0.03),
        lambda: RcofPopulation(0.2, -0.01),
        lambda: RcofPopulation(0.2, math.nan),
        lambda: RcofPopulation(0.2, 0.7),
        lambda: slip_risk(acof(math.nan)),
        lambda: slip_risk(acof(-0.1)),
        lambda: slip_risk(acof(None)),
        lambda: slip_risk(acof(0.2, math.inf)),
        lambda: ReportG6()(0.2, 1.5),
        lambda: ReportG6()(math.inf, 0.2),
        lambda: ReportG6().population(0.2, 0.2, -0.1),
        lambda: ReportG6(slope=49.2),
        lambda: Beschorner2016(odds_ratio=0.9),
    ],
)
def test_bad_input(build):
    with pytest.raises(InputError):
        build()


def test_range_error_names_the_range():
    with pytest.raises(RangeError, match="0 to 1"):
        ReportG6()(0.2, 1.5)


def test_tested_range_of_the_logistic_models_is_that_of_their_studies():
    """Each end of the tested ACOF - RCOF gives back the study's extreme predicted risk."""
    for model, highest, lowest in ((Beschorner2016(), 0.95, 0.03), (ReportG6(), 0.925, 0.006)):
        low, high = model.tested.low, model.tested.high
        assert low < high
        assert model(0.3 + low, 0.3) == pytest.approx(highest, abs=2e-3)
        assert model(0.3 + high, 0.3) == pytest.approx(lowest, abs=2e-3)
        assert not model.breaches(0.3 + 0.5 * (low + high), 0.3)
        for outside in (low - 0.01, high + 0.01):
            (breach,) = model.breaches(0.3 + outside, 0.3)
            assert breach.quantity == "available less required friction"


def test_risk_of_plain_numbers_and_arrays():
    """ACOF 0.14 on RCOF 0.2 +- 0: even odds of the report's model by its definition."""
    exact = RcofPopulation(0.2, 0.0)
    single = slip_risk(0.14, rcof=exact)
    assert single.probability.value == pytest.approx(0.5)
    assert single.low is None
    assert single.probability.reason == "the available friction came without one"
    acofs = np.array([[0.1, 0.14], [0.2, 0.3]])
    risks = slip_risk(acofs, rcof=exact)
    values = [[risk.probability.value for risk in row] for row in risks]
    assert np.array(values) == pytest.approx(ReportG6()(acofs, 0.2))
    assert slip_risk(np.float32(0.14), rcof=exact).probability.value == pytest.approx(0.5, abs=1e-6)
    for bad in (-0.1, math.nan, [0.1, -0.1]):
        with pytest.raises(InputError):
            slip_risk(bad)
    with pytest.raises(InputError, match="one ACOF"):
        slip_risk([0.1, 0.2], samples=[0.1, 0.2])


def test_risk_and_models_present_themselves():
    risk = slip_risk(acof(0.25, 0.02))
    assert len(repr(risk)) < 200
    assert "outside the tested range" in risk.summary()
    frame = risk.to_frame().set_index("quantity")
    assert frame.loc["probability of a slip", "value"] == risk.probability.value
    for name in MODELS:
        model = slip_model(name)
        assert len(repr(model)) < 200
        table = model.to_frame()
        assert list(table["probability of a slip"]) == list(model(table["ACOF"], 0.2))


def test_draws_beyond_the_friction_that_a_sole_can_have_count_as_the_most_of_it():
    draws = np.array([0.1, 0.2, 0.3, 9.0])
    most = slip_risk(SourcedValue(0.3, "1"), samples=np.minimum(draws, 5.0))
    assert slip_risk(SourcedValue(0.3, "1"), samples=draws).probability == most.probability
    assert slip_risk(9.0).probability == slip_risk(5.0).probability
    wide = slip_risk(SourcedValue(0.3, "1", uncertainty=4.0))
    assert wide.low == pytest.approx(0.0, abs=1e-6)
    assert wide.high == pytest.approx(1.0, abs=1e-2)
