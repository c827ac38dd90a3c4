"""How much of an output comes from each input of a study: Morris and Sobol, with confidence.

Morris: mean absolute elementary effect mu* and their deviation sigma (Morris 1991; Campolongo,
Cariboni and Saltelli 2007). Sobol: share of the variance by an input alone, S1, and with all its
interactions, ST (Saltelli et al. 2010). Computed by SALib; intervals by its bootstrap, 95 %.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from underfoot.core import DataError
from underfoot.core.arrays import Array
from underfoot.core.optional import optional_module
from underfoot.core.presentation import Presentable, Table

from .goals import AnyGoal
from .plan import StudyPlan
from .result import StudyResult
from .surrogate import Surrogate, fitted

ON_SURROGATE = 1024
"""Base sample of Sobol's indices on a surrogate; runs x (inputs + 2)."""
LEVELS = 4
"""Levels of Morris' trajectories."""


@dataclass(frozen=True, slots=True)
class Effects(Presentable):
    """Indices of one output, an input a row.

    Attributes:
        main, main_half: S1 (Sobol) or sigma (Morris, in the output's unit) and half its interval.
        total, total_half: ST or mu*.
        basis: What they were computed on, with its error.
    """

    kind: ClassVar[str] = "effects"

    output: str
    unit: str
    analysis: str
    paths: tuple[str, ...]
    main: Array
    main_half: Array
    total: Array
    total_half: Array
    basis: str

    @property
    def heads(self) -> tuple[str, str]:
        """Names of both indices."""
        return ("S1", "ST") if self.analysis == "sobol" else ("sigma", "mu*")

    def heading(self) -> str:
        """Return what it is about."""
        return f"{self.output}: where it comes from"

    def headline(self) -> tuple[str, ...]:
        """Return the most effective input and the basis."""
        first = int(np.argmax(self.total))
        value = f"{self.total[first]:.3g} ± {self.total_half[first]:.2g}"
        return (
            f"{self.output} depends most on {self.paths[first]} ({self.heads[1]} {value}).",
            f"On {self.basis}.",
        )

    def table(self) -> Table:
        """Return both indices of each input, the most effective first."""
        order = np.argsort(-self.total, kind="stable")
        rows = [
            (
                self.paths[k],
                f"{self.total[k]:.3g} ± {self.total_half[k]:.2g}",
                f"{self.main[k]:.3g} ± {self.main_half[k]:.2g}",
            )
            for k in order
        ]
        title = f"{self.output}: {self.analysis.capitalize()} indices, 95 %, on {self.basis}"
        return Table(title, ("Input", self.heads[1], self.heads[0]), rows)


def sampled_effect_points(plan: StudyPlan) -> list[tuple[float, ...]]:
    """Return the designs that indices on runs need, within the budget.

    Raises:
        DataError: The budget does not reach for one trajectory or base sample.
    """
    size, morris = len(plan.dimensions), plan.method.analysis == "morris"
    each = size + 1 if morris else size + 2
    count = plan.designs // each
    if count < (2 if morris else 8):
        raise DataError(
            f"{plan.method.budget} runs are too few for {plan.method.analysis} on runs",
            allowed=f"at least {(2 if morris else 8) * each * plan.cases_per_design}",
            remedy='Raise it, or write on = "surrogate"',
        )
    problem = _problem(plan)
    if morris:
        sample = optional_module("SALib.sample.morris", "study", "Morris' method").sample
        rows = sample(problem, count, num_levels=LEVELS, seed=plan.method.seed)
    else:
        sample = optional_module("SALib.sample.sobol", "study", "Sobol's indices").sample
        rows = sample(
            problem, 2 ** int(np.log2(count)), calc_second_order=False, seed=plan.method.seed
        )
    return [tuple(map(float, row)) for row in rows]


def effects(result: StudyResult, goal: AnyGoal) -> Effects:
    """Return the indices of a goal of a sensitivity study, on its runs or on their surrogate.

    Raises:
        DataError: Too few usable runs; a run of the sample that has no number.
    """
    plan = result.plan
    values = goal_column(result, goal)
    points = np.array([one.point for one in result.designs])
    if plan.method.on == "runs":
        if not np.isfinite(values).all():
            lost = int(np.count_nonzero(~np.isfinite(values)))
            raise DataError(
                f"{lost} of {len(values)} runs have no {goal}: indices on runs need all of them",
                remedy='Write on = "surrogate", which takes those that there are',
            )
        return _indices(plan, goal, points, values, f"{len(values)} designs run in full")
    surrogate = fitted(str(goal), goal.unit, plan.dimensions, points, values)
    rows = _dense_points(plan)
    return _indices(plan, goal, rows, surrogate.mean(rows), surrogate.words)


def surrogates(result: StudyResult, goals: Sequence[AnyGoal]) -> list[Surrogate]:
    """Return the surrogate of each goal over what is varied, from the designs on the study's grid.

    Raises:
        DataError: Too few usable runs.
    """
    points = np.array([one.point for one in result.designs])
    dimensions = result.plan.dimensions
    return [
        fitted(str(goal), goal.unit, dimensions, points, goal_column(result, goal))
        for goal in goals
    ]


def goal_column(result: StudyResult, goal: AnyGoal) -> Array:
    """Return (designs,) a goal's values on the study's grid, nan where there is none."""
    return np.array(
        [
            goal.value(one.records, result.plan.states) if one.usable else np.nan
            for one in result.designs
        ]
    )


def _dense_points(plan: StudyPlan) -> Array:
    if plan.method.analysis == "morris":
        sample = optional_module("SALib.sample.morris", "study", "Morris' method").sample
        return sample(_problem(plan), 200, num_levels=LEVELS, seed=plan.method.seed)
    sample = optional_module("SALib.sample.sobol", "study", "Sobol's indices").sample
    return sample(_problem(plan), ON_SURROGATE, calc_second_order=False, seed=plan.method.seed)


def _indices(plan: StudyPlan, goal: AnyGoal, points: Array, values: Array, basis: str) -> Effects:
    problem, seed = _problem(plan), plan.method.seed
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # indices of an output that does not vary
        if plan.method.analysis == "morris":
            analyze = optional_module("SALib.analyze.morris", "study", "Morris' method").analyze
            found = analyze(problem, points, values, num_levels=LEVELS, seed=seed)
            names = ("sigma", None, "mu_star", "mu_star_conf")
        else:
            analyze = optional_module("SALib.analyze.sobol", "study", "Sobol's indices").analyze
            found = analyze(problem, values, calc_second_order=False, seed=seed)
            names = ("S1", "S1_conf", "ST", "ST_conf")
    columns = [
        np.zeros(len(plan.dimensions))
        if name is None
        else np.nan_to_num(np.array(found[name], float))
        for name in names
    ]
    paths = tuple(one.path for one in plan.dimensions)
    return Effects(str(goal), goal.unit, plan.method.analysis, paths, *columns, basis=basis)


def _problem(plan: StudyPlan) -> dict[str, Any]:
    size = len(plan.dimensions)
    names = [one.path for one in plan.dimensions]
    return {"num_vars": size, "names": names, "bounds": [[0.0, 1.0]] * size}
