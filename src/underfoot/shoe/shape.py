"""Soles by a few lengths: profile, land new and worn, and the heel."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, Self, cast, runtime_checkable

import numpy as np

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.core.checks import between, not_negative, positive
from underfoot.core.deprecation import renamed_member
from underfoot.core.remark import Message

from .tread import ArcChannel, Tread


class HeelProfile(Protocol):
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


_CENTRE_LINE_NODES = 4001


class SoleWear(Protocol):
    """Material removed from the land of a sole."""

    @property
    def depth(self) -> float:
        """Largest thickness removed, m."""
        ...

    def worn_height(self, x: Array, y: Array, unworn: Array, shape: "SoleShape") -> Array:
        """Return the height (m) of the worn land at (x, y); ``unworn`` is that of the new one."""
        ...


@runtime_checkable
class WearOnSole(Protocol):
    """Wear that a sole decides: where it fits, or how its shape meets the floor."""

    @property
    def depth(self) -> float:
        """Largest thickness removed, m."""
        ...

    def on(self, shape: "SoleShape") -> SoleWear:
        """Return what is removed from ``shape``."""
        ...


def fit_wear(wear: SoleWear | WearOnSole, shape: "SoleShape") -> SoleWear:
    """Return the wear as it is on a sole.

    Raises:
        InputError: A patch larger than the sole or beside it.
    """
    return wear.on(shape) if isinstance(wear, WearOnSole) else wear


class SoleShape(ABC):
    """Bottom of a sole given by lengths and angles, x from the rear end, y to the left, z up."""

    __slots__ = ()
    length: float
    width: float
    outsole_thickness: float
    profile: HeelProfile
    edge_radius: float
    crown_radius: float | None
    tread: Tread | None
    arc_channel: ArcChannel | None
    wear: SoleWear | None

    @property
    @abstractmethod
    def plan_area(self) -> float:
        """Area of the plan form in its own plane, m^2."""

    @abstractmethod
    def inward_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) from the rim of the plan form, positive inside."""

    @abstractmethod
    def rim_arcs(self) -> Array:
        """Return the rim as arcs (n, 7), anticlockwise; see ``_kernels.arcs``."""

    def land_height(self, x: Array, y: Array) -> Array:
        """Return the height (m) of the worn sole over its plane, as if there were no channels."""
        unworn = self.unworn_height(x, y)
        if self.wear is None or self.wear.depth == 0:
            return unworn
        return self.wear.worn_height(x, y, unworn, self)

    def worn_off(self, x: Array, y: Array) -> Array:
        """Return the thickness (m) that wear has taken off the land."""
        if self.wear is None or self.wear.depth == 0:
            return np.zeros(x.shape)
        return self.land_height(x, y) - self.unworn_height(x, y)

    def unworn_height(self, x: Array, y: Array) -> Array:
        """Return the height (m) of the new sole over its plane, as if there were no channels."""
        height = self.profile.height(x)
        if self.crown_radius is not None:
            height = height + y**2 / (2 * self.crown_radius)
        if self.edge_radius > 0:
            into = np.clip(self.edge_radius - self.inward_distance(x, y), 0.0, self.edge_radius)
            height = height + self.edge_radius - np.sqrt(self.edge_radius**2 - into**2)
        return height

    def with_wear(self, wear: SoleWear | WearOnSole | None) -> Self:
        """Return the sole with other wear."""
        new = replace(cast("Any", self), wear=None)
        return new if wear is None else replace(new, wear=fit_wear(wear, new))

    worn = renamed_member("worn", "with_wear", gone="0.4")

    def centre_line(self) -> tuple[Array, Array]:
        """Return x and the unworn height (m) along y = 0."""
        line = np.linspace(0.0, self.length, _CENTRE_LINE_NODES)
        return line, self.unworn_height(line, np.zeros_like(line))


def check_depths(shape: SoleShape) -> None:
    """Refuse channels, arc channels and wear that go through the outsole, and a crown of 0."""
    positive(1.0 if shape.crown_radius is None else shape.crown_radius, "heel.crown_radius")
    for name in ("tread", "arc_channel", "wear"):
        part = getattr(shape, name)
        if part is not None and part.depth >= shape.outsole_thickness:
            raise InputError(
                Message(
                    "depth {depth:g} mm goes through the outsole of {outsole_thickness:g} mm",
                    depth=part.depth * 1000.0,
                    outsole_thickness=shape.outsole_thickness * 1000.0,
                ),
                where=f"{name}.depth",
                allowed="less than heel.outsole_thickness",
            )


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
    profile: HeelProfile = field(default_factory=Flat)
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
                    Message(
                        "{edge_radius:g} mm doesn't fit the plan form",
                        edge_radius=getattr(self, name) * 1000.0,
                    ),
                    where=f"heel.{name}",
                    allowed=Message(
                        "at most {limit:g} mm (half its width and half its length)",
                        limit=limit * 1000.0,
                    ),
                )
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
