"""How a study is worked on: waits, rounds, what is kept, a posterior of finished cases."""

from contextlib import nullcontext
from dataclasses import asdict, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from test_explore_studies import BASE, HERE, PLANS, SWEEP, ended, made_up, plan_of

from snapshot import held, refusal
from underfoot.explore import check, engines, posterior, store, study
from underfoot.explore import claims as claims_module
from underfoot.explore.check import Computer, StudyCheck, study_check
from underfoot.explore.claims import ASKED, LARGEST, begin_round, block_edges, latest_round
from underfoot.explore.computing import status_bytes
from underfoot.explore.cost import StudyCost, _steady, mean_cost, spread_jobs, study_cost
from underfoot.explore.inputs import JointDraws
from underfoot.explore.jobs import BatchJobs, add_batch, jobs_at
from underfoot.explore.lines import seal_line, unseal_line
from underfoot.explore.proposals import next_batch
from underfoot.explore.record import CaseJob, Ending, Record
from underfoot.explore.records import Records
from underfoot.explore.result import StudyResult, front_places, of_100
from underfoot.explore.scan import scan_cases
from underfoot.explore.status import StudyStatus
from underfoot.explore.store import Store
from underfoot.explore.study import Study
from underfoot.explore.study_file import read_plan
from underfoot.explore.sweeps import _file_value


class Script:
    """A store that finds at each look what a script says: jobs, "others", "held", "over"."""

    def __init__(self, *steps, stops=99, next_rounds=(), leads=True):
        self.steps, self.at, self.stops, self.rounds = list(steps), -1, stops, list(next_rounds)
        self.leads, self.seen, self.share, self.folder = leads, [], 0.25, Path("folder")
        self.looks = 0

    @property
    def stopped(self):
        self.looks += 1
        return self.looks > self.stops

    def take(self, *, in_order):
        self.at += 1
        step = self.steps[min(self.at, len(self.steps) - 1)]
        self.seen.append(f"take {in_order}")
        return list(step) if isinstance(step, tuple) else None

    def _now(self):
        return self.steps[min(self.at, len(self.steps) - 1)]

    @property
    def holds(self):
        return self._now() == "held"

    @property
    def round(self):
        now = self._now()
        places = [] if now == "last" else [1]
        return (
            SimpleNamespace(ended=now in ("over", "last"), places=places) if now != "none" else None
        )

    @property
    def other(self):
        return "another-7-abc"

    def end_round(self):
        self.seen.append("end round")
        return True

    def leading(self):
        script = self

        class Lead:
            def __enter__(self):
                script.seen.append("lead")
                return script.leads

            def __exit__(self, *_):
                return False

        return Lead()


def test_how_a_worker_waits(file_regression, monkeypatch):
    scripts = {
        "one batch": (Script(("a", "b"), ("c",), "last"), False),
        "leads": (Script(("a",), "over", ("b",), "last", next_rounds=[True, True, False]), True),
        "held": (Script(("a",), "held", "held", ("b",), "last"), False),
        "others": (Script(*["others"] * 7, ("a",), *["others"] * 3, "last"), False),
        "no round": (Script("none", "none", ("a",), "last", leads=False), False),
        "leads for a moment": (Script("over", ("a",), "last", next_rounds=[True]), False),
        "stopped": (Script(("a", "b", "c", "d"), ("e",), "last", stops=2), False),
        "stopped at once": (Script(("a",), "last", stops=0), False),
    }
    said: dict[str, Any] = {}
    for key, (script, leads) in scripts.items():
        clock, lines = [100.0], []

        def sleep(seconds, clock=clock, lines=lines):
            lines.append(f"sleep {seconds:g}")
            clock[0] += seconds

        monkeypatch.setattr(
            study, "time", SimpleNamespace(sleep=sleep, monotonic=lambda clock=clock: clock[0])
        )
        one = Study(plan_of("grid"), "folder")
        one.store = cast(Any, script)

        def begin(script=script, lines=lines):
            answer = script.rounds.pop(0) if script.rounds else False
            lines.append(f"begin {answer}")
            return answer

        monkeypatch.setattr(one, "_begin_next", begin)
        for count, job in enumerate(one._claim_jobs(leads, lines.append)):
            lines.append(f"job {job}")
            clock[0] += 0.6
            assert count < 40
        said[key] = lines, script.seen
    held(file_regression, said)


