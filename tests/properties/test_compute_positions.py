"""The answer of a treaded sole: averaged over where its pattern lies."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.case import Case, CaseError
from underfoot.compute import numerical_error, solve
from underfoot.compute.position_draws import (
    ANGLE_BAND,
    ANGLE_DEVIATION,
    COF_PARTS,
    ShoeAngles,
    TreadPlace,
    TreadPositions,
)
from underfoot.compute.positions import (
    YAW,
    carry_to_finer,
    case_places,
    places,
    position_count,
    run_cost,
    shoe_angles,
    tread_positions,
)
from underfoot.compute.run import run
from underfoot.compute.sole import sole_map
from underfoot.compute.solve import solved_at
from underfoot.compute.summary import cautions
from underfoot.core import ConvergenceError, SourcedValue, Status
from underfoot.friction.coefficient import FrictionCoefficients
from underfoot.friction.sampled_cof import LawDraws, SampledCof
from underfoot.shoe import Sipes, Tread
from underfoot.shoe.tread import PATTERNS

MM = 1e-3
PITCH = 10.0
FURTHER = {
    "blocks": {"lug_length": 9 * MM},
    "chevrons": {"arm_length": 11 * MM},
    "waves": {"wave_length": 13 * MM, "wave_height": 5 * MM},
    "rings": {"ring_width": 1.5 * MM},
    "graded_circles": {"front_lug_width": 5 * MM, "graded_length": 60 * MM},
}
POINTS = np.meshgrid(np.linspace(-0.04, 0.08, 41), np.linspace(-0.04, 0.04, 37))


@pytest.fixture(scope="module")
def bars():
    """Bars of 6 mm with channels of 4 mm under the bevel of a heel, on coarse cells."""
    case = Case.load("examples/work_shoe_full_tread_glycerol.toml")
    bars = {"pattern": "bars", "depth": "3 mm", "lug_width": "6 mm", "channel_width": "4 mm"}
    return case.replace({"shoe.tread": bars, "shoe.heel.width": "66 mm"})


@pytest.mark.slow
@settings(deadline=None)
@given(
    st.sampled_from([name for name in PATTERNS if name != "lettering"]),  # it needs a text
    st.floats(-1.2, 1.2),
    st.tuples(st.floats(-0.02, 0.02), st.floats(-0.02, 0.02)),
)
def test_a_pattern_repeats_after_each_period(pattern, angle, offset):
    tread = Tread(
        pattern,
        6 * MM,
        4 * MM,
        3 * MM,
        offset=offset,
        angle=angle,
        **FURTHER.get(pattern, {}),
    )
    at = tread.channel_distance(*POINTS)
    for period in tread.periods:
        moved = tread.shift_grooves((float(period[0]), float(period[1])))
        assert moved.channel_distance(*POINTS) == pytest.approx(at, abs=1e-9)


@given(st.integers(2, 16), st.integers(1, 15))
def test_even_positions_are_the_same_from_any_of_them(count, step):
    """Moved by whole parts of a pitch, bars are averaged over the same positions."""
    period = np.array([[PITCH, 0.0]])
    x = np.array([place.shift[0] for place in places(period, count)])
    moved = np.mod(x + PITCH * (step % count) / count + 1e-9, PITCH) - 1e-9
    assert np.sort(moved) == pytest.approx(np.sort(x), abs=1e-6)


@given(st.integers(1, 64))
def test_positions_cover_both_directions_evenly_at_the_angle_of_the_case(count):
    found = places(np.eye(2), count)
    assert found[0] == TreadPlace()
    assert len({place.shift[0] for place in found}) == count
    assert not any(place.turn for place in found)
    for wave in ((1, 0), (0, 1)) if count > 1 else ():
        phase = np.array([place.shift for place in found]) @ wave
        assert abs(np.exp(2j * math.pi * phase).mean()) < 1e-9


@pytest.mark.parametrize("count", [4, 6, 8, 12])
def test_rows_of_a_triangular_lattice_meet_a_line_at_places_of_their_own(count):
    """Every other row lies half a pitch on: the places must not fall on each other across."""
    pitch, row = 9.5, 9.5 * math.sqrt(3) / 2
    found = places(np.array([[pitch, 0.0], [pitch / 2, row]]), count)
    lines = np.mod([place.shift[0] for place in found], pitch / 2)
    assert len(np.unique(lines.round(6) % (pitch / 2))) >= count / 2
    for wave in ((1, 0), (0, 1), (1, 1), (2, 1)):  # those that run along the shoe
        shares = np.array([place.shift for place in found]) @ np.linalg.inv(
            np.array([[pitch, 0.0], [pitch / 2, row]])
        )
        assert abs(np.exp(2j * math.pi * shares @ wave).mean()) < 1e-9, wave


@given(st.integers(3, 16), st.floats(0, 6.28), st.sampled_from([1, 2]))
def test_waves_of_the_position_leave_no_error(count, phase, harmonic):
    bars = places(np.array([[1.0, 0.0]]), count)
    wave = np.cos([2 * math.pi * harmonic * place.shift[0] + phase for place in bars])
    assert wave.mean() == pytest.approx(0.0, abs=1e-12)


@given(st.floats(0, 1), st.integers(2, 16))
def test_the_error_of_the_mean_covers_a_saw_tooth(corner, count):
    """What the film is in the position of bars: the error stated holds the mean within two."""
    at = np.array([place.shift[0] for place in places(np.array([[1.0, 0.0]]), count)])
    teeth = np.mod(at + corner, 1)
    stated = np.std(teeth, ddof=1) / count ** numerical_error.RATES[1]
    assert abs(teeth.mean() - 0.5) < 2 * stated + 1e-12


@given(
    st.lists(st.floats(0.5, 80), min_size=3, max_size=8),
    st.floats(1.0, 3.0),
    st.floats(0, 3),
    st.booleans(),
)
def test_numbers_of_two_grids_are_carried_on_by_the_first_order_of_the_cells(
    values, grows, onward, shrinks
):
    """A number a + b h on cells h, or 1 / (a + b h) where it shrinks, is found on any cells."""
    coarse = np.array(values)
    fine = coarse / grows if shrinks else coarse * grows
    even = 1 / (grows + onward * (grows - 1)) if shrinks else grows + onward * (grows - 1)

    def numbers(film, adhesion, peak):
        whole, zero = np.full_like(coarse, 300.0), np.zeros_like(coarse)
        parts = {"cof_adhesion": adhesion, "cof_hysteresis": zero, "cof_viscous": peak}
        loads = {"fluid_load": film, "contact_load": whole - film}
        return {"cof": adhesion + peak, **parts, **loads, "peak": peak}

    contact = 0.2 * (300.0 - coarse) / 300.0
    before = numbers(coarse, contact, coarse)
    same = carry_to_finer(before, before, before, onward)
    for name, each in before.items():
        assert same[name] == pytest.approx(each), name
    found = carry_to_finer(before, before, numbers(coarse, contact, fine), onward)
    assert found["cof_viscous"] == pytest.approx(coarse * even)
    assert found["peak"] == pytest.approx(fine)  # not carried on
    assert found["cof"] == pytest.approx(found["cof_adhesion"] + found["cof_viscous"])
    film = np.minimum(fine, 299.0)
    loads = carry_to_finer(before, before, numbers(film, 0.2 * (1 - film / 300.0), coarse), onward)
    assert loads["fluid_load"] + loads["contact_load"] == pytest.approx(300.0)
    assert ((loads["fluid_load"] >= 0) & (loads["fluid_load"] <= 300.0)).all()
    # the contact has the friction that its newtons have, however many the film takes
    assert loads["cof_adhesion"] == pytest.approx(0.2 * loads["contact_load"] / 300.0)
    odds = [(each.mean() / (300 - each.mean())) for each in (coarse, film)]
    moved = np.sign(np.round(loads["fluid_load"] - coarse, 9))
    assert (moved == np.sign(np.round(odds[1] - odds[0], 12))).all()


def test_a_place_where_all_floats_says_nothing_of_the_friction_of_a_contact():
    """A factor of COF from there would carry 0.2 of adhesion to 40 where the shoe touches."""
    floats, touches = np.array([299.9]), np.array([0.0])
    zero = np.zeros(1)

    def numbers(film):
        adhesion = 0.2 * (300.0 - film) / 300.0
        parts = {"cof_adhesion": adhesion, "cof_hysteresis": zero, "cof_viscous": zero}
        return {"cof": adhesion, **parts, "fluid_load": film, "contact_load": 300.0 - film}

    before = {name: np.append(a, b) for (name, a), b in zip(
        numbers(floats).items(), numbers(touches).values(), strict=True)}  # fmt: skip
    fine = numbers(np.array([290.0]))
    found = carry_to_finer(before, numbers(floats), fine, 1.0)
    assert found["cof_adhesion"].max() == pytest.approx(0.2)
    own = {name: float(each[0]) for name, each in before.items()}
    law = np.random.default_rng(0).lognormal(0, 0.3, 1000)
    of_law = LawDraws(law, law, law, odds=np.random.default_rng(1).normal(0, 0.5, 1000))
    parts = {name.removeprefix("cof_"): own[name] for name in COF_PARTS}
    sampled = SampledCof(
        **of_law.at(own["contact_load"] / 300.0, **parts),
        share={}, left_out=(), confidence=0.95, seed=0, law=of_law,
    )  # fmt: skip
    known = SourcedValue(own["cof"], "1", "", 0.02)
    friction = FrictionCoefficients(known, known, known, known, 50.0, 300.0, 299.9)
    _, draws = ShoeAngles(shoe_angles()[:2], before, 0, own).friction(friction, sampled)
    assert draws is not None
    assert draws.cof[1::2] == pytest.approx(0.2 * law[1::2])
    assert draws.cof[::2].max() < 0.01
    assert draws.contact.max() <= 1.0


@pytest.mark.study
@pytest.mark.parametrize(
    "load",
    [
        "250 N",
        pytest.param(
            "90 N",
            marks=pytest.mark.xfail(
                strict=True,
                reason="COF 0.263 on two grids and 0.265 on one where cells of 0.3 mm have 0.273",
            ),
        ),
    ],
)
def test_two_grids_say_more_of_finer_cells_than_one(bars, load):
    """Under the lighter sole the film is 15.3 N on two grids, 14.8 on one, 13.1 on 0.3 mm."""
    light = bars.replace({"motion.normal_force": load, "contaminant.viscosity": "120 cP"})
    found = run(light)
    grid = light.numerics.grid_spacing
    alone = run(light.replace("numerics.quick_grid_spacing", grid))
    cells = {"numerics.grid_spacing": "0.3 mm", "numerics.quick_grid_spacing": "0.3 mm"}
    finer = run(light.replace(cells))
    for name in ("cof", "fluid_load"):
        off = abs(found.value(name) - finer.value(name))
        assert off < 0.7 * abs(alone.value(name) - finer.value(name)), name
        assert off < 1.96 * found[name].numerical, name


def test_draws_take_every_position_and_its_spread_is_named():
    cof = np.array([0.10, 0.14, 0.12, 0.12])
    values = {
        "cof": cof,
        "cof_adhesion": 0.25 * cof,
        "cof_hysteresis": 0.5 * cof,
        "cof_viscous": 0.25 * cof,
        "fluid_load": np.array([90.0, 10.0, 50.0, 50.0]),
    }
    values["contact_load"] = 1e6 - values["fluid_load"]  # a film too small to move it
    law = np.random.default_rng(0).normal(1, 0.2, 4000)
    of_law, parts = LawDraws(law, law, law), {"adhesion": 0.025, "hysteresis": 0.05}
    drawn = of_law.at(1 - 90e-6, **parts, viscous=0.025)
    sampled = SampledCof(**drawn, share={"model": 1.0}, left_out=(), confidence=0.95, seed=0,
                         law=of_law)  # fmt: skip
    known, open_part = SourcedValue(0.1, "1", "", 0.02), SourcedValue(0.025, "1", "")
    friction = FrictionCoefficients(known, known, known, open_part, 50.0, 500.0, 90.0)
    by_angle = {"cof": 0.005, "cof_adhesion": 0.0025, "cof_hysteresis": 0.0025, "cof_viscous": 0.0}
    own = {name: float(each[0]) for name, each in values.items()}
    positions = TreadPositions(
        places(np.eye(2), 4), values, 0, own, by_angle=by_angle, film_by_angle=0.05
    )
    averaged, sampled = positions.friction(friction, sampled)
    assert averaged.cof.value == pytest.approx(0.12)
    assert averaged.friction_force == pytest.approx(60.0)
    assert averaged.fluid_load == pytest.approx(50.0)
    assert averaged.cof_viscous.uncertainty is None
    assert sampled is not None
    assert sampled.cof.mean() == pytest.approx(0.12, rel=0.01)
    parts = sampled.adhesion + sampled.hysteresis + sampled.viscous
    assert sampled.cof == pytest.approx(parts)
    # law and position are independent: their relative variances add, and their products
    spread = 0.12 * math.sqrt((1 + 0.2**2) * (1 + (float(np.std(cof)) / 0.12) ** 2) - 1)
    assert averaged.cof.uncertainty == pytest.approx(spread, rel=0.03)
    assert sum(sampled.share.values()) == pytest.approx(1.0)
    whole = 0.0002 + 0.0004 + 0.000025
    assert sampled.share["tread_position"] == pytest.approx(0.0002 / whole, rel=0.1)
    assert sampled.share["shoe_angle"] == pytest.approx(0.000025 / whole, rel=0.1)
    film = positions.draw_scalar("fluid_load", 4000)  # each position in turn, its odds moved
    moved = np.log(film / (1e6 - film) * (1e6 / np.tile(values["fluid_load"], 1000) - 1))
    assert np.std(moved) == pytest.approx(0.05, rel=0.01)
    assert np.mean(moved) == pytest.approx(0.0, abs=1e-4)


def test_what_the_angle_adds_is_its_own_standard_deviation_of_every_number():
    own = {"cof": 0.3, "fluid_load": 20.0, "contact_load": 80.0}
    values = {name: np.full(2, value) for name, value in own.items()}
    made = TreadPositions(
        places(np.eye(2), 2), values, 0, own, by_angle={"cof": -0.01}, film_by_angle=0.05
    )
    drawn, film = made.draw_scalar("cof", 4000), made.draw_scalar("fluid_load", 4000)
    assert drawn.mean() == pytest.approx(0.3, abs=1e-5)
    assert drawn.std() == pytest.approx(0.01, rel=1e-3)
    assert np.ptp(drawn) == pytest.approx(2 * math.sqrt(3) * 0.01, rel=1e-2)
    odds = np.log(film / (100 - film))
    assert odds.mean() == pytest.approx(math.log(0.25), abs=1e-4)
    assert odds.std() == pytest.approx(0.05, rel=1e-3)
    assert made.draw_scalar("contact_load", 100) == pytest.approx(80.0)  # what it adds nothing to
    numbers = {name: SourcedValue(value, "1") for name, value in own.items()}
    assert made.average_numbers(numbers)["cof_shoe_angle"].value == pytest.approx(0.01)


def test_the_angle_adds_half_of_what_toe_up_and_toe_down_differ_by(bars):
    """A world in which each degree toe up adds 0.02 to COF and moves 4 N to the film."""
    parts = ("cof_adhesion", "cof_hysteresis", "cof_viscous")

    def numbers(place):
        more = 0.02 * place.turn / ANGLE_DEVIATION
        film = 50 + 4 * place.turn / ANGLE_DEVIATION
        return {"cof": 0.3 + more, "fluid_load": film, "contact_load": 100 - film,
                parts[0]: 0.1 + more, parts[1]: 0.1, parts[2]: 0.1}  # fmt: skip

    spacing = bars.numerics.quick_grid_spacing / 2
    made = tread_positions(
        bars,
        {TreadPlace(): numbers(TreadPlace())},
        lambda asked: ((k, numbers(place)) for k, (place, _) in enumerate(asked)),
        spacing=spacing,
        quick=False,
    )
    assert made.by_angle["cof"] == pytest.approx(0.02)
    assert made.by_angle["fluid_load"] == pytest.approx(4.0)
    assert made.film_by_angle == pytest.approx(math.log(54 / 46))


def test_the_offset_of_a_case_moves_the_pattern_with_its_sipes(bars):
    sipes = {"width": "2 mm", "depth": "2 mm", "spacing": "5 mm"}
    cut = bars.replace({"shoe.tread.sipes": sipes})
    for case in (bars, cut):
        there = case.replace("shoe.tread.offset_along", "4 mm")
        assert there.hash != case.hash
        assert Case.from_text(there.to_toml()).hash == there.hash
        land, moved = sole_map(case, 1 * MM).land, sole_map(there, 1 * MM).land
        assert not np.array_equal(land, moved)
        assert np.array_equal(sole_map(case, 1 * MM, shift=(4 * MM, 0.0)).land, moved)
        whole = case.replace("shoe.tread.offset_along", "10 mm")
        assert np.array_equal(sole_map(whole, 1 * MM).land, land)
    slits = Sipes(1 * MM, 2 * MM, 5 * MM, 0.3)
    tread = Tread("grid", 6 * MM, 4 * MM, 3 * MM, sipes=slits)
    x, y = POINTS
    back = tread.shift_grooves((2 * MM, 3 * MM)).slit_distance(x + 2 * MM, y + 3 * MM)
    assert back == pytest.approx(tread.slit_distance(x, y), abs=1e-12)


@given(st.sampled_from(["bars", "grid", "hexagons"]), st.floats(-0.4, 0.4))
@settings(deadline=None, max_examples=20)
def test_a_turned_tread_is_the_same_tread_about_its_pivot(pattern, yaw):
    pivot = (0.03, 0.004)
    tread = Tread(pattern, 6 * MM, 4 * MM, 3 * MM, offset=(1 * MM, 2 * MM), angle=0.2,
                  sipes=Sipes(1 * MM, 2 * MM, 5 * MM, 0.3))  # fmt: skip
    turned = replace(tread, yaw=yaw, pivot=pivot)
    ahead, aside = (each - at for each, at in zip(POINTS, pivot, strict=True))
    there = (
        pivot[0] + math.cos(yaw) * ahead - math.sin(yaw) * aside,
        pivot[1] + math.sin(yaw) * ahead + math.cos(yaw) * aside,
    )
    same = tread.channel_distance(*POINTS)
    assert turned.channel_distance(*there) == pytest.approx(same, abs=1e-12)
    assert turned.slit_distance(*there) == pytest.approx(tread.slit_distance(*POINTS), abs=1e-12)


@pytest.mark.parametrize("pattern", ["bars", "hexagons", "grid"])
def test_a_mirrored_tread_lies_at_the_mirrored_places(bars, pattern):
    tread = {"pattern": pattern, "depth": "3 mm", "lug_width": "6 mm", "channel_width": "4 mm"}
    one, other = (
        bars.replace({"shoe.tread": {**tread, "angle": f"{angle} deg"}}) for angle in (25, -25)
    )
    both = [
        sorted(
            (sole_map(case, 1 * MM, shift=place.shift, yaw=place.yaw).land for place in case_places(
                case, quick=False)), key=lambda land: (land.sum(), land[: len(land) // 2].sum()),
        )
        for case in (one, other)
    ]  # fmt: skip
    for land, mirrored in zip(*both, strict=True):
        assert np.count_nonzero(land != mirrored[:, ::-1]) <= 0.002 * land.size
    yaws = [place.yaw for place in case_places(one, quick=False)]
    assert sum(yaws) == pytest.approx(0.0)
    assert np.abs(yaws) == pytest.approx(YAW)


def test_the_tread_of_a_file_turns_as_one_that_was_drawn_so(bars):
    from underfoot.compute.sole import new_sole
    from underfoot.shoe import heel_surface
    from underfoot.shoe.tread_shift import moved_tread

    shape, cell = new_sole(bars), 0.25 * MM
    periods, pivot, yaw, shift = shape.tread.periods, (20 * MM, 0.0), math.radians(1), (2 * MM, 0)
    turned = replace(shape.tread.shift_grooves(shift), yaw=yaw, pivot=pivot)
    drawn = heel_surface(replace(shape, tread=turned), spacing=cell)
    moved = moved_tread(heel_surface(shape, spacing=cell), shift, periods, yaw=yaw, pivot=pivot)
    assert np.count_nonzero(moved.land != drawn.land) < 0.02 * drawn.land.sum()
    assert np.count_nonzero(moved.land) == pytest.approx(np.count_nonzero(drawn.land), rel=0.005)
    still = moved_tread(heel_surface(shape, spacing=cell), shift, periods)
    assert np.count_nonzero(still.land != drawn.land) > 0.04 * drawn.land.sum()


@pytest.mark.study
@pytest.mark.xfail(strict=True, reason="3.3 % of film, below 3 % asked; the cause is not known")
def test_a_lug_that_meets_a_corner_of_the_heel_leaves_no_tooth():
    """Without a yaw six places of these bars moved by 27 % of film and 7 % of COF by the width."""
    case = Case.load("examples/work_shoe_full_tread_glycerol.toml").replace(
        {
            "shoe.material.shore_a": 60,
            "shoe.roughness": {"ra": "6 um", "cutoff": "0.8 mm"},
            "shoe.heel": {
                "length": "60 mm",
                "width": "62 mm",
                "rear_radius": "28 mm",
                "profile": {"model": "facet", "angle": "8 deg", "length": "28 mm"},
                "edge_radius": "2 mm",
            },
            "shoe.sole.outsole_thickness": "22 mm",
            "shoe.tread": {"pattern": "transverse", "lug_width": "6 mm", "channel_width": "4 mm",
                           "depth": "3 mm"},
            "contaminant.viscosity": "150 cP",
            "numerics.tread_positions": 8,  # the quick grid takes half
        }
    )  # fmt: skip
    rows = []
    for width in np.arange(5.9, 6.16, 0.035):
        found = run(case.replace("shoe.tread.lug_width", f"{width:.4f} mm"), quick=True)
        rows.append((found.value("fluid_load"), found.value("cof")))
    second = np.abs(np.diff(rows, 2, axis=0)) / np.array(rows)[1:-1]
    assert second[:, 0].max() < 0.03
    assert second[:, 1].max() < 0.005


def test_grooves_are_in_case_and_hash_and_stay_in_their_lugs(bars):
    groove = {"along": "20 mm", "across": "5 mm", "width": "2 mm", "length": "9 mm"}
    cut = bars.replace("shoe.tread.grooves", [groove])
    assert cut.hash not in (bars.hash, bars.replace("shoe.tread.grooves", [groove] * 2).hash)
    for text in (cut.to_toml(), cut.to_toml(complete=True)):
        assert Case.from_text(text).hash == cut.hash
    further = cut.replace("shoe.tread.channel_width", "5 mm")  # beside it in its file
    assert Case.from_text(further.to_toml()).hash == further.hash
    assert cut.replace("shoe.tread.grooves", None).to_toml() == bars.to_toml()
    shift = (4 * MM, 1 * MM)
    there = cut.replace({
        "shoe.tread.offset_along": "4 mm", "shoe.tread.offset_across": "1 mm",
        "shoe.tread.grooves": [{**groove, "along": "24 mm", "across": "6 mm"}],
    })  # fmt: skip
    land = sole_map(cut, 1 * MM, shift=shift).land
    assert np.array_equal(land, sole_map(there, 1 * MM).land)
    assert np.count_nonzero(land) < np.count_nonzero(sole_map(bars, 1 * MM, shift=shift).land)
    for wrong, where in (("width", "0.5 mm"), ("along", "300 mm"), ("angle", "200 deg")):
        with pytest.raises(CaseError, match=r"grooves.0.?.*"):
            bars.replace("shoe.tread.grooves", [{**groove, wrong: where}])


def test_the_number_of_positions_is_a_field_with_a_range(bars):
    assert position_count(bars, quick=False) == 6
    assert position_count(bars, quick=True) == 3
    plain = bars.replace("shoe.tread", {"pattern": "none"})
    assert position_count(plain, quick=False) == position_count(plain, quick=True) == 3
    assert position_count(plain.replace("numerics.tread_positions", 1), quick=False) == 1
    for wrong in (0, 65, 2.5):
        with pytest.raises(CaseError, match="tread_positions"):
            bars.replace("numerics.tread_positions", wrong)


def test_an_averaged_run_is_estimated_at_as_many_marches_as_it_takes(bars):
    alone = bars.replace("numerics.tread_positions", 1)
    # its own; six on the quick grid, three of them on that of the run
    for quick, count in ((False, 4 + 6 * 0.6**2), (True, 4)):
        one, more = run_cost(alone, quick=quick), run_cost(bars, quick=quick)
        assert more.seconds == pytest.approx(np.multiply(count, one.seconds))
        assert more.memory == one.memory


def test_a_sole_without_lugs_is_estimated_at_what_its_wet_cells_take(bars):
    """The report's four took 8 to 20 s on the quick grid where 1 to 4 were told."""
    plain = bars.replace({"shoe.tread": {"pattern": "none"}, "numerics.tread_positions": 1})
    lugs = run_cost(bars.replace("numerics.tread_positions", 1), quick=True)
    assert run_cost(plain, quick=True).seconds == pytest.approx(np.multiply(5, lugs.seconds))


