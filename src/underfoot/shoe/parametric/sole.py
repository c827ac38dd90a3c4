"""A whole sole described by widths, profile and tread."""

from dataclasses import dataclass, field

import numpy as np

from underfoot.core import InputError, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.checks import not_negative, positive
from underfoot.core.remark import Message

from ..shape import Flat, HeelProfile, SoleShape, SoleWear, check_depths
from ..tread import ArcChannel, Tread

SIDES = ("left", "right")
HEEL_AT, WAIST_AT, LATERAL_BALL_AT, MEDIAL_BALL_AT = 0.16, 0.42, 0.62, 0.72
"""Places of the widths along the sole, as shares of its length (assumed: common lasts)."""
WAIST_INSET = 0.62
"""Share of the waist's inset that lies on the medial side, under the arch (assumed)."""
TOE_OFFSET = 0.12
"""Place of the tip towards the medial side as a share of the ball width (assumed)."""


@dataclass(frozen=True, slots=True)
class ShoeOutline:
    """Rim of a sole: arcs without a kink through the heel, both waists, both balls and the tip.

    Parameters:
        length: m.
        heel_width, waist_width, ball_width: Across the heel, the narrowest place and the ball of
            the foot, m. The ball width is the sum of its largest extents on both sides, which lie
            at different places along the sole.
        side: "left" or "right": the left sole, as seen from above, has its medial side at y < 0.
    """

    length: float
    heel_width: float
    waist_width: float
    ball_width: float
    side: str = "right"

    def __post_init__(self) -> None:
        for name in ("length", "heel_width", "waist_width", "ball_width"):
            positive(getattr(self, name), f"heel.{name}")
        if self.side not in SIDES:
            raise unknown_name("side", self.side, SIDES, where="heel.side")
        if self.waist_width > min(self.heel_width, self.ball_width):
            raise InputError(
                Message(
                    "the waist of {waist_width:g} mm is wider than heel or ball",
                    waist_width=self.waist_width * 1000.0,
                ),
                where="heel.waist_width",
                allowed=Message(
                    "at most {most:g} mm", most=min(self.heel_width, self.ball_width) * 1000.0
                ),
            )
        if self.length < 2 * self.ball_width:
            raise InputError(
                Message(
                    "a sole of {length:g} mm is too short for its ball width",
                    length=self.length * 1000.0,
                ),
                where="heel.length",
                allowed=Message(
                    "at least {ball_width:g} mm (twice heel.ball_width)",
                    ball_width=2000.0 * self.ball_width,
                ),
            )
        if 2 * HEEL_AT * self.length < 0.5 * self.heel_width:
            raise InputError(
                Message(
                    "a heel of {heel_width:g} mm is too wide for the length",
                    heel_width=self.heel_width * 1000.0,
                ),
                where="heel.heel_width",
                allowed=Message("at most {most:g} mm", most=4000.0 * HEEL_AT * self.length),
            )

    def arcs(self) -> Array:
        """Return the rim as arcs (n, 7), anticlockwise; see ``_kernels.arcs``."""
        from .._kernels.arcs import biarc

        length, inset = self.length, self.heel_width / 2 - self.waist_width / 2
        medial_inset, lateral_inset = 2 * WAIST_INSET * inset, 2 * (1 - WAIST_INSET) * inset
        heel, ball = self.heel_width / 2, self.ball_width / 2
        # of a right sole, whose medial side is on the left (y > 0); anticlockwise from the rear
        forward, backward = np.array([1.0, 0.0]), np.array([-1.0, 0.0])
        stations = [
            (np.array([0.0, 0.0]), np.array([0.0, -1.0])),
            (np.array([HEEL_AT * length, -heel]), forward),
            (np.array([WAIST_AT * length, lateral_inset - heel]), forward),
            (np.array([LATERAL_BALL_AT * length, -ball]), forward),
            (np.array([length, TOE_OFFSET * self.ball_width]), np.array([0.0, 1.0])),
            (np.array([MEDIAL_BALL_AT * length, ball]), backward),
            (np.array([WAIST_AT * length, heel - medial_inset]), backward),
            (np.array([HEEL_AT * length, heel]), backward),
        ]
        if self.side == "left":
            mirror = np.array([1.0, -1.0])
            stations = [(point * mirror, -tangent * mirror) for point, tangent in stations[::-1]]
        arcs = []
        for (start, leaving), (end, arriving) in zip(
            stations, [*stations[1:], stations[0]], strict=True
        ):
            arcs += biarc(start, leaving, end, arriving)
        return np.array(arcs)


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
                Message(
                    "a toe of {length:g} mm cannot rise by {height_at_tip:g} mm",
                    length=max(self.length - self.start, 0) * 1000.0,
                    height_at_tip=self.height_at_tip * 1000.0,
                ),
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

    rear: HeelProfile
    toe: ToeSpring | None = None

    def height(self, x: Array) -> Array:
        """Return the height (m) over the sole plane at the distance ``x`` (m) from the rear."""
        height = self.rear.height(x)
        return height if self.toe is None else height + self.toe.height(x)


@dataclass(frozen=True, slots=True)
class WholeSole(SoleShape):
    """A sole from heel to toe in its own frame: x from the rear end, y to the left, z up.

    Parameters:
        outline: Plan form.
        outsole_thickness: From the bottom of the lugs to the midsole, m.
        rear_profile: ``Flat()``, ``Facet(angle, length)`` or ``Rocker(radius, start)`` at the heel.
        toe_spring: Bend of the toe; None for none.
        edge_radius, crown_radius, tread, arc_channel, wear: As of ``Heel``.
    """

    outline: ShoeOutline
    outsole_thickness: float
    rear_profile: HeelProfile = field(default_factory=Flat)
    toe_spring: ToeSpring | None = None
    edge_radius: float = 0.0
    crown_radius: float | None = None
    tread: Tread | None = None
    arc_channel: ArcChannel | None = None
    wear: SoleWear | None = None
    length: float = field(init=False)
    width: float = field(init=False)
    profile: HeelProfile = field(init=False)

    def __post_init__(self) -> None:
        width = max(self.outline.ball_width, self.outline.heel_width)
        object.__setattr__(self, "length", self.outline.length)
        object.__setattr__(self, "width", width)
        object.__setattr__(self, "profile", SoleProfile(self.rear_profile, self.toe_spring))
        positive(self.outsole_thickness, "heel.outsole_thickness")
        not_negative(self.edge_radius, "heel.edge_radius")
        limit = self.outline.waist_width / 2
        if self.edge_radius > limit:
            raise InputError(
                Message(
                    "{edge_radius:g} mm doesn't fit the plan form",
                    edge_radius=self.edge_radius * 1000.0,
                ),
                where="heel.edge_radius",
                allowed=Message("at most {limit:g} mm (half of the waist)", limit=limit * 1000.0),
            )
        check_depths(self)

    @property
    def plan_area(self) -> float:
        """Area of the plan form in its own plane, m^2."""
        from .._kernels.arcs import points_on

        x, y = points_on(self.rim_arcs(), 1e-4).T
        return float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2

    def rim_arcs(self) -> Array:
        """Return the rim as arcs (n, 7), anticlockwise; see ``_kernels.arcs``."""
        return self.outline.arcs()

    def inward_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) from the rim of the plan form, positive inside."""
        from .._kernels.arcs import inward_distance

        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        flat = inward_distance(x.ravel(), y.ravel(), self.rim_arcs())
        return flat.reshape(x.shape)
