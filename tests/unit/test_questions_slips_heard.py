"""Whether a sensor heard a film: there is a fluid, and somebody's film rose above its noise."""

from types import SimpleNamespace
from typing import Any, cast

import pytest

from underfoot.questions.slips import SlipPopulation


@pytest.mark.parametrize(
    ("viscosity", "durations", "heard"),
    [
        (0.2, (None, 0.01), True),
        (0.2, (None, None), False),
        (0.2, (), False),
        (None, (0.01, 0.02), False),
        (None, (None,), False),
    ],
)
def test_a_film_is_heard_on_a_wet_floor_by_one_sensor_at_least(viscosity, durations, heard):
    subjects = [SimpleNamespace(seen=SimpleNamespace(duration=each)) for each in durations]
    study = SimpleNamespace(setting=SimpleNamespace(viscosity=viscosity), subjects=subjects)
    slips = SlipPopulation("walk", cast(Any, study), cast(Any, None), "model")
    assert slips.heard is heard
    assert slips.wet is (viscosity is not None)
