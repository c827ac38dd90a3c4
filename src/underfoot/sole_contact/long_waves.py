"""Long waves of a compliance put right by elements of the body's real shape.

Layers in closed form know one thickness and free sides as if they were upright. Where a profile
thins a heel they are a fifth too soft at its rear, and the gap under a bevel tilts by a third of a
degree. So, with B hats of some mm, C the layers and D the elements,

    u = C p + B K B^T p,   K = R (B^T D B - B^T C B) R,   R = (B^T B)^-1

which is symmetric, D for what the hats resolve and C for all that is finer.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from underfoot.core.arrays import Array
from underfoot.shoe.geometry import SoleMap

from ._kernels.brick_elements import Bricks, work_of_hats

Box = tuple[slice, slice]
SIDE = 6e-3
"""Side of a brick and of a hat, m; larger where ``MOST_SQUARES`` do not cover the plan."""
LEAST_SIDES = 5
"""Hats along and across what is near the floor, below which the layers stay as they are: they were
set by blocks of that size."""
MOST_SQUARES = 200
REACH = 6e-3
"""Land higher above the floor than this (m) keeps the layers alone."""
MARGIN = 1.5
"""Thicknesses of the body around this land that are meshed."""
GROWTH = 1.6  # from a layer of bricks to the next, from the floor up
MIDSOLE_LAYERS = 2
NEARLY_INCOMPRESSIBLE = 0.499
FAINT = 0.1
"""Share of what the rim cuts off a hat's overlap with itself by which its correction fades out."""


@dataclass(frozen=True, slots=True)
class LongWaves:
    """Correction B K B^T of a deflection: ``hats`` B (cells, n), ``matrix`` K (n, n) in m/Pa."""

    hats: sp.csr_matrix
    matrix: Array

    def apply(self, pressure: NDArray[Any]) -> NDArray[Any]:
        """Return what is added to the deflection (nx, ny) under a pressure (nx, ny)."""
        weight = self.hats.T @ pressure.ravel()
        return (self.hats @ (self.matrix @ weight)).reshape(pressure.shape)

    def self_compliance(self, shape: tuple[int, int]) -> Array:
        """Return what is added to the deflection of a cell under its own unit pressure."""
        product = self.hats.multiply(sp.csr_matrix(self.hats @ sp.csr_matrix(self.matrix)))
        return np.asarray(product.sum(axis=1)).reshape(shape)

    def within(self, shape: tuple[int, int], box: Box, dtype: Any = float) -> LongWaves:
        """Return the same between the cells of a box of a map of ``shape``."""
        cells = np.arange(shape[0] * shape[1]).reshape(shape)[box].ravel()
        hats: Any = self.hats[cells].astype(dtype)
        used = np.unique(hats.indices)
        return LongWaves(hats[:, used], self.matrix[np.ix_(used, used)].astype(dtype))


@dataclass(frozen=True, slots=True)
class Body:
    """What carries the lugs: rubber of one thickness field, a midsole, a rigid foot.

    ``plan`` are the cells that press on it; ``thickness`` (nx, ny) in m along the shoe's normal,
    ``shoe_angle`` of its plane in rad;
    ``midsole`` is its modulus (Pa), Poisson's ratio and thickness (m), None for none.
    """

    sole: SoleMap
    plan: NDArray[np.bool_]
    thickness: Array
    shoe_angle: float
    modulus: float
    poisson_ratio: float
    midsole: tuple[float, float, float] | None = None


@dataclass(frozen=True, slots=True)
class BodyCorrection:
    """Correction of the layers of one shoe, for its maps on cells of ``spacing`` (m).

    ``matrix`` K (n, n) in m/Pa per m^2 of the floor belongs to the hats of the corners ``chosen``,
    numbers i n_y + j of the places ``x`` and ``y`` (m); ``work`` is that of the elements on any
    cells, m^3/Pa.
    """

    x: Array
    y: Array
    chosen: NDArray[np.int64]
    work: Array
    spacing: float
    matrix: Array

    def on(self, sole: SoleMap, plan: NDArray[np.bool_]) -> LongWaves:
        """Return the correction on the cells of a map of which ``plan`` press on the body."""
        hats = _hats(sole, self.x, self.y, plan & (sole.clearance < REACH))[:, self.chosen]
        return LongWaves(sp.csr_matrix(hats), self.matrix * sole.spacing**2)


