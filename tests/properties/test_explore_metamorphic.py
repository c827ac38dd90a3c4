"""One study, told in other ways: order, unit, doubled rows and idle inputs decide nothing."""

import numpy as np
import pytest
from scipy.stats import qmc

from underfoot.explore.goals import WEAR, Condition, Goal, Requirement, WearLife
from underfoot.explore.inputs import Range
from underfoot.explore.result import front_places
from underfoot.explore.surrogate import fit_surrogate

WEARS = (0.0, 1e-3, 2e-3)
STATES = [
    Condition((fluid, f"{1e3 * wear:g} mm"), {"contaminant": fluid, WEAR: wear})
    for fluid in ("oil", "water")
    for wear in WEARS
]
OUTPUTS = 0.2 + 0.05 * np.random.default_rng(1).standard_normal((7, len(STATES), 3, 4))
OUTPUTS -= 0.03 * np.tile(np.arange(3), 2)[None, :, None, None]
GOALS = [
    Goal("cof", "1", statistic, 0.2, over, within)
    for statistic in ("mean", "min", "max", "sd", "quantile")
    for over in ("conditions", "draws", "conditions and draws")
    for within in ((), ("oil",), ("water", "1 mm"))
]
LIFE = WearLife(Requirement(Goal("cof", "1"), 1, 0.17))


@pytest.mark.parametrize("goal", [*GOALS, LIFE], ids=str)
def test_the_order_of_conditions_and_draws_is_nothing(goal):
    generator = np.random.default_rng(2)
    order = generator.permutation(len(STATES))
    states = [STATES[k] for k in order]
    mixed = OUTPUTS[:, order][:, :, generator.permutation(3)][..., generator.permutation(4)]
    np.testing.assert_allclose(goal.values(mixed, states), goal.values(OUTPUTS, STATES))


@pytest.mark.parametrize("goal", GOALS, ids=str)
def test_a_goal_scales_with_its_output_and_moves_with_it(goal):
    once = goal.values(OUTPUTS, STATES)
    np.testing.assert_allclose(goal.values(3 * OUTPUTS, STATES), 3 * once)
    moved = 0.0 if goal.statistic == "sd" else 0.1
    np.testing.assert_allclose(goal.values(OUTPUTS + 0.1, STATES), once + moved)


def test_what_is_not_within_does_not_count():
    changed = OUTPUTS.copy()
    changed[:, 3:] += 1.0  # water
    for goal in (one for one in GOALS if one.within == ("oil",)):
        np.testing.assert_allclose(goal.values(changed, STATES), goal.values(OUTPUTS, STATES))
    changed[:, 0] += 1.0
    assert all(
        (goal.values(changed, STATES) != goal.values(OUTPUTS, STATES)).all()
        for goal in GOALS
        if goal.within == ("oil",) and goal.statistic in ("mean", "max")
    )


def test_the_least_of_one_is_the_greatest_of_its_negative():
    for over in ("conditions", "draws", "conditions and draws"):
        least = Goal("cof", "1", "min", over=over).values(OUTPUTS, STATES)
        most = Goal("cof", "1", "max", over=over).values(-OUTPUTS, STATES)
        np.testing.assert_allclose(least, -most)
    upper = Goal("cof", "1", "quantile", 0.8).values(-OUTPUTS, STATES)
    np.testing.assert_allclose(Goal("cof", "1", "quantile", 0.2).values(OUTPUTS, STATES), -upper)


def test_a_bound_from_below_is_one_from_above_of_the_negative():
    low, high = (Requirement(Goal("cof", "1"), sense, sense * 0.2) for sense in (1, -1))
    values = np.linspace(0.1, 0.3, 5)
    np.testing.assert_allclose(low.margin(values), high.margin(-values))
    life = WearLife(Requirement(Goal("cof", "1"), -1, -0.17))
    np.testing.assert_allclose(life.values(-OUTPUTS, STATES), LIFE.values(OUTPUTS, STATES))


def test_a_wear_life_is_that_of_the_worst_fluid_and_lengthens_with_friction():
    alone = [LIFE.values(OUTPUTS[:, part], STATES[part]) for part in (slice(0, 3), slice(3, 6))]
    both = LIFE.values(OUTPUTS, STATES)
    np.testing.assert_allclose(both, np.minimum(*alone))
    assert (LIFE.values(OUTPUTS + 0.01, STATES) >= both).all()
    assert (LIFE.values(OUTPUTS + 0.01, STATES) > both).any()
    # the same falls at half the wear: half the life
    half = [Condition(one.parts, {**one.changes, WEAR: 0.5 * one.changes[WEAR]}) for one in STATES]
    np.testing.assert_allclose(LIFE.values(OUTPUTS, half), 0.5 * both)


