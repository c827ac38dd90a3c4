"""Persons as units: means per person first, then models in which persons differ.

Trials of one person are alike. A test that takes them as independent finds differences that are
not there; here every person counts once in each condition.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError
from underfoot.core.remark import Message

from .linear import AnovaRow, FittedModel, crossed_terms, model_data, parts
from .samples import ROUNDING
from .variance_components import VarianceComponents, variance_components


def independence_warning(persons: Sequence[object]) -> tuple[Message, ...]:
    """Return a warning when rows repeat persons, for tests that take rows as independent."""
    names = {str(person) for person in persons}
    if len(names) == len(persons):
        return ()
    if len(names) == 1:
        text = Message(
            "{count} trials of one person: this test tells of that person, not of others",
            count=len(persons),
        )
        return (text,)
    text = Message(
        "{count} trials of {persons} persons: this test takes them as independent, and its p is "
        "too small",
        count=len(persons),
        persons=len(names),
    )
    return (text,)


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

    def df(self, contrast: np.ndarray) -> float:
        """Return the degrees of freedom of the variances that the contrast holds."""
        return round(self.fit.error_df(contrast), 6)  # to which the variances are found

    @property
    def tests(self) -> tuple[AnovaRow, ...]:
        """F tests of the terms (type III), each with its own error (Kenward and Roger)."""
        from scipy import stats

        rows = []
        for term in self.design.terms:
            chosen = np.eye(len(self.coefficients))[self.design.slices[term]]
            f, df = self.fit.wald_test(chosen)
            p = float(stats.f.sf(f, len(chosen), df))
            rows.append(AnovaRow(term, np.nan, len(chosen), f, p, round(df, 6)))
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
    if np.linalg.matrix_rank(built.matrix) < built.matrix.shape[1]:
        text = "conditions that can't be told apart"
        raise DataError(text, where=name, remedy="Leave one out (told_apart says which)")
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
        ":".join(("person", *own)): _number_combinations(
            means.person, *(means.factors[part] for part in own)
        )
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


def _number_combinations(*columns: Sequence[str]) -> np.ndarray:
    """Return a number for each combination that stands in the columns, shape (n,)."""
    rows = list(zip(*columns, strict=True))
    order = {row: i for i, row in enumerate(dict.fromkeys(rows))}
    return np.array([order[row] for row in rows])


@dataclass(frozen=True, slots=True)
class RepeatedMeasures:
    """Repeated-measures analysis of variance of person means.

    ``rows`` hold p without a correction; ``epsilon`` (Greenhouse and Geisser's) and
    ``p_corrected``, p with it, go with them.
    """

    rows: tuple[AnovaRow, ...]
    epsilon: tuple[float, ...]
    p_corrected: tuple[float, ...]
    persons: int


def repeated_measures(
    response: ArrayLike, factors: Mapping[str, Sequence[str]], person: Sequence[object]
) -> RepeatedMeasures:
    """Return the repeated-measures analysis of variance of person means.

    Each term is tested against how differently persons react to it: with the contrasts z of a term
    (d of them, orthonormal) in n persons, F = n |mean z|^2 / trace S, S the covariance of z;
    epsilon = (trace S)^2 / (d trace S^2).

    DataError: a person lacks a combination of levels: use ``mixed_model``; no scatter.

    Source: S. W. Greenhouse, S. Geisser, Psychometrika 24 (1959) 95.
    """
    from scipy import stats

    means = person_means(response, factors, person)
    people = list(dict.fromkeys(means.person))
    levels = [list(dict.fromkeys(column)) for column in means.factors.values()]
    shape = [len(people), *map(len, levels)]
    if len(means.mean) != np.prod(shape) or len(people) < 2 or np.prod(shape[1:]) < 2:
        where, remedy = "repeated measures", "Use the mixed model"
        raise DataError("not every person has every condition", where=where, remedy=remedy)
    wide = np.empty(shape)
    columns = zip((means.person, *means.factors.values()), (people, *levels), strict=True)
    wide[tuple([names.index(one) for one in column] for column, names in columns)] = means.mean
    rows, epsilon, corrected = [], [], []
    for term in crossed_terms(*means.factors):
        z = wide
        for axis, name in enumerate(means.factors, start=1):
            k = shape[axis]
            basis = np.linalg.qr(np.column_stack((np.ones(k), np.eye(k)[:, 1:])))[0]
            chosen = basis[:, 1:] if name in parts(term) else basis[:, :1]
            z = np.moveaxis(np.tensordot(z, chosen, (axis, 0)), -1, axis)
        z = z.reshape(len(people), -1)
        d, spread = z.shape[1], np.atleast_2d(np.cov(z.T))
        scatter, error_df = float(np.trace(spread)), (len(people) - 1) * z.shape[1]
        if scatter <= ROUNDING**2 * float(np.max(wide**2)):
            raise DataError("persons react all alike: no scatter", where=term)
        f = len(people) * float(np.sum(z.mean(axis=0) ** 2)) / scatter
        rows.append(AnovaRow(term, np.nan, d, f, float(stats.f.sf(f, d, error_df)), error_df))
        epsilon.append(min(scatter**2 / (d * float(np.sum(spread**2))), 1.0))
        corrected.append(float(stats.f.sf(f, epsilon[-1] * d, epsilon[-1] * error_df)))
    return RepeatedMeasures(tuple(rows), tuple(epsilon), tuple(corrected), len(people))
