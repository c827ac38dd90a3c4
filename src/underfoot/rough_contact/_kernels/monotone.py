"""Shape-preserving cubic interpolation on sorted nodes (PCHIP) in one and two dimensions.

Fritsch and Butland (1984) SIAM J. Sci. Stat. Comput. 5:300.
"""

import numpy as np

from underfoot.core.arrays import Array


def pchip_slopes(x: Array, y: Array) -> Array:
    """Return node slopes along axis 0 of ``y`` (n >= 2 nodes) that keep monotone data monotone."""
    from scipy.interpolate import PchipInterpolator

    with np.errstate(over="ignore"):
        # the first slope of a cell is kept as it is; evaluated at the end, a slope of 0 would round
        forward, mirrored = PchipInterpolator(x, y), PchipInterpolator(-x[::-1], y[::-1])
    return np.concatenate([forward.c[2], -mirrored.c[2][:1]])


def interpolated_grid(
    x: Array, y: Array, values: Array, at_x: Array, at_y: Array
) -> tuple[Array, Array]:
    """Return value and x-derivative of the tensor cubic through ``values`` (x.size, y.size).

    Monotone along both axes where the nodes are; a single column is taken as constant. Places
    beyond the nodes count as the outermost node.
    """
    from scipy.interpolate import CubicHermiteSpline, NdPPoly, PchipInterpolator

    if y.size == 1:
        y, values = np.array([y[0], y[0] + 1.0]), np.repeat(values, 2, axis=1)
    ends = [PchipInterpolator(y, part, axis=1).c for part in (values, pchip_slopes(x, values))]
    cubic = NdPPoly(CubicHermiteSpline(x, *ends, axis=2).c.transpose(0, 2, 1, 3), (x, y))
    at = np.clip(at_x, x[0], x[-1]), np.clip(at_y, y[0], y[-1])
    return cubic(at), cubic(at, nu=(1, 0))
