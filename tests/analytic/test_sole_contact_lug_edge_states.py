"""The state of a lug with edges is the fixed point of its closed forms, iterated here anew."""

import numpy as np
import pytest

from underfoot.rough_contact import ExponentialLaw
from underfoot.sole_contact import lug_edges as module
from underfoot.sole_contact.lug_edges import LugEdges, let_in, lug_friction

PRESSURE, COF, SUCTION, MODULUS = 1e5, 0.3, 5e4, 3e6
LENGTH, HEIGHT, WIDTH = 0.01, 1e-3, 10.0


@pytest.mark.parametrize(
    ("drag", "edge"), [(0.003, 1e-3), (0.01, 3.2e-4), (0.01, 4.6e-4), (0.1, 3.2e-5), (0.1, 6.8e-5)]
)
def test_a_low_lug_is_emptied_by_what_its_edge_does_not_let_in(drag, edge):
    """h = (h_d^4 + h_0^4)^(1/4); empty is 1 - (h_0 / h_d)^4, less what is drawn back."""
    asperities = ExponentialLaw(MODULUS, 0.5, 2e-6)
    numbers = (np.array([value]) for value in (LENGTH, WIDTH, HEIGHT, edge, 1.0))
    lug = LugEdges(np.array([[1]]), np.ones((1, 1)), *numbers)
    gaps, pressures = module.gap_table(asperities)
    mu, pull, closed = COF, 0.0, 0.0
    for _ in range(2000):
        most = PRESSURE * (1 + pull)
        dry = float(np.interp(most, pressures[::-1], gaps[::-1]))
        inlet = let_in(drag, np.array([most]), lug.edge, MODULUS, mu * lug.reach).item()
        closed = min(inlet / dry, 1.0)
        back = dry**2 * SUCTION / (6 * module.LACKING * drag)
        kept = (1 - back / LENGTH) * (1 - 4 / 3 * np.sqrt(back * LENGTH) / WIDTH)
        emptied = (1 - closed**4) * kept
        gap = (dry**4 + inlet**4) ** 0.25
        mu += 0.05 * (COF * (1 + pull) + drag / gap * (1 - 0.5 * emptied) / PRESSURE - mu)
        pull += 0.05 * (emptied * SUCTION / PRESSURE - pull)
    assert 0.3 < closed < 0.97
    found = lug_friction(
        lug, np.array([[PRESSURE]]), np.array([COF]), asperities,
        modulus=MODULUS, viscosity=drag, speed=1.0, suction=SUCTION,
    )  # fmt: skip
    assert found.suction.item() == pytest.approx(pull, rel=1e-4)
