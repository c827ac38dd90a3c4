"""Signed distances of tread patterns: positive in a channel, negative on a lug; exact.

All functions take coordinates in the frame of the pattern (m) and return m. The distance to the
nearest wall is exact on both sides, so that edges can be rounded and fillets agree with solids.
"""

import math

import numpy as np

from underfoot.core.arrays import Array

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


def chevron_distance(
    x: Array, y: Array, lug: float, channel: float, arm: float, angle: float
) -> Array:
    """Return the distance for zigzag bars, their tips on y = 0, +-2 arm, ...

    The walls run at ``angle`` (rad) to y, back from the tips; ``lug`` and ``channel`` are measured
    normal to them, ``arm`` is the extent of one arm along y. By mirror symmetry about each tip the
    nearest wall lies in the same half period, so its distance is that to a segment.
    """
    stretch = 1.0 / math.cos(angle)
    pitch = (lug + channel) * stretch
    fold = np.abs(np.mod(y + arm, 2 * arm) - arm)
    slope = math.tan(angle)
    row = np.mod(x + slope * fold + _ROUNDING, pitch)
    in_channel = row >= lug * stretch
    nearest = np.full(x.shape, np.inf)
    length = math.hypot(arm, arm * slope)
    tangent = (-arm * slope / length, arm / length)
    offset_x = row - slope * fold  # of the wall through (0, 0) of this row
    for wall in (0.0, lug * stretch, pitch):
        dx = offset_x - wall
        along = np.clip(dx * tangent[0] + fold * tangent[1], 0.0, length)
        nearest = np.minimum(nearest, np.hypot(dx - along * tangent[0], fold - along * tangent[1]))
    return np.where(in_channel, nearest, -nearest)


def rotated(x: Array, y: Array, angle: float) -> tuple[Array, Array]:
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
