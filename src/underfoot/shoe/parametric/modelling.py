"""Outlines, wires, faces and prisms of the modelling kernel from arrays in m; it counts in mm."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from underfoot.core.arrays import Array
from underfoot.core.optional import optional_module

from .._kernels.tread_pattern import graded_diameter
from ..shape import SoleShape
from ..tread import LATTICES, Groove, Tread


@dataclass(frozen=True, slots=True)
class Outline:
    """One lug from below: a polygon (n, 2) anticlockwise, or a circle about its only point; m.

    ``holes`` are polygons within it.
    """

    points: Array
    radius: float = 0.0
    holes: tuple[Array, ...] = ()


def lug_outlines(shape: SoleShape, tread: Tread) -> list[Outline]:
    """Return the outlines of all lugs that reach into the plan form, anticlockwise, whole."""
    reach = math.hypot(shape.length, shape.width) / 2 + tread.lug_width
    centre = np.array([shape.length / 2, 0.0]) - np.array(tread.offset)
    turn = 0.0 if tread.pattern == "chevrons" else tread.angle
    cosine, sine = math.cos(turn), math.sin(turn)
    back = np.array([[cosine, -sine], [sine, cosine]])
    outlines = []
    for outline, size in _in_pattern(tread, centre @ back, reach):
        points = outline.points @ back.T + np.array(tread.offset)
        if size > 0:
            middle = points.mean(axis=0)
            if float(shape.inward_distance(middle[:1], middle[1:])[0]) <= -size:
                continue
        holes = tuple(hole @ back.T + np.array(tread.offset) for hole in outline.holes)
        outlines.append(Outline(points, outline.radius, holes))
    return outlines


def slit_outlines(
    shape: SoleShape, width: float, spacing: float, angle: float, first: float
) -> list[Outline]:
    """Return rectangles of ``width`` (m) every ``spacing`` across the whole sole."""
    reach, cosine, sine = math.hypot(shape.length, shape.width), math.cos(angle), math.sin(angle)
    centre = shape.length / 2 * cosine
    begin = math.floor((centre - reach / 2 - first) / spacing)
    end = math.ceil((centre + reach / 2 - first) / spacing)
    middles = [first + k * spacing for k in range(begin, end + 1)]
    slits = [Groove((at * cosine, at * sine), width, angle=angle) for at in middles]
    return groove_outlines(shape, slits)


def groove_outlines(shape: SoleShape, grooves: Sequence[Groove]) -> list[Outline]:
    """Return the rectangles of grooves; what goes right across ends beyond the sole."""
    outlines = []
    for groove in grooves:
        cosine, sine = math.cos(groove.angle), math.sin(groove.angle)
        half = min(groove.length, 4 * (shape.length + shape.width)) / 2
        corners = _rectangle(-groove.width / 2, -half, groove.width / 2, half)
        turned = corners @ np.array([[cosine, sine], [-sine, cosine]])
        outlines.append(Outline(turned + groove.place))
    return outlines


def _in_pattern(tread: Tread, centre: Array, reach: float) -> Iterator[tuple[Outline, float]]:
    """Yield outlines in the frame of the pattern and their half size (0: endless bars)."""
    lug, pitch = tread.lug_width, tread.pitch
    low, high = centre - reach, centre + reach
    if tread.letters is not None:
        for shell, holes in tread.letters.outlines(low, high):
            outline = Outline(_anticlockwise(shell), holes=tuple(map(_anticlockwise, holes)))
            yield outline, float(np.hypot(*np.ptp(shell, axis=0)))
    elif tread.pattern in LATTICES:
        for row in range(*_range(low[1], high[1], pitch * math.sqrt(3) / 2)):
            shift = lug / 2 + (pitch / 2 if row % 2 else 0.0)
            for column in range(*_range(low[0] - shift, high[0] - shift, pitch)):
                at = np.array([column * pitch + shift, row * pitch * math.sqrt(3) / 2])
                if tread.pattern != "hexagons":
                    radius = _round_lug(tread, at[0] - lug / 2) / 2
                    yield Outline(at[None, :], radius), radius
                else:
                    angle = math.pi / 6 + np.arange(6) * math.pi / 3
                    corner = lug / math.sqrt(3) * np.column_stack([np.cos(angle), np.sin(angle)])
                    yield Outline(at + corner), lug / math.sqrt(3)
    elif tread.pattern in ("grid", "blocks"):
        length = tread.lug_length or lug
        long_pitch = length + tread.channel_width
        for row in range(*_range(low[0], high[0], long_pitch)):
            for column in range(*_range(low[1], high[1], pitch)):
                x, y = row * long_pitch, column * pitch - lug / 2
                yield Outline(_rectangle(x, y, x + length, y + lug)), math.hypot(length, lug) / 2
    elif tread.wall_line is not None:
        yield from ((Outline(points), 0.0) for points in _folded_bars(tread, low, high))
    elif tread.pattern == "longitudinal":
        for column in range(*_range(low[1], high[1], pitch)):
            y = column * pitch - lug / 2
            yield Outline(_rectangle(low[0], y, high[0], y + lug)), 0.0
    else:
        for row in range(*_range(low[0], high[0], pitch)):
            yield Outline(_rectangle(row * pitch, low[1], row * pitch + lug, high[1])), 0.0


def _round_lug(tread: Tread, along: float) -> float:
    """Return the diameter (m) of a round lug centred ``along`` (m) from the first one."""
    if tread.front_lug_width is None or tread.graded_length is None:
        return tread.lug_width
    ends = (tread.lug_width, tread.front_lug_width, tread.graded_length)
    return float(graded_diameter(np.array(along), *ends))


def _anticlockwise(ring: Array) -> Array:
    x, y = ring.T
    return ring if np.dot(x, np.roll(y, -1)) > np.dot(y, np.roll(x, -1)) else ring[::-1]


def hollow_outlines(lugs: list[Outline], tread: Tread) -> list[Outline]:
    """Return the outlines of what is hollow within the lugs: of rings and letters, else nothing."""
    if tread.ring_width is None:
        return [Outline(hole) for lug in lugs for hole in lug.holes]
    return [Outline(lug.points, lug.radius - tread.ring_width) for lug in lugs]


def _folded_bars(tread: Tread, low: Array, high: Array) -> Iterator[Array]:
    assert tread.wall_line is not None  # of chevrons and waves
    nodes_y, nodes_x = tread.wall_line
    stretch = 1 / math.cos(tread.angle) if tread.pattern == "chevrons" else 1.0
    lug, pitch = tread.lug_width * stretch, tread.pitch * stretch
    # a whole period: the line and its mirror image
    half = float(nodes_y[-1])
    period_y = np.concatenate([nodes_y, 2 * half - nodes_y[-2:0:-1]])
    period_x = np.concatenate([nodes_x, nodes_x[-2:0:-1]])
    first, last = math.floor(low[1] / (2 * half)), math.ceil(high[1] / (2 * half))
    y = np.concatenate([period_y + 2 * half * k for k in range(first, last)])
    y = np.append(y, 2 * half * last)
    back = np.append(np.tile(period_x, last - first), nodes_x[0])
    spread = float(np.ptp(nodes_x))
    for row in range(*_range(low[0] - spread, high[0] + spread, pitch)):
        rear = np.column_stack([row * pitch + back, y])
        front = np.column_stack([row * pitch + lug + back, y])
        yield np.concatenate([front, rear[::-1]])


def _range(low: float, high: float, pitch: float) -> tuple[int, int]:
    return math.floor(low / pitch) - 1, math.ceil(high / pitch) + 2


def _rectangle(x0: float, y0: float, x1: float, y1: float) -> Array:
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


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


def raise_face(face: Any, height: float) -> Any:
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
