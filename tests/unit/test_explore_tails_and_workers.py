"""Half of a normal, cut in its far tails, and what a check says of workers."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.stats import halfnorm

from underfoot.explore.check import StudyCheck
from underfoot.explore.posterior import TAIL, _half_normal


def test_shares_of_a_half_normal_are_its_quantiles_between_both_tails():
    share = np.linspace(0, 1, 11)
    assert _half_normal(share) == pytest.approx(halfnorm.ppf(TAIL + (1 - 2 * TAIL) * share))
    assert halfnorm.cdf(_half_normal(np.array([0.0, 1.0]))) == pytest.approx([TAIL, 1 - TAIL])


@pytest.mark.parametrize(("workers", "words"), [(1, "1 worker of"), (2, "2 workers of")])
def test_a_check_counts_its_workers(workers, words):
    """One open case of a second each: all of it fits on this machine."""
    made: Any = SimpleNamespace(
        workers=workers, ended=0, cases=2, memory=1e9, seconds_left=2.0, cost=None, tasks=1
    )
    (line,) = StudyCheck._where(made)
    assert words in line
    assert "1 GB" in line
