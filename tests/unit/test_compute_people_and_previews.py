"""Who slips in a case, and what a preview keeps of the case that it goes on from."""

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from underfoot.case import Case
from underfoot.compute import continuation
from underfoot.compute.slips import slip_population

EXAMPLE = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"


@pytest.fixture(scope="module")
def case():
    return Case.load(EXAMPLE)


@pytest.mark.parametrize(
    ("angle", "low"), [(13.0, 5.0), (9.5, 1.5), (7.0, 1.0), (1.0, 1.0), (0.5, 0.5), (0.0, 0.0)]
)
def test_shoe_angles_of_people_reach_8_degrees_to_either_side_but_not_below_1(case, angle, low):
    spread = slip_population(case.replace("motion.shoe_angle", f"{angle} deg")).shoe_angle
    assert [math.degrees(end) for end in (spread.low, spread.mean, spread.high)] == pytest.approx(
        [low, angle, angle + 8.0]
    )


@pytest.mark.parametrize(
    ("changes", "kept"),
    [
        ({}, True),
        ({"motion.normal_force": "400 N"}, True),
        ({"contaminant.viscosity": "41 cP"}, True),
        ({"shoe.wear.depth": "1 mm"}, False),
        ({"shoe.material.shore_a": 55}, False),
        ({"numerics.grid_spacing": "1 mm"}, False),
    ],
)
def test_a_preview_keeps_the_sole_where_nothing_makes_another(case, monkeypatch, changes, kept):
    asked = {}
    monkeypatch.setattr(continuation, "prepared", lambda *_, geometry: asked.update(at=geometry))
    parts: Any = SimpleNamespace(case=case, spacing=1e-3, sole="sole", compliance="compliance")
    continuation._changed(parts, case.replace(changes))
    assert asked["at"] == (("sole", "compliance") if kept else None)
