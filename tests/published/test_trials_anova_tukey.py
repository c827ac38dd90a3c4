"""Analysis of variance, Tukey and subsets against R 4.2.2 (car, emmeans) on data in print."""

import numpy as np
import pytest
from scipy import stats

from underfoot.trials.statistics import (
    all_subsets,
    analysis_of_variance,
    least_squares_means,
    linear_model,
    tukey_hsd,
)

# Moore and Krupat 1971; Fox, Applied Regression Analysis.
_MOORE = {
    ("low", "low"): [8, 7, 10, 6, 13, 12, 7, 6, 8, 12],
    ("low", "medium"): [12, 4, 4, 9],
    ("low", "high"): [4, 8, 13, 9, 24, 7, 23, 13],
    ("high", "low"): [21, 23, 15, 12, 16],
    ("high", "medium"): [12, 17, 14, 16, 20, 8, 14, 17, 7, 17, 15],
    ("high", "high"): [19, 9, 7, 11, 14, 13, 10],
}
# ToothGrowth (Crampton 1947) less ten rows, to unbalance it.
_TOOTH = {
    ("OJ", "0.5"): [15.2, 21.5, 9.7, 14.5, 10, 8.2, 9.4, 16.5, 9.7],
    ("OJ", "1"): [19.7, 23.3, 23.6, 26.4, 20, 25.2, 25.8, 21.2, 14.5, 27.3],
    ("OJ", "2"): [25.5, 26.4, 22.4, 24.5, 24.8, 30.9, 26.4],
    ("VC", "0.5"): [6.4, 10, 11.2, 11.2, 5.2, 7],
    ("VC", "1"): [16.5, 16.5, 15.2, 17.3, 13.6, 14.5, 18.8, 15.5],
    ("VC", "2"): [23.6, 18.5, 33.9, 25.5, 26.4, 32.5, 26.7, 21.5, 23.3, 29.5],
}
# Tippett 1950, warpbreaks.
_WARP = {
    ("A", "L"): [26, 30, 54, 25, 70, 52, 51, 26, 67],
    ("B", "L"): [27, 14, 29, 19, 29, 31, 41, 20, 44],
    ("A", "M"): [18, 21, 29, 17, 12, 18, 35, 30, 36],
    ("B", "M"): [42, 26, 19, 16, 39, 28, 21, 39, 29],
    ("A", "H"): [36, 21, 24, 18, 10, 43, 28, 15, 26],
    ("B", "H"): [20, 21, 24, 17, 13, 15, 15, 16, 28],
}


def _flat(cells, first, second):
    response = [v for values in cells.values() for v in values]
    return response, {
        first: [key[0] for key, values in cells.items() for _ in values],
        second: [key[1] for key, values in cells.items() for _ in values],
    }


def test_moore_types_one_to_three():
    y, x = _flat(_MOORE, "partner", "fcategory")
    terms = ("fcategory", "partner", "fcategory:partner")
    one = analysis_of_variance(y, x, terms, ss_type=1)
    assert one["fcategory"].sum_of_squares == pytest.approx(3.733, abs=5e-4)
    assert one["fcategory"].f == pytest.approx(0.08902, abs=5e-6)
    assert one["partner"].sum_of_squares == pytest.approx(212.214, abs=5e-4)
    assert one["partner"].f == pytest.approx(10.1207, abs=5e-5)
    assert one["fcategory:partner"].sum_of_squares == pytest.approx(175.489, abs=5e-4)
    assert one["fcategory:partner"].f == pytest.approx(4.18462, abs=5e-6)
    two = analysis_of_variance(y, x, terms, ss_type=2)
    assert two["fcategory"].sum_of_squares == pytest.approx(11.615, abs=5e-4)
    assert two["fcategory"].f == pytest.approx(0.27696, abs=5e-6)
    assert two["fcategory"].p == pytest.approx(0.75956, abs=5e-6)
    assert two["partner"].p == pytest.approx(0.0028742, abs=5e-8)
    assert two["fcategory:partner"].p == pytest.approx(0.0225724, abs=5e-8)
    three = analysis_of_variance(y, x, terms, ss_type=3)
    assert three["fcategory"].sum_of_squares == pytest.approx(36.019, abs=5e-4)
    assert three["fcategory"].f == pytest.approx(0.85888, abs=5e-6)
    assert three["fcategory"].p == pytest.approx(0.43149, abs=5e-6)
    assert three["partner"].sum_of_squares == pytest.approx(239.562, abs=5e-4)
    assert three["partner"].f == pytest.approx(11.4250, abs=5e-5)
    assert three["partner"].p == pytest.approx(0.0016571, abs=5e-8)
    assert three["residual"].sum_of_squares == pytest.approx(817.764, abs=5e-4)
    assert three["residual"].df == 39
    assert "type III" in three.title


