"""One contact on its walkway, with what its judges ask for resolved once."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from underfoot.core.remark import Message

from ..recording.axes import marker_velocity
from ..recording.plates import plate_up
from ..recording.signals import LowPass, low_passed_part
from ..recording.trial import Marker, Plate
from .belts import Belt
from .events import Stance
from .walkway import Walkway


class BodyMotion(NamedTuple):
    """Velocities (3,) of the body over the surface under a step, m/s; None without markers.

    ``whole``: during the step, with its vertical part. ``first`` and ``second``: in the plane of
    the floor, during its halves.
    """

    whole: np.ndarray | None
    flat: np.ndarray | None
    first: np.ndarray | None
    second: np.ndarray | None


@dataclass(frozen=True, eq=False)
class Step:
    """A stance on its walkway: each answer is worked out when it is first asked for, and kept.

    Markers and velocities are as seen from the surface under the foot, in laboratory axes at its
    contact: on a belt those over the belt.
    """

    walk: Walkway
    stance: Stance

    @cached_property
    def plate(self) -> Plate:
        """The plate stood on; a DataError where the trial has none of that name."""
        plates = (plate for plate in self.walk.trial.plates if plate.name == self.stance.plate)
        return next(plates, None) or self.walk.plate(self.stance.plate)

    @property
    def belt(self) -> Belt | None:
        """The belt stood on; None on a floor."""
        return self.walk.belts.get(self.stance.plate)

    @property
    def surface_velocity(self) -> np.ndarray:
        """Velocity (3,) of the surface under the foot at contact: zero but for belts (m/s)."""
        return np.zeros(3) if self.belt is None else self.belt.velocity(self.stance.contact)

    @cached_property
    def surface(self) -> tuple[np.ndarray, np.ndarray]:
        """Normal and forward tangent (3,) of the walking surface; a walking direction is known."""
        assert self.stance.walking is not None
        return self.walk.axes.ramp.surface(self.walk.up, self.stance.walking)

    @property
    def surface_text(self) -> dict[str, Message]:
        """The surface (level, a ramp, a belt) and a belt's speed, in words."""
        belt, ground = self.belt, self.walk.axes.ramp.description
        if belt is None:
            return {"surface": ground}
        text = belt.speed_text(self.stance.contact)
        return {"surface": Message("treadmill belt, {ground}", ground=ground), "belt": text}

    @cached_property
    def slope(self) -> float | None:
        """Slope (rad) of the plate's corners along the walk, up positive; None without corners.

        Forces of a plate with corners stand in laboratory axes.
        """
        corners, walking, up = self.plate.corners, self.stance.walking, self.walk.up
        if corners is None or walking is None:
            return None
        normal = plate_up(corners, up)
        return math.atan2(-float(normal @ walking), float(normal @ up))

    @cached_property
    def force(self) -> np.ndarray:
        """Force (n, 3) from contact to toe off, as measured (N)."""
        return self.plate.force[self.stance.start : self.stance.stop]

    @cached_property
    def smooth_force(self) -> np.ndarray:
        """The same at 36 Hz, or what the sampling rate lets pass."""
        low_pass = LowPass(cutoff=min(36.0, 0.4 * self.plate.rate))
        return self.filtered_force[low_pass]

    @cached_property
    def filtered_force(self) -> "FilteredForce":
        """The same (N) by the filter that it went through."""
        return FilteredForce(self.plate, self.stance.start, self.stance.stop)

    @cached_property
    def markers(self) -> Mapping[str, Marker]:
        """Markers of heels, toes and pelvis by their names."""
        walk, stance, belt = self.walk, self.stance, self.belt
        names = dict.fromkeys((*walk.heels.values(), *walk.toes.values(), *walk.pelvis))
        if stance.heel:
            names[stance.heel] = None
        markers = {name: walk.trial.markers[name] for name in names}
        if belt is None:
            return markers
        return {name: belt.carry_back(marker, stance.contact) for name, marker in markers.items()}

    @property
    def heel(self) -> Marker | None:
        """The heel marker of the foot, None where none is known."""
        return self.markers.get(self.stance.heel)

    @property
    def toe(self) -> Marker | None:
        """The toe marker of the foot, None where none is known."""
        return self.markers.get(self.walk.toes.get(self.stance.side, ""))

    @cached_property
    def body(self) -> BodyMotion:
        """How the body moves during the step."""
        trial, up, belt = self.walk.trial, self.walk.up, self.belt
        contact, toe_off = self.stance.contact, self.stance.toe_off
        whole = marker_velocity(trial, contact, toe_off, None)
        if whole is None:
            return BodyMotion(None, None, None, None)
        flat = whole - (whole @ up) * up
        middle = 0.5 * (contact + toe_off)
        halves = (
            moved if moved is None or belt is None else moved - belt.velocity(begin)
            for begin, moved in (
                (contact, marker_velocity(trial, contact, middle, up)),
                (middle, marker_velocity(trial, middle, toe_off, up)),
            )
        )
        return BodyMotion(whole - self.surface_velocity, flat - self.surface_velocity, *halves)

    @cached_property
    def speed(self) -> float | None:
        """Speed of the body over the surface (m/s), None without markers.

        On a belt that of the belt, before which the body stays.
        """
        if self.belt is not None:
            return self.belt.speed(self.stance.contact)
        flat = self.body.flat
        return None if flat is None else float(np.linalg.norm(flat))

    @cached_property
    def contacts(self) -> tuple[tuple[int, int], ...]:
        """First sample of each contact with the plate and the one after its last."""
        found = self.walk.contacts[self.plate]
        return tuple((contact.start, contact.stop) for contact, _ in found)


class FilteredForce(dict[LowPass, np.ndarray]):
    """Forces (n, 3) from contact to toe off by their filter, each worked out when asked for (N)."""

    def __init__(self, plate: Plate, start: int, stop: int) -> None:
        self.plate, self.start, self.stop = plate, start, stop

    def __missing__(self, low_pass: LowPass) -> np.ndarray:
        """Filter the forces in their surroundings; errors as ``low_passed``."""
        plate = self.plate
        self[low_pass] = low_passed_part(plate.force, plate.rate, low_pass, self.start, self.stop)
        return self[low_pass]
