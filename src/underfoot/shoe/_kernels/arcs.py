"""Closed curves of arcs that meet without a kink: exact signed distance and joining arcs."""

import math

import numpy as np

from underfoot.core.arrays import Array

STRAIGHT = 1e6  # m: a radius this large is a line
BLOCK = 1 << 15
"""Points of a block, for which arcs too far off to be its nearest are left out (measured)."""


def inward_distance(x: Array, y: Array, arcs: Array) -> Array:
    """Return the distance (m) from a closed anticlockwise curve, positive inside.

    ``arcs`` (n, 7): start x, y, end x, y, centre x, y and radius in m; the radius is positive where
    the curve turns left, infinite for a line. x, y are flat arrays of one length.
    """
    if x.size <= BLOCK:
        return _distance(x, y, arcs)
    signed = np.empty(x.size)
    for first in range(0, x.size, BLOCK):
        block = slice(first, first + BLOCK)
        ends = np.array([[each[block].min(), each[block].max()] for each in (x, y)])
        (at_x, at_y), across = ends.mean(axis=1)[:, None], float(np.hypot(*np.ptp(ends, axis=1)))
        off = np.abs([_distance(at_x, at_y, arcs[k : k + 1])[0] for k in range(len(arcs))])
        near = off <= off.min() + across * (1 + 1e-9)
        signed[block] = _distance(x[block], y[block], arcs[near])
    return signed


def _distance(x: Array, y: Array, arcs: Array) -> Array:
    signed = np.full(x.size, np.inf)
    for x0, y0, x1, y1, cx, cy, radius in arcs:
        if math.isinf(radius):
            length = math.hypot(x1 - x0, y1 - y0)
            tx, ty = (x1 - x0) / length, (y1 - y0) / length
            along = np.clip((x - x0) * tx + (y - y0) * ty, 0.0, length)
            far = np.hypot(x - x0 - along * tx, y - y0 - along * ty)
            side = tx * (y - y0) - ty * (x - x0)
        else:
            dx, dy = x - cx, y - cy
            turn = 1.0 if radius > 0 else -1.0
            # within the sector: left of the start's ray and right of the end's (turned)
            after = turn * ((x0 - cx) * dy - (y0 - cy) * dx)
            before = turn * (dx * (y1 - cy) - dy * (x1 - cx))
            distance = np.hypot(dx, dy)
            ends = np.minimum(np.hypot(x - x0, y - y0), np.hypot(x - x1, y - y1))
            facing = (after >= 0.0) & (before >= 0.0)
            far = np.where(facing, np.abs(distance - abs(radius)), ends)
            side = turn * (abs(radius) - distance)
        signed = np.where(far < np.abs(signed), np.where(side >= 0.0, far, -far), signed)
    return signed


def biarc(start: Array, start_tangent: Array, end: Array, end_tangent: Array) -> list[Array]:
    """Return two arcs (7,) from point to point with the unit tangents given, equal leg lengths.

    Both legs d satisfy |v - d (t0 + t1)| = 2 d with v = end - start; none may turn by more than a
    half circle.
    """
    v, t = end - start, start_tangent + end_tangent
    quadratic = 2 * (1 - float(start_tangent @ end_tangent))
    vv, vt = float(v @ v), float(v @ t)
    leg = 0.0  # parallel tangents: the middle is half way, whatever the legs are
    if quadratic > 1e-12:
        leg = (-vt + math.sqrt(vt * vt + quadratic * vv)) / quadratic
    middle = (start + end + leg * (start_tangent - end_tangent)) / 2
    first = arc(start, start_tangent, middle)
    last = arc(end, -end_tangent, middle)
    reverse = np.array([last[2], last[3], last[0], last[1], last[4], last[5], -last[6]])
    return [first, reverse]


def arc(start: Array, tangent: Array, end: Array) -> Array:
    """Return the arc (7,) from ``start`` along ``tangent`` to ``end``; a line where it is one."""
    v = end - start
    normal = np.array([-tangent[1], tangent[0]])
    aside = float(normal @ v)
    length = float(v @ v)
    if abs(aside) * STRAIGHT <= length:
        return np.array([*start, *end, 0.0, 0.0, math.inf])
    radius = length / (2 * aside)
    centre = start + radius * normal
    return np.array([*start, *end, *centre, radius])


def points_on(arcs: Array, most: float) -> Array:
    """Return the closed polygon (n, 2) on the arcs, no edge longer than ``most`` (m)."""
    points = []
    for x0, y0, x1, y1, cx, cy, radius in arcs:
        if math.isinf(radius):
            count = max(1, math.ceil(math.hypot(x1 - x0, y1 - y0) / most))
            share = np.arange(count)[:, None] / count
            points.append((1 - share) * np.array([x0, y0]) + share * np.array([x1, y1]))
            continue
        first = math.atan2(y0 - cy, x0 - cx)
        sweep = math.atan2(y1 - cy, x1 - cx) - first
        sweep = sweep % (2 * math.pi) if radius > 0 else -((-sweep) % (2 * math.pi))
        count = max(2, math.ceil(abs(sweep * radius) / most))
        angle = first + sweep * np.arange(count) / count
        size = abs(radius)
        points.append(np.column_stack([cx + size * np.cos(angle), cy + size * np.sin(angle)]))
    polygon = np.concatenate(points)
    return np.concatenate([polygon, polygon[:1]])
