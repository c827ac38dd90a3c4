"""Every test and model of the trials on random samples, beside exact counts where there are any.

Of ``underfoot.trials.statistics.variance_components``.
"""

from itertools import combinations, permutations, product

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from scipy.stats import rankdata

from snapshot import held, tried
from underfoot.trials.statistics.agreement import FORMS, bland_altman, intraclass_correlation
from underfoot.trials.statistics.curves import paired_curve_test
from underfoot.trials.statistics.effects import effect_size, equivalence, power
from underfoot.trials.statistics.fisher import fisher_exact
from underfoot.trials.statistics.linear import (
    all_subsets,
    analysis_of_variance,
    least_squares_means,
    letters,
    linear_model,
    tukey_hsd,
)
from underfoot.trials.statistics.logistic import (
    clustered_logistic,
    logistic_regression,
    risk_curve,
)
from underfoot.trials.statistics.mixed import mixed_model, repeated_measures
from underfoot.trials.statistics.prediction import person_bootstrap, roc_area, slip_prediction
from underfoot.trials.statistics.ranks import rank_test
from underfoot.trials.statistics.samples import (
    corrected_p,
    drift,
    mean_interval,
    precision,
    regression_line,
    share_interval,
    t_test,
)
from underfoot.trials.statistics.shares import paired_score, score, share_difference

# by exact counts


