"""Twenty-node bricks on a plan of squares, condensed to what they rise under loads of their floor.

A square that the plan form covers in part has that share of the rubber's stiffness (finite cells:
Parvizian, Düster and Rank 2007), so that nothing is meshed and all moves smoothly with the form.
"""

import pickle
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from underfoot.core.arrays import Array
from underfoot.core.sparse import factorization

from .splines import Splines

EMPTY = 1e-3
"""Share of the rubber's stiffness that stands for air, so that no node is loose."""
GAUSS = 1 / np.sqrt(3.0)


def _corners_and_edges() -> NDArray[np.int64]:
    """Return the places of the 20 nodes in the cube of 0, 1, 2."""
    grid = np.array([(i, j, k) for i in range(3) for j in range(3) for k in range(3)])
    return grid[(grid == 1).sum(axis=1) <= 1]


PLACES = _corners_and_edges()


def shape_functions(points: Array) -> tuple[Array, Array]:
    """Return values (n, 20) and gradients (n, 20, 3) of the serendipity functions in [-1, 1]^3."""
    node = PLACES - 1.0
    along = 1 + points[:, None, :] * node  # (n, 20, 3); 1 where the node lies in the middle
    middle = node == 0
    corner = ~middle.any(axis=1)
    factor = np.where(middle, 1 - points[:, None, :] ** 2, along)
    slope = np.where(middle, -2 * points[:, None, :], np.broadcast_to(node, along.shape))
    others = (points[:, None, :] * node).sum(axis=2) - 2
    scale = np.where(corner, 0.125, 0.25)
    product = factor.prod(axis=2)
    value = scale * product * np.where(corner, others, 1.0)
    gradient = np.empty(along.shape)
    for axis in range(3):
        rest = np.delete(factor, axis, axis=2).prod(axis=2)
        by = slope[:, :, axis] * rest
        gradient[:, :, axis] = scale * np.where(corner, by * others + product * node[:, axis], by)
    return value, gradient


@dataclass(frozen=True, slots=True)
class Bricks:
    """Bodies over a net of squares, bonded to a rigid foot at their top.

    ``nodes`` (2 nx + 1, 2 ny + 1, 2 nz + 1, 3) are places in the floor's frame, m, corners at even
    indices; ``cover`` (2 nx, 2 ny) is the share of each quarter of a square that the body covers,
    ``pressed`` that on which waves press;
    ``modulus`` and ``poisson_ratio`` (nz,) are those of the layers, from the floor up.
    """

    nodes: Array
    cover: Array
    pressed: Array
    modulus: Array
    poisson_ratio: Array


def work_of_waves(
    bricks: Bricks, splines: Splines, waves: NDArray[np.int64]
) -> tuple[Array, Array]:
    """Return the work of waves on the floor of the bricks, m^3/Pa, and their overlap, m^2, (n, n).

    ``waves`` are numbers of ``splines``; a wave is 0 where nothing presses. [a, b] is the integral
    of wave a times the rise under a pressure that is wave b, or times wave b itself. Small strain;
    reduced integration (2 x 2 x 2), so that nothing locks. What comes of a body is kept: cases that
    differ in fluid, floor, speed or hardness alone share it.
    """
    stiff = bricks.modulus[0]  # what the work goes by: other rubber under a foot is known too
    relative = replace(bricks, modulus=bricks.modulus / stiff)
    work, overlap = _work_of_waves(pickle.dumps((relative, splines, waves)))
    return work / stiff, overlap


@lru_cache(maxsize=8)
def _work_of_waves(pickled: bytes) -> tuple[Array, Array]:
    bricks, splines, waves = pickle.loads(pickled)
    number, elements = _numbering(bricks)
    stiffness = _stiffness(bricks, elements, number)
    rise, area, x, y = _floor(bricks, elements, number)
    pressed = splines.at(x, y)[:, waves]
    weighted = sp.csr_matrix(pressed.multiply(area[:, None]))
    right = np.ascontiguousarray((rise.T @ weighted).toarray())
    factors = factorization(stiffness, kind="positive definite", where="sole_contact.bricks")
    work = right.T @ factors.solve(right)
    return 0.5 * (work + work.T), (pressed.T @ weighted).toarray()


