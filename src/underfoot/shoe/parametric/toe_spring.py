"""Profile of a whole sole: the heel's own, and a toe that bends up."""

from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.core.checks import positive

from ..profile import Profile


@dataclass(frozen=True, slots=True)
class ToeSpring:
    """An arc that lifts the toe, tangent to the sole where it begins.

    Parameters:
        height_at_tip: Of the tip over the sole plane, m.
        start: Distance of its beginning from the rear end, m.
        length: Of the sole, m.
    """

    height_at_tip: float
    start: float
    length: float

    def __post_init__(self) -> None:
        positive(self.height_at_tip, "heel.toe_spring")
        positive(self.start, "heel.toe_start")
        if not self.height_at_tip < self.length - self.start:
            raise InputError(
                f"a toe of {max(self.length - self.start, 0) * 1e3:g} mm cannot rise by "
                f"{self.height_at_tip * 1e3:g} mm",
                where="heel.toe_spring",
                allowed="less than the length before heel.toe_start",
            )

    @property
    def radius(self) -> float:
        """Radius of the arc, (l^2 + h^2) / (2 h), m."""
        reach = self.length - self.start
        return (reach**2 + self.height_at_tip**2) / (2 * self.height_at_tip)

    def height(self, x: Array) -> Array:
        """Return R - sqrt(R^2 - (x - start)^2) before ``start``, 0 behind it; m."""
        into = np.clip(x - self.start, 0.0, self.length - self.start)
        return self.radius - np.sqrt(self.radius**2 - into**2)


@dataclass(frozen=True, slots=True)
class SoleProfile:
    """The rear's profile and the toe spring together."""

    rear: Profile
    toe: ToeSpring | None = None

    def height(self, x: Array) -> Array:
        """Return the height (m) over the sole plane at the distance ``x`` (m) from the rear."""
        height = self.rear.height(x)
        return height if self.toe is None else height + self.toe.height(x)
