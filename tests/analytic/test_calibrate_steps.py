"""Steps of calibrations on made-up worlds: what a fit says of itself, which end is which."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.calibrate import Parameter, calibrate_model, pair_readings
from underfoot.calibrate.compound import _beside, _fit_warnings, relaxation_of
from underfoot.calibrate.law_file import TrialReadings, law_table
from underfoot.calibrate.pair_readings import (
    PairCalibration,
    PairReading,
    calibrated_pair,
    read_pair_readings,
)
from underfoot.calibrate.stribeck_curve import StribeckCurve
from underfoot.calibrate.trial_laws import stribeck_law_from_fit
from underfoot.case import load
from underfoot.core import DataError, InputError, SourcedValue
from underfoot.friction import packaged_pair_draws
from underfoot.trials.machines.stribeck_fit import stribeck_fit

EXAMPLES = Path(__file__).parents[2] / "examples"
TRUTH = 0.4, 0.3, 0.1
"""Boundary COF, speed (m/s) over which it falls by e, and what is left: Eq. 17."""


def eq_17(speed):
    boundary, tau, left = TRUTH
    return left + (boundary - left) * np.exp(-speed / tau)


def test_the_spread_of_a_fit_is_what_each_reading_moves_it_by():
    """Of independent readings of one variance s^2 the fit has s^2 sum (d fit / d reading)^2."""
    speed = np.geomspace(0.03, 1.5, 9)
    cof = eq_17(speed) + np.random.default_rng(7).normal(0, 2e-3, speed.size)

    def fitted(readings):
        return law_table(TrialReadings(speed, readings, None, 0, "made up"))

    table, step = fitted(cof), 1e-4
    moved = [(fitted(cof + step * one).cof - table.cof) / step for one in np.eye(speed.size)]
    scatter = table.deviation**2 / (1 + np.sum(np.square(moved), axis=0))
    np.testing.assert_allclose(scatter, scatter.mean(), rtol=0.01)
    missed = cof - np.interp(np.log(speed), np.log(table.speed), table.cof)
    assert scatter.mean() == pytest.approx(
        np.sum(missed**2) / (speed.size - 3), rel=0.25
    )  # between speeds by lines


def test_a_parameter_that_comes_out_as_nothing_is_nothing():
    x = np.linspace(0, 1, 9)
    for start in (0.5, 0.0):
        found = calibrate_model(lambda v: v["a"] * x, 0.0 * x, {"a": Parameter(start, -1.0, 1.0)})
        assert found.values == pytest.approx({"a": 0.0}, abs=1e-9)


@pytest.mark.parametrize(
    ("kinds", "cofs", "excluded"),
    [
        (("lower", "upper"), (0.3, 0.2), True),
        (("upper", "lower"), (0.2, 0.3), True),
        (("lower", "upper"), (0.2, 0.3), False),
        (("value", "value"), (0.3, 0.2), False),
        (("lower", "lower"), (0.3, 0.2), False),
    ],
)
def test_only_a_lower_bound_above_an_upper_one_excludes_it(kinds, cofs, excluded):
    case = load(EXAMPLES / "work_shoe_untreaded_glycerol.toml").replace(
        {"friction.model": "constant", "friction.cof": 0.2}
    )
    readings = [PairReading(case, cof, kind=kind) for kind, cof in zip(kinds, cofs, strict=True)]
    with pytest.raises(InputError, match="exclude" if excluded else "the law of"):
        calibrated_pair(readings)


def test_the_factor_of_an_interval_is_the_root_of_its_ends():
    rows = np.array([[0.1, 0.2, 0.4], [0.2, 0.21, 0.22]])
    reading = PairReading(cast(Any, SimpleNamespace(name="a case")), 0.21)
    told = PairCalibration(
        (reading, reading),
        cast(Any, None),
        rows,
        np.sqrt(rows),
        (("the laboratory", 0.2, 0.1),),
        100.0,
    ).headline()[0]
    assert "a factor of 2 to one of 1.4 either way" in told


def test_the_ends_of_a_band_stand_in_the_rows_of_a_curve():
    speed = np.array([0.1, 1.0])
    ends = np.array([0.1, 0.2]), np.array([0.3, 0.4])
    more = {"adhesion_left": np.array([1.0, 0.0]), "regimes": None, "points": None}
    parts = {"adhesion": np.array([0.1, 0.1]), "hysteresis": np.array([0.1, 0.2])}

    def rows(interval):
        return StribeckCurve(
            label="water", law="made up", viscosity=1e-3, speed=speed, parts=parts,
            interval=interval, deviation=None, pair="", notes=(), **more,
        ).rows()  # fmt: skip

    assert [(row["cof_low_95"], row["cof_high_95"]) for row in rows(ends)] == [
        (0.1, 0.3), (0.2, 0.4),
    ]  # fmt: skip
    assert [row["cof_low_95"] for row in rows(None)] == [None, None]
    assert [row["cof"] for row in rows(None)] == pytest.approx([0.2, 0.3])
    assert rows(None)[0]["adhesion_state"] == "boundary"


def hold_of(force):
    """Return a compression test whose force (N) over the hold is known; its modulus is 6 MPa."""
    time = np.arange(1, 4001) * 0.01
    reading = SimpleNamespace(
        hold=(time, force(time)),
        force_2_percent=SourcedValue(10.0),
        peak_force=SourcedValue(70.0),
    )
    moduli = SimpleNamespace(short_time_modulus=6e6)
    return cast(Any, SimpleNamespace(reading=reading, moduli=moduli, factor=1.5, name="made up"))


def test_a_modulus_of_a_hold_is_the_mean_about_its_time():
    """From 2 % to the peak 60 N are 6 MPa / 1.5; a force linear in time keeps its line."""
    steady = relaxation_of(hold_of(lambda t: np.full(t.size, 40.0)))
    np.testing.assert_allclose(steady.modulus, 6e6 * 30 / 60 / 1.5)
    falling = relaxation_of(hold_of(lambda t: 70.0 - t))
    # a window reaches half-way to its neighbours: it leans to the longer side, by less than that
    exact = 6e6 * (60.0 - falling.time) / 60 / 1.5
    gap = np.gradient(falling.time)
    assert np.all(np.abs(falling.modulus - exact) <= 6e6 / 60 / 1.5 * 0.5 * gap + 1.0)
    assert np.all(np.diff(falling.modulus) < 0)
    # where every reading is kept the mean is of that one alone
    close = gap < 0.0101
    assert np.count_nonzero(close) > 5
    np.testing.assert_allclose(falling.modulus[close][:-1], exact[close][:-1], rtol=1e-9)


def fit_to(fastest, quality="good", slowest=1.0):
    return cast(
        Any,
        SimpleNamespace(
            quality=quality, frequency_range=(slowest, fastest), rms_residual=0.1,
            largest_residual=0.2,
            spectrum=SimpleNamespace(relaxation_modulus=lambda time: 2e6),
        ),
    )  # fmt: skip


def test_only_rates_that_asperities_reach_and_no_test_did_are_warned_of():
    assert _fit_warnings(fit_to(1e9)) == []
    (told,) = _fit_warnings(fit_to(2 * np.pi * 100))
    assert told.startswith("Tested up to 100 Hz;")
    assert len(_fit_warnings(fit_to(1e9, "rough"))) == 1


def test_a_sweep_and_a_hold_are_compared_where_both_were_read():
    sweep = fit_to(1e3, slowest=1.0)  # 1 ms to 1 s
    assert "share no time" in _beside(sweep, fit_to(0.1, slowest=0.01))  # 10 s to 100 s
    assert "share no time" not in _beside(sweep, fit_to(10.0, slowest=0.01))  # 0.1 s to 100 s


def test_the_share_of_adhesion_has_a_name_from_nine_tenths_and_from_one_tenth():
    shares = np.array([1.0, 0.9, 0.89, 0.1, 0.09, 0.0])
    curve = StribeckCurve(
        label="water", law="made up", viscosity=1e-3, speed=shares, parts={}, interval=None,
        deviation=None, adhesion_left=shares, regimes=None, points=None, pair="", notes=(),
    )  # fmt: skip
    assert curve.states == ("boundary",) * 2 + ("part blocked",) * 2 + ("blocked",) * 2


def test_errors_that_readings_made_smaller_are_named_the_most_first():
    rows = np.array([[0.1, 0.2, 0.4]])
    reading = PairReading(cast(Any, SimpleNamespace(name="a case")), 0.21)

    def taken(*errors):
        made = PairCalibration((reading,), cast(Any, None), rows, rows, errors, 100.0)
        assert all(name in made.headline()[1] for name, *_ in made._smaller_errors())
        return [name for name, *_ in made._smaller_errors()]

    little, much, none = ("little", 0.3, 0.28), ("much", 0.3, 0.2), ("none", 0.5, 0.49)
    assert taken(little, much, none) == ["much", "little"]
    assert taken(much, little, none) == ["much", "little"]
    assert taken(("wide", 0.5, 0.4), ("narrow", 0.2, 0.05), none) == ["wide", "narrow"]
    assert taken(none, ("less", 0.2, 0.199)) == ["none"]  # the most where none is a 20th smaller


@pytest.mark.parametrize(
    ("lines", "wrong"),
    [
        ("cof = 0.24", ""),
        ('cof = 0.24\nsd = 0.02\nkind = "lower"', ""),
        ("sd = 0.02", "cof"),
        ("cof = 0.0", "cof"),
        ("cof = true", "cof"),
        ('cof = 0.24\nsd = "0.02"', "sd"),
        ('cof = 0.24\nkind = "low"', "kind"),
        ("cof = 0.24\nsds = 0.02", "sds"),
    ],
)
def test_a_reading_needs_its_cof_and_may_have_its_scatter(tmp_path, lines, wrong):
    case = EXAMPLES / "work_shoe_untreaded_glycerol.toml"
    path = tmp_path / "readings.toml"
    path.write_text(f'[[reading]]\ncase = "{case.as_posix()}"\n{lines}\n')
    if wrong:
        with pytest.raises(InputError, match=wrong):
            read_pair_readings(path)
        return
    (reading,) = read_pair_readings(path)
    more = "lower" in lines
    assert (reading.cof, reading.sd, reading.kind) == (
        (0.24, 0.02, "lower") if more else (0.24, None, "value")
    )


def test_each_reading_takes_its_part_of_the_work_one_after_the_other(monkeypatch):
    case = load(EXAMPLES / "work_shoe_untreaded_glycerol.toml").replace("friction.model", "pair")
    every, told = packaged_pair_draws(), []

    def whole_cof(case, law, quick, progress):
        for fraction in (0.0, 1.0):
            progress("solving", fraction)
        return np.full(law.draws.count, 0.24)

    monkeypatch.setattr(pair_readings, "_whole_cof", whole_cof)
    calibrated_pair(
        [PairReading(case, cof) for cof in (0.23, 0.25)],
        draws=every.rows(np.arange(0, every.count, 40)),
        progress=cast(Any, lambda stage, fraction, *_: told.append(fraction)),
    )
    assert told == pytest.approx([0.0, 0.5, 0.5, 1.0])


def test_a_friction_that_rises_with_speed_is_no_fit_of_eq_17():
    """A straight rise is fitted with an asymptote of hundreds: R^2 is 1, and it means nothing."""
    speed = np.repeat(np.geomspace(0.05, 0.8, 6), 2)
    readings = TrialReadings(speed, 0.1 + 0.2 * speed, None, 0, "made up")
    with pytest.raises(DataError, match="COF does not fall with speed"):
        law_table(readings)
    with pytest.raises(InputError, match="stribeck_fit, soap: COF does not fall with speed"):
        stribeck_law_from_fit(stribeck_fit(speed, readings.cof), source="made up", fluid="soap")
