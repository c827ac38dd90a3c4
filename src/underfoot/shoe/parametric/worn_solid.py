"""What wear takes from the solid of a sole: a half space for a plane, a spline surface else."""

import math
from typing import Any

import numpy as np

from ..shape import SoleShape
from ..worn.forms import WearPlane
from .modelling import MM, kernel
from .slab import land_profile

NODES = 2.5e-3
"""m between the points that the cutting surface is fitted to."""
CLEAR = 0.1e-3
"""m by which the cutting surface passes under land that is not worn; thinner wear is left out."""
_BEYOND = 6e-3  # m of cutting surface around the plan form
_DOWN = 60e-3  # m of the cutting body below its surface


def worn_solid(body: Any, shape: SoleShape) -> Any:
    """Return the solid (mm) of the new sole without what its wear has removed.

    A plane is cut exactly. Any other wear is cut along a spline surface through the worn land,
    z = z_profile + w - g exp(-3 w / g), w the thickness removed and g = ``CLEAR``: within 5 % of g
    where w is above g, under the land where nothing is worn. The rounded rim is left as it is.
    """
    wear = shape.wear
    if wear is None or wear.depth == 0:
        return body
    if isinstance(wear, WearPlane):
        at_rear = float(wear.height(np.zeros(1), *shape.centre_line())[0])
        upwards = kernel().Vec(math.tan(wear.angle), 0.0, 1.0)
        return body - kernel().HalfSpace(kernel().Pnt(0.0, 0.0, at_rear * MM), upwards)
    x = np.arange(-_BEYOND, shape.length + _BEYOND + NODES, NODES)
    half = shape.width / 2 + _BEYOND
    y = np.arange(-half, half + NODES, NODES)
    grid_x, grid_y = np.meshgrid(x, y, indexing="ij")
    plain = land_profile(shape, grid_x)
    if shape.crown_radius is not None:
        plain = plain + grid_y**2 / (2 * shape.crown_radius)
    removed = wear.worn_height(grid_x, grid_y, plain, shape) - plain
    height = plain + removed - CLEAR * np.exp(-3 * removed / CLEAR)
    points = np.stack([grid_x, grid_y, height], axis=-1) * MM
    surface = kernel().SplineSurfaceInterpolation(points)
    return body - surface.Extrude(kernel().Vec(0.0, 0.0, -_DOWN * MM))
