"""Slip risk against the numbers of the report's G.6 and of Beschorner et al. (2016)."""

import math

import numpy as np
import pytest

from underfoot.slip import ADULTS_LEVEL_WALKING, Beschorner2016, ReportG6


@pytest.mark.parametrize(
    ("difference", "risk", "slack"),
    [(-0.06, 0.50, 1e-12), (0.0, 0.05, 0.001), (0.044, 0.006, 0.0002), (-0.111, 0.925, 0.001),
     (-0.033, 0.21, 0.001)],
)  # fmt: skip
def test_report_is_consistent_with_itself(difference, risk, slack):
    """50 % at -0.06 and slope -49.2; printed risks 0.6 %, 21 % and 92.5 % (G.6.2)."""
    assert ReportG6()(0.2 + difference, 0.2) == pytest.approx(risk, abs=slack)


def test_range_of_the_study_as_breach():
    model = ReportG6()
    assert not model.breaches(0.16, 0.20)
    assert model.breaches(0.05, 0.20)
    assert model.breaches(0.30, 0.20)


def test_odds_ratio_of_2016():
    """+0.01 RCOF multiplies the odds by 1.7; slope 53 per unit."""
    model = Beschorner2016()
    risk = model(0.17, np.array([0.18, 0.19]))
    odds = risk / (1 - risk)
    assert odds[1] / odds[0] == pytest.approx(1.7)
    assert model.slope == pytest.approx(53.1, abs=0.05)


def test_neighbouring_slopes():
    """The report's slope lies within those it quotes: -41.2 to -45.1 and -54.7 (G.6.3)."""
    assert 41.2 < -ReportG6().slope < 54.7
    assert 41.2 < Beschorner2016().slope < 54.7


def test_default_rcof_follows_from_the_report():
    """Median ACOF - RCOF from its risk of 21 %; mean ACOF (0.159 + 0.159 + 0.182) / 3 (G.6.3: hard
    and medium outsoles indistinguishable). RCOF alone spans 3 % to 83 % at a slope of 53.1:
    divided by the expected range of 29 normal values, 4.06 sd (Tippett), a standard deviation.
    That of RCOF - ACOF, 0.6 % to 92.5 % at 49.2, is an upper bound."""

    def log_odds(risk):
        return math.log(risk / (1 - risk))

    model = ReportG6()
    median = log_odds(0.21) / model.slope + model.fifty_percent_at
    mean_acof = (0.159 + 0.159 + 0.182) / 3
    assert mean_acof - median == pytest.approx(ADULTS_LEVEL_WALKING.mean, abs=0.005)
    rng = np.random.default_rng(2)
    expected_range = np.ptp(rng.normal(size=(20_000, 29)), axis=1).mean()
    low = (log_odds(0.83) - log_odds(0.03)) / Beschorner2016().slope / expected_range
    high = (log_odds(0.925) - log_odds(0.006)) / -model.slope / expected_range
    assert low < ADULTS_LEVEL_WALKING.sd < high
    assert ADULTS_LEVEL_WALKING.assumed


def test_population_risks_of_the_outsoles():
    """Printed: hard 54 %, medium 42 %, soft 7.7 % from ACOF alone. From ACOF - RCOF with the
    default population the soft outsole (0.182) is safer than the others (0.159), but the difference
    is smaller: a steeper curve in ACOF alone is not what G.6's slope says."""
    model, people = ReportG6(), ADULTS_LEVEL_WALKING
    soft, hard = model.population(np.array([0.182, 0.159]), people.mean, people.sd)
    assert 0.077 < soft < hard < 0.54
