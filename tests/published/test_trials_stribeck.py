"""Exponential fits against NIST StRD certified values, R's nls and the report's Figure 14."""

import numpy as np
import pytest
from scipy.optimize import nnls

from underfoot.core import DataError
from underfoot.trials.machines.stribeck_fit import NOT_IDENTIFIED, linear_part, stribeck_fit

_SPEEDS = np.array([0.05, *np.arange(0.1, 1.01, 0.1)])
# Eq. 17 with Figure 14's values (0.164, 0.839, 0.184).
_EXACT = ".67839 .55599 .39164 .29619 .24077 .20858 .18989 .17903 .17273 .16907 .16694"
_NOISY = [0.681, 0.552, 0.401, 0.290, 0.245, 0.203, 0.196, 0.175, 0.178, 0.166, 0.170]


def _eq17(boundary, tau, asymptote):
    return asymptote + (boundary - asymptote) * np.exp(-_SPEEDS / tau)


@pytest.mark.parametrize("method", ["separable", "nelder_mead"])
def test_figure_14(method):
    cof = [float(v) for v in _EXACT.split()]
    assert cof == pytest.approx(_eq17(0.839, 0.184, 0.164), abs=5e-6)
    fit = stribeck_fit(_SPEEDS, cof, method=method)
    assert fit.boundary.value == pytest.approx(0.839, abs=5e-5)
    assert fit.tau.value == pytest.approx(0.184, abs=5e-5)
    assert fit.asymptote.value == pytest.approx(0.164, abs=5e-5)
    assert fit.verdict == "good"


@pytest.mark.parametrize("method", ["separable", "nelder_mead"])
def test_noise_against_r(method):
    fit = stribeck_fit(_SPEEDS, _NOISY, method=method)
    assert fit.asymptote.value == pytest.approx(0.16464668, abs=5e-7)
    assert fit.boundary.value == pytest.approx(0.84042096, abs=5e-7)
    assert fit.tau.value == pytest.approx(0.18386122, abs=5e-7)
    assert fit.asymptote.standard_error == pytest.approx(0.0033384780, rel=2e-5)
    assert fit.boundary.standard_error == pytest.approx(0.010164269, rel=2e-5)
    assert fit.tau.standard_error == pytest.approx(0.0053427602, rel=2e-5)
    assert fit.residual_sum == pytest.approx(2.9219204e-4, rel=1e-7)
    assert fit.r_squared == pytest.approx(0.99904951, abs=5e-9)
    # R interpolates its profiles.
    assert (fit.asymptote.low, fit.asymptote.high) == pytest.approx(
        (0.1568033, 0.1721910), abs=2e-6
    )
    assert (fit.boundary.low, fit.boundary.high) == pytest.approx((0.8174599, 0.8642723), abs=1e-5)
    assert (fit.tau.low, fit.tau.high) == pytest.approx((0.1720379, 0.1966424), abs=1e-5)


def test_nist_misra_1a():
    x = [77.6, 114.9, 141.1, 190.8, 239.9, 289, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1]
    x.append(760)
    y = [10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.4, 75.47]
    y.append(81.78)
    fit = stribeck_fit(x, y, boundary=0.0)
    assert fit.raw[2] == pytest.approx(2.3894212918e2, rel=1e-6)
    assert 1 / fit.raw[1] == pytest.approx(5.5015643181e-4, rel=1e-6)
    assert fit.residual_sum == pytest.approx(1.2455138894e-1, rel=1e-8)


def test_nist_box_bod():
    fit = stribeck_fit([1, 2, 3, 5, 7, 10], [109, 149, 149, 191, 213, 224], boundary=0.0)
    assert fit.raw[2] == pytest.approx(2.1380940889e2, rel=1e-7)
    assert 1 / fit.raw[1] == pytest.approx(5.4723748542e-1, rel=1e-7)
    assert fit.residual_sum == pytest.approx(1.1680088766e3, rel=1e-10)


def test_water_is_not_identified():
    # Report G.2: water, tau 2.09 m/s beyond the largest speed of 1 m/s.
    rng = np.random.default_rng(2)
    fit = stribeck_fit(_SPEEDS, _eq17(0.69, 2.09, 0.001) + rng.normal(0, 0.02, 11))
    assert fit.tau.remark == NOT_IDENTIFIED
    assert fit.asymptote.remark == NOT_IDENTIFIED
    assert fit.asymptote.low is None
    assert fit.boundary.remark == ""
    assert fit.boundary.low < 0.69 < fit.boundary.high


def test_report_rule_for_poor_fits():
    # G.2: canola oil hardly varies with speed.
    rng = np.random.default_rng(3)
    cof = 0.10 + rng.normal(0, 0.02, 11)
    fit = stribeck_fit(_SPEEDS, cof)
    assert fit.r_squared < 0.5
    assert fit.verdict == "mean"
    assert fit.boundary.value == pytest.approx(cof.mean())
    assert fit.tau.value is None


def test_methods_agree_on_good_data_and_separable_is_never_worse():
    rng = np.random.default_rng(5)
    for boundary, tau, asymptote in (
        (0.839, 0.184, 0.164),
        (0.65, 0.5, 0.099),
        (0.47, 0.19, 0.111),
    ):
        cof = _eq17(boundary, tau, asymptote) + rng.normal(0, 0.02, 11)
        ours = stribeck_fit(_SPEEDS, cof)
        theirs = stribeck_fit(_SPEEDS, cof, method="nelder_mead")
        assert ours.residual_sum <= theirs.residual_sum * (1 + 1e-9)
        assert theirs.residual_sum == pytest.approx(ours.residual_sum, rel=1e-3)


def test_too_few_speeds_are_refused():
    with pytest.raises(DataError, match="3 different speeds"):
        stribeck_fit([0.1, 0.2, 0.3], [0.5, 0.4, 0.3])


@pytest.mark.parametrize(("start", "end"), [(1.0, -0.2), (-0.2, 1.0), (1.0, 0.3), (-0.3, -0.1)])
def test_levels_below_zero_are_the_best_of_those_that_are_not(start, end):
    x, tau = np.linspace(0, 4, 40), np.array([0.3, 1.0, 3.0])
    y = end + (start - end) * np.exp(-x)
    found = np.transpose(linear_part(x, y, tau, None, None))
    for (a, b, rest), constant in zip(found, tau, strict=True):
        fall = np.exp(-x / constant)
        right, norm = nnls(np.column_stack([1 - fall, fall]), y)
        assert (a, b) == pytest.approx(tuple(right), abs=1e-9)
        assert rest == pytest.approx(norm**2, abs=1e-9)
