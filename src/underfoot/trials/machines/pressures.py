"""Fluid pressures under the foot: sensors of an array in the floor and the heel's passage."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from underfoot.core import DataError, InputError
from underfoot.core.remark import NOTHING, Message

from ..recording.measurement import Flag, Measurement, remark
from ..recording.signals import is_saturated, runs
from ..recording.trial import Channel, Trial
from ..walking.slips import HeelMotion, Slip

BASELINE_SAMPLES = 500  # fewer let noise pass 5 standard deviations in 1 % of empty records


@dataclass(frozen=True, slots=True)
class PulseDefinition:
    """What counts as pressure above the baseline.

    ``deviations``: threshold over the baseline's mean in its standard deviations (5 in report
    G.5.1). ``margin``: the baseline ends this long before contact (s). ``run``: samples in a row
    that must be above, one alone is noise.
    """

    deviations: float = 5.0
    margin: float = 0.05
    run: int = 3

    def conventions(self) -> dict[str, Message]:
        """Return the choices, a line each."""
        return {
            "threshold": Message(
                "{count:g} standard deviations over the baseline's mean", count=self.deviations
            ),
            "baseline": Message(
                "samples until {margin:g} ms before contact", margin=1e3 * self.margin
            ),
            "run": Message("{run} samples in a row", run=self.run),
            "duration": Message("between the first and the last moment above the threshold"),
        }


@dataclass(frozen=True, slots=True)
class Pulse:
    """Pressure pulse of one sensor: peak over the baseline (Pa) and duration (s)."""

    sensor: str
    peak: Measurement
    duration: Measurement
    baseline: float
    deviation: float
    peak_time: float = math.nan
    first: float = math.nan
    last: float = math.nan


@dataclass(frozen=True, slots=True)
class Passage:
    """The heel passing one sensor.

    ``row`` counts from 1, the row the walker meets first. ``speed`` is the instantaneous
    slipping speed (m/s), ``lateral`` the distance of the heel from the sensor across the walk
    (m, positive when the heel is to the walker's left of it).
    """

    sensor: str
    row: int
    time: float
    speed: Measurement
    lateral: Measurement


def pressure_pulse(
    sensor: str,
    channel: Channel,
    contact: float,
    *,
    until: float | None = None,
    definition: PulseDefinition | None = None,
) -> Pulse:
    """Return the peak and the duration of a sensor's pressure after contact.

    ``channel`` is in Pa; ``contact`` is the time of heel contact (s), ``until`` the end of the
    search (s), by default the end of the record. With fewer than 500 baseline samples the numbers
    carry a flag; with fewer than 20 there are none. A pressure that never passes the threshold has
    a peak (flagged) and no duration.
    """
    definition = definition or PulseDefinition()
    said = definition.conventions()
    time = channel.time
    values = channel.values
    quiet = values[(time < contact - definition.margin) & np.isfinite(values)]

    flags: tuple[Flag, ...] = ()

    def measure_of(
        name: str, value: float | Message, unit: str, sd: float = 0.0, why: Message = NOTHING
    ) -> Measurement:
        if isinstance(value, Message):
            return Measurement.not_estimated(name, value, unit=unit, flags=flags, conventions=said)
        words = {**said, "uncertainty": why} if why else said
        n = len(quiet) if unit == "Pa" else 1
        return Measurement(name, value, unit, sd, n=n, flags=flags, conventions=words)

    def without(reason: Message) -> Pulse:
        peak = measure_of("peak pressure", reason, "Pa")
        return Pulse(sensor, peak, measure_of("pressure duration", reason, "s"), math.nan, math.nan)

    if channel.unit != "Pa":
        return without(
            Message('the unit of the channel is "{unit}", not a pressure', unit=channel.unit)
        )
    if len(quiet) < 20:
        return without(
            Message("{count} samples before contact are no baseline (500 needed)", count=len(quiet))
        )
    if len(quiet) < BASELINE_SAMPLES:
        flags = (
            remark("baseline of {count} samples: 500 keep false alarms at 0.1 %", count=len(quiet)),
        )
    mean, deviation = float(quiet.mean()), float(quiet.std(ddof=1))
    inside = (time >= contact) & (time <= (until if until is not None else time[-1]))
    if not (inside & np.isfinite(values)).any():
        return without(Message("no samples after contact"))
    if np.isnan(values[inside]).any():
        flags += (
            remark("{count} samples without a number", count=int(np.isnan(values[inside]).sum())),
        )
    if is_saturated(values, channel.rate):
        flags += (remark("the sensor is saturated: the peak is a lower bound"),)
    over = np.where(inside, values - mean, np.nan)
    top = int(np.nanargmax(over))
    limit = definition.deviations * deviation
    above = np.asarray(np.nan_to_num(over, nan=-np.inf) > limit)
    stretches = [(a, b) for a, b in runs(above) if b - a >= definition.run]
    known, top_time = float(over[top]), float(time[top])
    if not stretches:
        never = Message("never above the threshold of {limit:.0f} Pa", limit=limit)
        none = measure_of("pressure duration", never, "s")
        flags += (remark("within the noise: never above the threshold"),)
        peak = measure_of("peak pressure", known, "Pa", deviation)
        return Pulse(sensor, peak, none, mean, deviation, top_time)
    first, last = stretches[0][0], stretches[-1][1] - 1
    if last == np.flatnonzero(inside)[-1]:
        flags += (remark("still above the threshold when the search ends"),)
    begin, end = float(time[first]), float(time[last])
    step, why = 1.0 / channel.rate / math.sqrt(6.0), Message("time between samples")
    noise = Message("standard deviation of the baseline")
    peak = measure_of("peak pressure", known, "Pa", deviation, noise)
    duration = measure_of("pressure duration", float(time[last] - time[first]), "s", step, why)
    return Pulse(sensor, peak, duration, mean, deviation, top_time, begin, end)


def sensor_rows(
    sensors: Mapping[str, tuple[float, float, float]], walking: np.ndarray
) -> dict[str, int]:
    """Return the row of each sensor along the walk, 1 = met first.

    Sensors whose places along the walk differ by less than a third of the largest gap between
    neighbours share a row.
    """
    places = np.array([np.dot(position, walking) for position in sensors.values()])
    order = np.argsort(places, kind="stable")
    gaps = np.diff(places[order])
    limit = max(float(gaps.max()) / 3.0, 1e-4) if len(gaps) else 0.0
    rows = 1 + np.concatenate(([0], np.cumsum(gaps > limit)))
    names = list(sensors)
    return {names[at]: int(row) for at, row in zip(order, rows, strict=True)}


def passages(
    motion: HeelMotion,
    sensors: Mapping[str, tuple[float, float, float]],
    *,
    up: np.ndarray,
    walking: np.ndarray,
    contact: float,
    until: float,
    conventions: Mapping[str, Message] | None = None,
) -> list[Passage]:
    """Return for each sensor when, how fast and how far to the side the heel passed it.

    The heel passes a sensor when it first comes level with it along the walk after contact; the
    instant is interpolated between frames. ``sensors`` are places in lab axes (m); passages after
    ``until``, the end of the slip (s), are those of the swing.

    Source: grant report G.5.1.
    """
    if not until > contact:
        raise InputError("the slip ends before it begins", where="passages")
    across = np.cross(up, walking)
    rows = sensor_rows(sensors, walking)
    choices = dict(conventions or {})
    signed = {**choices, "sign": Message("positive: heel to the walker's left")}
    names = ("instantaneous slipping speed", "m/s"), ("medio-lateral distance", "m")
    inside = np.flatnonzero((motion.time >= contact) & (motion.time <= until))
    passed = []
    for name, place in sensors.items():
        away = motion.position - np.asarray(place)
        reason, at = _crossing(away[inside] @ walking)
        if reason:
            speed, lateral = (
                Measurement.not_estimated(what, reason, unit=unit, conventions=choices)
                for what, unit in names
            )
            passed.append(Passage(name, rows[name], math.nan, speed, lateral))
            continue
        index, share = inside[int(at)], at - int(at)
        when, fast, side = (
            _between(values, index, share) for values in (motion.time, motion.speed, away @ across)
        )
        speed = Measurement(names[0][0], fast, "m/s", motion.speed_noise, conventions=choices)
        lateral = Measurement(names[1][0], side, "m", motion.noise, conventions=signed)
        passed.append(Passage(name, rows[name], when, speed, lateral))
    return passed


def heel_track(
    motion: HeelMotion,
    sensors: Mapping[str, tuple[float, float, float]],
    *,
    up: np.ndarray,
    walking: np.ndarray,
    contact: float,
    until: float,
) -> tuple[np.ndarray, bool]:
    """Return the heel's path over the sensor array and whether it crossed the array.

    The path (n, 2) is along and across the walk (m) from the middle of the array. It crossed
    when the marker was within the outer sensors' rectangle at any time of the slip.
    """
    across = np.cross(up, walking)
    places = np.array(list(sensors.values()))
    flat = np.column_stack((places @ walking, places @ across))
    middle = (flat.min(axis=0) + flat.max(axis=0)) / 2.0
    inside = (motion.time >= contact) & (motion.time <= until)
    position = motion.position[inside]
    path = np.column_stack((position @ walking, position @ across))
    within = (path >= flat.min(axis=0)) & (path <= flat.max(axis=0))
    return path - middle, bool(within.all(axis=1).any())


def _crossing(ahead: np.ndarray) -> tuple[Message, float]:
    """Why the heel does not pass, or at which fraction of the frames it does."""
    if not len(ahead) or not np.isfinite(ahead).all():
        return Message("the heel marker is missing"), 0.0
    if ahead[0] >= 0:
        over = 1e3 * ahead[0]
        return Message("the heel landed {way:.0f} mm beyond the sensor", way=over), 0.0
    beyond = np.flatnonzero(ahead >= 0)
    if not len(beyond):
        short = -1e3 * float(ahead.max())
        return Message("the heel stops {way:.0f} mm before the sensor", way=short), 0.0
    i = int(beyond[0])
    return NOTHING, i - 1 + float(-ahead[i - 1] / (ahead[i] - ahead[i - 1]))


def _between(values: np.ndarray, index: int, share: float) -> float:
    following = min(index + 1, len(values) - 1)
    return float(values[index] + share * (values[following] - values[index]))


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
    slip: Slip,
    sensors: Mapping[str, tuple[float, float, float]],
    *,
    up: np.ndarray,
    walking: np.ndarray,
    definition: PulseDefinition | None = None,
) -> SensorArrayReading:
    """Return pressures, passages and the heel's track of one slip over a sensor array.

    Without a heel path in the ``slip`` there are pressures only. ``sensors`` are places in
    lab axes (m) by the name of the pressure channel; ``up`` and ``walking`` unit vectors (3,). A
    sensor without a channel, or no sensors, are a DataError.

    Source: grant report G.5.1.
    """
    if not sensors:
        raise DataError("no sensor is named", where=trial.name, remedy="Add [sensors] to a profile")
    pulses = {
        name: pressure_pulse(name, trial.channel(name), slip.contact, definition=definition)
        for name in sensors
    }
    seen = {n: p.peak.value for n, p in pulses.items() if p.peak.value is not None}
    best = max(seen, key=lambda name: seen[name]) if seen else next(iter(pulses))
    passed: dict[str, Passage] = {}
    track, crossed = np.empty((0, 2)), False
    if slip.motion is not None and slip.end > slip.contact:
        choices = slip.peak_speed.conventions
        choices = {k: v for k, v in choices.items() if k not in ("threshold", "uncertainty")}
        span: Any = {"up": up, "walking": walking, "contact": slip.contact, "until": slip.end}
        read = passages(slip.motion, sensors, conventions=choices, **span)
        passed = {passage.sensor: passage for passage in read}
        track, crossed = heel_track(slip.motion, sensors, **span)
    return SensorArrayReading(pulses, passed, track, crossed, pulses[best].peak, best)
