"""Every test and model of the trials, on small samples that meet each of its branches.

Of ``underfoot.trials.statistics.variance_components``.
"""

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.trials.statistics.agreement import FORMS, bland_altman, intraclass_correlation
from underfoot.trials.statistics.confounding import names_persons, told_apart
from underfoot.trials.statistics.curves import paired_curve_test
from underfoot.trials.statistics.effects import (
    detectable_difference,
    effect_size,
    equivalence,
    persons_needed,
    power,
)
from underfoot.trials.statistics.fisher import fisher_exact
from underfoot.trials.statistics.linear import (
    LevelPair,
    all_subsets,
    analysis_of_variance,
    crossed_terms,
    least_squares_means,
    letters,
    linear_model,
    predictor,
    tukey_hsd,
)
from underfoot.trials.statistics.logistic import (
    LogisticLine,
    clustered_logistic,
    logistic_regression,
    risk_curve,
    separation,
)
from underfoot.trials.statistics.mixed import (
    independence_warning,
    mixed_model,
    person_means,
    repeated_measures,
)
from underfoot.trials.statistics.prediction import person_bootstrap, roc_area, slip_prediction
from underfoot.trials.statistics.ranks import rank_test
from underfoot.trials.statistics.samples import (
    corrected_p,
    drift,
    mean_interval,
    merge_equal_values,
    ordered_levels,
    precision,
    regression_line,
    share_interval,
    standard_deviation,
    t_test,
)
from underfoot.trials.statistics.shares import is_share, share_difference

RNG = np.random.default_rng(11)
A, B = RNG.normal(0.2, 0.03, 9), RNG.normal(0.23, 0.04, 9)
C = RNG.normal(0.26, 0.04, 7)
PEOPLE = [f"S{i}" for i in range(1, 9)]
SHOES = ("soft", "hard", "worn")
WHO = [who for who in PEOPLE for _ in SHOES for _ in range(2)]
SHOE = [shoe for _ in PEOPLE for shoe in SHOES for _ in range(2)]
FLOOR = [floor for _ in PEOPLE for _ in SHOES for floor in ("wet", "dry")]
LEVEL = {"soft": 0.02, "hard": -0.01, "worn": 0.0}
RCOF = np.array(
    [
        0.2 + LEVEL[shoe] + 0.01 * np.sin(7.0 * i) + 0.02 * np.cos(PEOPLE.index(who))
        for i, (shoe, who) in enumerate(zip(SHOE, WHO, strict=True))
    ]
)
SEX = ["f" if PEOPLE.index(who) % 2 else "m" for who in WHO]
SLIPPED = (RCOF > 0.205).astype(int) ^ (np.arange(48) % 7 == 0)
MARGIN = np.round(RCOF - 0.2 + 0.02 * np.cos(3.0 * np.arange(48)), 4)


