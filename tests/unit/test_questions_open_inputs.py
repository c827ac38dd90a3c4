"""Which inputs are open, and by how much; changes with one chance go by their friction."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.fluid import glycerol_water_viscosity
from underfoot.questions.risk import RiskAssessment
from underfoot.questions.sensitivity import OPEN_INPUTS, OpenInput, open_inputs
from underfoot.questions.separation import ANGLES, _conditions

EXAMPLE = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"


def test_the_viscosity_moves_as_1_to_2_kelvin_of_the_room_move_it():
    (viscosity,) = (one for one in OPEN_INPUTS if one.path == "contaminant.viscosity")
    assert viscosity.ratio
    for share in (0.9, 0.98):
        near, far = (
            glycerol_water_viscosity(share, 293.15) / glycerol_water_viscosity(share, 293.15 + k)
            for k in (1.0, 2.0)
        )
        assert near <= viscosity.deviation <= far


def test_an_input_is_open_whether_it_was_measured_or_assumed_unless_it_says_otherwise():
    path = "shoe.sole.outsole_thickness"
    assumed = Case.load(EXAMPLE)
    given = assumed.replace(path, "8 mm")
    assert [case.sourced_value(path).assumed for case in (assumed, given)] == [True, False]
    for always, counted in ((OpenInput(path, 5e-3, "made up"), 2),
                            (OpenInput(path, 5e-3, "made up", only_assumed=True), 1)):  # fmt: skip
        assert sum(len(open_inputs(case, [always])) for case in (assumed, given)) == counted


def test_of_changes_with_one_chance_to_slip_the_one_with_more_friction_comes_first():
    def change(name, slip, cof):
        lever = SimpleNamespace(lever="floor")
        numbers = {"slip_probability": slip, "cof": cof}
        return SimpleNamespace(name=name, number=numbers.get, higher=0.99, change=lever)

    changes = [change("a", 0.2, 0.10), change("b", 0.2, 0.14), change("c", 0.1, 0.11)]
    risk: Any = SimpleNamespace(
        outcome=change("now", 0.5, 0.1), effective=changes, _same_chance=lambda _: False
    )
    best = cast(Any, RiskAssessment.best).fget(risk)
    assert [one.name for one in best] == ["c", "b", "a"]


@pytest.mark.parametrize("angle", [7.0, 7.9, 11.5])
def test_two_cases_are_told_apart_at_shoe_angles_other_than_their_own(angle):
    case = Case.load(EXAMPLE).replace("motion.shoe_angle", f"{angle} deg")
    asked = list(_conditions(case, case.replace("shoe.material.shore_a", 55)))
    angles = [float(np.degrees(value)) for kind, value, _ in asked if kind == "angle"]
    assert angles == pytest.approx([one for one in ANGLES if abs(one - angle) > 1])
    assert len(angles) == len(ANGLES) - any(abs(one - angle) <= 1 for one in ANGLES)
