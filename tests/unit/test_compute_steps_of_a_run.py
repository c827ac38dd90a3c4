"""What a run takes down, how steady it is, and what it asks to be solved: small worlds by hand."""

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from underfoot.case import load
from underfoot.compute import histories, positions, read, sole, solve, steadiness
from underfoot.compute.contact_friction import _on_squares, film_warmth, leak_name
from underfoot.compute.position_draws import TreadPlace
from underfoot.compute.positions import TURNED, carry_to_finer, tread_positions
from underfoot.compute.steadiness import _least, settling_time, with_steadiness
from underfoot.core import ConvergenceError, InputError, SourcedValue
from underfoot.friction import FrictionParts
from underfoot.rough_contact import TabulatedLaw

CASE = load(Path(__file__).parents[2] / "examples" / "work_shoe_full_tread_glycerol.toml")


def fake(**parts) -> Any:
    return SimpleNamespace(**parts)


def scalar(value, unit="1"):
    return SourcedValue(value, unit, source="made up")


# the sole under its load


@pytest.mark.parametrize("force", [10.0, 100.0])
def test_springs_of_the_land_bear_the_load_at_their_approach(monkeypatch, force):
    monkeypatch.setattr(sole, "youngs_modulus", lambda _: (scalar(4e6, "Pa"),))
    case = CASE.replace("motion.normal_force", f"{force} N")
    heights = 1e-4 * np.arange(20.0).reshape(4, 5)
    land = np.ones((4, 5), bool)
    land[0, 0] = False  # the lowest is no land
    made = fake(clearance=heights, land=land, spacing=2e-3)
    depth, area = sole.spring_contact(case, made)
    pressed = np.maximum(depth - heights[land], 0)
    stiffness = 4e6 / case.shoe.sole.thickness * 4e-6
    assert stiffness * pressed.sum() == pytest.approx(force)
    assert area == pytest.approx(np.count_nonzero(pressed) * 4e-6)
    thick = case.shoe.sole.thickness
    for share, refused in ((0.99, False), (1.01, True)):
        there = share * sole.BOTTOMED * thick
        monkeypatch.setattr(sole, "spring_contact", lambda *_, d=there: (d, 1e-4))
        if refused:
            with pytest.raises(InputError, match="bottoms out"):
                sole.check_load(case, made)
        else:
            sole.check_load(case, made)


def test_what_lies_beyond_a_sole_is_told(monkeypatch):
    thick = CASE.shoe.sole.thickness
    most = sole.LINEAR_STRAIN.high
    for strain, beyond in ((0.99, 0), (1.01, 1), (-1.0, 0)):
        assert len(sole.compression_breaches(CASE, strain * most * thick)) == beyond
    depth = fake(tread_depth=np.array([0.0, 3e-3]))
    for rq, beyond in ((0.99e-3, 0), (1.01e-3, 1)):
        assert len(sole.tread_breaches(depth, rq)) == beyond
    assert sole.tread_breaches(fake(tread_depth=np.zeros(3)), 1.0) == []
    assert sole.forefoot_breaches(CASE, fake(joint="bends")) == []


# steadiness


def contact(time, film, force=500.0):
    return fake(history=fake(time=time, fluid_load=film), normal_force=force)


def test_a_film_has_settled_when_its_load_stays_within_a_hundredth():
    time = np.linspace(0, 2, 201)
    film = 100 + 50 * np.exp(-time / 0.2)
    found = settling_time(contact(time, film))
    assert found == pytest.approx(0.2 * math.log(50 / 1.0), rel=0.03)
    still = settling_time(contact(np.array([0.1, 0.2]), np.array([100.0, 100.5])))
    assert still == 0.1
    # one step that ends: an implicit Euler step of the memory that its ends tell
    jump = settling_time(contact(np.array([0.0, 1.0, 2.0]), np.array([150.0, 100.2, 100.0])))
    memory = 1.0 * 0.2 / (50 - 0.2)
    assert jump == pytest.approx(memory * math.log(50 / 1.0))
    last = settling_time(contact(np.array([0.0, 1.0]), np.array([102.0, 100.0])))
    assert 0 <= last <= 1


