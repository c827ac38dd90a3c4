"""What cleaning a place leaves: fluids wiped up, oil washed off with detergent."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from underfoot.places import choice
from underfoot.places.cells import Cell
from underfoot.places.choice import WASHED
from underfoot.places.place import PlaceFloor, PlaceShoe

SHOE = PlaceShoe("old", {}, True, None, None, 0.0, None, None, ())
SLIPS = {"canola_oil": 0.4, "gear_oil_75w140": 0.3, "water": 0.1, WASHED: 0.2}


def floor(name, *fluids):
    return PlaceFloor(name, {"from": name}, 0.5, 0.0, False, dict.fromkeys(fluids, 0.1), ())


FLOORS = (
    floor("kitchen", "canola_oil", WASHED, "water"),
    floor("hall", "gear_oil_75w140", "water"),
)


@pytest.fixture
def cleaned(monkeypatch):
    """The levers of a place, and on which floors what was solved for them."""
    asked: list[Any] = []

    def cells(shoe, floors, worn):
        asked.append([shoe.name, [(each.name, dict(each.fluids)) for each in floors], worn])
        return {(each.name, WASHED): Cell(np.full(4, 0.15), 0.3, 0.1) for each in floors}

    # a cell carries its share of slips
    def slips(place, joint, given):
        return {key: cell.acof for key, cell in given.items()}

    monkeypatch.setattr(choice, "slips_in_cells", slips)
    monkeypatch.setattr(
        choice, "_is_oil", lambda place, shoe, fluid: fluid in ("canola_oil", "gear_oil_75w140")
    )

    def call(floors):
        fluids = dict.fromkeys(fluid for each in floors for fluid in each.fluids)
        place: Any = SimpleNamespace(floors=floors, fluids=lambda: list(fluids))
        new = {(each.name, fluid): Cell(np.full(4, SLIPS[fluid]), 0.3, 0.1)
               for each in floors for fluid in each.fluids}  # fmt: skip
        shares = {key: cell.acof for key, cell in new.items()}
        solver: Any = SimpleNamespace(joint=None, cells=cells)
        levers = choice._cleaning(place, solver, SHOE, new, shares)
        return [(str(one.name), one.left[1]) for one in levers], asked

    return call


def test_a_floor_that_meets_detergent_is_not_solved_again(cleaned):
    levers, asked = cleaned(FLOORS)
    assert asked == [["old", [("hall", {WASHED: 1.0})], False]]
    today = 0.4 + 0.2 + 0.1 + 0.3 + 0.1
    wiped = [(today - 0.5 * part) / today for part in (0.4, 0.2, 0.2, 0.3)]
    assert [left for _, left in levers[:-1]] == pytest.approx(wiped)
    assert all("wiped up sooner" in name for name, _ in levers[:-1])
    name, left = levers[-1]
    assert "washed off with detergent" in name
    # the kitchen as it is with detergent, the hall as it was solved
    assert left == pytest.approx((0.2 + 0.2 + 0.1 + 0.15 + 0.1) / today)


def test_without_oil_or_with_detergent_everywhere_nothing_is_solved(cleaned):
    levers, asked = cleaned([replace(each, fluids={"water": 0.1}) for each in FLOORS])
    assert len(levers) == 1
    levers, asked = cleaned(
        [replace(each, fluids={"gear_oil_75w140": 0.1, WASHED: 0.1}) for each in FLOORS]
    )
    assert len(levers) == 3
    assert asked == []
    assert levers[-1][1] == pytest.approx(0.8 / 1.0)
