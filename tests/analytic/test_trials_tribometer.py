"""Pin on disk, master curve, profile radius and relaxation test against made-up truth."""

import numpy as np
import pytest

from underfoot.core import DataError
from underfoot.trials import Channel, Trial
from underfoot.trials.machines.pin_on_disk import (
    correlated_error,
    friction_point,
    reduced_radius,
    steady_window,
)
from underfoot.trials.machines.relaxation_test import relaxation_reading
from underfoot.trials.machines.stribeck_fit import master_curve


def _run(cof, load=-20.9, rate=100.0, speed=0.3):
    n = len(cof)
    return Trial(
        "run.csv",
        channels={
            "Fz": Channel(np.full(n, load), "N", rate),
            "Fx": Channel(-load * cof, "N", rate),
            "speed": Channel(np.full(n, speed), "m/s", rate),
        },
    )


def test_run_in_is_cut():
    rng = np.random.default_rng(0)
    time = np.arange(1000) / 100.0
    cof = 0.4 + 0.3 * np.exp(-time / 0.5) + rng.normal(0, 0.01, 1000)
    point = friction_point(_run(cof))
    assert point.window[0] == pytest.approx(2.0, abs=1.0)
    assert point.cof.value == pytest.approx(0.4, abs=0.004)
    assert point.speed == pytest.approx(0.3)
    assert point.normal == pytest.approx(20.9)
    assert not point.cof.flags
    given = friction_point(_run(cof), window=(5.0, 8.0))
    assert given.cof.n == 300
    assert given.cof.conventions["window"].startswith("5 to 8 s")


def test_a_run_that_never_settles_is_flagged():
    cof = np.linspace(0.8, 0.2, 1000) + np.random.default_rng(1).normal(0, 0.01, 1000)
    assert any("not steady" in flag.message for flag in friction_point(_run(cof)).cof.flags)


def test_lifted_pin_is_left_out():
    trial = _run(np.full(500, 0.5))
    trial.channels["Fz"].values[200:220] = 0.0
    point = friction_point(trial)
    assert point.cof.value == pytest.approx(0.5)
    assert any("20 samples" in flag.message for flag in point.cof.flags)


@pytest.mark.parametrize(
    ("factor", "told"), [(1.0, False), (1.05, False), (1.3, True), (9.8, True)]
)
def test_a_cof_in_the_log_that_its_forces_contradict_is_told(factor, told):
    """A load in kilograms under a heading in newtons made 0.05 of 0.5, beside a COF of 0.5."""
    trial = _run(0.5 + np.random.default_rng(3).normal(0, 0.01, 1000))
    own = factor * np.abs(trial.channels["Fx"].values / trial.channels["Fz"].values)
    trial.channels["COF"] = Channel(own, "1", 100.0)
    flags = [flag.message for flag in friction_point(trial).cof.flags]
    assert any("the log's own COF" in message for message in flags) == told


def test_correlated_noise_widens_the_error():
    rng = np.random.default_rng(2)
    phi, n, repeats = 0.95, 4000, 300
    x = np.zeros((repeats, n))
    steps = rng.normal(0, 1, (repeats, n))
    for i in range(1, n):
        x[:, i] = phi * x[:, i - 1] + steps[:, i]
    truth = x.mean(axis=1).std(ddof=1)
    errors = [correlated_error(row) for row in x]
    assert np.sqrt(np.mean(np.square(errors))) == pytest.approx(truth, rel=0.15)


def test_steady_window_needs_samples():
    with pytest.raises(DataError, match="50 or more"):
        steady_window(np.ones(20))


def test_reduced_radius():
    # Report G.2: R' 23.3 mm for a pin of 10 mm (errata: printed in micrometres).
    x = np.linspace(-4e-3, 4e-3, 400)
    rng = np.random.default_rng(3)
    noise = rng.normal(0, 2e-6, 400)
    found = reduced_radius(x, -(x**2) / (2 * 23.3e-3) + 0.01 * x + 1e-3 + noise)
    assert found.radius == pytest.approx(23.3e-3, abs=4 * found.standard_error)
    assert found.standard_error < 1e-4
    with pytest.raises(DataError, match="no curvature"):
        reduced_radius(x, rng.normal(0, 2e-6, 400))


