"""Draws of what a case states: more drag in a draw is more friction, more film is less contact."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from underfoot.compute.stated_spreads import ODDS
from underfoot.places import cells
from underfoot.places.cells import PlaceSolver, tread_place
from underfoot.places.joint import PlaceDraws
from underfoot.places.place import place_of

THICK = "glycerol_90pct"
TABLE = {
    "fluids": {"dry": 0.9, THICK: 0.1},
    "floor": [{"name": "hall", "roughness": {"rq": "2 um"}}],
    "shoe": [{"name": "smooth", "from": "work_shoe_untreaded"}],
}
COF, FILM, VISCOUS = 0.13, 0.4, 0.03


@pytest.fixture(scope="module")
def cell():
    """Return a function: the draws of friction of a cell with draws of its stated values."""
    place = place_of(TABLE)
    shoe, floor = place.shoes[0], place.floors[0]
    case = place.case(shoe, floor, THICK)
    pair, tread = cells.law_of_pair(case).pair, tread_place(case)

    def made(draws, film=FILM, viscous=VISCOUS):
        joint = PlaceDraws()
        stated = SimpleNamespace(of=lambda given: SimpleNamespace(draws=lambda normal: draws))
        march: Any = SimpleNamespace(spreads={}, stated=stated)
        load = film * case.motion.normal_force
        values = {"cof": COF, "cof_viscous": viscous, "fluid_load": load}
        solver = PlaceSolver(place, joint, True, {})
        return solver._cell(case, values, march, shoe, floor, pair, np.zeros(1), tread).acof

    return made


def test_drag_grows_with_its_draws(cell):
    count = PlaceDraws().count
    grown = np.linspace(-0.5, 0.5, count)
    plain, drawn = cell({}), cell({"viscosity": {"cof_viscous": grown}})
    both = cell({"viscosity": {"cof_viscous": grown}, "speed": {"cof_viscous": grown}})
    # the drag alone is 0.03 times the share of the film, whatever the contact rubs
    drag = plain - cell({}, viscous=0.0) * (COF - VISCOUS) / COF
    assert np.median(drag) == pytest.approx(VISCOUS, rel=0.05)
    assert drawn - plain == pytest.approx(drag * np.expm1(grown), abs=1e-9)
    assert both - plain == pytest.approx(drag * np.expm1(2 * grown), abs=1e-9)


def test_more_film_takes_from_the_contact(cell):
    count = PlaceDraws().count
    more = {"pool": {ODDS: np.full(count, 0.7)}}
    less, plain = cell({}, viscous=0.0), cell(more, viscous=0.0)
    assert (plain < less).all()
    # of the odds of the middle draw
    odds = FILM / (1 - FILM)
    expected = (1 / (1 + odds * np.exp(0.7))) / (1 / (1 + odds))
    assert np.median(plain / less) == pytest.approx(expected, rel=0.02)


def test_a_film_that_carries_nothing_has_no_draws(cell):
    bare = cell({}, film=0.0)
    drawn = cell({"viscosity": {"cof_viscous": np.full(bare.size, 3.0), ODDS: 1.0}}, film=0.0)
    assert np.array_equal(bare, drawn)
