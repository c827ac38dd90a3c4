"""Prisms under the plan form: a triangulation that follows rim and lugs, carried up to the foot."""

import math
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core import InputError
from underfoot.core.optional import optional_module
from underfoot.core.remark import Message

from .plan import Plan

Array = NDArray[np.float64]
SNAP = 0.125
"""Share of a cell to which corners of the plan are rounded; the cells' own corners stay."""


@dataclass(frozen=True, slots=True)
class Layers:
    """What lies between the land and the rigid foot; lengths in m, angle in rad.

    ``thickness`` is that of the outsole from its plane (the plane that the sole rests on when flat)
    to the midsole; ``shoe_angle`` the tilt of that plane against the floor.
    """

    thickness: float
    midsole_thickness: float
    shoe_angle: float


@dataclass(frozen=True, slots=True)
class SoleMesh:
    """Nodes and prisms of order 1; prism = lower triangle, upper triangle.

    ``material`` 0 outsole, 1 midsole; ``land`` (n, 3) triangles that can touch the floor; ``foot``
    (n, 3) triangles bonded to the rigid foot. Nodes in the floor's frame, m.
    """

    nodes: Array
    prisms: NDArray[np.int64]
    material: NDArray[np.int64]
    land: NDArray[np.int64]
    foot: NDArray[np.int64]


def sole_mesh(
    plan: Plan, layers: Layers, element: float, far_element: float, reach: float, lug_layers: int
) -> SoleMesh:
    """Return the mesh: elements of ``element`` (m) on land below ``reach`` (m), coarser beyond."""
    points, triangles, on_land = _triangulation(plan, element, far_element, reach)
    height, depth = (_at(plan, field, points) for field in (plan.land_height, plan.tread_depth))
    sine, cosine = math.sin(layers.shoe_angle), math.cos(layers.shoe_angle)
    # each point's height over the plane that the land rests on, along the shoe's normal
    over = height * cosine - points[:, 0] * sine
    over -= over[triangles[on_land]].min()
    lug = depth * cosine
    body = layers.thickness - over - lug
    if (body <= 0.1 * layers.thickness).any():
        raise InputError(
            "the profile or its channels go through nine tenths of the outsole",
            where="thickness",
            allowed=Message("above {max:.3g} mm", max=1000.0 * float((over + lug).max()) / 0.9),
        )
    normal = np.array([-sine, 0.0, cosine])
    base = np.column_stack([points, height])
    treaded = bool((lug > 0).any())
    levels: list[Array] = []
    if treaded:
        levels += [lug * step / lug_layers for step in range(lug_layers)]
    heights = _layer_shares(layers.thickness, element)
    levels += [lug + body * share for share in heights]
    outsole_levels = len(levels)
    if layers.midsole_thickness > 0:
        count = max(2, math.ceil(layers.midsole_thickness / (2.5 * far_element)))
        levels += [lug + body + layers.midsole_thickness * (n + 1) / count for n in range(count)]
    size = len(points)
    nodes = np.concatenate([base + level[:, None] * normal for level in levels])
    prisms, material = [], []
    for level in range(len(levels) - 1):
        within = on_land if treaded and level < lug_layers else np.ones(len(triangles), bool)
        chosen = triangles[within]
        prisms.append(np.hstack([chosen + level * size, chosen + (level + 1) * size]))
        material.append(np.full(len(chosen), int(level >= outsole_levels - 1)))
    every = np.concatenate(prisms)
    used, inverse = np.unique(every, return_inverse=True)
    place = np.full(len(nodes), -1)
    place[used] = np.arange(used.size)
    return SoleMesh(
        nodes=nodes[used],
        prisms=inverse.reshape(every.shape),
        material=np.concatenate(material),
        land=place[triangles[on_land]],
        foot=place[triangles + (len(levels) - 1) * size],
    )


def _layer_shares(thickness: float, element: float) -> Array:
    """Return the shares 0 to 1 of the layers, growing from the size of an element upward."""
    steps, total, step = [], 0.0, 1.2 * element
    while total < thickness:
        steps.append(step)
        total += step
        step *= 1.8
    return np.concatenate([[0.0], np.cumsum(steps) / total])


