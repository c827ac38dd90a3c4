"""Heel described by a few lengths and angles."""

import math
from dataclasses import dataclass, field

import numpy as np

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.core.checks import not_negative, positive

from .shape import Flat, Profile, SoleShape, SoleWear, check_depths
from .tread import ArcChannel, Tread


@dataclass(frozen=True, slots=True)
class Heel(SoleShape):
    """A heel in its own frame: x from its rear end towards the toe, y across, z up into the shoe.

    Parameters:
        length, width: Of the plan form, m.
        rear_radius, front_radius: Of the corners of the plan form, m, at most half the width.
        outsole_thickness: From the bottom of the lugs to the midsole, m: bounds tread depth and
            wear.
        profile: ``Flat()``, ``Facet(angle, length)``, ``Rocker(radius, start)`` or anything with
            ``height(x)``.
        edge_radius: Rounding of the lower edge all around, m.
        crown_radius: Radius of a sole that bulges across, m; None for none.
        tread, arc_channel: Channels in the sole; a depth of 0 is none.
        wear: What was removed, as a plane, a patch or a map; None for a new sole.
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
    wear: SoleWear | None = None

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
        check_depths(self)

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

    def rim_arcs(self) -> Array:
        """Return the rim as arcs (n, 7), anticlockwise; see ``_kernels.arcs``."""
        half, far = self.width / 2, self.length
        corners = (  # of the plan form and the direction along which the rim leaves them
            (np.array([far, half]), self.front_radius, np.array([-1.0, 0.0])),
            (np.array([0.0, half]), self.rear_radius, np.array([0.0, -1.0])),
            (np.array([0.0, -half]), self.rear_radius, np.array([1.0, 0.0])),
            (np.array([far, -half]), self.front_radius, np.array([0.0, 1.0])),
        )
        arcs = []
        for index, (corner, radius, leaving) in enumerate(corners):
            arriving = corners[index - 1][2]
            begin, end = corner - radius * arriving, corner + radius * leaving
            if radius > 0:
                centre = begin + radius * leaving
                arcs.append([*begin, *end, *centre, radius])
            following, next_radius, _ = corners[(index + 1) % 4]
            straight = following - next_radius * leaving
            if float(np.hypot(*(straight - end))) > 1e-9:
                arcs.append([*end, *straight, 0.0, 0.0, math.inf])
        return np.array(arcs)
