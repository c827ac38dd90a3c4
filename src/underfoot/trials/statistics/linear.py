"""Linear models: designs, analysis of variance, least-squares means, Tukey, subsets.

Least squares is that of statsmodels; designs (factors in sum-to-zero coding, covariates, products)
are built here, because formula packages reorder the terms of a type I analysis and drop empty cells
in silence.
"""

import warnings as python_warnings
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from string import ascii_lowercase
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, InputError, unknown_name
from underfoot.core.optional import optional_module
from underfoot.core.remark import Message

from .samples import ordered_levels


@dataclass(frozen=True, slots=True)
class Predictor:
    """One explanatory variable: a factor (with levels) or a covariate (without).

    ``values``: shape (n,): level numbers of a factor, numbers of a covariate. ``levels``: names of
    the levels; empty for a covariate.
    """

    name: str
    values: np.ndarray
    levels: tuple[str, ...] = ()

    @property
    def is_factor(self) -> bool:
        """True for a factor."""
        return bool(self.levels)

    def columns(self, values: np.ndarray | None = None) -> np.ndarray:
        """Return the coded columns, shape (n, k - 1) for k levels, (n, 1) for a covariate."""
        values = self.values if values is None else np.asarray(values)
        if not self.is_factor:
            return values[:, None].astype(float)
        k = len(self.levels)
        coding = np.vstack((np.eye(k - 1), -np.ones((1, k - 1))))
        return coding[values.astype(int)]


Columns = Mapping[str, Sequence[object] | np.ndarray | Predictor]
"""Explanatory variables by name: text makes a factor, numbers a covariate."""


@dataclass(frozen=True, slots=True)
class ModelMatrix:
    """Model matrix with its terms.

    ``matrix``: shape (n, p), the intercept first. ``terms``: names such as ``"shoe"`` or
    ``"shoe:fluid"``, in order. ``slices``: columns of each term.
    """

    matrix: np.ndarray
    terms: tuple[str, ...]
    slices: Mapping[str, slice]
    predictors: Mapping[str, Predictor]

    def without(self, *terms: str) -> np.ndarray:
        """Return the matrix without the columns of ``terms``."""
        columns = np.ones(self.matrix.shape[1], dtype=bool)
        for term in terms:
            columns[self.slices[term]] = False
        return self.matrix[:, columns]

    def rows(self, values: Mapping[str, np.ndarray]) -> np.ndarray:
        """Return model rows (m, p) for predictor values (level numbers or numbers), each (m,)."""
        count = len(next(iter(values.values()))) if values else 1
        coded = {name: p.columns(values[name]) for name, p in self.predictors.items()}
        return np.column_stack(
            [np.ones((count, 1)), *(_product(parts(term), coded) for term in self.terms)]
        )


def parts(term: str) -> tuple[str, ...]:
    """Return the predictors of a term: ``"a:b"`` gives ``("a", "b")``."""
    return tuple(term.split(":"))


def crossed_terms(*names: str, order: int | None = None) -> tuple[str, ...]:
    """Return all terms of a crossed model: main effects, then interactions up to ``order``."""
    top = len(names) if order is None else min(order, len(names))
    return tuple(
        ":".join(group) for size in range(1, top + 1) for group in combinations(names, size)
    )


