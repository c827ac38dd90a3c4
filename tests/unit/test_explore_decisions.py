"""Batches, rates and measures of studies on small worlds whose right number is plain."""

from collections import Counter
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.explore import engines
from underfoot.explore.computing import SURFACE, heel_surface, measures, sole_shape
from underfoot.explore.engines import _threads
from underfoot.explore.proposals import FEWEST, FIRST, first_points
from underfoot.explore.record import Ending
from underfoot.explore.status import StudyStatus
from underfoot.explore.study import Study


def size_of_first_batch(kind, designs, dimensions=2, **method):
    plan = SimpleNamespace(
        method=SimpleNamespace(kind=kind, design="sobol", on="surrogate", **method),
        designs=designs,
        dimensions=range(dimensions),
        sampled_points=lambda count: [(0.5,) * dimensions] * count,
    )
    return len(first_points(cast(Any, plan)))


@pytest.mark.parametrize("kind", ["optimise", "robust"])
def test_an_optimisation_begins_with_its_share_but_with_enough_for_a_surrogate(kind):
    assert size_of_first_batch(kind, 1000) == round(1000 * FIRST)
    fewest = 3 * FEWEST
    assert size_of_first_batch(kind, fewest + 1, 3) == max(fewest, round(FIRST * (fewest + 1)))
    assert size_of_first_batch(kind, 2) == 2  # never more than were asked for


@pytest.mark.parametrize(("active", "first"), [(0.0, 80), (0.25, 60), (1.0, 0)])
def test_a_sweep_begins_with_what_is_not_placed_by_its_results(active, first):
    assert size_of_first_batch("sweep", 80, active=active) == first


def status(sessions, ended, now):
    made = object.__new__(StudyStatus)
    given = {
        "sessions": sessions,
        "now": now,
        "scan": SimpleNamespace(case={"ended": np.array(ended, float)}),
    }
    for name, value in given.items():
        object.__setattr__(made, name, value)
    return made


def session(began, ended=None, workers=1):
    return {"began": began, "ended": ended, "workers": workers}


@pytest.mark.parametrize(
    ("sessions", "ended", "now", "rate"),
    [
        # 4 cases in 120 s of one process that is alive
        ([session(0.0)], [30, 60, 90, 120], 120.0, 2.0),
        # what ended before it began is no work of its
        ([session(0.0, 50.0), session(60.0)], [10, 20, 70, 80, 120], 120.0, 3.0),
        # none is alive: from the first beginning to the last end, not to now
        ([session(0.0, 60.0), session(30.0, 180.0)], [20, 50, 90, 160, 170, 180], 9000.0, 2.0),
        # two are alive: since the first began
        ([session(0.0), session(90.0)], [30, 100, 110], 180.0, 1.0),
        ([], [], 10.0, 0.0),
    ],
)
def test_cases_a_minute_are_those_of_the_time_in_which_they_ended(sessions, ended, now, rate):
    assert status(sessions, ended, now).per_minute == pytest.approx(rate)


def test_a_clock_that_went_back_leaves_no_rate():
    assert status([session(1e6)], [30.0], 10.0).per_minute == 0.0


@pytest.mark.parametrize(
    ("again", "last", "left"),
    [
        (0, (0.5,), 30 - 4),  # 10 designs of 3 cases, 4 of 6 proposed ones ended
        (2, (0.5,), 39 - 4),  # and the best two with the start once more
        (20, (0.5,), 63 - 4),  # no more than there are
        (2, (), 30 - 4),  # the start was the last of them: all is proposed
    ],
)
def test_cases_left_are_those_of_all_designs_and_of_the_best_again(again, last, left):
    made = status([], [], 0.0)
    method = SimpleNamespace(again_on="runs" if again else "", again=again)
    given = {
        "plan": SimpleNamespace(designs=10, cases_per_design=3, goals=("cof",), method=method),
        "jobs": [SimpleNamespace(point=last)],
        "endings": Counter({Ending.COMPUTED: 4, Ending.OPEN: 2}),
    }
    for name, value in given.items():
        object.__setattr__(made, name, value)
    assert made.cases_left == left


def result_at(approach):
    history = SimpleNamespace(values=np.array([0.5, approach]))
    return cast(Any, SimpleNamespace(data={"approach_history": history}))


def plan_area(case):
    surface = heel_surface(sole_shape(case), spacing=SURFACE)
    return np.isfinite(surface.height).sum() * surface.spacing**2


def test_a_flat_outsole_weighs_its_area_times_its_thickness_times_its_density():
    case = Case.load("examples/work_shoe_untreaded_glycerol.toml")
    case = case.replace({"shoe.material.density": "1100 kg/m^3"})
    told = {name: each.value for name, each in measures(case, result_at(2e-4)).items()}
    volume = told["rubber_volume"]
    assert told["land"] == pytest.approx(1.0)
    assert told["mass"] == pytest.approx(1100 * volume)
    assert told["stiffness"] == pytest.approx(case.motion.normal_force / 2e-4)
    thickness = case.shoe.sole.outsole_thickness
    assert 0.5 < volume / (plan_area(case) * thickness) < 1  # its bevel takes some
    more = case.replace({"shoe.sole.outsole_thickness": thickness + 1e-3})
    added = measures(more, result_at(2e-4))["rubber_volume"].value - volume
    # a millimetre more of rubber under all of the plan form
    assert added == pytest.approx(plan_area(case) * 1e-3, rel=1e-6)
    worn = case.replace({"shoe.sole.outsole_thickness": thickness / 2})
    assert measures(worn, result_at(2e-4))["rubber_volume"].value < volume
    assert measures(case, result_at(0.0))["stiffness"].value is None


def test_who_waits_for_a_cluster_is_told_only_after_the_time_that_it_has(monkeypatch):
    clock, lines = [0.0], []
    monkeypatch.setattr(
        engines,
        "time",
        SimpleNamespace(
            monotonic=lambda: clock[0],
            sleep=lambda seconds: clock.__setitem__(0, clock[0] + seconds),
        ),
    )

    def workers_after(seconds):
        return cast(
            Any, SimpleNamespace(nthreads=lambda: {"a": 2, "b": 3} if clock[0] > seconds else {})
        )

    assert _threads(workers_after(0.9 * engines.PATIENCE), "tcp://x", lines.append) == 5
    assert not lines
    clock[0] = 0.0
    assert _threads(workers_after(engines.PATIENCE + 0.5), "tcp://x", lines.append) == 5
    assert lines
    assert set(lines) == {"No worker: start dask worker tcp://x"}


@pytest.mark.parametrize(
    ("leads", "over", "begun"),
    [(True, True, 1), (True, False, 0), (False, True, 0), (False, False, 0)],
)
def test_only_who_leads_gives_out_more_and_only_when_a_round_is_over(leads, over, begun):
    asked, given = [], []

    def end_round():
        asked.append(True)
        return over

    one = object.__new__(Study)
    one.store = cast(Any, SimpleNamespace(end_round=end_round, stopped=True))
    one._begin_next = lambda: bool(given.append(True)) or True
    assert list(one._claim_jobs(leads, lambda text: None)) == []
    assert len(asked) == leads
    assert len(given) == begun