@pytest.mark.slow
def test_a_sole_without_tread_holds_a_degree_of_angle_in_its_interval(worn_shoe_case, monkeypatch):
    monkeypatch.setattr(  # the angles alone
        "underfoot.compute.read.with_numerical_error", lambda sampled, *_, **__: sampled
    )
    measured = worn_shoe_case.replace("shoe.heel.profile.angle", "10 deg")
    alone = run(measured.replace("numerics.tread_positions", 1), quick=True)
    found = run(measured, quick=True)
    angles = [ANGLE_BAND * part / math.sqrt(2) for part in (1, -1)]
    turned = [
        run(
            measured.replace(
                {
                    "motion.shoe_angle": measured.motion.shoe_angle + turn,
                    "numerics.tread_positions": 1,
                }
            ),
            quick=True,
        )
        for turn in angles
    ]
    for name in alone.scalars:
        if name not in ("slip_probability", "steady_slide"):  # of the draws, of one place
            at_angles = [one.value(name) for one in (alone, *turned)]
            # the body of the shoe is meshed once, at the angle of the case
            assert found.value(name) == pytest.approx(np.mean(at_angles), rel=0.02), name
    cof = [one.value("cof") for one in (alone, *turned)]
    assert found.value("cof_shoe_angle") == pytest.approx(float(np.std(cof)), rel=0.05)
    factors = np.array(cof) / cof[0]
    draws, before = found.fields["cof_draws"].values, alone.fields["cof_draws"].values
    assert draws[::3] == pytest.approx(before[::3], rel=1e-12)
    for k, factor in enumerate(factors):  # the draws take the angles in turn, part by part
        assert draws[k::3].mean() / before[k::3].mean() == pytest.approx(factor, rel=0.15)
    assert "shoe angle" in found.labels["cof_spread_from"]
    assert "-0.7 to +0.7 deg" in found.labels["shoe_angle"]
    assert any("shoe_angle: ±1 deg" in line for line in found.assumptions)
    assert found.fields["position_cof"].values == pytest.approx(cof, rel=0.02)
    assert "position_shift_x" not in found.fields
    assert "heel_bevel" not in found.labels


