"""Sections of a case for tread and wear."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field

from .quantity import Quantity, default
from .sections_base import Angle, Depth, Force, Length, Rounding, Section, WearAngle

Turn = Annotated[float, Quantity("rad", -math.pi, math.pi)]
Place = Annotated[float, Quantity("m", -0.2, 0.2)]
Taper = Annotated[float, Quantity("rad", math.radians(0.5), math.radians(60))]
WearRate = Annotated[float, Quantity("m^2/N", 1e-20, 1e-6)]


class ArcChannel(Section):
    """One channel that follows the rounded rear of the heel."""

    width: Length
    depth: Depth
    position: Length = Field(description="from the rear end, on the centre line")
    radius: Length = Field(description="of the channel's middle line")


class Sipes(Section):
    """Parallel slits in all lugs."""

    width: Length
    depth: Depth = Field(description="at most the depth of the tread")
    spacing: Length = Field(description="between the middles of two slits")
    angle: Turn = default(0.0, "0 deg", "across the shoe")


class Tread(Section):
    """Lugs of one pattern between channels of one width; sipes and an arc channel may be added."""

    pattern: Literal[
        "none",
        "grid",
        "transverse",
        "longitudinal",
        "blocks",
        "bars",
        "chevrons",
        "circles",
        "hexagons",
    ]
    depth: Depth | None = None
    lug_width: Length | None = Field(
        default=None,
        description="normal to the walls; of circles their diameter, of hexagons flats",
    )
    lug_length: Length | None = Field(default=None, description="blocks: along the shoe")
    channel_width: Length | None = None
    arm_length: Length | None = Field(
        default=None, description="chevrons: one arm, measured across the shoe"
    )
    angle: Turn = default(
        0.0, "0 deg", "turns the pattern; chevrons: of the arms against the transverse direction"
    )
    edge_radius: Rounding = default(0.0, "0 mm", "sharp lug edges", assumed=True)
    sipes: Sipes | None = None
    arc_channel: ArcChannel | None = None


class Wear(Section):
    """Wear: a plane cut, a patch of given size, or pressure times sliding step by step."""

    mode: Literal["plane", "patch", "archard"] = default("plane", "plane", "ground at one angle")
    depth: Depth = default(0.0, "0 mm", "unworn beyond the heel shape given")
    angle: WearAngle = default(0.0, "0 deg", "even wear")
    angle_range: Angle = default(
        math.radians(10),
        "10 deg",
        "archard: the shoe wears at three angles of early stance; their span",
        assumed=True,
    )
    normal_force: Force | None = Field(
        default=None, description="archard: while wearing; default motion.normal_force"
    )
    wear_rate: WearRate = default(
        3.75e-10,
        "0.375 mm^3/(N*m)",
        "archard: 150 mm^3 lost on the abrasive sheet of ISO 4649 (10 N, 40 m), the limit for good "
        "soles; floors are far gentler, and only the sliding distance depends on it",
        assumed=True,
    )
    patch_form: Literal["ellipse", "rectangle"] = default("ellipse", "ellipse", "patch")
    patch_length: Length | None = Field(default=None, description="patch: along the shoe")
    patch_width: Length | None = Field(default=None, description="patch: across the shoe")
    patch_position: Length | None = Field(
        default=None, description="patch: its middle from the rear end; default: it begins there"
    )
    patch_lateral: Place = default(0.0, "0 mm", "patch: its middle on the centre line")
    patch_taper: Taper = default(
        math.radians(3), "3 deg", "patch: slope of the wear around it", assumed=True
    )
