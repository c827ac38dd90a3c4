"""Reliability, agreement, effects, power, prediction and curves: published numbers, libraries."""

from itertools import combinations_with_replacement, permutations, product

import numpy as np
import pytest
from scipy import special, stats

from underfoot.core import DataError, InputError
from underfoot.trials.statistics import (
    bland_altman,
    corrected_p,
    detectable_difference,
    effect_size,
    equivalence,
    intraclass_correlation,
    mean_interval,
    paired_curve_test,
    person_bootstrap,
    persons_needed,
    power,
    rank_test,
    roc_area,
    share_interval,
    slip_prediction,
)
from underfoot.trials.statistics.curves import _tail
from underfoot.trials.statistics.ranks import _exact_p
from underfoot.trials.study.tables import mean_and_interval

# Shrout and Fleiss 1979, Table 2: six targets, four judges.
JUDGES = [[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7]]


@pytest.mark.parametrize(
    ("form", "value", "low", "high", "library"),
    [  # their Table 4; intervals as R's psych and irr print them; pingouin 0.7.0, intraclass_corr
        ("ICC(1,1)", 0.17, -0.13, 0.72, 0.165741768), ("ICC(A,1)", 0.29, 0.02, 0.76, 0.289763779),
        ("ICC(C,1)", 0.71, 0.34, 0.95, 0.714840714), ("ICC(1,k)", 0.44, -0.88, 0.91, 0.442797133),
        ("ICC(A,k)", 0.62, 0.07, 0.93, 0.620050547), ("ICC(C,k)", 0.91, 0.68, 0.99, 0.909315542),
    ],
)  # fmt: skip
def test_intraclass_correlation_of_shrout_and_fleiss(form, value, low, high, library):
    icc = intraclass_correlation(JUDGES, form)
    assert [icc.value, icc.low, icc.high] == pytest.approx([value, low, high], abs=0.005)
    assert icc.value == pytest.approx(library, abs=1e-6)


@pytest.mark.parametrize(
    ("form", "ratio", "df"),
    [("ICC(1,1)", 1.7946784922394683, 18), ("ICC(C,1)", 11.027247956403299, 15)],
)
def test_interval_of_the_intraclass_correlation(form, ratio, df):
    """From pingouin's ratios F of the same table, by Shrout and Fleiss's formulas."""
    icc = intraclass_correlation(JUDGES, form)
    ends = ratio / stats.f.ppf(0.975, 5, df), ratio * stats.f.ppf(0.975, df, 5)
    exact = [(one - 1) / (one + 3) for one in ends]
    assert [icc.low, icc.high] == pytest.approx(exact, abs=1e-6)


def test_intraclass_correlation_from_mean_squares_and_uneven_rows():
    # mean squares of the same table: 11.24 between targets, 6.26 within, 1.02 residual
    icc = intraclass_correlation(JUDGES, "ICC(C,1)")
    exact = (11.2416666667 - 1.0194444444) / (11.2416666667 + 3 * 1.0194444444)
    assert icc.value == pytest.approx(exact, abs=1e-6)
    assert icc.error == pytest.approx(np.sqrt(1.0194444444), abs=1e-6)
    assert icc.detectable_change == pytest.approx(1.96 * np.sqrt(2 * 1.0194444444), abs=1e-6)
    uneven = intraclass_correlation([row[: 2 + i % 3] for i, row in enumerate(JUDGES)], "ICC(1,1)")
    assert 2 < uneven.k < 4
    with pytest.raises(DataError, match="different numbers"):
        intraclass_correlation([[1, 2], [3]], "ICC(A,1)")
    with pytest.raises(InputError, match="ICC"):
        intraclass_correlation(JUDGES, "ICC(3,1)")


# Bland and Altman 1986: peak expiratory flow by Wright's and a mini meter, l/min.
WRIGHT = [494, 395, 516, 434, 476, 557, 413, 442, 650, 433, 417, 656, 267, 478, 178, 423, 427]
MINI = [512, 430, 520, 428, 500, 600, 364, 380, 658, 445, 432, 626, 260, 477, 259, 350, 451]


