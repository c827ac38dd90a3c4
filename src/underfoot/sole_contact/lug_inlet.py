"""The film that the leading edge of a lug lets in, where cells are too coarse to hold the edge.

Where fluid meets a lug, the pressure rises from that of the groove to that of the lug within
tenths of a millimetre, over a moulded round that no cell here resolves: cells alone let in whatever
gap their centre has. What the walls carry through such a face is

    V / 2 (c h_e + (1 - c) h),  h_e = (u^4 + h0^4)^(1/4),  c = 1 / (1 + (h / d)^2)

h0 the film of the edge (``lug_edges.let_in``) and u the dry gap of the pair at the pressure next to
it. An edge closes because the lug gives way by d = p min(w, 2 H) / E: behind a gap wider than h_e
the film is ruptured, in a narrower one its pressure rises until it floats. A gap h that is wider
than d is an open wedge, which the cells hold. Fluid leaves through a closed edge by pressure, as
under a lug that is squeezed, as far as that flow is more than what the wall carries in: the share
x^2 / (1 + x^2), x the ratio of both. A slanted edge counts with the whole speed.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.ndimage import grey_dilation

from underfoot.film.face_operator import Inlet
from underfoot.shoe.row_cells import Indices, RowCells

from .film_balance import SMALLEST_GAP
from .lug_edges import LugInlet, gap_table, let_in
from .problem import Problem, State

REACH = 0.5e-3
"""m behind an edge over which pressure and gap count as those at it: some radii of a moulded one.
At 0.3 and 0.6 mm the film load is the same within 1 %, at 2 mm half (bars across)."""
LIFTS = 1.5
"""Film let in within one time step, over the gap before it: a crushed edge is lifted in several."""
LEAST = 1e3  # Pa, of a lug that hardly bears: its edge is open


class LeadingEdges:
    """The x faces at which walls that move one way carry fluid from a groove under a lug."""

    def __init__(self, inlet: LugInlet, rows: RowCells, *, backward: bool) -> None:
        land, ahead = (rows.west, rows.east) if backward else (rows.east, rows.west)
        lugs = inlet.edges.label
        # finer cells reach into the squares beside their lug
        label = np.where(lugs > 0, lugs, grey_dilation(lugs, size=3)).ravel()[rows.parent]
        inside = np.isfinite(rows.clearance[ahead])
        at_edge = rows.land[land] & (label[land] > 0) & ~rows.land[ahead] & inside
        self.faces = np.flatnonzero(at_edge)
        self._land = land = land[self.faces]
        lug, edges = label[land] - 1, inlet.edges
        node = rows.node[self.faces]
        way = (node if backward else 1 - node) * rows.distance[self.faces] * rows.spacing
        self._way = np.maximum(way, 0.05 * rows.spacing)
        self._edge = edges.edge[lug], inlet.modulus, inlet.cof * edges.reach[lug]
        self._softness = np.minimum(edges.length, 2 * edges.height)[lug] / inlet.modulus
        self._mean = _mean_behind(rows, land, backward=backward)
        self._label, self._lug = np.where(rows.land, label, 0), lug + 1
        self._width = rows.width
        self._area = np.maximum(np.bincount(self._label, rows.area), 1e-9)

    def inlet(self, problem: Problem, state: State, count: int) -> Inlet:
        """Return what the edges let in, as ``State`` was, at all of ``count`` faces."""
        assert problem.viscosity is not None
        film, closed, passing = np.ones(count), np.zeros(count), np.ones(count)
        land, speed = self._land, abs(problem.wall_speed)
        bounded = np.clip(state.gap, SMALLEST_GAP, problem.largest_gap)
        of_lug = np.bincount(self._label, state.pressure * self._width) / self._area
        beside = np.maximum(self._mean @ (state.pressure / problem.contact_share), LEAST)
        gaps, pressures = gap_table(problem.law)
        dry = np.interp(beside, pressures[::-1], gaps[::-1])
        nominal = np.maximum(np.minimum(beside, of_lug[self._lug]), LEAST)
        let = let_in(problem.viscosity * speed, nominal, *self._edge)
        let = np.maximum((dry**4 + let**4) ** 0.25, SMALLEST_GAP)
        film[self.faces] = np.minimum(let, LIFTS * bounded[land])
        wedge = (self._mean @ bounded / (beside * self._softness)) ** 2
        closed[self.faces] = 1 / (1 + wedge)
        if speed:
            fluid = np.maximum(state.fluid[land] / problem.film_share[land], 0.0)
            pressed = problem.conductance(bounded[land]).value * fluid / self._way
            out = (pressed / (0.5 * speed * let)) ** 2 + wedge
            passing[self.faces] = out / (1 + out)
        return Inlet(film, closed, passing)


def _mean_behind(rows: RowCells, land: Indices, *, backward: bool) -> sp.csr_matrix:
    """Return the means over ``REACH`` behind each edge, whose first cells are ``land``."""
    number = rows.parent % rows.shape[1]
    edges, at = np.arange(land.size), land
    left = np.full(land.size, REACH / rows.spacing)
    entries: list[tuple[NDArray[Any], ...]] = [(edges[:0], at[:0], left[:0])]
    while edges.size:
        weight = np.minimum(left, np.maximum(rows.area[at], 1e-6))
        entries.append((edges, at, weight))
        further = np.clip(at + (-1 if backward else 1), 0, rows.size - 1)
        on = rows.land[further] & (number[further] == number[at]) & (left - weight > 1e-9)
        edges, at, left = edges[on], further[on], (left - weight)[on]
    row, column, weight = (np.concatenate(each) for each in zip(*entries, strict=True))
    weight = weight / np.bincount(row, weight, land.size)[row]
    return sp.csr_matrix((weight, (row, column)), (land.size, rows.size))
