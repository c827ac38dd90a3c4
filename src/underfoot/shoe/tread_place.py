"""Where a tread lies among treads: how far two are apart in what lets a film drain."""

import math

import numpy as np

from underfoot.core.arrays import Array

from .geometry import SoleMap

HEEL = 30e-3
"""m: 2 area / perimeter of a heel of 60 mm, the lug that a sole without tread is."""
CHANNEL, DEPTH, EDGE = 1e-3, 1e-3, 0.1e-3
"""m: a channel, a depth and a rounding of an edge that are next to none."""
TURN = 2.0
"""Between walls all across the sliding and walls in every direction."""


def tread_place(sole: SoleMap, edge_radius: float = 0.0) -> Array:
    """Return (6,) coordinates of a tread; all 0 without one.

        x = (log2(1 + 30 mm W), log2(1 + c / 1 mm), log2(1 + d / 1 mm), 2 f q_1, 2 f |q_2|,
             f log4(1 + r / 0.1 mm)),  f = 30 mm W / (1 + 30 mm W)

    W = P / A the walls' length over the area of land (2 / W is the width of bars), c = 2 (channel
    area) / P, d the mean height of the lugs, q_1 = (P_x - P_y) / (P_x + P_y) from the walls that
    face along and across the sliding (1 for bars across, -1 along, 0 for hexagons), q_2 the same
    between both diagonals (1 for bars at 45 degrees; a mirror image is as far), r ``edge_radius``
    (m). Share of land follows from lug and channel. One apart is a lug or channel twice as wide or
    deep: the time in which a film leaves goes with their square and cube, so that what is wiped
    under one may be sealed under the other. Between bars across and hexagons lies 2.

    Walls are counted between cells (Crofton, four directions; 5 % on length); the area of lugs is
    that of ``sole.cut``.
    """
    land, inside = sole.land, sole.inside
    walls = [
        np.count_nonzero((land[a] != land[b]) & inside[a] & inside[b])
        for a, b in (
            (np.s_[1:, :], np.s_[:-1, :]),
            (np.s_[:, 1:], np.s_[:, :-1]),
            (np.s_[1:, 1:], np.s_[:-1, :-1]),
            (np.s_[1:, :-1], np.s_[:-1, 1:]),
        )
    ]
    x, y, up, down = walls
    length = math.pi / 8 * sole.spacing * (x + y + math.sqrt(0.5) * (up + down))
    if not length:
        return np.zeros(6)
    area = np.ones(land.shape) if sole.cut is None else sole.cut.area
    wall_density = length / sole.land_area
    share = HEEL * wall_density / (1 + HEEL * wall_density)
    channel = 2 * float(area[inside & ~land].sum()) * sole.spacing**2 / length
    depth = float(np.average(sole.tread_depth[land], weights=area[land]))
    return np.array(
        [
            math.log2(1 + HEEL * wall_density),
            math.log2(1 + channel / CHANNEL),
            math.log2(1 + depth / DEPTH),
            TURN * share * (x - y) / max(x + y, 1),
            TURN * share * abs(up - down) / max(up + down, 1),
            share * math.log2(1 + edge_radius / EDGE) / 2,
        ]
    )
