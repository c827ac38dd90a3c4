"""Land of any form: a periodic height map cut at a share of land, every part as wide as asked.

A level is positive on land, an array over the nodes of one cell, both borders with it. Land is made
of discs of the smallest land, channels of discs of the smallest channel: both are open sets (Serra,
Image Analysis and Mathematical Morphology, 1982), so that corners are as round as the discs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache, reduce
from itertools import pairwise, product

import numpy as np
import shapely
from contourpy import FillType, contour_generator
from scipy.spatial import KDTree

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.core.remark import Message

from ._kernels.tread_pattern import outline_distance
from .lettering import Lettering

NODES = 8
"""Nodes across the smallest width. Outlines are linear between them: 0.4 % of it where roundest."""
TOLERANCE = 0.03
"""Share of the smallest channel by which a corner of a channel may reach beyond its discs."""
LAND_ERROR = 0.01
"""Largest difference between the share of land and what was asked."""
_FAR = 1.0  # m: distance to a wall where there is none
_REPAIRS = 8
_NARROWEST = 2e-3  # of the height map's range: cuts nearer to each other are one
_FORCED = 6
_CORE = 0.35  # of a channel's width: parts of a lost channel wider than that are held open
_SAME = 1e-9  # m: places nearer to each other are one
_DRAWN = 2e-5  # m: how far the outlines of a solid may lie from those of the map


@dataclass(frozen=True)
class FreeLand(Lettering):
    """Outlines of land in a cell that repeats along and across the shoe.

    ``shells`` and ``holes`` are cut at the border of the cell, which begins at (0, 0); ``gap`` is
    the smallest channel, m.

    Parameters:
        cell: Period along and across, m.
        smallest_land: m.
    """

    cell: tuple[float, float]
    smallest_land: float

    @cached_property
    def corner(self) -> Array:
        """(0, 0)."""
        return np.zeros(2)

    @cached_property
    def pitch(self) -> Array:
        """Period along and across, m."""
        return np.array(self.cell)

    @property
    def stroke(self) -> float:
        """Smallest land, m."""
        return self.smallest_land

    @cached_property
    def segments(self) -> Array:
        """Walls of one cell, (n, 4) as x0, y0, x1, y1, m, without the cuts along its border."""
        every = super().segments
        cut = np.zeros(len(every), dtype=bool)
        for axis, side in enumerate(self.cell):
            ends = every[:, [axis, axis + 2]]
            for border in (0.0, side):
                cut |= (np.abs(ends - border) < _SAME).all(axis=1)
        return every[~cut]

    @cached_property
    def _cell_land(self) -> shapely.Geometry:
        rings = map(shapely.Polygon, (*self.shells, *self.holes))
        return reduce(shapely.symmetric_difference, rings)

    def channel_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) into the channels: positive there, negative on land."""
        distance = np.abs(outline_distance(x, y, self.segments, self.corner, self.pitch))
        land = shapely.intersects_xy(
            self._cell_land, np.mod(x, self.cell[0]), np.mod(y, self.cell[1])
        )
        return np.where(land, -distance, distance)

    def outlines(self, low: Array, high: Array) -> Iterator[tuple[Array, list[Array]]]:
        """Yield outer wall of each piece of land between two corners, and the channels within it.

        Land that goes on without end is cut beyond the corners. A channel around an island is cut
        into parts that are around nothing.
        """
        counts = [
            range(math.floor(a / p) - 1, math.ceil(b / p) + 2)
            for a, b, p in zip(low, high, self.cell, strict=True)
        ]
        tiles = [
            shapely.transform(self._cell_land, lambda points, at=at: points + self.pitch * at)
            for at in product(*counts)
        ]
        land = shapely.simplify(shapely.union_all(tiles, grid_size=_SAME), _DRAWN)
        filled = shapely.union_all([shapely.Polygon(p.exterior) for p in shapely.get_parts(land)])
        for lug in shapely.get_parts(filled):
            within = shapely.get_parts(lug.difference(land))
            channels = [part for channel in within for part in _around_nothing(channel)]
            yield (
                np.array(lug.exterior.coords)[:-1],
                [np.array(part.exterior.coords)[:-1] for part in channels],
            )


def _around_nothing(area: shapely.Polygon) -> Iterator[shapely.Polygon]:
    """Yield the parts of an area, cut through the middle of whatever lies within it."""
    low, left, high, right = area.bounds
    cuts = [low, *sorted(shapely.Polygon(ring).centroid.x for ring in area.interiors), high]
    for begin, end in pairwise(cuts):
        yield from shapely.get_parts(area & shapely.box(begin, left, end, right))


def height_map(terms: Mapping[str, float], nodes: tuple[int, int]) -> Array:
    """Return the sum of waves at (nodes along, nodes across) one cell, its borders included.

    A term ``cosM_sinN`` is cos(2 pi M x / length) sin(2 pi N y / width), M and N one digit each.
    """
    along, across = (2 * math.pi * np.arange(count) / count for count in nodes)
    wave = {"cos": np.cos, "sin": np.sin}
    height = np.zeros(nodes)
    for name, value in terms.items():
        height += value * np.outer(
            wave[name[:3]](int(name[3]) * along), wave[name[5:8]](int(name[8]) * across)
        )
    return np.pad(height, (0, 1), mode="wrap")