def test_samples(file_regression):
    near = [1.0, 1.0 + 1e-13, 1.0 + 1e-10, -2.0]
    held(
        file_regression,
        {
            "levels": [
                ordered_levels(x)
                for x in (
                    ["10 cP", "9 cP", "10 cP"],
                    ["b", "a"],
                    ["S10", "S9x"],
                    ["-1.5", "+1", "0"],
                    [],
                )
            ],
            "equal": merge_equal_values(near).tolist(),
            "none": merge_equal_values([]),
            "table": merge_equal_values([[2.0, 1.0], [1.0, 2.0 + 1e-13]]),
            "sd": [standard_deviation(x) for x in (A, [1.0], [2.0, 2.0 + 1e-13], [2.0, 3.0])],
            "holm": corrected_p([0.01, 0.04, 0.03]),
            "bonferroni": corrected_p([0.01, 0.4], "bonferroni"),
            "none corrected": corrected_p([]),
            "t": {kind: t_test(A, B, kind=kind) for kind in ("welch", "pooled", "paired")},
            "title": [t_test(A, B, kind=kind).title for kind in ("welch", "pooled", "paired")],
            "narrow": t_test(A, C, confidence=0.8),
            "refused": [
                refusal(t_test, A, B, kind="z"),
                refusal(t_test, A, [0.2]),
                refusal(t_test, [0.1, np.nan], B),
                refusal(t_test, A, C, kind="paired"),
                refusal(t_test, [1.0, 1.0], [1.0, 1.0 + 1e-13]),
                refusal(t_test, A, A + 1.0, kind="paired"),
            ],
            "drift": [
                drift(x)
                for x in (
                    1.0 + 0.1 * np.arange(4) + [0, 1e-3, 0, 0],
                    [1.0, 1.1, 1.2],
                    [1.0] * 5,
                    A,
                    -1.0 - 0.02 * np.arange(4),
                    -1.0 - 0.016 * np.arange(4),
                    [-1.0, 1.0, -1.0, 1.0],
                )
            ],
            "drift, loose": drift(A, alpha=1.0, least=0.0),
            "mean": [
                mean_interval(A),
                mean_interval([1.0]),
                mean_interval(A, positive=True),
                mean_interval(-A, positive=True),
                mean_interval([1.0, 2.0], positive=True),
                mean_interval([1.0, 1.0], positive=True),
                mean_interval([1e-9, 1e3], confidence=0.5),
                mean_interval([1e-9, 1e9, 1e-9], positive=True),
            ],
            "share": [
                share_interval(*x)
                for x in (
                    ([1, 2, 0], [4, 4, 5]),
                    ([1], [4]),
                    ([0, 0, 0], [4, 4, 4]),
                    ([4, 4], [4, 4]),
                    ([2, 2, 2], [4, 4, 4]),
                    ([4, 0, 4, 0], [4, 4, 4, 4]),
                )
            ],
            "share, narrow": share_interval([1, 2, 0], [4, 4, 5], confidence=0.5),
            "line": regression_line(A, B),
            "r2": regression_line(A, B).r_squared,
            "no line": [
                refusal(regression_line, *x)
                for x in (
                    ([1, 2], [1, 2]),
                    ([1, 2, 3], [1, 2]),
                    ([1, 1, 1], [1, 2, 3]),
                    ([1, 2, 3], [1, 1, 1]),
                    ([1, 2, np.nan], [1, 2, 3]),
                )
            ],
        },
    )


def test_precision(file_regression):
    close = {"one": [0.2, 0.21], "two": [0.22, 0.23, 0.2], "three": [0.3, 0.31]}
    wild = {f"L{i}": 0.2 + 0.001 * np.sin(np.arange(3) + i) for i in range(6)}
    found = {
        "close": precision(close),
        "far": precision({**wild, "L6": [0.5, 0.51, 0.52]}),
        "low": precision({**wild, "L6": [0.05, 0.051, 0.052]}),
        "scattered": precision({**wild, "L6": [0.1, 0.2, 0.3]}),
        "two": precision({"one": [0.2, 0.21], "two": [0.22]}),
        "all alike": precision({"one": [0.2, 0.2], "two": [0.2, 0.2]}),
        "alike within": precision({"one": [0.2, 0.2], "two": [0.3, 0.3], "three": [0.4]}),
    }
    limits = {key: (x.repeatability_limit, x.reproducibility_limit) for key, x in found.items()}
    verdicts = {key: [one.verdict for one in x.outliers] for key, x in found.items()}
    refused = [
        refusal(precision, x)
        for x in (
            {"one": [0.2, 0.3]},
            {"one": [0.2], "two": [0.3]},
            {"one": [], "two": [0.3, 0.2]},
            {"one": [np.nan], "two": [0.3, 0.2]},
        )
    ]
    held(file_regression, {**found, "limits": limits, "verdicts": verdicts, "refused": refused})


