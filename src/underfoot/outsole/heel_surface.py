"""A parametric heel as a height map in its own frame."""

from __future__ import annotations

import math

import numpy as np

from ._checks import positive
from .heel_grid import cut_heel, plan_outline
from .shape import SoleShape
from .sole_surface import SoleSurface


def heel_surface(heel: SoleShape, *, spacing: float) -> SoleSurface:
    """Return the heel in its own frame on square cells of ``spacing`` (m).

    The cells begin at the rear end and are symmetric about the centre line. What ``heel_map`` makes
    of a heel at an angle, ``surface_map`` makes of this within the size of a cell.
    """
    positive(spacing, "spacing")
    count_x = math.ceil(heel.length / spacing - 1e-9)
    count_y = math.ceil(heel.width / spacing - 1e-9)
    x = (np.arange(count_x, dtype=np.float64) + 0.5) * spacing
    y = (np.arange(count_y, dtype=np.float64) - (count_y - 1) / 2) * spacing
    grid_x, grid_y = np.meshgrid(x, y, indexing="ij")
    inside = heel.inward_distance(grid_x, grid_y) > 0
    height, land, tread_depth = cut_heel(heel, grid_x, grid_y, spacing)
    land &= inside
    return SoleSurface(
        x=x,
        y=y,
        height=np.where(inside, height, np.nan),
        land=land,
        tread_depth=np.where(land, tread_depth, 0.0),
        spacing=float(spacing),
        outline=plan_outline(heel),
        name="parametric heel",
        base=np.where(inside, heel.land_height(grid_x, grid_y), np.nan),
    )
