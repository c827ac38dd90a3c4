"""Contact of a positive definite compliance: signs, complementarity, balance, uniqueness."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.block._kernels.active_set import contact_at_height, contact_under_load


def problem(seed, n, decay):
    """Compliance with long-range coupling, and clearances in no order."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(0, 1, (n, 2))
    distance = np.linalg.norm(points[:, None] - points[None], axis=2)
    compliance = np.exp(-distance / decay) + 0.02 * np.eye(n)
    return compliance, rng.normal(0, 1, n)


CASES = {
    "seed": st.integers(0, 10_000),
    "n": st.integers(2, 60),
    "decay": st.floats(0.02, 3.0),
    "load": st.floats(1e-3, 1e3),
}


@settings(deadline=None, max_examples=60)
@given(**CASES)
def test_load_is_carried_without_pull_or_overlap(seed, n, decay, load):
    compliance, clearance = problem(seed, n, decay)
    found = contact_under_load(compliance, clearance, load, np.zeros(n, bool))
    assert found.wrong == 0
    assert abs(found.force.sum() - load) < 1e-9 * load
    assert found.force.min() >= 0.0
    gap = clearance + found.height + compliance @ found.force
    scale = np.abs(clearance).max() + np.abs(compliance @ found.force).max()
    assert gap.min() > -1e-9 * scale
    assert np.abs(gap[found.force > 0.0]).max() < 1e-9 * scale


@settings(deadline=None, max_examples=40)
@given(**CASES)
def test_the_solution_does_not_depend_on_the_guess_or_the_control(seed, n, decay, load):
    compliance, clearance = problem(seed, n, decay)
    first = contact_under_load(compliance, clearance, load, np.zeros(n, bool))
    guess = np.random.default_rng(seed + 1).uniform(size=n) < 0.5
    second = contact_under_load(compliance, clearance, load, guess)
    fixed = contact_at_height(compliance, clearance, first.height, guess)
    assert fixed.wrong == 0
    for other in (second, fixed):
        assert np.abs(other.force - first.force).max() < 1e-6 * load


@settings(deadline=None, max_examples=30)
@given(**CASES)
def test_a_lower_block_carries_more(seed, n, decay, load):
    compliance, clearance = problem(seed, n, decay)
    there = contact_under_load(compliance, clearance, load, np.zeros(n, bool))
    lower = contact_at_height(compliance, clearance, there.height - 0.1, there.force > 0.0)
    assert lower.force.sum() > load


def test_no_contact_above_the_highest_point():
    compliance, clearance = problem(1, 20, 0.3)
    found = contact_at_height(compliance, clearance, 1.0 - clearance.min(), np.ones(20, bool))
    assert found.wrong == 0
    assert found.force.max() == 0.0
