"""Machines as devices of the law, and the choice of a shoe for a place."""

import copy
import dataclasses
import math
import re
import shutil
import tomllib
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import underfoot as uf
from snapshot import held
from underfoot.case import Case
from underfoot.compute.resolve import resolve_context
from underfoot.compute.run import run
from underfoot.compute.sole import bottom_surface
from underfoot.core import InputError, RangeError
from underfoot.core.arrays import Array
from underfoot.film import wedge_film
from underfoot.friction.pair_contact import Pair
from underfoot.friction.shoe_class import SPEED, slip_tests
from underfoot.places.calibration import calibrated_floor, class_bounds
from underfoot.places.cells import slip_share
from underfoot.places.choice import _count, _read_floors, choose_shoe
from underfoot.places.evidence import (
    _floor_rq,
    evidence,
    floor_likeness,
    learn_machine,
    machine_scores,
    score,
)
from underfoot.places.joint import FLOOR_LIKENESS, CofReading, PlaceDraws
from underfoot.places.machines import (
    FLUIDS,
    SCALES,
    Bearing,
    MachinePrediction,
    machine,
    machines,
    predicted_reading,
    rq_of_rz,
)
from underfoot.places.place import place_of, read_place
from underfoot.questions.method import method_name, method_prediction
from underfoot.rough_contact import ExponentialLaw

EXAMPLES = Path(__file__).parents[2] / "examples" / "places"
DRY = {"name": "store", "fluids": {"dry": 1.0}}
READ = {"test": "tile_glycerine", "cof": 0.3}
UM = 1e-6


def small_place():
    """Return a place of one floor, one fluid and two heels without tread: seconds to solve."""
    return {
        "fluids": {"dry": 0.9, "glycerol_90pct": 0.1},
        "floor": [{"name": "hall", "roughness": {"rq": "2 um"}}],
        "shoe": [
            {"name": "smooth", "from": "work_shoe_untreaded"},
            {"name": "treaded", "from": "work_shoe_full_tread"},
        ],
    }


@pytest.fixture(scope="module")
def choice():
    return choose_shoe(place_of(small_place()))


@pytest.mark.parametrize(("cof", "ptv"), [(0.31, 31), (0.54, 50), (1.00, 82), (0.37, 36)])
def test_ptv_is_that_of_the_published_table(cof, ptv):
    assert SCALES["ptv"].reading(cof) == pytest.approx(ptv, abs=0.55)


@pytest.mark.parametrize("name", SCALES)
def test_scales_hold_both_ways(name):
    cof = np.linspace(0.01, 1.2, 50)
    assert SCALES[name].cof(SCALES[name].reading(cof)) == pytest.approx(cof, rel=1e-12)
    step = 1e-6
    at = float(SCALES[name].reading(0.4))
    slope = (SCALES[name].cof(at + step) - SCALES[name].cof(at - step)) / (2 * step)
    assert SCALES[name].slope(at) == pytest.approx(float(slope), rel=1e-4)


def test_the_angle_of_a_ramp_is_that_of_its_friction():
    assert SCALES["angle"].reading(1.0) == pytest.approx(45)
    assert SCALES["angle"].cof(30.0) == pytest.approx(1 / np.sqrt(3))


@pytest.mark.parametrize(
    ("name", "reading", "label"),
    [
        ("pendulum-96", 24.9, "high slip potential"),
        ("pendulum-96", 36, "low slip potential"),
        ("ramp-oil", 10, "R9"),
        ("ramp-oil", 10.1, "R10"),
        ("ramp-oil", 6, "R9"),
        ("ramp-oil", 5.9, "no class"),
        ("bot-3000e", 0.42, "interior wet"),
    ],
)
def test_classes(name, reading, label):
    assert machine(name).class_of(reading) == label


@pytest.mark.parametrize("name", [name for name in machines() if name != "ramp-oil"])
def test_a_rougher_floor_reads_higher_wet_and_a_dry_one_higher_still(name):
    levels = [predicted_reading(name, rq_of_rz(rz * UM)) for rz in (5, 20, 40)]
    medians = [each.median for each in levels]
    assert medians == sorted(medians)
    dry = predicted_reading(name, rq_of_rz(5 * UM), fluid="dry")
    assert dry.median > levels[0].median
    assert sum(chance for _, chance in dry.classes) == pytest.approx(1)


@pytest.mark.parametrize("name", [name for name, one in machines().items() if one.learned])
def test_what_a_set_up_has_learned_is_what_its_readings_teach(name):
    device = machine(name)
    assert dataclasses.astuple(learn_machine(device)) == pytest.approx(
        dataclasses.astuple(device.learned), abs=0.002
    )


EDGE = Bearing(length=(1e-3, 3e-3), width=76e-3, load=25.0)
PRESSURE, DRAG, STIFF = 160e3, 2.6e-3, 30e6
ALONG = 25.0 / (76e-3 * PRESSURE)


def film(rq: float, *, drag: float = DRAG, taper: float = 1.19) -> tuple[float, float]:
    each: list[Array] = [np.array([x]) for x in (PRESSURE, ALONG, drag, rq)]
    share, gap = EDGE.film(*each, STIFF, np.array([taper]))
    return float(share[0]), float(gap[0])


def test_the_edge_of_a_slider_floats_on_a_smooth_floor_as_a_wedge_does():
    share, gap = film(1e-9)
    alone = wedge_film(
        viscosity=DRAG, speed=1.0, length=ALONG, width=EDGE.width, load=25.0, taper=1.19
    )
    assert share == pytest.approx(1.0)
    assert gap == pytest.approx(alone, rel=1e-3)


def test_a_lug_as_wide_as_long_floats_as_its_wedge_does():
    lug = Bearing(length=(4e-3, 15e-3), width=10e-3, load=None)
    ones = np.ones(1)
    share, gap = lug.film(3e5 * ones, 0.01 * ones, 0.02 * ones, 1e-9 * ones, 5e6, 0.7 * ones)
    alone = wedge_film(
        viscosity=0.02, speed=1.0, length=0.01, width=0.01, load=3e5 * 1e-4, taper=0.7
    )
    assert share[0] == pytest.approx(1.0)
    assert gap[0] == pytest.approx(alone, rel=1e-3)


