"""Logistic regression against R 4.2.2 (glm, logistf, brglm2) and the report's own model.

Tolerances are one or two units of the last digit given: R's own iterations stop there.
"""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from underfoot.core import DataError
from underfoot.trials.statistics import clustered_logistic, logistic_regression
from underfoot.trials.statistics.logistic import sandwich

# Dalal, Fowlkes and Hoadley 1989, O-rings.
_TEMPERATURE = [66, 70, 69, 68, 67, 72, 73, 70, 57, 63, 70, 78]
_TEMPERATURE += [67, 53, 67, 75, 70, 81, 76, 79, 75, 76, 58]
_DISTRESS = [0, 1, 0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 1]
# Heinze and Schemper 2002, endometrial cancer grade.
_NV = "0000000000000000000001111100000000000000000000011110000000000000000000100011010"
_HG = "0000000000000000011111111110000000000000000111111111100000000000000001111111111"
_PI = (
    "13,16,8,34,20,5,17,10,26,17,8,7,20,10,18,16,18,8,29,12,20,38,22,7,25,15,7,28,11,19,10,10,18,"
    "14,21,11,17,25,16,19,15,33,24,48,12,19,2,22,40,5,0,21,15,29,15,12,3,20,23,12,22,42,15,13,14,"
    "19,12,13,10,12,49,6,5,17,11,21,5,19,33"
)
_EH = (
    "1.64,2.26,3.14,2.68,1.28,2.31,1.8,1.68,1.56,2.31,2.01,1.89,3.15,1.23,1.27,1.76,2.0,2.64,0.88,"
    "1.27,1.37,0.97,1.14,0.88,0.91,0.58,0.97,1.5,1.33,2.37,1.82,3.13,1.31,1.92,1.64,2.01,1.88,"
    "1.93,2.11,1.29,1.72,0.75,1.92,1.84,1.11,1.61,1.18,1.44,1.18,0.93,1.17,1.19,1.06,2.02,2.29,"
    "2.33,2.9,1.7,1.41,2.25,1.54,1.97,1.75,2.16,2.57,1.37,3.61,2.04,2.17,1.69,0.27,1.84,1.3,0.96,"
    "1.01,0.98,0.35,1.02,0.85"
)
_CARS_WEIGHT = [2.620, 2.875, 2.320, 3.215, 3.440, 3.460, 3.570, 3.190, 3.150, 3.440, 3.440]
_CARS_WEIGHT += [4.070, 3.730, 3.780, 5.250, 5.424, 5.345, 2.200, 1.615, 1.835, 2.465, 3.520]
_CARS_WEIGHT += [3.435, 3.840, 3.845, 1.935, 2.140, 1.513, 3.170, 2.770, 3.570, 2.780]
_CARS_MANUAL = [1] * 3 + [0] * 14 + [1] * 3 + [0] * 5 + [1] * 7


def _endometrial():
    y = [int(c) for c in _HG]
    x = {
        "NV": [float(c) for c in _NV],
        "PI": [float(v) for v in _PI.split(",")],
        "EH": [float(v) for v in _EH.split(",")],
    }
    return y, x


def test_o_rings_maximum_likelihood():
    fit = logistic_regression(_DISTRESS, {"temperature": _TEMPERATURE})
    slope = fit["temperature"]
    assert fit["intercept"].estimate == pytest.approx(15.04290, abs=5e-6)
    assert fit["intercept"].standard_error == pytest.approx(7.37863, abs=1e-5)
    assert slope.estimate == pytest.approx(-0.23216, abs=5e-6)
    assert slope.standard_error == pytest.approx(0.10824, abs=5e-6)
    assert fit.deviance == pytest.approx(20.3152, abs=5e-5)
    # R interpolates its profile; at the exact ends the deviance rises by chi2(0.95, 1) = 3.841459.
    assert (slope.low, slope.high) == pytest.approx((-0.51547175, -0.060820762), abs=5e-5)
    y, x = np.array(_DISTRESS), np.array(_TEMPERATURE)
    for end in (slope.low, slope.high):
        fixed = minimize_scalar(
            lambda b0, b1=end: 2.0 * np.sum(np.logaddexp(0, b0 + b1 * x) - y * (b0 + b1 * x)),
            bracket=(0.0, 30.0),
        )
        assert fixed.fun - fit.deviance == pytest.approx(3.841459, abs=1e-5)
    assert fit.probability(temperature=31.0) == pytest.approx(0.99960878, abs=5e-9)


def test_o_rings_firth():
    fit = logistic_regression(_DISTRESS, {"temperature": _TEMPERATURE}, method="firth")
    slope = fit["temperature"]
    assert fit.estimates == pytest.approx([11.949514, -0.186042], abs=2e-6)
    assert fit["intercept"].standard_error == pytest.approx(6.255438, abs=1e-6)
    assert slope.standard_error == pytest.approx(0.091582, abs=1e-6)
    assert (slope.low, slope.high) == pytest.approx((-0.419533, -0.040529), abs=5e-7)