def test_tooth_growth_unbalanced():
    y, x = _flat(_TOOTH, "supp", "dose")
    two = analysis_of_variance(y, x, ss_type=2)
    assert two["supp"].sum_of_squares == pytest.approx(158.387, abs=5e-4)
    assert two["supp"].f == pytest.approx(11.67395, abs=5e-6)
    assert two["supp"].p == pytest.approx(0.0013746, abs=5e-8)
    assert two["dose"].sum_of_squares == pytest.approx(1911.939, abs=5e-4)
    assert two["dose"].f == pytest.approx(70.46002, abs=5e-6)
    assert two["supp:dose"].sum_of_squares == pytest.approx(107.088, abs=5e-4)
    assert two["supp:dose"].f == pytest.approx(3.94648, abs=5e-6)
    assert two["supp:dose"].p == pytest.approx(0.02652, abs=5e-6)
    three = analysis_of_variance(y, x, ss_type=3)
    assert three["supp"].sum_of_squares == pytest.approx(152.395, abs=5e-4)
    assert three["supp"].f == pytest.approx(11.23235, abs=5e-6)
    assert three["supp"].p == pytest.approx(0.0016591, abs=5e-8)
    assert three["dose"].sum_of_squares == pytest.approx(1817.871, abs=5e-4)
    assert three["dose"].f == pytest.approx(66.99336, abs=5e-6)
    assert three["residual"].sum_of_squares == pytest.approx(596.972, abs=5e-4)
    assert three["residual"].df == 44


def test_least_squares_means_and_tukey_unbalanced():
    y, x = _flat(_TOOTH, "supp", "dose")
    model = linear_model(y, x)
    means = least_squares_means(model, "dose")
    assert [m.mean for m in means] == pytest.approx([10.622222, 19.34375, 25.991429], abs=5e-7)
    assert [m.standard_error for m in means] == pytest.approx(
        [0.970665, 0.873599, 0.907603], abs=5e-7
    )
    half_one, half_two, one_two = tukey_hsd(model, "dose")
    assert half_one.difference == pytest.approx(-8.721528, abs=5e-7)
    assert half_one.standard_error == pytest.approx(1.305896, abs=5e-7)
    assert half_one.t == pytest.approx(-6.678576, abs=5e-7)
    assert half_one.p == pytest.approx(1.00884e-7, rel=1e-5)
    assert (half_one.low, half_one.high) == pytest.approx((-11.888956, -5.554100), abs=1e-6)
    assert half_two.difference == pytest.approx(-15.369206, abs=5e-7)
    assert half_two.p == pytest.approx(2.742e-14, abs=1e-13)  # as exact as the integral
    assert one_two.difference == pytest.approx(-6.647679, abs=5e-7)
    assert one_two.standard_error == pytest.approx(1.259730, abs=5e-7)
    assert one_two.p == pytest.approx(1.13339e-5, rel=1e-5)
    assert (one_two.low, one_two.high) == pytest.approx((-9.703130, -3.592227), abs=1e-6)
    # R's TukeyHSD compares sequential means; they must not be what we give.
    assert abs(half_one.difference) != pytest.approx(8.747963, abs=1e-3)


def test_tukey_uses_the_mean_square_of_its_model():
    y, x = _flat(_WARP, "wool", "tension")
    two_way = {
        (c.first, c.second): c
        for c in tukey_hsd(linear_model(y, x, ("wool", "tension")), "tension")
    }
    assert two_way["L", "M"].difference == pytest.approx(10.0)
    assert (two_way["L", "M"].low, two_way["L", "M"].high) == pytest.approx(
        (0.646579, 19.353421), abs=2e-6
    )
    assert two_way["L", "M"].p == pytest.approx(0.03362622, abs=1e-8)
    assert two_way["L", "H"].difference == pytest.approx(14.722222, abs=5e-7)
    assert two_way["L", "H"].p == pytest.approx(0.00112179, abs=1e-8)
    assert two_way["M", "H"].p == pytest.approx(0.44742102, abs=1e-8)
    one_way = tukey_hsd(linear_model(y, {"tension": x["tension"]}), "tension")
    assert [c.p for c in one_way] == pytest.approx([0.03845977, 0.00143150, 0.46308310], abs=1e-8)


