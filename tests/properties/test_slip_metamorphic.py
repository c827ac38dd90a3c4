"""One step, told in other ways: names, units of weight, finer times and mirrored feet."""

from dataclasses import replace

import numpy as np
import pytest

from slip_floors import Floor
from underfoot.core import SourcedValue
from underfoot.slip import (
    Beschorner2016,
    Chang2004,
    RcofPopulation,
    ReportG6,
    needed_acof,
    slip_risk,
)
from underfoot.slip.dynamics import (
    FloorSensors,
    Walker,
    array_pressures,
    observe_slip,
    packaged_histories,
    slip_motion,
)
from underfoot.slip.dynamics.sensors import MAP_X, MAP_Y
from underfoot.slip.risk import slip_chances

HISTORY = next(
    one
    for one in packaged_histories()
    if one.heel_velocity is not None and one.foot_angle is not None
)
MODELS = (ReportG6(), Beschorner2016(), Chang2004())
PERSONS = RcofPopulation(0.2, 0.03)
DRAWS = 0.22 * np.exp(0.2 * np.random.default_rng(1).standard_normal(400))


def finer(history, parts=4):
    """Return the history with samples between its own, on the straight lines."""
    time = np.interp(
        np.arange(parts * (history.time.size - 1) + 1) / parts,
        np.arange(history.time.size),
        history.time,
    )

    def between(values):
        return None if values is None else np.interp(time, history.time, values)

    return replace(
        history,
        time=time,
        normal=between(history.normal),
        ratio=between(history.ratio),
        foot_angle=between(history.foot_angle),
        heel_velocity=between(history.heel_velocity),
    )


def test_a_history_of_more_samples_asks_the_same():
    more = finer(HISTORY)
    assert more.rcof == pytest.approx(HISTORY.rcof, rel=1e-9)
    assert more.end_of_braking == pytest.approx(HISTORY.end_of_braking, abs=0.02)
    np.testing.assert_allclose(
        np.interp(HISTORY.time, more.time, more.landing), HISTORY.landing, atol=1e-9
    )


def test_a_history_stretched_asks_the_same_later():
    slow = HISTORY.lasting(1.3 * HISTORY.duration)
    assert slow.rcof == pytest.approx(HISTORY.rcof)
    assert slow.end_of_braking == pytest.approx(1.3 * HISTORY.end_of_braking)
    assert slow.lasting(HISTORY.duration).time == pytest.approx(HISTORY.time)
    more = HISTORY.asking(0.3)
    assert more.rcof == pytest.approx(0.3)
    assert more.asking(HISTORY.rcof).ratio == pytest.approx(HISTORY.ratio)


def test_how_the_foot_pushes_off_asks_nothing_of_the_heel():
    late = HISTORY.time > 0.6 * HISTORY.duration
    other = replace(HISTORY, ratio=np.where(late, 1.4, HISTORY.ratio))
    assert other.rcof == HISTORY.rcof


PERSON = Walker(HISTORY, mass=70.0, rcof=0.2, heel_speed=0.4)


def moved(person, cof=0.08, step=1e-3):
    return slip_motion(person, Floor(cof), step=step)


