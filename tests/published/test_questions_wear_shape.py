"""Friction over the wear of a tread, as published: it rises first, then falls to that of none."""

from pathlib import Path

import numpy as np
import pytest

from underfoot import Case
from underfoot.questions.wear import MAPS, trends, wear_series
from underfoot.report.dispatch import files

OUTSOLES = Path(__file__).parents[2] / "examples" / "outsoles"

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def series():
    case = Case.load(OUTSOLES / "heel_hexagons_glycerol.toml")
    # a heel that is new: the example's is ground flat at the tester's angle already
    rounded = {"model": "rocker", "radius": "120 mm", "start": "30 mm"}
    case = case.replace({"shoe.heel.profile": rounded, "numerics.tread_positions": 1})
    return wear_series(case, steps=4, band=False)


def test_friction_rises_and_falls_to_that_of_the_same_sole_without_tread(series):
    """Hemler et al. 2019 saw both; the end is ours: nothing of the tread bears any more."""
    cof = series.values("cof")
    highest = int(cof.argmax())
    assert 0 < highest < cof.size - 1
    assert (np.diff(cof[: highest + 1]) > 0).all()
    assert (np.diff(cof[highest:]) < 0).all()
    assert cof[highest] > 1.01 * cof[0]
    assert cof[-1] == pytest.approx(series.untreaded.number("cof"), rel=0.1)
    slight = next(each for each in trends(series) if "rises" in each.finding)
    assert slight.agrees


def test_every_state_keeps_its_sole_and_the_pressures_on_it(series, tmp_path):
    files(series)["wear.nc"](tmp_path / "wear.nc")
    import xarray

    with xarray.open_dataset(tmp_path / "wear.nc") as kept:
        cell = 1e-6  # m2
        for number, point in enumerate(series.points):
            state = kept.isel(state=number)
            bare = ~np.isfinite(state.height.values)
            # steep land is longer than its place on the floor: some cells are passed over
            for name in MAPS:
                assert np.isnan(state[name].values[bare]).all()
                solved = float(point.outcome.maps[name].sum()) * cell
                assert float(state[name].sum()) * cell == pytest.approx(solved, rel=0.06, abs=1)
            both = float(state.fluid_pressure.sum() + state.contact_pressure.sum()) * cell
            assert both == pytest.approx(500, rel=0.1)
            assert float(state.fluid_pressure.max()) < 2e6  # no channel's floor bears like a pillar