@pytest.mark.parametrize("rq", [1e-6, 2e-6, 6e-6])
def test_film_and_contact_of_the_edge_carry_its_load_at_one_gap(rq):
    share, gap = film(rq)
    contact = float(ExponentialLaw(STIFF, 0.5, rq).pressure(gap))
    assert share * PRESSURE + contact == pytest.approx(PRESSURE, rel=1e-6)


def test_the_film_of_the_edge_grows_with_speed_and_falls_with_roughness():
    assert film(2e-6)[0] > film(4e-6)[0] > film(8e-6)[0]
    assert film(2e-6, drag=2 * DRAG)[0] > film(2e-6)[0] > film(2e-6, taper=0.1)[0]


def test_a_longer_edge_reads_less_of_a_smooth_wet_floor():
    """The longer the edge, the better it floats: why sliders are dressed."""
    device, read = machine("pendulum-96"), []
    for length in (1e-3, 3e-3):
        worn = dataclasses.replace(device, bearing=Bearing((length, length), 76e-3, 25.0))
        cof = worn.cof(PlaceDraws(), "glass", (0.3 * UM, 0.3 * UM), FLUIDS["water"])
        read.append(np.median(cof))
    assert read[1] < read[0]


def test_a_walker_of_the_ramp_slips_below_the_angle_of_friction():
    """Without the need of a half step the angle is that of the friction."""
    device, angles = machine("ramp-oil"), []
    device = dataclasses.replace(device, bearing=None, deviation=0.0)
    for walker in (device.walker, (0.0, 0.0)):
        walked = dataclasses.replace(device, walker=walker)
        cof = walked.cof(PlaceDraws(), "floor", rq_of_rz(60 * UM), FLUIDS["ramp oil"])
        angles.append(np.median(walked.scale.reading(cof)))
    needed = np.degrees(np.arctan(np.mean(device.walker)))
    assert angles[1] - angles[0] == pytest.approx(needed, abs=0.5)


def test_a_class_of_a_machine_stands_for_its_bounds():
    bounds = class_bounds(machine("ramp-oil"), "R11", "floor")
    assert [(one.kind, one.value) for one in bounds] == [("lower", 19.0), ("upper", 27.0)]
    assert [one.value for one in class_bounds(machine("ramp-barefoot"), "C", "floor")] == [24.0]
    with pytest.raises(InputError, match="R9"):
        class_bounds(machine("ramp-oil"), "R8", "floor")


@pytest.mark.parametrize("name", [name for name, one in machines().items() if one.classes])
def test_classes_of_a_machine_cover_its_scale_and_each_ends_where_the_next_begins(name):
    """No bound is told at the foot of the lowest, which every reading is above, nor at the top."""
    device, end = machine(name), 0.0
    for at, (foot, label) in enumerate(device.classes):
        bounds = {one.kind: one.value for one in class_bounds(device, label, "floor")}
        assert bounds.get("lower", 0.0) == foot == end
        assert ("lower" in bounds) is (foot > 0)
        assert ("upper" in bounds) is (at + 1 < len(device.classes))
        end = bounds.get("upper", math.inf)
    assert end == math.inf


def test_published_readings_are_predicted_without_their_source():
    """Coverage is as wanted (90 to 98 %); error (6) and rank correlation (0.7) are not yet."""
    told = machine_scores()
    pendulum = told.of("pendulum-96", "pendulum-55")
    scored = score(pendulum)
    assert len({row.evidence.floor for row in pendulum}) >= 20
    assert 0.9 <= scored.inside <= 0.98
    assert scored.error == pytest.approx(11.8, abs=0.5)  # as the guide prints it
    assert scored.constant_error == pytest.approx(14, abs=0.5)
    assert scored.rank == pytest.approx(0.60, abs=0.02)
    one = pendulum[0].evidence
    assert learn_machine(one.machine, one.source) != learn_machine(one.machine)


@pytest.mark.parametrize("name", list(machines()))
def test_every_machine_is_a_method_that_reads_the_floor_of_a_case(name):
    case = read_case(ptv_96=40).replace({"friction": {"model": "pair"}})
    medians = []
    for rq in ("1 um", "8 um"):
        told = method_prediction(case.replace({"floor.roughness.rq": rq}), name)
        assert isinstance(told, MachinePrediction)
        assert sum(chance for _, chance in told.classes) == pytest.approx(1)
        settings = told.tables()[1].rows
        assert all(source for *_, source in settings)
        medians.append(told.median)
    assert medians[0] < medians[1] or name == "ramp-oil"


def test_a_machine_of_ones_own_is_an_entry_of_the_catalogue(tmp_path):
    (tmp_path / "catalogue").mkdir()
    entry = '[setup.soft_pendulum]\nfrom = "pendulum_96"\ntitle = "Soft"\nspecimen.shore_a = 40\n'
    (tmp_path / "catalogue" / "own.toml").write_text(entry, encoding="utf-8")
    lines = ["[shoe]", "[floor]", "[contaminant]", "[motion]"]
    names = ["work_shoe_untreaded", "vinyl", "water", "whole_shoe_g6"]
    text = "\n".join(f'{a}\nfrom = "{b}"' for a, b in zip(lines, names, strict=True))
    (tmp_path / "case.toml").write_text(text, encoding="utf-8")
    told = method_prediction(uf.load(tmp_path / "case.toml"), "soft-pendulum")
    assert isinstance(told, MachinePrediction)
    assert told.machine.shore_a == 40
    assert told.heading() == "Soft, water"


def test_a_machine_knows_what_another_read_of_the_floor():
    told = [method_prediction(read_case(ptv_96=ptv), "bot-3000e").median for ptv in (12, 60)]
    assert told[0] < told[1]