def predictor(
    name: str,
    values: Sequence[object] | np.ndarray | Predictor,
    *,
    kind: str = "",
    rows: np.ndarray | None = None,
) -> Predictor:
    """Return a factor for text (or ``kind="factor"``), a covariate for numbers.

    Levels stand in the order of their first appearance, so that tables read as the data do; those
    that differ in one number (hardness 45, 60, 75) in the order of it.

    ``rows``: which values count, shape (n,) of bool; all by default.

    InputError: a factor with one level, a covariate that is not finite or constant.
    """
    if isinstance(values, Predictor):
        if rows is None or rows.all():
            return values
        kind = "factor" if values.is_factor else "covariate"
        values = [values.levels[i] for i in values.values] if values.is_factor else values.values
    if not kind:
        kind = "covariate" if np.asarray(values).dtype.kind in "fiu" else "factor"
    if rows is not None and not rows.all():
        values = [value for value, row in zip(values, rows, strict=True) if row]
    if kind == "factor":
        named = [f"{v:g}" if isinstance(v, float | np.floating) else str(v) for v in values]
        levels = ordered_levels(named)
        if len(levels) < 2:
            raise InputError(
                Message('the factor has one level, "{level}"', level=levels[0] if levels else ""),
                where=name,
                allowed="at least two levels",
                remedy="Leave it out of the model",
            )
        return Predictor(name, np.array([levels.index(value) for value in named]), levels)
    numbers = np.asarray(values, dtype=float)
    if not np.isfinite(numbers).all():
        raise DataError(
            Message("{sum} values are missing", sum=int((~np.isfinite(numbers)).sum())), where=name
        )
    if np.ptp(numbers) == 0:
        raise InputError("the covariate is constant", where=name, remedy="Leave it out")
    return Predictor(name, numbers)


def design(predictors: Mapping[str, Predictor], terms: Sequence[str]) -> ModelMatrix:
    """Return the model matrix of ``terms``, factors coded to sum to zero.

    InputError: a term names no predictor, or appears twice.
    """
    coded = {name: p.columns() for name, p in predictors.items()}
    matrices = [np.ones((len(next(iter(coded.values()))), 1))]
    slices: dict[str, slice] = {}
    at = 1
    for term in terms:
        for name in parts(term):
            if name not in predictors:
                raise unknown_name("predictor", name, predictors, where=term)
        if term in slices:
            raise InputError(Message('the term "{term}" appears twice', term=term), where="terms")
        block = _product(parts(term), coded)
        matrices.append(block)
        slices[term] = slice(at, at + block.shape[1])
        at += block.shape[1]
    used = {name: p for name, p in predictors.items() if any(name in parts(t) for t in terms)}
    return ModelMatrix(np.column_stack(matrices), tuple(terms), slices, used)


def empty_cells(predictors: Mapping[str, Predictor], term: str) -> list[Message]:
    """Return the combinations of levels of an interaction that hold no observation."""
    factors = [predictors[name] for name in parts(term) if predictors[name].is_factor]
    if len(factors) < 2:
        return []
    seen = set(zip(*(f.values.tolist() for f in factors), strict=True))
    grid = np.indices([len(f.levels) for f in factors]).reshape(len(factors), -1).T
    return [
        Message(
            "{levels: and }",
            levels=[f"{f.name} {f.levels[i]}" for f, i in zip(factors, cell, strict=True)],
        )
        for cell in grid.tolist()
        if tuple(cell) not in seen
    ]


def _product(names: Sequence[str], coded: Mapping[str, np.ndarray]) -> np.ndarray:
    block = coded[names[0]]
    for name in names[1:]:
        block = (block[:, :, None] * coded[name][:, None, :]).reshape(len(block), -1)
    return block


TYPES = {
    1: "type I (sequential)",
    2: "type II (each term after all terms that do not contain it)",
    3: "type III (each term after all others, factors coded to sum to zero)",
}
EXACT = 1e-18  # share of the variation left over below which a fit is exact, rounding aside


@dataclass(frozen=True, slots=True)
class FittedModel(ABC):
    """What comparisons need of a model.

    ``coefficients`` and ``covariance``: of the fixed effects, shapes (p,) and (p, p), sum-to-zero
    coding.
    """

    response_name: str
    design: ModelMatrix
    coefficients: np.ndarray
    covariance: np.ndarray
    warnings: tuple[Message, ...]

    @abstractmethod
    def df(self, contrast: np.ndarray) -> float:
        """Return the degrees of freedom of the error of a contrast, shape (p,)."""