def test_a_heavier_person_on_the_same_friction_slips_the_same():
    one, heavy = moved(PERSON), moved(replace(PERSON, mass=140.0))
    assert one.distance[-1] > 0.02
    np.testing.assert_allclose(heavy.speed, one.speed, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(heavy.distance, one.distance, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(heavy.friction, 2 * one.friction, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(heavy.normal, 2 * one.normal, rtol=1e-6)
    np.testing.assert_allclose(heavy.work_in, 2 * one.work_in, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(heavy.dissipated, 2 * one.dissipated, rtol=1e-6, atol=1e-9)


def test_names_finer_times_and_finer_steps_change_no_slip():
    one = moved(PERSON)
    named = moved(replace(PERSON, history=replace(HISTORY, name="other", source="elsewhere")))
    assert named.distance[-1] == one.distance[-1]
    more = moved(replace(PERSON, history=finer(HISTORY)))
    assert more.distance[-1] == pytest.approx(one.distance[-1], rel=0.01)
    fine = moved(PERSON, step=2.5e-4)
    assert fine.distance[-1] == pytest.approx(one.distance[-1], rel=0.02)
    assert fine.speed.max() == pytest.approx(one.speed.max(), rel=0.02)


def test_where_the_heel_lands_changes_no_slip_but_what_crosses_the_sensors():
    one, far = moved(PERSON), moved(replace(PERSON, landing=5.0))
    np.testing.assert_array_equal(far.distance, one.distance)
    array = FloorSensors()
    assert observe_slip(moved(replace(PERSON, landing=0.0)), None, array).crossed
    assert not observe_slip(far, None, array).crossed
    for side in (-1, 1):
        beside = moved(replace(PERSON, landing=0.0, lateral=side * 0.031))
        assert not observe_slip(beside, None, array).crossed
        inside = moved(replace(PERSON, landing=0.0, lateral=side * 0.029))
        assert observe_slip(inside, None, array).crossed


def test_what_is_observed_is_how_the_foot_moved():
    one = moved(PERSON)
    seen = observe_slip(one, None, FloorSensors())
    assert seen.distance == pytest.approx(one.distance[-1], rel=0.05)
    assert seen.duration is None
    assert seen.row_peaks == ()
    assert seen.peak_pressure == 0.0


def blob(motion, x=0.03, y=0.004):
    """Return maps of a pressure that stands at one place of the sole."""
    shape = np.exp(-(((MAP_X[:, None] - x) / 0.02) ** 2) - ((MAP_Y[None, :] - y) / 0.01) ** 2)
    return 2e5 * np.repeat(shape[None], motion.time.size, axis=0)


def test_a_mirrored_foot_reads_on_the_other_columns():
    left, right = (moved(replace(PERSON, lateral=side * 0.012)) for side in (1, -1))
    array = FloorSensors()
    one = array_pressures(left, blob(left), array)
    image = array_pressures(right, blob(right)[:, :, ::-1], array)
    np.testing.assert_allclose(image, one[:, :, ::-1], atol=1e-6)
    assert one.max(axis=(0, 1))[0] != pytest.approx(one.max(axis=(0, 1))[2], rel=0.1)


def test_a_row_further_on_reads_what_the_first_read_of_a_heel_further_back():
    one = moved(PERSON)
    rows = array_pressures(one, blob(one), FloorSensors(rows=2, spacing=0.02))
    back = moved(replace(PERSON, landing=PERSON.landing + 0.02))
    first = array_pressures(back, blob(back), FloorSensors(rows=1, spacing=0.02))
    np.testing.assert_allclose(rows[:, 1], first[:, 0])
    assert rows[:, 0].max() > 0


@pytest.mark.parametrize("model", MODELS, ids=lambda one: one.name)
def test_a_risk_knows_no_order_and_no_doubling_of_draws(model):
    def of(draws):
        return slip_risk(SourcedValue(0.22, "1"), rcof=PERSONS, model=model, samples=draws)

    one = slip_chances(DRAWS, PERSONS, model, normal=lambda _: np.zeros(DRAWS.size))
    order = np.random.default_rng(2).permutation(DRAWS.size)
    mixed = slip_chances(DRAWS[order], PERSONS, model, normal=lambda _: np.zeros(DRAWS.size))
    np.testing.assert_allclose(mixed, one[order])
    low, high = of(DRAWS * 0.8).probability.value, of(DRAWS).probability.value
    assert low > high
    assert of(DRAWS).at_best_estimate == pytest.approx(of(DRAWS * 3).at_best_estimate)


def test_friction_and_need_shifted_together_slip_as_often():
    for shift in (-0.05, 0.1):
        found = Chang2004().population(0.25 + shift, 0.2 + shift, 0.03)
        assert found == pytest.approx(Chang2004().population(0.25, 0.2, 0.03))


@pytest.mark.parametrize("model", MODELS, ids=lambda one: one.name)
@pytest.mark.parametrize("spread", [None, 0.03])
def test_the_friction_that_is_needed_has_the_risk_it_is_needed_for(model, spread):
    known = None if spread is None else SourcedValue(0.2, "1", uncertainty=spread)
    for risk in (0.3, 0.05):
        needed = needed_acof(risk, rcof=PERSONS, model=model, acof=known)
        value = SourcedValue(needed, "1", uncertainty=spread and spread * needed / 0.2)
        again = slip_risk(value, rcof=PERSONS, model=model).probability.value
        assert again == pytest.approx(risk, rel=1e-4)


def test_a_slope_up_takes_back_what_one_down_asked():
    slope = np.radians(5)
    back = PERSONS.on_slope(slope).on_slope(-slope)
    assert (back.mean, back.sd) == pytest.approx((PERSONS.mean, PERSONS.sd))
    assert PERSONS.on_slope(slope).mean > PERSONS.mean
