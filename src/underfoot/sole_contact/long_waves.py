"""Long waves of a compliance put right by elements of the body's real shape.

Layers in closed form know one thickness and free sides as if they were upright. Where a profile
thins a heel they are a fifth too soft at its rear, and the gap under a bevel tilts by a third of a
degree. So, with B waves of some mm (splines of second order: a kink would be a wedge to the film),
C the layers and D the elements,

    u = C p + B K B^T p,   K = R (B^T D B) R - R' (B^T C B) R',   R = (B^T B)^-1

which is symmetric, D for what the waves resolve and C for all that is finer. R is the overlap of
waves over the elements, R' that over the cells, so that both bear the same forces.
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

from ._kernels.brick_elements import Bricks, work_of_waves
from ._kernels.splines import Splines

Box = tuple[slice, slice]
SIDE = 4e-3
"""Side of a square, m, at most; larger where ``MOST_SQUARES`` do not cover the plan."""
LEAST_LENGTH = 30e-3
"""Length and width (m) of what is near the floor, below which the layers stay as they are: they
were set by blocks of that size."""
MOST_SQUARES = 400
WAVE = 2
"""Squares under one of the waves, each way: what bricks don't resolve, the layers know better.
Waves of one square beat with lugs: the film of a tread hung on the side of a square."""
REACH = 6e-3
"""Land higher above the floor than this (m) keeps the layers alone."""
MARGIN = 1.5
"""Thicknesses of the body around this land that are meshed."""
FAINT = 0.1
"""Share of what is cut off a wave's overlap with itself by which its correction fades out."""
ALIKE = 1e-3
"""Share of a whole wave's overlap with itself by which waves fade that cells can't tell apart."""
NARROWEST = 0.1
"""Width of a row of bricks where the rim ends in a point, over the widest."""
SAMPLES = 3  # a side of a quarter of a square
GROWTH = 2.0  # from a layer of bricks to the next, from the floor up
MIDSOLE_LAYERS = 2
NEARLY_INCOMPRESSIBLE = 0.499


@dataclass(frozen=True, slots=True)
class LongWaves:
    """Correction B K B^T of a deflection: ``waves`` B (cells, n), ``matrix`` K (n, n) in m/Pa."""

    waves: sp.csr_matrix
    matrix: Array

    def apply(self, pressure: NDArray[Any]) -> NDArray[Any]:
        """Return what is added to the deflection (nx, ny) under a pressure (nx, ny)."""
        weight = self.waves.T @ pressure.ravel()
        return (self.waves @ (self.matrix @ weight)).reshape(pressure.shape)

    def self_compliance(self, shape: tuple[int, int]) -> Array:
        """Return what is added to the deflection of a cell under its own unit pressure."""
        return np.asarray(self.waves.multiply(self.waves @ self.matrix).sum(axis=1)).reshape(shape)

    def within(self, shape: tuple[int, int], box: Box, dtype: Any = float) -> LongWaves:
        """Return the same between the cells of a box of a map of ``shape``."""
        cells = np.arange(shape[0] * shape[1]).reshape(shape)[box].ravel()
        waves: Any = self.waves[cells].astype(dtype)
        used = np.unique(waves.indices)
        return LongWaves(waves[:, used], self.matrix[np.ix_(used, used)].astype(dtype))


@dataclass(frozen=True, slots=True)
class SoleBody:
    """What carries the lugs: rubber of one thickness field, a midsole, a rigid foot.

    ``thickness`` (nx, ny) in m along the shoe's normal, ``shoe_angle`` of its plane in rad;
    ``midsole`` is its modulus (Pa), Poisson's ratio and thickness (m), None for none.
    """

    sole: SoleMap
    thickness: Array
    shoe_angle: float
    modulus: float
    poisson_ratio: float
    midsole: tuple[float, float, float] | None = None


@dataclass(frozen=True, slots=True)
class Net:
    """Squares drawn out to the rim: columns across the sole, each from side to side.

    ``x`` (2 nx + 1,) are the ends and middles of the columns, ``low`` and ``high`` where the rim
    lies there, m; ``ny`` the squares of a column.
    """

    x: Array
    low: Array
    high: Array
    ny: int

    @property
    def places(self) -> tuple[Array, Array]:
        """Places (2 nx + 1, 2 ny + 1) of corners and middles, m."""
        share = np.linspace(0.0, 1.0, 2 * self.ny + 1)
        return (
            np.broadcast_to(self.x[:, None], (self.x.size, share.size)),
            self.low[:, None] + (self.high - self.low)[:, None] * share,
        )


