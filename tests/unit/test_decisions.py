"""Decisions on small worlds in which the right choice is plain: a table each, nothing solved."""

from pathlib import Path

import numpy as np
import pytest

from underfoot.case import load
from underfoot.explore.proposals import next_batch
from underfoot.explore.record import Ending, Record
from underfoot.explore.result import StudyResult
from underfoot.explore.study_file import read_plan
from underfoot.places.cells import Cell, PlaceSolver
from underfoot.places.choice import choose_shoe
from underfoot.places.place import place_of

EXAMPLES = Path(__file__).parents[2] / "examples"
WEARS = {"months": 10, "wear_per_month": "0.2 mm"}


def choice_of(monkeypatch, cofs, *, floors=("hall",), fluids=None, wears=()):
    """Return the choice between shoes whose COF (new, worn) is known in each cell.

    ``cofs`` is of a shoe a pair, or pairs by (floor, fluid).
    """

    def cells(solver, shoe, asked, worn):
        noise = np.exp(0.02 * solver.joint.normal(f"COF of {shoe.name}"))
        found = {}
        for floor in asked:
            for fluid in floor.fluids:
                told = cofs[shoe.name]
                pair = (
                    told if isinstance(told, tuple) else told.get((floor.name, fluid), (0.2, 0.2))
                )
                found[floor.name, fluid] = Cell(pair[worn] * noise, pair[worn], 0.0)
        return {key: cell for key, cell in found.items() if key[1] != "dry"}

    monkeypatch.setattr(PlaceSolver, "cells", cells)
    table = {
        "fluids": fluids or {"dry": 0.9, "water": 0.1},
        "floor": [{"name": name, "roughness": {"rq": "2 um"}, "area": area}
                  for name, area in (floors.items() if isinstance(floors, dict)
                                     else ((name, 1) for name in floors))],
        "shoe": [{"name": name, "from": "work_shoe_full_tread", "roughness": {"rq": f"{5 + k} um"},
                  **(WEARS if name in wears else {})}
                 for k, name in enumerate(cofs)],
    }  # fmt: skip
    return choose_shoe(place_of(table))


CHOICES = {
    "more friction": ({"a": (0.30, 0.30), "b": (0.20, 0.20)}, {}, "a"),
    "more friction, named second": ({"b": (0.20, 0.20), "a": (0.30, 0.30)}, {}, "a"),
    "better new, but it wears fast": (
        {"a": (0.24, 0.10), "b": (0.22, 0.21)},
        {"wears": "ab"},
        "b",
    ),
    "worse new, but it keeps its tread": (
        {"a": (0.18, 0.18), "b": (0.20, 0.08)},
        {"wears": "b"},
        "a",
    ),
    "the floor that is walked on most": (
        {
            "a": {("hall", "water"): (0.30, 0.30), ("yard", "water"): (0.18, 0.18)},
            "b": {("hall", "water"): (0.18, 0.18), ("yard", "water"): (0.30, 0.30)},
        },
        {"floors": {"hall": 1, "yard": 9}},
        "b",
    ),
    "the fluid that is there oftenest": (
        {
            "a": {("hall", "water"): (0.30, 0.30), ("hall", "canola_oil"): (0.15, 0.15)},
            "b": {("hall", "water"): (0.15, 0.15), ("hall", "canola_oil"): (0.30, 0.30)},
        },
        {"fluids": {"dry": 0.7, "water": 0.25, "canola_oil": 0.05}},
        "a",
    ),
}


@pytest.mark.parametrize("world", CHOICES)
def test_the_shoe_is_chosen_that_slips_least(world, monkeypatch):
    cofs, rest, best = CHOICES[world]
    told = choice_of(monkeypatch, cofs, **rest)
    assert told.first.shoe.name == best
    assert told.first.best > 0.9
    slips = {each.shoe.name: each.slips.value for each in told.shoes}
    assert min(slips, key=slips.__getitem__) == best
    assert told.headline()[0].startswith(f"{best} is best")


def test_fluids_are_told_by_their_names_not_by_their_keys(monkeypatch):
    cofs, rest, _ = CHOICES["the fluid that is there oftenest"]
    told = choice_of(monkeypatch, cofs, **rest)
    cells = [cell for table in told.tables() for row in table.cells() for cell in row]
    assert any("canola oil" in cell for cell in cells)
    assert not any("_" in cell for cell in cells)