@pytest.mark.parametrize(
    ("film", "least"), [(100.0, 1.0), (400.0, 1.0), (0.0, 0.05), (500.0, 0.05), (3.0, 0.05)]
)
def test_loads_on_a_film_differ_from_a_hundredth_of_it_or_of_the_rest(film, least):
    assert _least(film, 500.0) == pytest.approx(least)


@pytest.mark.parametrize(
    ("cof", "film", "moves"),
    [(0.2, 100.0, False), (0.2019, 100.9, False), (0.2021, 100.0, True), (0.1979, 100.0, True),
     (0.2, 101.1, True), (0.2, 98.9, True)],
)  # fmt: skip
def test_a_later_answer_is_told_where_it_is_another(cof, film, moves):
    values = {"cof": scalar(0.2), "fluid_load": scalar(100.0, "N"),
              "normal_force": scalar(500.0, "N"), "later_cof": scalar(cof),
              "later_fluid_load": scalar(film, "N"), "later_time": scalar(2.0, "s")}  # fmt: skip
    found = with_steadiness(values)
    assert ("later_cof" in found) is ("later_time" in found) is moves
    assert {"cof", "fluid_load", "normal_force"} <= set(found)
    assert with_steadiness({"cof": scalar(0.2)}) == {"cof": scalar(0.2)}


def test_a_march_to_the_steady_state_tells_how_far_it_slid(monkeypatch):
    monkeypatch.setattr(steadiness, "settling_time", lambda _: 0.4)
    parts = fake(viscosity=0.2, case=fake(motion=fake(end_time=None, speed=0.3)))
    assert steadiness.steady_slide(parts, fake())["steady_slide"].value == pytest.approx(0.12)
    parts.viscosity = None
    assert steadiness.steady_slide(parts, fake()) == {}
    assert steadiness.later_numbers(parts, fake()) == {}


# what is taken down


def recorder(monkeypatch, *, end, follows=False, size=4, read_of=None):
    case = fake(motion=fake(end_time=end, build=lambda: "history" if follows else None),
                sensor=fake(array=None))  # fmt: skip
    made = histories.Recorder(case, fake(), fake(), 0.2)
    sums = {name: scalar(k / 10) for k, name in enumerate(histories.COF_WORDS, start=1)}
    monkeypatch.setattr(histories, "friction_sums", lambda *_: fake(**sums))
    monkeypatch.setattr(histories, "contact_area", lambda _: 1e-4)
    reading = fake(load=scalar(5.0, "N"), peak_pressure=scalar(7.0, "Pa"))
    monkeypatch.setattr(histories, "scan_reading", lambda *_, **__: reading)
    return made


def state(time, *, speed=0.5, size=4):
    cells = np.zeros((size, 2))
    cells[1] = 3.0
    cells[2] = 1.0
    pressure = np.full((size, 2), 1234.0)
    return fake(time=time, speed=speed, cell_load=cells, x=np.arange(float(size)),
                contact_pressure=pressure, fluid_pressure=2 * pressure)  # fmt: skip


def test_a_recorder_knows_where_the_shoe_is_and_where_its_load_lies(monkeypatch):
    made = recorder(monkeypatch, end=2.4)
    for time in (0.1, 0.3, 0.35, 0.6):
        made(state(time))
    assert made.places == pytest.approx([0.05, 0.15, 0.175, 0.3])
    assert made.centre_of_pressure == pytest.approx([1.25] * 4)
    assert made.cof["cof"] == [0.1] * 4
    # read once in 0.1 s
    assert made.sensor_load == pytest.approx([5, 5, math.nan, 5], nan_ok=True)
    assert made.sensor_peak == pytest.approx([7, 7, math.nan, 7], nan_ok=True)
    assert made.array_scalars() == {}
    assert made.pictures[0][1]["contact_pressure"][0, 0] == 1200
    assert made.pictures[-1][1]["fluid_pressure"][0, 0] == 2500


