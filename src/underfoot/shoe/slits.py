"""Sipes narrower than the grid can show: what they open, drain and take of the land.

A slit of width s and depth d leads Q = s^3 d (1 - 0.63 s / d) / (12 eta) per length and pressure
difference: plane Poiseuille flow between its walls, with the drag of its floor and of the face
above (White, Viscous Fluid Flow, section 3-3; the smaller of s and d counts as s). That is a film
of the gap (s^3 d / b)^(1/3) on the width b. At 0.3 mm and 3 mm deep it is 0.4 mm on 1 mm, ten times
the film under a lug and a thousand times its flow: the slit is at the pressure of the channel that
it leads to, and fluid enters the film from it as from a channel. So a slit drains or it does not:
from ``LEAST_GAP`` on it does, which rubber pressed together (``closed_by``) reaches at 0.07 mm.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from underfoot.core.arrays import Array, Mask

from ._kernels.regions import pieces
from .cut_cells import NEAREST, Cells, CutCells, with_least_area

ENDS = 0.63
"""Drag of the short sides of a slit, per width over depth."""
LEAST_GAP, ON_WIDTH = 0.1e-3, 1e-3
"""m: a slit that leads as much as a film of this gap on this width drains; less is shut."""
FEWEST = 4
"""Samples along a side of a cell, at least; more where a slit is narrower."""


@dataclass(frozen=True, slots=True)
class Slits:
    """Slits of a map; arrays (2, nx, ny), first index 0: from a cell's centre to the next at +x, 1:
    at +y; else (nx, ny).

    Attributes:
        length: Of slit for which its crossing of this way stands, m; 0 where none crosses. All
            together are as long as the slits, on any grid and at any angle.
        place: Where it crosses, as a share of the way.
        depth, width: Of the slit next to a cell, m, (nx, ny).
        covered: Share of each land cell that slits take, (nx, ny).
        fed: Cells with a slit that leads to a channel or to the rim, (nx, ny).
        openness: Share of what the rubber bulges into an open slit before the walls meet, 0 to 1.
        further_give: By how much more the lugs give way than without slits, as a share.
        closing: Of the walls under load, m.
    """

    length: Array
    place: Array
    depth: Array
    width: Array
    covered: Array
    fed: Mask
    openness: float = 1.0
    further_give: float = 0.0
    closing: float = 0.0

    def part(self, keep: tuple[slice, slice]) -> Self:
        """Return the slits of a part of the map."""
        ways = {name: getattr(self, name)[:, *keep] for name in ("length", "place")}
        cells = {name: getattr(self, name)[keep] for name in ("depth", "width", "covered", "fed")}
        return replace(self, **ways, **cells)

    @property
    def drainage(self) -> Array:
        """Flow through the slit next to each cell times viscosity, per pressure gradient, m^4."""
        return slit_drainage(np.maximum(self.width - self.closing, 0.0), self.depth)

    @property
    def drained(self) -> Mask:
        """Cells that their slit keeps at the pressure of the channels, (nx, ny)."""
        return self.fed & (self.drainage >= LEAST_GAP**3 * ON_WIDTH / 12)

    @property
    def whole_length(self) -> float:
        """Length of all slits, m."""
        return float(self.length.sum())

    @property
    def count(self) -> int:
        """Slits that do not touch; closer than two cells they count as one."""
        return pieces(self.covered > 0)[1]

    def closed_by(self, closing: float) -> Self:
        """Return the slits with walls ``closing`` (m) nearer to each other, until they meet."""
        left = np.clip(1 - closing / self.width, 0.0, 1.0)
        weight = self.length.sum(axis=0)
        moved = np.minimum(self.width / max(closing, 1e-30), 1.0)
        return replace(
            self,
            covered=self.covered * left,
            openness=float(np.average(moved, weights=weight)) if weight.any() else 1.0,
            closing=closing,
        )


def slit_drainage(width: Array, depth: Array) -> Array:
    """Return the flow through a slit times viscosity, per pressure gradient, m^4; see above."""
    least, most = np.minimum(width, depth), np.maximum(width, depth)
    return least**3 * (most - ENDS * least) / 12


def slits_of(
    near: Mask,
    land: Mask,
    inside: Mask,
    spacing: float,
    level_at: Callable[[Cells, Cells, Array, Array], Array],
    *,
    depth: Array,
    width: Array,
    tangent: tuple[Array, Array],
) -> Slits | None:
    """Return the slits of a map, None where none lies on land.

    Parameters:
        near: Cells with a slit within a cell of their centre, (nx, ny).
        land, inside: Of the map, slits counted as land.
        spacing: Side of a cell, m.
        level_at: Signed distance (m) into the slits near the cells (i, j), (n, 1), at offsets along
            x and y, (1, m), in shares of a cell; positive in a slit.
        depth, width: Of the slit next to each cell, m, (nx, ny).
        tangent: Components along x and y of the unit vector along it, (nx, ny).
    """
    near = near & inside & (depth > 0)
    if not (near & land).any():
        return None
    i, j = (each[:, None] for each in np.nonzero(near))
    count = max(FEWEST, int(np.ceil(spacing / width[near].min())))
    step = 1 / count
    forward = np.asarray((np.arange(count) + 0.5) * step, dtype=np.float64)[None, :]
    middle, none = forward - 0.5, np.zeros_like(forward)
    aligned = [np.abs(part[near])[:, None] for part in tangent]
    staircase = (aligned[0] + aligned[1])[:, 0]
    slit_width, slit_depth = width[near], depth[near]

    def covered_share(along: Array, across: Array, slope: Array | float) -> Array:
        ramp = np.maximum(slope * step * spacing, 1e-9)
        return np.clip(0.5 + level_at(i, j, along, across) / ramp, 0.0, 1.0)

    length, place = np.zeros((2, *land.shape)), np.full((2, *land.shape), 0.5)
    for axis, way in enumerate(((forward, none), (none, forward))):
        normal = aligned[1 - axis]
        on_way = covered_share(*way, normal)
        crossed = on_way.sum(axis=1) * normal[:, 0] * step * spacing / slit_width
        at = (on_way * forward).sum(axis=1) / np.maximum(on_way.sum(axis=1), 1e-12)
        length[axis][near] = crossed * spacing / staircase
        place[axis][near] = np.where(crossed > 0, np.clip(at, NEAREST, 1 - NEAREST), 0.5)
        beside = np.zeros_like(land)
        here, ahead = (np.moveaxis(each, axis, 0) for each in (beside, land))
        here[:-1] = ahead[1:]
        length[axis] *= 0.5 * land + 0.5 * beside  # on average half of the way over a rim is land
    inner_x, inner_y = (part.reshape(1, -1) for part in np.meshgrid(middle, middle, indexing="ij"))
    taken = np.zeros(land.shape)
    # a groove shallower than wide is partly filled by what bulges into it
    taken[near] = covered_share(inner_x, inner_y, 1.0).mean(axis=1) * np.minimum(
        slit_depth / slit_width, 1.0
    )
    taken *= land
    if not taken.any():
        return None
    numbers, _ = pieces((taken > 0) | ~land)
    fed = (taken > 0) & np.isin(numbers, numbers[~land])
    return Slits(length, place, depth, width, taken, fed)


def without_slits(cut: CutCells, slits: Slits, land: Mask) -> CutCells:
    """Return what the cells of a map stand for beside the slits in them."""
    areas = {
        name: with_least_area(getattr(cut, name) - slits.covered, land)
        for name in ("area", "film_area")
    }
    return replace(cut, **areas)
