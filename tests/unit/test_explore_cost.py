"""What a study takes, by ten of its cases: made-up cases whose cost differs widely.

Real treads of one study differ by factors of 2 to 4. A rare case that takes ten times as long as
all others is seen by no ten cases.
"""

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from underfoot.explore import check, study
from underfoot.explore import plan as plan_module
from underfoot.explore.cost import mean_cost, spread_jobs, study_cost
from underfoot.explore.record import Ending, Record
from underfoot.explore.store import Store
from underfoot.explore.study import Study
from underfoot.explore.study_file import read_plan

EXAMPLES = Path(__file__).parents[2] / "examples"
TEXT = """\
base = "work_shoe_full_tread_glycerol.toml"
[vary]
"shoe.tread.depth" = { from = "1 mm", to = "4 mm"%s }
"shoe.tread.channel_width" = { from = "2.5 mm", to = "5 mm"%s }
"contaminant.viscosity" = { from = "50 cP", to = "300 cP"%s }
[conditions]
"motion.speed" = ["0.3 m/s", "0.5 m/s", "0.7 m/s"]
[method]
budget = 300
seed = %d
"""


def fine(job):
    """Finer cells for narrow channels: a factor of 8; of 3 between conditions."""
    return (1.0 / (1.0 + job.point[1])) ** 3 * (1 + job.condition)


def scattered(job):
    """The same with a scatter of a fifth that nothing explains."""
    return fine(job) * np.exp(0.2 * np.random.default_rng(int(job.key, 16)).normal())


@pytest.fixture
def made_up(monkeypatch):
    """Keys that need no case, and a function that sets what cases cost."""
    keys = {}
    monkeypatch.setattr(
        plan_module.StudyPlan,
        "_key",
        lambda self, changes, quick: keys.setdefault(repr((changes, quick)), f"{len(keys):024x}"),
    )

    def set_cost(cost):
        def computed(base, job):
            numbers = {"cof": job.point[0], "fluid_load": 20.0 / (1.0 + job.point[1])}
            took = {"cpu_seconds": cost(job), "seconds": 1.5 * cost(job), "memory": 2e8}
            done = {"worker": "a", "ended": time.time(), "draws": np.full(500, 0.2)}
            return Record(job.key, Ending.COMPUTED, numbers=numbers, **took, **done)

        monkeypatch.setattr(study, "compute_job", computed)

    return set_cost


def plan(seed=0, steps=""):
    text = TEXT % (*3 * [steps], seed)
    return read_plan(text.replace("budget = 300\n", "") if steps else text, EXAMPLES)


def whole(made, cost):
    """Return the CPU time of every case of a study."""
    points = made.grid_points() if made.method.design == "grid" else made.sampled_points(100)
    return sum(cost(job) for k, point in enumerate(points) for job in made.jobs(k, point, 0))


@pytest.mark.parametrize(
    ("cost", "share", "steps"), [(fine, 1.0, ", steps = 5"), (scattered, 0.9, "")]
)
def test_ten_cases_tell_the_cost_of_a_study_within_a_fifth(made_up, tmp_path, cost, share, steps):
    made_up(cost)
    errors, inside = [], []
    for seed in range(20):
        made = plan(seed, steps)
        one = Study(made, tmp_path / str(seed))
        one.compute_some(10)
        answer, true = check.study_check(made, 1, one.store), whole(made, cost)
        assert answer.cost.cases == 9  # the first one loads the program
        errors.append(answer.cpu_seconds / true - 1.0)
        inside.append(answer.seconds[0] <= true <= answer.seconds[1])
    assert np.mean(np.abs(errors) < 0.2) >= share, errors
    assert np.mean(inside) >= 0.9


def test_the_start_that_is_run_again_has_no_place_among_the_inputs(made_up, tmp_path):
    made_up(fine)
    made = plan()
    one = Study(made, tmp_path)
    one.compute_some(10)

    class Given(list):
        @property
        def keys(self):
            return [job.key for job in self]

    jobs = Given(spread_jobs(made, 10))
    start = replace(jobs[3], point=(), design=99)
    assert study_cost(made, one.store, Given([*jobs, start])) == study_cost(made, one.store, jobs)


