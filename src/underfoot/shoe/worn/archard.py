"""Wear by contact pressure and sliding, the contact recomputed under the worn shape."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError, Progress, silent
from underfoot.core.arrays import Array
from underfoot.core.checks import not_negative, positive

from .._kernels.regions import nearest_true
from ..geometry import SoleMap, centred_places
from ..shape import SoleShape
from .forms import WornMap

Contact = Callable[[SoleShape, float], tuple[SoleMap, Array]]
"""Sole and shoe angle (rad) to its map on the floor and the contact pressure (nx, ny) in Pa."""
BLUR = 0.6
"""Width of the blur of each step's wear in cells: keeps single cells from wearing alone."""


@dataclass(frozen=True, slots=True)
class ArchardStep:
    """State after a step: what is removed and how far the sole slid to remove it.

    ``sliding_distance`` (m) is the total since the sole was new.
    """

    worn: WornMap
    sliding_distance: float


def archard_wear(
    shape: SoleShape,
    *,
    angles: Sequence[float],
    depth: float,
    contact: Contact,
    wear_rate: float,
    spacing: float,
    step: float = 0.25e-3,
    begin: ArchardStep | None = None,
    progress: Progress = silent,
) -> ArchardStep:
    """Return the sole worn until its most worn place has lost ``depth``.

    Each step removes dz = k p ds (Archard 1953), p the mean contact pressure over the angles at
    which the sole wears, equal sliding at each; its length ds is such that the largest dz is
    ``step``. The next step meets the worn sole.

    Parameters:
        shape: The sole when new; wear that it has already is not counted.
        angles: Shoe angles at which it wears, rad.
        depth: Thickness lost at the most worn place, m.
        contact: Contact pressure under a sole at an angle.
        wear_rate: k, m^2/N (volume per load and way). It sets the way alone, not the shape.
        spacing: Of the map of wear, m.
        step: Largest thickness lost between two contacts, m.
        begin: Go on from here instead of from the new sole.

    Raises:
        InputError: No angle; values that are not positive; a sole that nowhere touches the floor.
    """
    positive(wear_rate, "wear.wear_rate")
    positive(spacing, "wear.spacing")
    positive(step, "wear.step")
    not_negative(depth, "wear.depth")
    if not angles:
        raise InputError("no angle", where="wear.angle", allowed="at least one shoe angle")
    x = (np.arange(math.ceil(shape.length / spacing), dtype=np.float64) + 0.5) * spacing
    y = centred_places(math.ceil(shape.width / spacing), spacing)
    state = begin or ArchardStep(WornMap(x, y, np.zeros((x.size, y.size))), 0.0)
    while state.worn.depth < depth * (1 - 1e-6):
        progress("Wearing the sole", state.worn.depth / depth)
        worn_shape = shape.with_wear(state.worn)
        pressure = np.zeros((x.size, y.size))
        for angle in angles:
            sole, contact_pressure = contact(worn_shape, angle)
            pressure += pressure_on_sole(worn_shape, sole, contact_pressure, angle, x, y) / len(
                angles
            )
        if not pressure.max() > 0:
            raise InputError("the sole nowhere touches the floor", where="wear.angle")
        rate = wear_rate * pressure
        touching = rate > 0
        left = (depth - state.worn.removed)[touching] / rate[touching]
        way = min(step / float(rate.max()), float(left.min()))
        worn = WornMap(x, y, state.worn.removed + rate * way)
        state = ArchardStep(worn, state.sliding_distance + way)
    progress("Wearing the sole", 1.0)
    return state


def pressure_on_sole(
    shape: SoleShape, sole: SoleMap, pressure: Array, angle: float, x: Array, y: Array
) -> Array:
    """Return the contact pressure (Pa) at nodes of the sole's own frame, carried across channels.

    A node (x, y) of the land lies at x' = x cos a - z sin a on the floor. The pressure is the mean
    over the land around it, so that a channel neither wears nor dilutes the wear beside it.
    """
    from scipy.ndimage import gaussian_filter, map_coordinates

    land = (sole.land & np.isfinite(sole.clearance)).astype(float)
    weight = gaussian_filter(land, BLUR, mode="constant")
    blurred = gaussian_filter(pressure * land, BLUR, mode="constant")
    known = weight > 0.25
    value = np.where(known, blurred / np.maximum(weight, 1e-12), 0.0)
    value = value[nearest_true(known)]
    grid_x, grid_y = np.meshgrid(x, y, indexing="ij")
    cosine, sine = math.cos(angle), math.sin(angle)
    origin = -float(shape.land_height(np.zeros(1), np.zeros(1))[0]) * sine
    at_x = grid_x * cosine - shape.land_height(grid_x, grid_y) * sine - origin
    at = [(at_x - sole.x[0]) / sole.spacing, (grid_y - sole.y[0]) / sole.spacing]
    return np.maximum(map_coordinates(value, at, order=1, mode="nearest"), 0.0)
