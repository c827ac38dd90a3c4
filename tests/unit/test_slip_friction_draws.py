"""Draws of the friction of a contact are levels about the friction that a study was made with."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.slip.dynamics import study as module
from underfoot.slip.dynamics.study import MEAN_PRESSURE, SlipStudy


@pytest.mark.parametrize("hysteresis", [0.0, 1e4, 4e4])
def test_a_draw_of_what_is_expected_is_the_study_itself(monkeypatch, hysteresis):
    parts = SimpleNamespace(adhesion=np.array(2e4), hysteresis=np.array(hysteresis))
    expected = (2e4 + hysteresis) / MEAN_PRESSURE
    draws = expected * np.exp(0.2 * np.random.default_rng(0).standard_normal(999))
    monkeypatch.setattr(module, "sampled_points", lambda *_, **__: SimpleNamespace(draws=draws))
    made = SimpleNamespace(
        sole=object(), setting=SimpleNamespace(friction=lambda *_: parts),
        at_contact_friction=lambda factor: factor,
    )  # fmt: skip
    found = SlipStudy.at_friction_draws(cast(Any, made))
    factors = np.array(found.levels)[found.nearest]
    assert np.median(factors) == pytest.approx(1.0, rel=0.1)
    inside = np.abs(np.log(draws / expected)) < 0.4
    assert factors[inside] == pytest.approx((draws / expected)[inside], rel=0.15)
