"""Dry contact of a finite-element sole with a rigid floor, on the compliance of its land."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from underfoot.core import ConvergenceError, InputError
from underfoot.rough_contact.pressure_gap_law import PressureGapLaw
from underfoot.sole_contact.finite_element import LandCompliance

Array = NDArray[np.float64]
MOST_STEPS = 80
CLIP = 2.0  # decay lengths by which a gap may change in one Newton step
FAR = 200.0  # decay lengths beyond which an asperity pressure is nothing


@dataclass(frozen=True, slots=True)
class DryContact:
    """Pressure and gap at the nodes of the land, in Pa and m; ``piece`` numbers its lugs.

    ``approach`` (m) is how far the rigid foot has come down since the lowest point touched.
    """

    land: LandCompliance
    pressure: Array
    gap: Array
    approach: float
    piece: NDArray[np.int64]
    newton: int

    def contact_area(self, least: float = 1e4) -> float:
        """Return the floor area (m^2) under a pressure above ``least`` (Pa)."""
        corners = self.pressure[self.land.triangles]
        return float((_triangle_areas(self.land) * _share_above(corners, least)).sum())

    @property
    def piece_loads(self) -> Array:
        """Load on each lug, N."""
        return np.bincount(self.piece, self.pressure * self.land.area).astype(float)

    @property
    def piece_areas(self) -> Array:
        """Land area of each lug, m^2."""
        return np.bincount(self.piece, self.land.area).astype(float)

    @property
    def piece_centres(self) -> Array:
        """Centroid of each lug, (n, 2), m."""
        sums = [np.bincount(self.piece, self.land.nodes[:, n] * self.land.area) for n in (0, 1)]
        return np.column_stack(sums) / self.piece_areas[:, None]


def dry_contact(
    land: LandCompliance, normal_force: float, law: PressureGapLaw | None = None
) -> DryContact:
    """Return the contact of the land with a rigid floor, free of friction.

    Without a law neither penalty nor roughness: gap >= 0, p >= 0, p gap = 0 by a primal-dual active
    set. With a law p = P(gap), from there by Newton's method. Gap and law are averaged over the hat
    of a node: h_i = G_i - d + sum_j work_ij p_j / area_i.

    Raises
    ------
    ConvergenceError
        The set of touching nodes does not settle, or Newton's method fails.
    """
    if not normal_force > 0:
        raise InputError(f"{normal_force} is not positive", where="normal_force")
    compliance = land.work / land.area[:, None]
    clearance = land.overlap @ (land.height - land.height.min()) / land.area
    pressure, approach, steps = _touching(compliance, clearance, land.area, normal_force)
    gap = clearance - approach + compliance @ pressure
    if law is not None:
        pressure, gap, approach, more = _rough(
            compliance, clearance, land.area, normal_force, law, pressure, gap, approach
        )
        steps += more
    return DryContact(land, pressure, gap, approach, _pieces(land), steps)


def _touching(
    compliance: Array, clearance: Array, area: Array, load: float
) -> tuple[Array, float, int]:
    """Return pressure and approach of a frictionless unilateral contact."""
    active = clearance <= np.quantile(clearance, 0.2)
    size = clearance.size
    for step in range(1, MOST_STEPS + 1):
        inside = np.flatnonzero(active)
        system = np.zeros((inside.size + 1, inside.size + 1))
        system[:-1, :-1] = compliance[np.ix_(inside, inside)]
        system[:-1, -1] = -1.0
        scale = float(np.diagonal(compliance).mean() / area.mean())
        system[-1, :-1] = area[inside] * scale
        right = np.append(-clearance[inside], load * scale)
        answer = np.linalg.solve(system, right)
        pressure = np.zeros(size)
        pressure[inside] = answer[:-1]
        approach = float(answer[-1])
        gap = clearance - approach + compliance @ pressure
        following = np.where(active, pressure > 0, gap < 0)
        if (following == active).all():
            return pressure, approach, step
        active = following
    raise ConvergenceError(
        "the set of touching nodes does not settle",
        where="outsole.finite_element",
        remedy="Refine the mesh.",
    )


def _rough(
    compliance: Array,
    clearance: Array,
    area: Array,
    load: float,
    law: PressureGapLaw,
    pressure: Array,
    gap: Array,
    approach: float,
) -> tuple[Array, Array, float, int]:
    """Return the contact through asperities, started from the smooth one."""
    gaps = np.geomspace(1e-9, 1e-2, 2000)
    known = law.pressure(gaps)
    touched = pressure > 0
    gap = np.maximum(gap, 0.0)
    gap[touched] = np.interp(-pressure[touched], -known, gaps)
    for step in range(1, MOST_STEPS + 1):
        values, stiffness = law.pressure(gap), law.stiffness(gap)
        misfit = gap - (clearance - approach + compliance @ values)
        short = load - float(area @ values)
        decay = values / np.maximum(stiffness, 1e-300)
        decay = np.where(stiffness > 0, decay, np.median(decay[touched]))
        if np.abs(misfit / decay)[values > 1.0].max() < 1e-8 and abs(short) < 1e-9 * load:
            return values, gap, approach, step - 1
        # gap change d: d + C (k d) + a = -misfit,  area . (-k d) = short
        matrix = compliance * stiffness[None, :]
        matrix[np.diag_indices_from(matrix)] += 1.0
        answers = np.linalg.solve(matrix, np.column_stack([-misfit, -np.ones_like(gap)]))
        force = area * stiffness
        lower = (-short - force @ answers[:, 0]) / (force @ answers[:, 1])
        change = answers[:, 0] + lower * answers[:, 1]
        near = gap < FAR * decay
        share = 1.0
        if near.any():
            worst = float(np.abs(change[near] / decay[near]).max())
            share = min(1.0, max(CLIP / worst, 0.05)) if worst > 0 else 1.0
        gap = gap + share * change
        approach += share * float(lower)
    raise ConvergenceError("the rough contact does not converge", where="outsole.finite_element")


def _pieces(land: LandCompliance) -> NDArray[np.int64]:
    """Return the number of the connected piece of land that each node belongs to."""
    import scipy.sparse as sp
    from scipy.sparse.csgraph import connected_components

    count = land.area.size
    edges = np.concatenate([land.triangles[:, [0, 1]], land.triangles[:, [1, 2]]])
    graph = sp.coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _triangle_areas(land: LandCompliance) -> Array:
    a, b, c = (land.nodes[land.triangles[:, n]] for n in range(3))
    return 0.5 * np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def _share_above(corners: Array, level: float) -> Array:
    """Return the share of each triangle on which a linear field lies above a level."""
    value = np.sort(corners - level, axis=1)
    low, middle, high = value.T
    with np.errstate(divide="ignore", invalid="ignore"):
        one = high**2 / ((high - low) * (high - middle))
        two = 1 - low**2 / ((low - middle) * (low - high))
    return np.select([low >= 0, high <= 0, middle <= 0], [1.0, 0.0, one], two)