def test_cars_maximum_likelihood():
    fit = logistic_regression(_CARS_MANUAL, {"weight": _CARS_WEIGHT})
    assert fit.estimates == pytest.approx([12.0403697, -4.0239699], abs=1e-7)


def test_quasi_separation_is_found_and_firth_answers():
    y, x = _endometrial()
    with pytest.raises(DataError, match=r"quasi-complete separation.*NV"):
        logistic_regression(y, x)
    fit = logistic_regression(y, x, method="firth")
    assert fit.separation.infinite == (False, True, False, False)
    assert fit.estimates == pytest.approx([3.774559, 2.929273, -0.034752, -2.604164], abs=1e-6)
    assert fit.penalised_log_likelihood == pytest.approx(-24.037268, abs=5e-7)
    assert (fit["NV"].low, fit["NV"].high) == pytest.approx((0.609724, 7.854632), abs=1e-6)
    assert (fit["PI"].low, fit["PI"].high) == pytest.approx((-0.124459, 0.040455), abs=1e-6)
    assert (fit["EH"].low, fit["EH"].high) == pytest.approx((-4.365183, -1.232721), abs=1e-6)
    assert fit["NV"].p == pytest.approx(0.0091237, abs=5e-8)
    assert fit["PI"].p == pytest.approx(0.387482, abs=5e-7)
    assert fit["EH"].p == pytest.approx(2.50687e-5, abs=5e-10)
    errors = [c.standard_error for c in fit.coefficients]
    assert errors == pytest.approx([1.488692, 1.550764, 0.039578, 0.776018], abs=1e-6)


def test_maximum_likelihood_of_the_finite_part():
    # The finite coefficients follow when the observations the separator decides are dropped.
    y, x = _endometrial()
    kept = [i for i, nv in enumerate(x["NV"]) if nv == 0]
    fit = logistic_regression(
        [y[i] for i in kept], {name: [x[name][i] for i in kept] for name in ("PI", "EH")}
    )
    assert fit.estimates == pytest.approx([4.304518, -0.042183, -2.902606], abs=5e-7)


def test_complete_separation_on_the_scale_of_a_cof():
    x = [0.12, 0.14, 0.15, 0.16, 0.17, 0.18, 0.19, 0.20, 0.21, 0.23]
    y = [1, 1, 1, 1, 1, 0, 0, 0, 0, 0]
    fit = logistic_regression(y, {"acof": x}, method="firth")
    assert fit.separation.kind == "complete"
    assert fit.estimates == pytest.approx([16.811668, -96.066676], abs=5e-6)
    assert fit["acof"].standard_error == pytest.approx(59.096904, abs=5e-5)
    assert fit["intercept"].standard_error == pytest.approx(10.389771, abs=5e-6)


def test_reports_risk_model_is_consistent_with_its_percentages():
    # G.6: slope -49.2 of ACOF - RCOF, 50 % at -0.06.
    from underfoot.trials.statistics.logistic import LogisticLine

    line = LogisticLine(-2.952, -49.2)
    assert line.at_probability(0.5) == pytest.approx(-0.06, abs=5e-5)
    assert line.probability(np.array([0.044, -0.111, -0.033, 0.0])) == pytest.approx(
        [0.006, 0.925, 0.21, 0.05], abs=5e-3
    )
    # Odds ratio 1.7 per 0.01 of RCOF (Beschorner 2016): slope 53.
    assert np.log(1.7) / 0.01 == pytest.approx(53, abs=0.5)


def test_clusters_widen_the_error_when_outcomes_repeat():
    rng = np.random.default_rng(4)
    x = np.repeat(rng.normal(size=30), 2)
    y = np.repeat((rng.random(30) < 1 / (1 + np.exp(-0.8 * x[::2]))).astype(int), 2)
    y[::10] = 1 - y[::10]
    subjects = np.repeat(np.arange(30), 2)
    plain = logistic_regression(y, {"x": x})
    clustered = clustered_logistic(y, {"x": x}, subjects)
    assert clustered.correlation > 0.3
    assert clustered["x"].standard_error > plain["x"].standard_error


def test_clusters_against_statsmodels():
    # statsmodels 0.15.0, GEE with exchangeable correlation, robust and bias_reduced covariance.
    x = (
        ".181,.221,.217,.165,.171,.164,.197,.178,.202,.125,.227,.177,.2,.176,.169,.194,.205,.174,"
        ".175,.201,.154,.135,.192,.16,.122,.156,.166,.144,.135,.181,.207,.173,.158,.192,.202,.171,"
        ".196,.211,.174,.156,.19,.187,.213,.141,.16,.155,.128,.184"
    )
    y = [int(c) for c in "100001110001101111000000011110001100111100001111"]
    acof = [float(v) for v in x.split(",")]
    fit = clustered_logistic(y, {"acof": acof}, np.repeat(np.arange(24), 2))
    assert fit["intercept"].estimate == pytest.approx(1.78586367, abs=1e-8)
    assert fit["acof"].estimate == pytest.approx(-10.09514236, abs=1e-8)
    # Between the sandwich (robust) and Mancl and DeRouen's form (bias-reduced).
    assert 9.27647707 < fit["acof"].standard_error < 9.97151192
    assert fit["acof"].p == pytest.approx(0.30, abs=0.01)
    assert fit.correlation == pytest.approx(0.5311928996, abs=1e-9)


