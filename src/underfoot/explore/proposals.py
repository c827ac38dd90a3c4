"""Which designs a study runs next, as its method says; a function of what is finished alone.

A batch is proposed when the one before has ended, so that the same study proposes the same designs
whichever machine computes them in whatever order. An optimisation begins with designs spread
evenly, and then takes those of a genetic algorithm's front on the surrogates (NSGA-II; Deb et al.
2002) that promise the largest growth of the hypervolume, requirements met (Emmerich, Giannakoglou
and Naujoks 2006). The front that grows is not that of the runs as they came out, which the luckiest
would lead, but is drawn with the candidates from what the surrogates believe of the designs run
(Daulton, Balandat and Bakshy 2021). At the end the best designs and the case where the study starts
are run again on new positions of the tread and, by default, the standard grid.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from scipy.stats import qmc

from underfoot.core import DataError
from underfoot.core.arrays import Array, Mask
from underfoot.core.optional import optional_module
from underfoot.core.threads import threads_limited

from .effects import sampled_effect_points
from .goals import Goal
from .plan import StudyPlan
from .record import CaseJob
from .result import StudyResult
from .surrogate import FEWEST, Surrogate, feature_columns

FIRST = 0.4
"""Share of an optimisation's designs that are spread evenly first."""
POPULATION, GENERATIONS = 60, 50
SAMPLES = 64
"""Draws of the goals at a candidate, by which its growth of the hypervolume is averaged."""
CANDIDATES = 80
"""Designs of a batch are chosen among so many of the surrogates' front ..."""
NEAR = 0.1
"""... as many near these, by this deviation in shares of every range, ..."""
SPREAD = 32
"""... and so many spread evenly, where the front is a point or the surrogates know little."""
SAME = 1e-3
"""Designs that lie nearer than this share of every range are one."""
BEYOND = 0.1
"""The hypervolume's reference lies this share of the goals' range beyond the worst of them."""


@threads_limited(1)
def next_batch(plan: StudyPlan, so_far: StudyResult) -> Iterable[CaseJob]:
    """Return the jobs of the next batch; none where the study is done."""
    if not so_far.jobs:
        return _jobs(plan, first_points(plan), 0, 0)
    last = so_far.jobs[-1]
    batch, count = last.batch + 1, last.design + 1
    left = min(plan.designs - len(so_far.designs), plan.method.batch)
    if left <= 0 and (not last.point or last.quick != plan.method.quick):
        return []  # the best designs and the start were the last
    try:
        if left > 0 and plan.method.kind in ("optimise", "robust"):
            return _jobs(plan, _promising(so_far, left), count, batch)
        if left > 0 and plan.method.kind == "sweep" and plan.method.active:
            return _jobs(plan, _least_known(so_far, left), count, batch)
    except DataError:  # too few usable runs for a surrogate: spread more of them
        return _jobs(plan, plan.sampled_points(count + left)[count:], count, batch)
    best = so_far.best(plan.method.again) if plan.goals and plan.method.again_on else []
    done = {design.number for design in so_far.again}  # of an optimisation that got a larger budget
    points = {design.number: design.point for design in best if design.number not in done}
    points |= {count: ()} if best else {}
    return [job for k, place in points.items() for job in plan.jobs(k, place, batch, again=True)]


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
) -> Iterator[CaseJob]:
    for number, point in enumerate(points, start=first):
        yield from plan.jobs(number, point, batch)


def _least_known(so_far: StudyResult, count: int) -> list[tuple[float, ...]]:
    """Return the places where the surrogate of the first goal (or COF) is least sure."""
    plan = so_far.plan
    (surrogate,) = so_far.surrogates([*plan.goals, Goal("cof", "1")][:1])
    candidates = qmc.Sobol(len(plan.dimensions), rng=plan.method.seed + 1).random(1024)
    chosen = []
    for _ in range(count):
        point = candidates[int(np.argmax(surrogate.prediction(candidates, noise=False)[1]))]
        surrogate = surrogate.with_point(point)
        chosen.append(tuple(map(float, point)))
    return chosen


