"""Design studies on a made-up law of their outputs: plans, batches, results, checks, refusals."""

import math
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from small_pads import BARS, DRY, pad
from snapshot import held, refusal, tried
from underfoot.case import Case
from underfoot.core import DataError
from underfoot.core.catalogue import Catalogue
from underfoot.explore.check import Computer, StudyCheck, size_text, study_check
from underfoot.explore.claims import block_edges
from underfoot.explore.computing import compute_job, crash_record, status_bytes
from underfoot.explore.cost import study_cost
from underfoot.explore.effects import effects, sampled_effect_points
from underfoot.explore.engines import _next, engine
from underfoot.explore.export import export_designs
from underfoot.explore.goals import (
    Condition,
    Goal,
    Requirement,
    WearLife,
    check_agreement,
    output_array,
    read_goal,
    read_requirement,
)
from underfoot.explore.inputs import (
    Choice,
    Distribution,
    JointDraws,
    Range,
    read_choice,
    read_distribution,
    read_input,
    read_joint_draws,
    value_at,
)
from underfoot.explore.plan import Method, StudyPlan, job_key
from underfoot.explore.posterior import Posterior, _half_normal, _log_density, posterior
from underfoot.explore.proposals import first_points, next_batch
from underfoot.explore.record import CaseJob, Ending, Record, draws_place
from underfoot.explore.result import StudyResult, _repeats, value_text
from underfoot.explore.scan import scan_cases
from underfoot.explore.status import StudyStatus, study_status
from underfoot.explore.store import Store
from underfoot.explore.study import Study
from underfoot.explore.study_file import UNITS, flat_paths, read_plan
from underfoot.explore.surrogate import Surrogate, feature_columns, fit_surrogate
from underfoot.explore.sweeps import optimise, sweep

HERE = Path(".")
SWEEP = """
[vary]
"shoe.tread.depth" = { from = "1 mm", to = "4 mm", steps = 3 }
"shoe.material.shore_a" = [50, 60, 70]
"""
STATES = """
[conditions]
contaminant = ["glycerol_90pct", "canola_oil"]
wear = ["0 mm", "0.5 mm", "1 mm"]
"""
PLANS = {
    "grid": SWEEP,
    "goals": SWEEP + STATES + """
[outputs]
maximise = ["min(cof) over conditions", "wear_life(cof > 0.12)"]
minimise = ["mass", "quantile(cof, 0.9) in canola_oil"]
require = ["cof > 0.1 in glycerol_90pct", "fluid_load < 40 N"]
""",
    "follow": """
name = "ribs"
[vary]
"shoe.tread.channel_width" = { from = "4 mm", to = "6 mm" }
"shoe.tread.lug_width" = { times = 1.2, of = "shoe.tread.channel_width" }
"motion.speed" = { from = "0.1 m/s", to = "1 m/s", log = true }
[set]
"motion.normal_force" = "60 N"
[method]
budget = 6
design = "lhs"
seed = 3
""",
    "optimum": """
[vary]
"shoe.tread.depth" = { from = "1 mm", to = "4 mm" }
"shoe.material.shore_a" = { from = 50, to = 80 }
[outputs]
maximise = ["cof"]
minimise = ["mass"]
require = ["cof > 0.11"]
[method]
kind = "optimise"
budget = 12
again = 2
batch = 2
""",
    "robust": """
[vary]
"shoe.tread.depth" = { from = "1 mm", to = "4 mm" }
[uncertain]
"contaminant.viscosity" = { lognormal = "20 cP", factor = 1.3 }
"motion.speed" = { normal = "0.3 m/s", sd = "0.05 m/s" }
[outputs]
maximise = ["quantile(cof, 0.1)"]
[method]
kind = "robust"
budget = 20
draws = 4
front_grid = "none"
""",
    "active": """
[vary]
"shoe.tread.depth" = { from = "1 mm", to = "4 mm" }
"shoe.tread.pattern" = ["bars", "grid"]
[method]
budget = 12
active = 0.2
""",
    "sobol": """
[vary]
"shoe.tread.depth" = { from = "1 mm", to = "4 mm" }
[uncertain]
"shoe.material.shore_a" = { from = 50, to = 70 }
[method]
kind = "sensitivity"
budget = 16
""",
    "morris": """
[uncertain]
"shoe.material.shore_a" = { from = 50, to = 70 }
"motion.speed" = { from = "0.2 m/s", to = "0.4 m/s" }
[method]
kind = "sensitivity"
analysis = "morris"
on = "runs"
budget = 15
""",
    "readings": """
[uncertain]
"shoe.material.shore_a" = { from = 50, to = 70 }
[method]
budget = 16
[[reading]]
name = "slow"
cof = 0.12
sd = 0.01
when."motion.speed" = "0.2 m/s"
[[reading]]
fluid_load = "10 N"
sd = "2 N"
when."motion.speed" = "0.5 m/s"
""",
}  # fmt: skip
BASE = pad(BARS, {"contaminant": "glycerol_90pct", "shoe.material.density": "1150 kg/m^3"})


