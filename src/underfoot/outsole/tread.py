"""Tread: lugs and channels in the frame of the sole."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError, unknown_name

from ._checks import not_negative, positive

Array = NDArray[np.float64]
PATTERNS = ("grid", "transverse", "longitudinal")
_ROUNDING = 1e-12  # m: keeps a cell centre on an edge from falling on either side by rounding


@dataclass(frozen=True, slots=True)
class Tread:
    """Straight lugs of one width between straight channels of one width.

    Parameters
    ----------
    pattern
        "grid" (square lugs), "transverse" (channels across the shoe) or "longitudinal" (channels
        along it).
    lug_width, channel_width
        Along the repeating direction, m.
    depth
        Height of the lugs, m; 0 is an untreaded sole.
    edge_radius
        Rounding of the upper edges of the lugs, m.
    offset
        Shift (x, y) of the pattern, m. At (0, 0) the first lug begins at the rear end of the sole
        and a lug is centred on the centre line.
    """

    pattern: str
    lug_width: float
    channel_width: float
    depth: float
    edge_radius: float = 0.0
    offset: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        if self.pattern not in PATTERNS:
            raise unknown_name("tread pattern", self.pattern, PATTERNS, where="tread.pattern")
        positive(self.lug_width, "tread.lug_width")
        positive(self.channel_width, "tread.channel_width")
        not_negative(self.depth, "tread.depth")
        not_negative(self.edge_radius, "tread.edge_radius")
        if self.depth > 0 and self.edge_radius > min(self.depth, self.lug_width / 2):
            raise InputError(
                f"edge radius {self.edge_radius * 1e3:g} mm doesn't fit on the lug",
                where="tread.edge_radius",
                allowed=f"at most {min(self.depth, self.lug_width / 2) * 1e3:g} mm "
                "(the depth and half the lug width)",
            )

    @property
    def land_ratio(self) -> float:
        """Share of an endless tread that is lug: w / (w + c), squared for a grid."""
        share = self.lug_width / (self.lug_width + self.channel_width)
        return share**2 if self.pattern == "grid" else share

    def channel_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) into the channels: positive in a channel, negative on a lug.

        On a lug the value is minus the distance to its nearest edge.
        """
        distances = []
        if self.pattern in ("grid", "transverse"):
            distances.append(self._across(x - self.offset[0]))
        if self.pattern in ("grid", "longitudinal"):
            shifted = y - self.offset[1]
            if self.offset[1] == 0.0:
                shifted = np.abs(shifted)  # exactly the same on both sides
            distances.append(self._across(shifted + self.lug_width / 2))
        return np.maximum.reduce(distances)

    def _across(self, position: Array) -> Array:
        pitch = self.lug_width + self.channel_width
        u = np.mod(position + _ROUNDING, pitch)
        into = np.minimum(u - self.lug_width, pitch - u)
        return np.where(u >= self.lug_width, np.maximum(into, 0.0), -np.minimum(u, -into))


@dataclass(frozen=True, slots=True)
class ArcChannel:
    """One channel that follows the rounded rear of the heel.

    Parameters
    ----------
    position
        Distance of the channel's middle from the rear end, on the centre line, m.
    radius
        Radius of the channel's middle line, m; its centre lies at position + radius.
    width, depth
        Of the channel, m.
    """

    position: float
    radius: float
    width: float
    depth: float

    def __post_init__(self) -> None:
        for name in ("position", "radius", "width"):
            positive(getattr(self, name), f"arc_channel.{name}")
        not_negative(self.depth, "arc_channel.depth")
        if self.width / 2 >= min(self.position, self.radius):
            raise InputError(
                f"width {self.width * 1e3:g} mm is too large for its place",
                where="arc_channel.width",
                allowed=f"below {2e3 * min(self.position, self.radius):g} mm "
                "(twice the smaller of position and radius)",
            )

    def channel_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) into the channel: positive in it, negative beside it."""
        along = x - (self.position + self.radius)
        into = self.width / 2 - np.abs(np.hypot(along, y) - self.radius)
        ahead = -np.hypot(along, np.maximum(np.abs(np.abs(y) - self.radius) - self.width / 2, 0.0))
        return np.where(along < 0, into, np.minimum(into, ahead))
