"""Vertical compliance of a block's lower face: all other nodes eliminated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from underfoot.asperity.finite_element import MicroBlock
from underfoot.asperity.finite_element.mesh import Mesh, block_mesh
from underfoot.core import ConvergenceError, InputError, Progress, silent

from ._kernels.hexahedron import stiffness_matrices
from ._kernels.pardiso import schur_complement

BATCH = 128


@dataclass(frozen=True, slots=True, eq=False)
class CondensedBlock:
    """A block reduced to the vertical displacements of its lower face; its top is glued.

    Parameters
    ----------
    block
        Size, mesh and roughness.
    poisson_ratio
        Of the block.
    points
        m, (n, 3): the lower face's nodes at rest, z = 0 its mean plane, upwards into the rubber.
    areas
        m^2, (n,): the part of the nominal area that belongs to each of them.
    grid
        Nodes along x and y; point (i, j) has the number j * grid[0] + i.
    unit_compliance
        1/m, (n, n), symmetric: displacement (m, upwards) of each lower node for a unit force
        (N, upwards) on each, times the shear modulus (Pa). The compliance at the shear modulus G
        is ``unit_compliance`` / G.
    asymmetry
        Largest difference of the solved compliance from its transpose over its largest entry,
        before it was made symmetric: the error of the factorisation (reciprocity).
    unit_vector_compliance
        1/m, (3, n, 3, n): the same for displacement and force along x, y, z, or None.
    pressure_ratio
        Mean pressure over shear modulus that the block is linearised about (``pressed_block``);
        ``points`` are then the nodes' places without that pressure, were the compliance constant.
    """

    block: MicroBlock
    poisson_ratio: float
    points: np.ndarray
    areas: np.ndarray
    grid: tuple[int, int]
    unit_compliance: np.ndarray
    asymmetry: float
    unit_vector_compliance: np.ndarray | None = None
    pressure_ratio: float = 0.0


def condensed_block(
    block: MicroBlock, poisson_ratio: float, *, sideways: bool = False, progress: Progress = silent
) -> CondensedBlock:
    """Return the block with the vertical compliance of its lower face.

    Small strains, isotropic, eight-node hexahedra with one mean volume strain each; forces act
    on the lower nodes vertically (no friction), the sides are free or periodic. Where MKL is
    installed, PARDISO eliminates all other nodes (Schur complement) and C is its inverse; else one
    sparse factorisation (SuperLU) and one solution a lower node, some ten times slower.
    ``sideways`` keeps the lower nodes' motion along x and y too (three times the cost): sliding
    then follows where each node goes and the direction of the floor's normal there.

    Errors
    ------
    InputError
        Poisson's ratio of 0.5 (no finite bulk modulus) or outside 0 to 0.5; roughness that turns
        an element inside out.
    ConvergenceError
        A compliance that is not symmetric to 1e-6.
    """
    if not 0.0 <= poisson_ratio < 0.5:
        raise InputError(
            f"Poisson's ratio {poisson_ratio:g}",
            where="poisson_ratio",
            allowed="0 to below 0.5",
            remedy="Choose 0.499 for rubber: at 0.5 the bulk modulus is infinite",
        )
    mesh = block_mesh(block)
    bulk = 2.0 * (1.0 + poisson_ratio) / (3.0 * (1.0 - 2.0 * poisson_ratio))
    corners = mesh.elements[:, None] + mesh.offsets
    matrices, jacobian = stiffness_matrices(mesh.nodes.T[corners], 1.0, bulk)
    if not float(jacobian.min()) > 0.0:
        raise InputError(
            f"the roughness of {block.roughness.peak_to_valley:g} m turns elements inside out",
            where="MicroBlock.roughness",
            remedy="Raise roughness_layers or bottom_layer",
        )
    same, kept = merged_nodes(mesh, block.sides == "periodic")
    top = mesh.shape[2] - 1
    plane = mesh.shape[0] * mesh.shape[1]
    stiffness, number = assembled(same[corners], matrices, same[: top * plane])
    bottom = kept[kept < plane]
    axes = (0, 1, 2) if sideways else (2,)
    loaded = np.concatenate([number[3 * bottom + axis] for axis in axes])
    found = inverse_block(stiffness, loaded, progress)
    largest = float(np.abs(found).max())
    asymmetry = float(np.abs(found - found.T).max()) / largest
    if not asymmetry < 1e-6:
        raise ConvergenceError(
            f"the compliance is not symmetric ({asymmetry:.2g})",
            where="condensed_block",
            remedy="Lower Poisson's ratio (0.499) or use less graded layers",
        )
    found = 0.5 * (found + found.T)
    count = bottom.size
    cut = 1 if block.sides == "periodic" else 0
    return CondensedBlock(
        block,
        float(poisson_ratio),
        mesh.nodes.T[bottom],
        mesh.lower_area[bottom],
        (mesh.shape[0] - cut, mesh.shape[1] - cut),
        found[-count:, -count:],
        asymmetry,
        found.reshape(3, count, 3, count) if sideways else None,
    )


def merged_nodes(mesh: Mesh, periodic: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return the node that stands for each node, and the nodes that stand for themselves."""
    own = np.arange(mesh.nodes.shape[1]).reshape(mesh.shape[::-1])
    same = own.copy()
    if periodic:
        same[:, :, -1] = same[:, :, 0]
        same[:, -1, :] = same[:, 0, :]
    same = same.ravel()
    return same, np.flatnonzero(same == own.ravel())