def test_agreement(file_regression):
    rows = np.column_stack((A, B, A + 0.01))
    noise = np.column_stack((A, A[::-1]))
    held(
        file_regression,
        {
            "icc": {form: intraclass_correlation(rows, form) for form in FORMS},
            "of noise": {form: intraclass_correlation(noise, form) for form in FORMS},
            "default": intraclass_correlation(rows),
            "change": intraclass_correlation(rows).detectable_change,
            "uneven": intraclass_correlation([A[:3], B[:2], C[:4]], "ICC(1,1)", confidence=0.8),
            "alike": {
                form: intraclass_correlation(np.column_stack((A, A)), form) for form in FORMS
            },
            "shifted": {
                form: intraclass_correlation(np.column_stack((A, A + 0.1)), form) for form in FORMS
            },
            "refused": [
                refusal(intraclass_correlation, rows, "ICC"),
                refusal(intraclass_correlation, rows[:1]),
                refusal(intraclass_correlation, [[1.0], [2.0]]),
                refusal(intraclass_correlation, [A[:3], B[:2]]),
                refusal(intraclass_correlation, [[1.0, np.nan], [1.0, 2.0]]),
                refusal(intraclass_correlation, [[1.0, 2.0], [1.0, 2.0]]),
            ],
            "pairs": bland_altman(A, B),
            "persons": bland_altman(A, B, list("aabbccdde")),
            "narrow": bland_altman(A, B, confidence=0.5),
            "sloped": bland_altman(A, 2.0 * A + 0.1 * B),
            "of the same mean": bland_altman([1, 2, 3], [3, 2, 1]),
            "no pairs": [
                refusal(bland_altman, A, C),
                refusal(bland_altman, A, B, list("ab")),
                refusal(bland_altman, [1, 2], [1, 3]),
                refusal(bland_altman, A, A + 0.5),
                refusal(bland_altman, [np.nan, *A[1:]], B),
            ],
        },
    )


def test_effects(file_regression):
    shares = ([1, 1, 0, 1, 0, 1, 1, 0], [0, 1, 0, 0, 0, 1, 0, 0])
    held(
        file_regression,
        {
            "size": [
                effect_size(A, B),
                effect_size(A, B, paired=True),
                effect_size(A, C, confidence=0.8),
                refusal(effect_size, [1, 2], [1, 3], paired=True),
            ],
            "equal": {
                kind: {
                    m: (x := equivalence(A, B, m, kind=kind), x.verdict)
                    for m in (0.001, 0.03, 0.06, 0.2)
                }
                for kind in ("welch", "pooled", "paired")
            },
            "below": (x := equivalence(A + 0.05, B, 0.03), x.verdict),
            "above": (x := equivalence(B, A - 0.02, 0.03, alpha=0.1), x.verdict),
            "shares": [
                (x := equivalence(*shares, m, kind=k), x.verdict)
                for m, k in ((0.1, "welch"), (0.95, "paired"), (0.8, "pooled"))
            ],
            "no margin": refusal(equivalence, A, B, 0.0),
            "power": {
                name: [
                    power(name, n, difference=0.03, sd=0.03, conditions=k)
                    for n, k in ((4, 2), (9, 3), (2, 2))
                ]
                for name in ("paired", "groups", "repeated")
            },
            "of slips": [
                power("slips", n, shares=(0.1, 0.7), alpha=a) for n, a in ((6, 0.05), (9, 0.01))
            ],
            "of equal slips": power("slips_equivalent", 12, shares=(0.1, 0.1), difference=0.3),
            "no power": [
                refusal(power, "pared", 9),
                refusal(power, "paired", 1),
                refusal(power, "paired", 9, sd=0.0),
                refusal(power, "paired", 9, alpha=1.0),
                refusal(power, "paired", 9, conditions=1),
                refusal(power, "slips", 9, shares=(0.1, 1.2)),
                refusal(power, "slips_equivalent", 9, shares=(-0.1, 0.2), difference=0.1),
                refusal(power, "slips_equivalent", 9, shares=(0.1, 0.2), difference=1.0),
            ],
            "needed": [
                persons_needed(lambda n, d=d: power("paired", n, difference=d), w)
                for d, w in ((0.5, 0.8), (3.0, 0.9), (0.2, 0.8))
            ],
            "needed by default": persons_needed(lambda n: n / 50),
            "not needed": [
                refusal(persons_needed, lambda n: 0.1),
                refusal(persons_needed, lambda n: 0.1, 1.0),
            ],
            "detectable": [
                detectable_difference("paired", 9, 0.03),
                detectable_difference("groups", 9, 0.03, 0.9),
            ],
        },
    )


