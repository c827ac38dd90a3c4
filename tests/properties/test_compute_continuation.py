"""A solved case answers changes of it: against the march of the changed case, with its error."""

import numpy as np
import pytest
from scipy.interpolate import griddata

from underfoot.app.run_preview import of_run, preview_of_run
from underfoot.app.work import rolled_surface
from underfoot.case import Case
from underfoot.compute.continuation import Continuation, preview
from underfoot.core import ConvergenceError, InputError, SourcedValue, Status
from underfoot.report.results import designed_surface

CASE = Case.load("examples/work_shoe_full_tread_glycerol.toml")


@pytest.fixture(scope="module")
def solved():
    return Continuation(CASE)


def test_no_change_is_the_march_itself(solved):
    same = solved.continue_march({})
    assert same.status is Status.PREVIEW
    assert not same.status.usable
    for name, value in solved.values.items():
        assert same.values[name] == pytest.approx(value, rel=1e-9), name
    assert same.cof.value == pytest.approx(solved.values["cof"], rel=1e-9)
    assert same.cof_draws is not None
    assert same.cof_draws.std(ddof=1) == pytest.approx(same.cof.uncertainty, rel=1e-9)


@pytest.mark.parametrize(
    "change",
    [{"contaminant.viscosity": "150 cP"}, {"shoe.material.shore_a": 54}],
)
def test_a_change_is_within_one_percent_and_its_own_error(solved, change):
    seen, full = solved.continue_march(change), Continuation(CASE.replace(change)).values
    assert seen.values["cof"] == pytest.approx(full["cof"], rel=0.01)
    assert seen.values["fluid_load"] == pytest.approx(full["fluid_load"], rel=0.05)
    for name in ("cof", "fluid_load"):
        assert abs(seen.values[name] - full[name]) <= seen.errors[name]
    # far nearer than the unchanged case
    assert abs(seen.values["cof"] - full["cof"]) < 0.1 * abs(full["cof"] - solved.values["cof"])
    # pressures at the centres of cells, of which some are cut by an outline
    assert seen.total_pressure.sum() * solved.spacing**2 == pytest.approx(500.0, rel=0.05)


def whole(cof, load):
    """Return scalars of a whole run, (value, numerical error) of each."""
    return {
        "cof": SourcedValue(cof[0], numerical=cof[1]),
        "fluid_load": SourcedValue(load[0], "N", numerical=load[1]),
    }


def test_beside_a_whole_run_it_is_a_change_of_that_run(solved):
    run = whole((0.14, 0.002), (60.0, 7.0))
    same = of_run(solved, solved.continue_march({}), run)
    assert same.values["cof"] == pytest.approx(0.14)
    assert same.cof.value == pytest.approx(0.14)
    assert same.values["fluid_load"] == pytest.approx(60.0)
    # the numerical error of the run that was made, and of the one to come
    assert same.errors["cof"] >= 1.96 * 2**0.5 * 0.002
    assert same.errors["fluid_load"] >= 1.96 * 2**0.5 * 7.0
    change = {"contaminant.viscosity": "150 cP"}
    alone, beside = (
        solved.continue_march(change),
        of_run(solved, solved.continue_march(change), run),
    )
    share = alone.values["cof"] / solved.values["cof"]
    assert beside.values["cof"] == pytest.approx(0.14 * share)
    with pytest.raises(InputError, match="wear has no preview"):
        preview_of_run(CASE, {"shoe.wear.depth": "0.5 mm"}, run)


def test_the_film_never_bears_more_than_the_load(solved):
    seen = of_run(solved, solved.continue_march({}), whole((0.14, 0.001), (480.0, 1.0)))
    assert seen.values["fluid_load"] == pytest.approx(480.0)
    thicker = solved.continue_march({"contaminant.viscosity": "300 cP"})
    with pytest.raises(ConvergenceError, match="too little"):
        of_run(solved, thicker, whole((0.14, 0.02), (480.0, 1.0)))


def test_the_march_is_kept_for_the_next_preview():
    first = preview(CASE, {"motion.speed": "0.6 m/s"})
    second = preview(CASE, {"motion.speed": "0.65 m/s"})
    assert second.seconds < 1.5 * first.seconds
    assert first.values["fluid_load"] < second.values["fluid_load"]
    assert "Run the case in full" in str(first)


def test_another_plan_of_the_tread_is_refused(solved):
    with pytest.raises(InputError, match="plan of the sole"):
        solved.continue_march({"shoe.tread.lug_width": "7 mm"})


def test_a_motion_with_a_history_is_refused(solved):
    with pytest.raises(InputError, match="history"):
        solved.continue_march({"motion": "heel_strike_to_flat"})
    with pytest.raises(InputError, match="history"):
        Continuation(CASE.replace("motion", "heel_strike_to_flat"))


@pytest.mark.slow
def test_the_shoe_angle_and_the_speed_of_a_flat_sole_are_refused():
    """A facet traps a pool that it knows nothing of, and a slow one wipes less of it away.

    COF 0.063 of a march, not 0.117, of 0.7 degrees more; 0.077, not 0.104, of a third of the speed.
    """
    coarse = {"numerics.grid_spacing": "2 mm", "numerics.cells_along": 1}
    case = Case.load("examples/athletic_shoe_untreaded_detergent.toml").replace(coarse)
    solved = Continuation(case)
    for change in ({"motion.shoe_angle": "10.7 deg"}, {"motion.speed": "0.33 m/s"}):
        with pytest.raises(InputError, match="without lugs"):
            solved.continue_march(change)
    assert solved.continue_march({"motion.normal_force": "480 N"}).values["cof"] > 0
    whole = {name: SourcedValue(value) for name, value in solved.values.items()}
    with pytest.raises(InputError, match="without lugs"):
        preview_of_run(case, {"motion.normal_force": "480 N"}, whole)


def test_the_drawn_sole_of_a_preview_is_rolled_as_one_that_is_made_at_its_angle():
    made, kept = (
        designed_surface(CASE.replace("motion.shoe_angle", f"{angle} deg")) for angle in (8, 10)
    )
    rolled, lugs = rolled_surface(kept, np.radians(-2.0), None), made.points[made.land]
    x, y, _ = rolled.points[rolled.land].T
    x = x + lugs[lugs[:, 2].argmin(), 0] - rolled.points[rolled.points[:, 2].argmin(), 0]
    there = griddata(lugs[:, :2], lugs[:, 2], (x, y))
    off, before = (
        np.nanmedian(np.abs(each.points[each.land, 2] - there)) for each in (rolled, kept)
    )
    assert off < 0.1e-3 < 0.2 * before  # m, at places found to a tenth of a millimetre
