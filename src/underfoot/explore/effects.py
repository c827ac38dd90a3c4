"""How much of an output comes from each input of a study: Morris and Sobol, with confidence.

Morris: mean absolute elementary effect mu* and their deviation sigma (Morris 1991; Campolongo,
Cariboni and Saltelli 2007). Sobol: share of the variance by an input alone, S1, and with all its
interactions, ST (Saltelli et al. 2010). Computed by SALib; intervals by its bootstrap, 95 %. On a
surrogate its own error is in them: the indices I_k of the surrogate without each of K parts of the
runs give the variance (K - 1) / K sum (I_k - mean I)^2 (jackknife by groups; Efron and Stein 1981).
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import Any, ClassVar

import numpy as np

from underfoot.core import DataError
from underfoot.core.arrays import Array
from underfoot.core.optional import optional_module
from underfoot.core.presentation import Presentable, Table
from underfoot.core.remark import Message

from .goals import AnyGoal
from .plan import StudyPlan
from .result import StudyResult
from .surrogate import NORMAL

ON_SURROGATE = {"sobol": 1024, "morris": 200}
"""Base sample or trajectories on a surrogate."""
OPTIONS = {"sobol": {"calc_second_order": False}, "morris": {"num_levels": 4}}
KEYS = {"sobol": ("S1", "ST"), "morris": ("sigma", "mu_star")}
"""Indices as SALib calls them."""


@dataclass(frozen=True, slots=True)
class Effects(Presentable):
    """Indices of one output, an input a row.

    Attributes:
        main, main_half: S1 (Sobol) and half its interval; sigma (Morris, in the output's unit),
            whose interval nobody estimates (NaN).
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
        value = _effect_text(self.total[first], self.total_half[first])
        return (
            Message(
                "{output} depends most on {path} ({head} {value}).",
                output=self.output,
                path=self.paths[first],
                head=self.heads[1],
                value=value,
            ),
            f"On {self.basis}.",
        )

    def table(self) -> Table:
        """Return both indices of each input, the most effective first."""
        order = np.argsort(-self.total, kind="stable")
        rows = [
            (
                self.paths[k],
                _effect_text(float(self.total[k]), float(self.total_half[k])),
                _effect_text(float(self.main[k]), float(self.main_half[k])),
            )
            for k in order
        ]
        title = Message(
            "{output}: {analysis:capital} indices, 95 %, on {basis}",
            output=self.output,
            analysis=self.analysis,
            basis=self.basis,
        )
        return Table(title, ("Input", self.heads[1], self.heads[0]), rows)


def _effect_text(value: float, half: float) -> str:
    return f"{value:.3g} ± {half:.2g}" if np.isfinite(half) else f"{value:.3g}"


def sampled_effect_points(plan: StudyPlan) -> list[tuple[float, ...]]:
    """Return the designs that indices on runs need, within the budget.

    Raises:
        DataError: The budget does not reach for two trajectories or a base sample of 8.
    """
    size, morris = len(plan.dimensions), plan.method.analysis == "morris"
    each, least = (size + 1, 2) if morris else (size + 2, 8)
    count = plan.designs // each
    if count < least:
        raise DataError(
            Message(
                "{budget} runs are too few for {analysis} on runs",
                budget=plan.method.budget,
                analysis=plan.method.analysis,
            ),
            allowed=Message("at least {least}", least=least * each * plan.cases_per_design),
            remedy='Raise it, or write on = "surrogate"',
        )
    rows = _salib(plan, "sample")(count if morris else 2 ** int(np.log2(count)))
    return [tuple(map(float, row)) for row in rows]


def effects(result: StudyResult, goal: AnyGoal) -> Effects:
    """Return the indices of a goal of a sensitivity study, on its runs or on their surrogate.

    Raises:
        DataError: Too few usable runs; a run of the sample that has no number.
    """
    plan, method = result.plan, result.plan.method
    without: list[Array] = []
    if method.on == "runs":
        points = np.array([design.point for design in result.designs])
        values = result.values(result.designs, [goal])[:, 0]
        basis = Message("{count} designs run in full", count=len(values))
        if lost := np.count_nonzero(~np.isfinite(values)):
            raise DataError(
                Message(
                    "{lost} of {count} runs have no {goal}: indices on runs need all of them",
                    lost=lost,
                    count=len(values),
                    goal=goal,
                ),
                remedy='Write on = "surrogate", which takes those that there are',
            )
    else:
        (surrogate,) = result.surrogates([goal])
        points = _salib(plan, "sample")(ON_SURROGATE[method.analysis])
        values, basis = surrogate.mean(points), surrogate.reliability
        without = surrogate.means_without(points)
    columns = _indices(plan, points, values)
    if without:
        parts = np.array([_indices(plan, points, one) for one in without])
        variance = (len(parts) - 1) * parts.var(axis=0)
        columns[1::2] = np.sqrt(columns[1::2] ** 2 + NORMAL**2 * variance[::2])
    paths = tuple(dimension.path for dimension in plan.dimensions)
    return Effects(str(goal), goal.unit, method.analysis, paths, *columns, basis=basis)


def _indices(plan: StudyPlan, points: Array, values: Array) -> Array:
    """Return (4, inputs): main, half its interval, total, half its interval, by SALib."""
    method = plan.method.analysis
    given = (points, values) if method == "morris" else (values,)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # indices of an output that does not vary
        indices = _salib(plan, "analyze")(*given)
    nothing = np.zeros(len(plan.dimensions))
    names = [part for name in KEYS[method] for part in (name, f"{name}_conf")]
    columns = np.nan_to_num(np.array([indices.get(name, nothing) for name in names], dtype=float))
    if method == "morris":
        columns[1] = np.nan
    return columns


def _salib(plan: StudyPlan, step: str) -> Callable[..., Any]:
    """Return SALib's function ``sample`` or ``analyze`` for the inputs and method of a plan."""
    name, paths = plan.method.analysis, [dimension.path for dimension in plan.dimensions]
    problem = {"num_vars": len(paths), "names": paths, "bounds": [[0.0, 1.0]] * len(paths)}
    optional_module("SALib", "study", "A sensitivity")
    function = getattr(import_module(f"SALib.{step}.{name}"), step)
    # its bootstrap takes a seed of 0 for none: the intervals would differ with each look
    seed = plan.method.seed + (step == "analyze")
    return partial(function, problem, seed=seed, **OPTIONS[name])