def test_what_blocks_and_rounds_hold(file_regression, tmp_path):
    claims = tmp_path / "claims"
    claims.mkdir()

    def nobody(*_):
        return False

    said: dict[str, Any] = {
        "edges": {str(n): [len(block_edges(n)), *block_edges(n)[:4]] for n in
                  (0, 1, LARGEST, LARGEST + 1, 2500, 2_000_000)},
        "limits": (LARGEST, ASKED),
    }  # fmt: skip
    one = begin_round(claims, np.arange(3) * 10, 5, "me-1-a")
    said["round"] = (one.total, one.before, one.places, one.share, one.ended, one.size(0))
    said["claim"] = one.claim(nobody, in_order=True), one.claim(nobody, in_order=True)
    one.finish(0)
    said["share"] = one.share, one.ended
    other = latest_round(claims, "you-2-b", None)
    assert other is not None
    taken = other.claim(nobody, in_order=True)
    over = other.claim(nobody, in_order=True)  # of a dead one
    said["taken over"] = taken, over
    said["nothing left"] = other.claim(lambda *_: True, in_order=False)
    said["others"] = one.other(lambda *_: True), one.other(nobody), other.other(lambda *_: True)
    assert not one.over(lambda *_: True)
    for block in (1, 2):
        other.finish(block)
    other.claim(nobody, in_order=True)
    said["ended"] = other.ended, other.share, other.over(lambda *_: True)
    later = begin_round(claims, np.arange(2), 9, "you-2-b")
    assert latest_round(claims, "you-2-b", later) is later
    held(file_regression, said)


def test_jobs_of_a_file(file_regression, tmp_path):
    plan, path = plan_of("goals"), tmp_path / "jobs.jsonl"
    jobs = list(plan.jobs(0, (0.0, 0.0), 0))
    said: dict[str, Any] = {"none": (len(BatchJobs(path)), BatchJobs(path).closed)}
    said["added"] = add_batch(path, 0, jobs, 0), add_batch(path, 1, [], path.stat().st_size)
    first = BatchJobs(path)
    said["more"] = add_batch(path, 1, jobs[:2], first.end)
    whole = BatchJobs(path)
    said["whole"] = len(whole), whole.batches, whole.end == path.stat().st_size, whole.closed
    for name, some in (
        ("slice", whole[1:3]), ("at", whole.at([0, 5])), ("all", list(whole)), ("last", [whole[-1]])
    ):  # fmt: skip
        said[name] = [(one.design, one.condition, one.draw) for one in some]
    with path.open("ab") as stream:
        stream.write(seal_line(jobs[0].line()) + b"half")
    torn = BatchJobs(path)
    said["torn"] = len(torn), torn.batches, torn.end == whole.end
    said["damaged"] = refusal(jobs_at, path, [3])
    line = seal_line('{"format": 2, "key": "a"}')
    texts = line[:-1], line[:-2], b'{"format": 1, "a": 2}', b'{"format": 1, "a": 2', b"x"
    said["lines"] = [unseal_line(one) for one in texts]
    said["newer"] = refusal(unseal_line, b'{"format": 3, "a": 2}')
    held(file_regression, said)


def test_records_and_their_numbers(file_regression):
    bare, job = Record("k", Ending.COMPUTED), CaseJob("k", 1, 2, 3, 4, (0.5,), {"a": 1.0})
    known = replace(bare, numbers={"cof": 0.2, "mass": None}, spreads={"cof": 0.01},
                    units={"mass": "kg"}, reason="why")  # fmt: skip
    said = {
        "defaults": {k: v for k, v in asdict(bare).items() if k != "draws"},
        "empty": bare.draws.size, "job": asdict(job),
        "sourced": [known.sourced_value(name) for name in ("cof", "mass", "gone")],
        "usable": [Record("k", one).usable for one in Ending],
        "packed": len(replace(bare, draws=np.arange(3.0)).packed_draws),
        "again": CaseJob.from_line(job.line()) == job,
    }  # fmt: skip
    held(file_regression, said)