def test_bland_and_altmans_flow_meters():
    found = bland_altman(WRIGHT, MINI)
    assert found.bias == pytest.approx(-2.1, abs=0.05)
    assert found.sd == pytest.approx(38.8, abs=0.05)
    assert found.bias_interval == pytest.approx((-22.0, 17.8), abs=0.06)
    library = stats.ttest_rel(WRIGHT, MINI).confidence_interval()
    assert found.bias_interval == pytest.approx((library.low, library.high), abs=1e-6)
    assert found.sd == pytest.approx(np.std(np.subtract(WRIGHT, MINI), ddof=1), abs=1e-6)
    line = stats.linregress(np.add(WRIGHT, MINI) / 2, np.subtract(WRIGHT, MINI))
    assert [found.slope, found.slope_p] == pytest.approx([line.slope, line.pvalue], abs=1e-6)
    assert found.upper - found.lower == pytest.approx(2 * 1.96 * found.sd)
    wider = found.upper_interval[1] - found.upper, found.upper - found.upper_interval[0]
    assert wider[0] > wider[1] > 0


def test_limits_of_repeated_pairs_hold_95_percent_of_differences():
    rng = np.random.default_rng(4)
    who = np.repeat(np.arange(400), 3)
    truth = 10 + rng.normal(0, 2, 400)[who]
    own = rng.normal(0, 1.0, 400)[who]  # of the second method, with each subject
    first = truth + rng.normal(0, 0.5, 1200)
    second = truth + own + rng.normal(0, 0.5, 1200)
    found = bland_altman(first, second, who)
    assert found.sd == pytest.approx(np.sqrt(1 + 0.25 + 0.25), rel=0.05)
    assert found.within == pytest.approx(np.sqrt(0.5), rel=0.05)


def test_limits_of_repeated_pairs_beside_statsmodels():
    """Bland and Altman 2007: variances of the one-way analysis of the differences."""
    from pandas import DataFrame
    from statsmodels.formula.api import ols
    from statsmodels.stats.anova import anova_lm

    rng = np.random.default_rng(7)
    who = np.repeat(np.arange(10), 4)
    d = 0.3 + rng.normal(0, 1, 10)[who] + rng.normal(0, 0.6, 40)
    squares = anova_lm(ols("d ~ C(who)", DataFrame({"d": d, "who": who})).fit())["mean_sq"]
    between, within = squares["C(who)"], squares["Residual"]
    found = bland_altman(d, np.zeros(40), who)
    assert found.sd == pytest.approx(np.sqrt((between - within) / 4 + within), abs=1e-6)
    assert found.within == pytest.approx(np.sqrt(within), abs=1e-6)
    assert found.upper == pytest.approx(d.mean() + 1.96 * found.sd, abs=1e-6)


def test_interval_of_the_limits_covers():
    rng = np.random.default_rng(5)
    hits = 0
    for _ in range(600):
        who = np.repeat(np.arange(12), 2)
        d = rng.normal(0, 1, 12)[who] + rng.normal(0, 0.7, 24)
        found = bland_altman(d, np.zeros(24), who)
        hits += found.upper_interval[0] < 1.96 * np.sqrt(1.49) < found.upper_interval[1]
    assert hits / 600 == pytest.approx(0.95, abs=0.025)


def test_power_and_numbers_of_persons():
    from statsmodels.stats.power import FTestAnovaPower, TTestIndPower, TTestPower

    for n in (5, 12, 40):
        assert power("paired", n, difference=0.5) == pytest.approx(
            TTestPower().power(0.5, n, 0.05), abs=1e-6
        )
        assert power("groups", n, difference=0.5) == pytest.approx(
            TTestIndPower().power(0.5, n, 0.05), abs=1e-6
        )
    # Cohen 1988 and G*Power: d 0.5, power 0.8: 34 pairs, 64 a group
    assert persons_needed(lambda n: power("paired", n, difference=0.5)) == 34
    assert persons_needed(lambda n: power("groups", n, difference=0.5)) == 64
    # two conditions repeated are the paired test: sd of differences is sqrt(2) of one mean's
    assert power("repeated", 12, difference=0.6, sd=1) == pytest.approx(
        power("paired", 12, difference=0.6, sd=np.sqrt(2)), abs=1e-6
    )
    assert FTestAnovaPower().power(0.25, 128, 0.05, 2) == pytest.approx(
        power("groups", 64, difference=0.5), abs=1e-6
    )
    # pingouin 0.7.0: power_rm_anova(eta_squared=0.1, n=12, m=3, corr=0.5), and n=8, m=4
    for persons, conditions, told in ((12, 3, 0.653224490302586), (8, 4, 0.5117059325898751)):
        spread = np.sqrt(2 * 0.1 / 0.9 * conditions / 0.5)  # f^2, conditions, 1 - correlation
        found = power("repeated", persons, difference=spread, conditions=conditions)
        assert found == pytest.approx(told, abs=1e-6)
    least = detectable_difference("paired", 16, 0.02)
    assert power("paired", 16, difference=least, sd=0.02) == pytest.approx(0.8, abs=1e-5)