def plan_of(name: str, text: str | None = None) -> StudyPlan:
    return read_plan(PLANS[name] if text is None else text, HERE, base=BASE)


def made_up(plan: StudyPlan, job: CaseJob) -> Record:
    """Return the record of a job: smooth in what is varied, one case in eleven without numbers."""
    case = plan.base.replace(job.changes)
    depth, shore = case.value("shoe.tread.depth") * 1e3, case.value("shoe.material.shore_a")
    cof = 0.14 - 0.004 * (depth - 2.4) ** 2 - 3e-5 * (shore - 58) ** 2 - 0.02 * case.motion.speed
    cof += 0.01 * (case.contaminant.viscosity or 0.0) - 10 * case.shoe.wear.depth
    cof += 0.002 * job.quick
    if job.design % 11 == 10:
        ending = (Ending.INFEASIBLE, Ending.NOT_CONVERGED)[job.condition % 2]
        return Record(job.key, ending, "made to fail", seconds=1.0, cpu_seconds=0.5)
    numbers = {"cof": cof, "fluid_load": 30 - 3 * depth, "mass": 0.02 * depth * shore / 50,
               "slip_probability": None}  # fmt: skip
    draws = cof + 0.01 * np.linspace(-1, 1, 5) ** 3
    return Record(
        job.key, Ending.COMPUTED, numbers=numbers, spreads={"cof": 0.01},
        errors={"cof": 0.001, "fluid_load": 0.5, "mass": 0.0}, units={"fluid_load": "N"},
        law="pair", draws=draws, breaches=("compound: beyond",) * (depth > 3), seconds=2.0 + depth,
        cpu_seconds=1.5 + depth, memory=1e8 * depth, program="a", worker="w", ended=100.0 + depth,
    )  # fmt: skip


def ended(plan: StudyPlan) -> StudyResult:
    """Return a study whose batches are all computed by the law."""
    jobs: list[CaseJob] = []
    records: dict[str, Record] = {}
    while batch := list(next_batch(plan, StudyResult(plan, jobs, records))):
        jobs += batch
        records |= {job.key: made_up(plan, job) for job in batch}
        assert len(jobs) < 400
    return StudyResult(plan, jobs, records)


@pytest.fixture(scope="module")
def results() -> dict[str, StudyResult]:
    return {name: ended(plan_of(name)) for name in PLANS if name != "morris"}


def told(result: StudyResult) -> dict[str, Any]:
    """Return what a result says and holds."""
    plan, some = result.plan, result.shown[:4]
    said = {
        "short": repr(result), "heading": result.heading(), "headline": result.headline(),
        "cautions": result.cautions(), "table": result.table(), "remarks": result.remarks(),
        "dict": {key: one for key, one in result.to_dict().items() if key != "designs"},
        "cases": result.cases(), "usable": result.usable, "endings": result.endings,
        "unmet": result.lost_text, "left": result.ended_text(3),
        "designs": [(one.number, one.point, one.usable, one.ending, one.reason, one.states)
                    for one in result.all_designs[:6]],
        "keys": len(result.keys), "again": [one.number for one in result.again],
        "start": result.start and result.start.number,
        "values": result.values(some, plan.shown_goals),
    }  # fmt: skip
    if plan.goals:
        said |= {
            "best": [one.number for one in result.best(3)],
            "front": [one.number for one in result.front],
            "margins": result.margins(some), "allowed": result.meets_requirements(some),
            "above": result.above_start(), "higher": result.higher_cof(*result.designs[:2]),
            "goals": result.goal_values(some),
        }  # fmt: skip
    return said


