"""Eight-node hexahedra: modes, mean gradients, stiffness at small and forces at finite strain."""

import numpy as np

CORNERS = np.array(
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
)
SIGNS = 2.0 * CORNERS - 1.0
"""Local coordinates of the nodes."""
MODES = np.stack([*SIGNS.T, *(SIGNS.T[[1, 0, 0]] * SIGNS.T[[2, 2, 1]]), SIGNS.prod(axis=1)])
"""Sign of each mode at each corner, (7, 8)."""


def mean_gradient(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return volumes (m,) and mean gradients by modes (m, 3, 7) of hexahedra, corners (m, 8, 3).

    2 x 2 x 2 Gauss points integrate the gradient of trilinear shape functions exactly.
    """
    volume = np.zeros(len(corners))
    total = np.zeros((len(corners), 8, 3))
    for point in SIGNS / np.sqrt(3.0):
        gradient, jacobian = _gradient(corners, point)
        volume += jacobian
        total += jacobian[:, None, None] * gradient
    return volume, np.einsum("eaj,qa->ejq", total, MODES) / (8.0 * volume[:, None, None])


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
    for point in SIGNS / np.sqrt(3.0):
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


def forces_and_tangents(
    displacement: np.ndarray,
    gradient: np.ndarray,
    hourglass: np.ndarray,
    volume: np.ndarray,
    hourglass_stiffness: np.ndarray,
    shear: float,
    bulk: float,
    limit: float = np.inf,
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return forces (m, 8, 3), tangents (m, 24, 24) and the least volume ratio.

    The element of the explicit march: W = G/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2 of F = 1 + H with
    H the mean gradient, and an energy c q^2 / 2 of each non-linear mode q. ``displacement``
    (m, 8, 3) in m, ``gradient`` (m, 8, 3) in 1/m, ``hourglass`` (m, 4, 8), ``volume`` (m,) in m^3,
    ``hourglass_stiffness`` c (m,) in N/m, moduli in Pa. Degrees of freedom node by node.
    ``limit`` (Pa) cuts the pressure in the tangent alone: far from equilibrium that of a nearly
    incompressible block is huge and would make its tangent indefinite.
    """
    one = np.eye(3)
    f = one + np.einsum("eai,eaj->eij", displacement, gradient)
    jac = np.linalg.det(f)
    inverse = np.linalg.inv(f).transpose(0, 2, 1)
    i1 = np.einsum("eij,eij->e", f, f)
    g = shear * np.cbrt(jac) ** -2.0
    volumetric = bulk * (jac - 1.0) * jac
    stress = g[:, None, None] * (f - (i1 / 3.0)[:, None, None] * inverse)
    stress += volumetric[:, None, None] * inverse
    modulus = np.einsum("e,ik,jl->eijkl", g, one, one)
    mixed = np.einsum("e,eij,ekl->eijkl", 2.0 / 3.0 * g, inverse, f)
    modulus -= mixed + mixed.transpose(0, 3, 4, 1, 2)
    pressure = np.clip(bulk * (jac - 1.0), -limit, limit)
    both = 2.0 / 9.0 * g * i1 + (bulk * jac + pressure) * jac
    modulus += np.einsum("e,eij,ekl->eijkl", both, inverse, inverse)
    modulus += np.einsum("e,eil,ekj->eijkl", g * i1 / 3.0 - pressure * jac, inverse, inverse)
    modes = np.einsum("eqa,eai->eqi", hourglass, displacement)
    forces = np.einsum("e,eij,eaj->eai", volume, stress, gradient)
    forces += np.einsum("e,eqa,eqi->eai", hourglass_stiffness, hourglass, modes)
    tangent = np.einsum(
        "e,eaj,eijkl,ebl->eaibk", volume, gradient, modulus, gradient, optimize=True
    )
    own = np.einsum("e,eqa,eqb->eab", hourglass_stiffness, hourglass, hourglass)
    for axis in range(3):
        tangent[:, :, axis, :, axis] += own
    return forces, tangent.reshape(-1, 24, 24), float(jac.min())


def _gradient(corners: np.ndarray, point: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return dN/dX (n, 8, 3) and det dX/dxi (n,) at a local point."""
    one = 1.0 + SIGNS * point
    local = 0.125 * SIGNS * one[:, [1, 0, 0]] * one[:, [2, 2, 1]]
    matrix = np.einsum("ai,eaj->eij", local, corners)
    jacobian = np.linalg.det(matrix)
    safe = np.where((jacobian != 0.0)[:, None, None], matrix, np.eye(3))
    return np.einsum("eij,aj->eai", np.linalg.inv(safe), local), jacobian
