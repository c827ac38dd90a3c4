"""Few values, equal values, slips: p counted by hand, equality by resolution, shares in print."""

import sys
from itertools import combinations, permutations, product

import numpy as np
import pytest
from scipy import stats

from underfoot.core import DataError, InputError, MissingExtraError
from underfoot.trials.statistics import (
    bland_altman,
    corrected_p,
    equivalence,
    intraclass_correlation,
    letters,
    linear_model,
    logistic_regression,
    merge_equal_values,
    paired_curve_test,
    persons_needed,
    power,
    rank_test,
    share_difference,
    t_test,
)
from underfoot.trials.statistics.agreement import FORMS
from underfoot.trials.statistics.shares import score


def apart(*groups):
    """Values and levels of groups of different persons."""
    names = [f"level {i}" for i, group in enumerate(groups) for _ in group]
    return [value for group in groups for value in group], names


def counted(values, sizes, statistic):
    """Share of all orders in which a statistic is as large, by hand."""
    observed = statistic(np.split(np.asarray(values), np.cumsum(sizes)[:-1]))
    every = [
        statistic(np.split(np.array(order), np.cumsum(sizes)[:-1]))
        for order in permutations(values)
    ]
    return np.mean(np.array(every) >= observed - 1e-9)


def test_mann_whitney_counts_all_orders():
    test = rank_test(*apart([35, 35, 35], [36, 36, 36]))
    assert (test.p, test.how) == (pytest.approx(0.10), "exact")
    a, b = [1.0, 2.0, 2.0, 5.0], [2.0, 7.0, 9.0]
    ranks = stats.rankdata(a + b)
    by_hand = counted(ranks, [4, 3], lambda parts: abs(parts[0].sum() - 4 * ranks.mean()))
    assert rank_test(*apart(a, b)).p == pytest.approx(by_hand)
    rng = np.random.default_rng(1)
    x, y = rng.normal(size=40), rng.normal(size=50)
    exact = stats.mannwhitneyu(x, y, method="exact").pvalue
    assert rank_test(*apart(x, y)).p == pytest.approx(exact)


def test_wilcoxon_counts_all_signs_of_rounded_readings():
    """Differences of 0.01 are ties, whatever the last digit of the computer's numbers."""
    first = np.array([0.18, 0.19, 0.21, 0.25, 0.30, 0.33])
    second = first - np.array([0.01, 0.01, -0.01, 0.02, 0.02, 0.03])
    second = np.round(second, 2)
    who = np.repeat(np.arange(6), 2)
    test = rank_test(np.ravel(np.column_stack((first, second))), ["a", "b"] * 6, who)
    ranks = np.array([2, 2, 2, 4.5, 4.5, 6])
    observed = abs(ranks[[0, 1, 3, 4, 5]].sum() - ranks[2])
    every = [abs(np.dot(signs, ranks)) for signs in product((-1, 1), repeat=6)]
    assert test.p == pytest.approx(np.mean(np.array(every) >= observed - 1e-9))
    hundred = rank_test(np.ravel(np.column_stack((100 * first, 100 * second))), ["a", "b"] * 6, who)
    assert hundred.p == test.p


@pytest.mark.parametrize(
    ("groups", "p"),
    [
        (([1, 2, 3], [4, 5, 6], [7, 8, 9]), 6 / 1680),
        (([1, 3, 4], [2, 6, 5], [7, 8, 9]), 0.025),
    ],
)
def test_kruskal_wallis_counts_all_orders(groups, p):
    test = rank_test(*apart(*groups))
    assert (test.p, test.how) == (pytest.approx(p), "exact")


def test_kruskal_wallis_of_four_a_group_errs_in_five_percent():
    """Its p is that of every parting of the ranks in three fours, which errs in 4.9 %."""
    ranks = set(range(1, 13))
    sums = [
        sum(a) ** 2 + sum(b) ** 2 + (78 - sum(a) - sum(b)) ** 2
        for a in combinations(ranks, 4)
        for b in combinations(ranks - set(a), 4)
    ]
    sums, counts = np.unique(sums, return_counts=True)
    tail = counts[::-1].cumsum()[::-1] / counts.sum()
    assert tail[tail < 0.05].max() == pytest.approx(0.049, abs=5e-4)
    rng = np.random.default_rng(2)
    for shift in (0.0, 0.0, 1.0, 2.0):
        groups = rng.normal(size=(3, 4)) + shift * np.arange(3)[:, None]
        squares = (stats.rankdata(groups).reshape(3, 4).sum(axis=1) ** 2).sum()
        test = rank_test(*apart(*groups))
        assert (test.p, test.how) == (pytest.approx(tail[sums == squares][0]), "exact")
    many = rng.normal(size=(3, 12))
    drawn = rank_test(*apart(*many))
    assert drawn.how == "drawn"
    assert drawn.p == pytest.approx(stats.kruskal(*many).pvalue, abs=0.02)
    assert drawn == rank_test(*apart(*many))


