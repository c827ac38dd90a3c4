"""The next designs of an optimisation lie where the surrogates promise most and the rest is met."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from test_decisions import EXAMPLES, load, read_plan

from underfoot.explore import proposals

STUDY = """\
[vary]
"shoe.material.shore_a" = { from = 40, to = 70 }
[outputs]
minimise = ["stiffness", "fluid_load"]
require = ["cof > 0.5"]
[method]
kind = "optimise"
budget = 40
"""


class Known:
    """A surrogate that is sure: ``of`` the place (designs, 1)."""

    def __init__(self, of):
        self.of = of

    def mean(self, places):
        return self.of(np.asarray(places)[:, 0])

    def joint_draws(self, places, normal):
        return np.tile(self.mean(places), (len(normal), 1))


@pytest.fixture(scope="module")
def plan():
    base = load(EXAMPLES / "work_shoe_full_tread_glycerol.toml")
    return read_plan(STUDY, base=base, folder=".")


BOTH_FALL = [Known(lambda x: 1.0 - x), Known(lambda x: 2.0 - x)]


def test_the_front_of_surrogates_keeps_what_is_required(plan):
    """Both goals fall with the place, the COF does too: the last that meets 0.5 is the best."""
    pytest.importorskip("pymoo")
    cof = [Known(lambda x: 1.0 - x)]
    first = proposals._surrogate_front(plan, cast(Any, BOTH_FALL), cast(Any, cof), 3)[0]
    assert first[0] == pytest.approx(0.5, abs=0.02)


def test_the_design_that_lets_the_front_grow_most_comes_first(plan):
    pytest.importorskip("pymoo")
    pytest.importorskip("moocore")
    met = [Known(lambda x: np.full_like(x, 0.9))]
    so_far = SimpleNamespace(
        plan=plan,
        designs=[SimpleNamespace(point=(x,), usable=True) for x in (0.1, 0.4)],
        surrogates=lambda goals: BOTH_FALL if len(goals) == 2 else met,
    )
    (best,) = proposals._promising(cast(Any, so_far), 1)
    assert best[0] == pytest.approx(1.0, abs=0.02)
