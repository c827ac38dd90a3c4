"""Sizes of effects, equivalence, and how many persons a study needs."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, InputError, unknown_name
from underfoot.core.remark import Message

from .samples import KINDS, t_test
from .shares import is_share, score, share_difference

DESIGNS = {
    "paired": "every person in both conditions, paired t test",
    "groups": "different persons in two conditions, two-sample t test",
    "repeated": "every person in all conditions, repeated-measures F test",
    "slips": "shares of slips in two groups of persons, Fisher's exact test",
    "slips_equivalent": "shares of slips in two groups, equal within the difference, score tests",
}


@dataclass(frozen=True, slots=True)
class EffectSize:
    """Hedges' g (unbiased) with its interval; ``name`` says which difference it is of."""

    name: str
    value: float
    low: float
    high: float


def effect_size(
    first: ArrayLike, second: ArrayLike, *, paired: bool = False, confidence: float = 0.95
) -> EffectSize:
    """Return the standardised difference of means with an exact interval (noncentral t).

    Paired: mean difference over the SD of the differences (g_z). Otherwise over the pooled SD.
    The bias of Cohen's d is removed by J = Gamma(df/2) / (sqrt(df/2) Gamma((df-1)/2)).

    DataError: as ``t_test``; one degree of freedom, for which J is zero.

    Source: L. V. Hedges, J. Educ. Stat. 6 (1981) 107; G. Cumming, S. Finch, Educ. Psychol. Meas.
    61 (2001) 532.
    """
    from scipy.optimize import brentq
    from scipy.special import gammaln
    from scipy.stats import nct

    test = t_test(first, second, kind="paired" if paired else "pooled")
    sizes = len(np.asarray(first)), len(np.asarray(second))
    scale = np.sqrt(1.0 / sizes[0] if paired else 1.0 / sizes[0] + 1.0 / sizes[1])
    df, tail = test.df, 0.5 - confidence / 2
    if df < 2:
        raise DataError("two persons have no unbiased effect size", where="effect size")

    def centre(probability: float) -> float:
        def beyond(c: float) -> float:  # the library gives NaN where the answer is 0 or 1
            return float(np.nan_to_num(nct.cdf(test.t, df, c), nan=c < test.t)) - probability

        reach = 10.0 + 1.5 * abs(test.t)
        return float(np.asarray(brentq(beyond, test.t - reach, test.t + reach, xtol=1e-10)))

    unbiased = float(np.exp(gammaln(df / 2) - gammaln((df - 1) / 2)) / np.sqrt(df / 2))
    name = "g_z (SD of differences)" if paired else "g (pooled SD)"
    values = (test.t, centre(1.0 - tail), centre(tail))
    return EffectSize(name, *(unbiased * float(scale * value) for value in values))


@dataclass(frozen=True, slots=True)
class Equivalence:
    """Two one-sided tests of ``first`` - ``second`` against -margin and +margin.

    ``not_lower``: p of "lower by the margin or more"; ``not_higher``: p of "higher by the margin
    or more". ``low`` to ``high`` is the interval at 1 - 2 alpha that lies inside the margins when
    both fall below alpha.
    """

    difference: float
    margin: float
    not_lower: float
    not_higher: float
    low: float
    high: float
    alpha: float

    @property
    def verdict(self) -> str:
        """What is shown at ``alpha``: "equivalent", "not lower", "not higher" or "not shown"."""
        lower, higher = self.not_lower < self.alpha, self.not_higher < self.alpha
        if lower and higher:
            return "equivalent"
        return "not lower" if lower else "not higher" if higher else "not shown"


def equivalence(
    first: ArrayLike, second: ArrayLike, margin: float, *, kind: str = "welch", alpha: float = 0.05
) -> Equivalence:
    """Return two one-sided tests: no worse than, and equivalent within a margin.

    t tests of measurements; of slips (0 and 1 alone) the score tests of ``share_difference``. The
    margin is fixed before the data are seen. A difference that is not significant does not show
    equality; this does.

    ``margin``: above 0, in the unit of the values. ``kind``: as ``t_test``.

    InputError: a margin that is not above 0. DataError: as ``t_test``.

    Source: D. J. Schuirmann, J. Pharmacokin. Biopharm. 15 (1987) 657.
    """
    from scipy.stats import t as student

    if not margin > 0:
        raise InputError(
            Message("margin {margin:g}", margin=margin), where="equivalence", allowed="above 0"
        )
    both = np.concatenate((np.ravel(np.asarray(first)), np.ravel(np.asarray(second))))
    if kind in KINDS and len(both) and is_share(both):
        told = share_difference(first, second, paired=kind == "paired", confidence=1 - 2 * alpha)
        p = told.beyond(-margin), 1.0 - told.beyond(margin)
        return Equivalence(told.difference, margin, *p, told.low, told.high, alpha)
    test = t_test(first, second, kind=kind, confidence=1.0 - 2.0 * alpha)
    error = (test.high - test.low) / (2.0 * float(student.isf(alpha, test.df)))
    lower = float(student.sf((test.difference + margin) / error, test.df))
    higher = float(student.cdf((test.difference - margin) / error, test.df))
    return Equivalence(test.difference, margin, lower, higher, test.low, test.high, alpha)


