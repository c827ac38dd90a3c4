"""Parts of a calibration at both sides of their limits: rises, times, spans, weights, searches."""

import dataclasses
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from snapshot import held, refusal, tried
from underfoot.calibrate import Parameter, calibrate_model, compound, law_file, pair_readings
from underfoot.calibrate.compound import (
    Compound,
    _beside,
    _fit_warnings,
    _reference,
    _refuse_rising,
)
from underfoot.calibrate.law_file import LawTable, TrialReadings, law_file_text, law_table
from underfoot.calibrate.least_squares import _covariance, _Scale
from underfoot.calibrate.pair_readings import PairCalibration, PairReading
from underfoot.calibrate.pin_regimes import _spans, pin_regimes
from underfoot.calibrate.stribeck_curve import ADHESION_STATES, StribeckCurve, _gap
from underfoot.calibrate.stribeck_points import fluid_points
from underfoot.core import SourcedValue
from underfoot.core.catalogue import Catalogue
from underfoot.friction.measured import BoundaryFriction
from underfoot.material import RelaxationCurve, RelaxationSpectrum

ROOM = compound.ROOM


def spectrum(rest=1e6, terms=2e6):
    return RelaxationSpectrum(rest, np.array([terms, terms]), np.array([1e-2, 1.0]))


def fit_of(low, high, quality="good", **more) -> Any:
    given = {"spectrum": spectrum(), "rms_residual": 0.012, "largest_residual": 0.05} | more
    return SimpleNamespace(frequency_range=(low, high), quality=quality, **given)


def test_tests_of_one_compound_beside_each_other(file_regression):
    soft = spectrum(5e5, 1e6)
    ranges = {
        "hold longer": ((1.0, 100.0), (1e-2, 10.0)), "hold shorter": ((1e-2, 100.0), (0.1, 10.0)),
        "hold quicker": ((1.0, 10.0), (0.5, 1e3)), "apart": ((10.0, 100.0), (0.1, 5.0)),
        "touching": ((10.0, 100.0), (1.0, 10.0)),
    }  # fmt: skip
    told: dict[str, Any] = {
        name: _beside(fit_of(*sweep), fit_of(*hold, spectrum=soft))
        for name, (sweep, hold) in ranges.items()
    }
    told["references"] = [
        _reference(tested, used)
        for tested, used in (
            ([ROOM - 5, ROOM + 5], None), ([ROOM + 1, ROOM + 5], None), ([ROOM - 9, ROOM], None),
            ([ROOM, ROOM + 9], None), ([None, None], None), ([ROOM - 5, None, ROOM + 5], 300.0),
        )
    ]  # fmt: skip
    fast = 2 * np.pi * compound.SLIDING_SPEED / compound.SLIDING_WAVES[1]
    told["fits"] = [
        _fit_warnings(fit_of(1.0, high, quality))
        for quality, high in (("good", fast), ("good", 0.99 * fast), ("rough", fast),
                              ("bad", fast))
    ]  # fmt: skip
    curves = {
        "falls": [4e6, 3e6, 2e6, 1e6], "just": [3e6, 2e6, 1e6, 1.049e6],
        "rises": [3e6, 2e6, 1e6, 1.06e6],
        "twice": [2e6, 1e6, 1.2e6, 1.0e6, 1.3e6],
    }  # fmt: skip
    for name, values in curves.items():
        curve = RelaxationCurve(np.geomspace(1, 100, len(values)), np.array(values), source=name)
        told[name] = tried(_refuse_rising, curve)
    held(file_regression, told)


def test_a_compound_by_hand(file_regression):
    plain = Compound("rubber", spectrum(), None, None, None, None, (), None, None, 0.49, None,
                     (), ())  # fmt: skip
    told: dict[str, Any] = {}
    ranges = {"never": None, "slow": (1e-3, 1.0), "fast": (50.0, 1e4), "around": (1.0, 1e3),
              "wide": (1e-12, 1e12)}  # fmt: skip
    for key, tested in ranges.items():
        fit = None if tested is None else fit_of(*tested, band=lambda w: None)
        one = dataclasses.replace(plain, fit=cast(Any, fit))
        told[key] = one._time, one.modulus(), one.tested, one.headline()
        told[f"{key} toml"] = [line for line in one.toml().splitlines() if "tested" in line]
        losses = one._losses().rows
        told[f"{key} losses"] = len(losses), losses[0], losses[-1]
    slow = RelaxationSpectrum(
        1e6, np.array([2e6, 1e6, 5e5, 3e5]), np.array([5e-10, 1e-3, 1.0, 2e6])
    )
    told["steps"] = dataclasses.replace(plain, spectrum=slow, polymer="SBR").toml()
    tiny = RelaxationSpectrum(1e6, np.array([2e6, 2e-1, 1.0]), np.array([1e-3, 1e-2, 1.0]))
    told["tiny"] = dataclasses.replace(plain, spectrum=tiny)._terms().rows
    many = RelaxationSpectrum(1e6, np.full(33, 1e5), np.geomspace(1e-3, 1e3, 33))
    most = RelaxationSpectrum(1e6, np.full(32, 1e5), np.geomspace(1e-3, 1e3, 32))
    told["many"] = [len(dataclasses.replace(plain, spectrum=one).tables()) for one in (many, most)]
    bare = dataclasses.replace(plain, spectrum=None)
    told["none"] = bare.modulus(), sorted(bare.data_tables()), repr(bare), bare.to_dict()
    held(file_regression, told)


