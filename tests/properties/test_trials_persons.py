"""Persons as units: mixed models and repeated measures against their special cases."""

import numpy as np
import pytest

from underfoot.core import DataError
from underfoot.trials.statistics import (
    analysis_of_variance,
    fisher_exact,
    independence_warning,
    least_squares_means,
    linear_model,
    mixed_model,
    person_means,
    precision,
    repeated_measures,
    t_test,
    tukey_hsd,
)
from underfoot.trials.statistics import fisher as fisher_module

SHOES = ("A", "B", "C")


def study(
    seed, effects=(0.20, 0.22, 0.25), persons=12, trials=4, between=0.02, own=0.008, step=0.01
):
    rng = np.random.default_rng(seed)
    y, shoe, who = [], [], []
    for person in range(persons):
        level = rng.normal(0.0, between)
        for name, effect in zip(SHOES, effects, strict=False):
            mean = effect + level + rng.normal(0.0, own)
            y += list(mean + rng.normal(0.0, step, trials))
            shoe += [name] * trials
            who += [f"S{person:02d}"] * trials
    return np.array(y), shoe, who


def test_mixed_model_of_complete_data_is_repeated_measures():
    y, shoe, who = study(1)
    mixed, repeated = mixed_model(y, {"shoe": shoe}, who), repeated_measures(y, {"shoe": shoe}, who)
    (test,), (row,) = mixed.tests, repeated.rows
    assert (test.df, test.error_df) == (row.df, row.error_df) == (2, 22)
    assert test.f == pytest.approx(row.f, rel=1e-6)
    (epsilon,), (corrected,) = repeated.epsilon, repeated.p_corrected
    assert 0.5 <= epsilon <= 1.0
    assert corrected > row.p
    # The plain analysis of variance gives another F: trials are not persons.
    plain = analysis_of_variance(y, {"shoe": shoe})["shoe"]
    assert plain.error_df == 141
    assert abs(plain.f - row.f) > 1.0


def test_two_conditions_are_the_paired_t_test():
    y, shoe, who = study(2, effects=(0.20, 0.22))
    means = person_means(y, {"shoe": shoe}, who)
    a, b = (means.mean[[level == name for level in means.factors["shoe"]]] for name in "AB")
    paired = t_test(a, b, kind="paired")
    mixed = mixed_model(y, {"shoe": shoe}, who)
    (found,) = tukey_hsd(mixed, "shoe")
    assert found.t == pytest.approx(paired.t, rel=1e-6)
    assert found.p == pytest.approx(paired.p, rel=1e-3)
    assert (found.low, found.high) == pytest.approx((paired.low, paired.high), rel=1e-4)


def test_factors_between_persons_are_tests_of_person_means():
    rng = np.random.default_rng(5)
    who = np.repeat([f"P{i}" for i in range(9)], 5)
    group = np.repeat(["x", "y", "z"], 15)
    y = np.repeat(rng.normal(0, 1, 9), 5) + rng.normal(0, 0.3, 45)
    mixed = mixed_model(y, {"group": list(group)}, list(who))
    means = y.reshape(9, 5).mean(axis=1)
    plain = analysis_of_variance(means, {"group": ["x"] * 3 + ["y"] * 3 + ["z"] * 3})["group"]
    (test,) = mixed.tests
    assert (test.f, test.p, test.error_df) == pytest.approx((plain.f, plain.p, 6))


def test_split_plot_has_two_errors():
    y, shoe, who = study(3)
    sex = ["m" if int(person[1:]) % 2 else "f" for person in who]
    mixed = mixed_model(y, {"shoe": shoe, "sex": sex}, who)
    degrees = {row.term: (row.df, row.error_df) for row in mixed.tests}
    assert degrees == {"shoe": (2, 20), "sex": (1, 10), "shoe:sex": (2, 20)}
    # Between persons: the t test of the persons' means.
    means = person_means(y, {"sex": sex}, who)
    men, women = (means.mean[[s == x for s in means.factors["sex"]]] for x in "mf")
    t = t_test(men, women, kind="pooled")
    row = next(row for row in mixed.tests if row.term == "sex")
    assert row.f == pytest.approx(t.t**2, rel=1e-5)


def test_missing_conditions_are_borne():
    y, shoe, who = study(4)
    rows = [i for i in range(len(y)) if not (who[i] == "S03" and shoe[i] == "B")]
    y, shoe, who = y[rows], [shoe[i] for i in rows], [who[i] for i in rows]
    mixed = mixed_model(y, {"shoe": shoe}, who)
    assert mixed.persons == 12
    assert 20 < mixed.tests[0].error_df < 22
    means = {m.level: m for m in least_squares_means(mixed, "shoe")}
    assert means["B"].n == 11
    assert means["B"].standard_error > means["A"].standard_error
    with pytest.raises(DataError, match="every condition"):
        repeated_measures(y, {"shoe": shoe}, who)