def test_power_of_fishers_test_by_all_tables():
    n, total = 8, 0.0
    for a in range(n + 1):
        for b in range(n + 1):
            if stats.fisher_exact([[a, n - a], [b, n - b]]).pvalue <= 0.05:
                total += stats.binom.pmf(a, n, 0.1) * stats.binom.pmf(b, n, 0.7)
    assert power("slips", n, shares=(0.1, 0.7)) == pytest.approx(total, abs=1e-9)
    with pytest.raises(InputError, match="5000"):
        persons_needed(lambda n: power("slips", min(n, 9), shares=(0.1, 0.1)))


def test_p_of_several_tests_of_a_published_study():
    """Benjamini and Hochberg 1995, section 3.2: four of fifteen, three by Bonferroni's rule."""
    p = [0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344, 0.0459, 0.3240, 0.4262,
         0.5719, 0.6528, 0.7590, 1.0000]  # fmt: skip
    assert sum(each <= 0.05 for each in corrected_p(p, "fdr_bh")) == 4
    assert sum(each <= 0.05 for each in corrected_p(p)) == 3
    assert corrected_p(p)[:2] == pytest.approx([15 * 0.0001, 14 * 0.0004])
    # Holm 1979: 4 x 0.005, 3 x 0.01, 2 x 0.03, and 0.04 no less than that
    assert corrected_p([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert corrected_p([]) == []


def test_equivalence_beside_statsmodels():
    from statsmodels.stats.weightstats import ttost_ind, ttost_paired

    rng = np.random.default_rng(1)
    a, b = rng.normal(0, 1, 12), rng.normal(0.1, 1, 12)
    paired = equivalence(a, b, 0.8, kind="paired")
    p, (_, lower, _), (_, higher, _) = ttost_paired(a, b, -0.8, 0.8)
    assert [paired.not_lower, paired.not_higher] == pytest.approx([lower, higher], abs=1e-9)
    assert max(paired.not_lower, paired.not_higher) == pytest.approx(p, abs=1e-9)
    p, (_, lower, _), (_, higher, _) = ttost_ind(a, b, -0.8, 0.8, usevar="unequal")
    welch = equivalence(a, b, 0.8)
    assert [welch.not_lower, welch.not_higher] == pytest.approx([lower, higher], abs=1e-9)
    assert (welch.verdict == "equivalent") == (welch.low > -0.8 and welch.high < 0.8)
    assert equivalence(a + 9, b, 0.8).verdict == "not lower"
    with pytest.raises(InputError, match="margin"):
        equivalence(a, b, 0)


@pytest.mark.slow
def test_effect_size_and_its_interval():
    rng = np.random.default_rng(2)
    a, b = rng.normal(1, 1, 15), rng.normal(0, 1, 11)
    pooled = np.sqrt((14 * a.var(ddof=1) + 10 * b.var(ddof=1)) / 24)
    d = (a.mean() - b.mean()) / pooled
    g = effect_size(a, b)
    assert g.value == pytest.approx(d * (1 - 3 / (4 * 24 - 1)), rel=1e-3)  # Hedges's approximation
    # pingouin 0.7.0: compute_effsize(first, second, eftype="cohen")
    first, second = [5.1, 4.8, 6.2, 5.9, 5.5, 6.6, 5.0], [4.2, 4.9, 5.1, 4.4, 4.8, 5.2]
    g = effect_size(first, second)
    assert g.value == pytest.approx(1.4557843649112105 * g_correction(11), abs=1e-6)
    t = stats.ttest_ind(first, second).statistic
    ends = np.array([g.low, g.high]) / g_correction(11) / np.sqrt(1 / 7 + 1 / 6)
    assert stats.nct.cdf(t, 11, ends) == pytest.approx([0.975, 0.025], abs=1e-6)
    hits = 0
    for _ in range(1000):
        x, y = rng.normal(0.8, 1, 10), rng.normal(0, 1, 10)
        one = effect_size(x, y)
        hits += one.low < 0.8 * g_correction(18) < one.high
    assert hits / 1000 == pytest.approx(0.95, abs=0.02)
    assert np.isfinite(effect_size(a[:3] + 40, a[:3] * 0.99, paired=True).high)


def g_correction(df):
    from scipy.special import gammaln

    return np.exp(gammaln(df / 2) - gammaln((df - 1) / 2)) / np.sqrt(df / 2)


def slips(persons=30, trials=3, strength=1.5, seed=3):
    rng = np.random.default_rng(seed)
    who = np.repeat(np.arange(persons), trials)
    x = rng.normal(0, 1, persons * trials)
    own = rng.normal(0, 0.8, persons)[who]
    y = (rng.random(len(x)) < 1 / (1 + np.exp(0.5 - strength * x - own))).astype(int)
    return y, x, who


def delong(y, x):
    """DeLong's variance by its definition, pair by pair."""
    s, o = x[y == 1], x[y == 0]
    psi = (s[:, None] > o) + 0.5 * (s[:, None] == o)
    return psi.mean(), psi.mean(axis=1).var(ddof=1) / len(s) + psi.mean(axis=0).var(ddof=1) / len(o)


@pytest.mark.slow
def test_roc_area_beside_scikit_learn_and_delong():
    from sklearn.metrics import brier_score_loss, roc_auc_score

    y, x, who = slips()
    x = x.round(1)  # with ties
    alone, together = roc_area(y, x), roc_area(y, x, who)
    area, variance = delong(y, x)
    assert alone.area == pytest.approx(roc_auc_score(y, x), abs=1e-9)
    assert [alone.area, alone.error] == pytest.approx([area, np.sqrt(variance)], abs=1e-9)
    # its interval is even in ln(A / (1 - A))
    reach = stats.norm.ppf(0.975) * np.sqrt(variance) / (area * (1 - area))
    ends = special.expit(special.logit(area) + reach * np.array([-1, 1]))
    assert [alone.low, alone.high] == pytest.approx(ends)
    turned = roc_area(y, -x)
    assert [turned.area, turned.low, turned.high] == pytest.approx(
        [1 - alone.area, 1 - alone.high, 1 - alone.low]
    )
    assert together.area == alone.area
    assert together.error != pytest.approx(alone.error, rel=1e-3)
    told = slip_prediction(y, x, who)
    assert told.brier == pytest.approx(brier_score_loss(y, told.risk), abs=1e-9)
    assert told.brier_low < told.brier < told.brier_high
    assert told.brier < told.constant
    assert told.calibration_slope == pytest.approx(1, abs=0.35)
    nothing = slip_prediction(y, np.random.default_rng(0).normal(size=len(y)), who)
    assert nothing.brier > 0.99 * nothing.constant
    # three of either that are told apart: 1 - 0.025^(1/3) of them might not have been
    apart = roc_area([0, 0, 0, 1, 1, 1], [1, 2, 3, 4, 5, 6])
    assert (apart.area, apart.high) == (1.0, 1.0)
    assert apart.low == pytest.approx(0.025 ** (1 / 3))
    swapped = roc_area([1, 1, 1, 0, 0, 0], [1, 2, 3, 4, 5, 6])
    assert (swapped.area, swapped.low, swapped.high) == (0.0, 0.0, pytest.approx(1 - apart.low))
    with pytest.raises(DataError, match="both"):
        roc_area([1, 1, 1], [1, 2, 3])


def test_bootstrap_of_persons_is_as_wide_as_their_mean_asks():
    rng = np.random.default_rng(6)
    values, who = np.repeat(rng.normal(0, 1, 40), 5), np.repeat(np.arange(40), 5)
    low, high = person_bootstrap(lambda rows: float(values[rows].mean()), who)
    means = values[::5]
    assert high - low == pytest.approx(2 * 1.96 * means.std(ddof=1) / np.sqrt(40), rel=0.12)


P = np.linspace(0, 1, 101)
CURVES = np.array([np.sin(np.pi * P * (1 + 0.1 * i)) for i in range(10)])
FIRST = CURVES + [
    0.2 * np.cos(7 * P + i) + 0.35 * np.exp(-(((P - 0.5) / 0.12) ** 2)) for i in range(10)
]
SECOND = CURVES + [0.2 * np.cos(8 * P + 2.1 * i) for i in range(10)]


def test_curves_beside_spm1d():
    """Numbers of spm1d 0.4.55, ttest_paired(...).inference(0.05, two_tailed=True)."""
    found = paired_curve_test(FIRST, SECOND)
    assert found.threshold == pytest.approx(3.877792659163396, abs=1e-6)
    assert found.fwhm == pytest.approx(22.213989965509963, abs=1e-6)
    assert found.t[50] == pytest.approx(5.222740010261708, abs=1e-6)
    # chance that a field of 101 nodes and fwhm 12 goes beyond 4 (rft1d.t.sf)
    assert _tail(4.0, 9, 100 / 12.0) == pytest.approx(0.0379108727281795, abs=1e-9)
    (one,) = found.clusters
    assert abs(found.t[one.start]) > found.threshold > abs(found.t[one.start - 1])


def test_rank_tests_are_scipys():
    rng = np.random.default_rng(8)
    many = rng.exponential(size=(45, 3))
    three = rank_test(many.ravel(), ["a", "b", "c"] * 45, np.repeat(np.arange(45), 3))
    assert three.p == pytest.approx(stats.friedmanchisquare(*many.T).pvalue)
    values = many[:9]
    two = rank_test(values[:, :2].ravel(), ["a", "b"] * 9, np.repeat(np.arange(9), 2))
    assert two.p == pytest.approx(stats.wilcoxon(values[:, 0], values[:, 1]).pvalue)
    apart = rank_test(values[:, 0], ["a"] * 4 + ["b"] * 5)
    assert apart.p == pytest.approx(stats.mannwhitneyu(values[:4, 0], values[4:, 0]).pvalue)
    with pytest.raises(DataError, match="five or more"):
        rank_test(values[:3, :2].ravel(), ["a", "b"] * 3, np.repeat(np.arange(3), 2))


@pytest.mark.parametrize(
    ("sums", "statistic", "p"),
    [  # Friedman 1937, Table V (three levels) and VI (four), as Siegel 1956, Table N, prints them
        ((5, 11, 8), 4.5, 0.125), ((4, 8, 12), 8.0, 0.0046),
        ((5, 10, 15), 10.0, 0.00077), ((6, 11, 13), 5.2, 0.093), ((6, 10, 14), 6.4, 0.039),
    ],
)  # fmt: skip
def test_friedman_of_published_tables(sums, statistic, p):
    persons = sum(sums) // 6
    rows = next(
        rows
        for rows in combinations_with_replacement(list(permutations((1, 2, 3))), persons)
        if tuple(map(sum, zip(*rows, strict=True))) == sums
    )
    assert _exact_p(np.array(rows, float)) == pytest.approx(p, abs=5e-4)
    assert stats.friedmanchisquare(*zip(*rows, strict=True)).statistic == pytest.approx(statistic)


def test_friedman_with_ties_counts_every_order():
    ranks = np.array([[1, 2.5, 2.5], [1, 2, 3], [1.5, 1.5, 3], [2, 2, 2], [1, 3, 2]])
    spread = (ranks.sum(axis=0) ** 2).sum()
    tables = [np.sum(rows, axis=0) for rows in product(*map(permutations, ranks.tolist()))]
    assert _exact_p(ranks) == np.mean([(sums**2).sum() >= spread for sums in tables])


def test_intervals_stay_where_the_quantity_can_be():
    assert mean_and_interval([12.0, 132.0], "slip_distance")[2:] == (None, None)
    _, _, low, high = mean_and_interval([5.0, 60.0, 200.0], "slip_distance")
    assert low > 0
    assert low * high == pytest.approx((265 / 3) ** 2)
    assert mean_and_interval([-0.1, 0.2, 0.05], "acof_minus_rcof")[2] < 0
    tight = np.array([0.200, 0.202, 0.204, 0.198])
    assert mean_interval(tight, positive=True) == pytest.approx(mean_interval(tight), rel=1e-3)
    assert share_interval([0, 0, 0, 0], [3, 3, 3, 3]) == pytest.approx((0, 1 - 0.025**0.25))
    low, high = share_interval([1, 0, 0, 2, 0], [3, 3, 3, 3, 3])
    assert 0 < low < 0.2 < high < 1


@pytest.mark.parametrize("spread", [0.1, 0.5])
def test_interval_on_the_logarithm_covers(spread):
    rng = np.random.default_rng(9)
    sigma = np.sqrt(np.log(1 + spread**2))
    x = rng.lognormal(-(sigma**2) / 2, sigma, (4000, 8))
    ends = [mean_interval(row, positive=True) for row in x]
    assert np.mean([low < 1 < high for low, high in ends]) == pytest.approx(0.95, abs=0.025)
