"""A block condensed about its finite compression: small motions of a block already squeezed."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from underfoot.asperity.finite_element import MicroBlock
from underfoot.asperity.finite_element.mesh import MODES, Mesh, block_mesh
from underfoot.core import ConvergenceError, InputError, Progress, silent

from ._kernels.active_set import contact_under_load
from ._kernels.finite_strain import forces_and_tangents
from ._kernels.pardiso import symmetric_solution
from .compliance import CondensedBlock, assembled, inverse_block, merged_nodes

HOURGLASS = 2.0
"""Coefficient of the explicit elements' hourglass stiffness, in units of the shear modulus."""
LOAD_STEPS, NEWTON_STEPS, TOLERANCE = 2, 30, 1e-7
PRESSURE_LIMIT = 0.25
"""Of the tangent while Newton's method is under way, over the shear modulus."""
LARGEST_PRESSURE_RATIO = 1.0
"""Mean pressure over shear modulus; beyond it elements of rough faces turn inside out."""


class _Pressing:
    """Newton's method for a block on a smooth flat floor; all moduli over the shear modulus."""

    def __init__(self, mesh: Mesh, periodic: bool, bulk: float) -> None:
        self.mesh, self.bulk = mesh, bulk
        self.corners = mesh.elements[:, None] + mesh.offsets
        self.gradient = np.einsum("ejq,qa->eaj", mesh.gradient, MODES)
        self.hourglass = MODES[3:] / 8.0 - np.einsum(
            "eqj,eaj->eqa", mesh.hourglass_shape, self.gradient
        )
        square = 8.0 * np.sum(mesh.gradient**2, axis=(1, 2))
        self.hourglass_stiffness = HOURGLASS * mesh.volume * square
        self.same, kept = merged_nodes(mesh, periodic)
        self.plane = mesh.shape[0] * mesh.shape[1]
        self.bottom = kept[kept < self.plane]
        self.top = (mesh.shape[2] - 1) * self.plane
        self.displacement = np.zeros((mesh.nodes.shape[1], 3))
        self.force = np.zeros(self.bottom.size)

    def stiffness(self, limit: float = np.inf) -> tuple[Any, np.ndarray, np.ndarray]:
        """Return tangent, place of each degree of freedom, and internal forces by node."""
        moved = self.displacement[self.same[self.corners]]
        forces, tangents, least = forces_and_tangents(
            moved,
            self.gradient,
            self.hourglass,
            self.mesh.volume,
            self.hourglass_stiffness,
            1.0,
            self.bulk,
            limit,
        )
        if not least > 0.0:
            raise ConvergenceError(
                "an element of the pressed block turned inside out",
                where="pressed_block",
                remedy="Lower the pressure or the roughness, or refine the lower layers",
            )
        total = np.zeros_like(self.displacement)
        np.add.at(total, self.same[self.corners], forces)
        matrix, number = assembled(self.same[self.corners], tangents, self.same[: self.top])
        return matrix, number, total

    def solve(self, load: float) -> None:
        """Find the equilibrium under ``load`` (over the shear modulus) from the present state.

        Newton's method; each step is an exact contact problem of the tangent's compliance.
        """
        self.force *= load / max(float(self.force.sum()), 1e-300)
        left: list[float] = []
        while len(left) < NEWTON_STEPS:
            matrix, number, inner = self.stiffness(PRESSURE_LIMIT)
            at = number[3 * self.bottom + 2]
            free = np.flatnonzero(number >= 0)
            right = np.zeros(matrix.indptr.size - 1)
            right[number[free]] = -inner.ravel()[free]
            missing = right.copy()
            missing[at] += self.force
            left.append(float(np.abs(missing).max()) / load)
            if left[-1] <= TOLERANCE and self.force.any():
                return
            clearance = self.mesh.nodes[2, self.bottom] + self.displacement[self.bottom, 2]
            clearance = clearance + _solution(matrix, right)[at]
            compliance = inverse_block(matrix, at, silent)
            found = contact_under_load(
                0.5 * (compliance + compliance.T), clearance, load, self.force > 0.0
            )
            self.force = found.force
            right[at] += found.force
            self.displacement.ravel()[free] += _solution(matrix, right)[number[free]]
        raise ConvergenceError(
            f"the block pressed flat has a relative residual of {left[-1]:.1e} after "
            f"{NEWTON_STEPS} steps",
            where="pressed_block",
            history=left[-20:],
            remedy="Lower the pressure or the roughness",
        )


