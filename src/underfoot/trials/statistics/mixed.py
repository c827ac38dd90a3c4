"""Persons as units: means per person first, then models in which persons differ.

Trials of one person are alike. A test that takes them as independent finds differences that are
not there; here every person counts once in each condition.
"""

import warnings as python_warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError

from .linear import AnovaRow, FittedModel, linear_model, model_data, parts


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
    """One row for each person in each condition: mean response, number of trials."""

    person: tuple[str, ...]
    factors: Mapping[str, tuple[str, ...]]
    mean: np.ndarray
    trials: np.ndarray


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
    )


@dataclass(frozen=True, slots=True)
class MixedModel(FittedModel):
    """Linear model of person means with a random intercept for each person (REML).

    ``person_sd`` and ``residual_sd``: standard deviations between persons, and of a person's mean
    in one condition about it. ``within_df`` and ``between_df``: degrees of freedom of what varies
    within persons and of what only differs between them. ``within``: factors of which at least one
    person has several levels.
    """

    person_sd: float
    residual_sd: float
    within_df: int
    between_df: int
    within: frozenset[str]
    persons: int
    trials: int

    def df(self, factor: str) -> float:
        """Return those within persons where a person has several levels, else those between."""
        inside = any(name in self.within for name in parts(factor))
        return self.within_df if inside else self.between_df

    @property
    def tests(self) -> tuple[AnovaRow, ...]:
        """F tests of the terms (type III, Wald, degrees of freedom between and within persons)."""
        from scipy import stats

        rows = []
        for term in self.design.terms:
            at = self.design.slices[term]
            b, c = self.coefficients[at], self.covariance[at, at]
            q, df = len(b), self.df(term)
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

    Trials are averaged first for each person and condition, so that repeating trials does not
    make persons more. The means are modelled with fixed factors and a random intercept for each
    person; its variance is that of statsmodels' REML fit. In complete data the tests are those
    of repeated measures (with two levels, the paired t test). Degrees of freedom: persons -
    parameters for what differs between persons, rows - persons - parameters within.

    ``response`` and ``person``: shape (n,), one row a trial. ``factors``: columns of length n, as
    names. ``terms``: all crossed by default.

    DataError: fewer persons than the model needs; no person with two conditions and none repeated;
    combinations of levels without a person.

    Source: J. C. Pinheiro, D. M. Bates, Mixed-Effects Models in S and S-PLUS, Springer 2000
    (degrees of freedom: section 2.4.2).
    """
    means = person_means(response, factors, person)
    y, built, notes = model_data(means.mean, means.factors, terms, name)
    if notes:
        raise DataError(
            notes[0], where=name, remedy="Name fewer factors, or leave out interactions"
        )
    people = list(dict.fromkeys(means.person))
    who = np.array([people.index(p) for p in means.person])
    x = built.matrix
    varies = np.array([np.ptp(x[who == i], axis=0) > 0 for i in range(len(people))])
    inside = int(varies.any(axis=0).sum())
    within = frozenset(
        factor
        for factor, levels in means.factors.items()
        if len(set(zip(means.person, levels, strict=True))) > len(people)
    )
    between_df = len(people) - (x.shape[1] - inside)
    within_df = len(y) - len(people) - inside
    if between_df < 1 or (varies.any() and within_df < 1):
        raise DataError(
            f"{len(people)} persons leave nothing to estimate the scatter of {x.shape[1]} "
            "parameters",
            where=name,
            remedy="Measure more persons, or name fewer factors",
        )
    counted = within, len(people), int(means.trials.sum())
    if not varies.any():
        # Nobody repeats a condition: the means of persons are independent.
        plain = linear_model(y, means.factors, built.terms, name=name)
        fixed = plain.coefficients, plain.covariance, plain.warnings
        spread = float(np.sqrt(plain.residual_mean_square))
        return MixedModel(name, built, *fixed, spread, 0.0, 0, plain.residual_df, *counted)
    person_sd, residual_sd = _standard_deviations(y, x, who)
    share = person_sd**2 / residual_sd**2
    shrink = share / (1.0 + share * np.bincount(who)[who])
    inverse = (np.eye(len(y)) - shrink * (who[:, None] == who)) / residual_sd**2
    covariance = np.linalg.inv(x.T @ inverse @ x)
    warning = ()
    if person_sd < 1e-3 * residual_sd:
        warning = ("persons differ no more than by chance: their variance is estimated as zero",)
    fixed = covariance @ (x.T @ inverse @ y), covariance, warning
    return MixedModel(name, built, *fixed, person_sd, residual_sd, within_df, between_df, *counted)


def _standard_deviations(y: np.ndarray, x: np.ndarray, who: np.ndarray) -> tuple[float, float]:
    from statsmodels.regression.mixed_linear_model import MixedLM

    scale = float(y.std())
    with python_warnings.catch_warnings():
        # A variance of zero is an answer here, said in the model's own warnings.
        python_warnings.simplefilter("ignore")
        fit: Any = MixedLM((y - y.mean()) / scale, x, groups=who).fit(
            reml=True, method=["powell"], ftol=1e-13, xtol=1e-10
        )
    person, residual = float(np.asarray(fit.cov_re).ravel()[0]), float(fit.scale)
    if not np.isfinite([person, residual]).all() or residual <= 1e-18:
        raise DataError(
            "persons explain everything: no scatter is left within them", where="mixed model"
        )
    return scale * float(np.sqrt(max(person, 0.0))), scale * float(np.sqrt(residual))


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
