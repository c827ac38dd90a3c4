"""Local width of a plane region: the largest disc inside it that covers each cell."""

import numpy as np

from underfoot.core.arrays import Array, Mask

from .pieces import distance_within


def local_width(region: Mask, spacing: float) -> Array:
    """Return, per cell of ``region``, the diameter (m) of the largest disc in it over the cell.

    w(c) = max { 2 d(m) : |c - m| < d(m) } - spacing / 2, with d(m) the distance of a cell m to the
    nearest cell outside; in a straight channel w is its width within half a cell. 0 outside the
    region; what lies beyond the array counts as outside.

    Source: Hildebrand and Ruegsegger 1997 (local thickness), in the plane.
    """
    radius = _covering_radius(np.pad(distance_within(region), 1))[1:-1, 1:-1]
    return np.where(region, np.maximum(2 * radius - 0.5, 1.0) * spacing, 0.0)


def _covering_radius(distance: Array) -> Array:
    """Return the radius of the largest disc over each cell; the rim of the array is outside."""
    inner = distance[1:-1, 1:-1]
    ridge = inner > 1.0
    for a, b in [(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1) if a or b]:
        # a disc that lies in a neighbour's disc paints nothing new
        neighbour = np.roll(distance, (-a, -b), (0, 1))[1:-1, 1:-1]
        ridge &= neighbour < inner + np.hypot(a, b) - 1e-9
    margin = int(np.ceil(distance.max(initial=0.0)))
    radius = np.pad(distance, margin)
    centres = np.argwhere(ridge) + 1 + margin
    reaches = inner[ridge]
    for reach in np.unique(reaches):
        side = np.arange(1 - np.ceil(reach), np.ceil(reach), dtype=int)
        a, b = np.nonzero(side[:, None] ** 2 + side**2 < reach**2)
        at = centres[reaches == reach]
        cells = at[:, :1] + side[a], at[:, 1:] + side[b]
        radius[cells] = np.maximum(radius[cells], reach)
    return radius[margin : radius.shape[0] - margin, margin : radius.shape[1] - margin]
