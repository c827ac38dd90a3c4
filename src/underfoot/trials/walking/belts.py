"""Treadmill belts: found where a standing foot is carried backward, and how fast."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from underfoot.core.deprecation import renamed_member
from underfoot.core.remark import Message

from ..recording.axes import Direction, DirectionSource, walking_direction
from ..recording.plates import Contact
from ..recording.signals import frames_between
from ..recording.trial import Marker, Plate, Trial

_SLOWEST = 0.3  # m/s; a slower belt can't be told from feet that roll and drift
_STANDS = (0.2, 0.45)  # share of a contact in which heel and toe of the foot lie flat
_STRAIGHT = 0.01  # m that a standing foot may stray from even motion
_ROLL, _ROLL_SD = 0.155, 0.024  # m from the first to the last fifth of a stance: 16 recorded steps
_BESIDE = 15.0  # s of a marker's path before and after a step on a belt
_NEAREST = 5  # stances whose median is the belt's speed at a time: belts of their own pace change


@dataclass(frozen=True, slots=True, eq=False)
class Belt:
    """The moving surface of one plate: velocities (n, 3) of standing feet at ``times`` (n,).

    In m/s and s. ``source`` is what told them, ``uncertainty`` that of one velocity (m/s).
    """

    times: np.ndarray
    velocities: np.ndarray
    source: str
    uncertainty: float

    def velocity(self, time: float) -> np.ndarray:
        """Return the velocity (3,) of the surface at a time (s): the median of the stances near."""
        near = np.argsort(np.abs(self.times - time))[:_NEAREST]
        return np.asarray(np.median(self.velocities[near], axis=0))

    def speed(self, time: float) -> float:
        """Return the speed of the surface at a time (m/s)."""
        return float(np.linalg.norm(self.velocity(time)))

    def speed_text(self, time: float) -> Message:
        """Return the speed in words: "1.25 m/s (u 0.01 m/s, foot markers)"."""
        values = {"speed": self.speed(time), "u": self.uncertainty, "source": self.source}
        return Message("{speed:.2f} m/s (u {u:.2f} m/s, {source})", **values)

    words = renamed_member("words", "speed_text", gone="0.4")

    def carry_back(self, marker: Marker, time: float) -> Marker:
        """Return a marker as seen from the surface, in laboratory axes at ``time`` (s).

        Of the 15 s before and after.
        """
        near = frames_between(marker.time, time - _BESIDE, time + _BESIDE)
        moments, places = marker.time[near], marker.positions[near]
        return replace(
            marker,
            positions=places - np.outer(moments - time, self.velocity(time)),
            start=float(moments[0]) if len(moments) else marker.start,
            times=None if marker.times is None else moments,
        )

    def direction(self, time: float) -> Direction:
        """Return the way of somebody who walks against the belt."""
        speed = self.speed(time)
        here = Message(" ({speed:.2f} m/s, {source})", speed=speed, source=self.source)
        text = Message("against the treadmill belt{here}", here=here)
        return Direction(-self.velocity(time) / speed, DirectionSource.TREADMILL, text)


def belts_of(
    contacts: Mapping[Plate, Sequence[Contact]], body: np.ndarray | None, feet: Sequence[Marker]
) -> dict[str, Belt]:
    """Return the belts among plates by the name of their plate; none on a floor.

    On a belt a foot that stands is carried evenly, against the way in which it pushes itself, at
    0.3 m/s or more, and the body stays behind: this must hold for most contacts of the plate. The
    speed is that of the markers ``feet`` (heels, toes) between 20 and 45 % of the contact; without
    them that of the centre of pressure, less its own 155 +- 24 mm from heel to toe. ``body`` is the
    velocity (3,) of all markers over the recording (m/s), None without any.
    """
    belts = {}
    for plate, ones in contacts.items():
        seen, straightness = [], []
        for contact in ones:
            start, stop, swing = contact.start, contact.stop, contact.shear_swing
            if not 0.3 < (stop - start) / plate.rate < 2.0 or np.linalg.norm(swing) < 10.0:
                continue
            swing /= np.linalg.norm(swing)
            velocity, error = _carried_velocity(contact, feet, swing)
            if velocity is not None:
                seen.append((plate.start + start / plate.rate, velocity, swing))
                straightness.append(error)
        carried = [(t, v) for t, v, swing in seen if v @ swing < -_SLOWEST]
        if 2 * len(carried) <= len(seen):
            continue
        times, velocities = (np.array(part) for part in zip(*carried, strict=True))
        middle = np.median(velocities, axis=0)
        if body is not None and abs(body @ middle) > 0.3 * (middle @ middle):
            continue  # somebody walks off: a floor on which the heel slides
        source = "foot markers" if feet else "centre of pressure"
        belts[plate.name] = Belt(times, velocities, source, float(np.median(straightness)))
    return belts


def _carried_velocity(
    contact: Contact, feet: Sequence[Marker], swing: np.ndarray
) -> tuple[np.ndarray | None, float]:
    """Velocity (3,) of the foot that stands on a plate and its uncertainty (m/s)."""
    plate, start, up = contact.plate, contact.start, contact.up
    duration = (contact.stop - start) / plate.rate
    if not feet:
        step = contact.pressure_path
        if not step.any():
            return None, 0.0
        return (step - _ROLL * swing) / (0.8 * duration), _ROLL_SD / (0.8 * duration)
    begin, end = (plate.start + start / plate.rate + share * duration for share in _STANDS)
    lines = []
    for marker in feet:
        near = frames_between(marker.time, begin, end)
        inside = ~marker.missing[near]
        if inside.sum() < max(4, 0.5 * (end - begin) * marker.rate):
            continue
        time, place = marker.time[near][inside] - begin, marker.positions[near][inside]
        place = place - np.outer(place @ up, up)
        line = np.polynomial.polynomial.polyfit(time, place, 1)
        stray = place - np.polynomial.polynomial.polyval(time, line).T
        spread = float(np.sqrt((stray**2).sum(axis=1).mean()))
        if spread < _STRAIGHT:
            lines.append((line[1], spread / (end - begin)))
    # The other foot swings forward: the one that stands goes least along the way of the walk.
    return min(lines, key=lambda pair: float(pair[0] @ swing), default=(None, 0.0))


def contact_direction(
    trial: Trial,
    contact: Contact,
    belts: Mapping[str, Belt],
    walking: str | None,
    body: np.ndarray | None,
) -> Direction:
    """Return the walking direction during a contact: against its belt, else ``walking_direction``.

    ``belts``: by the name of their plate. ``walking`` and ``body`` as ``walking_direction``.
    """
    plate, belt = contact.plate, belts.get(contact.plate.name)
    if belt is not None and not walking:
        return belt.direction(plate.start + contact.start / plate.rate)
    return walking_direction(trial, contact, walking, body)