@pytest.mark.slow
@pytest.mark.parametrize("tread", ["none", "bars"])
def test_a_bevel_that_nobody_measured_is_drawn_and_its_film_reaches_the_dangerous_side(
    worn_shoe_case, bars, tread
):
    case = worn_shoe_case if tread == "none" else bars
    path = "shoe.heel.profile.angle"
    angle = f"{math.degrees(case.value(path) or 0.1):g} deg"

    def with_angle(**more):
        return run(case.replace(path, {"value": angle, **more}), quick=True)

    exact, doubted, assumed = (
        with_angle(),
        with_angle(uncertainty="1 deg"),
        with_angle(assumed=True, source="a guess"),
    )
    for name in ("cof", "fluid_load", "fluid_load_sensor", "peak_fluid_pressure"):
        assert exact.value(name) == doubted.value(name) == assumed.value(name)
    cof = {"exact": exact, "doubted": doubted, "assumed": assumed}
    cof = {name: one.fields["cof_draws"].values for name, one in cof.items()}
    middle = [np.quantile(cof[name], [0.25, 0.5, 0.75]) for name in ("doubted", "assumed")]
    assert middle[0] == pytest.approx(middle[1], rel=0.15)
    load = {id(one): one.scalars["fluid_load"].interval for one in (exact, doubted)}
    if tread == "none":  # flush is where the film bears least: off to either side it bears more
        assert cof["assumed"].mean() < 0.95 * cof["exact"].mean()
        assert np.quantile(cof["assumed"], 0.25) < np.quantile(cof["exact"], 0.25)
    assert load[id(doubted)][1] > load[id(exact)][1]
    assert load[id(doubted)][1] <= exact.value("normal_force")
    assert "bevel of the heel" in assumed.labels["cof_spread_from"]
    assert any(line.about == "shoe.heel.profile" for line in assumed.assumptions)
    assert "heel_bevel" in assumed.labels
    assert "heel_bevel" not in exact.labels
    told = " ".join(assumed.cautions())
    assert "heel" not in told  # of which the bevel is drawn, and the film's error holds its lengths