def _promising(so_far: StudyResult, count: int) -> list[tuple[float, ...]]:
    """Return the designs that promise the largest growth of the hypervolume, one after another.

    Its mean over joint draws of every goal and requirement at the designs run, those chosen before
    and a candidate; in each draw the front that grows is that of the draw.
    """
    plan, signs = so_far.plan, so_far.plan.signs
    goals = so_far.surrogates(plan.goals)
    bounds = so_far.surrogates([each.goal for each in plan.require])
    generator = np.random.default_rng([plan.method.seed, len(so_far.designs)])
    spread = qmc.Sobol(len(plan.dimensions), rng=generator).random(SPREAD)
    optimum = np.array(_surrogate_front(plan, goals, bounds, len(so_far.designs))[:CANDIDATES])
    near = optimum + NEAR * generator.standard_normal(optimum.shape)
    candidates = np.vstack([optimum, np.clip(near, 0.0, 1.0), spread])
    for design in so_far.designs:
        candidates = candidates[_apart(plan, candidates, design.point)]
    run = np.array([design.point for design in so_far.designs if design.usable])
    places, known = np.vstack([run, candidates]), len(run)
    normal = generator.standard_normal((len(goals) + len(bounds), SAMPLES, len(places)))
    drawn = [
        surrogate.joint_draws(places, z)
        for surrogate, z in zip([*goals, *bounds], normal, strict=True)
    ]
    values = np.stack(drawn[: len(goals)], axis=-1) * signs
    met = np.ones(values.shape[:2], dtype=bool)
    for requirement, each in zip(plan.require, drawn[len(goals) :], strict=True):
        met &= np.asarray(requirement.margin(each)) >= 0
    low, high = values[:, :known].min(axis=(0, 1)), values[:, :known].max(axis=(0, 1))
    scaled = (values - low) / np.where(high > low, high - low, 1.0)
    measure = optional_module("moocore", "study", "An optimisation").Hypervolume(
        ref=[1.0 + BEYOND] * len(signs)
    )
    fronts = [one[:known][ok[:known]] for one, ok in zip(scaled, met, strict=True)]
    chosen: list[tuple[float, ...]] = []
    left = np.arange(known, len(places))
    while len(chosen) < count and len(left):
        growth = np.zeros(len(left))
        for front, row, ok in zip(fronts, scaled, met, strict=True):
            volume = measure(front) if len(front) else 0.0
            growth += [ok[k] and measure(np.vstack([front, row[k]])) - volume for k in left]
        best = left[int(np.argmax(growth))]
        chosen.append(tuple(map(float, places[best])))
        fronts = [
            np.vstack([front, row[best]]) if ok[best] else front
            for front, row, ok in zip(fronts, scaled, met, strict=True)
        ]
        left = left[_apart(plan, places[left], chosen[-1])]
    return chosen


def _apart(plan: StudyPlan, points: Array, taken: Sequence[float]) -> Mask:
    """Return which places make another design than one that is taken."""
    own = feature_columns(plan.dimensions, np.array([taken]))
    return np.abs(feature_columns(plan.dimensions, points) - own).max(axis=1) > SAME


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
            means = [goal.mean(x) for goal in goals]
            out["F"] = np.column_stack(means) * plan.signs
            if bounds:
                margins = [
                    requirement.margin(surrogate.mean(x))
                    for requirement, surrogate in zip(plan.require, bounds, strict=True)
                ]
                out["G"] = -np.column_stack(margins)

    optimum = minimised(
        OnSurrogates(), nsga2.NSGA2(pop_size=POPULATION), ("n_gen", GENERATIONS), seed=seed
    )
    population = optimum.pop.get("X")
    front = population if optimum.X is None else np.vstack([np.atleast_2d(optimum.X), population])
    return list(dict.fromkeys(tuple(map(float, row)) for row in front))
