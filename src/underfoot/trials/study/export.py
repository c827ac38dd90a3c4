"""A trial as C3D with the contacts found, for other software."""

from collections.abc import Sequence

import numpy as np

from underfoot.core import DataError

from ..readers.c3d_writer import c3d_bytes
from ..recording.plates import plate_axes
from ..recording.trial import Plate, Trial
from ..walking.events import Stance
from ..walking.walkway import body_mass


def c3d_with_events(trial: Trial, stances: Sequence[Stance]) -> bytes:
    """Return a C3D file of markers, force plates (type 2, baseline subtracted) and events.

    Events are "Foot Strike" and "Foot Off" of the accepted contacts, with the side as context.
    Forces are brought to a multiple of the marker rate by linear interpolation where they are
    not; plates without corners are written as channels. Other channels are left out.

    DataError: neither markers nor usable plates.
    """
    plates = [plate for plate in trial.plates if plate.usable]
    markers = [(name, m) for name, m in trial.markers.items() if m.times is None]
    if not plates and not markers:
        raise DataError("neither markers nor force plates to export", where=trial.name)
    if markers:
        rate, start = markers[0][1].rate, markers[0][1].start
        frames = len(markers[0][1].positions)
    else:
        rate, start = plates[0].rate / 10.0, plates[0].start
        frames = len(plates[0].force) // 10
    per_frame = max(1, round(max((p.rate for p in plates), default=rate) / rate))
    samples = start + np.arange(frames * per_frame) / (rate * per_frame)
    analog: dict[str, tuple[np.ndarray, str]] = {}
    described: list[tuple[np.ndarray, np.ndarray, list[str]]] = []
    for number, plate in enumerate(plates, start=1):
        corners = plate.corners
        axes = np.eye(3) if corners is None else plate_axes(corners)
        force, moment = (_sampled(plate, v, samples) @ axes for v in (plate.force, _moment(plate)))
        names = [f"{letter}{number}" for letter in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")]
        for i in range(3):
            analog[names[i]] = (force[:, i], "N")
            analog[names[3 + i]] = (1e3 * moment[:, i], "Nmm")
        if corners is not None:
            described.append((corners, np.zeros(3), names))
    events = [
        (label, stance.side.capitalize() if stance.side != "unknown" else "General", time - start)
        for stance in stances
        if stance.accepted
        for label, time in (("Foot Strike", stance.contact), ("Foot Off", stance.toe_off))
    ]
    first = max(1, round(start * rate) + 1)
    return c3d_bytes(
        {
            name: marker.positions
            for name, marker in markers
            if len(marker.positions) == frames and marker.rate == rate
        },
        rate,
        analog,
        rate * per_frame,
        described,
        events=[(label, side, time + (first - 1) / rate) for label, side, time in events],
        mass=body_mass(trial) or 0.0,
        software="underfoot trials export",
        description="",
        first_frame=first,
        frames=frames,
    )


def _moment(plate: Plate) -> np.ndarray:
    """Moment (n, 3) about the centre of the surface, from the centre of pressure if need be."""
    if plate.moment is not None:
        return plate.moment
    if plate.centre_of_pressure is None or plate.corners is None:
        return np.zeros_like(plate.force)
    lever = np.nan_to_num(plate.centre_of_pressure - plate.corners.mean(axis=0))
    return np.cross(lever, plate.force)


def _sampled(plate: Plate, values: np.ndarray, samples: np.ndarray) -> np.ndarray:
    filled = np.nan_to_num(values)
    return np.column_stack([np.interp(samples, plate.time, filled[:, i]) for i in range(3)])
