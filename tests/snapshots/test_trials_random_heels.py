"""Slips of heels that move at random: humps, noise, gaps, leaps, lifts, ways and limits."""

import numpy as np
import pytest

from snapshot import held
from underfoot.trials.recording.signals import LowPass
from underfoot.trials.recording.trial import Marker
from underfoot.trials.walking.slips import (
    OutcomeLimits,
    SlipDefinition,
    contact_from_heel,
    heel_motion,
    slip,
)

UP = np.array([0.0, 0.0, 1.0])
RATE = 200.0


def heel(seed: int) -> tuple[Marker, float]:
    """Return the marker of a heel that comes down, slides by some humps and lifts; its contact."""
    rng = np.random.default_rng(seed)
    time = np.arange(round(1.6 * RATE)) / RATE
    contact = 0.5 + 0.1 * rng.random()
    speed = 1.5 / (1 + np.exp((time - contact + 0.03) / rng.choice([0.012, 0.03])))
    for _ in range(int(rng.integers(1, 4))):
        at, size, wide = contact + 0.05 + 0.5 * rng.random(), rng.choice([0.05, 0.21, 0.6]), 0.05
        speed += size * np.exp(-(((time - at) / wide / (0.5 + rng.random())) ** 2))
    lift = contact + rng.choice([0.3, 0.55, 0.9])
    turn = rng.choice([0.0, 0.3, 1.2, 3.0])
    way = np.cumsum(speed) / RATE
    down = 0.08 * np.clip((contact - time) / 0.1, 0, 1)
    height = 0.03 + down + 0.25 * np.clip(time - lift, 0, 1)
    path = np.column_stack([way * np.cos(turn), way * np.sin(turn), height])
    path += rng.choice([2e-5, 4e-4]) * rng.normal(size=path.shape)
    first = round(contact * RATE)
    kind = seed % 6
    if kind == 1:
        path[first + 30 : first + 30 + int(rng.integers(2, 30))] = np.nan
    elif kind == 2:
        path[first + int(rng.integers(2, 40))] += 0.05
    elif kind == 3:
        path[first + int(rng.integers(5, 60)) :] = np.nan
    elif kind == 4:
        path[first + 25 : first + 28] = 0.0
    return Marker(path, RATE, note="as seen" if seed % 2 else ""), float(contact)


DEFINITIONS = (
    SlipDefinition(), SlipDefinition(plane="3d", threshold=0.1),
    SlipDefinition(derivative="savitzky-golay"), SlipDefinition(filter=LowPass(cutoff=20.0)),
    SlipDefinition(prominence=0.1, heel_lift=0.01, longest_gap=0.02),
)  # fmt: skip


@pytest.mark.parametrize("first", [0, 10])
def test_slips_of_heels(file_regression, first):
    told = {}
    for seed in range(first, first + 10):
        marker, contact = heel(seed)
        for k in {0, 1 + seed % 4}:
            one = slip(
                marker, contact, up=UP, walking=np.array([1.0, 0.0, 0.0]) if seed % 3 else None,
                leaves=contact + 0.45 if seed % 4 == 2 else None, definition=DEFINITIONS[k],
                limits=OutcomeLimits(0.02, 0.05, 0.15) if seed % 5 == 0 else None,
            )  # fmt: skip
            four = (one.start, one.peak_speed, one.distance, one.margin)
            told[f"{seed} {k}"] = {
                "is": f"{one.slipped} {one.outcome} {one.way} {one.slides} {one.start.reason}",
                "numbers": np.array([one.end, one.peak_time, *(m.value for m in four),
                                     *(m.uncertainty for m in four)], dtype=float),
                "flags": [f"{f.name}: {f} {f.measured} {f.limit}" for f in one.start.flags],
                "ends": one.start.conventions.get("search ends", ""),
            }  # fmt: skip
        motion = heel_motion(marker, UP, DEFINITIONS[seed % 5])
        told[f"{seed}"] = {
            "landings": np.array(contact_from_heel(marker, UP)),
            "noise": (motion.noise, motion.speed_noise, motion.acceleration_noise),
            "taken": (int(motion.filled.sum()), int(motion.jumps.sum())),
            "speed": motion.speed,
        }
    held(file_regression, told, f"heels from {first}")
