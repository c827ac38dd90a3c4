"""Square cells cut by the outlines of lugs: where edges lie, and the area of each cell.

A cell is land or channel as its centre is; its share of the neighbours' area follows the outline.
So the area of lugs is exact on any grid, and loads change smoothly with the width of a lug.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask

NEAREST = 0.01
"""Share of the way between centres that an edge keeps from either. An edge on the centre of a cell
makes its film as open as the channel's until a hair's breadth closes it: three times the Newton
steps, for 0.5 % of the load on the film."""
SAMPLES = 4
"""Samples along each side of a cell; between them the outline is a straight ramp."""
LEAST_AREA = 0.1
"""Cells: what a cell stands for at least, where a sliver of a height map leaves it less. The cells
around it give it, so that all areas together stay that of the map."""
_SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1))
_CORNERS = ((1, 1), (1, -1), (-1, 1), (-1, -1))
Cells = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class CutCells:
    """How the outlines of lugs cut the cells of a map; arrays (nx, ny).

    Attributes:
        along, across: Where an edge crosses the way from a cell's centre to its neighbour's at +x
            and at +y, as a share of that way; 0.5 where none does.
        area: What a cell stands for of its own kind (land or not), in cells. A land cell takes in
            what lies between its square and the outline, a channel cell what a lug leaves free.
        film_area: The same for the pressure of the fluid, which falls from a lug's last centre to
            that of the channel at the outline.
    """

    along: Array
    across: Array
    area: Array
    film_area: Array

    @classmethod
    def none(cls, shape: tuple[int, ...]) -> Self:
        """Return cells that nothing cuts."""
        half, one = np.full(shape, 0.5), np.ones(shape)
        return cls(half, half, one, one)

    def part(self, keep: tuple[slice, slice]) -> Self:
        """Return the cells of a part of the map."""
        names = ("along", "across", "area", "film_area")
        return replace(self, **{name: getattr(self, name)[keep] for name in names})


def cut_cells(
    level: Array, inside: Mask, level_at: Callable[[Cells, Cells, Array, Array], Array]
) -> CutCells:
    """Return the cells of a map as outlines cut them.

    Parameters:
        level: Signed distance (m) into a channel at the centres, (nx, ny): land where 0 or less.
        inside: The plan form. Its rim cuts no cell.
        level_at: Returns it near the cells (i, j), (n, 1), at offsets along x and y, (1, m), in
            shares of a cell.
    """
    cut = CutCells.none(level.shape)
    land = inside & (level <= 0)
    channel = inside & ~land
    cut = replace(cut, along=_crossing(level, inside, 0), across=_crossing(level, inside, 1))
    lug, groove = _pairs(land, channel)
    if lug.size == 0:
        return cut
    cells = np.unique(np.concatenate([lug, groove]))
    step = (np.arange(SAMPLES) + 0.5) / SAMPLES - 0.5
    offsets = [part.reshape(1, -1) for part in np.meshgrid(step, step, indexing="ij")]
    i, j = np.unravel_index(cells, level.shape)
    depth = -level_at(i[:, None], j[:, None], *offsets)  # into the lug, m
    spread = np.abs(np.diff(depth.reshape(-1, SAMPLES, SAMPLES), axis=1)).max(axis=(1, 2))
    spread = np.maximum(
        spread, np.abs(np.diff(depth.reshape(-1, SAMPLES, SAMPLES), axis=2)).max(axis=(1, 2))
    )
    covered = np.clip(0.5 + depth / np.maximum(spread[:, None], 1e-12), 0.0, 1.0)
    at_lug, at_groove = np.searchsorted(cells, lug), np.searchsorted(cells, groove)
    centre = np.maximum(-level.ravel()[lug], 1e-12)
    results = []
    for fluid in (False, True):
        # the fluid's pressure falls to that of the channel at the outline, contact's does not
        within, beyond = (
            covered[at] * (np.clip(depth[at] / centre[:, None], 0.0, 1.0) if fluid else 1.0)
            for at in (at_lug, at_groove)
        )
        results.append(_areas(lug, groove, within.mean(axis=1), beyond.mean(axis=1), land))
    return replace(cut, area=results[0], film_area=results[1])


def _areas(lug: Cells, groove: Cells, within: Array, beyond: Array, land: Mask) -> Array:
    """Return the area of each cell from what land covers of its own cell and of its neighbours."""

    def total(at: Cells, values: Array) -> Array:
        return np.bincount(at, values, land.size).astype(np.float64)

    pairs = np.maximum(total(lug, np.ones(lug.size)) + total(groove, np.ones(lug.size)), 1.0)
    taken, left = beyond / pairs[groove], (1 - within) / pairs[lug]
    area = 1.0 + total(lug, taken) - total(lug, left) - total(groove, taken) + total(groove, left)
    return with_least_area(area.reshape(land.shape), land)


def with_least_area(area: Array, land: Mask) -> Array:
    """Return areas of at least LEAST_AREA and of the same sum: the cells around a sliver give."""
    for i, j in np.argwhere(area < LEAST_AREA):
        reach = 0
        while area[i, j] < LEAST_AREA:
            reach += 1
            near = tuple(slice(max(at - reach, 0), at + reach + 1) for at in (i, j))
            for alike in (True, False):  # lugs keep their area where a neighbour is one
                spare = np.maximum(area[near] - LEAST_AREA, 0.0)
                spare *= (land[near] == land[i, j]) == alike
                given = min(LEAST_AREA - area[i, j], spare.sum())
                if given > 0:
                    area[near] -= spare * (given / spare.sum())
                    area[i, j] += given
    return area


def _pairs(land: Mask, channel: Mask) -> tuple[Cells, Cells]:
    """Return land cells and the channel cells beside them; across a corner where no side is."""
    number = np.arange(land.size).reshape(land.shape)
    pairs: list[tuple[Cells, Cells]] = []
    beside = np.zeros(land.size, dtype=bool)
    for ways in (_SIDES, _CORNERS):
        new = []
        for way in ways:
            ahead = tuple(slice(max(step, 0), min(step, 0) or None) for step in way)
            here = tuple(slice(max(-step, 0), min(-step, 0) or None) for step in way)
            touching = land[here] & channel[ahead]
            lug, groove = number[here][touching], number[ahead][touching]
            alone = ~(beside[lug] & beside[groove])
            new.append((lug[alone], groove[alone]))
        pairs += new
        for lug, groove in new:
            beside[lug] = beside[groove] = True
    lug, groove = (np.concatenate(each) for each in zip(*pairs, strict=True))
    return lug, groove


def _crossing(level: Array, inside: Mask, axis: int) -> Array:
    """Return where the level crosses 0 on the way to the next cell, 0.5 where it does not."""
    place = np.full(level.shape, 0.5)
    here, ahead = (np.moveaxis(part, axis, 0) for part in (level, level))
    here, ahead = here[:-1], ahead[1:]
    mask = np.moveaxis(inside, axis, 0)
    crossed = mask[:-1] & mask[1:] & ((here <= 0) != (ahead <= 0))
    share = here / np.where(crossed, here - ahead, 1.0)
    np.moveaxis(place, axis, 0)[:-1] = np.where(crossed, np.clip(share, NEAREST, 1 - NEAREST), 0.5)
    return place
