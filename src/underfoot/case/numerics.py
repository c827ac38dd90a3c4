"""Section for grid, tolerance and limits of the computation."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from .quantity import Flag, Quantity, default
from .section import Section

_mm = 1e-3
Spacing = Annotated[float, Quantity("m", 5e-5, 0.005)]
Tolerance = Annotated[float, Quantity("1", 1e-10, 0.1)]


class Numerics(Section):
    """Grid and tolerance."""

    without_spread: ClassVar[str] = "a setting of the computation is exact"

    grid_spacing: Spacing = default(
        0.6 * _mm, "0.6 mm", "four cells in the narrowest channel of the report"
    )
    quick_grid_spacing: Spacing = default(1.0 * _mm, "1 mm", "for a first look")
    cells_along: Literal["auto", 1, 2, 4, 8, 16, 32] = default(
        "auto",
        "auto",
        "cells along the sliding in one spacing, beside rims and corners; 1 for square cells "
        "alone; auto: 8 under a sole without tread in a fluid, else 1",
    )
    seed: Annotated[int, Field(ge=0, le=2**31, strict=True)] = default(
        0, 0, "of the draws behind the intervals; the same seed gives the same numbers"
    )
    tolerance: Tolerance = default(1e-4, 1e-4, "relative imbalance of volume and load")
    grid_check: Flag = default(
        False,
        False,
        "one grid; true solves the quick one too, without lugs with 16 cells along the sliding "
        "beside rims and corners, and twice the steps in time, and puts the differences into the "
        "errors",
    )
    tread_positions: Annotated[int, Field(ge=1, le=64, strict=True)] = default(
        6, 6, "on the quick grid, every other one on the run's too; --quick: half; 1: as it lies"
    )
    most_memory: Annotated[float, Quantity("B", 2e8, 1e13)] = default(
        2e9, "2 GB", "a run that would take more is refused before it starts"
    )
