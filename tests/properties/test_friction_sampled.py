"""Sampled intervals of COF: what must hold for any sole, law and seed."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.core import SourcedValue
from underfoot.friction import (
    BoundaryLaw,
    BowdenTaborLaw,
    ShearStrength,
    asperity_ehl_law,
    cof,
    propagated,
    sampled_cof,
    self_affine_scale,
)

SCALE = self_affine_scale(2.5e-6, rq=8.3e-6, longest_wave=0.8e-3)
SPREAD = {"modulus_deviation": 0.5e6, "roughness_deviation": 0.1}


def sole(seed):
    """Contact, fluid pressure and film of a made-up sole, with dry and with unloaded places."""
    rng = np.random.default_rng(seed)
    contact = rng.exponential(2e5, (40, 50)) * (rng.random((40, 50)) < 0.7)
    fluid = rng.exponential(5e4, (40, 50))
    return contact, fluid, rng.uniform(1e-6, 1e-4, (40, 50)), rng.random((40, 50)) < 0.8


def asperity_law(viscosity=5e-3):
    return asperity_ehl_law(SCALE, modulus=2e6, viscosity=viscosity, **SPREAD)


def test_classes_of_pressure_stand_for_every_cell():
    """The same draws on all cells: the classes give the same COF within half a percent."""
    contact, fluid, film, wet = sole(1)
    law = asperity_law()
    found = sampled_cof(law, contact, fluid, film, speed=0.3, wet=wet, samples=100, seed=4)
    inputs = {**law.inputs, "model": SourcedValue(0.0, "1", "", law.error_of_model)}
    load, carried = (contact + fluid).sum(), contact.sum() / (contact + fluid).sum()

    def whole(values):
        drawn = law.at({k: v for k, v in values.items() if k != "model"})(contact, 0.3, film)
        solid = (drawn.adhesion + drawn.hysteresis).sum() / load + values["model"] * carried
        return max(solid, 0.0) + drawn.viscous[wet].sum() / load

    exact = propagated(whole, inputs, samples=100, seed=4, shares=False)
    assert found.cof == pytest.approx(exact.draws, rel=5e-3)


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 1000), draw=st.integers(0, 100))
def test_the_seed_fixes_the_numbers_and_parts_add_up(seed, draw):
    contact, fluid, film, wet = sole(seed)
    given_law = asperity_law()
    made = [
        sampled_cof(given_law, contact, fluid, film, speed=0.3, wet=wet, samples=100, seed=draw)
        for _ in range(2)
    ]
    assert np.array_equal(made[0].cof, made[1].cof)
    parts = made[0].adhesion + made[0].hysteresis + made[0].viscous
    assert made[0].cof == pytest.approx(parts, rel=1e-12)
    assert (made[0].adhesion >= 0).all()
    assert (made[0].hysteresis >= 0).all()
    assert sum(made[0].share.values()) == pytest.approx(1.0)


def test_the_interval_holds_the_value_and_grows_with_the_spread():
    contact, fluid, film, wet = sole(2)
    widths = []
    for spread in (0.01, 0.03, 0.09):
        law = BoundaryLaw(
            SourcedValue(0.4, "1", "made up", spread), SourcedValue(0.1, "1", "made up", 0.01)
        )
        draws = sampled_cof(law, contact, fluid, film, speed=0.3, wet=wet)
        found = cof(law(contact, 0.3, film), contact, fluid, spacing=1e-3, wet=wet, sampled=draws)
        low, high = found.cof.interval
        assert low < found.cof.value < high
        widths.append(high - low)
    share = contact.sum() / (contact + fluid).sum()
    assert widths == pytest.approx([3.92 * s * share for s in (0.01, 0.03, 0.09)], rel=0.05)


def test_the_viscous_part_spreads_with_the_viscosity_alone():
    contact, fluid, film, wet = sole(3)
    for spread in (None, 0.5e-3):
        viscosity = SourcedValue(5e-3, "Pa*s", "made up", spread)
        draws = sampled_cof(
            asperity_law(), contact, fluid, film,
            speed=0.3, wet=wet, fluid_inputs={"viscosity": viscosity},
        )  # fmt: skip
        viscous = draws.sourced("viscous", SourcedValue(float(draws.viscous.mean())))
        if spread is None:
            assert viscous.uncertainty is None
            assert "viscosity" in viscous.reason
            assert draws.left_out == ("viscosity",)
        else:
            assert viscous.uncertainty == pytest.approx(0.1 * viscous.value, rel=0.02)


def test_a_law_with_an_input_of_unknown_spread_gives_no_interval():
    contact, fluid, film, wet = sole(4)
    strength = BowdenTaborLaw(ShearStrength(3e5, "made up"), lambda p, _: p / 1e6, 0.1)
    assert sampled_cof(strength, contact, fluid, film, speed=0.3, wet=wet) is None
    viscosity = {"viscosity": SourcedValue(5e-3, "Pa*s", "made up", 1e-3)}
    assert (
        sampled_cof(strength, contact, fluid, film, speed=0.3, wet=wet, fluid_inputs=viscosity)
        is None
    )


def test_a_wide_spread_is_drawn_log_normal_with_the_same_mean_and_deviation():
    wide = propagated(
        lambda values: values["x"], {"x": SourcedValue(2.0, uncertainty=1.2)}, samples=8000
    )
    drawn = wide.drawn["x"]
    assert drawn.min() > 0.0
    assert drawn.mean() == pytest.approx(2.0, rel=5e-3)
    assert np.log(drawn).std() == pytest.approx(np.sqrt(np.log1p(0.36)), rel=5e-3)
    assert wide.deviation == pytest.approx(1.2, rel=0.03)