def assembled(
    nodes: np.ndarray, matrices: np.ndarray, free: np.ndarray
) -> tuple[sp.csr_matrix, np.ndarray]:
    """Return the stiffness of the ``free`` nodes and the place of each degree of freedom."""
    free = np.unique(free)
    number = np.full(3 * (int(nodes.max()) + 1), -1)
    size = 3 * free.size
    number[(3 * free[:, None] + np.arange(3)).ravel()] = np.arange(size)
    placed = number[(3 * nodes[:, :, None] + np.arange(3)).reshape(-1, 24)]
    rows = np.repeat(placed, 24, axis=1).ravel()
    columns = np.tile(placed, (1, 24)).ravel()
    keep = (rows >= 0) & (columns >= 0)
    matrix = sp.csr_matrix((matrices.ravel()[keep], (rows[keep], columns[keep])), (size, size))
    matrix.sort_indices()
    return matrix, number


def inverse_block(matrix: sp.csr_matrix, loaded: np.ndarray, progress: Progress) -> np.ndarray:
    """Return the entries (loaded, loaded) of the inverse."""
    progress("compliance of the block", 0.0, None)
    order = np.argsort(loaded)
    upper: Any = sp.triu(matrix, format="csr")
    upper.sort_indices()
    reduced = schur_complement(upper, loaded[order])
    if reduced is not None and np.isfinite(reduced).all():
        placed = np.empty_like(order)
        placed[order] = np.arange(order.size)
        return _inverse(reduced)[np.ix_(placed, placed)]
    solve = _solver(matrix)
    count, size = loaded.size, matrix.indptr.size - 1
    found = np.empty((count, count))
    for start in range(0, count, BATCH):
        progress("compliance of the block", start / count, None)
        some = slice(start, min(start + BATCH, count))
        right = np.zeros((size, some.stop - some.start), order="F")
        right[loaded[some], np.arange(some.stop - some.start)] = 1.0
        found[:, some] = solve(right)[loaded]
    if not np.isfinite(found).all():
        raise ConvergenceError("the stiffness of the block is singular", where="condensed_block")
    return found


def _inverse(matrix: np.ndarray) -> np.ndarray:
    """Return the inverse of a symmetric positive definite matrix."""
    from scipy.linalg import LinAlgError, cho_factor, cho_solve

    try:
        factor = cho_factor(0.5 * (matrix + matrix.T), check_finite=False)
    except LinAlgError as problem:
        raise ConvergenceError(
            "the stiffness of the block is not positive definite", where="condensed_block"
        ) from problem
    return cho_solve(factor, np.eye(len(matrix)), check_finite=False)


def _solver(matrix: sp.csr_matrix):
    """Return the function that solves for several right-hand sides."""
    from scipy.sparse.linalg import splu

    return splu(
        matrix.tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.01,
        options={"SymmetricMode": True},
    ).solve