@pytest.mark.parametrize("name", ["grid", "goals", "follow", "optimum", "robust", "active"])
def test_results(file_regression, results, name):
    held(file_regression, told(results[name]), f"result {name}")


def test_plans(file_regression):
    said: dict[str, Any] = {}
    for name in PLANS:
        plan = plan_of(name)
        point = tuple(np.linspace(0.2, 0.9, len(plan.dimensions)))
        said[name] = {
            "name": plan.name, "vary": plan.vary, "follow": plan.follow, "fixed": plan.fixed,
            "uncertain": plan.uncertain, "draws": plan.draws, "states": plan.states,
            "goals": [(str(one), one.phrase, one) for one in plan.goals],
            "shown": plan.shown_goals, "require": [(str(one), one) for one in plan.require],
            "method": plan.method, "remarks": plan.remarks, "readings": plan.readings,
            "signs": plan.signs, "designs": plan.designs, "cases": plan.cases_per_design,
            "first": first_points(plan)[:5], "changes": plan.design_changes(point),
            "same": plan.again_is_the_same, "spread": plan.sampled_points(3),
            "job": next(plan.jobs(3, point, 1)).changes,
            "again": next(plan.jobs(3, point, 1, again=True)).changes,
        }  # fmt: skip
    said["keys"] = job_key(BASE, True) == job_key(BASE, False), len(job_key(BASE, True))
    said["defaults"] = Method()
    held(file_regression, said)


def test_checks_and_costs(file_regression, results, tmp_path):
    said: dict[str, Any] = {}
    here = Computer(4, 8e9, 5e9)
    for name in ("goals", "follow", "optimum", "robust"):
        plan = plan_of(name)
        store = Store.open_folder(tmp_path / name)
        store.adopt(plan)
        if name == "goals":
            result = results[name]
            with store.working(2):
                for job in result.jobs[:30]:
                    store.add_record(result.records[job.key])
        for kind, most, at in (("plain", 300, None), ("few", 4, store)):
            made = study_check(plan, most, at)
            parts = {one.name: getattr(made, one.name) for one in fields(made)}
            made = StudyCheck(**(parts | {"machine": here}))
            said[f"{name} {kind}"] = {
                "headline": made.headline(), "cautions": made.cautions(), "table": made.table(),
                "remarks": made.remarks(), "dict": made.to_dict(), "heading": made.heading(),
                "tasks": made.tasks, "workers": made.workers, "left": made.seconds_left,
            }  # fmt: skip
    big = StudyCheck(**(parts | {"machine": Computer(2, 1e6, 1e3), "cases": 900000}))
    said["big"] = big.headline(), big.cautions(), big.tasks, big.workers
    said["sizes"] = [size_text(x) for x in (10, 999_999, 1e6, 2.34e8, 1e9, 5.55e9)]
    plan, jobs = plan_of("goals"), results["goals"].jobs[:30]
    store = Store.open_folder(tmp_path / "cost")
    store.adopt(plan)
    store.add_batch(store.jobs(), jobs)
    with store.working(2):
        for k, job in enumerate(jobs):
            took = {"cpu_seconds": 2.0 + 0.1 * k, "seconds": 3.0 + 0.1 * (k % 4), "memory": k,
                    "worker": str(k % 2), "ended": 1e9 + k}  # fmt: skip
            store.add_record(replace(results["goals"].records[job.key], **took))
    costs = study_cost(plan, Store(tmp_path / "cost"))
    assert costs is not None
    said["cost"] = {one.name: getattr(costs, one.name) for one in fields(costs)
                    if one.name != "disk"}  # fmt: skip
    for job in jobs:
        place = tmp_path / "cost" / "fields.zarr" / job.key
        place.mkdir(parents=True)
        (place / "c0").write_bytes(bytes(4000))
    more = study_cost(plan, Store(tmp_path / "cost"))
    assert more is not None
    assert more.disk - costs.disk == pytest.approx(4000)
    said["repeats"] = [_repeats("a.x", paths) for paths in (["b.x", "a.x"], ["a.x", "a.y"])]
    said["no cost"] = study_cost(plan_of("follow"), Store(tmp_path / "follow"))
    said["blocks"] = [block_edges(n) for n in (0, 1, 5, 3000)]
    held(file_regression, said)


