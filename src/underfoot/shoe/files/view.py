"""A mesh seen from both sides as height maps, and its defects."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError, InputError
from underfoot.core.arrays import Array, Mask

from .._kernels.height_buffer import extents as _extents
from .._kernels.height_buffer import height_buffer
from .._kernels.mesh_edges import shared_edges, soup_keys
from .mesh import Mesh

_MOST_CELLS = 60_000_000


@dataclass(frozen=True, slots=True)
class View:
    """Lowest and highest surface over cells of a plane, in the frame ``axes`` (rows, m per unit).

    Heights count from ``level`` (m) of that frame.

    ``facing`` is -1 where the lowest surface has its normal down, 1 up, 0 where there is none.
    """

    axes: Array
    first: tuple[float, float]
    spacing: float
    lowest: Array
    highest: Array
    facing: NDArray[np.int8]
    level: float = 0.0

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
    # a file's rounding must not add a cell, which would move all others by half of one
    shape = tuple(max(1, math.ceil(float(high[n] - low[n]) / spacing - 0.02)) for n in range(2))
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


@dataclass(frozen=True, slots=True)
class Soundness:
    """Counts of what a sound closed mesh has none of.

    Parameters:
        faces: In the file.
        degenerate, not_finite: Faces without area; faces with a corner that is no number.
        open_edges, crowded_edges, turned_edges: Edges of one face; of more than two, other than
            of bodies that touch; of two faces that are turned opposite ways.
        duplicates: Faces that are there more than once.
        volume: Signed volume in the file's unit cubed: negative when the normals point inward.
    """

    faces: int
    degenerate: int
    not_finite: int
    open_edges: int
    crowded_edges: int
    turned_edges: int
    duplicates: int
    volume: float

    @property
    def closed(self) -> bool:
        """True when every edge has at least two faces."""
        return self.open_edges == 0

    def remarks(self) -> tuple[str, ...]:
        """Return the tolerated defects, a sentence each."""
        inward = int(self.closed and not self.turned_edges and self.volume < 0)
        counted = (
            (self.open_edges, "{} open edges were tolerated: the height map needs no closed body."),
            (inward, "The normals point inward; tolerated, heights do not depend on them."),
            (
                self.turned_edges,
                "Along {} edges neighbouring faces are turned opposite ways; "
                "tolerated, since heights don't depend on normals.",
            ),
            (
                self.crowded_edges,
                "{} edges have more than two faces; tolerated, the lowest face counts.",
            ),
            (self.duplicates, "{} faces are there twice; the copies change nothing."),
            (self.degenerate, "{} faces without area were ignored."),
            (self.not_finite, "{} faces with a corner that is not a number were left out."),
        )
        return tuple(text.format(count) for count, text in counted if count)


def soundness(mesh: Mesh, where: str) -> Soundness:
    """Return what is wrong with a mesh; corners are the same when their coordinates are.

    Raises:
        DataError: No face with an area.
    """
    triangles = mesh.triangles
    if (triangles == 0).any():
        triangles = triangles + np.float32(0.0)  # a negative zero has other bits than zero
    bits = triangles.view(np.uint32)
    edges, faces, counts, volume = soup_keys(triangles, bits)
    degenerate, not_finite = int(counts[0]), int(counts[1])
    if degenerate + not_finite == faces.size:
        raise DataError(f"none of its {faces.size} faces has an area", where=where)
    edges.sort()
    open_edges, crowded, turned, touching = shared_edges(edges)
    return Soundness(
        faces=faces.size,
        degenerate=degenerate,
        not_finite=not_finite,
        open_edges=int(open_edges),
        crowded_edges=int(crowded),
        turned_edges=int(turned),
        duplicates=_duplicates(faces) if crowded or turned or touching else 0,
        volume=float(volume),
    )


def without_copies(triangles: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return each triangle once, whichever way it is turned and whichever corner comes first."""
    triangles = triangles + np.float32(0.0)
    _, keys, _, _ = soup_keys(triangles, triangles.view(np.uint32))
    _, chosen = np.unique(keys, return_index=True)
    return triangles[np.sort(chosen)]


def _duplicates(faces: NDArray[np.uint64]) -> int:
    faces.sort()
    return int(np.count_nonzero((faces[1:] == faces[:-1]) & (faces[1:] != 0)))
