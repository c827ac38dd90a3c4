"""A place said another way is the same place: order, names, units, scale, what does not count."""

import copy

import numpy as np
import pytest

from underfoot.places.cells import Cell, PlaceSolver
from underfoot.places.choice import choose_shoe
from underfoot.places.place import place_of

COF = {
    ("a", "hall"): 0.30, ("a", "yard"): 0.17, ("b", "hall"): 0.22, ("b", "yard"): 0.24,
    ("c", "hall"): 0.19, ("c", "yard"): 0.21,
}  # fmt: skip
PLACE = {
    "fluids": {"dry": 0.9, "water": 0.08, "glycerol_90pct": 0.02},
    "floor": [
        {"name": "hall", "roughness": {"rq": "2 um"}, "area": 3},
        {"name": "yard", "roughness": {"rq": "9 um"}, "area": 1},
    ],
    "shoe": [{"name": name, "from": "work_shoe_full_tread"} for name in "abc"],
}


@pytest.fixture(scope="module")
def answers():
    """Return a function: chance of being best and share of slips of each shoe of a place.

    COF is known in each cell, with an error of 3 % of each shoe; a name after "other " counts.
    """

    def plain(name):
        return name.removeprefix("other ")

    def cof(shoe, floor):  # a floor that a change would bring has one of its own
        return COF.get((plain(shoe.name), plain(floor.name)), 0.2)

    def cells(solver, shoe, asked, worn):
        noise = np.exp(0.03 * solver.joint.normal(f"COF of {plain(shoe.name)}"))
        return {
            (floor.name, fluid): Cell(cof(shoe, floor) * noise, 0.2, 0.0)
            for floor in asked
            for fluid in floor.fluids
            if fluid != "dry"
        }

    def answer(table):
        told = choose_shoe(place_of(table))
        return {plain(one.shoe.name): (one.best, one.slips.value) for one in told.shoes}, told

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(PlaceSolver, "cells", cells)
        yield answer


@pytest.fixture(scope="module")
def told(answers):
    """Return the numbers of the place as it stands, and all of its answer."""
    return answers(PLACE)


def changed(**parts):
    return {**copy.deepcopy(PLACE), **parts}


def other_names(rows):
    return [{**row, "name": f"other {row['name']}"} for row in rows]


SAME = {
    "shoes in another order": changed(shoe=PLACE["shoe"][::-1]),
    "floors in another order": changed(floor=PLACE["floor"][::-1]),
    "fluids in another order": changed(fluids=dict(reversed(PLACE["fluids"].items()))),
    "areas of another unit": changed(
        floor=[{**floor, "area": 1e4 * floor["area"]} for floor in PLACE["floor"]]
    ),
    "roughness in another unit": changed(
        floor=[
            {**floor, "roughness": {"rq": rq}}
            for floor, rq in zip(PLACE["floor"], ("0.002 mm", "9000 nm"), strict=True)
        ]
    ),
    "other names": changed(
        shoe=other_names(PLACE["shoe"]), floor=other_names(PLACE["floor"]), name="elsewhere"
    ),
    "prices": changed(shoe=[{**shoe, "price": 40 + k} for k, shoe in enumerate(PLACE["shoe"])]),
    "one floor as two halves": changed(
        floor=[
            {**PLACE["floor"][0], "area": 1.5},
            {**PLACE["floor"][0], "area": 1.5, "name": "other hall"},
            PLACE["floor"][1],
        ]
    ),
}


@pytest.mark.parametrize("way", SAME)
def test_a_place_said_in_another_way_has_the_same_answer(way, answers, told):
    (before, first), (after, again) = told, answers(SAME[way])
    assert set(after) == set(before)
    for name, numbers in before.items():
        assert after[name] == pytest.approx(numbers, rel=1e-9, abs=1e-12), name
    shares, moved = dict(first.sources), dict(again.sources)
    assert sum(moved.values()) == pytest.approx(sum(shares.values())) == pytest.approx(1.0)
    if set(moved) == set(shares) and again.present == first.present:
        assert moved == pytest.approx(shares)


def test_a_worse_shoe_takes_no_chance_and_moves_no_slips(answers, told, monkeypatch):
    monkeypatch.setitem(COF, ("d", "hall"), 0.05)
    monkeypatch.setitem(COF, ("d", "yard"), 0.05)
    before, _ = told
    more = [*PLACE["shoe"], {"name": "d", "from": "work_shoe_full_tread"}]
    after, _ = answers(changed(shoe=more))
    assert after.pop("d")[0] == 0.0
    for name, numbers in before.items():
        assert after[name] == pytest.approx(numbers)


def test_two_shoes_whose_friction_is_swapped_swap_their_answers(answers, told, monkeypatch):
    before, _ = told
    for floor in ("hall", "yard"):
        one, two = COF["a", floor], COF["b", floor]
        monkeypatch.setitem(COF, ("a", floor), two)
        monkeypatch.setitem(COF, ("b", floor), one)
    after, _ = answers(PLACE)
    # each shoe has an error of its own: the means differ by what is drawn
    assert after["a"] == pytest.approx(before["b"], rel=0.1, abs=0.02)
    assert after["b"] == pytest.approx(before["a"], rel=0.1, abs=0.02)
