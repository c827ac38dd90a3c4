"""Bodies of a triangle soup: triangles that share corners, directly or through others."""

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array
from underfoot.core.compiled import njit

from .mesh_edges import hash_key, soup_keys

MOST_FACES = 2_000_000
"""Bodies of a larger mesh are not looked for: scans are one surface."""


def components(triangles: NDArray[np.float32]) -> tuple[NDArray[np.int32], int]:
    """Return the number of the body of each triangle and how many there are.

    Corners are the same when their coordinates are.
    """
    bits = (triangles + np.float32(0.0)).view(np.uint32)  # a negative zero has other bits
    roots = _roots(bits.reshape(-1, 3))
    _, numbers = np.unique(roots, return_inverse=True)
    return np.asarray(numbers, dtype=np.int32).ravel(), int(numbers.max(initial=-1)) + 1


def closed_bodies(triangles: NDArray[np.float32]) -> NDArray[np.int32]:
    """Return the number of the body of each triangle; closed bodies that touch are told apart.

    Triangles of one body share edges that no third one has. Where all edges of such a piece have as
    many faces of it in one direction as in the other, it is a body whatever corners and edges
    others share with it; the rest are the bodies of ``components``.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    count = triangles.shape[0]
    bits = (triangles + np.float32(0.0)).view(np.uint32)
    keys, _, _, _ = soup_keys(triangles, bits)
    used = np.flatnonzero(keys)
    order = used[np.argsort(keys[used] >> np.uint64(1), kind="stable")]
    key, face = keys[order] >> np.uint64(1), order // 3
    begins = np.append(True, key[1:] != key[:-1])
    edge = np.cumsum(begins) - 1
    first = np.flatnonzero(begins)[np.bincount(edge) == 2]
    joined = coo_matrix(
        (np.ones(first.size, bool), (face[first], face[first + 1])), shape=(count, count)
    )
    number, piece = connected_components(joined, directed=False)
    own, numbered = np.unique(edge * np.int64(number) + piece[face], return_inverse=True)
    forward = np.where(keys[order] & np.uint64(1), 1.0, -1.0)
    uneven = own[np.bincount(numbered, forward) != 0] % number
    open_pieces = np.zeros(number, bool)
    open_pieces[uneven] = True
    rest = open_pieces[piece]
    body = piece.astype(np.int32)
    body[rest] = number + components(triangles[rest])[0]
    return body


@njit(cache=True)
def _roots(corners: NDArray[np.uint32]) -> NDArray[np.int32]:
    """Return, per triangle, the corner that stands for its body: a forest over hashed corners."""
    count = corners.shape[0]
    size = 1
    while size < 2 * count:
        size *= 2
    table = np.full(size, -1, dtype=np.int32)
    parent = np.empty(count, dtype=np.int32)
    for n in range(count):
        key = np.uint64(corners[n, 0]) | (np.uint64(corners[n, 1]) << np.uint64(32))
        key = hash_key(key + np.uint64(0x9E3779B97F4A7C15))
        key = hash_key(key ^ (np.uint64(corners[n, 2]) + np.uint64(0x632BE59BD9B4E019)))
        place = np.int64(key & np.uint64(size - 1))
        while True:
            k = table[place]
            if k < 0:
                table[place] = n
                parent[n] = n
                break
            if (
                corners[k, 0] == corners[n, 0]
                and corners[k, 1] == corners[n, 1]
                and corners[k, 2] == corners[n, 2]
            ):
                parent[n] = k
                break
            place = (place + 1) & (size - 1)
    for n in range(0, count, 3):
        for k in range(1, 3):
            a, b = _root(parent, n), _root(parent, n + k)
            if a < b:
                parent[b] = a
            elif b < a:
                parent[a] = b
    roots = np.empty(count // 3, dtype=np.int32)
    for n in range(count // 3):
        roots[n] = _root(parent, 3 * n)
    return roots


@njit(cache=True, inline="always")
def _root(parent: NDArray[np.int32], n: int) -> int:
    while parent[n] != n:
        parent[n] = parent[parent[n]]
        n = parent[n]
    return n


@njit(cache=True)
def extents_of_bodies(
    triangles: NDArray[np.float32], body: NDArray[np.int32], axes: Array, count: int
) -> tuple[Array, Array, Array]:
    """Return least and greatest coordinates (count, 3) along the rows of ``axes``, and areas.

    Of bodies without triangles the extents are infinite, least above greatest.
    """
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    area = np.zeros(count)
    u, v = np.empty(3), np.empty(3)
    for n in range(triangles.shape[0]):
        own = body[n]
        for k in range(3):
            x, y, z = triangles[n, k, 0], triangles[n, k, 1], triangles[n, k, 2]
            for m in range(3):
                along = axes[m, 0] * x + axes[m, 1] * y + axes[m, 2] * z
                low[own, m] = min(low[own, m], along)
                high[own, m] = max(high[own, m], along)
        for m in range(3):
            u[m] = np.float64(triangles[n, 1, m]) - triangles[n, 0, m]
            v[m] = np.float64(triangles[n, 2, m]) - triangles[n, 0, m]
        area[own] += 0.5 * np.sqrt(
            (u[1] * v[2] - u[2] * v[1]) ** 2
            + (u[2] * v[0] - u[0] * v[2]) ** 2
            + (u[0] * v[1] - u[1] * v[0]) ** 2
        )
    return low, high, area