def readings(speed, cof, **more):
    given = {"viscosity": 0.01, "left_out": 0, "origin": "here"} | more
    return TrialReadings(np.array(speed, float), np.array(cof, float), **cast(Any, given))


def test_laws_of_few_readings(file_regression):
    speed = np.repeat([0.1, 0.2, 0.4, 0.8], 2)
    cof = 0.1 + 0.3 * np.exp(-speed / 0.2) + 0.004 * np.cos(5 * np.arange(8))
    many = np.repeat([0.1, 0.2], [law_file.ENOUGH, 2])
    scattered = 0.3 + 0.01 * np.cos(3 * np.arange(many.size))
    told: dict[str, Any] = {
        "fit": law_table(readings(speed, cof, left_out=2)),
        "means": law_table(readings(speed, cof), form="readings"),
        "enough": law_table(readings(many, scattered), form="readings").deviation,
        "few": law_table(readings(many[1:], scattered[1:]), form="readings").deviation,
        "once": refusal(law_table, readings([0.1, 0.2], [0.3, 0.2]), form="readings"),
        "none": refusal(law_table, readings(speed, 0.3 + 0.05 * (-1.0) ** np.arange(8))),
        "form": refusal(law_table, readings(speed, cof), form="lines"),
    }
    table = LawTable(np.array([0.1, 1.0]), np.array([0.3, 0.2]), np.array([0.01, 0.02]), None,
                     "s", ("n",))  # fmt: skip
    told["text"] = law_file_text(table)
    told["text of a pressure"] = law_file_text(
        dataclasses.replace(table, viscosity=0.2), pressure=2e5
    )
    held(file_regression, told)


def test_searches(file_regression):
    x = np.linspace(0.1, 1.0, 8)
    noise = 0.01 * np.cos(9 * np.arange(8))
    told: dict[str, Any] = {
        "scales": [
            [one.start, one.low, one.high, one.step, one.value(0.5), one.slope(0.5)]
            for one in (_Scale(Parameter(2.0, 1.0, 5.0)), _Scale(Parameter(0.0, -3.0, 5.0)),
                        _Scale(Parameter(2.0, 1.0, 5.0, "Pa", True)))
        ],
        "covariance": [
            _covariance(np.array([[1.0, 0.2], [0.3, 2.0], [0.5, 0.1]]), fixed)
            for fixed in ([False, False], [True, False], [True, True])
        ],
        "no effect": _covariance(np.array([[1.0, 0.0], [2.0, 0.0]]), [False, False]),
        "alike": _covariance(np.array([[1.0, 2.0], [2.0, 4.0]]), [False, False]),
    }  # fmt: skip
    free = {"a": Parameter(1.0, 1e-3, 10.0, "Pa", True), "b": Parameter(0.1, -5.0, 5.0)}

    def model(values):
        return values["a"] * np.exp(values["b"] * x)

    told["logarithm"] = calibrate_model(model, 2 * np.exp(0.5 * x) + noise, free, source="here")
    told["stated"] = calibrate_model(
        model, 2 * np.exp(0.5 * x) + noise, free, deviation=np.full(8, 0.02)
    )
    held(file_regression, told)


def test_curves_and_spans(file_regression):
    speed = np.array([0.1, 0.2, 0.4, 0.8])
    left = np.array([0.95, 0.9, 0.1, 0.0999])
    parts = {"adhesion": 0.2 * left, "hysteresis": np.full(4, 0.05)}
    points = speed[1:3], np.array([0.3, 0.2])
    curve = StribeckCurve("a fluid", "pair", 0.01, speed, parts, (left / 2, left * 2), left / 9,
                          left, None, points, "pin", ("n",))  # fmt: skip
    bare = dataclasses.replace(curve, interval=None, deviation=None, points=None)
    kinds = (["a"] * 4, ["a", "b", "b", "b"], ["a", "b", "b", "a"], ["a", "a", "a", "b"])
    told = {
        "states": curve.states, "rows": curve.rows(), "bare": bare.rows()[0],
        "dict": {k: v for k, v in curve.to_dict().items() if k != "rows"},
        "names": ADHESION_STATES, "spans": [_spans(speed, names) for names in kinds],
    }  # fmt: skip
    held(file_regression, told)


