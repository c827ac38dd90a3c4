"""Fisher's exact test for tables of any size, by enumeration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import lgamma

import numpy as np

from underfoot.core import InputError

_LIMIT = 5_000_000
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

    All tables with the same margins are enumerated: columns are split into two halves, each
    half's tables are grouped by the row sums they use up, and probabilities no larger than the
    observed one are added (the two-sided rule of Freeman and Halton, Biometrika 38, 1951, 141).

    Errors
    ------
    InputError
        Negative or broken counts, fewer than two filled rows or columns, or a table with more
        than five million partial tables (use a Monte Carlo or chi-square test there).
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
    rows, columns = counts.sum(axis=1), counts.sum(axis=0)
    constant = sum(lgamma(x + 1) for x in (*rows, *columns)) - lgamma(counts.sum() + 1)
    observed = constant - sum(lgamma(x + 1) for x in counts.ravel())
    # Equal halves of the columns give the fewest partial tables.
    half = (len(columns) + 1) // 2
    first = _partial(rows, columns[:half])
    second = _partial(rows, columns[half:])
    total = 0.0
    bound = observed + np.log1p(_TIE)
    for used, weights in first.items():
        rest = tuple(int(r - u) for r, u in zip(rows, used, strict=True))
        others = second.get(rest)
        if others is None:
            continue
        ordered = np.sort(others)
        sums = np.concatenate(([0.0], np.cumsum(np.exp(ordered + constant))))
        reach = np.searchsorted(ordered, bound - constant - weights, side="right")
        total += float(np.sum(np.exp(weights) * sums[reach]))
    return min(total, 1.0)


def _partial(rows: np.ndarray, columns: np.ndarray) -> dict[tuple[int, ...], np.ndarray]:
    """Return, for each vector of row sums used up, the logs of 1 / prod(cell!) of its tables."""
    states: dict[tuple[int, ...], np.ndarray] = {(0,) * len(rows): np.zeros(1)}
    for total in columns:
        grown: dict[tuple[int, ...], list[np.ndarray]] = {}
        made = 0
        for used, weights in states.items():
            room = [int(r - u) for r, u in zip(rows, used, strict=True)]
            for cells in _fillings(int(total), room):
                key = tuple(u + c for u, c in zip(used, cells, strict=True))
                weight = weights - sum(lgamma(c + 1) for c in cells)
                grown.setdefault(key, []).append(weight)
                made += len(weight)
                if made > _LIMIT:
                    raise InputError(
                        "the table is too large for an exact test",
                        where="table",
                        remedy="Merge categories, or use a chi-square or Monte Carlo test",
                    )
        states = {key: np.concatenate(parts) for key, parts in grown.items()}
    return states


def _fillings(total: int, room: list[int]) -> list[tuple[int, ...]]:
    if len(room) == 1:
        return [(total,)] if total <= room[0] else []
    rest = sum(room[1:])
    return [
        (first, *others)
        for first in range(max(0, total - rest), min(total, room[0]) + 1)
        for others in _fillings(total - first, room[1:])
    ]
