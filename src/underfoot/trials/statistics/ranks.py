"""Rank tests of persons' means, for quantities whose scatter is not normal."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError

from .mixed import person_means


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
    a person are averaged first.

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
        found: Any = stats.mannwhitneyu(groups[0], groups[1]) if two else stats.kruskal(*groups)
        name = "Mann-Whitney U" if two else "Kruskal-Wallis H"
        return RankTest(name, float(found.statistic), float(found.pvalue), len(table))
    whole = np.array([[own[n] for n in names] for own in table.values() if len(own) == len(names)])
    if len(whole) < 5:
        words = f"{len(whole)} persons have every level"
        raise DataError(words, where="rank test", allowed="five or more")
    if len(names) == 2:
        found, name = stats.wilcoxon(whole[:, 0], whole[:, 1]), "Wilcoxon signed ranks W"
    else:
        found, name = stats.friedmanchisquare(*whole.T), "Friedman chi squared"
    return RankTest(name, float(found.statistic), float(found.pvalue), len(whole))
