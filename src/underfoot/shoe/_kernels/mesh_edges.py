"""Edges and faces of a triangle soup as keys that can be sorted: who shares what."""

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array
from underfoot.core.compiled import njit

Keys = NDArray[np.uint64]
Triangles = NDArray[np.float32]


@njit(cache=True, inline="always")
def hash_key(key: np.uint64) -> np.uint64:
    """Return a hash of a key."""
    key ^= key >> np.uint64(30)
    key *= np.uint64(0xBF58476D1CE4E5B9)
    key ^= key >> np.uint64(27)
    key *= np.uint64(0x94D049BB133111EB)
    key ^= key >> np.uint64(31)
    return key


@njit(cache=True, error_model="numpy")
def soup_keys(
    triangles: Triangles, bits: NDArray[np.uint32]
) -> tuple[Keys, Keys, NDArray[np.int64], float]:
    """Return edge keys (3 n,), face keys (n,), counts and the signed volume of a soup.

    A corner is known by the bits of its coordinates. The lowest bit of an edge key tells its
    direction, the rest is a hash of both corners in order; a face key is the same for any order of
    its corners. Faces without area or with corners that are not finite get key 0, no edge keys
    (all zero), and are counted in ``counts`` (degenerate, not finite).
    """
    count = triangles.shape[0]
    edges = np.zeros(3 * count, dtype=np.uint64)
    faces = np.zeros(count, dtype=np.uint64)
    counts = np.zeros(2, dtype=np.int64)
    corner = np.empty(3, dtype=np.uint64)
    volume = 0.0
    bx, by, bz = triangles[0, 0, 0], triangles[0, 0, 1], triangles[0, 0, 2]
    one = np.uint64(1)
    for n in range(count):
        ax, ay, az = triangles[n, 0, 0] - bx, triangles[n, 0, 1] - by, triangles[n, 0, 2] - bz
        ux = np.float64(triangles[n, 1, 0]) - triangles[n, 0, 0]
        uy = np.float64(triangles[n, 1, 1]) - triangles[n, 0, 1]
        uz = np.float64(triangles[n, 1, 2]) - triangles[n, 0, 2]
        vx = np.float64(triangles[n, 2, 0]) - triangles[n, 0, 0]
        vy = np.float64(triangles[n, 2, 1]) - triangles[n, 0, 1]
        vz = np.float64(triangles[n, 2, 2]) - triangles[n, 0, 2]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        size = nx * nx + ny * ny + nz * nz
        if not np.isfinite(size):
            counts[1] += 1
            continue
        longest = max(ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz)
        if size <= 1e-14 * longest * longest:
            counts[0] += 1
            continue
        volume += (ax * nx + ay * ny + az * nz) / 6.0
        for k in range(3):
            # + 0.0 turns a negative zero, which has other bits, into zero
            key = np.uint64(bits[n, k, 0]) | (np.uint64(bits[n, k, 1]) << np.uint64(32))
            key = hash_key(key + np.uint64(0x9E3779B97F4A7C15))
            corner[k] = hash_key(key ^ (np.uint64(bits[n, k, 2]) + np.uint64(0x632BE59BD9B4E019)))
        faces[n] = hash_key(corner[0] + corner[1] + corner[2]) | one
        for k in range(3):
            a, b = corner[k], corner[(k + 1) % 3]
            low, high = (a, b) if a < b else (b, a)
            key = hash_key(low + hash_key(high))
            edges[3 * n + k] = (key & ~one) | (one if a < b else np.uint64(0))
    return edges, faces, counts, volume


@njit(cache=True)
def shared_edges(edges: Keys) -> tuple[int, int, int, int]:
    """Return how many edges of sorted keys have one face, more than two, or two turned alike.

    More than two, as many in one direction as in the other, are bodies that touch or copies: they
    are counted last, apart.
    """
    open_edges, crowded, turned, touching = 0, 0, 0, 0
    one = np.uint64(1)
    n = 0
    while n < edges.size and edges[n] == 0:
        n += 1
    while n < edges.size:
        key = edges[n] >> one
        total, forward = 0, 0
        while n < edges.size and (edges[n] >> one) == key:
            total += 1
            forward += int(edges[n] & one)
            n += 1
        if total == 1:
            open_edges += 1
        elif total > 2 and 2 * forward == total:
            touching += 1
        elif total > 2:
            crowded += 1
        elif forward != 1:
            turned += 1
    return open_edges, crowded, turned, touching


