"""A plane of floor that was left in a file with the sole."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask

from .._kernels.components import MOST_FACES, components
from .mesh import Mesh
from .orientation import box_axes
from .settings import FileSettings

_FLAT = 0.94  # cosine between normal and plane: the faces of a plane with noise
_BINS = 400  # over the height: where a plane's area stands out
_WIDER = 1.15  # than all else, both ways: cut without asking
_AS_WIDE = 1.01
_SPREADS = 4.0  # standard deviations of a plane's noise that are cut
_LEAST = 1e-4  # of the length
_SAMPLE = 400_000


def without_floor(mesh: Mesh, settings: FileSettings) -> tuple[Mesh, Array | None, list[str]]:
    """Return the mesh without a floor plane, where the ground is, and what was seen of a plane.

    A floor plane: faces level with each other that reach beyond all else by 15 % both ways; it is
    cut, as an assumption. Where it reaches beyond by 1 % it is cut when ``cut_floor`` is set, and
    hinted at else. A scan hangs together with the table it lies on: then the ground side is the one
    away from it (a direction in the file's axes, else None).
    """
    axes = box_axes(mesh.triangles, FileSettings())
    chosen = mesh.triangles[:: math.ceil(mesh.triangles.shape[0] / _SAMPLE) or 1]
    plane = _plane(chosen, axes)
    if plane is None:
        return mesh, None, []
    level, spread, size, rest = plane
    beyond = (size / np.maximum(rest, 1e-30)).min()
    if beyond < _AS_WIDE:
        return mesh, None, []
    what = f"flat plane of {size[0]:.4g} x {size[1]:.4g}, larger than all else in the file"
    if beyond < _WIDER and not settings.cut_floor:
        return mesh, None, [f"There is a {what}: if it is a floor, cut it with --cut-floor."]
    heights = mesh.triangles @ axes[2].astype(np.float32)
    keep = (np.abs(heights - np.float32(level)) > spread).any(axis=1)
    if not keep.any():
        return mesh, None, []
    lost = " What of the sole lies in it is lost."
    rest = heights[keep]
    away = axes[2] * (1.0 if float(np.nanmean(rest)) > level else -1.0)
    down: Array | None = away if settings.down == "auto" else None
    if mesh.triangles.shape[0] <= MOST_FACES:
        # a plane that hangs together with nothing else goes alone: the land may stand on it
        number, count = components(mesh.triangles)
        apart = np.bincount(number, keep, minlength=count)[number] == 0
        if np.count_nonzero(apart) > 0.5 * np.count_nonzero(~keep):
            keep, lost, down = ~apart, "", None
    body = None if mesh.body is None else mesh.body[keep]
    chosen_words = "was cut as floor" if settings.cut_floor else "was taken as floor and cut"
    begin = "A" if settings.cut_floor else "Assumed: a"
    return (
        replace(mesh, triangles=mesh.triangles[keep], body=body),
        down,
        [f"{begin} {what}, {chosen_words} ({np.count_nonzero(~keep)} faces).{lost}"],
    )


def _plane(triangles: NDArray[np.float32], axes: Array) -> tuple[float, float, Array, Array] | None:
    """Return height, half thickness and extents of the widest level plane, and those of the rest.

    None where no plane stands out. All in the file's unit, seen along the third axis.
    """
    corners = triangles.astype(np.float64) @ axes.T
    sides = corners[:, 1:] - corners[:, :1]
    normal = np.cross(sides[:, 0], sides[:, 1])
    area = np.linalg.norm(normal, axis=1)
    level = np.abs(normal[:, 2]) > _FLAT * area
    level &= area > 0
    if not level.any():
        return None
    height = corners.mean(axis=1)[:, 2]
    low, high = float(np.nanmin(corners[..., 2])), float(np.nanmax(corners[..., 2]))
    length = float(np.ptp(corners[..., 0]))
    if high - low < _LEAST * length:
        return None
    counts, edges = np.histogram(height[level], _BINS, (low, high), weights=area[level])
    peak = int(np.argmax(counts))
    middle = float((edges[peak] + edges[peak + 1]) / 2)
    near = level & (np.abs(height - middle) < 3 * (edges[1] - edges[0]))
    middle = _median(height[near], area[near])
    spread = 1.4826 * _median(np.abs(height[near] - middle), area[near])
    half = max(_SPREADS * spread * np.sqrt(3.0), _LEAST * length)  # of corners, not of middles
    in_plane: Mask = (np.abs(corners[..., 2] - middle) <= half).all(axis=1)
    if in_plane.all() or not in_plane.any():
        return None
    sizes = [
        np.ptp(corners[part][..., :2].reshape(-1, 2), axis=0) for part in (in_plane, ~in_plane)
    ]
    return middle, half, sizes[0], sizes[1]


def _median(values: Array, weights: Array) -> float:
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(total, total[-1] / 2)])
