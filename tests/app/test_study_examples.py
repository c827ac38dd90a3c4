"""The worked studies of examples/studies, run small."""

import re
from pathlib import Path

import numpy as np
import pytest

from underfoot.explore import Study
from underfoot.explore.effects import effects
from underfoot.explore.posterior import posterior
from underfoot.explore.study_file import read_plan

STUDIES = Path(__file__).parents[2] / "examples" / "studies"


def small(name, folder, spacing, **smaller):
    """Return a study of the examples on a coarse grid, with smaller numbers by key."""
    text = (STUDIES / f"{name}.toml").read_text()
    for key, value in smaller.items():
        text, count = re.subn(rf"{key} = \d+", f"{key} = {value}", text)
        assert count == 1
    grid = {f"numerics.{which}": spacing for which in ("grid_spacing", "quick_grid_spacing")}
    fixed = "".join(f'"{key}" = "{value}"\n' for key, value in grid.items())
    fixed += "".join(f'"numerics.{key}" = 1\n' for key in ("tread_positions", "cells_along"))
    head, rest = text.split("\n[", 1)
    text = f"{head}\n[set]\n{fixed}\n[{rest}"
    return Study(read_plan(text, STUDIES), folder)


@pytest.mark.study
def test_which_measurement_is_worth_making(tmp_path):
    result = small("which_measurement", tmp_path, "2.5 mm", budget=32).run(workers=2)
    found = effects(result, result.plan.goals[0])
    assert found.total.sum() >= 0.9
    assert (found.main <= found.total + found.total_half + 0.05).all()
    # the heel's angle decides the film of a worn heel; 10 % of viscosity do not
    assert found.total[found.paths.index("shoe.heel.profile.angle")] > 0.2


@pytest.mark.slow
def test_grooves_across_and_along(tmp_path):
    study = small("groove_width", tmp_path, "1 mm", steps=2)
    result = study.run(workers=2)
    assert result.endings == {"computed": 4}
    lands = [one.records[0, 0].number("land") for one in result.designs]
    assert lands == pytest.approx([0.6] * 4, abs=0.06)


@pytest.mark.study
def test_a_clog_for_oil_and_detergent_over_its_wear(tmp_path):
    result = small("kitchen_clog", tmp_path, "1.1 mm", budget=16).run(workers=2)
    assert len(result.designs) == 4
    assert result.front
    for one in result.front:
        assert set(one.records) == {(state, 0) for state in range(4)}
        assert all(record.usable for record in one.records.values())
    assert (result.margins(result.front) >= 0).all()
    order = result.goal_values(result.front)
    assert (order[:-1, 0] >= order[1:, 0]).all()
    assert (order[:-1, 1] >= order[1:, 1]).all()


@pytest.mark.study
def test_own_readings_narrow_the_parameters(tmp_path):
    found = posterior(small("own_readings", tmp_path, "2 mm", budget=48), workers=2)
    assert found.usable
    # the readings tie roughness and angle together: the area of the cloud shrinks, not each side
    after, before = (np.linalg.det(np.cov(each.T)) for each in (found.draws, found.prior))
    assert after < before