@pytest.mark.parametrize(("follows", "most"), [(True, 26), (False, 12)])
def test_as_many_pictures_are_kept_as_are_shown_the_first_and_the_newest_too(
    monkeypatch, follows, most
):
    made = recorder(monkeypatch, end=1.0, follows=follows)
    times = np.linspace(0.01, 1.0, 100)
    for time in times:
        made(state(time))
    kept = [time for time, _ in made.pictures]
    assert len(kept) <= most
    assert len(kept) > (20 if follows else 5)
    assert (kept[0], kept[-1]) == (pytest.approx(0.01), pytest.approx(1.0))
    assert (np.diff(kept) > 0).all()
    monkeypatch.setattr(histories, "PICTURED_CELLS", 5 * 8)
    few = recorder(monkeypatch, end=None)
    for time in times:
        few(state(time))
    assert len(few.pictures) <= 5


# places on two grids


PATTERN = {"fluid_load": 100.0, "contact_load": 400.0, "cof": 0.2, "cof_adhesion": 0.12,
           "cof_hysteresis": 0.05, "cof_viscous": 0.03}  # fmt: skip


def test_what_grows_with_finer_cells_is_carried_on_evenly_and_its_parts_bear_the_load():
    def arrays(**changes):
        return {name: np.array([value]) for name, value in (PATTERN | changes).items()}

    each, coarse = arrays(), arrays()
    fine = arrays(fluid_load=120.0, contact_load=380.0)
    same = carry_to_finer(each, coarse, fine, 0.0)
    odds = 120 / 380 / (100 / 400)
    film = 500 * (0.25 * odds) / (1 + 0.25 * odds)
    assert same["fluid_load"] == pytest.approx([film])
    assert same["fluid_load"] + same["contact_load"] == pytest.approx([500])
    beyond = carry_to_finer(each, coarse, fine, 0.5)
    step = odds + 0.5 * (odds - 1)
    assert beyond["fluid_load"] == pytest.approx([500 * 0.25 * step / (1 + 0.25 * step)])
    assert beyond["cof"] == pytest.approx(
        beyond["cof_adhesion"] + beyond["cof_hysteresis"] + beyond["cof_viscous"]
    )
    less = carry_to_finer(each, fine, coarse, 0.5)  # of what shrinks the inverse grows evenly
    step = 1 / odds / (1 + 0.5 * (1 - 1 / odds))
    assert less["fluid_load"] == pytest.approx([500 * 0.25 * step / (1 + 0.25 * step)])
    none = carry_to_finer(each, arrays(fluid_load=0.0), fine, 0.5)
    assert none["fluid_load"] == pytest.approx([100])


