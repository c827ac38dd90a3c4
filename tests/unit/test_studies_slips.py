"""Shares of slips against the slip model: what is averaged, and what a source may not see."""

from dataclasses import replace

import numpy as np
import pytest

from underfoot.slip import ADULTS_LEVEL_WALKING, ReportG6
from underfoot.studies.slips import predict_shares, published_shares, share

COMPUTED = np.array([0.1, 0.2])


def test_a_share_is_the_mean_of_the_models_population():
    one = published_shares(COMPUTED)[2]
    found = share(one, np.array([-49.2]), np.array([-0.06]), np.zeros(1))
    walkers = ADULTS_LEVEL_WALKING.mean, ADULTS_LEVEL_WALKING.sd
    assert found[0, 0] == pytest.approx(float(np.mean(ReportG6().population(one.acof, *walkers))))


def test_a_tester_that_reads_high_has_more_slips_at_its_reading():
    one = published_shares(COMPUTED)[0]
    low, mean, high = share(one, np.array([-49.2]), np.array([-0.06]), np.array([-0.3, 0.0, 0.3]))[
        0
    ]
    assert low > mean > high
    own = share(
        published_shares(COMPUTED)[-1], np.array([-49.2]), np.array([-0.06]), np.array([-0.3, 0.3])
    )
    assert np.ptp(own) == 0.0  # its interval holds the laboratory already


def test_a_source_is_predicted_from_the_others_alone():
    sources = published_shares(COMPUTED)
    before = predict_shares(sources)[2]
    changed = [*sources[:2], replace(sources[2], low=0.9, high=0.95), *sources[3:]]
    after = predict_shares(changed)[2]
    assert after["predicted from the others, %"] == before["predicted from the others, %"]
    assert (
        predict_shares(changed)[3]["predicted from the others, %"]
        > predict_shares(sources)[3]["predicted from the others, %"]
    )
    assert before["off by, points"] == pytest.approx(0.0, abs=20)
    seen = predict_shares(changed)[2]
    assert (seen["share of slips, %"], seen["or up to, %"]) == pytest.approx((90.0, 95.0))
    assert [row["source"] for row in predict_shares(sources)].count("report, G.6") == 2