def body_correction(
    body: Body, layers: Callable[[sp.csr_matrix], Array], known: BodyCorrection | None = None
) -> BodyCorrection | None:
    """Return the correction of ``layers``: B to B^T C B (m/Pa); None where nothing is near.

    ``known`` is that of another map of the same shoe, whose elements serve this one too.
    """
    sole, near = body.sole, body.plan & (body.sole.clearance < REACH)
    if known is not None and known.spacing == sole.spacing:
        return known
    along, across = np.nonzero(near)
    if not along.size or min(np.ptp(along), np.ptp(across)) + 1 < (
        LEAST_SIDES * SIDE / sole.spacing
    ):
        return None
    if known is None:
        bricks, x, y = _bricks(body, near)
        chosen = np.flatnonzero(np.diff(sp.csc_matrix(_hats(sole, x, y, near)).indptr))
        work = work_of_hats(bricks, chosen)
    else:
        x, y, chosen, work = known.x, known.y, known.chosen, known.work
    hats = sp.csr_matrix(_hats(sole, x, y, near)[:, chosen])
    cell = sole.spacing**2
    overlap = (hats.T @ hats).toarray() * cell
    missing = np.maximum(4 / 9 * (x[1] - x[0]) ** 2 - np.diagonal(overlap), 0.0)
    inverse = np.linalg.inv(overlap + np.diag(FAINT * missing))
    matrix = inverse @ (work - layers(hats) * cell) @ inverse
    return BodyCorrection(x, y, chosen, work, sole.spacing, 0.5 * (matrix + matrix.T))


def _bricks(body: Body, near: NDArray[np.bool_]) -> tuple[Bricks, Array, Array]:
    """Return the bricks and the places of their corners along x and across y."""
    sole = body.sole
    whole = sole.whole or sole
    margin = MARGIN * (float(body.thickness.max()) + (body.midsole[2] if body.midsole else 0.0))
    ends = []
    half = 0.5 * sole.spacing
    for axis, places, across in ((0, sole.x, whole.x), (1, sole.y, whole.y)):
        reached, rim = places[near.any(axis=1 - axis)], across[whole.inside.any(axis=1 - axis)]
        low = max(float(rim[0]) - half, float(reached[0]) - margin)
        ends.append((low, min(float(rim[-1]) + half, float(reached[-1]) + margin)))
    (x0, x1), (y0, y1) = ends
    side = max(SIDE, math.sqrt((x1 - x0) * (y1 - y0) / MOST_SQUARES))
    nx, ny = (max(1, math.ceil(length / side - 1e-9)) for length in (x1 - x0, y1 - y0))
    corner_x = x0 + side * np.arange(nx + 1)  # from the rear, where a heel lands
    corner_y = 0.5 * (y0 + y1) + side * (np.arange(ny + 1) - 0.5 * ny)  # as its mirror image
    boxes = _halves(corner_x), _halves(corner_y)
    cover, loaded = _covered(whole, whole.inside, *boxes), _covered(sole, body.plan, *boxes)
    thickness = _at(sole, body.thickness, _halves(corner_x), _halves(corner_y))
    shares = _graded(float(body.thickness[near].mean()), side)
    levels = [thickness * share for share in _halves(shares)]
    modulus, ratio = [body.modulus] * (shares.size - 1), [body.poisson_ratio] * (shares.size - 1)
    if body.midsole is not None:
        soft, soft_ratio, deep = body.midsole
        steps = np.arange(1, 2 * MIDSOLE_LAYERS + 1) / (2 * MIDSOLE_LAYERS)
        levels += [thickness + deep * step for step in steps]
        modulus += [soft] * MIDSOLE_LAYERS
        ratio += [soft_ratio] * MIDSOLE_LAYERS
    sine, cosine = math.sin(body.shoe_angle), math.cos(body.shoe_angle)
    x, y = np.meshgrid(_halves(corner_x), _halves(corner_y), indexing="ij")
    base = np.stack([x, y, x * sine / cosine - thickness / cosine], axis=-1)
    normal = np.array([-sine, 0.0, cosine])
    nodes = np.stack([base + level[..., None] * normal for level in levels], axis=2)
    capped = np.minimum(ratio, NEARLY_INCOMPRESSIBLE)
    return Bricks(side, nodes, cover, loaded, np.array(modulus), capped), corner_x, corner_y


