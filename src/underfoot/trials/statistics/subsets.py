"""Adjusted R^2 of every subset of predictors (the report's Table 7)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from underfoot.core import InputError

from .design import Predictor
from .linear import linear_model

_MOST = 10


@dataclass(frozen=True, slots=True)
class Subset:
    """One subset of predictors, main effects only."""

    predictors: tuple[str, ...]
    r_squared: float
    adjusted_r_squared: float
    parameters: int


def all_subsets(
    response: Sequence[float] | np.ndarray,
    predictors: Mapping[str, Sequence[object] | np.ndarray | Predictor],
) -> list[Subset]:
    """Return R^2 and adjusted R^2 of all non-empty subsets, smallest first.

    An ordinal variable enters as a factor (text; k - 1 parameters) or as a trend (numbers; one).
    The largest of many adjusted R^2 is optimistic: it was picked.

    Errors
    ------
    InputError
        More than ten predictors; otherwise as ``linear_model``.
    """
    if len(predictors) > _MOST:
        raise InputError(f"{len(predictors)} predictors", where="predictors", allowed="ten at most")
    found = []
    for size in range(1, len(predictors) + 1):
        for names in combinations(predictors, size):
            model = linear_model(response, {name: predictors[name] for name in names}, names)
            found.append(
                Subset(
                    names,
                    model.r_squared,
                    model.adjusted_r_squared,
                    model.design.matrix.shape[1],
                )
            )
    return found
