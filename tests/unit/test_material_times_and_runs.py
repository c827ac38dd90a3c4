"""Times of relaxation under either name; how many residuals of a fit stand for one."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.material.read import _times
from underfoot.material.spectrum_fit import run_length


@pytest.mark.parametrize("name", ["relaxation time", "time"])
def test_a_column_of_times_is_read_under_either_name(name):
    column = SimpleNamespace(name=name, quantity=name, cells=("0.1", "2"))
    table = SimpleNamespace(
        named=lambda *names: column if name in names else None,
        needed=lambda *names: pytest.fail(f"asked for {names}"),
        si=lambda one, infinite=False: np.array([0.1, 2.0]) if one is column else None,
        lines=[1, 2], where="made",
    )  # fmt: skip
    assert _times(cast(Any, table)).tolist() == [0.1, 2.0]


@pytest.mark.parametrize(
    ("rho", "size", "low", "high"),
    [(0.0, 4000, 1, 1), (0.8, 4000, 8, 10), (0.99, 4000, 19, 19), (0.99, 40, 5, 5)],
)
def test_residuals_that_follow_each_other_count_as_one(rho, size, low, high):
    """(1 + rho) / (1 - rho) of them, rho at most 0.9, and an eighth of all at most."""
    noise = np.random.default_rng(3).standard_normal(size)
    residual = np.zeros(size)
    for k in range(1, size):
        residual[k] = rho * residual[k - 1] + noise[k]
    assert low <= run_length(residual if rho else noise) <= high
