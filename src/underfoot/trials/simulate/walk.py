"""Made-up walking with a slip over a sensor array, truth known; nobody walked here.

The shapes are simple on purpose (raised cosines, Gaussians): they put events, speeds, friction
and pressures where the truth says, and nothing else in them is meant to be human.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

RATE, MARKER_RATE = 1000.0, 200.0
DURATION = 5.0
SENSOR_SPACING = 0.03
FIRST_CONTACT, SLIP_CONTACT = 1.6, 2.2
_HEEL_TO_PRESSURE = 0.02  # m; the pressure's middle lies ahead of the heel's back (report G.4)


@dataclass(frozen=True, slots=True)
class SlipTruth:
    """What is put into one trial.

    Parameters
    ----------
    rcof
        Peak of resultant shear over normal force of the dry step.
    acof
        Shear over normal force while sliding.
    peak_speed
        Largest speed of the heel during the slip (m/s).
    slip_start
        Local minimum of the heel's speed, after contact (s).
    rise, fall
        Duration of speeding up and slowing down (s).
    angle
        Direction of the slip to the left of the walk (rad).
    pressure
        Largest pressure under the heel (Pa); ``width`` its Gaussian sd (m).
    row_decay
        Factor from one row of sensors to the next.
    lateral
        Place of the heel's middle to the left of the middle sensor (m).
    mass
        Of the walker (kg).
    """

    rcof: float = 0.2
    acof: float = 0.1
    peak_speed: float = 1.2
    slip_start: float = 0.04
    rise: float = 0.18
    fall: float = 0.25
    angle: float = 0.0
    pressure: float = 120e3
    width: float = 0.015
    row_decay: float = 0.7
    lateral: float = 0.005
    mass: float = 70.0


@dataclass(frozen=True, slots=True)
class Defects:
    """What goes wrong in the recording; zero is a perfect one."""

    marker_noise: float = 0.3e-3
    force_noise: float = 1.0
    pressure_noise: float = 240.0
    force_offset: float = 8.0
    pressure_offset: float = 900.0
    missing_frames: int = 0
    dropped_samples: int = 0


@dataclass(frozen=True, slots=True)
class WalkRecording:
    """Markers (m), analog channels (SI) and the sensors' places (m) of one made-up trial."""

    markers: Mapping[str, np.ndarray]
    force: tuple[np.ndarray, np.ndarray]
    centre: tuple[np.ndarray, np.ndarray]
    pressures: Mapping[str, np.ndarray]
    sensors: Mapping[str, tuple[float, float, float]]
    corners: tuple[np.ndarray, np.ndarray]
    truth: dict[str, float] = field(default_factory=dict)


def walk_with_slip(
    truth: SlipTruth, defects: Defects, rng: np.random.Generator, *, duration: float = DURATION
) -> WalkRecording:
    """Return a recording: a dry step on plate 1, then a slip (or none) on plate 2.

    Walking along +x, z up. Plate 2 holds nine pressure sensors, 3 x 3, 30 mm apart; the heel
    lands just behind them.
    """
    time = np.arange(round(duration * RATE)) / RATE
    frames = np.arange(round(duration * MARKER_RATE)) / MARKER_RATE
    corners = _plate_corners(0.0), _plate_corners(0.62)
    array = np.array([0.82, 0.0])
    sensors = {
        f"P{row + 1}{column + 1}": (
            float(array[0] + SENSOR_SPACING * (row - 1)),
            float(array[1] + SENSOR_SPACING * (1 - column)),
            0.0,
        )
        for row in range(3)
        for column in range(3)
    }
    landing = np.array([array[0] - SENSOR_SPACING - 0.02 - _HEEL_TO_PRESSURE, truth.lateral])
    left = _slipping_heel(time, landing, truth)
    right = _walking_heel(time, np.array([0.15, -0.1]), FIRST_CONTACT)
    pressures = _pressures(time, left, sensors, truth)
    dry, dry_centre, rcof = _dry_step(time, right, truth)
    slip, slip_centre = _slip_step(time, left, truth)
    path = _speed_of(left)
    begin = int(np.searchsorted(time, SLIP_CONTACT))
    facts = {
        "rcof": rcof,
        "acof": truth.acof,
        "peak_slipping_speed": float(path[begin:].max()) if truth.peak_speed > 0 else 0.0,
        "slip_start": SLIP_CONTACT + truth.slip_start,
        "heel_contact": SLIP_CONTACT,
    }
    # Only the slip counts: the swing after it is faster.
    end = SLIP_CONTACT + truth.slip_start + truth.rise + truth.fall
    window = (time >= SLIP_CONTACT + truth.slip_start) & (time <= end)
    facts["peak_slipping_speed"] = float(path[window].max())
    facts |= {f"peak_pressure_{name}": float(values.max()) for name, values in pressures.items()}
    markers = _markers(frames, time, left, right, defects, rng)
    for name, values in pressures.items():
        noisy = values + defects.pressure_offset + rng.normal(0, defects.pressure_noise, len(time))
        pressures[name] = _dropped(noisy, defects.dropped_samples, rng)
    forces = []
    for force in (dry, slip):
        offset = defects.force_offset * rng.uniform(-1, 1, 3)
        forces.append(force + offset + rng.normal(0, defects.force_noise, force.shape))
    return WalkRecording(
        markers,
        (forces[0], forces[1]),
        (dry_centre, slip_centre),
        pressures,
        sensors,
        corners,
        facts,
    )


