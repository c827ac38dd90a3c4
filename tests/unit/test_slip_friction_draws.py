"""Draws of the friction of a contact are levels about the friction that a study was made with."""

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.slip.dynamics import study as module
from underfoot.slip.dynamics.sensors import MAP_X, MAP_Y, PressureShape, pressure_shape
from underfoot.slip.dynamics.study import MEAN_PRESSURE, SlipStudy


@pytest.mark.parametrize("hysteresis", [0.0, 1e4, 4e4])
def test_a_draw_of_what_is_expected_is_the_study_itself(monkeypatch, hysteresis):
    parts = SimpleNamespace(adhesion=np.array(2e4), hysteresis=np.array(hysteresis))
    expected = (2e4 + hysteresis) / MEAN_PRESSURE
    draws = expected * np.exp(0.2 * np.random.default_rng(0).standard_normal(999))
    monkeypatch.setattr(module, "sampled_points", lambda *_, **__: SimpleNamespace(draws=draws))
    made = SimpleNamespace(
        sole=object(), setting=SimpleNamespace(friction=lambda *_: parts),
        at_contact_friction=lambda factor: factor,
    )  # fmt: skip
    found = SlipStudy.at_friction_draws(cast(Any, made))
    factors = np.array(found.levels)[found.nearest]
    assert np.median(factors) == pytest.approx(1.0, rel=0.1)
    inside = np.abs(np.log(draws / expected)) < 0.4
    assert factors[inside] == pytest.approx((draws / expected)[inside], rel=0.15)


@pytest.mark.parametrize(
    ("speeds", "crossed", "chosen"),
    [
        ([0.1, 0.5, 0.3, 0.9, 0.7], [True] * 5, 1),
        ([0.1, 0.5, 0.3, 0.9, 0.7], [True, False, True, True, False], 2),
        ([0.1, 0.5, 0.3], [False] * 3, 2),
    ],
)
def test_the_slip_that_is_shown_is_the_median_of_those_who_crossed(speeds, crossed, chosen):
    subjects = [
        SimpleNamespace(seen=SimpleNamespace(peak_speed=speed, crossed=over))
        for speed, over in zip(speeds, crossed, strict=True)
    ]
    assert module._middle(cast(Any, subjects)) == chosen


def test_a_law_is_asked_for_the_highest_pressure_and_the_thinnest_film_of_all_slips():
    asked = {}
    setting = SimpleNamespace(
        friction=SimpleNamespace(breaches=lambda **given: asked.update(given) or [])
    )
    runs = [
        SimpleNamespace(motion=SimpleNamespace(speed=np.array(v)), extremes=np.array(e))
        for v, e in (([0.0, 0.2, 0.4], (2e5, 3e-6)), ([0.005, 0.8], (3e5, 2e-6)))
    ]
    assert module._breaches(cast(Any, setting), cast(Any, runs)) == ()
    assert (asked["contact_pressure"], asked["film_thickness"]) == (3e5, 2e-6)
    assert asked["speed"].tolist() == [0.2, 0.8]


def test_the_shape_of_readings_is_that_which_runs_were_made_with():
    """Instants without load on the film or on the foot hold anything."""
    random = np.random.default_rng(4)
    parts = random.uniform(50.0, 90.0, (4, MAP_X.size, MAP_Y.size))
    parts *= np.array([1.0, 0.1, 0.2, 0.3])[:, None, None]
    true = PressureShape(parts, math.radians(10))

    def run(angle):
        normal = random.uniform(100.0, 900.0, 12)
        fluid = normal * random.uniform(0.2, 0.9, 12)
        normal[0], fluid[0], fluid[1] = 10.0, 9.0, 0.0
        motion = SimpleNamespace(normal=normal, fluid_load=fluid, shoe_angle=np.full(12, angle))
        maps = true.maps(cast(Any, motion))
        maps[:2] = 1e9
        return SimpleNamespace(motion=motion, maps=maps)

    runs = [run(math.radians(angle)) for angle in (8, 10, 12)]
    fitted = pressure_shape(cast(Any, runs), math.radians(10))
    assert fitted.parts == pytest.approx(parts, rel=1e-4, abs=1e-3)
