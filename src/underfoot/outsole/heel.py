"""Heel described by a few lengths and angles."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError

from ._checks import not_negative, positive
from .profile import Flat, Profile
from .tread import ArcChannel, Tread
from .wear import WearPlane

Array = NDArray[np.float64]
_CENTRE_LINE_NODES = 4001


@dataclass(frozen=True, slots=True)
class Heel:
    """A heel in its own frame: x from its rear end towards the toe, y across, z up into the shoe.

    Parameters
    ----------
    length, width
        Of the plan form, m.
    rear_radius, front_radius
        Of the corners of the plan form, m, at most half the width.
    outsole_thickness
        From the bottom of the lugs to the midsole, m: bounds tread depth and wear.
    profile
        ``Flat()``, ``Facet(angle, length)``, ``Rocker(radius, start)`` or anything with
        ``height(x)``.
    edge_radius
        Rounding of the lower edge all around, m.
    crown_radius
        Radius of a sole that bulges across, m; None for none.
    tread, arc_channel
        Channels in the sole; a depth of 0 is none.
    wear
        Plane cut; None for a new sole.
    """

    length: float
    width: float
    rear_radius: float
    outsole_thickness: float
    front_radius: float = 0.0
    profile: Profile = field(default_factory=Flat)
    edge_radius: float = 0.0
    crown_radius: float | None = None
    tread: Tread | None = None
    arc_channel: ArcChannel | None = None
    wear: WearPlane | None = None

    def __post_init__(self) -> None:
        for name in ("length", "width", "outsole_thickness"):
            positive(getattr(self, name), f"heel.{name}")
        for name in ("rear_radius", "front_radius", "edge_radius"):
            not_negative(getattr(self, name), f"heel.{name}")
        limit = min(self.width / 2, self.length / 2)
        for name in ("rear_radius", "front_radius", "edge_radius"):
            if getattr(self, name) > limit:
                raise InputError(
                    f"{getattr(self, name) * 1e3:g} mm doesn't fit the plan form",
                    where=f"heel.{name}",
                    allowed=f"at most {limit * 1e3:g} mm (half its width and half its length)",
                )
        if self.crown_radius is not None:
            positive(self.crown_radius, "heel.crown_radius")
        for name in ("tread", "arc_channel", "wear"):
            part = getattr(self, name)
            if part is not None and part.depth >= self.outsole_thickness:
                raise InputError(
                    f"depth {part.depth * 1e3:g} mm goes through the outsole of "
                    f"{self.outsole_thickness * 1e3:g} mm",
                    where=f"{name}.depth",
                    allowed="less than heel.outsole_thickness",
                )

    @property
    def plan_area(self) -> float:
        """Area of the plan form in its own plane, m^2 (closed form)."""
        corners = (2 - math.pi / 2) * (self.rear_radius**2 + self.front_radius**2)
        return self.length * self.width - corners

    def inward_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) from the rim of the plan form, positive inside."""
        middle = self.length / 2
        radius = np.where(x < middle, self.rear_radius, self.front_radius)
        across = np.abs(y) - self.width / 2 + radius
        along = np.abs(x - middle) - middle + radius
        corner = np.hypot(np.maximum(along, 0.0), np.maximum(across, 0.0))
        return radius - corner - np.minimum(np.maximum(along, across), 0.0)

    def land_height(self, x: Array, y: Array) -> Array:
        """Return the height (m) of the worn sole over its plane, as if there were no channels."""
        unworn = self.unworn_height(x, y)
        if self.wear is None or self.wear.depth == 0:
            return unworn
        return np.maximum(unworn, self._wear_height(x))

    def unworn_height(self, x: Array, y: Array) -> Array:
        """Return the height (m) of the new sole over its plane, as if there were no channels."""
        height = self.profile.height(x)
        if self.crown_radius is not None:
            height = height + y**2 / (2 * self.crown_radius)
        if self.edge_radius > 0:
            into = np.clip(self.edge_radius - self.inward_distance(x, y), 0.0, self.edge_radius)
            height = height + self.edge_radius - np.sqrt(self.edge_radius**2 - into**2)
        return height

    def _wear_height(self, x: Array) -> Array:
        assert self.wear is not None
        line = np.linspace(0.0, self.length, _CENTRE_LINE_NODES)
        return self.wear.height(x, line, self.unworn_height(line, np.zeros_like(line)))
