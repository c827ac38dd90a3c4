"""A mesh seen from both sides as height maps, and its defects."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError, InputError
from underfoot.core.arrays import Array, Mask
from underfoot.core.remark import Message

from .._kernels.components import MOST_FACES, closed_bodies
from .._kernels.height_buffer import extents as _extents
from .._kernels.height_buffer import height_buffer
from .._kernels.mesh_edges import overlap_lines, shared_edges, soup_keys
from .mesh import Mesh

_MOST_CELLS = 60_000_000
_OVERLAP_PITCH = 2e-3  # m between the lines on which crossing material is looked for
_SAME_PLACE = 20e-6  # m: faces nearer than this lie on each other
_MOST_APART = 0.02


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
            Message(
                "{along} x {across} cells of {spacing:g} mm are too many",
                along=shape[0],
                across=shape[1],
                spacing=spacing * 1000.0,
            ),
            where="outsole.spacing",
            allowed=Message(
                "{sqrt:.2g} mm or more",
                sqrt=math.sqrt(math.prod(shape) / _MOST_CELLS) * spacing * 1000.0,
            ),
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

    def remarks(self) -> tuple[Message, ...]:
        """Return the tolerated defects, a sentence each."""
        inward = int(self.closed and not self.turned_edges and self.volume < 0)
        counted = (
            Message(
                "{count} open edges were tolerated: the height map needs no closed body.",
                count=self.open_edges,
            ),
            Message("The normals point inward; tolerated, heights do not depend on them."),
            Message(
                "Along {count} edges neighbouring faces are turned opposite ways; tolerated, since "
                "heights don't depend on normals.",
                count=self.turned_edges,
            ),
            Message(
                "{count} edges have more than two faces; tolerated, the lowest face counts.",
                count=self.crowded_edges,
            ),
            Message(
                "{count} faces are there twice; the copies change nothing.", count=self.duplicates
            ),
            Message("{count} faces without area were ignored.", count=self.degenerate),
            Message(
                "{count} faces with a corner that is not a number were left out.",
                count=self.not_finite,
            ),
        )
        return tuple(line for line in counted if line.values.get("count", inward))


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
        raise DataError(
            Message("none of its {size} faces has an area", size=faces.size), where=where
        )
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


def view_remarks(seen: View, sound: Soundness, mesh: Mesh, where: str) -> tuple[Message, ...]:
    """Return what is tolerated about normals and bodies of a mesh that is seen from below.

    Raises:
        DataError: The view and the mesh disagree; see ``_agreement``.
    """
    remarks: list[Message] = []
    covered = seen.covered
    up = float(np.count_nonzero(seen.facing > 0)) / max(1, np.count_nonzero(covered))
    inward = sound.closed and not sound.turned_edges and sound.volume < 0
    if up > 0.5 and not inward:
        remarks.append(
            Message("Normals of the ground side point into the sole (inverted); tolerated.")
        )
    elif 0.01 < up <= 0.5 and not inward:
        remarks.append(
            Message("Normals are turned over {share:.0%} of the ground side; tolerated.", share=up)
        )
    return (*remarks, *_agreement(seen, sound, mesh, where))


def _agreement(seen: View, sound: Soundness, mesh: Mesh, where: str) -> list[Message]:
    """Return a remark where bodies overlap or faces lie double.

    Raises:
        DataError: One body crosses itself, its faces lie double, or faces of its ground side are
            missing, on more than 2 % of the lines through it: area by faces and by outline, or
            volume by faces and by height, disagree.
    """
    covered = seen.covered
    shape = tuple(max(1, int(n * seen.spacing / _OVERLAP_PITCH)) for n in covered.shape)
    # off the cells' own places by odd parts, so that lines don't run along edges or diagonals
    odd = (0.381966, 0.527864)
    first = tuple(s + n * _OVERLAP_PITCH for s, n in zip(seen.first, odd, strict=True))

    triangles = without_copies(mesh.triangles) if sound.duplicates else mesh.triangles

    def lines(body: NDArray[np.int32]) -> tuple[int, int, int, int, int]:
        return overlap_lines(
            triangles, body, seen.axes, (first[0], first[1]), _OVERLAP_PITCH,
            (shape[0], shape[1]), _SAME_PLACE,
        )  # fmt: skip

    count = triangles.shape[0]
    crossed, doubled, missing, odd_lines, met = lines(np.zeros(count, dtype=np.int32))
    own = 0
    known_sides = sound.turned_edges <= _MOST_APART * count
    if known_sides and crossed > _MOST_APART * met and count <= MOST_FACES:
        own, *_ = lines(closed_bodies(triangles))
    one_sided = odd_lines > met / 2  # as a scan without its upper side
    for many, what, cause in (
        (own, "the surface crosses itself", "corners of its faces are mixed up"),
        (0 if one_sided else missing, "faces of the ground side are missing",
         "a program left out faces that it did not understand"),
        (doubled, "faces lie double, with nothing between them",
         "concave polygons were cut as if they were convex"),
    ):  # fmt: skip
        if many > _MOST_APART * met:
            raise DataError(
                Message(
                    "{what} on {many:.0%} of the lines through it: its area by faces and by "
                    "outline disagree, as where {cause}",
                    what=what,
                    many=many / met,
                    cause=cause,
                ),
                where=where,
                allowed=f"{_MOST_APART:.0%}",
                remedy="Export it again as STEP or, by another program, as triangles",
            )
    if not crossed:
        return []
    return [
        Message(
            "The surface crosses itself, or bodies overlap, on {crossed} of "
            "{met} lines through the sole; tolerated, the lowest surface "
            "counts.",
            crossed=crossed,
            met=met,
        )
    ]
