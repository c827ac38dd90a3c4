"""Design studies: worker start, overhead a case, scaling, a killed Dask worker, surrogate, front.

Ratios within one run. The whole takes about 20 minutes of two quiet cores; parts by name:
``python -m benchmarks design_studies`` with UNDERFOOT_BENCH="overhead scaling".
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import psutil

from underfoot.compute.run import run
from underfoot.explore import Study, StudyResult
from underfoot.explore.computing import crash_record
from underfoot.explore.engines import engine
from underfoot.explore.plan import StudyPlan
from underfoot.explore.record import CaseJob, Record
from underfoot.explore.result import Design
from underfoot.explore.status import study_status
from underfoot.explore.study_file import read_plan
from underfoot.explore.surrogate import fit_surrogate

from .study_store import jobs, record

EXAMPLES = Path(__file__).parents[1] / "examples"
CASES = int(os.environ.get("UNDERFOOT_BENCH_CASES", "1000"))
SEEDS = int(os.environ.get("UNDERFOOT_BENCH_SEEDS", "3"))
WORKERS = int(os.environ.get("UNDERFOOT_BENCH_WORKERS", "100"))
SIDE = int(os.environ.get("UNDERFOOT_BENCH_SIDE", "15"))
QUICK = """
base = "work_shoe_untreaded_glycerol.toml"
[set]
"numerics.quick_grid_spacing" = "2 mm"
"numerics.grid_spacing" = "2 mm"
[vary]
"motion.speed" = { from = "0.3 m/s", to = "0.7 m/s" }
"shoe.material.shore_a" = { from = 50, to = 70 }
[method]
budget = %d
"""
FIVE = """
base = "work_shoe_full_tread_glycerol.toml"
[vary]
"shoe.tread.depth" = { from = "0.5 mm", to = "4 mm" }
"shoe.tread.lug_width" = { from = "3 mm", to = "8 mm" }
"shoe.tread.channel_width" = { from = "2.05 mm", to = "4 mm" }
"contaminant.viscosity" = { from = "50 cP", to = "300 cP" }
"shoe.material.shore_a" = { from = 50, to = 70 }
[outputs]
maximise = ["cof"]
minimise = ["fluid_load"]
[method]
kind = "sensitivity"
budget = 100
"""
SPLITS = """
base = "work_shoe_full_tread_glycerol.toml"
[set]
"numerics.quick_grid_spacing" = "1.25 mm"
"numerics.grid_spacing" = "1.25 mm"
"numerics.tread_positions" = 4
[vary]
"shoe.tread.depth" = { from = "1 mm", to = "4 mm" }
"shoe.tread.channel_width" = { from = "2.5 mm", to = "5 mm" }
"contaminant.viscosity" = { from = "50 cP", to = "300 cP" }
"shoe.material.shore_a" = { from = 50, to = 70 }
[outputs]
maximise = ["cof"]
minimise = ["fluid_load"]
[method]
kind = "sweep"
budget = 110
"""
FRONT = """
base = "work_shoe_full_tread_glycerol.toml"
[set]
"numerics.quick_grid_spacing" = "1.25 mm"
"numerics.grid_spacing" = "1.25 mm"
"numerics.tread_positions" = 2
[vary]
"shoe.tread.depth" = { from = "1 mm", to = "4 mm"%s }
"shoe.tread.channel_width" = { from = "2.5 mm", to = "5 mm"%s }
[outputs]
maximise = ["cof"]
minimise = ["rubber_volume"]
[method]
%s
"""
CLOG = """
base = "work_shoe_full_tread_detergent.toml"
[set]
contaminant = "canola_oil"
"numerics.quick_grid_spacing" = "1.25 mm"
"numerics.grid_spacing" = "1 mm"
[vary]
"shoe.tread.depth" = { from = "1.5 mm", to = "5 mm", steps = 4 }
"shoe.tread.lug_width" = { from = "4 mm", to = "9 mm", steps = 5 }
"shoe.tread.channel_width" = { from = "2.5 mm", to = "5 mm", steps = 5 }
[outputs]
maximise = ["cof"]
require = ["land > 0.4"]
[method]
%s
"""
EQUAL_LAND = """
base = "work_shoe_full_tread_detergent.toml"
[set]
contaminant = "canola_oil"
"numerics.quick_grid_spacing" = "1.25 mm"
"numerics.grid_spacing" = "1 mm"
"shoe.tread.depth" = "3 mm"
[vary]
"shoe.tread.pattern" = ["%s"]
"shoe.tread.channel_width" = { from = "2.5 mm", to = "5 mm" }
"shoe.tread.lug_width" = { times = %.4f, of = "shoe.tread.channel_width" }
%s
[outputs]
maximise = ["cof"]
[method]
kind = "optimise"
budget = 26
again = 3
"""
FAMILIES = {
    "bars": (1.5, {"angle": ("0 deg", "90 deg")}),
    "grid": (3.4365, {"angle": ("0 deg", "45 deg")}),
    "hexagons": (3.4365, {"angle": ("0 deg", "30 deg")}),
    "circles": (4.3596, {"angle": ("0 deg", "30 deg")}),
    "chevrons": (1.5, {"angle": ("-60 deg", "60 deg"), "arm_length": ("8 mm", "20 mm")}),
    "waves": (1.5, {"wave_length": ("12 mm", "30 mm"), "wave_height": ("2 mm", "8 mm")}),
}
"""Lug over channel at 60 % of land (``Tread.land_ratio``), and what else varies."""
TRUE = {"numerics.grid_spacing": "0.8 mm", "numerics.tread_positions": 16}
"""A finer grid and other positions than any of that study."""


def study(text: str, folder: str) -> Study:
    """Return a study of the examples in a folder."""
    return Study(read_plan(text, EXAMPLES), folder)


def numbers(result: StudyResult) -> dict[str, tuple[object, ...]]:
    """Return everything that a study computed, by key of the case."""
    return {
        key: (record.numbers, record.spreads, record.draws.tolist())
        for key, record in result.records.items()
    }


def ready() -> Iterator[str]:
    """Yield the CPU time until a worker is ready for its first case."""
    code = "import time, underfoot.explore.computing; print(time.process_time())"
    runs = [
        float(subprocess.run([sys.executable, "-c", code], capture_output=True, check=True).stdout)
        for _ in range(3)
    ]
    yield f"worker ready after {min(runs):.2f} s of CPU"


def overhead() -> Iterator[str]:
    """Yield CPU and time that a case costs beyond its bare solve, and how busy workers are."""
    plan = read_plan(QUICK % CASES, EXAMPLES)
    cases = [plan.base.replace(plan.design_changes(p)) for p in plan.sampled_points(24)]
    run(cases[0], quick=True)
    began = time.process_time()
    for case in cases:
        run(case, quick=True)
    bare = (time.process_time() - began) / len(cases)
    with tempfile.TemporaryDirectory() as folder:
        before = _cpu()
        began = time.monotonic()
        done = study(QUICK % CASES, folder)
        done.run(workers=2)
        spent, wall = (_cpu() - before) / CASES, time.monotonic() - began
        status = study_status(done)
    yield f"{CASES} cases on 2 workers: {wall:.0f} s, workers {status.busy:.1%} busy"
    yield f"CPU a case {spent:.3f} s, bare solve {bare:.3f} s: {spent / bare - 1:+.1%}"


def scaling() -> Iterator[str]:
    """Yield how much faster two workers are than one."""
    count, walls = max(CASES // 10, 12), []
    for workers in (1, 2):
        with tempfile.TemporaryDirectory() as folder:
            began = time.monotonic()
            # one worker as a process too: as `study work` on a machine of its own
            study(QUICK % count, folder).run(workers=workers)
            walls.append(time.monotonic() - began)
    one, two = walls
    yield f"{count} cases: {one:.1f} s on 1 core, {two:.1f} s on 2, {one / two:.2f} times as fast"


def dask() -> Iterator[str]:
    """Yield whether a cluster of 4 that loses a worker gives what one process gives."""
    count = min(CASES, 48)
    with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
        alone = numbers(study(QUICK % count, one).run(workers=1))
        threading.Thread(target=_kill_a_worker, args=(other,), daemon=True).start()
        cluster = numbers(study(QUICK % count, other).run(on="dask", workers=4))
    yield f"Dask, 4 workers, one killed: {len(cluster)} of {count}, equal {alone == cluster}"


def saturation() -> Iterator[str]:
    """Yield how many made-up cases a second 100 workers of a Dask cluster finish.

    Workers are threads that wait: scheduler, client and workers share one processor, so that this
    is what the scheduler and its client can do at least.
    """
    import distributed

    cluster = distributed.LocalCluster(
        n_workers=WORKERS,
        threads_per_worker=1,
        processes=False,
        memory_limit=0,
        dashboard_address=None,
    )
    with cluster:
        compute, _ = engine(f"dask:{cluster.scheduler_address}", None, print)
        for seconds, count in ((2.0, 400), (1.0, 600), (0.5, 800), (0.2, 800), (0.0, 800)):
            before, began = time.process_time(), time.monotonic()
            done = len(list(compute(partial(_waited, seconds), jobs(count), crash_record)))
            wall, spent = time.monotonic() - began, time.process_time() - before
            busy = f", workers {seconds * count / WORKERS / wall:.0%} busy" if seconds else ""
            rate = f"{done / wall:.0f} a second{busy}, {1e3 * spent / done:.1f} ms of CPU a case"
            yield f"Dask, {WORKERS} workers, cases of {seconds:g} s: {rate}"


def surrogate() -> Iterator[str]:
    """Yield the error of surrogates over five inputs."""
    with tempfile.TemporaryDirectory() as folder:
        result = study(FIVE, folder).run()
    for one in result.surrogates(result.plan.goals):
        yield f"{one.name}: {one.reliability}"


def splits() -> Iterator[str]:
    """Yield stated and held-out error over five splits of 110 runs of a tread, 60 fitted."""
    with tempfile.TemporaryDirectory() as folder:
        result = study(SPLITS, folder).run(workers=1)
        runs = [one.runs for one in result.surrogates(result.plan.goals)]
    for goal, every in zip(result.plan.goals, runs, strict=True):
        rows, forms = [], set[str]()
        for seed in range(5):
            order = np.random.default_rng(seed).permutation(len(every))
            fit, rest = every[order[:60]], every[order[60:]]
            own = fit.points, fit.values, fit.errors
            one = fit_surrogate(str(goal), goal.unit, result.plan.dimensions, *own)
            mean, deviation = one.prediction(rest.points)
            error = rest.values - mean
            q2 = 1 - np.mean(error**2) / np.var(rest.values)
            rows.append((one.q2, q2, np.mean(np.abs(error) < 1.96 * deviation)))
            forms.add(one.model.form)
        stated, held, within = np.mean(rows, axis=0)
        yield f"{goal}, 5 splits: Q2 stated {stated:.2f}, held out {held:.2f}, {within:.0%} inside"
        parts = ", ".join(f"{a:.2f} / {b:.2f} / {c:.0%}" for a, b, c in rows)
        yield f"  {' and '.join(sorted(forms))}: {parts}"


def front() -> Iterator[str]:
    """Yield the share of a brute-force grid's hypervolume that an optimisation finds."""
    import moocore

    with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
        steps = (f", steps = {SIDE}",) * 2
        every = study(FRONT % (*steps, 'design = "grid"'), one).run()
        method = f'kind = "optimise"\nbudget = {4 * SIDE}\nbatch = 6'
        found = study(FRONT % ("", "", method), other).run()
    brute, front = (r.goal_values(r.front) * r.plan.signs for r in (every, found))
    all_ = every.goal_values(every.designs) * every.plan.signs
    low, high = all_.min(axis=0), all_.max(axis=0)
    volumes = [
        moocore.hypervolume((each - low) / (high - low), ref=[1.1, 1.1]) for each in (brute, front)
    ]
    yield (
        f"front by {len(found.designs)} runs: {volumes[1] / volumes[0]:.1%} of the hypervolume of "
        f"a grid of {len(every.designs)}"
    )


