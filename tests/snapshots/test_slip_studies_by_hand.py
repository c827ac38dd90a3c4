"""Studies of slips whose runs are made by hand: who is fitted, tested and shown, areas, markers."""

import math
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.core import ConvergenceError, Status
from underfoot.core.progress import silent
from underfoot.slip.dynamics import Population, study
from underfoot.slip.dynamics.full_model import pressed_area
from underfoot.slip.dynamics.gait import history_from_lines
from underfoot.slip.dynamics.motion import _new_speed
from underfoot.slip.dynamics.observation import _pulses
from underfoot.slip.dynamics.recorded import (
    _toe_of,
    _walking_speed,
    heel_over_floor,
)
from underfoot.slip.dynamics.reduced_model import FittedRange, ReducedSole


def runs_of(states: str) -> list[Any]:
    """Return runs of persons, + for one that was solved."""
    return [
        SimpleNamespace(
            motion=SimpleNamespace(
                status=Status.CONVERGED if state == "+" else Status.NOT_CONVERGED, name=k
            ),
            area_rows=lambda k=k: [k, 10 * k],
        )
        for k, state in enumerate(states)
    ]


def studied(monkeypatch, states: str, held_out: int, *, shown: str = "+") -> tuple[Any, Any]:
    """Return a study of runs by hand and what was asked on the way."""
    runs, shown_runs = runs_of(states), runs_of(shown)
    asked: dict[str, Any] = {"progress": []}
    people = Population(subjects=4, seed=3)
    walkers = people.walkers()
    setting: Any = SimpleNamespace(viscosity=0.2, shoe_angle=0.15)

    def full_runs(given: Any, persons: Any, *, progress: Any, **options: Any) -> Any:
        assert given is setting
        progress("full", 1.0)
        asked.setdefault("options", options)
        if len(persons) == 1:
            asked["shown"] = persons[0]
            return shown_runs
        asked["persons"] = len(persons)
        return runs

    def fitted(given: Any, kept: Any, apart: Any, rows: Any, *, progress: Any) -> Any:
        assert given is setting
        progress("fit", 1.0)
        asked.update(kept=[one.name for one in kept], apart=[one.name for one in apart], rows=rows)
        return SimpleNamespace(sole="sole")

    def subjects(sole: Any, shape: Any, given: Any, array: Any, limits: Any) -> Any:
        assert (sole, shape, limits) == ("sole", "shape", "limits")
        assert [one.name for one in given] == [one.name for one in walkers]
        return ["a", "b", "c", "d"]

    monkeypatch.setattr(study, "full_runs", full_runs)
    monkeypatch.setattr(study, "fitted_reduced", fitted)
    monkeypatch.setattr(
        study, "pressure_shape",
        lambda used, angle: "shape" if angle == 0.15 and len(used) == len(asked["kept"]) else "",
    )  # fmt: skip
    monkeypatch.setattr(study, "_reduced_subjects", subjects)
    monkeypatch.setattr(study, "_middle", lambda told: told.index("c"))
    monkeypatch.setattr(
        study, "_pressure_error", lambda shape, sole, tested, array: (shape, sole, len(tested))
    )
    monkeypatch.setattr(study, "_breaches", lambda given, good: (given is setting, len(good)))
    monkeypatch.setattr(study.SlipStudy, "at_friction_draws", lambda one: one.subjects)
    made = study.slip_study(
        setting, people, fit_runs=8, held_out=held_out, limits="limits", cache="cache",
        progress=lambda stage, share, *_: asked["progress"].append((stage, share)),
    )  # fmt: skip
    assert asked["shown"].name == walkers[2].name
    return made, asked


