"""Signed distances of tread patterns: positive in a channel, negative on a lug; exact.

All functions take coordinates in the frame of the pattern (m) and return m. The distance to the
nearest wall is exact on both sides, so that edges can be rounded and fillets agree with solids.
"""

import math

import numpy as np

from underfoot.core.arrays import Array

WAVE_SEGMENTS = 12
"""Straight pieces of half a wave, in the map and in the solid: within 0.3 % of its height."""
_NEAR = 8  # pieces of walls whose distance is compared
_ROUNDING = 1e-12  # m: keeps a cell centre on an edge from falling on either side by rounding


def bar_distance(along: Array, lug: float, channel: float) -> Array:
    """Return the distance for bars that repeat along one direction, the first from 0 to ``lug``."""
    pitch = lug + channel
    place = np.mod(along + _ROUNDING, pitch)
    into = np.minimum(place - lug, pitch - place)
    return np.where(place >= lug, np.maximum(into, 0.0), -np.minimum(place, -into))


def block_distance(
    x: Array, y: Array, lugs: tuple[float, float], channels: tuple[float, float]
) -> Array:
    """Return the distance for rectangular lugs in rows and columns, the first begins at (0, 0)."""
    outside, inside = np.zeros_like(x), np.full_like(x, -np.inf)
    for place, lug, channel in ((x, lugs[0], channels[0]), (y, lugs[1], channels[1])):
        into = bar_distance(place, lug, channel)
        outside = np.hypot(outside, np.maximum(into, 0.0))
        inside = np.maximum(inside, into)
    return np.where(inside > 0, outside, inside)


def circle_distance(x: Array, y: Array, diameter: float, channel: float) -> Array:
    """Return the distance for round lugs in a triangular lattice, one centred at (0, 0).

    Rows run along x, ``channel`` is the smallest gap between neighbours.
    """
    near_x, near_y = _nearest_lattice_point(x, y, diameter + channel)
    return np.hypot(x - near_x, y - near_y) - diameter / 2


def hexagon_distance(x: Array, y: Array, width: float, channel: float) -> Array:
    """Return the distance for hexagons of width ``width`` across flats, one centred at (0, 0).

    Neighbours stand flat to flat, a channel of one width between them; flats face x.
    """
    near_x, near_y = _nearest_lattice_point(x, y, width + channel)
    return _hexagon(np.abs(x - near_x), np.abs(y - near_y), width / 2)


def ring_distance(x: Array, y: Array, diameter: float, channel: float, wall: float) -> Array:
    """Return the distance for rings of ``wall`` in a triangular lattice, as ``circle_distance``."""
    near_x, near_y = _nearest_lattice_point(x, y, diameter + channel)
    radius = np.hypot(x - near_x, y - near_y)
    return np.maximum(radius - diameter / 2, diameter / 2 - wall - radius)


def graded_circle_distance(
    x: Array, y: Array, diameters: tuple[float, float], channel: float, length: float
) -> Array:
    """Return the distance for round lugs whose diameter grows along x, from 0 to ``length``.

    The lattice is that of the larger diameter, so that ``channel`` is the smallest gap. Circles do
    not overlap: the nearest wall is that of the nearest lattice point or of one of its neighbours.
    """
    first, last = diameters
    pitch = max(diameters) + channel
    near_x, near_y = _nearest_lattice_point(x, y, pitch)
    best = np.full(x.shape, np.inf)
    around = [(0.0, 0.0), *((math.cos(a), math.sin(a)) for a in np.arange(6) * math.pi / 3)]
    for along, across in around:
        middle = near_x + pitch * along
        diameter = graded_diameter(middle, first, last, length)
        away = np.hypot(x - middle, y - near_y - pitch * across)
        best = np.minimum(best, away - diameter / 2)
    return best


def graded_diameter(middle: Array, first: float, last: float, length: float) -> Array:
    """Return the diameter (m) of a lug centred at ``middle`` along x."""
    return first + (last - first) * np.clip(middle / length, 0.0, 1.0)


def folded_bar_distance(
    x: Array, y: Array, half: tuple[Array, Array], lug: float, channel: float
) -> Array:
    """Return the distance for bars whose walls follow one line that is folded at its ends.

    ``half`` holds (y, x) of the line over half a period, y from 0 upwards; ``lug`` and ``channel``
    are measured along x. By mirror symmetry about both ends the nearest wall lies in the same half
    period, so its distance is that to the segments of the line.
    """
    nodes_y, nodes_x = half
    arm, pitch = float(nodes_y[-1]), lug + channel
    fold = np.abs(np.mod(y + arm, 2 * arm) - arm)
    line = np.interp(fold, nodes_y, nodes_x)
    row = np.mod(x - line + _ROUNDING, pitch)
    place = row + line  # along x from the wall of this row
    nearest = np.full(x.shape, np.inf)
    for wall in (0.0, lug, pitch):
        for k in range(nodes_y.size - 1):
            dx, dy = nodes_x[k + 1] - nodes_x[k], nodes_y[k + 1] - nodes_y[k]
            from_x, from_y = place - wall - nodes_x[k], fold - nodes_y[k]
            share = np.clip((from_x * dx + from_y * dy) / (dx * dx + dy * dy), 0.0, 1.0)
            nearest = np.minimum(nearest, np.hypot(from_x - share * dx, from_y - share * dy))
    return np.where(row >= lug, nearest, -nearest)


