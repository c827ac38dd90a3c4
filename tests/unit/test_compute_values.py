"""Small steps of a run by their values: rates beyond a compound's test, what is cut off a sole."""

import importlib
import inspect
import math
import pkgutil
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot import compute, shoe
from underfoot.case import load
from underfoot.compute import numerical_error, positions, read, sole, solve
from underfoot.compute.position_draws import COF_PARTS, ShoeAngles, TreadPlace
from underfoot.compute.prepare import prepare_case
from underfoot.compute.resolve import _untested_rates
from underfoot.compute.sole import trim_map
from underfoot.compute.summary import table
from underfoot.core import SourcedValue
from underfoot.film import NewtonianFilm
from underfoot.friction.film_shear import FilmShearLaw
from underfoot.shoe import SoleMap
from underfoot.sole_contact.solver import SolverSettings

HEEL = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"


def with_compound(speed: float, slowest: float | None, fastest: float | None) -> Any:
    material = SimpleNamespace(relaxation=object(), slowest_tested=slowest, fastest_tested=fastest)
    return SimpleNamespace(
        shoe=SimpleNamespace(material=material), motion=SimpleNamespace(speed=speed)
    )


@pytest.mark.parametrize("speed", [0.5, -0.5])
def test_asperities_work_the_rubber_at_rates_of_the_waves_of_a_stylus(speed):
    least, most = (2 * math.pi * 0.5 / wave for wave in (0.8e-3, 2.5e-6))
    (breach,) = _untested_rates(with_compound(speed, None, 1e5))
    assert (breach.low, breach.high) == pytest.approx((least, most))
    assert (breach.range.low, breach.range.high) == (0.0, 1e5)
    assert _untested_rates(with_compound(speed, None, 1.001 * most)) == []
    assert _untested_rates(with_compound(speed, 0.999 * least, 1.001 * most)) == []
    assert len(_untested_rates(with_compound(speed, 1.001 * least, 1.001 * most))) == 1
    assert _untested_rates(with_compound(speed, 1.0, None)) == []


def sloping() -> SoleMap:
    """Return a sole of 20 x 12 cells of 1 mm, 0.1 mm higher with each row; its sides are out."""
    x, y = 1e-3 * np.arange(20), 1e-3 * np.arange(12)
    inside = np.zeros((20, 12), bool)
    inside[:, 3:9] = True
    clearance = np.where(inside, 1e-4 * np.arange(20)[:, None], np.inf)
    depth = np.zeros((20, 12))
    return SoleMap(x, y, clearance, inside, inside.copy(), depth, 1e-3, np.zeros((4, 2)))


@pytest.mark.parametrize(
    ("padding", "rows", "columns"), [(2e-3, 8, (1, 11)), (2.5e-3, 9, (0, 12)), (0.0, 7, (2, 10))]
)
def test_a_trimmed_sole_keeps_what_comes_within_reach_and_its_padding(padding, rows, columns):
    whole = sloping()
    part = trim_map(whole, 5.5e-4, padding=padding)  # rows 0 to 5 stand that low
    np.testing.assert_array_equal(part.x, whole.x[:rows])
    np.testing.assert_array_equal(part.y, whole.y[slice(*columns)])
    cut = (slice(rows), slice(*columns))
    for name in ("clearance", "inside", "land", "tread_depth"):
        np.testing.assert_array_equal(getattr(part, name), getattr(whole, name)[cut])
    assert part.whole is whole


def test_a_sole_that_rolls_keeps_what_any_angle_brings_down():
    whole = sloping()
    flat = math.atan(-0.1)  # toe down by the slope of the sole: every row lies on the floor
    assert trim_map(whole, 5.5e-4, flat).x.size == 20
    assert trim_map(whole, 5.5e-4, cast(Any, [0.0, flat])).x.size == 20
    assert trim_map(whole, 5.5e-4, 0.0).x.size == 10  # 6 rows and 4 of padding


@dataclass(frozen=True)
class HalfSheared:
    """A film that shears its walls half as much as a Newtonian one."""

    viscosity: float
    name: str = "half_sheared"
    source: str = "made for this test"

    def flow_factor(self, gap, speed):
        return np.ones_like(gap), np.zeros_like(gap)

    def shear(self, speed, film_thickness):
        return 0.5 * self.viscosity * np.asarray(speed) / np.asarray(film_thickness)


