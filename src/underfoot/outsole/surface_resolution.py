"""Whether a grid resolves the channels and lugs of a sole known by its heights."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from underfoot.core import Breach, InputError, Range, breaches

from ._kernels.local_width import local_width
from .heel_grid import CELLS_REFUSED, CELLS_WANTED

if TYPE_CHECKING:
    from .sole_surface import SoleSurface

HALF, NARROW = 50.0, 10.0
"""Percentiles of the local width by area: what is refused, and what is listed."""


def resolution_breaches(surface: SoleSurface, spacing: float) -> list[Breach]:
    """Return what a grid of ``spacing`` (m) resolves with too few cells.

    By local width (the largest disc that covers a place), because a sole has no single channel
    width: listed when more than a tenth of the area of channels or of lugs is narrower than 4
    cells.

    Errors
    ------
    InputError
        More than half of the channels' or of the lugs' area is narrower than 2 cells.
    """
    channel = surface.inside & ~surface.land
    if not channel.any():
        return []
    found: list[Breach] = []
    tested = Range(CELLS_WANTED, math.inf, "1", "grid refinement of the tread")
    for name, mask in (("channel", channel), ("lug", surface.land)):
        widths = local_width(mask, surface.spacing)[mask]
        narrow, half = (float(value) for value in np.percentile(widths, (NARROW, HALF)))
        # the width itself is known within half a cell of the height map
        if half + surface.spacing / 2 < CELLS_REFUSED * spacing * (1 - 1e-9):
            raise InputError(
                f"half of the {name} area of {surface.name} is narrower than {half * 1e3:.2g} mm, "
                f"{half / spacing:.2g} cells of {spacing * 1e3:g} mm",
                where="grid.spacing",
                allowed=f"at least {CELLS_REFUSED:g} cells, {CELLS_WANTED:g} for a result to trust",
                remedy=f"Use a grid spacing of {half / CELLS_WANTED * 1e3:.2g} mm or less",
            )
        cells = (narrow + surface.spacing / 2) / spacing
        quantity = f"cells across the narrowest tenth of the {name}s"
        found += breaches("grid", {quantity: tested}, {quantity: cells})
    return found
