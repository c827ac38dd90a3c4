"""The underside of a sole as few triangles: lugs and rim by their edges, flat parts thinned out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.shoe.cut_cells import CutCells

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Mask = NDArray[np.bool_]
NONE: Floats = np.empty((0, 2, 2))
STEEP = 2.0
"""Slope between cells of one kind beyond which a wall stands between them."""
TOLERANCE, HELD = 0.75, 0.05
"""Cells by which a line may pass beside the middles between cells that it stands for, and how much
the place where two lines meet is held where it was, over how much it follows them."""
EDGE, CORNER, AWAY, WINDOW = 0.02e-3, 0.5, 2, 4
"""m by which a line may pass beside a drawn edge whose crossings are known. Two lines that turn by
more (rad) meet in a corner; none of its nearest places is trusted, and so many on either side are
asked for their direction."""
DRAWN = 0.05e-3
"""m within which lines are of drawn edges, corners too, on cells of 0.2 mm or less, or of a file's
faces; ``TOLERANCE`` where the rim leaves a sliver of a lug, too short to tell its sides."""
LATTICE, NEAR = 4e-3, 1.2e-3
"""m between the points on smooth parts, and how near to an edge none of them is set."""
ERROR, REFINED, APART = 0.05e-3, 2, 1.5e-3
"""m by which a triangle may miss its cells, how often points are set for that, and how close."""
CELL_ERROR = 0.15
"""The same in cells, where these are coarse."""
FARTHEST, OBLIQUE = 8.0, 3.0
"""Cells between places that lie beside each other on one line; times the reach within which a line
of a lug ends at the rim."""
NODED, ROUNDS = 1e-3, 10
"""Cells by which places are told apart; times that lines are halved until each is an edge of
triangles."""
SURE = 0.8
"""Share of an area parted off by lines that one level must have to be all of that level."""


@dataclass(frozen=True, slots=True)
class SurfaceMesh:
    """Triangles of the underside of a sole, in m, with upright walls where a level ends.

    ``points`` (n, 3); ``land`` (n,): whether a point lies on a lug; ``triangles`` (t, 3); ``walls``
    (w, 4): two points of one level and those of another at the same places; ``sides`` (s, 2): two
    points on the rim. No point belongs to two levels.
    """

    points: Floats
    land: Mask
    triangles: Indices
    walls: Indices
    sides: Indices


def surface_mesh(
    x: Floats,
    y: Floats,
    height: Floats,
    land: Mask,
    cut: CutCells | None = None,
    *,
    edges: Floats = NONE,
    rim: Floats = NONE,
    reach: float = 0.0,
) -> SurfaceMesh:
    """Return the surface through the heights (nx, ny; m, nan outside) of square cells.

    Lines between levels (land, channels, what a wall parts) pass within a cell of where the cells
    change; those of lugs, where ``cut`` has their crossings, within ``DRAWN`` of the drawing, and
    where ``edges`` and ``rim`` (n, 2, 2; m), lines at which lugs and the sole end, are known within
    ``reach`` (m), along them.
    Triangles between lines are within ``ERROR`` of the cells where they are smooth.
    """
    side = float(np.median(np.diff(x)))
    known = tuple(
        _Edges((lines - np.array([x[0], y[0]])) / side + 1, reach / side) for lines in (edges, rim)
    )
    grid = _Grid.of(np.pad(height, 1, constant_values=np.nan), np.pad(land, 1), side)
    ends, lines = _divide_lines(*_lines(grid, cut, *known), LATTICE / side)
    inner = _lattice(grid, ends, LATTICE / side, NEAR / side)
    ends, lines, triangles, levels = _triangles(grid, ends, lines, inner)
    for _ in range(REFINED):
        missed = _most_missed_cells(grid, ends, inner, triangles, levels, APART / side)
        if not len(missed):
            break
        inner = np.concatenate([inner, missed])
        ends, lines, triangles, levels = _triangles(grid, ends, lines, inner)
    places = np.concatenate([ends, inner])
    pairs, owner = np.unique(
        np.stack([triangles.ravel(), np.repeat(levels, 3)], axis=1), axis=0, return_inverse=True
    )
    heights = grid.heights(places[pairs[:, 0]], pairs[:, 1])
    flat = np.stack([x[0], y[0]]) + (places[pairs[:, 0]] - 1) * side
    corners = owner.reshape(-1, 3)
    walls, sides = _upright(triangles, corners, levels, lines, len(places))
    return SurfaceMesh(
        np.column_stack([flat, heights]), grid.is_land[pairs[:, 1]], corners, walls, sides
    )


@dataclass(frozen=True, slots=True)
class _Grid:
    """Cells with a rim of empty ones: heights, levels (0 outside), and which levels are land."""

    height: Floats
    level: Indices
    steep: Mask
    is_land: Mask
    side: float

    @classmethod
    def of(cls, height: Floats, land: Mask, side: float) -> _Grid:
        """Return the cells with their levels; steep ones belong to the nearest that is not."""
        from scipy.ndimage import distance_transform_edt, label

        inside = np.isfinite(height)
        kind = np.where(inside, 1 + land, 0)
        steep = np.zeros(kind.shape, bool)
        for axis in (0, 1):
            ahead, behind = _neighbours(axis)
            wall = np.abs(height[ahead] - height[behind]) >= STEEP * side
            wall &= kind[ahead] == kind[behind]
            steep[ahead] |= wall
            steep[behind] |= wall
        if not steep.any():
            return cls(height, kind, steep, np.array([False, False, True]), side)
        level, lands = np.zeros(kind.shape, np.intp), [False]
        for number in (1, 2):
            own = kind == number
            numbered: Any = label(own & ~steep)
            parts, count = numbered
            if not count:  # all of it is steep
                parts, count, steep = own.astype(int), 1, steep & ~own
            far: Any = distance_transform_edt(parts == 0, return_indices=True)
            level[own] = parts[tuple(far[1])][own] + len(lands) - 1
            lands += [number == 2] * count
        return cls(height, level, steep, np.array(lands), side)

    def at(self, places: Floats) -> tuple[Indices, Indices]:
        """Return the cells in which places (n, 2) lie."""
        i, j = (np.clip(np.rint(p).astype(int), 0, n - 1)
                for p, n in zip(places.T, self.level.shape, strict=True))  # fmt: skip
        return i, j

    def heights(self, places: Floats, levels: Indices) -> Floats:
        """Return heights (m) of levels at places (n, 2): of the nearest cell, with its slope."""
        from scipy.spatial import KDTree

        i, j = self.at(places)
        good = (self.level[i, j] == levels) & ~self.steep[i, j]
        if not good.all():
            known = np.argwhere(
                (self.level > 0) & ~self.steep & _beside_another(self.level, self.steep)
            )
            far = 1e4 * self.level[tuple(known.T)]
            tree = KDTree(np.column_stack([known, far]))
            wanted = np.column_stack([places[~good], 1e4 * levels[~good]])
            i[~good], j[~good] = known[tree.query(wanted)[1]].T
        result = self.height[i, j]
        for axis, away in enumerate((places - np.column_stack([i, j])).T):
            slope, count = np.zeros((2, len(i)))
            for step in (1, -1):
                m, n = (i + step, j) if axis == 0 else (i, j + step)
                same = (self.level[m, n] == self.level[i, j]) & ~self.steep[m, n]
                slope += np.where(same, step * (self.height[m, n] - self.height[i, j]), 0.0)
                count += same
            result = result + away * slope / np.maximum(count, 1)
        return result


def _neighbours(axis: int) -> tuple[tuple[slice, ...], tuple[slice, ...]]:
    """Return what picks all cells but the first along an axis, and all but the last."""
    before = (slice(None),) * axis
    return (*before, slice(1, None)), (*before, slice(-1))


def _beside_another(level: Indices, steep: Mask) -> Mask:
    """Return where a cell of another level, or a steep one, is within two cells."""
    from scipy.ndimage import binary_dilation

    other = steep.copy()
    for axis in (0, 1):
        ahead, behind = _neighbours(axis)
        change = level[ahead] != level[behind]
        other[ahead] |= change
        other[behind] |= change
    return np.asarray(binary_dilation(other, iterations=2), bool)


class _Edges:
    """Lines (n, 2, 2; cells) that are known within ``reach`` cells of a place."""

    def __init__(self, lines: Floats, reach: float) -> None:
        import shapely

        strings: Any = shapely.linestrings(np.round(lines / NODED) * NODED)
        merged: Any = shapely.line_merge(shapely.multilinestrings(strings))
        self.whole, self._reach = merged, reach
        self._parts = parts = shapely.get_parts(merged)
        at, self._part = shapely.get_coordinates(parts, return_index=True)
        self._at, self._length = at, shapely.length(parts)
        self._closed = shapely.is_closed(parts)
        along = np.append(0.0, np.hypot(*np.diff(at, axis=0).T).cumsum()) if len(at) else at
        first = np.searchsorted(self._part, np.arange(len(parts)))
        self._along = along - along[first][self._part] if len(at) else along
        self._begins = np.flatnonzero(self._part[1:] == self._part[:-1])
        ends = np.stack([at[self._begins], at[self._begins + 1]], axis=1)
        segments: Any = shapely.linestrings(ends)
        self._tree = shapely.STRtree(segments)

    def nearest(self, places: Floats) -> tuple[Floats, Mask, Indices, Floats]:
        """Return the nearest point to each place (n, 2), where it is near, its line, how far on."""
        import shapely

        if not len(self._begins):
            none = np.zeros(len(places))
            return places, none > 0, none.astype(np.intp), none
        points: Any = shapely.points(places)
        (at, number), away = self._tree.query_nearest(
            points, return_distance=True, all_matches=False
        )
        lines = self._tree.geometries[number]
        further = shapely.line_locate_point(lines, points[at])
        onto = shapely.get_coordinates(shapely.line_interpolate_point(lines, further))
        near, begin = away <= self._reach, self._begins[number]
        return (
            np.where(near[:, None], onto, places),
            near,
            self._part[begin],
            (self._along[begin] + further),
        )

    def crossing(self, number: int, other: _Edges, place: Floats) -> Floats:
        """Return where one of these lines crosses others near a place (2,), else the place."""
        import shapely

        met = shapely.intersection(self._parts[number], other.whole)
        points = shapely.get_coordinates(met)
        away = np.hypot(*(points - place).T)
        if not len(points) or away.min() > OBLIQUE * self._reach:
            return place
        return points[away.argmin()]

    def between(self, part: Indices, along: Floats) -> Floats | None:
        """Return the way (n, 2) along one line past all places, None where they lie on several."""
        if not len(part) or (part != part[0]).any():
            return None
        number = part[0]
        length, steps = float(self._length[number]), np.diff(along)
        d = np.flatnonzero(self._part == number)
        corners, at = self._at[d], self._along[d]
        if self._closed[number]:
            steps = (steps + length / 2) % length - length / 2
            corners = np.concatenate([corners[:-1]] * 3 + [corners[:1]])
            at = np.concatenate([at[:-1] - length, at[:-1], at[:-1] + length, [2 * length]])
        begin, end = along[0], along[0] + float(steps.sum())
        if (np.abs(steps) > FARTHEST).any():
            return None
        passed = (at > min(begin, end)) & (at < max(begin, end))
        way = corners[passed] if end > begin else corners[passed][::-1]
        ends = [[np.interp(each, at, corners[:, k]) for k in (0, 1)] for each in (begin, end)]
        return np.concatenate([ends[:1], way, ends[1:]])


def _lines(grid: _Grid, cut: CutCells | None, edges: _Edges, rim: _Edges) -> tuple[Floats, Indices]:
    """Return places (n, 2) and lines (m, 2) between levels, straightened.

    Of the places between cells that differ, joined around each corner of four cells; where three
    or four levels meet they are joined in the corner. A place is the middle, of land and channel
    where ``cut`` has the edge, and the nearest of ``edges`` or the ``rim``.
    """
    level = grid.level
    n, m = level.shape
    along, across = level[1:] != level[:-1], level[:, 1:] != level[:, :-1]
    # the four middles at a corner: before and behind it across, then along
    at = np.stack([along[:, :-1], along[:, 1:], across[:-1], across[1:]])
    i, j = np.indices((n - 1, m - 1))
    number = np.stack([i * m + j, i * m + j + 1, n * m + i * m + j, n * m + (i + 1) * m + j])
    count = at.sum(axis=0)
    pair = count == 2
    links = [number[:, pair].T[at[:, pair].T].reshape(-1, 2)]
    corner = 2 * n * m + i * m + j
    for k in range(4):
        here = at[k] & (count > 2)
        links.append(np.stack([number[k][here], corner[here]], axis=1))
    joined = np.concatenate(links)
    names, nodes = np.unique(joined, return_inverse=True)
    kind, cell = np.divmod(names, n * m)
    i, j = np.divmod(cell, m)
    places = np.stack([i, j], axis=1) + np.array([[0.5, 0.0], [0.0, 0.5], [0.5, 0.5]])[kind]
    drawn = np.zeros(len(names), bool)
    part, further = np.full(len(names), -1), np.zeros(len(names))
    at_rim = np.zeros(len(names), bool)
    for axis in (0, 1):
        after = (i + (axis == 0)) % n, (j + (axis == 1)) % m
        two = (kind == axis) & (level[i, j] > 0) & (level[after] > 0)
        two &= grid.is_land[level[i, j]] != grid.is_land[level[after]]
        one = (kind == axis) & ((level[i, j] > 0) != (level[after] > 0))
        if cut is not None:
            share = np.pad((cut.along, cut.across)[axis], 1, constant_values=0.5)
            places[two, axis] += share[i[two], j[two]] - 0.5
            drawn |= two
        for known, here in ((edges, two & ~drawn), (rim, one)):
            places[here], near, number, way = known.nearest(places[here])
            drawn[here], further[here] = near, way
            part[here] = np.where(near, number, -1)
        at_rim |= one
    around = [
        level[np.minimum(i + a, n - 1), np.minimum(j + b, m - 1)] for a in (0, 1) for b in (0, 1)
    ]
    ending = (kind == 2) & (np.min(around, axis=0) == 0)
    places[ending] = rim.nearest(places[ending])[0]
    numbered, ways = [np.empty((0, 2), np.intp)], []
    for chain in _chains(nodes.reshape(-1, 2), len(names)):
        closed = chain[0] == chain[-1]
        inner, way = chain if closed else chain[1:-1], None
        if inner and (part[inner] >= 0).all():
            known = rim if at_rim[inner[0]] else edges
            for end, beside in ((chain[0], inner[0]), (chain[-1], inner[-1])):
                if known is edges and ending[end]:
                    places[end] = edges.crossing(part[beside], rim, places[end])
            way = known.between(part[inner], further[inner])
        if way is not None and not (closed and len(way) < 4):
            ways.append((chain[:0] if closed else [chain[0], chain[-1]], way))
        elif drawn[chain[1:-1]].all() and len(chain) > 2:
            numbered.append(_along_edge(places, chain, EDGE / grid.side))
        else:
            numbered.append(_straighten_chain(places, chain))
    lines = [places[np.concatenate(numbered)]]
    for ends, way in ways:
        path = np.concatenate([places[ends[:1]], way, places[ends[1:]]])
        path = path[_corners_of(path, EDGE / grid.side)]
        lines.append(np.stack([path[:-1], path[1:]], axis=1))
    return _cut_where_lines_meet(np.concatenate(lines))


def _cut_where_lines_meet(lines: Floats) -> tuple[Floats, Indices]:
    """Return the places (n, 2) and lines (m, 2) of lines (k, 2, 2) cut where they meet.

    A corner that moved may lie beyond the place after it: its line comes back on itself, and no
    triangles have both as edges.
    """
    import shapely

    parts = shapely.get_parts(shapely.union_all(shapely.linestrings(lines), grid_size=NODED))
    at, number = shapely.get_coordinates(parts, return_index=True)
    ahead = np.flatnonzero(number[1:] == number[:-1])
    places, again = np.unique(at, axis=0, return_inverse=True)
    return places, again.ravel()[np.stack([ahead, ahead + 1], axis=1)]


def _chains(links: Indices, count: int) -> list[list[int]]:
    """Return the chains of linked nodes, from one branching or back to the first."""
    beside: list[list[int]] = [[] for _ in range(count)]
    for a, b in links.tolist():
        beside[a].append(b)
        beside[b].append(a)
    seen, chains = [False] * count, []

    def follow(first: int, then: int) -> list[int]:
        chain = [first, then]
        while len(beside[then]) == 2 and then != first:
            seen[then] = True
            a, b = beside[then]
            then = b if a == chain[-2] else a
            chain.append(then)
        return chain

    for node in range(count):
        if len(beside[node]) != 2:
            seen[node] = True
            chains += [follow(node, each) for each in beside[node] if not seen[each]]
    for node in range(count):
        if not seen[node]:
            seen[node] = True
            chains.append(follow(node, beside[node][0]))
    return chains


def _straighten_chain(places: Floats, chain: list[int]) -> Indices:
    """Return the chain as the fewest lines (n, 2) by halving at the place farthest off.

    The places where lines meet move to where the lines through all places between them meet.
    """
    path = places[chain]
    at = _corners_of(path, TOLERANCE)
    normal, offset = _fit_lines(path, at)
    ends = np.array(chain)[at]
    before, after = np.arange(len(at) - 2), np.arange(1, len(at) - 1)
    if chain[0] == chain[-1] and len(at) > 2:
        before, after = np.append(before, len(at) - 2), np.append(after, 0)
    both = np.stack([before, after])
    # of least squares; HELD keeps the place along lines that run on straight
    matrix = np.einsum("knc,knd->ncd", normal[both], normal[both]) + HELD * np.eye(2)
    right = np.einsum("knc,kn->nc", normal[both], offset[both]) + HELD * path[at[after]]
    met = np.linalg.solve(matrix, right[:, :, None])[:, :, 0]
    near = np.hypot(*(met - path[at[after]]).T) < 1.0
    places[ends[after][near]] = met[near]
    return np.stack([ends[:-1], ends[1:]], axis=1)


def _along_edge(places: Floats, chain: list[int], tolerance: float) -> Indices:
    """Return the chain, whose places lie on a drawn edge, as the fewest lines (n, 2).

    Corners of the edge, on which no place lies, move to where its two sides meet, an end at a rim
    onto its side; the places nearest to them, where the crossing of neither side is known, go.
    """
    nodes, path = np.array(chain), places[chain]
    closed, last = chain[0] == chain[-1], len(chain) - 1
    at = _corners_of(path, TOLERANCE)
    if closed:  # from the middle of its longest side, not from beside a corner
        longest = int(np.diff(at).argmax())
        nodes = np.roll(nodes[:-1], -int(at[longest : longest + 2].sum() // 2))
        nodes = np.append(nodes, nodes[0])
        path = places[nodes]
        at = _corners_of(path, TOLERANCE)
    inner = at[1:-1]
    inner = inner[np.diff(at[:-1]) > AWAY]  # a corner cut off between cells has two places
    at = np.concatenate([at[:1], inner, at[-1:]])
    gone = np.zeros(len(chain), bool)
    for number, k in enumerate(at[:-1] if closed else at):
        low, high = at[number - 1] + 1, at[(number + 1) % len(at)] - 1
        if closed and k == 0:
            low, high = at[-2] + 1 - last, at[1] - 1
        before = np.arange(max(k - AWAY - WINDOW, low), k - AWAY + 1)
        after = np.arange(k + AWAY, min(k + AWAY + WINDOW, high) + 1)
        ends = [
            each[[0, -1]] % (last + (not closed)) for each in (before, after[::-1]) if len(each) > 1
        ]
        if closed or 0 < k < last:
            if len(ends) < 2:
                continue
            here = _meeting(path, *ends)
        elif ends := ends[-1:] if k == 0 else ends[:1]:
            first, then = path[ends[0]]
            long = float(np.hypot(*(then - first)))
            if long == 0:
                continue
            way = (then - first) / long
            here = first + way * ((path[k] - first) @ way)
        else:
            continue
        if here is not None and np.hypot(*(here - path[k])) < 2.0:
            near = np.arange(k - AWAY + 1, k + AWAY)
            near = near % last if closed else near[(near > 0) & (near < last)]
            gone[near] = True
            gone[k] = False
            path[k] = places[nodes[k]] = here
    rest = np.flatnonzero(~gone[:last] if closed else ~gone)
    if closed:
        rest = np.append(rest, rest[0])
    ends = nodes[rest[_corners_of(path[rest], tolerance)]]
    return np.stack([ends[:-1], ends[1:]], axis=1)


def _meeting(path: Floats, before: Indices, after: Indices) -> Floats | None:
    """Return where the lines through two places each meet; None where they hardly turn."""
    first, then = path[before[1]] - path[before[0]], path[after[0]] - path[after[1]]
    sine = first[0] * then[1] - first[1] * then[0]
    if abs(np.arctan2(sine, first @ then)) < CORNER:
        return None
    off = path[after[1]] - path[before[1]]
    return path[before[1]] + first * ((off[0] * then[1] - off[1] * then[0]) / sine)


def _corners_of(path: Floats, tolerance: float) -> Indices:
    """Return which places stay of a path, by halving at the place farthest off."""
    kept, waiting = {0, len(path) - 1}, [(0, len(path) - 1)]
    while waiting:
        first, last = waiting.pop()
        if last - first < 2:
            continue
        way, off = path[last] - path[first], path[first + 1 : last] - path[first]
        length = float(np.hypot(*way))
        away = np.hypot(*off.T) if length == 0 else np.abs(off @ [-way[1], way[0]]) / length
        far = int(away.argmax())
        if away[far] > tolerance:
            kept.add(first + 1 + far)
            waiting += [(first, first + 1 + far), (first + 1 + far, last)]
    return np.array(sorted(kept))


def _fit_lines(path: Floats, at: Indices) -> tuple[Floats, Floats]:
    """Return normal (n, 2) and offset (n,) of the lines through the places between ``at``."""
    x, y = path.T
    sums = np.cumsum(np.stack([x, y, x * x, x * y, y * y]), axis=1)
    first, last = at[:-1], at[1:] - 1
    count = np.maximum(last - first, 1)
    mean = (sums[:, last] - sums[:, first]) / count
    xx, xy, yy = mean[2] - mean[0] ** 2, mean[3] - mean[0] * mean[1], mean[4] - mean[1] ** 2
    angle, through = 0.5 * np.arctan2(2 * xy, xx - yy), mean[:2].T
    short = last - first < 3
    way = path[at[1:]] - path[at[:-1]]
    angle = np.where(short, np.arctan2(way[:, 1], way[:, 0]), angle)
    through = np.where(short[:, None], path[first], through)
    normal = np.stack([-np.sin(angle), np.cos(angle)], axis=1)
    return normal, (normal * through).sum(axis=1)


def _divide_lines(places: Floats, lines: Indices, most: float) -> tuple[Floats, Indices]:
    """Return places and lines none of which is longer than ``most`` cells."""
    while True:
        long = np.hypot(*(places[lines[:, 0]] - places[lines[:, 1]]).T) > most
        if not long.any():
            return places, lines
        places, lines = _halve_lines(places, lines, long)


def _halve_lines(places: Floats, lines: Indices, which: Mask) -> tuple[Floats, Indices]:
    middles = places[lines[which]].mean(axis=1)
    number = len(places) + np.arange(len(middles))
    halves = [np.stack([lines[which][:, k], number], axis=1) for k in (0, 1)]
    return np.concatenate([places, middles]), np.concatenate([lines[~which], *halves])


def _lattice(grid: _Grid, ends: Floats, step: float, near: float) -> Floats:
    """Return places ``step`` cells apart inside the sole, none nearer than ``near`` to ``ends``."""
    from scipy.spatial import KDTree

    along, across = (np.arange(step / 2, n, step) for n in grid.level.shape)
    places = np.stack(np.meshgrid(along, across, indexing="ij"), axis=-1).reshape(-1, 2)
    places = places[grid.level[grid.at(places)] > 0]
    return places[KDTree(ends).query(places)[0] > near]


def _triangles(
    grid: _Grid, ends: Floats, lines: Indices, inner: Floats
) -> tuple[Floats, Indices, Indices, Indices]:
    """Return places of lines, lines as edges of triangles, triangles inside, and their levels.

    Lines are halved until each is an edge of the Delaunay triangles of all places; the triangles
    between lines have the level of most of their area.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import Delaunay

    turns = 0
    while True:
        places = np.concatenate([ends, inner])
        made = Delaunay(places)
        triangles, beside = made.simplices.astype(np.intp), made.neighbors
        edges = np.stack(
            [_edge(np.roll(triangles, -k - 1, 1)[:, :2], len(places)) for k in range(3)], 1
        )
        missing = ~np.isin(_edge(lines, len(places)), edges)
        if turns == ROUNDS or not missing.any():
            break
        ends, lines = _halve_lines(ends, lines, missing)
        turns += 1
    crossed = np.isin(edges, _edge(lines, len(places))) | (beside < 0)
    one, side = np.nonzero(~crossed)
    joined = coo_matrix((np.ones(len(one)), (one, beside[one, side])), shape=(len(triangles),) * 2)
    count, part = connected_components(joined, directed=False)
    a, b, c = places[triangles].transpose(1, 0, 2)
    area = np.abs(np.linalg.det(np.stack([b - a, c - a], axis=-1))) / 2
    inside = (a + b + c) / 3
    levels = grid.level[grid.at(inside)]
    votes = coo_matrix((area, (part, levels)), shape=(count, len(grid.is_land))).toarray()
    sure = votes.max(axis=1) >= SURE * votes.sum(axis=1)
    levels = np.where(sure[part], votes.argmax(axis=1)[part], levels)
    shown = (levels > 0) & (area > 1e-9)
    return ends, lines, triangles[shown], levels[shown]


