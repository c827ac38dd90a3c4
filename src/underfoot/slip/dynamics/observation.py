"""A simulated slip seen as a recording: heel marker and pressure channels, judged by ``trials``."""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core.arrays import Array
from underfoot.core.remark import Message
from underfoot.trials.machines.pressures import pressure_pulse
from underfoot.trials.recording.measurement import Measurement
from underfoot.trials.recording.trial import Channel, Marker
from underfoot.trials.walking.slips import Outcome, OutcomeLimits, Slip, slip

from .motion import SlipMotion
from .sensors import FloorSensors

RATE = 250.0  # Hz of the marker
PRESSURE_RATE = 1000.0  # Hz of the sensors
BEFORE = 0.8  # s of record before contact
AFTER = 0.35  # s of record after the foot came to rest
SWING_BRAKING = 18.0
"""m/s^2, how fast the heel slows down before contact: mean of the recorded steps over 20 ms."""
SWING_SPEED = 4.0  # m/s, largest speed of the swinging heel before contact
BASELINE_SD = 240.0  # Pa, report G.5.1
UP, WALK = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])


@dataclass(frozen=True, slots=True)
class ObservedSlip:
    """A slip as a laboratory would report it; SI.

    ``start`` and ``duration`` are None where they are not estimated. ``distance`` is the way from
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
    v[slow] *= np.maximum((frames[slow] + BEFORE) / (BEFORE - 0.35), 0.0)
    gone = frames > lift
    v[gone] += 20.0 * (frames[gone] - lift)
    x = np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]) / RATE)])
    x -= np.interp(0.0, frames, x)
    z = 0.02 + np.where(
        gone, 5.0 * (frames - min(lift, last)) ** 2 + 0.3 * (frames - min(lift, last)), 0.0
    )
    z += np.where(swing, np.minimum(0.25 * frames**2 + 0.1 * -frames, 0.12), 0.0)
    return frames, np.column_stack([x, np.zeros(frames.size), z])


def judge_slip(motion: SlipMotion) -> Slip:
    """Return the slip as ``trials.slip`` finds it in the simulated heel marker."""
    frames, positions = heel_marker(motion)
    marker = Marker(positions, RATE, start=float(frames[0]), note="simulated")
    return slip(marker, 0.0, up=UP, walking=WALK)


def observe_slip(
    motion: SlipMotion,
    pressures: Array | None,
    array: FloorSensors,
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
    recorded = judge_slip(motion)
    peak = recorded.peak_speed.value
    flags = tuple(flag.message for flag in recorded.peak_speed.flags)
    if peak is None:
        flags = (*flags, Message("no peak: {reason}", reason=recorded.peak_speed.reason))
    end = recorded.end if math.isfinite(recorded.end) else float(motion.time[-1])
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
        start=recorded.start.value,
        distance=distance,
        outcome=limits.outcome(distance),
        slipped=bool(recorded.slipped),
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
        peaks[i, j] = float(pulse.peak)
        durations[i, j] = pulse.duration
    top = np.unravel_index(int(peaks.argmax()), peaks.shape)
    return (
        tuple(float(p) for p in peaks.max(axis=1)),
        durations[int(top[0]), int(top[1])].value,
        float(peaks.max()),
    )