def test_only_a_film_of_another_shear_takes_the_place_of_eta_v_over_h():
    case = load(HEEL)
    viscosity, at = 0.2, ([1e5], 0.5, [2e-5])

    first = prepare_case(case, 4e-3, {"film": NewtonianFilm(viscosity)})

    def law_with(film):
        return prepare_case(case, 4e-3, {"film": film}, geometry=(first.sole, first.compliance)).law

    plain = first.law
    assert not isinstance(plain, FilmShearLaw)
    assert not isinstance(law_with(None), FilmShearLaw)
    halved = law_with(HalfSheared(viscosity))
    assert halved(*at).viscous == pytest.approx(0.5 * viscosity * 0.5 / 2e-5)
    assert halved(*at).adhesion == pytest.approx(plain(*at).adhesion)


@pytest.mark.parametrize("history", [False, True])
def test_a_motion_is_solved_in_as_many_steps_as_are_asked_for_and_by_default_in_its_own(
    monkeypatch, history
):
    case, taken = load(HEEL), []
    motion = SimpleNamespace(
        **dict.fromkeys(("shoe_angle", "sliding_speed", "normal_force", "end_time"), 1.0),
        force_rise_time=0.1, start_film=None, build=lambda: "history" if history else None,
    )  # fmt: skip
    parts: Any = SimpleNamespace(
        case=SimpleNamespace(motion=motion, contaminant=None, numerics=case.numerics), sole=None,
        compliance=None, asperities=None, viscosity=0.1, film=None, local_law=None,
    )  # fmt: skip
    for name in ("solve_history", "solve_sliding"):
        monkeypatch.setattr(
            solve, name, lambda *_, settings, name=name, **__: taken.append((name, settings))
        )
    solve.solved_motion(parts)
    for finer in (1, 2, 3):
        solve.solved_motion(parts, finer=finer)
    assert {name for name, _ in taken} == {"solve_history" if history else "solve_sliding"}
    steps = [settings.time_resolution for _, settings in taken]
    own = SolverSettings().time_resolution * (solve.HISTORY_FINER if history else 1)
    assert steps == pytest.approx([own, own, 2 * own, 3 * own])


@pytest.mark.parametrize(("degrees", "angles"), [(6.0, [7, 10, 13]), (0.0, [10])])
def test_a_sole_is_worn_step_by_step_at_its_angle_and_half_the_range_to_either_side(
    monkeypatch, degrees, angles
):
    wear = {"mode": "archard", "angle": "10 deg", "angle_range": f"{degrees} deg"}
    depth = 2.5 * sole.WEAR_STEP
    case = load(HEEL).replace("shoe.wear", {**wear, "depth": f"{depth} m"})
    calls = []

    def wears(new, *, angles, depth, begin, **_):
        calls.append((np.degrees(angles), depth, begin))
        worn = SimpleNamespace(x=np.zeros(1), y=np.zeros(1), removed=np.zeros((1, 1)))
        return SimpleNamespace(worn=worn, sliding_distance=depth)

    store = SimpleNamespace(load=lambda _: None, store=lambda *_: None)
    monkeypatch.setattr(sole, "archard_wear", wears)
    monkeypatch.setattr(sole, "Cache", lambda _: store)
    end = sole.archard_state(case)
    assert end.sliding_distance == pytest.approx(depth)
    step = sole.WEAR_STEP
    assert [each for _, each, _ in calls] == pytest.approx([step, 2 * step, depth])
    assert calls[0][2] is None
    assert [begin.sliding_distance for *_, begin in calls[1:]] == pytest.approx([step, 2 * step])
    for each, *_ in calls:
        assert each == pytest.approx(angles)


@pytest.mark.parametrize("depth", [0.0, 1e-3])
@pytest.mark.parametrize(
    ("shift", "yaw", "moves"),
    [
        ((0.0, 0.0), 0.0, False),
        ((1e-3, 0.0), 0.0, True),
        ((0.0, -1e-3), 0.0, True),
        ((0.0, 0.0), 0.1, True),
    ],
)
def test_a_tread_of_a_file_is_moved_and_turned_where_that_is_asked_and_then_worn(
    monkeypatch, depth, shift, yaw, moves
):
    def moved(surface, by, periods, *, yaw, pivot):
        return f"{surface} by {by} of {periods} and {yaw} about {pivot}"

    fakes = {
        "file_outsole": lambda _: SimpleNamespace(surface="new"), "file_periods": lambda _: 9,
        "landing_front": lambda _: 0.05, "worn_surface": lambda surface, by: f"{surface}, {by}",
    }  # fmt: skip
    for name, fake in fakes.items():
        monkeypatch.setattr(sole, name, fake)
    monkeypatch.setattr("underfoot.shoe.tread_shift.moved_tread", moved)
    wear = SimpleNamespace(depth=depth, build=lambda: "worn")
    case: Any = SimpleNamespace(shoe=SimpleNamespace(wear=wear))
    surface: Any = sole.file_surface(case, shift, yaw)
    where = f"new by {shift} of 9 and {yaw} about (0.05, 0.0)" if moves else "new"
    assert surface == where + (", worn" if depth else "")


