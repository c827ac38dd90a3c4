"""Which designs a study runs next, as its method says; a function of what is finished alone.

A batch is proposed when the one before has ended, so that the same study proposes the same designs
whichever machine computes them in whatever order.
"""

from __future__ import annotations

from collections.abc import Sequence

from .plan import StudyPlan
from .record import Job
from .result import StudyResult


def next_batch(plan: StudyPlan, so_far: StudyResult) -> list[Job]:
    """Return the jobs of the next batch; none where the study is done."""
    batch = max((job.batch for job in so_far.jobs), default=-1) + 1
    count = len({job.design for job in so_far.jobs})
    points: Sequence[Sequence[float]] = []
    if batch == 0:
        points = first_points(plan)
    return [
        job
        for number, point in enumerate(points, start=count)
        for job in plan.jobs(number, point, batch)
    ]


def first_points(plan: StudyPlan) -> list[tuple[float, ...]]:
    """Return the places of the first batch in the unit cube."""
    if plan.method.design == "grid":
        return plan.grid_points()
    return plan.sampled_points(plan.designs)
