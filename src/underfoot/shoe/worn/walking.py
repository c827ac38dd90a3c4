"""Wear by walking: the floor cuts the sole at every angle of landing, as far as it is loaded."""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core.arrays import Array
from underfoot.core.checks import not_negative

from ..shape import SoleShape

SHARES = (
    *(0.266, 0.139, 0.092, 0.078, 0.069, 0.056, 0.049, 0.041, 0.037),
    *(0.036, 0.033, 0.029, 0.024, 0.019, 0.015, 0.009, 0.004, 0.004),
)
LANDING = tuple((math.radians(2.5 + degree), share) for degree, share in enumerate(SHARES))
"""Foot angles (rad) from 20 deg down to 2 deg and the share of load times time at each degree: ten
recorded steps of four laboratories that come with the package (the mean of the laboratories')."""
NODES = 801
CUT = 30e-6
"""m: mean thickness that one round of cuts takes off the rear of a heel."""
REAR = 30e-3  # m, its length


@dataclass(frozen=True, slots=True)
class FloorCuts:
    """A sole cut by floor planes z = offset - slope x (m); what stood below them is gone.

    ``depth`` is the largest thickness removed, m.
    """

    depth: float
    planes: tuple[tuple[float, float], ...]

    def worn_height(self, x: Array, y: Array, unworn: Array, shape: SoleShape) -> Array:
        """Return the height (m) of the worn land at (x, y): the highest of sole and planes."""
        worn = unworn
        for slope, offset in self.planes:
            worn = np.maximum(worn, offset - slope * x)
        return worn


@dataclass(frozen=True, slots=True)
class WalkingWear:
    """Material that walking removes: the sole meets the floor at every angle of ``LANDING``.

    Where the foot bears the load F at an angle while it slides by s, wear takes the volume
    V = k F s (Archard 1953). So at each angle the floor plane cuts off a volume in proportion to
    load times time there; sliding is taken as even in time. The angles take turns in rounds of a
    few hundredths of a millimetre until the most worn place has lost ``depth``. The sole is stiff
    against its wear; the planes do not lean sideways.

    Parameters:
        depth: Largest thickness removed, m.
    """

    depth: float

    def __post_init__(self) -> None:
        not_negative(self.depth, "wear.depth")

    def on(self, shape: SoleShape) -> FloorCuts:
        """Return the planes that cut a sole."""
        x, unworn = _section(shape)
        across = np.linspace(-0.5, 0.5, 201) * shape.width
        within = shape.inward_distance(*np.meshgrid(x, across, indexing="ij")) > 0
        width = within.mean(axis=1) * shape.width
        round_volume = CUT * REAR * shape.width / (x[1] - x[0])
        offsets = np.full(len(LANDING), -np.inf)
        worn = unworn
        while True:
            cut, after = _round(x, worn, width, round_volume)
            lost = float((after - unworn).max())
            if lost >= self.depth:
                break
            worn, offsets = after, np.maximum(offsets, cut)
        low, high = 0.0, 1.0  # share of the last round
        for _ in range(30):
            share = 0.5 * (low + high)
            cut, after = _round(x, worn, width, share * round_volume)
            if (after - unworn).max() < self.depth:
                low = share
            else:
                high = share
        offsets = np.maximum(offsets, cut)
        planes = [
            (math.tan(angle), float(offset))
            for (angle, _), offset in zip(LANDING, offsets, strict=True)
        ]
        return FloorCuts(self.depth, tuple(planes))


def _section(shape: SoleShape) -> tuple[Array, Array]:
    """Return the unworn sole along its centre line at even places, m."""
    line, height = shape.centre_line()
    x = np.linspace(line[0], line[-1], NODES)
    return x, np.interp(x, line, height)


def _round(x: Array, height: Array, width: Array, volume: float) -> tuple[Array, Array]:
    """Return the offset of the plane at each angle and the section after one round of cuts.

    ``volume`` (m^2) is that of the round over the spacing of ``x``.
    """
    offsets = np.empty(len(LANDING))
    for number, (angle, share) in enumerate(LANDING):
        slope = math.tan(angle)
        offset = _cut_level(height + slope * x, width, share * volume)
        height = np.maximum(height, offset - slope * x)
        offsets[number] = offset
    return offsets, height


def _cut_level(above: Array, width: Array, volume: float) -> float:
    """Return c with sum width max(c - above, 0) = volume: how far a plane cuts."""
    order = np.argsort(above)
    heights, widths = above[order], width[order]
    total = np.cumsum(widths)
    offsets = (volume + np.cumsum(widths * heights)) / np.maximum(total, 1e-12)
    beyond = np.append(heights[1:], np.inf) >= offsets
    return float(offsets[int(np.argmax(beyond))])
