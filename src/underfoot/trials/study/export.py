"""A trial as C3D with the contacts found, or as TRC and MOT, for other software."""

from collections.abc import Iterable, Sequence

import numpy as np

from underfoot.core import DataError

from ..readers.c3d_writer import c3d_bytes
from ..recording.plates import plate_axes
from ..recording.trial import Plate, Trial
from ..walking.body_weight import body_mass
from ..walking.events import Stance


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
        force, moment = (
            _sample_plate(plate, v, samples) @ axes for v in (plate.force, _moment(plate))
        )
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


def trc_text(trial: Trial) -> str:
    """Return the markers as a TRC file of OpenSim: mm, y up, cells of unseen ones empty.

    DataError: no markers of one rate.
    """
    markers = [(name, m) for name, m in trial.markers.items() if m.times is None]
    if not markers:
        raise DataError("no markers to export", where=trial.name)
    first = markers[0][1]
    same = [(name, m) for name, m in markers
            if len(m.positions) == len(first.positions) and m.rate == first.rate]  # fmt: skip
    turn, count = _upright(trial), len(first.positions)
    keys = ("DataRate CameraRate NumFrames NumMarkers Units OrigDataRate OrigDataStartFrame "
            "OrigNumFrames").split()  # fmt: skip
    values = [first.rate, first.rate, count, len(same), "mm", first.rate, 1, count]
    lines = ["PathFileType\t4\t(X/Y/Z)\ttrial.trc", "\t".join(keys), _row(values)]
    lines += ["Frame#\tTime\t" + "\t\t\t".join(name for name, _ in same) + "\t\t"]
    lines += ["\t\t" + "\t".join(f"{a}{n}" for n in range(1, len(same) + 1) for a in "XYZ"), ""]
    paths = np.hstack([1e3 * m.positions @ turn.T for _, m in same])
    for n, (time, places) in enumerate(zip(first.time, paths, strict=True), start=1):
        lines.append(_row([n, time, *(value if np.isfinite(value) else "" for value in places)]))
    return "\n".join(lines) + "\n"


def mot_text(trial: Trial) -> str:
    """Return the plates as a MOT file of OpenSim: force on the foot (N), its place (m), free moment
    (N m), y up.

    DataError: no usable plates, or plates of several rates.
    """
    plates = [plate for plate in trial.plates if plate.usable]
    if not plates:
        raise DataError("no force plates to export", where=trial.name)
    if len({(plate.rate, plate.start, len(plate.force)) for plate in plates}) > 1:
        raise DataError("plates of several clocks", where=trial.name,
                        remedy="Export them as C3D")  # fmt: skip
    turn = _upright(trial)
    labels, parts = ["time"], [plates[0].time[:, None]]
    for n, plate in enumerate(plates):
        before = f"{n}_" if n else ""
        place = plate.centre_of_pressure
        known = np.zeros_like(plate.force) if place is None else np.nan_to_num(place)
        for kind, values in (("force_v", np.nan_to_num(plate.force)), ("force_p", known)):
            labels += [f"{before}ground_{kind}{axis}" for axis in "xyz"]
            parts.append(values @ turn.T)
        labels += [f"{before}ground_torque_{axis}" for axis in "xyz"]
        parts.append(_free_moment(plate) @ turn.T)
    table = np.hstack(parts)
    head = ["forces", "version=1", f"nRows={len(table)}", f"nColumns={len(labels)}"]
    lines = [*head, "inDegrees=yes", "endheader", "\t".join(labels)]
    return "\n".join([*lines, *(_row(row) for row in table)]) + "\n"


def _upright(trial: Trial) -> np.ndarray:
    """Return the rotation (3, 3) that turns the vertical of a trial to y, by the shortest way."""
    up = np.array((0.0, 0.0, 1.0) if trial.vertical is None else trial.vertical.axis)
    y = np.array([0.0, 1.0, 0.0])
    axis, cosine = np.cross(up, y), float(up @ y)
    if cosine < -1.0 + 1e-9:
        return np.diag([1.0, -1.0, -1.0])
    x, y_, z = axis
    cross = np.array([[0.0, -z, y_], [z, 0.0, -x], [-y_, x, 0.0]])
    return np.eye(3) + cross + cross @ cross / (1.0 + cosine)


def _row(values: Iterable[object]) -> str:
    return "\t".join(f"{value:.7g}" if isinstance(value, float) else str(value) for value in values)


def _free_moment(plate: Plate) -> np.ndarray:
    """Moment (n, 3) that is left at the centre of pressure; zero where it is not known."""
    if plate.moment is None or plate.centre_of_pressure is None or plate.corners is None:
        return np.zeros_like(plate.force)
    lever = plate.centre_of_pressure - plate.corners.mean(axis=0)
    return np.nan_to_num(plate.moment - np.cross(lever, plate.force))


def _moment(plate: Plate) -> np.ndarray:
    """Moment (n, 3) about the centre of the surface, from the centre of pressure if need be."""
    if plate.moment is not None:
        return plate.moment
    if plate.centre_of_pressure is None or plate.corners is None:
        return np.zeros_like(plate.force)
    lever = np.nan_to_num(plate.centre_of_pressure - plate.corners.mean(axis=0))
    return np.cross(lever, plate.force)


def _sample_plate(plate: Plate, values: np.ndarray, samples: np.ndarray) -> np.ndarray:
    filled = np.nan_to_num(values)
    return np.column_stack([np.interp(samples, plate.time, filled[:, i]) for i in range(3)])