@dataclass(frozen=True, slots=True)
class BodyCorrection:
    """Correction of the layers of one shoe, for its maps on cells of ``spacing`` (m).

    ``matrix`` K (n, n) in m/N belongs to the waves ``chosen`` of ``splines``; ``by_bricks`` is what
    the elements say on any cells, m/N.
    """

    splines: Splines
    chosen: NDArray[np.int64]
    by_bricks: Array
    spacing: float
    matrix: Array

    def on(self, sole: SoleMap) -> LongWaves:
        """Return the correction on the cells of a map."""
        waves = near_waves(sole, self.splines)[:, self.chosen]
        return LongWaves(sp.csr_matrix(waves), self.matrix * sole.spacing**2)


def body_correction(
    body: SoleBody, layers: Callable[[sp.csr_matrix], Array], known: BodyCorrection | None = None
) -> BodyCorrection | None:
    """Return the correction of ``layers``: B to B^T C B (m/Pa); None where nothing is near.

    ``known`` is that of another map of the same shoe, whose elements serve this one too.
    """
    sole, near = body.sole, _near(body.sole)
    if known is not None and known.spacing == sole.spacing:
        return known
    along, across = np.nonzero(near)
    if not along.size or min(np.ptp(along), np.ptp(across)) + 1 < (LEAST_LENGTH / sole.spacing):
        return None
    if known is None:
        bricks, splines = _bricks(body, near)
        chosen = np.flatnonzero(np.diff(sp.csc_matrix(near_waves(sole, splines)).indptr))
        by_bricks = _compliance(*work_of_waves(bricks, splines, chosen), splines.size)
    else:
        splines, chosen, by_bricks = known.splines, known.chosen, known.by_bricks
    waves = sp.csr_matrix(near_waves(sole, splines)[:, chosen])
    cell = sole.spacing**2
    overlap = (waves.T @ waves).toarray() * cell
    matrix = by_bricks - _compliance(layers(waves) * cell, overlap, splines.size)
    return BodyCorrection(splines, chosen, by_bricks, sole.spacing, matrix)


def _compliance(work: Array, overlap: Array, size: float) -> Array:
    """Return the rise by waves (m) of forces on waves (N): R W R, R = overlap^-1.

    Waves that little of what presses is left of fade out, and what few cells can't tell apart.
    """
    missing = np.maximum(size - np.diagonal(overlap), 0.0)
    inverse = np.linalg.inv(overlap + np.diag(FAINT * missing + ALIKE * size))
    product = inverse @ work @ inverse
    return 0.5 * (product + product.T)


def _near(sole: SoleMap) -> NDArray[np.bool_]:
    """Return the cells near the floor."""
    return sole.inside & (sole.clearance < REACH)


def near_waves(sole: SoleMap, splines: Splines) -> sp.csr_matrix:
    """Return the waves at each cell, 0 away from what is near."""
    return splines.on(sole.x, sole.y, _near(sole))


def _through(values: Array, column: NDArray[np.intp], share: Array) -> Array:
    """Return the parabola through both ends and the middle of a column, as its bricks bend."""
    weights = (1 - share) * (1 - 2 * share), 4 * share * (1 - share), share * (2 * share - 1)
    return sum(
        (weight * values[2 * column + k].T for k, weight in enumerate(weights)), np.array(0.0)
    ).T


def splines_over(sole: SoleMap, near: NDArray[np.bool_], margin: float = 0.0) -> Splines:
    """Return waves over some cells and what of the sole is within ``margin`` (m) of them."""
    whole = sole.whole or sole
    half = 0.5 * sole.spacing
    ends = []
    for axis, places, cells in ((0, sole.x, whole.x), (1, sole.y, whole.y)):
        reached, rim = places[near.any(axis=1 - axis)], cells[whole.inside.any(axis=1 - axis)]
        low = max(float(rim[0]), float(reached[0]) - margin) - half
        ends.append((low, min(float(rim[-1]), float(reached[-1]) + margin) + half))
    (x0, x1), (y0, y1) = ends
    side = WAVE * max(SIDE, math.sqrt((x1 - x0) * (y1 - y0) / MOST_SQUARES))
    nx, ny = (max(1, math.ceil(length / side - 1e-9)) for length in (x1 - x0, y1 - y0))
    return Splines((x0, y0), ((x1 - x0) / nx, (y1 - y0) / ny), (nx, ny))


