"""A small picture of a sole: its land on its plan form, heel to the left, for lists."""

from __future__ import annotations

import numpy as np

from underfoot.case import Case
from underfoot.compute.sole import sole_map, sole_shape
from underfoot.core import content_hash, silent
from underfoot.core.arrays import Mask
from underfoot.core.cache import Cache

CELLS = 150
"""Cells along the sole, at least."""
LEAST = 0.4e-3
"""m: side of the smallest cells."""
PLAN, LAND = "#9aa7b473", "#3d6f92"
"""Colours that are seen on light and dark pages."""


def thumbnail(case: Case) -> str:
    """Return the SVG of a case's sole as it is worn; it is drawn once, then kept on disk.

    Raises:
        InputError, DataError: The sole of the case can't be made: its file is not there.
    """
    shape = case.shoe.outsole or sole_shape(case)
    cache, key = Cache("thumbnails"), content_hash(shape, case.shoe.wear)
    if (stored := cache.load(key)) is not None:
        return str(stored["svg"])
    svg = _draw_sole(case)
    cache.store(key, {"svg": svg})
    return svg


def _draw_sole(case: Case) -> str:
    sole = sole_map(case, case.numerics.quick_grid_spacing, silent)
    fine = max(LEAST, float(np.ptp((sole.whole or sole).x)) / CELLS)
    if fine < sole.spacing:
        sole = sole_map(case, fine, silent)
    sole = sole.whole or sole
    across = np.flatnonzero(sole.inside.any(axis=0))
    along = np.flatnonzero(sole.inside.any(axis=1))
    place = slice(along[0], along[-1] + 1), slice(across[0], across[-1] + 1)
    inside, land = (each[place][:, ::-1].T for each in (sole.inside, sole.land & sole.inside))
    high, wide = inside.shape
    paths = "".join(
        f'<path fill="{colour}" d="{_runs(mask)}"/>'
        for colour, mask in ((PLAN, inside), (LAND, land))
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" '
        f'width="{wide}" height="{high}">{paths}</svg>'
    )


def _runs(mask: Mask) -> str:
    """Return a mask as the data of a path: each run of cells in a row is a rectangle."""
    padded = np.pad(mask.astype(np.int8), ((0, 0), (1, 1)))
    rows, edges = np.nonzero(np.diff(padded, axis=1))
    pairs = zip(rows[::2], edges[::2], edges[1::2], strict=True)
    return "".join(f"M{a} {row}h{b - a}v1H{a}z" for row, a, b in pairs)