@pytest.mark.parametrize("turned", [True, False])
def test_what_the_angle_adds_is_half_of_what_toe_up_and_toe_down_differ_by(monkeypatch, turned):
    monkeypatch.setattr(positions, "has_lugs", lambda _: True)
    monkeypatch.setattr(positions, "remembers", lambda _: False)
    monkeypatch.setattr(positions, "further_angles", lambda _: ())
    monkeypatch.setattr(positions, "tread_on_sole", lambda _: ([1],))
    where = TreadPlace(), TreadPlace((1e-3, 0.0))
    monkeypatch.setattr(positions, "_places_on_grids", lambda *_, **__: (where, where[:1], 1e-3))
    monkeypatch.setattr(positions.UncertainBevel, "of", lambda _: None)
    up, down = (PATTERN | {"cof": cof, "fluid_load": film, "contact_load": 500 - film}
                for cof, film in ((0.22, 140.0), (0.16, 80.0)))  # fmt: skip
    numbers = {(TURNED[0], 5e-4): up, (TURNED[1], 5e-4): down if turned else None,
               (where[0], 1e-3): PATTERN, (where[1], 1e-3): PATTERN}  # fmt: skip
    asked_for = []

    def at_places(asked):
        asked_for.extend(asked)
        yield from ((k, numbers[one]) for k, one in enumerate(asked))

    found = tread_positions(CASE, {TreadPlace(): PATTERN}, at_places, spacing=5e-4, quick=False)
    assert asked_for == list(numbers)
    assert found.left_out == 0
    if not turned:
        assert (found.by_angle, found.film_by_angle) == ({}, 0.0)
        return
    assert found.by_angle["cof"] == pytest.approx(0.03)
    assert found.by_angle["fluid_load"] == pytest.approx(30)
    odds = [math.log(film / (500 - film)) for film in (140, 80)]
    assert found.film_by_angle == pytest.approx((odds[0] - odds[1]) / 2)
    assert found.answer("cof") == pytest.approx(0.2)


# what is solved


def test_a_stated_spread_takes_its_share_of_the_work_and_a_pool_its_landing():
    wet = CASE.replace("motion.start_film", None) if CASE.motion.start_film else CASE
    steady = solve.SolverSettings().start_film
    assert solve.start_film(wet, steady=True) == steady
    assert solve.start_film(wet, steady=False) == min(solve.pool_depth(wet), 0.2e-3)
    given = wet.replace("motion.start_film", "0.05 mm")
    assert solve.start_film(given, steady=True) == solve.start_film(given, steady=False) == 5e-5
    usual = solve.SolverSettings().time_resolution
    assert solve.solver_settings(wet, finer=3).time_resolution == pytest.approx(3 * usual)
    film = fake(fluid_load=100.0, normal_force=500.0)
    assert solve.film_odds(film) == pytest.approx(math.log(0.25))
    assert solve._mean([]) is None
    assert solve._mean([{"a": 1.0, "b": 2.0}, {"a": 3.0}]) == {"a": 2.0}


@pytest.mark.parametrize(
    ("changes", "spread"),
    [({}, True), ({"film": 0.0}, False), ({"film": 500.0}, False), ({"film": 0.4}, False),
     ({"usable": False}, False), ({"given": True}, False), ({"fails": True}, False),
     ({"deviation": 0.0}, False)],
)  # fmt: skip
def test_how_unknown_a_film_is_is_solved_with_more_and_less_of_what_leaks(
    monkeypatch, changes, spread
):
    found = {"film": 100.0, "usable": True, "given": False, "fails": False, "deviation": 0.5} | (
        changes
    )
    state = fake(fluid_load=found["film"], normal_force=500.0,
                 status=fake(usable=found["usable"]))  # fmt: skip
    factors = []

    class Parts:
        objects = {"rough_contact": 1} if found["given"] else {}
        film, asperities, case, spacing = "film", "own", CASE, 1e-3
        context = fake(leak_deviation=found["deviation"])

        def on(self, asperities):
            return asperities

    def continued(start, law, **_):
        if found["fails"]:
            raise ConvergenceError("no", history=[])
        load = {"own": 110.0}.get(law) or 110.0 * law
        return [fake(), fake(fluid_load=load, normal_force=500.0, status=fake(usable=True))]

    def leaking(parts, factor):
        factors.append(factor)
        return factor

    monkeypatch.setattr(solve, "micro_contact", lambda *_: None)
    monkeypatch.setattr(solve, "continue_contact", continued)
    monkeypatch.setattr(solve, "_leaking", leaking)
    told = solve.film_spreads(Parts(), state)  # type: ignore[arg-type]
    assert bool(told) is spread
    if spread:
        assert factors == pytest.approx([math.exp(-0.5), math.exp(0.5)])
        ends = [math.log(110 * f / (500 - 110 * f)) - math.log(110 / 390) for f in factors]
        assert told == {solve.LEAK: pytest.approx(tuple(ends))}