def net_over(sole: SoleMap, splines: Splines) -> Net:
    """Return the squares under some waves, ``WAVE`` each way under a square of theirs."""
    whole = sole.whole or sole
    half = 0.5 * sole.spacing
    nx, ny = (WAVE * count for count in splines.squares)
    (x0, y0), (x1, y1) = splines.start, splines.end
    x = np.linspace(x0, x1, 2 * nx + 1)
    # parabolas nearest to the rim, which may end in a round
    rows = np.flatnonzero(whole.inside.any(axis=1) & (whole.x > x0) & (whole.x < x1))
    at = nx * (whole.x[rows] - x0) / (x1 - x0)
    column = np.minimum(at.astype(np.intp), nx - 1)
    bends = _through(np.eye(x.size), column, at - column)
    first = whole.inside[rows].argmax(axis=1)
    last = whole.y.size - 1 - whole.inside[rows, ::-1].argmax(axis=1)
    rim = np.clip(np.column_stack([whole.y[first] - half, whole.y[last] + half]), y0, y1)
    low, high = np.linalg.lstsq(bends, rim)[0].T
    least = 0.5 * NARROWEST * (y1 - y0)
    middle = 0.5 * (low + high)
    return Net(x, np.minimum(low, middle - least), np.maximum(high, middle + least), ny)


def _bricks(body: SoleBody, near: NDArray[np.bool_]) -> tuple[Bricks, Splines]:
    """Return the bricks over the squares of a net, and the waves over them."""
    sole = body.sole
    margin = MARGIN * (float(body.thickness.max()) + (body.midsole[2] if body.midsole else 0.0))
    splines = splines_over(sole, near, margin)
    net = net_over(sole, splines)
    x, y = net.places
    thickness = _at(sole, body.thickness, x, y)
    side = float(net.x[2] - net.x[0])
    shares = _layer_shares(float(body.thickness[near].mean()), side)
    levels = [thickness * share for share in _halves(shares)]
    modulus, ratio = [body.modulus] * (shares.size - 1), [body.poisson_ratio] * (shares.size - 1)
    if body.midsole is not None:
        soft, soft_ratio, deep = body.midsole
        steps = np.arange(1, 2 * MIDSOLE_LAYERS + 1) / (2 * MIDSOLE_LAYERS)
        levels += [thickness + deep * step for step in steps]
        modulus += [soft] * MIDSOLE_LAYERS
        ratio += [soft_ratio] * MIDSOLE_LAYERS
    sine, cosine = math.sin(body.shoe_angle), math.cos(body.shoe_angle)
    base = np.stack([x, y, x * sine / cosine - thickness / cosine], axis=-1)
    normal = np.array([-sine, 0.0, cosine])
    nodes = np.stack([base + level[..., None] * normal for level in levels], axis=2)
    capped = np.minimum(ratio, NEARLY_INCOMPRESSIBLE)
    whole = sole.whole or sole
    cover = _covered_shares(whole, whole.inside, net)
    pressed = cover * _covered_shares(sole, near, net)
    return Bricks(nodes, cover, pressed, np.array(modulus), capped), splines


def _halves(places: Array) -> Array:
    """Return places with those halfway between them."""
    return np.interp(np.arange(2 * places.size - 1) / 2, np.arange(places.size), places)


def _layer_shares(thickness: float, side: float) -> Array:
    """Return the shares 0 to 1 of the outsole's thickness at which its layers of bricks end."""
    steps = [side]
    while sum(steps) < thickness or len(steps) < 2:
        steps.append(steps[-1] * GROWTH)
    return np.concatenate([[0.0], np.cumsum(steps) / sum(steps)])


def _at(sole: SoleMap, field: Array, x: Array, y: Array) -> Array:
    """Return a field of the map at places (m), linear between cells."""
    from scipy.ndimage import map_coordinates

    at = (x - sole.x[0]) / sole.spacing, (y - sole.y[0]) / sole.spacing
    return np.asarray(map_coordinates(field, at, order=1, mode="nearest"))


def _covered_shares(sole: SoleMap, cells: NDArray[np.bool_], net: Net) -> Array:
    """Return the share of each quarter of a square (2 nx, 2 ny) that some cells cover.

    A cell's width from it counts: the net ends at the rim, cells do so in steps.
    """
    from scipy.ndimage import binary_dilation

    x, y = net.places
    inside = binary_dilation(cells, np.ones((3, 3))).astype(float)
    points = (np.arange(SAMPLES) + 0.5) / SAMPLES
    total = np.zeros((x.shape[0] - 1, x.shape[1] - 1))
    for a in points:
        for b in points:
            at = [
                (1 - a) * ((1 - b) * place[:-1, :-1] + b * place[:-1, 1:])
                + a * ((1 - b) * place[1:, :-1] + b * place[1:, 1:])
                for place in (x, y)
            ]
            total += _at(sole, inside, *at)
    return total / SAMPLES**2
