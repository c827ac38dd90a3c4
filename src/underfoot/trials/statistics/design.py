"""Design matrices of linear models: factors in sum-to-zero coding, covariates, products."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from underfoot.core import DataError, InputError, unknown_name


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
class Design:
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


def crossed(*names: str, order: int | None = None) -> tuple[str, ...]:
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

    Levels stand in the order of their first appearance, so that tables read as the data do.

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
        levels = tuple(dict.fromkeys(named))
        if len(levels) < 2:
            raise InputError(
                f'the factor has one level, "{levels[0] if levels else ""}"',
                where=name,
                allowed="at least two levels",
                remedy="Leave it out of the model",
            )
        return Predictor(name, np.array([levels.index(value) for value in named]), levels)
    numbers = np.asarray(values, dtype=float)
    if not np.isfinite(numbers).all():
        raise DataError(f"{int((~np.isfinite(numbers)).sum())} values are missing", where=name)
    if np.ptp(numbers) == 0:
        raise InputError("the covariate is constant", where=name, remedy="Leave it out")
    return Predictor(name, numbers)


def design(predictors: Mapping[str, Predictor], terms: Sequence[str]) -> Design:
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
            raise InputError(f'the term "{term}" appears twice', where="terms")
        block = _product(parts(term), coded)
        matrices.append(block)
        slices[term] = slice(at, at + block.shape[1])
        at += block.shape[1]
    used = {name: p for name, p in predictors.items() if any(name in parts(t) for t in terms)}
    return Design(np.column_stack(matrices), tuple(terms), slices, used)


def empty_cells(predictors: Mapping[str, Predictor], term: str) -> list[str]:
    """Return the combinations of levels of an interaction that hold no observation."""
    factors = [predictors[name] for name in parts(term) if predictors[name].is_factor]
    if len(factors) < 2:
        return []
    seen = set(zip(*(f.values.tolist() for f in factors), strict=True))
    grid = np.indices([len(f.levels) for f in factors]).reshape(len(factors), -1).T
    return [
        " and ".join(f"{f.name} {f.levels[i]}" for f, i in zip(factors, cell, strict=True))
        for cell in grid.tolist()
        if tuple(cell) not in seen
    ]


def _product(names: Sequence[str], coded: Mapping[str, np.ndarray]) -> np.ndarray:
    block = coded[names[0]]
    for name in names[1:]:
        block = (block[:, :, None] * coded[name][:, None, :]).reshape(len(block), -1)
    return block