def test_the_shoe_angles_have_the_variance_of_an_even_band():
    turns = np.array([place.turn for place in shoe_angles()])
    assert turns[0] == 0.0
    assert turns.mean() == pytest.approx(0.0, abs=1e-15)
    assert np.mean(turns**2) == pytest.approx(ANGLE_BAND**2 / 3)


@pytest.mark.parametrize("quick", [pytest.param(False, marks=pytest.mark.slow), True])
def test_the_share_done_of_a_run_rises_over_all_its_positions(bars, quick):
    grids = {"numerics.grid_spacing": "1.6 mm", "numerics.quick_grid_spacing": "2 mm"}
    told = []
    run(bars.replace(grids), quick=quick, progress=lambda _, share, __=None: told.append(share))
    assert told[0] < 0.05
    assert told[-1] == pytest.approx(1.0, abs=1e-3)  # a steady state has no end that is known
    steps = np.diff(told)
    assert steps.min() > -0.05  # a step in time that is tried again is shorter
    assert steps.max() < 0.2


@pytest.mark.slow
def test_positions_in_processes_of_their_own_have_the_same_digits(bars):
    told = []
    case = bars.replace({"numerics.grid_spacing": "2 mm", "numerics.tread_positions": 3})
    alone = run(case)
    beside = run(case, processes=2, progress=lambda stage, *_: told.append(stage))
    assert "Tread positions" in told
    assert beside.to_frame().equals(alone.to_frame())
    assert beside.labels == alone.labels
    assert beside.provenance.result_hash == alone.provenance.result_hash
    for name, field in alone.data.data_vars.items():
        np.testing.assert_array_equal(beside.data[name].values, field.values)


