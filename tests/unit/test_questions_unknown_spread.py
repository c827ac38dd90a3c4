"""What is given counts in every answer, or the answer says that it does not."""

from pathlib import Path

import pytest

from underfoot.case import Case
from underfoot.compute.run import run
from underfoot.questions.method import method_prediction
from underfoot.questions.wear import wear_series

EXAMPLE = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"
COARSE = {
    "numerics.quick_grid_spacing": "4 mm",
    "numerics.grid_spacing": "4 mm",
    "numerics.tread_positions": 1,
    "contaminant": "none",
}
AS_GIVEN = ("floor", "contaminant", "normal_force", "shoe_angle", "speed")


def dry(**friction):
    return Case.load(EXAMPLE).replace({**COARSE, "friction": {"model": "constant", **friction}})


def test_the_spread_of_the_whole_counts_beside_its_hysteresis_part():
    spread = {"value": 0.5, "uncertainty": 0.02}
    whole, parted = (
        run(case, quick=True)["cof"]
        for case in (dry(cof=spread), dry(cof=spread, hysteresis_cof=0.1))
    )
    assert whole.uncertainty == pytest.approx(0.02, rel=0.05)
    assert parted.uncertainty == pytest.approx(whole.uncertainty)


@pytest.mark.parametrize(
    ("cof", "chance"),
    [(0.31, None), ({"value": 0.31, "uncertainty": 0.02}, 0.5)],
)
def test_a_test_is_passed_with_no_chance_that_nobody_can_know(cof, chance):
    asked = {"quick": True, "with_band": False, "keep": AS_GIVEN}
    first = method_prediction(dry(cof=cof), "iso13287", **asked).conditions[0]
    assert first.limit.value == 0.31
    assert first.cof.value == pytest.approx(0.31)
    assert first.probability == (chance if chance is None else pytest.approx(chance, abs=1e-6))
    assert (first.low is None) == (chance is None)
    assert ("no interval" in first.sentence) == (chance is None)


def test_a_spread_beyond_all_friction_is_an_answer_as_wide_as_it():
    wide = run(dry(cof={"value": 0.3, "uncertainty": 0.6}), quick=True)["slip_probability"]
    assert wide.interval[0] < 0.01
    assert wide.interval[1] > 0.99


def test_a_worn_shoe_is_not_taken_for_a_new_one_in_silence():
    fine = {"numerics.quick_grid_spacing": "2 mm", "numerics.grid_spacing": "2 mm"}
    worn = {"shoe": "work_shoe_full_tread", "shoe.wear.depth": "1.5 mm"}
    worn |= {"shoe.tread.lug_width": "8 mm", "shoe.tread.channel_width": "4 mm"}
    case = dry(cof=0.5).replace(fine).replace(worn)
    series = wear_series(case, steps=2, mode="plane", band=False)
    assert series.points[0].measures.removed_depth == 0.0
    assert any("shoe.wear.depth = 1.5 mm counts for nothing" in line for line in series.assumptions)
