"""Which designs a study runs next, as its method says; a function of what is finished alone.

A batch is proposed when the one before has ended, so that the same study proposes the same designs
whichever machine computes them in whatever order. An optimisation begins with designs spread
evenly, and then takes those of a genetic algorithm's front on the surrogates (NSGA-II; Deb et al.
2002) that promise the largest growth of the hypervolume (Emmerich, Giannakoglou and Naujoks 2006),
times the probability that every requirement holds. The front that grows is that of the surrogates'
means at the designs, not of the runs as they came out: a lucky run is no front.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from scipy.special import ndtr
from scipy.stats import qmc

from underfoot.core import DataError
from underfoot.core.arrays import Array
from underfoot.core.optional import optional_module
from underfoot.core.threads import threads_limited

from .effects import sampled_effect_points, surrogates
from .goals import Goal
from .plan import StudyPlan
from .record import Job
from .result import StudyResult
from .surrogate import FEWEST, Surrogate, featured

FIRST = 0.4
"""Share of an optimisation's designs that are spread evenly first."""
POPULATION, GENERATIONS = 60, 50
SAMPLES = 64
"""Draws of the goals at a candidate, by which its growth of the hypervolume is averaged."""
CANDIDATES = 80
"""Designs of a batch are chosen among so many of the surrogates' front ..."""
SPREAD = 32
"""... and so many spread evenly, where the front is a point or the surrogates know little."""
SAME = 1e-3
"""Designs that lie nearer than this share of every range are one."""
BEYOND = 0.1
"""The hypervolume's reference lies this share of the goals' range beyond the worst of them."""


@threads_limited(1)
def next_batch(plan: StudyPlan, so_far: StudyResult) -> Iterable[Job]:
    """Return the jobs of the next batch; none where the study is done."""
    if not so_far.jobs:
        return _jobs(plan, first_points(plan), 0, 0)
    last = so_far.jobs[-1]
    if last.quick != plan.method.quick:
        return []  # the front was the last
    batch, count = last.batch + 1, last.design + 1
    left = min(plan.designs - count, plan.method.batch)
    try:
        if left > 0 and plan.method.kind in ("optimise", "robust"):
            return _jobs(plan, _promising(so_far, left), count, batch)
        if left > 0 and plan.method.kind == "sweep" and plan.method.active:
            return _jobs(plan, _least_known(so_far, left), count, batch)
    except DataError:  # too few usable runs for a surrogate: spread more of them
        return _jobs(plan, plan.sampled_points(count + left)[count:], count, batch)
    if plan.method.front_grid not in (None, plan.method.grid):
        quick = plan.method.front_grid == "quick"
        front = so_far.front_of(so_far.designs)
        return [j for one in front for j in plan.jobs(one.number, one.point, batch, quick=quick)]
    return []


def first_points(plan: StudyPlan) -> list[tuple[float, ...]]:
    """Return the places of the first batch in the unit cube."""
    method = plan.method
    if method.design == "grid":
        return plan.grid_points()
    if method.kind == "sensitivity" and method.on == "runs":
        return sampled_effect_points(plan)
    count = plan.designs
    if method.kind in ("optimise", "robust"):
        least = FEWEST * len(plan.dimensions)
        count = min(count, max(least, round(FIRST * count)))
    elif method.kind == "sweep":
        count = round((1 - method.active) * count)
    return plan.sampled_points(count)


def _jobs(
    plan: StudyPlan, points: Sequence[Sequence[float]], first: int, batch: int
) -> Iterator[Job]:
    for number, point in enumerate(points, start=first):
        yield from plan.jobs(number, point, batch)


def _least_known(so_far: StudyResult, count: int) -> list[tuple[float, ...]]:
    """Return the places where the surrogate of the first goal (or COF) is least sure."""
    plan = so_far.plan
    (surrogate,) = surrogates(so_far, [*plan.goals, Goal("cof", "1")][:1])
    candidates = qmc.Sobol(len(plan.dimensions), rng=plan.method.seed + 1).random(1024)
    chosen = []
    for _ in range(count):
        point = candidates[int(np.argmax(surrogate.predicted(candidates)[1]))]
        surrogate = surrogate.with_point(point)
        chosen.append(tuple(map(float, point)))
    return chosen


