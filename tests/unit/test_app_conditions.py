"""What a result was computed under stands beside its number: a variant's name may be older."""

import pytest

from underfoot import Case
from underfoot.app.pages.answer import conditions

CASE = Case.from_mapping(
    {
        "shoe": "work_shoe_full_tread",
        "floor": "vinyl_g4",
        "contaminant": "glycerol_90pct",
        "motion": "slip_tester_g4",
    }
)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"contaminant": "canola_oil"}, ("Canola oil", False)),
        ({"contaminant.viscosity": "41 cP"}, ("Glycerol 90 %, water 10 % (by volume)", True)),
        ({"contaminant": "none"}, ("", False)),
        ({"contaminant": {"viscosity": "41 cP"}}, ("", True)),
    ],
)
def test_floor_and_contaminant_are_those_of_the_case(changes, told):
    assert conditions(CASE.replace(changes))["contaminant"] == told
    assert conditions(CASE)["floor"] == ("Vinyl tile of the slip tester", False)