@pytest.mark.slow
def test_one_position_is_the_case_s_own(bars):
    coarse = bars.replace(
        {"numerics.grid_spacing": "1.2 mm", "numerics.quick_grid_spacing": "2 mm"}
    )
    one = run(coarse.replace("numerics.tread_positions", 1))
    more = run(coarse)
    cof, load = more.fields["position_cof"], more.fields["position_fluid_load"]
    assert cof.size == 6
    assert cof.attrs["as_described"] == pytest.approx(one.value("cof"), rel=1e-12)
    assert f"(COF {one.value('cof'):.3g}, " in more.labels["tread_position"]
    assert more.value("cof") == pytest.approx(float(cof.mean()), rel=1e-12)
    assert more.value("fluid_load") == pytest.approx(float(load.mean()), rel=1e-12)
    parts = sum(more.value(f"cof_{part}") for part in ("adhesion", "hysteresis", "viscous"))
    assert more.value("cof") == pytest.approx(parts, rel=1e-12)
    assert np.array_equal(more.fields["contact_pressure"], one.fields["contact_pressure"])
    spread = [float(np.log(r.fields["cof_draws"]).std()) for r in (more, one)]
    assert spread[0] > spread[1]  # relative: the mean over places is another COF
    assert "mean over positions of the tread" in more.headline()[0]
    assert "tread_position" not in one.labels
    assert "6 positions" in more.labels["tread_position"]
    assert "position of the tread" in more.labels["cof_spread_from"]
    assert "spread over tread positions" in more.summary()
    assert any("shoe_angle: ±1 deg" in line for line in more.assumptions)
    assert any("tread: turned ±1 deg" in line for line in more.assumptions)
    assert sorted(more.fields["position_yaw"].values) == pytest.approx([-YAW] * 3 + [YAW] * 3)