@pytest.mark.parametrize("ratio", [-3.0, -2.1, -1.9, 0.5, 1.9, 2.1, 3.0])
def test_a_pin_is_round_where_its_curvature_is_two_of_its_errors(ratio):
    """Of places 2 mm apart and a scatter that is no parabola: error of B by the least squares."""
    x = 2e-3 * np.arange(12.0)
    known = np.vander((x - x.mean()) / 1e-3, 3)
    scatter = 1e-6 * np.cos(np.pi * np.arange(12))
    scatter -= known @ np.linalg.lstsq(known, scatter, rcond=None)[0]
    error = np.sqrt(scatter @ scatter / 9 * np.linalg.inv(known.T @ known)[0, 0]) * 1e6
    height = ratio * error * x**2 - 0.02 * x + 1e-3 + scatter
    if abs(ratio) < 2:
        with pytest.raises(DataError, match="no curvature"):
            reduced_radius(x, height)
        return
    told = reduced_radius(x, height)
    assert told.curvature == pytest.approx(abs(ratio) * error)
    assert told.radius == pytest.approx(1 / (2 * abs(ratio) * error))
    assert told.standard_error == pytest.approx(told.radius / abs(ratio))
    assert told.residual_rms == pytest.approx(scatter.std())


@pytest.mark.parametrize("method", ["isotonic", "spline"])
def test_master_curve_is_recovered(method):
    rng = np.random.default_rng(4)
    viscosity = np.repeat([0.52e-3, 1.9e-3, 5.54e-3, 41e-3, 74.6e-3], 11)
    speed = np.tile([0.05, *np.arange(0.1, 1.01, 0.1)], 5)

    def truth(product):
        return 0.1 + 0.6 / (1 + product / 1e-3)

    cof = truth(viscosity * speed) + rng.normal(0, 0.02, 55)
    curve = master_curve(viscosity, speed, cof, method=method)
    assert curve.residual_sd == pytest.approx(0.02, rel=0.35)
    assert curve.r_squared > 0.97
    grid = np.geomspace(1e-4, 3e-2, 20)
    assert np.abs(curve(grid) - truth(grid)).max() < 0.05
    # The order of the points does not matter.
    order = rng.permutation(55)
    again = master_curve(viscosity[order], speed[order], cof[order], method=method)
    assert again.fitted == pytest.approx(curve.fitted, abs=1e-12)


def _relaxation(sign=1.0, offset=0.0):
    thickness, rate = 5.5e-3, 100.0
    time = np.arange(0, 260, 1 / rate)
    ramp = np.clip((time - 2.0) / 0.5, 0, 1) * 0.2 * thickness
    travel = np.where(time > 252.0, 0.2 * thickness * np.clip(1 - (time - 252), 0, 1), ramp)
    stiffness = 600.0 / (0.2 * thickness)
    relaxed = np.where(time > 2.5, 0.7 + 0.3 * np.exp(-(time - 2.5) / 40.0), 1.0)
    force = stiffness * travel * relaxed + np.random.default_rng(5).normal(0, 0.3, len(time))
    return thickness, Trial(
        "relax.csv",
        channels={
            "Force": Channel(sign * force + offset, "N", rate),
            "Displacement": Channel(sign * travel + 3e-3, "m", rate),
        },
    )


@pytest.mark.parametrize(("sign", "offset"), [(1.0, 0.0), (-1.0, 4.0)])
def test_relaxation_test_is_read(sign, offset):
    thickness, trial = _relaxation(sign, offset)
    found = relaxation_reading(trial, thickness)
    assert found.peak_force.value == pytest.approx(600.0, abs=2.0)
    assert found.force_2_percent.value == pytest.approx(60.0, abs=8.0)
    final = 600 * (0.7 + 0.3 * np.exp(-237.0 / 40.0))
    assert found.final_force.value == pytest.approx(final, abs=1.0)
    assert found.hold_time == pytest.approx(249.5, abs=0.3)
    assert found.ramp_time == pytest.approx(0.5, abs=0.05)
    assert found.peak_displacement == pytest.approx(0.2 * thickness, rel=0.02)
    assert any("unloading cut off" in note for note in found.notes)
    assert found.peak_force.uncertainty == pytest.approx(0.3, rel=0.2)


def test_relaxation_without_a_hold_is_refused():
    thickness, trial = _relaxation()
    cut = {
        name: Channel(channel.values[:252], channel.unit, channel.rate)
        for name, channel in trial.channels.items()
    }
    with pytest.raises(DataError, match="samples of hold"):
        relaxation_reading(Trial("cut", channels=cut), thickness)