def test_the_error_of_a_run_is_spread_about_its_own_cof(monkeypatch):
    class Asked(Exception):
        pass

    def asked(sampled, error, *, cof, sole):
        raise Asked(sampled, error, cof, sole)

    errors = read.NumericalErrors.__new__(read.NumericalErrors)
    monkeypatch.setattr(read.NumericalErrors, "deviation", lambda _, name: {"cof": 0.01}[name])
    monkeypatch.setattr(read, "numerical_errors", lambda *_, **__: errors)
    monkeypatch.setattr(read, "overload_breaches", lambda *_: [])
    monkeypatch.setattr(read, "with_numerical_error", asked)
    monkeypatch.setattr(read.numbers, "sole_name", lambda _: "a")
    friction = SimpleNamespace(sums=SimpleNamespace(cof=SourcedValue(0.12, "1")), sampled="draws")
    contact = SimpleNamespace(status=SimpleNamespace(usable=True))
    parts: Any = SimpleNamespace(case=None, context=SimpleNamespace(youngs_modulus=5e6))
    solution: Any = SimpleNamespace(contact=contact, friction=friction)
    with pytest.raises(Asked) as told:
        read.readings(parts, solution, None)
    assert told.value.args == ("draws", 0.01, 0.12, "a")


def test_what_nobody_moves_or_turns_lies_where_it_was_put():
    unmoved = {"shift": (0.0, 0.0), "offset": (0.0, 0.0), "turn": 0.0, "yaw": 0.0}
    checked = 0
    for room in (compute, shoe):
        for each in pkgutil.iter_modules(room.__path__, f"{room.__name__}."):
            module = importlib.import_module(each.name)
            members = (one for _, one in inspect.getmembers(module, inspect.isroutine))
            for made in (one for one in members if one.__module__ == each.name):
                for name, taken in inspect.signature(made).parameters.items():
                    if name in unmoved and isinstance(taken.default, (float, tuple)):
                        assert taken.default == unmoved[name], (made, name)
                        checked += 1
    assert checked >= 10


GRID = 0.5e-3


def numbers_on(film: float) -> dict[str, float]:
    return {"cof": 0.3, "fluid_load": film, "contact_load": 100 - film,
            **dict.fromkeys(COF_PARTS, 0.1)}  # fmt: skip


def test_half_of_what_finer_cells_would_add_is_between_the_grids_where_all_places_agree():
    """Odds of the film are 2/3 on the quick grid and 1 on the run's, at every place alike."""
    case = load(HEEL).replace(
        {
            "shoe.tread": {"pattern": "bars", "depth": "3 mm", "lug_width": "6 mm",
                           "channel_width": "4 mm"},
            "numerics.quick_grid_spacing": f"{4 * GRID} m",
        }
    )  # fmt: skip
    made = positions.tread_positions(
        case,
        {TreadPlace(): numbers_on(50.0)},
        lambda asked: ((k, numbers_on(50.0 if h == GRID else 40.0))
                       for k, (_, h) in enumerate(asked)),
        spacing=GRID, quick=False,
    )  # fmt: skip
    onward = (GRID - positions.FINEST) / (3 * GRID)
    odds = 1.0 + onward / 3  # 2/3 grew by half, which is 1/3
    assert onward > 0.01
    assert made.values["fluid_load"] == pytest.approx(100 * odds / (1 + odds))
    half = (100 * odds / (1 + odds) - 50) / 2
    assert cast(Any, made).between["fluid_load"] == pytest.approx(half)


@pytest.mark.parametrize(
    ("second", "reduced"),
    [((0, 7), (0, 7)), ((10, 7), (0, 7)), ((-20, 7), (0, 7)), ((25, 7), (5, 7)),
     ((-3, -7), (3, 7)), ((13, 7), (3, 7))],
)  # fmt: skip
@pytest.mark.parametrize("length", [10e-3, 8.66e-3])
def test_periods_of_a_pattern_lean_by_less_than_one_of_its_first(second, reduced, length):
    """Of 10 units along; the lattice stays, so what is taken off is a whole number of the first."""
    unit = length / 10
    given = np.array([(10, 0), second]) * unit
    assert positions._reduce_periods(given) == pytest.approx(np.array([(10, 0), reduced]) * unit)


