"""A class is told where its probability is high, else it is called the likeliest."""

import pytest

from underfoot.places.choice import _ratio
from underfoot.places.machines import MachinePrediction, machine


@pytest.mark.parametrize(("chance", "told"), [(0.9, True), (0.75, True), (0.74, False)])
def test_the_class_of_a_floor_is_told_from_three_quarters_on(chance, told):
    device = machine("pendulum-96")
    shown = MachinePrediction(
        device, device.fluid_of_standard(), (2e-6, 2e-6), True, 20.0, 30.0, 40.0,
        (("low slip potential", 1 - chance), ("high slip potential", chance)),
    )  # fmt: skip
    (line,) = shown.headline()
    assert ("no class can be told" not in line) is told
    assert "high slip potential with a probability of" in line


@pytest.mark.parametrize(
    ("value", "told"), [(0.001, "below 0.01"), (0.05, "0.05"), (1.0, "1"), (1000.0, "above 100")]
)
def test_a_ratio_of_slips_is_told_within_a_hundred_either_way(value, told):
    assert _ratio(value) == told
