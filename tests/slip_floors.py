"""Floors and soles of known friction for the tests of slips."""

from dataclasses import dataclass

import numpy as np

from underfoot.slip.dynamics import GaitHistory, ReducedSole, Walker
from underfoot.slip.dynamics._kernels import reduced as kernel

WEIGHT = 70.0 * 9.80665


@dataclass
class Floor:
    """A floor of one coefficient of friction and one drag."""

    cof: float = 0.0
    drag: float = 0.0
    load: float = 0.0
    fluid_load: float = 0.0
    usable: bool = True

    def advance(self, duration, *, normal_force, speed, shoe_angle):
        return Floor(self.cof, self.drag, normal_force)

    def friction(self, speed):
        return self.cof * self.load + self.drag * speed


def constant(ratio: float, duration: float = 0.5) -> GaitHistory:
    time = np.linspace(0, duration, 101)
    return GaitHistory("constant", time, np.ones(101), np.full(101, ratio))


def dry_sole(cof: float) -> ReducedSole:
    speeds = np.array([0.0, 10.0])
    constants = np.ones(kernel.COUNT)
    return ReducedSole(constants, None, 1e-3, 0.0, speeds, np.full(2, cof))


def walker(history: GaitHistory, rcof: float, **changes) -> Walker:
    values = {
        "mass": 70.0,
        "rcof": rcof,
        "heel_speed": 0.3,
        "effective_mass": 8 / 70,
        "heel_brake": "none",
    }
    return Walker(history, **(values | changes))


def slippery_sole() -> ReducedSole:
    """Constants of the size that fits to untreaded soles in glycerol give."""
    c = np.array([1.5e-3, 0.4, 0.0, 2e6, 2e-5, 1e5, 0.0, 100.0, 0.0, 0.05, 1e-4, 1.0, 0.0, 0.0])
    assert c.size == kernel.COUNT
    speeds = np.linspace(0, 10, 50)
    return ReducedSole(c, 0.219, 6e-4, np.radians(10), speeds, 0.1 + 0.2 * np.exp(-speeds))