def _promising(so_far: StudyResult, count: int) -> list[tuple[float, ...]]:
    """Return the designs that promise the largest growth of the hypervolume, one after another."""
    plan = so_far.plan
    goals = surrogates(so_far, plan.goals)
    bounds = surrogates(so_far, [each.goal for each in plan.require])
    known, signs = so_far.goal_values(so_far.designs) * plan.signs, plan.signs
    usable = np.isfinite(known).all(axis=1)
    low, high = known[usable].min(axis=0), known[usable].max(axis=0)
    span = np.where(high > low, high - low, 1.0)
    places = np.array([one.point for one in so_far.designs])
    believed = np.column_stack([one.mean(places) for one in goals]) * signs
    front = ((believed - low) / span)[so_far.allowed(so_far.designs)]
    measure = optional_module("moocore", "study", "An optimisation").Hypervolume(
        ref=[1.0 + BEYOND] * len(signs)
    )
    generator = np.random.default_rng([plan.method.seed, len(so_far.designs)])
    spread = qmc.Sobol(len(plan.dimensions), rng=generator).random(SPREAD)
    optimum = _surrogate_front(plan, goals, bounds, len(so_far.designs))[:CANDIDATES]
    candidates = np.vstack([optimum, spread])
    for one in so_far.designs:
        candidates = _apart(plan, candidates, one.point)
    chosen: list[tuple[float, ...]] = []
    while len(chosen) < count and len(candidates):
        holds = _probability_met(plan, bounds, candidates)
        predicted = [one.predicted(candidates) for one in goals]
        mean = np.array([m for m, _ in predicted]).T * signs
        deviation = np.array([d for _, d in predicted]).T
        normal = generator.standard_normal((SAMPLES, 1, len(signs)))
        drawn = (mean + deviation * normal - low) / span
        volume = measure(front) if len(front) else 0.0
        growth = np.array(
            [
                np.mean([measure(np.vstack([front, draw])) for draw in drawn[:, k]]) - volume
                for k in range(len(candidates))
            ]
        )
        best = int(np.argmax(growth * holds))
        chosen.append(tuple(map(float, candidates[best])))
        goals = [one.with_point(candidates[best]) for one in goals]
        front = np.vstack([front, (mean[best] - low) / span])
        candidates = _apart(plan, candidates, chosen[-1])
    return chosen


def _apart(plan: StudyPlan, points: Array, taken: Sequence[float]) -> Array:
    """Return the places that make another design than one that is taken."""
    own = featured(plan.dimensions, np.array([taken]))
    return points[np.abs(featured(plan.dimensions, points) - own).max(axis=1) > SAME]


def _probability_met(plan: StudyPlan, bounds: Sequence[Surrogate], points: Array) -> Array:
    """Return (n,) the probability that every requirement holds, taken as independent."""
    holds = np.ones(len(points))
    for requirement, surrogate in zip(plan.require, bounds, strict=True):
        mean, deviation = surrogate.predicted(points)
        holds *= ndtr(requirement.margin(mean) / np.maximum(deviation, 1e-12))
    return holds


def _surrogate_front(
    plan: StudyPlan, goals: Sequence[Surrogate], bounds: Sequence[Surrogate], seed: int
) -> list[Any]:
    """Return the front of the surrogates' means, by NSGA-II, followed by its last population.

    With one goal the population alone.
    """
    nsga2 = optional_module("pymoo.algorithms.moo.nsga2", "study", "An optimisation")
    problems = optional_module("pymoo.core.problem", "study", "An optimisation")
    minimised = optional_module("pymoo.optimize", "study", "An optimisation").minimize

    class OnSurrogates(problems.Problem):
        def __init__(self) -> None:
            size = len(plan.dimensions)
            super().__init__(n_var=size, n_obj=len(goals), n_ieq_constr=len(bounds), xl=0.0, xu=1.0)

        def _evaluate(self, x: Array, out: dict[str, Any], *_: Any, **__: Any) -> None:
            means = [one.mean(x) for one in goals]
            out["F"] = np.column_stack(means) * plan.signs
            if bounds:
                margins = [
                    one.margin(surrogate.mean(x))
                    for one, surrogate in zip(plan.require, bounds, strict=True)
                ]
                out["G"] = -np.column_stack(margins)

    optimum = minimised(
        OnSurrogates(), nsga2.NSGA2(pop_size=POPULATION), ("n_gen", GENERATIONS), seed=seed
    )
    population = optimum.pop.get("X")
    front = population if optimum.X is None else np.vstack([np.atleast_2d(optimum.X), population])
    return list(dict.fromkeys(tuple(map(float, row)) for row in front))