COST = StudyCost(40, 30.0, (20.0, 45.0), 36.0, 2e9, 3e6, {"no contact": 2, "x": 1})


def test_what_a_study_takes_anywhere(file_regression):
    plan, small = plan_of("goals"), plan_of("robust")
    plain = study_check(plan, 20)
    parts = {key: getattr(plain, key) for key in StudyCheck.__dataclass_fields__ if key != "kind"}
    made = {
        "here": {}, "no memory told": {"machine": Computer(8, 0.0, 1e12)},
        "one fits": {"machine": Computer(8, 3.9e9, 1e12)},
        "none fits": {"machine": Computer(8, 1e9, 1e12)},
        "disk": {"machine": Computer(8, 64e9, 1e6)},
        "ended": {"ended": 40}, "all ended": {"ended": 54},
        "long": {"cases": 100_000, "machine": Computer(2, 64e9, 1e13)},
        "a little long": {"cases": 4801, "machine": Computer(4, 64e9, 1e13)},
        "not long": {"cases": 4800, "machine": Computer(4, 64e9, 1e13)},
        "few long": {"cases": 30, "cost": replace(COST, cpu_seconds=1e5, seconds=1e5),
                     "machine": Computer(1, 64e9, 1e13)},
        "guess": {"cost": None, "ended": 3}, "bad": {"infeasible": {"a": 1, "b": 3}, "built": 9},
    }  # fmt: skip
    said: dict[str, Any] = {}
    for key, changes in made.items():
        base = {"machine": Computer(4, 16e9, 1e12), "memory": 2e9, "cost": COST,
                "seconds": (1080.0, 2430.0)}  # fmt: skip
        one = StudyCheck(**{**parts, **base, **changes})
        said[key] = (one.headline(), one.cautions(), one.workers, one.tasks, one.seconds_left,
                     one.cpu_seconds, one.remarks(), one.to_dict()["estimate"])  # fmt: skip
    wild = read_plan(PLANS["grid"].replace('"4 mm"', '"45 mm"'), HERE, base=BASE)
    refused = study_check(wild, 300)
    said["can't be built"] = refused.headline()[1], refused.remarks(), refused.infeasible
    few = {n: study_check(small, n).built for n in (1, 8, 300)}
    said["built"] = few, check.MOST_BUILT
    said["machine"] = [status_bytes(__file__, "MemAvailable:"), Computer(2, 1.0, 2.0)]
    held(file_regression, said, hide=r"about [\d.]+ to [\d.]+ \w+ of one")


def test_costs_of_cases(file_regression, tmp_path):
    plan = plan_of("goals")
    result = ended(plan)
    kept_in = Store.open_folder(tmp_path / "s")
    kept_in.adopt(plan)
    said: dict[str, Any] = {"nothing": study_cost(plan, kept_in)}
    kept_in.add_batch(kept_in.jobs(), result.jobs)
    with kept_in.working(1):
        for k, job in enumerate(result.jobs[:12]):
            worker = {"worker": f"w{k % 3}", "ended": 100.0 + k}
            kept_in.add_record(replace(result.records[job.key], **worker))
            if k == 1:
                said["two"] = study_cost(plan, kept_in)
    cost = study_cost(plan, kept_in)
    assert cost is not None
    said["twelve"] = {key: value for key, value in asdict(cost).items() if key != "disk"}
    said["disk"] = 500 < cost.disk < 5000
    rows = np.array([[0.0, 1.0], [0.3, 0.2], [0.5, 0.5], [0.9, 0.1]])
    costs = np.exp(1 + 2 * rows[:, 0] - rows[:, 1])
    said["mean"] = mean_cost(rows, costs, rows), mean_cost(rows, costs, rows[:2])
    said["spread"] = [(j.design, j.condition, j.draw) for j in spread_jobs(plan, 9)]
    said["every"] = len(list(spread_jobs(plan, 10**6)))
    held(file_regression, said)