@pytest.mark.parametrize("floor", ["polished_tile", "quarry_tile", None])
def test_a_reading_is_foretold_again_and_named_where_it_was_not(floor):
    """What is foretold of a floor holds what was read of it; a value outside is a caution."""
    shoes, cautioned = [], []
    for ptv in (12, 24, 40):
        case = read_case(ptv_96=ptv)
        case = case if floor is None else case.replace({"floor": floor})
        told = method_prediction(case, "pendulum-96")
        assert told.low <= ptv <= told.high
        law = case.friction.build(resolve_context(case))
        shoes.append(np.median(law.joint_draws(1000, 0)["pair"]))
        before = method_prediction(case.replace({"friction": {"model": "pair"}}), "pendulum-96")
        outside = not before.low <= ptv <= before.high
        if floor is not None:  # else the reading tells which of all floors it is
            assert bool(law.draws.outside) == outside
            cautioned.append(outside)
            assert any(f"read {ptv} PTV where" in text for text in told.cautions()) == outside
    assert shoes == sorted(shoes)  # more on the pendulum, more under the shoe
    assert floor is None or shoes[0] < 0.97 < 1.03 < shoes[-1] / shoes[0]
    assert any(cautioned) == (floor is not None)


def test_what_a_reading_says_of_a_shoe_is_what_machines_say_of_each_other():
    """Nobody's shoe and pendulum read one floor; two machines did, and each laboratory less one
    says the same.
    """
    assert floor_likeness() == pytest.approx(FLOOR_LIKENESS, abs=0.005)
    for source in ("floor_testing_services", "safety_direct_coatings", "uksrg_verification"):
        assert floor_likeness(source) == pytest.approx(FLOOR_LIKENESS, abs=0.1)
    joint = PlaceDraws(count=20000)
    one, two = (joint.beyond_roughness("hall", name) for name in "ab")
    assert np.corrcoef(one, two)[0, 1] == pytest.approx(FLOOR_LIKENESS, abs=0.02)
    for other in (joint.beyond_roughness("yard", "b"), joint.beyond_roughness("hall", "b2", "oil")):
        assert np.corrcoef(one, other)[0, 1] == pytest.approx(0, abs=0.02)


def test_a_machine_outside_its_standard_is_told_and_nothing_else_is_kept():
    case = read_case(ptv_96=40).replace({"contaminant": "canola_oil"})
    told = method_prediction(case, "pendulum-96", keep=["contaminant"])
    assert any("Outside the standard" in text for text in told.cautions())
    with pytest.raises(InputError, match=r"speed.*contaminant"):
        method_prediction(case, "pendulum-96", keep=["speed"])


def read_case(**friction):
    return Case(
        shoe="work_shoe_untreaded",
        floor={"roughness": {}},
        contaminant="water",
        motion="whole_shoe_g6",
        friction={"model": "pair_read", **friction},
    )


@pytest.mark.parametrize("shoe", ["work_shoe_untreaded", "athletic_shoe_full_tread"])
def test_a_reading_of_the_floor_in_a_case_narrows_every_shoe_on_it(shoe):
    rough, cofs = [], []
    for ptv in (15, 60):
        case = read_case(ptv_96=ptv).replace({"shoe": shoe})
        law = case.friction.build(resolve_context(case))
        share = law.draws.errors[f"floor_rq {law.pair.floor_rq[0]:.3g} {law.pair.floor_rq[1]:.3g}"]
        rough.append(np.quantile(share, (0.025, 0.5, 0.975)))
        cofs.append(law.medians["kappa"])
        assert law.spread_basis == "of a floor that was read"
    assert rough[0][1] < 0.5 < rough[1][1]
    assert all(high - low < 0.9 for low, _, high in rough)  # of 0.95 of what was drawn
    assert cofs[0] < cofs[1]  # a rougher floor sheds water longer


def test_readings_of_a_case_go_beside_those_of_its_shoe(tmp_path):
    """Draws of calibrate pair are narrowed further, with what they determined of the shoe."""
    plain = read_case(ptv_96=40)
    law = plain.friction.build(resolve_context(plain))
    error = {"laboratory": np.linspace(-0.1, 0.1, law.draws.count)}
    path = tmp_path / "own.csv"
    dataclasses.replace(law.draws, errors=error).write(path)
    both = read_case(ptv_96=40, draws_file=str(path))
    kept = both.friction.build(resolve_context(both)).draws.errors["laboratory"]
    assert np.abs(kept).max() <= 0.1


@pytest.mark.parametrize(
    ("friction", "words"),
    [
        ({"ptv_96": 350}, "350 is outside"),
        ({"ramp_angle": "60 deg"}, "60 deg is outside"),
        ({"ptv_96": 0.41}, "0.41 is no reading"),
        ({"ramp_angle": "0.2 deg"}, "0.2 is no reading"),
        ({"ramp_class": "R8"}, "R9"),
        ({}, "no reading of the floor"),
        ({"ptv": 36}, "ptv_96"),
    ],
)
def test_bad_readings_of_a_case_are_refused(friction, words):
    with pytest.raises(InputError, match=words):
        read_case(**friction)


def test_what_is_not_known_of_a_floor_is_told():
    unknown = predicted_reading("ramp-oil", fluid="water")
    told = " ".join(unknown.cautions())
    assert "no roughness" in told
    assert "Outside the standard" in told
    assert "No reading of this machine" in told


def test_a_reading_moves_what_it_is_of_and_leaves_other_floors():
    device, span = machine("pendulum-96"), (0.3 * UM, 20 * UM)
    medians = []
    for reading in (20.0, 50.0):
        joint = PlaceDraws()
        other = np.median(joint.share("roughness of floor other"))
        likelihood = device.log_likelihood(joint, "hall", span, FLUIDS["water"], reading)
        joint.learn(likelihood, "hall")
        medians.append(np.median(joint.drawn_between("roughness of floor hall", span)))
        assert np.median(joint.share("roughness of floor other")) == pytest.approx(other, abs=0.05)
    assert medians[0] < medians[1]


ANY = (0.2 * UM, 15 * UM)


def shoe_cofs(joint):
    """Return the water-wet COF of two shoes on two floors, by their names."""
    hardness = {"soft": 50.0, "hard": 75.0}
    return {
        (shoe, floor): joint.contact_cof(
            Pair(hardness[shoe], (1 * UM, 10 * UM), ANY, "aqueous"),
            laboratory="the place",
            floor=floor,
            sole=shoe,
            pressure=3e5,
            drag=3e-4,
        )
        for shoe in hardness
        for floor in ("hall", "yard")
    }


