"""A plane of floor, table or build plate that was left in a file with the sole."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask
from underfoot.core.remark import Message, assumption_line

from .._kernels.components import MOST_FACES, components
from .._kernels.regions import grow_mask, shrunk, without_specks
from .carriers import span_mask
from .mesh import Mesh
from .orientation import box_axes, level_axes
from .settings import FileSettings
from .view import View, extents, view

_FLAT = 0.94  # cosine between normal and plane: the faces of a plane with noise
_BINS = 400  # over the height: where a plane's area stands out
_LEVELS = 4  # planes that are looked at, the widest first
_BEYOND = 0.08, 0.02  # of the plan form of a surface, of a body: what is less is no floor
_SPIKES = 0.01  # of a plane's faces
_LEVEL_WITH = 0.2  # of a body's plan form: its land or its top lies in the plane
_LAND = 0.25  # of the plan form of all else: a plane seen there is land, not what lies behind
_SPREADS = 4.0  # standard deviations of a plane's noise that are cut
_LEAST = 1e-4  # of the length
_SAMPLE = 400_000
_COARSE = 300  # cells along the file
_SPECK = 20  # cells
_TILT = 1e-4  # rad: what is level within it stays as it lies


def without_floor(mesh: Mesh, settings: FileSettings) -> tuple[Mesh, Array | None, list[Message]]:
    """Return the mesh without a floor plane, where the ground is, and what was seen of a plane.

    A floor plane: level, and seen beyond the plan form of all else, over 2 % of it beside a body
    with two sides, 8 % beside a surface without thickness (a scan). It is cut, as an assumption:
    what hangs together with nothing whole; beside a body where it reaches beyond; behind a scan,
    which rises from its table towards the normals, all that lies in it, and the ground side is the
    one away from it (a direction in the file's axes, else None). A plane that is seen between the
    rest over 25 % of it, or that a scan doesn't rise from, may be land: it stays, which is told,
    and is cut when ``cut_floor`` is set.
    """
    axes = _level_axes(mesh.triangles)
    low, high = extents(mesh.triangles, axes)
    if high[2] - low[2] < _LEAST * (high[0] - low[0]):
        return mesh, None, []
    seen = view(mesh.triangles, axes, float(max(high[:2] - low[:2])) / _COARSE)
    found = None
    for level, half in _levels(mesh.triangles, axes):
        flat = np.maximum(seen.highest - level, level - seen.lowest) <= half
        rest = without_specks(seen.covered & ~flat, _SPECK)
        if not rest.any():
            continue
        solid = float(np.median((seen.highest - seen.lowest)[rest])) > 2 * half
        hull = span_mask(rest)
        plan = rest if solid else hull
        beyond = np.pad(flat & ~plan, 2, mode="edge")
        beyond = grow_mask(shrunk(beyond, 1), 1)[2:-2, 2:-2] & ~plan
        land = np.count_nonzero(flat & hull) > _LAND * np.count_nonzero(hull)
        share = np.count_nonzero(beyond) / np.count_nonzero(hull)
        if share > _BEYOND[solid] and (found is None or share > found[0]):
            found = share, level, half, rest, beyond, solid, land
    if found is None:
        return mesh, None, []
    _, level, half, rest, beyond, solid, land = found
    heights = mesh.triangles @ axes[2].astype(np.float32)
    in_plane = (np.abs(heights - np.float32(level)) <= half).all(axis=1)
    size = np.ptp(mesh.triangles[in_plane].reshape(-1, 3) @ axes[:2].T, axis=0)
    plane: dict[str, Any] = {"length": size[0], "width": size[1]}
    risen = float(np.median((seen.lowest - level)[rest]))
    towards = risen * float(np.median(seen.facing[beyond])) > 0
    if not settings.cut_floor and (land or not (solid or towards)):
        told = assumption_line(
            "a level plane of {length:.4g} x {width:.4g} that reaches beyond all else in the file "
            "is part of the sole. If it is a floor or a table, cut it with --cut-floor (in a case: "
            "cut_floor = true).",
            **plane,
        )
        return mesh, None, [told]
    beside = _within(mesh.triangles.mean(axis=1), seen, ~rest if solid else beyond)
    level_with = np.minimum(np.abs(seen.lowest - level), np.abs(seen.highest - level))[rest] <= half
    if not solid:
        cut = beside
    elif np.count_nonzero(level_with) > _LEVEL_WITH * level_with.size:
        cut = beside & in_plane  # land or top of the body lie in the plane
    else:
        cut = in_plane | _within(mesh.triangles.mean(axis=1), seen, ~grow_mask(rest, 1))
    lost, down = "", None
    apart = _whole_pieces(mesh, in_plane, seen, ~rest)
    if apart.any():
        cut = apart
    elif not (solid or land):
        cut, lost = cut | in_plane, Message(" What of the sole lies in it is lost.")
        if settings.down == "auto":
            down = axes[2] * np.sign(risen)
    body = None if mesh.body is None else mesh.body[~cut]
    plane |= {"faces": np.count_nonzero(cut), "lost": lost}
    told = (
        Message(
            "A level plane of {length:.4g} x {width:.4g} that reaches beyond all else in the file "
            "was cut as floor ({faces} faces).{lost}",
            **plane,
        )
        if settings.cut_floor
        else assumption_line(
            "a level plane of {length:.4g} x {width:.4g} that reaches beyond all else in the file "
            "was taken as floor and cut ({faces} faces).{lost}",
            **plane,
        )
    )
    return replace(mesh, triangles=mesh.triangles[~cut], body=body), down, [told]


def _within(points: NDArray[np.floating], seen: View, region: Mask) -> Mask:
    """Return which points (..., 3) of the file lie over the region."""
    places = np.nan_to_num((points @ seen.axes[:2].T - seen.first) / seen.spacing)
    rows, columns = (
        np.clip(np.rint(places[..., n]), 0, region.shape[n] - 1).astype(int) for n in (0, 1)
    )
    return region[rows, columns]


def _whole_pieces(mesh: Mesh, in_plane: Mask, seen: View, beside: Mask) -> Mask:
    """Return the faces of pieces that lie in the plane alone and reach beyond all else."""
    if mesh.triangles.shape[0] > MOST_FACES:
        return np.zeros_like(in_plane)
    number, count = components(mesh.triangles)
    reaching = _within(mesh.triangles, seen, beside).any(axis=1)
    alone = np.bincount(number, ~in_plane, count) < _SPIKES * np.bincount(number, minlength=count)
    return (alone & (np.bincount(number, reaching, minlength=count) > 0))[number]


def _sample_triangles(triangles: NDArray[np.float32], axes: Array) -> tuple[Array, Array, Array]:
    """Return corners, normals (as long as twice the area) and their lengths in the frame."""
    chosen = triangles[:: math.ceil(triangles.shape[0] / _SAMPLE) or 1]
    corners = chosen.astype(np.float64) @ axes.T
    sides = corners[:, 1:] - corners[:, :1]
    normal = np.cross(sides[:, 0], sides[:, 1])
    return corners, normal, np.linalg.norm(normal, axis=1)


def _level_axes(triangles: NDArray[np.float32]) -> Array:
    """Return the frame of the file's box, turned so that most of what is nearly level is level."""
    axes = box_axes(triangles, FileSettings())
    _, normal, area = _sample_triangles(triangles, axes)
    level = (np.abs(normal[:, 2]) > _FLAT * area) & (area > 0)
    if not level.any():
        return axes
    slope_x, slope_y = (
        -_median(normal[level, n] / normal[level, 2], area[level]) for n in range(2)
    )
    turned, angle = level_axes(axes, (slope_x, slope_y, 0.0))
    return turned if angle > _TILT else axes


def _levels(triangles: NDArray[np.float32], axes: Array) -> list[tuple[float, float]]:
    """Return height and half thickness of the widest level planes, in the file's unit."""
    corners, normal, area = _sample_triangles(triangles, axes)
    level = (np.abs(normal[:, 2]) > _FLAT * area) & (area > 0)
    height = corners.mean(axis=1)[:, 2]
    low, high = float(np.nanmin(corners[..., 2])), float(np.nanmax(corners[..., 2]))
    length = float(np.ptp(corners[..., 0]))
    counts, edges = np.histogram(height[level], _BINS, (low, high), weights=area[level])
    planes = []
    for _ in range(_LEVELS):
        peak = int(np.argmax(counts))
        if counts[peak] <= 0:
            break
        middle = float((edges[peak] + edges[peak + 1]) / 2)
        near = level & (np.abs(height - middle) < 3 * (edges[1] - edges[0]))
        middle = _median(height[near], area[near])
        spread = 1.4826 * _median(np.abs(height[near] - middle), area[near])
        # of corners, not of middles
        planes.append((middle, max(_SPREADS * spread * math.sqrt(3.0), _LEAST * length)))
        counts[max(0, peak - 3) : peak + 4] = 0
    return planes


def _median(values: Array, weights: Array) -> float:
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(total, total[-1] / 2)])
