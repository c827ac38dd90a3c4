"""Compliance of the real sole: finite elements where it is coarse, layers where it is fine."""

from typing import Any, NotRequired, TypedDict, Unpack

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from underfoot.core import Cache, Progress, silent
from underfoot.core.identity import content_hash
from underfoot.core.threads import threads_limited
from underfoot.shoe.geometry import SoleMap

from ..compliance import ConvolutionCompliance, layered_compliance
from ..long_waves import LongWaves, splines_over
from .elasticity import LandCompliance, Rubber, land_compliance
from .mesh import Layers, SoleMesh, sole_mesh
from .plan import plan_of

Array = NDArray[np.float64]
ELEMENT, PLAIN_ELEMENT = 2.0e-3, 3.0e-3
"""Side of an element on the land of a treaded and of an untreaded sole, m; at least
``CELLS_AN_ELEMENT`` cells of the grid."""
CELLS_AN_ELEMENT = 2.5
FAR_ELEMENT = 4.0e-3
REACH = 3.5e-3
"""Land higher above the floor than this (m) keeps the layered compliance alone."""
FAINT = 0.02
"""Waves that the land can't tell apart (relative eigenvalue of their overlap) are left out."""


class OutsoleAndMidsole(TypedDict):
    """What ``finite_element_compliance`` takes about the layers."""

    modulus: float
    poisson_ratio: float
    thickness: float
    shoe_angle: float
    midsole_modulus: NotRequired[float | None]
    midsole_thickness: NotRequired[float | None]
    midsole_poisson_ratio: NotRequired[float]


@threads_limited(1)
def finite_element_compliance(
    sole: SoleMap,
    *,
    cache: Cache | None = None,
    progress: Progress = silent,
    **body: Unpack[OutsoleAndMidsole],
) -> ConvolutionCompliance:
    """Return the compliance of a sole from finite elements of its real shape.

    Finite elements for what varies over 6 mm or more, lug by lug too; layers for what is finer
    and for land far above the floor: ``LongWaves`` with waves that the land cuts out.

    Parameters:
        sole: Plan form, profile and tread; meshed as its cells show them.
        modulus, poisson_ratio, thickness: Of the outsole: Pa, 1 (0 to 0.495), m (from the plane of
            the sole to the midsole, lugs included).
        shoe_angle: Tilt of the sole's plane against the floor, rad.
        midsole_modulus, midsole_thickness, midsole_poisson_ratio: Of the layer between outsole and
            rigid foot; None (the default) for none, and a ratio of 0.3.
        cache: Where the condensed land is kept; a sole of the same shape and the same ratio of
            moduli is not computed again. None computes afresh.

    Raises:
        InputError: The profile or a channel goes through the outsole; Poisson's ratio above 0.495.
    """
    land = sole_land(sole, cache=cache, progress=progress, **body)
    layers = layered_compliance(sole, **body)
    nodes, near = hats_on_cells(land, sole), sole.land & (sole.clearance < REACH)
    fields = splines_over(sole, near).on(sole.x, sole.y, near)
    fields = sp.csr_matrix(fields[:, np.diff(sp.csc_matrix(fields).indptr) > 0])
    size = np.sqrt(np.asarray(fields.multiply(fields).sum(axis=0)).ravel())
    values, vectors = np.linalg.eigh((fields.T @ fields).toarray() / np.outer(size, size))
    distinct = values > FAINT
    turn = vectors[:, distinct] / np.sqrt(values[distinct]) / size[:, None]
    # The sum of hat times pressure over the cells is the force on a node: the elements' own overlap
    # turns it into pressure, so that force is kept where cells cover a rim only in part.
    pressure = np.linalg.solve(land.overlap.toarray(), (nodes.T @ fields).toarray() @ turn)
    exact = pressure.T @ land.work @ pressure * sole.spacing**2
    change = turn @ (exact - turn.T @ layers.under_waves(fields) @ turn) @ turn.T
    return layers.plus(LongWaves(fields, 0.5 * (change + change.T)))