def moved(read, count=24000):
    """Return ln of the ratio of median COFs after a high and after a low reading."""
    medians = []
    for high in (False, True):
        joint = PlaceDraws(count=count)
        read(joint, high)
        medians.append({name: np.log(np.median(cof)) for name, cof in shoe_cofs(joint).items()})
    return {name: medians[1][name] - medians[0][name] for name in medians[0]}


def test_a_floor_that_was_read_moves_every_shoe_on_it_and_none_elsewhere():
    def read(joint, high):
        value, device = 60.0 if high else 15.0, machine("pendulum-96")
        log = device.log_likelihood(joint, "hall", ANY, FLUIDS["water"], value)
        joint.learn(log, "hall")

    change = moved(read)
    assert all(change[shoe, "hall"] > 0.5 for shoe in ("soft", "hard"))
    assert all(abs(change[shoe, "yard"]) < 0.1 for shoe in ("soft", "hard"))


def test_a_shoe_that_was_read_moves_on_every_floor_more_than_another_shoe():
    def read(joint, high):
        test = slip_tests()["tile_glycerine"]
        cof = joint.contact_cof(
            Pair(50.0, (1 * UM, 10 * UM), test.floor_rq, test.family),
            laboratory="test house",
            floor=test.name,
            sole="soft",
            pressure=3e5,
            drag=test.viscosity * SPEED,
        )
        joint.learn(joint.log_likelihood(cof, CofReading(0.4 if high else 0.08)), "soft")

    change = moved(read, count=200_000)  # of fewer draws the sampling hides it
    for floor in ("hall", "yard"):
        assert change["soft", floor] > max(0.03, change["hard", floor])


def test_a_bound_says_less_than_a_value():
    """A value narrows to a band; a lower bound cuts one side alone (of ln: errors are factors)."""
    device, span, wide = machine("pendulum-96"), (0.3 * UM, 20 * UM), {}
    for kind in ("value", "lower", "upper"):
        joint = PlaceDraws()
        joint.learn(
            device.log_likelihood(joint, "hall", span, FLUIDS["water"], 36.0, kind=kind), "hall"
        )
        read = device.scale.reading(device.cof(joint, "hall", span, FLUIDS["water"]))
        wide[kind] = np.log(np.quantile(read, (0.05, 0.95)))
    assert np.ptp(wide["value"]) < min(np.ptp(wide["lower"]), np.ptp(wide["upper"]))
    assert wide["lower"][0] > wide["upper"][0]


def test_two_readings_teach_the_same_in_either_order():
    """Learning one after the other is learning both: the order changes the sampling alone."""
    device, found = machine("bot-3000e"), []
    device = dataclasses.replace(device, learned=None)
    for order in (("a", "b"), ("b", "a")):
        joint = PlaceDraws(count=20000)
        for floor in order:
            value = {"a": 0.3, "b": 0.5}[floor]
            span = {"a": rq_of_rz(10 * UM), "b": rq_of_rz(30 * UM)}[floor]
            fluid = FLUIDS["detergent"]
            joint.learn(device.log_likelihood(joint, floor, span, fluid, value), floor)
        found.append(np.log(joint.constants.constants.kappa_0))
    assert np.mean(found[0]) == pytest.approx(np.mean(found[1]), abs=0.15 * np.std(found[0]) + 0.05)


def test_slips_fall_with_friction_and_grow_with_slope_and_need():
    joint = PlaceDraws(count=2000)
    acof = np.full(joint.count, 0.2)
    base = slip_share(acof, 0.2, 0.03, 0.0, joint).mean()
    assert slip_share(1.5 * acof, 0.2, 0.03, 0.0, joint).mean() < base
    assert slip_share(acof, 0.25, 0.03, 0.0, joint).mean() > base
    sloped = slip_share(acof, 0.2, 1e-6, 0.05, joint)
    needed = np.tan(0.05 + np.arctan(0.2))
    assert sloped == pytest.approx(slip_share(acof, needed, 1e-6, 0.0, joint), rel=1e-3)


def test_the_treaded_heel_is_the_better_one_in_a_thick_fluid(choice):
    best = {each.shoe.name: each.best for each in choice.shoes}
    assert best["treaded"] > 0.75 > best["smooth"]
    assert sum(best.values()) == pytest.approx(1)
    assert "treaded is best" in choice.headline()[0]
    for each in choice.shoes:  # of the steps in the fluid, a tenth of all
        low, high = each.slips.interval
        assert 0 <= low <= each.slips.value <= high <= 1
    assert choice.place.wet_steps == pytest.approx(0.1 * choice.place.steps)


def test_a_solved_choice_tells_what_it_told(choice, file_regression):
    """Its words and two digits of its numbers: what a coarser machine rounds alike."""
    held(file_regression, {
        "headline": list(map(str, choice.headline())),
        "remarks": {name: list(map(str, each)) for name, each in choice.remarks().items()},
        "tables": [[str(table.title), *(" | ".join(map(str, row)) for row in table.rows)]
                   for table in choice.tables()],
    })  # fmt: skip


def test_what_helps_most_is_the_first_row_and_nothing_idle_is_one(choice):
    """The sentence, the table and the numbers of the shoes tell one thing."""
    first = choice.levers[0]
    assert f"Most is gained by {first.name}" in " ".join(choice.headline())
    assert [each.left[1] for each in choice.levers] == sorted(e.left[1] for e in choice.levers)
    assert all(each.does_something for each in choice.levers)
    slips = {each.shoe.name: each.slips.value for each in choice.shoes}
    instead = next(each for each in choice.levers if "instead of" in each.name)
    assert instead.left[1] == pytest.approx(slips["treaded"] / slips["smooth"], rel=1e-6)
    assert sum(share for _, share in choice.sources) == pytest.approx(1)
    words = " ".join(choice.headline()) + choice.summary()
    assert not re.search(r"\d,\d{3},\d{3}", words)  # no slips in millions


@pytest.mark.slow
def test_a_floor_that_is_as_rough_is_not_offered_another():
    floors = [
        {"name": "kitchen", "from": "quarry_tile"},
        {"name": "hall", "roughness": {"rq": "2 um"}},
    ]
    names = [each.name for each in choose_shoe(place_of(small_place() | {"floor": floors})).levers]
    assert any("clay quarry tile" in name and "(hall)" in name for name in names)
    rough = choose_shoe(place_of(small_place() | {"floor": floors[:1]}))
    assert not any("quarry tile" in each.name for each in rough.levers)


