"""Sipes: slits in the lugs, too narrow to drain much, that let a lug bend and open its edges."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError

from ._checks import between, positive
from ._kernels.tread_pattern import rotated

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Sipes:
    """Parallel slits through all lugs.

    Parameters
    ----------
    width, depth
        Of a slit, m; the depth at most that of the tread.
    spacing
        Between the middles of two slits, m.
    angle
        Of the slits against the transverse direction, rad, anticlockwise seen from above.
    offset
        Distance of the first slit's middle from the rear end at angle 0, m; by default half the
        spacing.
    """

    width: float
    depth: float
    spacing: float
    angle: float = 0.0
    offset: float | None = None

    def __post_init__(self) -> None:
        for name in ("width", "depth", "spacing"):
            positive(getattr(self, name), f"sipes.{name}")
        most = math.radians(180)
        between(self.angle, -most, most, "sipes.angle", "-180 deg to 180 deg")
        if self.width >= self.spacing / 2:
            raise InputError(
                f"slits of {self.width * 1e3:g} mm every {self.spacing * 1e3:g} mm leave no lug",
                where="sipes.width",
                allowed=f"below {self.spacing / 2e-3:g} mm (half of sipes.spacing)",
            )

    def check_within(self, tread_depth: float) -> None:
        """Refuse slits that go deeper than the lugs stand."""
        if self.depth > tread_depth * (1 + 1e-9):
            raise InputError(
                f"sipes of {self.depth * 1e3:g} mm are deeper than the tread",
                where="sipes.depth",
                allowed=f"at most {tread_depth * 1e3:g} mm (tread.depth)",
            )

    def channel_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) into a slit: positive in it, negative beside it."""
        first = self.spacing / 2 if self.offset is None else self.offset
        across, _ = rotated(x, y, self.angle)
        place = np.mod(across - first + self.spacing / 2, self.spacing) - self.spacing / 2
        return self.width / 2 - np.abs(place)