ROWS = np.random.default_rng(3).integers(0, 6, (40, 3)).astype(float)


def fronts(rows, allowed=None):
    allowed = np.ones(len(rows), dtype=bool) if allowed is None else allowed
    return {tuple(rows[k]) for k in front_places(rows, allowed)}


def test_a_front_is_that_of_its_definition():
    beaten = [any((other <= one).all() and (other < one).any() for other in ROWS) for one in ROWS]
    assert fronts(ROWS) == {tuple(one) for one, lost in zip(ROWS, beaten, strict=True) if not lost}


def test_a_front_knows_no_order_unit_or_row_that_is_beaten():
    first = fronts(ROWS)
    order = np.random.default_rng(4).permutation(len(ROWS))
    assert fronts(ROWS[order]) == first
    assert fronts(np.vstack([ROWS, ROWS])) == first
    assert fronts(np.vstack([ROWS, [[9, 9, 9]], [[np.nan, -1, -1]]])) == first
    assert {tuple(np.array(one) / (2, 5, 1)) for one in fronts(ROWS * (2, 5, 1))} == first
    assert {one[::-1] for one in fronts(ROWS[:, ::-1])} == first
    places = front_places(ROWS, np.ones(len(ROWS), dtype=bool))
    assert (np.diff(ROWS[places, 0]) >= 0).all()  # the best in the first goal first


def test_what_is_not_allowed_is_as_if_it_were_not_there():
    allowed = np.random.default_rng(5).random(len(ROWS)) > 0.4
    assert fronts(ROWS, allowed) == fronts(ROWS[allowed])


BOX = tuple(Range(name, 0.0, 1.0) for name in ("shoe.tread.depth", "motion.speed"))
POINTS = qmc.Sobol(2, rng=1).random(32)
VALUES = 0.2 * np.exp(0.8 * POINTS[:, 0] - 0.5 * POINTS[:, 1] ** 2)
VALUES *= 1 + 0.01 * np.random.default_rng(6).standard_normal(32)
NEW = qmc.Sobol(2, rng=7).random(16)


@pytest.fixture(scope="module")
def surrogate():
    return fit_surrogate("cof", "1", BOX, POINTS, VALUES)


def test_a_surrogate_knows_no_unit(surrogate):
    large = fit_surrogate("cof", "1", BOX, POINTS, 1e3 * VALUES)
    for one, other in zip(surrogate.prediction(NEW), large.prediction(NEW), strict=True):
        np.testing.assert_allclose(other, 1e3 * one, rtol=1e-3)
    assert large.error == pytest.approx(1e3 * surrogate.error, rel=1e-3)
    assert (large.q2, large.stretch) == pytest.approx((surrogate.q2, surrogate.stretch), rel=1e-3)


def test_a_surrogate_knows_no_order_of_runs_nor_of_inputs(surrogate):
    mean, deviation = surrogate.prediction(NEW)
    order = np.random.default_rng(8).permutation(32)
    mixed = fit_surrogate("cof", "1", BOX, POINTS[order], VALUES[order])
    turned = fit_surrogate("cof", "1", BOX[::-1], POINTS[:, ::-1], VALUES)
    back = fit_surrogate("cof", "1", BOX, 1 - POINTS, VALUES)
    for other, places in ((mixed, NEW), (turned, NEW[:, ::-1]), (back, 1 - NEW)):
        np.testing.assert_allclose(other.prediction(places)[0], mean, rtol=0.01)
        # what was left out together differs
        np.testing.assert_allclose(other.prediction(places)[1], deviation, rtol=0.35)
        assert other.q2 == pytest.approx(surrogate.q2, abs=0.01)


def test_an_idle_input_moves_no_prediction(surrogate):
    idle = Range("floor.roughness.rq", 0.0, 1.0)
    noise = qmc.Sobol(1, rng=9).random(32)
    more = fit_surrogate("cof", "1", (*BOX, idle), np.column_stack([POINTS, noise]), VALUES)
    for place in (0.1, 0.9):
        mean = more.mean(np.column_stack([NEW, np.full(16, place)]))
        np.testing.assert_allclose(mean, surrogate.mean(NEW), rtol=0.03)


def test_runs_without_a_number_are_as_if_they_were_not_there(surrogate):
    points = np.vstack([POINTS, qmc.Sobol(2, rng=10).random(4)])
    some = fit_surrogate("cof", "1", BOX, points, np.append(VALUES, [np.nan] * 4))
    np.testing.assert_allclose(some.mean(NEW), surrogate.mean(NEW), rtol=1e-9)
