"""A grooved pad dropped on a wet floor: Stefan's squeeze in the limit; depth and width."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from underfoot.core import InputError
from underfoot.film import Strike, touch_time
from underfoot.rough_contact import ExponentialLaw

PAD = Strike(groove=3e-3, depth=3e-3, rib=9e-3, viscosity=1e-3)
ROUGH = ExponentialLaw(20e6, 0.49, 10e-6).pressure


def test_a_thick_fluid_between_ribs_and_deep_grooves_leaves_as_stefan_says():
    """t = eta b^2 / (2 p) (1 / h^2 - 1 / h_0^2) under long strips of width b."""
    thick = replace(PAD, viscosity=5.0, pool=0.2e-3, speed=1e-6, density=1.0)
    floor = 40e-6
    pressure = thick.load / (thick.side**2 * thick.land)

    def stop(gap):
        return np.where(np.asarray(gap) < floor, 0.5001 * pressure, 0.0)

    stefan = thick.viscosity * thick.rib**2 / (2 * pressure) * (floor**-2 - thick.pool**-2)
    assert stefan > 0.5  # else the start matters
    thin = replace(thick, viscosity=0.2)
    assert touch_time(thin, stop) == pytest.approx(stefan / 25, rel=0.03)


def test_deeper_wider_and_closer_grooves_let_a_pad_touch_sooner():
    times = [touch_time(replace(PAD, depth=d), ROUGH) for d in (1e-3, 2e-3, 3e-3, 5e-3)]
    assert times == sorted(times, reverse=True)
    assert times[0] - times[1] > 3 * (times[2] - times[3])  # saturates
    assert touch_time(replace(PAD, groove=9e-3), ROUGH) < touch_time(PAD, ROUGH)
    assert touch_time(replace(PAD, rib=4e-3), ROUGH) < touch_time(PAD, ROUGH)
    assert touch_time(replace(PAD, viscosity=2e-3), ROUGH) >= touch_time(PAD, ROUGH)


def test_a_pad_in_honey_floats_and_nonsense_is_refused():
    assert touch_time(replace(PAD, viscosity=500.0), ROUGH) == math.inf
    with pytest.raises(InputError, match="rib"):
        touch_time(replace(PAD, rib=0.0), ROUGH)


@pytest.mark.parametrize(
    "changes",
    [
        {"pool": 3e-3, "depth": 0.5e-3, "groove": 1e-3},  # the grooves fill early
        {"pool": 3e-3, "depth": 0.5e-3, "groove": 1e-3, "viscosity": 30e-3},  # and are laminar
        {"groove": 20e-3, "depth": 9e-3, "speed": 1.0},  # they never fill: squeeze and inertia
    ],
)
def test_the_equation_of_the_docstring_integrated_anew(changes):
    strike = replace(PAD, **changes)
    area, land = strike.side**2, strike.rib / (strike.rib + strike.groove)
    count = strike.side / (strike.rib + strike.groove)

    def squeeze(gap, speed):
        creeping = strike.viscosity * speed * strike.rib**2 / gap**3
        return land * (creeping + strike.density * (speed * strike.rib / 2 / gap) ** 2 / 6)

    def grooves(gap, speed):
        if strike.pool - gap < strike.depth * (1 - land):
            return 0.0
        high = strike.depth + gap
        u = speed * area / count / (2 * strike.groove * high)  # half leaves by either end
        diameter = 4 * strike.groove * high / (2 * (strike.groove + high))  # 4 area / perimeter
        reynolds = max(strike.density * u * diameter / strike.viscosity, 1.0)
        friction = max(64 / reynolds, 0.3 / reynolds**0.25)
        return strike.density * u**2 * (1 / 4 + friction * strike.side / (24 * diameter))

    def change(_, state):
        gap, speed = state
        speed = max(speed, 0.0)
        pressure = squeeze(gap, speed) + land * float(ROUGH(gap)) + grooves(gap, speed)
        return [-speed, (strike.load - area * pressure) / strike.mass]

    def half(_, state):
        return area * land * float(ROUGH(state[0])) - strike.load / 2

    half.terminal = True
    start = [strike.pool, strike.speed]
    solved = solve_ivp(change, (0, 1), start, "BDF", events=half, rtol=1e-7, atol=[1e-10, 1e-8])
    assert touch_time(strike, ROUGH) == pytest.approx(solved.t_events[0][0], rel=2e-3)
