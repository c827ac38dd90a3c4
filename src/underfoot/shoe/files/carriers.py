"""Lugs that are bodies of their own, and the body that carries them: one sole, by their contact."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask

from .._kernels.components import MOST_FACES, extents_of_bodies
from .._kernels.height_buffer import height_buffer
from .mesh import Mesh
from .orientation import box_axes
from .settings import FileSettings
from .view import View, extents, view

_MOST = 12  # bodies that are looked at, the largest first
_FACES = 1000  # of a body whose contact is looked at: more tell no more
_COARSE = 300  # cells along a body
_NEAR = 1e-3  # of a body's length: faces nearer than this touch
_HANGS, _PART = 0.6, 0.1  # of a body's plan form over what carries it, in all: what touches it
_OPEN = 0.08  # of the plan form of lugs: what shows between them
_FITS = 3.0  # area where a carrier and the span of its lugs differ, over that span
_LEVEL = 0.5  # cosine of a face's normal with upright: a wall touches nothing
_SLENDER = 3.0  # height over width: a support, no lug


@dataclass(frozen=True, slots=True)
class _Claim:
    """A body that carries others on one side.

    Parameters:
        carrier, lugs: Numbers of bodies.
        side: Direction (3,) from the carrier to the lugs.
        misfit: Area where the carrier and the span of its lugs differ, over that span.
    """

    carrier: int
    lugs: frozenset[int]
    side: Array
    misfit: float


def group_bodies(mesh: Mesh) -> NDArray[np.intp]:
    """Return for each body the number of the group that it makes one sole with.

    A body carries lugs where these touch it over most of their plan form, leave gaps between them
    through which it shows, and stand out from it there. Lugs between two such bodies, a base and a
    table, hang on the one that fits their span better.
    """
    assert mesh.body is not None
    count = len(mesh.bodies)
    group = np.arange(count)
    if count < 2 or mesh.triangles.shape[0] > MOST_FACES:
        return group
    claims: list[_Claim] = []
    size = _sizes(mesh.triangles, mesh.body, np.eye(3), count)
    sample = _sample(mesh.body, count)
    for carrier in np.argsort(-(size**2).sum(axis=1))[:_MOST]:
        claims += _claims(mesh, sample, int(carrier))
    claims.sort(key=lambda claim: claim.misfit)
    taken: list[_Claim] = []
    for claim in claims:
        between = any(
            claim.lugs & other.lugs and claim.carrier != other.carrier
            and float(claim.side @ other.side) < 0
            for other in taken
        )  # fmt: skip
        if not between:
            taken.append(claim)
            joined = np.isin(group, group[[claim.carrier, *claim.lugs]])
            group[joined] = group[claim.carrier]
    return group


def _sample(body: NDArray[np.int32], count: int) -> NDArray[np.intp]:
    """Return the numbers of triangles that stand for their bodies: all of small ones."""
    order = np.argsort(body, kind="stable")
    sizes = np.bincount(body, minlength=count)
    place = np.arange(body.size) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    step = np.maximum(sizes // _FACES, 1)
    return np.sort(order[place % np.repeat(step, sizes) == 0])


def _claims(mesh: Mesh, sample: NDArray[np.intp], carrier: int) -> list[_Claim]:
    assert mesh.body is not None
    own = mesh.triangles[mesh.body == carrier]
    if own.shape[0] < 2:
        return []
    axes = box_axes(own, FileSettings())
    low, high = extents(own, axes)
    length = float(max(high[:2] - low[:2]))
    if not length > 0:
        return []
    seen = view(own, axes, length / _COARSE)
    body = mesh.body[sample]
    placed = mesh.triangles[sample].astype(np.float64) @ axes.T
    sides = placed[:, 1:] - placed[:, :1]
    normal = np.cross(sides[:, 0], sides[:, 1])
    area = np.linalg.norm(normal, axis=1)
    level = np.abs(normal[:, 2]) > _LEVEL * area
    plan = np.bincount(body, np.abs(normal[:, 2]), len(mesh.bodies)) / 2
    middle = placed.mean(axis=1)
    lowest, highest, there = _over(seen, middle)
    over = np.bincount(body, np.abs(normal[:, 2]) * there, len(mesh.bodies)) / 2
    near = _NEAR * length
    touching = level & there & (middle[:, 2] > lowest - near) & (middle[:, 2] < highest + near)
    out = [
        np.bincount(body, np.where(there, np.abs(normal[:, 2]) * np.maximum(far, 0.0), 0.0))
        for far in (lowest - middle[:, 2], middle[:, 2] - highest)
    ]  # of each body, how far it stands out on either side
    below = (out[0] > out[1])[body]
    size = _sizes(mesh.triangles[sample], body, axes, len(mesh.bodies))
    slender = size[:, 2] > _SLENDER * size[:, :2].max(axis=1)
    found = []
    for sign, on_side in ((-1.0, below), (1.0, ~below)):
        met = np.bincount(body, np.abs(normal[:, 2]) * (touching & on_side), len(mesh.bodies))
        lugs = (met > _HANGS * over) & (met > _PART * plan) & ~slender
        lugs[carrier] = False
        if lugs.any():
            claim = _claim(mesh, seen, carrier, lugs, sign, near)
            found += [claim] if claim else []
    return found


def _claim(
    mesh: Mesh, seen: View, carrier: int, lugs: Mask, sign: float, near: float
) -> _Claim | None:
    """Return the claim of a body on the lugs on one side of it, None where they leave no gaps."""
    assert mesh.body is not None
    lowest, highest, _ = height_buffer(
        mesh.triangles[lugs[mesh.body]], seen.axes, seen.first, seen.spacing, seen.covered.shape
    )
    plan = np.isfinite(lowest) & seen.covered
    span = span_mask(plan) & seen.covered
    gaps = span & ~plan
    if not plan.any() or np.count_nonzero(gaps) <= _OPEN * np.count_nonzero(plan):
        return None
    face, free = (seen.lowest, lowest) if sign < 0 else (seen.highest, highest)
    standing = sign * (float(np.median(free[plan])) - float(np.median(face[gaps])))
    if standing < near:
        return None
    misfit = np.count_nonzero(seen.covered ^ span) / np.count_nonzero(span)
    if misfit > _FITS:
        return None
    return _Claim(carrier, frozenset(np.flatnonzero(lugs).tolist()), sign * seen.axes[2], misfit)


def span_mask(mask: Mask) -> Mask:
    """Return the cells between cells of the mask across, then those between these along."""
    for axis in (1, 0):
        back = np.flip(np.logical_or.accumulate(np.flip(mask, axis), axis), axis)
        mask = np.logical_or.accumulate(mask, axis) & back
    return mask


def _over(seen: View, points: Array) -> tuple[Array, Array, Mask]:
    """Return the lowest and highest surface over points, and where there is any."""
    shape = seen.covered.shape
    with np.errstate(invalid="ignore"):
        places = np.rint((points[:, :2] - seen.first) / seen.spacing)
    there = np.asarray((places >= 0).all(axis=1) & (places < shape).all(axis=1))
    rows, columns = np.where(there[:, None], places, 0).astype(np.intp).T
    there &= seen.covered[rows, columns]
    return seen.lowest[rows, columns], seen.highest[rows, columns], there


def _sizes(
    triangles: NDArray[np.float32], body: NDArray[np.int32], axes: Array, count: int
) -> Array:
    """Return the extents of the bodies (count, 3) along the rows of ``axes``."""
    low, high, _ = extents_of_bodies(triangles, body, np.ascontiguousarray(axes), count)
    return np.where(np.isfinite(low), high - low, 0.0)
