"""Force plates: from analog channels (C3D types 1-4) to the force on the foot in lab axes."""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core import DataError
from underfoot.core.remark import Message

from .measurement import Flag, remark
from .signals import (
    CONTACT_FORCE,
    SHEAR_WARNING,
    along,
    contacts,
    enough,
    is_saturated,
    unloaded_samples,
)
from .trial import REVERSED, Plate, Trial, once_a_record

KINDS = {
    1: "type 1 (force, centre of pressure, free moment)",
    2: "type 2 (force and moment)",
    3: "type 3 (eight Kistler channels)",
    4: "type 4 (force and moment through a calibration matrix)",
}
CHANNELS = {1: 6, 2: 6, 3: 8, 4: 6}
_PART = 1_000_000  # samples worked on at once
_LOADED = 20.0  # N, below it a centre of pressure has no meaning
_IMPLAUSIBLE = 10_000.0  # N, far above any step or slip test
_STANDING = 200.0  # N, a median beyond it means the plate is loaded most of the time


def plate_axes(corners: np.ndarray) -> np.ndarray:
    """Return the plate's axes as columns in lab axes, shape (3, 3), from its corners (4, 3).

    Corner 1 lies at +x +y of the plate, 2 at -x +y, 3 at -x -y, 4 at +x -y (c3d.org); x is kept,
    y made normal to it, z = x cross y (down into the floor in a plate wired as the format says).
    Corners that are missing or without area are a DataError.
    """
    if corners.shape != (4, 3) or not np.isfinite(corners).all():
        raise DataError("the plate's corners are missing")
    x = corners[0] - corners[1] + corners[3] - corners[2]
    y = corners[0] - corners[3] + corners[1] - corners[2]
    z = _cross(x, y)
    lengths = [math.sqrt(float(v @ v)) for v in (x, y, z)]  # numpy's norm takes longer for one
    if min(lengths[:2]) < 0.02 or lengths[2] < 0.1 * lengths[0] * lengths[1]:
        raise DataError("the plate's corners enclose no area")
    x, z = x / lengths[0], z / lengths[2]
    return np.column_stack((x, _cross(z, x), z))


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Cross product of two vectors (3,); numpy's takes ten times as long for one."""
    return a[[1, 2, 0]] * b[[2, 0, 1]] - a[[2, 0, 1]] * b[[1, 2, 0]]


