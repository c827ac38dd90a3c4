"""Wear of a sole as a plane cut."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from underfoot.core.arrays import Array
from underfoot.core.checks import between, not_negative

if TYPE_CHECKING:
    from ..shape import SoleShape


@dataclass(frozen=True, slots=True)
class WearPlane:
    """Material removed by a plane, as if ground against a floor at the wear angle.

    The plane first meets the point that would touch a floor at this shoe angle and then removes
    ``depth`` there; this also makes the worn facet at the rear of a heel.

    Parameters:
        depth: Largest thickness removed, normal to the sole, m.
        angle: Shoe angle at which the sole wears, rad, toe up positive; 0 wears the sole evenly.
    """

    depth: float
    angle: float = 0.0

    def __post_init__(self) -> None:
        not_negative(self.depth, "wear.depth")
        between(self.angle, 0.0, math.radians(45), "wear.angle", "0 deg to 45 deg")

    def worn_height(self, x: Array, y: Array, unworn: Array, shape: SoleShape) -> Array:
        """Return the height (m) of the worn land at (x, y): the higher of sole and plane."""
        return np.maximum(unworn, self.height(x, *shape.centre_line()))

    def height(self, x: Array, centre_line_x: Array, centre_line_height: Array) -> Array:
        """Return the height (m) of the plane over the sole plane at ``x`` (m).

        z_p(x) = depth + min(z + x tan(angle)) - x tan(angle), the minimum over the centre line of
        the unworn sole: the surface after wear is the higher of z and z_p.
        """
        slope = math.tan(self.angle)
        first_contact = float(np.min(centre_line_height + slope * centre_line_x))
        return self.depth + first_contact - slope * x