def test_what_was_timed_is_part_of_the_study_and_not_computed_again(made_up, tmp_path):
    made_up(fine)
    one = Study(plan(), tmp_path)
    one.compute_some(10)
    timed = set(one.store.records())
    assert len(timed) == 10
    result = one.run(workers=1)
    assert result.endings == {"computed": 300}
    assert timed < {job.key for job in result.jobs}
    lines = sum(len(path.read_bytes().splitlines()) for path in tmp_path.glob("cases-*"))
    assert lines == 300


def test_cases_in_the_order_of_a_grid_tell_the_cost_of_the_rest(made_up, tmp_path):
    """A third of a grid whose cost grows along its first axis."""
    made_up(lambda job: np.exp(1.5 * job.point[0]) * (1 + job.condition))
    made = plan(steps=", steps = 6")
    store = Store.open_folder(tmp_path)
    store.adopt(made)
    points = made.grid_points()
    jobs = [job for k, point in enumerate(points) for job in made.jobs(k, point, 0)]
    store.add_batch(store.jobs(), jobs)
    with store.working(1):
        for job in jobs[: len(jobs) // 3]:
            store.add_record(study.compute_job(made.base, job))
    true = whole(made, lambda job: np.exp(1.5 * job.point[0]) * (1 + job.condition))
    answer = check.study_check(made, 1, store)
    assert answer.cpu_seconds == pytest.approx(true, rel=0.05)
    assert answer.ended == len(jobs) // 3


def test_the_disk_is_that_of_the_folder(made_up, tmp_path):
    made_up(fine)
    made = plan()
    one = Study(made, tmp_path)
    one.compute_some(10)
    cost = check.study_check(made, 1, one.store).cost
    one.store.write_views(one.run(workers=1).cases())
    names = ("cases-*", "draws-*", "jobs.jsonl", "results.csv")
    size = sum(path.stat().st_size for name in names for path in tmp_path.glob(name))
    assert 300 * cost.disk == pytest.approx(size, rel=0.1)


def test_where_to_run_it_follows_from_time_memory_and_disk(made_up, tmp_path):
    made_up(lambda job: 3600.0)
    made = plan()
    one = Study(made, tmp_path)
    one.compute_some(10)
    machine = check.Computer(processors=8, memory=1e9, disk=1e5)
    answer = replace(check.study_check(made, 1, one.store), machine=machine)
    assert answer.workers == 5  # of 0.2 GB
    assert answer.seconds_left == pytest.approx(290 * 5400 / 5)
    assert answer.tasks == 30
    said = " ".join(answer.headline())
    assert "290 open cases on this machine, 5 workers of 200 MB: about 87.0 h" in said
    assert "array job of 30 tasks takes about 14.5 h: underfoot study work in each" in said
    assert "Dask" in said
    assert any("disk has 100 kB free, the study takes" in text for text in answer.cautions())
    roomy = replace(answer, machine=replace(machine, processors=200, memory=0.0))
    assert roomy.tasks == 1
    assert "array job" not in " ".join(roomy.headline())


def test_without_a_finished_case_the_cost_is_called_a_guess(made_up, tmp_path):
    answer = check.study_check(plan(), 1, Store(tmp_path))
    assert answer.cost is None
    assert any("guess" in text for text in answer.cautions())


def test_why_timed_cases_have_no_numbers_is_told(made_up, tmp_path, monkeypatch):
    made_up(fine)
    real = study.compute_job

    def computed(base, job):
        done = real(base, job)
        bad = job.condition == 2
        return replace(done, ending=Ending.NOT_CONVERGED, reason="no steady state") if bad else done

    monkeypatch.setattr(study, "compute_job", computed)
    made = plan()
    one = Study(made, tmp_path)
    one.compute_some(10)
    lost = check.study_check(made, 1, one.store).remarks()["Without numbers among the finished"]
    assert len(lost) == 1
    assert lost[0].endswith("x no steady state")


def test_a_cost_that_is_the_same_everywhere_is_its_mean():
    rows = np.random.default_rng(0).random((10, 3))
    mean, error = mean_cost(rows, np.full(10, 2.5), np.random.default_rng(1).random((99, 3)))
    assert mean == pytest.approx(2.5)
    assert error == pytest.approx(0.0, abs=1e-12)
