"""Heights of triangles over cells, whichever way they are turned."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from underfoot.shoe._kernels.height_buffer import extents, height_buffer

SPACING, SHAPE, FIRST = 0.5, (12, 9), (-3.0, -2.0)


@pytest.mark.parametrize("seed", range(3))
def test_turned_axes_are_turned_triangles(seed):
    random = np.random.default_rng(seed)
    triangles = random.uniform(-3.0, 3.0, (20, 3, 3)).astype(np.float32)
    turn = Rotation.random(random_state=seed).as_matrix()
    turned = (triangles.astype(float) @ turn.T).astype(np.float32)
    for one, other in zip(
        height_buffer(triangles, turn, FIRST, SPACING, SHAPE),
        height_buffer(turned, np.eye(3), FIRST, SPACING, SHAPE), strict=True,
    ):  # fmt: skip
        assert np.mean(np.isclose(one, other, atol=1e-4, equal_nan=True)) > 0.97
    low, high = extents(triangles, turn)
    assert low == pytest.approx(turned.reshape(-1, 3).min(axis=0), abs=1e-5)
    assert high == pytest.approx(turned.reshape(-1, 3).max(axis=0), abs=1e-5)


def test_two_planes_are_seen_where_they_lie_and_how_they_face():
    """z = 1 + 0.2 x - 0.1 y over x in -2 to 2 and y in -1 to 1; above it the same turned round."""

    def plane(x, y, above=0.0):
        return np.stack([x, y, 1 + above + 0.2 * x - 0.1 * y], axis=-1)

    corners = np.array([[-2.0, -1.0], [2.0, -1.0], [2.0, 1.0], [-2.0, 1.0]])
    low, top = (plane(*corners.T, above) for above in (0.0, 3.0))
    triangles = np.stack([low[[0, 2, 1]], low[[0, 3, 2]], top[[0, 1, 2]], top[[0, 2, 3]]])
    lowest, highest, facing = height_buffer(
        triangles.astype(np.float32), np.eye(3), FIRST, SPACING, SHAPE
    )
    x, y = (first + SPACING * np.arange(n) for first, n in zip(FIRST, SHAPE, strict=True))
    over = (np.abs(x)[:, None] <= 2.0) & (np.abs(y) <= 1.0)
    expected = plane(*np.meshgrid(x, y, indexing="ij"))[..., 2]
    assert np.array_equal(np.isfinite(lowest), over)
    assert lowest[over] == pytest.approx(expected[over], abs=1e-5)
    assert highest[over] == pytest.approx(expected[over] + 3, abs=1e-5)
    assert np.array_equal(facing, np.where(over, -1, 0))


def test_a_triangle_beyond_the_map_fills_it_and_no_cell_beside_it():
    """In Python, which knows the ends of an array, as compiled: z = 1 + 0.2 x - 0.1 y."""
    corners = np.array([[-99.0, -99.0], [99.0, -99.0], [0.0, 99.0]])
    heights = 1 + corners @ [0.2, -0.1]
    triangles = np.column_stack([corners, heights])[None].astype(np.float32)
    given = (triangles, np.eye(3), FIRST, SPACING, SHAPE)
    kernel = getattr(height_buffer, "py_func", height_buffer)
    for one, other in zip(kernel(*given), height_buffer(*given), strict=True):
        assert one.shape == SHAPE
        np.testing.assert_allclose(one, other)
    x, y = (first + SPACING * np.arange(n) for first, n in zip(FIRST, SHAPE, strict=True))
    expected = 1 + 0.2 * x[:, None] - 0.1 * y
    np.testing.assert_allclose(kernel(*given)[0], expected, atol=1e-5)