def _at(plan: Plan, field: Array, points: Array) -> Array:
    """Return a field of cell centres at points, linear between them."""
    from scipy.ndimage import map_coordinates

    cell = plan.x[1] - plan.x[0]
    where = [(points[:, 0] - plan.x[0]) / cell, (points[:, 1] - plan.y[0]) / cell]
    return np.asarray(map_coordinates(field, where, order=1, mode="nearest"))


def _triangulation(
    plan: Plan, element: float, far_element: float, reach: float
) -> tuple[Array, NDArray[np.int64], NDArray[np.bool_]]:
    """Return points (n, 2) in m, triangles (anticlockwise) and which of them are land."""
    netgen = optional_module("netgen.geom2d", "cad", "Compliance by finite elements")
    geometry = netgen.SplineGeometry()
    numbers: dict[tuple[float, float], int] = {}
    sides: dict[tuple[int, int], dict[str, int]] = {}
    pieces = _pieces(plan)
    for domain, (polygon, is_land) in enumerate(pieces, start=1):
        near = float(_at(plan, plan.land_height, np.asarray(polygon.exterior.coords)).min()) < reach
        geometry.SetMaterial(domain, "land" if is_land else "channel")
        size = element if near and (is_land or len(plan.land) > 1) else far_element
        geometry.SetDomainMaxH(domain, 1e3 * size)
        for index, ring in enumerate((polygon.exterior, *polygon.interiors)):
            corners = [(round(1e3 * px, 6), round(1e3 * py, 6)) for px, py in ring.coords[:-1]]
            if ring.is_ccw != (index == 0):
                corners.reverse()  # the piece lies to the left of its rings
            for corner in corners:
                if corner not in numbers:
                    numbers[corner] = geometry.AppendPoint(*corner)
            places = [numbers[corner] for corner in corners]
            for start, end in zip(places, places[1:] + places[:1], strict=True):
                if (end, start) in sides:
                    sides[end, start]["rightdomain"] = domain
                else:
                    sides[start, end] = {"leftdomain": domain, "rightdomain": 0}
    for (start, end), domains in sides.items():
        geometry.Append(["line", start, end], **domains)
    parameters = import_module("netgen.meshing").MeshingParameters(
        maxh=1e3 * far_element, grading=0.4
    )
    try:
        mesh = geometry.GenerateMesh(mp=parameters)
    except Exception as error:  # netgen's own exception has no public name
        raise InputError(
            "the plan form can't be meshed",
            where="compliance.model",
            remedy='Change numerics.grid_spacing a little, or use compliance.model = "layered"',
        ) from error
    points = np.array([tuple(point.p)[:2] for point in mesh.Points()]) * 1e-3
    elements = mesh.Elements2D()
    triangles = np.array([[v.nr - 1 for v in e.vertices] for e in elements], dtype=np.int64)
    on_land = np.array([pieces[e.index - 1][1] for e in elements])
    used, inverse = np.unique(triangles, return_inverse=True)
    points, triangles = points[used], inverse.reshape(triangles.shape)
    a, b, c = (points[triangles[:, n]] for n in range(3))
    turn = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    triangles[turn < 0] = triangles[turn < 0][:, ::-1]
    return points, triangles, on_land


def _pieces(plan: Plan) -> list[tuple[Any, bool]]:
    """Return polygons that share their corners, each with whether it is land."""
    import shapely

    everything = [*plan.land, *plan.channels]
    # corners closer than this become one: slivers at the rim can't be meshed
    grid = SNAP * float(plan.x[1] - plan.x[0])
    lines = shapely.union_all(
        [shapely.set_precision(p.boundary, grid) for p in everything], grid_size=grid
    )
    land = shapely.union_all(list(plan.land))
    shapely.prepare(land)
    parts = []
    for part in shapely.get_parts(shapely.polygonize(shapely.get_parts(lines))):
        inside = part.representative_point()
        parts.append((part, bool(shapely.contains(land, inside))))
    return parts