def test_pairs_after_a_rank_test_have_letters():
    test = rank_test(*apart(np.arange(8.0), np.arange(8.0) + 0.5, np.arange(8.0) + 20))
    assert {(one.first, one.second) for one in test.pairs} == set(
        combinations(["level 0", "level 1", "level 2"], 2)
    )
    single = stats.mannwhitneyu(np.arange(8.0), np.arange(8.0) + 20, method="exact").pvalue
    assert test.pairs[1].p == pytest.approx(3 * single)
    marks = letters(test.pairs)
    assert marks["level 0"] == marks["level 1"] != marks["level 2"]


def test_values_that_differ_by_rounding_are_equal():
    assert len(set(merge_equal_values([0.1 + 0.2, 0.3, 0.31]))) == 2
    readings = np.array([0.18, 0.19, 0.20, 0.21])
    for factor in (1.0, 1e-9, 1e9):
        with pytest.raises(DataError, match="scatter"):
            t_test(factor * readings, factor * np.array([0.17, 0.18, 0.19, 0.20]), kind="paired")
        with pytest.raises(DataError, match="scatter"):
            bland_altman(factor * readings, factor * np.array([0.17, 0.18, 0.19, 0.20]))


def curves(seed=0):
    from scipy.ndimage import gaussian_filter1d

    a, b = gaussian_filter1d(np.random.default_rng(seed).normal(size=(2, 8, 101)), 6, axis=2)
    a[:, 40:60] += 0.5
    return a, b


@pytest.mark.parametrize("scatter", [0.0, 1e-17, 1e-6])
def test_a_sample_without_scatter_is_named_and_left_out(scatter):
    a, b = curves()
    without = paired_curve_test(a[:, 1:], b[:, 1:])
    a[:, 0] = b[:, 0] + 0.1 + scatter * np.arange(8)
    found = paired_curve_test(a, b)
    assert found.still == (0,)
    assert np.isnan(found.t[0])
    assert found.fwhm == pytest.approx(without.fwhm, rel=0.01)
    assert found.threshold == pytest.approx(without.threshold, abs=0.02)


def test_curves_are_the_same_in_another_unit():
    a, b = curves()
    one, other = paired_curve_test(a, b), paired_curve_test(1e-8 * a, 1e-8 * b)
    assert (other.fwhm, other.threshold) == pytest.approx((one.fwhm, one.threshold), rel=1e-9)


def test_a_cluster_has_the_chance_of_its_length():
    """spm1d 0.4.55, two-tailed, of the same curves."""
    found = paired_curve_test(*curves())
    assert (found.fwhm, found.threshold) == pytest.approx((14.505187706338715, 4.749164569689002))
    (one,) = found.clusters
    assert one.p == pytest.approx(4.24931023701447e-09, rel=1e-6)
    assert one.p_peak > one.p


def test_raters_who_agree_have_an_icc_of_one():
    for values in ([[1, 1], [2, 2], [3, 3]], [[0.1, 0.1], [0.3, 0.1 + 0.2], [0.7, 0.7]]):
        for form in FORMS:
            icc = intraclass_correlation(values, form)
            assert (icc.value, icc.low, icc.high, icc.error) == (1, 1, 1, 0)
    shifted = [[1, 2], [2, 3], [4, 5]]
    assert intraclass_correlation(shifted, "ICC(C,1)").value == 1
    assert intraclass_correlation(shifted, "ICC(A,1)").value < 1
    with pytest.raises(DataError, match="do not differ"):
        intraclass_correlation([[1, 1], [1, 1]])


def test_the_interval_of_an_icc_is_never_upside_down():
    rng = np.random.default_rng(0)
    for _ in range(300):
        n, k = rng.integers(2, 6), rng.integers(2, 5)
        x = rng.normal(size=(n, k)) + rng.normal(size=(n, 1)) * rng.choice([0, 0.3, 3])
        for form in FORMS:
            icc = intraclass_correlation(x + rng.normal(size=k) * rng.choice([0, 3]), form)
            assert icc.low <= icc.value <= icc.high <= 1


def slips(count, trials):
    return [1] * count + [0] * (trials - count)


@pytest.mark.parametrize(
    ("first", "second", "low", "high"),
    [  # Miettinen and Nurminen's interval as Newcombe 1998, Table II, method 6, prints it
        ((56, 70), (48, 80), 0.0528, 0.3382), ((5, 56), (0, 29), -0.0326, 0.1933),
        ((0, 20), (0, 20), -0.1646, 0.1646), ((9, 10), (3, 10), 0.1700, 0.8406),
        ((10, 10), (0, 10), 0.6636, 1.0),
    ],
)  # fmt: skip
def test_the_score_interval_of_two_shares(first, second, low, high):
    found = share_difference(slips(*first), slips(*second))
    assert (found.low, found.high) == pytest.approx((low, high), abs=1e-4)
    assert found.difference == pytest.approx(first[0] / first[1] - second[0] / second[1])
    assert (found.slips, found.trials) == ((first[0], second[0]), (first[1], second[1]))
    turned = share_difference(slips(*second), slips(*first))
    assert turned.difference == pytest.approx(-found.difference)
    assert turned.p == pytest.approx(found.p)
    assert (turned.low, turned.high) == pytest.approx((-found.high, -found.low), abs=1e-9)


