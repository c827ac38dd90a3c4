"""Order of the foot's time stepping."""

import numpy as np

from slip_floors import Floor, constant, slippery_sole, walker
from underfoot.slip.dynamics import packaged_histories, slip_motion


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
