"""Roughness that is none is refused with the limit and why."""

from pathlib import Path

import pytest

from underfoot.case import Case
from underfoot.case.errors import CaseError
from underfoot.core import RangeError

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
