"""Rank tests of persons' means, for quantities whose scatter is not normal."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import combinations, permutations
from math import factorial, prod
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError
from underfoot.core.remark import Message

from .linear import LevelPair
from .mixed import person_means
from .samples import ROUNDING, corrected_p, merge_equal_values, ordered_levels

EXACT_TABLES = 2000  # persons ** (levels - 1) up to which Friedman's p is counted (a second)
EXACT_RANKS = 100  # persons up to which the orders of one or two groups are counted
_ORDERS = 100_000  # orders of several groups up to which all are counted, else so many are drawn


@dataclass(frozen=True, slots=True)
class RankTest:
    """Name of the test, its statistic, p (two-sided), and how many persons it compares.

    ``how``: "exact" (all orders counted), "drawn" (random orders; ``p_error`` is the standard error
    of p) or "large sample". ``pairs``: of three levels and more, each two: the
    median of their differences, p after Holm.
    """

    name: str
    statistic: float
    p: float
    persons: int
    how: str = "exact"
    p_error: float | None = None
    pairs: tuple[LevelPair, ...] = ()


def rank_test(
    response: ArrayLike, levels: Sequence[str], person: Sequence[object] = ()
) -> RankTest:
    """Return the rank test that fits: persons repeat or not, two levels or more.

    Wilcoxon's signed ranks and Friedman's test where every person has every level (those who do
    not are left out), Mann and Whitney's and Kruskal and Wallis's where nobody has two. Trials of
    a person are averaged first; means that differ by rounding alone are ties. p is exact, ties
    included, up to 100 persons at one or two levels, and for Friedman's test of few persons and
    levels (three levels: 44 persons, four: 12, five: 6), where chi squared would find 5.8 % of
    twelve-person studies without a difference significant at 5 %; beyond, by large samples.
    Kruskal and Wallis's p counts all orders up to 100,000, and draws as many beyond. Three levels
    and more are then compared by twos.

    ``response``: shape (n,). ``levels``: condition of each row. ``person``: whose each row is;
    each its own without.

    DataError: fewer than two levels, too few persons, some persons with several levels and too few
    with all, no scatter.
    """
    who = person if len(person) else range(len(levels))
    means = person_means(response, {"level": levels}, who)
    of = means.factors["level"]
    names = list(ordered_levels(of))
    table: dict[str, dict[str, float]] = {}
    for one, level, mean in zip(means.person, of, merge_equal_values(means.mean), strict=True):
        table.setdefault(one, {})[level] = float(mean)
    if len(names) < 2:
        raise DataError("a rank test needs two levels", where="rank test")
    several = any(len(own) > 1 for own in table.values())
    if several:
        table = {one: own for one, own in table.items() if len(own) == len(names)}
    columns = [np.array([own[n] for own in table.values() if n in own]) for n in names]
    fewest = min(map(len, columns))
    if fewest < (5 if several else 3):
        words = (
            Message("{fewest} persons have every level", fewest=fewest)
            if several
            else "fewer than three in a level"
        )
        allowed = "five or more" if several else "three or more"
        raise DataError(words, where="rank test", allowed=allowed)
    if len(names) == 2:
        return replace(_of_two(columns[0], columns[1], several), persons=len(table))
    whole = _of_many(columns, several)
    couples = list(combinations(range(len(names)), 2))
    single = [_of_two(columns[i], columns[j], several).p for i, j in couples]
    pairs = []
    for (i, j), p in zip(couples, corrected_p(single), strict=True):
        shift = columns[i] - columns[j] if several else np.subtract.outer(columns[i], columns[j])
        pairs.append(LevelPair(names[i], names[j], float(np.median(shift)), p))
    return replace(whole, persons=len(table), pairs=tuple(pairs))


def _of_two(a: np.ndarray, b: np.ndarray, several: bool) -> RankTest:
    """Return Wilcoxon's test of pairs (without those that are equal), or Mann and Whitney's."""
    from scipy import stats

    difference = a - b if several else np.zeros(0)
    if several:
        largest = max(np.abs(a).max(), np.abs(b).max())
        difference = difference[np.abs(difference) > ROUNDING * largest]
        if not len(difference):
            raise DataError("no person differs between the levels", where="rank test")
        # sizes are as exact as what they are differences of
        sizes = merge_equal_values(np.append(np.abs(difference), largest))[:-1]
        ranks, chosen = stats.rankdata(sizes), None
        up = float(ranks[difference > 0].sum())
        name, statistic, observed = "Wilcoxon signed ranks W", min(up, ranks.sum() - up), up
    else:
        ranks, chosen = stats.rankdata(np.concatenate((a, b))), len(a)
        if np.ptp(ranks) == 0:
            raise DataError("the values do not scatter", where="rank test")
        observed = float(ranks[:chosen].sum())
        name, statistic = "Mann-Whitney U", observed - chosen * (chosen + 1) / 2.0
    if len(ranks) <= EXACT_RANKS:
        return RankTest(name, statistic, _sum_p(ranks, chosen, observed), 0)
    test: Any = stats.wilcoxon(difference) if several else stats.mannwhitneyu(a, b)
    return RankTest(name, statistic, float(test.pvalue), 0, "large sample")


def _sum_p(ranks: np.ndarray, chosen: int | None, observed: float) -> float:
    """Return the chance that a sum of ranks lies as far from its mean as the observed one.

    Over all ways to choose so many of the ranks; ``chosen`` None: any number of them. Ranks count
    twice (ties are halves).
    """
    twice = np.rint(2.0 * ranks).astype(int)
    total, most = int(twice.sum()), len(twice) if chosen is None else chosen
    ways = np.zeros((most + 1, total + 1))  # of each number of ranks, by their sum
    ways[0, 0] = 1.0
    for rank in twice:
        ways[1:, rank:] += ways[:-1, : total + 1 - rank].copy()
    sums = ways.sum(axis=0) if chosen is None else ways[chosen]
    middle = 0.5 * total if chosen is None else total * chosen / len(twice)
    far = np.abs(np.arange(total + 1) - middle) >= abs(round(2.0 * observed) - middle) - 1e-9
    return float(min(sums[far].sum() / sums.sum(), 1.0))


def _of_many(columns: Sequence[np.ndarray], several: bool) -> RankTest:
    from scipy import stats

    if several:
        whole = np.stack(columns, axis=1)
        with np.errstate(invalid="ignore"):  # of persons whose levels are all alike
            test: Any = stats.friedmanchisquare(*whole.T)
        if not np.isfinite(test.statistic):
            raise DataError("no person differs between the levels", where="rank test")
        if len(whole) ** (whole.shape[1] - 1) > EXACT_TABLES:
            p, how = float(test.pvalue), "large sample"
        else:
            p, how = _exact_p(stats.rankdata(whole, axis=1)), "exact"
        return RankTest("Friedman chi squared", float(test.statistic), p, 0, how)
    everyone = np.concatenate(columns)
    if np.ptp(everyone) == 0:
        raise DataError("the values do not scatter", where="rank test")
    sizes = [len(column) for column in columns]
    statistic = float(stats.kruskal(*columns).statistic)
    twice = np.rint(2.0 * stats.rankdata(everyone)).astype(int)

    def spread_of(sums: np.ndarray) -> np.ndarray:
        return np.sum(sums**2 / np.array(sizes), axis=-1)

    ends = np.cumsum(sizes)[:-1]
    observed = float(spread_of(np.array([part.sum() for part in np.split(twice, ends)], float)))
    least = observed * (1.0 - 1e-12)
    count = factorial(len(twice)) // prod(map(factorial, sizes))
    name = "Kruskal-Wallis H"
    if count <= _ORDERS:
        sums = _all_sums(tuple(sorted(twice.tolist())), tuple(sizes))
        far = float(np.mean(spread_of(sums) >= least))
        return RankTest(name, statistic, far, 0)
    draws = np.random.default_rng(0).permuted(np.tile(twice, (_ORDERS, 1)), axis=1)
    sums = np.add.reduceat(draws, [0, *ends.tolist()], axis=1)
    far = (float(np.sum(spread_of(sums) >= least)) + 1.0) / (_ORDERS + 1.0)
    return RankTest(name, statistic, far, 0, "drawn", float(np.sqrt(far * (1.0 - far) / _ORDERS)))


@lru_cache(maxsize=4)
def _all_sums(ranks: tuple[int, ...], sizes: tuple[int, ...]) -> np.ndarray:
    return np.array(_group_sums(ranks, sizes), dtype=float)


def _group_sums(ranks: tuple[int, ...], sizes: tuple[int, ...]) -> list[tuple[int, ...]]:
    """Return the sums of ranks in each group, for each way to deal them out."""
    if len(sizes) == 1:
        return [(sum(ranks),)]
    dealt = []
    for own in combinations(range(len(ranks)), sizes[0]):
        rest = tuple(rank for i, rank in enumerate(ranks) if i not in own)
        first = sum(ranks[i] for i in own)
        dealt += [(first, *sums) for sums in _group_sums(rest, sizes[1:])]
    return dealt


def _exact_p(ranks: np.ndarray) -> float:
    """Return the chance that rank sums spread as far when each person's ranks are shuffled.

    Counts the tables of all orders within rows, shape (persons, levels), ties kept. Sums are held
    twice (ties are halves) and sorted: the columns of a shuffled table can change places.
    """
    rows = [sorted(row) for row in (2 * ranks).astype(int).tolist()]
    tables = Counter({(0,) * ranks.shape[1]: 1})
    for row in rows:
        orders = set(permutations(row))  # each as often as any other, where ranks are alike too
        longer: Counter[tuple[int, ...]] = Counter()
        for sums, ways in tables.items():
            for order in orders:
                longer[tuple(sorted(map(int.__add__, sums, order)))] += ways
        tables = longer
    spread = sum(total**2 for total in (2 * ranks).sum(axis=0).astype(int).tolist())
    far = sum(ways for sums, ways in tables.items() if sum(s**2 for s in sums) >= spread)
    return far / tables.total()