@dataclass(frozen=True, slots=True)
class LinearModel(FittedModel):
    """A least-squares fit, with the pseudo-inverse where columns depend on each other.

    ``warnings`` name rows left out, empty cells, dependent columns, an exact fit;
    ``residual_sum`` is the residual sum of squares, with ``residual_df`` degrees of freedom.
    """

    response: np.ndarray
    residual_sum: float
    residual_df: int

    @property
    def residual_mean_square(self) -> float:
        """Residual variance."""
        return self.residual_sum / self.residual_df

    @property
    def total_sum(self) -> float:
        """Sum of squares about the mean."""
        return float(np.sum((self.response - self.response.mean()) ** 2))

    @property
    def exact(self) -> bool:
        """True when nothing but rounding is left over: F and p then mean nothing."""
        largest = max(self.total_sum, float(self.response @ self.response))
        return self.residual_sum <= EXACT * largest

    @property
    def dependent(self) -> bool:
        """True when columns depend on each other, as with empty cells: no means of all levels."""
        return bool(np.linalg.matrix_rank(self.design.matrix) < self.design.matrix.shape[1])

    @property
    def r_squared(self) -> float:
        """Share of the variation the model describes."""
        return 1.0 - self.residual_sum / self.total_sum

    @property
    def adjusted_r_squared(self) -> float:
        """R^2 corrected for the number of terms: 1 - (RSS/df)/(TSS/(n - 1))."""
        return 1.0 - self.residual_mean_square / (self.total_sum / (len(self.response) - 1))

    @property
    def fitted(self) -> np.ndarray:
        """Fitted values, shape (n,)."""
        return self.design.matrix @ self.coefficients

    def df(self, contrast: np.ndarray) -> float:
        """Return those of the residual."""
        return self.residual_df


def linear_model(
    response: ArrayLike,
    predictors: Columns,
    terms: Sequence[str] | None = None,
    *,
    name: str = "response",
) -> LinearModel:
    """Return the least-squares fit of a linear model.

    ``response``: shape (n,). Rows whose response is missing are left out and counted in
    ``warnings``. ``predictors``: columns of length n: text makes a factor, numbers a covariate (see
    ``predictor``). ``terms``: for example ``("shoe", "fluid", "shoe:fluid")``; all crossed by
    default.

    DataError: lengths differ, a constant response, or no degrees of freedom left for the residual.
    """
    y, built, warnings = model_data(response, predictors, terms, name)
    rank = int(np.linalg.matrix_rank(built.matrix))
    gaps = any(empty_cells(built.predictors, term) for term in built.terms)
    if rank < built.matrix.shape[1] and not gaps:
        warnings.append(
            Message("predictors depend on each other: single coefficients have no meaning")
        )
    if len(y) - rank < 1:
        raise DataError(
            Message(
                "{count} observations for {rank} parameters leave nothing to estimate the scatter",
                count=len(y),
                rank=rank,
            ),
            where=name,
            remedy="Drop interactions or measure more",
        )
    fit = _least_squares(y, built.matrix)
    left = float(fit.ssr), int(fit.df_resid)
    model = LinearModel(name, built, fit.params, fit.cov_params(), tuple(warnings), y, *left)
    if not model.exact:
        return model
    exact = Message("the model fits the data exactly: no scatter is left for a test")
    return replace(model, warnings=(*warnings, exact))


def model_data(
    response: ArrayLike, predictors: Columns, terms: Sequence[str] | None, name: str
) -> tuple[np.ndarray, ModelMatrix, list[Message]]:
    """Return complete responses, the design and warnings of empty cells (``linear_model``)."""
    y = np.asarray(response, dtype=float)
    if not predictors:
        raise InputError("a model needs at least one predictor", where=name)
    for key, column in predictors.items():
        length = len(column.values if isinstance(column, Predictor) else column)
        if length != len(y):
            raise DataError(
                Message("{length} values for {count} responses", length=length, count=len(y)),
                where=key,
            )
    complete = np.isfinite(y)
    warnings: list[Message] = []
    if not complete.all():
        lost = int((~complete).sum())
        warnings.append(Message("{lost} rows without a response were left out", lost=lost))
    ready = {key: predictor(key, column, rows=complete) for key, column in predictors.items()}
    terms = crossed_terms(*ready) if terms is None else tuple(terms)
    built = design(ready, terms)
    for term in terms:
        cells = empty_cells(ready, term)
        if cells:
            warnings.append(
                Message(
                    "{term}: empty cells ({cells:; }{more}); type III tests of lower terms depend "
                    "on the coding and least-squares means can't all be estimated",
                    term=term,
                    cells=cells[:4],
                    more=" ..." if len(cells) > 4 else "",
                )
            )
    y = y[complete]
    if np.ptp(y) == 0:
        raise DataError("the response is constant", where=name)
    return y, built, warnings


