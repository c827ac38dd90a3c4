"""Why no step can be used; a trend of three states."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.questions.wear import _rank
from underfoot.slip.dynamics import recorded


def test_each_step_says_why_it_is_none(monkeypatch):
    steps = [
        SimpleNamespace(
            stance=SimpleNamespace(reason=a), measurement=SimpleNamespace(value=None, reason=b)
        )
        for a, b in (("partial", ""), ("", "no peak"), ("partial", "no peak"))
    ]
    monkeypatch.setattr(recorded, "read_trial", lambda path: None)
    monkeypatch.setattr(recorded, "walkway_of", lambda trial: None)
    monkeypatch.setattr(recorded, "required_frictions", lambda walk: steps)
    with pytest.raises(InputError, match="no step can be used: partial; no peak"):
        recorded.recorded_histories("walk.c3d")
    steps.clear()
    with pytest.raises(InputError, match="no contact"):
        recorded.recorded_histories("walk.c3d")


@pytest.mark.parametrize("states", [2, 3, 5])
def test_three_states_tell_a_trend_and_two_do_not(states):
    x = np.arange(6.0)
    y = np.where(np.arange(6) < states, x**2, np.nan)
    rising, falling = (_rank(cast(Any, "one"), x, y, sign) for sign in (1, -1))
    told = (pytest.approx(1.0), True) if states > 2 else (None, None)
    assert (rising.correlation, rising.agrees) == told
    assert falling.agrees is (False if states > 2 else None)
