"""Persons as units: means per person first, then models in which persons differ.

Trials of one person are alike. A test that takes them as independent finds differences that are
not there; here every person counts once in each condition.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError

from .linear import AnovaRow, FittedModel, model_data, parts
from .variance_components import VarianceComponents, variance_components


def independence_warning(persons: Sequence[object]) -> tuple[str, ...]:
    """Return a warning when rows repeat persons, for tests that take rows as independent."""
    names = {str(person) for person in persons}
    if len(names) == len(persons):
        return ()
    return (
        f"{len(persons)} trials of {len(names)} persons: this test takes them as independent, "
        "and its p is too small",
    )


@dataclass(frozen=True, slots=True)
class PersonMeans:
    """One row for each person in each condition: mean response, number of trials.

    ``squares``: of the trials about their means, summed over all rows.
    """

    person: tuple[str, ...]
    factors: Mapping[str, tuple[str, ...]]
    mean: np.ndarray
    trials: np.ndarray
    squares: float


def person_means(
    response: ArrayLike, factors: Mapping[str, Sequence[str]], person: Sequence[object]
) -> PersonMeans:
    """Return the mean of each person in each combination of levels; missing values are left out.

    DataError: lengths differ, or nothing is left.
    """
    y = np.asarray(response, dtype=float)
    if any(len(column) != len(y) for column in (person, *factors.values())):
        raise DataError("response, factors and persons differ in length", where="person means")
    cells: dict[tuple[str, ...], list[float]] = {}
    for i in np.flatnonzero(np.isfinite(y)).tolist():
        cell = (str(person[i]), *(str(levels[i]) for levels in factors.values()))
        cells.setdefault(cell, []).append(float(y[i]))
    if not cells:
        raise DataError("no values", where="person means")
    columns = list(zip(*cells, strict=True))
    return PersonMeans(
        columns[0],
        dict(zip(factors, columns[1:], strict=True)),
        np.array([np.mean(values) for values in cells.values()]),
        np.array([len(values) for values in cells.values()]),
        sum(float(np.sum((np.array(v) - np.mean(v)) ** 2)) for v in cells.values()),
    )


@dataclass(frozen=True, slots=True)
class MixedModel(FittedModel):
    """Linear model of trials in which persons differ, and react to conditions in their own way.

    ``variances``: of what is random: "person" (between persons), "person:shoe" (a person's own
    reaction to the shoe), "trial" (a person's repeats); NaN where the data hold it and a later one
    as one. One below zero says that trials of a person differ more than those of two.
    ``within``: factors of which at least one person has several levels.
    """

    fit: VarianceComponents
    variances: Mapping[str, float]
    within: frozenset[str]
    persons: int
    trials: int

    def df(self, contrasts: np.ndarray) -> float:
        """Return Satterthwaite's degrees of freedom: of the variances that the contrasts hold."""
        return round(self.fit.error_df(contrasts), 6)  # to which the variances are found

    @property
    def tests(self) -> tuple[AnovaRow, ...]:
        """F tests of the terms (type III, Wald), each with its own error."""
        from scipy import stats

        rows = []
        for term in self.design.terms:
            at = self.design.slices[term]
            b, c = self.coefficients[at], self.covariance[at, at]
            q, df = len(b), self.df(np.eye(len(self.coefficients))[at])
            f = float(b @ np.linalg.solve(c, b)) / q
            rows.append(AnovaRow(term, np.nan, q, f, float(stats.f.sf(f, q, df)), df))
        return tuple(rows)


def mixed_model(
    response: ArrayLike,
    factors: Mapping[str, Sequence[str]],
    person: Sequence[object],
    terms: Sequence[str] | None = None,
    *,
    name: str = "response",
) -> MixedModel:
    """Return the mixed model of a study in which persons repeat.

    Fixed factors; random are the person, the person's own reaction to each term of which it has
    several levels and to the whole condition, and the trial (REML). So a factor is tested against
    how differently persons react to it, and repeating trials does not make persons more. In
    complete data the tests are those of repeated measures (with two levels, the paired t test),
    since a variance may be negative.

    ``response`` and ``person``: shape (n,), one row a trial. ``factors``: columns of length n, as
    names. ``terms``: all crossed by default.

    DataError: fewer persons than the model needs; no scatter; combinations of levels without a
    trial.

    Source: D. J. Barr et al., J. Mem. Lang. 68 (2013) 255 (which effects are random); see
    ``variance_components``.
    """
    means = person_means(response, factors, person)
    y, built, notes = model_data(means.mean, means.factors, terms, name)
    if notes:
        raise DataError(
            notes[0], where=name, remedy="Name fewer factors, or leave out interactions"
        )
    people = tuple(dict.fromkeys(means.person))
    within = frozenset(
        factor
        for factor, levels in means.factors.items()
        if len(set(zip(means.person, levels, strict=True))) > len(people)
    )
    shared = dict.fromkeys(
        tuple(part for part in parts(term) if part in within) for term in ("", *built.terms)
    )
    shared |= {tuple(factor for factor in means.factors if factor in within): None}
    groups = {
        ":".join(("person", *own)): _numbered(means.person, *(means.factors[part] for part in own))
        for own in sorted(shared, key=len)
    }
    try:
        fit = variance_components(
            y, means.trials, means.squares, built.matrix, tuple(groups.values())
        )
    except DataError as error:
        raise DataError(
            error.what, where=name, remedy="Measure more persons, or name fewer factors"
        ) from error
    variances = dict(zip((*groups, "trial"), fit.variances.tolist(), strict=True))
    return MixedModel(
        name, built, fit.coefficients, fit.covariance, (), fit, variances, within, len(people),
        int(means.trials.sum()),
    )  # fmt: skip


def _numbered(*columns: Sequence[str]) -> np.ndarray:
    """Return a number for each combination that stands in the columns, shape (n,)."""
    rows = list(zip(*columns, strict=True))
    order = {row: i for i, row in enumerate(dict.fromkeys(rows))}
    return np.array([order[row] for row in rows])


@dataclass(frozen=True, slots=True)
class RepeatedMeasures:
    """Repeated-measures analysis of variance of person means.

    ``epsilon`` is Greenhouse and Geisser's, for one factor: ``rows`` hold p without it,
    ``p_corrected`` is p with it.
    """

    rows: tuple[AnovaRow, ...]
    epsilon: float | None
    p_corrected: float | None
    persons: int


def repeated_measures(
    response: ArrayLike, factors: Mapping[str, Sequence[str]], person: Sequence[object]
) -> RepeatedMeasures:
    """Return the repeated-measures analysis of variance (statsmodels' AnovaRM) of person means.

    DataError: a person lacks a combination of levels: use ``mixed_model``.

    Source: S. W. Greenhouse, S. Geisser, Psychometrika 24 (1959) 95.
    """
    import pandas as pd
    from scipy import stats
    from statsmodels.stats.anova import AnovaRM

    means = person_means(response, factors, person)
    # Neutral column names: statsmodels builds formulas of them.
    named = {f"factor{i}": name for i, name in enumerate(means.factors)}
    levels = {column: means.factors[name] for column, name in named.items()}
    frame = pd.DataFrame({"person": means.person, "y": means.mean, **levels})
    cells = int(np.prod([len(set(column)) for column in levels.values()]))
    persons = len(set(means.person))
    if len(frame) != cells * persons or persons < 2 or cells < 2:
        where, remedy = "repeated measures", "Use the mixed model"
        raise DataError("not every person has every condition", where=where, remedy=remedy)
    table: Any = AnovaRM(frame, "y", "person", within=list(named)).fit().anova_table
    rows = []
    for term, row in table.iterrows():
        name = ":".join(named[part] for part in str(term).split(":"))
        f, p, error_df = (float(row[key]) for key in ("F Value", "Pr > F", "Den DF"))
        rows.append(AnovaRow(name, np.nan, int(row["Num DF"]), f, p, error_df))
    if len(named) > 1:
        return RepeatedMeasures(tuple(rows), None, None, persons)
    wide = frame.pivot(index="person", columns="factor0", values="y").to_numpy()
    k = wide.shape[1]
    centring = np.eye(k) - 1.0 / k
    inner = centring @ np.atleast_2d(np.cov(wide.T)) @ centring
    epsilon = min(float(np.trace(inner) ** 2 / ((k - 1) * np.sum(inner**2))), 1.0)
    own: Any = rows[0]  # with F and the degrees of freedom of its error
    p = float(stats.f.sf(own.f, epsilon * own.df, epsilon * own.error_df))
    return RepeatedMeasures(tuple(rows), epsilon, p, persons)