def _least_squares(y: np.ndarray, matrix: np.ndarray) -> Any:
    models = optional_module("statsmodels.regression.linear_model", "trials", "A linear model")
    with python_warnings.catch_warnings():
        # Dependent columns are in the model's own warnings, with the cells that cause them.
        python_warnings.simplefilter("ignore")
        return models.OLS(y, matrix).fit()


@dataclass(frozen=True, slots=True)
class AnovaRow:
    """One term: sum of squares, degrees of freedom, F and p (None for the residual).

    ``error_df`` are the degrees of freedom of its error.
    """

    term: str
    sum_of_squares: float
    df: int
    f: float | None = None
    p: float | None = None
    error_df: float | None = None


@dataclass(frozen=True, slots=True)
class AnovaTable:
    """Analysis of variance; ``rows`` holds the terms, then the residual."""

    model: LinearModel
    ss_type: int
    rows: tuple[AnovaRow, ...]
    warnings: tuple[Message, ...]

    @property
    def title(self) -> str:
        """Name of the table with its type of sums of squares."""
        return Message(
            "Analysis of variance of {response}, {types}",
            response=self.model.response_name,
            types=TYPES[self.ss_type],
        )

    def __getitem__(self, term: str) -> AnovaRow:
        return next(row for row in self.rows if row.term == term)

    def __str__(self) -> str:
        lines = [self.title, f"{'term':<28}{'sum of squares':>16}{'df':>5}{'F':>12}{'p':>12}"]
        for row in self.rows:
            tail = "" if row.f is None or row.p is None else f"{row.f:>12.4g}{row.p:>12.4g}"
            lines.append(f"{row.term:<28}{row.sum_of_squares:>16.6g}{row.df:>5}{tail}")
        return "\n".join([*lines, *(f"Warning: {text}" for text in self.warnings)])


def analysis_of_variance(
    response: ArrayLike,
    predictors: Columns,
    terms: Sequence[str] | None = None,
    *,
    ss_type: int = 3,
    name: str = "response",
) -> AnovaTable:
    """Return the analysis of variance (or covariance) of a linear model.

    Type I adds the terms in the order given; type II tests each term after all terms that do not
    contain it; type III after all others, which is right only with factors coded to sum to zero,
    as here. JMP, SPSS and SAS report type III. A covariate in an interaction is not centred: the
    factor's type III test is then about the covariate at zero, and a warning says so.

    ``response``, ``predictors`` and ``terms``: as for ``linear_model``. ``ss_type``: 1, 2 or 3.

    InputError: another type, or as for ``linear_model``.

    Source: J. Fox, Applied Regression Analysis and Generalized Linear Models, ch. 8.
    """
    from scipy import stats

    if ss_type not in TYPES:
        raise InputError(
            Message("sums of squares of type {ss_type}", ss_type=ss_type),
            where="ss_type",
            allowed="1, 2, 3",
        )
    model = linear_model(response, predictors, terms, name=name)
    built, y = model.design, model.response
    warnings = list(model.warnings)
    if ss_type == 3:
        for term in built.terms:
            slopes = [n for n in parts(term) if not built.predictors[n].is_factor]
            if len(parts(term)) > 1 and slopes:
                warnings.append(
                    Message(
                        "{term}: type III tests of the terms inside it are about {slope} = 0; "
                        "centre the covariate to test at its mean",
                        term=term,
                        slope=slopes[0],
                    )
                )
    rows = []
    for number, term in enumerate(built.terms):
        others = {
            1: built.terms[number + 1 :],
            2: [t for t in built.terms if t != term and set(parts(term)) < set(parts(t))],
            3: (),
        }[ss_type]
        full = _least_squares(y, built.without(*others))
        reduced = _least_squares(y, built.without(term, *others))
        ss, df = max(float(reduced.ssr - full.ssr), 0.0), int(reduced.df_resid - full.df_resid)
        if df == 0 or model.exact:
            rows.append(AnovaRow(term, ss, df))
            continue
        f = ss / df / model.residual_mean_square
        p = float(stats.f.sf(f, df, model.residual_df))
        rows.append(AnovaRow(term, ss, df, f, p, model.residual_df))
    rows.append(AnovaRow("residual", model.residual_sum, model.residual_df))
    return AnovaTable(model, ss_type, tuple(rows), tuple(warnings))


