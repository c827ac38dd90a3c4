"""A study of slips whose full model is a sole of known constants and a known map of pressure."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from slip_floors import slippery_sole
from underfoot.core import InputError, Status
from underfoot.core.cache import Cache
from underfoot.slip.dynamics import FloorSensors, Population, Spread, full_model
from underfoot.slip.dynamics import study as module
from underfoot.slip.dynamics.full_model import FullRun, pressed_area
from underfoot.slip.dynamics.reduced_model import at_bounds
from underfoot.slip.dynamics.sensors import MAP_X, MAP_Y, PressureShape, pressure_shape

ANGLE = 0.15


def known_shape():
    """Return a hill of pressure that grows with load, film share and angle in its own places."""
    bell = np.exp(-(((MAP_X[:, None] - 0.03) / 0.02) ** 2) - (MAP_Y / 0.015) ** 2)
    parts = [800 * bell, 60 * bell**2, 200 * bell[::-1], 900 * bell[:, ::-1]]
    return PressureShape(np.array(parts), ANGLE)


def full_run(walker, status=Status.CONVERGED):
    motion = replace(slippery_sole().motion(walker), status=status)
    none = np.zeros(motion.time.size)
    maps: Any = known_shape().maps(motion)
    return FullRun(motion, maps, none + 1e-3, none, maps[:, :, 0], MAP_X, np.array([2e5, 3e-6]))


@pytest.fixture(scope="module")
def made():
    """Return a study, and what its fit was asked to follow; each fourth full slip had no answer."""
    asked = {}

    def runs(_, walkers, **__):
        states = [Status.NOT_CONVERGED if i % 4 == 2 else Status.CONVERGED for i in range(100)]
        return [full_run(each, state) for each, state in zip(walkers, states, strict=False)]

    def fit(_, runs, held_out, rows, **__):
        asked.update(runs=runs, held_out=held_out, rows=rows)
        return SimpleNamespace(sole=slippery_sole())

    law = SimpleNamespace(breaches=lambda **_: ["rough", "rough"])
    setting = cast(Any, SimpleNamespace(viscosity=0.2, shoe_angle=ANGLE, friction=law))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "full_runs", runs)
        patch.setattr(module, "fitted_reduced", fit)
        patch.setattr(module.SlipStudy, "at_friction_draws", lambda _: None)
        people = Population(subjects=5, seed=2)
        yield module.slip_study(setting, people, fit_runs=6, held_out=2), people, asked


def test_a_shape_of_pressure_is_found_again_from_slips_that_have_it():
    runs = [full_run(each) for each in Population(subjects=5, seed=5).walkers()]
    assert pressure_shape(runs, ANGLE).parts == pytest.approx(known_shape().parts, abs=0.05)


def test_a_fit_and_its_test_share_no_slip_and_leave_out_what_had_no_answer(made):
    study, _, asked = made
    kept, apart = asked["runs"], asked["held_out"]
    assert (len(kept), len(apart), study.failed) == (4, 2, 2)
    assert not {id(one) for one in kept} & {id(one) for one in apart}
    assert all(one.status is Status.CONVERGED for one in (*kept, *apart))
    assert len(asked["rows"]) == sum(int((one.normal > 0).sum()) for one in kept)
    assert study.breaches == ("rough",)


def test_everybody_slips_by_the_fitted_sole_over_the_fitted_pressure(made):
    study, people, _ = made
    array = FloorSensors()
    for walker, each in zip(people.walkers(), study.subjects, strict=True):
        exact = slippery_sole().motion(walker)
        assert each.walker == walker
        assert each.motion.distance[-1] == pytest.approx(exact.distance[-1])
        maps = known_shape().maps(each.motion)
        expected = module.array_pressures(each.motion, maps, array)
        assert each.pressures == pytest.approx(expected, abs=2e-4 * expected.max() + 1.0)
    # the sole that was fitted is the one that made the runs
    assert study.pressure_error < 1e-3
    middle = study.subjects[module._middle(study.subjects)].walker
    assert study.representative.motion.walker == middle
    assert not study.full


def test_people_hold_their_shoe_angle_unless_the_recorded_fall_is_asked_for():
    times = np.linspace(0.0, 0.4, 9)
    asked = Population(subjects=30), Population(subjects=30, recorded_angle=True)
    for population, falls in zip(asked, (False, True), strict=True):
        people = population.walkers()
        angles = [each.demands(times)[2] for each in people if each.history.foot_angle is not None]
        assert angles
        assert [bool(np.ptp(angle) > 0.01) for angle in angles] == [falls] * len(angles)
        assert [angle[0] for angle in angles] == [
            each.shoe_angle for each in people if each.history.foot_angle is not None
        ]


@pytest.mark.parametrize(
    "numbers", [(np.nan, 0.1), (np.inf, 0.1), (0.2, np.nan), (0.2, np.inf), (0.2, -0.1)]
)
def test_a_spread_without_a_finite_mean_and_width_is_refused(numbers):
    with pytest.raises(InputError):
        Spread(*numbers)


def test_the_highest_reading_is_told_beside_the_highest_pressure_of_the_film():
    none = SimpleNamespace(maps=np.zeros(3), peaks=np.zeros(3))
    runs = [
        SimpleNamespace(maps=np.array([0.0, reading]), peaks=np.array([0.0, 2e5]))
        for reading in (1e5, 0.5e5, 1.5e5)
    ]
    for full, representative, share in (
        ([none, *runs], None, 0.5), ([], runs[1], 0.25), ([none], None, None),
    ):  # fmt: skip
        study = SimpleNamespace(full_runs=full, representative=representative)
        assert module.SlipStudy.highest_seen(cast(Any, study)) == share


def test_an_even_pressure_presses_on_its_area_and_half_of_a_load_on_less():
    even = np.zeros((6, 5))
    even[1:4, 2:4] = 3e5
    assert pressed_area(even, even, 2e-3) == pytest.approx(6 * 4e-6)
    assert pressed_area(0.5 * even, even, 2e-3) == pytest.approx(3 * 4e-6)  # cells half covered
    assert pressed_area(0 * even, even, 2e-3) == 0.0


def test_a_constant_that_a_fit_drives_to_its_bound_is_stuck():
    lows, highs = np.array([0.0, 0.0, 0.0, -1.0]), np.array([10.0, 10.0, 10.0, 1.0])
    stuck = at_bounds(np.array([0.001, 5.0, 9.995, 0.0]), lows, highs)
    assert stuck.tolist() == [True, False, True, False]


def test_a_slip_that_was_done_is_read_back_where_its_setting_has_a_key(tmp_path, monkeypatch):
    """By the key of the setting: without one nobody knows what it was of."""
    made = []

    def compute(setting, walker, *_):
        made.append(walker)
        return full_run(walker)

    monkeypatch.setattr(full_model, "_compute_run", compute)
    walker, cache = Population(subjects=1, seed=3).walker(0), Cache("slips", tmp_path)
    for key, times in (("of a case", 1), ("", 3)):
        setting = cast(Any, SimpleNamespace(key=key))
        runs = [full_model.full_run(setting, walker, cache=cache) for _ in range(3)]
        assert len(made) == times
        assert [one.motion.peak_speed for one in runs] == [runs[0].motion.peak_speed] * 3
        made.clear()


def test_slips_are_counted_from_one_as_they_go_on(monkeypatch):
    told = []

    def run(setting, walker, *, progress, **_):
        progress("under way", 0.5)
        return walker

    monkeypatch.setattr(full_model, "full_run", run)

    def heard(stage, fraction, residual=None):
        told.append((str(stage), fraction))

    full_model.full_runs(cast(Any, None), cast(Any, ["a", "b"]), progress=heard)
    assert told == [("Slip 1 of 2", 0.25), ("Slip 2 of 2", 0.75)]
