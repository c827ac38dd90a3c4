"""Parts of a run: what is decided just below and just above each limit, and numbers by hand."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from small_pads import BARS, STEP, TWO_GRIDS, pad
from snapshot import refusal
from underfoot.compute import check, numbers, positions, sole
from underfoot.compute.numerical_error import NumericalErrors
from underfoot.compute.position_draws import TreadPlace, UncertainBevel
from underfoot.core import ConvergenceError, SourcedValue, Status
from underfoot.core.remark import Message
from underfoot.shoe import SoleMap

LUGS = pad(BARS, {"numerics.tread_positions": 4})
FLAT = pad(TWO_GRIDS)


def cells(pressure, area=None, *, force=None, spacing=1e-3) -> Any:
    """Return a state of the sole of a pressure of contact (Pa) alone."""
    pressure = np.asarray(pressure, dtype=float)
    area = np.ones_like(pressure) if area is None else np.asarray(area)
    load = float((pressure * area).sum()) * spacing**2
    return SimpleNamespace(
        contact_pressure=pressure, total_pressure=pressure, spacing=spacing,
        cut=SimpleNamespace(area=area), normal_force=load if force is None else force,
    )  # fmt: skip


# numbers


def test_what_touches_bears_a_thousandth_of_the_mean():
    """Of 10 cells 4 are loaded; the mean is that of these, and 1e-3 of it touches."""
    state = cells([[1e5, 99.0, 101.0, 1e5, 0.0], [2e5, 0, 0, 0, 0]], force=0.4)
    # 0.4 N on five cells of a mm^2: 80 kPa
    assert numbers.touching_cells(state).sum() == 5
    state = cells([[1e5, 79.0, 81.0, 1e5, 0.0], [2e5, 0, 0, 0, 0]], force=0.4)
    assert numbers.touching_cells(state).tolist() == [
        [True, False, True, True, False], [True, *[False] * 4]]  # fmt: skip
    assert numbers.contact_area(state) == pytest.approx(4e-6)
    half = cells([[1e5, 1e5]], [[0.5, 1.0]])
    assert numbers.contact_area(half) == pytest.approx(1.5e-6)
    assert not numbers.touching_cells(cells(np.zeros((2, 2)))).any()


def test_ninety_nine_parts_of_the_load_are_borne():
    few = np.append(np.full(99, 1e4), 1e4)
    assert numbers.bearing_pressure(cells(few)) == 1e4
    edge = np.append(np.arange(1.0, 100.0), 49.0)
    # 1 + ... + 99 + 49 = 4999; without the highest (99) 4900 < 4949, so it is needed
    assert numbers.bearing_pressure(cells(edge)) == 99.0
    narrow = np.ones(100)
    narrow[98] = 0.1
    assert numbers.bearing_pressure(cells(np.arange(1.0, 101.0)[:99], narrow[:99])) == 98.0


@pytest.mark.parametrize(("film", "said"), [(450.0, "change places"), (451.0, "floats and tips")])
def test_a_sole_floats_where_the_film_carries_nine_tenths(film, said):
    contact: Any = SimpleNamespace(fluid_load=film, normal_force=500.0, time=0.02)
    told = numbers.no_result_words(contact, [])
    assert said in told
    assert "stopped at 20 ms, where the film carried 90% of 500 N" in told
    unloaded: Any = SimpleNamespace(fluid_load=3.0, normal_force=0.0, time=0.02)
    assert "carried 0% of 0 N" in numbers.no_result_words(unloaded, [])
    crushed: Any = [SimpleNamespace(high=0.4)]
    assert "lugs crushed: 40% of the load" in numbers.no_result_words(contact, crushed)
    assert "40% of the load rests" in numbers.overload_words(crushed)
    assert numbers.overload_words([]) == ""


@pytest.mark.parametrize("place", ["tread_position", "shoe_angle", "bevel"])
def test_where_a_spread_comes_from(place):
    share = {
        "hysteresis": 0.0049,
        "kappa": 0.0049,
        "rest": 0.005,
        "film": 0.6,
        place: 0.3,
        "x": 0.1,
    }
    sampled: Any = SimpleNamespace(share=share, left_out=("pair", "y"), cof=np.zeros(40), seed=7)
    told = numbers.spread_origin(sampled)
    parts = told["cof_spread_from"].split(", ")
    assert parts[0] == "boundary film 60%"
    assert parts[-3:] == ["hysteresis of the rough contact below 1%",
                          "taken as exact: difference between pairs", "y"]  # fmt: skip
    assert "adhesion at rest 0%" in parts
    assert "x 10%" in parts
    assert "fading of the dry-like part" not in told["cof_spread_from"]
    held = {"tread_position": "position of the tread in turn", "shoe_angle": "shoe angle in turn",
            "bevel": "film thickness as computed"}[place]  # fmt: skip
    assert told["cof_spread_how"].startswith("40 draws, seed 7; ")
    assert held in told["cof_spread_how"]
    assert numbers.spread_origin(None) == {}


def test_soles_of_one_geometry_share_a_name():
    names = {
        key: (numbers.sole_name(case), numbers.heel_name(case))
        for key, case in {
            "it": LUGS, "faster": LUGS.replace("motion.speed", "0.4 m/s"),
            "harder": LUGS.replace("shoe.material.shore_a", 70),
            "wider": LUGS.replace("shoe.tread.channel_width", "5 mm"),
            "longer": LUGS.replace("shoe.heel.length", "25 mm"),
            "thicker": LUGS.replace("shoe.sole.outsole_thickness", "11 mm"),
            "worn": LUGS.replace("shoe.wear", {"mode": "plane", "depth": "1 mm", "angle": "2 deg"}),
            "new": LUGS.replace("shoe.wear", {"mode": "plane", "depth": "0 mm", "angle": "2 deg"}),
            "rounded": LUGS.replace("shoe.wear.edge_radius", "1 mm"),
        }.items()
    }  # fmt: skip
    same_sole = [key for key in names if names[key][0] == names["it"][0]]
    same_heel = [key for key in names if names[key][1] == names["it"][1]]
    assert same_sole == ["it", "faster", "harder", "new"]
    assert same_heel == ["it", "faster", "harder", "wider", "new"]


def test_what_a_film_without_a_load_or_a_number_leaves():
    values = {
        "fluid_load": SourcedValue(20.0, "N"), "normal_force": SourcedValue(50.0, "N"),
        "fluid_load_sensor": SourcedValue(None, "N", reason="r"),
        "peak_fluid_pressure": SourcedValue(0.0, "Pa"),
        "peak_fluid_pressure_sensor": SourcedValue(1e4, "Pa", uncertainty=2e3),
    }  # fmt: skip
    odds = np.array([-1.0, 0.0, 1.0])
    found = numbers.with_film_spread(values, odds)
    for name in ("fluid_load_sensor", "peak_fluid_pressure"):
        assert found[name] is values[name]
    factors = 1 / (0.4 + 0.6 * np.exp(-odds))
    load = found["fluid_load"]
    assert load.uncertainty == pytest.approx(np.std(20 * factors))
    ends = np.quantile(20 * factors, [0.025, 0.975])
    assert load.interval == pytest.approx(tuple(ends))
    peak = found["peak_fluid_pressure_sensor"]
    assert peak.uncertainty == pytest.approx(math.hypot(np.std(1e4 * factors), 2e3))
    down = math.log(1e4 / np.quantile(1e4 * factors, 0.025))
    assert peak.interval[0] == pytest.approx(1e4 * math.exp(-math.hypot(down, 1.96 * 0.2)))
    up = math.log(np.quantile(factors, 0.975))
    assert peak.interval[1] == pytest.approx(1e4 * math.exp(math.hypot(up, 1.96 * 0.2)))
    for name in ("fluid_load", "normal_force"):
        without = {**values, name: SourcedValue(0.0, "N")}
        assert numbers.with_film_spread(without, odds) == without
    places = np.append(np.zeros(4), np.full(36, 20.0))
    dry = numbers.with_film_spread(values, np.zeros(40), lambda *_: places)
    assert dry["fluid_load"].interval[0] == 0.0
    # what the case states of the load moves its end, and no film bears more than all of it
    stated = {"a": {"whole": np.full(3, math.log(1.1)), "odds": np.full(3, 30.0)}}
    most = numbers.with_film_spread(values, odds, None, stated)["fluid_load"]
    assert most.interval[1] == pytest.approx(55.0)


# before a run


def test_a_check_looks_at_the_pressure_of_a_usual_heel(monkeypatch):
    asked: list[Any] = []

    def breaches(**local):
        asked.append(local)
        return []

    class Law:
        def build(self, context):
            asked.append(context.rough_contact(context))
            return SimpleNamespace(breaches=breaches)

    case = pad({"motion.normal_force": "400 N"})
    monkeypatch.setattr(type(case.friction), "build", Law.build)
    check.case_check(case)
    table, local = asked
    assert table is None
    assert local["contact_pressure"].tolist() == [pytest.approx(2e5)]
    assert local["film_thickness"].tolist() == [1e-5]
    assert local["speed"] == 0.3


@pytest.mark.parametrize(("more", "refused"), [(1, False), (-1, True)])
def test_a_check_refuses_what_needs_more_than_the_memory(more, refused):
    fine = pad({"numerics.grid_spacing": "0.1 mm"})
    least = check.case_check(fine).full.memory + more
    case = fine.replace("numerics.most_memory", f"{least} B")
    assert bool(check.case_check(case).cautions()) is refused


# places


def test_positions_and_grids_of_a_run():
    def grids(case, fine, coarse, *, quick=False):
        changed = case.replace(
            {"numerics.quick_grid_spacing": coarse, "numerics.grid_spacing": fine}
        )
        spacing = changed.numerics.grid_spacing
        every, on_run, of_all = positions._places_on_grids(changed, spacing, quick=quick)
        return len(every), len(on_run), round(1e3 * of_all, 3)

    assert grids(LUGS, "1 mm", "1.26 mm") == (4, 2, 1.26)
    assert grids(LUGS, "1 mm", "1.24 mm") == (4, 4, 1.0)
    assert grids(LUGS, "1 mm", "2 mm", quick=True) == (2, 2, 1.0)
    assert grids(FLAT, "1 mm", "1.26 mm") == (3, 1, 1.26)
    assert grids(FLAT, "1 mm", "1.24 mm") == (3, 3, 1.0)
    assert grids(FLAT, "1 mm", "2 mm", quick=True) == (3, 3, 1.0)
    odd = LUGS.replace("numerics.tread_positions", 5)
    assert [positions.position_count(odd, quick=quick) for quick in (True, False)] == [3, 5]
    one = LUGS.replace("numerics.tread_positions", 1)
    assert [positions.position_count(one, quick=quick) for quick in (True, False)] == [1, 1]


@pytest.mark.parametrize(
    ("change", "quick", "share"),
    [
        ({}, False, 1 + 2 + 4 / 4), ({}, True, 2 + 1),
        ({"numerics.quick_grid_spacing": "1 mm"}, False, 4 + 1),
        ({"motion.duration": "60 ms"}, False, 1 + 2 + 4 / 4 + 1.5 / 4),
        ({"motion.duration": "60 ms"}, True, 2 + 1 + 1.5),
        ({"motion.duration": "60 ms", "contaminant": "none",
          "friction": {"model": "constant", "cof": 0.5}}, False, 1 + 2 + 4 / 4),
        (STEP, False, 1 + 2 + 4 / 4 + 2 + 1.5 / 4),
    ],
)  # fmt: skip
def test_the_share_of_the_first_march_by_hand(change, quick, share):
    """With grids of 1 and 2 mm: a place of the coarse one takes a quarter."""
    case = LUGS.replace(change)
    assert positions.first_share(case, quick=quick) == pytest.approx(1 / share)
    own = positions.cost(
        case, case.numerics.quick_grid_spacing if quick else case.numerics.grid_spacing
    )
    whole = positions.run_cost(case, quick=quick)
    assert whole.seconds == pytest.approx([seconds * share for seconds in own.seconds])
    assert whole.cells == own.cells


def test_a_flat_sole_takes_five_times_as_long_and_bevels_more_angles():
    assert positions.first_share(FLAT, quick=False) == pytest.approx(1 / (1 + 3 / 4))
    assert positions.first_share(FLAT, quick=True) == pytest.approx(1 / 3)
    own, whole = positions.cost(FLAT, 2e-3), positions.run_cost(FLAT, quick=False)
    assert whole.seconds[0] == pytest.approx(5 * own.seconds[0] * 1.75)
    profile = {"model": "facet", "angle": {"value": "5 deg", "assumed": True}, "length": "10 mm"}
    bevel = FLAT.replace("shoe.heel.profile", profile)
    assert positions.first_share(bevel, quick=False) == pytest.approx(1 / (1 + 5 / 4))
    up, down = positions.further_angles(bevel)
    assert math.degrees(up.turn) == pytest.approx(1.5)
    assert down.turn == -up.turn
    assert positions.further_angles(LUGS) == ()
    measured = bevel.replace("shoe.heel.profile.angle", "5 deg")
    assert UncertainBevel.of(measured) is None
    stated = {"value": "5 deg", "uncertainty": "0.5 deg", "assumed": True}
    one = UncertainBevel.of(bevel.replace("shoe.heel.profile.angle", stated))
    assert one is not None
    assert (math.degrees(one.deviation), one.assumed) == (pytest.approx(0.5), False)


def of(**values):
    every = ("fluid_load", "contact_load", "cof_adhesion", "cof_hysteresis", "cof_viscous", "cof")
    given = dict.fromkeys(every, 1.0) | values
    return {name: np.atleast_1d(np.asarray(v, dtype=float)) for name, v in given.items()}


@pytest.mark.parametrize(
    ("coarse", "fine", "onward", "factor"),
    [
        (10.0, 20.0, 0.0, 2.0), (10.0, 20.0, 1.0, 3.0), (20.0, 10.0, 0.0, 0.5),
        (20.0, 10.0, 1.0, 1 / 3), (0.0, 10.0, 1.0, 1.0), (10.0, 0.0, 1.0, 1.0),
        (10.0, 10.0, 1.0, 1.0),
    ],
)  # fmt: skip
def test_numbers_go_on_to_finer_cells_by_their_rule(coarse, fine, onward, factor):
    """The viscous part of a load that stays: by the rule alone."""
    each = of(cof_viscous=4.0)
    found = positions.carry_to_finer(each, of(cof_viscous=coarse), of(cof_viscous=fine), onward)
    assert found["cof_viscous"] == pytest.approx(4.0 * factor)
    assert found["cof"] == pytest.approx(4.0 * factor + 2.0)
    assert found["fluid_load"] == pytest.approx(1.0)
    # other numbers go to the grid of the run, not beyond
    more = {name: np.append(v, v) for name, v in each.items()} | {"peak": np.array([1.0, 2.0])}
    grids = [of() | {"peak": np.array([v])} for v in (coarse, fine)]
    found = positions.carry_to_finer(more, *grids, onward)
    there = fine / coarse if coarse and fine else 1.0
    assert found["peak"] == pytest.approx([there, 2 * there])


def test_film_and_contact_bear_the_load_by_their_odds():
    each = of(fluid_load=[10.0, 30.0], contact_load=[40.0, 20.0], cof_viscous=[1.0, 1.0])
    found = positions.carry_to_finer(
        each, of(fluid_load=10.0, contact_load=40.0), of(fluid_load=20.0, contact_load=30.0), 0.0
    )
    odds = (20 / 30) / (10 / 40)
    film = np.array([10.0, 30.0])
    expected = 50 * film * odds / (film * odds + 50 - film)
    assert found["fluid_load"] == pytest.approx(expected)
    assert found["fluid_load"] + found["contact_load"] == pytest.approx([50.0, 50.0])
    # friction of one newton of contact: its part times the contact that is left
    onto = found["contact_load"] / np.array([40.0, 20.0])
    per_newton = (1.0 * 50) / 30 / ((1.0 * 50) / 40)
    assert found["cof_adhesion"] == pytest.approx(onto * per_newton)


@pytest.mark.parametrize(("slope", "hand"), [(1, -1), (-1, 1)])
def test_walls_of_a_tread_tell_its_hand(monkeypatch, slope, hand):
    x, y = np.meshgrid(np.arange(24), np.arange(24), indexing="ij")
    surface = SimpleNamespace(land=(x - slope * y) % 6 < 3, inside=np.ones((24, 24), bool),
                              x=x[:, 0] * 1.0, y=y[0] - 11.5)  # fmt: skip
    monkeypatch.setattr(positions, "bottom_surface", lambda _: surface)
    assert positions._hand(LUGS) == hand
    even = replace_land(surface, np.ones((24, 24), bool))
    monkeypatch.setattr(positions, "bottom_surface", lambda _: even)
    assert positions._hand(LUGS) == 1
    corner = np.ones((24, 24), bool)
    corner[:5, 19:] = False
    even.inside = corner
    assert positions._hand(LUGS) == 1
    even.inside = corner[:, ::-1]
    assert positions._hand(LUGS) == -1


def replace_land(surface, land):
    return SimpleNamespace(**{**vars(surface), "land": land})


def test_a_place_has_the_numbers_of_its_tread():
    assert TreadPlace() == TreadPlace((0.0, 0.0), 0.0, 0.0, 1)


# soles


def plate(clearance, *, spacing=1e-3, depth=0.0) -> SoleMap:
    clearance = np.asarray(clearance, dtype=float)
    inside = np.isfinite(clearance)
    nx, ny = clearance.shape
    return SoleMap(
        x=spacing * np.arange(nx), y=spacing * np.arange(ny), clearance=clearance, inside=inside,
        land=inside, tread_depth=np.where(inside, depth, 0.0), spacing=spacing,
        outline=np.zeros((4, 2)), breaches=(),
    )  # fmt: skip


def test_springs_of_a_sole_by_hand():
    """k = E / t dA, cells of a mm^2: two of three places bear the load."""
    case = pad({"shoe.material.modulus": "4 MPa", "motion.normal_force": "1 N"})
    depth, area = sole.spring_contact(case, plate([[0.0, 1e-4, 9e-3]]))
    stiffness = 4e6 / case.shoe.sole.thickness * 1e-6
    assert depth == pytest.approx((1.0 / stiffness + 1e-4) / 2)
    assert area == pytest.approx(2e-6)


@pytest.mark.parametrize(("factor", "refused"), [(0.999, False), (1.001, True)])
def test_a_sole_may_be_pressed_to_half_of_its_thickness(factor, refused):
    case = pad({"shoe.material.modulus": "4 MPa"})
    thickness = case.shoe.sole.thickness
    force = factor * 4e6 / thickness * 1e-6 * 0.5 * thickness
    case = case.replace("motion.normal_force", force)
    if refused:
        assert "bottoms out the sole" in refusal(sole.check_load, case, plate([[0.0]]))
    else:
        sole.check_load(case, plate([[0.0]]))


def test_a_map_is_trimmed_to_what_comes_near():
    clearance = np.full((20, 12), 9e-3)
    clearance[8:11, 5:7] = 1e-3
    kept = sole.trim_map(plate(clearance), 1e-3, padding=0.0021)
    assert kept.clearance.shape == (9, 8)
    assert (kept.x[0], kept.y[0]) == pytest.approx((5e-3, 2e-3))
    assert kept.whole.clearance.shape == (20, 12)
    least = sole.trim_map(plate(clearance), 1e-3, padding=0.0)
    assert least.clearance.shape == (5, 4)
    edge = np.full((6, 6), 9e-3)
    edge[0, 0] = 0.0
    assert sole.trim_map(plate(edge), 1e-3, padding=0.002).clearance.shape == (3, 3)


@pytest.mark.parametrize(
    ("call", "within", "beyond"),
    [
        (lambda v: sole.compression_breaches(pad(), v * pad().shoe.sole.thickness), 0.25, 0.251),
        (lambda v: sole.tread_breaches(plate([[0.0]], depth=3e-5), v), 1e-5, 1.01e-5),
        (lambda v: sole.forefoot_breaches(pad({"motion.shoe_angle": f"{v} deg"}), plate([[0.0]])),
         -7.4, -7.6),
        (lambda v: sole.forefoot_breaches(pad({"motion.shoe_angle": f"{v} deg"}), plate([[0.0]])),
         40.0, None),
    ],
)  # fmt: skip
def test_a_range_is_left_beyond_its_end(call, within, beyond):
    assert not call(within)
    if beyond is not None:
        assert call(beyond)
    assert not sole.compression_breaches(pad(), -1.0)
    assert not sole.tread_breaches(plate([[0.0]]), 1.0)
    bent = replace(plate([[0.0]]), joint=object())
    assert sole.forefoot_breaches(pad({"motion.shoe_angle": "-9 deg"}), bent) == []


def test_a_flat_sole_in_a_fluid_has_finer_cells_along():
    flat, lugs = plate(np.zeros((3, 3))), plate(np.zeros((3, 3)), depth=1e-3)
    dry = pad({"contaminant": "none", "friction": {"model": "constant", "cof": 0.5}})
    given = pad({"numerics.cells_along": 4})
    slit = replace(flat, slits=object())
    assert [sole.cells_along(pad(), each) for each in (flat, lugs, slit)] == [8, 1, 1]
    assert sole.cells_along(dry, flat) == 1
    assert sole.cells_along(given, lugs) == 4


def test_rolls_of_a_motion_are_a_degree_apart_at_most():
    assert sole.rolls(pad()).tolist() == [0.0]
    turned = np.degrees(sole.rolls(pad(STEP, {"motion.shoe_angle": "2.5 deg"})))
    assert (turned[0], turned[-1]) == pytest.approx((-0.5, 3.5))
    assert 0.7 < np.diff(turned).min() <= np.diff(turned).max() < 1.0001


def test_a_worn_sole_whose_contact_fails_says_so(monkeypatch):
    state = SimpleNamespace(status=Status.NOT_CONVERGED, residuals=(1.0,))
    monkeypatch.setattr(sole, "solve_sliding", lambda *_, **__: state)
    shape = sole.new_sole(pad())
    context = sole.resolve_context(pad())
    with pytest.raises(ConvergenceError, match="did not converge"):
        sole._dry_contact(pad(), context, shape, 0.05, 50.0)
    good = SimpleNamespace(status=Status.CONVERGED, contact_pressure="p")
    asked: list[Any] = []
    monkeypatch.setattr(sole, "solve_sliding", lambda *_, **options: asked.append(options) or good)
    made, pressure = sole._dry_contact(pad(), context, shape, 0.05, 60.0)
    assert pressure == "p"
    assert made.spacing == 4e-3
    assert asked[0]["normal_force"] == 60.0
    assert asked[0]["viscosity"] is None
    assert asked[0]["settings"].tolerance == 1e-7


def test_the_front_of_what_lands_first_lies_between_two_cells(monkeypatch):
    x = np.arange(6) * 1e-2
    height = np.array([0.0, 0.0, 0.0, 0.05e-3, 0.25e-3, 1e-3])
    monkeypatch.setattr(sole, "tread_on_sole", lambda _: (None, None, x, height))
    case = pad({"motion.shoe_angle": "0 deg"})
    # 0.1 mm above the lowest quarter (0): a quarter of the way from 0.05 to 0.25 mm
    assert sole.landing_front(case) == pytest.approx(3.25e-2)
    monkeypatch.setattr(sole, "tread_on_sole", lambda _: (None, None, x, np.full(6, np.nan) * 0))
    height[-1] = np.nan
    monkeypatch.setattr(sole, "tread_on_sole", lambda _: (None, None, x, height))
    assert sole.landing_front(case) == pytest.approx(3.25e-2)


def test_errors_join_by_squares():
    grid, time = {"cof": 0.03, "fluid_load": 3.0}, {"cof": 0.04}
    errors = NumericalErrors(grid, time, Message("why"))
    assert errors.deviation("cof") == pytest.approx(0.05)
    assert errors.deviation("fluid_load") == pytest.approx(3.0)
