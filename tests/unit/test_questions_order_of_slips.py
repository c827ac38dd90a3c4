"""Which of two slips less often: what nobody can tell of their friction counts as theirs if alike.

People who need another friction are another question.
"""

from types import SimpleNamespace
from typing import Any

import numpy as np

from underfoot.case import Case
from underfoot.questions import comparison
from underfoot.questions.order import order_of_draws
from underfoot.slip import slip_chances

LEVEL = Case(shoe="work_shoe_full_tread", floor="vinyl_g4", contaminant="water",
             motion={"from": "slip_tester_g4"})  # fmt: skip
STEEP = LEVEL.replace({"risk.rcof_mean": 0.3})


def test_the_friction_nobody_can_tell_apart_is_that_of_the_slips_of_people_who_need_the_same(
    monkeypatch,
):
    rng = np.random.default_rng(2)
    low = 0.25 + 0.03 * rng.standard_normal(500)
    drawn = low + 0.002 * rng.standard_normal(500), low
    monkeypatch.setattr(comparison, "_shared_draws", lambda *_: drawn)
    result: Any = SimpleNamespace(scalars={"slip_probability": 0.1})
    friction = order_of_draws(*drawn).within

    def within(first, other):
        found = comparison._order_in("slip_probability", [result] * 2, [first, other], 1)
        assert found is not None
        return found.within

    chances = [
        slip_chances(draws, comparison.required_friction(case), case.risk.build())
        for draws, case in zip(drawn, (STEEP, LEVEL), strict=True)
    ]
    slips = order_of_draws(chances[0], chances[1]).within
    assert slips != friction
    assert within(LEVEL, LEVEL) == within(STEEP, STEEP) == friction
    assert within(LEVEL, STEEP) == slips
