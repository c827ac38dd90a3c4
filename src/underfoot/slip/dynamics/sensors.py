"""Fluid-pressure sensors in the floor while a sole slides over them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.sole_contact.reading import GAP_CAP, pocket_pressure
from underfoot.sole_contact.sole_state import SoleState

from .motion import SlipMotion
from .walker import Walker

MAP_X: NDArray[np.float64] = np.linspace(-10e-3, 90e-3, 51)
MAP_Y: NDArray[np.float64] = np.linspace(-36e-3, 36e-3, 37)
"""m, places in the sole's frame (x from its rear end) at which a sensor's reading is kept."""
SHOWN = 0.02  # of the load on the film: below it a map says nothing about shape


@dataclass(frozen=True, slots=True)
class FloorSensors:
    """Sensors in rows across the walk; the report's G.5.1: 3 x 3, 30 mm apart, 4 mm inlets.

    Row 0 is met first. The heel lands ``Walker.landing`` behind it.
    """

    rows: int = 3
    columns: int = 3
    spacing: float = 30e-3
    inlet_diameter: float = 4e-3

    def __post_init__(self) -> None:
        if self.rows < 1 or self.columns < 1:
            raise InputError("no sensors", where="slip.sensors", allowed="1 row and column or more")
        if not self.spacing > 0 or self.inlet_diameter < 0:
            raise InputError("spacing above 0, inlet 0 or more", where="slip.sensors")

    def places(self, walker: Walker) -> tuple[Array, Array]:
        """Return x (rows,) from the heel's rear end at contact and y (columns,) from its middle."""
        x = walker.landing + self.spacing * np.arange(self.rows, dtype=np.float64)
        half = 0.5 * (self.columns - 1)
        y = (half - np.arange(self.columns, dtype=np.float64)) * self.spacing - walker.lateral
        return x, y


def sensor_map(state: SoleState, inlet_diameter: float) -> Array:
    """Return what a sensor reads at each place (MAP_X, MAP_Y) of the sole's frame, Pa.

    The pocket of ``outsole.floor_sensor_reading``.
    """
    if not (state.fluid_pressure > 0).any():
        return np.zeros((MAP_X.size, MAP_Y.size))
    film = (state.x, state.y, state.fluid_pressure, state.film_thickness)
    pocket = {"inlet_diameter": inlet_diameter, "gap_cap": GAP_CAP, "spacing": state.spacing}
    return pocket_pressure(*film, MAP_X, MAP_Y, **pocket)[0]


class MappedRun(Protocol):
    """A full slip with the readings in the sole's frame; ``full_model.FullRun`` is one."""

    @property
    def motion(self) -> SlipMotion:
        """How the foot moved."""
        ...

    @property
    def maps(self) -> NDArray[np.float32]:
        """Readings (n, len(MAP_X), len(MAP_Y)) at ``motion.time``, Pa."""
        ...


@dataclass(frozen=True, slots=True)
class PressureShape:
    """Reading over load on the film, 1/m^2, by place, load, film share and shoe angle.

    Least squares over full runs at every place: p / W_f = s0 + s1 log(F / 500 N) + s2 W_f / F
    + s3 (a - a0), at least 0.
    """

    parts: Array  # (4, len(MAP_X), len(MAP_Y))
    shoe_angle: float

    def maps(self, motion: SlipMotion) -> Array:
        """Return the readings (n, len(MAP_X), len(MAP_Y)) under a motion, Pa."""
        columns = _shape_columns(motion, self.shoe_angle)
        shape = np.tensordot(columns, self.parts, axes=(1, 0))
        return np.maximum(shape, 0.0) * motion.fluid_load[:, None, None]


def pressure_shape(runs: Sequence[MappedRun], shoe_angle: float) -> PressureShape:
    """Return the shape of the film's pressure as sensors see it, from full runs."""
    rows, values, weights = [], [], []
    for run in runs:
        motion = run.motion
        carried = (motion.normal > 30) & (motion.fluid_load > SHOWN * motion.normal)
        if not carried.any():
            continue
        rows.append(_shape_columns(motion, shoe_angle)[carried])
        values.append(
            run.maps[carried].reshape(int(carried.sum()), -1) / motion.fluid_load[carried, None]
        )
        weights.append(motion.fluid_load[carried])
    blank = np.zeros((4, MAP_X.size, MAP_Y.size))
    if not rows:
        return PressureShape(blank, shoe_angle)
    weight = np.concatenate(weights)[:, None]
    fit, *_ = np.linalg.lstsq(
        np.concatenate(rows) * weight, np.concatenate(values) * weight, rcond=1e-6
    )
    return PressureShape(fit.reshape(blank.shape), shoe_angle)


def array_pressures(motion: SlipMotion, maps: NDArray[np.floating], array: FloorSensors) -> Array:
    """Return the pressure (n, rows, columns) in Pa that each sensor reads at ``motion.time``.

    ``maps`` (n, len(MAP_X), len(MAP_Y)): readings in the sole's frame at these times. A sensor
    outside the maps reads 0.
    """
    x, y = array.places(motion.walker)
    count = motion.time.size
    pressures = np.zeros((count, array.rows, array.columns))
    ahead = x[None, :] - motion.distance[:, None]
    along = (ahead - MAP_X[0]) / (MAP_X[1] - MAP_X[0])
    across = (y - MAP_Y[0]) / (MAP_Y[1] - MAP_Y[0])
    which = np.broadcast_to(np.arange(count, dtype=float)[:, None], along.shape)
    for j, place in enumerate(across):
        at = np.stack([which, along, np.full(along.shape, place)])
        pressures[:, :, j] = map_coordinates(
            np.asarray(maps, dtype=float), at, order=1, mode="constant", cval=0.0
        )
    return pressures


def _shape_columns(motion: SlipMotion, shoe_angle: float) -> Array:
    load = np.maximum(motion.normal, 30.0)
    return np.column_stack(
        [
            np.ones(load.size),
            np.log(load / 500.0),
            np.clip(motion.fluid_load / load, 0.0, 1.0),
            motion.shoe_angle - shoe_angle,
        ]
    )