@pytest.mark.slow
@pytest.mark.xfail(
    strict=True,
    reason="0.0079 for 0.0063: rolled cells overrate what the angle does to lugs at a corner",
)
def test_the_angle_widens_the_interval_by_what_marches_of_the_turned_shoe_say(bars):
    found, angle = run(bars, quick=True), bars.motion.shoe_angle
    one = bars.replace("numerics.tread_positions", 1)
    up, down = (
        run(one.replace("motion.shoe_angle", angle + sign * ANGLE_DEVIATION), quick=True)
        for sign in (1, -1)
    )
    moved = (up.value("cof") - down.value("cof")) / 2
    assert found.value("cof_shoe_angle") == pytest.approx(abs(moved), abs=0.001)
    film = (up.value("fluid_load") - down.value("fluid_load")) / 2
    assert f"the load on the film by {film:.0f}"[:-1] in found.labels["shoe_angle"]
    assert any("shoe_angle: ±1 deg" in line for line in found.assumptions)


@pytest.mark.slow
def test_a_turned_shoe_that_can_t_go_on_is_marched_and_one_without_answer_is_said(
    bars, monkeypatch
):
    def refused(*_, **__):
        raise ConvergenceError("no step", history=[])

    coarse = bars.replace({"numerics.quick_grid_spacing": "2 mm", "numerics.tread_positions": 4})
    going_on = run(coarse, quick=True)
    monkeypatch.setattr(solve, "continue_contact", refused)
    marched = run(coarse, quick=True)
    assert marched.value("cof") == going_on.value("cof")
    assert marched.value("cof_shoe_angle") == pytest.approx(
        going_on.value("cof_shoe_angle"), abs=0.008
    )
    numbers_at = solve._numbers_at
    monkeypatch.setattr(
        solve,
        "_numbers_at",
        lambda parts, place, *more: None if place.turn else numbers_at(parts, place, *more),
    )
    alone = run(coarse, quick=True)
    assert "cof_shoe_angle" not in alone.scalars
    assert "its angle counts as exact" in alone.summary().split("\n\n")[0]


