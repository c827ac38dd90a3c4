"""What is taken down while a contact is solved in time: friction, floor sensors, pictures."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from underfoot.case import Case
from underfoot.case.motion import SLOWEST
from underfoot.core import SourcedValue
from underfoot.friction import FrictionLaw
from underfoot.shoe import SoleMap
from underfoot.sole_contact.lug_edges import EdgedLaw
from underfoot.sole_contact.sensor_array import ArrayReading, SensorArray, array_reading
from underfoot.sole_contact.sole_state import SoleState
from underfoot.sole_contact.solver import SoleContact

from .contact_friction import friction_sums
from .numbers import contact_area
from .sensors import scan_reading

READ_STEPS = 24
"""Instants, spread over the time steps, at which the scans are read for a history."""
PICTURED = {"contact_pressure": "asperity contact pressure", "fluid_pressure": "fluid pressure"}
"""Maps that are kept, to 100 Pa: of a motion history at the same number of instants."""
STEADY_PICTURES, PICTURED_CELLS, MARCH = 12, 1_200_000, "march_time"
"""Instants, the last one too, and cells of all at most that another run keeps; their axis."""
COF_WORDS = {
    "cof": "coefficient of friction",
    "cof_adhesion": "adhesion part of COF",
    "cof_hysteresis": "hysteresis part of COF",
    "cof_viscous": "viscous part of COF",
}
READ_OFFSETS = 3
"""Lateral places over which such a reading is averaged."""


@dataclass
class Recorder:
    """Takes down, at every step, the parts of COF and (at some) what the sensors read."""

    case: Case
    law: FrictionLaw | EdgedLaw
    sole: SoleMap
    viscosity: float | None
    cof: dict[str, list[float]] = field(default_factory=dict)
    sensor_load: list[float] = field(default_factory=list)
    sensor_peak: list[float] = field(default_factory=list)
    times: list[float] = field(default_factory=list)
    places: list[float] = field(default_factory=list)
    contact_area: list[float] = field(default_factory=list)
    centre_of_pressure: list[float] = field(default_factory=list)
    array_frames: list[tuple[np.ndarray, ...]] = field(default_factory=list)
    pictures: list[tuple[float, dict[str, np.ndarray]]] = field(default_factory=list)
    _last_read: float = -math.inf
    _array: ArrayReading | None = None

    def __call__(self, state: SoleState) -> None:
        """Take down one state."""
        speed = max(abs(state.speed), SLOWEST)
        friction = friction_sums(self.law, state, speed)
        for name in COF_WORDS:
            value = getattr(friction, name).value
            self.cof.setdefault(name, []).append(math.nan if value is None else value)
        before = self.times[-1] if self.times else 0.0
        place = self.places[-1] if self.places else 0.0
        self.times.append(state.time)
        self.places.append(place + (state.time - before) * state.speed)
        self.contact_area.append(contact_area(state))
        along = state.cell_load.sum(axis=1)
        self.centre_of_pressure.append(float(along @ state.x / along.sum()))
        self._read(state)
        self._picture(state)

    def _read(self, state: SoleState) -> None:
        every = (self.case.motion.end_time or 0.0) / READ_STEPS
        if self.viscosity is None or state.time < self._last_read + every:
            self.sensor_load.append(math.nan)
            self.sensor_peak.append(math.nan)
        else:
            read = scan_reading(
                self.case, self.sole, state, viscosity=self.viscosity, offsets=READ_OFFSETS
            )
            self.sensor_load.append(float(read.load))
            self.sensor_peak.append(float(read.peak_pressure))
            self._last_read = state.time
        if self.case.sensor.array is not None:
            # single precision: the frames of a whole history are kept
            maps = state.fluid_pressure, state.film_thickness
            self.array_frames.append(tuple(each.astype(np.float32) for each in maps))

    def _picture(self, state: SoleState) -> None:
        follows = self.case.motion.build() is not None
        every = (self.case.motion.end_time or 0.0) / (READ_STEPS if follows else STEADY_PICTURES)
        times = [time for time, _ in self.pictures[-2:]]
        if len(times) == 2 and times[1] < times[0] + every:
            self.pictures.pop()  # the newest is always the last
        maps = {name: np.round(getattr(state, name), -2).astype(np.float32) for name in PICTURED}
        self.pictures.append((state.time, maps))
        most = min(STEADY_PICTURES, PICTURED_CELLS // state.fluid_pressure.size)
        if not follows and len(self.pictures) > most:
            del self.pictures[1:-1:2]

    def array(self) -> ArrayReading | None:
        """Return what the array in the floor saw; None where the case has none."""
        array = self.case.sensor.array
        if self._array is not None or array is None or len(self.times) < 2:
            return self._array
        position = array.position
        if position is None:
            middle = float(self.sole.x[self.sole.inside.any(axis=1)].mean())
            position = self.places[-1] + middle - (array.rows - 1) * array.spacing / 2
        pressures, films = (list(maps) for maps in zip(*self.array_frames, strict=True))
        self._array = array_reading(
            self.sole.x,
            self.sole.y,
            np.array(self.times),
            np.array(self.places),
            pressures,
            films,
            SensorArray(array.rows, array.columns, array.spacing, array.inlet_diameter, position),
            compliance=self.case.sensor.compliance if self.viscosity else 0.0,
            viscosity=self.viscosity or 0.0,
        )
        return self._array

    def array_scalars(self) -> dict[str, SourcedValue]:
        """Return the array's peaks and duration by name."""
        read = self.array()
        if read is None:
            return {}
        rows = {f"array_peak_row_{n}": value for n, value in enumerate(read.row_peaks, start=1)}
        return {"array_peak": read.peak, **rows, "array_duration": read.duration}


