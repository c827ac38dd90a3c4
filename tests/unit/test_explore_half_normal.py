"""The unknown model error of a posterior is half of a normal, cut in its far tails."""

import numpy as np
import pytest
from scipy.stats import halfnorm

from underfoot.explore.posterior import TAIL, _half_normal


def test_shares_of_a_half_normal_are_its_quantiles_between_both_tails():
    share = np.linspace(0, 1, 11)
    assert _half_normal(share) == pytest.approx(halfnorm.ppf(TAIL + (1 - 2 * TAIL) * share))
    assert halfnorm.cdf(_half_normal(np.array([0.0, 1.0]))) == pytest.approx([TAIL, 1 - TAIL])
