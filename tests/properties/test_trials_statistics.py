"""What must hold for any data: symmetries, special cases with known answers, refusals."""

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from underfoot.core import DataError, InputError
from underfoot.trials.machines.stribeck_fit import stribeck_fit
from underfoot.trials.statistics import (
    analysis_of_variance,
    crossed_terms,
    fisher_exact,
    letters,
    linear_model,
    logistic_regression,
    separation,
    t_test,
    tukey_hsd,
)

_SEEDS = st.integers(0, 2**31)


@settings(max_examples=40, deadline=None)
@given(st.lists(st.lists(st.integers(0, 6), min_size=3, max_size=3), min_size=2, max_size=4))
def test_fisher_ignores_order_and_is_a_probability(rows):
    table = np.array(rows)
    assume((table.sum(axis=0) > 0).sum() > 1)
    assume((table.sum(axis=1) > 0).sum() > 1)
    p = fisher_exact(table).p
    assert 0 < p <= 1
    assert fisher_exact(table.T).p == pytest.approx(p, rel=1e-9)
    assert fisher_exact(table[::-1, ::-1]).p == pytest.approx(p, rel=1e-9)


@settings(max_examples=30, deadline=None)
@given(st.lists(st.integers(0, 20), min_size=4, max_size=4))
def test_fisher_two_by_two_equals_scipy(cells):
    from scipy import stats

    table = np.array(cells).reshape(2, 2)
    assume((table.sum(axis=0) > 0).all())
    assume((table.sum(axis=1) > 0).all())
    expected = stats.fisher_exact(table)
    assert fisher_exact(table).p == pytest.approx(float(expected.pvalue), rel=1e-6)


@settings(max_examples=15, deadline=None)
@given(_SEEDS)
def test_types_agree_when_balanced_and_sums_add_up(seed):
    rng = np.random.default_rng(seed)
    a, b = np.repeat(["x", "y", "z"], 8), np.tile(np.repeat(["p", "q"], 4), 3)
    y = rng.normal(size=24)
    tables = [analysis_of_variance(y, {"a": a, "b": b}, ss_type=kind) for kind in (1, 2, 3)]
    for term in ("a", "b", "a:b", "residual"):
        sums = [table[term].sum_of_squares for table in tables]
        assert sums == pytest.approx([sums[0]] * 3, rel=1e-8, abs=1e-12)
    total = sum(row.sum_of_squares for row in tables[0].rows)
    assert total == pytest.approx(tables[0].model.total_sum, rel=1e-9)


@settings(max_examples=15, deadline=None)
@given(_SEEDS, st.floats(-1e3, 1e3), st.floats(1e-3, 1e3))
def test_anova_does_not_depend_on_units_or_names(seed, shift, factor):
    rng = np.random.default_rng(seed)
    group = rng.choice(["a", "b", "c"], 20)
    assume(len(set(group)) == 3)
    y = rng.normal(size=20)
    first = analysis_of_variance(y, {"g": group})["g"]
    renamed = [{"a": "z", "b": "y", "c": "x"}[g] for g in group]
    second = analysis_of_variance(shift + factor * y, {"g": renamed})["g"]
    assert second.f == pytest.approx(first.f, rel=1e-5)


@settings(max_examples=10, deadline=None)
@given(_SEEDS)
def test_tukey_of_two_groups_is_the_pooled_t_test(seed):
    rng = np.random.default_rng(seed)
    first, second = rng.normal(size=7), rng.normal(1.0, size=9)
    model = linear_model([*first, *second], {"g": ["a"] * 7 + ["b"] * 9})
    (found,) = tukey_hsd(model, "g")
    expected = t_test(first, second, kind="pooled")
    assert found.p == pytest.approx(expected.p, rel=1e-4)
    assert (found.low, found.high) == pytest.approx((expected.low, expected.high), rel=1e-5)


@settings(max_examples=15, deadline=None)
@given(_SEEDS)
def test_letters_say_what_the_comparisons_say(seed):
    rng = np.random.default_rng(seed)
    groups = np.repeat(list("abcde"), 6)
    y = rng.normal(size=30) + np.repeat(rng.normal(0, 1.2, 5), 6)
    comparisons = tukey_hsd(linear_model(y, {"g": groups}), "g")
    marks = letters(comparisons)
    for c in comparisons:
        shared = set(marks[c.first]) & set(marks[c.second])
        assert bool(shared) == (c.p >= 0.05)


