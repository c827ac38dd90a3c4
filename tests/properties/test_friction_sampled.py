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
    propagate_spread,
    sampled_cof,
    self_affine_scale,
)
from underfoot.friction.propagation import named_shares, normal_draws, probability_higher
from underfoot.friction.sampled_cof import HIGHEST, VACUUM

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

    exact = propagate_spread(whole, inputs, samples=100, seed=4, shares=False)
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
        viscous = draws.sourced_value("viscous", SourcedValue(float(draws.viscous.mean())))
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
    wide = propagate_spread(
        lambda values: values["x"], {"x": SourcedValue(2.0, uncertainty=1.2)}, samples=8000
    )
    drawn = wide.drawn["x"]
    assert drawn.min() > 0.0
    assert drawn.mean() == pytest.approx(2.0, rel=5e-3)
    assert np.log(drawn).std() == pytest.approx(np.sqrt(np.log1p(0.36)), rel=5e-3)
    assert wide.deviation == pytest.approx(1.2, rel=0.03)


EXACT = BoundaryLaw(SourcedValue(0.4, "1", "", 1e-9), SourcedValue(0.1, "1", "", 1e-9))


def drawn_cof(law=EXACT, **options):
    contact, fluid, film, wet = sole(5)
    return sampled_cof(law, contact, fluid, film, speed=0.3, wet=wet, **options)


def test_the_error_of_the_film_load_spreads_the_odds_of_the_contact():
    """Odds F / (W - F) times exp(z), z normal: contact carries 1 / (c + (1 - c) exp z) of c."""
    contact, fluid, *_ = sole(5)
    carried = contact.sum() / (contact + fluid).sum()
    error = 0.5 * normal_draws(0, "film", 500)
    plain, spread = drawn_cof(samples=500), drawn_cof(film_error=error, samples=500)
    solid = (spread.adhesion + spread.hysteresis) / (plain.adhesion + plain.hysteresis).mean()
    z = np.log((1 / solid - carried) / (1 - carried))
    assert z.std() == pytest.approx(0.5, rel=0.03)
    assert z.mean() == pytest.approx(0.0, abs=0.01)
    assert spread.adhesion + spread.hysteresis + spread.viscous == pytest.approx(spread.cof)


def test_the_error_of_the_tread_is_a_factor_up_to_the_highest_cof():
    error = 0.5 * normal_draws(0, "tread", 500)
    plain, spread = drawn_cof(samples=500), drawn_cof(tread_error=error, samples=500)
    assert spread.cof == pytest.approx(plain.cof * np.exp(error), rel=1e-6)
    assert spread.viscous == pytest.approx(plain.viscous * np.exp(error), rel=1e-6)
    assert spread.share["tread"] > 0.99
    far = drawn_cof(tread_error=error + 6.0, samples=500)
    assert far.cof == pytest.approx(HIGHEST, rel=1e-6)


def test_warmth_and_zero_move_the_film_s_part_alone():
    warmth, zero = (0.2 * normal_draws(0, name, 500) for name in ("warmth", "zero"))
    law = asperity_law(viscosity=2.0)
    plain = drawn_cof(law, samples=500)
    warm = drawn_cof(law, film_shear=warmth, samples=500)
    assert plain.viscous.min() > 0.05
    assert warm.viscous == pytest.approx(plain.viscous * np.exp(warmth), rel=1e-6)
    assert warm.adhesion == pytest.approx(plain.adhesion, rel=1e-9)
    off = drawn_cof(law, zero=0.01 * zero, samples=500)
    assert off.cof - plain.cof == pytest.approx(np.maximum(0.01 * zero, -plain.viscous), abs=1e-9)
    contact, _, film, wet = sole(5)
    dry = [
        sampled_cof(EXACT, contact, 0 * contact, film, speed=0.3, wet=wet, film_shear=each).cof
        for each in (None, warmth)
    ]
    assert np.array_equal(*dry)


def test_suction_that_is_known_changes_no_draw_and_a_wide_one_stays_below_a_vacuum():
    plain = drawn_cof().cof
    known = drawn_cof(suction=(SourcedValue(5e4, "Pa", "", 1e-3), 0.3)).cof
    assert known == pytest.approx(plain, rel=1e-6)
    contact_part = drawn_cof()
    solid = contact_part.adhesion + contact_part.hysteresis
    wide = drawn_cof(suction=(SourcedValue(5e4, "Pa", "", 2e5), 0.3))
    ratio = (wide.adhesion + wide.hysteresis) / solid.mean()
    assert ratio.min() >= 0.7 - 1e-6
    assert ratio.max() <= 1 + 0.3 * (VACUUM / 5e4 - 1) + 1e-6
    assert ratio.max() > 1.1
    assert wide.adhesion.std() / wide.adhesion.mean() == pytest.approx(
        ratio.std() / ratio.mean(), rel=0.05
    )  # both parts in proportion


def test_draws_of_two_inputs_are_normal_independent_and_give_the_interval():
    inputs = {name: SourcedValue(10.0, "1", "", 1.0) for name in "ab"}
    found = propagate_spread(lambda values: values["a"], inputs, samples=4000)
    drawn = np.array([found.drawn[name] for name in "ab"])
    assert drawn.mean(axis=1) == pytest.approx([10.0, 10.0], abs=1e-3)
    assert drawn.std(axis=1) == pytest.approx([1.0, 1.0], rel=5e-3)
    assert abs(np.corrcoef(drawn)[0, 1]) < 0.05
    assert (found.low, found.high) == pytest.approx((10 - 1.96, 10 + 1.96), abs=0.01)
    a, b = (named_shares(1, name, 1000) for name in "ab")
    assert abs(np.corrcoef(a, b)[0, 1]) < 0.1
    assert np.array_equal(a, named_shares(1, "a", 1000))


def test_the_chance_that_one_value_is_higher():
    apart = probability_higher((1.0, 0.6, None), (0.0, 0.8, None), shared=False)
    assert apart == pytest.approx(0.8413, abs=1e-4)  # one standard deviation of the difference
    ties = np.array([1.0, 2.0, 3.0, 4.0]), np.array([1.0, 2.0, 2.0, 5.0])
    both = probability_higher((0.0, 1.0, ties[0]), (0.0, 1.0, ties[1]), shared=True)
    assert both == pytest.approx(0.25 + 0.5 * 0.5)
