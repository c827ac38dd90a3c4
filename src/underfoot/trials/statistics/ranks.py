"""Rank tests of persons' means, for quantities whose scatter is not normal."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError

from .mixed import person_means

EXACT_TABLES = 2000  # persons ** (levels - 1) up to which Friedman's p is counted (a second)


@dataclass(frozen=True, slots=True)
class RankTest:
    """Name of the test, its statistic, p (two-sided), and how many persons it compares."""

    name: str
    statistic: float
    p: float
    persons: int


def rank_test(
    response: ArrayLike, levels: Sequence[str], person: Sequence[object] = ()
) -> RankTest:
    """Return the rank test that fits: persons repeat or not, two levels or more.

    Wilcoxon's signed ranks and Friedman's test where every person has every level (those who do
    not are left out), Mann and Whitney's and Kruskal and Wallis's where nobody has two. Trials of
    a person are averaged first. Friedman's p is exact for few persons and levels (three levels: 44
    persons, four: 12, five: 6), where chi squared would find 5.8 % of twelve-person studies without
    a difference significant at 5 %; beyond, chi squared.

    ``response``: shape (n,). ``levels``: condition of each row. ``person``: whose each row is;
    each its own without.

    DataError: fewer than two levels, too few persons, some persons with several levels and too few
    with all.
    """
    from scipy import stats

    who = person if len(person) else range(len(levels))
    means = person_means(response, {"level": levels}, who)
    of = means.factors["level"]
    names = list(dict.fromkeys(of))
    table: dict[str, dict[str, float]] = {}
    for one, level, mean in zip(means.person, of, means.mean, strict=True):
        table.setdefault(one, {})[level] = float(mean)
    if len(names) < 2:
        raise DataError("a rank test needs two levels", where="rank test")
    if all(len(own) == 1 for own in table.values()):
        groups = [[own[name] for own in table.values() if name in own] for name in names]
        if min(map(len, groups)) < 3:
            raise DataError("fewer than three persons in a level", where="rank test")
        two = len(names) == 2
        test: Any = stats.mannwhitneyu(groups[0], groups[1]) if two else stats.kruskal(*groups)
        name = "Mann-Whitney U" if two else "Kruskal-Wallis H"
        return RankTest(name, float(test.statistic), float(test.pvalue), len(table))
    whole = np.array([[own[n] for n in names] for own in table.values() if len(own) == len(names)])
    if len(whole) < 5:
        words = f"{len(whole)} persons have every level"
        raise DataError(words, where="rank test", allowed="five or more")
    if len(names) == 2:
        test, name = stats.wilcoxon(whole[:, 0], whole[:, 1]), "Wilcoxon signed ranks W"
    else:
        test, name = stats.friedmanchisquare(*whole.T), "Friedman chi squared"
        if len(whole) ** (len(names) - 1) <= EXACT_TABLES:
            p = _exact_p(stats.rankdata(whole, axis=1))
            return RankTest(name, float(test.statistic), p, len(whole))
    return RankTest(name, float(test.statistic), float(test.pvalue), len(whole))


def _exact_p(ranks: np.ndarray) -> float:
    """Return the chance that rank sums spread as far when each person's ranks are shuffled.

    Counts the tables of all orders within rows, shape (persons, levels), ties kept. Sums are held
    twice (ties are halves) and sorted: the columns of a shuffled table can change places.
    """
    rows = [sorted(row) for row in (2 * ranks).astype(int).tolist()]
    tables = Counter({(0,) * ranks.shape[1]: 1})
    for row in rows:
        orders = Counter(permutations(row))
        longer: Counter[tuple[int, ...]] = Counter()
        for sums, ways in tables.items():
            for order, times in orders.items():
                longer[tuple(sorted(map(int.__add__, sums, order)))] += ways * times
        tables = longer
    spread = sum(total**2 for total in (2 * ranks).sum(axis=0).astype(int).tolist())
    far = sum(ways for sums, ways in tables.items() if sum(s**2 for s in sums) >= spread)
    return far / tables.total()