@dataclass(frozen=True, slots=True)
class AdjustedMean:
    """Least-squares mean of one level: the other factors weigh equally, covariates at mean."""

    level: str
    mean: float
    standard_error: float
    n: int


@dataclass(frozen=True, slots=True)
class LevelDifference:
    """Difference ``first`` - ``second`` with its simultaneous interval and adjusted p."""

    first: str
    second: str
    difference: float
    standard_error: float
    t: float
    p: float
    low: float
    high: float


def least_squares_means(model: FittedModel, factor: str) -> list[AdjustedMean]:
    """Return the least-squares mean of each level of ``factor``.

    Predictions on the grid of all levels, averaged with equal weights over the other factors,
    covariates at their mean. In unbalanced data they differ from the plain means of the groups.

    InputError: no such factor in the model.
    """
    rows, counts, levels = _mean_rows(model.design, factor)
    means = rows @ model.coefficients
    errors = np.sqrt(np.einsum("ij,jk,ik->i", rows, model.covariance, rows))
    return [
        AdjustedMean(level, float(m), float(e), int(n))
        for level, m, e, n in zip(levels, means, errors, counts, strict=True)
    ]


def tukey_hsd(
    model: FittedModel, factor: str, *, confidence: float = 0.95
) -> list[LevelDifference]:
    """Return all pairwise differences of least-squares means, adjusted after Tukey and Kramer.

    p = P(Q > sqrt(2) |t|) with Q the studentized range of k means and the degrees of freedom of
    the difference's own error (JMP and R's emmeans do the same; a one-way Tukey test on a factorial
    experiment uses another mean square). Exact when balanced, conservative otherwise.

    InputError: no such factor; a confidence outside 0 to 1. DataError: the model leaves no scatter.
    """
    from scipy.optimize import brentq

    if not 0 < confidence < 1:
        raise InputError(
            Message("confidence {confidence}", confidence=confidence),
            where="confidence",
            allowed="between 0 and 1",
        )
    if isinstance(model, LinearModel) and model.exact:
        raise DataError("the model fits the data exactly: no scatter", where=factor)
    rows, _, levels = _mean_rows(model.design, factor)
    beyond: dict[float, Callable[[float], float]] = {}
    reach: dict[float, float] = {}
    comparisons = []
    for i, j in combinations(range(len(levels)), 2):
        contrast = rows[i] - rows[j]
        df = model.df(contrast)
        if df not in beyond:
            q = beyond[df] = _studentized_range(len(levels), df)
            largest = 1.0
            while q(largest) > 1 - confidence:
                largest *= 2
            reach[df] = brentq(lambda x, q=q: q(x) - 1 + confidence, 0, largest) / np.sqrt(2.0)
        difference = float(contrast @ model.coefficients)
        error = float(np.sqrt(contrast @ model.covariance @ contrast))
        t = difference / error
        p = beyond[df](np.sqrt(2.0) * abs(t))
        ends = float(difference - reach[df] * error), float(difference + reach[df] * error)
        comparisons.append(LevelDifference(levels[i], levels[j], difference, error, t, p, *ends))
    return comparisons