def sole_land(
    sole: SoleMap,
    *,
    modulus: float,
    poisson_ratio: float,
    thickness: float,
    shoe_angle: float,
    midsole_modulus: float | None = None,
    midsole_thickness: float | None = None,
    midsole_poisson_ratio: float = 0.3,
    element: float | None = None,
    far_element: float = FAR_ELEMENT,
    lug_layers: int = 1,
    reach: float = REACH,
    cache: Cache | None = None,
    progress: Progress = silent,
) -> LandCompliance:
    """Return the finite-element compliance of the land within ``reach`` (m) of the floor.

    ``element`` and ``far_element`` (m) are the sides of elements on this land and elsewhere,
    ``lug_layers`` the elements over the height of a lug. Others as ``finite_element_compliance``.
    """
    element = _element(sole) if element is None else element
    soft = None if midsole_modulus is None else midsole_modulus / modulus
    key = content_hash(
        [sole.x, sole.y, np.nan_to_num(sole.clearance, posinf=-1.0), sole.inside, sole.land],
        [np.asarray(sole.outline), poisson_ratio, thickness, shoe_angle],
        [soft, midsole_thickness, midsole_poisson_ratio],
        [element, far_element, lug_layers, reach],
    )
    stored = None if cache is None else cache.load(key)
    if stored is not None:
        exact: dict[str, Any] = {**stored, "work": stored["work"] / modulus}
        return LandCompliance(**{**exact, "unknowns": int(stored["unknowns"])})
    layers = Layers(thickness, midsole_thickness or 0.0, shoe_angle)
    sizes = {"far_element": far_element, "reach": reach, "lug_layers": lug_layers}
    mesh = sole_prisms(sole, layers, element=element, **sizes)
    near = (mesh.nodes[mesh.land, 2] - sole.clearance.min()).min(axis=1) < reach
    land = land_compliance(
        mesh,
        Rubber(modulus, poisson_ratio),
        None if midsole_modulus is None else Rubber(midsole_modulus, midsole_poisson_ratio),
        loaded=near,
        progress=progress,
    )
    if cache is not None:
        kept = {name: getattr(land, name) for name in ("nodes", "height", "triangles", "unknowns")}
        cache.store(key, {**kept, "work": land.work * modulus})
    return land


def _element(sole: SoleMap) -> float:
    plain = not (sole.inside & ~sole.land).any()
    return max(PLAIN_ELEMENT if plain else ELEMENT, CELLS_AN_ELEMENT * sole.spacing)


def sole_prisms(
    sole: SoleMap,
    layers: Layers,
    *,
    element: float | None = None,
    far_element: float = FAR_ELEMENT,
    reach: float = REACH,
    lug_layers: int = 1,
) -> SoleMesh:
    """Return the prisms of a sole between the floor and the rigid foot.

    Others as ``sole_land``.

    Raises:
        InputError: The profile or a channel goes through the outsole.
    """
    element = _element(sole) if element is None else element
    return sole_mesh(plan_of(sole), layers, element, max(far_element, element), reach, lug_layers)


def hats_on_cells(land: LandCompliance, sole: SoleMap, reach: float = REACH) -> sp.csr_matrix:
    """Return the value of each hat at each cell centre, (nx ny, n); 0 beyond ``reach`` (m)."""
    from scipy.spatial import KDTree

    cell = sole.spacing
    corners = land.nodes[land.triangles]
    ny = sole.y.size
    taken = np.full(sole.clearance.shape, -np.inf)
    best: dict[int, tuple[NDArray[np.int64], Array]] = {}
    for nodes, points in zip(land.triangles, corners, strict=True):
        low = np.floor((points.min(axis=0) - (sole.x[0], sole.y[0])) / cell - 0.7).astype(int)
        high = np.ceil((points.max(axis=0) - (sole.x[0], sole.y[0])) / cell + 0.7).astype(int)
        i = np.arange(max(low[0], 0), min(high[0], sole.x.size - 1) + 1)
        j = np.arange(max(low[1], 0), min(high[1], ny - 1) + 1)
        x, y = np.meshgrid(sole.x[i], sole.y[j], indexing="ij")
        first, second, third = points
        size = np.linalg.det(np.array([second - first, third - first]))
        b = ((x - first[0]) * (third - first)[1] - (y - first[1]) * (third - first)[0]) / size
        c = ((second - first)[0] * (y - first[1]) - (second - first)[1] * (x - first[0])) / size
        share = np.stack([1 - b - c, b, c], axis=-1)
        depth = share.min(axis=-1)
        # a cell just outside, on the rim of a piece, takes the value of the nearest edge
        near = (depth > -0.5) & sole.land[np.ix_(i, j)] & (depth > taken[np.ix_(i, j)])
        for at, to in zip(*np.nonzero(near), strict=True):
            taken[i[at], j[to]] = depth[at, to]
            clipped = np.clip(share[at, to], 0.0, None)
            best[int(i[at] * ny + j[to])] = (nodes, clipped / clipped.sum())
    # what the mesh leaves out at rims belongs to the nearest node
    left = np.argwhere(sole.land & (sole.clearance < reach) & np.isneginf(taken))
    if len(left):
        places = np.column_stack([sole.x[left[:, 0]], sole.y[left[:, 1]]])
        _, nearest = KDTree(land.nodes).query(places)
        for (at, to), node in zip(left, np.atleast_1d(nearest), strict=True):
            best[int(at * ny + to)] = (np.full(3, node), np.full(3, 1 / 3))
    rows = np.repeat(np.array(list(best), dtype=int), 3)
    columns, values = (np.concatenate(part) for part in zip(*best.values(), strict=True))
    return sp.csr_matrix((values, (rows, columns)), shape=(sole.clearance.size, land.area.size))