@pytest.mark.parametrize(("states", "held_out", "apart"), [
    ("++++++++++++", 4, [2, 5, 8, 11]), ("++++++++++++", 3, [3, 7, 11]), ("++++++++++++", 0, []),
    ("++++++++++++", 1, [11]), ("++++++++++++", 9, [1, 3, 5, 7, 9, 11]), ("++-++-+-", 2, [1, 4]),
    ("-+-+-+-+", 1, [7]), ("++++", 1, [3]),
])  # fmt: skip
def test_who_is_fitted_and_who_is_tested(monkeypatch, states, held_out, apart):
    """Each so-manieth of those who were solved is kept apart; the others are fitted to."""
    made, asked = studied(monkeypatch, states, held_out)
    good = [k for k, state in enumerate(states) if state == "+"]
    assert asked["apart"] == apart
    assert asked["kept"] == [k for k in good if k not in apart]
    assert asked["rows"] == [row for k in asked["kept"] for row in (k, 10 * k)]
    assert made.failed == len(states) - len(good)
    assert len(made.full_runs) == len(good)
    assert made.pressure_error == ("shape", "sole", len(apart))
    assert made.breaches == (True, len(good))
    assert (made.full, made.sole, made.by_friction) == (False, "sole", ("a", "b", "c", "d"))
    assert made.representative.motion.name == 0
    assert asked["progress"] == [("full", 0.8), ("fit", 0.93), ("full", 1.0)]
    assert asked["options"]["cache"] == "cache"
    assert asked["options"]["inlet_diameter"] == made.array.inlet_diameter


@pytest.mark.parametrize(("states", "enough"), [
    ("++++----", True), ("+++-----", False), ("+++", False), ("++++", True),
    ("+++++-------", False), ("++++++------", True),
])  # fmt: skip
def test_half_of_the_slips_must_be_solved_and_four_at_least(monkeypatch, states, enough):
    if enough:
        assert studied(monkeypatch, states, 1)[0].failed == states.count("-")
        return
    with pytest.raises(ConvergenceError, match=f"only {states.count('+')} of {len(states)} slips"):
        studied(monkeypatch, states, 1)


def test_a_slip_that_was_not_solved_again_is_not_shown(monkeypatch):
    made, _ = studied(monkeypatch, "++++++++", 2, shown="-")
    assert made.representative is None
    assert silent("a", 0.5) is None


def test_the_error_of_a_reading_is_relative_and_of_those_who_pressed_on_a_sensor(monkeypatch):
    """Readings of 3 and 1 over 2 are off by a half; 1 kPa is none, and so is nobody."""

    def pressures(motion: Any, maps: Any, array: Any) -> Any:
        assert (array, maps) == ("array", f"{motion.kind} maps")
        return np.array([[-5.0, motion.peak], [0.0, 0.0]])

    def run(true: float, reading: float) -> Any:
        walker = SimpleNamespace(reading=reading)
        return SimpleNamespace(
            motion=SimpleNamespace(kind="full", peak=true, walker=walker), maps="full maps"
        )

    sole: Any = SimpleNamespace(
        motion=lambda walker: SimpleNamespace(kind="reduced", peak=walker.reading)
    )
    shape: Any = SimpleNamespace(maps=lambda motion: f"{motion.kind} maps")
    monkeypatch.setattr(study, "array_pressures", pressures)

    def error(*runs: Any) -> float | None:
        return study._pressure_error(shape, sole, runs, "array")

    assert error(run(2e4, 3e4), run(2e4, 1e4), run(1e3, 9e9)) == pytest.approx(0.5)
    assert error(run(2e4, 2.6e4), run(1.5e3, 1.5e3)) == pytest.approx(0.3 / math.sqrt(2))
    assert error(run(1e3, 5e3)) is None
    assert error() is None


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e6])
def test_the_area_that_bears_a_load_knows_no_unit_of_pressure(scale):
    load = scale * np.array([[1.0, 3.0], [0.0, 2.0]])
    pressure = scale * np.array([[2.0, 3.0], [5.0, 4.0]])
    # 6^2 over 1 * 2 + 3 * 3 + 2 * 4, in squares of 2 mm
    assert pressed_area(load, pressure, 2e-3) == pytest.approx(36 / 19 * 4e-6)
    assert pressed_area(0 * load, pressure, 2e-3) == 0.0
    assert pressed_area(load, 0 * pressure, 2e-3) == 0.0


