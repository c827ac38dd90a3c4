"""What a study takes, learned from the few of its cases that are finished."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path

import numpy as np
from scipy.special import stdtrit
from scipy.stats import qmc

from underfoot.core.arrays import AnyArray, Array

from .jobs import BatchJobs
from .plan import StudyPlan
from .proposals import first_points
from .record import CaseJob, Ending, Record
from .records import Records
from .result import StudyResult
from .store import Store
from .surrogate import feature_columns

FEWEST = 3
"""Finished cases from which on a cost is estimated."""
MOST = 500
"""Finished cases that an estimate reads, and places of the study that it is the mean of."""
SCATTER = 0.05
"""Standard deviation of the logarithm by which the speed of a processor changes in any case."""
RIDGES = np.geomspace(1e-2, 1e2, 13)
"""Among which the one is taken that predicts best what was left out."""


@dataclass(frozen=True, slots=True)
class StudyCost:
    """Means over the cases of a study.

    Attributes:
        cases: Finished ones that this rests on.
        cpu_seconds: Of a case; and low and high of its 95 % interval.
        seconds: Of a case by the clock, as it was in the finished ones.
        memory: Bytes of a worker at most; None where the system doesn't tell.
        disk: Bytes of a case, its maps and its row of results.csv with it.
        failures: Why finished cases have no numbers, and how many.
    """

    cases: int
    cpu_seconds: float
    interval: tuple[float, float]
    seconds: float
    memory: float | None
    disk: float
    failures: Mapping[str, int]


def spread_jobs(plan: StudyPlan, count: int) -> Iterator[CaseJob]:
    """Yield up to ``count`` jobs of the first batch, spread evenly over all that differs in it."""
    points = np.array(first_points(plan), dtype=float).reshape(-1, len(plan.dimensions))
    places = feature_columns(plan.dimensions, points)
    count = min(count, len(points) * plan.cases_per_design)
    wanted = qmc.Sobol(points.shape[1] + 2, rng=plan.method.seed).random_base2(12)
    taken = set[tuple[int, int, int]]()
    for row in wanted:
        if len(taken) == count:
            return
        away = np.abs(places - feature_columns(plan.dimensions, row[None, :-2])).sum(axis=1)
        state, draw = (
            int(share * size) for share, size in zip(row[-2:], _sizes(plan), strict=True)
        )
        design = int(np.argmin(away))
        if (design, state, draw) in taken:
            continue
        taken.add((design, state, draw))
        yield plan.job(design, points[design].tolist(), 0, state, draw)


def study_cost(plan: StudyPlan, store: Store, jobs: BatchJobs | None = None) -> StudyCost | None:
    """Return what the cases of a study take, from those in its folder; None from too few.

    ``jobs`` are those of the folder, where they are read already.

    The logarithm of the CPU time is linear in inputs and conditions, by a ridge regression whose
    weight is chosen by leaving one case out after the other; the mean is that over the study, so
    that it does not matter much in which order the cases were computed. The interval is that of the
    mean at the error of the left-out cases. The first case of a process, which loads the program
    and its tables, does not count.
    """
    records = store.records()
    some = _some(store.jobs() if jobs is None else jobs, records)
    if records and not some:  # timed alone
        some = list(takewhile(lambda job: job.key in records, spread_jobs(plan, MOST)))
    # the start has no place among the inputs
    some = [job for job in some if len(job.point) == len(plan.dimensions)]
    known = [(job, records[job.key]) for job in some if job.quick == plan.method.quick]
    failures = Counter(record.reason for _, record in known if record.ending is not Ending.COMPUTED)
    used = _steady([pair for pair in known if pair[1].cpu_seconds > 0])
    if len(used) < FEWEST:
        return None
    cpu = np.array([record.cpu_seconds for _, record in used])
    own = _features(plan, [job.point for job, _ in used], [job.condition for job, _ in used])
    points, generator = first_points(plan), np.random.default_rng(plan.method.seed)
    chosen = generator.choice(len(points), min(len(points), MOST), replace=False)
    states = np.tile(np.arange(len(plan.states)), len(chosen))
    rows = [points[k] for k in np.repeat(chosen, len(plan.states))]
    mean, error = mean_cost(own, cpu, _features(plan, rows, states))
    error = math.hypot(error, SCATTER)
    wide = float(np.exp(error * stdtrit(len(used) - 1, 0.975)))
    clock = sum(record.seconds for _, record in used) / cpu.sum()
    memory = max(record.memory for _, record in known) or None
    disk = _disk(plan, store, known, len(records))
    interval = mean / wide, mean * wide
    return StudyCost(len(used), mean, interval, mean * clock, memory, disk, dict(failures))


def mean_cost(rows: Array, costs: Array, planned: Array) -> tuple[float, float]:
    """Return the mean of a cost over what is planned, and the standard error of its logarithm.

    Parameters:
        rows: (n, m) features of what was measured.
        costs: (n,) what it took, above 0.
        planned: (k, m) features of all.
    """
    centre = planned.mean(axis=0)
    rows, planned, values = rows - centre, planned - centre, np.log(costs)
    design = np.column_stack([np.ones(len(rows)), rows])
    best = np.inf, np.zeros((design.shape[1], len(values)))
    for ridge in RIDGES:
        weight = ridge * np.eye(design.shape[1])
        weight[0, 0] = 0.0
        solved = np.linalg.solve(design.T @ design + weight, design.T)
        hat = design @ solved
        left_out = (values - hat @ values) / np.maximum(1.0 - np.diag(hat), 1e-9)
        best = min(best, (float(np.mean(left_out**2)), solved), key=lambda one: one[0])
    square, solved = best
    line = solved @ values
    believed = np.exp(design @ line)
    mean = np.exp(line[0] + planned @ line[1:]).mean() * costs.sum() / believed.sum()
    return float(mean), float(np.sqrt(square * np.sum(solved[0] ** 2)))


def _sizes(plan: StudyPlan) -> tuple[int, int]:
    return len(plan.states), len(plan.draws)


def _some(jobs: BatchJobs, records: Records) -> list[CaseJob]:
    """Return up to ``MOST`` finished jobs, evenly from first to last."""
    ended = [k for k, key in enumerate(jobs.keys) if key in records]
    places = np.linspace(0, len(ended) - 1, min(len(ended), MOST)).round().astype(int)
    return [jobs[ended[k]] for k in places.tolist()]


def _steady(pairs: Sequence[tuple[CaseJob, Record]]) -> Sequence[tuple[CaseJob, Record]]:
    """Return all but the first case of each process, where enough are left."""
    first: dict[str, float] = {}
    for _, record in pairs:
        first[record.worker] = min(record.ended, first.get(record.worker, record.ended))
    later = [pair for pair in pairs if pair[1].ended > first[pair[1].worker]]
    return later if len(later) >= max(FEWEST, len(pairs) // 2) else pairs


def _features(
    plan: StudyPlan, points: Sequence[Sequence[float]], states: Sequence[int] | AnyArray
) -> Array:
    inputs = feature_columns(plan.dimensions, np.array(points, dtype=float))
    conditions = np.equal.outer(np.asarray(states), np.arange(len(plan.states)))
    return np.column_stack([inputs, conditions])


def _disk(
    plan: StudyPlan, store: Store, known: Sequence[tuple[CaseJob, Record]], records: int
) -> float:
    """Return bytes of a case: its line and draws, its job, its row of the table, its maps."""
    sample = known[:: max(1, len(known) // 20)]
    files = [
        path for kind in ("cases-*", "draws-*", "packed-*") for path in store.folder.glob(kind)
    ]
    finished = sum(file.stat().st_size for file in files) / records
    jobs = [job for job, _ in sample]
    table = StudyResult(plan, jobs, store.known).cases().to_csv(index=False)
    lines = sum(len(job.line()) for job in jobs) + len(table)
    places = [store.folder / "fields.zarr" / job.key for job in jobs]
    maps = sum(_size(place) for place in places)
    return finished + (lines + maps) / len(sample)


def _size(folder: Path) -> int:
    return sum(os.path.getsize(path) for path in folder.rglob("*") if path.is_file())