def test_scans_of_many_draws(file_regression, tmp_path, monkeypatch):
    from underfoot.explore import scan

    result = ended(plan_of("grid"))
    kept_in = Store.open_folder(tmp_path / "s")
    kept_in.adopt(result.plan)
    some = [result.records[job.key] for job in result.jobs[:5]]
    draws = [np.empty(0), np.arange(4.0), np.arange(4.0) + 1, np.arange(2.0), np.empty(0)]
    with kept_in.working(1):
        for record, own in zip(some, draws, strict=True):
            kept_in.add_record(replace(record, draws=own))
    found = scan_cases(kept_in.records(), ["cof"], draws=True)
    monkeypatch.setattr(scan, "MOST_DRAWS", 11)
    fewer = scan_cases(kept_in.records(), ["cof"], draws=True)
    without = scan_cases(kept_in.records(), ["cof"])
    gone = Records(kept_in.folder).look()
    order = [job.key for job in result.jobs]
    monkeypatch.setattr("underfoot.explore.records.PACK", 2)
    kept_in.records().pack(order)
    held(
        file_regression,
        {
            "all": (found.draws, found.every, found.outputs, list(found.rows.values())),
            "fewer": (fewer.draws, fewer.every), "without": (without.draws, without.every),
            "packed since": scan_cases(gone, ["cof"], draws=True).draws,
            "files": sorted(p.name.partition("-")[0] for p in kept_in.folder.glob("*-*")),
            "read": [gone[record.key].draws for record in some],
            "counts": gone.endings_of(order),
        },
    )  # fmt: skip


def test_status_at_a_moment(file_regression):
    result = ended(plan_of("goals"))
    began = {"began": 90.0, "ended": None, "workers": 2}
    told: dict[str, Any] = {}
    for name, now, sessions in (
        ("soon", 200.0, [began]), ("later", 130.0, [began]), ("ended", 400.0,
        [began | {"ended": 150.0}]), ("ahead", 45.0, [began | {"began": 105.0}]),
        ("far ahead", 44.9, [began | {"began": 105.0}]),
    ):  # fmt: skip
        scan = SimpleNamespace(
            case={
                "seconds": np.array([3.0, 4.0, np.nan]),
                "ended": np.array([101.0, 95.0, np.nan]),
            },
            programs={"a"},
        )
        some: Any = dict(list(result.records.items())[:30])
        one = StudyStatus(result.plan, result.jobs, some, sessions, now=now)
        one.__dict__["scan"] = scan
        told[name] = (one.headline(), one.cautions()[-1:], one.busy, one.per_minute, one.cases_left,
                      one.seconds_left, one.clock_went_back, one.worker_seconds)  # fmt: skip
    held(file_regression, told)


def test_a_posterior_of_finished_cases(file_regression, tmp_path, monkeypatch):
    for name, few in (("STEPS", 40), ("BURNT", 20), ("MOST_STEPS", 80), ("PART", 20), ("KEPT", 50)):
        monkeypatch.setattr(posterior, name, few)
    text = PLANS["readings"] + '[[reading]]\nname = "again"\ncof = 0.2\nsd = 0.01\n' \
        'when."motion.speed" = "0.2 m/s"\n'  # fmt: skip
    one = Study(read_plan(text, HERE, base=BASE), tmp_path / "s")
    kept_in = Store.open_folder(one.store.folder)
    kept_in.adopt(one.plan)
    with kept_in.working(1):
        for job in next_batch(one.plan, StudyResult(one.plan, [], {})):
            kept_in.add_record(made_up(one.plan, job))
    heard: list[tuple[str, float]] = []
    made = posterior.posterior(one, workers=1, progress=lambda *said: heard.append(said))
    held(
        file_regression,
        {
            "draws": made.draws, "prior": made.prior, "discrepancy": made.discrepancy,
            "before": made.before, "after": made.after, "lengths": made.lengths,
            "readings": made.readings, "apart": made.apart, "paths": made.paths,
            "usable": made.usable, "headline": made.headline(), "cautions": made.cautions(),
            "heard": heard[-4:], "models": [str(model.name) for model in made.models],
            "table": made.tables(),
        },
    )  # fmt: skip