def _crossing(a: np.ndarray) -> np.ndarray:
    """Matrix (3, 3) that makes of a vector its cross product with ``a`` (3,) before it."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def ordered_corners(corners: np.ndarray, *, down: bool = True) -> tuple[np.ndarray, bool]:
    """Return the corners (4, 3) in the format's order, and True when they had to be re-ordered.

    Some systems write them crossed (1, 2, 4, 3). Corner 1 keeps its place, the one farthest from
    it becomes corner 3, and of the other two that one becomes corner 2 which makes the plate's z
    axis point into the floor (``down``), or out of it where the file's other plates do so.
    """
    if corners.shape != (4, 3) or not np.isfinite(corners).all():
        return corners, False
    opposite = int(np.argmax(np.linalg.norm(corners - corners[0], axis=1)))
    if opposite in (0, 2):
        return corners, False
    others = [i for i in (1, 2, 3) if i != opposite]
    for second, fourth in (others, others[::-1]):
        order = corners[[0, second, opposite, fourth]]
        try:
            z = plate_axes(order)[:, 2]
        except DataError:
            continue
        if (z[int(np.argmax(np.abs(z)))] < 0) == down:
            return order, True
    return corners, False


@dataclass(frozen=True, slots=True, eq=False)
class Contact:
    """A stretch in which a plate is stood on: samples ``start`` to ``stop``, this one excluded.

    ``up`` (3,) is the unit vector out of the floor, ``peak`` the largest force along it (N).
    """

    plate: Plate
    start: int
    stop: int
    up: np.ndarray
    peak: float = math.nan

    @property
    def pressure_path(self) -> np.ndarray:
        """Way (3,) of the centre of pressure from the first to the last fifth (m)."""
        if self.plate.centre_of_pressure is None:
            return np.zeros(3)
        place = self.plate.centre_of_pressure[self.start : self.stop]
        place = place[np.isfinite(place).all(axis=1)]
        fifth = len(place) // 5
        if fifth < 3:
            return np.zeros(3)
        step = place[-fifth:].mean(axis=0) - place[:fifth].mean(axis=0)
        return step - (step @ self.up) * self.up

    @property
    def shear_swing(self) -> np.ndarray:
        """Mean shear (3,) of the second half less that of the first (N)."""
        force = self.plate.force[self.start : self.stop]
        force = force[np.isfinite(force).all(axis=1)]
        half = len(force) // 2
        if half < 3:
            return np.zeros(3)
        swing = force[half:].mean(axis=0) - force[:half].mean(axis=0)
        return swing - (swing @ self.up) * self.up


def plate_contacts(
    plate: Plate, up: np.ndarray, threshold: float = CONTACT_FORCE
) -> tuple[Contact, ...]:
    """Return the ``contacts`` with a plate; ``up`` (3,) is the unit vector out of the floor."""
    return tuple(
        Contact(plate, start, stop, up, peak)
        for start, stop, peak in _contacts(plate, tuple(up.tolist()), threshold)
    )


@once_a_record
def _contacts(
    plate: Plate, up: tuple[float, ...], threshold: float
) -> tuple[tuple[int, int, float], ...]:
    vertical = along(plate.force, np.array(up))
    return tuple(
        (start, stop, float(np.nanmax(vertical[start:stop])))
        for start, stop in contacts(vertical, plate.rate, threshold)
    )


def channel_forces(
    kind: int, signals: np.ndarray, origin: np.ndarray, calibration: np.ndarray | None
) -> tuple[np.ndarray, np.ndarray]:
    """Return force and moment about the surface's centre, plate axes, both (n, 3) in N and N m.

    ``kind`` is the C3D plate type, 1 to 4; ``signals`` (n, 6) or (n, 8) are SI (type 4: raw, the
    ``calibration`` matrix (6, 6) makes them SI). ``origin`` (3,), m, is FORCE_PLATFORM:ORIGIN: from
    the transducers' origin to the surface's centre (types 2, 4); half spacings a, b and depth of
    the sensors (type 3). A DataError where type or number of channels is not supported.

    Source: c3d.org, the FORCE_PLATFORM group.
    """
    if kind not in CHANNELS:
        raise DataError(
            Message("plate type {kind} is not supported", kind=kind), allowed="types 1 to 4"
        )
    if signals.shape[1] != CHANNELS[kind]:
        words = Message(
            "type {kind} needs {channels} channels, the file names {shape}",
            kind=kind,
            channels=CHANNELS[kind],
            shape=signals.shape[1],
        )
        raise DataError(words)
    if kind == 1:
        force = signals[:, :3]
        x, y, free = signals[:, 3], signals[:, 4], signals[:, 5]
        fx, fy, fz = force.T
        return force, np.column_stack((y * fz, -x * fz, x * fy - y * fx + free))
    if kind == 3:
        fx12, fx34, fy14, fy23, fz1, fz2, fz3, fz4 = signals.T
        a, b = float(origin[0]), float(origin[1])
        force = np.column_stack((fx12 + fx34, fy14 + fy23, fz1 + fz2 + fz3 + fz4))
        across, along = b * (fz1 + fz2 - fz3 - fz4), a * (-fz1 + fz2 + fz3 - fz4)
        moment = np.column_stack((across, along, b * (-fx12 + fx34) + a * (fy14 - fy23)))
        to_surface = np.array([0.0, 0.0, origin[2]])
    else:
        if kind == 4:
            if calibration is None or calibration.shape != (6, 6):
                raise DataError("type 4 needs a 6 x 6 calibration matrix")
            signals = signals @ calibration.T
        force, moment = signals[:, :3], signals[:, 3:]
        to_surface = np.asarray(origin, dtype=float)
    if to_surface[2] > 0:  # z points down and the transducers lie below the surface
        to_surface = -to_surface
    return force, moment - force @ _crossing(to_surface).T


def finished_plate(
    name: str,
    force: np.ndarray,
    *,
    rate: float,
    start: float = 0.0,
    up: np.ndarray,
    moment: np.ndarray | None = None,
    centre_of_pressure: np.ndarray | None = None,
    corners: np.ndarray | None = None,
    raw: np.ndarray | None = None,
    kind: str = "",
    notes: tuple[str, ...] = (),
    flags: tuple[Flag, ...] = (),
    subtract_baseline: bool = True,
    in_place: bool = False,
) -> Plate:
    """Return the plate with sign checked, baseline subtracted and centre of pressure worked out.

    ``force``, ``moment`` (about the centre of the surface) and ``centre_of_pressure`` have shape
    (n, 3), lab axes; ``up`` (3,) is the unit vector out of the floor; ``raw`` (n, k), the channels
    before any arithmetic, are searched for saturation. With ``in_place`` force and moment, those of
    a long record, are written to and keep their precision.
    """
    force = force if in_place else np.array(force, dtype=float)
    seen = list(flags)
    lost = ~np.isfinite(along(force, np.ones(3)))  # faster than all()
    if lost.any():
        seen.append(
            Flag(
                "missing samples",
                Message("{count} samples without a number", count=int(lost.sum())),
            )
        )
    vertical = along(force, up)
    with_load = vertical[~lost] if lost.any() else vertical
    if with_load.size and _upside_down(with_load):
        force, vertical = -force, -vertical
        moment = None if moment is None else -moment
        words = Message("signs reversed: the file holds the force on the plate")
        seen.append(Flag(REVERSED, words, matters=False))
    baseline, samples = None, 0
    empty = unloaded_samples(vertical, rate)
    if not subtract_baseline:
        seen.append(remark("baseline not subtracted: switched off"))
    elif enough(empty):
        rows = empty[:, None]
        baseline, samples = force.mean(axis=0, dtype=float, where=rows), int(empty.sum())
        force -= baseline.astype(force.dtype)
        if moment is not None:
            middle = moment.mean(axis=0, dtype=float, where=rows)
            less = middle.astype(moment.dtype)
            moment = np.subtract(moment, less, out=moment if in_place else None)
        across = float(np.linalg.norm(baseline - (baseline @ up) * up))
        if across > SHEAR_WARNING:
            seen.append(remark("shear baseline of {across:.1f} N was subtracted", across=across))
    else:
        text = Message("baseline not subtracted: the plate is never unloaded for long enough")
        seen.append(Flag("baseline", text))
    del with_load
    channels = (force if raw is None else raw).T  # one after the other is held once more
    cut = any(is_saturated(np.ascontiguousarray(channel), rate) for channel in channels)
    if cut:
        seen.append(Flag("saturated", Message("saturated: a channel stays at its extreme value")))
    peak = float(np.nanmax(np.abs(along(force, up)), initial=0.0))
    if peak > _IMPLAUSIBLE:
        text = Message(
            "peak vertical force {peak:.0f} N is implausible: is the unit right?", peak=peak
        )
        seen.append(Flag("size", text, True, peak, _IMPLAUSIBLE, "N"))
    elif 0.05 < peak < _LOADED:
        text = Message("never loaded beyond {peak:.1f} N: unused, or is the unit right?", peak=peak)
        seen.append(Flag("size", text, True, peak, _LOADED, "N"))
    elif peak <= 0.05:
        seen.append(remark("never loaded"))
    if centre_of_pressure is not None:
        loaded = along(force, up) > _LOADED
        centre_of_pressure = np.where(loaded[:, None], centre_of_pressure, np.nan)
    elif moment is not None and corners is not None:
        centre_of_pressure = _centre_of_pressure(force, moment, up, corners.mean(axis=0))
    return Plate(
        name, force, rate, start, moment, centre_of_pressure, corners, baseline, samples, kind,
        notes=notes, saturated=cut, flags=tuple(seen),
    )  # fmt: skip


def refused_plate(name: str, problem: str, *, rate: float = 0.0, kind: str = "") -> Plate:
    """Return a plate that can't be used, with the reason."""
    return Plate(name, np.empty((0, 3)), rate, kind=kind, problem=problem)


