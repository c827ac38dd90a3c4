"""Order of the foot's time stepping."""

import numpy as np
import pytest

from slip_floors import Floor, constant, slippery_sole, walker
from underfoot import Case
from underfoot.compute.slips import slip_population, slip_setting
from underfoot.slip.dynamics import packaged_histories, slip_motion
from underfoot.slip.dynamics.full_model import SoleFoot


def test_full_stepping_is_of_second_order():
    person = walker(constant(0.2), 0.2)
    mass, drag, drive = person.moving_mass, 60.0, 0.2 * 70 * 9.80665
    errors = []
    for step in (0.02, 0.01, 0.005):
        motion = slip_motion(person, Floor(drag=drag), step=step)
        exact = drive / drag + (0.3 - drive / drag) * np.exp(-drag / mass * motion.time)
        errors.append(np.abs(motion.speed - exact).max())
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (rates > 1.9).all()
    assert errors[-1] < 1e-4


def test_reduced_stepping_converges_with_second_order():
    person = walker(packaged_histories()[10], 0.2, walking_speed=None)
    sole = slippery_sole()
    times = np.linspace(0.05, 0.3, 40)

    def speeds(step):
        motion = sole.motion(person, step=step)
        return np.interp(times, motion.time, motion.speed)

    steps = person.history.duration / np.array([129, 258, 516]) / 5  # nodes on the table's own
    reference = speeds(steps[-1] / 8)
    errors = [np.abs(speeds(step) - reference).max() for step in steps]
    assert errors[-1] < 2e-5
    assert errors[0] / errors[-1] > 10  # four times finer: 16 at second order


def test_default_steps_are_fine_enough():
    person = walker(packaged_histories()[10], 0.2)
    sole = slippery_sole()
    fine = sole.motion(person, step=2e-5).peak_speed
    assert abs(sole.motion(person).peak_speed - fine) < 1e-3 * fine


@pytest.mark.slow
def test_the_steps_of_a_case_hold_a_slip_on_a_film():
    """Peak and distance with 8 ms beside 2 ms: a slip that is caught, and one that is not."""
    found = []
    for shoe, fluid in (
        ("work_shoe_half_tread", "glycerol_90pct"),
        ("work_shoe_untreaded", "glycerol_75pct"),
    ):
        case = Case(shoe=shoe, floor="vinyl_g4", contaminant=fluid, motion="slip_tester_g4")
        setting, person = slip_setting(case), slip_population(case, subjects=1).walkers()[0]
        default = case.slip.time_step
        for step in (default, default / 4):
            foot = SoleFoot(setting, person.shoe_angle, 700.0)
            motion = slip_motion(person, foot, step=step)
            found.append((motion.peak_speed, motion.distance[-1]))
    caught, caught_finely, lost, lost_finely = found
    assert caught[0] == caught_finely[0] == 0.0
    assert abs(caught[1] - caught_finely[1]) < 0.3e-3
    assert lost == pytest.approx(lost_finely, rel=0.01)
