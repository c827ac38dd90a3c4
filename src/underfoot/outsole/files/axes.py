"""How an outsole lies in its file: its thin direction, its long one and the one across."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .settings import DIRECTIONS, FileSettings

Array = NDArray[np.float64]
_SAMPLE = 200_000  # triangles: more change the axes by less than the snapping
_SNAP = math.cos(math.radians(20))
_NEARLY = 1.10  # a box along the file's axes may be this much larger than the smallest one


def unit_vector(direction: str) -> Array:
    """Return the unit vector of a direction such as "-z"."""
    vector = np.zeros(3)
    vector["xyz".index(direction[1])] = 1.0 if direction[0] == "+" else -1.0
    return vector


def named_direction(vector: Array) -> str:
    """Return "+x" and so on for a vector along an axis of the file, else its components."""
    for name in DIRECTIONS:
        if float(vector @ unit_vector(name)) > 1 - 1e-6:
            return name
    return "(" + ", ".join(f"{value:.2f}" for value in vector) + ")"


def box_axes(triangles: NDArray[np.float32], settings: FileSettings) -> Array:
    """Return rows (long, across, thin), a right-handed frame; signs still mean nothing.

    Thin: the direction in which the area spreads least (second moments of the triangles), taken
    as the file's axis when within 20 degrees of it. Long and across: the smallest rectangle around
    the plan form, or the file's axes when that rectangle is less than 10 % larger.
    """
    centres, weights = _sample(triangles)
    if settings.down in DIRECTIONS:
        thin = unit_vector(settings.down)
    else:
        moments = np.cov(centres.T, aweights=weights)
        _, vectors = np.linalg.eigh(moments)
        thin = _snapped(np.asarray(vectors[:, 0], dtype=np.float64))
        if settings.forward in DIRECTIONS:
            forward = unit_vector(settings.forward)
            thin = thin - (thin @ forward) * forward
            thin = _snapped(thin / np.linalg.norm(thin))
    if settings.forward in DIRECTIONS:
        along = unit_vector(settings.forward)
        along = along - (along @ thin) * thin
        along /= np.linalg.norm(along)
        return np.stack([along, np.cross(thin, along), thin])
    along = _long_axis(centres, thin)
    return np.stack([along, np.cross(thin, along), thin])


def _sample(triangles: NDArray[np.float32]) -> tuple[Array, Array]:
    chosen = triangles[:: max(1, triangles.shape[0] // _SAMPLE)].astype(np.float64)
    chosen = chosen[np.isfinite(chosen).all(axis=(1, 2))]
    sides = chosen[:, 1:] - chosen[:, :1]
    weights = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    centres = chosen.mean(axis=1)
    return centres - np.average(centres, axis=0, weights=np.maximum(weights, 1e-30)), weights


def _snapped(vector: Array) -> Array:
    axis = int(np.argmax(np.abs(vector)))
    if abs(vector[axis]) < _SNAP:
        return vector
    found = np.zeros(3)
    found[axis] = math.copysign(1.0, vector[axis])
    return found


def _long_axis(centres: Array, thin: Array) -> Array:
    """Return the longer side of the smallest rectangle around the points seen along ``thin``."""
    from scipy.spatial import ConvexHull

    start = np.eye(3)[int(np.argmin(np.abs(thin)))]
    u = start - (start @ thin) * thin
    u /= np.linalg.norm(u)
    v = np.cross(thin, u)
    points = np.asarray(np.column_stack([centres @ u, centres @ v]), dtype=np.float64)
    hull = points[ConvexHull(points).vertices]
    edges = np.roll(hull, -1, axis=0) - hull
    angles = np.unique(np.mod(np.arctan2(edges[:, 1], edges[:, 0]), math.pi / 2).round(3))
    best = min(angles, key=lambda angle: math.prod(_extents(hull, angle)))
    for axis in np.eye(3):
        if abs(axis @ thin) > 1e-6:
            continue
        angle = math.atan2(float(axis @ v), float(axis @ u))
        if math.prod(_extents(hull, angle)) <= _NEARLY * math.prod(_extents(hull, best)):
            best = angle
            break
    length, width = _extents(hull, best)
    if width > length:
        best += math.pi / 2
    return math.cos(best) * u + math.sin(best) * v


def _extents(points: Array, angle: float) -> tuple[float, float]:
    cosine, sine = math.cos(angle), math.sin(angle)
    along = points @ np.array([cosine, sine])
    across = points @ np.array([-sine, cosine])
    return float(np.ptp(along)), float(np.ptp(across))