def clog() -> Iterator[str]:
    """Yield what an optimisation of a clog's tread in oil finds beside a grid of equal cost.

    All are judged by a run at 16 positions of the tread on a finer grid.
    """

    def done(method: str) -> StudyResult:
        with tempfile.TemporaryDirectory() as folder:
            result = study(CLOG % method, folder).run(workers=1)
            return StudyResult(result.plan, list(result.jobs), dict(result.records))

    def judged(name: str, result: StudyResult, best: Design, stated: float) -> tuple[str, float]:
        cof = run(result.plan.base.replace({**best.changes, **TRUE})).value("cof")
        cost = sum(record.cpu_seconds for record in result.records.values())
        sizes = ", ".join(f"{1e3 * value:.2f}" for value in best.changes.values())
        text = f"{name}, {cost:.0f} s: depth, lug, channel {sizes} mm"
        return f"{text}: COF stated {stated:.4f}, is {cof:.4f}", cof

    grid = done('design = "grid"')
    allowed = [one for one in grid.designs if grid.meets_requirements([one])[0]]
    values = grid.goal_values(allowed)[:, 0]
    luckiest = int(np.argmax(values))
    text, most = judged("grid, best as run", grid, allowed[luckiest], values[luckiest])
    yield text
    believed = grid.best(1)[0]
    means, _ = grid.goal_estimates([believed], grid.plan.goals)
    yield judged("grid, best by surrogate", grid, believed, means[0, 0])[0]
    better = []
    for seed in range(SEEDS):
        found = done(f'kind = "optimise"\nbudget = 72\nseed = {seed}')
        best = found.best(1)[0]
        means, _ = found.goal_estimates([best], found.plan.goals)
        text, cof = judged(f"seed {seed}", found, best, means[0, 0])
        better.append(cof > most)
        yield text
        yield f"  {found.above_start()}"
    yield f"better than the best of the grid with {sum(better)} of {SEEDS} seeds"


