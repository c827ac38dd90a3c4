"""Right-preconditioned GMRES that keeps the preconditioned vectors."""

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
    norm = float(np.linalg.norm(right))
    if norm == 0.0:
        return np.zeros_like(right), 0, 0.0
    basis = np.empty((most + 1, right.size))
    images = np.empty((most, right.size))
    basis[0] = right / norm
    hessenberg = np.zeros((most + 1, most))
    rotations = np.zeros((most, 2))
    target = np.zeros(most + 1)
    target[0] = norm
    count = 0
    for j in range(most):
        images[j] = precondition(basis[j])
        vector = operator(images[j])
        for _ in range(2):  # once more than Gram-Schmidt needs on paper, for orthogonality
            part = basis[: j + 1] @ vector
            vector -= part @ basis[: j + 1]
            hessenberg[: j + 1, j] += part
        length = float(np.linalg.norm(vector))
        for i in range(j):
            c, s = rotations[i]
            upper, lower = hessenberg[i, j], hessenberg[i + 1, j]
            hessenberg[i, j] = c * upper + s * lower
            hessenberg[i + 1, j] = -s * upper + c * lower
        radius = float(np.hypot(hessenberg[j, j], length))
        if radius == 0.0 or not np.isfinite(radius):
            break
        c, s = hessenberg[j, j] / radius, length / radius
        rotations[j] = c, s
        hessenberg[j, j] = radius
        target[j + 1] = -s * target[j]
        target[j] = c * target[j]
        count = j + 1
        if abs(target[count]) <= tolerance * norm or length <= 1e-14 * radius:
            break
        basis[count] = vector / length
    if count == 0:
        return np.full_like(right, np.nan), 0, float("nan")
    weights = np.linalg.solve(np.triu(hessenberg[:count, :count]), target[:count])
    return weights @ images[:count], count, abs(float(target[count])) / norm