@pytest.mark.slow
def test_the_mean_does_not_depend_on_where_the_pattern_begins(bars):
    single, mean = [], []
    for offset in ("0 mm", "1.25 mm", "4 mm"):
        moved = bars.replace("shoe.tread.offset_along", offset)
        alone, over = (
            run(each, quick=True) for each in (moved.replace("numerics.tread_positions", 1), moved)
        )
        single.append((alone.value("cof"), alone.value("fluid_load")))
        mean.append((over.value("cof"), over.value("fluid_load")))
    before, after = np.ptp(single, axis=0), np.ptp(mean, axis=0)
    assert (after < 0.01 * before).all()
    # as well as a steady film is told whatever it began with
    assert (after < 5e-3 * np.mean(mean, axis=0)).all()


def test_a_place_that_does_not_converge_is_said_first_and_widens_the_error(monkeypatch):
    """Places that fail float: what is missing may be as far off as the farthest of the others."""
    load = np.array([60.0, 80.0, 100.0, 160.0])
    parts_of_cof = {"cof_adhesion": 0.05, "cof_hysteresis": 0.03, "cof_viscous": 0.02}
    values = {name: np.full(4, value) for name, value in {"cof": 0.1, **parts_of_cof}.items()}
    values["fluid_load"] = load
    errors, force = {}, 320.0
    own = {name: float(each[0]) for name, each in values.items()}
    names = ("cof", "fluid_load", "peak_fluid_pressure")
    values["peak_fluid_pressure"] = np.full(4, 1e6)
    monkeypatch.setattr(numerical_error, "_read", lambda *_: dict.fromkeys(names, 0.0))
    monkeypatch.setattr(numerical_error, "cells_along", lambda *_: 1)
    monkeypatch.setattr(numerical_error, "tread_on_sole", lambda _: (np.eye(2),))
    parts = SimpleNamespace(
        case=SimpleNamespace(
            numerics=SimpleNamespace(grid_check=False), motion=SimpleNamespace(end_time=None)
        ),
        objects={},
        sole=None,
    )
    for left_out in (0, 2):
        positions = TreadPositions(places(np.eye(2), 4), values, left_out, own)
        found = numerical_error.numerical_errors(
            parts,
            SimpleNamespace(contact=SimpleNamespace(normal_force=force)),
            positions,
        )
        errors[left_out] = found.grid["fluid_load"]
        told = positions.labels()
        assert ("positions_left_out" in told) == bool(left_out)
    scatter = np.std(load, ddof=1) / 4**0.75
    odds = 0.05 * np.mean(load * (1 - load / force))
    assert errors[0] == pytest.approx(math.hypot(odds, scatter))
    assert errors[2] == pytest.approx(math.hypot(odds, scatter, 2 / 6 * 60))
    contact = 0.05 * np.mean(load / force) * 0.08 + 0.01 * 0.02
    assert found.grid["cof"] == pytest.approx(math.hypot(contact, 0.002 * 0.1))
    assert found.grid["peak_fluid_pressure"] == pytest.approx(0.3e6)
    assert "2 of 6 positions of the tread did not converge" in told["positions_left_out"]
    assert cautions(Status.CONVERGED, {}, (), (), labels=told)[0] == told["positions_left_out"]
    alone = {"cof": np.array([0.1]), "fluid_load": load[:1]}
    one = TreadPositions(places(np.eye(2), 1), alone, 3, own)
    assert "3 did not converge" in one.labels()["tread_position"]
    assert "3 of 4" in one.labels()["positions_left_out"]
    assert one.draw_scalar("cof", 3).tolist() == [0.1] * 3


