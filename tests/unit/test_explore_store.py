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
from underfoot.explore import claims, records
from underfoot.explore import store as store_module
from underfoot.explore.lines import seal_line
from underfoot.explore.record import CaseJob, Ending, Record
from underfoot.explore.result import StudyResult
from underfoot.explore.scan import scan_cases
from underfoot.explore.status import StudyStatus
from underfoot.explore.store import Store
from underfoot.explore.study import Study
from underfoot.explore.study_file import read_plan

EXAMPLES = Path(__file__).parents[2] / "examples"
TEXT = """\
base = "work_shoe_untreaded_glycerol.toml"
[vary]
"motion.speed" = { from = "0.3 m/s", to = "0.7 m/s", steps = 3 }
"""
numbers = st.floats(allow_nan=False, allow_infinity=False)


@pytest.fixture
def store(tmp_path):
    made = Store.open_folder(tmp_path / "study")
    made.adopt(read_plan(TEXT, EXAMPLES))
    return made


def record(key, value=0.5):
    return Record(key, Ending.COMPUTED, numbers={"cof": value}, draws=np.array([0.25, 0.5]))


def added(store, *records):
    """Add records as a process that works does."""
    with store.working(1):
        for one in records:
            store.add_record(one)


@settings(max_examples=20, deadline=None)
@given(st.dictionaries(st.text(max_size=8), st.none() | numbers, max_size=4), st.text(max_size=20))
def test_a_record_is_the_same_after_its_line(values, reason):
    draws = np.array([0.25, 0.5])
    one = Record("k", Ending.FAILED, reason, values, {"cof": 0.1}, breaches=("a", "b"), draws=draws)
    line = one.line((8, 2, 7))
    assert "\n" not in line
    other = Record.from_line(line, lambda *place: one.packed_draws * (place == (8, 2, 7)))
    assert other.line((8, 2, 7)) == line
    assert (other.numbers, other.draws.tolist()) == (dict(values), [0.25, 0.5])


def test_a_torn_line_is_not_read_and_goes_on_where_it_is_finished(store):
    added(store, record("a"))
    path = next(store.folder.glob("cases-*.jsonl"))
    (line,) = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(line + line[:20])
    reader = Store(store.folder)
    assert set(reader.records()) == {"a"}
    body = line.split(b"\t")[0].decode().replace('"key": "a"', '"key": "b"')
    path.write_bytes(line + seal_line(body))
    assert set(reader.records()) == {"a", "b"}


@pytest.mark.parametrize("place", [5, 30, 60, -3])
def test_a_line_with_one_changed_byte_is_no_case(store, place):
    added(store, record("a"), record("b"))
    path = next(store.folder.glob("cases-*.jsonl"))
    data = bytearray(path.read_bytes())
    data[place % data.index(b"\n")] ^= 1
    path.write_bytes(data)
    assert set(Store(store.folder).records()) == {"b"}


def test_draws_that_were_cut_or_changed_are_not_taken(store):
    added(store, record("a"), record("b"))
    path = next(store.folder.glob("draws-*.f4"))
    data = path.read_bytes()
    assert Store(store.folder).records()["b"].draws.tolist() == [0.25, 0.5]
    path.write_bytes(data[:-1])
    assert set(Store(store.folder).records()) == {"a"}
    path.write_bytes(b"\0" * len(data))
    with pytest.raises(DataError, match=r"draws-.*damaged.*computes its cases anew"):
        Store(store.folder).records()["a"]


def test_lines_of_a_newer_version_are_refused(store):
    added(store, record("a"))
    path = next(store.folder.glob("cases-*.jsonl"))
    path.write_text(path.read_text().replace('"format": 2', '"format": 3'))
    with pytest.raises(DataError, match=r"newer version.*Update underfoot"):
        Store(store.folder).records()


