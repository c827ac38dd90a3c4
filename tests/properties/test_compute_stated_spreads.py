"""What a case states with a standard deviation reaches every number that a run prints."""

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot import Case, run
from underfoot.case import CaseError, unit_at
from underfoot.compute import solve
from underfoot.compute.numbers import with_film_spread
from underfoot.compute.stated_spreads import (
    ODDS,
    VISCOSITY,
    WHOLE,
    StatedEffect,
    odds_changes,
    stated_spreads,
)
from underfoot.core import InputError, SourcedValue, Status

LENGTH = "shoe.heel.length"
FILM = ("fluid_load", "fluid_load_sensor", "peak_fluid_pressure")
MOVED = ("peak_fluid_pressure", "cof_viscous", "contact_area", "minimum_film_thickness")


def heel(tread: str = "full_tread", **values: Any) -> Case:
    """Return a heel as its tread lies, or at its own angle alone."""
    return Case.from_text(
        f"""
        shoe = "work_shoe_{tread}"
        floor = "vinyl_g4"
        contaminant = "glycerol_90pct"
        motion = "slip_tester_g4"
        interface.roughness_beyond_cutoff = 1.5
        """
    ).replace({"numerics.tread_positions": 1, **values})


def stated(case: Case, path: str, deviation: float) -> Case:
    """Return the case with a standard deviation (SI) of the number at a path."""
    number = SourcedValue(case.value(path), unit_at(path), "", deviation)
    return case.replace(path, number)


def deviation(result: Any, name: str) -> float:
    return result[name].uncertainty or 0.0


@pytest.fixture(scope="module")
def plain() -> Any:
    return run(heel(), quick=True)


@pytest.mark.parametrize(
    ("path", "spread"),
    [
        (VISCOSITY, 0.11),
        ("motion.normal_force", 100.0),
        ("shoe.material.shore_a", 6.0),
        ("shoe.heel.length", 5e-3),
    ],
)
def test_the_film_s_part_is_that_of_runs_at_one_standard_deviation(plain, path, spread):
    """Tolerance: 10 % of each move of ln F / (W - F) and of ln of other numbers, or 0.02."""
    case = stated(heel(), path, spread)
    (only,) = stated_spreads(case)
    ends = [run(case.replace(change), quick=True) for change in only.changes]
    result = solve.solve_case(solve.prepare_case(case, case.numerics.quick_grid_spacing))
    assert not result.stated.left_out
    (effect,) = result.stated.effects

    def odds(one: Any) -> float:
        film, whole = one.value("fluid_load"), one.value("normal_force")
        return math.log(film / (whole - film))

    for k, end in enumerate(ends):
        assert effect.moves[ODDS][k] == pytest.approx(odds(end) - odds(plain), rel=0.1, abs=0.02)
        for name in MOVED:
            log = math.log(end.value(name) / plain.value(name))
            assert effect.moves[name][k] == pytest.approx(log, rel=0.1, abs=0.02), name


@pytest.mark.slow
def test_a_stated_viscosity_reaches_the_film():
    plain = run(heel("untreaded"), quick=True)
    known = run(stated(heel("untreaded"), VISCOSITY, 0.11), quick=True)
    for name in (*FILM, "cof"):
        assert known.value(name) == plain.value(name)
    film, whole = plain.value("fluid_load"), plain.value("normal_force")
    assert deviation(known, "fluid_load") > 1.1 * deviation(plain, "fluid_load")
    assert deviation(known, "cof") > deviation(plain, "cof")
    low, high = known["fluid_load"].interval
    assert low < plain["fluid_load"].interval[0]
    assert high <= whole * 1.001
    assert film < whole
    assert VISCOSITY in known.labels["cof_spread_from"]
    assert VISCOSITY in known.labels["stated_spreads"]
    assert "by what the case states" in known["contact_area"].note
    assert "stated_left_out" not in known.labels


def test_what_makes_a_viscosity_counts_as_one_spread():
    fluid = {
        "glycerol_fraction": {"value": 0.9, "uncertainty": 0.02},
        "fraction_basis": "mass",
        "temperature": {"value": "20 degC", "uncertainty": "2 K"},
    }
    spreads = stated_spreads(heel().replace("contaminant", fluid))
    assert [one.path for one in spreads] == [VISCOSITY]
    thin = heel().replace(VISCOSITY, {"value": "219 cP", "uncertainty": "1 cP"})
    assert not stated_spreads(thin)  # the law draws it; the film does not know 0.5 %


def test_a_wide_spread_is_drawn_log_normal():
    (spread,) = stated_spreads(stated(heel(), VISCOSITY, 0.219))
    low, high = (change["contaminant"]["viscosity"] for change in spread.changes)
    width = math.sqrt(math.log(2.0))
    assert (low, high) == pytest.approx((0.219 * math.exp(-width), 0.219 * math.exp(width)))
    normal = np.array([-1.0, 0.0, 1.0]) + spread.offset
    effect = StatedEffect(spread.path, spread.subject, spread.offset, {ODDS: (-0.5, 0.3)})
    assert effect.draws(lambda _: normal)[ODDS] == pytest.approx([-0.5, 0.0, 0.3])


def test_between_and_beyond_the_ends_a_number_moves_in_proportion():
    moved = odds_changes(-0.4, 0.2, np.array([-2.0, -0.5, 0.0, 0.5, 3.0]))
    assert moved == pytest.approx([-0.8, -0.2, 0.0, 0.1, 0.6])