def _plate_corners(begin: float) -> np.ndarray:
    """Corners of a 0.6 x 0.6 m plate; plate axes x = lab y, y = lab x, z down."""
    low, high = np.array([begin, -0.3, 0.0]), np.array([begin + 0.6, 0.3, 0.0])
    return np.array(
        [
            [high[0], high[1], 0.0],
            [high[0], low[1], 0.0],
            [low[0], low[1], 0.0],
            [low[0], high[1], 0.0],
        ]
    )


def raised_cosines(time: np.ndarray, knots: list[tuple[float, float]]) -> np.ndarray:
    """Return raised cosines through (time, value) knots: every knot is an extreme or a level."""
    out = np.full(len(time), knots[0][1])
    for (t0, v0), (t1, v1) in pairwise(knots):
        part = (time >= t0) & (time < t1)
        out[part] = v0 + (v1 - v0) * 0.5 * (1 - np.cos(np.pi * (time[part] - t0) / (t1 - t0)))
    out[time >= knots[-1][0]] = knots[-1][1]
    return out


def _slipping_heel(time: np.ndarray, landing: np.ndarray, truth: SlipTruth) -> np.ndarray:
    start = SLIP_CONTACT + truth.slip_start
    peak = start + truth.rise
    end = peak + truth.fall
    speed = raised_cosines(
        time,
        [
            (SLIP_CONTACT - 0.45, 0.0),
            (SLIP_CONTACT - 0.25, 4.2),
            (start, 0.02),
            (peak, truth.peak_speed),
            (end, 0.03),
            (end + 0.2, 0.035),
            (end + 0.45, 1.5),
            (end + 0.8, 0.0),
        ],
    )
    turn = np.where(time < start, 0.0, truth.angle)
    x = np.cumsum(speed * np.cos(turn)) / RATE
    y = np.cumsum(speed * np.sin(turn)) / RATE
    at = int(np.searchsorted(time, SLIP_CONTACT))
    x += landing[0] - x[at]
    y += landing[1] - y[at]
    lift = end + 0.12
    z = 0.02 + raised_cosines(
        time,
        [
            (SLIP_CONTACT - 0.45, 0.0),
            (SLIP_CONTACT - 0.25, 0.12),
            (SLIP_CONTACT, 0.0),
            (lift, 0.0),
            (lift + 0.25, 0.15),
            (lift + 0.5, 0.0),
        ],
    )
    return np.column_stack((x, y, z))


def _walking_heel(time: np.ndarray, landing: np.ndarray, contact: float) -> np.ndarray:
    # A heel turns about the ball of the foot: it rises by centimetres before it goes forward.
    speed = raised_cosines(
        time,
        [
            (contact - 0.45, 0.0),
            (contact - 0.25, 4.2),
            (contact + 0.03, 0.02),
            (contact + 0.43, 0.03),
            (contact + 0.65, 4.4),
            (contact + 0.95, 0.0),
        ],
    )
    x = np.cumsum(speed) / RATE
    x += landing[0] - x[int(np.searchsorted(time, contact))]
    z = 0.02 + raised_cosines(
        time,
        [
            (contact - 0.45, 0.0),
            (contact - 0.25, 0.12),
            (contact, 0.0),
            (contact + 0.35, 0.0),
            (contact + 0.6, 0.2),
            (contact + 0.9, 0.0),
        ],
    )
    return np.column_stack((x, np.full(len(time), landing[1]), z))


