"""Tread: lugs, channels and sipes in the frame of the sole.

Sipes are slits in the lugs, too narrow to drain much; they let a lug bend and open its edges.
"""

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from underfoot.core import InputError, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.checks import between, not_negative, positive
from underfoot.core.deprecation import renamed_member
from underfoot.core.remark import Message

from ._kernels import tread_pattern
from .lettering import Lettering

FURTHER_LENGTHS: dict[str, tuple[str, ...]] = {
    "blocks": ("lug_length",),
    "chevrons": ("arm_length",),
    "waves": ("wave_length", "wave_height"),
    "rings": ("ring_width",),
    "graded_circles": ("front_lug_width", "graded_length"),
}
"""What some patterns need beyond the widths of lug and channel, the depth and the angle."""
PATTERNS = [
    "grid",
    "transverse",
    "longitudinal",
    "bars",
    "circles",
    "hexagons",
    *FURTHER_LENGTHS,
    "lettering",
]
LATTICES = ("circles", "hexagons", "rings", "graded_circles")
"""Patterns in a triangular lattice, its rows along the shoe."""


@dataclass(frozen=True, slots=True)
class Sipes:
    """Parallel slits through all lugs.

    Parameters:
        width, depth: Of a slit, m; the depth at most that of the tread.
        spacing: Between the middles of two slits, m.
        angle: Of the slits against the transverse direction, rad, anticlockwise seen from above.
        offset: Distance of the first slit's middle from the rear end at angle 0, m, before the
            pattern is shifted; by default half the spacing.
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
                Message(
                    "slits of {width:g} mm every {spacing:g} mm leave no lug",
                    width=self.width * 1000.0,
                    spacing=self.spacing * 1000.0,
                ),
                where="sipes.width",
                allowed=Message(
                    "below {spacing:g} mm (half of sipes.spacing)", spacing=self.spacing / 0.002
                ),
            )

    def channel_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) into a slit: positive in it, negative beside it."""
        first = self.spacing / 2 if self.offset is None else self.offset
        across, _ = tread_pattern.rotate_coordinates(x, y, self.angle)
        place = np.mod(across - first + self.spacing / 2, self.spacing) - self.spacing / 2
        return self.width / 2 - np.abs(place)