def test_shares(file_regression):
    one, two = np.array([1, 1, 0, 1, 0, 1, 1, 0, 1]), np.array([0, 1, 0, 0, 0, 1, 0, 0, 0])
    who = list("aabbccdde")
    told = {
        "plain": share_difference(one, two),
        "paired": share_difference(one, two, paired=True),
        "by persons": share_difference(one, two, who, who),
        "each its own": share_difference(one, two, range(9), range(9)),
        "one person": share_difference(one, two, ["a"] * 9, who),
        "narrow": share_difference(one, two, confidence=0.5),
        "certain": share_difference([1, 1, 1, 1], [0, 0, 0], list("aabb"), list("abc")),
        "certain, paired": share_difference([1, 1, 1], [0, 0, 0], paired=True),
        "the same": share_difference([1, 0, 1], [1, 0, 1], paired=True),
        "never": share_difference([0, 0, 0], [0, 0, 0]),
        "sizes": share_difference(one, two[:4]),
        "persons alike": share_difference([1, 0, 1, 0], [1, 1, 0, 0], list("aabb"), list("aabb")),
    }
    held(
        file_regression,
        {
            **told,
            "shares": {name: x.shares for name, x in told.items()},
            "beyond": {name: [x.beyond(m) for m in (-0.3, 0.0, 0.2)] for name, x in told.items()},
            "is": [is_share([0, 1]), is_share([0, 0.5]), is_share([])],
            "refused": [
                refusal(told["plain"].beyond, 1.0),
                refusal(share_difference, [], one),
                refusal(share_difference, [0.5, 1], one),
                refusal(share_difference, one, two, who[:3]),
                refusal(share_difference, one, two[:4], paired=True),
            ],
        },
    )


def test_fisher(file_regression):
    tables = {
        "two": [[8, 2], [1, 5]],
        "none": [[3, 0], [0, 4]],
        "with an empty row": [[3, 1], [0, 0], [2, 5]],
        "three": [[3, 1, 4], [1, 5, 2], [6, 0, 1]],
        "tall": [[1, 4], [2, 2], [6, 1], [3, 3]],
        "one zero": [[0, 5], [3, 4]],
    }
    held(
        file_regression,
        {
            **{name: fisher_exact(table) for name, table in tables.items()},
            "refused": [
                refusal(fisher_exact, x)
                for x in ([[1.5, 1], [2, 2]], [[-1, 1], [2, 2]], [1, 2], [[1, 2], [0, 0]])
            ],
        },
    )


