"""A sole divided into cells in rows: square ones, finer along the sliding beside rims and corners.

A square cell is divided into up to ``SoleMap.columns`` cells along x: their width halves as a rim
or a corner comes near.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from underfoot.core import InputError
from underfoot.core.arrays import Array, Mask

from .cut_cells import CutCells
from .geometry import SoleMap
from .row_cells import Indices, RowCells

GRADING = 2.0
"""A cell is this many of its widths away from a rim or corner, at least."""
BESIDE = 0.25
"""Spacings by which a rim in the next row counts as farther away than one in the same row."""
BEND = 0.02
"""Change of the sole's slope from one finest cell to the next that counts as a corner: a rounding
of 3 mm."""
STRAIGHT = 0.1
"""Share of the turn at a corner by which the lines on both sides of it may bend."""
FLAT = 1e-9
"""Change of slope below which two lines are one."""


def row_cells(sole: SoleMap, fine: SoleMap | None = None) -> RowCells:
    """Return the cells of a sole.

    Parameters:
        sole: On square cells, whole or a part of a map.
        fine: The whole of the same sole with ``columns`` cells along x in each spacing; None: its
            square cells.

    Raises:
        InputError: Sipes finer than the cells, which square cells alone know.
    """
    if fine is None:
        fine = sole
    elif fine.slits is not None:
        raise InputError(
            "sipes finer than the grid are computed on square cells",
            where="numerics.cells_along",
            allowed="1",
        )
    else:
        fine = _part_under(sole, fine)
    columns = fine.columns
    nx, ny = fine.clearance.shape
    land = fine.land & fine.inside
    number, first, width, row = _blocks(land, _distance(fine, land, columns), columns)
    clearance = np.where(fine.inside, fine.clearance, np.inf)
    height = 0.5 * (clearance[first + (width - 1) // 2, row] + clearance[first + width // 2, row])
    cut = fine.cut or CutCells.none(clearance.shape)
    areas = {
        name: np.bincount(number.ravel(), getattr(cut, name).ravel(), first.size) / columns
        for name in ("area", "film_area")
    }
    return RowCells(
        shape=(nx // columns, ny),
        spacing=fine.spacing,
        parent=np.ravel_multi_index((first // columns, row), (nx // columns, ny)),
        width=width / columns,
        offset=(first % columns + 0.5 * width) / columns - 0.5,
        clearance=height,
        land=land[first, row],
        **areas,
        **_faces_along(fine, land, clearance, (first, width, row), height),
        **_faces_across(cut.across, number, columns),
    )


def _part_under(sole: SoleMap, fine: SoleMap) -> SoleMap:
    """Return the part of a fine map that the square cells of a sole cover."""
    columns = fine.columns
    i = round(columns * (sole.x[0] - fine.x[0]) / fine.spacing - 0.5 * (columns - 1))
    j = round((sole.y[0] - fine.y[0]) / fine.spacing)
    part = slice(i, i + columns * sole.x.size), slice(j, j + sole.y.size)
    names = ("clearance", "inside", "land", "tread_depth")
    return replace(
        fine,
        x=fine.x[part[0]],
        y=fine.y[part[1]],
        cut=fine.cut and fine.cut.part(part),
        removed=None,
        **{name: getattr(fine, name)[part] for name in names},
    )


def _distance(fine: SoleMap, land: Mask, columns: int) -> Array:
    """Return how many finest cells lie between each and the next rim or corner, (nx, ny)."""
    clearance = np.where(fine.inside, fine.clearance, np.nan)
    step = fine.spacing / columns
    bend = np.zeros(land.shape, dtype=bool)
    with np.errstate(invalid="ignore"):  # nothing counts as a corner outside the sole
        slope = np.diff(clearance, axis=0) / step
        bend[1:-1] = np.abs(np.diff(slope, axis=0)) > BEND
    bend[1:-1] &= land[:-2] & land[1:-1] & land[2:]
    rim = land[1:] != land[:-1]
    marked = bend.copy()
    marked[1:] |= rim
    marked[:-1] |= rim
    places = np.arange(land.shape[0], dtype=float)[:, None]
    far = 10.0 * land.shape[0]
    behind = np.maximum.accumulate(np.where(marked, places, -far), axis=0)
    ahead = np.minimum.accumulate(np.where(marked, places, 2 * far)[::-1], axis=0)[::-1]
    distance = np.minimum(places - behind, ahead - places)
    beside = distance + BESIDE * columns
    result = distance.copy()
    result[:, 1:] = np.minimum(result[:, 1:], beside[:, :-1])
    result[:, :-1] = np.minimum(result[:, :-1], beside[:, 1:])
    return result


def _blocks(land: Mask, distance: Array, columns: int) -> tuple[Indices, Indices, Indices, Indices]:
    """Return the number of the block of each finest cell, and first cell, width, row of each."""
    nx, ny = land.shape
    width_of = np.zeros(land.shape, dtype=np.intp)
    width = columns
    while width:
        blocks = (nx // width, width, ny)
        parts = land.reshape(blocks)
        alike = parts.all(axis=1) | ~parts.any(axis=1)
        room = distance.reshape(blocks).min(axis=1) >= GRADING * width
        free = (width_of.reshape(blocks) == 0).all(axis=1)
        taken = free & ((alike & (room | ~parts.any(axis=1))) if width > 1 else True)
        width_of[np.repeat(taken, width, axis=0)] = width
        width //= 2
    place = np.broadcast_to(np.arange(nx)[:, None], land.shape)
    starts = (place % np.maximum(width_of, 1)) == 0
    number = (np.cumsum(starts.T.ravel()) - 1).reshape(ny, nx).T
    row, first = np.nonzero(starts.T)
    return number, first, width_of[first, row], row


def _faces_along(
    fine: SoleMap,
    land: Mask,
    clearance: Array,
    blocks: tuple[Indices, Indices, Indices],
    height: Array,
) -> dict[str, Any]:
    """Return the x faces of blocks: cells, way, node and rise."""
    first, width, row = blocks
    columns = fine.columns
    west = np.flatnonzero(row[1:] == row[:-1])
    east = west + 1
    border = first[east]  # the finest cell east of the face
    at = row[west]
    last = clearance.shape[0] - 1
    centre = first + 0.5 * width  # in finest cells
    way = centre[east] - centre[west]
    # heights and slopes of the finest cells next to the face, where these belong to one surface
    near = [np.clip(border + k, 0, last) for k in (-3, -2, -1, 0, 1, 2)]
    values = [clearance[k, at] for k in near]
    status = [land[k, at] for k in near]
    outside = [~fine.inside[k, at] for k in near]
    with np.errstate(invalid="ignore"):

        def slope_on(neighbour: int, cell: int) -> Array:  # per finest cell, beside ``cell``
            smooth = (status[neighbour] == status[cell]) & ~outside[neighbour] & ~outside[cell]
            return np.where(smooth, (values[cell] - values[neighbour]) / (cell - neighbour), 0.0)

        left, right = slope_on(1, 2), slope_on(4, 3)
        # a corner lies between the two cells where both sides go on straight; next to them it
        # bends one slope alone, and the sole between them is the straight line
        turn = right - left
        straight = np.abs(slope_on(0, 1) - left) <= STRAIGHT * np.abs(turn)
        straight &= np.abs(slope_on(5, 4) - right) <= STRAIGHT * np.abs(turn)
        bent = straight & (np.abs(turn) > FLAT)
        same = (status[2] == status[3]) & (outside[2] == outside[3])
        to_border = border - centre[west]
        # where the line of the west meets that of the east, in finest cells from the west's centre
        from_west = values[2] + left * 0.5 - left * to_border  # at the west's centre
        from_east = values[3] - right * 0.5 + right * (way - to_border)  # at the east's centre
        meet = (from_west - from_east + right * way) / np.where(bent, turn, np.inf)
        bent &= (meet > 0) & (meet < way)
        meet = np.where(bent, meet, to_border)
        along = np.full(border.shape, 0.5) if fine.cut is None else fine.cut.along[near[2], at]
        rim = border - 0.5 + along - centre[west]
        node = np.where(same & (columns > 1), meet, rim)
        share = node / way
        # square cells know the sole at their centres alone: two parts, each with its own gap
        lean = np.where(same & (columns > 1), share, np.array([[0.0], [1.0]]))
        line = np.where(lean < 1, (1 - lean) * height[west], 0.0)
        line += np.where(lean > 0, lean * height[east], 0.0)
        seen = np.stack(
            [
                values[2] + left * (0.5 + node - to_border),
                values[3] - right * (0.5 + to_border - node),
            ]
        )
        mean = 0.5 * (seen[0] + seen[1])
        rise = np.where(same & ~bent, 0.0, np.where(same, mean, seen) - line)
    rise = np.where(np.isfinite(rise) & (columns > 1), rise, 0.0)
    return {
        "west": west,
        "east": east,
        "distance": way / columns,
        "node": share,
        "lean": lean,
        "rise": rise,
    }


def _faces_across(across: Array, number: Indices, columns: int) -> dict[str, Any]:
    """Return the y faces between blocks of neighbouring rows: cells, overlap and crossing."""
    south, north = number[:, :-1].T.ravel(), number[:, 1:].T.ravel()
    begins = np.ones(south.size, dtype=bool)
    begins[1:] = (south[1:] != south[:-1]) | (north[1:] != north[:-1])
    starts = np.flatnonzero(begins)
    count = np.diff(np.append(starts, south.size))
    return {
        "south": south[starts],
        "north": north[starts],
        "overlap": count / columns,
        "crossing": np.add.reduceat(across[:, :-1].T.ravel(), starts) / count,
    }
