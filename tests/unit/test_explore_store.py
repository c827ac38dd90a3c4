"""The folder of a study: nothing finished is lost, nothing is done twice."""

import errno
import json
import os
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.core import DataError, InputError
from underfoot.core.progress import silent
from underfoot_design_studies import store as store_module
from underfoot_design_studies.record import Ending, Job, Record
from underfoot_design_studies.result import StudyResult
from underfoot_design_studies.status import StudyStatus
from underfoot_design_studies.store import Store
from underfoot_design_studies.study import Study
from underfoot_design_studies.study_file import read_plan

EXAMPLES = Path(__file__).parents[2] / "examples"
TEXT = """\
base = "work_shoe_untreaded_glycerol.toml"
[vary]
"motion.speed" = { from = "0.3 m/s", to = "0.7 m/s", steps = 3 }
"""
numbers = st.floats(allow_nan=False, allow_infinity=False)


@pytest.fixture
def store(tmp_path):
    made = Store.made(tmp_path / "study")
    made.adopt(read_plan(TEXT, EXAMPLES))
    return made


def record(key, value=0.5):
    return Record(key, Ending.COMPUTED, numbers={"cof": value}, draws=np.array([0.25, 0.5]))


@settings(max_examples=20, deadline=None)
@given(st.dictionaries(st.text(max_size=8), st.none() | numbers, max_size=4), st.text(max_size=20))
def test_a_record_is_the_same_after_its_line(values, reason):
    one = Record("k", Ending.FAILED, reason, values, {"cof": 0.1}, breaches=("a", "b"), seconds=0.1)
    line = one.line()
    assert "\n" not in line
    other = Record.from_line(line)
    assert other.line() == line
    assert other.numbers == dict(values)


def test_a_torn_line_is_not_read_and_not_glued_to_the_next(store):
    store.add_record(record("a"))
    path = next(store.folder.glob("cases-*.jsonl"))
    with path.open("a") as stream:
        stream.write('{"format": 1, "key": "b", "end')
    assert set(Store(store.folder).records()) == {"a"}
    store.add_record(record("c"))
    assert set(Store(store.folder).records()) == {"a", "c"}


def test_lines_of_a_newer_version_are_refused(store):
    store.add_record(record("a"))
    path = next(store.folder.glob("cases-*.jsonl"))
    path.write_text(path.read_text().replace('"format": 1', '"format": 2'))
    with pytest.raises(DataError, match=r"newer version.*Update underfoot"):
        Store(store.folder).records()