def power(
    design: str, persons: int, *, difference: float = 0.0, sd: float = 1.0,
    conditions: int = 2, shares: tuple[float, float] = (0.0, 0.0), alpha: float = 0.05,
) -> float:  # fmt: skip
    """Return the chance that a study finds a difference that is there (two-sided test).

    ``design``: a key of ``DESIGNS``. ``persons``: in all ("paired", "repeated") or in each group.
    ``difference``: between two means; in "repeated" that of the largest and the smallest mean, the
    others in the middle; in "slips_equivalent" the margin. ``sd``: of the differences within
    persons ("paired"), of a person's mean about its own in one condition ("repeated"), between
    persons ("groups"); 1 makes the difference one in standard deviations. ``shares``: of slips.

    InputError: an unknown design, numbers out of range.
    """
    from scipy import stats

    if design not in DESIGNS:
        raise unknown_name("design", design, DESIGNS, where="power")
    if persons < 2 or not sd > 0 or not 0 < alpha < 1 or conditions < 2:
        words = Message(
            "{persons} persons, sd {sd:g}, alpha {alpha:g}, {conditions} conditions",
            persons=persons,
            sd=sd,
            alpha=alpha,
            conditions=conditions,
        )
        allowed = "2 persons or more, sd above 0, alpha from 0 to 1, 2 conditions or more"
        raise InputError(words, where="power", allowed=allowed)
    if design == "slips":
        return _fisher_power(persons, shares, alpha)
    if design == "slips_equivalent":
        return _equivalent_power(persons, shares, difference, alpha)
    if design == "repeated":
        df = conditions - 1, (conditions - 1) * (persons - 1)
        centre = persons * (difference / sd) ** 2 / 2.0
        return float(stats.ncf.sf(stats.f.isf(alpha, *df), *df, centre))
    df = persons - 1 if design == "paired" else 2 * (persons - 1)
    error = sd * np.sqrt(1.0 / persons if design == "paired" else 2.0 / persons)
    limit = float(stats.t.isf(alpha / 2, df))
    centre = abs(difference) / error
    # the far tail underflows to NaN where it is 0
    far = float(np.nan_to_num(stats.nct.cdf(-limit, df, centre)))
    return float(stats.nct.sf(limit, df, centre)) + far


def _equivalent_power(
    persons: int, shares: tuple[float, float], margin: float, alpha: float
) -> float:
    """Sum over all tables that both score tests reject."""
    from scipy import stats

    if not all(0 <= share <= 1 for share in shares) or not 0 < margin < 1:
        words = Message("shares {shares}, difference {margin:g}", shares=shares, margin=margin)
        raise InputError(words, where="power", allowed="shares 0 to 1, a difference from 0 to 1")
    slips = np.arange(persons + 1)
    a, b = slips[:, None] / persons, slips[None, :] / persons
    limit = float(stats.norm.isf(alpha))
    lower = score(a, b, persons, persons, -margin) > limit
    higher = score(a, b, persons, persons, margin) < -limit
    chances = [stats.binom.pmf(slips, persons, share) for share in shares]
    return float(chances[0] @ (lower & higher) @ chances[1])


def _fisher_power(persons: int, shares: tuple[float, float], alpha: float) -> float:
    """Sum over all tables that the exact test rejects."""
    from scipy import stats

    if not all(0 <= share <= 1 for share in shares):
        raise InputError(Message("shares {shares}", shares=shares), where="power", allowed="0 to 1")
    slips = np.arange(persons + 1)
    chances = [stats.binom.pmf(slips, persons, share) for share in shares]
    total = 0.0
    for both in range(2 * persons + 1):
        first = np.arange(max(0, both - persons), min(persons, both) + 1)
        table = stats.hypergeom.pmf(first, 2 * persons, both, persons)
        p = np.array([table[table <= one * (1 + 1e-7)].sum() for one in table])
        rejected = first[p <= alpha]
        total += float(chances[0][rejected] @ chances[1][both - rejected])
    return total


def persons_needed(power_of: Callable[[int], float], wanted: float = 0.8) -> int:
    """Return the smallest number of persons whose power reaches ``wanted``, as ``power`` counts.

    InputError: ``wanted`` outside 0 to 1, or more than 5000 persons.
    """
    if not 0 < wanted < 1:
        raise InputError(
            Message("power {power:g}", power=wanted), where="power", allowed="between 0 and 1"
        )
    few, many = 1, 4
    while power_of(many) < wanted:
        few, many = many, 2 * many
        if many > 5000:
            raise InputError("more than 5000 persons", where="power", remedy="Seek a larger effect")
    while many - few > 1:
        middle = (few + many) // 2
        few, many = (few, middle) if power_of(middle) >= wanted else (middle, many)
    return many


def detectable_difference(design: str, persons: int, sd: float, wanted: float = 0.8) -> float:
    """Return the difference that a study of ``persons`` finds with power ``wanted`` (``power``)."""
    from scipy.optimize import brentq

    def short(difference: float) -> float:
        return power(design, persons, difference=difference, sd=sd) - wanted

    return float(np.asarray(brentq(short, 1e-9 * sd, 100.0 * sd, xtol=1e-6 * sd)))