def test_plant_growth_one_way():
    # Dobson 1983, PlantGrowth.
    control = [4.17, 5.58, 5.18, 6.11, 4.50, 4.61, 5.17, 4.53, 5.33, 5.14]
    first = [4.81, 4.17, 4.41, 3.59, 5.87, 3.83, 6.03, 4.89, 4.32, 4.69]
    second = [6.31, 5.12, 5.54, 5.50, 5.37, 5.29, 4.92, 6.15, 5.80, 5.26]
    group = ["ctrl"] * 10 + ["trt1"] * 10 + ["trt2"] * 10
    table = analysis_of_variance([*control, *first, *second], {"group": group})
    assert table["group"].f == pytest.approx(4.84609, abs=5e-6)
    assert table["group"].p == pytest.approx(0.01591, abs=5e-6)
    found = tukey_hsd(table.model, "group")
    assert [c.p for c in found] == pytest.approx([0.39087114, 0.19799599, 0.01200642], abs=1e-8)


def test_chick_weights_tukey_kramer():
    # Anonymous 1948, chickwts: unequal groups.
    feeds = {
        "horsebean": [179, 160, 136, 227, 217, 168, 108, 124, 143, 140],
        "linseed": [309, 229, 181, 141, 260, 203, 148, 169, 213, 257, 244, 271],
        "soybean": [243, 230, 248, 327, 329, 250, 193, 271, 316, 267, 199, 171, 158, 248],
        "sunflower": [423, 340, 392, 339, 341, 226, 320, 295, 334, 322, 297, 318],
        "meatmeal": [325, 257, 303, 315, 380, 153, 263, 242, 206, 344, 258],
        "casein": [368, 390, 379, 260, 404, 318, 352, 359, 216, 222, 283, 332],
    }
    weight = [v for values in feeds.values() for v in values]
    feed = [name for name, values in feeds.items() for _ in values]
    table = analysis_of_variance(weight, {"feed": feed})
    assert table["feed"].f == pytest.approx(15.3648, abs=5e-5)
    found = {frozenset((c.first, c.second)): c.p for c in tukey_hsd(table.model, "feed")}
    assert found[frozenset(("linseed", "casein"))] == pytest.approx(0.00021002, abs=1e-8)
    assert found[frozenset(("soybean", "casein"))] == pytest.approx(0.00836531, abs=1e-8)


def test_all_subsets_of_stack_loss():
    # Brownlee 1960, stackloss.
    air = "80,80,75,62,62,62,62,62,58,58,58,58,58,58,50,50,50,50,50,56,70"
    water = "27,27,25,24,22,23,24,24,23,18,18,17,18,19,18,18,19,19,20,20,20"
    acid = "89,88,90,87,87,87,93,93,87,80,89,88,82,93,89,86,72,79,80,82,91"
    loss = "42,37,37,28,18,18,19,20,15,14,14,13,11,12,8,7,8,8,9,15,15"
    data = {
        name: np.array([float(v) for v in text.split(",")])
        for name, text in (("air", air), ("water", water), ("acid", acid))
    }
    found = all_subsets([float(v) for v in loss.split(",")], data)
    assert {s.predictors: s.adjusted_r_squared for s in found} == pytest.approx(
        {
            ("air",): 0.83766407,
            ("water",): 0.75421891,
            ("acid",): 0.115646,
            ("air", "water"): 0.89862327,
            ("air", "acid"): 0.83400353,
            ("water", "acid"): 0.74490985,
            ("air", "water", "acid"): 0.89832577,
        },
        abs=5e-7,
    )


@pytest.mark.parametrize(("levels", "repeats"), [(2, 2), (3, 4), (6, 9), (12, 60)])
def test_studentized_range_is_that_of_scipy(levels, repeats):
    names = np.repeat([f"l{n}" for n in range(levels)], repeats)
    values = np.random.default_rng(levels).normal(size=names.size) + (names == "l0")
    found = tukey_hsd(linear_model(values, {"level": names}), "level", confidence=0.9)
    exact = levels, levels * (repeats - 1)
    for one in found[:: len(found) // 3 + 1]:
        q = np.sqrt(2) * abs(one.t)
        assert one.p == pytest.approx(stats.studentized_range.sf(q, *exact), abs=1e-10)
    width = np.sqrt(2) * (one.high - one.difference) / one.standard_error
    assert width == pytest.approx(stats.studentized_range.ppf(0.9, *exact), rel=1e-8)