@settings(max_examples=10, deadline=None)
@given(_SEEDS, st.floats(1e-4, 1e4), st.floats(-100, 100), st.sampled_from(["firth", ""]))
@example(0, 3.5e-4, 9.0, "firth")  # an intercept 26,000 standard deviations from the data
def test_logistic_does_not_depend_on_units(seed, factor, shift, method):
    rng = np.random.default_rng(seed)
    x = rng.normal(size=30)
    y = (rng.random(30) < 1 / (1 + np.exp(-x))).astype(int)
    assume(4 < y.sum() < 26)
    method = method or "maximum_likelihood"
    try:
        first = logistic_regression(y, {"x": x}, method=method)
    except DataError:
        assert separation(np.column_stack((np.ones(30), x)), y).separated
        return
    moved = logistic_regression(y, {"x": shift + factor * x}, method=method)
    assert moved["x"].estimate * factor == pytest.approx(first["x"].estimate, rel=1e-4, abs=1e-6)
    assert moved["x"].p == pytest.approx(first["x"].p, rel=1e-3, abs=1e-7)
    turned = logistic_regression(1 - y, {"x": x}, method=method)
    assert turned["x"].estimate == pytest.approx(-first["x"].estimate, rel=1e-5, abs=1e-7)


@settings(max_examples=20, deadline=None)
@given(st.floats(0.05, 1.0), st.floats(0.05, 0.8), st.floats(0.0, 0.9), st.floats(0.01, 100.0))
def test_stribeck_fit_finds_exact_data_in_any_unit_of_speed(boundary, tau, share, unit):
    speed = np.array([0.05, *np.arange(0.1, 1.01, 0.1)])
    asymptote = share * boundary
    cof = asymptote + (boundary - asymptote) * np.exp(-speed / tau)
    fit = stribeck_fit(unit * speed, cof)
    assert fit.raw == pytest.approx((boundary, unit * tau, asymptote), rel=1e-4, abs=1e-5)
    assert fit.curve(unit * speed) == pytest.approx(cof, abs=1e-7)


def test_crossed_terms():
    assert crossed_terms("a", "b", "c") == ("a", "b", "c", "a:b", "a:c", "b:c", "a:b:c")
    assert crossed_terms("a", "b", "c", order=2)[-1] == "b:c"


def test_refusals_name_the_trouble():
    with pytest.raises(InputError, match="one level"):
        analysis_of_variance([1.0, 2.0, 3.0], {"shoe": ["a", "a", "a"]})
    with pytest.raises(DataError, match="leave nothing"):
        analysis_of_variance([1.0, 2.0], {"shoe": ["a", "b"]})
    with pytest.raises(DataError, match="constant"):
        analysis_of_variance([1.0, 1.0, 1.0], {"shoe": ["a", "b", "b"]})
    with pytest.raises(InputError, match="1, 2, 3"):
        analysis_of_variance([1.0, 2.0, 3.0], {"shoe": ["a", "b", "b"]}, ss_type=4)
    with pytest.raises(DataError, match="all 4 outcomes"):
        logistic_regression([1, 1, 1, 1], {"x": [1.0, 2.0, 3.0, 4.0]})
    with pytest.raises(DataError, match="follows from the others"):
        logistic_regression([0, 1, 0, 1], {"x": [1.0, 2, 3, 5], "z": [2.0, 4, 6, 10]})
    with pytest.raises(InputError, match="fewer than two"):
        fisher_exact([[1, 2], [0, 0]])
    with pytest.raises(InputError, match="welch"):
        t_test([1.0, 2.0], [2.0, 3.0], kind="welsh")


def test_empty_cells_are_warned_of():
    y = np.arange(9.0) ** 1.5
    a = ["x", "x", "x", "x", "y", "y", "y", "y", "y"]
    b = ["p", "p", "q", "q", "p", "p", "p", "p", "p"]
    table = analysis_of_variance(y, {"a": a, "b": b})
    assert any("a y and b q" in text for text in table.warnings)
    assert table["a:b"].df == 0


@pytest.mark.parametrize("method", ["maximum_likelihood", "firth"])
def test_slips_counted_as_steps_that_held_turn_every_sign_and_no_warning(method):
    generator = np.random.default_rng(4)
    x, idle = generator.normal(0.2, 0.05, 60), generator.normal(size=60)
    slipped = (generator.random(60) < 1 / (1 + np.exp(2.0 + 20 * (x - 0.2)))).astype(float)
    assert 2 < slipped.sum() < 10  # fewer than five for each predictor
    one, other = (
        logistic_regression(outcome, {"cof": x, "idle": idle}, method=method)
        for outcome in (slipped, 1 - slipped)
    )
    for first, second in zip(one.coefficients, other.coefficients, strict=True):
        assert second.estimate == pytest.approx(-first.estimate, rel=1e-4, abs=1e-5)
        assert second.low == pytest.approx(-first.high, rel=1e-3, abs=1e-3)
    assert one.warnings == other.warnings
    assert len(one.warnings) == 1
    both = np.tile(slipped, 4), {"cof": np.tile(x, 4), "idle": np.tile(idle, 4)}
    four = logistic_regression(*both, method=method)
    assert len(four.warnings) == 0
