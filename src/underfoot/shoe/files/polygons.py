"""Faces of any number of corners as triangles within their outline."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError
from underfoot.core.arrays import Array, Mask
from underfoot.core.remark import Message

Ints = NDArray[np.integer]

_FLAT_CORNER = 1e-9  # of the square of the sides: a corner that does not turn
_NO_WIDTH = 1e-12  # of the length: all corners lie on a line
_SAME_AREA = 1e-6


def triangulate_polygons(
    vertices: Array, counts: Ints, corners: Ints, kind: str, where: str
) -> NDArray[np.int64]:
    """Return triangles (n, 3) of polygons; those of fewer than three corners are left out.

    A convex polygon is cut from its first corner. A concave one, or one with corners that do not
    turn, is cut within its outline (constrained Delaunay triangles of GEOS) in the plane that its
    own area prescribes, so that the first corner has no meaning and all corners keep their edges.

    Parameters:
        vertices: (m, 3).
        counts: (n,) corners of each polygon.
        corners: Numbers of their vertices, one polygon after the other.
        kind, where: Format and name of the file.

    Raises:
        DataError: A polygon crosses itself; it names a vertex that is not there.
    """
    counts = np.asarray(counts, dtype=np.int64)
    corners = np.asarray(corners, dtype=np.int64)
    if corners.size and (corners.min() < 0 or corners.max() >= vertices.shape[0]):
        bad = corners[(corners < 0) | (corners >= vertices.shape[0])][0]
        raise DataError(
            Message(
                "a face of the {kind} file names vertex {bad} of {shape}, counted from 0",
                kind=kind,
                bad=bad,
                shape=vertices.shape[0],
            ),
            where=where,
            remedy="It may be cut short or damaged: export the outsole again",
        )
    if (counts == 3).all():
        return corners.reshape(-1, 3)
    sound = np.isfinite(vertices).all()
    vertices = vertices if sound else np.nan_to_num(vertices, posinf=0.0, neginf=0.0)
    first = np.cumsum(counts) - counts
    made: list[Ints] = [np.zeros((0, 3), dtype=np.int64)]
    order: list[Ints] = [np.zeros(0, dtype=np.int64)]
    for count in np.unique(counts[counts > 2]):
        number = np.flatnonzero(counts == count)
        rings = corners[first[number][:, None] + np.arange(count)]
        if count == 3:
            made.append(rings)
            order.append(number)
            continue
        convex = _convex(vertices[rings])
        fans = np.stack([np.stack([rings[:, 0], rings[:, n], rings[:, n + 1]], axis=-1)
                         for n in range(1, count - 1)], axis=1)[convex]  # fmt: skip
        made.append(fans.reshape(-1, 3))
        order.append(np.repeat(number[convex], count - 2))
        if not convex.all():
            within, owner = _within(vertices, rings[~convex], number[~convex], where)
            made.append(within)
            order.append(owner)
    faces = np.concatenate(made)[np.argsort(np.concatenate(order), kind="stable")]
    return faces.astype(np.int64)


def _normals(rings: Array) -> Array:
    """Return twice the area vectors of polygons (n, k, 3)."""
    centred = rings - rings[:, :1]
    return np.cross(centred, np.roll(centred, -1, axis=1)).sum(axis=1)


def _convex(rings: Array) -> Mask:
    """Return which polygons (n, k, 3) turn the same way at each corner, once around."""
    normal = _normals(rings)
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    unit = normal / np.where(size > 0, size, 1.0)
    side = np.roll(rings, -1, axis=1) - rings
    before = np.roll(side, 1, axis=1)
    turn = np.einsum("nkc,nc->nk", np.cross(before, side), unit)
    ahead = np.einsum("nkc,nkc->nk", before, side)
    scale = np.linalg.norm(before, axis=2) * np.linalg.norm(side, axis=2)
    once = np.arctan2(turn, ahead).sum(axis=1) < 3 * np.pi
    return np.asarray((turn > _FLAT_CORNER * scale).all(axis=1) & once & (size[:, 0] > 0))


def _within(vertices: Array, rings: Ints, numbers: Ints, where: str) -> tuple[Ints, Ints]:
    """Return triangles within the outlines of polygons, and the polygon of each."""
    import shapely

    places = vertices[rings]
    places = places - places.mean(axis=1, keepdims=True)
    extent = np.linalg.svd(places, compute_uv=False)
    sized = extent[:, 1] > _NO_WIDTH * extent[:, 0]  # a line has no inside
    places, rings, numbers = places[sized], rings[sized], numbers[sized]
    flat = (
        np.stack([_flatten_polygon(place) for place in places]) if len(places) else places[..., :2]
    )
    area = np.abs(_shoelace(flat))
    triangles, owner = [np.zeros((0, 3), dtype=np.int64)], [np.zeros(0, dtype=np.int64)]
    indices = np.broadcast_to(np.arange(rings.shape[1], dtype=float), rings.shape)
    outlines: Any = shapely.polygons(np.dstack([flat, indices]))
    for ring, outline, points, own, number in zip(
        rings, outlines, flat, area, numbers, strict=True
    ):
        sound = shapely.is_valid(outline) or not _crosses(points)
        pieces = np.zeros((0, 3), dtype=np.int64)
        try:
            cut = shapely.get_parts(shapely.constrained_delaunay_triangles(outline))
            z = shapely.get_coordinates(cut, include_z=True)[:, 2]
            pieces = z.reshape(-1, 4)[:, :3].astype(np.int64)
        except shapely.GEOSException:
            sound = False
        doubled = _shoelace(points[pieces])
        if not sound or abs(np.abs(doubled).sum() - own) > _SAME_AREA * own:
            raise DataError(
                Message(
                    "face {number}, a polygon of {size} corners, crosses itself",
                    number=number + 1,
                    size=ring.size,
                ),
                where=where,
                allowed="polygons whose sides meet at corners alone",
                remedy="Mend it in the modelling program, or export triangles",
            )
        if _shoelace(points[None])[0] * doubled.sum() < 0:
            pieces = pieces[:, ::-1]
        triangles.append(ring[pieces])
        owner.append(np.full(len(pieces), number))
    return np.concatenate(triangles), np.concatenate(owner)


def _flatten_polygon(ring: Array) -> Array:
    """Return a polygon (k, 3) in the plane of its area, or of its spread where it has no area."""
    normal = _normals(ring[None])[0]
    _, _, axes = np.linalg.svd(ring, full_matrices=False)
    if np.linalg.norm(normal) <= _NO_WIDTH * float(np.abs(ring).max()) ** 2:
        return ring @ axes[:2].T
    normal /= np.linalg.norm(normal)
    along = axes[0] - (axes[0] @ normal) * normal
    along /= np.linalg.norm(along)
    return ring @ np.stack([along, np.cross(normal, along)]).T


def _shoelace(rings: Array) -> Array:
    """Return twice the signed areas of plane polygons (n, k, 2)."""
    x, y = rings[..., 0], rings[..., 1]
    return np.asarray((x * np.roll(y, -1, axis=-1) - np.roll(x, -1, axis=-1) * y).sum(axis=-1))


def _crosses(ring: Array) -> bool:
    """Return whether two sides of a plane polygon (k, 2) cross between their ends."""
    ends = np.roll(ring, -1, axis=0)
    side = ends - ring
    length = np.linalg.norm(side, axis=1)

    def beside(points: Array) -> Array:
        """Return on which side of each line (rows) points (columns) lie, 0 on it."""
        way = points[None] - ring[:, None]
        off = side[:, None, 0] * way[..., 1] - side[:, None, 1] * way[..., 0]
        return np.where(np.abs(off) > 1e-12 * length.max() * length[:, None], np.sign(off), 0.0)

    parted = beside(ring) * beside(ends) < 0
    return bool((parted & parted.T).any())
