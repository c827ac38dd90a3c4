"""Roughness that is none is refused with the limit and why; what is known of it counts."""

from pathlib import Path

import pytest

from underfoot.case import Case
from underfoot.case.errors import CaseError
from underfoot.compute.resolve import resolve_context
from underfoot.core import RangeError
from underfoot.places.machines import rq_of_rz
from underfoot.places.place import place_of

EXAMPLE = Path(__file__).parents[2] / "examples" / "work_shoe_half_tread_detergent.toml"


@pytest.mark.parametrize(
    ("settings", "where", "allowed"),
    [
        ({"interface.effective_rq": "500 um"}, "interface.effective_rq", "159 um"),
        (
            {"interface.effective_rq": "60 um", "contaminant.pool_depth": "0.1 mm"},
            "contaminant.pool_depth",
            "180 um",
        ),
        (
            {"shoe.roughness.rq": "100 um", "interface.roughness_beyond_cutoff": 3.0},
            "shoe.roughness",
            "53.1 um",
        ),
        ({"floor.roughness.rq": "150 um"}, "floor.roughness", "at most 10"),
    ],
)
def test_roughness_beyond_what_sole_and_pool_hold_is_refused(settings, where, allowed):
    with pytest.raises((CaseError, RangeError)) as refused:
        Case.load(EXAMPLE, settings=settings)
    assert where in str(refused.value)
    assert allowed in str(refused.value)


def test_rough_but_possible_interfaces_are_taken():
    assert Case.load(EXAMPLE, settings={"interface.effective_rq": "100 um"}).effective_rq.value


RZ = {"shoe": "work_shoe_half_tread", "contaminant": "water", "motion": "slip_tester_g4"}


@pytest.mark.parametrize("floor", [{}, {"from": "vinyl_g4"}, {"from": "vinyl_g3"}])
def test_rz_is_the_roughness_where_it_is_what_was_measured(floor):
    """Rz of a data sheet changed nothing beside an Rq or Ra of the catalogue, nor alone."""
    known = Case(**RZ, floor={**floor, "roughness": {"rz": "12 um"}}).floor.roughness
    assert (known.ra, known.rq) == (None, None)
    assert known.rq_or_estimate == pytest.approx(12e-6 / 32**0.5)
    law = Case(**RZ, floor={"roughness": {"rz": "12 um"}}).friction
    span = law.build(
        resolve_context(Case(**RZ, floor={"roughness": {"rz": "12 um"}}))
    ).pair.floor_rq
    assert span == pytest.approx((1.5e-6, 3e-6)) == rq_of_rz(12e-6)


def test_a_given_ra_or_rq_goes_before_rz_and_the_catalogue_keeps_its_numbers():
    for given, rq in (({"ra": "2 um"}, 2.5e-6), ({"rq": "5 um"}, 5e-6), ({}, 0.45e-6)):
        for rz in ({}, {"rz": "1.00 um"}):
            floor = {"from": "vinyl_g4", "roughness": given | (rz if given else {})}
            assert Case(**RZ, floor=floor).floor.roughness.rq_or_estimate == pytest.approx(
                rq, rel=0.01
            )


def test_rz_of_a_place_is_that_of_its_cases():
    table = {"fluids": {"dry": 0.9, "water": 0.1}, "shoe": [{"name": "a", "from": RZ["shoe"]}]}
    floor = {"name": "hall", "rz": "12 um"}
    place = place_of(table | {"floor": [floor]})
    found = place.case(place.shoes[0], place.floors[0], "water").floor.roughness
    told = Case(**RZ, floor={"roughness": {"rz": "12 um"}}).floor.roughness
    assert found.rq_or_estimate == told.rq_or_estimate
    assert found.rq_uncertainty == told.rq_uncertainty
