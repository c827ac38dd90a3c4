"""Compliance of a block's lower face, all other nodes eliminated; at rest or pressed flat."""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from underfoot.core import ConvergenceError, InputError, Progress, silent
from underfoot.core.remark import Message
from underfoot.core.sparse import factorization, schur_complement, upper_triangle

from ._kernels.active_set import contact_under_load
from ._kernels.hexahedron import MODES, forces_and_tangents, stiffness_matrices
from .inputs import MicroBlock
from .mesh import BlockMesh, block_mesh

HOURGLASS = 2.0
"""Coefficient of the explicit elements' hourglass stiffness, in units of the shear modulus."""
LOAD_STEPS, NEWTON_STEPS, TOLERANCE = 2, 30, 1e-7
PRESSURE_LIMIT = 0.25
"""Of the tangent while Newton's method is under way, over the shear modulus."""
LARGEST_PRESSURE_RATIO = 1.0
"""Mean pressure over shear modulus; beyond it elements of rough faces turn inside out."""


@dataclass(frozen=True, slots=True, eq=False)
class CondensedBlock:
    """A block reduced to the vertical displacements of its lower face; its top is glued.

    Parameters:
        block: Size, mesh and roughness.
        poisson_ratio: Of the block.
        points: m, (n, 3): the lower face's nodes at rest, z = 0 its mean plane, upwards into the
            rubber.
        areas: m^2, (n,): the part of the nominal area that belongs to each of them.
        grid: Nodes along x and y; point (i, j) has the number j * grid[0] + i.
        unit_compliance: 1/m, (n, n), symmetric: displacement (m, upwards) of each lower node for a
            unit force (N, upwards) on each, times the shear modulus (Pa). The compliance at the
            shear modulus G is ``unit_compliance`` / G.
        asymmetry: Largest difference of the solved compliance from its transpose over its largest
            entry, before it was made symmetric: the error of the factorisation (reciprocity).
        unit_vector_compliance: 1/m, (3, n, 3, n): the same for displacement and force along x, y,
            z, or None.
        pressure_ratio: Mean pressure over shear modulus that the block is linearised about
            (``pressed_block``); ``points`` are then the nodes' places without that pressure, were
            the compliance constant.
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


def bulk_ratio(poisson_ratio: float) -> float:
    """Return the bulk over the shear modulus, 2 (1 + nu) / (3 (1 - 2 nu))."""
    if not 0.0 <= poisson_ratio < 0.5:
        raise InputError(
            Message("Poisson's ratio {poisson_ratio:g}", poisson_ratio=poisson_ratio),
            where="poisson_ratio",
            allowed="0 to below 0.5",
            remedy="Choose 0.499 for rubber: at 0.5 the bulk modulus is infinite",
        )
    return 2.0 * (1.0 + poisson_ratio) / (3.0 * (1.0 - 2.0 * poisson_ratio))


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

    Parameters:
        block: Mesh and material.
        poisson_ratio: Poisson's ratio, below 0.5.
        sideways: Keep the lower nodes' motion along x and y too.
        progress: Called with stage, fraction and residual; an exception it raises stops the work.

    Raises:
        InputError: Poisson's ratio of 0.5 (no finite bulk modulus) or outside 0 to 0.5; roughness
            that turns an element inside out.
        ConvergenceError: A compliance that is not symmetric to 1e-6.
    """
    bulk = bulk_ratio(poisson_ratio)
    mesh = block_mesh(block)
    corners = mesh.elements[:, None] + mesh.offsets
    matrices, jacobian = stiffness_matrices(mesh.nodes.T[corners], 1.0, bulk)
    if not float(jacobian.min()) > 0.0:
        raise InputError(
            f"the roughness of {block.roughness.peak_to_valley:g} m turns elements inside out",
            where="MicroBlock.roughness",
            remedy="Raise roughness_layers or bottom_layer",
        )
    same, own = merged_nodes(mesh, block.sides == "periodic")
    top = mesh.shape[2] - 1
    plane = mesh.shape[0] * mesh.shape[1]
    stiffness, number = assemble_stiffness(same[corners], matrices, same[: top * plane])
    bottom = own[own < plane]
    return _condense_block(
        block,
        poisson_ratio,
        mesh,
        stiffness,
        number,
        bottom,
        (0, 1, 2) if sideways else (2,),
        progress,
    )


def _condense_block(
    block: MicroBlock,
    poisson_ratio: float,
    mesh: BlockMesh,
    stiffness: sp.csr_matrix,
    number: np.ndarray,
    bottom: np.ndarray,
    axes: tuple[int, ...],
    progress: Progress,
) -> CondensedBlock:
    """Return the block whose compliance at the nodes ``bottom`` follows from its stiffness."""
    loaded = np.concatenate([number[3 * bottom + axis] for axis in axes])
    compliance = inverse_block(stiffness, loaded, progress)
    asymmetry = float(np.abs(compliance - compliance.T).max() / np.abs(compliance).max())
    if not asymmetry < 1e-6:
        raise ConvergenceError(
            f"the compliance is not symmetric ({asymmetry:.2g})",
            where="condensed_block",
            remedy="Lower Poisson's ratio (0.499) or use less graded layers",
        )
    compliance = 0.5 * (compliance + compliance.T)
    count = bottom.size
    cut = 1 if block.sides == "periodic" else 0
    return CondensedBlock(
        block,
        float(poisson_ratio),
        mesh.nodes.T[bottom],
        mesh.lower_area[bottom],
        (mesh.shape[0] - cut, mesh.shape[1] - cut),
        np.ascontiguousarray(compliance[-count:, -count:]),
        asymmetry,
        compliance.reshape(3, count, 3, count) if len(axes) == 3 else None,
    )