@pytest.mark.slow
def test_a_sole_whose_bars_float_converges_at_every_place(tmp_path):
    """Where a film is pressed out of a gap, its balance must know that the gap can open again.

    Bars in thin glycerol drawn 6 mm further on: four of sixteen places had no answer, each with
    more film than the others.
    """
    from benchmarks.tread_widths import bars as bars_in_glycerol

    from underfoot.compute.prepare import prepare_case
    from underfoot.compute.sole import file_periods, new_sole
    from underfoot.shoe.parametric import write_sole

    base = bars_in_glycerol({"motion.duration": "0.12 s"})
    shape = new_sole(base)
    moved = replace(shape, tread=shape.tread.shift_grooves((6 * MM, 0.0)))
    path = write_sole(moved, tmp_path / "bars.stl").path
    parts = {"shoe.heel": None, "shoe.tread": None, "shoe.sole": None}
    case = base.replace({**parts, "shoe.outsole": {"file": str(path)}})
    spacing = case.numerics.grid_spacing
    ready, rejected = prepare_case(case, spacing), []
    for place in places(file_periods(case), 16)[2:8]:
        _, contact = solved_at(ready, place, spacing)
        assert contact.status is Status.CONVERGED
        rejected.append(contact.counts.rejected)
    *others, most = sorted(rejected)
    assert others[-1] < 8
    if most == 14:
        pytest.xfail("14 steps in vain at one place, below 8 asked: the cause is not known")
    assert most < 8


@pytest.mark.study
def test_a_tread_drawn_at_other_places_in_a_file_has_nearly_the_same_mean(tmp_path):
    """As drawn COF differs by 23 % and film load by a factor of four (docs, coupled contact)."""
    from underfoot.shoe import Facet, Heel
    from underfoot.shoe.parametric import write_sole

    drawn, mean = [], []
    for offset in (0.0, 4 * MM, 8 * MM):
        heel = Heel(
            length=60 * MM,
            width=66 * MM,
            rear_radius=28 * MM,
            outsole_thickness=25 * MM,
            edge_radius=2 * MM,
            profile=Facet(math.radians(10), 30 * MM),
            tread=Tread("transverse", 6 * MM, 4 * MM, 3.5 * MM, offset=(offset, 0.0)),
        )
        file = tmp_path / f"bars_{offset * 1e3:.0f}.stl"
        write_sole(heel, file)
        case = Case(
            shoe={"from": "work_shoe_full_tread", "outsole": {"file": str(file)}},
            floor="vinyl_g4",
            contaminant="glycerol_90pct",
            motion="slip_tester_g4",
        )
        result = run(case.replace("numerics.tread_positions", 8), quick=True)
        apart = np.diff(result.fields.position_shift_x.values) % (10 * MM)
        assert apart == pytest.approx(2.5 * MM, abs=0.1 * MM)
        mean.append((result.value("cof"), result.value("fluid_load")))
        alone = run(case.replace("numerics.tread_positions", 1), quick=True)
        drawn.append((alone.value("cof"), alone.value("fluid_load")))
        assert "describes (COF" in result.labels["tread_position"]
    assert (np.ptp(mean, axis=0) < 0.25 * np.ptp(drawn, axis=0)).all()