def test_a_full_disk_costs_no_finished_case(store, monkeypatch):
    """The first write fails as on a full disk until the reserve is gone."""
    real = os.write

    def write(descriptor, data):
        if any(store.folder.glob(".reserve-*")) and data.startswith(b'{"format"'):
            real(descriptor, data[: len(data) // 2])
            raise OSError(errno.ENOSPC, "no space left on device")
        return real(descriptor, data)

    with store.working(1):
        monkeypatch.setattr(store_module.os, "write", write)
        with pytest.raises(DataError, match=r"full.*every finished case is on it.*goes on"):
            store.add_record(record("a"))
        monkeypatch.setattr(store_module.os, "write", real)
    assert set(Store(store.folder).records()) == {"a"}


def test_one_of_two_claims_a_case_and_a_dead_one_loses_it(store):
    assert store.claim("a")
    other = Store(store.folder)
    assert not other.claim("a")
    dead = subprocess.run(
        [sys.executable, "-c", "import os; print(os.getpid())"], capture_output=True, check=True
    )
    machine = store.name.rsplit("-", 2)[0]
    (store.folder / "claims" / "a").write_text(f"{machine}-{int(dead.stdout)}-abcdef")
    assert other.claim("a")
    assert not store.claim("a")


def test_a_silent_process_of_another_machine_loses_its_claim(store):
    owner = "elsewhere-12-abcdef"
    (store.folder / "claims" / "a").write_text(owner)
    alive = store.folder / "alive" / owner
    alive.write_text("{}")
    with store.working(1):
        assert not store.claim("a")
        old = time.time() - store_module.SILENT - 5
        os.utime(alive, (old, old))
        assert store.claim("a")


@pytest.mark.parametrize("call", ["write", "fsync"])
def test_stopped_between_two_lines_of_code_it_leaves_no_claim(store, monkeypatch, call):
    """Ctrl-C before the claim has its owner, and after a record is on disk but still claimed."""
    study = Study.load(store.folder)
    real = getattr(os, call)

    def stopped(descriptor, *data):
        if any((store.folder / "claims").iterdir()):
            raise KeyboardInterrupt
        return real(descriptor, *data)

    def compute(function, jobs, died):
        return (record(job.key) for job in jobs if job)

    monkeypatch.setattr(store_module.os, call, stopped)
    with pytest.raises(KeyboardInterrupt, match="every finished case is kept"):
        study._compute(compute, 1, silent, leads=True)
    assert list((store.folder / "claims").iterdir()) == []
    assert len(Store(store.folder).records()) == (call == "fsync")


def test_two_masters_on_one_folder_are_told_of_each_other(store):
    study = Study.load(store.folder)
    with store.leading() as leads:
        assert leads
        with pytest.raises(InputError, match=r"is being run by .*study work"):
            study.run()
    with store.leading() as leads:
        assert leads


def test_a_folder_that_another_process_is_about_to_fill_is_joined(tmp_path):
    begun = Store.made(tmp_path / "study")
    assert not begun.exists
    assert Store.made(tmp_path / "study").claim("a")


def test_a_folder_of_something_else_is_left_alone(tmp_path):
    (tmp_path / "thesis.txt").write_text("x")
    with pytest.raises(InputError, match="holds no study"):
        Store.made(tmp_path)
    with pytest.raises(InputError, match="holds no study"):
        Study.load(tmp_path)


def test_another_study_in_the_folder_keeps_what_both_have(store):
    plan = store.plan()
    jobs = [job for k, p in enumerate(plan.grid_points()) for job in plan.jobs(k, p, 0)]
    store.add_jobs(jobs)
    store.add_record(record(jobs[0].key))
    wider = read_plan(TEXT.replace("steps = 3", "steps = 5"), EXAMPLES)
    store.adopt(wider)
    assert store.jobs() == []
    again = [job for k, p in enumerate(wider.grid_points()) for job in wider.jobs(k, p, 0)]
    assert again[0].key in store.records()
    assert store.plan().grid_points() == wider.grid_points()


def test_views_hold_every_case(store):
    duckdb = pytest.importorskip("duckdb")
    plan = store.plan()
    jobs = [job for k, p in enumerate(plan.grid_points()) for job in plan.jobs(k, p, 0)]
    store.add_record(record(jobs[0].key, 0.125))
    store.add_record(Record(jobs[1].key, Ending.INFEASIBLE, 'too "narrow", by far'))
    assert store.write_views(StudyResult(plan, jobs, store.records()).cases()) == []
    place = store.folder / "results.parquet"
    rows = duckdb.sql(f"SELECT ending, cof, reason FROM read_parquet('{place}')").fetchall()
    assert rows[0][:2] == ("computed", 0.125)
    assert rows[1][::2] == ("infeasible", 'too "narrow", by far')
    assert rows[2][0] == "open"


def test_a_job_is_the_same_after_its_line():
    job = Job("k", 3, 1, 0, 2, (0.5, 0.25), {"shoe.tread.depth": 0.002, "contaminant": "water"})
    assert Job.from_line(job.line()) == job
    assert json.loads(job.line())["changes"]["contaminant"] == "water"


def test_time_left_is_told_once_every_worker_has_ended_a_case():
    jobs = [Job(str(n), n, 0, 0, 0, (), {}) for n in range(10)]
    session = {"began": 1000.0, "ended": None, "workers": 2}

    def left(count):
        records = {str(n): replace(record(str(n)), ended=1000.0 + 5 * n) for n in range(count)}
        return StudyStatus(read_plan(TEXT, EXAMPLES), jobs, records, [session], 1060.0).seconds_left

    assert [left(0), left(1)] == [None, None]
    assert left(2) == pytest.approx(8 * 30.0)
