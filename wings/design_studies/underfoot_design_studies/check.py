"""A study before it runs: how many cases, what they cost, which of them can't be built."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from underfoot.compute.positions import run_cost
from underfoot.core import InputError
from underfoot.core.presentation import Presentable, Table
from underfoot.core.progress import time_text

from .plan import StudyPlan
from .proposals import first_points
from .result import value_text

MOST_BUILT = 300
"""Cases that are built to see which can't be; 0.03 s each."""


@dataclass(frozen=True, slots=True)
class StudyCheck(Presentable):
    """What a study will take.

    Attributes:
        designs, cases: At most, over the whole study.
        seconds: CPU seconds of all cases together, low and high.
        again, again_seconds: The same of the cases that are run again after those.
        built: Cases that were built.
        infeasible: Why cases can't be built: how many of those built.
    """

    kind: ClassVar[str] = "study_check"

    plan: StudyPlan
    designs: int
    cases: int
    seconds: tuple[float, float]
    again: int
    again_seconds: tuple[float, float]
    built: int
    infeasible: Mapping[str, int]

    def heading(self) -> str:
        """Return the name of the study."""
        return self.plan.name

    def headline(self) -> tuple[str, ...]:
        """Return the number of cases and their cost."""
        states, draws = len(self.plan.states), len(self.plan.draws)
        per = f" x {states} conditions" * (states > 1) + f" x {draws} draws" * (draws > 1)
        cost, more = (
            f"about {time_text(low)} to {time_text(high)} of one processor"
            for low, high in (self.seconds, self.again_seconds)
        )
        again = (
            f"The best {self.plan.method.again} and the start are then run again on the "
            f"{self.plan.method.again_on} grid: {self.again} cases at most, {more}."
        )
        bad = sum(self.infeasible.values())
        share = f"{bad} of {self.built} cases of the first designs can't be built"
        return (
            f"{self.designs} designs{per}: {self.cases} cases at most, {cost}.",
            *[again] * bool(self.again),
            f"{share[0].upper()}{share[1:]}."
            if bad
            else f"All {self.built} cases tried can be built.",
        )

    def cautions(self) -> tuple[str, ...]:
        """Return what reading the file decided."""
        return self.plan.remarks

    def table(self) -> Table:
        """Return what is varied, uncertain and asked for."""
        plan, rows = self.plan, []
        for one in plan.vary:
            ends = [value_text(one.path, one.value(share)) for share in (0.0, 1.0)]
            options = getattr(one, "options", None)
            listed = [value_text(one.path, option) for option in options or ()]
            rows.append(("vary", one.path, ", ".join(listed) or " to ".join(ends)))
        rows += [("follows", each.path, f"{each.times:g} x {each.of}") for each in plan.follow]
        for each in plan.uncertain:
            ends = [value_text(each.path, each.value(share)) for share in (0.025, 0.975)]
            rows.append(("uncertain", each.path, f"{' to '.join(ends)} (95 %)"))
        rows += [("condition", state.label, "") for state in plan.states if state.label]
        rows += [("maximise", str(goal), "") for goal in plan.maximise]
        rows += [("minimise", str(goal), "") for goal in plan.minimise]
        rows += [("require", str(each), "") for each in plan.require]
        return Table("Study", ("", "What", "Range"), rows)

    def remarks(self) -> Mapping[str, Sequence[str]]:
        """Return why cases can't be built, the most frequent reason first."""
        reasons = sorted(self.infeasible.items(), key=lambda one: -one[1])
        return {"Can't be built": [f"{count} x {reason}" for reason, count in reasons]}

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "designs": self.designs,
            "cases": self.cases,
            "cpu_seconds": list(self.seconds),
            "again": self.again,
            "again_cpu_seconds": list(self.again_seconds),
            "built": self.built,
            "infeasible": dict(self.infeasible),
        }


def study_check(plan: StudyPlan, most: int = MOST_BUILT) -> StudyCheck:
    """Return what a study will take; nothing is computed, about ``most`` cases are built."""
    designs, method = plan.designs, plan.method
    low, high = run_cost(plan.base, quick=method.quick).seconds
    cases = designs * plan.cases_per_design
    again, (least, most_again) = 0, (0.0, 0.0)
    if plan.goals and method.again_on:
        again = (min(method.again, designs) + 1) * plan.cases_per_design
        (job, *_) = plan.jobs(0, (), 0, again=True)
        least, most_again = run_cost(plan.base.replace(job.changes), quick=job.quick).seconds
    reasons: Counter[str] = Counter()
    built = 0
    points = first_points(plan)
    step = max(1, len(points) * plan.cases_per_design // most)
    for number, point in enumerate(points[::step]):
        for job in plan.jobs(number, point, 0):
            built += 1
            try:
                plan.base.replace(job.changes)
            except InputError as error:
                reasons[str(error)] += 1
    costs = (low * cases, high * cases), again, (least * again, most_again * again)
    return StudyCheck(plan, designs, cases, *costs, built, dict(reasons))