def test_ranks(file_regression):
    names = lambda *sizes: [n for n, size in zip("abc", sizes, strict=False) for _ in range(size)]  # noqa: E731
    both, three = np.concatenate((A, B)), np.concatenate((A[:5], B[:4], C[:4]))
    who = [*range(9), *range(9)]
    wide = np.concatenate((A, B, A[::-1] + 0.05))
    held(
        file_regression,
        {
            "two groups": rank_test(both, names(9, 9)),
            "two of each": rank_test(both, names(9, 9), who),
            "ties": rank_test([1, 2, 2, 3, 3, 4, 1, 2, 5], names(4, 5)),
            "ties of each": rank_test(
                [1, 2, 2, 3, 4, 6, 2, 2, 4, 3, 3, 8], names(6, 6), [*range(6)] * 2
            ),
            "three groups": rank_test(three, names(5, 4, 4)),
            "three groups, exact": rank_test(np.concatenate((A[:3], B[:3], C[:3])), names(3, 3, 3)),
            "three of each": rank_test(
                np.concatenate((A[:5], B[:5], C[:5])), names(5, 5, 5), [*range(5)] * 3
            ),
            "four of each, exact": rank_test(
                np.concatenate((A[:6], B[:6], C[:6])), names(6, 6, 6), [*range(6)] * 3
            ),
            "many of each": rank_test(wide, names(9, 9, 9), [*range(9)] * 3),
            "large": rank_test(np.sin(np.arange(104.0) ** 2), ["a", "b"] * 52),
            "large, of each": rank_test(
                np.sin(np.arange(204.0) ** 2), ["a", "b"] * 102, [i // 2 for i in range(204)]
            ),
            "one lacks a level": rank_test(both[:-1], names(9, 8), who[:-1]),
            "refused": [
                refusal(rank_test, A, ["a"] * 9),
                refusal(rank_test, [1, 2, 3, 4], list("aabb")),
                refusal(rank_test, [1, 2, 3, 4], list("abab"), list("ccdd")),
                refusal(rank_test, [1.0] * 6, list("aaabbb")),
                refusal(rank_test, [1.0] * 9, list("aaabbbccc")),
                refusal(rank_test, [*range(5), *range(5)], names(5, 5), [*range(5)] * 2),
                refusal(rank_test, [*range(5)] * 3, names(5, 5, 5), [*range(5)] * 3),
            ],
        },
    )


def test_linear(file_regression):
    holed = RCOF.copy()
    holed[3] = np.nan
    both = {"shoe": SHOE, "sex": SEX}
    slope = {"shoe": SHOE, "mass": 60.0 + np.arange(48.0)}
    gap = [(x, y) for x, y in zip(SHOE, SEX, strict=True) if (x, y) != ("worn", "f")]
    rows = [i for i, pair in enumerate(zip(SHOE, SEX, strict=True)) if pair != ("worn", "f")]
    model = linear_model(RCOF, both)
    means = {name: least_squares_means(model, name) for name in both}
    tukey = tukey_hsd(model, "shoe")
    held(
        file_regression,
        {
            "terms": [
                crossed_terms("a", "b", "c"),
                crossed_terms("a", "b", "c", order=2),
                crossed_terms("a", order=3),
            ],
            "model": model,
            "r2": (
                model.r_squared,
                model.adjusted_r_squared,
                model.total_sum,
                model.residual_mean_square,
                model.exact,
                model.dependent,
            ),
            "fitted": model.fitted,
            "means": means,
            "tukey": tukey,
            "narrow": tukey_hsd(model, "sex", confidence=0.5),
            "letters": letters(tukey),
            "strict letters": letters(tukey, alpha=1e-4),
            "chain": letters(
                [
                    LevelPair("a", "b", 1.0, 0.2),
                    LevelPair("b", "c", 1.0, 0.3),
                    LevelPair("a", "c", 2.0, 0.01),
                ]
            ),
            "four": letters(
                [
                    LevelPair(
                        a,
                        b,
                        float(ord(b) - ord(a)),
                        0.01 if (a, b) in (("a", "d"), ("b", "d"), ("a", "c")) else 0.5,
                    )
                    for a, b in ("ab", "ac", "ad", "bc", "bd", "cd")
                ]
            ),
            "anova": [str(analysis_of_variance(holed, both, ss_type=kind)) for kind in (1, 2, 3)],
            "slopes": analysis_of_variance(RCOF, slope, name="RCOF").rows,
            "with slopes": analysis_of_variance(RCOF, slope).warnings,
            "gap": linear_model(
                RCOF[rows], {"shoe": [x for x, _ in gap], "sex": [y for _, y in gap]}, name="RCOF"
            ).warnings,
            "exact": (
                x := linear_model([1.0, 2.0, 3.0, 4.0], {"x": [1.0, 2.0, 3.0, 4.0]})
            ).warnings,
            "is exact": (x.exact, x.dependent),
            "twice": linear_model(RCOF, {"x": MARGIN, "y": 2.0 * MARGIN}, ("x", "y")).warnings,
            "subsets": all_subsets(RCOF, {"x": MARGIN, "shoe": SHOE}),
            "predictors": [
                predictor("x", [1.5, 2.0]),
                predictor("x", [2.0, 1.0], kind="factor"),
                predictor("x", ["10", "9"]),
                predictor("x", [1.0, 2.0, 5.0], rows=np.array([True, False, True])),
                predictor("x", predictor("x", list("aab")), rows=np.array([False, True, True])),
            ],
            "refused": [
                refusal(linear_model, RCOF, {}),
                refusal(linear_model, RCOF, {"x": [1.0]}),
                refusal(linear_model, [1.0, 2.0], {"x": [1.0, 2.0]}),
                refusal(linear_model, [1.0] * 48, both),
                refusal(predictor, "x", ["a", "a"]),
                refusal(predictor, "x", [], kind="factor"),
                refusal(predictor, "x", [1.0, np.nan]),
                refusal(predictor, "x", [1.0, 1.0]),
                refusal(linear_model, RCOF, both, ("shoes",)),
                refusal(linear_model, RCOF, both, ("shoe", "shoe")),
                refusal(analysis_of_variance, RCOF, both, ss_type=4),
                refusal(tukey_hsd, model, "sox"),
                refusal(tukey_hsd, model, "shoe", confidence=1.0),
                refusal(tukey_hsd, linear_model([1.0, 1.0, 2.0, 2.0], {"x": list("aabb")}), "x"),
                refusal(all_subsets, RCOF, {str(i): MARGIN for i in range(11)}),
            ],
        },
    )


def test_mixed(file_regression):
    mixed = mixed_model(RCOF, {"shoe": SHOE, "sex": SEX}, WHO)
    one = mixed_model(RCOF, {"shoe": SHOE}, WHO, name="RCOF")
    contrast = np.array([0.0, 1.0, 0.0])
    held(
        file_regression,
        {
            "warning": [independence_warning(x) for x in (["a", "b"], ["a", "a"], ["a", "a", "b"])],
            "means": person_means([0.1, 0.2, np.nan, 0.4], {"shoe": list("aabb")}, list("xxxy")),
            "mixed": mixed,
            "tests": mixed.tests,
            "of one": one.tests,
            "df": one.df(contrast),
            "one": (one.response_name, one.variances, one.within, one.persons, one.trials),
            "covariance": np.round(1e6 * one.covariance, 6) + 0.0,
            "least squares": least_squares_means(one, "shoe"),
            "tukey": tukey_hsd(one, "shoe"),
            "two within": mixed_model(
                RCOF, {"shoe": SHOE, "floor": FLOOR}, WHO, ("shoe", "floor")
            ).tests,
            "repeated": repeated_measures(RCOF, {"shoe": SHOE}, WHO),
            "of two": repeated_measures(RCOF, {"shoe": SHOE, "floor": FLOOR}, WHO),
            "refused": [
                refusal(person_means, [0.1], {"shoe": ["a", "b"]}, ["x"]),
                refusal(person_means, [np.nan], {"shoe": ["a"]}, ["x"]),
                refusal(mixed_model, RCOF[:6], {"shoe": SHOE[:6]}, WHO[:6]),
                refusal(mixed_model, RCOF[:12], {"shoe": SHOE[:12], "sex": SEX[:12]}, WHO[:12]),
                refusal(mixed_model, RCOF, {"shoe": SHOE, "same": SHOE}, WHO, ("shoe", "same")),
                refusal(repeated_measures, RCOF[:-2], {"shoe": SHOE[:-2]}, WHO[:-2]),
                refusal(repeated_measures, RCOF[:6], {"shoe": SHOE[:6]}, WHO[:6]),
                refusal(
                    repeated_measures,
                    np.tile([1.0, 2.0, 3.0], 8),
                    {"shoe": SHOES * 8},
                    [who for who in PEOPLE for _ in SHOES],
                ),
            ],
        },
    )


def test_confounding(file_regression):
    def said(factors, *args, **options):
        kept, left = told_apart(factors, *args, **options)
        return {"kept": list(kept), "left": left, "text": list(map(str, left))}

    held(
        file_regression,
        {
            "apart": said({"shoe": SHOE, "sex": SEX}, WHO),
            "the same": said({"shoe": SHOE, "colour": [x[0] for x in SHOE]}, WHO),
            "inside": said({"shoe": SHOE, "hard": [str(x == "hard") for x in SHOE]}, WHO),
            "last": said({"Order": SHOE, "colour": [x[0] for x in SHOE]}, WHO, last=("order",)),
            "of three": said({"a": list("xxyyz"), "b": list("pqpqr"), "c": list("mnnmo")}),
            "persons": said({"group": WHO}, WHO),
            "without persons": said({"group": list("aabb")}),
            "names": [
                names_persons(list("aabb"), list("ccdd")),
                names_persons(list("aaaa"), list("ccdd")),
                names_persons(list("abab"), list("ccdd")),
                names_persons(["a"], ["a"]),
            ],
        },
    )


def test_curves(file_regression):
    at = np.linspace(0.0, 1.0, 41)
    noise = np.array([np.sin(9.0 * at * (1 + 0.1 * i) + i) for i in range(7)])
    bump = np.exp(-(((at - 0.6) / 0.1) ** 2))
    flat = noise.copy()
    flat[:, :4] = 0.3
    dip = noise * 0.2 + bump - 1.2 * np.exp(-(((at - 0.2) / 0.08) ** 2))
    held(
        file_regression,
        {
            "bump": paired_curve_test(2.0 * bump + 0.5 * noise, 0 * noise),
            "both ways": paired_curve_test(dip, 0.1 * noise[::-1]),
            "to the end": paired_curve_test(0.2 * noise + at, 0 * noise, alpha=0.01),
            "nothing": paired_curve_test(noise, 0.5 * noise[::-1]),
            "still": paired_curve_test(flat, 0 * flat + 0.3),
            "refused": [
                refusal(paired_curve_test, *x)
                for x in (
                    (noise[:3], noise[:3]),
                    (noise, noise[:5]),
                    (noise[:, :2], noise[:, :2]),
                    (at, at),
                    (noise, noise),
                    (noise * np.nan, noise),
                )
            ],
        },
    )


def test_logistic(file_regression):
    fit = logistic_regression(SLIPPED, {"margin": MARGIN})
    two = logistic_regression(SLIPPED, {"margin": MARGIN, "order": np.arange(48.0)}, confidence=0.8)
    firth = logistic_regression(SLIPPED, {"margin": MARGIN}, method="firth")
    apart = logistic_regression([0, 0, 0, 1, 1], {"x": [1, 2, 3, 4, 5]}, method="firth")
    touching = logistic_regression([0, 0, 1, 0, 1, 1], {"x": [1, 2, 3, 3, 4, 5]}, method="firth")
    ways = {"x": MARGIN}
    clustered = clustered_logistic(SLIPPED, ways, WHO)
    many = clustered_logistic(SLIPPED, ways, range(48), confidence=0.9)
    line = LogisticLine(2.952, -49.2, "the report")
    held(
        file_regression,
        {
            "fit": fit,
            "deviance": fit.deviance,
            "probability": fit.probability(margin=np.array([0, 0.02])),
            "two": two,
            "firth": firth,
            "apart": apart,
            "touching": touching,
            "clustered": clustered,
            "slope": clustered["x"],
            "estimates": clustered.estimates,
            "each its own": many,
            "separation": [
                separation(np.column_stack((np.ones(4), x)), np.array([0, 0, 1, 1]))
                for x in ([1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 2.0, 4.0], [1.0, 4.0, 2.0, 3.0])
            ],
            "separated": [
                separation(np.ones((4, 1)), np.ones(4)).separated,
                separation(np.ones((4, 1)), np.arange(4) % 2).separated,
            ],
            "line": line,
            "on it": line.probability(np.array([0.0, 0.06, 0.1])),
            "at": [line.at_probability(0.5), line.at_probability(0.1)],
            "risk": risk_curve(fit),
            "risk at": risk_curve(fit, np.array([0.0, 0.01]), confidence=0.5),
            "of clusters": risk_curve(clustered, np.array([0.0, 0.01])),
            "refused": [
                refusal(risk_curve, two),
                refusal(risk_curve, fit, confidence=1.0),
                refusal(line.at_probability, 0.0),
                refusal(logistic_regression, SLIPPED, ways, method="ml"),
                refusal(logistic_regression, [0, 0, 0, 1, 1], {"x": [1, 2, 3, 4, 5]}),
                refusal(logistic_regression, [0, 2, 1], {"x": [1, 2, 3]}),
                refusal(logistic_regression, [0, 0, 0], {"x": [1, 2, 3]}),
                refusal(logistic_regression, [0, 1, 0], {"x": [1, 2]}),
                refusal(logistic_regression, [0, 1, 0], {"x": [1, 2, np.nan]}),
                refusal(logistic_regression, [0, 1, 0], {"x": [1, 1, 1]}),
                refusal(clustered_logistic, SLIPPED, ways, WHO[:3]),
                refusal(clustered_logistic, SLIPPED, ways, ["a", "b", "c"] * 16),
            ],
        },
    )


def test_prediction(file_regression):
    mean = lambda rows: float(MARGIN[rows].mean())  # noqa: E731
    few = ([1, 0, 1, 0], [4.0, 1.0, 3.0, 2.0])
    held(
        file_regression,
        {
            "area": roc_area(SLIPPED, MARGIN, WHO),
            "each its own": roc_area(SLIPPED, MARGIN),
            "narrow": roc_area(SLIPPED, MARGIN, WHO, confidence=0.5),
            "perfect": roc_area(*few),
            "worst": roc_area(few[0], -np.array(few[1])),
            "ties": roc_area([1, 0, 1, 0, 1], [2, 2, 1, 1, 3]),
            "prediction": slip_prediction(SLIPPED[:24], MARGIN[:24], WHO[:24]),
            "bootstrap": [
                person_bootstrap(mean, WHO, draws=200),
                person_bootstrap(mean, WHO, draws=100, seed=3, confidence=0.5),
            ],
            "of the same": person_bootstrap(lambda rows: 1.0, WHO, draws=20),
            "refused": [
                refusal(roc_area, SLIPPED, MARGIN, WHO[:3]),
                refusal(roc_area, [0, 0, 0], [1, 2, 3]),
                refusal(roc_area, [0, 2, 1], [1, 2, 3]),
                refusal(roc_area, [0, 1, 1], [1, np.nan, 2]),
                refusal(roc_area, [0, 1, 1], [1, 2, 3], list("aab")),
                refusal(roc_area, [0, 1, 0], [1, 2, 3]),
                refusal(person_bootstrap, mean, ["a", "b"]),
                refusal(person_bootstrap, lambda rows: np.nan, WHO, draws=20),
            ],
        },
    )


@pytest.mark.parametrize("level", [0.0, 5.0])
def test_shift_of_both_samples_changes_no_test(level):
    moved = t_test(A + level, B + level)
    assert moved.p == pytest.approx(t_test(A, B).p)
    assert rank_test(np.concatenate((A, B)) + level, ["a"] * 9 + ["b"] * 9).p == pytest.approx(
        rank_test(np.concatenate((A, B)), ["a"] * 9 + ["b"] * 9).p
    )
