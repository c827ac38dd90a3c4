"""A cell of a place, nothing solved: what parts of a contact add up to, and which end is which."""

import tomllib
from importlib import resources
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from underfoot.compute.stated_spreads import StatedEffects
from underfoot.core import InputError
from underfoot.friction.shoe_class import slip_tests
from underfoot.places import cells, choice
from underfoot.places.cells import PlaceSolver, film_odds_over_positions, tread_place
from underfoot.places.evidence import _of_file
from underfoot.places.joint import FLOOR_LIKENESS, CofReading, PlaceDraws
from underfoot.places.machines import FLUIDS, predicted_reading
from underfoot.places.place import place_of

THICK = "glycerol_90pct"
TABLE = {
    "fluids": {"dry": 0.8, THICK: 0.1, "water": 0.1},
    "floor": [{"name": "hall", "roughness": {"rq": "2 um"}}],
    "shoe": [{"name": "smooth", "from": "work_shoe_untreaded"}],
}


@pytest.fixture(scope="module")
def cell():
    """Return a function: the cell of a contact whose COF and film are said, not solved."""
    place = place_of(TABLE)
    joint = PlaceDraws()
    shoe, floor = place.shoes[0], place.floors[0]
    cases = {fluid: place.case(shoe, floor, fluid) for fluid in (THICK, "water")}
    solver = PlaceSolver(place, joint, True, {})

    def made(cof, film=0.0, viscous=0.0, fluid=THICK):
        case = cases[fluid]
        march: Any = SimpleNamespace(spreads={}, stated=StatedEffects())
        pair, tread = cells.law_of_pair(case).pair, tread_place(case)
        values = {
            "cof": cof,
            "cof_viscous": viscous,
            "fluid_load": film * case.motion.normal_force,
        }
        return solver._cell(case, values, march, shoe, floor, pair, np.zeros(1), tread)

    return made


@pytest.mark.parametrize("fluid", [THICK, "water"])
@pytest.mark.parametrize("film", [0.0, 0.3, 0.7])
@pytest.mark.parametrize("cof", [0.05, 0.2])
def test_the_middle_of_the_draws_is_the_cof_that_was_solved(cell, cof, film, fluid):
    one = cell(cof, film, fluid=fluid)
    assert one.solved == cof
    assert one.film_share == pytest.approx(film)
    assert np.median(one.acof) == pytest.approx(cof, rel=0.15)  # of the law's own medians


def test_friction_without_a_film_is_in_proportion_to_what_was_solved(cell):
    np.testing.assert_allclose(cell(0.1).acof, 2 * cell(0.05).acof, rtol=1e-9)


def test_a_film_that_carries_most_of_the_load_makes_friction_less_sure(cell):
    def spread(one):
        low, high = np.quantile(np.log(one.acof), (0.025, 0.975))
        return high - low

    assert spread(cell(0.1, 0.8)) > 1.2 * spread(cell(0.1, 0.1))


def test_what_the_film_drags_is_added_to_what_the_contact_rubs(cell):
    """0.03 of drag beside 0.1 of contact: the contact's part is that of 0.1 alone."""
    dragged = cell(0.13, 0.5, 0.03).acof - cell(0.1, 0.5).acof
    assert dragged.min() > 0
    assert np.median(dragged) == pytest.approx(0.03, rel=0.05)
    assert dragged.max() < 0.03 / 0.5  # the whole load on the film


def test_the_film_over_positions_is_told_against_the_tread_where_it_lies(monkeypatch):
    """Shares of 1/2, 2/3 and 1/3 of the load are odds of 1, 2 and 1/2."""
    treaded = {"shoe": [{"name": "treaded", "from": "work_shoe_full_tread"}]}
    place = place_of(TABLE | treaded)
    case = place.case(place.shoes[0], place.floors[0], THICK)
    loads = iter(np.array([1 / 2, 2 / 3, 1 / 3]) * case.motion.normal_force)
    monkeypatch.setattr(cells, "prepare_case", lambda *_: None)
    monkeypatch.setattr(cells, "places", lambda *_: [0, 1, 2])
    monkeypatch.setattr(cells, "solved_at", lambda *_: ())
    monkeypatch.setattr(cells, "place_numbers", lambda: {"fluid_load": next(loads)})
    np.testing.assert_allclose(film_odds_over_positions(case), np.log([1, 2, 0.5]), atol=1e-12)
    smooth = place_of(TABLE)
    case = smooth.case(smooth.shoes[0], smooth.floors[0], THICK)
    assert film_odds_over_positions(case).tolist() == [0.0]


