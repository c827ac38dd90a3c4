"""The reduced slip against its equations by another solver, each constant at a telling value."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from slip_floors import WEIGHT, walker
from underfoot.core import InputError, Status
from underfoot.slip.dynamics import GaitHistory, ReducedSole, SlipMotion
from underfoot.slip.dynamics.reduced_model import MARGIN, NAMES, FittedRange

CONSTANTS = {
    "area": 1.5e-3, "area_power": 0.4, "area_angle": 2.0, "stiffness": 6e5, "decay": 4e-5,
    "leak": 2e5, "leak_angle": 3.0, "wedge": 90.0, "wedge_angle": -2.0, "length": 0.05,
    "start_film": 1.2e-4, "shear": 1.7, "leak_bend": 9.0, "wedge_bend": -6.0,
}  # fmt: skip
ETA, POOL, MIDDLE = 0.2, 7e-4, math.radians(8)
SPEEDS = np.array([0.0, 0.5, 2.0, 10.0])
COFS = np.array([0.25, 0.2, 0.12, 0.1])


def sole(**fitted):
    constants = np.array([CONSTANTS[name] for name in NAMES])
    return ReducedSole(constants, ETA, POOL, MIDDLE, SPEEDS, COFS, **fitted)


def state(film, speed, load, angle):
    """Return rate of the film, friction and load on the film by the equations of the docstring."""
    c, lean = CONSTANTS, angle - MIDDLE
    area = c["area"] * (load / 500) ** c["area_power"] * math.exp(c["area_angle"] * lean)
    mean = load / area
    contact = (mean**-4 + (c["stiffness"] * math.exp(-film / c["decay"])) ** -4) ** -0.25
    fluid = mean - contact
    leak = c["leak"] * math.exp(c["leak_angle"] * lean + c["leak_bend"] * lean**2)
    wedge = c["wedge"] * math.exp(c["wedge_angle"] * lean + c["wedge_bend"] * lean**2)
    drawn = 1 / (1 / POOL + fluid / (wedge * ETA * speed))
    rate = -leak * film**3 * fluid / (12 * ETA) + speed / (2 * c["length"]) * (drawn - film)
    cof = float(np.interp(speed, SPEEDS, COFS))
    friction = cof * contact * area + c["shear"] * ETA * speed * area / film
    return rate, friction, fluid * area


def angle_at(time):
    return MIDDLE + 0.1 - 0.9 * time


def load_at(time):
    return 250 + 2000 * time


def test_an_imposed_motion_carries_the_film_of_the_equations():
    time = np.linspace(0, 0.2, 2001)
    speed = 0.3 + 0.8 * np.sin(20 * time) ** 2
    zero = np.zeros(time.size)
    motion = SlipMotion(
        walker(GaitHistory("n", np.arange(5.0), np.ones(5), np.ones(5)), 0.2), time, speed, zero,
        load_at(time), zero, zero, zero, angle_at(time), zero, zero, Status.CONVERGED, "given",
    )  # fmt: skip
    fluid, friction = sole().carried_at(motion)
    given = time, load_at(time), zero, angle_at(time), speed, 1.0, speed, 8.0, 0.0
    assert sole()._carry_slip(*given)[0] == pytest.approx(speed, abs=0)

    def rate(t, film):
        return [state(film[0], 0.3 + 0.8 * math.sin(20 * t) ** 2, load_at(t), angle_at(t))[0]]

    exact = solve_ivp(
        rate,
        (0, 0.2),
        [CONSTANTS["start_film"]],
        t_eval=time,
        rtol=1e-9,
        atol=1e-12,
        method="LSODA",
    )
    for k in range(100, time.size, 100):
        _, wanted, carried = state(exact.y[0, k], speed[k], load_at(time[k]), angle_at(time[k]))
        assert fluid[k] == pytest.approx(carried, rel=2e-4)
        assert friction[k] == pytest.approx(wanted, rel=2e-4)
    shares = fluid[100:] / load_at(time[100:])
    assert 0.2 < shares.min() < 0.9 * shares.max()


def test_a_foot_that_is_set_free_moves_and_carries_as_the_equations_say():
    time = np.linspace(0, 0.3, 61)
    history = GaitHistory("rising", time, load_at(time) / WEIGHT, 0.15 + 0.5 * time)
    person = walker(history, history.rcof, heel_speed=1.0, shoe_angle=MIDDLE + 0.05,
                    heel_brake="constant", brake_time=0.2)  # fmt: skip
    motion = sole().motion(person, step=1e-4)
    mass = person.moving_mass

    def rates(t, y):
        film, speed, _ = y
        load = load_at(t)
        rate, friction, _ = state(film, max(speed, 1e-9), load, MIDDLE + 0.05)
        drive = (0.15 + 0.5 * t) * load
        brake = -1.0 / 0.2 * math.exp(-t / 0.2)
        return [rate, (drive - friction) / mass + brake, speed]

    begin = [CONSTANTS["start_film"], 1.0, 0.0]
    exact = solve_ivp(rates, (0, 0.3), begin, dense_output=True, rtol=1e-9, atol=1e-12,
                      method="LSODA").sol  # fmt: skip
    moving = motion.time < 0.25
    film, speed, way = exact(motion.time[moving])
    assert speed.min() > 0.02
    assert motion.speed[moving] == pytest.approx(speed, abs=2e-3)
    assert motion.distance[moving] == pytest.approx(way, abs=2e-4)
    later = np.flatnonzero(moving)[200::200]
    for k in later:
        _, friction, fluid = state(film[k], speed[k], load_at(motion.time[k]), MIDDLE + 0.05)
        assert motion.friction[k] == pytest.approx(friction, rel=5e-3)
        assert motion.fluid_load[k] == pytest.approx(fluid, rel=5e-3)


@pytest.mark.parametrize(
    ("name", "scale", "refused"),
    [("normal", 1.0, False), ("normal", 1.24, False), ("normal", 1.27, True),
     ("speed", 1.24, False), ("speed", 1.27, True), ("shoe_angle", 1.27, True)],
)  # fmt: skip
def test_a_motion_beyond_a_quarter_of_the_fitted_range_is_refused(name, scale, refused):
    time = np.linspace(0, 0.1, 11)
    zero, person = (
        np.zeros(11),
        walker(GaitHistory("n", np.arange(5.0), np.ones(5), np.ones(5)), 0.2),
    )

    def motion(**changes):
        given = {"normal": 500 * np.linspace(0.1, 1, 11), "speed": np.linspace(0.1, 2, 11),
                 "shoe_angle": np.linspace(0, 0.2, 11), **changes}  # fmt: skip
        return SlipMotion(
            person, time, given["speed"], zero, given["normal"], zero, zero, zero,
            given["shoe_angle"], zero, zero, Status.CONVERGED, "given",
        )  # fmt: skip

    fitted = FittedRange.of(ETA, [motion(), motion(speed=np.linspace(0, 1, 11))])
    assert fitted == FittedRange(ETA, (0.0, 500.0), (0.0, 2.0), (0.0, 0.2))
    assert MARGIN == 0.25
    made = sole(fitted=fitted)
    given = motion(**{name: scale * getattr(motion(), name)})
    if refused:
        with pytest.raises(InputError, match=name.replace("_", " ").replace("normal", "load")):
            made.carried_at(given)
    else:
        made.carried_at(given)
    with pytest.raises(InputError, match="viscosity"):
        ReducedSole(made.constants, 2 * ETA, POOL, MIDDLE, SPEEDS, COFS, fitted)
