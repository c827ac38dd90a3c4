"""The body between the land surface of a sole and its top, as wide as needed."""

import math
from itertools import pairwise
from typing import Any

import numpy as np

from underfoot.core.arrays import Array

from ..shape import Facet, HeelProfile, Rocker, SoleShape
from .modelling import MM, kernel
from .sole import SoleProfile, ToeSpring

MARGIN = 0.02  # m on both sides of the plan form
ENDS = 0.5e-3  # m behind and before it, where profiles still have their formula
_CROWN_NODES = 15


def slab(shape: SoleShape) -> Any:
    """Return the body over the unworn land: profile and crown below, the midsole's side above.

    Without a crown its pieces are planes and cylinders, exact; with one they are spline surfaces
    through points of the land (parabola across).
    """
    profile = side_face(shape)
    body = profile.Extrude(kernel().Vec(0.0, (shape.width + 2 * MARGIN) * MM, 0.0))
    if shape.crown_radius is None:
        return body

    crowned = None
    breaks = break_points(shape)
    for first, last in pairwise(breaks):
        piece = _crowned_piece(shape, first, last)
        crowned = piece if crowned is None else crowned + piece
    return body * crowned


def break_points(shape: SoleShape) -> list[float]:
    """Return the places along the sole where its profile changes its kind, margins included."""
    rear, toe = _parts(shape)
    inner: set[float] = set()
    if isinstance(rear, Facet):
        inner.add(rear.length)
    if isinstance(rear, Rocker):
        inner.add(rear.start)
    if toe is not None:
        inner.add(toe.start)
    inside = sorted(x for x in inner if 0.0 < x < shape.length)
    return [-ENDS, *inside, shape.length + ENDS]


def land_profile(shape: SoleShape, x: Array) -> Array:
    """Return the profile (m) at x, each curve carried on beyond the ends of the sole.

    ``HeelProfile.height`` holds its last height there, which would put a kink on the rim itself.
    """
    rear, toe = _parts(shape)
    height = rear.height(x)
    if isinstance(rear, Rocker):
        into = np.maximum(rear.start - x, 0.0)
        height = rear.radius - np.sqrt(np.maximum(rear.radius**2 - into**2, 0.0))
    if toe is not None:
        into = np.maximum(x - toe.start, 0.0)
        height = height + toe.radius - np.sqrt(np.maximum(toe.radius**2 - into**2, 0.0))
    return height


def _parts(shape: SoleShape) -> tuple[HeelProfile, ToeSpring | None]:
    profile = shape.profile
    if isinstance(profile, SoleProfile):
        return profile.rear, profile.toe
    return profile, None


def side_face(shape: SoleShape) -> Any:
    """Return the outline of the slab seen from the side, at y = -width/2 - margin."""
    breaks = break_points(shape)
    y = (-shape.width / 2 - MARGIN) * MM
    top = _top(shape)

    def point(x: float, z: float) -> Any:
        return kernel().Pnt(x * MM, y, z * MM)

    def land(x: float) -> float:
        return float(land_profile(shape, np.array([x]))[0])

    below = [
        _curve(point, [(x, land(x)) for x in (a, (a + b) / 2, b)]) for a, b in pairwise(breaks)
    ]
    above = [
        _curve(point, [(x, top(x)) for x in (b, (a + b) / 2, a)])
        for a, b in reversed(list(pairwise(breaks)))
    ]
    low, high = breaks[0], breaks[-1]
    rise = kernel().Segment(point(high, land(high)), point(high, top(high)))
    fall = kernel().Segment(point(low, top(low)), point(low, land(low)))
    return kernel().Face(kernel().Wire([*below, rise, *above, fall]))


def _top(shape: SoleShape) -> Any:
    """Return the height (m) of the sole's upper side against x: it follows the toe spring."""
    toe = _parts(shape)[1]

    def height(x: float) -> float:
        if toe is None:
            return shape.outsole_thickness
        into = max(x - toe.start, 0.0)
        return shape.outsole_thickness + toe.radius - math.sqrt(toe.radius**2 - into**2)

    return height


def _curve(point: Any, places: list[tuple[float, float]]) -> Any:
    """Return the line or arc through three places (x, z)."""
    (x0, z0), (_, z1), (x2, z2) = places
    if abs(z1 - (z0 + z2) / 2) < 1e-9:
        return kernel().Segment(point(x0, z0), point(x2, z2))
    return kernel().ArcOfCircle(*(point(x, z) for x, z in places))


def _crowned_piece(shape: SoleShape, first: float, last: float) -> Any:
    """Return everything over the crowned land between two places, up to beyond the top."""
    assert shape.crown_radius is not None
    x = np.linspace(first, last, _CROWN_NODES)
    half = shape.width / 2 + MARGIN
    y = np.linspace(-half, half, _CROWN_NODES)
    grid_x, grid_y = np.meshgrid(x, y, indexing="ij")
    z = land_profile(shape, grid_x) + grid_y**2 / (2 * shape.crown_radius)
    surface = kernel().SplineSurfaceInterpolation(np.stack([grid_x, grid_y, z], axis=-1) * MM)
    top = shape.outsole_thickness + float(z.max())
    return surface.Extrude(kernel().Vec(0.0, 0.0, 2 * top * MM))
