"""The full slip: the real sole's contact and film under the moving foot (coarse grid)."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute.slips import slip_population, slip_setting
from underfoot.core import Cache, Cancelled
from underfoot.slip.dynamics import (
    FloorSensors,
    ReducedSole,
    SoleFoot,
    array_pressures,
    cof_table,
    design,
    full_run,
    full_runs,
    slip_motion,
)

EXAMPLES = Path(__file__).parents[2] / "examples"
STEP = 0.03


@pytest.fixture(scope="module")
def wet():
    case = Case.load(EXAMPLES / "human_slip_untreaded.toml")
    return case.replace("numerics.quick_grid_spacing", "2.5 mm")


@pytest.fixture(scope="module")
def setting(wet):
    return slip_setting(wet)


@pytest.fixture(scope="module")
def run(wet, setting):
    return full_run(setting, slip_population(wet).walker(0), step=STEP)


def test_energy_is_kept_and_glycerol_slips(run):
    motion = run.motion
    assert motion.status.usable
    balance = motion.kinetic - motion.kinetic[0] - motion.work_in + motion.dissipated
    assert np.abs(balance).max() < 1e-10
    assert motion.peak_speed > 1.0
    assert (motion.fluid_load <= motion.normal * 1.01).all()


def test_sensors_read_while_the_heel_is_over_them(run):
    found = array_pressures(run.motion, run.maps, FloorSensors())
    assert found.shape == (run.motion.time.size, 3, 3)
    assert found.max() > 1e4
    assert found.max() <= run.peaks.max() * 1.01
    gone = run.motion.distance > 0.2
    assert found[gone].max() == 0.0


@pytest.mark.slow
def test_faster_means_more_load_on_the_film_and_less_friction(wet):
    """The feedback of the report's G.5.3, in the full model with a contact that knows no speed."""
    setting = slip_setting(
        wet.replace(
            {
                "contaminant.viscosity": "60 cP",
                "models.friction": "constant",
                "interface.constant_cof": 0.3,
                "interface.roughness_beyond_cutoff": 4,
            }
        )
    )
    fluid, friction = [], []
    for speed in (0.05, 0.2, 0.8):
        foot = SoleFoot(setting, setting.shoe_angle)
        foot.advance(0.03, normal_force=500.0, speed=speed, shoe_angle=setting.shoe_angle)
        instant = foot.settle_load(normal_force=500.0, speed=speed)
        fluid.append(instant.fluid_load)
        friction.append(instant.friction(speed))
    assert (np.diff(fluid) > 1.0).all()
    assert (np.diff(friction) < 0.0).all()


def test_on_a_dry_floor_both_models_agree(wet):
    case = wet.replace(
        {"contaminant": "none", "models.friction": "constant", "interface.constant_cof": 0.1}
    )
    setting = slip_setting(case)
    walker = slip_population(case).walker(0)
    full = slip_motion(walker, SoleFoot(setting, walker.shoe_angle), step=STEP)
    constants = np.ones(14)
    reduced = ReducedSole(constants, None, 1e-3, 0.0, *cof_table(setting.friction, 3e5))
    fast = reduced.motion(walker, step=STEP)
    assert np.abs(full.speed - fast.speed[: full.speed.size]).max() < 2e-3 * full.speed.max()


def test_a_stopped_series_goes_on_where_it_was(tmp_path, wet, setting):
    people = [slip_population(wet).walker(i) for i in range(2)]
    cache = Cache("slip-test", tmp_path)

    def stop(stage, fraction, residual=None):
        if stage.startswith("Slip 2"):
            raise Cancelled("stopped")

    with pytest.raises(Cancelled):
        full_runs(setting, people, step=STEP, cache=cache, progress=stop)
    assert len(list((tmp_path / "slip-test").iterdir())) == 1
    moved = replace(people[0], landing=0.015, name="elsewhere")
    again = full_run(setting, moved, step=STEP, cache=cache)
    assert len(list((tmp_path / "slip-test").iterdir())) == 1
    assert again.motion.walker is moved
    assert again.motion.peak_speed > 1.0


@pytest.mark.slow
def test_a_film_of_water_under_a_resting_foot_lets_its_steps_end():
    """It ended unsolved after 16 instants: imbalance was measured against what moves, nothing."""
    case = Case(
        shoe="work_shoe_half_tread",
        floor="quarry_tile",
        contaminant="water",
        motion="heel_strike_to_flat",
    ).replace("motion.start_film", "50 um")
    walker = design(slip_population(case), 16)[3]
    motion = full_run(slip_setting(case), walker).motion
    assert motion.status.usable
    assert motion.time.size > 40
    assert motion.distance[-1] < 2e-3  # the foot rests
    assert motion.fluid_load.max() == pytest.approx(52.9, abs=0.5)
