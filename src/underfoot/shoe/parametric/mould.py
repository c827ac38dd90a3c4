"""A sole with the draft that its mould needs: the walls of its channels lean, as a mesh."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import UnderfootError
from underfoot.core.arrays import Array

from ..shape import SoleShape
from .modelling import MM
from .solid import SoleSolid, sole_mesh

ON_WALL = 50e-6
"""m: corners of a mesh so near to a wall or to the rim lie on it."""
_STEP = 20e-6  # m, of the differences that give the way into a channel
_SQUARE = 0.2  # a wall meets the rim at 12 degrees or more, else its foot stays


def write_drafted(shape: SoleShape, made: SoleSolid, draft: float, path: Path) -> None:
    """Write the sole as STL in mm, its channels' walls leaning by ``draft`` (rad) from upright.

    The land stays; the foot of a wall moves depth x tan(draft) into the channel, along the rim
    where it ends there.

    Raises:
        UnderfootError: The mesh is not watertight.
    """
    tread = shape.tread
    assert tread is not None
    mesh = sole_mesh(made)
    x, y, z = np.asarray(mesh.vertices).T / MM
    foot = np.abs(tread.channel_distance(x, y)) < ON_WALL
    foot &= np.abs(z - shape.unworn_height(x, y) - tread.depth) < tread.depth / 2
    x, y = x[foot], y[foot]
    into, inward = _way(tread.channel_distance, x, y), _way(shape.inward_distance, x, y)
    along = into - (into * inward).sum(axis=0) * inward
    square = (along**2).sum(axis=0)
    on_rim = np.abs(shape.inward_distance(x, y)) < ON_WALL
    held = np.where(square > _SQUARE**2, along / np.maximum(square, _SQUARE**2), 0.0)
    shift = tread.depth * math.tan(draft) * np.where(on_rim, held, into)
    vertices = np.array(mesh.vertices)
    vertices[foot, :2] += shift.T * MM
    mesh.vertices = vertices
    if not mesh.is_watertight:
        raise UnderfootError("the mesh of the sole is not watertight", where=str(path))
    mesh.export(str(path))


def _way(distance: Callable[[Array, Array], Array], x: Array, y: Array) -> Any:
    """Return the unit vectors (2, n) along which a distance grows."""
    slope = np.stack(
        [
            distance(x + _STEP, y) - distance(x - _STEP, y),
            distance(x, y + _STEP) - distance(x, y - _STEP),
        ]
    )
    return slope / np.maximum(np.hypot(*slope), 1e-12)
