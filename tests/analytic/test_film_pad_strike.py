"""A grooved pad dropped on a wet floor: Stefan's squeeze in the limit; depth and width."""

import math
from dataclasses import replace

import numpy as np
import pytest

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
