"""A simulated slip seen as a recording: heel marker and pressure channels, judged by ``trials``."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError

from .motion import SlipMotion
from .sensors import SensorArray

if TYPE_CHECKING:
    from underfoot.trials.measurement import Measurement
    from underfoot.trials.slips import Slip

Array = NDArray[np.float64]
RATE = 250.0  # Hz of the marker
PRESSURE_RATE = 1000.0  # Hz of the sensors
BEFORE = 0.8  # s of record before contact
AFTER = 0.35  # s of record after the foot came to rest
SWING_BRAKING = 18.0
"""m/s^2, how fast the heel slows down before contact: mean of the recorded steps over 20 ms."""
SWING_SPEED = 4.0  # m/s, largest speed of the swinging heel before contact
BASELINE_SD = 240.0  # Pa, report G.5.1
UP, WALK = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])


class Outcome(StrEnum):
    """What happened to the step, by the distance slipped."""

    NO_SLIP = "no slip"
    MICROSLIP = "microslip"
    SLIDE = "slide"
    SLIP = "slip"


@dataclass(frozen=True, slots=True)
class OutcomeLimits:
    """Distances (m) up to which a step counts as no slip, microslip and slide.

    30 and 100 mm: Leamon and Li 1990 (from memory, not verified; the four classes are those of
    Liu et al. 2013, PLoS ONE 8:e68989). 13 mm: the most that a heel moved in the recorded steps of
    dry walking between slip start and slip end (assumed).
    """

    no_slip: float = 0.013
    microslip: float = 0.03
    slide: float = 0.10

    def __post_init__(self) -> None:
        if not 0 < self.no_slip < self.microslip < self.slide:
            raise InputError("limits do not rise", where="slip.limits")

    def outcome(self, distance: float) -> Outcome:
        """Return the class of a distance in m."""
        if distance <= self.no_slip:
            return Outcome.NO_SLIP
        if distance <= self.microslip:
            return Outcome.MICROSLIP
        return Outcome.SLIDE if distance <= self.slide else Outcome.SLIP


@dataclass(frozen=True, slots=True)
class ObservedSlip:
    """A slip as a laboratory would report it; SI.

    ``start`` and ``duration`` are None where they can't be told. ``distance`` is the way from
    contact to the end of the slip; ``peak_speed`` that of ``trials.slip`` (report G.5.1, G.6.1),
    0 when the heel has no speed peak after its first minimum. ``row_peaks`` (rows,) are the
    highest readings of each row.
    """

    peak_speed: float
    start: float | None
    distance: float
    outcome: Outcome
    slipped: bool
    peak_pressure: float
    row_peaks: tuple[float, ...]
    duration: float | None
    crossed: bool
    flags: tuple[str, ...]


def heel_marker(motion: SlipMotion) -> tuple[Array, Array]:
    """Return times (n,) s since contact and positions (n, 3) m of a marker behind the heel.

    Before contact the heel comes in from its swing; a foot that rests stays, then lifts.
    """
    time, speed = motion.time, motion.speed
    first, last = -BEFORE, float(time[-1])
    lift = math.inf
    if not motion.still_sliding:
        lift = last + 0.15
        last += AFTER
    frames = np.arange(math.floor(first * RATE), math.floor(last * RATE) + 1) / RATE
    v = np.interp(frames, time, speed, right=float(speed[-1]))
    swing = frames < 0
    v[swing] = np.minimum(motion.walker.heel_speed - SWING_BRAKING * frames[swing], SWING_SPEED)
    slow = frames < -0.35
    v[slow] *= np.clip((frames[slow] + BEFORE) / (BEFORE - 0.35), 0.0, 1.0)
    gone = frames > lift
    v[gone] += 20.0 * (frames[gone] - lift)
    x = np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]) / RATE)])
    x -= np.interp(0.0, frames, x)
    z = 0.02 + np.where(
        gone, 5.0 * (frames - min(lift, last)) ** 2 + 0.3 * (frames - min(lift, last)), 0.0
    )
    z += np.where(swing, np.minimum(0.25 * frames**2 + 0.1 * -frames, 0.12), 0.0)
    return frames, np.column_stack([x, np.zeros(frames.size), z])


def judged(motion: SlipMotion) -> Slip:
    """Return the slip as ``trials.slip`` finds it in the simulated heel marker."""
    from underfoot.trials.slips import slip
    from underfoot.trials.trial import Marker

    frames, positions = heel_marker(motion)
    marker = Marker(positions, RATE, start=float(frames[0]), note="simulated")
    return slip(marker, 0.0, up=UP, walking=WALK)


def observed(
    motion: SlipMotion,
    pressures: Array | None,
    array: SensorArray,
    *,
    limits: OutcomeLimits | None = None,
    seed: int = 0,
) -> ObservedSlip:
    """Return what a laboratory would report of a simulated slip.

    ``pressures`` (n, rows, columns) are the sensors' true readings at ``motion.time``, None for a
    floor without fluid; noise of the report's sensors (0.24 kPa) is added, and peaks and durations
    taken by ``trials.pressure_pulse``.
    """
    limits = limits or OutcomeLimits()
    found = judged(motion)
    peak = found.peak_speed.value
    flags = found.peak_speed.flags
    if peak is None:
        flags = (*flags, f"no peak: {found.peak_speed.reason}")
    end = found.end if math.isfinite(found.end) else float(motion.time[-1])
    distance = float(np.interp(end, motion.time, motion.distance))
    rows: tuple[float, ...] = ()
    duration = None
    highest = 0.0
    if pressures is not None:
        rows, duration, highest = _pulses(motion, pressures, seed)
    reach = motion.distance[-1] >= motion.walker.landing
    inside = abs(motion.walker.lateral) <= 0.5 * (array.columns - 1) * array.spacing
    return ObservedSlip(
        peak_speed=peak or 0.0,
        start=found.start.value,
        distance=distance,
        outcome=limits.outcome(distance),
        slipped=bool(found.slipped),
        peak_pressure=highest,
        row_peaks=rows,
        duration=duration,
        crossed=bool(reach and inside),
        flags=tuple(dict.fromkeys((*flags, *motion.notes))),
    )


def _pulses(
    motion: SlipMotion, pressures: Array, seed: int
) -> tuple[tuple[float, ...], float | None, float]:
    """Return peaks by row, duration at the sensor of the highest peak, and that peak."""
    from underfoot.trials.pressures import pressure_pulse
    from underfoot.trials.trial import Channel

    generator = np.random.default_rng(seed)
    times = np.arange(-BEFORE, float(motion.time[-1]) + 0.05, 1 / PRESSURE_RATE)
    peaks = np.zeros(pressures.shape[1:])
    durations: dict[tuple[int, int], Measurement] = {}
    for i, j in np.ndindex(*peaks.shape):
        true = np.interp(times, motion.time, pressures[:, i, j], left=0.0, right=0.0)
        noisy = true + generator.normal(0.0, BASELINE_SD, times.size)
        pulse = pressure_pulse(
            f"{i}{j}", Channel(noisy, "Pa", PRESSURE_RATE, start=float(times[0])), 0.0
        )
        peaks[i, j] = pulse.peak.value or 0.0
        durations[i, j] = pulse.duration
    top = np.unravel_index(int(peaks.argmax()), peaks.shape)
    return (
        tuple(float(p) for p in peaks.max(axis=1)),
        durations[int(top[0]), int(top[1])].value,
        float(peaks.max()),
    )
