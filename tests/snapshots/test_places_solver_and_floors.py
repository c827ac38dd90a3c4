"""In which order floors and fluids of a place are solved, floors that were read, likeness."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from underfoot.core import ConvergenceError, InputError
from underfoot.places import cells, choice, evidence
from underfoot.places.place import PlaceFloor, PlaceShoe

VISCOSITY = {"water": 1e-3, "glycerol": 0.2, "canola": 0.06, "gas": None}


def floor(name, fluids, readings=(), **section):
    shares = dict.fromkeys(fluids, 0.1)
    return PlaceFloor(name, {"from": name, **section}, 0.5, 0.0, False, shares, tuple(readings))


SHOE = PlaceShoe("old", {}, True, None, None, 0.0, None, None, ())
HALL = floor("hall", ("water", "dry", "glycerol"))
KITCHEN = floor("kitchen", ("canola", "gas"))


@pytest.fixture
def asked(monkeypatch):
    """What is begun and continued; a case is its floor and fluid."""
    told: list[Any] = []

    class March:
        def __init__(self, case, quick):
            self.case, self.values = case, {"of": case.hash}
            told.append(["begun", case.hash, quick])

        def continue_march(self, changes, drawn):
            told.append(["continued", changes["floor"], changes["contaminant"], drawn])
            if changes["contaminant"] == "water":
                raise ConvergenceError("it does not", where="here", remedy="none")
            if changes["contaminant"] == "gas":
                raise InputError("it is none", where="here", allowed="a liquid")
            return SimpleNamespace(values={"of": f"continued {changes['contaminant']}"})

    monkeypatch.setattr(cells, "Continuation", March)
    monkeypatch.setattr(cells, "film_odds_over_positions", lambda case: f"moved {case.hash}")
    monkeypatch.setattr(cells, "tread_place", lambda case: f"tread of {case.hash}")
    monkeypatch.setattr(
        cells, "law_of_pair", lambda case: SimpleNamespace(pair=f"pair {case.hash}")
    )
    monkeypatch.setattr(
        cells, "resolve_context", lambda case: SimpleNamespace(viscosity_value=case.viscosity)
    )
    monkeypatch.setattr(
        cells.PlaceSolver, "_cell",
        lambda self, case, values, march, shoe, floor, pair, moved, tread: (
            case.hash, values["of"], march.case.hash, shoe.name, floor.name, pair, moved, tread),
    )  # fmt: skip
    return told


def case_of(shoe, at, fluid, worn):
    name = f"{shoe.name}{' worn' * worn} on {at.section['from']}, {fluid}"
    return SimpleNamespace(hash=name, viscosity=VISCOSITY[fluid])


def test_a_sole_is_marched_in_its_thickest_fluid_and_continued_to_the_others(asked):
    place: Any = SimpleNamespace(case=case_of)
    read = floor("read", ("water",))
    solver = cells.PlaceSolver(place, Any, True, {"hall": read})  # type: ignore[arg-type]
    first = "old on read, glycerol"
    rest = ("old", "pair old on {}, {}", f"moved {first}", f"tread of {first}")
    found = solver.cells(SHOE, (HALL, KITCHEN), False)
    assert found == {
        ("hall", "glycerol"): (first, first, first, "old", "hall", "pair old on hall, glycerol",
                               *rest[2:]),
        ("kitchen", "canola"): ("old on kitchen, canola", "continued canola", first, "old",
                                "kitchen", "pair old on kitchen, canola", *rest[2:]),
        ("hall", "water"): ("old on read, water", "old on read, water", "old on read, water",
                            "old", "hall", "pair old on hall, water", *rest[2:]),
        ("kitchen", "gas"): ("old on kitchen, gas", "old on kitchen, gas", "old on kitchen, gas",
                             "old", "kitchen", "pair old on kitchen, gas", *rest[2:]),
    }  # fmt: skip
    assert asked == [
        ["begun", first, True],
        ["continued", {"from": "kitchen"}, "canola", False],
        ["continued", {"from": "read"}, "water", False], ["begun", "old on read, water", True],
        ["continued", {"from": "kitchen"}, "gas", False], ["begun", "old on kitchen, gas", True],
    ]  # fmt: skip
    asked.clear()
    # the march of a sole stays, a worn one has its own
    solver.cells(SHOE, (HALL,), False)
    assert [each[0] for each in asked] == ["continued", "begun"]
    solver.cells(SHOE, (HALL,), True)
    assert asked[2] == ["begun", "old worn on read, glycerol", True]
    assert sorted(solver.marches) == [("old", False), ("old", True)]


def test_the_roughness_that_readings_leave_is_told_of_floors_that_were_read():
    draws = np.exp(np.linspace(math.log(2e-6), math.log(8e-6), 4001))
    asked = []

    def between(name, ends):
        asked.append((name, ends))
        return draws

    floors = (
        floor("read", ("water",), ["a reading"], roughness={"rq": "1 um", "slope": 0.2}),
        floor("bare", ("water",), ["a reading"]), floor("unread", ("water",)),
        floor("measured", ("water",), ["a reading"]),
    )  # fmt: skip
    place: Any = SimpleNamespace(floors=floors)
    ends = dict.fromkeys(("read", "bare", "unread"), (1e-6, 1e-5)) | {"measured": (2e-6, 2e-6)}
    made = choice._read_floors(place, SimpleNamespace(drawn_between=between), ends)  # type: ignore
    assert asked == [(f"roughness of floor {name}", (1e-6, 1e-5)) for name in ("read", "bare")]
    assert sorted(made) == ["bare", "read"]
    deviation = 4.0 * 0.95 * math.log(4) / 3.92
    rq = {"value": "4 um", "uncertainty": f"{deviation:.4g} um"}
    assert made["read"].section == {"from": "read", "roughness": {"rq": rq, "slope": 0.2}}
    assert made["bare"].section == {"from": "bare", "roughness": {"rq": rq}}


def test_how_alike_machines_find_a_floor(monkeypatch):
    monkeypatch.setattr(evidence, "DRAWS", 200)
    assert evidence.floor_likeness() == pytest.approx(0.64072, abs=1e-4)
    assert evidence.floor_likeness("safety_direct_coatings") == pytest.approx(0.57675, abs=1e-4)