def test_two_rubbers_find_one_wet_floor_alike_and_another_floor_not():
    joint = PlaceDraws()
    one, two, away = (
        joint.beyond_roughness(floor, name)
        for floor, name in (("hall", "pair: a"), ("hall", "pair: b"), ("yard", "pair: c"))
    )
    noise = 3 / np.sqrt(joint.count)
    assert np.corrcoef(one, two)[0, 1] == pytest.approx(FLOOR_LIKENESS, abs=noise)
    assert np.corrcoef(one, away)[0, 1] == pytest.approx(0.0, abs=noise)
    assert one.std() == pytest.approx(1.0, abs=noise)
    # oil tells nothing of what water finds
    oil = joint.beyond_roughness("hall", "pair: d", "oil")
    assert np.corrcoef(one, oil)[0, 1] == pytest.approx(0.0, abs=noise)


def test_an_upper_bound_takes_away_what_is_above_it_and_a_lower_one_what_is_below():
    joint, cof = PlaceDraws(count=2000), np.geomspace(0.05, 0.8, 2000)
    upper = np.exp(joint.log_likelihood(cof, CofReading(0.2, "upper")))
    lower = np.exp(joint.log_likelihood(cof, CofReading(0.2, "lower")))
    np.testing.assert_allclose(upper + lower, 1.0, atol=1e-9)
    assert upper[0] > 0.99 > 0.01 > upper[-1]
    value = joint.log_likelihood(cof, CofReading(0.2))
    assert cof[value.argmax()] == pytest.approx(0.2, rel=0.05)  # repeats vary a little by draw


def test_fluids_of_machines_are_as_thick_as_their_names_say():
    ends = {name: fluid.viscosity for name, fluid in FLUIDS.items() if fluid.viscosity}
    for name, (low, high) in ends.items():
        assert low <= high, name
    assert ends["water"] == pytest.approx((1.002e-3, 1.002e-3), rel=0.01)  # at 20 C
    # a drop of a detergent in water; a lubricating oil is a hundred times as thick
    assert all(0.9e-3 < each < 1.1e-3 for each in ends["detergent"])
    assert all(0.1 < each < 0.3 for each in ends["ramp oil"])


def test_settings_that_nobody_read_in_the_source_are_counted():
    told = predicted_reading("pendulum-96", (5e-6, 5e-6))
    settings = told.machine.entry.values.values()
    sure = [one for one in settings if one.verified and not one.assumed]
    line = next(each for each in told.cautions() if "settings of the set-up" in each)
    assert int(line.split()[0]) == len(settings) - len(sure)


@pytest.mark.parametrize(("before", "after"), [(0.1, 0.05), (0.1, 0.2)])
def test_the_mean_ratio_of_slips_lies_between_its_ends(before, after):
    spread = np.exp(0.1 * np.random.default_rng(3).normal(size=4000))
    low, middle, high = choice._slip_ratio(after * spread, np.full(4000, before))
    assert middle == pytest.approx(after / before, rel=0.02)
    assert low == pytest.approx(after / before * np.exp(-0.196), rel=0.02)
    assert high == pytest.approx(after / before * np.exp(0.196), rel=0.02)


@pytest.mark.parametrize(
    ("cof", "right"), [(0.02, True), (1.9, True), (0.009, False), (2.1, False)]
)
def test_a_reading_of_a_shoe_is_a_friction_that_a_machine_can_show(cof, right):
    test = next(iter(slip_tests()))
    for sd, named in ((2.0, True), (2.1, False)):
        shoe = {**TABLE["shoe"][0], "reading": [{"test": test, "cof": 0.3, "sd": sd}]}
        if named:
            assert place_of(TABLE | {"shoe": [shoe]}).shoes[0].readings[0].reading.sd == sd
        else:
            with pytest.raises(InputError, match=r"reading 1\.sd"):
                place_of(TABLE | {"shoe": [shoe]})
    shoe = {**TABLE["shoe"][0], "reading": [{"test": test, "cof": cof}]}
    if right:
        assert place_of(TABLE | {"shoe": [shoe]}).shoes[0].readings[0].reading.cof == cof
    else:
        with pytest.raises(InputError, match=r"reading 1\.cof"):
            place_of(TABLE | {"shoe": [shoe]})


def test_the_first_of_a_list_is_number_one():
    with pytest.raises(InputError, match=r"floor 1\.name"):
        place_of(TABLE | {"floor": [{"roughness": {"rq": "2 um"}}]})


def test_a_printed_rz_is_four_to_eight_rq_and_a_range_of_rq_is_taken_as_it_stands():
    text = resources.files("underfoot.places").joinpath("evidence.toml").read_text("utf-8")
    entries = tomllib.loads(text)["reading"]
    assert {"rz" in entry for entry in entries} == {True, False}
    for entry, one in zip(entries, _of_file(), strict=True):
        ends = [1e-6 * float(end.removesuffix(" um")) for end in entry.get("rz") or entry["rq"]]
        wanted = (ends[0] / 8, ends[1] / 4) if "rz" in entry else tuple(ends)
        assert one.rq == pytest.approx(wanted)
        assert one.printed == ("rz" in entry)
