"""Sections of a case for what the foot does and for the sensors in the floor."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field

from .quantity import Quantity, default
from .sections_base import Force, Length, Section

_TESTER = "final progress report on shoe-floor friction, G.4.1"
_mm, _um = 1e-3, 1e-6
ShoeAngle = Annotated[float, Quantity("rad", math.radians(-30), math.radians(60))]
Speed = Annotated[float, Quantity("m/s", 0.0, 20.0, open_low=True)]
Time = Annotated[float, Quantity("s", 0.0, 60.0, open_low=True)]
Instant = Annotated[float, Quantity("s", 0.0, 60.0)]
AnySpeed = Annotated[float, Quantity("m/s", -20.0, 20.0)]
AnyForce = Annotated[float, Quantity("N", 0.0, 1e4)]
Count = Annotated[int, Field(ge=1, le=200, strict=True)]


class MotionPoint(Section):
    """One instant of a history; straight lines lead from one to the next."""

    time: Instant
    normal_force: AnyForce
    speed: AnySpeed = Field(description="of the shoe, forward positive")
    shoe_angle: ShoeAngle | None = Field(
        default=None, description="toe up positive; default: motion.shoe_angle"
    )


class Motion(Section):
    """How the heel meets the floor: one load and speed held, or a history of them."""

    speed: Speed
    normal_force: Force
    shoe_angle: ShoeAngle = Field(description="toe up positive")
    force_rise_time: Time = default(0.03, "30 ms", _TESTER)
    duration: Time = default(0.12, "0.12 s", "90 ms of sliding under full load", assumed=True)
    start_film: Annotated[float, Quantity("m", 1e-6, 0.01)] = default(
        50 * _um, "50 um", "lowest point above the floor when loading starts", assumed=True
    )
    steady: Annotated[bool, Field(strict=True)] = default(
        False, False, "the result is taken at the end of the duration"
    )
    history: str | None = Field(
        default=None,
        description="file (CSV, XLSX) with columns time, normal_force, speed and, where it turns, "
        "shoe_angle; the path counts from the case file's folder. The result is its last instant",
    )
    history_points: tuple[MotionPoint, ...] | None = Field(
        default=None, description="the same points written in the case"
    )


class Sensor(Section):
    """Fluid-pressure sensors in the floor: the scans of one, and an array that stays in place."""

    inlet_diameter: Length = default(10 * _mm, "10 mm", _TESTER)
    scan_spacing: Length = default(10 * _mm, "10 mm", _TESTER)
    scans: Count = default(7, 7, _TESTER)
    rows: Count | None = Field(
        default=None, description="of the array, along the walking direction (G.5.1: 3)"
    )
    columns: Count | None = Field(default=None, description="of the array, across (G.5.1: 3)")
    array_spacing: Length | None = Field(
        default=None, description="between rows and between columns (G.5.1: 30 mm)"
    )
    array_inlet_diameter: Length | None = Field(
        default=None, description="of the array's sensors (G.5.1: 4 mm)"
    )
    array_position: Annotated[float, Quantity("m", -5.0, 5.0)] | None = Field(
        default=None,
        description="of the first row, ahead of the shoe's rear end at time 0; default: the shoe "
        "has the array under its middle at the end",
    )