def test_where_cases_are_sent(file_regression, monkeypatch):
    asked: list[Any] = []

    class Cluster:
        def __init__(self, *given, **more):
            asked.append((given, more))

        def get_client(self):
            return "its own"

    def failing(*_, **__):
        raise OSError("no answer")

    threads = [{}] * 60 + [{"a": 2, "b": 3}]
    clock = [0.0]

    def sleep(seconds):
        clock[0] += seconds

    monkeypatch.setattr(engines, "time", SimpleNamespace(sleep=sleep, monotonic=lambda: clock[0]))
    heard: list[str] = []
    client = SimpleNamespace(nthreads=lambda: threads.pop(0))
    there = SimpleNamespace(LocalCluster=Cluster, Client=Cluster)
    away = SimpleNamespace(Client=failing)
    clients = [engines._client(there, at, 3) for at in ("", "tcp://a:8786", "scheduler.json")]
    held(
        file_regression,
        {
            "asked": asked, "own": clients[0],
            "threads": engines._threads(client, "tcp://a", heard.append),
            "heard": (len(heard), heard[0], clock[0]),
            "away": refusal(engines._client, away, "tcp://a:8786", 1),
        },
    )  # fmt: skip


class Cancelled(Exception):
    """The scheduler forgot a case."""


class Killed(Exception):
    """Workers that took a case died."""


class Cluster:
    """A Dask cluster that answers each case when it is asked for the next answer."""

    def __init__(self, threads, gone=99, loses=99):
        self.threads, self.gone, self.loses, self.waiting, self.lines = threads, gone, loses, [], []
        self.CancelledError, self.KilledWorker = Cancelled, Killed
        self.comm = SimpleNamespace(CommClosedError=EOFError)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.lines.append("closed")
        return False

    def nthreads(self):
        return {"a": self.threads}

    def submit(self, function, job, *, key, pure):
        self.lines.append(f"submit {key} {pure}")
        return SimpleNamespace(key=key, call=lambda: function(job))

    def as_completed(self, *, with_results, raise_errors):
        self.lines.append(f"results {with_results}, errors raised {raise_errors}")
        return self

    def add(self, future):
        self.waiting.append(future)

    def __iter__(self):
        return self

    def __next__(self):
        if not self.waiting:
            raise StopIteration
        future = self.waiting.pop(0)
        if future.key == f"case-{self.gone}":
            return future, Cancelled()
        if future.key == f"case-{self.loses}":
            return future, (Killed, Killed("twice"))
        try:
            return future, future.call()
        except ValueError as error:
            return future, (ValueError, error)


def test_cases_on_a_cluster(file_regression, monkeypatch):
    def set_(values):
        settings.append(values)
        return nullcontext()

    def record(job):
        if job.key == "bad":
            raise ValueError("no number")
        return Record(job.key, Ending.COMPUTED)

    def died(job):
        return Record(job.key, Ending.CRASHED)

    told: dict[str, Any] = {}
    for name, keys, cluster in (
        ("all", [*"abcdefg"], Cluster(2)),
        ("none open for now", ["a", None, "b", None], Cluster(1)),
        ("a worker dies", [*"abc"], Cluster(1, loses="b")), ("away", [*"abc"], Cluster(1, "b")),
        ("wrong", ["a", "bad"], Cluster(3)),
    ):  # fmt: skip
        settings: list[Any] = []
        modules = {"distributed": cluster, "dask.config": SimpleNamespace(set=set_)}
        monkeypatch.setattr(engines, "optional_module", lambda name, *_, m=modules: m[name])
        monkeypatch.setattr(engines, "_client", lambda module, at, count: module)
        jobs = [key and CaseJob(key, 0, 0, 0, 0, (), {}) for key in keys]
        compute, count = engines.engine("dask:tcp://a:1", 3, print)
        got = []
        try:
            for one in compute(record, iter(jobs), died):
                got.append(f"{one.key} {one.ending}, {len(cluster.waiting)} sent")
        except Exception as error:  # how it ends is what is held
            got.append(f"{type(error).__name__}: {error}")
        told[name] = got, cluster.lines, settings, count
    held(file_regression, told)