def test_surrogates_and_effects(file_regression, results):
    optimum, sobol, robust = (results[name] for name in ("optimum", "sobol", "robust"))
    points = np.array([[0.1, 0.2], [0.5, 0.5], [0.9, 0.8]])
    said: dict[str, Any] = {}
    for goal, surrogate in zip(optimum.plan.goals, optimum.surrogates(optimum.plan.goals),
                               strict=True):  # fmt: skip
        again = Surrogate.from_dict(surrogate.to_dict(), optimum.plan.dimensions)
        np.testing.assert_allclose(again.mean(points), surrogate.mean(points), rtol=1e-9)
        said[str(goal)] = {
            "said": surrogate.reliability, "mean": surrogate.mean(points),
            "predicted": surrogate.prediction(points), "quiet": surrogate.prediction(
                points, noise=False), "drawn": surrogate.joint_draws(points, np.eye(3)),
            "without": surrogate.means_without(points)[:2],
            "with": surrogate.with_point(points[0]).prediction(points)[1],
        }  # fmt: skip
    some = optimum.designs[:3]
    said["believed"] = optimum.goal_estimates(some, optimum.plan.goals)
    (law,) = robust.surrogates(robust.plan.goals)
    said["robust"] = law.mean(points[:, :1]), law.reliability
    dimensions = Range("a", 1.0, 2.0), Choice("b", ("x", "y", "z")), Choice("c", (1.0, 3.0))
    said["features"] = feature_columns(dimensions, np.array([[0.2, 0.1, 0.9], [1, 0.5, 0.0]]))
    made = effects(sobol, Goal("cof", "1"))
    said["effects"] = made, made.headline(), made.table(), made.heading(), made.heads
    on_runs = plan_of("morris")
    said["points"] = sampled_effect_points(on_runs)
    jobs = [job for k, p in enumerate(first_points(on_runs)) for job in on_runs.jobs(k, p, 0)]
    records = {}
    for job in jobs:
        one = made_up(on_runs, job)
        cof = 0.1 + 0.02 * job.point[0] - 0.05 * job.point[1]
        records[job.key] = Record(job.key, Ending.COMPUTED, numbers={"cof": cof}, law=one.law)
    result = StudyResult(on_runs, jobs, records)
    morris = effects(result, Goal("cof", "1"))
    said["morris"] = morris, morris.headline(), morris.table()
    lost = StudyResult(on_runs, jobs, dict(list(records.items())[:-1]))
    said["lost"] = refusal(effects, lost, Goal("cof", "1"))
    few = read_plan(PLANS["morris"].replace("15", "5"), HERE, base=BASE)
    said["few"] = refusal(sampled_effect_points, few)
    empty = StudyResult(optimum.plan, [], {})
    said["none"] = refusal(empty.surrogates, optimum.plan.goals)
    said["empty"] = empty.headline(), empty.cautions(), empty.table(), empty.usable
    held(file_regression, said)
    assert fit_surrogate is not None


def test_readings_and_their_posterior(file_regression, results, tmp_path):
    result = results["readings"]
    plan = result.plan
    goals = [Goal(one.output, one.unit, within=state.parts)
             for one, state in zip(plan.readings, plan.states, strict=True)]  # fmt: skip
    models = result.surrogates(goals)
    places = np.array([[0.2, 0.5], [0.9, 0.1], [0.5, 1.2], [0.5, 0.999]])
    rng = np.random.default_rng(2)
    prior, draws = rng.uniform(50, 70, (200, 1)), rng.normal(60, 2, (200, 1))
    levels = np.array([[0.10, 0.12, 0.14], [20.0, 25.0, 30.0]])
    readings = [("slow", 0.12, 0.01, "1"), ("fast", 90.0, 2.0, "N")]
    made = Posterior("a", ("shoe.material.shore_a",), draws, prior, np.abs(draws[:, 0] - 60) / 50,
                     readings, levels, levels, 30.0, models, [("slow", "fast")])  # fmt: skip
    short = Posterior("a", made.paths, draws + 90, prior, made.discrepancy, readings, levels,
                      levels, 19.9, models)  # fmt: skip
    made.write(tmp_path / "draws.csv")
    again = read_joint_draws(tmp_path / "draws.csv")
    np.testing.assert_allclose(again.values, draws, rtol=1e-9)
    said = {
        "density": _log_density(places, models, plan.readings),
        "half": _half_normal(np.array([0.0, 0.5, 1.0])),
        "said": (made.usable, made.headline(), made.cautions(), made.table(), made.tables(),
                 made.remarks()),
        "short": (short.usable, short.headline(), short.cautions()),
        "rows": again.rows(2), "names": again.paths,
        "none": refusal(posterior, Study(plan_of("grid"), tmp_path / "none")).partition(": is")[2],
    }  # fmt: skip
    held(file_regression, said)


