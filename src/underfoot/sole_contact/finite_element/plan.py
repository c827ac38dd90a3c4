"""Plan form of a sole as polygons: the rim, the lugs in it and how far the channels go in."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError
from underfoot.shoe.geometry import SoleMap

Array = NDArray[np.float64]
SMOOTHING = 0.75
"""Steps of a rim that runs askew over the cells are drawn straight within this share of a cell."""
SMALLEST_PIECE = 4.0
"""Cells; a smaller piece of land is left to its surroundings."""


@dataclass(frozen=True, slots=True)
class Plan:
    """Polygons in the floor's frame (shapely), and heights over them.

    ``land`` are the pieces that can touch the floor, ``channels`` the pieces between them.
    ``land_height`` is the land surface over the floor, also bridging channels, ``tread_depth`` how
    far the bottom of the channels lies above it; both (nx, ny) at the cell centres, m. An untreaded
    sole has no channels and a tread depth of 0 everywhere.
    """

    land: tuple[Any, ...]
    channels: tuple[Any, ...]
    x: Array
    y: Array
    land_height: Array
    tread_depth: Array


def plan_of(sole: SoleMap) -> Plan:
    """Return the plan form of a sole map as polygons that follow its cells."""
    import shapely

    rim = shapely.make_valid(shapely.Polygon(np.asarray(sole.outline)))
    height, depth = _heights(sole)
    cell = sole.spacing
    if not (sole.inside & ~sole.land).any():
        return Plan((rim,), (), sole.x, sole.y, height, depth)
    smallest = SMALLEST_PIECE * cell**2
    # Cells at the rim are cut by it; reaching one cell further lets the rim itself be the edge.
    merged = _cells_union(sole.land, sole.x, sole.y, cell)
    grown = merged.buffer(cell, join_style="mitre").difference(rim.buffer(-cell))
    grown = grown.difference(_cells_union(sole.inside & ~sole.land, sole.x, sole.y, cell))
    land = shapely.union_all([merged, grown]).simplify(SMOOTHING * cell).intersection(rim)
    land = land.buffer(-0.3 * cell, join_style="mitre").buffer(0.3 * cell, join_style="mitre")
    land = land.intersection(rim)
    pieces = [part for part in _polygons(land) if part.area >= smallest]
    if not pieces:
        raise InputError("the sole has no piece of land of four cells", where="sole.land")
    gaps = rim.difference(shapely.union_all(pieces))
    channels = [part for part in _polygons(gaps) if part.area > 1e-3 * cell**2]
    return Plan(tuple(pieces), tuple(channels), sole.x, sole.y, height, depth)


def _heights(sole: SoleMap) -> tuple[Array, Array]:
    """Return land surface and channel depth everywhere, also where the sole has neither."""
    from scipy.interpolate import griddata
    from scipy.ndimage import distance_transform_edt

    height = np.where(sole.land, sole.clearance, 0.0)
    points = np.argwhere(sole.land) * 1.0
    elsewhere = np.argwhere(~sole.land)
    values = sole.clearance[sole.land]
    filled = griddata(points, values, elsewhere, method="linear")
    missing = np.isnan(filled)
    if missing.any():
        filled[missing] = griddata(points, values, elsewhere[missing], method="nearest")
    height[~sole.land] = filled
    channel = sole.inside & ~sole.land
    if not channel.any():
        return height, np.zeros_like(height)
    depth = np.where(channel, np.maximum(sole.clearance - height, 0.0), 0.0)
    nearest = distance_transform_edt(~channel, return_distances=False, return_indices=True)
    assert isinstance(nearest, np.ndarray)
    return height, depth[nearest[0], nearest[1]]


def _cells_union(mask: NDArray[np.bool_], x: Array, y: Array, cell: float) -> Any:
    """Return the union of the cells of a mask."""
    import shapely

    boxes = []
    half = 0.5 * cell
    for i in np.flatnonzero(mask.any(axis=1)):
        row = np.concatenate([[False], mask[i], [False]]).astype(np.int8)
        starts, ends = np.flatnonzero(np.diff(row) == 1), np.flatnonzero(np.diff(row) == -1) - 1
        for first, last in zip(starts, ends, strict=True):
            boxes.append(shapely.box(x[i] - half, y[first] - half, x[i] + half, y[last] + half))
    return shapely.union_all(boxes, grid_size=cell * 1e-6)


def _polygons(shape: Any) -> list[Any]:
    import shapely

    return [part for part in shapely.get_parts(shape) if part.geom_type == "Polygon"]
