"""Stiffness of eight-node hexahedra with one volume strain for each (mean dilatation)."""

from __future__ import annotations

import numpy as np

CORNERS = np.array(
    [
        (-1, -1, -1),
        (1, -1, -1),
        (1, 1, -1),
        (-1, 1, -1),
        (-1, -1, 1),
        (1, -1, 1),
        (1, 1, 1),
        (-1, 1, 1),
    ],
    dtype=float,
)
"""Local coordinates of the nodes, in the order of ``nodes``."""


def stiffness_matrices(
    corners: np.ndarray, shear_modulus: float, bulk_modulus: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return stiffness (n, 24, 24) and smallest Jacobian over mean Jacobian (n,).

    K = int 2 G dev(eps) : dev(eps) dV + K V mean(div u)^2, two Gauss points a direction. The
    mean volume strain keeps nearly incompressible material from locking (Nagtegaal, Parks and
    Rice 1974). ``corners`` (n, 8, 3) in m; degrees of freedom node by node, x, y, z.
    """
    n = corners.shape[0]
    volume = np.zeros(n)
    mean = np.zeros((n, 8, 3))
    full = np.zeros((n, 8, 3, 8, 3))
    smallest = np.full(n, np.inf)
    for point in CORNERS / np.sqrt(3.0):
        gradient, jacobian = _gradient(corners, point)
        smallest = np.minimum(smallest, jacobian)
        volume += jacobian
        weighted = gradient * jacobian[:, None, None]
        mean += weighted
        outer = np.einsum("eai,ebj->eaibj", weighted, gradient, optimize=True)
        along = np.einsum("eakbk->eab", outer)
        for i in range(3):
            full[:, :, i, :, i] += shear_modulus * along
        full += shear_modulus * outer.transpose(0, 1, 4, 3, 2)
        full -= 2.0 / 3.0 * shear_modulus * outer
    with np.errstate(divide="ignore", invalid="ignore"):
        flat = mean.reshape(n, 24)
        full = full.reshape(n, 24, 24)
        full += (bulk_modulus / volume)[:, None, None] * (flat[:, :, None] * flat[:, None, :])
        return full, 8.0 * smallest / volume


def _gradient(corners: np.ndarray, point: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return dN/dX (n, 8, 3) and det dX/dxi (n,) at a local point."""
    one = 1.0 + CORNERS * point
    local = 0.125 * np.stack(
        [
            CORNERS[:, 0] * one[:, 1] * one[:, 2],
            CORNERS[:, 1] * one[:, 0] * one[:, 2],
            CORNERS[:, 2] * one[:, 0] * one[:, 1],
        ],
        axis=1,
    )
    matrix = np.einsum("ai,eaj->eij", local, corners)
    jacobian = np.linalg.det(matrix)
    safe = np.where((jacobian > 0.0)[:, None, None], matrix, np.eye(3))
    return np.einsum("eij,aj->eai", np.linalg.inv(safe), local), jacobian