def _numbering(bricks: Bricks) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the number of each node, -1 at the foot, and the elements (i, j, k) that are there."""
    nx, ny = (n // 2 for n in bricks.cover.shape)
    nz = bricks.modulus.size
    filled = bricks.cover.reshape(nx, 2, ny, 2).sum(axis=(1, 3)) > 0
    i, j = np.nonzero(filled)
    elements = np.array([(a, b, k) for k in range(nz) for a, b in zip(i, j, strict=True)])
    used = np.zeros(bricks.nodes.shape[:3], dtype=bool)
    for a, b, c in PLACES:
        used[2 * elements[:, 0] + a, 2 * elements[:, 1] + b, 2 * elements[:, 2] + c] = True
    used[:, :, -1] = False
    number = np.full(used.shape, -1)
    number[used] = np.arange(used.sum())
    return number, elements


def _element_nodes(elements: NDArray[np.int64]) -> tuple[NDArray[np.int64], ...]:
    """Return the indices of the nodes of each element, three arrays (n, 20)."""
    i, j, k = (2 * elements[:, None, :] + PLACES[None]).transpose(2, 0, 1)
    return i, j, k


def _stiffness(
    bricks: Bricks, elements: NDArray[np.int64], number: NDArray[np.int64]
) -> sp.csr_matrix:
    at = _element_nodes(elements)
    places, numbers = bricks.nodes[at], number[at]
    modulus, ratio = (v[elements[:, 2]] for v in (bricks.modulus, bricks.poisson_ratio))
    shear = modulus / (2 * (1 + ratio))
    lame = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio))
    corners = np.array([(a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)])
    _, slopes = shape_functions(GAUSS * (2.0 * corners - 1))  # (8, 20, 3)
    i, j = (2 * elements[:, None, axis] + corners[:, axis] for axis in (0, 1))
    jacobian = np.swapaxes(places, 1, 2)[:, None] @ slopes  # (e, 8, 3, 3)
    share = np.abs(np.linalg.det(jacobian)) * np.maximum(bricks.cover[i, j], EMPTY)
    gradient = (slopes @ np.linalg.inv(jacobian)).reshape(len(elements), 8, 60)
    scaled = (share * shear[:, None])[:, :, None] * gradient
    product = (np.swapaxes(scaled, 1, 2) @ gradient).reshape(-1, 20, 3, 20, 3)
    total = (lame / shear)[:, None, None, None, None] * product + product.transpose(0, 1, 4, 3, 2)
    dot = np.trace(product, axis1=2, axis2=4)
    for axis in range(3):
        total[:, :, axis, :, axis] += dot
    unknowns = (3 * numbers[:, :, None] + np.arange(3)).reshape(-1, 60).astype(np.int32)
    rows, columns = np.broadcast_arrays(unknowns[:, :, None], unknowns[:, None, :])
    kept = (rows >= 0) & (columns >= 0)
    size = 3 * (int(number.max()) + 1)
    values = total.reshape(kept.shape)[kept]
    matrix = sp.csr_matrix((values, (rows[kept], columns[kept])), (size, size))
    matrix.sort_indices()
    return matrix


def _floor(
    bricks: Bricks, elements: NDArray[np.int64], number: NDArray[np.int64]
) -> tuple[sp.csr_matrix, Array, Array, Array]:
    """Return the rise by the unknowns at points of the floor, their pressed areas (m^2), x and y.

    Four points a quarter of a square.
    """
    low = elements[elements[:, 2] == 0]
    at = _element_nodes(low)
    numbers, places = number[at], bricks.nodes[at][..., :2]
    inner = 0.5 * GAUSS * np.array([(a, b) for a in (-1, 1) for b in (-1, 1)])
    quarters = [(a, b) for a in (0, 1) for b in (0, 1)]
    points = np.concatenate([inner + (np.array(quarter) - 0.5) for quarter in quarters])
    value, slope = shape_functions(np.column_stack([points, np.full(len(points), -1.0)]))
    drawn = np.einsum("eni,pnj->epij", places, slope[:, :, :2])
    pressed = [bricks.pressed[2 * low[:, 0] + a, 2 * low[:, 1] + b] for a, b in quarters]
    area = 0.25 * np.abs(np.linalg.det(drawn)) * np.repeat(np.stack(pressed, axis=1), 4, axis=1)
    x, y = np.einsum("pn,eni->iep", value, places)
    unknowns = np.repeat(3 * numbers[:, None, :] + 2, len(points), axis=1)
    kept = (unknowns >= 2) & (value != 0.0)
    rows = np.broadcast_to(np.arange(area.size).reshape(area.shape)[:, :, None], kept.shape)
    values = np.broadcast_to(value, kept.shape)
    shape = area.size, 3 * (int(number.max()) + 1)
    rise = sp.csr_matrix((values[kept], (rows[kept], unknowns[kept])), shape)
    return rise, area.ravel(), x.ravel(), y.ravel()
