"""Made-up walking on two treadmill belts, truth known; nobody walked here."""

import numpy as np

from .walk import (
    GRAVITY,
    MARKER_RATE,
    RATE,
    WalkRecording,
    foot_markers,
    raised_cosines,
    stance_load,
    stance_ratio,
)  # fmt: skip

_STANCE, _STRIDE = 0.66, 1.1  # s
_AHEAD = 0.3  # m; where a heel comes down, ahead of the body


def treadmill_walk(
    rng: np.random.Generator,
    *,
    stances: int = 45,
    speeds: tuple[float, float] = (1.25, 1.25),
    rcof: float = 0.2,
    mass: float = 70.0,
    slip: float = 0.0,
) -> WalkRecording:
    """Return a walk along +x on a right and a left belt, a plate under each.

    ``speeds`` are those of the right and the left belt (m/s): they differ on a split belt. Each
    slows down by 3 % while a foot brakes on it. ``rcof`` is the peak of resultant shear over normal
    force; it scatters by 5 % from step to step. ``slip`` is the distance (m) that the heel slides
    forward over the belt in the fifth stance.
    """
    time = np.arange(round((0.5 * _STRIDE * stances + 2.0) * RATE)) / RATE
    forces, centres, heels, ratios = [], [], {}, []
    for i, (side, lateral) in enumerate((("R", -0.1), ("L", 0.1))):
        contacts = 0.8 + 0.5 * _STRIDE * i + _STRIDE * np.arange((stances + 1 - i) // 2)
        force, centre = np.zeros((len(time), 3)), np.zeros((len(time), 3))
        belt, swing, height = np.full(len(time), speeds[i]), [(0.0, 0.0)], [(0.0, 0.0)]
        for n, contact in enumerate(contacts):
            share = (time - contact) / _STANCE
            on = (share > 0) & (share < 1)
            impact = 0.12 * np.exp(-(((share - 0.03) / 0.006) ** 2)) * on
            normal = mass * GRAVITY * (stance_load(share) + impact)
            peak = rcof * (1.0 + 0.05 * rng.standard_normal())
            push = peak * stance_ratio(share) * normal
            force += np.column_stack((-push, 0.05 * push, normal))
            ratios.append(float(peak * np.hypot(1.0, 0.05)))
            belt -= 0.03 * speeds[i] * np.exp(-(((share - 0.15) / 0.1) ** 2))
            slides = slip > 0 and i == 0 and n == 2
            if slides:
                swing += [(contact + 0.02, 0.0), (contact + 0.1, 2 * slip / 0.2)]
            # The swing carries the foot forward over the belt as far as the belt carries it back.
            way = speeds[i] * _STRIDE - (slip if slides else 0.0)
            lift, down = contact + 0.7 * _STANCE, contact + _STRIDE - 0.01
            swing += [
                (contact + 0.22, 0.0),
                (lift, 0.0),
                (0.5 * (lift + down), 2 * way / (down - lift)),
                (down, 0.0),
            ]
            height += [(lift - 0.1, 0.0), (lift + 0.15, 0.18), (down, 0.0)]
        moved = np.cumsum(raised_cosines(time, swing) - belt) / RATE
        first = int(np.searchsorted(time, contacts[0]))
        x = moved - moved[first] + _AHEAD
        heels[side] = np.column_stack(
            (x, np.full(len(time), lateral), 0.02 + raised_cosines(time, height))
        )
        for contact in contacts:
            share = (time - contact) / _STANCE
            on = (share > 0) & (share < 1)
            start = x[int(np.searchsorted(time, contact))]
            carried = start - speeds[i] * (time - contact) + 0.02 + 0.22 * share
            centre[on] = np.column_stack((carried, np.full(len(time), lateral), 0 * time))[on]
        forces.append(force + rng.normal(0.0, 0.8, force.shape))
        centres.append(centre)
    frames = np.arange(round(time[-1] * MARKER_RATE)) / MARKER_RATE
    sway = np.column_stack(
        (
            0.02 * np.sin(4 * np.pi * frames / _STRIDE),
            0.02 * np.sin(2 * np.pi * frames / _STRIDE),
            0.95 + 0.02 * np.cos(4 * np.pi * frames / _STRIDE),
        )
    )
    seen = {
        side: np.column_stack([np.interp(frames, time, path[:, i]) for i in range(3)])
        for side, path in heels.items()
    }
    markers = foot_markers(seen, sway, (0.2, 0.0, 0.02), 0.1, 0.05)
    noisy = {name: path + rng.normal(0.0, 3e-4, path.shape) for name, path in markers.items()}
    corners = _belt_corners(0.0), _belt_corners(0.5)
    truth = {"rcof": float(np.mean(ratios)), "speed_right": speeds[0], "speed_left": speeds[1]}
    samples = round(len(frames) * RATE / MARKER_RATE)
    force, centre = ((both[0][:samples], both[1][:samples]) for both in (forces, centres))
    return WalkRecording(noisy, force, centre, {}, {}, corners, truth)


def _belt_corners(left: float) -> np.ndarray:
    right = left - 0.5
    return np.array([(1.0, left, 0.0), (1.0, right, 0.0), (-1.0, right, 0.0), (-1.0, left, 0.0)])
