"""Numerical errors, draws over places, and what is said of numbers: by hand on small worlds."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from underfoot.case import load
from underfoot.compute import numbers, numerical_error, positions, summary
from underfoot.compute.numerical_error import NumericalErrors, _wider, errors_by_steps
from underfoot.compute.position_draws import (
    ANGLE_DEVIATION,
    ShoeAngles,
    TreadPlace,
    TreadPositions,
    UncertainBevel,
    log_film_odds,
)
from underfoot.compute.stated_spreads import odds_changes, sum_of_draws
from underfoot.core import Breach, SourcedValue, Status, ValidityRange
from underfoot.core.remark import Message, Remark
from underfoot.friction import SampledCof
from underfoot.shoe.lug_drainage import SIDES

CASE = load(Path(__file__).parents[2] / "examples" / "work_shoe_full_tread_glycerol.toml")


def fake(**parts) -> Any:
    return SimpleNamespace(**parts)


def scalar(value, unit="1", **more):
    return SourcedValue(value, unit, source="made up", reason="none", **more)


# numerical errors


def test_errors_of_grid_and_steps_join_and_widen_what_is_not_of_the_friction():
    errors = NumericalErrors({"cof": 0.03, "fluid_load": 30.0}, {"fluid_load": 40.0}, Message("x"))
    assert errors.deviation("fluid_load") == pytest.approx(50)
    assert errors.deviation("cof") == pytest.approx(0.03)
    values = {
        "cof": scalar(0.3, uncertainty=0.04, interval=(0.2, 0.4)),
        "fluid_load": scalar(100.0, "N", uncertainty=120.0, interval=(50.0, 200.0), note="of it"),
        "normal_force": scalar(500.0, "N"),
    }
    found = errors.widen_numbers(values)
    assert (found["cof"].uncertainty, found["cof"].interval) == (0.04, (0.2, 0.4))
    assert found["cof"].numerical == pytest.approx(0.03)
    film = found["fluid_load"]
    assert (film.uncertainty, film.numerical) == pytest.approx((130, 50))
    assert film.interval == pytest.approx(_wider(100.0, (50.0, 200.0), 50.0, 500.0))
    assert str(film.note).startswith("of it; numerical error 50 N")
    assert found["normal_force"] is values["normal_force"]
    bare = errors.widen_numbers(values | {"fluid_load": scalar(100.0, "N")})["fluid_load"]
    assert (bare.uncertainty, bare.interval) == (50.0, None)


@pytest.mark.parametrize("most", [500.0, math.inf])
def test_an_interval_is_widened_in_the_odds_of_its_number(most):
    value, ends, error = 100.0, (60.0, 180.0), 20.0

    def odds(number):
        return math.log(number / (1 - number / most))

    width = 1.96 * error / (value * (1 - value / most))
    low, high = _wider(value, ends, error, most)
    for end, before, sign in ((low, 60.0, -1), (high, 180.0, 1)):
        moved = math.hypot(odds(before) - odds(value), width)
        assert odds(end) == pytest.approx(odds(value) + sign * moved)
    assert _wider(value, ends, 0.0, most) == pytest.approx(ends)
    if most < math.inf:
        low, high = _wider(value, (0.0, most), error, most)
        assert 0 <= low < 1e-3
        assert 499 < high <= 500


def sampled(count=4000):
    rng = np.random.default_rng(1)
    parts = {"adhesion": 0.2 + 0.01 * rng.normal(size=count), "hysteresis": np.full(count, 0.05),
             "viscous": np.full(count, 0.02)}  # fmt: skip
    law: Any = None
    whole = np.sum(list(parts.values()), axis=0)
    return SampledCof(
        cof=whole, contact=np.full(count, 0.5), share={"a": 0.75, "b": 0.25},
        seed=3, left_out=(), confidence=0.95, law=law, **parts,
    )  # fmt: skip


def test_draws_of_the_friction_get_its_numerical_error_as_a_factor_of_their_own():
    drawn: Any = sampled()
    found = numerical_error.with_numerical_error(drawn, 0.027, cof=0.27, sole="s")
    factor = found.viscous / drawn.viscous
    assert np.log(factor).std() == pytest.approx(math.sqrt(math.log1p(0.01)), rel=0.05)
    assert np.median(factor) == pytest.approx(1, abs=0.01)
    solid = found.adhesion / drawn.adhesion
    assert solid == pytest.approx(np.minimum(factor, 2))
    assert found.hysteresis / drawn.hysteresis == pytest.approx(solid)
    assert found.cof == pytest.approx(found.adhesion + found.hysteresis + found.viscous)
    assert found.contact == pytest.approx(np.minimum(0.5 * solid, 1))
    law = np.var(drawn.cof)
    whole = law + 0.027**2
    assert found.share == pytest.approx(
        {"a": 0.75 * law / whole, "b": 0.25 * law / whole, "numerical": 0.027**2 / whole}
    )
    again = numerical_error.with_numerical_error(drawn, 0.027, cof=0.27, sole="s")
    other = numerical_error.with_numerical_error(drawn, 0.027, cof=0.27, sole="t")
    assert again.cof == pytest.approx(found.cof)
    assert abs(np.corrcoef(other.viscous, found.viscous)[0, 1]) < 0.1
    full = replace(drawn, contact=np.ones(drawn.cof.size))
    capped = numerical_error.with_numerical_error(full, 0.27, cof=0.27, sole="s")
    assert (capped.adhesion / drawn.adhesion).max() == pytest.approx(1.1)
    assert capped.contact.max() == 1
    for error, cof in ((0.0, 0.27), (0.1, 0.0)):
        assert numerical_error.with_numerical_error(drawn, error, cof=cof, sole="s") is drawn


def at_places(kind=TreadPositions, **more):
    values = {"fluid_load": np.array([100.0, 200.0]), "contact_load": np.array([400.0, 300.0]),
              "cof_adhesion": np.array([0.2, 0.1]), "cof_hysteresis": np.array([0.04, 0.02]),
              "cof_viscous": np.array([0.01, 0.03]), "cof": np.array([0.25, 0.15]),
              "peak_fluid_pressure": np.array([1e5, 3e5])}  # fmt: skip
    own = {name: float(each[0]) for name, each in values.items()}
    places = (TreadPlace(), TreadPlace((1e-3, 0.0)))
    return kind(places, values, 0, own, **more)


def test_steps_in_time_are_off_by_what_twice_as_many_leave():
    own = {"cof": 0.26, "fluid_load": 100.0, "contact_load": 400.0, "cof_adhesion": 0.2,
           "cof_hysteresis": 0.05, "cof_viscous": 0.01, "peak_fluid_pressure": 1e5}  # fmt: skip
    finer = own | {"fluid_load": 104.0, "contact_load": 396.0, "cof_adhesion": 0.198,
                   "cof_viscous": 0.012, "peak_fluid_pressure": 1.02e5}  # fmt: skip
    at = at_places(in_time=(own, finer))
    found = errors_by_steps(at, ["cof", "fluid_load", "peak_fluid_pressure"], 500.0)
    still = numerical_error.IN_TIME
    assert found["peak_fluid_pressure"] == pytest.approx(math.hypot(0.04, still) * 2e5)
    swing = 2 * (math.log(104 / 396) - math.log(100 / 400))
    film = np.array([0.2, 0.4])
    assert found["fluid_load"] == pytest.approx(
        math.hypot(swing, still) * np.mean(film * (1 - film)) * 500
    )
    moved = 2 * (0.002 + 0.002) / 0.26
    assert found["cof"] == pytest.approx(
        math.hypot(moved * 0.2, still * np.mean(film * [0.24, 0.12]))
    )
    assert errors_by_steps(at_places(), ["cof"], 500.0) == {}


@pytest.mark.parametrize("uncompared", [0.0, 2e-3])
@pytest.mark.parametrize("lost", [0, 2])
def test_errors_of_a_grid_are_those_of_its_rule_its_grids_and_its_lost_places(
    monkeypatch, uncompared, lost
):
    between = {"fluid_load": 4.0, "cof": 0.01, "peak_fluid_pressure": 1e4}
    at = replace(at_places(between=between, uncompared=uncompared), left_out=lost)
    read = {"cof": 0.2, "fluid_load": 150.0, "peak_fluid_pressure": 2e5}
    monkeypatch.setattr(numerical_error, "_read", lambda *_: read)
    monkeypatch.setattr(numerical_error, "cells_along", lambda *_: 0)
    monkeypatch.setattr(numerical_error, "tread_on_sole", lambda _: ([1, 2],))
    monkeypatch.setattr(numerical_error, "remembers", lambda _: False)
    case = CASE.replace("numerics.grid_check", False)
    parts = fake(case=case, spacing=1e-3, objects={}, sole=None)
    solution = fake(contact=fake(normal_force=500.0))
    found: Any = numerical_error.numerical_errors(parts, solution, at)
    size, alone = (2.0, True) if uncompared else (1.0, False)
    share = {k: size * v[alone] for k, v in numerical_error.BETWEEN_GRIDS[True].items()}
    film = np.array([0.2, 0.4])
    moved = share["fluid_load"] * film
    finer = {
        "peak_fluid_pressure": 0.3 * 2e5,
        "fluid_load": np.mean(moved * (1 - film)) * 500,
        "cof": math.hypot(
            share["cof"] * 0.2,
            np.mean(moved * [0.24, 0.12] + share["cof_viscous"] * np.array([0.01, 0.03])),
        ),
    }
    half = {"cof": 0.05, "fluid_load": 50.0, "peak_fluid_pressure": 1e5}
    for name, error in finer.items():
        rule = half[name] * math.sqrt(2) / 2**0.75
        missing = lost / (2 + lost) * half[name]
        wanted = math.sqrt(error**2 + between[name] ** 2 + rule**2 + missing**2)
        assert found.grid[name] == pytest.approx(wanted)
    assert found.steps == {}


# draws over places


def test_the_film_of_a_draw_is_that_of_its_place_moved_by_the_angle():
    at = at_places(film_by_angle=0.3, by_angle={"peak_fluid_pressure": 4e4, "cof": 0.02})
    count = 20_000
    film = at.draw_scalar("fluid_load", count)
    turns = (log_film_odds(film, 500 - film) - np.tile(log_film_odds(
        np.array([100.0, 200.0]), np.array([400.0, 300.0])), count // 2)) / 0.3  # fmt: skip
    assert (turns.min(), turns.max()) == pytest.approx((-math.sqrt(3), math.sqrt(3)), abs=1e-3)
    assert (turns.mean(), turns.std()) == pytest.approx((0, 1), abs=1e-2)
    peak = at.draw_scalar("peak_fluid_pressure", count)
    assert peak - np.tile([1e5, 3e5], count // 2) == pytest.approx(4e4 * turns)
    assert at_places(by_angle={"cof": 1.0}).draw_scalar("cof", 10).min() == 0
    assert at_places().draw_scalar("cof", 4) == pytest.approx([0.25, 0.15] * 2)
    with_bevel = at_places(
        film_by_angle=0.3, bevel=UncertainBevel(2 * ANGLE_DEVIATION, True, "h", 1)
    )
    more = with_bevel._turns(count) - at._turns(count)
    assert (more.mean(), more.std()) == pytest.approx((0, 2), abs=0.05)
    assert with_bevel._turns(count, bevel=False) == pytest.approx(at._turns(count))


def test_log_odds_of_a_film_end_at_a_millionth_of_the_load():
    assert log_film_odds(100.0, 400.0) == pytest.approx(math.log(0.25))
    assert log_film_odds(0.0, 500.0) == pytest.approx(math.log(1e-6))
    assert log_film_odds(500.0, 0.0) == pytest.approx(math.log(1e6))


def test_means_over_places_have_the_spread_of_the_friction_beside_them():
    names = ("cof", "fluid_load", "peak_fluid_pressure")
    values = {name: scalar(1.0, note="n") for name in names}
    found = at_places(by_angle={"cof": -0.02, "fluid_load": 1.0}).average_numbers(values)
    assert found["cof"].value == 1.0  # by the draws, not here
    assert found["fluid_load"].value == 150
    assert found["peak_fluid_pressure"].value == 2e5
    assert found["cof_tread_position"].value == pytest.approx(0.05)
    assert found["cof_shoe_angle"].value == 0.02
    assert "100 N to 200 N over 2" in str(found["fluid_load"].note)
    one = at_places()
    single = replace(one, places=one.places[:1])
    assert single.average_numbers(values) == values
    assert "cof_shoe_angle" not in at_places().average_numbers(values)


@pytest.mark.parametrize("lost", [0, 3])
@pytest.mark.parametrize("turned", [False, True])
def test_places_are_told_with_what_is_left_out(lost, turned):
    by_angle = {"cof": 0.02, "fluid_load": -5.0} if turned else {}
    told = replace(at_places(by_angle=by_angle), left_out=lost).labels()
    assert ("positions_left_out" in told) is (lost > 0)
    assert ("angle_as_exact" in told) is not turned
    assert ("shoe_angle" in told) is turned
    assert "heel_bevel" not in told
    if lost:
        assert told["positions_left_out"].startswith("3 of 5")
    alone = at_places()
    single = replace(alone, places=alone.places[:1], left_out=lost)
    lacks = {"positions_left_out"} if lost else set()
    assert set(single.labels()) == {"tread_position"} | lacks
    yawed = replace(alone, places=(TreadPlace(yaw=0.1), TreadPlace()))
    assert [one.about for one in yawed.assumptions()] == ["shoe.tread"]
    angled = replace(alone, places=(TreadPlace(turn=0.1), TreadPlace()))
    assert [one.about for one in angled.assumptions()] == ["motion.shoe_angle"]
    for assumed in (True, False):
        bevel = at_places(bevel=UncertainBevel(0.01, assumed, "h", 1))
        heads = [one.about for one in bevel.assumptions()]
        assert heads == ["shoe.heel.profile"] * assumed
        assert "heel_bevel" in bevel.labels()


def test_a_sole_without_lugs_is_read_between_the_angles_that_were_solved():
    bevel = UncertainBevel(0.02, True, "h", 5)
    further = {0.1: {"fluid_load": 400.0, "contact_load": 100.0, "cof": 0.05},
               -0.1: {"fluid_load": 50.0, "contact_load": 450.0, "cof": 0.35}}  # fmt: skip
    at: Any = replace(
        at_places(ShoeAngles, bevel=bevel, further=further),
        places=(TreadPlace(), TreadPlace(turn=0.05)),
    )
    turns, cof = at._over_angle("cof")
    assert turns.tolist() == [-0.1, 0, 0.05, 0.1]
    assert cof.tolist() == [0.35, 0.25, 0.15, 0.05]
    count = 1000
    own = np.tile([0.0, 0.05], count // 2)
    with_bevel = own + bevel.turns(count)
    assert at.draw_scalar("cof", count) == pytest.approx(np.interp(with_bevel, turns, cof))
    odds = log_film_odds(np.array([50.0, 100, 200, 400]), np.array([450.0, 400, 300, 100]))
    moved = np.interp(with_bevel, turns, odds) - np.interp(own, turns, odds)
    assert at._more_odds(count) == pytest.approx(moved)
    assert (at._more_odds(count, bevel=False) == 0).all()
    plain = at_places(ShoeAngles)
    assert plain.draw_scalar("cof", 4) == pytest.approx([0.25, 0.15] * 2)
    assert bevel.turns(20_000).std() == pytest.approx(0.02, rel=0.03)
    fields = at.fields()
    assert fields["position_turn"][1] == [0, 0.05]
    assert not [name for name in fields if "yaw" in name or "shift" in name]
    shifted = at_places().fields()
    assert list(shifted["position_shift_x"][1]) == [0, 1e-3]
    assert list(shifted["position_shift_y"][1]) == [0, 0]
    assert shifted["position_fluid_load"][2]["as_described"] == 100
    said = at.labels()["shoe_angle"]
    assert "0.0 to +2.9 deg" in said


# places of a pattern


@pytest.mark.parametrize("count", [1, 4, 5, 8])
def test_places_lie_evenly_along_the_first_period_and_once_each_along_the_second(count):
    periods = np.array([[10e-3, 0.0], [0.0, 7e-3]])
    lie = np.array([place.shift for place in positions.places(periods, count)])
    assert lie[:, 0] == pytest.approx(10e-3 * np.arange(count) / count)
    parts = np.sort(np.round(lie[:, 1] / 7e-3 * count, 6))
    assert parts == pytest.approx(np.arange(count)) or count == 4
    moved = positions.places(periods, count, np.array([0.25, 0.5]))
    apart = np.array([place.shift for place in moved]) - lie
    assert np.mod(apart[:, 0], 10e-3) == pytest.approx(2.5e-3)
    assert np.mod(apart[:, 1], 7e-3) == pytest.approx(3.5e-3)
    (one,) = positions.places(periods[:1], 1)
    assert one.shift == (0.0, 0.0)


@pytest.mark.parametrize("quick", [True, False])
@pytest.mark.parametrize("count", [1, 2, 7])
def test_the_first_march_takes_its_share_of_the_work(monkeypatch, quick, count):
    cells = {"numerics.grid_spacing": "0.5 mm", "numerics.quick_grid_spacing": "1 mm"}
    case = CASE.replace({"numerics.tread_positions": count, **cells})
    monkeypatch.setattr(positions, "further_angles", lambda _: ())
    several = positions.position_count(case, quick=quick)
    assert several == (1 if count == 1 else math.ceil(count / 2) if quick else count)
    remembers = positions.remembers(case)
    turned = 2 * (case.motion.build() is not None)
    if several == 1:
        wanted = 1.0
    elif quick:
        wanted = several + 1 + turned + 1.5 * remembers
    else:
        wanted = 1 + math.ceil(several / 2) + several / 4 + turned + 1.5 / 4 * remembers
    assert 1 / positions.first_share(case, quick=quick) == pytest.approx(wanted)


# what moves in proportion, and what is told


def test_what_a_spread_adds_lies_between_its_ends_and_beyond_in_proportion():
    apart = np.array([-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 3.0])
    found = odds_changes(-0.2, 0.5, apart)
    assert found == pytest.approx([-0.4, -0.2, -0.1, 0.0, 0.25, 0.5, 1.5])
    stated = {"a": {"x": np.array([1.0, 2.0])}, "b": {"x": np.array([10.0, 20.0]), "y": 1.0}}
    assert sum_of_draws(stated, "x") == pytest.approx([11, 22])
    assert np.all(np.asarray(sum_of_draws(stated, "z")) == 0)


def test_numbers_of_a_film_are_as_unsure_as_its_load():
    rng = np.random.default_rng(2)
    odds = 0.5 * rng.normal(size=20_000)
    values = {
        "normal_force": scalar(500.0, "N"),
        "fluid_load": scalar(100.0, "N", uncertainty=10.0),
        "fluid_load_sensor": scalar(50.0, "N"),
        "peak_fluid_pressure": scalar(2e5, "Pa"),
        "peak_fluid_pressure_sensor": scalar(None, "Pa"),
        "cof": scalar(0.2),
    }
    found = numbers.with_film_spread(values, odds)
    drawn = 500 / (1 + 4 * np.exp(-odds))
    low, high = np.quantile(drawn, [0.025, 0.975])
    film = found["fluid_load"]
    assert film.uncertainty == pytest.approx(math.hypot(drawn.std(), 10))
    assert film.interval == pytest.approx(
        (100 * math.exp(-math.hypot(math.log(100 / low), 0.196)),
         100 * math.exp(math.hypot(math.log(high / 100), 0.196)))
    )  # fmt: skip
    peak = found["peak_fluid_pressure"]
    assert peak.interval == pytest.approx((2e3 * low, 2e3 * high))
    assert found["fluid_load_sensor"].interval == pytest.approx((low / 2, high / 2))
    assert found["cof"] is values["cof"]
    assert found["peak_fluid_pressure_sensor"].value is None
    heavier = {"load": {numbers.WHOLE: np.full(odds.size, math.log(1.2)),
                        "peak_fluid_pressure": np.full(odds.size, math.log(1.5)),
                        "fluid_load": np.full(odds.size, math.log(1.1))}}  # fmt: skip
    more = numbers.with_film_spread(values, odds, None, heavier)
    assert max(more["fluid_load"].interval or ()) > max(film.interval or ())
    assert more["peak_fluid_pressure"].interval == pytest.approx(
        (2e5 * min(1.0, 1.5 / 1.1 * 1.2 * low / 100), 2e5 * 1.5 / 1.1 * 1.2 * high / 100)
    )
    assert numbers.with_film_spread(values | {"fluid_load": scalar(None, "N")}, odds)[
        "peak_fluid_pressure"
    ].interval is None  # fmt: skip


def test_the_pressure_that_bears_the_contact_leaves_out_a_hundredth_of_its_load():
    pressure = np.array([[1e5] * 99, [0.0] * 99])
    pressure[1, 0] = 9e4
    pressure[0, 0] = 1e7  # half of the load on one small cell
    area = np.ones((2, 99))
    area[0, 0] = 1e-4
    state = fake(contact_pressure=pressure, cut=fake(area=area), spacing=1e-3,
                 total_pressure=pressure, normal_force=10.0)  # fmt: skip
    assert numbers.bearing_pressure(state) == 1e5
    area[0, 0] = 1.0
    assert numbers.bearing_pressure(state) == 1e7
    touching = numbers.touching_cells(state)
    assert touching.sum() == 100
    state.contact_pressure = np.where(pressure == 9e4, 50.0, pressure)
    mean = 10.0 / (100 * 1e-6)
    assert mean == pytest.approx(1e5)
    assert numbers.touching_cells(state).sum() == 99
    assert numbers.contact_area(state) == pytest.approx(99e-6)


@pytest.mark.parametrize(
    ("share", "crushed", "said"),
    [(0.95, (), "floats"), (0.5, (), "change places"), (0.5, (0.3,), "crushed")],
)
def test_a_march_without_a_result_says_what_stopped_it(share, crushed, said):
    contact = fake(fluid_load=500 * share, normal_force=500.0, time=0.1)
    over = [
        Breach("rubber", "share", each, each, ValidityRange(0, 0.1, "1", "s")) for each in crushed
    ]
    text = numbers.no_result_words(contact, over)
    assert said in text
    assert f"{share:.0%} of 500 N" in text
    assert ("30%" in text) is bool(crushed)
    assert (str(numbers.overload_words(over)) != "") is bool(crushed)


@pytest.mark.parametrize(
    ("low", "high", "overload", "word"),
    [(0.3, 0.9, False, "slips"), (0.0, 0.0009, False, "grips"), (0.0, 0.0009, True, "doubtful"),
     (0.0, 0.9, False, "doubtful")],
)  # fmt: skip
@pytest.mark.parametrize("note", ["", "extrapolated: x"])
def test_both_ends_of_a_probability_decide_what_a_person_may_expect(
    low, high, overload, word, note
):
    slip = scalar(0.5 * (low + high), interval=(low, high), note=note)
    labels = {"overload": "x"} if overload else {}
    found, sentence = summary.verdict_sentence({"slip_probability": slip}, labels)
    assert found == summary.verdict({"slip_probability": slip}, labels) == word
    assert ("extrapolated" in sentence) is bool(note)
    count = {"grips": 1 / summary.GRIPS, "slips": 1 / summary.SLIPS}.get(word)
    if count:
        assert f"1 of {count:.0f} steps" in sentence
    assert summary.verdict_sentence({}, {}) == ("", "")


@pytest.mark.parametrize(
    ("film", "cof", "viscous", "kind", "without"),
    [(0.5, 0.1, 0.02, "film", 0.16), (0.99, 0.02, 0.0198, "shear", 0.02),
     (0.01, 0.2, 0.0, "boundary",
      0.2 / 0.99), (1.0, 0.02, 0.02, "shear", math.nan)],
)  # fmt: skip
def test_what_limits_the_friction_is_what_would_raise_it(film, cof, viscous, kind, without):
    scalars = {"cof": scalar(cof), "cof_viscous": scalar(viscous),
               "fluid_load": scalar(500 * film, "N"), "normal_force": scalar(500.0, "N"),
               "minimum_film_thickness": scalar(1e-6, "m")}  # fmt: skip
    found = summary.friction_limit(scalars)
    assert (found.film_share, found.cof) == (pytest.approx(film), cof)
    assert found.cof_without_film == pytest.approx(without, nan_ok=True)
    assert found.kind == kind
    dry = summary.friction_limit(scalars | {"minimum_film_thickness": scalar(None, "m")})
    assert (dry.kind, dry.cof_without_film) == ("no fluid", cof)


def test_lugs_that_bear_most_of_the_film_are_listed_with_their_ways_out():
    count = summary.LUGS_SHOWN + 2
    share = np.linspace(0.5, 0.2, count)
    same = {"x": 0.03, "y": 0.01, "way": 5e-3, "groove": 2e-3, "relief": 0.25}
    sides = np.arange(count) % 4
    values = {name: np.full(count, each) for name, each in same.items()}
    values |= {"share": share, "load": 100 * share, "side": sides, "groove_side": (sides + 1) % 4}
    fields: Any = {f"lug_{name}": fake(values=each) for name, each in values.items()}
    rows = summary.drainage_table(fields).rows
    assert len(rows) == summary.LUGS_SHOWN
    assert [row[2].rpartition(" ")[2] for row in rows[:4]] == [*SIDES]
    assert rows[0][3].startswith("2 mm to the ")
    assert rows[0][3].endswith("25 % of it")
    assert rows[0][1] == "50 N, 50 %"
    fields["lug_share"].values = np.r_[share[:2], np.full(count - 2, summary.MATTERS / 2)]
    assert len(summary.drainage_table(fields).rows) == 2


def test_assumptions_begin_with_one_of_each_decisive_section():
    heads = {"f": "floor", "m": "motion", "i": "interface", "h": "shoe.heel"}
    given = [Remark(heads[each[0]], each) for each in ("f1", "m1", "i1", "i2", "h1", "f2")]
    ranked = [one.what for one in summary.ranked_assumptions(given)]
    assert ranked == ["i1", "h1", "m1", "f1", "i2", "f2"]


@pytest.mark.parametrize(("slide", "said"), [(None, 0), (0.9, 0), (1.1, 1)])
def test_a_film_that_takes_longer_than_a_tester_slides_is_told(slide, said):
    way = None if slide is None else scalar(slide * summary.LONGEST_SLIDE, "m")
    scalars = {} if way is None else {"steady_slide": way}
    assert len(summary.steadiness(scalars)) == said
    later = {"later_cof": scalar(0.1), "later_time": scalar(2.0, "s"),
             "later_fluid_load": scalar(300.0, "N")}  # fmt: skip
    (line,) = summary.steadiness(scalars | later)
    assert "2 s" in line
    assert "300 N" in line
    assert summary.headline(Status.NOT_CONVERGED, {}, {"no_result": "x"})[0].startswith("No result")