@pytest.mark.slow
def test_another_floor_is_none_that_was_read_whatever_its_name():
    """What a pendulum read of a floor called "quarry tile" is not known of one that is laid."""
    ends = []
    for name in ("hall", "quarry tile"):
        rq = {"value": "1.7 um", "uncertainty": "1.9 um"}
        floor = {"name": name, "roughness": {"rq": rq}}
        floor["reading"] = [{"machine": "pendulum-96", "value": 15}]
        table = small_place() | {"floor": [floor], "fluids": {"dry": 0.8, "water": 0.2}}
        table["shoe"] = table["shoe"][:1]
        ends.append(choose_shoe(place_of(table)).levers[0].left[2])
    assert abs(np.log(ends[1] / ends[0])) < np.log(2)  # it was a fifth


@pytest.mark.slow
def test_a_cell_is_the_whole_run_of_its_case(choice):
    """The draws that every shoe shares spread as those of a run do, about the same COF."""
    case = choice.place.case(choice.place.shoes[0], choice.place.floors[0], "glycerol_90pct")
    whole = run(case, quick=True).scalars["cof"]
    *_, low, median, high, film = next(row for row in choice.cofs if row[0] == "smooth")
    assert median == pytest.approx(whole.value, rel=0.1)
    assert (low, high) == pytest.approx(whole.interval, rel=0.25)
    assert film > 0.5


@pytest.mark.slow
def test_how_often_the_fluid_is_there_changes_no_step_in_it(choice):
    table = small_place() | {"fluids": {"dry": 0.8, "glycerol_90pct": 0.2}}
    twice = choose_shoe(place_of(table))
    for one, two in zip(choice.shoes, twice.shoes, strict=True):
        assert two.slips.value == pytest.approx(one.slips.value, rel=1e-9)
        assert two.best == pytest.approx(one.best)


@pytest.mark.slow
def test_the_order_of_floors_and_shoes_changes_nothing():
    table = small_place()
    table["floor"][0]["area"] = 1
    table["floor"].append({"name": "yard", "roughness": {"rq": "6 um"}, "area": 2})
    turned = copy.deepcopy(table)
    turned["floor"].reverse()
    turned["shoe"].reverse()
    one, two = ({each.shoe.name: each for each in choose_shoe(place_of(each)).shoes}
                for each in (table, turned))  # fmt: skip
    for name, answer in one.items():
        # a contact is continued from another one: the numbers differ by the solver's error
        assert answer.best == pytest.approx(two[name].best, abs=0.02)
        assert answer.slips.value == pytest.approx(two[name].slips.value, abs=0.01)


@cache
def ranking(quick, shift):
    table = small_place()
    table["fluids"] = {"dry": 0.8, "glycerol_90pct": 0.1, "water": 0.1}
    table["shoe"] = [
        {"name": name, "from": name, **({"tread": {"offset_along": shift}} if lugs else {})}
        for name, lugs in (
            ("work_shoe_full_tread", True),
            ("work_shoe_half_tread", True),
            ("work_shoe_untreaded", False),
        )
    ]
    told = choose_shoe(place_of(table), quick=quick)
    return {each.shoe.name: each.best for each in told.shoes}


@pytest.mark.slow
@pytest.mark.parametrize(("quick", "shift"), [(False, "0 mm"), (True, "4 mm")], ids=str)
def test_the_ranking_is_that_of_another_grid_and_other_positions_of_the_tread(quick, shift):
    here, there = ranking(True, "0 mm"), ranking(quick, shift)
    assert sorted(here, key=here.__getitem__) == sorted(there, key=there.__getitem__)
    assert here == pytest.approx(there, abs=0.1)


@pytest.mark.study
@pytest.mark.xfail(strict=True, reason="0.14 for 0.16 of 25 mm: steady sliding empties the patch")
def test_a_larger_worn_region_carries_more_load_on_its_film():
    """Its threshold is no rule here: what a region does comes of the film under it.

    Published of 57 persons: a longer region slips oftener, about 10 % a millimetre of the geometric
    mean of its sides (doi 10.5061/dryad.vmcvdncsk, abstract).
    """
    table = small_place()
    table["shoe"] = [
        {"name": f"{side} mm", "from": "work_shoe_full_tread", "worn_region": [f"{side} mm"] * 2}
        for side in (10, 25, 40)
    ]
    told = choose_shoe(place_of(table), quick=False)
    films = [row[-1] for row in told.cofs]
    assert films[2] > 1.2 * max(films[:2])  # 10 mm is less than a lug
    assert all(each.replaced for each in told.shoes)


@pytest.mark.slow
def test_cleaning_is_a_change_and_rinsing_oil_with_water_is_no_row():
    table = small_place()
    table["fluids"] = {"dry": 0.8, "canola_oil": 0.1, "water": 0.1}
    table["shoe"] = table["shoe"][:1]
    left = {one.name: one.left for one in choose_shoe(place_of(table)).levers}
    assert not any("rinsed" in name for name in left)
    halved = [value for name, value in left.items() if "half the steps" in name]
    assert all(0.5 <= low <= high <= 1 for low, _, high in halved)
    assert np.sum(halved, axis=0)[1] == pytest.approx(1.5, abs=0.02)  # what one spares is there
    assert any("washed off with detergent" in name for name in left)


@pytest.mark.slow
def test_the_same_shoe_twice_shares_its_chance():
    table = small_place()
    table["shoe"] = [{**table["shoe"][1], "name": name} for name in ("one", "two")]
    answer = choose_shoe(place_of(table))
    assert [each.best for each in answer.shoes] == pytest.approx([0.5, 0.5])
    assert answer.shoes[0].slips == answer.shoes[1].slips
    assert any("same shoe twice" in text for text in answer.cautions())
    assert "can't be told" in answer.headline()[0]


