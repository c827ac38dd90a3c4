"""Made-up activities over two force plates: walking, and what must not be taken for it.

Simple shapes with the forces, times and marker paths of textbooks; nobody moved here.
"""

from collections.abc import Mapping

import numpy as np

from . import walk
from .c3d_file import walk_c3d

DURATION = 4.0
Motion = tuple[
    list[np.ndarray], list[np.ndarray], list[np.ndarray], np.ndarray, tuple[float, float]
]
"""Forces, centres of pressure and heels of both feet, the pelvis, heights of the plates."""


def activity(
    name: str, rng: np.random.Generator, *, mass: float = 70.0, markers: bool = True
) -> walk.WalkRecording:
    """Return a made-up recording of an activity, a key of ``ACTIVITIES``.

    ``mass`` is that of the person (kg). Without ``markers`` (heels, toes, pelvis) only the plates
    tell.
    """
    time = np.arange(round(DURATION * walk.RATE)) / walk.RATE
    if name in _STEPS:
        motion = _steps(time, mass * walk.GRAVITY, **_STEPS[name])
    else:
        load, height = (walk.raised_cosines(time, knots) for knots in _STANDING[name])
        motion = _standing_feet(time, mass * walk.GRAVITY * load, height)
    forces, centres, heels, body, heights = motion
    noisy = [force + rng.normal(0.0, 0.6, force.shape) for force in forces]
    frames = np.arange(round(DURATION * walk.MARKER_RATE)) / walk.MARKER_RATE
    left, right, pelvis = (
        np.column_stack([np.interp(frames, time, path[:, i]) for i in range(3)])
        for path in (heels[1], heels[0], body)
    )
    found = walk.foot_markers({"R": right, "L": left}, pelvis, (0.2, 0.0, 0.02), 0.1, 0.05)
    noise = {key: path + rng.normal(0.0, 3e-4, path.shape) for key, path in found.items()}
    if not markers:
        noise = {"origin": np.full((len(frames), 3), 5.0)}
    corners = (
        walk.plate_corners(0.0, 0.45, heights[0]),
        walk.plate_corners(0.65, 0.45, heights[1]),
    )
    return walk.WalkRecording(
        noise, (noisy[0], noisy[1]), (centres[0], centres[1]), {}, {}, corners
    )


def activity_c3d(
    recording: walk.WalkRecording, *, crossed: bool = False, mass: float = 0.0
) -> bytes:
    """Return a recording of an activity as C3D; ``crossed`` writes corners 3 and 4 exchanged."""
    order = (0, 1, 3, 2) if crossed else (0, 1, 2, 3)
    return walk_c3d(recording, origin=0.0, order=order, mass=mass)


def _heel(
    time: np.ndarray, contact: float, stance: float, place: np.ndarray, speed: float
) -> np.ndarray:
    """Heel that lands at ``place`` (3,), stands, and swings on at ``speed`` of the body (m/s)."""
    swing, lift, end = 4.0 * speed / 1.35, contact + 0.5 * stance, contact + stance
    before, top = contact - 0.4, contact - 0.22
    still = [(contact + 0.03, 0.02), (contact + 0.65 * stance, 0.02)]
    speeds = [(before, 0.0), (top, swing), *still, (end + 0.05, swing), (end + 0.42, 0.0)]
    heights = [(before, 0.0), (top, 0.12), (contact, 0.0), (lift, 0.0)]
    heights += [(lift + 0.28, 0.2), (lift + 0.72, 0.0)]
    return walk.heel_path(time, contact, place, speeds, heights)