def test_a_heel_that_rolls_stands_still_on_the_floor():
    """A foot that turns about its contact at 2 rad/s, and one that slides at 0.3 m/s besides."""
    up, walking = np.array([0.0, 0, 1]), np.array([1.0, 0, 0])
    heel, toe = (np.tile(place, (2, 1)) for place in ([0.1, 0.0, 0.05], [0.3, 0.0, 0.15]))
    turn = np.array([0.0, 2.0, 0.0])  # toe down

    def motion(place: np.ndarray, slides: float) -> Any:
        return SimpleNamespace(
            position=place, velocity=np.cross(turn, place - [0.1, 0, 0.02]) + slides * walking
        )

    for slides in (0.0, 0.3):
        found = heel_over_floor(motion(heel, slides), motion(toe, slides), up, walking, 0.02)
        np.testing.assert_allclose(found, slides, atol=1e-12)
    # a marker below the floor counts as on it
    low = heel_over_floor(motion(heel, 0.3), motion(toe, 0.3), up, walking, 0.2)
    np.testing.assert_allclose(low, 0.3 + 2.0 * 0.03)


@pytest.mark.parametrize(("heel", "markers", "toe"), [
    ("RHEEL", ("RMT2", "RTOE", "LTOE", "RMT1"), "RTOE"), ("LHEE", ("RTOE", "LMT1", "lmt2"), "lmt2"),
    ("rHeel", (" RToe", "RMT2"), " RToe"), ("R", ("RMT1",), "RMT1"), ("L", ("RTOE", "LMT3"), None),
    (" LHEE", ("LTOEX", "LTOE"), "LTOE"),
])  # fmt: skip
def test_the_toe_of_a_heel_is_on_its_side_the_tip_before_the_heads(heel, markers, toe):
    trial: Any = SimpleNamespace(markers=dict.fromkeys(markers))
    assert _toe_of(trial, heel) == toe


@pytest.mark.parametrize(("velocity", "speed"), [
    ((0.9, 1.2, 0.0), 1.5), ((0.31, 0.0, 0.0), 0.31), ((0.29, 0.0, 0.0), None),
    ((2.99, 0.0, 0.0), 2.99), ((3.01, 0.0, 0.0), None), ((math.nan, 0.0, 0.0), None), (None, None),
])  # fmt: skip
def test_a_walking_speed_is_that_of_somebody_who_walks(velocity, speed):
    asked: list[Any] = []

    def body(*given: Any) -> Any:
        asked.append(given)
        return None if velocity is None else np.array(velocity)

    stance: Any = SimpleNamespace(plate="p", contact=1.0, toe_off=1.6)
    walk: Any = SimpleNamespace(body_velocity=body)
    found = _walking_speed(walk, stance)
    assert found is None if speed is None else found == pytest.approx(speed)
    assert asked == [("p", 1.0, 1.6)]


@dataclass
class Rubs:
    """A foot whose friction is a law of its speed; how often it was asked."""

    law: Any
    asked: int = 0

    def friction(self, speed: float) -> float:
        self.asked += 1
        return float(self.law(speed))


LAWS: dict[str, tuple[Any, int]] = {
    "falls at once": (lambda v: 150 * math.exp(-v / 0.02), 3),
    "falls": (lambda v: 150 / (1 + 4 * v), 9),
    "rises": (lambda v: 100 * v**0.2, 9),
    "rises late": (lambda v: 90 + 400 * v**4, 10),
    "steps": (lambda v: 40 + 80 * math.tanh(40 * (v - 0.5)), 14),
}


@pytest.mark.parametrize("name", LAWS)
def test_the_speed_after_a_step_is_the_root_of_its_balance_found_in_few_steps(name):
    """V = speed + share (net + drive - FF(V)): the Illinois form halves the end that stays."""
    from scipy.optimize import brentq

    law, most = LAWS[name]
    foot: Any = Rubs(law)
    speed, share, net, drive = 0.4, 4e-3, 30.0, 90.0
    made, friction = _new_speed(foot, speed, share, net, drive)
    exact = brentq(
        lambda v: v - speed - share * (net + drive - law(v)), 0, 2, xtol=1e-14, rtol=1e-14
    )
    assert made == pytest.approx(exact, abs=1e-10)
    assert friction == pytest.approx(law(exact))
    assert foot.asked == most


