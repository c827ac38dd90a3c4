"""No number of a result lies beyond the load or what draws of its law allow."""

import sys
from pathlib import Path

import numpy as np
import pytest

from underfoot import Case, run
from underfoot.compute.position_draws import TreadPlace
from underfoot.compute.prepare import prepare_case
from underfoot.compute.solve import solved_at
from underfoot.core import UnderfootError

sys.path.insert(0, str(Path(__file__).parents[1]))
from random_cases import beyond_physics, drawn_case, drawn_pad
from small_pads import PAD

TESTER_PAD = {
    "shoe.material.shore_a": 95, "shoe.heel.length": "76 mm", "shoe.heel.width": "76 mm",
    "contaminant.viscosity": "50 cP", "motion.normal_force": "44.5 N", "motion.shoe_angle": "0 deg",
    "numerics.quick_grid_spacing": "2 mm",
}  # fmt: skip


@pytest.mark.slow
def test_a_flat_pad_that_floats_at_its_own_angle_has_an_answer():
    """Its contact beside that angle was drawn as a factor of nearly nothing: COF of 32."""
    case = Case.from_text(PAD).replace(TESTER_PAD)
    result = run(case, quick=True)
    film = result.data["position_fluid_load"].values
    assert film.max() > 0.98 * 44.5
    assert film.min() < 0.5 * 44.5
    assert beyond_physics(case, result) == []


@pytest.mark.slow
def test_a_tread_worn_through_has_an_answer_at_every_speed():
    """Cells pressed shut with liquid in them held Newton's method up at a third of the speeds."""
    pair = {"shoe": "work_shoe_full_tread", "floor": "vinyl_g4", "contaminant": "glycerol_90pct"}
    worn = Case(**pair, motion="slip_tester_g4").replace("shoe.wear.depth", "4 mm")
    for speed in ("0.64 m/s", "0.76 m/s", "0.88 m/s"):
        case = worn.replace("motion.speed", speed)
        _, contact = solved_at(prepare_case(case, 1.2e-3), TreadPlace(), 1.2e-3)
        assert contact.status.usable


@pytest.mark.slow
def test_cases_drawn_at_random_stay_within_physics():
    """``python tests/random_cases.py`` has as many as are asked for."""
    rng, answers = np.random.default_rng(41), 0
    for number in range(12):
        case = drawn_pad(rng) if number % 2 else drawn_case(rng)
        try:
            coarse = {"numerics.quick_grid_spacing": "3 mm" if number % 2 else "1.6 mm"}
            case = case.replace(coarse)
            result = run(case, quick=True)
        except UnderfootError:
            continue
        if result.usable:
            answers += 1
            assert beyond_physics(case, result) == [], case.to_toml()
    assert answers > 6