def _studentized_range(k: int, df: float) -> Callable[[float], float]:
    """Return P(Q > q) of the studentized range of k means with df degrees of freedom.

    Mean over s = sqrt(chi^2 / df) of 1 - k int phi(z) [Phi(z) - Phi(z - q s)]^(k-1) dz. Both
    integrals by the trapezoidal rule, over z and ln s, where it converges exponentially: 1e-13.
    """
    from scipy.special import gammainccinv, gammaincinv, ndtr

    df = min(df, 1e8)  # the limit of many
    low, high = gammaincinv(df / 2, 1e-16), gammainccinv(df / 2, 1e-16)
    log_s = np.linspace(np.log(2 * low / df) / 2, np.log(2 * high / df) / 2, 257)
    weight = np.exp(df * (log_s - np.expm1(2 * log_s) / 2))
    weight /= weight.sum()
    z = np.linspace(-8.5, 8.5, 129)
    density = k * np.exp(-(z**2) / 2) * (z[1] - z[0]) / np.sqrt(2 * np.pi)

    def beyond(q: float) -> float:
        within = ndtr(z) - ndtr(z - q * np.exp(log_s)[:, None])
        return float(np.clip(weight @ (1 - within ** (k - 1) @ density), 0.0, 1.0))

    return beyond


@dataclass(frozen=True, slots=True)
class LevelPair:
    """Two levels compared: their difference, first - second, and p."""

    first: str
    second: str
    difference: float
    p: float


def letters(
    comparisons: Sequence[LevelDifference | LevelPair], *, alpha: float = 0.05
) -> dict[str, str]:
    """Return letters for the levels: levels that share one do not differ at ``alpha``.

    Insert-and-absorb of Piepho, J. Comput. Graph. Stat. 13 (2004) 456. The first letter goes to
    the group that holds the largest mean.
    """
    height: dict[str, float] = {}
    for c in comparisons:
        height[c.first] = height.get(c.first, 0.0) + c.difference
        height[c.second] = height.get(c.second, 0.0) - c.difference
    order = sorted(height, key=lambda level: -height[level])
    groups = [set(order)]
    for c in comparisons:
        if c.p >= alpha:
            continue
        split: list[set[str]] = []
        for group in groups:
            both = {c.first, c.second} <= group
            split += [group - {c.first}, group - {c.second}] if both else [group]
        groups = [
            g
            for i, g in enumerate(split)
            if not any(g < other or (g == other and j < i) for j, other in enumerate(split))
        ]
    groups.sort(key=lambda group: [order.index(x) for x in sorted(group, key=order.index)])
    return {
        level: "".join(ascii_lowercase[i] for i, group in enumerate(groups) if level in group)
        for level in order
    }


def _mean_rows(built: ModelMatrix, factor: str) -> tuple[np.ndarray, np.ndarray, tuple[str, ...]]:
    factors = {name: p for name, p in built.predictors.items() if p.is_factor}
    if factor not in factors:
        raise unknown_name("factor", factor, factors, where="Tukey")
    shape = [len(p.levels) for p in factors.values()]
    grid = np.indices(shape).reshape(len(shape), -1)
    values = dict(zip(factors, grid, strict=True))
    for name, p in built.predictors.items():
        if not p.is_factor:
            values[name] = np.full(grid.shape[1], p.values.mean())
    rows = built.rows(values)
    levels = factors[factor].levels
    means = np.array([rows[values[factor] == i].mean(axis=0) for i in range(len(levels))])
    return means, np.bincount(factors[factor].values, minlength=len(levels)), levels


@dataclass(frozen=True, slots=True)
class Subset:
    """One subset of predictors, main effects only."""

    predictors: tuple[str, ...]
    r_squared: float
    adjusted_r_squared: float
    parameters: int


def all_subsets(response: ArrayLike, predictors: Columns) -> list[Subset]:
    """Return R^2 and adjusted R^2 of all non-empty subsets (the report's Table 7), smallest first.

    An ordinal variable enters as a factor (text; k - 1 parameters) or as a trend (numbers; one).
    The largest of many adjusted R^2 is optimistic: it was picked.

    InputError: more than ten predictors; otherwise as ``linear_model``.
    """
    if len(predictors) > 10:
        raise InputError(
            Message("{count} predictors", count=len(predictors)),
            where="predictors",
            allowed="ten at most",
        )
    subsets = []
    for size in range(1, len(predictors) + 1):
        for names in combinations(predictors, size):
            model = linear_model(response, {name: predictors[name] for name in names}, names)
            columns = model.design.matrix.shape[1]
            subsets.append(Subset(names, model.r_squared, model.adjusted_r_squared, columns))
    return subsets
