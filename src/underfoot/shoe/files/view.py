"""A mesh seen from both sides as height maps."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError
from underfoot.core.arrays import Array, Mask

from .._kernels.height_buffer import extents as _extents
from .._kernels.height_buffer import height_buffer

_MOST_CELLS = 60_000_000


@dataclass(frozen=True, slots=True)
class View:
    """Lowest and highest surface over cells of a plane, in the frame ``axes`` (rows, m per unit).

    ``facing`` is -1 where the lowest surface has its normal down, 1 up, 0 where there is none.
    """

    axes: Array
    first: tuple[float, float]
    spacing: float
    lowest: Array
    highest: Array
    facing: NDArray[np.int8]

    @property
    def covered(self) -> Mask:
        """True over some part of the mesh."""
        return np.isfinite(self.lowest)


def extents(triangles: NDArray[np.float32], axes: Array) -> tuple[Array, Array]:
    """Return the least and greatest coordinates (3,) along the rows of ``axes``."""
    return _extents(triangles, np.ascontiguousarray(axes, dtype=np.float64))


def view(triangles: NDArray[np.float32], axes: Array, spacing: float) -> View:
    """Return the mesh seen along the third row of ``axes`` on cells of ``spacing`` (m).

    Raises:
        InputError: More cells than memory is good for.
    """
    axes = np.ascontiguousarray(axes, dtype=np.float64)
    low, high = extents(triangles, axes)
    shape = tuple(max(1, math.ceil(float(high[n] - low[n]) / spacing)) for n in range(2))
    if shape[0] * shape[1] > _MOST_CELLS:
        raise InputError(
            f"{shape[0]} x {shape[1]} cells of {spacing * 1e3:g} mm are too many",
            where="outsole.spacing",
            allowed=f"{math.sqrt(math.prod(shape) / _MOST_CELLS) * spacing * 1e3:.2g} mm or more",
        )
    # centred, so that the cells are the same for a mesh and its mirror image
    first = tuple(float(low[n] + high[n]) / 2 - (shape[n] - 1) / 2 * spacing for n in range(2))
    lowest, highest, facing = height_buffer(
        triangles, axes, (first[0], first[1]), spacing, (shape[0], shape[1])
    )
    return View(axes, (first[0], first[1]), spacing, lowest, highest, facing)