def test_a_foot_at_rest_stays_where_friction_bears_what_drives_it():
    assert _new_speed(Rubs(lambda v: 100.0), 0.0, 4e-3, 50.0, 80.0) == (0.0, 80.0)
    assert _new_speed(Rubs(lambda v: 100.0), 0.0, 4e-3, 50.0, -5.0) == (0.0, 0.0)
    # it starts where it does not, and what drives it backward is none
    speed, friction = _new_speed(Rubs(lambda v: 100.0), 0.0, 4e-3, -50.0, 120.0)
    assert (speed, friction) == pytest.approx((4e-3 * 20, 100.0))
    # a slow one is stopped within the step
    assert _new_speed(Rubs(lambda v: 100.0), 0.01, 4e-3, -30.0, 60.0) == (0.0, 60.0)
    assert _new_speed(Rubs(lambda v: 100.0), 0.01, 4e-3, -300.0, 160.0) == (0.0, 100.0)


@pytest.mark.parametrize(("name", "low", "high", "told"), [
    ("normal", 1.0, 599.0, ()), ("normal", -1.0, 599.0, ("load -1 to 599 N",)),
    ("normal", 1.0, 601.0, ("load 1 to 601 N",)), ("speed", 0.76, 2.24, ()),
    ("speed", 0.74, 2.0, ("speed 0.74 to 2 m/s",)), ("speed", 1.0, 2.26, ("speed 1 to 2.26 m/s",)),
    ("angle", -0.009, 0.289, ()), ("angle", -0.03, 0.2, ("shoe angle -1.72 to 11.5 deg",)),
])  # fmt: skip
def test_a_motion_lies_within_the_fit_and_a_quarter_of_its_range(name, low, high, told):
    """Fitted from 100 to 500 N, from 1 to 2 m/s and from 0.04 to 0.24 rad."""
    fitted = FittedRange(0.2, (100.0, 500.0), (1.0, 2.0), (0.04, 0.24))
    sole: Any = SimpleNamespace(fitted=fitted)
    given = {"normal": 300.0, "speed": 1.5, "angle": 0.1}
    arrays = {key: np.full(2, value) for key, value in given.items()} | {
        name: np.array([low, high])
    }
    found = ReducedSole._beyond(sole, arrays["normal"], arrays["speed"], arrays["angle"])
    assert len(found) == len(told)
    for one, text in zip(found, told, strict=True):
        assert one.startswith(f"{text} beyond the fit's ")
    assert ReducedSole._beyond(
        cast(Any, SimpleNamespace(fitted=None)), *(1e9 * one for one in arrays.values())
    ) == ()  # fmt: skip


def test_a_history_whose_column_has_a_hole_is_one_without_it():
    lines = ["time_s,normal_per_body_weight,shear_ratio,foot_angle_deg,heel_velocity_m_per_s"]
    rows = [f"{0.1 * k},{0.5 + 0.1 * k},{0.1 * k},{3 - k},{0.5 - 0.1 * k}" for k in range(5)]
    whole = history_from_lines([*lines, *rows], "a")
    assert whole.foot_angle == pytest.approx(np.radians(3 - np.arange(5.0)))
    assert whole.heel_velocity == pytest.approx(0.5 - 0.1 * np.arange(5))
    rows[2] = "0.2,0.7,0.2,,0.3"
    hole = history_from_lines([*lines, *rows], "a")
    assert hole.foot_angle is None
    assert hole.heel_velocity == pytest.approx(whole.heel_velocity)
    assert hole.normal == pytest.approx(whole.normal)


def test_a_sensor_that_nothing_passes_reads_its_noise():
    """Two rows of two sensors: a pulse of 50 kPa over one of the first row alone."""
    time = np.linspace(0, 0.3, 301)
    pressures = np.zeros((301, 2, 2))
    pressures[:, 0, 1] = 5e4 * np.exp(-(((time - 0.15) / 0.02) ** 2))
    motion: Any = SimpleNamespace(time=time)
    rows, duration, highest = _pulses(motion, pressures, 3)
    assert 240 < rows[1] < 5 * 240
    assert rows[0] == highest == pytest.approx(5e4, rel=0.03)
    assert duration is not None
    assert 0.03 < duration < 0.15
    assert max(_pulses(motion, 0 * pressures, 3)[0]) < 5 * 240
