"""Made-up pin-on-disk runs and relaxation tests."""

from __future__ import annotations

import numpy as np


def disk_run(
    cof: float, speed: float, rng: np.random.Generator, *, load: float = 20.9
) -> dict[str, np.ndarray]:
    """Return ten seconds of a pin-on-disk run at 100 Hz: run-in, then correlated scatter."""
    time = np.arange(1000) / 100.0
    white = rng.normal(0, 0.012, len(time))
    scatter = np.zeros(len(time))
    for i in range(1, len(time)):
        scatter[i] = 0.6 * scatter[i - 1] + 0.8 * white[i]
    ratio = cof * (1 + 0.35 * np.exp(-time / 0.4)) + scatter
    normal = load + rng.normal(0, 0.1, len(time))
    return {
        "time (s)": time,
        "normal force (N)": normal,
        "friction force (N)": ratio * normal,
        "sliding speed (m/s)": np.full(len(time), speed),
    }


def relaxation(
    rng: np.random.Generator,
    *,
    thickness: float = 5.5e-3,
    peak: float = 800.0,
    share: float = 0.35,
    rate: float = 0.025,
) -> dict[str, np.ndarray]:
    """Return a ramp, a hold of 240 s and the unloading of a rubber pair, compression positive.

    F(t) = peak ((1 - share) + share exp(-rate t)) from the end of the ramp; 0.2 thickness is
    taken up in one second.
    """
    time = np.arange(0, 246.0, 0.02)
    travel = np.clip(time - 2.0, 0, 1) * 0.2 * thickness
    travel = np.where(time > 243.0, np.clip(244.0 - time, 0, 1) * 0.2 * thickness, travel)
    relaxed = np.where(time > 3.0, 1 - share + share * np.exp(-rate * (time - 3.0)), 1.0)
    force = peak * travel / (0.2 * thickness) * relaxed
    return {
        "time (s)": time,
        "displacement (mm)": 1e3 * travel + rng.normal(0, 2e-4, len(time)),
        "force (N)": force + rng.normal(0, 0.3, len(time)),
    }
