"""Cells of a sole in rows along the sliding, fine where rims and corners lie.

What decides a film is a tenth of a millimetre at the rim of a lug or at a corner of the sole, and
across the sliding next to nothing. So each square cell of a map is one cell where the sole is
smooth, and several along x beside a rim or a corner (``row_division``). Faces know the sole between
two centres: it is two straight lines that meet in a node, the rim or the corner itself.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask

Indices = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class RowCells:
    """Cells (n,) of a sole, row after row along x; faces (m,) along x and (k,) across.

    Attributes:
        shape: Of the map of square cells that these divide, (nx, ny).
        spacing: Side of a square cell, m.
        parent: The square cell that each is a part of, as a flat index.
        width: Along x, in spacings.
        offset: Of the centre from that of the square cell along x, in spacings.
        clearance: Height of the undeformed sole at the centre, m; inf outside.
        land: True where the cell can touch the floor.
        area, film_area: What a cell stands for, of contact and of fluid pressure, in square cells;
            as in ``CutCells``.
        west, east: The cells on both sides of the x faces; the way between their centres is
            ``distance`` spacings long.
        node: Where on that way, as a share of it from the west, the lines meet.
        lean: Share of the east's gap, the rest being the west's, that the gap at the node is, as it
            is seen from the west and from the east, (2, m): 0 and 1 at the rim of a lug.
        rise: Height of the undeformed node over that mixture of the centres' heights, (2, m), m.
        south, north: The cells on both sides of the y faces, which are ``overlap`` spacings long.
        crossing: Where an edge crosses the way from south to north, as a share of it.
    """

    shape: tuple[int, int]
    spacing: float
    parent: Indices
    width: Array
    offset: Array
    clearance: Array
    land: Mask
    area: Array
    film_area: Array
    west: Indices
    east: Indices
    distance: Array
    node: Array
    lean: Array
    rise: Array
    south: Indices
    north: Indices
    overlap: Array
    crossing: Array

    @property
    def size(self) -> int:
        """Number of cells."""
        return self.parent.size

    @property
    def at_rim(self) -> Mask:
        """Cells at the rim of the map."""
        i, j = np.divmod(self.parent, self.shape[1])
        return (i == 0) | (i == self.shape[0] - 1) | (j == 0) | (j == self.shape[1] - 1)

    def part(self, numbers: Indices) -> "RowCells":
        """Return some of the cells, without faces."""
        names = ("parent", "width", "offset", "clearance", "land", "area", "film_area")
        none = np.empty(0, dtype=np.intp)
        faces = dict.fromkeys(("west", "east", "south", "north"), none)
        lengths = {name: np.empty(0) for name in ("distance", "node", "overlap", "crossing")}
        cells = {name: getattr(self, name)[numbers] for name in names}
        return replace(
            self, **cells, **faces, **lengths, lean=np.empty((2, 0)), rise=np.empty((2, 0))
        )

    def sums(self, values: Array) -> Array:
        """Return the sums of values (n,) over the cells of each square cell, (nx, ny)."""
        count = self.shape[0] * self.shape[1]
        sums = np.asarray(np.bincount(self.parent, values, count), dtype=np.float64)
        return sums.reshape(self.shape)

    def means(self, values: Array, weight: Array) -> Array:
        """Return the weighted means over each square cell, (nx, ny); plain where weights are 0."""
        total = self.sums(weight)
        plain = self.sums(values * self.width)
        return np.where(
            total > 0, self.sums(values * weight) / np.where(total > 0, total, 1), plain
        )

    def of(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return a map of square cells (nx, ny) at the cells, (n,)."""
        return values.ravel()[self.parent]
