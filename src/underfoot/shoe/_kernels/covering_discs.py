"""The largest disc in a region that covers a cell: its width there, and the value at its middle."""

import numpy as np

from underfoot.core.arrays import Array, Mask
from underfoot.core.compiled import njit

from .regions import Labels, distance_within


def local_width(region: Mask, spacing: float) -> Array:
    """Return, per cell of ``region``, the diameter (m) of the largest disc in it over the cell.

    w(c) = max { 2 d(m) : |c - m| < d(m) } - spacing / 2, with d(m) the distance of a cell m to the
    nearest cell outside; in a straight channel w is its width within half a cell. 0 outside the
    region; what lies beyond the array counts as outside.

    Source: Hildebrand and Ruegsegger 1997 (local thickness), in the plane.
    """
    radius, _ = _covering_discs(np.pad(distance_within(region), 1))
    radius = radius[1:-1, 1:-1]
    return np.where(region, np.maximum(2 * radius - 0.5, 1.0) * spacing, 0.0)


def channel_width(region: Mask, spacing: float) -> Array:
    """Return ``local_width`` from halved cells, which has no bias: w(c) = max { 2 d(m) }.

    Halved, a channel is an even number of cells across, so that its middle lies half a (halved)
    cell from a cell's, as far as d reaches beyond its edge. Along the cells exact for whole cells,
    at other angles within a third of a cell of ``spacing``.
    """
    halved = np.repeat(np.repeat(region, 2, axis=0), 2, axis=1)
    return local_width(halved, spacing / 2)[::2, ::2] + np.where(region, spacing / 4, 0.0)


def covering_value(region: Mask, values: Array) -> Array:
    """Return, per cell of ``region``, the value at the middle of the largest disc in it over it."""
    _, middle = _covering_discs(np.pad(distance_within(region), 1))
    return np.pad(values, 1).ravel()[middle][1:-1, 1:-1]


def _covering_discs(distance: Array) -> tuple[Array, Labels]:
    """Return radius and middle (flat index) of the largest disc over each cell.

    The rim of the array is outside; a cell outside is its own middle.
    """
    inner = distance[1:-1, 1:-1]
    ridge = inner > 1.0
    for a, b in [(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1) if a or b]:
        # a disc that lies in a neighbour's disc paints nothing new
        neighbour = np.roll(distance, (-a, -b), (0, 1))[1:-1, 1:-1]
        ridge &= neighbour < inner + np.hypot(a, b) - 1e-9
    order = np.argsort(inner[ridge], kind="stable")
    places, reaches = np.argwhere(ridge)[order] + 1, inner[ridge][order]
    radius, middle = distance.copy(), np.arange(distance.size).reshape(distance.shape)
    _paint(places, reaches, radius, middle)
    return radius, middle


@njit(cache=True)
def _paint(places: Labels, reaches: Array, radius: Array, middle: Labels) -> None:
    """Enter discs, the largest last; a disc never leaves the array, whose rim is outside."""
    for k in range(reaches.size):
        i, j, reach = places[k, 0], places[k, 1], reaches[k]
        most = int(np.ceil(reach)) - 1
        for a in range(-most, most + 1):
            half = int(np.ceil(np.sqrt(reach * reach - a * a))) - 1
            radius[i + a, j - half : j + half + 1] = reach
            middle[i + a, j - half : j + half + 1] = i * radius.shape[1] + j
