"""Fisher's exact test and t tests against R 4.2.2."""

from math import comb

import pytest

from underfoot.trials.statistics import fisher_exact, t_test


@pytest.mark.parametrize(
    ("table", "p", "tolerance"),
    [
        ([[3, 1], [1, 3]], 0.485714, 5e-7),
        ([[8, 2], [1, 5]], 0.034965, 5e-7),
        ([[2, 15], [10, 3]], 0.00053672, 5e-9),
        # Agresti, job satisfaction.
        ([[1, 3, 10, 6], [2, 3, 10, 7], [1, 6, 14, 12], [0, 1, 9, 11]], 0.78268494, 5e-9),
        ([[2, 3], [4, 1], [0, 3]], 0.1550117, 5e-8),
        # A reconstruction of the report's slip table from its percentages (G.6.2): not unique.
        ([[7, 10], [7, 11], [1, 16]], 0.037439, 5e-7),
    ],
)
def test_fisher_p(table, p, tolerance):
    assert fisher_exact(table).p == pytest.approx(p, abs=tolerance)
    assert fisher_exact(list(zip(*table, strict=True))).p == pytest.approx(p, abs=tolerance)


def test_fisher_odds_ratios():
    tea = fisher_exact([[3, 1], [1, 3]])
    assert tea.odds_ratio == pytest.approx(6.40831, abs=5e-5)
    # R prints 621.934 for the upper end (its root finder stops early); the exact end satisfies
    # P(X <= 3) = 0.025 with weights C(4, k) C(4, 4 - k) psi^k.
    assert tea.low == pytest.approx(0.21173, abs=1e-5)
    assert tea.high == pytest.approx(621.934, rel=0.01)
    weights = [comb(4, k) ** 2 * tea.high**k for k in range(5)]
    assert sum(weights[:4]) / sum(weights) == pytest.approx(0.025, rel=1e-6)
    assert tea.sample_odds_ratio == pytest.approx(9.0)
    second = fisher_exact([[8, 2], [1, 5]])
    # The conditional estimate makes the expected count equal the observed one; R stops early.
    assert second.odds_ratio == pytest.approx(15.4697, rel=5e-4)
    weights = [comb(10, k) * comb(6, 9 - k) * second.odds_ratio**k for k in range(3, 10)]
    mean = sum(k * w for k, w in zip(range(3, 10), weights, strict=True)) / sum(weights)
    assert mean == pytest.approx(8.0, rel=1e-6)
    assert (second.low, second.high) == pytest.approx((1.00885, 1049.79), rel=0.01)
    third = fisher_exact([[2, 15], [10, 3]])
    assert third.odds_ratio == pytest.approx(0.0469366, abs=5e-6)


def test_t_tests():
    # Student 1908, sleep.
    one = [0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0]
    two = [1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4]
    welch = t_test(one, two)
    assert (welch.t, welch.df, welch.p) == pytest.approx((-1.86081, 17.7765, 0.079394), rel=1e-5)
    assert t_test(one, two, kind="pooled").p == pytest.approx(0.079187, abs=5e-7)
    # Box, Hunter and Hunter, wear of boys' shoes.
    a = [13.2, 8.2, 10.9, 14.3, 10.7, 6.6, 9.5, 10.8, 8.8, 13.3]
    b = [14, 8.8, 11.2, 14.2, 11.8, 6.4, 9.8, 11.3, 9.3, 13.6]
    paired = t_test(a, b, kind="paired")
    assert (paired.t, paired.df, paired.p) == pytest.approx((-3.34888, 9, 0.0085388), rel=1e-5)
    assert paired.difference == pytest.approx(-0.41)
    assert (paired.low, paired.high) == pytest.approx((-0.686954, -0.133046), abs=5e-7)