def test_what_a_pendulum_read_goes_into_a_case(tmp_path):
    case = Case(
        shoe="work_shoe_untreaded",
        floor={"roughness": {}},
        contaminant="water",
        motion="whole_shoe_g6",
        friction={"model": "pair"},
    )
    low, high = (calibrated_floor(case, "pendulum-96", ptv) for ptv in (18.0, 40.0))
    assert low.after[1] < high.after[1]
    cofs = []
    for told in (low, high):
        path = tmp_path / f"{told.readings[0].value:g}.csv"
        told.draws.write(path)
        named = case.replace({"friction.draws_file": str(path)})
        law = named.friction.build(resolve_context(named))
        drawn = law.joint_draws(1000, 0)
        cofs.append(float(np.median(drawn["kappa"])))
    assert cofs[0] < cofs[1]


def test_a_reading_of_the_case_does_not_count_in_the_file_too():
    text = """
    shoe = "work_shoe_full_tread"
    floor.roughness = {}
    contaminant = "detergent"
    motion = "slip_tester_g4"
    friction = {model = "pair_read", ptv_96 = 36}
    """
    case = Case.from_text(text)
    with pytest.raises(InputError, match="the case holds what"):
        calibrated_floor(case, "pendulum-96", 36.0)
    told = calibrated_floor(case, "pendulum-55", 30.0)
    assert [one.value for one in told.beside] == [36.0]
    without = Case.from_text(text.replace("ptv_96 = 36", "ptv_96 = 60"))
    assert calibrated_floor(without, "pendulum-55", 30.0).after == told.after


def test_the_setting_of_17_deg_is_a_method_of_the_catalogue():
    case = Case(
        shoe="work_shoe_untreaded", floor="vinyl", contaminant="water", motion="whole_shoe_g6"
    )
    assert method_name("slip-prediction-17-deg", case) == "slip_prediction_17_deg"


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_examples_are_places(path):
    place = place_of(tomllib.loads(path.read_text(encoding="utf-8")))
    assert sum(floor.share for floor in place.floors) == pytest.approx(1)
    for floor in place.floors:
        for fluid in set(floor.fluids) - {"dry"}:
            assert place.case(place.shoes[0], floor, fluid).contaminant is not None


def changed(**changes):
    table = small_place()
    for path, value in changes.items():
        section, _, key = path.partition("__")
        if not key:
            table[section] = value
        elif isinstance(table[section], list):
            table[section][0][key] = value
        else:
            table[section][key] = value
    return table


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"fluids": {"dry": 0.5, "water": 0.4}}, "add to 0.9"),
        ({"fluids": {"dry": 1.0}}, "every floor is dry"),
        ({"floor__reading": [{"machine": "pendulum-96", "value": 350}]}, "350 is no reading"),
        ({"floor__reading": [{"machine": "pendulum-96", "value": -3}]}, "-3 is no reading"),
        ({"floor__reading": [{"machine": "pendlum-96", "value": 36}]}, "pendulum-96"),
        ({"floor__reading": [{"value": 36}]}, "without the machine"),
        (
            {"floor__reading": [{"machine": "pendulum-96", "value": 36, "fluid": "oil"}]},
            "does not read oil",
        ),
        ({"floor__slope": "60 deg"}, "60 deg is no floor"),
        ({"floor__ptv": 36}, "ptv"),
        ({"shoe__reading": [{"test": "tile_glycerin", "cof": 0.2}]}, "tile_glycerine"),
        ({"shoe__class": "EN ISO 20345 SRX"}, "EN ISO 20345 SR"),
        ({"shoe__name": "treaded"}, "stands twice"),
        ({"shoe__wear_per_month": "0.1 mm"}, "months"),
        ({"shoe": []}, "is missing"),
        ({"shoe__worn_region": "30 mm"}, "length along"),
        ({"shoe__worn_region": ["30 mm", "300 mm"]}, "300 mm"),
        (
            {
                "shoe__worn_region": ["3 mm", "3 mm"],
                "shoe__wear_per_month": "1 mm",
                "shoe__months": 3,
            },
            "beside wear_per_month",
        ),
        ({"floor__reading": [{"machine": "ramp-oil", "value": 60}]}, "60 is no reading"),
        ({"floor__reading": {"machine": "ramp-oil", "value": 12}}, r"reading: .*a list of tables"),
        ({"floor__reading": [{"machine": "ramp-oil"}]}, "reading 1.value: is missing"),
        ({"floor__reading": [{"machine": "pendulum-96", "value": 0.41}]}, "0.41 is no reading"),
        ({"floor__reading": [{"machine": "ramp-oil", "value": 0.21}]}, "0.21 is no reading"),
        ({"shoe__reading": [{"test": "tile_glycerine"}]}, "reading 1.cof: is missing"),
        ({"people": {"rcof_mean": 0.2, "task": [{"rcof": 0.3}]}}, "each task has its own rcof"),
        (
            {"shoe": [one | {"present": True} for one in small_place()["shoe"]]},
            "shoe.present: 2 shoes: smooth, treaded",
        ),
        (
            {"floor": [{**small_place()["floor"][0], "area": 60}, DRY]},
            "floor store.area: is missing, other floors have one",
        ),
        (
            {"floor": [small_place()["floor"][0] | {"fluids": {"dry": 0.9, "water": 0.1}}]},
            "fluids: each floor has its own",
        ),
        ({"floor__reading": [{"machine": "bot-3000e", "value": True}]}, "True"),
        ({"floor__area": 0}, "area"),
        ({"fluids": {"dry": 0.5, "watr": 0.5}}, 'floor hall.fluids.*"water'),
        ({"fluids": {"dry": 0.5, "dust": 0.5}}, "floor hall.fluids.*dust"),
        ({"floor__from": "quary_tile"}, "floor hall.from.*quarry_tile"),
        ({"shoe__from": "work_sho"}, "shoe smooth.*work_sho"),
        ({"people": {"task": [{"name": "walking", "share": 0.5}]}}, "add to 0.5"),
        ({"people": {"rcof_mean": 20}}, "20"),
        ({"floor__rz": "50 um"}, "floor hall.rz: stands beside roughness"),
        ({"floor": [*small_place()["floor"], DRY | {"from": "quary_tile"}]}, "floor store.from"),
        ({"shoe__present": "false"}, "shoe smooth.present: 'false'. Allowed: true or false"),
        ({"shoe__wear": {"depth": "1 mm"}, "shoe__worn_region": ["9 mm", "9 mm"]}, "smooth.wear"),
        (
            {"shoe__wear": {"depth": "2 mm"}, "shoe__wear_per_month": "1 mm", "shoe__months": 1},
            "smooth.wear: stands beside",
        ),
        ({"shoe__reading": [READ | {"sd": "0.02"}]}, "shoe smooth.reading 1.sd: '0.02'"),
        ({"shoe__class": 3}, 'shoe smooth.class: unknown slip class "3"'),
    ],
)
def test_bad_places_are_refused(changes, words):
    with pytest.raises((InputError, RangeError), match=words):
        place_of(changed(**changes))


