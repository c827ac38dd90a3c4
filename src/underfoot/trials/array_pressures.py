"""A slip over an array of pressure sensors in the floor: each sensor's pulse and passage."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from underfoot.core import DataError

from .measurement import Measurement
from .pressures import Passage, Pulse, PulseDefinition, heel_track, passages, pressure_pulse
from .slips import Slip
from .trial import Trial


@dataclass(frozen=True, slots=True)
class SensorArrayReading:
    """What the array saw of one slip.

    ``pulses`` and ``passages`` are by sensor name; ``track`` (n, 2) is the heel along and across
    the walk from the middle of the array (m); ``crossed`` says whether the heel was over the
    array. ``peak`` is the largest pressure of all sensors (Pa), ``peak_sensor`` its name.
    """

    pulses: Mapping[str, Pulse]
    passages: Mapping[str, Passage]
    track: np.ndarray
    crossed: bool
    peak: Measurement
    peak_sensor: str


def sensor_array_reading(
    trial: Trial,
    found: Slip,
    sensors: Mapping[str, tuple[float, float, float]],
    *,
    up: np.ndarray,
    walking: np.ndarray,
    definition: PulseDefinition | None = None,
) -> SensorArrayReading:
    """Return pressures, passages and the heel's track of one slip over a sensor array.

    Without a heel path in the slip ``found`` there are pressures only. ``sensors`` are places in
    lab axes (m) by the name of the pressure channel; ``up`` and ``walking`` unit vectors (3,). A
    sensor without a channel, or no sensors, are a DataError.

    Source: grant report G.5.1.
    """
    if not sensors:
        raise DataError("no sensor is named", where=trial.name, remedy="Add [sensors] to a profile")
    pulses = {
        name: pressure_pulse(name, trial.channel(name), found.contact, definition=definition)
        for name in sensors
    }
    seen = {n: p.peak.value for n, p in pulses.items() if p.peak.value is not None}
    best = max(seen, key=lambda name: seen[name]) if seen else next(iter(pulses))
    passed: dict[str, Passage] = {}
    track, crossed = np.empty((0, 2)), False
    if found.motion is not None and found.end > found.contact:
        said = found.peak_speed.conventions
        said = {k: v for k, v in said.items() if k not in ("threshold", "uncertainty")}
        span: Any = {"up": up, "walking": walking, "contact": found.contact, "until": found.end}
        for one in passages(found.motion, sensors, conventions=said, **span):
            passed[one.sensor] = one
        track, crossed = heel_track(found.motion, sensors, **span)
    return SensorArrayReading(pulses, passed, track, crossed, pulses[best].peak, best)
