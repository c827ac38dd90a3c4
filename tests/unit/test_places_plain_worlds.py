"""Choices where the right one is plain: what a stand-in solves is the friction of each shoe."""

import pytest

from underfoot.places import choice
from underfoot.places.cells import Cell
from underfoot.places.place import place_of

SHOES = ("smooth", "treaded", "soft", "hard")


def place(present=""):
    return place_of(
        {
            "fluids": {"dry": 0.9, "glycerol_90pct": 0.1},
            "floor": [{"name": "hall", "from": "quarry_tile"}],
            "shoe": [
                {"name": name, "from": "work_shoe_untreaded"}
                | ({"present": True} if name == present else {})
                for name in SHOES
            ],
        }
    )


@pytest.fixture
def chosen(monkeypatch):
    """Return what chooses where each shoe has an available friction of its own, all but exact."""

    def choose(frictions, **given):
        class Solver:
            def __init__(self, place, joint, *_):
                self.joint = joint

            def cells(self, shoe, floors, worn):
                acof = frictions[shoe.name] + 1e-3 * self.joint.normal("friction of all")
                wet = [(floor.name, fluid) for floor in floors for fluid in floor.fluids]
                return {key: Cell(acof, float(acof.mean()), 0.3) for key in wet if key[1] != "dry"}

        monkeypatch.setattr(choice, "PlaceSolver", Solver)
        return choice.choose_shoe(place(**given))

    return choose


@pytest.mark.parametrize("best", ["treaded", "soft", "hard"])
def test_the_shoe_with_most_friction_is_best_and_is_what_replaces_the_present_one(chosen, best):
    frictions = dict.fromkeys(SHOES, 0.15) | {"smooth": 0.12, best: 0.25}
    made = chosen(frictions)
    assert {each.shoe.name: each.best for each in made.shoes}[best] == pytest.approx(1.0)
    slips = {each.shoe.name: each.slips.value for each in made.shoes}
    assert min(slips, key=slips.__getitem__) == best
    assert max(slips, key=slips.__getitem__) == "smooth"
    (instead,) = (str(each.name) for each in made.levers if "instead of" in str(each.name))
    assert instead == f"{best} instead of smooth"


def test_nothing_is_gained_by_the_next_best_of_a_place_whose_shoe_is_best(chosen):
    made = chosen({"smooth": 0.12, "treaded": 0.3, "soft": 0.2, "hard": 0.15}, present="treaded")
    assert made.present == "treaded"
    (instead,) = (each for each in made.levers if "instead of" in str(each.name))
    assert str(instead.name) == "soft instead of treaded"
    assert instead.left[1] > 1
    assert instead.fewer == 0
    assert "instead of" not in " ".join(map(str, made.headline()))


def test_shoes_alike_share_the_chance_of_being_best(chosen):
    made = chosen({"smooth": 0.12, "treaded": 0.3, "soft": 0.3, "hard": 0.15})
    chances = {each.shoe.name: each.best for each in made.shoes}
    assert chances == pytest.approx({"smooth": 0, "treaded": 0.5, "soft": 0.5, "hard": 0}, abs=1e-9)