def merged_nodes(mesh: BlockMesh, periodic: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return the node that stands for each node, and the nodes that stand for themselves."""
    own = np.arange(mesh.nodes.shape[1]).reshape(mesh.shape[::-1])
    same = own.copy()
    if periodic:
        same[:, :, -1] = same[:, :, 0]
        same[:, -1, :] = same[:, 0, :]
    same = same.ravel()
    return same, np.flatnonzero(same == own.ravel())


def assemble_stiffness(
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
    reduced = schur_complement(upper_triangle(matrix), loaded[order], where="condensed_block")
    placed = np.empty_like(order)
    placed[order] = np.arange(order.size)
    try:
        factor = cho_factor(0.5 * (reduced + reduced.T), check_finite=False)
    except LinAlgError as problem:
        raise ConvergenceError(
            "the stiffness of the block is not positive definite", where="condensed_block"
        ) from problem
    inverse = cho_solve(factor, np.eye(len(reduced)), check_finite=False)
    return inverse[np.ix_(placed, placed)]


class _Pressing:
    """Newton's method for a block on a smooth flat floor; all moduli over the shear modulus."""

    def __init__(self, mesh: BlockMesh, periodic: bool, bulk: float) -> None:
        self.mesh, self.bulk = mesh, bulk
        self.corners = mesh.elements[:, None] + mesh.offsets
        self.gradient = np.einsum("ejq,qa->eaj", mesh.gradient, MODES)
        self.hourglass = MODES[3:] / 8.0 - np.einsum(
            "eqj,eaj->eqa", mesh.hourglass_shape, self.gradient
        )
        square = 8.0 * np.sum(mesh.gradient**2, axis=(1, 2))
        self.hourglass_stiffness = HOURGLASS * mesh.volume * square
        self.same, own = merged_nodes(mesh, periodic)
        self.plane = mesh.shape[0] * mesh.shape[1]
        self.bottom = own[own < self.plane]
        self.top = (mesh.shape[2] - 1) * self.plane
        self.displacement = np.zeros((mesh.nodes.shape[1], 3))
        self.force = np.zeros(self.bottom.size)

    def stiffness(self, limit: float = np.inf) -> tuple[sp.csr_matrix, np.ndarray, np.ndarray]:
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
        matrix, number = assemble_stiffness(
            self.same[self.corners], tangents, self.same[: self.top]
        )
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
            compliance = 0.5 * (compliance + compliance.T)
            self.force = contact_under_load(compliance, clearance, load, self.force > 0.0).force
            right[at] += self.force
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

    Parameters:
        block: As ``condensed_block`` takes it.
        poisson_ratio: Of small strains, 0 to below 0.5.
        pressure_ratio: Mean pressure over the shear modulus that answers it, above 0 and at most 1.

    Raises:
        InputError: Ratios outside their range; a mesh that can't carry the roughness.
        ConvergenceError: No equilibrium; an element turned inside out.
    """
    if not 0.0 < pressure_ratio <= LARGEST_PRESSURE_RATIO:
        raise InputError(
            f"a mean pressure of {pressure_ratio:g} times the shear modulus",
            where="pressure_ratio",
            allowed=f"above 0, at most {LARGEST_PRESSURE_RATIO:g}",
        )
    bulk = bulk_ratio(poisson_ratio)
    mesh = block_mesh(block)
    pressing = _Pressing(mesh, block.sides == "periodic", bulk)
    for part in range(1, LOAD_STEPS + 1):
        progress("press the block flat", part / (LOAD_STEPS + 1.0), None)
        pressing.solve(pressure_ratio * block.nominal_area * part / LOAD_STEPS)
    matrix, number, _ = pressing.stiffness()
    bottom = pressing.bottom
    free = _condense_block(block, poisson_ratio, mesh, matrix, number, bottom, (0, 1, 2), progress)
    # Where the nodes would be without the floor's push, were the compliance constant.
    rest = free.points + pressing.displacement[bottom]
    assert free.unit_vector_compliance is not None
    rest -= np.einsum("inm,m->ni", free.unit_vector_compliance[:, :, 2, :], pressing.force)
    return replace(free, points=rest, pressure_ratio=float(pressure_ratio))


def _solution(matrix: sp.csr_matrix, right: np.ndarray) -> np.ndarray:
    return factorization(matrix, kind="symmetric", where="pressed_block").solve(right)
