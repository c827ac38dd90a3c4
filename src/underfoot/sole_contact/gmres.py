"""Right-preconditioned GMRES that keeps the preconditioned vectors."""

import math
from collections.abc import Callable

import numpy as np

from underfoot.core.arrays import Array


def krylov_solution(
    operator: Callable[[Array], Array],
    precondition: Callable[[Array], Array],
    right: Array,
    *,
    tolerance: float,
    most: int = 60,
) -> tuple[Array, int, float]:
    """Return the solution of ``operator(x) = right``, the iterations and the relative residual.

    GMRES of Saad and Schultz (1986) preconditioned from the right, without restart; the
    preconditioned basis is stored, so the solution needs no further preconditioner call.
    """
    norm = math.sqrt(right @ right)
    if norm == 0.0:
        return np.zeros_like(right), 0, 0.0
    basis = np.empty((most + 1, right.size))
    images = np.empty((most, right.size))
    basis[0] = right / norm
    columns: list[list[float]] = []  # of the triangle that rotations make of the Hessenberg matrix
    rotations: list[tuple[float, float]] = []
    target = [norm]
    for j in range(most):
        images[j] = precondition(basis[j])
        vector = operator(images[j])
        known = basis[: j + 1]
        part = known @ vector
        vector -= part @ known
        again = known @ vector  # once more than on paper, for orthogonality
        vector -= again @ known
        column = (part + again).tolist()
        length = math.sqrt(vector @ vector)
        for i, (c, s) in enumerate(rotations):
            upper, lower = column[i], column[i + 1]
            column[i], column[i + 1] = c * upper + s * lower, c * lower - s * upper
        radius = math.hypot(column[j], length)
        if radius == 0.0 or not math.isfinite(radius):
            break
        c, s = column[j] / radius, length / radius
        column[j] = radius
        columns.append(column)
        rotations.append((c, s))
        target[j:] = c * target[j], -s * target[j]
        if abs(target[-1]) <= tolerance * norm or length <= 1e-14 * radius:
            break
        np.divide(vector, length, out=basis[j + 1])
    count = len(columns)
    if count == 0:
        return np.full_like(right, np.nan), 0, math.nan
    weights = np.array(target[:count])
    for j in range(count - 1, -1, -1):
        weights[j] /= columns[j][j]
        weights[:j] -= weights[j] * np.array(columns[j][:j])
    return weights @ images[:count], count, abs(target[count]) / norm