def _halves(places: Array) -> Array:
    """Return places with those halfway between them."""
    return np.interp(np.arange(2 * places.size - 1) / 2, np.arange(places.size), places)


def _graded(thickness: float, side: float) -> Array:
    """Return the shares 0 to 1 of the outsole's thickness at which its layers of bricks end."""
    steps = [side]
    while sum(steps) < thickness or len(steps) < 2:
        steps.append(steps[-1] * GROWTH)
    return np.concatenate([[0.0], np.cumsum(steps) / sum(steps)])


def _at(sole: SoleMap, field: Array, x: Array, y: Array) -> Array:
    """Return a field of the map at the places of a grid, linear between cells."""
    from scipy.ndimage import map_coordinates

    at = np.meshgrid((x - sole.x[0]) / sole.spacing, (y - sole.y[0]) / sole.spacing, indexing="ij")
    return np.asarray(map_coordinates(field, at, order=1, mode="nearest"))


def _hats(sole: SoleMap, x: Array, y: Array, near: NDArray[np.bool_]) -> sp.csr_matrix:
    """Return the hat of each corner at each cell, 0 away from what is near."""

    def along(places: Array, corners: Array) -> sp.csr_matrix:
        step = corners[1] - corners[0]
        value = 1 - np.abs(places[:, None] - corners) / step
        return sp.csr_matrix(np.maximum(value, 0.0))

    every = sp.kron(along(sole.x, x), along(sole.y, y), format="csr")
    return sp.csr_matrix(sp.diags(near.ravel().astype(float)) @ every)


def wide_hats(sole: SoleMap, land: NDArray[np.bool_]) -> sp.csr_matrix:
    """Return hats of ``SIDE`` on the cells of some land, those without land left out."""
    corners = []
    for axis, places in ((0, sole.x), (1, sole.y)):
        reached = places[land.any(axis=1 - axis)]
        count = max(1, round((reached[-1] - reached[0]) / SIDE))
        corners.append(np.linspace(reached[0], reached[-1], count + 1))
    along, across = corners
    hats = _hats(sole, along, across, land)
    return sp.csr_matrix(hats[:, np.diff(sp.csc_matrix(hats).indptr) > 0])


def _covered(sole: SoleMap, plan: NDArray[np.bool_], x: Array, y: Array) -> Array:
    """Return the share of each box between the places x and y that some cells of a map cover."""
    total = np.pad(np.cumsum(np.cumsum(plan, axis=0), axis=1), ((1, 0), (1, 0)))
    for axis, places, cells in ((0, x, sole.x), (1, y, sole.y)):
        at = np.clip((places - cells[0]) / sole.spacing + 0.5, 0, cells.size)
        low = np.minimum(at.astype(np.intp), cells.size - 1)
        share = (at - low)[:, None] if axis == 0 else at - low
        below, above = np.take(total, low, axis), np.take(total, low + 1, axis)
        total = below + share * (above - below)
    step = (x[1] - x[0]) * (y[1] - y[0]) / sole.spacing**2
    return np.diff(np.diff(total, axis=0), axis=1) / step
