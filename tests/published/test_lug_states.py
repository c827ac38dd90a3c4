"""Two states under a lug: fitted to two sources, better than one state on those left out."""

import math

import numpy as np
import pytest

from underfoot.studies.lug_states import states_scores


@pytest.mark.study
def test_two_states_foresee_the_treads_of_other_sources_better_than_one():
    scores = {one.stress: one for one in states_scores((0.0, 0.05, 0.2, 1.0))}
    one, two = scores[0.0], scores[0.2]
    assert max(scores.values(), key=lambda each: each.fitted) is two
    assert two.left_out > one.left_out + 0.3
    assert two.left_out_thin > one.left_out_thin + 0.3
    sealed, wiped = (
        {(pair.source, pair.effect, pair.fluid): pair.computed for pair in each.pairs}
        for each in (one, two)
    )
    across = ("mohamed_2011", "treads_across_above_along", "thin")
    assert sealed[across] < 0.05 < 0.25 < wiped[across]
    oblique = ("blanchette_2015", "oblique_over_along", "thin")
    assert sealed[oblique] < 0.05 < 0.4 < wiped[oblique] < math.log(4.3)
    for sole, read in (("hard_outsole", 0.159), ("soft_outsole", 0.182)):
        assert np.exp(wiped["report_g6", sole, "thick"]) == pytest.approx(read, rel=0.2)
    # nothing happens in oil and 90 % glycerol; 50 % glycerol and oil in water (9 mPa s) drain
    for key, ratio in wiped.items():
        if key[2] == "thick" and key[0] not in ("report_g6", "work_wear_limit"):
            assert ratio == pytest.approx(sealed[key], abs=0.02), key
