"""Friction laws with the report's numbers (final progress report on shoe-floor friction)."""

import numpy as np
import pytest

from underfoot.core import SourcedValue
from underfoot.friction import (
    BoundaryFriction,
    BoundaryLaw,
    StribeckLaw,
    boundary_friction_at,
    friction_left,
    sampled_cof,
    stribeck_cof,
    stribeck_law_at,
    viscous_decay,
)

SOURCE = "report G.2.1 and G.2.2"


def _value(pair):
    return None if pair is None else SourcedValue(pair[0], "1", SOURCE, pair[1])


# viscosity in cP; COF_BL, tau_hydro in m/s, COF_asymptote, each with its printed spread (G.2.2)
G2 = {
    name: BoundaryFriction(
        name, "polyurethane on vinyl", cP * 1e-3, _value(bl), _value(tau), _value(left)
    )
    for name, cP, bl, tau, left in [
        ("water", 0.52, (0.69, 0.04), (2.09, 0.27), (0.001, 0.0)),
        ("detergent 1.5 %", 1.8, (0.58, 0.03), (0.68, 0.17), (0.001, 0.0)),
        ("glycerol 25 %", 1.9, (0.65, 0.03), (0.50, 0.17), (0.099, 0.027)),
        ("glycerol 50 %", 5.54, (0.47, 0.03), (0.19, 0.17), (0.111, 0.027)),
        ("glycerol 75 %", 41.0, (0.16, 0.05), None, None),
        ("canola oil", 74.6, (0.10, 0.02), None, None),
    ]
}
ALL = tuple(G2.values())
SPEEDS = np.array([0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0])  # G.2.1


def test_fit_of_figure_14():
    """COF_BL 0.839, tau 0.184, asymptote 0.164 give these values at the 11 speeds."""
    expected = [
        0.67839, 0.55599, 0.39164, 0.29619, 0.24077, 0.20858, 0.18989, 0.17903, 0.17273, 0.16907,
        0.16694,
    ]  # fmt: skip
    assert stribeck_cof(SPEEDS, 0.839, 0.184, 0.164) == pytest.approx(expected, abs=1e-5)


def test_boundary_law_of_a_measured_fluid():
    law = BoundaryLaw.from_measured(G2["glycerol 50 %"], others=ALL)
    assert law.cof_parts == pytest.approx((0.365, 0.105))
    assert law.source == SOURCE
    assert any("polyurethane on vinyl" in text for text in law.assumptions)
    fast, slow = law(1e5, np.array([1.0, 0.05]), 1e-3).total
    assert fast - slow == pytest.approx(5.54e-3 * 0.95 / 1e-3)  # no fall with speed of its own


def test_thick_glycerol_was_not_measured():
    """219 cP lies above canola oil (74.6 cP), which is kept: 0.10, spread 0.02 joined by half of
    the step from 75 % glycerol (0.06). The glycerols' COF at high speed agrees."""
    found = boundary_friction_at(0.219, ALL, fluid="glycerol 90 %")
    assert found.cof_boundary.value == pytest.approx(0.10)
    assert found.cof_boundary.uncertainty == pytest.approx(np.hypot(0.02, 0.03))
    assert found.cof_boundary.assumed
    left = friction_left(ALL)
    assert left.value == pytest.approx(0.105)
    assert abs(left.value - found.cof_boundary.value) < found.cof_boundary.uncertainty
    law = BoundaryLaw.from_measured(found, others=ALL)
    assert any("was not measured" in text for text in law.assumptions)
    assert sum(law.cof_parts) == pytest.approx(0.10)


def test_viscosity_times_decay_speed_is_one_constant():
    """1.09, 1.22, 0.95 and 1.05 mPa m for the four fitted fluids."""
    decay = viscous_decay(ALL)
    assert decay.value == pytest.approx(1.08e-3, abs=0.005e-3)
    assert decay.uncertainty / decay.value == pytest.approx(0.11, abs=0.01)


@pytest.mark.parametrize(
    ("name", "mean", "spread"), [("glycerol 75 %", 0.16, 0.05), ("canola oil", 0.10, 0.02)]
)
def test_one_constant_foretells_the_fluids_without_a_fit(name, mean, spread):
    """COF_BL of these two is their mean over the speeds (G.2.2); they took no part in the fit."""
    law = stribeck_law_at(G2[name].viscosity, ALL)
    found = law(1.0, SPEEDS, 1e9).total.mean()
    assert found == pytest.approx(mean, abs=spread)


def test_whole_shoes_without_fluid_pressure():
    """Treaded boots, 50 % glycerol, 0.3 m/s, fluid pressure below 10 kPa: ACOF 0.159 to 0.182
    (G.6.2). Eq. 17 as a local law comes near within its spread; COF_BL alone is far above."""
    fluid = G2["glycerol 50 %"]
    stribeck = StribeckLaw.from_measured(fluid)
    found = float(stribeck(1.0, 0.3, 1e9).total)
    spread = sampled_cof(stribeck, [[1.0]], [[0.0]], [[1.0]], speed=0.3).cof.std()
    assert found == pytest.approx(0.185, abs=0.001)
    assert 0.159 - spread < found < 0.182 + spread
    by_viscosity = stribeck_law_at(fluid.viscosity, ALL)
    assert float(by_viscosity(1.0, 0.3, 1e9).total) == pytest.approx(0.18, abs=0.01)
    boundary = BoundaryLaw.from_measured(fluid, others=ALL)
    assert float(boundary(1.0, 0.3, 1e9).total) > 2.5 * 0.182


def test_an_asymptote_at_its_bound_is_no_hysteresis():
    """Water and detergent print 0.001, "not as reliable" (G.2.2): the glycerols' 0.105 is taken
    for the split, and COF itself is left as fitted."""
    fluid = G2["detergent 1.5 %"]
    plain, split = StribeckLaw.from_measured(fluid), StribeckLaw.from_measured(fluid, others=ALL)
    one, other = plain(1.0, SPEEDS, 1e9), split(1.0, SPEEDS, 1e9)
    assert other.total == pytest.approx(one.total, rel=1e-12)
    assert one.hysteresis == pytest.approx(0.001)
    assert other.hysteresis == pytest.approx(0.105)
    assert any("Hysteresis" in text for text in split.assumptions)
