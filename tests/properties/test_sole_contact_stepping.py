"""A sole carried in time: pieces add up, loads fall, speed turns, the sole rolls."""

import math
from functools import cache

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from underfoot.core import InputError, Status
from underfoot.rough_contact.pressure_gap_law import ExponentialLaw
from underfoot.shoe import Facet, Flat, Heel, heel_map
from underfoot.sole_contact.compliance import layered_compliance
from underfoot.sole_contact.solver import SolverSettings, solve_sliding
from underfoot.sole_contact.stepping import SlidingSole, rolled_sole

MODULUS = 5e6
TEN = math.radians(10)


def heel(profile=None):
    return Heel(
        length=0.06,
        width=0.06,
        rear_radius=0.028,
        outsole_thickness=0.025,
        profile=profile or Facet(TEN, 0.03),
        edge_radius=0.002,
    )


SHAPE = heel_map(heel(), shoe_angle=TEN, spacing=2e-3)


@cache
def pressed_body():
    return layered_compliance(SHAPE, modulus=MODULUS, poisson_ratio=0.49, thickness=0.025)


def sliding(shape=SHAPE, body=None, viscosity: float | None = 0.1, rq=12e-6, **settings):
    return SlidingSole(
        shape,
        body or pressed_body(),
        ExponentialLaw(MODULUS, 0.5, rq),
        viscosity=viscosity,
        settings=SolverSettings(**settings),
        shoe_angle=TEN,
    )


def test_one_run_is_the_sum_of_its_pieces():
    whole, pieces = sliding(), sliding()
    whole.advance(0.03, normal_force=400.0, speed=0.5, longest_step=2e-3)
    one = whole.advance(0.03, normal_force=400.0, speed=0.5, longest_step=2e-3)
    many = None
    for step in range(1, 31):
        many = pieces.advance(2e-3, normal_force=400.0 * min(step / 15, 1.0), speed=0.5)
    assert many is not None
    assert many.time == pytest.approx(one.time) == pytest.approx(0.06)
    assert many.fluid_load == pytest.approx(one.fluid_load, rel=0.02)
    assert many.approach == pytest.approx(one.approach, rel=2e-3)


def test_advance_and_solve_sliding_are_one_march():
    solved = solve_sliding(
        SHAPE,
        pressed_body(),
        ExponentialLaw(MODULUS, 0.5, 12e-6),
        viscosity=0.1,
        speed=0.5,
        normal_force=400.0,
    )
    sole = sliding()
    sole.advance(0.03, normal_force=400.0, speed=0.5, longest_step=0.03 / 8)
    last = sole.advance(0.09, normal_force=400.0, speed=0.5, longest_step=0.09 / 8)
    assert last.fluid_load == pytest.approx(solved.fluid_load, rel=1e-9)


@pytest.mark.slow
@settings(max_examples=5, deadline=None, phases=[Phase.explicit, Phase.generate])
@given(
    low=st.floats(2.0, 100.0),
    turn=st.integers(-10, 10).map(lambda tenths: tenths / 10),
    viscosity=st.sampled_from([1e-3, 0.02, 0.3]),
)
def test_load_and_speed_may_rise_fall_and_turn(low, turn, viscosity):
    sole = sliding(viscosity=viscosity)
    for force, speed in ((500.0, 0.5), (500.0, 0.5), (low, turn), (300.0, -turn), (low, 0.0)):
        state = sole.advance(0.03, normal_force=force, speed=speed)
        assert state.status is Status.CONVERGED
        assert state.fluid_load + state.contact_load == pytest.approx(force, rel=2e-3)
        assert state.speed == pytest.approx(speed)
        assert (state.fluid_pressure >= 0).all()
        assert (state.film_thickness >= 0).all()
    assert len(sole.history.time) == sole.counts.time_steps
    assert sole.history.speed[-1] == 0.0


def test_a_foot_that_lifts_leaves_its_last_weight():
    sole = sliding()
    sole.advance(0.03, normal_force=400.0, speed=0.3)
    state = sole.advance(0.03, normal_force=0.0, speed=0.3)
    assert state.status is Status.CONVERGED
    assert state.fluid_load + state.contact_load == pytest.approx(0.4, rel=1e-3)


