"""Which way is up and forward, the slope of the walkway: overridable."""

import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from underfoot.core import InputError, to_si, unknown_name
from underfoot.core.deprecation import renamed_member
from underfoot.core.remark import NOTHING, Message

from .marker_names import heel_candidates, toe_candidates
from .plates import Contact, plate_normal
from .signals import CONTACT_FORCE, frames_between
from .trial import Marker, Trial, Vertical, once_a_record

PLATE_FRAMES = {
    "surface": Message("plates that measure normal and tangential to the walking surface"),
    "horizontal": Message("plates that measure in horizontal and vertical axes"),
}
_STEEPEST = math.radians(30.0)


@dataclass(frozen=True, slots=True)
class Ramp:
    """Slope of a walkway along the walk.

    ``angle``: against the horizontal (rad), positive where the walk goes up, negative where it goes
    down; 0 is a level walkway. ``plate_frame``: a key of ``PLATE_FRAMES``; it has a meaning on a
    slope only.

    InputError: an angle beyond 30 degrees, an unknown frame, a slope without a frame.
    """

    angle: float = 0.0
    plate_frame: str = ""

    def __post_init__(self) -> None:
        if not abs(self.angle) <= _STEEPEST:
            allowed = 'from "-30 deg" (walking down) to "30 deg" (walking up)'
            words = Message("a ramp of {degrees:.4g} deg", degrees=math.degrees(self.angle))
            raise InputError(words, where="ramp", allowed=allowed)
        if self.plate_frame and self.plate_frame not in PLATE_FRAMES:
            raise unknown_name("plate frame", self.plate_frame, PLATE_FRAMES, where="plate_frame")
        if self.angle and not self.plate_frame:
            raise InputError(
                "the axes of the force plates on the ramp are not given",
                where="plate_frame",
                allowed="; ".join(f'"{key}": {words}' for key, words in PLATE_FRAMES.items()),
            )

    def surface(self, up: np.ndarray, walking: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return normal and forward tangent of the walking surface in the plate's axes, (3,)."""
        return _turn_axes(up, walking, self.angle if self.plate_frame == "horizontal" else 0.0)

    def gravity(self, up: np.ndarray, walking: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return vertical and forward horizontal in the plate's axes, both (3,)."""
        return _turn_axes(up, walking, -self.angle if self.plate_frame == "surface" else 0.0)

    @property
    def name(self) -> Message:
        """What is walked on: "level" or "ramp of 5 deg"."""
        if not self.angle:
            return Message("level")
        return Message("ramp of {angle:.4g} deg", angle=abs(math.degrees(self.angle)))

    @property
    def description(self) -> Message:
        """The surface in words, as "ramp of 5 deg, walking up; plates that measure ..."."""
        if not self.angle:
            return self.name
        values = {"ramp": self.name, "plates": PLATE_FRAMES[self.plate_frame]}
        if self.angle > 0:
            return Message("{ramp}, walking up; {plates}", **values)
        return Message("{ramp}, walking down; {plates}", **values)

    words = property(renamed_member("words", "description", gone="0.4"))


LEVEL = Ramp()


def ramp_from(angle: object, plate_frame: str = "", *, where: str = "ramp") -> Ramp:
    """Return the ramp of an angle with its unit, as "5 deg" (up) or "-5 deg" (down).

    InputError: no angle, no unit, or what ``Ramp`` refuses.
    """
    return Ramp(to_si(angle, "rad", where=where), plate_frame)


def _turn_axes(up: np.ndarray, walking: np.ndarray, angle: float) -> tuple[np.ndarray, np.ndarray]:
    cos, sin = math.cos(angle), math.sin(angle)
    return cos * up - sin * walking, cos * walking + sin * up


_FIXED = 0.01  # m; any part of a body that walks goes further
_GOES = 0.3  # m; some part of it goes as far
_ABOVE = 0.2  # m between the feet and the middle of a body's other markers
WALKING_SPEED = 0.3  # m/s; slower than that nobody walks
_ALONG = 0.7  # cosine of the angle between the way of a foot's pressure and that of the walk
_NAMES = "xyz"


class DirectionSource(StrEnum):
    """What told the walking direction of a step."""

    GIVEN = "given"
    MARKERS = "markers"
    PRESSURE = "centre of pressure"
    TREADMILL = "treadmill"
    SHEAR = "shear alone"
    NONE = "unknown"


@dataclass(frozen=True, slots=True)
class Direction:
    """Walking direction of a step: unit vector (3,) or None, its source, and a line about it."""

    vector: np.ndarray | None = None
    source: DirectionSource = DirectionSource.NONE
    explanation: Message = NOTHING


@dataclass(frozen=True, slots=True)
class Axes:
    """Directions in laboratory axes and how each was found.

    ``up`` and ``walking`` are unit vectors (3,); ``walking`` is None when nothing tells it.
    ``ramp`` is the slope of the walkway, ``body`` the velocity (3,) of the markers over the whole
    recording in the floor's plane (m/s), None without markers.
    """

    up: np.ndarray
    up_from: str
    walking: np.ndarray | None
    walking_from: str
    ramp: Ramp = LEVEL
    body: np.ndarray | None = None

    @property
    def across(self) -> np.ndarray | None:
        """Unit vector to the left of the walker, up x walking."""
        return None if self.walking is None else np.cross(self.up, self.walking)


def axis_vector(text: str, where: str = "axis") -> np.ndarray:
    """Return the unit vector named ``"x"``, ``"+y"``, ``"-z"`` ..."""
    if not re.fullmatch("[+-]?[xyz]", text):
        raise InputError(
            Message('"{axis}" is no axis', axis=text), where=where, allowed="x, y, z, +x, -x ..."
        )
    return np.eye(3)[_NAMES.index(text[-1])] * (-1.0 if text[0] == "-" else 1.0)


def axis_name(vector: np.ndarray | None) -> str:
    """Return ``"+x"`` ... for a vector within 1 degree of an axis, else its components."""
    if vector is None:
        return "unknown"
    largest = int(np.argmax(np.abs(vector)))
    if abs(vector[largest]) > 0.9998:
        return ("-" if vector[largest] < 0 else "+") + _NAMES[largest]
    return "(" + ", ".join(f"{component:.2f}" for component in vector) + ")"


def axes_of(
    trial: Trial, *, vertical: str | None = None, walking: str | None = None, ramp: Ramp = LEVEL
) -> Axes:
    """Return the axes of a trial: from overrides, plates, then markers.

    Vertical: the one that the plates were read with (``found_vertical``). Walking: the path of the
    markers over the whole recording. For one step use ``walking_direction``, which looks at it.
    """
    found = None if vertical else trial.vertical
    found = found or found_vertical(
        vertical,
        corners=[p.corners for p in trial.plates if p.usable and p.corners is not None],
        forces=[p.force for p in trial.plates if p.usable],
        markers=trial.markers,
    )
    up, how = np.array(found.axis), found.source
    path = marker_velocity(trial, -np.inf, np.inf, up)
    if walking:
        return Axes(up, how, _flat(axis_vector(walking, "walking"), up), "given", ramp, path)
    speed = 0.0 if path is None else float(np.linalg.norm(path))
    if path is not None and speed > WALKING_SPEED:
        return Axes(
            up,
            how,
            path / speed,
            Message("path of the markers ({speed:.2f} m/s)", speed=speed),
            ramp,
            path,
        )
    reason = (
        "no markers"
        if path is None
        else Message("markers move at {speed:.2f} m/s only", speed=speed)
    )
    return Axes(up, how, None, Message("not found: {reason}", reason=reason), ramp, path)


def marker_velocity(
    trial: Trial, begin: float, end: float, up: np.ndarray | None
) -> np.ndarray | None:
    """Return the velocity (3,) of the middle of the markers between two times (m/s).

    In the plane of the floor; with its vertical part when ``up`` is None.

    The median over the markers of their mean velocities, so that a swinging limb or a few lost
    markers don't count. Markers that never move (corners of plates, the frame of a treadmill) are
    no part of a body that does. None with fewer than three markers seen.
    """
    whole = begin == -np.inf and end == np.inf
    velocities = [
        velocity
        for marker in moving_markers(trial.markers).values()
        for velocity in [_whole_velocity(marker) if whole else _velocity_in(marker, begin, end)]
        if velocity is not None
    ]
    if len(velocities) < 3:
        return None
    ordered = np.sort(velocities, axis=0)  # np.median takes several times as long for so few
    middle = (ordered[(len(velocities) - 1) // 2] + ordered[len(velocities) // 2]) / 2.0
    return middle if up is None else middle - (middle @ up) * up


@once_a_record
def _whole_velocity(marker: Marker) -> np.ndarray | None:
    return _velocity_in(marker, -np.inf, np.inf)


def _velocity_in(marker: Marker, begin: float, end: float) -> np.ndarray | None:
    frames = frames_between(marker.time, begin, end)
    seen = np.flatnonzero(~marker.missing[frames])
    if len(seen) < 3:
        return None
    time, path, first, last = marker.time[frames], marker.positions[frames], seen[0], seen[-1]
    lasting = time[last] - time[first]
    return (path[last].astype(float) - path[first]) / lasting if lasting >= 0.05 else None


def moving_markers(markers: Mapping[str, Marker]) -> Mapping[str, Marker]:
    """Return the markers of a body that moves: those that never leave their place are left out.

    Where nothing moves as far as somebody who walks, all may be of a body.
    """
    spans = [_span(marker) for marker in markers.values()]
    return markers if max(spans, default=0.0) < _GOES else body_markers(markers)


def body_markers(markers: Mapping[str, Marker]) -> Mapping[str, Marker]:
    """Return the markers that leave their place: corners of plates and frames don't."""
    return {name: marker for name, marker in markers.items() if _span(marker) > _FIXED}


@once_a_record
def _span(marker: Marker) -> float:
    """Longest way (m) that a marker goes along an axis, but for a hundredth of its frames."""
    seen = marker.positions[~marker.missing]
    if len(seen) < 3:
        return 0.0
    low, high = np.percentile(seen, (1, 99), axis=0)
    return float((high - low).max())


def walking_direction(
    trial: Trial, contact: Contact, walking: str | None, body: np.ndarray | None
) -> Direction:
    """Return the walking direction during a contact and how it was found.

    ``walking``: the axis that a person set, as "+x". ``body``: that of ``Axes``.

    In this order: the override, the markers during the first half of the stance, the path of
    the centre of pressure (heel to toe), the shear force (braking first, then driving). Markers
    that stand still tell of a person who does, unless they walk on in the recording: they may be
    those of the foot on the plate.
    """
    up = contact.up
    if walking:
        way = _flat(axis_vector(walking, "walking"), up)
        return Direction(way, DirectionSource.GIVEN, Message("given"))
    plate, start, stop = contact.plate, contact.start, contact.stop
    time = plate.start + np.array([start, (start + stop) / 2.0]) / plate.rate
    path = marker_velocity(trial, float(time[0]), float(time[1]), up)
    speed = 0.0 if path is None else float(np.linalg.norm(path))
    if path is not None and speed > WALKING_SPEED:
        here = Message(" ({speed:.2f} m/s)", speed=speed)
        text = Message("markers in this step{here}", here=here)
        return Direction(path / speed, DirectionSource.MARKERS, text)
    step, swing = contact.pressure_path, contact.shear_swing
    length, size = float(np.linalg.norm(step)), float(np.linalg.norm(swing))
    least = _ALONG * max(length, 0.05) * WALKING_SPEED
    if path is not None and (body is None or not step @ body > least):
        return Direction(
            explanation=Message("the markers move at {speed:.2f} m/s only", speed=speed)
        )
    if length > 0.05:
        text = Message("centre of pressure, {way:.0f} mm heel to toe", way=1e3 * length)
        return Direction(step / length, DirectionSource.PRESSURE, text)
    if size > 10.0:
        text = Message("shear force, braking before driving")
        return Direction(swing / size, DirectionSource.SHEAR, text)
    return Direction(explanation=Message("nothing tells it"))


def found_vertical(
    given: str | None = None,
    *,
    corners: Sequence[np.ndarray] = (),
    forces: Sequence[np.ndarray] = (),
    markers: Mapping[str, Marker],
    stated: Vertical | None = None,
) -> Vertical:
    """Return which way is up in a laboratory: the one answer for plates, markers and readers.

    Told by, in this order: a person (``given``, as "z" or "-y"); the normal of the plates'
    ``corners`` (4, 3); the axis along which their ``forces`` (n, 3) change most, if anybody stood
    on them; the file's format (``stated``); the axis along which the markers differ most and move
    least. Where nothing else tells, z is assumed. It points away from the feet.
    """
    if given:
        return Vertical(_three(axis_vector(given, "vertical")), "given")
    axis, source = _vertical_line(corners, forces, markers, stated)
    if stated is None or axis @ np.array(stated.axis) < 0.5:
        axis = axis * _away_from_feet(axis, markers)
    return Vertical(_three(axis), source)


def _vertical_line(
    corners: Sequence[np.ndarray],
    forces: Sequence[np.ndarray],
    markers: Mapping[str, Marker],
    stated: Vertical | None,
) -> tuple[np.ndarray, str]:
    normals = (plate_normal(corner) for corner in corners)
    framed = [int(np.argmax(np.abs(normal))) for normal in normals if normal is not None]
    if framed:
        return np.eye(3)[Counter(framed).most_common(1)[0][0]], "normal of the force plates"
    seen = [force[np.isfinite(force).all(axis=1)] for force in forces]
    seen = [force for force in seen if len(force)]
    changes = [np.ptp(np.percentile(force, (0.5, 99.5), axis=0), axis=0) for force in seen]
    change = np.sum(changes, axis=0) if seen else np.zeros(3)
    if change.max() < CONTACT_FORCE and seen:  # nobody steps on or off: the load that stays
        change = np.sum([np.abs(np.median(force, axis=0)) for force in seen], axis=0)
    if change.max() > CONTACT_FORCE:
        return np.eye(3)[int(np.argmax(change))], "axis that carries the load"
    if stated is not None:
        return np.array(stated.axis), stated.source
    paths = [m.positions[~m.missing] for m in markers.values() if (~m.missing).sum() > 2]
    if seen and not paths:
        return np.eye(3)[int(np.argmax(change))], "axis that carries the load"
    if not paths:
        return np.eye(3)[2], "assumed z: neither plates nor markers"
    # Everything moves along the walkway or sways across it, feet most; heights return.
    spans = np.median([np.ptp(path, axis=0) for path in paths], axis=0)
    heights = np.ptp([np.median(path, axis=0) for path in paths], axis=0)
    up = np.eye(3)[int(np.argmax(heights / (spans + 0.05)))]
    return up, "axis along which markers differ most and move least"


def _away_from_feet(axis: np.ndarray, markers: Mapping[str, Marker]) -> float:
    """Return -1 where the feet are on the axis' far side of a body's other markers, else 1."""
    trial = Trial("", markers=moving_markers(markers))
    found = [*heel_candidates(trial).values(), *toe_candidates(trial).values()]
    feet = {name for names in found for name in names}
    heights: dict[bool, list[float]] = {True: [], False: []}
    for name, marker in trial.markers.items():
        seen = marker.positions[~marker.missing]
        if len(seen):
            heights[name in feet].append(float(np.median(seen @ axis)))
    if not heights[True] or len(heights[False]) < 2:
        return 1.0
    return -1.0 if np.median(heights[True]) - np.median(heights[False]) > _ABOVE else 1.0


def _three(axis: np.ndarray) -> tuple[float, float, float]:
    x, y, z = axis.tolist()
    return x, y, z


def _flat(vector: np.ndarray, up: np.ndarray) -> np.ndarray:
    flat = vector - (vector @ up) * up
    length = float(np.linalg.norm(flat))
    if length < 0.5:
        raise InputError("the walking axis is the vertical axis", where="walking")
    return flat / length
