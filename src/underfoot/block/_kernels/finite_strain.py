"""Nodal forces and tangent stiffness of hexahedra at finite strain, one mean gradient each."""

from __future__ import annotations

import numpy as np


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