@pytest.mark.parametrize(
    ("jobs", "count", "taken"),
    [("abc", 2, 2), ("abc", 4, 3), ("abc", 0, 0), (("a", None, "b"), 3, 1), ("", 2, 0)],
)
def test_so_many_jobs_are_taken_as_there_is_room_for(jobs, count, taken):
    there: Any = iter(jobs)
    assert _next(there, count) == list(jobs)[:taken]


def test_stores_and_what_their_status_says(file_regression, results, tmp_path):
    plan, result = results["goals"].plan, results["goals"]
    study = Study(plan, tmp_path / "study")
    Store.open_folder(study.store.folder).adopt(plan)
    with study.store.working(3):
        for job in result.jobs[:20]:
            study.store.add_record(result.records[job.key])
    scan = scan_cases(study.store.records(), ["cof", "mass"], draws=True)
    jobs = list(result.jobs)
    sessions = [{"began": 10.0, "ended": None, "workers": 2},
                {"began": 0.0, "ended": 60.0, "workers": 1}]  # fmt: skip
    records = study.store.records()
    said: dict[str, Any] = {
        "scan": (scan.case, scan.outputs, scan.errors, scan.draws, scan.every, scan.programs),
        "plain": scan_cases(records).outputs, "repr": repr(study).split(" in ")[0],
    }  # fmt: skip
    for name, now, some in (("now", 130.0, sessions), ("late", 130.0, sessions[1:]),
                            ("back", 5.0, sessions), ("nobody", 130.0, [])):  # fmt: skip
        status = StudyStatus(plan, jobs, records, some, now=now)
        said[name] = {
            "headline": status.headline(), "cautions": status.cautions(), "table": status.table(),
            "remarks": status.remarks(), "lost": status.lost_text, "working": status.working,
            "numbers": (status.case_seconds, status.worker_seconds, status.busy,
                        status.per_minute, status.cases_left, status.seconds_left,
                        status.clock_went_back, status.programs),
            "dict": {k: v for k, v in status.to_dict().items() if k != "designs"},
        }  # fmt: skip
    assert study_status(study).working == 0
    line = made_up(plan, jobs[0]).line((5, 5, 7))
    said["line"] = line, draws_place(line.encode()), jobs[0].line()
    same = CaseJob.from_line(jobs[0].line())
    assert same.key == jobs[0].key
    assert same.point == jobs[0].point
    study.store.write_views(result.cases())
    said["csv"] = (study.store.folder / "results.csv").read_text(encoding="utf-8")[:1500]
    held(file_regression, said)