def test_what_is_tried_next(file_regression):
    goals = {
        "front": '[outputs]\nmaximise = ["cof"]\nminimise = ["mass"]\n',
        "bound": '[outputs]\nmaximise = ["cof"]\nrequire = ["mass < 0.045 kg"]\n',
    }
    told: dict[str, Any] = {}
    for name, text in goals.items():
        plan = read_plan(
            '[vary]\n"shoe.tread.depth" = { from = "1 mm", to = "4 mm" }\n'
            f'{text}[method]\nkind = "optimise"\nbudget = 7\nbatch = 2\nagain = 2\n',
            HERE,
            base=BASE,
        )
        result = ended(plan)
        told[name] = [
            (one.number, [round(share, 2) for share in one.point], one.quick)
            for one in result.all_designs
        ]
    held(file_regression, told)


def test_small_answers(file_regression, tmp_path):
    draws = tmp_path / "draws.csv"
    draws.write_text("shoe.material.shore_a,motion.speed\n" + "".join(
        f"{50 + k},{0.2 + 0.01 * k}\n" for k in range(12)))  # fmt: skip
    goal = '[outputs]\nmaximise = ["cof"]\nminimise = ["{}"]\n'
    texts = {
        "joint": '[vary]\n"shoe.tread.depth" = [1, 2]\n[uncertain]\nposterior = "draws.csv"\n'
        '"motion.normal_force" = {normal = "60 N", sd = "5 N"}\n'
        '[outputs]\nmaximise = ["cof"]\n[method]\nkind = "robust"\nbudget = 12\ndraws = 3\n',
        "both ways": SWEEP + goal.format("cof"), 
        "twice": SWEEP + '[outputs]\nmaximise = ["cof", "cof"]',
        "no density": SWEEP + goal.format("mass"), 
        "set twice": SWEEP + '[uncertain]\n"shoe.material.shore_a" = {from = 50, to = 60}',
        "section": "vary = 3\n", "path twice": SWEEP + '[conditions]\nwear = ["0 mm"]\n'
        '"shoe.wear.depth" = ["1 mm"]\n',
        "too fine": '[vary]\n"shoe.tread.lug_width" = ["1 um", "5 mm"]\n',
        "finer": '[vary]\n"shoe.tread.lug_width" = ["3 mm", "5 mm"]\n',
        "not again": '[vary]\n"shoe.tread.depth" = ["1 mm", "2 mm"]\n[set]\n'
        '"numerics.tread_positions" = 1\n[outputs]\nmaximise = ["cof"]\n'
        '[method]\nfront_grid = "quick"\n',
    }  # fmt: skip
    said: dict[str, Any] = {}
    for name, text in texts.items():
        base = BASE.replace("shoe.material.density", None) if name == "no density" else BASE
        try:
            plan = read_plan(text.replace("[1, 2]", '["1 mm", "2 mm"]'), tmp_path, base=base)
            said[name] = (
                plan.draws,
                plan.remarks,
                plan.base.numerics.quick_grid_spacing,
                plan.designs,
            )
        except Exception as error:  # how it is refused is held too
            said[name] = f"{type(error).__name__}: {error}"
    said["rows"] = JointDraws(("a",), np.arange(10.0)[:, None]).rows(4)
    said["written"] = [_file_value(*one) for one in (
        ("vary", "motion.speed", {"from": 0.1, "to": 1.0, "log": True, "steps": 3}),
        ("vary", "motion.speed", (0.1, 1.0, 4)), ("vary", "wear", [0.0, 1e-3]),
        ("conditions", "wear", [0.0, 1e-3]), ("uncertain", "motion.speed",
        {"lognormal": 0.3, "factor": 1.3}), ("method", "budget", 3), ("vary", "a", "x"),
        ("vary", "contaminant", ["water"]))]  # fmt: skip
    values = np.array([[1.0, 3.0], [1.0, 2.0], [2.0, 1.0], [3.0, 1.0], [0.5, np.nan], [0.0, 0.0]])
    said["front"] = front_places(values, np.array([1, 1, 1, 1, 1, 0], bool))
    said["of 100"] = [of_100(x) for x in (0.0, 0.29, 0.999, 1.0)]
    said["silence"] = store.SILENT, study.PAUSE, study.LONGEST_PAUSE
    held(file_regression, said)