def test_no_draw_of_the_film_bears_more_than_the_load():
    values = {
        name: SourcedValue(value, unit, source="")
        for name, value, unit in (
            ("fluid_load", 400.0, "N"),
            ("normal_force", 500.0, "N"),
            ("fluid_load_sensor", 300.0, "N"),
            ("peak_fluid_pressure", 4e5, "Pa"),
            ("peak_fluid_pressure_sensor", 3e5, "Pa"),
        )
    }
    normal = np.random.default_rng(0).normal(size=500)
    names = ("fluid_load", "fluid_load_sensor", "peak_fluid_pressure", "peak_fluid_pressure_sensor")
    draws = {ODDS: 3 * normal, WHOLE: 0 * normal, **dict.fromkeys(names, 0.2 * normal)}
    low, high = with_film_spread(values, 0 * normal, None, {"x": draws})["fluid_load"].interval
    assert 0 < low < 400 < high <= 500


def test_a_hardness_counts_once():
    """The law draws it without the effects; with them its draws come from contact and film."""
    case = stated(heel(), "shoe.material.shore_a", 6.0)
    parts = solve.prepare_case(case, case.numerics.quick_grid_spacing)
    effects = solve.stated_effects(parts, solve.solved_motion(parts))
    exact: Any = solve.law_without(parts, effects)
    pair, own = exact.law.pair, parts.law.pair
    assert pair.shore_a_deviation == 0
    assert own.shore_a_deviation == 6.0
    assert pair.shore_a == own.shore_a


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("numerics.grid_spacing", {"value": "0.6 mm", "uncertainty": "0.1 mm"}),
        ("slip.mass_mean", {"value": "70 kg", "uncertainty": "5 kg"}),
        ("sensor.scans", {"value": 7, "uncertainty": 1}),
        ("shoe.tread.pattern", {"value": "none", "uncertainty": 1}),
    ],
)
def test_a_spread_that_nothing_can_draw_is_refused(path, value):
    with pytest.raises(CaseError, match="has no standard deviation"):
        heel().replace(path, value)


def test_a_spread_in_a_list_is_refused():
    readings = [
        {"speed": "0.1 m/s", "cof": {"value": 0.2, "uncertainty": 0.1}},
        {"speed": "0.5 m/s", "cof": 0.1},
    ]
    with pytest.raises(CaseError, match="in a list"):
        heel().replace("friction", {"model": "table", "readings": readings})
    own = {"model": "table", "readings": [{**each, "cof": 0.2, "sd": 0.1} for each in readings]}
    assert heel().replace("friction", own).friction.readings[0].sd == 0.1


@pytest.mark.parametrize("lost", [None, "one place", "all places"])
def test_a_spread_moves_the_mean_over_the_places_that_have_numbers(monkeypatch, lost):
    """Two places of a tread: loads on the film of 40 and 60 N, 60 and 90 N one deviation more."""
    case = stated(heel(**{"numerics.tread_positions": 4}), LENGTH, 5e-3)
    places = solve.effect_places(case)[:2]
    monkeypatch.setattr(solve, "effect_places", lambda _: places)
    parts = SimpleNamespace(case=case, objects={"friction": None}, spacing=1e-3)

    def of_cases(cases, spacing, objects):
        assert objects == parts.objects
        factors = [each.value(LENGTH) / case.value(LENGTH) for each in cases]

        def numbers(asked):
            number, place = asked
            if lost == "all places" or (lost and place == places[1]):
                return None
            film = {places[0]: 40.0, places[1]: 60.0}[place] * factors[number]
            parts = dict.fromkeys(("cof_adhesion", "cof_hysteresis", "cof_viscous"), 0.03)
            return {"fluid_load": film, "contact_load": 500.0 - film, "cof": 0.09, **parts}

        return numbers

    def no_step(*_):
        raise InputError("the finished contact does not go on")

    monkeypatch.setattr(solve, "prepare_case", no_step)
    monkeypatch.setattr(solve, "_NumbersOfCases", of_cases)
    contact = SimpleNamespace(status=Status.CONVERGED)
    made = solve.stated_effects(cast(Any, parts), cast(Any, contact), processes=2)
    if lost == "all places":
        assert made.left_out == (LENGTH,)
        return
    ends = stated_spreads(case)[0].changes
    factors = [cast(float, end[LENGTH]) / case.value(LENGTH) for end in ends]
    mean = 40.0 if lost else 50.0
    odds = [math.log(mean * x / (500 - mean * x)) - math.log(mean / (500 - mean)) for x in factors]
    assert made.effects[0].moves[ODDS] == pytest.approx(odds)


def test_an_end_that_cannot_be_is_as_far_as_the_other():
    case = stated(heel(**{"motion.shoe_angle": math.radians(60)}), "motion.shoe_angle", 0.01)
    numbers = {"fluid_load": 100.0, "contact_load": 400.0, "cof": 0.1}
    numbers |= {"cof_adhesion": 0.05, "cof_hysteresis": 0.03, "cof_viscous": 0.02}
    end = {**numbers, "fluid_load": 50.0, "contact_load": 450.0}

    def marched(cases):
        assert len(cases) == 2  # beyond 60 degrees there is no case
        return [numbers, end]

    effects = solve.solved_effects(case, lambda _: None, marched)
    less, more = effects.effects[0].moves[ODDS]
    assert less == -more == pytest.approx(math.log(50 / 450) - math.log(100 / 400))
    gone = solve.solved_effects(case, lambda _: None, lambda cases: [numbers, *[None] * len(cases)])
    assert gone.left_out == ("motion.shoe_angle",)
    assert "motion.shoe_angle" in gone.labels()["stated_left_out"]
