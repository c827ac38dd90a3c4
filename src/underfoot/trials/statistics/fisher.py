"""Fisher's exact test for tables of any size: by enumeration, by Monte Carlo where that is long."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import lgamma
from typing import Self

import numpy as np

from underfoot.core import InputError

_EFFORT = 20_000_000  # tables that may be looked at, about five seconds of one processor
_LARGEST = 2_000_000  # tables held at once
_STEP = 40  # tables' worth of one step in Python
_TIE = 1e-7  # relative slack for tables exactly as likely as the observed one, as R uses
_DRAWS = 100_000
_SEED = 20_260_101  # fixed: the same table gives the same p


@dataclass(frozen=True, slots=True)
class ExactTest:
    """Two-sided p of Fisher's exact test; odds ratios for 2 x 2 tables only.

    ``p_error`` is the standard error of a p by Monte Carlo, None where all tables were counted.
    ``odds_ratio`` is the conditional maximum-likelihood estimate (R's), ``low`` to ``high`` its
    exact 95 % interval; ``sample_odds_ratio`` is ad / bc.
    """

    p: float
    table: tuple[tuple[int, ...], ...]
    p_error: float | None = None
    odds_ratio: float | None = None
    low: float | None = None
    high: float | None = None
    sample_odds_ratio: float | None = None


class _TooLongError(Exception):
    """Enumeration would take longer than a person waits."""


def fisher_exact(table: Sequence[Sequence[int]] | np.ndarray) -> ExactTest:
    """Return Fisher's exact test of an r x c table of counts.

    All tables with the same margins are enumerated: the first half of the columns is filled and
    grouped by the row sums it leaves, each group is completed once, equally likely tables are
    counted together, and probabilities no larger than the observed one are added (the two-sided
    rule of Freeman and Halton, Biometrika 38, 1951, 141). Where that would take more than about
    five seconds, p is the share of 100 000 random tables with the same margins (Patefield's
    algorithm, fixed seed), and ``p_error`` its standard error.

    InputError: negative or broken counts, fewer than two filled rows or columns.
    """
    counts = np.asarray(table)
    if counts.ndim != 2 or (counts < 0).any() or not np.equal(np.mod(counts, 1), 0).all():
        raise InputError("counts must be whole and not negative", where="table")
    counts = counts.astype(int)
    as_tuples = tuple(map(tuple, counts.tolist()))
    counts = counts[counts.sum(axis=1) > 0][:, counts.sum(axis=0) > 0]
    if min(counts.shape) < 2:
        remedy = "An exact test needs two groups and two outcomes"
        raise InputError("fewer than two rows or columns hold counts", where="table", remedy=remedy)
    error = None
    try:
        p = _exact(counts if counts.shape[0] <= counts.shape[1] else counts.T)
    except _TooLongError:
        p, error = _monte_carlo(counts)
    if counts.shape != (2, 2):
        return ExactTest(p, as_tuples, error)
    from scipy.stats.contingency import odds_ratio

    ratio = odds_ratio(counts, kind="conditional")
    interval = ratio.confidence_interval(0.95)
    a, b, c, d = counts.astype(float).ravel().tolist()
    sample = a * d / (b * c) if b * c else float("inf")
    odds, low, high = map(float, (ratio.statistic, interval.low, interval.high))
    return ExactTest(p, as_tuples, error, odds, low, high, sample)


def _monte_carlo(counts: np.ndarray) -> tuple[float, float]:
    from scipy.special import gammaln
    from scipy.stats import random_table

    tables = random_table(counts.sum(axis=1), counts.sum(axis=0))
    rng = np.random.default_rng(_SEED)
    bound = float(gammaln(counts + 1.0).sum()) - _TIE
    share, done = 0, 0
    while done < _DRAWS:
        size = min(_DRAWS - done, max(1, 2_000_000 // counts.size))
        drawn = tables.rvs(size, method="patefield", random_state=rng)
        share += int((gammaln(drawn + 1.0).sum(axis=(1, 2)) >= bound).sum())
        done += size
    p = (share + 1) / (_DRAWS + 1)
    return p, float(np.sqrt(p * (1.0 - p) / _DRAWS))


class _Weights:
    """Ways to fill some columns: log of 1 / prod(cell!) and how many ways share it."""

    __slots__ = ("logs", "ways")

    def __init__(self, logs: np.ndarray, ways: np.ndarray) -> None:
        # Equal weights are counted together: tables of few counts have few different ones.
        order = np.argsort(logs, kind="stable")
        logs, ways = logs[order], ways[order]
        first = np.concatenate(([True], np.diff(logs) > 1e-10))
        self.logs = logs[first]
        self.ways = np.add.reduceat(ways, np.flatnonzero(first))

    @classmethod
    def join_parts(cls, parts: Sequence[tuple[np.ndarray, np.ndarray]]) -> Self:
        return cls(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def _exact(counts: np.ndarray) -> float:
    # Small columns first: they make the few row sums from which the rest is completed.
    counts = counts[:, np.argsort(counts.sum(axis=0), kind="stable")]
    rows, columns = (tuple(counts.sum(axis=axis).tolist()) for axis in (1, 0))
    log_factorial = np.array([lgamma(i + 1.0) for i in range(int(counts.sum()) + 1)])
    search = _Enumeration(log_factorial)
    constant = log_factorial[list(rows)].sum() + log_factorial[list(columns)].sum()
    constant -= log_factorial[-1]
    bound = -log_factorial[counts].sum() + np.log1p(_TIE)
    half = len(columns) // 2
    total = 0.0
    for rest, first in search.beginnings(rows, columns[:half]).items():
        last = search.completions(rest, columns[half:])
        sums = np.concatenate(([0.0], np.cumsum(last.ways * np.exp(last.logs + constant))))
        reach = np.searchsorted(last.logs, bound - first.logs, side="right")
        total += float(np.sum(first.ways * np.exp(first.logs) * sums[reach]))
    return min(total, 1.0)


class _Enumeration:
    """Fillings of columns with a limit on the work, the same on every machine."""

    def __init__(self, log_factorial: np.ndarray) -> None:
        self.log_factorial = log_factorial
        self.left = _EFFORT
        self.known: dict[tuple[tuple[int, ...], tuple[int, ...]], _Weights] = {}

    def beginnings(
        self, rows: tuple[int, ...], columns: tuple[int, ...]
    ) -> dict[tuple[int, ...], _Weights]:
        """Return the ways to fill ``columns``, by what they leave of the row sums."""
        states = {rows: _Weights(np.zeros(1), np.ones(1))}
        for total in columns:
            grown: dict[tuple[int, ...], list[tuple[np.ndarray, np.ndarray]]] = {}
            for rest, before in states.items():
                cells = self._fillings(total, rest)
                self._spend(len(cells) * (len(before.logs) + _STEP))
                added = self.log_factorial[cells].sum(axis=1)
                for left, weight in zip((np.array(rest) - cells).tolist(), added, strict=True):
                    grown.setdefault(tuple(left), []).append((before.logs - weight, before.ways))
            states = {key: _Weights.join_parts(parts) for key, parts in grown.items()}
        return states

    def completions(self, rest: tuple[int, ...], columns: tuple[int, ...]) -> _Weights:
        """Return the ways to fill ``columns`` with row sums ``rest``."""
        if len(columns) == 1:
            return _Weights(-self.log_factorial[list(rest)].sum(keepdims=True), np.ones(1))
        # The order of the rows does not matter: sorted sums are found again more often.
        key = (tuple(sorted(rest)), columns)
        if key in self.known:
            return self.known[key]
        cells = self._fillings(columns[0], rest)
        left = np.array(rest) - cells
        logs = -self.log_factorial[cells].sum(axis=1)
        if len(columns) == 2:
            self._spend(len(cells) + _STEP)
            weights = _Weights(logs - self.log_factorial[left].sum(axis=1), np.ones(len(cells)))
        else:
            parts = []
            for row, log in zip(left.tolist(), logs, strict=True):
                later = self.completions(tuple(row), columns[1:])
                self._spend(len(later.logs) + _STEP)
                parts.append((log + later.logs, later.ways))
            weights = _Weights.join_parts(parts)
        self.known[key] = weights
        return weights

    def _spend(self, tables: int) -> None:
        self.left -= tables
        if self.left < 0:
            raise _TooLongError

    def _fillings(self, total: int, room: tuple[int, ...]) -> np.ndarray:
        """Return all ways to put ``total`` into rows with space ``room``, shape (m, rows)."""
        filled = np.zeros((1, 0), dtype=int)
        open_total = np.array([total])
        for i, space in enumerate(room):
            low = np.maximum(0, open_total - sum(room[i + 1 :]))
            count = np.maximum(np.minimum(open_total, space) - low + 1, 0)
            if int(count.sum()) > _LARGEST:
                raise _TooLongError
            which = np.repeat(np.arange(len(count)), count)
            cell = low[which] + np.arange(len(which)) - (np.cumsum(count) - count)[which]
            filled = np.column_stack((filled[which], cell))
            open_total = open_total[which] - cell
        return filled