def plate_named(trial: Trial, name: str) -> Plate:
    """Return the plate called ``name``; a DataError where there is none."""
    for plate in trial.plates:
        if plate.name == name:
            return plate
    raise DataError(
        Message("no plate named {name}", name=name),
        where=trial.name,
        allowed=", ".join(p.name for p in trial.plates) or "the trial has no plates",
    )


def plate_normal(corners: np.ndarray | None) -> np.ndarray | None:
    """Return a unit vector (3,) normal to a plate's surface; None without corners that have one."""
    if corners is None:
        return None
    try:
        return plate_axes(corners)[:, 2]
    except DataError:
        return None


def plate_up(corners: np.ndarray | None, up: np.ndarray) -> np.ndarray:
    """Return the normal (3,) out of a plate's surface, on the side that is up in the laboratory.

    Without corners, and where they stand across the vertical that a person gave, it is ``up``.
    """
    normal = plate_normal(corners)
    height = 0.0 if normal is None else float(normal @ up)
    return up if normal is None or abs(height) < 0.5 else normal * np.sign(height)


def _upside_down(vertical: np.ndarray) -> bool:
    low, centre, high = np.percentile(vertical, (0.5, 50.0, 99.5)).tolist()
    above, below = high - centre, centre - low
    if max(above, below) < _LOADED:
        return False
    # A plate loaded most of the time has its median in the load.
    return centre < -_STANDING if abs(centre) > _STANDING else below > above


def _centre_of_pressure(
    force: np.ndarray, moment: np.ndarray, up: np.ndarray, centre: np.ndarray
) -> np.ndarray:
    """r = up x M / (up . F), from M = r x F + T up with r in the surface."""
    vertical = along(force, up)
    place = np.full(force.shape, np.nan, moment.dtype)
    crossing = _crossing(up).T
    for part in (slice(at, at + _PART) for at in range(0, len(force), _PART)):
        loaded = vertical[part] > _LOADED
        over = vertical[part][loaded, None]
        place[part][loaded] = moment[part][loaded] @ crossing / over + centre
    return place
