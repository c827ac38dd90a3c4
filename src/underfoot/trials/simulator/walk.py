"""Made-up walking with a slip over a sensor array, truth known; nobody walked here.

The shapes are simple on purpose (raised cosines, Gaussians): they put events, speeds, friction
and pressures where the truth says, and nothing else in them is meant to be human.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

RATE, MARKER_RATE = 1000.0, 200.0
DURATION = 5.0
GRAVITY = 9.80665
SENSOR_SPACING = 0.03
FIRST_CONTACT, SLIP_CONTACT = 1.6, 2.2
_HEEL_TO_PRESSURE = 0.02  # m; the pressure's middle lies ahead of the heel's back (report G.4)
_MIDDLE = 0.82  # m along the walk
SENSORS: Mapping[str, tuple[float, float, float]] = {
    f"P{row + 1}{column + 1}": (
        _MIDDLE + SENSOR_SPACING * (row - 1), SENSOR_SPACING * (1 - column), 0.0
    )
    for row in range(3)
    for column in range(3)
}  # fmt: skip
"""Places (m) of the pressure sensors, rows along the walk, columns from left to right."""


@dataclass(frozen=True, slots=True)
class SlipTruth:
    """What is put into one trial.

    ``rcof`` is the peak of resultant shear over normal force of the dry step, ``acof`` shear over
    normal force while sliding. The slip starts at a local minimum of the heel's speed,
    ``slip_start`` (s) after contact, speeds up for ``rise`` (s) to ``peak_speed`` (m/s) and slows
    down for ``fall`` (s), ``angle`` (rad) to the left of the walk. ``pressure`` (Pa) is the largest
    under the heel, ``width`` (m) its Gaussian sd, ``row_decay`` the factor from one row of sensors
    to the next, ``lateral`` (m) the place of the heel's middle to the left of the middle sensor,
    ``mass`` (kg) that of the walker.
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
    landing = np.array([_MIDDLE - SENSOR_SPACING - 0.02 - _HEEL_TO_PRESSURE, truth.lateral, 0.0])
    begin = SLIP_CONTACT + truth.slip_start
    end = begin + truth.rise + truth.fall
    left = _slipping_heel(time, landing, truth, begin, end)
    # A heel turns about the ball of the foot: it rises by centimetres before it goes forward.
    at = FIRST_CONTACT
    speeds = [*_swing(at, 4.2), (at + 0.03, 0.02), (at + 0.43, 0.03), (at + 0.65, 4.4)]
    heights = [*_swing(at, 0.12), (at, 0.0), (at + 0.35, 0.0), (at + 0.6, 0.2), (at + 0.9, 0.0)]
    place = np.array([0.15, -0.1, 0.0])
    right = heel_path(time, at, place, [*speeds, (at + 0.95, 0.0)], heights)
    pressures = _pressures(time, left, truth)
    dry, dry_centre, rcof = _dry_step(time, right, truth)
    slip, slip_centre = _slip_step(time, left, truth)
    # Only the slip counts: the swing after it is faster.
    speed = np.linalg.norm(np.gradient(left[:, :2], 1.0 / RATE, axis=0), axis=1)
    facts = {
        "rcof": rcof,
        "acof": truth.acof,
        "peak_slipping_speed": float(speed[(time >= begin) & (time <= end)].max()),
        "slip_start": begin,
        "heel_contact": SLIP_CONTACT,
        **{f"peak_pressure_{name}": float(values.max()) for name, values in pressures.items()},
    }
    body = np.column_stack(
        (1.35 * (frames - FIRST_CONTACT) - 0.1, np.zeros(len(frames)), np.full(len(frames), 0.95))
    )
    heels = {
        side: np.column_stack([np.interp(frames, time, path[:, i]) for i in range(3)])
        for side, path in (("L", left), ("R", right))
    }
    markers = foot_markers(heels, body, (0.2, 0.0, 0.03), 0.12, 0.05)
    for name, path in markers.items():
        markers[name] = path + rng.normal(0, defects.marker_noise, path.shape)
    if defects.missing_frames:
        at = int(rng.uniform(SLIP_CONTACT + 0.15, SLIP_CONTACT + 0.3) * MARKER_RATE)
        markers["LHEE"][at : at + defects.missing_frames] = np.nan
    for name, values in pressures.items():
        noisy = values + defects.pressure_offset + rng.normal(0, defects.pressure_noise, len(time))
        if defects.dropped_samples:
            at = int(rng.integers(0, len(values) - defects.dropped_samples))
            noisy[at : at + defects.dropped_samples] = np.nan
        pressures[name] = noisy
    forces = []
    for force in (dry, slip):
        offset = defects.force_offset * rng.uniform(-1, 1, 3)
        forces.append(force + offset + rng.normal(0, defects.force_noise, force.shape))
    plates = (forces[0], forces[1]), (dry_centre, slip_centre)
    corners = plate_corners(0.0), plate_corners(0.62)
    return WalkRecording(markers, *plates, pressures, SENSORS, corners, facts)


def plate_corners(begin: float, half_width: float = 0.3, height: float = 0.0) -> np.ndarray:
    """Return the corners of a plate of 0.6 m; plate axes x = lab y, y = lab x, z down."""
    right, left, end = -half_width, half_width, begin + 0.6
    flat = [(end, left), (end, right), (begin, right), (begin, left)]
    return np.column_stack((flat, np.full(4, height)))


