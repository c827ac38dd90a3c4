"""Sweeps and optimisations of a case from Python, without a study file."""

from pathlib import Path

import numpy as np
import pytest

import underfoot as uf
from underfoot.core import InputError

EXAMPLES = Path(__file__).parents[2] / "examples"
GRID = {
    "numerics.grid_spacing": "3 mm",
    "numerics.quick_grid_spacing": "3 mm",
    "numerics.tread_positions": 1,
}


@pytest.fixture(scope="module")
def case():
    return uf.load(EXAMPLES / "work_shoe_untreaded_glycerol.toml").replace(GRID)


@pytest.mark.slow
def test_a_sweep_gives_what_the_runs_of_its_cases_give(case, tmp_path):
    speeds = [0.3, 0.7]
    conditions = {"contaminant": ["glycerol_90pct", "canola_oil"]}
    found = uf.sweep(case, {"motion.speed": speeds}, conditions=conditions, folder=tmp_path)
    assert found["cof"].dims == ("design", "condition", "draw")
    assert list(found["condition"].values) == conditions["contaminant"]
    assert found["motion.speed"].values.tolist() == speeds
    assert (found["fluid_load"].attrs["units"], found["motion.speed"].attrs["units"]) == (
        "N",
        "m/s",
    )
    alone = uf.run(case.replace({"motion.speed": 0.7, "contaminant": "canola_oil"}), quick=True)
    one = found.isel(design=1, draw=0).sel(condition="canola_oil")
    assert float(one["cof"]) == pytest.approx(alone.scalars["cof"].value, rel=1e-12)
    assert set(found["ending"].values.ravel()) == {"computed"}


@pytest.mark.slow
def test_an_optimisation_beats_the_designs_that_it_began_with(case, tmp_path):
    found = uf.optimise(
        # at an instant the film is smooth on a grid as coarse as this; of steady sliding it is not
        case.replace(
            {
                "numerics.cells_along": 1,
                "motion.duration": "120 ms",
                "contaminant": "glycerol_50pct",
            }
        ),
        {"motion.speed": ("0.2 m/s", "0.8 m/s"), "shoe.material.shore_a": (50.0, 70.0)},
        minimise=["fluid_load"],
        require=["cof > 0.005"],
        budget=18,
        folder=tmp_path,
    )
    assert found.endings == {"computed": 18 + 10 + 1}  # the ten best again, and the start
    values = found.goal_values(found.designs)[:, 0]
    (best,) = found.best(1)
    assert best.number >= 10  # of those that the surrogate proposed
    assert best.again
    assert values[best.number] < 0.99 * values[:10].min()
    assert (found.margins([best]) >= 0).all()
    again = uf.Study.load(tmp_path).result()  # what it left in its folder
    assert np.array_equal(again.goal_values(again.designs)[:, 0], values)


def test_what_can_not_be_optimised_is_said_with_the_remedy(case):
    with pytest.raises(InputError, match=r"there is no goal.*Write maximise"):
        uf.optimise(case, {"motion.speed": (0.3, 0.7)})
    with pytest.raises(InputError, match=r'unknown output "grip".*cof'):
        uf.optimise(case, {"motion.speed": (0.3, 0.7)}, maximise=["grip"])
