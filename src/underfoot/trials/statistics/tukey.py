"""Least-squares means and Tukey's honestly significant differences on the model's mean square."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from underfoot.core import InputError, unknown_name

from .linear import LinearModel


@dataclass(frozen=True, slots=True)
class AdjustedMean:
    """Least-squares mean of one level: the other factors weigh equally, covariates at mean."""

    level: str
    mean: float
    standard_error: float
    n: int


@dataclass(frozen=True, slots=True)
class Comparison:
    """Difference ``first`` - ``second`` with its simultaneous interval and adjusted p."""

    first: str
    second: str
    difference: float
    standard_error: float
    t: float
    p: float
    low: float
    high: float


def least_squares_means(model: LinearModel, factor: str) -> list[AdjustedMean]:
    """Return the least-squares mean of each level of ``factor``.

    Predictions on the grid of all levels, averaged with equal weights over the other factors,
    covariates at their mean. In unbalanced data they differ from the plain means of the groups.

    Errors
    ------
    InputError
        No such factor in the model.
    """
    rows, counts, levels = _mean_rows(model, factor)
    means = rows @ model.coefficients
    errors = np.sqrt(np.einsum("ij,jk,ik->i", rows, model.covariance, rows))
    return [
        AdjustedMean(level, float(m), float(e), int(n))
        for level, m, e, n in zip(levels, means, errors, counts, strict=True)
    ]


def tukey_hsd(model: LinearModel, factor: str, *, confidence: float = 0.95) -> list[Comparison]:
    """Return all pairwise differences of least-squares means, adjusted after Tukey and Kramer.

    p = P(Q > sqrt(2) |t|) with Q the studentized range of k means and the residual degrees of
    freedom of the model (JMP and R's emmeans do the same; a one-way Tukey test on a factorial
    experiment uses another mean square). Exact when balanced, conservative otherwise.

    Errors
    ------
    InputError
        No such factor; a confidence outside 0 to 1.
    """
    from scipy.stats import studentized_range

    if not 0 < confidence < 1:
        raise InputError(f"confidence {confidence}", where="confidence", allowed="between 0 and 1")
    rows, _, levels = _mean_rows(model, factor)
    k, df = len(levels), model.residual_df
    critical = float(studentized_range.ppf(confidence, k, df)) / np.sqrt(2.0)
    found = []
    for i, j in combinations(range(k), 2):
        contrast = rows[i] - rows[j]
        difference = float(contrast @ model.coefficients)
        error = float(np.sqrt(contrast @ model.covariance @ contrast))
        t = difference / error
        p = float(np.clip(studentized_range.sf(np.sqrt(2.0) * abs(t), k, df), 0.0, 1.0))
        reach = float(critical * error)
        low, high = difference - reach, difference + reach
        found.append(Comparison(levels[i], levels[j], difference, error, t, p, low, high))
    return found


def letters(comparisons: list[Comparison], *, alpha: float = 0.05) -> dict[str, str]:
    """Return letters for the levels: levels that share one do not differ at ``alpha``.

    Insert-and-absorb of Piepho, J. Comput. Graph. Stat. 13 (2004) 456. The first letter goes to
    the group that holds the largest mean.
    """
    order = _by_mean(comparisons)
    groups = [set(order)]
    for c in comparisons:
        if c.p >= alpha:
            continue
        split = []
        for group in groups:
            if {c.first, c.second} <= group:
                split += [group - {c.first}, group - {c.second}]
            else:
                split.append(group)
        groups = [
            g
            for i, g in enumerate(split)
            if not any(g < other or (g == other and j < i) for j, other in enumerate(split))
        ]
    groups.sort(key=lambda group: [order.index(x) for x in sorted(group, key=order.index)])
    names = "abcdefghijklmnopqrstuvwxyz"
    return {
        level: "".join(names[i] for i, group in enumerate(groups) if level in group)
        for level in order
    }


def _by_mean(comparisons: list[Comparison]) -> list[str]:
    height: dict[str, float] = {}
    for c in comparisons:
        height[c.first] = height.get(c.first, 0.0) + c.difference
        height[c.second] = height.get(c.second, 0.0) - c.difference
    return sorted(height, key=lambda level: -height[level])


def _mean_rows(model: LinearModel, factor: str) -> tuple[np.ndarray, np.ndarray, tuple[str, ...]]:
    predictors = model.design.predictors
    factors = {name: p for name, p in predictors.items() if p.is_factor}
    if factor not in factors:
        raise unknown_name("factor", factor, factors, where="Tukey")
    shape = [len(p.levels) for p in factors.values()]
    grid = np.indices(shape).reshape(len(shape), -1)
    values = dict(zip(factors, grid, strict=True))
    for name, p in predictors.items():
        if not p.is_factor:
            values[name] = np.full(grid.shape[1], p.values.mean())
    rows = model.design.rows(values)
    levels = factors[factor].levels
    chosen = values[factor]
    means = np.array([rows[chosen == i].mean(axis=0) for i in range(len(levels))])
    counts = np.bincount(factors[factor].values, minlength=len(levels))
    return means, counts, levels