def foot_markers(
    heels: Mapping[str, np.ndarray],
    pelvis: np.ndarray,
    toe: tuple[float, float, float],
    front: float,
    back: float,
) -> dict[str, np.ndarray]:
    """Return heel, toe and pelvis markers by side; ``front`` and ``back`` are half widths (m)."""
    found = {}
    for side, heel in heels.items():
        sign = 1.0 if side == "L" else -1.0
        found[f"{side}HEE"] = heel
        found[f"{side}TOE"] = heel + np.array(toe)
        found[f"{side}ASI"] = pelvis + np.array([0.08, front * sign, 0.0])
        found[f"{side}PSI"] = pelvis + np.array([-0.1, back * sign, 0.02])
    return found


def raised_cosines(time: np.ndarray, knots: list[tuple[float, float]]) -> np.ndarray:
    """Return raised cosines through (time, value) knots: every knot is an extreme or a level."""
    out = np.full(len(time), knots[0][1])
    for (t0, v0), (t1, v1) in pairwise(knots):
        part = (time >= t0) & (time < t1)
        out[part] = v0 + (v1 - v0) * 0.5 * (1 - np.cos(np.pi * (time[part] - t0) / (t1 - t0)))
    out[time >= knots[-1][0]] = knots[-1][1]
    return out


def heel_path(
    time: np.ndarray,
    contact: float,
    landing: np.ndarray,
    speeds: list[tuple[float, float]],
    heights: list[tuple[float, float]],
    angle: np.ndarray | float = 0.0,
) -> np.ndarray:
    """Return a heel (n, 3) that is at ``landing`` at contact, from its speed in ``angle`` (rad)."""
    speed = raised_cosines(time, speeds)
    plane = np.column_stack((speed * np.cos(angle), speed * np.sin(angle))).cumsum(axis=0) / RATE
    plane += landing[:2] - plane[int(np.searchsorted(time, contact))]
    return np.column_stack((plane, landing[2] + 0.02 + raised_cosines(time, heights)))


def _swing(contact: float, most: float) -> list[tuple[float, float]]:
    return [(contact - 0.45, 0.0), (contact - 0.25, most)]


def _slipping_heel(
    time: np.ndarray, landing: np.ndarray, truth: SlipTruth, begin: float, end: float
) -> np.ndarray:
    peak, at, lift = begin + truth.rise, SLIP_CONTACT, end + 0.12
    slide = [(begin, 0.02), (peak, truth.peak_speed), (end, 0.03), (end + 0.2, 0.035)]
    turn = np.where(time < begin, 0.0, truth.angle)
    speeds = [*_swing(at, 4.2), *slide, (end + 0.45, 1.5), (end + 0.8, 0.0)]
    heights = [*_swing(at, 0.12), (at, 0.0), (lift, 0.0), (lift + 0.25, 0.15), (lift + 0.5, 0.0)]
    return heel_path(time, at, landing, speeds, heights, turn)


def stance_load(share: np.ndarray, second: float = 1.0) -> np.ndarray:
    """Return the vertical force over body weight at a share of stance; ``second`` peak's height."""
    on = (share > 0) & (share < 1)
    shape = np.exp(-(((share - 0.25) / 0.16) ** 2))
    shape += second * np.exp(-(((share - 0.75) / 0.16) ** 2))
    shape += 0.55 * np.exp(-(((share - 0.5) / 0.2) ** 2))
    edge = np.clip(np.minimum(share / 0.08, (1 - share) / 0.08), 0, 1)
    return np.where(on, shape * 0.5 * (1 - np.cos(np.pi * edge)), 0.0)


def stance_ratio(share: np.ndarray) -> np.ndarray:
    """Return the braking shear over normal force at a share of stance, as a share of its peak."""
    return np.exp(-(((share - 0.17) / 0.11) ** 2)) - 0.9 * np.exp(-(((share - 0.84) / 0.1) ** 2))


def _dry_step(
    time: np.ndarray, heel: np.ndarray, truth: SlipTruth
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return force (n, 3), centre of pressure (n, 3) and the true RCOF of the dry step."""
    s = (time - FIRST_CONTACT) / 0.65
    normal = truth.mass * GRAVITY * stance_load(s, 1.02)
    braking = truth.rcof * stance_ratio(s)
    sideways = 0.1 * truth.rcof * np.sin(np.pi * np.clip(s, 0, 1))
    force = np.column_stack((-braking * normal, sideways * normal, normal))
    rcof = float(np.hypot(braking, sideways).max())
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
    load = [(0.0, 0.0), (0.1, 0.8), (max(0.55, end) - 0.1, 0.75), (max(0.6, end), 0.0)]
    normal = truth.mass * GRAVITY * raised_cosines(time - SLIP_CONTACT, load)
    ratio = truth.acof * np.clip((time - SLIP_CONTACT) / 0.02, 0, 1)
    force = np.column_stack(
        (-ratio * np.cos(truth.angle) * normal, -ratio * np.sin(truth.angle) * normal, normal)
    )
    centre = heel + np.array([_HEEL_TO_PRESSURE, 0.0, 0.0])
    centre[:, 2] = 0.0
    return force, centre


def _pressures(time: np.ndarray, heel: np.ndarray, truth: SlipTruth) -> dict[str, np.ndarray]:
    """A Gaussian pressure under the moving heel, fading from row to row as the film thins."""
    loaded = (time >= SLIP_CONTACT) & (heel[:, 2] < 0.025)
    # The load comes on in 40 ms, and the pressure with it.
    onset = 0.5 * (1 - np.cos(np.pi * np.clip((time - SLIP_CONTACT) / 0.04, 0, 1)))
    found = {}
    for name, (x, y, _) in SENSORS.items():
        away = (x - heel[:, 0] - _HEEL_TO_PRESSURE) ** 2 + (y - heel[:, 1]) ** 2
        height = truth.pressure * truth.row_decay ** (int(name[1]) - 1)
        found[name] = np.where(loaded, onset * height * np.exp(-away / (2 * truth.width**2)), 0.0)
    return found
