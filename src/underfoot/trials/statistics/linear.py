"""Linear least squares with the pieces that analysis of variance and comparisons need."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from underfoot.core import DataError, InputError

from .design import Design, Predictor, crossed, design, empty_cells, predictor


@dataclass(frozen=True, slots=True)
class LinearModel:
    """A fitted linear model.

    Parameters
    ----------
    coefficients
        Shape (p,), sum-to-zero coding.
    covariance
        Shape (p, p); pseudo-inverse when columns depend on each other.
    residual_sum, residual_df
        Residual sum of squares and its degrees of freedom.
    warnings
        Empty cells, dropped rows, dependent columns.
    """

    response_name: str
    response: np.ndarray
    design: Design
    coefficients: np.ndarray
    covariance: np.ndarray
    residual_sum: float
    residual_df: int
    warnings: tuple[str, ...]

    @property
    def residual_mean_square(self) -> float:
        """Residual variance."""
        return self.residual_sum / self.residual_df

    @property
    def total_sum(self) -> float:
        """Sum of squares about the mean."""
        return float(np.sum((self.response - self.response.mean()) ** 2))

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


def linear_model(
    response: Sequence[float] | np.ndarray,
    predictors: Mapping[str, Sequence[object] | np.ndarray | Predictor],
    terms: Sequence[str] | None = None,
    *,
    name: str = "response",
) -> LinearModel:
    """Return the least-squares fit of a linear model.

    Parameters
    ----------
    response
        Shape (n,). Rows whose response is missing are left out and counted in ``warnings``.
    predictors
        Columns of length n: text makes a factor, numbers a covariate (see ``predictor``).
    terms
        For example ``("shoe", "fluid", "shoe:fluid")``; all crossed by default.

    Errors
    ------
    DataError
        Lengths differ, a constant response, or no degrees of freedom left for the residual.
    """
    y = np.asarray(response, dtype=float)
    if not predictors:
        raise InputError("a model needs at least one predictor", where=name)
    for key, column in predictors.items():
        length = len(column.values if isinstance(column, Predictor) else column)
        if length != len(y):
            raise DataError(f"{length} values for {len(y)} responses", where=key)
    kept = np.isfinite(y)
    warnings: list[str] = []
    if not kept.all():
        warnings.append(f"{int((~kept).sum())} rows without a response were left out")
    ready = {key: _ready(key, column, kept) for key, column in predictors.items()}
    terms = crossed(*ready) if terms is None else tuple(terms)
    built = design(ready, terms)
    y = y[kept]
    for term in terms:
        cells = empty_cells(ready, term)
        if cells:
            shown = "; ".join(cells[:4]) + (" ..." if len(cells) > 4 else "")
            warnings.append(
                f"{term}: empty cells ({shown}); type III tests of lower terms depend on the "
                "coding and least-squares means can't all be estimated"
            )
    matrix = built.matrix
    rank = int(np.linalg.matrix_rank(matrix))
    if rank < matrix.shape[1] and not any("empty cells" in text for text in warnings):
        warnings.append("predictors depend on each other: single coefficients have no meaning")
    df = len(y) - rank
    if df < 1:
        raise DataError(
            f"{len(y)} observations for {rank} parameters leave nothing to estimate the scatter",
            where=name,
            remedy="Drop interactions or measure more",
        )
    if np.ptp(y) == 0:
        raise DataError("the response is constant", where=name)
    coefficients = np.linalg.lstsq(matrix, y, rcond=None)[0]
    rss = float(np.sum((y - matrix @ coefficients) ** 2))
    covariance = np.linalg.pinv(matrix.T @ matrix) * (rss / df)
    return LinearModel(name, y, built, coefficients, covariance, rss, df, tuple(warnings))


def residual_sum(matrix: np.ndarray, response: np.ndarray) -> tuple[float, int]:
    """Return the residual sum of squares and the rank of a least-squares fit."""
    solution, _, rank, _ = np.linalg.lstsq(matrix, response, rcond=None)
    return float(np.sum((response - matrix @ solution) ** 2)), int(rank)


def _ready(
    name: str, column: Sequence[object] | np.ndarray | Predictor, kept: np.ndarray
) -> Predictor:
    if isinstance(column, Predictor):
        if kept.all():
            return column
        kind = "factor" if column.is_factor else "covariate"
        values = [column.levels[i] for i in column.values] if column.is_factor else column.values
        return predictor(name, [v for v, k in zip(values, kept, strict=True) if k], kind=kind)
    return predictor(name, [v for v, k in zip(column, kept, strict=True) if k])