def pressed_block(
    block: MicroBlock,
    poisson_ratio: float,
    pressure_ratio: float,
    *,
    progress: Progress = silent,
) -> CondensedBlock:
    """Return the block condensed about its compression by ``pressure_ratio`` times G.

    The block is pressed on a smooth flat floor at finite strain (neo-Hookean, the elements of the
    explicit march), and its lower face's compliance is that of small motions about this state: a
    rubber block under 160 kPa with G = 0.59 MPa is stiffened and spread by its own compression,
    which a block condensed at rest does not know. All three displacements are kept.

    Parameters
    ----------
    block
        As ``condensed_block`` takes it.
    poisson_ratio
        Of small strains, 0 to below 0.5.
    pressure_ratio
        Mean pressure over the shear modulus that answers it, above 0 and at most 1.

    Errors
    ------
    InputError
        Ratios outside their range; a mesh that can't carry the roughness.
    ConvergenceError
        No equilibrium; an element turned inside out.
    """
    if not 0.0 <= poisson_ratio < 0.5:
        raise InputError(
            f"Poisson's ratio {poisson_ratio:g}", where="poisson_ratio", allowed="0 to below 0.5"
        )
    if not 0.0 < pressure_ratio <= LARGEST_PRESSURE_RATIO:
        raise InputError(
            f"a mean pressure of {pressure_ratio:g} times the shear modulus",
            where="pressure_ratio",
            allowed=f"above 0, at most {LARGEST_PRESSURE_RATIO:g}",
        )
    mesh = block_mesh(block)
    bulk = 2.0 * (1.0 + poisson_ratio) / (3.0 * (1.0 - 2.0 * poisson_ratio))
    pressing = _Pressing(mesh, block.sides == "periodic", bulk)
    for part in range(1, LOAD_STEPS + 1):
        progress("press the block flat", part / (LOAD_STEPS + 1.0), None)
        pressing.solve(pressure_ratio * block.nominal_area * part / LOAD_STEPS)
    matrix, number, _ = pressing.stiffness()
    bottom = pressing.bottom
    loaded = np.concatenate([number[3 * bottom + axis] for axis in range(3)])
    found = inverse_block(matrix, loaded, progress)
    asymmetry = float(np.abs(found - found.T).max() / np.abs(found).max())
    found = 0.5 * (found + found.T)
    count = bottom.size
    compliance = found.reshape(3, count, 3, count)
    # Where the nodes would be without the floor's push, were the compliance constant.
    rest = mesh.nodes.T[bottom] + pressing.displacement[bottom]
    rest -= np.einsum("inm,m->ni", compliance[:, :, 2, :], pressing.force)
    cut = 1 if block.sides == "periodic" else 0
    return CondensedBlock(
        block,
        float(poisson_ratio),
        rest,
        mesh.lower_area[bottom],
        (mesh.shape[0] - cut, mesh.shape[1] - cut),
        np.ascontiguousarray(compliance[2, :, 2, :]),
        asymmetry,
        compliance,
        float(pressure_ratio),
    )


def _solution(matrix: Any, right: np.ndarray) -> np.ndarray:
    upper: Any = sp.triu(matrix, format="csr")
    upper.sort_indices()
    found = symmetric_solution(upper, right[:, None])
    if found is not None and np.isfinite(found).all():
        return found[:, 0]
    from scipy.sparse.linalg import splu

    return splu(matrix.tocsc()).solve(right)