def test_a_machine_outside_its_standard_calibrates_nothing():
    case = read_case(ptv_96=36)
    with pytest.raises(InputError, match=r"--fluid.*does not read oil.*water, dry"):
        calibrated_floor(case, "pendulum-96", 24.0, fluid="oil")


def test_readings_that_contradict_each_other_are_refused():
    joint, device = PlaceDraws(), machine("pendulum-96")

    def learned(values):
        for value in values:
            span = (3 * UM, 3 * UM)
            joint.learn(device.log_likelihood(joint, "hall", span, FLUIDS["water"], value), "hall")

    with pytest.raises(InputError, match="draws agree"):
        learned((4.0, 140.0) * 4)


def test_files_of_a_place_count_from_its_folder(tmp_path, monkeypatch):
    sole = Path(__file__).parents[1] / "data" / "soles" / "b_heel_bars.3mf"
    folder, other = tmp_path / "place", tmp_path / "other"
    (folder / "soles").mkdir(parents=True)
    other.mkdir()
    shutil.copy(sole, folder / "soles" / "sole.3mf")
    (folder / "place.toml").write_text(
        '[fluids]\nglycerol_90pct = 1.0\n[[floor]]\nname = "hall"\nroughness = { rq = "2 um" }\n'
        '[[shoe]]\nname = "own"\nfrom = "work_shoe_half_tread"\n'
        'outsole = { file = "soles/sole.3mf" }\n'
    )
    monkeypatch.chdir(other)
    place = read_place(folder / "place.toml")
    case = place.case(place.shoes[0], place.floors[0], "glycerol_90pct")
    assert bottom_surface(case).length == pytest.approx(0.075)
    (folder / "soles" / "sole.3mf").unlink()
    with pytest.raises(InputError, match=r"place/soles/sole\.3mf"):
        read_place(folder / "place.toml")


def test_the_repeat_of_a_reading_is_the_scatter_it_states():
    """One standard deviation off is e^-1/2 of the reading itself, whatever the deviation."""
    draws = SimpleNamespace(constants=SimpleNamespace(sd_reading=np.zeros(1)))
    for sd in (0.01, 0.04):
        reading = CofReading(0.4, "value", sd)
        off = np.array([0.4, 0.4 * math.exp(sd / 0.4)])
        at, beside = PlaceDraws.log_likelihood(draws, off, reading)
        assert at - beside == pytest.approx(0.5)


def test_a_friction_that_people_need_is_assumed_only_where_it_was_not_given():
    def asked(**people):
        return place_of(small_place() | {"people": people})

    def assumes(place):
        return any(each.startswith("people.rcof_mean") for each in place.assumed)

    walk, carry = {"name": "walking", "share": 0.5}, {"name": "carrying", "share": 0.5}
    assert assumes(asked(steps_per_day=5000))
    assert not assumes(asked(task=[walk | {"rcof": 0.19}, carry | {"rcof": 0.3}]))
    mixed = asked(task=[walk, carry | {"rcof": 0.3}])
    assert assumes(mixed)
    assert [task.rcof for task in mixed.tasks] == [0.20, 0.3]
    told = asked(rcof_mean=0.23, task=[walk, carry | {"rcof": 0.3}])
    assert not assumes(told)
    assert [task.rcof for task in told.tasks] == [0.23, 0.3]


@pytest.mark.parametrize(
    ("known", "worn"),
    [
        ({}, {"depth": 0.0}),
        (
            {"wear_per_month": "0.25 mm", "months": 4},
            {"depth": 1e-3, "angle": math.radians(7), "mode": "plane"},
        ),
        (
            {"worn_region": ["20 mm", "12 mm"]},
            {"mode": "patch", "patch_length": 20e-3, "patch_width": 12e-3},
        ),
    ],
)
def test_a_shoe_of_a_place_is_new_and_as_worn_as_its_file_says(known, worn):
    table = small_place()
    table["shoe"][1] |= known
    place = place_of(table)
    new, old = (
        place.case(place.shoes[1], place.floors[0], "water", worn=when) for when in (False, True)
    )
    assert new.value("shoe.wear.depth") == 0.0
    assert new.origins["shoe.wear.depth"].kind == "default"
    for name, value in worn.items():
        assert old.value(f"shoe.wear.{name}") == (value if name == "mode" else pytest.approx(value))
    if "worn_region" in known:  # it is through its tread
        assert old.value("shoe.wear.depth") == pytest.approx(new.value("shoe.tread.depth"))


@pytest.mark.parametrize(
    ("rest", "taken"), [(0.096, True), (0.104, True), (0.094, False), (0.106, False)]
)
def test_shares_add_to_one_within_half_a_percent(rest, taken):
    table = small_place() | {"fluids": {"dry": 0.9, "water": rest}}
    if taken:
        assert place_of(table).wet_share == pytest.approx(rest)
    else:
        with pytest.raises(InputError, match="add to"):
            place_of(table)


@pytest.mark.parametrize(("share", "left"), [(0.5, 390.0), (0.025, 4000.0)])
def test_the_fewest_draws_are_those_that_a_reading_leaves_of_equal_weight(share, left):
    """100 of 4,000 draws have ``share`` of the weight: 1 / (s^2 / 100 + (1 - s)^2 / 3900)."""
    joint = PlaceDraws(count=4000)
    weight = np.repeat([share / 100, (1 - share) / 3900], [100, 3900])
    unlike = np.unique(joint.constants.constants.kappa_0).size
    joint.learn(np.log(weight), "hall")
    assert joint.fewest == pytest.approx(min(left, unlike), abs=0.1)
    joint.learn(np.zeros(4000), "hall")  # what tells nothing
    assert joint.fewest == pytest.approx(min(left, unlike), abs=0.1)


