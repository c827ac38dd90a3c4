"""How worn a sole is: tread left, size of the patch without tread, volume removed."""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core.arrays import Array, Mask

from .._kernels.regions import nearest_true
from ..geometry import SoleSurface
from ..grids import cut_heel
from ..shape import SoleShape

MEASURING_CELL = 0.5e-3  # m
GONE = 1e-5  # m: a lug worn to its last hundredth of a millimetre drains nothing
SHALLOW = 0.5
"""Share of the median lug height below which a part of a scanned sole is rounded rim, no lug."""


@dataclass(frozen=True, slots=True)
class WearMeasures:
    """State of wear of one sole.

    Parameters:
        removed_depth: Largest thickness removed from the land, m.
        tread_left, mean_tread_left: Height of the lugs that is left where it is least, and on
            average, m.
        worn_patch_area: Largest connected area in which the lugs are worn down to the channel
            floor, m^2.
        worn_patch_length, worn_patch_width: Its extents along and across the shoe, m.
        removed_volume: m^3.
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
    rows = np.arange(math.ceil(shape.length / spacing), dtype=np.float64)
    columns = np.arange(math.ceil(shape.width / spacing), dtype=np.float64)
    x, y = np.meshgrid(
        (rows + 0.5) * spacing, (columns + 0.5) * spacing - shape.width / 2, indexing="ij"
    )
    inside = shape.inward_distance(x, y) > 0
    new = shape.with_wear(None)
    removed = np.where(inside, shape.land_height(x, y) - shape.unworn_height(x, y), 0.0)
    raised = (cut_heel(shape, x, y)[0] - cut_heel(new, x, y)[0])[inside]
    depth = np.where(inside, 0.0 if shape.tread is None else shape.tread.depth, 0.0)
    return _wear_measures(removed, inside, depth, float(raised.sum()) * spacing**2, spacing)


def surface_wear_measures(new: SoleSurface, worn: SoleSurface) -> WearMeasures:
    """Return how worn a sole known by its heights is, against the same sole when new.

    Each cell has the lug height of the nearest land, so that a channel counts with its lugs; parts
    that had no tread are left aside, and so is the rounded rim, where a lug measures less than half
    of the median height.
    """
    inside, lug = new.inside, nearest_true(new.land)
    # what the land lost: between the lugs its base is a guess, on a bevel off by the bevel's rise
    removed = np.where(inside, np.nan_to_num(worn.land_base - new.land_base)[lug], 0.0)
    raised = np.nan_to_num(worn.height - new.height)[inside]
    depth = np.where(inside, new.tread_depth[lug], 0.0)
    lugs = depth[depth > 0]
    if lugs.size:
        depth = np.where(depth < SHALLOW * np.median(lugs), 0.0, depth)
    area = new.spacing**2
    return _wear_measures(removed, inside, depth, float(raised.sum()) * area, new.spacing)


def _worn_share(beyond: Array) -> Array:
    """Return the share of each cell that is worn down, of how far wear goes beyond the lugs (m).

    The worn height is taken as plane within a cell: a patch smaller than a cell has its own area.
    """
    beyond = beyond + GONE
    steepness = np.abs(np.gradient(beyond, axis=0)) + np.abs(np.gradient(beyond, axis=1))
    return np.clip(0.5 + beyond / np.maximum(steepness, 1e-12), 0.0, 1.0)


def _wear_measures(
    removed: Array, inside: Mask, depth: Array, volume: float, spacing: float
) -> WearMeasures:
    """Return the measures from removed thickness and height of the lugs (m), cell by cell."""
    from scipy.ndimage import find_objects, label

    treaded = inside & (depth > 0)
    left = np.clip(depth - removed, 0.0, None)
    length = width = area = least = mean = 0.0
    if treaded.any():
        least, mean = float(left[treaded].min()), float(left[treaded].mean())
        share = np.where(treaded, _worn_share((removed - depth)[nearest_true(treaded)]), 0.0)
        patches = np.zeros(treaded.shape, dtype=np.int32)
        label(share > 0, output=patches)
        if patches.any():
            sizes = np.bincount(patches.ravel(), share.ravel())[1:]
            largest = int(sizes.argmax())
            along, across = find_objects(patches)[largest]
            area = float(sizes[largest]) * spacing**2
            length = (along.stop - along.start) * spacing
            width = (across.stop - across.start) * spacing
    return WearMeasures(
        removed_depth=float(removed.max()),
        tread_left=least,
        mean_tread_left=mean,
        worn_patch_area=area,
        worn_patch_length=length,
        worn_patch_width=width,
        removed_volume=volume,
    )