def treads() -> Iterator[str]:
    """Yield the best of six families and the best free tread, at equal land, depth and runs.

    The free study (``examples/studies/free_tread.toml``) starts at the best of the families. Both
    are judged by a run at 16 positions of the tread on a finer grid, too.
    """
    best: tuple[float, StudyResult, Design] | None = None
    for name, (ratio, ranges) in FAMILIES.items():
        rows = [
            f'"shoe.tread.{key}" = {{ from = "{low}", to = "{high}" }}'
            for key, (low, high) in ranges.items()
        ]
        result = _best_tread(read_plan(EQUAL_LAND % (name, ratio, "\n".join(rows)), EXAMPLES))
        design = result.best(1)[0]
        value = result.goal_estimates([design], result.plan.goals)[0][0, 0]
        yield _told(name, result, design, value)
        if best is None or value > best[0]:
            best = value, result, design
    assert best is not None
    _, family, start = best
    text = (EXAMPLES / "studies" / "free_tread.toml").read_text()
    begin = family.plan.base.replace(start.changes)
    free = _best_tread(read_plan(text, EXAMPLES / "studies", base=begin))
    for design in free.best(3):
        yield _told("free", free, design, free.goal_estimates([design], free.plan.goals)[0][0, 0])
    chance = free.higher_cof(free.best(1)[0], start)
    yield f"the free tread has the higher COF in {100 * (chance or 0):.0f} of 100 draws"
    yield free.above_start()


