"""The walking surface: level, or a ramp with its angle and the axes that its plates measure in."""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError, to_si, unknown_name

PLATE_FRAMES = {
    "surface": "plates that measure normal and tangential to the walking surface",
    "horizontal": "plates that measure in horizontal and vertical axes",
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
            words = f"a ramp of {math.degrees(self.angle):.4g} deg"
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
        return _turned(up, walking, self.angle if self.plate_frame == "horizontal" else 0.0)

    def gravity(self, up: np.ndarray, walking: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return vertical and forward horizontal in the plate's axes, both (3,)."""
        return _turned(up, walking, -self.angle if self.plate_frame == "surface" else 0.0)

    @property
    def words(self) -> str:
        """The surface in words, as "ramp of 5 deg, walking up; plates that measure ..."."""
        if not self.angle:
            return "level"
        way = "up" if self.angle > 0 else "down"
        return (
            f"ramp of {abs(math.degrees(self.angle)):.4g} deg, walking {way}; "
            f"{PLATE_FRAMES[self.plate_frame]}"
        )


LEVEL = Ramp()


def ramp_from(angle: object, plate_frame: str = "", *, where: str = "ramp") -> Ramp:
    """Return the ramp of an angle with its unit, as "5 deg" (up) or "-5 deg" (down).

    InputError: no angle, no unit, or what ``Ramp`` refuses.
    """
    return Ramp(to_si(angle, "rad", where=where), plate_frame)


def _turned(up: np.ndarray, walking: np.ndarray, angle: float) -> tuple[np.ndarray, np.ndarray]:
    cos, sin = math.cos(angle), math.sin(angle)
    return cos * up - sin * walking, cos * walking + sin * up
