"""Wires, faces and prisms of the modelling kernel from arrays in m; the kernel counts in mm."""

import math
from typing import Any

import numpy as np

from underfoot.core.arrays import Array
from underfoot.core.optional import optional_module

from .lugs import Outline

MM = 1e3


def kernel() -> Any:
    """Return the modelling kernel, which is loaded when the first solid is made."""
    return optional_module("netgen.occ", "cad", "Making the solid of a sole")


def polygon_wire(points: Array, height: float) -> Any:
    """Return the closed wire through points (n, 2) at one height, m."""
    corners = [
        kernel().Pnt(*(float(value) * MM for value in point), height * MM) for point in points
    ]
    return kernel().Wire(
        [kernel().Segment(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    )


def outline_wire(outline: Outline, height: float) -> Any:
    """Return the wire of a lug, anticlockwise seen from above."""
    if outline.radius == 0.0:
        return polygon_wire(outline.points, height)
    x, y = outline.points[0]
    half = [arc_edge(x, y, outline.radius, first, height) for first in (0.0, math.pi)]
    return kernel().Wire(half)


def arc_edge(x: float, y: float, radius: float, first: float, height: float) -> Any:
    """Return the half circle about (x, y) that begins at the angle ``first``, anticlockwise."""
    places = [first, first + math.pi / 2, first + math.pi]
    points = [
        kernel().Pnt((x + radius * math.cos(a)) * MM, (y + radius * math.sin(a)) * MM, height * MM)
        for a in places
    ]
    return kernel().ArcOfCircle(*points)


def rim_face(arcs: Array, height: float) -> Any:
    """Return the face within a rim of arcs (n, 7) at one height."""
    edges = []
    for x0, y0, x1, y1, cx, cy, radius in arcs:
        start, end = (
            kernel().Pnt(x0 * MM, y0 * MM, height * MM),
            kernel().Pnt(x1 * MM, y1 * MM, height * MM),
        )
        if math.isinf(radius):
            edges.append(kernel().Segment(start, end))
            continue
        middle = np.array([x0 + x1, y0 + y1]) / 2 - (cx, cy)
        size = float(np.hypot(*middle))
        # of a half circle the middle of the chord is the centre
        away = middle / size if size > 1e-9 else np.array([y1 - y0, x0 - x1]) / (2 * abs(radius))
        over = np.array([cx, cy]) + abs(radius) * away
        edges.append(
            kernel().ArcOfCircle(start, kernel().Pnt(over[0] * MM, over[1] * MM, height * MM), end)
        )
    return kernel().Face(kernel().Wire(edges))


def raised(face: Any, height: float) -> Any:
    """Return the prism of a face up by ``height`` (m)."""
    return face.Extrude(height * MM * kernel().Z)


def plate_with_holes(outlines: list[Outline], height: float) -> Any:
    """Return a rectangle around all outlines, without them."""
    places = np.concatenate([outline.points for outline in outlines])
    margin = 1e-3 + max((outline.radius for outline in outlines), default=0.0)
    low, high = places.min(axis=0) - margin, places.max(axis=0) + margin
    outer = polygon_wire(np.array([low, [high[0], low[1]], high, [low[0], high[1]]]), height)
    holes = [outline_wire(outline, height).Reversed() for outline in outlines]
    return kernel().Face(kernel().Face(outer), [outer, *holes])
