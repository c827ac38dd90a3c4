"""Analysis of variance with the type of the sums of squares named in the table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError

from .design import Predictor, parts
from .linear import LinearModel, linear_model, residual_sum

TYPES = {
    1: "type I (sequential)",
    2: "type II (each term after all terms that do not contain it)",
    3: "type III (each term after all others, factors coded to sum to zero)",
}


@dataclass(frozen=True, slots=True)
class AnovaRow:
    """One term: sum of squares, degrees of freedom, F and p (None for the residual)."""

    term: str
    sum_of_squares: float
    df: int
    f: float | None = None
    p: float | None = None


@dataclass(frozen=True, slots=True)
class AnovaTable:
    """Analysis of variance; ``rows`` holds the terms, then the residual."""

    model: LinearModel
    ss_type: int
    rows: tuple[AnovaRow, ...]
    warnings: tuple[str, ...]

    @property
    def title(self) -> str:
        """Name of the table with its type of sums of squares."""
        return f"Analysis of variance of {self.model.response_name}, {TYPES[self.ss_type]}"

    def __getitem__(self, term: str) -> AnovaRow:
        return next(row for row in self.rows if row.term == term)

    def __str__(self) -> str:
        lines = [self.title, f"{'term':<28}{'sum of squares':>16}{'df':>5}{'F':>12}{'p':>12}"]
        for row in self.rows:
            tail = "" if row.f is None or row.p is None else f"{row.f:>12.4g}{row.p:>12.4g}"
            lines.append(f"{row.term:<28}{row.sum_of_squares:>16.6g}{row.df:>5}{tail}")
        lines += [f"Warning: {text}" for text in self.warnings]
        return "\n".join(lines)


def analysis_of_variance(
    response: Sequence[float] | np.ndarray,
    predictors: Mapping[str, Sequence[object] | np.ndarray | Predictor],
    terms: Sequence[str] | None = None,
    *,
    ss_type: int = 3,
    name: str = "response",
) -> AnovaTable:
    """Return the analysis of variance of a linear model.

    Type I adds the terms in the order given; type II tests each term after all terms that do not
    contain it; type III after all others, which is right only with factors coded to sum to zero,
    as here. JMP, SPSS and SAS report type III. A covariate in an interaction is not centred: the
    factor's type III test is then about the covariate at zero, and a warning says so.

    Parameters
    ----------
    response, predictors, terms
        As for ``linear_model``.
    ss_type
        1, 2 or 3.

    Errors
    ------
    InputError
        Another type, or as for ``linear_model``.

    Source: J. Fox, Applied Regression Analysis and Generalized Linear Models, ch. 8.
    """
    if ss_type not in TYPES:
        raise InputError(f"sums of squares of type {ss_type}", where="ss_type", allowed="1, 2, 3")
    model = linear_model(response, predictors, terms, name=name)
    built, y = model.design, model.response
    warnings = list(model.warnings)
    rows = []
    if ss_type == 3:
        warnings += _about_zero(model)
    for number, term in enumerate(built.terms):
        if ss_type == 1:
            later = built.terms[number + 1 :]
            full = built.without(*later)
            reduced = built.without(term, *later)
        elif ss_type == 2:
            containing = [t for t in built.terms if t != term and set(parts(term)) < set(parts(t))]
            full = built.without(*containing)
            reduced = built.without(term, *containing)
        else:
            full, reduced = built.matrix, built.without(term)
        rss_full, rank_full = residual_sum(full, y)
        rss_reduced, rank_reduced = residual_sum(reduced, y)
        rows.append(_row(model, term, rss_reduced - rss_full, rank_full - rank_reduced))
    rows.append(AnovaRow("residual", model.residual_sum, model.residual_df))
    return AnovaTable(model, ss_type, tuple(rows), tuple(warnings))


def _row(model: LinearModel, term: str, ss: float, df: int) -> AnovaRow:
    from scipy import stats

    ss = max(ss, 0.0)
    if df == 0:
        return AnovaRow(term, ss, 0)
    f = ss / df / model.residual_mean_square
    return AnovaRow(term, ss, df, f, float(stats.f.sf(f, df, model.residual_df)))


def _about_zero(model: LinearModel) -> list[str]:
    found = []
    predictors = model.design.predictors
    for term in model.design.terms:
        names = parts(term)
        covariates = [n for n in names if not predictors[n].is_factor]
        if len(names) > 1 and covariates:
            found.append(
                f"{term}: type III tests of the terms inside it are about {covariates[0]} = 0; "
                "centre the covariate to test at its mean"
            )
    return found
