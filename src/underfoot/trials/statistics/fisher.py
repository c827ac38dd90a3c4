"""Fisher's exact test for tables of any size, by enumeration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import lgamma

import numpy as np

from underfoot.core import InputError

_LIMIT = 20_000_000
_TIE = 1e-7  # relative slack for tables exactly as likely as the observed one, as R uses


@dataclass(frozen=True, slots=True)
class ExactTest:
    """Two-sided p of Fisher's exact test; odds ratios for 2 x 2 tables only.

    ``odds_ratio`` is the conditional maximum-likelihood estimate (R's), ``low`` to ``high`` its
    exact 95 % interval; ``sample_odds_ratio`` is ad / bc.
    """

    p: float
    table: tuple[tuple[int, ...], ...]
    odds_ratio: float | None = None
    low: float | None = None
    high: float | None = None
    sample_odds_ratio: float | None = None


def fisher_exact(table: Sequence[Sequence[int]] | np.ndarray) -> ExactTest:
    """Return Fisher's exact test of an r x c table of counts.

    All tables with the same margins are enumerated: the first half of the columns is filled and
    grouped by the row sums it leaves, each group is completed once, and probabilities no larger
    than the observed one are added (the two-sided rule of Freeman and Halton, Biometrika 38,
    1951, 141).

    Errors
    ------
    InputError
        Negative or broken counts, fewer than two filled rows or columns, or a table with more
        than twenty million partial tables (use a Monte Carlo or chi-square test there).
    """
    counts = np.asarray(table)
    if counts.ndim != 2 or (counts < 0).any() or not np.equal(np.mod(counts, 1), 0).all():
        raise InputError("counts must be whole and not negative", where="table")
    counts = counts.astype(int)
    given = tuple(tuple(int(x) for x in row) for row in counts)
    counts = counts[counts.sum(axis=1) > 0][:, counts.sum(axis=0) > 0]
    if min(counts.shape) < 2:
        raise InputError(
            "fewer than two rows or columns hold counts",
            where="table",
            remedy="An exact test needs two groups and two outcomes",
        )
    p = _p_value(counts if counts.shape[0] <= counts.shape[1] else counts.T)
    if counts.shape != (2, 2):
        return ExactTest(p, given)
    from scipy.stats.contingency import odds_ratio

    found = odds_ratio(counts, kind="conditional")
    interval = found.confidence_interval(0.95)
    a, b, c, d = (float(x) for x in counts.ravel())
    sample = a * d / (b * c) if b * c else float("inf")
    ratio, low, high = float(found.statistic), float(interval.low), float(interval.high)
    return ExactTest(p, given, ratio, low, high, sample)


def _p_value(counts: np.ndarray) -> float:
    # Small columns first: they make the few row sums from which the rest is completed.
    counts = counts[:, np.argsort(counts.sum(axis=0), kind="stable")]
    rows, columns = counts.sum(axis=1), [int(c) for c in counts.sum(axis=0)]
    log_factorial = np.array([lgamma(i + 1.0) for i in range(int(counts.sum()) + 1)])
    constant = log_factorial[rows].sum() + log_factorial[columns].sum() - log_factorial[-1]
    observed = constant - log_factorial[counts].sum()
    bound = observed + np.log1p(_TIE)
    half = len(columns) // 2
    budget = [_LIMIT]
    total = 0.0
    for rest, weights in _partial(rows, columns[:half], log_factorial, budget).items():
        others = _completions(rest, tuple(columns[half:]), log_factorial, budget)
        ordered = np.sort(others)
        sums = np.concatenate(([0.0], np.cumsum(np.exp(ordered + constant))))
        reach = np.searchsorted(ordered, bound - constant - weights, side="right")
        total += float(np.sum(np.exp(weights) * sums[reach]))
    return min(total, 1.0)


def _partial(
    rows: np.ndarray, columns: list[int], log_factorial: np.ndarray, budget: list[int]
) -> dict[tuple[int, ...], np.ndarray]:
    """Return the logs of 1 / prod(cell!) of all fillings, by what they leave of the row sums."""
    states = {tuple(int(r) for r in rows): np.zeros(1)}
    for total in columns:
        grown: dict[tuple[int, ...], list[np.ndarray]] = {}
        for rest, weights in states.items():
            cells = _fillings(total, rest)
            _spend(budget, len(cells) * len(weights))
            added = log_factorial[cells].sum(axis=1)
            for left, weight in zip((np.array(rest) - cells).tolist(), added, strict=True):
                grown.setdefault(tuple(left), []).append(weights - weight)
        states = {key: np.concatenate(parts) for key, parts in grown.items()}
    return states


def _completions(
    rest: tuple[int, ...], columns: tuple[int, ...], log_factorial: np.ndarray, budget: list[int]
) -> np.ndarray:
    """Return the logs of 1 / prod(cell!) of all ways to fill ``columns`` with row sums ``rest``."""
    if len(columns) == 1:
        return -log_factorial[list(rest)].sum(keepdims=True)
    cells = _fillings(columns[0], rest)
    left = np.array(rest) - cells
    weights = -log_factorial[cells].sum(axis=1)
    _spend(budget, len(cells))
    if len(columns) == 2:
        return weights - log_factorial[left].sum(axis=1)
    return np.concatenate(
        [
            weight + _completions(tuple(row), columns[1:], log_factorial, budget)
            for row, weight in zip(left.tolist(), weights, strict=True)
        ]
    )


def _spend(budget: list[int], tables: int) -> None:
    budget[0] -= tables
    if budget[0] < 0:
        raise _too_large()


def _too_large() -> InputError:
    return InputError(
        "the table is too large for an exact test",
        where="table",
        remedy="Merge categories, or use a chi-square or Monte Carlo test",
    )


def _fillings(total: int, room: tuple[int, ...]) -> np.ndarray:
    """Return all ways to put ``total`` into rows with space ``room``, shape (m, rows)."""
    filled = np.zeros((1, 0), dtype=int)
    open_total = np.array([total])
    for i, space in enumerate(room):
        later = sum(room[i + 1 :])
        low = np.maximum(0, open_total - later)
        count = np.maximum(np.minimum(open_total, space) - low + 1, 0)
        if int(count.sum()) > _LIMIT // 10:
            raise _too_large()
        which = np.repeat(np.arange(len(count)), count)
        first = np.cumsum(count) - count
        cell = low[which] + np.arange(len(which)) - first[which]
        filled = np.column_stack((filled[which], cell))
        open_total = open_total[which] - cell
    return filled