@pytest.mark.parametrize("wet", [True, False])
def test_the_quick_grid_is_compared_in_cells_and_where_a_film_remembers_in_time(monkeypatch, wet):
    case = load(HEEL)
    at = {1: {"cof": 0.30, "fluid_load": 40.0}, 2: {"cof": 0.28, "fluid_load": 41.0}}

    def solved(parts, place, spacing, **_):
        assert spacing == case.numerics.quick_grid_spacing
        status = SimpleNamespace(usable=True)
        return SimpleNamespace(sole=None), SimpleNamespace(status=status, numbers=at[place.finer])

    monkeypatch.setattr(numerical_error, "solved_at", solved)
    monkeypatch.setattr(numerical_error, "_read", lambda _, contact: contact.numbers)
    monkeypatch.setattr(numerical_error, "cells_along", lambda *_: 1)
    parts: Any = SimpleNamespace(case=case, viscosity=0.1 if wet else None)
    own = {"cof": 0.33, "fluid_load": 36.0}
    told: Any = numerical_error._grid_differences(parts, own, cast(Any, None))
    assert told.grid == pytest.approx({"cof": 0.03, "fluid_load": 4.0})
    assert told.steps == pytest.approx({"cof": 0.04, "fluid_load": 2.0} if wet else {})


@pytest.mark.parametrize(("share", "bends"), [(0.5, False), (0.94, False), (0.96, True), (1, True)])
def test_a_region_of_a_file_bends_at_its_ball_where_it_is_nearly_the_whole(
    monkeypatch, share, bends
):
    whole, jointed = 0.3, []
    fakes = {
        "file_outsole": lambda _: SimpleNamespace(whole_length=whole),
        "surface_map": lambda *_, **__: "map", "trim_map": lambda made, *_: made,
        "_add_joint": lambda case, made, length: jointed.append(length) or made,
        "check_load": lambda *_: None, "rolls": lambda _: 0.0,
        "_press_slits": lambda case, made: made,
        "_with_cells": lambda case, made, again: made,
    }  # fmt: skip
    for name, fake in fakes.items():
        monkeypatch.setattr(sole, name, fake)
    case: Any = SimpleNamespace(shoe=SimpleNamespace(outsole=SimpleNamespace(reach=1e-3)))
    sole._map_of_surface(case, cast(Any, SimpleNamespace(length=share * whole)), 1e-3, 0.1)
    assert jointed == [share * whole] * bends


@pytest.mark.parametrize("regime", [True, False])
def test_a_row_of_a_result_has_the_interval_beside_it_or_what_its_value_means(regime):
    scalars = {
        "normal_force": SourcedValue(500.0, "N"),
        "cof": SourcedValue(0.3, "1", uncertainty=0.05, interval=(0.1, 0.31)),
        "cof_adhesion": SourcedValue(0.2, "1", uncertainty=0.01, interval=(0.18, 0.22)),
        "cof_viscous": SourcedValue(0.1, "1"),
        "fluid_load": SourcedValue(200.0, "N"),
        "fluid_load_sensor": SourcedValue(150.0, "N", uncertainty=20.0, interval=(110.0, 190.0)),
        "contact_area": SourcedValue(1e-4, "m^2"),
        "minimum_film_thickness": SourcedValue(1e-6, "m", note="of the whole sole"),
    }
    labels = {"regime": "mixed", "regime_rule": "film bears 40 %"} if regime else {}
    rows = [tuple(cell.strip() for cell in row) for row in table(scalars, labels).rows]
    remark = {label: (value, told) for label, value, told in rows}
    assert remark["Coefficient of friction"] == ("0.300 (0.100 to 0.310)", "")
    assert remark["from adhesion"] == ("0.200 ± 0.010", "95 %: 0.180 to 0.220")
    assert remark["Load carried by the fluid"] == ("200 N", "40 % of the load")
    assert remark["as floor sensors read it"] == ("150 ± 20 N", "95 %: 110 N to 190 N")
    assert remark["Contact area"][1] == "where the rough surfaces touch"
    assert remark["Thinnest film"][1] == "of the whole sole"
    assert ("Lubrication regime" in remark) is regime
    if regime:
        after = rows.index(("Lubrication regime", "mixed", "film bears 40 %"))
        assert rows[after - 1][0] == "from shearing the fluid"


@pytest.mark.parametrize("count", [1, 3])
def test_a_run_at_several_angles_says_from_where_to_where(count):
    degree = math.radians(1.0)
    turns = [TreadPlace(), TreadPlace(turn=degree), TreadPlace(turn=-degree)][:count]
    values = {"cof": np.array([0.30, 0.35, 0.25])[:count],
              "fluid_load": np.array([40.0, 30.0, 50.0])[:count]}  # fmt: skip
    made = ShoeAngles(tuple(turns), values, 0, {"cof": 0.30, "fluid_load": 40.0})
    labels = made.labels()
    assert bool(labels) is (count > 1)
    for part in ("0.25", "0.35", "30", "50 N", "-1.0 to +1.0 deg") * (count > 1):
        assert part in labels["shoe_angle"]