def _best_tread(plan: StudyPlan) -> StudyResult:
    with tempfile.TemporaryDirectory() as folder:
        result = Study(plan, folder).run(workers=1)
        return StudyResult(result.plan, list(result.jobs), dict(result.records))


def _told(name: str, result: StudyResult, design: Design, stated: float) -> str:
    judged = run(result.plan.base.replace({**design.changes, **TRUE})).value("cof")
    cost = sum(record.cpu_seconds for record in result.records.values())
    lost = sum(not one.usable for one in result.designs)
    land = next(iter(design.records.values())).number("land")
    sizes = ", ".join(
        f"{key.split('.')[-1]} {value if isinstance(value, str) else f'{value:.4g}'}"
        for key, value in design.changes.items()
    )
    return (
        f"{name}, {cost:.0f} s, {lost} of {len(result.designs)} without numbers: COF stated "
        f"{stated:.4f}, is {judged:.4f}, land {land:.3f} ({sizes})"
    )


def _waited(seconds: float, job: CaseJob) -> Record:
    time.sleep(seconds)
    return record(job)


def _cpu() -> float:
    own, children = (
        resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    )
    return own.ru_utime + own.ru_stime + children.ru_utime + children.ru_stime


def _kill_a_worker(folder: str) -> None:
    """Kill one worker of the cluster once some cases are finished."""
    while len(list(Path(folder).glob("cases-*.jsonl"))) == 0:
        time.sleep(0.2)
    workers = [
        process
        for process in psutil.Process().children(recursive=True)
        if "spawn_main" in " ".join(process.cmdline())
    ]
    workers[0].kill()


PARTS = {
    each.__name__: each
    for each in (ready, overhead, scaling, dask, saturation, surrogate, splits, front, clog, treads)
}


def main() -> None:
    """Print every part."""
    for name in os.environ.get("UNDERFOOT_BENCH", " ".join(PARTS)).split():
        for line in PARTS[name]():
            print(line, flush=True)
