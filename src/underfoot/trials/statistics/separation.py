"""Is a binary outcome separated by its predictors? Found by linear programmes before any fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Separation:
    """``kind`` is "none", "quasi-complete" or "complete".

    ``infinite`` marks the coefficients (intercept first) whose maximum-likelihood estimate does
    not exist.
    """

    kind: str
    infinite: tuple[bool, ...]

    @property
    def separated(self) -> bool:
        """True when maximum likelihood has no finite answer."""
        return self.kind != "none"


def separation(matrix: np.ndarray, outcome: np.ndarray) -> Separation:
    """Return whether a direction b exists with X b >= 0 where y = 1 and <= 0 where y = 0.

    Parameters
    ----------
    matrix
        Shape (n, p) of full rank, intercept first.
    outcome
        Shape (n,), 0 or 1.

    Source: K. Konis, Linear programming algorithms for detecting separated data in binary
    logistic regression models, thesis, Oxford 2007.
    """
    from scipy.optimize import linprog

    scale = np.abs(matrix).max(axis=0)
    signed = np.where(outcome > 0.5, 1.0, -1.0)[:, None] * matrix / scale
    p = matrix.shape[1]
    bounds = [(-1.0, 1.0)] * p
    infinite = []
    for j in range(p):
        reach = 0.0
        for sign in (1.0, -1.0):
            objective = np.zeros(p)
            objective[j] = -sign
            found = linprog(objective, A_ub=-signed, b_ub=np.zeros(len(signed)), bounds=bounds)
            reach = max(reach, -float(found.fun) if found.success else 0.0)
        infinite.append(reach > 1e-7)
    if not any(infinite):
        return Separation("none", tuple(infinite))
    # Complete: every observation can be put on its side by one and the same margin.
    with_margin = np.column_stack((-signed, np.ones(len(signed))))
    objective = np.zeros(p + 1)
    objective[-1] = -1.0
    found = linprog(
        objective, A_ub=with_margin, b_ub=np.zeros(len(signed)), bounds=[*bounds, (0.0, 1.0)]
    )
    complete = bool(found.success) and -float(found.fun) > 1e-7
    return Separation("complete" if complete else "quasi-complete", tuple(infinite))
