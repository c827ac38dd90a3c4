"""Shape of a sole along the shoe before tilting."""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.core.checks import between, positive


class Profile(Protocol):
    """Shape of the sole along x before tilting."""

    def height(self, x: Array) -> Array:
        """Return the height (m) over the sole plane at the distance ``x`` (m) from the rear."""
        ...


@dataclass(frozen=True, slots=True)
class Flat:
    """A sole that is flat up to its rear edge."""

    def height(self, x: Array) -> Array:
        """Return 0."""
        return np.zeros_like(x)


@dataclass(frozen=True, slots=True)
class Facet:
    """A plane bevel at the rear, moulded or worn.

    Parameters:
        angle: Between facet and sole, rad: at a shoe angle equal to it the facet lies flat on the
            floor.
        length: Of the facet along the sole, from the rear end, m.
    """

    angle: float
    length: float

    def __post_init__(self) -> None:
        between(self.angle, 0.0, math.radians(60), "profile.angle", "0 deg to 60 deg")
        positive(self.length, "profile.length")

    def height(self, x: Array) -> Array:
        """Return tan(angle) (length - x) behind the facet's front end, 0 before it."""
        return math.tan(self.angle) * np.maximum(self.length - x, 0.0)


@dataclass(frozen=True, slots=True)
class Rocker:
    """A rear part rounded along x.

    Parameters:
        radius: Of the rounding, m.
        start: Distance from the rear end at which the rounding begins, m.
    """

    radius: float
    start: float

    def __post_init__(self) -> None:
        positive(self.radius, "profile.radius")
        positive(self.start, "profile.start")
        if self.start >= self.radius:
            raise InputError(
                f"start {self.start * 1e3:g} mm reaches beyond the radius "
                f"{self.radius * 1e3:g} mm: the rear would be vertical",
                where="profile.start",
                allowed="less than profile.radius",
            )

    def height(self, x: Array) -> Array:
        """Return R - sqrt(R^2 - (start - x)^2) behind ``start``, 0 before it."""
        # behind the rear end (x < 0) the profile keeps its last height
        into = np.clip(self.start - x, 0.0, self.start)
        return self.radius - np.sqrt(self.radius**2 - into**2)
