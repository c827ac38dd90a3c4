"""Options for reading an outsole file; "auto" leaves an option to be determined."""

import math
from dataclasses import dataclass

from underfoot.core import InputError, unknown_name

UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 0.0254}
"""Units of length a file may be in, m."""
DIRECTIONS = ("+x", "-x", "+y", "-y", "+z", "-z")
"""Directions in the frame of the file."""
REGIONS = ("whole", "heel", "forepart")
FEET = ("left", "right")
SHARES = {"whole": 1.0, "heel": 0.30, "forepart": 0.45}
"""Share of the length of a whole sole that a region takes, from its own end."""


@dataclass(frozen=True, slots=True)
class FileSettings:
    """How to read an outsole file.

    Parameters:
        unit: "mm", "cm", "m", "inch", or "auto": the one that makes the length that of a sole.
        down: Where the ground is, in the file's axes ("-z", ...); "auto" finds it by the tread,
            "flip" takes the opposite side.
        forward: Where the toe is ("+x", ...); "auto" or "flip".
        foot: Which foot the file shows, "left" or "right"; "auto" finds it by the bend of the sole.
        mirror: Take the other shoe of the pair.
        region: "whole", "heel" (rear 30 % of a whole sole) or "forepart" (front 45 %).
        region_length: Length of the region, m; None for these shares.
        spacing: Of the height map, m.
    """

    unit: str = "auto"
    down: str = "auto"
    forward: str = "auto"
    foot: str = "auto"
    mirror: bool = False
    region: str = "whole"
    region_length: float | None = None
    spacing: float = 0.25e-3

    def __post_init__(self) -> None:
        allowed = {
            "unit": ("auto", *UNITS),
            "down": ("auto", "flip", *DIRECTIONS),
            "forward": ("auto", "flip", *DIRECTIONS),
            "foot": ("auto", *FEET),
            "region": REGIONS,
        }
        for name, known in allowed.items():
            if getattr(self, name) not in known:
                raise unknown_name(name, str(getattr(self, name)), known, where=f"outsole.{name}")
        if (
            self.down in DIRECTIONS
            and self.forward in DIRECTIONS
            and self.down[1] == self.forward[1]
        ):
            raise InputError(
                f"down {self.down} and forward {self.forward} lie on one axis",
                where="outsole.forward",
                allowed="two different axes of the file",
            )
        for name in ("spacing", "region_length"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value > 0):
                raise InputError(
                    f"{value:g} is not positive", where=f"outsole.{name}", allowed="above 0"
                )
        if self.spacing < 2e-5:
            raise InputError(
                f"{self.spacing * 1e3:g} mm is finer than any tread",
                where="outsole.spacing",
                allowed="0.02 mm or more",
            )