@dataclass(frozen=True)
class _Cell:
    """Nodes of a cell, and the smallest widths of land and channel, m."""

    size: tuple[float, float]
    land: float
    channel: float

    @cached_property
    def nodes(self) -> tuple[int, int]:
        """Nodes along and across: even, so that half a cell is a whole number of them."""
        step = min(self.land, self.channel) / NODES
        along, across = (2 * math.ceil(side / step / 2) for side in self.size)
        return along, across

    @cached_property
    def places(self) -> tuple[Array, Array]:
        """Nodes along x and y, m."""
        along, across = (
            np.linspace(0, a, n + 1) for a, n in zip(self.size, self.nodes, strict=True)
        )
        return along, across

    def distance(self, level: Array) -> Array:
        """Return the distance (m) to where a level is 0, of its sign."""
        x, y = self.places
        lines = contour_generator(y, x, level, quad_as_tri=True).lines(0.0)
        if not lines:
            return np.where(level > 0, _FAR, -_FAR)
        walls = [np.asarray(line) for line in lines]
        begin = np.concatenate([wall[:-1] for wall in walls])
        end = np.concatenate([wall[1:] for wall in walls])
        share = (np.arange(4)[:, None, None] + 0.5) / 4  # walls as points, four on a piece
        points = (begin + share * (end - begin)).reshape(-1, 2)[:, ::-1]
        place = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
        # the walls of the cells around count too: the tree is a torus
        away, _ = KDTree(points % self.size, boxsize=self.size).query(place % self.size)
        return np.where(level > 0, away, -away)

    def open_level(self, level: Array, width: float) -> Array:
        """Return the level of what is covered by discs of a width (m) within it."""
        return self.distance(self.distance(level) - width / 2) + width / 2

    def share(self, level: Array) -> float:
        """Return the share of land of a distance."""
        step = max(place[1] for place in self.places)
        return float(np.clip(0.5 + level[:-1, :-1] / step, 0.0, 1.0).mean())

    def repair_land(self, level: Array, held: Array) -> Array | None:
        """Return the distance of land with both smallest widths; None where nothing of it is left.

        Narrow channels are filled, narrow land is taken away. A channel that this leaves narrow is
        widened, which takes land, until both hold. ``held`` is positive where channels stay.
        """
        level = np.minimum(-self.open_level(-level, self.channel), -held)
        for _ in range(_REPAIRS):
            level = self.open_level(level, self.land)
            wide = self.open_level(-level, self.channel)
            narrow = np.minimum(-level, -wide - TOLERANCE * self.channel)
            if narrow.max() <= 0:
                return level
            level = -np.maximum(wide, self.distance(narrow) + self.channel / 2)
        return None


@lru_cache(maxsize=512)
def free_land(
    terms: tuple[tuple[str, float], ...],
    cell: tuple[float, float],
    share: float,
    smallest_land: float,
    smallest_channel: float,
) -> FreeLand:
    """Return the land where a height map is high, its share and smallest widths as asked.

    The map is cut where the repaired land has its share: within ``LAND_ERROR``. Where a channel
    that would close makes the share jump over it, that channel is held open, and land is taken
    elsewhere.

    Parameters:
        terms: Coefficients of ``height_map`` by name.
        cell: Period along and across the shoe, m.
        share: Of land, 0 to 1.
        smallest_land, smallest_channel: m; land and channels are made of discs of these.

    Raises:
        InputError: No cut has both widths and the share.
    """
    nodes = _Cell(cell, smallest_land, smallest_channel)
    height = height_map(dict(terms), nodes.nodes)
    held = np.full(height.shape, -_FAR)
    reached = [0.0, 1.0]
    for _ in range(_FORCED):
        low, high = float(height.min()), float(height.max())
        most, least, step = None, None, _NARROWEST * (high - low)
        while high - low > step:
            cut = (low + high) / 2
            level = nodes.repair_land(height - cut, held)
            land = 0.0 if level is None else nodes.share(level)
            if level is not None and abs(land - share) <= LAND_ERROR:
                return _outline_land(nodes, level)
            if land > share:
                low, most, reached[1] = cut, level, min(reached[1], land)
            else:
                high, least, reached[0] = cut, level, max(reached[0], land)
        if most is None or least is None:
            break
        held = np.maximum(
            held, nodes.open_level(np.minimum(-least, most), _CORE * smallest_channel)
        )
    near = " or ".join(f"{land:.2f}" for land in reached if 0 < land < 1)
    raise InputError(
        Message(
            "no cut of these waves has {share:.0%} of land and both smallest widths", share=share
        ),
        allowed=Message("a land of {near} is near", near=near) if near else "none at any land",
        remedy="Take smaller lug_width or channel_width, a larger cell, or other coefficients",
    )


def _outline_land(nodes: _Cell, level: Array) -> FreeLand:
    x, y = nodes.places
    filled = contour_generator(
        y, x, level, quad_as_tri=True, fill_type=FillType.OuterOffset
    ).filled(0.0, 2 * _FAR)
    shells, holes = [], []
    for points, offsets in zip(*filled, strict=True):
        for number, (first, last) in enumerate(pairwise(offsets)):
            ring = tuple((float(b), float(a)) for a, b in points[first : last - 1])
            (holes if number else shells).append(ring)
    return FreeLand(tuple(shells), tuple(holes), nodes.channel, nodes.size, nodes.land)
