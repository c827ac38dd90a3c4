"""Section of a case for an outsole from a file (STEP, STL, OBJ, PLY)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from .quantity import Quantity, default
from .sections_base import Length, Section

Direction = Literal["auto", "flip", "+x", "-x", "+y", "-y", "+z", "-z"]
_mm = 1e-3
_FOUND = "found from the file; underfoot check tells what and how"


class OutsoleFile(Section):
    """Outsole from a file in place of heel and tread; ``underfoot outsole inspect`` reads one."""

    file: str | None = Field(
        default=None,
        description="STEP, STL, OBJ or PLY; the path counts from the case file's folder",
    )
    sha256: str | None = Field(
        default=None, description="checksum of the file that is meant; another file is refused"
    )
    unit: Literal["auto", "mm", "cm", "m", "inch"] = default("auto", "auto", _FOUND)
    down: Direction = default("auto", "auto", _FOUND)
    forward: Direction = default("auto", "auto", _FOUND)
    foot: Literal["auto", "left", "right"] = default("auto", "auto", _FOUND)
    mirror: Annotated[bool, Field(strict=True)] = default(
        False, False, "the shoe that the file shows, not the other of the pair"
    )
    region: Literal["whole", "heel", "forepart"] = default(
        "whole", "whole", "all of the file; the part far from the floor is trimmed"
    )
    region_length: Length | None = Field(
        default=None, description="of the region; default: rear 30 %, front 45 % of a whole sole"
    )
    map_spacing: Annotated[float, Quantity("m", 2e-5, 0.002)] = default(
        0.25 * _mm, "0.25 mm", "of the height map, finer than the grid of the solver"
    )
    reach: Length = default(
        12 * _mm, "12 mm", "parts of the tilted sole higher above the floor are trimmed off"
    )
