"""Bodies of soles for tests: closed triangle meshes from height functions, in m."""

from collections.abc import Callable

import numpy as np

Heights = Callable[[np.ndarray, np.ndarray], np.ndarray]
WIDTHS = ((0, 0.03, 0.12, 0.3, 0.45, 0.7, 0.9, 0.97, 1),
          (4, 22, 34, 30, 31, 47, 36, 20, 3))  # fmt: skip
MIDDLES = ((0, 0.2, 0.45, 0.75, 1), (0, 0, -6, 0, 10))


def grooved(depth=3e-3, pitch=10e-3, width=4e-3):
    """Channels across and along, ``width`` wide, in land at z = 0."""

    def heights(x, y):
        across = np.mod(x, pitch) > pitch - width
        along = np.mod(y + (pitch - width) / 2, pitch) > pitch - width
        return depth * (across | along)

    return heights


def flat(x, y):
    return np.zeros_like(x + y)


def heel_half_width(x, length=0.06, half=0.03, radius=0.025):
    """Half the width of a heel with a rounded rear end at x = 0."""
    into = np.clip(radius - x, 0, radius)
    return half - radius + np.sqrt(radius**2 - np.minimum(into, radius - 1e-5) ** 2)


def closed_body(bottom: Heights, half, *, length, thickness=0.015, step=0.5e-3, middle=None):
    """Vertices and outward faces of a body between ``bottom`` and a plane top."""
    x = np.linspace(0, length, round(length / step) + 1)
    middles = np.zeros_like(x) if middle is None else middle(x)
    halves = half(x)
    across = np.linspace(-1, 1, 2 * round(float(halves.max()) / step) + 1)
    grid_x = np.repeat(x[:, None], across.size, axis=1)
    grid_y = middles[:, None] + halves[:, None] * across[None]
    low = np.stack([grid_x, grid_y, bottom(grid_x, grid_y)], axis=-1).reshape(-1, 3)
    high = np.stack([grid_x, grid_y, np.full_like(grid_x, thickness)], axis=-1).reshape(-1, 3)
    shape = grid_x.shape
    place = np.arange(grid_x.size).reshape(shape)
    above = grid_x.size
    a, b, c, d = place[:-1, :-1], place[1:, :-1], place[1:, 1:], place[:-1, 1:]
    faces = [_rows(a, d, c), _rows(a, c, b), _rows(a, c, d) + above, _rows(a, b, c) + above]
    rims = ((place[:, 0], 1), (place[:, -1], -1), (place[0, :], -1), (place[-1, :], 1))
    for line, turn in rims:
        p, q = line[:-1], line[1:]
        for face in (_rows(p, q, q + above), _rows(p, q + above, p + above)):
            faces.append(face[:, ::turn])
    return np.concatenate([low, high]), np.concatenate(faces)


def heel_body(bottom=None, **options):
    options = {"length": 0.06, **options}
    return closed_body(bottom or grooved(), heel_half_width, **options)


def sole_body(bottom=None, *, length=0.28, right=True, step=1e-3, toe=0.010, **options):
    """A whole sole with toe spring; right foot unless ``right`` is False."""
    tread = bottom or grooved()

    def heights(x, y):
        return tread(x, y) + toe * np.clip((x / length - 0.72) / 0.28, 0, 1) ** 2

    def half(x):
        return np.interp(x / length, WIDTHS[0], WIDTHS[1]) * 1e-3

    def middle(x):
        return np.interp(x / length, *MIDDLES) * 1e-3 * (1 if right else -1)

    return closed_body(heights, half, length=length, step=step, middle=middle, **options)


def _rows(*corners):
    return np.stack(corners, axis=-1).reshape(-1, 3)


def triangles(body, scale=1e3):
    """Triangles (n, 3, 3) float32 of a body, in mm unless told."""
    vertices, faces = body
    return np.ascontiguousarray((vertices * scale)[faces], dtype=np.float32)


def write_stl(path, corners):
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("extra", "<u2")])
    records = np.zeros(corners.shape[0], dtype=record)
    records["corners"] = corners
    with path.open("wb") as stream:
        stream.write(b"outsole".ljust(80) + np.uint32(corners.shape[0]).tobytes())
        records.tofile(stream)
    return path


def turned(corners, angles):
    """Triangles turned about x, y, z in turn (rad)."""
    from scipy.spatial.transform import Rotation

    return (corners @ Rotation.from_euler("xyz", angles).as_matrix().T).astype(np.float32)
