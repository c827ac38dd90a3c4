"""Least squares of closures: closed forms, what is not identified, limits, made-up truth."""

import numpy as np
import pytest

from underfoot.calibrate import Parameter, calibrate_model
from underfoot.core import DataError, InputError

X = np.linspace(0.0, 1.0, 12)
LINE = {"start": Parameter(0.5, -10.0, 10.0), "slope": Parameter(0.5, -10.0, 10.0)}


def test_a_straight_line_is_that_of_the_normal_equations():
    data = 0.3 - 1.7 * X + np.random.default_rng(5).normal(0, 0.05, X.size)
    found = calibrate_model(lambda v: v["start"] + v["slope"] * X, data, LINE)
    design = np.column_stack([np.ones_like(X), X])
    best, rss, *_ = np.linalg.lstsq(design, data)
    covariance = np.linalg.inv(design.T @ design) * rss[0] / (X.size - 2)
    assert [found.values[k] for k in LINE] == pytest.approx(best, abs=1e-7)
    spread = [found.parameters[k].uncertainty for k in LINE]
    assert spread == pytest.approx(np.sqrt(np.diag(covariance)), rel=1e-5)
    assert found.deviation == pytest.approx(np.sqrt(rss[0] / (X.size - 2)))


def test_known_deviations_set_the_spread():
    data = 0.3 - 1.7 * X
    found = calibrate_model(lambda v: v["start"] + v["slope"] * X, data, LINE, deviation=0.1)
    design = np.column_stack([np.ones_like(X), X]) / 0.1
    expected = np.sqrt(np.diag(np.linalg.inv(design.T @ design)))
    assert [found.parameters[k].uncertainty for k in LINE] == pytest.approx(expected, rel=1e-5)
    assert found.mean_absolute_error < 1e-9


def test_a_scale_over_decades_is_recovered():
    truth = {"height": 0.4, "scale": 3e-9}
    x = np.geomspace(1e-10, 1e-7, 20)

    def model(v):
        return v["height"] * np.exp(-x / v["scale"])

    unknown = {
        "height": Parameter(1.0, 0.0, 3.0),
        "scale": Parameter(1e-6, 1e-12, 1e-3, "m", logarithmic=True),
    }
    found = calibrate_model(model, model(truth), unknown, deviation=0.01)
    assert found.values == pytest.approx(truth, rel=1e-5)
    assert found.parameters["scale"].uncertainty is not None


def test_what_the_data_do_not_hold_has_no_uncertainty():
    unknown = {"a": Parameter(0.5, -9.0, 9.0), "b": Parameter(0.5, -9.0, 9.0)}
    found = calibrate_model(lambda v: (v["a"] + v["b"]) * np.ones(5), np.ones(5), unknown)
    assert found.parameters["a"].uncertainty is None
    assert found.parameters["a"].reason == "not identified"
    bound = calibrate_model(lambda v: v["a"] * np.ones(5), 20 * np.ones(5), {"a": unknown["a"]})
    assert bound.at_bound == ("a",)
    assert "limit" in bound.parameters["a"].reason


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("which", [[0], [5], range(12)])
def test_data_of_which_any_is_not_finite_are_refused(bad, which):
    data = np.array(X)
    data[list(which)] = bad
    with pytest.raises(DataError, match="finite"):
        calibrate_model(lambda v: v["start"] + v["slope"] * X, data, LINE)


def test_bad_input():
    with pytest.raises(DataError, match="at least as many"):
        calibrate_model(lambda v: np.ones(1), [1.0], LINE)
    with pytest.raises(InputError, match="within"):
        Parameter(2.0, 0.0, 1.0)
    with pytest.raises(InputError, match="above 0"):
        Parameter(0.5, 0.0, 1.0, logarithmic=True)