def test_gap_and_flow_of_measured_surfaces_have_each_their_two_ends(monkeypatch):
    """A film that bears 100 N times the gap times the root of the flow, of what was measured."""
    gaps, loads = np.array([1e-6, 2e-6, 4e-6]), np.array([1e6, 1e5, 1e4])
    law = TabulatedLaw("a", "b", gaps, loads, np.array([0.2, 0.4, 0.4]))

    parts = fake(objects={}, film="film", asperities=law, case=CASE, spacing=1e-3,
                 context=fake(leak_deviation=0.0), on=lambda asperities: asperities)  # fmt: skip

    def continued(start, changed, **_):
        gap, flow = changed.gap[0] / gaps[0], changed.node_flow_factor[0] / 0.2
        load = 100.0 * gap * math.sqrt(flow)
        return [fake(), fake(fluid_load=load, normal_force=500.0, status=fake(usable=True))]

    monkeypatch.setattr(
        solve, "micro_contact", lambda *_: fake(gap_deviation=0.1, flow_deviation=0.2)
    )
    monkeypatch.setattr(solve, "continue_contact", continued)
    state = fake(fluid_load=90.0, normal_force=500.0, status=fake(usable=True))
    spreads = solve.film_spreads(parts, state)
    for name, factor in ((solve.GAP, 1.1), (solve.FLOW, math.sqrt(1.2))):
        ends = (100.0 / factor, 100.0 * factor)
        moves = [math.log(end / (500 - end)) - math.log(100 / 400) for end in ends]
        assert spreads[name] == pytest.approx(moves)
    assert set(spreads) == {solve.GAP, solve.FLOW}


@pytest.mark.parametrize("fails", [True, False])
def test_a_shoe_is_turned_up_and_down_where_its_contact_goes_on(monkeypatch, fails):
    turns = []

    def continued(start, parts, turn):
        turns.append(turn)
        if fails:
            raise ConvergenceError("no", history=[])
        return ["first", turn]

    monkeypatch.setattr(solve, "continue_contact", continued)
    monkeypatch.setattr(solve, "place_numbers", lambda parts, end: {"end": end})
    parts = fake(case=fake(motion=fake(build=lambda: None)))
    found = solve._turn_and_solve(parts, fake())
    if fails:
        assert found == {}
        return
    assert turns == [place.turn for place in TURNED]
    assert found == {place: {"end": place.turn} for place in TURNED}
    parts.case.motion.build = lambda: "history"
    assert solve._turn_and_solve(parts, fake()) == {}


@pytest.mark.parametrize("processes", [1, 3])
def test_places_are_solved_one_after_the_other_or_in_processes(monkeypatch, processes):
    asked = [(TreadPlace(), 1e-3), (TreadPlace((1e-3, 0.0)), 2e-3)]
    shares, in_several = [], []

    def positions_of(case, known, at_places, *, spacing, quick):
        return dict(at_places(asked)), known, spacing, quick

    def numbers_at(parts, place, spacing, progress):
        progress("solving", 0.0)
        progress("solving", 1.0)
        return {"at": place.shift[0] + spacing}

    def several(work, asked, count, **_):
        in_several.append(count)
        return ((k, {"at": k}) for k, _ in enumerate(asked))

    for name, made in (
        ("tread_positions", positions_of), ("_numbers_at", numbers_at), ("in_processes", several),
        ("place_numbers", lambda *_: "own"), ("has_lugs", lambda _: True),
        ("_turn_and_solve", lambda *_: {"turned": 1}), ("position_count", lambda *_, **__: 2),
    ):  # fmt: skip
        monkeypatch.setattr(solve, name, made)
    parts = fake(case=CASE, objects={}, spacing=1e-3)
    solution = fake(contact=fake(status=fake(usable=True)))

    def told(stage, fraction, residual=None):
        shares.append((stage, fraction))

    answer: Any = solve.average_positions(
        parts, solution, quick=True, processes=processes, progress=told
    )
    found, known, spacing, quick = answer
    assert known == {TreadPlace(): "own", "turned": 1}
    assert (spacing, quick) == (1e-3, True)
    if processes > 1:
        assert in_several == [3]
        return
    assert found == {0: {"at": 1e-3}, 1: {"at": 3e-3}}
    assert [share for _, share in shares] == pytest.approx([0, 0.8, 0.8, 1.0])  # 4 : 1
    assert "2 of 3" in shares[0][0]
    for changes in ({"objects": {"compliance": 1}}, {}):
        if not changes:
            monkeypatch.setattr(solve, "position_count", lambda *_, **__: 1)
        assert solve.average_positions(fake(**vars(parts) | changes), solution, quick=True) is None