def _steps(
    time: np.ndarray,
    weight: float,
    *,
    stance: float = 0.66,
    pace: float = 0.55,
    speed: float = 1.3,
    half_sine: float = 0.0,
    ratio: float = 0.2,
    rise: float = 0.0,
    turn: float = 0.0,
) -> Motion:
    """Right foot on plate 1, then left foot on plate 2, ``rise`` higher; ``turn`` (rad) between.

    The load over body weight is a half sine of that height; at zero that of walking.
    """
    forces, centres, heels = [], [], []
    for i, side in enumerate((-1.0, 1.0)):
        contact = 1.2 + pace * i
        share = (time - contact) / stance
        place = np.array([0.15 + 0.62 * i, 0.08 * side, rise * i])
        load = half_sine * np.sin(np.pi * np.clip(share, 0, 1)) * ((share > 0) & (share < 1))
        load = load if half_sine else walk.stance_load(share)
        # A short transient of the heel, so that forces have the frequencies of real ones.
        impact = 0.12 * np.exp(-(((share - 0.03) / 0.006) ** 2))
        normal = weight * (load + impact * (load > 0))
        angle = turn * np.clip((share - 0.2) / 0.6, 0, 1)
        push = ratio * walk.stance_ratio(share) * normal
        forces.append(
            np.column_stack((-push * np.cos(angle), -push * np.sin(angle) + 0.05 * push, normal))
        )
        forward = 0.22 * np.clip(share, 0, 1)
        zero = np.full(len(time), place[1])
        centres.append(np.column_stack((place[0] + forward, zero, np.full(len(time), place[2]))))
        heels.append(_heel(time, contact, stance, place, speed))
    since = time - 1.2
    way = turn * np.clip(since / stance, 0, 2)
    body = np.column_stack(
        (
            np.cumsum(speed * np.cos(way)) / walk.RATE - speed * 1.2 + 0.15,
            np.cumsum(speed * np.sin(way)) / walk.RATE,
            0.95 + rise * np.clip(since / pace, 0, 2),
        )
    )
    return forces, centres, heels, body, (0.0, rise)


def _standing_feet(time: np.ndarray, vertical: np.ndarray, height: np.ndarray) -> Motion:
    """Both feet side by side over the gap: half of the load on each plate, a little push."""
    sway = 0.01 * vertical * np.sin(2 * np.pi * 0.6 * time)
    landing = np.gradient(vertical, 1.0 / walk.RATE)
    push = sway - 0.12 * vertical * np.clip(landing / 4e4, -1.0, 1.0)
    forces, centres, heels = [], [], []
    for i, side in enumerate((-1.0, 1.0)):
        forces.append(np.column_stack((0.5 * push, 0.04 * side * vertical, 0.5 * vertical)))
        place = np.array([0.3 + 0.65 * i, 0.0, 0.0])
        centres.append(place + np.column_stack((3e-5 * (vertical - 600), 0 * time, 0 * time)))
        lifted = np.maximum(height, 0.0)
        heels.append(place + np.column_stack((0 * time - 0.1, 0 * time, 0.02 + lifted)))
    body = np.column_stack((0.6 + 0.004 * np.sin(time), 0 * time, 0.95 + height))
    return forces, centres, heels, body, (0.0, 0.0)


ACTIVITIES: Mapping[str, str] = {
    "walk": "level walking, a step on each plate",
    "standing": "quiet standing",
    "jump": "countermovement jump",
    "drop_jump": "drop jump with rebound",
    "running": "running at 3.2 m/s",
    "jogging": "slow jogging at 2.3 m/s",
    "stairs_up": "two stairs upward",
    "stairs_down": "two stairs downward",
    "turn": "a walk that turns by 90 deg in a step",
}
_STEPS: Mapping[str, Mapping[str, float]] = {
    "walk": {},
    "running": {"stance": 0.25, "pace": 0.36, "speed": 3.2, "half_sine": 2.5, "ratio": 0.25},
    "jogging": {"stance": 0.38, "pace": 0.42, "speed": 2.3, "half_sine": 1.75, "ratio": 0.22},
    "stairs_up": {"rise": 0.17, "speed": 0.6},
    "stairs_down": {"rise": -0.17, "speed": 0.6},
    "turn": {"turn": np.radians(90.0)},
}
# (s, load over body weight) and (s, height of the body in m) of both feet side by side: a jump is
# standing, unweighting, push-off, flight, landing; a drop jump comes from a box behind the plates.
_STANDING: Mapping[str, tuple[list[tuple[float, float]], list[tuple[float, float]]]] = {
    "standing": ([(0.0, 1.0)], [(0.0, 0.0)]),
    "jump": (
        [(0.0, 1.0), (1.0, 1.0), (1.25, 0.4), (1.55, 2.3), (1.7, 0.0), (2.1, 0.0), (2.15, 3.6),
         (2.4, 0.8), (2.6, 1.05), (2.8, 1.0)],
        [(1.0, 0.0), (1.4, -0.25), (1.7, 0.0), (1.9, 0.3), (2.1, 0.0)],
    ),
    "drop_jump": (
        [(0.0, 0.0), (0.99, 0.0), (1.05, 3.7), (1.2, 2.2), (1.4, 0.0), (1.85, 0.0), (1.9, 3.4),
         (2.2, 0.9), (2.4, 1.0), (4.0, 1.0)],
        [(0.6, 0.3), (1.0, 0.0), (1.2, -0.2), (1.4, 0.0), (1.62, 0.25), (1.85, 0.0), (2.1, -0.15),
         (2.4, 0.0)],
    ),
}  # fmt: skip