@pytest.mark.parametrize("name", ["jobs.jsonl", "cases-"])
def test_a_study_of_format_99_is_refused(store, name):
    begun(store)
    added(store, record("a"))
    path = next(store.folder.glob(f"{name}*"))
    path.write_text(path.read_text().replace('"format": 2', '"format": 99'))
    with pytest.raises(DataError, match=r"newer version.*format 99.*2 or older.*Update underfoot"):
        Study.load(store.folder).result()


def test_a_full_disk_costs_no_finished_case(store, monkeypatch):
    """The first write fails as on a full disk until the reserve is gone."""
    real = os.write

    def write(descriptor, data):
        if any(store.folder.glob(".reserve-*")) and bytes(data[:9]) == b'{"format"':
            real(descriptor, data[: len(data) // 2])
            raise OSError(errno.ENOSPC, "no space left on device")
        return real(descriptor, data)

    with store.working(1):
        monkeypatch.setattr(os, "write", write)
        with pytest.raises(DataError, match=r"full.*every finished case is on it.*goes on"):
            store.add_record(record("a"))
        monkeypatch.setattr(os, "write", real)
    assert set(Store(store.folder).records()) == {"a"}


def begun(store):
    """Return the keys of a study whose first batch is given out."""
    Study.load(store.folder)._begin_next()
    return list(store.jobs().keys)


def took(store):
    """Return the key of the one job that a process takes; None where it gets none."""
    return next(iter(taken(store)), None)


def taken(store):
    """Return the keys of the jobs that a process takes."""
    return [job.key for job in store.take(in_order=True) or ()]


def dead_name(store):
    dead = subprocess.run(
        [sys.executable, "-c", "import os; print(os.getpid())"], capture_output=True, check=True
    )
    return f"{store.name.rsplit('-', 2)[0]}-{int(dead.stdout)}-abcdef"


def test_one_of_two_claims_a_case_and_a_dead_one_loses_it(store):
    keys = begun(store)
    other, third = Store(store.folder), Store(store.folder)
    third.name = dead_name(store)
    with store.working(1), other.working(1):
        assert [took(store), took(other), took(third)] == keys
        assert took(store) == keys[2]
        assert took(other) is None
    assert Store(store.folder).other == ""


def test_who_takes_over_from_the_dead_computes_only_what_they_left(store, monkeypatch):
    monkeypatch.setattr(claims, "block_edges", lambda count: [0, count])
    keys = begun(store)
    first, second = Store(store.folder), Store(store.folder)
    first.name = dead_name(store)
    assert taken(first) == keys
    first.add_record(record(keys[0]))
    first.commit()
    with second.working(1):
        assert taken(second) == keys[1:]
        for key in keys[1:]:
            second.add_record(record(key))
        assert second.share == 1.0
    assert set(Store(store.folder).records()) == set(keys)


def test_a_claim_whose_name_is_not_written_yet_is_one(store, monkeypatch):
    """A busy machine may stop a process between the two calls that claim a block."""
    monkeypatch.setattr(claims, "block_edges", lambda count: [0, count])
    keys, other = begun(store), Store(store.folder)
    claim = store.round.folder / "0"
    claim.touch()
    with other.working(1):
        assert took(other) is None
        old = time.time() - store_module.SILENT - 5
        os.utime(claim, (old, old))  # it died there
        assert taken(other) == keys


def test_two_that_see_the_same_dead_one_do_not_both_take_over(store, monkeypatch):
    monkeypatch.setattr(claims, "block_edges", lambda count: [0, count])
    keys, dead, slow = begun(store), Store(store.folder), Store(store.folder)
    dead.name = dead_name(store)
    assert taken(dead) == keys
    quick = []

    def while_looking(self, owner, mark=None):  # another is faster, after the look at the owner
        if self is slow and not quick:
            quick.append(taken(store))
        return alive(self, owner, mark)

    alive = Store._alive
    monkeypatch.setattr(Store, "_alive", while_looking)
    with store.working(1), slow.working(1):
        assert took(slow) is None
        assert quick == [keys]


def test_who_knew_an_ended_round_computes_nothing_of_it_again(store):
    keys, other = begun(store), Store(store.folder)
    assert list(other.round.places)
    for _ in keys:
        taken(store)
    added(store, *map(record, keys))
    assert not Study.load(store.folder)._begin_next()
    assert took(other) is None


def test_a_silent_process_of_another_machine_loses_its_claim(store):
    keys, elsewhere = begun(store), Store(store.folder)
    elsewhere.name = "elsewhere-12-abcdef"
    with elsewhere.working(1), store.working(1):
        assert [took(elsewhere) for _ in keys] == keys
        assert took(store) is None
        alive = store.folder / "alive" / elsewhere.name
        old = time.time() - store_module.SILENT - 5
        os.utime(alive, (old, old))
        assert took(store) in keys


@pytest.mark.parametrize("beats", [False, True])
def test_a_clock_that_was_set_back_keeps_nobody_s_claim_for_ever(store, monkeypatch, beats):
    """Its file was touched an hour from now; whoever lives touches it again."""
    keys, elsewhere = begun(store), Store(store.folder)
    elsewhere.name = "elsewhere-12-abcdef"
    clock = [0.0]
    monkeypatch.setattr(store_module.time, "monotonic", lambda: clock[0])
    with elsewhere.working(1), store.working(1):
        assert [took(elsewhere) for _ in keys] == keys
        alive = store.folder / "alive" / elsewhere.name
        later = time.time() + 3600
        for k in range(7):
            if beats or not k:
                os.utime(alive, (later + k, later + k))
            clock[0] = 20.0 * k
            took_over = took(store)
            assert (took_over is not None) == (k == 6 and not beats), k
        assert took_over in (keys if not beats else [None])


def test_no_rate_is_told_where_the_clock_was_set_back(store):
    added(store, replace(record("a"), ended=5000.0))
    jobs = [CaseJob(key, k, 0, 0, 0, (), {}) for k, key in enumerate("abc")]
    session = {"began": 4900.0, "ended": None, "workers": 1}

    def status(now):
        return StudyStatus(store.plan(), jobs, Store(store.folder).records(), [session], now)

    right, back = status(5010.0), status(1000.0)
    assert right.seconds_left == pytest.approx(2 * 110)
    assert not any("clock" in text for text in right.cautions())
    assert (back.seconds_left, back.per_minute, back.worker_seconds) == (None, 0.0, 0.0)
    assert any("The clock was set back" in text for text in back.cautions())
    assert back.headline() == ("1 of 3 cases ended: 1 computed.", "1 worker at work.")


def test_the_lead_goes_without_locks_of_the_kernel(store, monkeypatch):
    """As on Lustre without flock or NFS without a lock service; a dead leader loses it."""

    def flock(descriptor, operation):
        raise OSError(errno.ENOSYS, "Function not implemented")

    monkeypatch.setattr("fcntl.flock", flock)
    monkeypatch.setattr(store_module, "SETTLED", 0.01)
    other = Store(store.folder)
    with store.leading() as leads, other.leading() as both:
        assert (leads, both) == (True, False)
        assert other.leader() == store.name
    with other.leading() as leads:
        assert leads
    (store.folder / "lead.claim").write_text(dead_name(store))
    with other.leading() as leads:
        assert leads
    assert not (store.folder / "lead.claim").exists()


@pytest.mark.parametrize("call", ["write", "fsync"])
def test_stopped_between_two_lines_of_code_it_says_what_is_kept(store, monkeypatch, call):
    """Ctrl-C as a record is written, and after it is."""
    study = Study.load(store.folder)
    real, stopping = getattr(os, call), []

    def stopped(descriptor, *data):
        if stopping:
            stopping.clear()
            raise KeyboardInterrupt
        return real(descriptor, *data)

    def compute(function, jobs, died):
        for job in jobs:
            stopping.append(True)
            yield record(job.key)

    monkeypatch.setattr(os, call, stopped)
    with pytest.raises(KeyboardInterrupt, match="every finished case is kept"):
        study._compute(compute, 1, silent, leads=True)
    assert not Store(store.folder).other
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
    begun = Store.open_folder(tmp_path / "study")
    assert not begun.exists
    assert Store.open_folder(tmp_path / "study").take(in_order=True) is None


def test_a_folder_of_something_else_is_left_alone(tmp_path):
    (tmp_path / "thesis.txt").write_text("x")
    with pytest.raises(InputError, match="holds no study"):
        Store.open_folder(tmp_path)
    with pytest.raises(InputError, match="holds no study"):
        Study.load(tmp_path)


def test_another_study_in_the_folder_keeps_what_both_have(store):
    plan = store.plan()
    jobs = [job for k, p in enumerate(plan.grid_points()) for job in plan.jobs(k, p, 0)]
    assert store.add_batch(store.jobs(), jobs) == 3
    assert list(store.jobs()) == jobs
    added(store, record(jobs[0].key))
    wider = read_plan(TEXT.replace("steps = 3", "steps = 5"), EXAMPLES)
    store.adopt(wider)
    assert len(store.jobs()) == 0
    again = [job for k, p in enumerate(wider.grid_points()) for job in wider.jobs(k, p, 0)]
    assert again[0].key in store.records()
    assert store.plan().grid_points() == wider.grid_points()


def test_views_hold_every_case(store):
    duckdb = pytest.importorskip("duckdb")
    plan = store.plan()
    jobs = [job for k, p in enumerate(plan.grid_points()) for job in plan.jobs(k, p, 0)]
    added(store, record(jobs[0].key, 0.125))
    added(Store(store.folder), Record(jobs[1].key, Ending.INFEASIBLE, 'too "narrow", by far'))
    store.write_views(StudyResult(plan, jobs, store.records()).cases())
    place = store.folder / "results.parquet"
    rows = duckdb.sql(f"SELECT ending, cof, reason FROM read_parquet('{place}')").fetchall()
    assert rows[0][:2] == ("computed", 0.125)
    assert rows[1][::2] == ("infeasible", 'too "narrow", by far')
    assert rows[2][0] == "open"


def test_a_job_is_the_same_after_its_line():
    job = CaseJob("k", 3, 1, 0, 2, (0.5, 0.25), {"shoe.tread.depth": 0.002, "contaminant": "water"})
    assert CaseJob.from_line(job.line()) == job
    assert json.loads(job.line())["changes"]["contaminant"] == "water"


def test_time_left_is_told_once_every_worker_has_ended_a_case(store):
    jobs = [CaseJob(str(n), n, 0, 0, 0, (), {}) for n in range(10)]
    session = {"began": 1000.0, "ended": None, "workers": 2}

    def left():
        known = Store(store.folder).records()
        return StudyStatus(store.plan(), jobs, known, [session], 1060.0).seconds_left

    told = [left()]
    for n in range(2):
        added(store, replace(record(str(n)), ended=1000.0 + 5 * n))
        told.append(left())
    assert told[:2] == [None, None]
    assert told[2] == pytest.approx(8 * 30.0)


def test_what_dead_processes_left_is_tidied_and_their_times_are_kept(store):
    added(store, record("a"))
    dead = Store(store.folder)
    dead.name = dead_name(store)
    (store.folder / f".reserve-{dead.name}").write_bytes(b"x")
    (store.folder / "alive" / dead.name).write_text(
        json.dumps({"began": 10.0, "workers": 2, "ended": None})
    )
    before = Store(store.folder).sessions()
    Store(store.folder).adopt(store.plan())
    assert Store(store.folder).sessions() == before
    assert len(before) == 2
    assert list((store.folder / "alive").iterdir()) == []
    assert list(store.folder.glob(".reserve-*")) == []


def test_packed_cases_are_those_that_were_in_lines(store, monkeypatch):
    monkeypatch.setattr(records, "PACK", 4)
    one, other = (record(str(k), k / 8) for k in range(5)), Record("x", Ending.FAILED, "why")
    added(store, *one)
    added(Store(store.folder), other)
    wide = Store(store.folder)
    before = dict(wide.records())
    wide.records().pack(["3", "x", "1"])
    assert list(store.folder.glob("cases-*")) == list(store.folder.glob("draws-*")) == []
    assert len(list(store.folder.glob("packed-*.npz"))) == 2
    for reader in (wide, Store(store.folder)):
        again = dict(reader.records())
        assert {k: (r.numbers, r.draws.tolist()) for k, r in again.items()} == {
            k: (r.numbers, r.draws.tolist()) for k, r in before.items()
        }
        assert reader.records().ending("x") is Ending.FAILED
    place = sorted(store.folder.glob("packed-*.npz"))[0]
    place.write_bytes(place.read_bytes()[:100])
    assert len(Store(store.folder).records()) == 2


VERSION_1 = (
    '{"format": 1, "key": "KEY", "ending": "computed", "reason": "", "numbers": {"cof": 0.25}, '
    '"spreads": {}, "units": {"cof": "1"}, "law": "pair", "draws": "AACAPgAAAD8=", "breaches": '
    '["a"], "seconds": 1.5, "cpu_seconds": 1.0, "program": "p", "worker": "w", "ended": 3.0}\n'
)


def test_a_folder_of_version_1_is_read_and_gone_on_with(store):
    """Lines as version 1 wrote them; a list of jobs that was cut off is set again."""
    plan = store.plan()
    jobs = [job for k, p in enumerate(plan.grid_points()) for job in plan.jobs(k, p, 0)]
    lines = [f"{job.line()}\n".replace('"format": 2', '"format": 1') for job in jobs]
    (store.folder / "cases-old.jsonl").write_text(VERSION_1.replace("KEY", jobs[1].key))
    path = store.folder / "jobs.jsonl"
    for text in ("".join(lines), "".join(lines)[:-20], "".join(lines)):
        path.write_text(text)
        result = Study.load(store.folder).result()
        assert len(result.designs) == 3 - (text[-1] != "\n")
        one = result.records[jobs[1].key]
        assert (one.number("cof"), one.draws.tolist(), one.breaches) == (0.25, [0.25, 0.5], ("a",))
        scanned = scan_cases(Store(store.folder).records(), ["cof"], draws=True)
        assert scanned.draws is not None
        assert scanned.draws[scanned.rows[jobs[1].key]].tolist() == [0.25, 0.5]
        assert Study.load(store.folder)._begin_next()
        assert list(Store(store.folder).jobs()) == jobs
        after = Store(store.folder).round
        assert after is not None
        assert (after.total, len(after.places)) == (3, 2)


def test_a_million_cases_take_few_claims_and_end_one_by_one():
    edges = np.diff(claims.block_edges(10**6))
    assert edges.sum() == 10**6
    assert (np.diff(edges) <= 0).all()
    assert (edges[0], edges[-1]) == (1000, 1)
    assert len(edges) < 8500


@pytest.mark.slow
def test_the_benchmark_of_the_store_runs():
    small = {"CASES": "400", "WORKERS": "4", "PROCESSES": "1"}
    environment = os.environ | {f"UNDERFOOT_BENCH_{name}": value for name, value in small.items()}
    command = [sys.executable, "-m", "benchmarks", "study_store"]
    done = subprocess.run(
        command, cwd=EXAMPLES.parent, env=environment, capture_output=True, text=True, check=True
    )
    assert "opened, in lines, 10 files" in done.stdout
    assert "{'computed': 400}" in done.stdout