@dataclass(frozen=True, slots=True)
class Groove:
    """One straight groove through the lugs, as deep as the channels.

    Parameters:
        place: Of its middle (x, y) in the frame of the sole, m.
        width: m.
        length: m; right across the sole where nothing is said.
        angle: Against the transverse direction, rad, anticlockwise seen from above.
    """

    place: tuple[float, float]
    width: float
    length: float = math.inf
    angle: float = 0.0

    def __post_init__(self) -> None:
        positive(self.width, "groove.width")
        if not self.length > 0:
            raise InputError(
                Message("{length} m is no length", length=self.length), where="groove.length"
            )

    def channel_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) into the groove: positive in it, negative beside it."""
        across, along = tread_pattern.rotate_coordinates(
            x - self.place[0], y - self.place[1], self.angle
        )
        aside, ahead = np.abs(across) - self.width / 2, np.abs(along) - self.length / 2
        beyond = np.hypot(np.maximum(aside, 0.0), np.maximum(ahead, 0.0))
        return -beyond - np.minimum(np.maximum(aside, ahead), 0.0)


@dataclass(frozen=True, slots=True)
class Tread:
    """Lugs of one kind between channels of one width.

    Parameters:
        pattern: "grid" (square lugs), "blocks" (rectangular lugs), "transverse" (channels across
            the shoe), "longitudinal" (channels along it), "bars" (straight channels, across the
            shoe at angle 0), "chevrons" (zigzag bars, tips forward), "waves" (waving bars, crests
            forward), "circles", "hexagons", "rings" (round with a closed hollow) and
            "graded_circles" (larger or smaller along the shoe), all in triangular lattices;
            "lettering" (the letters of one line of text, repeated).
        lug_width, channel_width: m; of bars and chevrons normal to their walls, the diameter of
            circles and rings (outer), the width across flats of hexagons, of waves along the shoe;
            of lettering the height of its capitals; the channel where it is narrowest.
        depth: Height of the lugs, m; 0 is an untreaded sole.
        edge_radius: Rounding of the lower edges of the lugs, m.
        edge_chamfer: Width of a chamfer of 45 degrees there instead, m.
        offset: Shift (x, y) of the pattern with its sipes, m. At (0, 0) the first lug begins at the
            rear end of the sole and a lug is centred on the centre line.
        angle: Turns the pattern as a whole, rad, anticlockwise seen from above; for chevrons it is
            the angle of the arms against the transverse direction instead.
        lug_length: Of "blocks" along the shoe, m.
        arm_length: Of "chevrons": extent of one arm across the shoe, m.
        wave_length, wave_height: Of "waves": across the shoe, and from trough to crest, m.
        ring_width: Of "rings": thickness of their wall, m.
        front_lug_width, graded_length: Of "graded_circles": the diameter at ``graded_length`` (m)
            from the first lug, and beyond; ``lug_width`` is that of the first.
        letters: Of "lettering".
        sipes: Fine slits in the lugs.
        grooves: Where the sole lies as made; shifted with the pattern, whose lugs they part.
        yaw, pivot: Turn all of it as it lies, rad, anticlockwise seen from above, about a place
            (x, y), m.
    """

    pattern: str
    lug_width: float
    channel_width: float
    depth: float
    edge_radius: float = 0.0
    offset: tuple[float, float] = (0.0, 0.0)
    angle: float = 0.0
    lug_length: float | None = None
    arm_length: float | None = None
    wave_length: float | None = None
    wave_height: float | None = None
    ring_width: float | None = None
    front_lug_width: float | None = None
    graded_length: float | None = None
    letters: Lettering | None = None
    edge_chamfer: float = 0.0
    sipes: Sipes | None = None
    grooves: tuple[Groove, ...] = ()
    yaw: float = 0.0
    pivot: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        if self.pattern not in PATTERNS:
            raise unknown_name("tread pattern", self.pattern, PATTERNS, where="tread.pattern")
        positive(self.lug_width, "tread.lug_width")
        positive(self.channel_width, "tread.channel_width")
        not_negative(self.depth, "tread.depth")
        not_negative(self.edge_radius, "tread.edge_radius")
        needed = (
            *FURTHER_LENGTHS.get(self.pattern, ()),
            *["letters"][: self.pattern == "lettering"],
        )
        lengths = [each for names in FURTHER_LENGTHS.values() for each in names]
        for name in (*lengths, "letters"):
            value = getattr(self, name)
            if (value is None) == (name in needed):
                what = Message("is not used for {pattern}", pattern=self.pattern)
                if value is None:
                    what = Message("is missing for {pattern}", pattern=self.pattern)
                raise InputError(what, where=f"tread.{name}")
            if value is not None and name in lengths:
                positive(value, f"tread.{name}")
        most = math.radians(75 if self.pattern == "chevrons" else 180)
        between(
            self.angle,
            -most,
            most,
            "tread.angle",
            Message("at most {degrees:g} deg", degrees=math.degrees(most)),
        )
        if self.ring_width is not None and self.ring_width >= self.lug_width / 2:
            raise InputError(
                Message(
                    "a wall of {ring_width:g} mm leaves no hollow",
                    ring_width=self.ring_width * 1000.0,
                ),
                where="tread.ring_width",
                allowed=Message(
                    "below {lug_width:g} mm (half of tread.lug_width)",
                    lug_width=self.lug_width / 0.002,
                ),
            )
        not_negative(self.edge_chamfer, "tread.edge_chamfer")
        if self.edge_radius > 0 and self.edge_chamfer > 0:
            raise InputError("both a radius and a chamfer", where="tread.edge_chamfer")
        rounding = min(self.depth, self.smallest_lug / 2)
        for name in ("edge_radius", "edge_chamfer"):
            size = getattr(self, name)
            if self.depth > 0 and size > rounding:
                raise InputError(
                    Message(
                        "{name} {size:g} mm doesn't fit on the lug",
                        name=name.replace("_", " "),
                        size=size * 1000.0,
                    ),
                    where=f"tread.{name}",
                    allowed=Message(
                        "at most {rounding:g} mm (the depth and half the lug width)",
                        rounding=rounding * 1000.0,
                    ),
                )
        if self.sipes is not None and self.sipes.depth > self.depth * (1 + 1e-9) > 0:
            raise InputError(
                Message(
                    "sipes of {depth:g} mm are deeper than the tread",
                    depth=self.sipes.depth * 1000.0,
                ),
                where="sipes.depth",
                allowed=Message("at most {depth:g} mm (tread.depth)", depth=self.depth * 1000.0),
            )

    @property
    def smallest_lug(self) -> float:
        """Smallest side of a lug, m; of letters the stroke of the thinnest."""
        if self.letters is not None:
            return self.letters.stroke
        sides = (self.lug_length, self.ring_width, self.front_lug_width)
        return min([self.lug_width, *(side for side in sides if side is not None)])

    @property
    def pitch(self) -> float:
        """Lug and channel together, m; of graded lugs the larger ones."""
        return max(self.lug_width, self.front_lug_width or 0.0) + self.channel_width

    @property
    def land_ratio(self) -> float:
        """Share of an endless tread that is lug, sipes and grooves left aside.

        w / (w + c) = s for bars and waves, s^2 for a grid and hexagons, the product of both
        directions for blocks, pi / (2 sqrt 3) s^2 for circles, less the hollow for rings, and with
        the mean of w^2 over the graded length for graded circles; of lettering the area of its
        outlines in that of a period.
        """
        if self.letters is not None:
            return self.letters.area / float(np.prod(self.letters.pitch))
        share = self.lug_width / (self.lug_width + self.channel_width)
        if self.pattern == "blocks" and self.lug_length is not None:
            return share * self.lug_length / (self.lug_length + self.channel_width)
        disc = math.pi / (2 * math.sqrt(3.0)) / self.pitch**2
        if self.pattern == "circles":
            return disc * self.lug_width**2
        if self.ring_width is not None:
            return disc * (self.lug_width**2 - (self.lug_width - 2 * self.ring_width) ** 2)
        if self.front_lug_width is not None:
            first, last = self.lug_width, self.front_lug_width
            return disc * (first**2 + first * last + last**2) / 3
        return share**2 if self.pattern in ("grid", "hexagons") else share

    @property
    def periods(self) -> Array:
        """Shifts (x, y), one row each, m, that map the endless pattern onto itself."""
        pitch = self.pitch
        if self.pattern == "chevrons" and self.arm_length is not None:
            return np.array([[pitch / math.cos(self.angle), 0.0], [0.0, 2 * self.arm_length]])
        if self.letters is not None:
            frame = np.diag(self.letters.pitch)
            return np.column_stack(
                tread_pattern.rotate_coordinates(frame[:, 0], frame[:, 1], -self.angle)
            )
        along = [(self.lug_length or self.lug_width) + self.channel_width, 0.0]
        across = [0.0, self.wave_length or pitch]
        if self.pattern in LATTICES:
            across = [pitch / 2, pitch * math.sqrt(3.0) / 2]
        rows = {
            "transverse": [along],
            "bars": [along],
            "longitudinal": [across],
            "graded_circles": [[0.0, pitch * math.sqrt(3.0)]],
        }
        frame = np.array(rows.get(self.pattern, [along, across]))
        return np.column_stack(
            tread_pattern.rotate_coordinates(frame[:, 0], frame[:, 1], -self.angle)
        )

    @property
    def wall_line(self) -> tuple[Array, Array] | None:
        """(y, x) of half a period of the walls of folded bars, m; None for other patterns."""
        if self.arm_length is not None:
            return tread_pattern.zigzag_line(self.arm_length, self.angle)
        if self.wave_length is not None and self.wave_height is not None:
            return tread_pattern.wave_line(self.wave_length, self.wave_height)
        return None

    def shift_grooves(self, shift: tuple[float, float]) -> Self:
        """Return the pattern with its grooves shifted by (x, y), m."""

        def new(place: tuple[float, float]) -> tuple[float, float]:
            return place[0] + shift[0], place[1] + shift[1]

        grooves = tuple(replace(groove, place=new(groove.place)) for groove in self.grooves)
        return replace(self, offset=new(self.offset), grooves=grooves)

    moved = renamed_member("moved", "shift_grooves", gone="0.4")

    def _before_yaw(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Return where places (m) of the turned tread lie in the one that was not turned."""
        if not self.yaw:
            return x, y
        ahead, aside = self.pivot
        along, across = tread_pattern.rotate_coordinates(x - ahead, y - aside, self.yaw)
        return along + ahead, across + aside

    def slit_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) into the sipes, positive in one."""
        assert self.sipes is not None
        x, y = self._before_yaw(x, y)
        return self.sipes.channel_distance(x - self.offset[0], y - self.offset[1])

    def channel_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) into the channels: positive in a channel, negative on a lug.

        On a lug the value is minus the distance to its nearest edge.
        """
        x, y = self._before_yaw(x, y)
        grooves = (groove.channel_distance(x, y) for groove in self.grooves)
        return np.maximum.reduce([self._pattern_distance(x, y), *grooves])

    def _pattern_distance(self, x: Array, y: Array) -> Array:
        lug, channel = self.lug_width, self.channel_width
        x, y = x - self.offset[0], y - self.offset[1]
        line = self.wall_line
        if self.pattern == "chevrons" and line is not None:
            stretch = 1 / math.cos(self.angle)
            return tread_pattern.folded_bar_distance(x, y, line, lug * stretch, channel * stretch)
        x, y = tread_pattern.rotate_coordinates(x, y, self.angle)
        if line is not None:
            return tread_pattern.folded_bar_distance(x, y, line, lug, channel)
        if self.letters is not None:
            return self.letters.channel_distance(x, y)
        if self.ring_width is not None:
            return tread_pattern.ring_distance(x - lug / 2, y, lug, channel, self.ring_width)
        if self.front_lug_width is not None and self.graded_length is not None:
            both = (lug, self.front_lug_width)
            length = self.graded_length
            return tread_pattern.graded_circle_distance(x - lug / 2, y, both, channel, length)
        if self.pattern == "blocks" and self.lug_length is not None:
            lugs = (self.lug_length, lug)
            return tread_pattern.block_distance(x, y + lug / 2, lugs, (channel, channel))
        if self.pattern == "circles":
            return tread_pattern.circle_distance(x - lug / 2, y, lug, channel)
        if self.pattern == "hexagons":
            return tread_pattern.hexagon_distance(x - lug / 2, y, lug, channel)
        distances = []
        if self.pattern in ("grid", "transverse", "bars"):
            distances.append(tread_pattern.bar_distance(x, lug, channel))
        if self.pattern in ("grid", "longitudinal"):
            if self.offset[1] == 0.0 and self.angle == 0.0:
                y = np.abs(y)  # exactly the same on both sides
            distances.append(tread_pattern.bar_distance(y + lug / 2, lug, channel))
        return np.maximum.reduce(distances)


@dataclass(frozen=True, slots=True)
class ArcChannel:
    """One channel that follows the rounded rear of the heel.

    Parameters:
        position: Distance of the channel's middle from the rear end, on the centre line, m.
        radius: Radius of the channel's middle line, m; its centre lies at position + radius.
        width, depth: Of the channel, m.
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
                Message("width {width:g} mm is too large for its place", width=self.width * 1000.0),
                where="arc_channel.width",
                allowed=Message(
                    "below {position:g} mm (twice the smaller of position and radius)",
                    position=2000.0 * min(self.position, self.radius),
                ),
            )

    def channel_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) into the channel: positive in it, negative beside it."""
        along = x - (self.position + self.radius)
        into = self.width / 2 - np.abs(np.hypot(along, y) - self.radius)
        ahead = -np.hypot(along, np.maximum(np.abs(np.abs(y) - self.radius) - self.width / 2, 0.0))
        return np.where(along < 0, into, np.minimum(into, ahead))