def test_small_sample_errors_of_clusters_against_statsmodels():
    """The three powers of the leverage: plain and bias-reduced are those of statsmodels."""
    from statsmodels.genmod.cov_struct import Independence
    from statsmodels.genmod.families import Binomial
    from statsmodels.genmod.generalized_estimating_equations import GEE

    rng = np.random.default_rng(9)
    groups = np.repeat(np.arange(12), [2, 3, 4] * 4)
    matrix = np.column_stack((np.ones(36), rng.normal(size=(36, 2))))
    y = (rng.random(36) < 0.5).astype(float)
    fit = GEE(y, matrix, groups, family=Binomial(), cov_struct=Independence()).fit(
        cov_type="bias_reduced", ctol=1e-12
    )
    mean = fit.fittedvalues
    rows = [matrix[groups == k] for k in range(12)]
    scores = np.array([x.T @ (y - mean)[groups == k] for k, x in enumerate(rows)])
    weight = mean * (1 - mean)
    curvatures = np.array([(x.T * weight[groups == k]) @ x for k, x in enumerate(rows)])
    assert sandwich(scores, curvatures, 0.0) == pytest.approx(fit.cov_robust, rel=1e-8)
    assert sandwich(scores, curvatures, 1.0) == pytest.approx(fit.cov_robust_bc, rel=1e-8)
    # Kauermann and Carroll by their formula: residuals times the inverse root of 1 - leverage.
    bread, meat = np.linalg.inv(curvatures.sum(axis=0)), np.zeros((3, 3))
    for k, x in enumerate(rows):
        own = weight[groups == k]
        leverage = (x * np.sqrt(own)[:, None]) @ bread @ (x * np.sqrt(own)[:, None]).T
        value, axes = np.linalg.eigh(np.eye(len(x)) - leverage)
        pearson = (y - mean)[groups == k] / np.sqrt(own)
        score = (x.T * np.sqrt(own)) @ (axes @ ((axes.T @ pearson) / np.sqrt(value)))
        meat += np.outer(score, score)
    assert sandwich(scores, curvatures, 0.5) == pytest.approx(bread @ meat @ bread, rel=1e-8)


def test_persons_who_always_do_the_same_have_an_answer():
    """No correlation fits them: as many rows tell no more than one of each person."""
    rng = np.random.default_rng(2)
    x, y = rng.normal(size=12), np.array([0, 1, 1, 0, 1, 0, 0, 1, 0, 1, 1, 0])
    who = np.arange(12)
    once = clustered_logistic(y, {"x": x}, who)["x"]
    thrice = clustered_logistic(np.repeat(y, 3), {"x": np.repeat(x, 3)}, np.repeat(who, 3))["x"]
    assert thrice.estimate == pytest.approx(once.estimate, rel=1e-6)
    assert thrice.standard_error == pytest.approx(once.standard_error, rel=1e-6)
    assert thrice.p == once.p


def test_flipped_signs_of_few_persons_are_counted_out():
    """Four persons: 16 flips, of which the two that keep or turn all signs are as far out."""
    x, y = [1.0, 0.9, -1.0, -0.9] * 4, [1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 0, 0, 0, 1, 0, 0]
    p = clustered_logistic(y, {"x": x}, np.repeat(np.arange(4), 4))["x"].p
    assert p * 16 == pytest.approx(round(p * 16), abs=1e-9)
    assert p >= 2 / 16


def test_risk_curve_band():
    from underfoot.trials.statistics.logistic import risk_curve

    fit = logistic_regression(_DISTRESS, {"temperature": _TEMPERATURE})
    curve = risk_curve(fit, np.array([31.0, 70.0]))
    assert curve.risk[0] == pytest.approx(0.99960878, abs=5e-9)
    assert (curve.low < curve.risk).all()
    assert (curve.risk < curve.high).all()
    assert curve.half == pytest.approx(15.04290 / 0.23216, rel=5e-5)
    # With the predictor counted from the 50 % point the intercept's error is all that is left.
    moved = logistic_regression(_DISTRESS, {"x": np.array(_TEMPERATURE) - curve.half})
    expected = moved["intercept"].standard_error / abs(moved["x"].estimate)
    assert curve.half_error == pytest.approx(expected, rel=1e-6)