def zigzag_line(arm: float, angle: float) -> tuple[Array, Array]:
    """Return (y, x) of half a zigzag: back from the tip at ``angle`` (rad) to y over ``arm``."""
    return np.array([0.0, arm]), np.array([0.0, -arm * math.tan(angle)])


def wave_line(length: float, height: float) -> tuple[Array, Array]:
    """Return (y, x) of half a cosine of wave ``length`` and ``height``, crest to trough."""
    y = np.linspace(0.0, length / 2, WAVE_SEGMENTS + 1)
    return y, height / 2 * (np.cos(2 * math.pi * y / length) - 1)


def outline_distance(x: Array, y: Array, segments: Array, corner: Array, pitch: Array) -> Array:
    """Return the distance for closed outlines that repeat along x and y.

    The walls are split into pieces of at most 1/200 of the period; of the pieces with the nearest
    middles the distance to the nearest is taken, which is exact within half a piece.

    Args:
        segments: (n, 4) walls as x0, y0, x1, y1 within one period, holes included, m.
        corner: Lowest (x, y) of that period, m.
        pitch: Its extents, m.
    """
    place = corner + np.mod(np.column_stack([x.ravel(), y.ravel()]) - corner, pitch)
    begin, way = segments[:, :2], segments[:, 2:] - segments[:, :2]
    count = np.ceil(np.hypot(*way.T) / (pitch.max() / 200)).astype(int)
    which = np.repeat(np.arange(count.size), count)
    part = np.arange(which.size) - np.repeat(np.cumsum(count) - count, count)
    step = (way / count[:, None])[which]
    pieces = begin[which] + step * part[:, None]
    around = [pitch * (i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    pieces = np.concatenate([pieces + shift for shift in around])
    step = np.tile(step, (len(around), 1))
    from scipy.spatial import KDTree  # heavy, and only patterns of outlines need it

    _, near = KDTree(pieces + step / 2).query(place, k=_NEAR)
    from_piece, along = place[:, None] - pieces[near], step[near]
    share = (from_piece * along).sum(axis=2) / (along * along).sum(axis=2)
    beside = from_piece - np.clip(share, 0.0, 1.0)[..., None] * along
    distance = np.hypot(beside[..., 0], beside[..., 1]).min(axis=1)
    within = np.zeros(len(place), dtype=bool)
    for x0, y0, x1, y1 in segments:  # even-odd rule: walls crossed on the way to larger x
        if y0 != y1:
            passes = (place[:, 1] >= min(y0, y1)) & (place[:, 1] < max(y0, y1))
            within ^= passes & (place[:, 0] < x0 + (place[:, 1] - y0) * (x1 - x0) / (y1 - y0))
    return np.where(within, -distance, distance).reshape(x.shape)


def rotate_coordinates(x: Array, y: Array, angle: float) -> tuple[Array, Array]:
    """Return coordinates in a frame that is turned by ``angle`` (rad, anticlockwise)."""
    if angle == 0.0:
        return x, y
    cosine, sine = math.cos(angle), math.sin(angle)
    return x * cosine + y * sine, y * cosine - x * sine


def _nearest_lattice_point(x: Array, y: Array, pitch: float) -> tuple[Array, Array]:
    """Return the nearest point of a triangular lattice with rows along x through (0, 0)."""
    height = pitch * math.sqrt(3.0)
    best_x, best_y, best = np.zeros_like(x), np.zeros_like(y), np.full(x.shape, np.inf)
    for shift_x, shift_y in ((0.0, 0.0), (pitch / 2, height / 2)):
        at_x = np.rint((x - shift_x) / pitch) * pitch + shift_x
        at_y = np.rint((y - shift_y) / height) * height + shift_y
        far = (x - at_x) ** 2 + (y - at_y) ** 2
        closer = far < best
        best = np.where(closer, far, best)
        best_x, best_y = np.where(closer, at_x, best_x), np.where(closer, at_y, best_y)
    return best_x, best_y


def _hexagon(x: Array, y: Array, apothem: float) -> Array:
    """Return the signed distance from a hexagon with flats facing x; x, y are both positive."""
    # fold at the mirror of 30 degrees onto the sector of the flat that faces x
    tall = math.sqrt(3.0) / 2
    beyond = np.maximum(tall * y - 0.5 * x, 0.0)
    x, y = x + beyond, y - 2 * tall * beyond
    half_side = apothem / math.sqrt(3.0)
    aside = np.maximum(np.abs(y) - half_side, 0.0)
    return np.where(x > apothem, np.hypot(x - apothem, aside), x - apothem)