def test_shoes_alike_share_the_chance_and_neither_is_best(monkeypatch):
    told = choice_of(monkeypatch, {"a": (0.2, 0.2), "b": (0.2, 0.2)})
    # each has its own error of 2 %
    assert [each.best for each in told.shoes] == pytest.approx([0.5, 0.5], abs=0.05)
    assert not told.headline()[0].startswith(("a is best", "b is best"))


def test_a_shoe_is_replaced_when_it_slips_twice_as_often(monkeypatch):
    cofs = {"fast": (0.24, 0.10), "slow": (0.24, 0.235), "new": (0.24, 0.24), "slick": (0.1, 0.05)}
    told = {
        each.shoe.name: each.replaced
        for each in choice_of(monkeypatch, cofs, wears=("fast", "slow", "slick")).shoes
    }
    assert told["fast"].startswith("after ")
    assert float(told["fast"].split()[1]) < 10
    assert told["slow"] == "not within its 10 months"
    assert told["new"] == ""
    # it slips in most of its steps, which no wear can double
    assert told["slick"].startswith("new already, it slips in ")


STUDY = """\
[vary]
"shoe.material.shore_a" = [40, 50, 60, 70]
[outputs]
maximise = ["cof"]
minimise = ["stiffness"]
require = ["fluid_load < 50 N"]
[method]
"""


def front_of(*rows):
    """Return which of four designs with given COF, stiffness (N/m) and load (N) are the front."""
    base = load(EXAMPLES / "work_shoe_full_tread_glycerol.toml")
    plan = read_plan(STUDY + 'kind = "sweep"\n', base=base, folder=".")
    jobs = list(next_batch(plan, StudyResult(plan, [], {})))
    records = {}
    for job, row in zip(jobs, rows, strict=True):
        numbers = None if row is None else dict(
            zip(("cof", "stiffness", "fluid_load"), row, strict=True)
        )  # fmt: skip
        records[job.key] = (
            Record(job.key, Ending.CRASHED, "killed")
            if numbers is None
            else Record(job.key, Ending.COMPUTED, numbers=numbers)
        )
    result = StudyResult(plan, jobs, records)
    return [one.number for one in result.front], [one.number for one in result.best(4)]


FRONTS = {
    "each best at one thing": (((0.3, 9, 1), (0.2, 5, 1), (0.1, 2, 1), (0.05, 1, 1)), [0, 1, 2, 3]),
    "one beats all": (((0.1, 9, 1), (0.2, 8, 1), (0.4, 1, 1), (0.3, 5, 1)), [2]),
    "the best fails its requirement": (
        ((0.1, 9, 1), (0.2, 8, 1), (0.4, 1, 90), (0.3, 5, 1)),
        [3],
    ),
    "one ties in all": (((0.3, 5, 1), (0.3, 5, 1), (0.1, 9, 1), (0.2, 7, 1)), [0]),
    "one ties in friction and is softer": (
        ((0.3, 5, 1), (0.3, 4, 1), (0.1, 9, 1), (0.2, 7, 1)),
        [1],
    ),
    "the best was not computed": ((None, (0.2, 4, 1), (0.1, 9, 1), (0.15, 5, 1)), [1]),
    "none meets it": (((0.3, 5, 60), (0.3, 4, 70), (0.1, 9, 80), (0.2, 7, 51)), []),
}


@pytest.mark.parametrize("world", FRONTS)
def test_on_the_front_stand_designs_that_none_beats_and_that_meet_what_is_required(world):
    rows, front = FRONTS[world]
    found, best = front_of(*rows)
    assert found == front
    assert best == front


def test_shoes_that_never_slip_share_the_chance_to_be_best(monkeypatch):
    told = choice_of(monkeypatch, dict.fromkeys("abc", (4.0, 4.0)) | {"d": (0.1, 0.1)})
    chances = {each.shoe.name: each.best for each in told.shoes}
    assert chances == pytest.approx({"a": 1 / 3, "b": 1 / 3, "c": 1 / 3, "d": 0}, abs=1e-9)
