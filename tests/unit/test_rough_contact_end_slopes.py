"""Ends of a tabulated law of a rough contact."""

import numpy as np
import pytest

from underfoot.rough_contact import TabulatedLaw


def test_below_its_nodes_a_law_rises_by_a_tenth_of_the_first_secant_at_least():
    """The cubic through ln p = 0, -0.1, -3, -6 would begin level, and the pressure would stay."""
    gap, logarithm = 1e-6 * np.arange(4.0), np.array([0.0, -0.1, -3.0, -6.0])
    law = TabulatedLaw("t", "s", gap, 1e5 * np.exp(logarithm), np.linspace(0.1, 0.9, 4))
    below = float(law.pressure(-1e-6))
    assert below == pytest.approx(1e5 * (1 + 0.1 * 0.1))
    assert float(law.pressure(0.0)) == pytest.approx(1e5)
    assert float(law.stiffness(0.0)) == pytest.approx(0.1 * 0.1 * 1e5 / 1e-6)