def test_readings_of_a_pair_by_hand(file_regression):
    def reading(cof, kind="value"):
        return PairReading(cast(Any, SimpleNamespace(name=f"case {cof}")), cof, 0.02, kind)

    def calibrated(given, after, errors, **more):
        before = np.array([[0.1, 0.2, 0.4]] * len(given))
        return PairCalibration(tuple(given), cast(Any, None), before, np.array(after), errors, 90.0,
                               **more)  # fmt: skip

    some = (("the laboratory", 0.4, 0.2), ("the pair", 0.3, 0.29), ("the tread", 0.2, 0.1))
    none = (("the laboratory", 0.4, 0.39), ("the pair", 0.3, 0.3))
    kinds = {
        "within": calibrated([reading(0.2)], [[0.15, 0.2, 0.3]], some),
        "nothing smaller": calibrated([reading(0.2)], [[0.1, 0.2, 0.4]], none),
        "above": calibrated([reading(0.5)], [[0.15, 0.2, 0.3]], some),
        "below": calibrated([reading(0.1)], [[0.15, 0.2, 0.3]], some),
        "bounds": calibrated(
            [reading(0.5, "upper"), reading(0.1, "lower"), reading(0.1, "upper"),
             reading(0.5, "lower")], [[0.15, 0.2, 0.3]] * 4, some, not_begun=("a",)),
    }  # fmt: skip
    told: dict[str, Any] = {
        name: [one.heading(), one.headline(), one.cautions(), one.tables()]
        for name, one in kinds.items()
    }
    told["limits"] = pair_readings.REPEATS, pair_readings.COUNT, pair_readings.FEWEST
    held(file_regression, told)


def test_the_gap_that_carries_a_pressure(monkeypatch):
    """A linear interface has it exactly; beyond both ends it is the end."""
    context = SimpleNamespace(rq_value=1e-6)
    monkeypatch.setattr("underfoot.compute.resolve.resolve_context", lambda case: context)

    def gap(pressure, least=0.0):
        interface = SimpleNamespace(pressure=lambda at: least + max(2e6 - 2e11 * at, 0.0))
        rough = SimpleNamespace(build=lambda context: interface)
        return _gap(cast(Any, SimpleNamespace(rough_contact=rough)), pressure)

    assert gap(1e6) == pytest.approx(5e-6)
    assert gap(2e6 - 0.5) == pytest.approx(2.5e-12, abs=1e-12)
    assert (gap(2e6), gap(3e6)) == (0.0, 0.0)
    assert [gap(1.0, least=each) for each in (1.0, 2.0)] == pytest.approx([20e-6] * 2)


def test_points_of_a_fluid_without_a_whole_fit_are_its_mean():
    number = SourcedValue(0.2, "1", "a table")
    speed = np.array([0.1, 1.0])
    for tau, left in ((None, number), (number, None), (None, None)):
        one = BoundaryFriction("oil", "pin on tile", 0.1, number, tau, left)
        points = fluid_points(one, rq=1e-6, speed=speed)
        assert (points.curve, points.cof.tolist()) == ("mean", [0.2, 0.2])
    whole = BoundaryFriction("oil", "pin on tile", 0.1, number, SourcedValue(0.5, "m/s", "a table"),
                             SourcedValue(0.1, "1", "a table"))  # fmt: skip
    points = fluid_points(whole, rq=1e-6, speed=speed)
    assert points.curve == "fit"
    assert points.cof == pytest.approx(0.1 + 0.1 * np.exp(-speed / 0.5))


def test_a_pin_meets_a_pair_of_which_one_roughness_is_known(monkeypatch):
    """Only where neither surface has a stylus' Rq there is nothing to say."""
    known, unknown = (SimpleNamespace(rq_or_estimate=rq) for rq in (2e-6, None))
    monkeypatch.setattr("underfoot.compute.resolve.resolve_context", lambda case: 1 / 0)
    case: Any = SimpleNamespace(catalogue=Catalogue.load())
    for sole, floor in ((known, unknown), (unknown, known)):
        case.shoe, case.floor = SimpleNamespace(roughness=sole), SimpleNamespace(roughness=floor)
        with pytest.raises(ZeroDivisionError):  # it goes on
            pin_regimes(case, 0.1, np.array([0.3]), 2e5)
    case.shoe.roughness = case.floor.roughness = unknown
    assert pin_regimes(case, 0.1, np.array([0.3]), 2e5) is None