@njit(cache=True, error_model="numpy")
def overlap_lines(
    triangles: Triangles,
    body: NDArray[np.int32],
    axes: Array,
    first: tuple[float, float],
    pitch: float,
    shape: tuple[int, int],
    near: float,
) -> tuple[int, int, int, int, int]:
    """Return on how many straight lines a body overlaps itself, and on how many faces lie double.

    Then on how many a first face is missing, how many lines end within the body, and how many meet
    the mesh at all. Lines along the third axis, ``pitch`` apart. Along a line through a sound body
    the surfaces are met in turn from outside and from inside; two from outside in a row, farther
    apart than ``near``, mean that the surface crosses itself. Two faces turned opposite ways that
    lie nearer, with nothing else beside them, are faces that lie double. Where a line ends within
    the body and meets its first face from the other side than most lines that don't, the face that
    it should have met is missing.

    Parameters:
        body: (n,) number of the body of each triangle; all alike: bodies that overlap count too.
        near: In the unit of the axes.
    """
    lines = shape[0] * shape[1]
    counts = np.zeros(lines + 1, dtype=np.int64)
    height = np.empty(0)
    side = np.empty(0, dtype=np.int8)
    owner = np.empty(0, dtype=np.int32)
    order = np.empty(0, dtype=np.int64)
    u, v, w = np.empty(3), np.empty(3), np.empty(3)
    for turn in range(2):
        for n in range(triangles.shape[0]):
            for k in range(3):
                x, y, z = triangles[n, k, 0], triangles[n, k, 1], triangles[n, k, 2]
                u[k] = (axes[0, 0] * x + axes[0, 1] * y + axes[0, 2] * z - first[0]) / pitch
                v[k] = (axes[1, 0] * x + axes[1, 1] * y + axes[1, 2] * z - first[1]) / pitch
                w[k] = axes[2, 0] * x + axes[2, 1] * y + axes[2, 2] * z
            twice = (u[1] - u[0]) * (v[2] - v[0]) - (u[2] - u[0]) * (v[1] - v[0])
            if not abs(twice) > 1e-18:
                continue
            i_end = min(int(np.floor(max(u[0], u[1], u[2]))), shape[0] - 1)
            j_begin = max(int(np.ceil(min(v[0], v[1], v[2]))), 0)
            j_end = min(int(np.floor(max(v[0], v[1], v[2]))), shape[1] - 1)
            for i in range(max(int(np.ceil(min(u[0], u[1], u[2]))), 0), i_end + 1):
                for j in range(j_begin, j_end + 1):
                    a = ((u[1] - i) * (v[2] - j) - (u[2] - i) * (v[1] - j)) / twice
                    b = ((u[2] - i) * (v[0] - j) - (u[0] - i) * (v[2] - j)) / twice
                    if a < 0 or b < 0 or a + b > 1:
                        continue
                    line = i * shape[1] + j
                    if turn == 0:
                        counts[line + 1] += 1
                    else:
                        height[order[line]] = a * w[0] + b * w[1] + (1 - a - b) * w[2]
                        side[order[line]] = 1 if twice > 0 else -1
                        owner[order[line]] = body[n]
                        order[line] += 1
        if turn == 0:
            counts = np.cumsum(counts)
            height = np.empty(counts[-1])
            side = np.empty(counts[-1], dtype=np.int8)
            owner = np.empty(counts[-1], dtype=np.int32)
            order = counts[:-1].copy()
    crossed, doubled, odd, met, down = 0, 0, 0, 0, 0
    firsts, flaps = np.zeros(3, dtype=np.int64), np.zeros(3, dtype=np.int64)
    for line in range(lines):
        begin, end = counts[line], counts[line + 1]
        if begin == end:
            continue
        met += 1
        ranks = begin + np.argsort(height[begin:end])
        overlaps, double, flap, whole = False, False, False, True
        within = 0
        even = (end - begin) % 2 == 0
        lone = 0  # side of the first face that no other cancels
        k = 0
        while k < end - begin and lone == 0:
            lone = side[ranks[k]]
            if k + 1 < end - begin and height[ranks[k + 1]] - height[ranks[k]] <= near:
                lone += side[ranks[k + 1]]
                k += 1
            k += 1
        lone = min(max(lone, -1), 1)
        if even:
            down -= side[ranks[0]]
        else:
            odd += 1
            firsts[lone + 1] += 1
        for k in range(end - begin):
            here = ranks[k]
            within += side[here]
            own, last = 0, -1
            for m in range(k + 1):
                if owner[ranks[m]] == owner[here]:
                    own += side[ranks[m]]
            for m in range(k + 1, end - begin):
                if owner[ranks[m]] == owner[here]:
                    last = m
                    break
            if abs(own) > 1 and last >= 0 and height[ranks[last]] - height[here] > near:
                overlaps = True
            if last < 0 and own != 0:
                whole = False
            # enters and leaves within ``near``, with free space before and behind
            opposite = k > 0 and side[here] + side[ranks[k - 1]] == 0
            if opposite and within == 0 and height[here] - height[ranks[k - 1]] <= near:
                free = k == 1 or height[ranks[k - 1]] - height[ranks[k - 2]] > near
                free = free and (k + 1 == end - begin or height[ranks[k + 1]] - height[here] > near)
                # of a line that ends within the body only what it meets first is sure
                double = double or (free and even)
                flap = flap or (free and k == 1)
        doubled += int(double)
        flaps[lone + 1] += int(flap and not even)
        # a line that ends within the body grazed an edge or a hole
        crossed += int(overlaps and whole)
    outer = -1 if down >= 0 else 1
    return crossed, doubled + flaps[1 + outer], firsts[1 - outer], odd, met