class Jobs(list):
    """Jobs as a folder holds them."""

    closed = True

    @property
    def keys(self):
        return [job.key for job in self]


@pytest.mark.parametrize(
    ("designs", "whole"),
    [
        ([(k, 0) for k in range(9)], True), ([(k, 0) for k in range(9)] + [(9, 1)], True),
        ([(k, 0) for k in range(8)], False), ([(k, 0) for k in range(8)] + [(9, 1)], False),
    ],
)  # fmt: skip
def test_jobs_of_version_1_are_kept_where_the_first_batch_is_whole(monkeypatch, designs, whole):
    plan = plan_of("grid")
    jobs = Jobs(CaseJob(f"k{d}", d, 0, 0, batch, (0.0, 0.0), {}) for d, batch in designs)
    jobs.closed = False
    closed: list[Any] = []
    rounds = iter([0, 5])
    later = Jobs()
    records = SimpleNamespace(pack=print)
    one = Study(plan, "folder")
    found = iter([jobs, later, later])
    one.store = cast(Any, SimpleNamespace(
        jobs=lambda: next(found), records=lambda: records,
        close_batches=lambda kept_of: closed.append(len(kept_of)),
        begin_round=lambda jobs, *, ended: next(rounds), add_batch=lambda jobs, batch: 9,
    ))  # fmt: skip
    monkeypatch.setattr(study, "next_batch", lambda plan, so_far: ["a batch"])
    assert one._begin_next()
    assert closed == [len(jobs) if whole else 0]


def test_a_study_without_a_next_batch_is_packed_and_ended(monkeypatch):
    said: list[Any] = []
    jobs = Jobs([CaseJob("k", 0, 0, 0, 0, (0.0,), {})])
    one = Study(plan_of("grid"), "folder")
    one.store = cast(Any, SimpleNamespace(
        jobs=lambda: jobs, records=lambda: SimpleNamespace(pack=lambda keys: said.append(keys)),
        begin_round=lambda jobs, *, ended: said.append(ended) or 0,
        add_batch=lambda jobs, batch: said.append(batch) or 0,
    ))  # fmt: skip
    monkeypatch.setattr(study, "next_batch", lambda plan, so_far: [])
    assert not one._begin_next()
    assert said == [False, [], True, ["k"]]


@pytest.mark.parametrize(
    ("cases", "workers", "used"), [(6, 6, 6), (6, 3, 3), (7, 4, 3), (8, 5, 8), (5, 2, 3), (4, 2, 4)]
)
def test_the_first_case_of_a_process_counts_where_few_others_are_left(cases, workers, used):
    """Of ``cases``, evenly over processes, those are used that are no first ones, or all."""
    pairs: Any = [
        (k, Record(f"k{k}", Ending.COMPUTED, worker=f"w{k % workers}", ended=float(k)))
        for k in range(cases)
    ]
    left = _steady(pairs)
    assert len(left) == used
    assert used == cases or min(k for k, _ in left) == workers


def test_the_latest_of_several_rounds_counts(tmp_path, monkeypatch):
    for number in (9, 10, 2):
        (tmp_path / str(number)).mkdir()
    monkeypatch.setattr(claims_module, "Round", lambda path, name: (path.name, name))
    assert latest_round(tmp_path, "me", None) == ("10", "me")
    for number, same in ((10, True), (9, False)):
        known = cast(Any, SimpleNamespace(number=number))
        assert (latest_round(tmp_path, "me", known) is known) is same
    (tmp_path / "none").mkdir()
    assert latest_round(tmp_path / "none", "me", None) is None