# friction of a contact


def test_squares_have_the_mean_of_their_cells_and_the_viscous_part_of_the_wet_ones():
    square, area = np.array([0, 0, 3]), np.array([0.25, 0.25, 0.5])
    wet = np.array([True, False, True])
    at = fake(square=square, area=area, wet=wet)
    on = fake(areas={"area": np.array([[0.5, 1.0], [1.0, 0.5]])})
    stress = FrictionParts(*(k * np.array([1.0, 2.0, 4.0]) for k in (1, 10, 100)))
    found = _on_squares(stress, at, on)
    assert found.adhesion == pytest.approx(np.array([[1.5, 0], [0, 4]]))
    assert found.hysteresis == pytest.approx(np.array([[15, 0], [0, 40]]))
    assert found.viscous == pytest.approx(np.array([[50, 0], [0, 400]]))


def test_a_film_is_warmed_by_the_laboratory_and_thins_by_it():
    cells = fake(total_pressure=np.ones((4, 5)), spacing=1e-3)
    context = fake(viscosity_value=None)
    assert film_warmth(CASE, context, 0.2, cells, film_share=0.5, samples=10) is None
    context = fake(viscosity_value=0.2)
    cold = film_warmth(CASE, context, 0.0, cells, film_share=0.5, samples=4000)
    warm = film_warmth(CASE, context, 0.5, cells, film_share=0.5, samples=4000)
    assert cold is not None
    assert warm is not None
    assert cold.mean() == pytest.approx(0, abs=0.05 * cold.std() + 1e-3)
    assert (warm < cold + 1e-12).all()
    assert warm.mean() < cold.mean()


def test_a_leak_is_named_after_both_roughnesses():
    def side(rq):
        return fake(roughness=fake(rq_or_estimate=rq))

    context = fake(shoe=side(1e-6), floor=side(2e-6))
    other = fake(shoe=side(2e-6), floor=side(1e-6))
    assert leak_name(context) != leak_name(other)
    assert leak_name(context) == leak_name(fake(shoe=side(1e-6), floor=side(2e-6)))
    assert leak_name(fake(shoe=side(None), floor=side(1e-6))).count(" 0 m") == 1


def test_the_last_instant_of_a_motion_says_when_and_from_where():
    endless = fake(motion=fake(build=lambda: None, end_time=None))
    assert read._last_instant(endless) == ""
    history = fake(shoe_angle=np.array([0.3, 0.1]), speed=np.array([0.5, 0.0]),
                   normal_force=np.array([50.0, 500.0]))  # fmt: skip
    motion = fake(build=lambda: history, end_time=0.4, start_film=1e-4, force_rise_time=1.0)
    case = fake(motion=motion, contaminant=fake(pool_depth=1e-3))
    said = read._last_instant(case)
    for words in ("400 ms", "5.7", "at rest", "100 um", "50 N"):
        assert words in said, (words, said)
    history.shoe_angle = np.array([0.1, 0.1])
    history.speed = np.array([0.5, 0.3])
    history.normal_force = np.array([0.0, 500.0])
    plain = read._last_instant(case)
    for words in ("5.7", "at rest", "50 N"):
        assert words not in plain
    case.contaminant = None
    assert "touch-down" not in read._last_instant(case)