@pytest.mark.parametrize("factor", [-1000.0, -300.0, 300.0, 1000.0])
def test_a_factor_of_all_likelihoods_teaches_nothing(factor):
    log = -0.5 * np.linspace(-2, 2, 4000) ** 2
    rows = [PlaceDraws(count=4000).learn(log + more, "hall") for more in (0.0, factor)]
    np.testing.assert_array_equal(*rows)


def test_only_the_roughness_of_a_floor_that_was_read_and_not_measured_is_told_anew():
    """Even between 1 and 16 um in the logarithm: median 4 um, 95 % within 16^0.95 = 13.9."""
    floors = [
        dataclasses.replace(place_of(small_place()).floors[0], name=name, readings=readings)
        for name, readings in (("read", ("a",)), ("unread", ()), ("measured", ("a",)))
    ]
    joint = SimpleNamespace(
        drawn_between=lambda name, ends: ends[0] * (ends[1] / ends[0]) ** np.linspace(0, 1, 4001)
    )
    ends = {"read": (UM, 16 * UM), "unread": (UM, 16 * UM), "measured": (3 * UM, 3 * UM)}
    place = SimpleNamespace(floors=floors)
    told = _read_floors(place, joint, ends)
    assert told.keys() == {"read"}
    rq = told["read"].section["roughness"]["rq"]
    assert rq["value"] == "4 um"
    deviation = 4 * 0.95 * math.log(16) / 3.92
    assert float(rq["uncertainty"].removesuffix(" um")) == pytest.approx(deviation, rel=1e-3)


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0123, "0.012"), (0.5, "0.5"), (1.04, "1"), (9.9, "9.9"), (10.4, "10"), (123.0, "120"),
     (4567.0, "4,600"), (987654.0, "990,000")],
)  # fmt: skip
def test_a_count_has_two_digits_and_no_exponent(value, text):
    assert _count(value) == text


def test_roughness_of_a_published_floor_is_printed_or_that_of_gaussian_heights():
    """Rq / Ra of normal heights is 1 over their mean distance from the middle."""
    ra = _floor_rq({"floor_ra": "2 um"}, "a")
    drawn = np.abs(np.random.default_rng(3).standard_normal(400_000)).mean()
    assert ra[0] == pytest.approx([2 * UM / drawn] * 2, rel=0.01)
    assert ra[1] is True
    assert _floor_rq({"floor_rq": {"value": "2 um"}}, "a") == ((2 * UM, 2 * UM), True)
    low, high = _floor_rq({"floor_rq": {"range": ["1 um", "3 um"]}}, "a")[0]
    assert (low, high) == pytest.approx((UM, 3 * UM))
    assert _floor_rq({"floor_rq": {"range": ["1 um", "3 um"]}}, "a")[1] is False


def test_steps_in_a_fluid_are_those_of_each_floor_by_its_area():
    """Three parts of a hall with 0.2 of its steps wet and one of a stair with 0.6."""
    table = small_place() | {"people": {"steps_per_day": 5000, "rcof_sd": 0.05}}
    del table["fluids"]
    hall = table["floor"][0] | {"area": 300, "fluids": {"dry": 0.8, "water": 0.2}}
    stair = hall | {"name": "stair", "area": 100}
    stair["fluids"] = {"water": 0.1, "dry": 0.4, "glycerol_90pct": 0.5}
    place = place_of(table | {"floor": [hall, stair]})
    assert [floor.share for floor in place.floors] == [0.75, 0.25]
    assert place.wet_share == pytest.approx(0.3)
    assert place.wet_steps == pytest.approx(1500)
    assert place.fluids() == ("glycerol_90pct", "water")
    assert (place.rcof_sd, place.steps, place.reported) == (0.05, 5000, None)
    assert not any("steps_per_day" in each for each in place.assumed)
    usual = place_of(small_place())
    assert (usual.rcof_sd, usual.steps, usual.tasks[0].rcof) == (0.03, 8000, 0.2)
    assert any("steps_per_day" in each for each in usual.assumed)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"people": {"days_per_year": 220}}, "people.days_per_year: no number"),
        ({"floor": [*small_place()["floor"], DRY]}, "floor.area: not given; each floor"),
        ({}, "people.rcof_sd: not given; 0.03"),
    ],
)
def test_what_a_place_leaves_open_or_says_in_vain_is_told(changes, told):
    assert any(each.startswith(told) for each in place_of(small_place() | changes).assumed)


def test_nothing_is_told_of_a_place_that_says_all():
    people = {"rcof_mean": 0.2, "rcof_sd": 0.03, "steps_per_day": 8000}
    assert place_of(small_place() | {"people": people}).assumed == ()


@pytest.mark.parametrize(
    ("key", "low", "high"),
    [
        ("rcof_mean", 0.05, 0.6),
        ("rcof_sd", 0.001, 0.2),
        ("steps_per_day", 1, 100_000),
        ("reported_slips", 0, 1_000_000),
    ],
)
def test_numbers_of_people_are_taken_from_end_to_end(key, low, high):
    for value in (low, high):
        place = place_of(small_place() | {"people": {key: value}})
        told = {
            "rcof_mean": place.tasks[0].rcof,
            "rcof_sd": place.rcof_sd,
            "steps_per_day": place.steps,
            "reported_slips": place.reported,
        }
        assert told[key] == value
    for value in (low - 1e-4, 1.001 * high):
        with pytest.raises(RangeError, match=f"people.{key}"):
            place_of(small_place() | {"people": {key: value}})


def test_a_printed_reading_is_of_a_floor_of_its_source_by_a_machine_with_its_fluid():
    told = evidence()
    assert {one.machine.name for one in told} <= set(machines())
    for one in told:
        assert one.floor.partition(", ")[2]
        assert one.floor not in one.source  # of several floors that one source reads
        for bound in one.bounds:
            assert bound.fluid == one.machine.fluid_of_standard()
        assert one.ends[0] <= one.ends[1]
        assert 0 < one.rq[0] <= one.rq[1] < 1e-3