def test_the_score_is_that_of_the_likeliest_shares():
    """By a search over the shares under the difference."""
    p = np.linspace(1e-6, 1 - 1e-6, 200_001)
    for a, b, m, n, d in ((30, 28, 40, 35, 0.2), (5, 0, 56, 29, -0.1), (3, 9, 10, 10, 0.3)):
        p = np.linspace(max(0, -d) + 1e-7, min(1, 1 - d) - 1e-7, 400_001)
        likely = a * np.log(p + d) + (m - a) * np.log(1 - p - d)
        likely += b * np.log(p) + (n - b) * np.log(1 - p)
        low = p[likely.argmax()]
        high = low + d
        variance = (high * (1 - high) / m + low * (1 - low) / n) * (m + n) / (m + n - 1)
        expected = (a / m - b / n - d) / np.sqrt(variance)
        assert score(a / m, b / n, m, n, d) == pytest.approx(expected, abs=1e-3)


def test_slips_are_shares_to_a_test_of_equivalence():
    found = equivalence(slips(30, 40), slips(28, 35), 0.2)
    assert max(found.not_lower, found.not_higher) == pytest.approx(0.0594, abs=5e-5)
    none = equivalence(slips(0, 20), slips(0, 20), 0.2)
    assert none.verdict == "equivalent"
    pairs = equivalence(slips(3, 30), slips(2, 30), 0.2, kind="paired")
    assert pairs.low < 1 / 30 < pairs.high
    assert pairs.verdict == "equivalent"
    measured = equivalence([0.1, 0.2, 0.3, 0.2], [0.1, 0.2, 0.25, 0.2], 0.2)
    assert measured.low == pytest.approx(
        t_test([0.1, 0.2, 0.3, 0.2], [0.1, 0.2, 0.25, 0.2], confidence=0.9).low
    )


def test_interval_of_paired_shares_covers():
    rng = np.random.default_rng(3)
    held = 0
    for _ in range(400):
        both = rng.choice(4, size=30, p=[0.2, 0.15, 0.05, 0.6])
        one = share_difference(np.isin(both, (0, 1)), np.isin(both, (0, 2)), paired=True)
        held += one.low <= 0.10 <= one.high
    assert 0.92 < held / 400 < 0.985


def test_persons_who_repeat_count_as_persons():
    who = np.repeat([f"P{i}" for i in range(8)], 5)
    alike = np.repeat([1, 0, 1, 0, 0, 0, 1, 0], 5)
    other = [f"Q{i}" for i in range(40)]
    plain = share_difference(alike, slips(20, 40))
    persons = share_difference(alike, slips(20, 40), who, other)
    assert persons.counted == (pytest.approx(7.0, abs=0.1), 40.0)
    assert persons.high - persons.low > 1.5 * (plain.high - plain.low)


def test_power_of_equivalent_shares_by_all_tables():
    n, total = 12, 0.0
    for a, b in product(range(n + 1), repeat=2):
        if equivalence(slips(a, n), slips(b, n), 0.4).verdict == "equivalent":
            total += stats.binom.pmf(a, n, 0.1) * stats.binom.pmf(b, n, 0.15)
    found = power("slips_equivalent", n, difference=0.4, shares=(0.1, 0.15))
    assert found == pytest.approx(total, abs=1e-9)
    assert persons_needed(
        lambda count: power("slips_equivalent", count, difference=0.2, shares=(0.1, 0.1))
    ) == pytest.approx(44, abs=2)
    with pytest.raises(InputError, match="shares"):
        power("slips_equivalent", 10, shares=(0.1, 0.1))


@pytest.mark.parametrize(
    ("module", "ask"),
    [
        ("statsmodels.stats.multitest", lambda: corrected_p([0.01, 0.2])),
        (
            "statsmodels.discrete.discrete_model",
            lambda: logistic_regression([0, 1, 0, 1, 1], {"x": [1.0, 2.0, 3.0, 4.0, 5.0]}),
        ),
        (
            "statsmodels.regression.linear_model",
            lambda: linear_model([1.0, 2.0, 4.0, 3.0], {"a": list("xxyy")}),
        ),
    ],
)
def test_a_missing_library_is_named_with_its_extra(monkeypatch, module, ask):
    ask()
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(MissingExtraError, match=r"needs the package statsmodels.*\[trials\]"):
        ask()