# which places


@pytest.mark.parametrize(
    ("lugs", "quick", "coarse", "grid", "own"),
    [(True, False, 2e-3, 2e-3, ["a", "c"]), (True, True, 2e-3, 1e-3, ["a", "b", "c"]),
     (True, False, 1e-3, 1e-3, ["a", "b", "c"]), (False, False, 2e-3, 2e-3, ["x"]),
     (False, True, 2e-3, 1e-3, ["x", "y", "z"]), (False, False, 1e-3, 1e-3, ["x", "y", "z"])],
)  # fmt: skip
def test_every_other_place_and_the_own_angle_alone_are_solved_on_the_grid_of_the_run(
    monkeypatch, lugs, quick, coarse, grid, own
):
    monkeypatch.setattr(positions, "has_lugs", lambda _: lugs)
    monkeypatch.setattr(positions, "case_places", lambda case, *, quick: ("a", "b", "c"))
    monkeypatch.setattr(positions, "shoe_angles", lambda: ("x", "y", "z"))
    case = fake(numerics=fake(quick_grid_spacing=coarse))
    every, on_run, on = positions._places_on_grids(case, 1e-3, quick=quick)
    assert list(every) == (["a", "b", "c"] if lugs else ["x", "y", "z"])
    assert (list(on_run), on) == (own, grid)


def test_a_mirrored_sole_has_the_other_hand(monkeypatch):
    """By the lean of its lugs; where these hardly lean, by its plan form."""
    x, y = np.arange(40.0), np.arange(-20.0, 20) + 0.5
    inside = np.ones((40, 40), bool)

    def hand(land, inside=inside):
        surface = fake(land=land, inside=inside, x=x, y=y)
        monkeypatch.setattr(positions, "bottom_surface", lambda _: surface)
        return positions._hand(fake())

    i, j = np.indices((40, 40))
    bars = (i + j) % 10 < 5  # their walls run along x + y = const.
    assert hand(bars) == 1
    assert hand(bars[:, ::-1]) == -1
    # lugs without a lean on a sole that widens to one side
    square = (i % 10 < 5) & (j % 10 < 5)
    form = (y[None, :] < 5) | (x[:, None] > 20)
    assert hand(square, form) == -hand(square[:, ::-1], form[:, ::-1])
    assert hand(square, form) == 1
    few = square.copy()
    few[3:6, 35] = few[4:6, 36] = True  # a corner of one lug alone leans
    assert hand(few, form) == 1
    assert hand(few[:, ::-1], form[:, ::-1]) == -1


@pytest.mark.parametrize(("share", "stated"), [(0.0099, False), (0.0101, True), (0.2, True)])
def test_a_viscosity_is_solved_for_from_a_spread_of_a_hundredth_on(monkeypatch, share, stated):
    from underfoot.compute import stated_spreads

    viscosity = SourcedValue(0.2, "Pa s", uncertainty=0.2 * share)
    fluid = fake(build=lambda: viscosity, chemistry="oil", pool_depth=1e-3)
    monkeypatch.setattr(stated_spreads, "_of_viscosity", lambda _: ())
    monkeypatch.setattr(stated_spreads, "stated_paths", lambda _: ())
    found = stated_spreads.stated_spreads(fake(contaminant=fluid))
    assert [spread.path for spread in found] == [stated_spreads.VISCOSITY] * stated
    for spread in found:
        less, more = (float(each["contaminant"]["viscosity"]) for each in spread.changes)  # type: ignore
        assert less < 0.2 < more
        assert more - less == pytest.approx(0.4 * share, rel=0.05)
    assert stated_spreads.stated_spreads(fake(contaminant=None)) == ()