def test_an_unloaded_sole_draws_no_suction_and_lets_go():
    """The film holds pressure while it is pressed; when the load falls the gap opens."""
    sole = sliding(viscosity=0.5)
    pressed = sole.advance(0.05, normal_force=500.0, speed=0.0)
    freed = sole.advance(0.01, normal_force=5.0, speed=0.0)
    assert freed.approach < pressed.approach
    assert freed.cavitated.sum() > 0
    assert freed.fluid_load <= 5.0 * (1 + 1e-3)


@pytest.mark.parametrize("profile", [Flat(), Facet(math.radians(8), 0.03)])
def test_rolled_map_is_the_map_of_the_new_angle(profile):
    """On the cells of the sole, rolling turns every point about the rear end."""
    spacing = 0.5e-3
    shape = heel_map(heel(profile), shoe_angle=TEN, spacing=spacing)
    change = math.radians(-6)
    rolled = rolled_sole(shape, change).clearance
    other = heel_map(heel(profile), shoe_angle=TEN + change, spacing=spacing)
    middle = shape.y.size // 2
    inside = shape.inside[:, middle] & (shape.x > 3e-3) & (shape.x < 0.055)
    moved = shape.x * math.cos(change) - shape.clearance[:, middle] * math.sin(change)
    there = np.interp(
        moved[inside],
        other.x[other.inside[:, middle]],
        other.clearance[:, middle][other.inside[:, middle]],
    )
    offset = rolled[:, middle][inside] - there
    assert np.ptp(offset) < 0.03e-3  # the rear end's own shift along a slope of 10 deg
    assert rolled.min() == 0


def test_dry_rolling_ends_where_pressing_at_that_angle_does():
    dry = sliding(viscosity=None, rq=20e-6)
    dry.advance(0.03, normal_force=400.0, speed=0.5)
    flat = dry.advance(0.03, normal_force=400.0, speed=0.5, shoe_angle=math.radians(4))
    direct = sliding(viscosity=None, rq=20e-6)
    straight = direct.advance(0.03, normal_force=400.0, speed=0.5, shoe_angle=math.radians(4))
    assert flat.status is straight.status is Status.CONVERGED
    assert flat.contact_pressure == pytest.approx(
        straight.contact_pressure, abs=2e-3 * straight.contact_pressure.max()
    )


def test_heel_strike_to_flat_moves_the_pressure_forward():
    sole = sliding(viscosity=0.05)
    strike = sole.advance(0.02, normal_force=300.0, speed=0.4)
    down = sole.advance(0.06, normal_force=500.0, speed=0.1, shoe_angle=0.0)
    assert down.status is Status.CONVERGED
    assert down.shoe_angle == 0.0

    def centre(state):
        pressure = state.total_pressure.sum(axis=1)
        return float((pressure * state.x).sum() / pressure.sum())

    assert centre(down) > centre(strike) + 5e-3
    assert sole.history.shoe_angle[-1] == 0.0


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"duration": 0.0}, "duration"),
        ({"normal_force": -1.0}, "normal_force"),
        ({"normal_force": float("nan")}, "normal_force"),
        ({"speed": float("inf")}, "speed"),
        ({"shoe_angle": 2.0}, "shoe_angle"),
        ({"shoe_angle": math.radians(50)}, "shoe_angle"),
    ],
)
def test_bad_demands_are_refused(change, where):
    given_ = {"duration": 0.01, "normal_force": 10.0, "speed": 0.1} | change
    with pytest.raises(InputError) as caught:
        sliding().advance(given_.pop("duration"), **given_)
    assert caught.value.where == where


def test_a_march_that_fails_says_where_it_stopped():
    sole = sliding()
    sole.advance(0.03, normal_force=400.0, speed=0.5)
    state = sole.advance(0.09, normal_force=400.0, speed=0.5, longest_step=1e-3, most_steps=5)
    assert state.status is Status.NOT_CONVERGED
    assert state.remedy
    assert 0.03 < state.time == sole.time < 0.12
