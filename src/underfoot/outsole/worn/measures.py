"""How worn a sole is: tread left, size of the patch without tread, volume removed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ..heel_grid import cut_heel

if TYPE_CHECKING:
    from ..shape import SoleShape

MEASURING_CELL = 0.5e-3  # m


@dataclass(frozen=True, slots=True)
class WearMeasures:
    """State of wear of one sole.

    Parameters
    ----------
    removed_depth
        Largest thickness removed from the land, m.
    tread_left, mean_tread_left
        Height of the lugs that is left where it is least, and on average, m.
    worn_patch_area
        Largest connected area in which the lugs are worn down to the channel floor, m^2.
    worn_patch_length, worn_patch_width
        Its extents along and across the shoe, m.
    removed_volume
        m^3.
    """

    removed_depth: float
    tread_left: float
    mean_tread_left: float
    worn_patch_area: float
    worn_patch_length: float
    worn_patch_width: float
    removed_volume: float

    @property
    def characteristic_length(self) -> float:
        """Geometric mean of the worn patch's length and width, m."""
        return math.sqrt(self.worn_patch_length * self.worn_patch_width)


def wear_measures(shape: SoleShape, *, spacing: float = MEASURING_CELL) -> WearMeasures:
    """Return how worn a sole is, measured on cells of ``spacing`` (m) in its own frame.

    On a sole that had no tread the patch is 0: nothing was worn away. Channels that have opened
    onto the patch through their floor count as part of it.
    """
    from scipy.ndimage import find_objects, label

    rows = np.arange(math.ceil(shape.length / spacing), dtype=np.float64)
    columns = np.arange(math.ceil(shape.width / spacing), dtype=np.float64)
    x, y = np.meshgrid(
        (rows + 0.5) * spacing, (columns + 0.5) * spacing - shape.width / 2, indexing="ij"
    )
    inside = shape.inward_distance(x, y) > 0
    new = cast("SoleShape", replace(cast("Any", shape), wear=None))
    removed = np.where(inside, shape.land_height(x, y) - shape.unworn_height(x, y), 0.0)
    volume = float((cut_heel(shape, x, y)[0] - cut_heel(new, x, y)[0])[inside].sum()) * spacing**2
    depth = 0.0 if shape.tread is None else shape.tread.depth
    left = np.clip(depth - removed, 0.0, None)
    length = width = area = 0.0
    if depth > 0:
        # a lug worn to its last hundredth of a millimetre drains nothing
        patches = np.asarray(label(inside & (left < 1e-5))[0])  # type: ignore[index]
        if patches.any():
            sizes = np.bincount(patches.ravel())[1:]
            largest = int(sizes.argmax())
            along, across = find_objects(patches)[largest]
            area = float(sizes[largest]) * spacing**2
            length = (along.stop - along.start) * spacing
            width = (across.stop - across.start) * spacing
    return WearMeasures(
        removed_depth=float(removed.max()),
        tread_left=float(left[inside].min()),
        mean_tread_left=float(left[inside].mean()),
        worn_patch_area=area,
        worn_patch_length=length,
        worn_patch_width=width,
        removed_volume=volume,
    )
