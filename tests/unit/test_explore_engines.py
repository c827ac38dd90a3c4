"""Engines that wait say for whom, and what helps."""

import os
import signal
import time
from pathlib import Path

import pytest

from underfoot.explore import engines, study
from underfoot.explore import store as store_module
from underfoot.explore.record import CaseJob, Ending, Record
from underfoot.explore.store import Store
from underfoot.explore.study import Study
from underfoot.explore.study_file import read_plan

EXAMPLES = Path(__file__).parents[2] / "examples"
TEXT = """\
base = "work_shoe_untreaded_glycerol.toml"
[vary]
"motion.speed" = { from = "0.3 m/s", to = "0.7 m/s", steps = 3 }
"""


def answer(job):
    return Record(job.key, Ending.COMPUTED, numbers={"cof": 0.2})


def test_a_dask_cluster_without_workers_says_what_starts_one(monkeypatch):
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr(engines, "PATIENCE", 0.3)
    jobs = [CaseJob(f"{k}", k, 0, 0, 0, (0.5,), {}) for k in range(5)]
    local = {"processes": False, "protocol": "tcp", "dashboard_address": None}
    with distributed.LocalCluster(n_workers=0, **local) as cluster:
        said, address = [], cluster.scheduler_address

        def told(text):
            said.append(text)
            cluster.scale(1)

        compute, _ = engines.engine(f"dask:{address}", None, told)
        done = list(compute(answer, iter(jobs), None))
    assert said[0] == f"No worker: start dask worker {address}"
    assert {one.key for one in done} == {job.key for job in jobs}


@pytest.mark.slow
def test_answers_that_came_count_though_their_worker_was_lost_since():
    """The first reader is slow; meanwhile all answers come, and then every worker dies."""
    distributed = pytest.importorskip("distributed")
    jobs = [CaseJob(f"{k}", k, 0, 0, 0, (0.5,), {}) for k in range(4)]
    local = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with distributed.LocalCluster(**local) as cluster, distributed.Client(cluster) as client:
        address = cluster.scheduler_address
        compute, _ = engines.engine(f"dask:{address}", None, pytest.fail)
        records = compute(answer, iter(jobs), pytest.fail)
        done = [next(records)]
        time.sleep(1)
        for process in client.run(os.getpid).values():
            os.kill(process, signal.SIGKILL)
        time.sleep(1)
        done += records
    assert {one.key for one in done} == {job.key for job in jobs}


def test_who_waits_for_a_silent_process_says_for_whom_and_takes_over(tmp_path, monkeypatch):
    monkeypatch.setattr(study, "PAUSE", 0.01)
    monkeypatch.setattr(study, "PATIENCE", 0.05)
    monkeypatch.setattr(study, "compute_job", lambda base, job: answer(job))
    plan = read_plan(TEXT, EXAMPLES)
    Store.open_folder(tmp_path).adopt(plan)
    Study(plan, tmp_path)._begin_next()
    elsewhere, said = Store(tmp_path), []
    elsewhere.name = "elsewhere-12-abcdef"

    def progress(stage, share, residual=None):
        if stage.startswith("Waiting"):
            said.append(stage)
            old = time.time() - store_module.SILENT - 5
            os.utime(tmp_path / "alive" / elsewhere.name, (old, old))

    with elsewhere.working(1):
        while elsewhere.take(in_order=True):
            pass
        assert Study(plan, tmp_path).work(progress=progress) == 3
    assert said[0] == "Waiting for elsewhere-12-abcdef: taken over after 2 min of silence"