def _edge(pairs: Indices, count: int) -> Indices:
    """Return one number for each pair (n, 2) of points, in either order."""
    return pairs.min(axis=1) * count + pairs.max(axis=1)


def _most_missed_cells(
    grid: _Grid, ends: Floats, inner: Floats, triangles: Indices, levels: Indices, apart: float
) -> Floats:
    """Return the cells (n, 2) that triangles miss most, at most one in ``apart`` cells."""
    places = np.concatenate([ends, inner])
    corners = places[triangles]
    heights = grid.heights(corners.reshape(-1, 2), np.repeat(levels, 3)).reshape(-1, 3)
    worst: list[tuple[Floats, Floats]] = []
    # at the middle of a triangle and of its sides, towards its middle
    for weights in ((1, 1, 1), (4, 4, 1), (4, 1, 4), (1, 4, 4)):
        share = np.array(weights) / sum(weights)
        middle = np.einsum("tkc,k->tc", corners, share)
        i, j = grid.at(middle)
        there = (grid.level[i, j] == levels) & ~grid.steep[i, j]
        off = np.abs(grid.heights(middle[there], levels[there]) - heights[there] @ share)
        bad = off > max(ERROR, CELL_ERROR * grid.side)
        worst.append((middle[there][bad], off[bad]))
    missed, off = (np.concatenate(each) for each in zip(*worst, strict=True))
    order = np.argsort(-off)
    box = np.floor(missed[order] / apart).astype(int)
    return missed[order][np.unique(box, axis=0, return_index=True)[1]]


def _upright(
    triangles: Indices, corners: Indices, levels: Indices, lines: Indices, count: int
) -> tuple[Indices, Indices]:
    """Return the walls (w, 4) and sides (s, 2) at the lines, as points of the surface."""
    sides = [np.roll(triangles, -k, 1)[:, :2] for k in range(3)]
    owners = np.concatenate([np.roll(corners, -k, 1)[:, :2] for k in range(3)])
    pairs, level = np.concatenate(sides), np.tile(levels, 3)
    turned = pairs[:, 0] > pairs[:, 1]
    owners[turned] = owners[turned][:, ::-1]
    key = _edge(pairs, count)
    order = np.argsort(key, kind="stable")
    key, owners, level = key[order], owners[order], level[order]
    twice = np.append(key[1:] == key[:-1], False)
    alone = ~twice & ~np.append(False, twice[:-1])
    differ = twice & (level != np.roll(level, -1))
    return np.concatenate([owners[differ], np.roll(owners, -1, 0)[differ]], axis=1), owners[alone]