@pytest.mark.slow
def test_intervals_of_differences_hold_the_truth():
    held = 0
    for seed in range(200):
        y, shoe, who = study(seed)
        held += all(
            c.low <= d <= c.high
            for c, d in zip(
                tukey_hsd(mixed_model(y, {"shoe": shoe}, who), "shoe"),
                (-0.02, -0.05, -0.03),
                strict=True,
            )
        )
    # Nominal 95 %: three standard errors of 200 draws.
    assert 0.90 <= held / 200 <= 0.995


def test_trials_taken_as_persons_are_warned_of():
    assert independence_warning(["a", "b", "c"]) == ()
    (text,) = independence_warning(["a", "a", "b"])
    assert "3 trials of 2 persons" in text


def test_refusals_name_the_trouble():
    y, shoe, who = study(1, persons=2)
    with pytest.raises(DataError, match="nothing to estimate"):
        mixed_model(y, {"shoe": shoe, "sex": ["m" if w == "S00" else "f" for w in who]}, who)
    with pytest.raises(DataError, match="differ in length"):
        mixed_model(y, {"shoe": shoe[:-1]}, who)


def test_an_exact_fit_says_so():
    table = analysis_of_variance([1.0, 1.0, 2.0, 2.0], {"g": ["a", "a", "b", "b"]})
    assert any("exactly" in text for text in table.warnings)
    assert table["g"].p is None
    with pytest.raises(DataError, match="exactly"):
        tukey_hsd(linear_model([1.0, 1.0, 2.0, 2.0], {"g": ["a", "a", "b", "b"]}), "g")


def test_fisher_of_a_long_table_is_quick_and_exact():
    # 29 persons with two trials each: minutes by plain enumeration.
    slips = np.random.default_rng(8).integers(0, 3, 29)
    found = fisher_exact(np.column_stack((slips, 2 - slips)))
    assert found.p_error is None


def test_fisher_by_monte_carlo_agrees_with_exact(monkeypatch):
    table = [[7, 10], [7, 11], [1, 16]]
    exact = fisher_exact(table)
    monkeypatch.setattr(fisher_module, "_EFFORT", 10)
    drawn = fisher_exact(table)
    assert exact.p_error is None
    assert drawn.p_error == pytest.approx(np.sqrt(drawn.p * (1 - drawn.p) / 1e5), rel=1e-6)
    assert abs(drawn.p - exact.p) < 4 * drawn.p_error
    assert fisher_exact(table) == drawn


def test_precision_of_the_example_of_astm_e691():
    # Glucose in serum, material A (from memory; printed: mean 41.5183, s_r 1.0632, s_R 1.0632).
    readings = {
        "1": [41.03, 41.45, 41.37],
        "2": [41.17, 42.00, 41.15],
        "3": [41.01, 40.68, 42.66],
        "4": [39.37, 42.37, 42.63],
        "5": [41.88, 41.19, 41.32],
        "6": [43.28, 40.50, 42.28],
        "7": [41.08, 41.27, 39.02],
        "8": [43.36, 42.65, 41.72],
    }
    found = precision(readings)
    assert found.mean == pytest.approx(41.5183, abs=5e-5)
    assert (found.repeatability, found.reproducibility) == pytest.approx((1.0632, 1.0632), abs=5e-5)
    cochran, largest, _ = found.outliers
    # Printed tables of ISO 5725-2 for p = 8, n = 3.
    assert (cochran.critical_5_percent, cochran.critical_1_percent) == pytest.approx(
        (0.516, 0.615), abs=5e-4
    )
    assert (largest.critical_5_percent, largest.critical_1_percent) == pytest.approx(
        (2.126, 2.274), abs=1e-3
    )
    assert {t.verdict for t in found.outliers} == {"correct"}
    readings["4"] = [60.0, 60.5, 60.2]
    verdicts = {t.name: (t.laboratory, t.verdict) for t in precision(readings).outliers}
    assert verdicts["Grubbs, largest mean"] == ("4", "outlier")


def test_precision_finds_the_spread_between_laboratories():
    rng = np.random.default_rng(0)
    readings = {str(i): rng.normal(0, 0.3) + rng.normal(0, 0.1, 5) for i in range(400)}
    found = precision(readings)
    assert found.repeatability == pytest.approx(0.1, rel=0.05)
    assert found.between == pytest.approx(0.3, rel=0.1)
