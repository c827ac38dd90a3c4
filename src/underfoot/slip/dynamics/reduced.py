"""The fast slip: one film height under the whole sole, with constants fitted to the full model."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError, Status

from ._kernels import reduced as kernel
from .motion import SlipMotion
from .sole_contact import LOWEST_SPEED
from .walker import Walker

if TYPE_CHECKING:
    from underfoot.friction import FrictionLaw

Array = NDArray[np.float64]
STEP = 0.5e-3
NAMES = (
    "area", "area_power", "area_angle", "stiffness", "decay", "leak", "leak_angle", "wedge",
    "wedge_angle", "length", "start_film", "shear", "leak_bend", "wedge_bend",
)  # fmt: skip
UNITS = (
    "m^2",
    "1",
    "1/rad",
    "Pa",
    "m",
    "1/m^2",
    "1/rad",
    "1",
    "1/rad",
    "m",
    "m",
    "1",
    "1/rad^2",
    "1/rad^2",
)
TABLE_SPEEDS = np.concatenate([[0.0], np.geomspace(LOWEST_SPEED, 10.0, 96)])


@dataclass(frozen=True, slots=True)
class ReducedSole:
    """One sole on one floor with one fluid, in fourteen constants.

    p = F / A,  A = area (F / 500 N)^area_power,  p_c = stiffness exp(-h / decay) (at most p)
    dh/dt = -leak h^3 p_f / (12 eta) + V / (2 length) (h_w - h),  p_f = p - p_c
    1 / h_w = 1 / pool + p_f / (wedge eta V),  FF = COF(V) p_c A + shear eta V A / h

    A carries exp(area_angle a), leakage and wedge exp(angle a + bend a^2), a the shoe angle against
    ``shoe_angle``. ``speeds``, ``cofs`` tabulate the contact's friction over pressure.
    """

    constants: Array
    viscosity: float | None
    pool_depth: float
    shoe_angle: float
    speeds: Array
    cofs: Array

    def __post_init__(self) -> None:
        if self.constants.shape != (kernel.COUNT,) or not np.isfinite(self.constants).all():
            raise InputError("fourteen finite constants are wanted", where="reduced.constants")

    def motion(self, walker: Walker, *, step: float = STEP) -> SlipMotion:
        """Return the slip of a walker (see ``motion.slip_motion`` for the rules)."""
        history = walker.step
        if not (math.isfinite(step) and 0 < step <= history.duration / 10):
            raise InputError(
                f"{step:g} s", where="step", allowed=f"above 0, up to {history.duration / 10:.3g} s"
            )
        times = np.linspace(0.0, history.duration, math.ceil(history.duration / step) + 1)
        normals, drives, angles = walker.demands(times)
        free = np.full(times.size, np.nan)
        out = self._carried(
            times, normals, drives, angles, free, walker.heel_speed, walker.moving_mass,
            history.end_of_braking,
        )  # fmt: skip
        speed, _, friction, fluid, work, lost, end = out
        keep = slice(0, end + 1)
        moved = 0.5 * (speed[1:] + speed[:-1]) * np.diff(times)
        distance = np.concatenate([[0.0], np.cumsum(moved)])
        notes = ()
        if speed[end] > 1e-6:
            notes = (
                f"still sliding at {speed[end]:.2f} m/s when the history of {history.duration:.2f}"
                " s ends: distance is a lower bound",
            )
        return SlipMotion(
            walker, times[keep], speed[keep], distance[keep], normals[keep], drives[keep],
            friction[keep], fluid[keep], angles[keep], work[keep], lost[keep],
            Status.CONVERGED, "reduced", notes,
        )  # fmt: skip

    def carried_at(self, motion: SlipMotion) -> tuple[Array, Array]:
        """Return film load and friction (n,) if the foot moved as in ``motion``."""
        out = self._carried(
            motion.time, motion.normal, motion.drive, motion.shoe_angle, motion.speed, 0.0,
            motion.walker.moving_mass, 0.0,
        )  # fmt: skip
        return out[3], out[2]

    def _carried(
        self, times: Array, normals: Array, drives: Array, angles: Array, given: Array, v0: float,
        mass: float, over: float,
    ) -> tuple[Array, Array, Array, Array, Array, Array, int]:  # fmt: skip
        return kernel.carried(
            times, normals, drives, angles - self.shoe_angle, given, v0, mass, self.constants,
            0.0 if self.viscosity is None else self.viscosity, self.pool_depth, self.speeds,
            self.cofs, over,
        )  # fmt: skip


def cof_table(law: FrictionLaw, pressure: float) -> tuple[Array, Array]:
    """Return speeds (m/s) and the contact's friction over a contact pressure (Pa) at them, 1."""
    speeds = np.maximum(TABLE_SPEEDS, LOWEST_SPEED)
    parts = law(np.full(speeds.size, pressure), speeds, np.full(speeds.size, 1e-3))
    return TABLE_SPEEDS.copy(), (parts.adhesion + parts.hysteresis) / pressure