def _dry_step(
    time: np.ndarray, heel: np.ndarray, truth: SlipTruth
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return force (n, 3), centre of pressure (n, 3) and the true RCOF of the dry step."""
    length = 0.65
    s = (time - FIRST_CONTACT) / length
    on = (s > 0) & (s < 1)
    weight = truth.mass * 9.80665
    shape = np.exp(-(((s - 0.25) / 0.16) ** 2)) + 1.02 * np.exp(-(((s - 0.75) / 0.16) ** 2))
    shape += 0.55 * np.exp(-(((s - 0.5) / 0.2) ** 2))
    edge = np.clip(np.minimum(s / 0.08, (1 - s) / 0.08), 0, 1)
    normal = np.where(on, weight * shape * 0.5 * (1 - np.cos(np.pi * edge)), 0.0)
    ratio = np.exp(-(((s - 0.17) / 0.11) ** 2)) - 0.9 * np.exp(-(((s - 0.84) / 0.1) ** 2))
    braking = truth.rcof * ratio
    sideways = 0.1 * truth.rcof * np.sin(np.pi * np.clip(s, 0, 1))
    force = np.column_stack((-braking * normal, sideways * normal, normal))
    firm = on & (s < 0.5) & (normal > 100.0)
    rcof = float(np.hypot(braking[firm], sideways[firm]).max())
    x0 = heel[int(np.searchsorted(time, FIRST_CONTACT + 0.1)), 0]
    centre = np.column_stack(
        (x0 + 0.2 * np.clip(s, 0, 1), np.full(len(s), heel[0, 1]), np.zeros(len(s)))
    )
    return force, centre, rcof


def _slip_step(
    time: np.ndarray, heel: np.ndarray, truth: SlipTruth
) -> tuple[np.ndarray, np.ndarray]:
    """Return force and centre of pressure while sliding at ``truth.acof``."""
    end = truth.slip_start + truth.rise + truth.fall + 0.15
    weight = truth.mass * 9.80665
    normal = weight * raised_cosines(
        time - SLIP_CONTACT,
        [(0.0, 0.0), (0.1, 0.8), (max(0.55, end) - 0.1, 0.75), (max(0.6, end), 0.0)],
    )
    ratio = truth.acof * np.clip((time - SLIP_CONTACT) / 0.02, 0, 1)
    force = np.column_stack(
        (-ratio * np.cos(truth.angle) * normal, -ratio * np.sin(truth.angle) * normal, normal)
    )
    centre = heel + np.array([_HEEL_TO_PRESSURE, 0.0, 0.0])
    centre[:, 2] = 0.0
    return force, centre


def _pressures(
    time: np.ndarray,
    heel: np.ndarray,
    sensors: Mapping[str, tuple[float, float, float]],
    truth: SlipTruth,
) -> dict[str, np.ndarray]:
    """A Gaussian pressure under the moving heel, fading from row to row as the film thins."""
    loaded = (time >= SLIP_CONTACT) & (heel[:, 2] < 0.025)
    # The load comes on in 40 ms, and the pressure with it.
    onset = 0.5 * (1 - np.cos(np.pi * np.clip((time - SLIP_CONTACT) / 0.04, 0, 1)))
    found = {}
    for name, (x, y, _) in sensors.items():
        away = (x - heel[:, 0] - _HEEL_TO_PRESSURE) ** 2 + (y - heel[:, 1]) ** 2
        height = truth.pressure * truth.row_decay ** (int(name[1]) - 1)
        found[name] = np.where(loaded, onset * height * np.exp(-away / (2 * truth.width**2)), 0.0)
    return found


def _markers(
    frames: np.ndarray,
    time: np.ndarray,
    left: np.ndarray,
    right: np.ndarray,
    defects: Defects,
    rng: np.random.Generator,
) -> dict[str, np.ndarray]:
    body = np.column_stack(
        (1.35 * (frames - FIRST_CONTACT) - 0.1, np.zeros(len(frames)), np.full(len(frames), 0.95))
    )
    found = {}
    for side, path, sign in (("L", left, 1.0), ("R", right, -1.0)):
        heel = np.column_stack([np.interp(frames, time, path[:, i]) for i in range(3)])
        found[f"{side}HEE"] = heel
        found[f"{side}TOE"] = heel + np.array([0.2, 0.0, 0.03])
        found[f"{side}ASI"] = body + np.array([0.08, 0.12 * sign, 0.0])
        found[f"{side}PSI"] = body + np.array([-0.1, 0.05 * sign, 0.02])
    for name in found:
        found[name] = found[name] + rng.normal(0, defects.marker_noise, found[name].shape)
    if defects.missing_frames:
        middle = int(rng.uniform(SLIP_CONTACT + 0.15, SLIP_CONTACT + 0.3) * MARKER_RATE)
        found["LHEE"][middle : middle + defects.missing_frames] = np.nan
    return found


def _dropped(values: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    if count:
        begin = int(rng.integers(0, len(values) - count))
        values[begin : begin + count] = np.nan
    return values


def _speed_of(path: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.gradient(path[:, :2], 1.0 / RATE, axis=0), axis=1)