def test_cases_are_computed_and_designs_exported(file_regression, tmp_path):
    base = pad(DRY, {"numerics.grid_spacing": "4 mm"})
    text = '[vary]\n"shoe.material.shore_a" = [50, 70]\n"motion.normal_force" = ["50 N", "9 kN"]\n'
    study = Study(read_plan(text, HERE, base=base), tmp_path / "study")
    result = study.run(workers=1)
    records = [result.records[job.key] for job in result.jobs]
    names = export_designs(study, tmp_path / "out", count=1, step=False)
    job = result.jobs[0]
    moved = compute_job(base.replace("motion.speed", "0.2 m/s"), job)
    said = {
        "records": [(one.ending, one.reason, one.numbers, one.spreads, one.errors, one.units,
                     one.law, one.draws, one.breaches) for one in records],
        "headline": result.headline(), "table": result.table(), "names": names,
        "files": sorted(path.name for path in (tmp_path / "out").iterdir()),
        "case": (tmp_path / "out" / "design_0.toml").read_text(encoding="utf-8"),
        "moved": (moved.ending, moved.reason), "crashed": crash_record(job).reason,
        "no file": status_bytes("/no such file", "a"),
        "engine": refusal(engine, "cluster", 1, print), "workers": engine(None, 3, print)[1],
        "pool": engine("pool", 2, print)[1],
    }  # fmt: skip
    sole = sweep(base, {"shoe.material.shore_a": [50.0, 60.0]}, workers=1)
    said["sweep"] = sole
    said["bad sweep"] = refusal(sweep, base, {"shoe.material.shore": [50.0, 60.0]})
    said["bad optimum"] = refusal(optimise, base, {"shoe.material.shore_a": (50.0, 60.0)})
    held(file_regression, said)


STATE = (
    Condition(("oil", "0 mm"), {"contaminant": "canola_oil", "shoe.wear.depth": 0.0}),
    Condition(("oil", "1 mm"), {"contaminant": "canola_oil", "shoe.wear.depth": 1e-3}),
    Condition(("water, hot", "0 mm"), {"contaminant": "water", "shoe.wear.depth": 0.0}),
    Condition(("water, hot", "1 mm"), {"contaminant": "water", "shoe.wear.depth": 1e-3}),
)
GOALS = (
    "cof", "min(cof)", "max(cof) over conditions", "sd(cof) over draws", "quantile(cof, 0.1)",
    "quantile(cof, 25 %) in oil over conditions", "mean(fluid_load) in water, hot",
    "min(mass) in oil, 0 mm", "wear_life(cof > 0.12)", "wear_life(min(cof) > 0.12) in oil",
    "wear_life(cof > 0.12 in water, hot)", "wear_life(cof < 0.2)",
)  # fmt: skip
BAD_GOALS = (
    3, "", "cof >", "median(cof)", "cog", "quantile(cof)", "quantile(cof, 1)", "quantile(cof, 0)",
    "min(cof, 0.1)", "cof over tests", "cof in ice", "cof in oil, water, hot", "wear_life",
    "wear_life(cof)",
)  # fmt: skip
BOUNDS = ("cof > 0.16", "fluid_load <= 40 N in oil", "sd(cof) < 0.02", "min(cof) >= 0.1 over draws")
BAD_BOUNDS = ("cof", "cof > ", "cof > 3 N", "wear_life(cof > 0.1) > 1 mm", "sd(cof) < 3 %")


