"""Pressure flow factors: the thin-film flow through a contact's own gap."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import ConvergenceError, InputError
from underfoot.core.checks import host_array

_SEALED = 1e-12
"""Factors below this are rounding of a cell that does not percolate."""
_NEGLIGIBLE = 1e-15
"""Faces that conduct less than this share of the mean are closed: they only spoil the solve."""


@dataclass(frozen=True, slots=True)
class FlowFactors:
    """Flow through one periodic cell, divided by that of a smooth gap of the same mean.

    ``along`` is the factor for a pressure gradient along axis 0 (sliding), ``across`` along
    axis 1 and ``coupling`` the sideways flow (0 for isotropic roughness). The mean flow is
    q_i = -phi_ij mean_gap^3 / (12 eta) dp/dx_j. ``mean_gap`` (m) counts contact as zero gap.
    ``residual`` is the largest flow imbalance of a cell over the mean flow of a face under the
    mean gradient alone.
    """

    along: float
    across: float
    coupling: float
    mean_gap: float
    residual: float

    @property
    def mean(self) -> float:
        """Return the mean of both directions, the factor of an isotropic film equation."""
        return 0.5 * (self.along + self.across)


def flow_factors(
    gap: ArrayLike, spacing: float | tuple[float, float] = 1.0, *, closed: float = 0.0
) -> FlowFactors:
    """Return the pressure flow factors of a periodic gap map, both directions from one solve.

    div(g^3 grad p) = 0 with a unit mean gradient and periodic pressure fluctuation, by finite
    volumes on the grid of ``gap``; phi_ij = <g^3 dp/dx_i>_j / <g>^3. Between two cells a and b
    the gap is taken as linear, for which the flow is exact: 2 a^2 b^2 / (a + b). Contact (gap <=
    ``closed``) is impermeable; what does not percolate gives exactly 0. Second order in the cell
    size for smooth gaps. The factor refers to the MEAN gap, contact included; Patir and Cheng
    refer to the distance of the undeformed mean planes, which is the same where nothing touches.

    Parameters:
        gap: (nx, ny) gap, m, >= 0; small negative values (rounding) count as contact.
        spacing: Cell size, m, or (along axis 0, along axis 1); only their ratio matters.
        closed: Gap at and below which a cell is closed, m.

    Raises:
        InputError: Not a 2-D map, not finite, or negative beyond rounding.
        ConvergenceError: The flow balance was not met (badly scaled gaps).

    Source: Reynolds equation without cavitation or shear flow; the average-flow idea is that of
    Patir and Cheng (1978) J. Lubr. Technol. 100:12-17, here on the deformed gap itself.
    """
    g = _check_gap(gap)
    g = np.where(g > closed, g, 0.0)
    mean = float(g.mean())
    if mean == 0.0:
        return FlowFactors(0.0, 0.0, 0.0, 0.0, 0.0)
    dx, dy = (spacing, spacing) if isinstance(spacing, int | float) else spacing
    scaled = g / mean
    faces = [_linear_gap_face(scaled, axis) for axis in (0, 1)]
    least = _NEGLIGIBLE * 0.5 * float(faces[0].mean() + faces[1].mean())
    faces = [np.where(face > least, face, 0.0) for face in faces]
    if not any(face.any() for face in faces):
        return FlowFactors(0.0, 0.0, 0.0, mean, 0.0)
    shape, ratio = g.shape, dy / dx
    weights = (faces[0] * ratio, faces[1] / ratio)  # face area over distance
    weights, pressures = _fluctuations(weights, shape, (dx, dy))
    residual = 0.0
    drops: list[list[np.ndarray]] = []
    for j in (0, 1):
        drop = [np.roll(pressures[j], -1, axis) - pressures[j] for axis in (0, 1)]
        drop[j] += (dx, dy)[j]
        drops.append(drop)
        flows = [weights[axis] * drop[axis] for axis in (0, 1)]
        balance = sum(flow - np.roll(flow, 1, axis) for axis, flow in enumerate(flows))
        size = float(faces[j].mean()) * (dy, dx)[j]
        residual = max(residual, float(np.abs(balance).max()) / size if size else 0.0)
    if not residual < 1e-6:
        raise ConvergenceError(
            f"the flow through the gap does not balance (relative error {residual:.1e})",
            history=[residual],
            where="flow_factors",
            remedy="Close gaps that are negligible with the argument closed, "
            "for example closed=1e-4 of the mean gap",
        )
    # dissipated power: equal to the mean flow, never negative, and exact to second order in the
    # rounding of the pressures
    tensor = [
        [sum((weights[n] * drops[i][n] * drops[j][n]).mean() for n in (0, 1)) for j in (0, 1)]
        for i in (0, 1)
    ]
    along, across, coupling = (
        0.0 if abs(value) < _SEALED * dx * dy else float(value) / (dx * dy)
        for value in (tensor[0][0], tensor[1][1], tensor[0][1])
    )
    return FlowFactors(along, across, coupling, mean, residual)


def _fluctuations(
    weights: tuple[np.ndarray, np.ndarray], shape: tuple[int, int], steps: tuple[float, float]
) -> tuple[tuple[np.ndarray, np.ndarray], list[np.ndarray]]:
    """Return the faces that can carry flow and the pressure fluctuations along both axes.

    Fluid in a component that no cell edge cuts can't wind around the cell: its pressure follows
    the mean gradient, its flow is zero, and its faces are dropped.
    """
    from scipy import sparse
    from scipy.sparse.csgraph import connected_components
    from scipy.sparse.linalg import splu

    size = shape[0] * shape[1]
    index = np.arange(size).reshape(shape)
    cell = np.concatenate([index.ravel(), index.ravel()])
    neighbour = np.concatenate([np.roll(index, -1, axis).ravel() for axis in (0, 1)])
    value = np.concatenate([weights[0].ravel(), weights[1].ravel()])
    flowing = value > 0.0
    graph = sparse.coo_matrix((value[flowing], (cell[flowing], neighbour[flowing])), (size, size))
    graph = (graph + graph.T).tocsr()
    _, label = connected_components(graph, directed=False)
    keep = _cut_components(label, cell[flowing], neighbour[flowing], shape)
    weights = (weights[0] * keep.reshape(shape), weights[1] * keep.reshape(shape))
    # one cell of every component carries zero pressure, the rest is solved for
    _, first = np.unique(label, return_index=True)
    keep[first] = False
    solutions = [np.zeros(shape), np.zeros(shape)]
    if not keep.any():
        return weights, solutions
    diagonal = np.asarray(graph.sum(axis=1)).ravel()
    matrix = (sparse.diags(diagonal) - graph).tocsr()[keep][:, keep]
    scale = 1.0 / np.sqrt(diagonal[keep])
    matrix = (sparse.diags(scale) @ matrix @ sparse.diags(scale)).tocsc()
    # two regions joined by an almost closed neck make the matrix singular to rounding: a small
    # shift bounds the pressure difference across it, and refinement takes the shift out again
    shift = 1e-14 * sparse.identity(matrix.shape[0], format="csc")
    factor = splu(
        (matrix + shift).tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    for axis in (0, 1):
        source = (weights[axis] - np.roll(weights[axis], 1, axis)) * steps[axis]
        right = source.ravel()[keep] * scale
        solution = factor.solve(right)
        for _ in range(2):
            solution += factor.solve(right - matrix @ solution)
        solutions[axis].ravel()[keep] = solution * scale
    return weights, solutions


def _cut_components(
    label: np.ndarray, cell: np.ndarray, neighbour: np.ndarray, shape: tuple[int, int]
) -> np.ndarray:
    """Return which cells belong to a component that has a face on the edge of the cell."""
    rows = (cell // shape[1] != neighbour // shape[1]) & (neighbour // shape[1] == 0)
    columns = (cell % shape[1] != neighbour % shape[1]) & (neighbour % shape[1] == 0)
    cut = np.zeros(label.max() + 1, dtype=bool)
    cut[label[cell[rows | columns]]] = True
    return cut[label]


def _linear_gap_face(gap: np.ndarray, axis: int) -> np.ndarray:
    """Return 2 a^2 b^2/(a + b), the mean of g^3 in series over a linear gap from a to b."""
    other = np.roll(gap, -1, axis)
    total = gap + other
    return np.where(total > 0.0, 2.0 * (gap * other) ** 2 / np.where(total > 0.0, total, 1.0), 0.0)


def _check_gap(gap: ArrayLike) -> np.ndarray:
    g = host_array(gap, "gap", "an array of NumPy, m").astype(float, copy=False)
    if g.ndim != 2 or min(g.shape) < 3:
        raise InputError(
            f"gap has shape {g.shape}", where="flow_factors", allowed="a map of at least 3 x 3"
        )
    if not np.all(np.isfinite(g)):
        raise InputError(
            f"{np.count_nonzero(~np.isfinite(g))} gaps are not finite", where="flow_factors"
        )
    if g.min() < -1e-3 * np.abs(g).max():
        raise InputError(
            f"the smallest gap is {g.min():.3g} m",
            where="flow_factors",
            allowed="gaps of zero (contact) or more",
            remedy="Give the gap of the deformed contact, not the undeformed height",
        )
    return np.maximum(g, 0.0)
