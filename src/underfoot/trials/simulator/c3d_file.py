"""A made-up walk as a C3D file."""

from collections.abc import Sequence

import numpy as np

from ..readers.c3d_writer import c3d_bytes
from .walk import MARKER_RATE, RATE, WalkRecording

NOTICE = (
    "SYNTHETIC DATA. Nothing in this folder was measured: every file was computed by "
    "'underfoot trials simulate' from the values in truth.csv, for trying out and testing the "
    "analysis. Do not publish, mix with measurements, or take as a reference.\n"
)


def walk_c3d(
    recording: WalkRecording,
    *,
    origin: float = -0.04,
    order: Sequence[int] = (0, 1, 2, 3),
    mass: float = 0.0,
) -> bytes:
    """Return a recording as a C3D file with two type-2 plates and the pressures in kPa.

    The origin of the plates lies ``origin`` (m) along their z, their corners stand in ``order``;
    ``mass`` (kg) of the person is left out at zero.
    """
    analog: dict[str, tuple[np.ndarray, str]] = {}
    plates = []
    below = np.array([0.0, 0.0, origin])
    axes = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
    for number, (force, centre, corners) in enumerate(
        zip(recording.force, recording.centre, recording.corners, strict=True), start=1
    ):
        in_plate = force @ axes.T
        moment = np.cross((centre - corners.mean(axis=0)) @ axes.T + below, in_plate)
        names = [f"{letter}{number}" for letter in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")]
        for i in range(3):
            analog[names[i]] = (in_plate[:, i], "N")
            analog[names[3 + i]] = (1e3 * moment[:, i], "Nmm")
        plates.append((corners[list(order)], below, names))
    for name, values in recording.pressures.items():
        analog[name] = (1e-3 * values, "kPa")
    return c3d_bytes(recording.markers, MARKER_RATE, analog, RATE, plates, mass=mass)