def test_goals(file_regression):
    rng = np.random.default_rng(4)
    records = {
        (state, draw): Record(
            "k", Ending.COMPUTED if (state, draw) != (3, 2) else Ending.FAILED,
            numbers={"cof": 0.16 - 0.05 * (state % 2) - 0.01 * draw, "fluid_load": 3.0 + state,
                     "mass": 0.1}, errors={"cof": 0.01 * (1 + state)},
            draws=0.12 + 0.02 * rng.random(4) if draw else np.empty(0),
        )
        for state in range(4) for draw in range(3)
    }  # fmt: skip
    whole = {place: one for place, one in records.items() if place[1] < 2}
    require = [read_requirement(text, UNITS, STATE) for text in BOUNDS]
    said: dict[str, Any] = {}
    for text in GOALS:
        goal = read_goal(text, UNITS, STATE, require)
        said[text] = (str(goal), goal.phrase, goal.of_draws, goal.value(whole, STATE),
                      goal.value(records, STATE), goal.error(whole, STATE), goal)  # fmt: skip
        if isinstance(goal, Goal):
            said[f"{text}: numbers"] = goal.numbers(STATE, 3)
    said["life of the first"] = str(read_goal("wear_life", UNITS, STATE, require))
    said["bad"] = {repr(text): refusal(read_goal, text, UNITS, STATE) for text in BAD_GOALS}
    for one in require:
        said[str(one)] = one, one.margin(0.15), one.margin(np.array([0.1, 50.0]))
    said["bad bounds"] = [refusal(read_requirement, text, UNITS, STATE) for text in BAD_BOUNDS]
    said["no wear"] = refusal(read_goal, "wear_life(cof > 0.1) in 0 mm", UNITS, STATE)
    twice = (*STATE, Condition(("ice", "oil"), {}))
    said["twice"] = refusal(
        read_goal, "cof in oil", UNITS, (*twice[:1], Condition(("a", "oil"), {}))
    )
    pairs = {
        "bounds": ("cof > 0.2", "cof < 0.2"), "open": ("cof > 0.2", "cof < 0.21"),
        "least": ("min(cof) > 0.2", "cof < 0.2"), "most": ("cof > 0.2", "max(cof) < 0.1"),
        "free": ("max(cof) > 0.2", "cof < 0.1"), "spread": ("sd(cof) > 0.2", "cof < 0.1"),
        "other": ("cof > 0.2 in oil", "cof < 0.1"), "load": ("cof > 0.2", "mass < 0.1 kg"),
    }  # fmt: skip
    for name, both in pairs.items():
        read = [read_requirement(text, UNITS, STATE) for text in both]
        try:
            check_agreement(read)
            said[f"agree {name}"] = True
        except Exception as error:  # which pairs do is what is held
            said[f"agree {name}"] = str(error)
    said["outputs"] = [output_array(records, [0, 3], "cof", law=way) for way in (True, False)]
    assert isinstance(read_goal(GOALS[8], UNITS, STATE), WearLife)
    assert isinstance(require[0], Requirement)
    held(file_regression, said)


def test_inputs(file_regression, tmp_path):
    known = Catalogue.load()
    depth, speed, shore = "shoe.tread.depth", "motion.speed", "shoe.material.shore_a"
    ranges = [Range("a", 1.0, 3.0, steps=3), Range("a", 1.0, 100.0, True)]
    said: dict[str, Any] = {
        "ranges": [[one.value(s) for s in (0.0, 0.5, 1.0)] + one.shares() for one in ranges],
        "choice": [Choice("a", ("x", "y")).value(s) for s in (0.0, 0.49, 0.5, 1.0)],
        "shares": Choice("a", ("x", "y")).shares(),
        "draws": [[one.value(s) for s in (0.0, 0.025, 0.5, 1.0)] for one in (
            Distribution("a", "uniform", 1.0, 2.0), Distribution("a", "normal", 1.0, 0.5, 0.2),
            Distribution("a", "lognormal", 2.0, 1.3, high=2.5))],
        "joint": JointDraws(("a", "b"), np.arange(12.0).reshape(6, 2)).rows(3),
        "texts": [value_text(depth, 2e-3), value_text(shore, 55.0), value_text("a.b", "x")],
        "flat": list(flat_paths({"a": {"b": {"c": 1}, "d": {"from": 1, "to": 2}}, "e.f": 3,
                                 "g": {}})),
    }  # fmt: skip
    for path, given in (
        (depth, {"from": "1 mm", "to": "4 mm"}),
        (speed, {"from": "0.1 m/s", "to": "1 m/s", "log": True, "steps": 3}),
        (shore, [50, 60]),
        ("contaminant", ["canola_oil", "none"]),
        ("shoe.tread.pattern", ["bars", "grid"]),
        (depth, {"times": 2, "of": "a"}),
        (depth, {"of": "a"}),
        (depth, 3),
        (depth, {"from": "1 mm"}),
        (depth, {"times": 2}),
        (depth, {"times": 0, "of": "a"}),
        (depth, {"from": "1 mm", "to": "2 mm", "step": 2}),
        (depth, {"from": "2 mm", "to": "2 mm"}),
        (depth, {"from": "1 mm", "to": "2 mm", "log": 1}),
        (depth, {"from": "1 mm", "to": "2 mm", "steps": 1}),
        (depth, {"from": "1 mm", "to": "2 mm", "steps": True}),
        (depth, {"from": "1 s", "to": "2 mm"}),
        (depth, {"from": "-1 mm", "to": "2 mm"}),
        ("motion.shoe_angle", {"from": "0 deg", "to": "5 deg", "log": True}),
        ("shoe.tread.pattern", {"from": "a", "to": "b"}),
        (shore, []),
        (shore, [50, 50]),
        ("shoe.tread.dept", [1]),
        ("contaminant", ["milk"]),
        ("shoe.tread.pattern", ["dots"]),
    ):
        said[f"vary {path} {given}"] = tried(read_input, path, given, known)
    for path, given in (
        (speed, {"normal": "0.3 m/s", "sd": "0.05 m/s"}),
        (speed, {"lognormal": "0.3 m/s", "factor": 1.3}),
        (speed, {"from": "0.1 m/s", "to": "0.2 m/s"}),
        (shore, {"normal": 60, "sd": "5 %"}),
        (speed, {"normal": "0.3 m/s"}),
        (speed, 3),
        (speed, {"lognormal": "0.3 m/s", "sd": 2}),
        (speed, {"lognormal": "0.3 m/s", "factor": 1.0}),
        (speed, {"from": "0.2 m/s", "to": "0.2 m/s"}),
        (speed, {"lognormal": "0.3 m/s", "factor": 1e7}),
        (speed, {"normal": "0.1 m/s", "sd": "0.2 m/s"}),
        ("motion.shoe_angle", {"lognormal": "-1 deg", "factor": 1.2}),
        ("shoe.tread.pattern", {"normal": "bars", "sd": "bars"}),
    ):
        said[f"uncertain {path} {given}"] = tried(read_distribution, path, given, known)
    said["choices"] = read_choice(shore, (50, 60.5), known)
    said["value"] = value_at("floor", "vinyl_g4", known), refusal(value_at, "floor", 3, known)
    why = refusal(read_joint_draws, tmp_path / "draws.csv")
    said["no file"] = why.replace(str(tmp_path), "FOLDER")
    held(file_regression, said)