def history_fields(
    contact: SoleContact, recorder: Recorder
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the variables and coordinates of a result that go with time."""
    history = contact.history

    def in_time(values: object, unit: str, name: str) -> tuple[str, object, dict[str, str]]:
        return ("time", values, {"units": unit, "long_name": name})

    variables: dict[str, Any] = {
        "load_history": in_time(history.load, "N", "applied load"),
        "fluid_load_history": in_time(history.fluid_load, "N", "load carried by the fluid"),
        "approach_history": in_time(history.approach, "m", "approach of the foot"),
        "speed_history": in_time(history.speed, "m/s", "sliding speed of the shoe"),
        "shoe_angle_history": in_time(history.shoe_angle, "rad", "shoe angle, toe up positive"),
        "contact_area_history": in_time(
            recorder.contact_area, "m^2", "contact area, apparent, on the grid"
        ),
        "centre_of_pressure_history": in_time(
            recorder.centre_of_pressure, "m", "centre of pressure ahead of the rear end of the sole"
        ),
        "sensor_load_history": in_time(
            recorder.sensor_load, "N", "fluid load as the scans read it, nan where not read"
        ),
        "sensor_peak_history": in_time(
            recorder.sensor_peak, "Pa", "highest reading of the scans, nan where not read"
        ),
    }
    for name, values in recorder.cof.items():
        variables[f"{name}_history"] = in_time(values, "1", COF_WORDS[name])
    coordinates: dict[str, Any] = {"time": in_time(history.time, "s", "time")}
    if recorder.pictures:
        times, maps = zip(*recorder.pictures, strict=True)
        axis = MARCH if recorder.case.motion.build() is None else "picture_time"
        coordinates[axis] = ((axis,), np.array(times), {"units": "s"})
        for name, title in PICTURED.items():
            variables[f"{name}_history"] = (
                (axis, "x", "y"),
                np.stack([each[name] for each in maps]),
                {"units": "Pa", "long_name": title},
            )
    read = recorder.array()
    if read is not None:
        variables["array_pressure"] = (
            ("array_time", "array_row", "array_column"),
            read.pressure,
            {"units": "Pa", "long_name": "fluid pressure at each sensor of the array"},
        )
        coordinates["array_time"] = ("array_time", read.time, {"units": "s"})
    return variables, coordinates