@pytest.mark.parametrize("seed", range(3))
def test_scores_of_shares_are_those_of_the_likeliest_shares(seed):
    """Tango's and Miettinen's: the nuisance share maximises the likelihood on a fine search."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(8, 30))
    first, second = (int(v) for v in rng.integers(1, n // 3, 2))
    for d in (-0.4, -0.1, 0.05, 0.3):

        def lost(q, d=d, n=n, first=first, second=second):
            """Of pairs: q slip in the second alone, q + d in the first alone."""
            shares = np.array([q + d, q, 1 - 2 * q - d])
            counts = np.array([first, second, n - first - second])
            return -float(counts @ np.log(np.maximum(shares, 1e-300)))

        ends = max(0.0, -d) + 1e-9, (1 - d) / 2 - 1e-9
        q = minimize_scalar(lost, bounds=ends, method="bounded", options={"xatol": 1e-12}).x
        variance = n * (2 * q + d - d * d)
        expected = (first - second - n * d) / variance**0.5
        assert paired_score(first, second, n, d) == pytest.approx(expected, rel=1e-5)
        m = n + 5
        a, b = (first + 2) / m, second / n

        def lost_groups(low, d=d, m=m, n=n, a=a, b=b):
            high = low + d
            logs = np.log(np.maximum([high, 1 - high, low, 1 - low], 1e-300))
            return -float(np.array([m * a, m * (1 - a), n * b, n * (1 - b)]) @ logs)

        ends = max(0.0, -d) + 1e-9, min(1.0, 1.0 - d) - 1e-9
        low = minimize_scalar(lost_groups, bounds=ends, method="bounded",
                              options={"xatol": 1e-12}).x  # fmt: skip
        high = low + d
        variance = (high * (1 - high) / m + low * (1 - low) / n) * (m + n) / (m + n - 1)
        found = float(score(a, b, float(m), float(n), d))
        assert found == pytest.approx((a - b - d) / variance**0.5, rel=1e-4)


@pytest.mark.parametrize("seed", range(4))
def test_rank_tests_count_all_orders(seed):
    rng = np.random.default_rng(seed)
    ties = seed % 2 == 0

    def sample(count):
        values = rng.normal(size=count)
        return np.round(2 * values) / 2 if ties else values

    a, b = sample(5), sample(4) + 0.7
    ranks = rankdata([*a, *b])
    sums = np.array([ranks[list(one)].sum() for one in combinations(range(9), 5)])
    far = np.abs(sums - 5 * ranks.mean()) >= abs(ranks[:5].sum() - 5 * ranks.mean()) - 1e-9
    found = rank_test([*a, *b], ["a"] * 5 + ["b"] * 4)
    assert found.p == pytest.approx(far.mean())
    pairs = np.array([sample(6), sample(6) + 0.6])
    differ = (pairs[0] - pairs[1])[pairs[0] != pairs[1]]
    ranks = rankdata(np.round(np.abs(differ), 12))
    sums = np.array([ranks @ signs for signs in product((0, 1), repeat=len(ranks))])
    up = ranks[differ > 0].sum()
    middle = ranks.sum() / 2
    found = rank_test(pairs.ravel(), ["a"] * 6 + ["b"] * 6, [*range(6)] * 2)
    assert found.p == pytest.approx((np.abs(sums - middle) >= abs(up - middle) - 1e-9).mean())
    three = np.array([sample(5), sample(5) + 0.8, sample(5) - 0.5]).T
    ranks = rankdata(three, axis=1)
    sums = np.zeros((1, 3))
    for row in ranks.tolist():
        orders = np.array([*permutations(row)])
        sums = (sums[:, None] + orders).reshape(-1, 3)
    spread = (sums**2).sum(axis=1)
    own = (ranks.sum(axis=0) ** 2).sum()
    found = rank_test(three.T.ravel(), ["a"] * 5 + ["b"] * 5 + ["c"] * 5, [*range(5)] * 3)
    assert found.p == pytest.approx((spread >= own - 1e-9).mean())
    groups = [sample(3), sample(4) + 1.0, sample(3)]
    ranks = rankdata(np.concatenate(groups))
    sums = []
    for first in combinations(range(10), 3):
        rest = [k for k in range(10) if k not in first]
        for second in combinations(rest, 4):
            third = [k for k in rest if k not in second]
            parts = (ranks[list(each)] for each in (first, second, third))
            sums.append(sum(part.sum() ** 2 / len(part) for part in parts))
    own = sum(part.sum() ** 2 / len(part) for part in np.split(ranks, [3, 7]))
    found = rank_test(np.concatenate(groups), list("aaabbbbccc"))
    assert found.p == pytest.approx((np.array(sums) >= own * (1 - 1e-12)).mean())


# as they were


@pytest.mark.parametrize("seed", range(3))
def test_samples(file_regression, seed):
    rng = np.random.default_rng(100 + seed)
    count = 6 + 3 * seed
    a, b, c = (0.2 + 0.04 * rng.normal(size=count) + at for at in (0.0, 0.03, -0.01))
    slips, others = rng.random(count) < 0.6, rng.random(count) < 0.3
    who = [f"p{k}" for k in rng.integers(0, 4, count)]
    table = rng.integers(0, 6, (2 + seed % 2, 3)) + 1
    walks = np.cumsum(rng.normal(size=(2, 6, 25)), axis=2)
    held(file_regression, {
        "t": [t_test(a, b, kind=kind, confidence=0.9) for kind in ("welch", "pooled", "paired")],
        "effect": effect_size(a, b), "of pairs": effect_size(a, b, paired=True),
        "equal": [equivalence(a, b[:-1], 0.04), equivalence(a, b, 0.04, kind="paired")],
        "power": [power(kind, count, difference=0.02, sd=0.03, conditions=3)
                  for kind in ("paired", "groups", "repeated")],
        "shares": [tried(share_difference, slips, others, *more, paired=way)
                   for more in ((), (who, who)) for way in (False, True)],
        "share": share_interval(rng.integers(0, 4, 5), np.full(5, 4)),
        "mean": [mean_interval(a), mean_interval(a, positive=True, confidence=0.8)],
        "line": regression_line(a, b + 0.5 * a), "drift": drift(a + 0.02 * np.arange(count)),
        "corrected": [corrected_p((rng.random(5) / 10).tolist(), how)
                      for how in ("holm", "bonferroni")],
        "precision": precision({name: 0.2 + 0.1 * rng.normal() + 0.02 * rng.normal(size=n)
                                for name, n in zip("uvwxy", (3, 2, 4, 3, 2), strict=True)}),
        "agreement": {form: intraclass_correlation(np.column_stack((a, b + a, c + a)), form)
                      for form in FORMS},
        "bland": [bland_altman(a, b), tried(bland_altman, a, b, who)],
        "fisher": fisher_exact(table), "curves": paired_curve_test(*walks),
        "friedman": rank_test([*a, *b, *c], ["a"] * count + ["b"] * count + ["c"] * count,
                              [*range(count)] * 3),
    })  # fmt: skip


@pytest.mark.parametrize("seed", range(2))
def test_models(file_regression, seed):
    rng = np.random.default_rng(200 + seed)
    people, shoes = [f"p{k}" for k in range(5 + seed)], ("a", "b", "c")[: 2 + seed]
    rows = [(p, s, f) for p in people for s in shoes for f in ("x", "y") for _ in range(2)]
    keep = rng.random(len(rows)) > 0.12 * seed
    rows = [row for row, good in zip(rows, keep, strict=True) if good]
    who, shoe, floor = (list(column) for column in zip(*rows, strict=True))
    offset = dict(zip(people, (0.05 * rng.normal(size=len(people))).tolist(), strict=True))
    y = np.array([0.2 + offset[p] + 0.03 * (s == "b") - 0.02 * (f == "y") for p, s, f in rows])
    y += 0.02 * rng.normal(size=len(rows))
    mass = 60 + 10 * rng.normal(size=len(rows))
    margin = y - 0.2 + 0.01 * rng.normal(size=len(rows))
    slipped = (margin + 0.04 * rng.normal(size=len(rows)) < 0).astype(int)
    both, more = {"shoe": shoe, "floor": floor}, {"shoe": shoe, "floor": floor, "mass": mass}
    model, mixed = linear_model(y, more), mixed_model(y, both, who)
    tukey = tukey_hsd(model, "shoe", confidence=0.9)
    fit = logistic_regression(slipped, {"margin": margin})
    grouped = clustered_logistic(slipped, {"margin": margin}, who)
    held(file_regression, {
        "model": model, "r2": (model.r_squared, model.adjusted_r_squared, model.fitted),
        "means": [least_squares_means(each, "shoe") for each in (model, mixed)],
        "tukey": tukey, "letters": letters(tukey, alpha=0.2), "mixed": mixed,
        "of floors": tukey_hsd(mixed, "floor"), "tests": mixed.tests,
        "anova": [analysis_of_variance(y, more, ss_type=kind).rows for kind in (1, 2, 3)],
        "crossed": analysis_of_variance(y, both, ("shoe", "floor", "shoe:floor")).rows
        if seed == 0 else tried(analysis_of_variance, y, both, ("shoe", "shoe:floor")),
        "subsets": all_subsets(y, more), "repeated": tried(repeated_measures, y, both, who),
        "fit": fit, "firth": logistic_regression(slipped, {"m": margin, "w": mass}, method="firth",
                                                 confidence=0.9),
        "grouped": grouped, "risk": risk_curve(fit, np.array([-0.02, 0.0, 0.03])),
        "of groups": risk_curve(grouped, np.array([-0.02, 0.0, 0.03]), confidence=0.8),
        "area": roc_area(slipped, -margin, who), "alone": roc_area(slipped, -margin),
        "prediction": tried(slip_prediction, slipped, margin, who),
        "bootstrap": person_bootstrap(lambda at: float(y[at].mean() ** 2), who, draws=300),
    })  # fmt: skip