BAD = {
    "nothing": "", "section": "[varied]\na = 1", "syntax": "[[", "version": "file_version = 9",
    "no path": '[vary]\n"shoe.tread.dept" = [1, 2]', "method": SWEEP + "[method]\nkind = 'fast'",
    "count": SWEEP + "[method]\ndesign = 'grid'\nbudget = 3",
    "budget": PLANS["optimum"].replace("= 12", "= 0"),
    "no goal": SWEEP + '[method]\nkind = "optimise"\nbudget = 9',
    "certain": SWEEP + '[outputs]\nmaximise=["cof"]\n[method]\nkind = "robust"\nbudget = 9',
    "goal": SWEEP + '[outputs]\nmaximise = ["cog"]', "outputs": SWEEP + "[outputs]\nbest = 1",
    "twice": SWEEP + '[conditions]\n"shoe.material.shore_a" = [50]',
    "follows": '[vary]\n"shoe.tread.depth" = {times = 2, of = "shoe.tread.width"}',
    "one number": SWEEP + '[outputs]\nmaximise = ["min(mass)"]\n[set]\n'
    '"shoe.material.density" = "1150 kg/m^3"',
    "many": SWEEP.replace("steps = 3", "steps = 900000"),
    "reading": PLANS["readings"].replace("sd = 0.01", ""),
    "reading of": PLANS["readings"].replace("cof = 0.12", "cog = 0.12"),
    "condition": SWEEP + "[conditions]\nwear = []", "agree": SWEEP
    + '[outputs]\nrequire = ["cof > 0.2", "cof < 0.1"]',
    "set": SWEEP + '[set]\n"motion.speed" = "3 kg"',
    "uncertain": SWEEP + '[uncertain]\n"motion.speed" = 3', "no budget": PLANS["sobol"].replace(
        "budget = 16", ""),
}  # fmt: skip


def test_study_files_that_are_refused(file_regression, tmp_path):
    said = {name: refusal(read_plan, text, HERE, base=BASE) for name, text in BAD.items()}
    said["base"] = refusal(read_plan, 'base = "no such.toml"\n' + SWEEP, tmp_path)
    said["no base"] = refusal(read_plan, SWEEP, tmp_path)
    said = {name: text.replace(str(tmp_path), "FOLDER") for name, text in said.items()}
    held(file_regression, said)
    assert math.isnan(Record("k", Ending.OPEN).number("cof"))
    assert isinstance(BASE, Case)
    assert issubclass(DataError, Exception)
